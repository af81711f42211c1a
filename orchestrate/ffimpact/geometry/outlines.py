"""Outlines in the plane: closed curves, their areas and centres, and signed distances from them.

Points are arrays (n, 2) in m.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from .limits import SHORTEST

__all__ = [
    "Loop",
    "Outline",
    "Shape",
    "TubeOutline",
    "circle_loop",
    "cross",
    "ellipse_loop",
    "folding",
    "normal_of",
    "polygon_centre",
    "polygon_loop",
    "rotation",
    "self_crossing",
    "signed_area",
]

SAMPLES = 400  # approximate number of sides of the polygon that represents a loop
CHUNK = 500  # number of sides that are compared with all other sides in one array operation
# Largest and smallest number of points on an outline for the search of contact.
FINEST = 4000
COARSEST = 400
# Gaps whose difference is at most FLUSH times the bounding radius belong to one face that lies flat
# on the other surface.
FLUSH = 1e-6
# The orientation of a body, or its change: an angle [rad] in the plane, in three dimensions a
# rotation vector (3,) [rad] or a matrix (3, 3).
Turn = Any


@dataclass(frozen=True)
class Loop:
    """A closed counter-clockwise curve: a polygon, an ellipse, or a chain of lines and arcs.

    Segment k leads from corner k of `corners` (n, 2) [m] to the next corner. It is an arc if row k
    of `arc_centres` (n, 2) [m] contains the centre of an arc, and straight if the row is nan. If
    `semi_axes` (2,) [m] is set, the loop is an ellipse, and the four corners are its extreme points
    (right, top, left, bottom).
    """

    corners: np.ndarray
    semi_axes: np.ndarray | None = None
    arc_centres: np.ndarray | None = None

    @property
    def centre(self) -> np.ndarray:
        """The mean of the corners, which is the centre of an ellipse."""
        mean: np.ndarray = self.corners.mean(axis=0)
        return mean

    @property
    def radius(self) -> float | None:
        """The radius [m] of a circle; None for all other loops."""
        if self.semi_axes is None or self.semi_axes[0] != self.semi_axes[1]:
            return None
        return float(self.semi_axes[0])

    @property
    def circles(self) -> list[tuple[np.ndarray, float]]:
        """Centres (2,) and radii [m] of the circles on which segments lie, each circle once."""
        if self.radius:
            return [(self.centre, self.radius)]
        _, centres, first, *_ = self._arcs
        radii = np.linalg.norm(first, axis=1)
        _, once = np.unique(
            np.column_stack([centres, np.round(radii / radii.max(initial=0.0), 6)]),
            axis=0,
            return_index=True,
        )
        return [(centres[k], float(radii[k])) for k in once]

    @cached_property
    def _arcs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The arcs: numbers of the segments, centres, radius vectors of both ends (arcs, 2), angles.

        The angles (arcs,) [rad] from the first to the second vector are positive counter-clockwise.
        """
        all_centres = np.full(self.corners.shape, np.nan)
        if self.arc_centres is not None:
            all_centres = self.arc_centres
        which = np.flatnonzero(~np.isnan(all_centres[:, 0]))
        centres, following = all_centres[which], np.roll(self.corners, -1, axis=0)
        a, b = self.corners[which] - centres, following[which] - centres
        return which, centres, a, b, np.arctan2(cross(a, b), (a * b).sum(axis=1))

    def at(self, piece: int, s: np.ndarray) -> np.ndarray:
        """Points (n, 2) of segment `piece` at the parameters s (n,) in [0, 1].

        At s = 0 the point is the first corner, exactly in a loop without arcs, else to round-off.
        """
        a, b = self.corners[piece], self.corners[(piece + 1) % len(self.corners)]
        which, centres, first, last, angles = self._arcs
        points: np.ndarray
        if len(k := np.flatnonzero(which == piece)):
            turn = angles[k[0]]
            along = np.sin(np.outer(1 - s, turn)) * first[k] + np.sin(np.outer(s, turn)) * last[k]
            points = centres[k] + along / np.sin(turn)
        elif self.semi_axes is None:
            points = a + s[:, None] * (b - a)
        else:
            # An ellipse is an affine image of a circle with the conjugate radii a - c and b - c.
            c, turn = self.centre, np.pi / 2 * s[:, None]
            points = c + np.cos(turn) * (a - c) + np.sin(turn) * (b - c)
        return points

    def sampled(self, spacing: float) -> np.ndarray:
        """The loop as a polygon (n, 2) with all corners and sides of up to about `spacing` [m]."""
        # 1e-9 keeps round-off from adding a point
        counts = [max(1, int(np.ceil(length / spacing - 1e-9))) for length in self.lengths]
        return np.vstack([self.at(k, np.arange(n) / n) for k, n in enumerate(counts)])

    @cached_property
    def lengths(self) -> np.ndarray:
        """The lengths (n,) [m] of the segments; for an ellipse to a relative 1e-6."""
        s = np.linspace(0, 1, 2 if self.semi_axes is None and self.arc_centres is None else 1001)
        return np.array(
            [
                np.linalg.norm(np.diff(self.at(k, s), axis=0), axis=1).sum()
                for k in range(len(self.corners))
            ]
        )

    @cached_property
    def polygon(self) -> np.ndarray:
        """The loop as a polygon (n, 2) of about SAMPLES sides that contains all corners."""
        return self.sampled(self.lengths.sum() / SAMPLES)

    @property
    def sides(self) -> np.ndarray:
        """The corners (n, 2) of a polygon; for other loops the polygon of about SAMPLES sides."""
        return self.corners if self.semi_axes is None and self.arc_centres is None else self.polygon

    @property
    def area(self) -> float:
        """The enclosed area [m2], positive."""
        if self.semi_axes is not None:
            return float(np.pi * np.prod(self.semi_axes))
        return signed_area(self.corners) + float(self._segments[0].sum())

    @property
    def _segments(self) -> tuple[np.ndarray, np.ndarray]:
        """Areas (arcs,) [m2] between arcs and chords, and their first moments (arcs, 2) [m3].

        The moments are about the centres of the arcs. With the radius vectors a and b of the ends
        and the angle t between them, the moment of the sector is a x b (a + b) / (3 (1 + cos t)),
        that of its triangle a x b (a + b) / 6.
        """
        *_, a, b, turn = self._arcs
        square = cross(a, b)
        return (turn * (a**2).sum(axis=1) - square) / 2, (
            square * (1 / (3 + 3 * np.cos(turn)) - 1 / 6)
        )[:, None] * (a + b)

    @property
    def area_centre(self) -> np.ndarray:
        """The centroid (2,) [m] of the enclosed area."""
        if self.semi_axes is not None:
            return self.centre
        areas, moments = self._segments
        if not len(areas):
            return polygon_centre(self.corners)
        moment: np.ndarray = (
            signed_area(self.corners) * polygon_centre(self.corners)
            + moments.sum(axis=0)
            + areas @ self._arcs[1]
        )
        return moment / self.area

    def placed(self, centre: np.ndarray, angle: float) -> "Loop":
        """The loop, turned counter-clockwise about the origin by angle [rad], moved by `centre`.

        A turned ellipse remains an ellipse.
        """
        turn = rotation(angle).T
        loop = replace(
            self,
            corners=self.corners @ turn + centre,
            arc_centres=None if self.arc_centres is None else self.arc_centres @ turn + centre,
        )
        loop.__dict__["lengths"] = self.lengths  # independent of the position: not computed again
        return loop

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m] of points (n, 2) from the loop, negative inside."""
        if self.radius:
            distance: np.ndarray = np.linalg.norm(points - self.centre, axis=1) - self.radius
            return distance
        import shapely  # imported here: circles do not need it

        distance = shapely.distance(shapely.LinearRing(self.sides), shapely.points(points))
        inside = shapely.contains_xy(shapely.Polygon(self.sides), *points.T)
        signed: np.ndarray = np.where(inside, -distance, distance)
        return signed


def polygon_loop(corners: np.ndarray, arc_centres: np.ndarray | None = None) -> Loop:
    """The loop through the corners (n, 2), along arcs about `arc_centres`, made counter-clockwise."""
    if signed_area(corners) > 0:
        return Loop(corners, arc_centres=arc_centres)
    return Loop(
        corners[::-1],
        arc_centres=None if arc_centres is None else np.roll(arc_centres[::-1], -1, axis=0),
    )


def ellipse_loop(a: float, b: float) -> Loop:
    """The ellipse about the origin with the semi-axes a along x and b along y [m]."""
    return Loop(np.array([[a, 0.0], [0.0, b], [-a, 0.0], [0.0, -b]]), np.array([a, b]))


def circle_loop(radius: float) -> Loop:
    """The circle about the origin with a radius [m]."""
    return ellipse_loop(radius, radius)


class Shape(ABC):
    """The common base of outlines in the plane and of solids."""

    @property
    @abstractmethod
    def points(self) -> np.ndarray:
        """Points (n, axes) [m] on the boundary."""

    @property
    @abstractmethod
    def content(self) -> float:
        """The area [m2] of an outline, the volume [m3] of a solid."""

    @property
    @abstractmethod
    def area_centre(self) -> np.ndarray:
        """The centroid (axes,) [m] of the area or volume."""

    @property
    @abstractmethod
    def extent(self) -> np.ndarray:
        """The lengths (axes,) [m] along the axes."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """The bounding radius [m] about the centroid."""

    @property
    @abstractmethod
    def half_thickness(self) -> float:
        """The length [m] that replaces the radius for a body that is not a disc or ball."""

    @property
    @abstractmethod
    def coarsest(self) -> float:
        """The largest automatic element size [m]."""

    @property
    @abstractmethod
    def disc(self) -> tuple[np.ndarray, float] | None:
        """The centre and radius [m] of a disc or ball; None for other shapes."""

    @abstractmethod
    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m] of points (n, axes), negative inside."""

    @abstractmethod
    def placed(self, centre: np.ndarray, turn: Turn) -> Self:
        """The shape, turned about the origin and then moved by `centre` (axes,) [m]."""

    @abstractmethod
    def turned(self, turn: Turn, spin: Turn, t: float) -> Turn:
        """The turn at time t [s] of a body, from that at t = 0 and its spin [rad/s]."""

    @abstractmethod
    def fastest(self, turn: Turn, spin: Turn) -> float:
        """An upper bound of the angular velocity [rad/s]; arguments as of `turned`."""

    @abstractmethod
    def carried(self, moved: Self, points: np.ndarray) -> np.ndarray:
        """Points (n, axes) of this shape after the rigid motion that takes it to `moved`."""

    @abstractmethod
    def samples(self, size: float) -> tuple[np.ndarray, float]:
        """Points (n, axes) on the boundary and their spacing [m], half an element of a size [m]."""

    @abstractmethod
    def width(self, points: np.ndarray, spacing: float) -> float:
        """The width [m] of a part of the boundary that contains these samples."""

    def least(self, gap: Callable[[np.ndarray], np.ndarray]) -> float:
        """The least value [m] of a distance function on the shape.

        For a disc or ball the value is exact; for other shapes it is the minimum over `points`.
        """
        return float(
            gap(self.disc[0][None])[0] - self.disc[1] if self.disc else gap(self.points).min()
        )

    def normal_from(self, other: Any) -> np.ndarray:
        """The outward normal (axes,) of another body or obstacle where this shape is closest."""
        if not getattr(other, "is_exact", True):
            _, normal = other.nearest(self)
            return np.asarray(normal)
        if self.disc:
            return normal_of(other.gap, self.disc[0])
        if getattr(other, "disc", None):
            return -normal_of(self.gap, other.disc[0])
        gaps = other.gap(self.points)
        # If a face lies flat on the other surface, the point next to its middle defines the normal.
        touching = self.points[gaps <= gaps.min() + FLUSH * self.reach]
        middle = np.linalg.norm(touching - touching.mean(axis=0), axis=1).argmin()
        return normal_of(other.gap, touching[middle])


