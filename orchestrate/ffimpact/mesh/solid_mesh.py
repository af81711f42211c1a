"""Meshes of tetrahedra: gmsh generates them, and they are written in Medit's format for FreeFEM.

Balls, shells, boxes, cylinders and tubes are meshed wholly, or reduced by symmetry. Labels of
boundary faces: 1 may come into contact, 2 lies on the plane of symmetry x = 0, 3 lies on the plane of symmetry
z = 0, 4 never comes into contact.
"""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from . import mesh, rounding
from .mesh import AXIS, FREE, GROWTH, Gmsh, Sizes, T

if TYPE_CHECKING:
    from ..input.conditions import Part

__all__ = [
    "Curved",
    "DEPTH",
    "MOST_CELLS",
    "MOST_RIGID_CELLS",
    "MOST_UNKNOWNS",
    "most_unknowns",
    "SolidMesh",
    "cell_volumes",
    "cells_of",
    "expected_cells",
    "generate",
    "mesh_shape",
    "right_handed",
    "unknowns",
    "write",
]

DEPTH = 3
PLANES = {0: AXIS, 2: DEPTH}  # planes of symmetry: the axis normal to the plane, and its label
BENT = 1.5  # largest size of a face on a layer over sqrt(R t)
LARGEST = 0.52  # largest element size of a ball over its radius: twelve elements per full turn
MOST_SOURCES = 2000  # largest number of points from which the size field measures distances
FILL = 0.118  # volume of a regular tetrahedron over the cube of its edge
MOST_CELLS = 1_000_000  # largest expected number of tetrahedra of a body
MOST_UNKNOWNS = 150_000  # largest number of displacement unknowns of a run with implicit steps
BYTES, SHARE = (
    8000,
    0.8,
)  # memory of an unknown with explicit steps, share of the machine's that a run takes
MOST_RIGID_CELLS = (
    60_000  # of rigid bodies, which have few unknowns: FreeFem++ takes 40 kB for each
)


