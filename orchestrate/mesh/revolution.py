"""Bodies of revolution about the axis x = 0: [[body]] tables (docs/bodies.md) as their section with a plane through the axis, SI units.

x is the radius, y the axis. The section is symmetric about x = 0: an Outline about the centre of volume, of which the half x >= 0 is
meshed.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from . import flat, mesh
from ..failure import BadInput
from ..geometry.outlines import Loop, Outline, circle_loop, cross, ellipse_loop
from ..input.tables import LONGEST, Table

SHAPES = {"ball": ("radius",), "ellipsoid": ("semi_axes",), "cylinder": ("radius", "height"), "polygon": ("vertices",),
          "mesh": ("file", "scale")}
LOOPS = {"ball": circle_loop, "ellipsoid": lambda semi_axes: ellipse_loop(*semi_axes),
         "cylinder": lambda r, height: Loop(np.array([r, height / 2]) * [[0, -1], [1, -1], [1, 1], [0, 1], [-1, 1], [-1, -1]])}
MOTION = ()


def shape(table: Table, folder: Path) -> tuple[Outline, mesh.Mesh | None]:
    """The section of a body, and the mesh of its half x >= 0 where a file brings it, both about the centre of volume."""
    if table.given["shape"] == "mesh":
        half = flat.mesh_file(table, folder, "ball-axisymmetric")
        half.points[np.unique(half.edges[half.labels == mesh.AXIS]), 0] = 0.0      # what a file has of the axis to round-off
        centre = np.array([0.0, _centre_of_volume(half.points[half.triangles])])
        half = half.moved(-centre)
        return flat.mesh_outline(whole(half)), half
    loop = _loop(table)
    return Outline((loop.placed(np.array([0.0, -_loop_centre(loop)]), 0.0),)), None


def motion(table: Table) -> dict:
    """Where a body is at the start and how it moves along the axis."""
    return {"position": on_axis(table, "position"), "angle": 0.0, "velocity": on_axis(table, "velocity", (0.0, 0.0)), "spin": 0.0}


def on_axis(table: Table, key: str, default: tuple[float, float] | None = None) -> np.ndarray:
    """A place on the axis, or a vector along it, (2,): [0, y], or y alone."""
    if key in table and not isinstance(table.given[key], list):
        return np.array([0.0, table.number(key, -LONGEST)])
    found = table.numbers(key, default)
    if found[0] != 0:
        raise BadInput(f"{table.at(key)}: x is {found[0]:g}, off the axis of revolution (accepted: [0, y], or y alone)")
    return found


def _loop(table: Table) -> Loop:
    """The outline of a section, with corners where it crosses the axis."""
    kind = table.given["shape"]
    if kind == "polygon":
        return Loop(closed_over_axis(f"{table.path}.vertices", table.points("vertices")))
    return LOOPS[kind](*table.lengths(SHAPES[kind]))


def closed_over_axis(path: str, right: np.ndarray) -> np.ndarray:
    """The polygon, counter-clockwise, of a chain (n, 2) from the axis to the axis and its mirror image."""
    if right[0, 0] != 0 or right[-1, 0] != 0 or (right[1:-1, 0] <= 0).any():
        raise BadInput(f"{path}: do not go from the axis to the axis on its right (accepted: x = 0 for the first and the last, x > 0 "
                       f"between)")
    corners = np.vstack([right, right[-2:0:-1] * [-1, 1]])
    flat.check_simple(path, corners)
    return corners if right[-1, 1] > right[0, 1] else np.roll(corners[::-1], 1, axis=0)


def right_half(loop: Loop) -> list[int]:
    """The pieces of a section's loop to the right of the axis, from its lower end on; pieces lead from corner to corner."""
    lower, upper = sorted(np.flatnonzero(loop.corners[:, 0] == 0), key=lambda k: loop.corners[k, 1])
    return [(lower + k) % len(loop.corners) for k in range((upper - lower) % len(loop.corners))]


def boundary(loop: Loop) -> list[Callable[[np.ndarray], np.ndarray]]:
    """The boundary of the half x >= 0, counter-clockwise, as curves over [0, 1]; the last one is the axis, downwards."""
    pieces = right_half(loop)
    lower, upper = loop.corners[pieces[0]], loop.corners[(pieces[-1] + 1) % len(loop.corners)]
    return [*(partial(loop.at, k) for k in pieces), lambda s: upper + s[:, None] * (lower - upper)]


def _loop_centre(loop: Loop) -> float:
    if loop.semi_axes is not None:
        return float(loop.centre[1])
    first, *pieces = right_half(loop)
    corners = loop.corners[[first, *pieces, (pieces[-1] + 1) % len(loop.corners)]]
    return _centre_of_volume(np.stack([np.broadcast_to(corners[0], (len(corners) - 2, 2)), corners[1:-1], corners[2:]], axis=1))


def _centre_of_volume(triangles: np.ndarray) -> float:
    """y of the centre of what triangles (t, 3, 2), areas signed, make about the axis: the integral of x y over that of x."""
    areas = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2
    x, y = triangles[..., 0], triangles[..., 1]
    moments = areas / 12 * (x.sum(axis=1) * y.sum(axis=1) + (x * y).sum(axis=1))
    return float(moments.sum() / (areas * x.mean(axis=1)).sum())


def whole(half: mesh.Mesh) -> mesh.Mesh:
    """The mesh of a section with its mirror image, which shares the vertices on the axis."""
    n, off = len(half.points), half.points[:, 0] != 0
    mirrored = np.where(off, n + np.cumsum(off) - 1, np.arange(n))
    outer = half.labels != mesh.AXIS
    return mesh.Mesh(np.vstack([half.points, half.points[off] * [-1, 1]]), np.vstack([half.triangles, mirrored[half.triangles][:, ::-1]]),
                     np.vstack([half.edges[outer], mirrored[half.edges[outer]][:, ::-1]]), np.tile(half.labels[outer], 2),
                     np.vstack([half.hubs[outer], half.hubs[outer] * [-1, 1]]))


def mirrored(path: str, chain: np.ndarray) -> tuple[np.ndarray, bool]:
    """The vertices of a rigid chain (n, 2) that begins or ends on the axis with those of its mirror image, in one direction of travel, and
    whether they close: the mirror image of what is to the left of a chain is to the left of its mirror image travelled backwards."""
    begins, ends = bool(chain[0, 0] == 0), bool(chain[-1, 0] == 0)
    if not (begins or ends) or (chain[begins:len(chain) - ends, 0] <= 0).any():
        raise BadInput(f"{path}: is no section of a surface of revolution (accepted: x = 0 for the first or the last vertex, x > 0 for "
                       f"the others)")
    image = chain[::-1] * [-1, 1]
    if begins and ends:
        return np.vstack([chain, image[1:-1]]), True
    return np.vstack([image, chain[1:]] if begins else [chain, image[1:]]), False
