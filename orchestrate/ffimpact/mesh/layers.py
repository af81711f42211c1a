"""Layers of a body: which cells of a mesh are in which one, and the curves between them, which a
mesh in the plane follows. All lengths are in m, in the coordinates of the body's mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import scipy

from . import curved, plane_file
from .groups import rows_among
from .mesh import AXIS, FREE, SIDES, Curve, Made, Mesh, Piece, Sizes, boundary
from .solid_mesh import Curved, SolidMesh

if TYPE_CHECKING:
    from ..input.conditions import Part

__all__ = [
    "Circle",
    "Layers",
    "Segment",
    "circles_between",
    "contents",
    "layers_of_cells",
    "longest",
    "on_boundary",
    "surfaces_between",
    "with_interfaces",
]

SAMPLES = 400  # number of points of a curve between which crossings are sought
NEAR = 1e-9  # distance that counts as none, over the bounding radius
BESIDE = 1e-7  # distance from a curve at which the layers on its sides are looked up, the same
SAME = 1e-9  # distance of parameters in [0, 1] that are the same
BENT = 1.5  # largest size of a curved side over sqrt(R t): it bends by 0.28 of the thickness t
ROUND = 16  # number of points of a circle whose distance from the boundary is looked up
ON = 1e-6  # distance of corners that are on the boundary of a region, over the bounding radius


@dataclass(frozen=True)
class Layers:
    """The regions of the layers of a body and the numbers of these layers, from 1. A later region
    wins. `bounding_radius` [m] is that of the body.
    """

    parts: Sequence[Part]
    numbers: Sequence[int]
    bounding_radius: float

    def at(self, points: np.ndarray) -> np.ndarray:
        """The layer (n,) at points (n, axes), 0 for none."""
        layer = np.zeros(len(points), dtype=int)
        for part, number in zip(self.parts, self.numbers):
            layer[part.contains(points)] = number
        return layer

    @property
    def edges(self) -> list[Segment | Circle]:
        """The curves that bound the regions in the plane."""
        return [edge for part in self.parts for edge in _edges(part, 4 * self.bounding_radius)]

    @property
    def circles(self) -> list[tuple[np.ndarray, float]]:
        """Centres (2,) [m] and radii [m] of the round ones among these curves."""
        return [(edge.centre, edge.radius) for edge in self.edges if isinstance(edge, Circle)]

    def differ(self, edge: Segment | Circle, points: np.ndarray) -> np.ndarray:
        """Whether the layers on both sides of points (n, 2) on an edge differ."""
        away = BESIDE * self.bounding_radius * edge.normal(points)
        differ: np.ndarray = self.at(points + away) != self.at(points - away)
        return differ


@dataclass(frozen=True)
class Segment:
    """A straight edge of a region between two points (2,)."""

    start: np.ndarray
    end: np.ndarray
    closed = False

    def at(self, s: np.ndarray) -> np.ndarray:
        points: np.ndarray = self.start + s[:, None] * (self.end - self.start)
        return points

    def parameter(self, points: np.ndarray) -> np.ndarray:
        along = self.end - self.start
        parameter: np.ndarray = (points - self.start) @ along / (along @ along)
        return parameter

    def normal(self, points: np.ndarray) -> np.ndarray:
        along = (self.end - self.start) / np.linalg.norm(self.end - self.start)
        return np.tile([-along[1], along[0]], (len(points), 1))

    def side(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) from the straight line."""
        distance: np.ndarray = ((points - self.start) * self.normal(points)).sum(axis=1)
        return distance


