"""Meshes of tetrahedra: of balls, boxes and cylinders by gmsh, or parts of them on one side of
planes of symmetry; written in Medit's format, as FreeFEM reads it.

Labels of boundary faces: 1 may touch, 2 on the plane x = 0 of what is computed by symmetry, 3 on
its plane z = 0, 4 never touches.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np

from . import mesh, rounding
from .mesh import AXIS, FREE, GROWTH, Sizes

__all__ = [
    "Curved",
    "DEPTH",
    "MOST_CELLS",
    "MOST_UNKNOWNS",
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
PLANES = {0: AXIS, 2: DEPTH}  # of symmetry: the axis across it, and its label
LARGEST = 0.52  # element of a ball over its radius: twelve on a full turn
MOST_SOURCES = 2000  # points that sizes are measured from
FILL = 0.118  # volume of a regular tetrahedron over the cube of its side
MOST_CELLS = 400_000  # that gmsh is asked for
MOST_UNKNOWNS = 150_000  # displacement unknowns of a run


@dataclass(frozen=True)
class Curved:
    """A sphere, without an axis (), or a cylinder, about a point of its axis with its direction
    (3,).
    """

    centre: np.ndarray
    axis: np.ndarray
    radius: float

    def arms(self, points: np.ndarray) -> np.ndarray:
        """Vectors (..., 3) to points from the centre, or from the nearest points of the axis."""
        away = points - self.centre
        return away - (away @ self.axis)[..., None] * self.axis if len(self.axis) else away

    def onto(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) moved straight onto it."""
        arms = self.arms(points)
        return points + arms * (self.radius / np.linalg.norm(arms, axis=1, keepdims=True) - 1)


@dataclass(frozen=True)
class SolidMesh:
    """points (n, 3) in m, tetrahedra (t, 4) of positive volume, faces (f, 3) of the boundary
    seen counter-clockwise from outside, their labels (f,); the spheres and cylinders that faces
    lie on.
    """

    points: np.ndarray
    cells: np.ndarray
    faces: np.ndarray
    labels: np.ndarray
    curved: tuple[Curved, ...] = ()
    NEVER: ClassVar[int] = 4  # the label of faces that may not touch

    @property
    def sides(self) -> np.ndarray:
        return self.faces

    def moved(self, by: np.ndarray) -> "SolidMesh":
        """The same mesh, `by` [m] elsewhere."""
        return replace(self, points=self.points + by)

    def scaled(self, factor: float) -> "SolidMesh":
        """The same mesh, `factor` times as large."""
        return replace(self, points=self.points * factor)

    @property
    def volumes(self) -> np.ndarray:
        """Those of the tetrahedra (t,) [m3]."""
        return cell_volumes(self.points, self.cells)

    @property
    def centre(self) -> np.ndarray:
        """The centre of volume."""
        return (self.volumes[:, None] * self.points[self.cells].mean(axis=1)).sum(
            axis=0
        ) / self.volumes.sum()


