"""Bodies in three dimensions: solids with signed distances, positions, motions and meshes.

Units are SI. y points up; x, y and z are right-handed.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np
import scipy

from ..failure import BadInput
from ..geometry import outlines, tumbling
from ..geometry.outlines import Turn
from . import curved, given, solid_file
from .mesh import Sizes
from .solid_mesh import MOST_CELLS, SolidMesh, expected_cells, mesh_shape

if TYPE_CHECKING:
    from ..input.conditions import Part
    from ..input.shapes import Mesh

__all__ = [
    "Shape",
    "Solid",
    "ball",
    "box",
    "cylinder",
    "distance_to_triangles",
    "distances_from",
    "file_solid",
    "mesh_of",
    "shell",
    "surface",
    "tube",
]

SAMPLES = 1500  # smallest number of points that represent a surface
# Largest relative change of the volume of a geometry by flat elements on its roundings, relative to
# the accuracy.
CUT = 0.25
AT_ONCE = 500_000  # largest number of pairs (point, triangle) in one array operation


@dataclass(frozen=True)
class Shape:
    """The shape of a solid, about its centre of volume and not rotated."""

    kind: str  # ball, shell, box, cylinder, tube, or surface (of a mesh)
    # [m], as of solid_mesh.mesh_shape(); empty for a surface
    lengths: np.ndarray
    extent: np.ndarray  # (3,), along x, y, z [m]
    volume: float  # [m3]
    area: float  # of the surface [m2]
    reach: float  # bounding radius about the centre [m]
    moments: np.ndarray  # (3, 3), matrix of inertia about the centre over the density [m5]
    # signed distances (n,) [m] of points (n, 3), negative inside
    gap: Callable[[np.ndarray], np.ndarray]
    # points (n, 3) on the surface, with corners and edges, for a spacing [m]
    sampled: Callable[[float], np.ndarray]
    # whether the shape is symmetric about the plane through its centre with a unit normal (3,)
    is_mirrored: Callable[[np.ndarray], bool]


def ball(radius: float) -> Shape:
    volume, area = 4 / 3 * math.pi * radius**3, 4 * math.pi * radius**2

    def sampled(spacing: float) -> np.ndarray:
        """Points (n, 3) of a golden-angle spiral from the lowest to the highest point.

        Each point represents the same area.
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
            sides = [line if k != axis else line[[0, -1]] for k, line in enumerate(along)]
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
    """The shape of a cylinder with the axis y; radius and height in m."""
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


def shell(radius: float, inner: float) -> Shape:
    """The shape of a hollow ball; outer and inner radius in m."""
    return _hollow(
        "shell",
        np.array([radius, inner]),
        ball(radius),
        ball(inner),
        lambda points: _outside(
            abs(np.linalg.norm(points, axis=1) - (radius + inner) / 2)[:, None]
            - (radius - inner) / 2
        ),
    )


def tube(radius: float, inner: float, height: float) -> Shape:
    """The shape of a tube with the axis y; outer and inner radius and height in m."""
    made = _hollow(
        "tube",
        np.array([radius, inner, height]),
        cylinder(radius, height),
        cylinder(inner, height),
        lambda points: _outside(
            np.column_stack(
                [
                    abs(np.hypot(points[:, 0], points[:, 2]) - (radius + inner) / 2)
                    - (radius - inner) / 2,
                    abs(points[:, 1]) - height / 2,
                ]
            )
        ),
    )
    # The ends of the two cylinders are not on the surface: their difference is.
    return replace(made, area=2 * math.pi * (radius + inner) * (height + radius - inner))


def _hollow(
    kind: str,
    lengths: np.ndarray,
    outer: Shape,
    inner: Shape,
    gap: Callable[[np.ndarray], np.ndarray],
) -> Shape:
    """The shape between `outer` and `inner`, which have the same centre and symmetries."""

    def sampled(spacing: float) -> np.ndarray:
        points = np.vstack([outer.sampled(spacing), inner.sampled(spacing)])
        return points[abs(gap(points)) <= 1e-9 * outer.reach]

    return replace(
        outer,
        kind=kind,
        lengths=lengths,
        volume=outer.volume - inner.volume,
        area=outer.area + inner.area,
        moments=outer.moments - inner.moments,
        gap=gap,
        sampled=sampled,
    )


