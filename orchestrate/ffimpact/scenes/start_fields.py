"""Fields that bodies have at the start, velocity and displacement, at the nodes of their elements
(edp/program/run/start.idp).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..freefem.arrays import Entries
from ..geometry.outlines import rotation
from ..input.bodies import FIELDS
from ..input.dimension import PLANE_STRAIN
from ..mesh.mesh import Mesh
from ..mesh.solid_mesh import SolidMesh
from .arrays import Arc

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["start_fields"]

# Ends of the sides on whose middles FreeFEM's elements of degree 2 have nodes, behind the corners.
MIDDLES = {
    3: np.array([[1, 2], [2, 0], [0, 1]]),
    4: np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]),
}


def start_fields(
    scene: Scene,
    together: Mesh | SolidMesh,
    regions: np.ndarray,
    centres: np.ndarray,
    arcs: Sequence[Arc],
    arc_of: np.ndarray,
) -> Entries:
    """Returns each field as a list of numbers, nothing if no body has one."""
    with_fields = any(body.has_fields for body in scene.bodies)
    arrays: Entries = {"start_fields": int(with_fields)}
    if not with_fields:
        return arrays
    nodes = _nodes(together, arcs, arc_of, int(scene.number("degree")))
    for name in FIELDS:
        values = np.zeros_like(nodes)
        fields = [body.fields.get(name) for body in scene.bodies]
        for k, (body, field) in enumerate(zip(scene.bodies, fields)):
            if field:
                plane = scene.kind is PLANE_STRAIN
                turn = rotation(body.start_angle) if plane else np.eye(nodes.shape[2])
                mine = regions == k
                place = (nodes[mine] - centres[k]) @ turn.T + body.start_position
                values[mine] = field(place.reshape(-1, nodes.shape[2])).reshape(place.shape)
        # of each element the components of all nodes along x, then y, z
        listed = values.transpose(0, 2, 1).ravel()
        arrays[f"start.{name.removeprefix('initial_')}"] = listed
    return arrays


def _nodes(
    together: Mesh | SolidMesh, arcs: Sequence[Arc], arc_of: np.ndarray, degree: int
) -> np.ndarray:
    """The nodes (t, nodes, axes) [m] of each element: corners, for degree 2 the middles of sides, on
    arcs of the boundary those of the arcs.
    """
    cells, points = together.elements, together.points
    corners: np.ndarray = points[cells]
    if degree == 1:
        return corners
    ends = np.sort(cells[:, MIDDLES[cells.shape[1]]], axis=2)
    middles = points[ends].mean(axis=2)
    key = ends[..., 0] * len(points) + ends[..., 1]
    for k, arc in enumerate(arcs):
        sides = np.sort(together.sides[arc_of == k], axis=1)
        pairs = [sides[:, [a, b]] for a in range(sides.shape[1]) for b in range(a)]
        own = np.concatenate([pair.min(axis=1) * len(points) + pair.max(axis=1) for pair in pairs])
        on = np.isin(key, own)
        middles[on] = arc.onto(middles[on])
    return np.concatenate([corners, middles], axis=1)