def cell_volumes(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    return ((b - a) * np.cross(c - a, d - a)).sum(axis=1) / 6


def right_handed(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """The tetrahedra (t, 4), those that are inside out turned over."""
    return np.where(cell_volumes(points, cells)[:, None] < 0, cells[:, [0, 1, 3, 2]], cells)


def unknowns(cells: np.ndarray, degree: int) -> int:
    """Displacement unknowns: three a vertex, of degree 2 three an edge more."""
    vertices = len(np.unique(cells))
    edges = np.unique(
        np.sort(cells[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1),
        axis=0,
    )
    return 3 * (vertices + (len(edges) if degree == 2 else 0))


# ---- meshes of shapes


def mesh_shape(
    kind: str,
    lengths: np.ndarray,
    rotation: np.ndarray,
    folded: tuple[int, ...],
    sizes: Sizes,
    scale: float,
) -> SolidMesh:
    """The mesh of a ball (radius), box (extents) or cylinder (radius, height, its axis y) about
    the origin, turned: only what lies on the positive side of the planes across the axes
    `folded`. `scale` [m] is about its size: gmsh's tolerances are absolute.
    """
    bulk = min(sizes.bulk, LARGEST * lengths[0]) if kind == "ball" else sizes.bulk
    inside = Sizes(
        *(
            np.round(size / scale, mesh.DIGITS)
            for size in (bulk, min(bulk, sizes.contact), sizes.near, sizes.slack)
        )
    )
    sides = np.round(lengths / scale, 12)  # its corners are exact to as much

    def build(gmsh) -> None:
        occ, (a, *more) = gmsh.model.occ, map(float, sides)
        if kind == "ball":
            tag = occ.addSphere(0, 0, 0, a)
        elif kind == "cylinder":
            tag = occ.addCylinder(0, -more[0] / 2, 0, 0, more[0], 0, a)
        else:
            tag = occ.addBox(-a / 2, -more[0] / 2, -more[1] / 2, a, *more)
        if kind == "ball":
            occ.rotate([(3, tag)], 0, 0, 0, 1, 0, 0, np.pi / 2)  # its poles on the axis y
        else:
            occ.affineTransform(
                [(3, tag)], [*np.column_stack([rotation, np.zeros(3)]).ravel(), 0, 0, 0, 1]
            )
        if folded:
            far = 4 * np.linalg.norm(sides)
            corner = [0 if axis in folded else -far for axis in range(3)]
            half = occ.addBox(*corner, *(far - low for low in corner))
            occ.intersect([(3, tag)], [(3, half)])
        occ.synchronize()

    points, cells = generate(build, inside, rounding.TURN if kind == "cylinder" else 0)
    points = points * scale
    faces = mesh.boundary(cells)
    labels = np.full(len(faces), FREE)
    for axis in folded:
        on = (abs(points[faces][:, :, axis]) < 1e-7 * scale).all(axis=1)
        labels[on] = PLANES[axis]
        points[np.unique(faces[on]), axis] = 0
    if kind == "box":
        return SolidMesh(points, cells, faces, labels)
    round_one = Curved(
        np.zeros(3), rotation[:, 1] if kind == "cylinder" else np.array([]), float(lengths[0])
    )
    ends = (
        np.zeros(len(faces), dtype=bool)
        if kind == "ball"
        else np.ptp(points[faces] @ rotation[:, 1], axis=1) < 1e-7 * scale
    )
    side = np.unique(faces[(labels == FREE) & ~ends])
    points[side] = round_one.onto(points[side])
    return SolidMesh(points, cells, faces, labels, (round_one,))


def cells_of(model) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and tetrahedra (t, 4) of a model of gmsh, of those of second order the
    corners; BadInput for other elements.
    """
    points, cells, _ = mesh.elements_of(model, (3,), {4: 4, 11: 10}, "tetrahedron", "tetrahedra")
    return points, right_handed(points, cells)


def generate(
    build: Callable, sizes: Sizes, turn: int, take: Callable = cells_of, cut: float | None = None
):
    """What `take` makes of the model that `build` puts into gmsh, meshed; on curved surfaces with
    `turn` elements a full turn at least, or, where `cut` is given, as rounding.py says. A bulk size
    of 0 is open: `build` sets the largest."""
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


def _grade(gmsh, sizes: Sizes, cut: float | None) -> None:
    """The size grows linearly with the distance from the points where the body touches."""
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


def _sources(gmsh, sizes: Sizes) -> list[int]:
    """Points of gmsh where the body touches, where elements are smaller."""
    if not len(sizes.near) or sizes.contact >= sizes.bulk:
        return []
    free = 1 + max(
        tag for _, tag in gmsh.model.getEntities(0)
    )  # whose own numbers do not know those of another kernel
    near = sizes.near[:: -(-len(sizes.near) // MOST_SOURCES)]
    points = [gmsh.model.geo.addPoint(*point, tag=free + k) for k, point in enumerate(near)]
    gmsh.model.geo.synchronize()
    return points


def expected_cells(volume: float, sizes: Sizes) -> float:
    """About how many tetrahedra a body gets: of its bulk, and around where it touches in layers
    whose area grows with the distance.
    """
    bulk = volume / (FILL * sizes.bulk**3)
    if not len(sizes.near) or sizes.contact >= sizes.bulk:
        return bulk
    away = np.linspace(0, (sizes.bulk - sizes.contact) / GROWTH, 200)
    patch = np.ptp(sizes.near, axis=0).max() / 2 + sizes.slack
    return bulk + np.trapezoid(
        np.pi * (patch + away) ** 2 / (FILL * (sizes.contact + GROWTH * away) ** 3), away
    )


def write(together: SolidMesh, regions: np.ndarray, path: Path) -> None:
    """Medit's text format: tetrahedra with the number of their body, boundary faces with their
    labels; vertices count from 1.
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