def _outside(beyond: np.ndarray) -> np.ndarray:
    """Signed distances (n,) [m] of points from a solid between k orthogonal pairs of faces.

    `beyond` (n, k) [m] is the distance of each point beyond each pair, negative between its faces.
    """
    distance: np.ndarray = np.linalg.norm(np.maximum(beyond, 0), axis=1) + np.minimum(
        beyond.max(axis=1), 0
    )
    return distance


def surface(triangles: np.ndarray) -> Shape:
    """The shape bounded by a closed surface of triangles.

    `triangles` (t, 3, 3) [m] contains the corners, counter-clockwise seen from outside.
    """
    (a, b, c), corners = triangles.transpose(1, 0, 2), np.unique(triangles.reshape(-1, 3), axis=0)
    low, high, six = corners.min(axis=0), corners.max(axis=0), (a * np.cross(b, c)).sum(axis=1)
    # The integral of x x^T over the tetrahedron of volume V between the centre and a triangle
    # (a, b, c) is 6 V / 120 (s s^T + a a^T + b b^T + c c^T) with s = a + b + c.
    square = (
        sum(np.einsum("t,ti,tj->ij", six, vector, vector) for vector in (a + b + c, a, b, c)) / 120
    )

    distances = distances_from(triangles)

    def gap(points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m] of points (n, 3) from the nearest triangle.

        A point is inside if the solid angle of all triangles exceeds 2 pi.
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
        """The corners, and a grid of points in each triangle that is larger than the spacing."""
        longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
        parts, samples = np.ceil(longest / spacing).astype(int), [corners]
        for n in np.unique(parts[parts > 1]):
            i, j = np.array([(i, j) for i in range(n + 1) for j in range(n + 1 - i)]).T
            weights = np.column_stack([i, j, n - i - j]) / n
            samples.append(np.einsum("pk,tkx->tpx", weights, triangles[parts == n]).reshape(-1, 3))
        return np.vstack(samples)

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
    """Returns a function for the distances (n,) [m] of points (n, 3) from triangles (t, 3, 3).

    The distance of a point is that of the nearest triangle.
    """
    centres = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - centres[:, None], axis=2).max()
    corners, within = (
        scipy.spatial.cKDTree(triangles.reshape(-1, 3)),
        scipy.spatial.cKDTree(centres),
    )

    def distances(points: np.ndarray) -> np.ndarray:
        # The nearest triangle is no farther than the nearest corner. So its centre is no farther
        # than the nearest corner plus the largest radius of a triangle.
        near = within.query_ball_point(points, (1 + 1e-9) * (corners.query(points)[0] + radius))
        count = np.array([len(candidates) for candidates in near])
        distance = distance_to_triangles(
            np.repeat(points, count, axis=0), triangles[np.concatenate(near).astype(int)]
        )
        return np.minimum.reduceat(distance, np.cumsum(count) - count)

    return distances