@dataclass(frozen=True)
class Circle:
    """A round edge of a region."""

    centre: np.ndarray
    radius: float
    closed = True

    def at(self, s: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * s
        points: np.ndarray = self.centre + self.radius * np.column_stack(
            [np.cos(angle), np.sin(angle)]
        )
        return points

    def parameter(self, points: np.ndarray) -> np.ndarray:
        arm = points - self.centre
        parameter: np.ndarray = np.arctan2(arm[:, 1], arm[:, 0]) / (2 * np.pi) % 1
        return parameter

    def normal(self, points: np.ndarray) -> np.ndarray:
        arm = points - self.centre
        normal: np.ndarray = arm / np.linalg.norm(arm, axis=1, keepdims=True)
        return normal

    def side(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) from the circle."""
        distance: np.ndarray = np.linalg.norm(points - self.centre, axis=1) - self.radius
        return distance


def _edges(part: Part, far: float) -> list[Segment | Circle]:
    """The edges of a region in the plane, straight ones up to the distance `far` [m]."""
    first, second = part.numbers
    if part.kind == "ball":
        return [Circle(np.broadcast_to(first, 2), float(second))]
    if part.kind == "half-space":
        normal = second / np.linalg.norm(second)
        middle, along = normal * (normal @ first), far * np.array([-normal[1], normal[0]])
        return [Segment(middle - along, middle + along)]
    (x0, y0), (x1, y1) = np.clip(first, -far, far), np.clip(second, -far, far)
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    sides = zip(corners, np.roll(corners, -1, axis=0))
    return [Segment(a, b) for a, b in sides if (a != b).any()]


def _splits(curve: Curve, edge: Segment | Circle, near: float) -> list[float]:
    """The parameters in [0, 1] at which a curve crosses an edge, and those of its ends on it."""
    s = np.linspace(0, 1, SAMPLES)
    side = edge.side(curve(s))
    off = np.flatnonzero(abs(side) > near)
    crossed = [float(end) for end, at in ((0.0, 0), (1.0, -1)) if abs(side[at]) <= near]
    for a, b in pairwise(off):
        if side[a] * side[b] < 0:
            root = scipy.optimize.brentq(
                lambda x: float(edge.side(curve(np.array([x])))[0]), s[a], s[b], xtol=1e-15
            )
            crossed.append(float(root))
    if edge.closed or not crossed:
        return crossed
    length = float(np.linalg.norm(edge.at(np.array([0.0])) - edge.at(np.array([1.0]))))
    within = edge.parameter(curve(np.array(crossed)))
    slack = near / length
    return [x for x, at in zip(crossed, within) if -slack <= at <= 1 + slack]


def _stretch(curve: Curve, a: float, b: float) -> Curve:
    """The part of a curve from the parameter a to b, over [0, 1]."""
    return lambda s: curve(a + (b - a) * s)


def with_interfaces(
    boundary: list[list[Piece]],
    layers: Layers,
    gap: Callable[[np.ndarray], np.ndarray],
    halved: bool,
    sizes: Sizes,
) -> tuple[list[list[Piece]], list[tuple[Curve, float]]]:
    """Returns the boundary of a body, split where interfaces between layers meet it, and the
    interfaces inside it with the largest element size [m] on each. `gap` are signed distances (n,) of
    points (n, 2) from the outline of the body, negative inside; of a `halved` one only x >= 0 is meshed.
    """
    near, edges = NEAR * layers.bounding_radius, layers.edges
    cuts: list[list[float]] = [[] for _ in edges]
    split: list[list[Piece]] = []
    for loop in boundary:
        split.append([])
        for curve, largest, label in loop:
            ends = [0.0, 1.0]
            for edge, own in zip(edges, cuts):
                crossed = _splits(curve, edge, near)
                ends += crossed
                own += edge.parameter(curve(np.array(crossed))).tolist() if crossed else []
            for a, b in pairwise(_distinct(ends)):
                split[-1].append((_stretch(curve, a, b), largest, label))
    for edge in edges:
        for other, own in zip(edges, cuts):
            if other is not edge and (crossed := _splits(edge.at, other, near)):
                own += other.parameter(edge.at(np.array(crossed))).tolist()
    inner: dict[tuple[tuple[float, ...], ...], tuple[Curve, float]] = {}
    for edge, own in zip(edges, cuts):
        for a, b in _spans(edge, own):
            curve = _stretch(edge.at, a, b)
            places = curve(np.array([0.0, 0.5, 1.0]))
            middle = places[1:2]
            inside = gap(middle)[0] < -10 * near and (not halved or middle[0, 0] > 10 * near)
            if inside and layers.differ(edge, middle)[0]:
                # regions that touch have the same edge twice
                key = sorted(map(tuple, np.round(places / (100 * near)).tolist()))
                inner.setdefault(tuple(key), (curve, _largest(edge, edges, gap, sizes, near)))
    return split, list(inner.values())


def _distinct(values: list[float]) -> list[float]:
    """Parameters in [0, 1], sorted, each once."""
    kept: list[float] = []
    for x in sorted(values):
        if 0 <= x <= 1 and (not kept or x > kept[-1] + SAME):
            kept.append(x)
    return kept


def _spans(edge: Segment | Circle, cuts: list[float]) -> list[tuple[float, float]]:
    """The stretches of an edge between cuts, of a circle at most quarters."""
    if not edge.closed:
        return list(pairwise(_distinct([0.0, *cuts, 1.0])))
    kept = _distinct(cuts) or [0.0]
    if len(kept) > 1 and kept[-1] > kept[0] + 1 - SAME:
        kept.pop()
    spans = pairwise([*kept, kept[0] + 1])
    quarters = [np.linspace(a, b, 1 + math.ceil(4 * (b - a))).tolist() for a, b in spans]
    return [both for ends in quarters for both in pairwise(ends)]


def _largest(
    edge: Segment | Circle,
    edges: list[Segment | Circle],
    gap: Callable[[np.ndarray], np.ndarray],
    sizes: Sizes,
    near: float,
) -> float:
    """The largest element size [m] on an edge: `sizes.of_layers` times the distance from the next
    parallel or concentric one; of a circle also from the boundary, and half its radius.
    """
    apart: list[float] = []
    if isinstance(edge, Circle):
        circles = [other for other in edges if isinstance(other, Circle)]
        apart += [
            abs(other.radius - edge.radius)
            for other in circles
            if (other.centre == edge.centre).all()
        ]
        away = -gap(edge.at(np.linspace(0, 1, ROUND)))
        apart += [float(away.min())] if away.min() > 0 else []
        largest = [longest(thick, edge.radius, sizes) for thick in apart if thick > near]
        return min([sizes.bulk, edge.radius / 2, *largest])
    along = edge.end - edge.start
    lines = [other for other in edges if isinstance(other, Segment)]
    apart += [
        abs(float(other.side(edge.start[None])[0]))
        for other in lines
        if abs(np.dot(along, other.normal(along[None])[0])) <= NEAR * np.linalg.norm(along)
    ]
    return min([sizes.bulk, *(sizes.of_layers * thick for thick in apart if thick > near)])


def longest(thick: float, radius: float, sizes: Sizes) -> float:
    """The largest element size [m] on a circle of this radius on a side of a layer. The middle of a
    curved side, which is s long, is s^2/(8 R) away from its chord.
    """
    return min(sizes.of_layers * thick, BENT * math.sqrt(radius * thick))


def layers_of_cells(corners: np.ndarray, layers: Layers) -> tuple[np.ndarray, bool]:
    """The layer (t,) of cells with these corners (t, n, axes), and whether no cell is in two layers.

    Corners on the boundary of a region are in both. A cell has the layer of its other corners, or
    of its middle if it has none: with a coarse chord the middle of a thin cell is beyond a curved
    boundary.
    """
    if not layers.parts:
        return np.zeros(len(corners), dtype=int), True
    points = corners.reshape(-1, corners.shape[2])
    distance = np.min([_distance(part, points) for part in layers.parts], axis=0)
    off = (distance > ON * layers.bounding_radius).reshape(corners.shape[:2])
    of_corner = layers.at(points).reshape(corners.shape[:2])
    first = of_corner[np.arange(len(corners)), off.argmax(axis=1)]
    layer = np.where(off.any(axis=1), first, layers.at(corners.mean(axis=1)))
    return layer, bool((of_corner == layer[:, None])[off].all())


def on_boundary(made: Mesh | SolidMesh) -> np.ndarray:
    """The numbers of the cells that have a side which may come into contact."""
    corners = made.elements.shape[1]
    sides = made.elements[:, SIDES[corners]].reshape(-1, corners - 1)
    cells: np.ndarray = rows_among(made.sides[made.labels == FREE], sides) // corners
    return cells


def contents(made: Mesh | SolidMesh, of_revolution: bool) -> np.ndarray:
    """The areas or volumes (t,) of cells, of revolution over 2 pi [m2 or m3]."""
    corners = made.points[made.elements]
    arms = corners[:, 1:] - corners[:, :1]
    around = corners[..., 0].mean(axis=1) if of_revolution else 1.0
    size: np.ndarray = np.linalg.det(arms) / math.factorial(arms.shape[1]) * around
    return size


def circles_between(made: Mesh) -> list[tuple[np.ndarray, float]]:
    """Centres (2,) [m] and radii [m] of the circles on which sides between layers of a mesh from a
    file lie.
    """
    circles: dict[tuple[float, ...], tuple[np.ndarray, float]] = {}
    for cells, sides, inner in _bounds(made):
        labels = np.where(inner, FREE, AXIS)  # no circle goes through sides with the label AXIS
        centres = plane_file.arc_centres(Mesh(made.points, cells, sides, labels))
        for side, centre in zip(sides, centres):
            if not np.isnan(centre).any():
                radius = float(np.linalg.norm(made.points[side[0]] - centre))
                circles.setdefault(tuple(centre), (centre, radius))
    return list(circles.values())


def surfaces_between(made: SolidMesh) -> list[Curved]:
    """The spheres and cylinders on which faces between layers of a mesh from a file lie."""
    sides = [sides[inner] for _, sides, inner in _bounds(made)]
    return [patch for own in sides for patch, _ in curved.surfaces(made.points, own)]


def _bounds(made: Made) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Yields for each layer its cells (t, corners), the sides (n, corners - 1) around them, and which
    of these are between it and a layer with a larger number.
    """
    for layer in np.unique(made.layer_of)[:-1]:
        cells = made.elements[made.layer_of == layer]
        sides = boundary(cells)
        inner = np.zeros(len(sides), dtype=bool)
        above = boundary(made.elements[made.layer_of > layer])
        inner[rows_among(above, sides)] = True
        if inner.any():
            yield cells, sides, inner


def _distance(part: Part, points: np.ndarray) -> np.ndarray:
    """Distances (n,) of points (n, axes) from the boundary of a region, of a box from its planes."""
    first, second = part.numbers
    if part.kind == "box":
        planes: np.ndarray = np.minimum(abs(points - first), abs(points - second)).min(axis=1)
        return planes
    if part.kind in ("ball", "cylinder"):
        arms = points - first if part.kind == "ball" else np.cross(points, first)
        radial: np.ndarray = abs(np.linalg.norm(arms, axis=1) - second)
        return radial
    plane: np.ndarray = abs((points - first) @ second) / np.linalg.norm(second)
    return plane