@dataclass(frozen=True)
class Outline(Shape):
    """The boundary of a body: the outer loop first, then the loops of the holes."""

    loops: tuple[Loop, ...]

    @property
    def area(self) -> float:
        return self.loops[0].area - sum(hole.area for hole in self.loops[1:])

    @property
    def content(self) -> float:
        return self.area

    @property
    def area_centre(self) -> np.ndarray:
        outer, *holes = self.loops
        moment: np.ndarray = outer.area * outer.area_centre
        moment = moment - sum(hole.area * hole.area_centre for hole in holes)
        return moment / self.area

    @property
    def length(self) -> float:
        return float(sum(loop.lengths.sum() for loop in self.loops))

    @cached_property
    def points(self) -> np.ndarray:
        """Points (n, 2) [m] on all loops."""
        return np.vstack([loop.polygon for loop in self.loops])

    @property
    def extent(self) -> np.ndarray:
        """Width and height (2,) [m] of the outer loop: of a tube, of the section of its wall."""
        lengths: np.ndarray = np.ptp(self.loops[0].polygon, axis=0)
        return lengths

    @cached_property
    def reach(self) -> float:
        return float(np.linalg.norm(self.loops[0].polygon - self.area_centre, axis=1).max())

    @cached_property
    def gyration(self) -> float:
        """The squared radius of gyration [m2] about the centroid, from the loops as polygons."""
        first, moments, areas = [loop.polygon - self.area_centre for loop in self.loops], [], []
        for a, b in ((polygon, np.roll(polygon, -1, axis=0)) for polygon in first):
            areas.append(cross(a, b).sum() / 2)
            moments.append((cross(a, b) * (a * a + a * b + b * b).sum(axis=1)).sum() / 12)
        return float((moments[0] - sum(moments[1:])) / (areas[0] - sum(areas[1:])))

    @property
    def half_thickness(self) -> float:
        """The smaller of half the smaller extent and 2 area / length of the boundary, which is the
        radius of a disc and the wall thickness of a ring.
        """
        return float(min(self.extent.min() / 2, 2 * self.area / self.length))

    @property
    def coarsest(self) -> float:
        """The largest automatic element size [m]: two elements across a slender body or the wall of
        a ring, four across a disc or a square.
        """
        return float(min(self.extent.min() / 2, self.area / self.length))

    def placed(self, centre: np.ndarray, turn: Turn) -> Self:
        outline = replace(self, loops=tuple(loop.placed(centre, turn) for loop in self.loops))
        outline.__dict__["reach"] = self.reach  # independent of the position: not computed again
        return outline

    def turned(self, turn: Turn, spin: Turn, t: float) -> Turn:
        return turn + spin * t

    def fastest(self, turn: Turn, spin: Turn) -> float:
        return abs(float(spin))  # constant in the plane

    def carried(self, moved: Self, points: np.ndarray) -> np.ndarray:
        a, b = self.loops[0].corners[:2]
        c, d = moved.loops[0].corners[:2]
        turn = complex(*(d - c)) / complex(*(b - a))
        matrix = np.array([[turn.real, -turn.imag], [turn.imag, turn.real]])
        carried: np.ndarray = c + (points - a) @ matrix.T
        return carried

    def samples(self, size: float) -> tuple[np.ndarray, float]:
        """Two points per element. Their number is limited to the range from COARSEST to FINEST."""
        spacing = self.length / np.clip(2 * self.length / size, COARSEST, FINEST)
        return np.vstack([loop.sampled(spacing) for loop in self.loops]), spacing

    def width(self, points: np.ndarray, spacing: float) -> float:
        """The length [m] of a stretch of the outline that contains these samples."""
        return (max(2, len(points)) - 1) * spacing

    def folding(self, revolved: bool = False) -> float:
        """A lower estimate of the bending strain at which the body comes into contact with itself.

        It is infinite if no two parts of the outline face each other. `revolved`: the outline is
        the section of a body of revolution, and only parts on one side of the axis are compared.
        """
        return min(
            folding(loop.polygon[:: 1 if k == 0 else -1], self.half_thickness, revolved)
            for k, loop in enumerate(self.loops)
        )

    @property
    def disc(self) -> tuple[np.ndarray, float] | None:
        outer, *holes = self.loops
        return (outer.centre, outer.radius) if outer.radius and not holes else None

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m]: negative in the material, positive outside and in the holes."""
        outer, *holes = self.loops
        distance: np.ndarray = np.max(
            [outer.gap(points), *(-hole.gap(points) for hole in holes)], axis=0
        )
        return distance


@dataclass(frozen=True)
class TubeOutline(Outline):
    """The section of a body of revolution that does not reach the axis.

    `loops` contains the loop to the right of the axis and its mirror image.
    """

    @property
    def area(self) -> float:
        """The area [m2] of both loops."""
        return sum(loop.area for loop in self.loops)

    @property
    def area_centre(self) -> np.ndarray:
        """The centroid (2,) [m] of both loops, on the axis."""
        first, second = self.loops
        middle: np.ndarray = (first.area_centre + second.area_centre) / 2
        return middle

    @property
    def disc(self) -> None:
        """None, because a tube is not a ball."""
        return None

    def folding(self, revolved: bool = False) -> float:
        """The estimate of `Outline.folding`, for the right loop alone."""
        return folding(self.loops[0].polygon, self.half_thickness, revolved)

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m] of points (n, 2) from the nearer loop."""
        distance: np.ndarray = np.min([loop.gap(points) for loop in self.loops], axis=0)
        return distance


