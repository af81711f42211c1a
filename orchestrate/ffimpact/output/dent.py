"""The dent that plastic strain leaves in a body. Units are SI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..mesh.mesh import boundary

if TYPE_CHECKING:
    from .states import State

__all__ = ["Dent", "dent"]

Array = NDArray[np.float64]
EDGE = 0.01  # share of the depth at the radius of a dent
ELASTIC = 1e-3  # share of the largest plastic strain above which a node takes no part in the fit


@dataclass(frozen=True)
class Dent:
    """`depth` [m]: the largest displacement of the outline inwards, after the rigid motion of the
    nodes that have not yielded is subtracted; `radius` [m]: the distance from the middle of the dent
    at which the displacement has fallen to a hundredth of the depth.
    """

    depth: float
    radius: float


def dent(state: State, body: int, mirrored: Sequence[str]) -> Dent:
    """The dent in body number `body` of a state; mirrored: the axes "x", "z" along which half of the
    body is left out, "x" of a body of revolution, too.
    """
    own = state.cells[state.body == body]
    nodes, cells = np.unique(own, return_inverse=True)
    rest, moved = state.points[nodes], state.positions[nodes]
    yielded = state.plastic_strain[nodes]
    outline, normals = _outline(rest, cells.reshape(own.shape), mirrored)
    for axis in ["xyz".index(name) for name in mirrored]:
        sign = np.where(np.arange(3) == axis, -1.0, 1.0)
        rest, moved = np.vstack([rest, rest * sign]), np.vstack([moved, moved * sign])
        normals, yielded = np.vstack([normals, normals * sign]), np.tile(yielded, 2)
        outline = np.concatenate([outline, outline])
    inwards = -np.sum(_relative(rest, moved, yielded) * normals, axis=1)
    inwards[~outline] = 0.0
    depth = float(inwards.max())
    apart = np.linalg.norm(rest - rest[inwards.argmax()], axis=1)
    shallow = outline & (inwards < depth / 2)
    deep = (inwards > depth / 2) & (apart < 2 * apart[shallow].min(initial=np.inf))
    middle = np.average(rest[deep], axis=0, weights=inwards[deep])
    distance = np.linalg.norm(rest - middle, axis=1)[outline]
    order = np.argsort(distance)
    distance, inwards = distance[order], inwards[outline][order]
    beyond = np.flatnonzero((inwards < EDGE * depth) & (distance > distance[inwards.argmax()]))
    if not len(beyond) or depth <= 0:
        return Dent(max(depth, 0.0), float(distance[-1]))
    k = beyond[0]
    share = (inwards[k - 1] - EDGE * depth) / (inwards[k - 1] - inwards[k])
    return Dent(depth, float(distance[k - 1] + share * (distance[k] - distance[k - 1])))


def _relative(rest: Array, moved: Array, yielded: Array) -> Array:
    """The displacements (n, 3) in the frame of the body, less the rigid motion of the nodes that
    have not yielded, of all if there are none.
    """
    from scipy.spatial.transform import Rotation  # takes long to load

    elastic = yielded <= ELASTIC * yielded.max()
    elastic = elastic if elastic.any() else np.ones(len(rest), bool)
    from_centre, now = rest - rest[elastic].mean(axis=0), moved - moved[elastic].mean(axis=0)
    rotation, _ = Rotation.align_vectors(now[elastic], from_centre[elastic])
    relative: Array = rotation.inv().apply(now) - from_centre
    return relative


def _outline(
    points: Array, cells: NDArray[np.int64], mirrored: Sequence[str]
) -> tuple[NDArray[np.bool_], Array]:
    """Whether each node is a corner of the outline, and its outward normal (n, 3), the mean over the
    sides there. Sides on a plane of symmetry belong to no outline.
    """
    axes = 2 if cells.shape[1] == 6 else 3
    sides = boundary(cells[:, : axes + 1])
    for axis in ["xyz".index(name) for name in mirrored]:
        on_plane = np.abs(points[sides][:, :, axis]).max(axis=1) < 1e-9 * np.ptp(points)
        sides = sides[~on_plane]
    along = points[sides[:, 1:]] - points[sides[:, :1]]
    up = np.array([0.0, 0.0, 1.0])
    of_sides = np.cross(along[:, 0], up if axes == 2 else along[:, 1])
    normals = np.zeros_like(points)
    np.add.at(normals, sides, of_sides[:, None])
    size = np.linalg.norm(normals, axis=1)
    at_outline = size > 0
    normals[at_outline] /= size[at_outline, None]
    return at_outline, normals