def _solid_angle(triangles: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The solid angle (n,) of all triangles (t, 3, 3), seen from points (n, 3).

    It is 4 pi inside and 0 outside (van Oosterom and Strackee 1983).
    """
    a, b, c = (triangles[:, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(vector, axis=2) for vector in (a, b, c))
    below = (
        la * lb * lc
        + (a * b).sum(axis=2) * lc
        + (b * c).sum(axis=2) * la
        + (c * a).sum(axis=2) * lb
    )
    angle: np.ndarray = 2 * np.arctan2((a * np.cross(b, c)).sum(axis=2), below).sum(axis=1)
    return angle


def distance_to_triangles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The unsigned distances (...) [m] of points (..., 3) from triangles (..., 3, 3)."""
    a, b, c = (triangles[..., k, :] for k in range(3))

    def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        product: np.ndarray = (u * v).sum(axis=-1)
        return product

    normal = np.cross(b - a, c - a)
    square = np.maximum(dot(normal, normal), np.finfo(float).tiny)
    inside = np.all(
        [dot(np.cross(q - p, points - p), normal) >= 0 for p, q in ((a, b), (b, c), (c, a))], axis=0
    )
    distance = np.where(inside, abs(dot(points - a, normal)) / np.sqrt(square), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        s = np.clip(
            dot(points - p, q - p) / np.maximum(dot(q - p, q - p), np.finfo(float).tiny), 0, 1
        )
        distance = np.minimum(
            distance, np.linalg.norm(points - p - s[..., None] * (q - p), axis=-1)
        )
    return distance


@dataclass(frozen=True)
class Solid(outlines.Shape):
    """A shape with its centre of volume at `centre` (3,) [m], turned by the matrix `rotation`.

    `geometry` is set if gmsh meshes the geometry of a file.
    """

    shape: Shape
    centre: np.ndarray
    rotation: np.ndarray
    geometry: solid_file.Geometry | None = None

    @property
    def volume(self) -> float:
        return self.shape.volume

    @property
    def content(self) -> float:
        return self.shape.volume

    @property
    def extent(self) -> np.ndarray:
        return self.shape.extent

    @property
    def reach(self) -> float:
        return self.shape.reach

    @property
    def area_centre(self) -> np.ndarray:
        return self.centre

    @property
    def disc(self) -> tuple[np.ndarray, float] | None:
        """The centre (3,) and outer radius [m] of a ball or shell; None for all other solids."""
        return (self.centre, self.shape.reach) if self.shape.kind in ("ball", "shell") else None

    @property
    def half_thickness(self) -> float:
        """The smaller of half the smallest extent and 3 volume / area."""
        return float(min(self.extent.min() / 2, 3 * self.volume / self.shape.area))

    @property
    def coarsest(self) -> float:
        """The largest automatic element size [m]: two elements across a slender body or the wall of
        a shell, four across a ball or a cube.
        """
        return float(min(self.extent.min() / 2, 1.5 * self.volume / self.shape.area))

    def placed(self, centre: np.ndarray, turn: Turn) -> Self:
        return replace(self, centre=self.centre + centre, rotation=turn @ self.rotation)

    def turned(self, turn: Turn, spin: Turn, t: float) -> Turn:
        """The rotation matrix (3, 3), from a rotation vector `turn`."""
        return tumbling.turned(self.shape.moments, tumbling.rotation(turn), spin, t)

    def fastest(self, turn: Turn, spin: Turn) -> float:
        return tumbling.fastest(self.shape.moments, tumbling.rotation(turn), spin)

    def carried(self, moved: Self, points: np.ndarray) -> np.ndarray:
        carried: np.ndarray = (
            moved.centre + (points - self.centre) @ self.rotation @ moved.rotation.T
        )
        return carried

    @cached_property
    def points(self) -> np.ndarray:
        """Points (n, 3) [m] on the surface."""
        return self.sampled(math.sqrt(self.shape.area / SAMPLES))

    def sampled(self, spacing: float) -> np.ndarray:
        points: np.ndarray = self.shape.sampled(spacing) @ self.rotation.T + self.centre
        return points

    def samples(self, size: float) -> tuple[np.ndarray, float]:
        """Points (n, 3) on the surface and their spacing [m], half an element of a size [m].

        The spacing is limited so that the number of points is about SAMPLES to 20000.
        """
        spacing = math.sqrt(
            self.shape.area / np.clip(4 * self.shape.area / size**2, SAMPLES, 20000)
        )
        return self.sampled(spacing), spacing

    def width(self, points: np.ndarray, spacing: float) -> float:
        """The diameter [m] of a disc with the area of a patch that contains these samples.

        Samples of a mesh are denser where its faces are small, so they are counted once per cube of
        the spacing.
        """
        count = len(points)
        if self.shape.kind == "surface":
            count = len(np.unique(np.floor(points / spacing), axis=0))
        return 2 * spacing * math.sqrt(max(2, count) / math.pi)

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) [m] of points (n, 3), negative inside."""
        return self.shape.gap((points - self.centre) @ self.rotation)


# ---- meshes


def mesh_of(
    name: str,
    solid: Solid,
    made: SolidMesh | None,
    sizes: Sizes | None,
    mirror_axes: tuple[int, ...],
    accuracy: float,
    parts: Sequence["Part"] = (),
) -> SolidMesh:
    """The mesh of the body `name` about its centre of volume, turned as at the start.

    The mesh is that of the body's file, `made`, or gmsh generates one with the element sizes `sizes`, which
    refer to the body before its rotation. `mirror_axes` contains the axes that are normal to planes of
    symmetry: only the part on the positive side of these planes is meshed, with faces on the boundaries of the regions
    `parts` of layers. Raises BadInput if the mesh would have more than MOST_CELLS tetrahedra.
    """
    if made:
        return _with_curves(replace(made, points=made.points @ solid.rotation.T))
    assert sizes  # which a body without a mesh has
    expected = expected_cells(solid.volume, sizes) / 2 ** len(mirror_axes)
    if expected > MOST_CELLS:
        raise BadInput(
            f"mesh_size: '{name}' would have about {expected:.2g} tetrahedra (accepted: up to {MOST_CELLS}; larger "
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
        mirror_axes,
        replace(sizes, near=sizes.near @ solid.rotation.T),
        solid.half_thickness,
        parts,
    )


def _with_curves(made: SolidMesh) -> SolidMesh:
    """The mesh with the spheres and cylinders on which its faces lie."""
    return replace(
        made, curved=tuple(patch for patch, _ in curved.surfaces(made.points, made.faces))
    )


# ---- files


def file_solid(body: "Mesh", folder: Path) -> tuple[Solid, SolidMesh | None, np.ndarray]:
    """The solid of a body from a file, the mesh if the file contains one, and the centre of volume
    (3,) [m].

    Solid and mesh are about this centre, which is in the coordinates of the file.
    """
    name, scale = body.file, body.scale or 1.0
    if given.is_given(body):
        return _of_mesh(given.solid(body).scaled(scale))
    if not name:
        raise BadInput(
            f"{body.at('file')}: is missing (accepted: {', '.join(solid_file.MESHES + solid_file.GEOMETRIES)})"
        )
    path = folder / name
    try:
        file_mesh = solid_file.read(path).scaled(scale)
    except BadInput as error:
        raise BadInput(f"{body.at('file')}: {error}") from None
    if body.scale is not None and solid_file.declares_unit(path):
        raise BadInput(
            f"{body.at('scale')}: '{body.value_text('scale')}' for '{path.name}', which declares its unit of length "
            f"(accepted: without scale, or files that declare none)"
        )
    solid, centred, centre = _of_mesh(file_mesh)
    if solid_file.is_geometry(path):
        geometry = solid_file.Geometry(path, scale, centre, centred)
        return replace(solid, geometry=geometry), None, centre
    return solid, centred, centre


def _of_mesh(made: SolidMesh) -> tuple[Solid, SolidMesh, np.ndarray]:
    """The solid of a mesh, a ball if all its faces lie on one sphere; the mesh about the centre."""
    sphere = next(
        (
            patch
            for patch, own in curved.surfaces(made.points, made.faces)
            if not len(patch.axis) and len(own) == len(made.faces)
        ),
        None,
    )
    centre = sphere.centre if sphere else made.centre
    centred = made.moved(-centre)
    shape = ball(sphere.radius) if sphere else surface(centred.points[centred.faces])
    return Solid(shape, np.zeros(3), np.eye(3)), centred, centre