def normal_of(gap: Callable[[np.ndarray], np.ndarray], point: np.ndarray) -> np.ndarray:
    """The outward normal (axes,) at a point (axes,) of a surface with these signed distances.

    The normal is the gradient of the signed distance, from central differences of fourth order,
    rounded to eight decimals. It is 0 where the gradient vanishes.
    """
    h = max(1e-7 * np.abs(point).max(), 1e-3 * abs(gap(point[None])[0]), SHORTEST)
    axes = np.eye(len(point))
    slope = [(gap(point + k * h * axes) - gap(point - k * h * axes)) / (2 * k * h) for k in (1, 2)]
    normal = np.round((4 * slope[0] - slope[1]) / 3, 8)  # Richardson: fourth order
    unit: np.ndarray = normal / max(float(np.linalg.norm(normal)), 0.5)
    return unit


# ---- polygons: corners (n, 2) [m], closed from the last corner to the first


def rotation(angle: float) -> np.ndarray:
    """The matrix (2, 2) of a counter-clockwise rotation by angle [rad]."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The cross product a_x b_y - a_y b_x (...) of vectors (..., 2)."""
    product: np.ndarray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def signed_area(corners: np.ndarray) -> float:
    """The area [m2] of a polygon (n, 2), positive if its corners are counter-clockwise."""
    local = corners - corners[0]  # keeps the digits of polygons far from the origin
    return float(cross(local, np.roll(local, -1, axis=0)).sum() / 2)