@dataclass(frozen=True)
class Curved:
    """A sphere or a cylinder of a radius [m].

    `centre` (3,) [m] is the centre of the sphere or a point on the axis of the cylinder. `axis` is
    the unit direction (3,) of the cylinder's axis, and empty for a sphere.
    """

    centre: np.ndarray
    axis: np.ndarray
    radius: float

    def arms(self, points: np.ndarray) -> np.ndarray:
        """Radius vectors (..., 3) of points, from the centre or from the axis at right angles."""
        away = points - self.centre
        arms: np.ndarray = (
            away - (away @ self.axis)[..., None] * self.axis if len(self.axis) else away
        )
        return arms

    def onto(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3), moved along their radius vectors onto the sphere or cylinder."""
        arms = self.arms(points)
        projected: np.ndarray = points + arms * (
            self.radius / np.linalg.norm(arms, axis=1, keepdims=True) - 1
        )
        return projected


@dataclass(frozen=True)
class SolidMesh:
    """A mesh of tetrahedra.

    `points` (n, 3) are in m. `cells` (t, 4) are tetrahedra of positive volume. `faces` (f, 3) of
    the boundary are counter-clockwise seen from outside, with their `labels` (f,). `curved` are the
    spheres and cylinders on which faces lie. `groups` are the numbers of the faces of parts of the
    boundary by name, `cell_groups` those of the tetrahedra of named parts.
    """

    points: np.ndarray
    cells: np.ndarray
    faces: np.ndarray
    labels: np.ndarray
    curved: tuple[Curved, ...] = ()
    groups: dict[str, np.ndarray] = field(default_factory=dict)
    cell_groups: dict[str, np.ndarray] = field(default_factory=dict)
    layers: np.ndarray | None = None  # (t,) numbers of the layers of tetrahedra, 0: in none
    NEVER: ClassVar[int] = 4  # label of faces that never come into contact

    @property
    def elements(self) -> np.ndarray:
        return self.cells

    @property
    def sides(self) -> np.ndarray:
        return self.faces

    @property
    def layer_of(self) -> np.ndarray:
        """`layers`, 0 for all tetrahedra of a mesh without layers."""
        return mesh.layers_of(self)

    def moved(self, by: np.ndarray) -> "SolidMesh":
        """The mesh, translated by the vector `by` (3,) [m]."""
        return replace(self, points=self.points + by)

    def scaled(self, factor: float) -> "SolidMesh":
        """The mesh, scaled by `factor` about the origin; `curved` is kept unchanged."""
        return replace(self, points=self.points * factor)

    @property
    def volumes(self) -> np.ndarray:
        """The volumes (t,) [m3] of the tetrahedra."""
        return cell_volumes(self.points, self.cells)

    @property
    def centre(self) -> np.ndarray:
        """The centre of volume (3,) [m]."""
        volumes = self.volumes
        moments = volumes[:, None] * self.points[self.cells].mean(axis=1)
        centre: np.ndarray = moments.sum(axis=0) / volumes.sum()
        return centre


def cell_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    volumes: np.ndarray = ((b - a) * np.cross(c - a, d - a)).sum(axis=1) / 6
    return volumes


def right_handed(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """The tetrahedra (t, 4) with positive volumes: two corners of inverted ones are swapped."""
    return np.where(cell_volumes(points, cells)[:, None] < 0, cells[:, [0, 1, 3, 2]], cells)


def most_unknowns(explicit: bool) -> int:
    """The largest number of unknowns of a run, with explicit steps by the memory of the machine."""
    if not explicit:
        return MOST_UNKNOWNS
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return max(MOST_UNKNOWNS, int(SHARE * memory / BYTES / 1000) * 1000)


def unknowns(cells: np.ndarray, degree: int) -> int:
    """The number of displacement unknowns: three per vertex, and for degree 2 three per edge."""
    vertices = len(np.unique(cells))
    edges = np.unique(
        np.sort(cells[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1),
        axis=0,
    )
    return 3 * (vertices + (len(edges) if degree == 2 else 0))


# ---- meshes of shapes

ON_ROUND = 1e-6  # distance of vertices on a ball or cylinder by gmsh, over the size of the body


def mesh_shape(
    kind: str,
    lengths: np.ndarray,
    rotation: np.ndarray,
    mirror_axes: tuple[int, ...],
    sizes: Sizes,
    scale: float,
    parts: Sequence["Part"] = (),
) -> SolidMesh:
    """The mesh of a shape about the origin, turned by the matrix `rotation`, with faces on the
    boundaries of the regions `parts`, which refer to the body before its rotation.

    `lengths` [m] by `kind`: radius of a ball; outer and inner radius of a shell; width, height and
    depth of a box; radius and height of a cylinder; outer and inner radius and height of a tube.
    Cylinders and tubes have the axis y. `mirror_axes` contains the axes that are normal to planes
    of symmetry: only the part on the positive side of these planes is meshed. `scale` [m] is about
    the size of the body. Lengths are divided by it, because gmsh's tolerances are absolute.
    """
    spherical = kind in ("ball", "shell")
    radii = {"ball": 1, "shell": 2, "cylinder": 1, "tube": 2}.get(kind, 0)  # number of them
    bulk = min(sizes.bulk, LARGEST * lengths[0]) if spherical else sizes.bulk
    bulk = min(bulk, min(sizes.of_layers, BENT) * _largest_in_layers(lengths[:radii], parts))
    largest, contact, slack = (
        float(np.round(size / scale, mesh.DIGITS))
        for size in (bulk, min(bulk, sizes.contact), sizes.slack)
    )
    inside = Sizes(largest, contact, np.round(sizes.near / scale, mesh.DIGITS), slack)
    sides = np.round(lengths / scale, 12)  # 12 decimals: the accuracy of the corners

    def build(gmsh: Gmsh) -> None:
        occ = gmsh.model.occ
        volume = [(3, _occ_shape(occ, kind, list(map(float, sides))))]
        if spherical:
            occ.rotate(volume, 0, 0, 0, 1, 0, 0, np.pi / 2)  # puts the poles on the axis y
        else:
            occ.affineTransform(
                volume, [*np.column_stack([rotation, np.zeros(3)]).ravel(), 0, 0, 0, 1]
            )
        volume = _fragmented(occ, volume, parts, rotation, scale)
        if mirror_axes:
            far = 4 * np.linalg.norm(sides)
            corner = [0 if axis in mirror_axes else -far for axis in range(3)]
            half = occ.addBox(*corner, *(far - low for low in corner))
            occ.intersect(volume, [(3, half)])
        occ.synchronize()

    turn = 0 if kind in ("ball", "box") and not parts else rounding.TURN
    points, cells, _ = generate(build, inside, turn, cells_of)
    points = points * scale
    faces = mesh.boundary(cells)
    labels = np.full(len(faces), FREE)
    for axis in mirror_axes:
        on = (abs(points[faces][:, :, axis]) < 1e-7 * scale).all(axis=1)
        labels[on] = PLANES[axis]
        points[np.unique(faces[on]), axis] = 0
    rounds = _onto_rounds(points, parts, rotation, scale)
    if kind == "box":
        return SolidMesh(points, cells, faces, labels, rounds)
    along = np.array([]) if spherical else rotation[:, 1]
    patches = tuple(Curved(np.zeros(3), along, float(radius)) for radius in lengths[:radii])
    round_faces = labels == FREE
    if not spherical:
        round_faces &= np.ptp(points[faces] @ along, axis=1) >= 1e-7 * scale
    inner = _onto(patches, lengths[:radii], points, faces, round_faces)
    if kind == "shell":
        labels[inner] = SolidMesh.NEVER
    return SolidMesh(points, cells, faces, labels, (*patches, *rounds))


def _largest_in_layers(radii: np.ndarray, parts: Sequence["Part"]) -> float:
    """The largest element size [m] in concentric layers of a body with these radii. A face with
    sides sqrt(R t) on a sphere of radius R dips t/6 below it, less on a cylinder, and stays in a
    layer of the thickness t.
    """
    layers = [
        float(part.numbers[1])
        for part in parts
        if part.kind == "cylinder" or part.kind == "ball" and not part.numbers[0].any()
    ]
    if not layers or not len(radii):
        return np.inf
    steps = np.sort([*radii, *layers])
    return float(np.sqrt(steps[1:] * np.diff(steps)).min())


def _onto_rounds(
    points: np.ndarray, parts: Sequence["Part"], rotation: np.ndarray, scale: float
) -> tuple[Curved, ...]:
    """Moves the points of a turned body that are on balls and cylinders among its regions onto them;
    returns these.
    """
    rounds = []
    for part in parts:
        if part.kind in ("ball", "cylinder"):
            first, radius = rotation @ part.numbers[0], float(part.numbers[1])
            is_ball = part.kind == "ball"
            centre, axis = (first, np.array([])) if is_ball else (np.zeros(3), first)
            rounds.append(Curved(centre, axis, radius))
    for patch in rounds:
        away = np.linalg.norm(patch.arms(points), axis=1) - patch.radius
        close = abs(away) < ON_ROUND * scale
        points[close] = patch.onto(points[close])
    return tuple(rounds)


def _fragmented(
    occ: Gmsh,
    volume: list[tuple[int, int]],
    parts: Sequence["Part"],
    rotation: np.ndarray,
    scale: float,
) -> list[tuple[int, int]]:
    """Cuts a volume of gmsh's OpenCASCADE model, in lengths over `scale` [m], along the boundaries of
    regions, which are turned by `rotation`. Returns its pieces, which share faces.
    """
    if not parts:
        return volume
    occ.synchronize()
    far = 4 * float(np.abs(occ.getBoundingBox(*volume[0])).max())
    regions = [(3, _occ_region(occ, part, rotation, scale, far)) for part in parts]
    inside = [occ.intersect(volume, [region], removeObject=False)[0] for region in regions]
    pieces: list[tuple[int, int]] = occ.fragment(
        volume, [piece for own in inside for piece in own]
    )[0]
    return pieces


def _occ_region(occ: Gmsh, part: "Part", rotation: np.ndarray, scale: float, far: float) -> int:
    """Adds a region, turned by `rotation`, to gmsh's OpenCASCADE model, up to the distance `far`, and
    returns its number.
    """
    first, second = part.numbers
    if part.kind == "ball":
        return int(occ.addSphere(*(rotation @ first / scale), float(second) / scale))
    if part.kind == "cylinder":
        start, along = -far * (rotation @ first), 2 * far * (rotation @ first)
        return int(occ.addCylinder(*start, *along, float(second) / scale))
    if part.kind == "box":
        low, high = np.clip(first / scale, -far, far), np.clip(second / scale, -far, far)
        solid, turn = occ.addBox(*low, *(high - low)), rotation
    else:
        normal = second / np.linalg.norm(second)
        across = np.linalg.svd(normal[None])[2][1]
        turn = rotation @ np.column_stack([normal, across, np.cross(normal, across)])
        solid = occ.addBox(float(normal @ first) / scale, -far, -far, 2 * far, 2 * far, 2 * far)
    occ.affineTransform([(3, solid)], [*np.column_stack([turn, np.zeros(3)]).ravel(), 0, 0, 0, 1])
    return int(solid)


def _onto(
    patches: tuple[Curved, ...],
    radii: np.ndarray,
    points: np.ndarray,
    faces: np.ndarray,
    round_faces: np.ndarray,
) -> np.ndarray:
    """Moves the points of `round_faces` (f,) onto the nearest of concentric patches. Returns which
    faces (f,) are on the second, inner patch.
    """
    away = np.linalg.norm(patches[0].arms(points[faces].mean(axis=1)), axis=1)
    nearest = abs(away[:, None] - radii).argmin(axis=1)
    for k, patch in enumerate(patches):
        corners = np.unique(faces[round_faces & (nearest == k)])
        points[corners] = patch.onto(points[corners])
    on_patch: np.ndarray = round_faces & (nearest == 1)
    return on_patch


def _occ_shape(occ: Gmsh, kind: str, lengths: list[float]) -> int:
    """Adds a shape of mesh_shape() to gmsh's OpenCASCADE model and returns its number."""
    if kind == "ball":
        return int(occ.addSphere(0, 0, 0, *lengths))
    if kind == "box":
        return int(occ.addBox(*(-length / 2 for length in lengths), *lengths))
    if kind == "cylinder":
        radius, height = lengths
        return int(occ.addCylinder(0, -height / 2, 0, 0, height, 0, radius))
    solid = "ball" if kind == "shell" else "cylinder"
    outer, inner, *rest = lengths
    whole, hole = (_occ_shape(occ, solid, [radius, *rest]) for radius in (outer, inner))
    return int(occ.cut([(3, whole)], [(3, hole)])[0][0][1])


