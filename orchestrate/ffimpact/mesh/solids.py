"""Bodies in three dimensions: [[body]] tables (docs: scenes) as solids with signed distances,
their places and motions, SI units. y is up, z completes x and y.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from ..failure import BadInput
from ..geometry import outlines, tumbling
from ..input.models import Body, Mesh
from . import curved, solid_file
from .solid_mesh import MOST_CELLS, Sizes, SolidMesh, expected_cells, mesh_shape

__all__ = [
    "Shape",
    "Solid",
    "ball",
    "box",
    "cylinder",
    "distance_to_triangles",
    "distances_from",
    "mesh_of",
    "motion",
    "shape",
    "surface",
]

MADE = {
    "ball": lambda radius: ball(radius),
    "box": lambda *extent: box(np.array(extent)),
    "cylinder": lambda radius, height: cylinder(radius, height),
}
SAMPLES = 1500  # points on a surface where its shape is wanted as points
# share of the accuracy by which flat elements on its roundings may change the volume of a geometry
CUT = 0.25
AT_ONCE = 500_000  # pairs of a point and a triangle


@dataclass(frozen=True)
class Shape:
    """What a solid is, about its centre of volume and not turned."""

    kind: str  # ball, box, cylinder; surface of a mesh
    lengths: np.ndarray  # radius; width, height, depth; radius and height [m]
    extent: np.ndarray  # along x, y, z [m]
    volume: float  # [m3]
    area: float  # [m2]
    reach: float  # distance of its farthest point from the centre [m]
    moments: np.ndarray  # (3, 3), of inertia over the density, about the centre [m5]
    gap: Callable[
        [np.ndarray], np.ndarray
    ]  # signed distances (n,) of points (n, 3), negative inside
    sampled: Callable[
        [float], np.ndarray
    ]  # points (n, 3) on the surface, corners and edges included, about so far [m] apart
    is_mirrored: Callable[
        [np.ndarray], bool
    ]  # its own mirror image in the plane through its centre with this unit normal?


def ball(radius: float) -> Shape:
    volume, area = 4 / 3 * math.pi * radius**3, 4 * math.pi * radius**2

    def sampled(spacing: float) -> np.ndarray:
        """A spiral of points of equal shares, golden section turns apart, from the lowest
        to the highest.
        """
        n = max(20, round(area / spacing**2))
        y, turn = np.linspace(-1, 1, n), math.pi * (3 - math.sqrt(5)) * np.arange(n)
        away = np.sqrt(np.maximum(1 - y**2, 0))
        return radius * np.column_stack([away * np.cos(turn), y, away * np.sin(turn)])

    return Shape(
        "ball",
        np.array([radius]),
        np.full(3, 2 * radius),
        volume,
        area,
        radius,
        2 / 5 * volume * radius**2 * np.eye(3),
        lambda points: np.linalg.norm(points, axis=1) - radius,
        sampled,
        lambda normal: True,
    )


def box(extent: np.ndarray) -> Shape:
    (a, b, c), square, volume = extent, extent**2, float(np.prod(extent))

    def sampled(spacing: float) -> np.ndarray:
        along = [
            np.linspace(-half, half, 1 + max(2, math.ceil(2 * half / spacing)))
            for half in extent / 2
        ]
        faces = []
        for axis in range(3):
            sides = [one if k != axis else one[[0, -1]] for k, one in enumerate(along)]
            faces.append(np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3))
        return np.unique(np.vstack(faces), axis=0)

    return Shape(
        "box",
        extent,
        extent,
        volume,
        float(2 * (a * b + b * c + c * a)),
        float(np.linalg.norm(extent) / 2),
        volume / 12 * np.diag(square.sum() - square),
        lambda points: _outside(abs(points) - extent / 2),
        sampled,
        lambda normal: abs(normal).max() > 1 - 1e-12,
    )


def cylinder(radius: float, height: float) -> Shape:
    """Its axis is y."""
    volume, across = math.pi * radius**2 * height, (3 * radius**2 + height**2) / 12

    def gap(points: np.ndarray) -> np.ndarray:
        return _outside(
            np.column_stack(
                [np.hypot(points[:, 0], points[:, 2]) - radius, abs(points[:, 1]) - height / 2]
            )
        )

    def ring(radius: float, y: float, spacing: float) -> np.ndarray:
        turn = 2 * math.pi * np.arange(n := max(1, math.ceil(2 * math.pi * radius / spacing))) / n
        return np.column_stack([radius * np.cos(turn), np.full(n, y), radius * np.sin(turn)])

    def sampled(spacing: float) -> np.ndarray:
        side = np.linspace(-height / 2, height / 2, 1 + max(2, math.ceil(height / spacing)))
        inner = np.linspace(0, radius, 1 + max(2, math.ceil(radius / spacing)))[:-1]
        return np.vstack(
            [ring(radius, y, spacing) for y in side]
            + [ring(r, y, spacing) for r in inner for y in side[[0, -1]]]
        )

    return Shape(
        "cylinder",
        np.array([radius, height]),
        np.array([2 * radius, height, 2 * radius]),
        volume,
        2 * math.pi * radius * (radius + height),
        math.hypot(radius, height / 2),
        volume * np.diag([across, radius**2 / 2, across]),
        gap,
        sampled,
        lambda normal: abs(normal[1]) < 1e-12 or abs(normal[1]) > 1 - 1e-12,
    )


def _outside(beyond: np.ndarray) -> np.ndarray:
    """Signed distances (n,) of points that are `beyond` (n, k) [m] pairs of faces at right
    angles to each other.
    """
    return np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(beyond.max(axis=1), 0)


def surface(triangles: np.ndarray) -> Shape:
    """The boundary of a mesh of tetrahedra: triangles (t, 3, 3) of corners, counter-clockwise
    seen from outside.
    """
    (a, b, c), corners = triangles.transpose(1, 0, 2), np.unique(triangles.reshape(-1, 3), axis=0)
    low, high, six = corners.min(axis=0), corners.max(axis=0), (a * np.cross(b, c)).sum(axis=1)
    # the integral of x x^T over the tetrahedra between the centre and each triangle is 1/120 of six
    # times its volume times (s s^T + a a^T + b b^T + c c^T), s = a + b + c
    square = sum(np.einsum("t,ti,tj->ij", six, one, one) for one in (a + b + c, a, b, c)) / 120

    distances = distances_from(triangles)

    def gap(points: np.ndarray) -> np.ndarray:
        """The distance from the nearest triangle; inside, where they are seen under a full
        solid angle.
        """
        chunk = max(1, AT_ONCE // len(triangles))
        distance = np.concatenate(
            [distances(points[at : at + chunk]) for at in range(0, len(points), chunk)]
        )
        for at in np.array_split(
            boxed := np.flatnonzero(((points > low) & (points < high)).all(axis=1)),
            len(boxed) // chunk + 1,
        ):
            distance[at] *= np.where(_solid_angle(triangles, points[at]) > 2 * math.pi, -1, 1)
        return distance

    def sampled(spacing: float) -> np.ndarray:
        """Corners, and points of a grid in each triangle whose sides are longer than the
        spacing.
        """
        longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
        parts, found = np.ceil(longest / spacing).astype(int), [corners]
        for n in np.unique(parts[parts > 1]):
            i, j = np.array([(i, j) for i in range(n + 1) for j in range(n + 1 - i)]).T
            weights = np.column_stack([i, j, n - i - j]) / n
            found.append(np.einsum("pk,tkx->tpx", weights, triangles[parts == n]).reshape(-1, 3))
        return np.vstack(found)

    return Shape(
        "surface",
        np.array([]),
        high - low,
        float((a * np.cross(b, c)).sum() / 6),
        float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2),
        float(np.linalg.norm(corners, axis=1).max()),
        np.trace(square) * np.eye(3) - square,
        gap,
        sampled,
        lambda normal: False,
    )


def distances_from(triangles: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """The function that gives the distances (n,) of points (n, 3) from the nearest of the
    triangles (t, 3, 3).
    """
    centres = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - centres[:, None], axis=2).max()
    corners, within = cKDTree(triangles.reshape(-1, 3)), cKDTree(centres)

    def distances(points: np.ndarray) -> np.ndarray:
        # the nearest triangle is no farther than the nearest corner, its centre than that and the
        # radius
        near = within.query_ball_point(points, (1 + 1e-9) * (corners.query(points)[0] + radius))
        count = np.array([len(one) for one in near])
        found = distance_to_triangles(
            np.repeat(points, count, axis=0), triangles[np.concatenate(near).astype(int)]
        )
        return np.minimum.reduceat(found, np.cumsum(count) - count)

    return distances


def _solid_angle(triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Of all triangles, seen from points: 4 pi inside, 0 outside (van Oosterom and Strackee
    1983).
    """
    a, b, c = (triangles[:, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(one, axis=2) for one in (a, b, c))
    below = (
        la * lb * lc
        + (a * b).sum(axis=2) * lc
        + (b * c).sum(axis=2) * la
        + (c * a).sum(axis=2) * lb
    )
    return 2 * np.arctan2((a * np.cross(b, c)).sum(axis=2), below).sum(axis=1)


def distance_to_triangles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Distances (...) of points (..., 3) from triangles (..., 3, 3)."""
    a, b, c = (triangles[..., k, :] for k in range(3))

    def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return (u * v).sum(axis=-1)

    normal = np.cross(b - a, c - a)
    square = np.maximum(dot(normal, normal), np.finfo(float).tiny)
    inside = np.all(
        [dot(np.cross(q - p, points - p), normal) >= 0 for p, q in ((a, b), (b, c), (c, a))], axis=0
    )
    found = np.where(inside, abs(dot(points - a, normal)) / np.sqrt(square), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        s = np.clip(
            dot(points - p, q - p) / np.maximum(dot(q - p, q - p), np.finfo(float).tiny), 0, 1
        )
        found = np.minimum(found, np.linalg.norm(points - p - s[..., None] * (q - p), axis=-1))
    return found


@dataclass(frozen=True)
class Solid(outlines.Shape):
    """A shape with its centre of volume at `centre`, turned by the matrix `rotation`; where
    gmsh is to mesh a file, that `geometry`.
    """

    shape: Shape
    centre: np.ndarray
    rotation: np.ndarray
    geometry: solid_file.Geometry | None = None

    volume, extent, reach = (
        property(attrgetter(f"shape.{name}")) for name in ("volume", "extent", "reach")
    )
    area_centre = property(attrgetter("centre"))

    @property
    def disc(self) -> tuple[np.ndarray, float] | None:
        """Centre and radius of a ball, None for anything else."""
        return (self.centre, self.shape.reach) if self.shape.kind == "ball" else None

    @property
    def half_thickness(self) -> float:
        """What stands for the radius of a body that is no ball: half its smallest extent,
        or 3 volume / area where that is less.
        """
        return float(min(self.extent.min() / 2, 3 * self.volume / self.shape.area))

    def placed(self, centre: np.ndarray, rotation: np.ndarray) -> "Solid":
        return replace(self, centre=self.centre + centre, rotation=rotation @ self.rotation)

    def turned(self, turn: np.ndarray, spin: np.ndarray, t: float) -> np.ndarray:
        """The matrix at time t of a body that begins with a turn [rad] and a spin [rad/s]."""
        return tumbling.turned(self.shape.moments, tumbling.rotation(turn), spin, t)

    def fastest(self, turn: np.ndarray, spin: np.ndarray) -> float:
        """No spin [rad/s] is larger that a turned body comes to which begins with this one."""
        return tumbling.fastest(self.shape.moments, tumbling.rotation(turn), spin)

    def carried(self, moved: "Solid", points: np.ndarray) -> np.ndarray:
        """Points of this solid carried along to where it is moved."""
        return moved.centre + (points - self.centre) @ self.rotation @ moved.rotation.T

    @cached_property
    def points(self) -> np.ndarray:
        """Points on the surface."""
        return self.sampled(math.sqrt(self.shape.area / SAMPLES))

    def sampled(self, spacing: float) -> np.ndarray:
        return self.shape.sampled(spacing) @ self.rotation.T + self.centre

    def samples(self, size: float) -> tuple[np.ndarray, float]:
        """Points on the surface, twice as dense as elements of a size, and their distance [m]."""
        spacing = math.sqrt(
            self.shape.area / np.clip(4 * self.shape.area / size**2, SAMPLES, 20000)
        )
        return self.sampled(spacing), spacing

    def width(self, points: np.ndarray, spacing: float) -> float:
        """Of a patch with these of the samples; those of a mesh are denser where its faces
        are small.
        """
        count = len(points)
        if self.shape.kind == "surface":
            count = len(np.unique(np.floor(points / spacing), axis=0))
        return 2 * spacing * math.sqrt(max(2, count) / math.pi)

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points (n, 3), negative inside."""
        return self.shape.gap((points - self.centre) @ self.rotation)


# ---- meshes


def mesh_of(body, sizes: Sizes | None, folded: tuple[int, ...], accuracy: float) -> SolidMesh:
    """The mesh of a body (bodies.Body) about its centre of volume, turned as it is at the
    start: that of its file, or one with sizes, which are of the body not turned; of that what
    lies on the positive side of the planes across the axes `folded`.
    """
    solid = body.at(0.0, np.zeros(3))
    if body.mesh:
        return _with_curves(replace(body.mesh, points=body.mesh.points @ solid.rotation.T))
    expected = expected_cells(solid.volume, sizes) / 2 ** len(folded)
    if expected > MOST_CELLS:
        raise BadInput(
            f"mesh_size: '{body.name}' would have about {expected:.2g} tetrahedra (accepted: up to {MOST_CELLS}; larger "
            f"mesh_size, contact_mesh_size or accuracy)"
        )
    if solid.geometry:
        cut = CUT * accuracy * solid.volume / float(np.prod(solid.extent))
        made = solid.geometry.meshed(sizes, cut)
        centre = solid.geometry.centre if solid.disc else made.centre
        return _with_curves(replace(made, points=(made.points - centre) @ solid.rotation.T))
    return mesh_shape(
        solid.shape.kind,
        solid.shape.lengths,
        solid.rotation,
        folded,
        replace(sizes, near=sizes.near @ solid.rotation.T),
        solid.half_thickness,
    )


def _with_curves(made: SolidMesh) -> SolidMesh:
    """The same with the spheres and cylinders that it has."""
    return replace(made, curved=tuple(one for one, _ in curved.surfaces(made.points, made.faces)))


# ---- tables


def shape(body: Body, folder: Path) -> tuple[Solid, SolidMesh | None]:
    """The solid of a body about its centre of volume, and its mesh where a file brings it."""
    if isinstance(body, Mesh):
        return _of_file(body, folder)
    return Solid(MADE[body.shape](*body.sizes), np.zeros(3), np.eye(3)), None


def _of_file(body: Mesh, folder: Path) -> tuple[Solid, SolidMesh | None]:
    name, scale = body.file, body.scale or 1.0
    if not name:
        raise BadInput(
            f"{body.at('file')}: is missing (accepted: {', '.join(solid_file.MESHES + solid_file.GEOMETRIES)})"
        )
    path = folder / name
    try:
        found = solid_file.read(path).scaled(scale)
    except BadInput as error:
        raise BadInput(f"{body.at('file')}: {error}") from None
    sphere = next(
        (
            one
            for one, own in curved.surfaces(found.points, found.faces)
            if not len(one.axis) and len(own) == len(found.faces)
        ),
        None,
    )
    centre = sphere.centre if sphere else found.centre
    centred = found.moved(-centre)
    shape = ball(sphere.radius) if sphere else surface(centred.points[centred.faces])
    if solid_file.is_geometry(path):
        geometry = solid_file.Geometry(path, scale, centre, centred)
        return Solid(shape, np.zeros(3), np.eye(3), geometry), None
    return Solid(shape, np.zeros(3), np.eye(3)), centred


def motion(body: Body) -> dict:
    """Where a body is at the start and how it moves: position [m], turn [rad], velocity [m/s],
    spin [rad/s], vectors (3,).
    """
    if body.angle is not None and body.turn is not None:
        raise BadInput(
            f"{body.at('angle')}: '{body.given('angle')}' stands beside turn (accepted: angle about z, or turn = "
            f"[x, y, z])"
        )
    none = [0.0, 0.0, 0.0]
    turn = [0.0, 0.0, body.angle] if body.angle is not None else body.turn or none
    return {
        "position": np.array(body.position),
        "angle": np.radians(turn),
        "velocity": np.array(body.velocity or none),
        "spin": np.array(body.spin or none),
    }