def polygon_centre(corners: np.ndarray) -> np.ndarray:
    """The centroid (2,) [m] of the area of a polygon (n, 2)."""
    a = corners - corners[0]
    b = np.roll(a, -1, axis=0)
    moment = ((a + b) * cross(a, b)[:, None]).sum(axis=0)
    centroid: np.ndarray = corners[0] + moment / (6 * signed_area(corners))
    return centroid


def folding(corners: np.ndarray, thickness: float, revolved: bool) -> float:
    """The least thickness * s / w^2 over pairs of sides of a polygon that face each other.

    `corners` (n, 2) [m] have the body to the left. s [m] is the distance of the two sides across
    empty space, w [m] the arc length between them along the polygon; equation (a) of pair.idp tells
    which sides face each other. The value estimates the bending strain of a wall that closes the
    distance s; for a ring it is 0.2 thickness / radius. A convex polygon returns infinity.
    `revolved`: only sides to the right of the axis x = 0 are compared.
    """
    along = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(along, axis=1)
    if (cross(along, np.roll(along, -1, axis=0)) >= -1e-9 * length * np.roll(length, -1)).all():
        return math.inf  # the polygon is convex
    middle, normal, arc_position = (
        corners + along / 2,
        along @ [[0, -1], [1, 0]] / length[:, None],
        np.cumsum(length) - length / 2,
    )
    least = math.inf
    for at in range(0, len(corners), CHUNK):
        some = slice(at, at + CHUNK)
        to = middle - middle[some, None]
        distance, arc_length = (
            np.linalg.norm(to, axis=2),
            np.abs(arc_position - arc_position[some, None]),
        )
        ahead, behind = (to * normal[some, None]).sum(axis=2), (to * normal).sum(axis=2)
        sees = (np.minimum(ahead, -behind) > 1e-9 * distance) & (
            normal[some] @ normal.T < math.cos(math.radians(80))
        )
        if revolved:
            sees &= (middle[some, None, 0] > 0) & (middle[:, 0] > 0)
        least = min(
            least,
            (
                thickness
                * distance[sees]
                / np.minimum(arc_length, length.sum() - arc_length)[sees] ** 2
            ).min(initial=math.inf),
        )
    return float(least)


def self_crossing(corners: np.ndarray) -> tuple[int, int] | None:
    """The numbers of two sides of a polygon (n, 2), from 0, that cross, touch or fold back.

    Neighbouring sides may touch at their common corner. Returns None for a simple polygon.
    """
    import shapely

    n, sides = (
        len(corners),
        shapely.linestrings(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)),
    )
    for i, j in sorted(shapely.STRtree(sides).query(sides, predicate="intersects").T.tolist()):
        if (j - i) % n not in (0, 1, n - 1):
            return int(min(i, j)), int(max(i, j))
    along = np.roll(corners, -1, axis=0) - corners
    ahead = np.roll(along, -1, axis=0)
    folded = (cross(along, ahead) == 0) & ((along * ahead).sum(axis=1) <= 0)
    return (int(np.argmax(folded)), int((np.argmax(folded) + 1) % n)) if folded.any() else None