def cells_of(model: Gmsh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (n, 3) and tetrahedra (t, 4) of a gmsh model, and gmsh's numbers (n,) of the vertices.

    Of tetrahedra of second order only the corners are kept. Raises BadInput for other elements.
    """
    points, cells, used = mesh.elements_of(model, (3,), {4: 4, 11: 10}, "tetrahedron", "tetrahedra")
    return points, right_handed(points, cells), used


def generate(
    build: Callable[[Gmsh], None],
    sizes: Sizes,
    turn: int,
    take: Callable[[Gmsh], T],
    cut: float | None = None,
) -> T:
    """Builds a model with `build`, meshes it with gmsh and returns the result of `take`.

    A curved surface gets at least `turn` elements per full turn. If `cut` is set, rounding.py
    determines the sizes on curved surfaces. If the bulk size is 0, `build` sets the largest size.
    """
    with mesh.gmsh_session() as gmsh:
        build(gmsh)
        for name, value in {
            "FromPoints": 0,
            "ExtendFromBoundary": 0,
            "FromCurvature": turn,
        }.items():
            gmsh.option.setNumber(f"Mesh.MeshSize{name}", value)
        if sizes.bulk:
            gmsh.option.setNumber("Mesh.MeshSizeMax", sizes.bulk)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.OptimizeNetgen", 1)
        _grade(gmsh, sizes, cut)
        gmsh.model.mesh.generate(3)
        return take(gmsh.model)


def _grade(gmsh: Gmsh, sizes: Sizes, cut: float | None) -> None:
    """Sets the size field: sizes grow linearly with the distance from expected contact points."""
    field, sources, made = gmsh.model.mesh.field, _sources(gmsh, sizes), []
    if sources:
        both = sizes.contact, sizes.bulk
        made.append(mesh.graded(field, "PointsList", sources, both, flat=sizes.slack))
    if cut is not None:
        bulk = gmsh.option.getNumber("Mesh.MeshSizeMax")
        made += rounding.fields(gmsh, sizes, sources, bulk, cut)
    if made:
        least = field.add("Min")
        field.setNumbers(least, "FieldsList", made)
        field.setAsBackgroundMesh(least)


def _sources(gmsh: Gmsh, sizes: Sizes) -> list[int]:
    """Adds the expected contact points to gmsh and returns their numbers.

    The list is empty if elements are not smaller there than in the bulk.
    """
    if not len(sizes.near) or sizes.contact >= sizes.bulk:
        return []
    # Gmsh's own numbering does not know the points of the other geometry kernel.
    free = 1 + max(tag for _, tag in gmsh.model.getEntities(0))
    near = sizes.near[:: -(-len(sizes.near) // MOST_SOURCES)]
    points = [gmsh.model.geo.addPoint(*point, tag=free + k) for k, point in enumerate(near)]
    gmsh.model.geo.synchronize()
    return points


def expected_cells(volume: float, sizes: Sizes) -> float:
    """An estimate of the number of tetrahedra of a body with a volume [m3].

    It is the sum over the bulk and over layers around the contact patch, whose area grows with the
    distance from the patch.
    """
    bulk = volume / (FILL * sizes.bulk**3)
    if not len(sizes.near) or sizes.contact >= sizes.bulk:
        return bulk
    away = np.linspace(0, (sizes.bulk - sizes.contact) / GROWTH, 200)
    patch = np.ptp(sizes.near, axis=0).max() / 2 + sizes.slack
    layers = np.pi * (patch + away) ** 2 / (FILL * (sizes.contact + GROWTH * away) ** 3)
    return bulk + float(np.trapezoid(layers, away))


def write(together: SolidMesh, regions: np.ndarray, path: Path) -> None:
    """Writes a mesh in Medit's text format, with vertices counted from 1.

    Tetrahedra have the numbers of their bodies, `regions` (t,), and boundary faces their labels.
    """
    with open(path, "w") as file:
        file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(together.points)}\n")
        file.writelines(f"{x:.17g} {y:.17g} {z:.17g} 0\n" for x, y, z in together.points)
        file.write(f"Tetrahedra\n{len(together.cells)}\n")
        file.writelines(
            f"{a} {b} {c} {d} {region}\n"
            for (a, b, c, d), region in zip(together.cells + 1, regions)
        )
        file.write(f"Triangles\n{len(together.faces)}\n")
        file.writelines(
            f"{a} {b} {c} {label}\n"
            for (a, b, c), label in zip(together.faces + 1, together.labels)
        )
        file.write("End\n")
