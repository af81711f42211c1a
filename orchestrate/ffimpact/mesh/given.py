"""Meshes that a scene gives as arrays: points, triangles or tetrahedra, and parts of the boundary by
name. The part `contact` may come into contact (by default all of the boundary), the part `symmetry`
is on the axis of revolution; all parts can have supports and loads.
"""

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from ..failure import BadInput
from . import mesh, plane_file, solid_file
from .mesh import AXIS, FREE, Mesh
from .solid_mesh import SolidMesh, right_handed

if TYPE_CHECKING:
    from ..input.shapes import Mesh as Table

__all__ = ["is_given", "plane", "solid"]

CONTACT, SYMMETRY = "contact", "symmetry"
Made = TypeVar("Made", Mesh, SolidMesh)


def is_given(body: "Table") -> bool:
    """Whether a body has its mesh as arrays."""
    return body.points is not None


def plane(body: "Table") -> Mesh:
    """The mesh of triangles of a body, lengths as given. Raises BadInput if it cannot be used."""
    points, triangles = _used(body, 3)
    triangles = mesh.counter_clockwise(points, triangles)
    edges = mesh.boundary(triangles)
    labels, groups = _labels(body, edges, Mesh.NEVER)
    try:
        return plane_file.checked(Mesh(points, triangles, edges, labels, groups=groups))
    except BadInput as error:
        raise BadInput(f"{body.at('cells')}: {error}") from None


def solid(body: "Table") -> SolidMesh:
    """The mesh of tetrahedra of a body, lengths as given. Raises BadInput if it cannot be used."""
    points, cells = _used(body, 4)
    cells = right_handed(points, cells)
    try:
        solid_file.check(points, cells)
    except BadInput as error:
        raise BadInput(f"{body.at('cells')}: {error}") from None
    faces = mesh.boundary(cells)
    labels, groups = _labels(body, faces, SolidMesh.NEVER)
    return SolidMesh(points, cells, faces, labels, groups=groups)


def _used(body: "Table", corners: int) -> tuple[np.ndarray, np.ndarray]:
    """The points that cells use and the cells, whose numbers count these points."""
    points, cells = np.array(body.points), np.array(body.cells)
    axes, width = points.shape[1], cells.shape[1]
    if (axes, width) != (corners - 1, corners):
        raise BadInput(
            f"{body.at('cells')}: {width} corners in {axes} dimensions (accepted: triangles of points [x, y] "
            "in the plane and of revolution, tetrahedra of points [x, y, z] in space)"
        )
    if cells.max() >= len(points):
        raise BadInput(
            f"{body.at('cells')}: names point {cells.max()} (accepted: 0 to {len(points) - 1})"
        )
    used, numbers = np.unique(cells, return_inverse=True)
    return points[used], numbers.reshape(cells.shape)


def _labels(
    body: "Table", sides: np.ndarray, never: int
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """The label of each boundary side, and the numbers of the sides of each part by name."""
    number = {frozenset(side): k for k, side in enumerate(_given_numbers(body)[sides].tolist())}
    groups = {}
    for name, rows in (body.labels or {}).items():
        missing = [side for side in rows if frozenset(side) not in number]
        if missing:
            raise BadInput(
                f"{body.at('labels')}.{name}: {missing[0]} is no side on the boundary of the mesh (accepted: "
                f"numbers of the {sides.shape[1]} points of one)"
            )
        groups[name] = np.unique([number[frozenset(side)] for side in rows]).astype(int)
    labels = np.full(len(sides), never if CONTACT in groups else FREE)
    for name, label in ((CONTACT, FREE), (SYMMETRY, AXIS)):
        if name in groups:
            labels[groups[name]] = label
    return labels, groups


def _given_numbers(body: "Table") -> np.ndarray:
    """The number in the scene of each point that cells use."""
    return np.unique(np.array(body.cells))
