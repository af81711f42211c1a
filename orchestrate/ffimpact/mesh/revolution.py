"""Bodies of revolution about the axis x = 0: [[body]] tables (docs/bodies.md) as their section with a plane through the axis, SI units.

x is the radius, y the axis. The section is symmetric about x = 0: an Outline about the centre of volume, of which the half x >= 0 is
meshed.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from ..failure import BadInput
from ..geometry.outlines import (
    Loop,
    Outline,
    TubeOutline,
    circle_loop,
    cross,
    ellipse_loop,
    signed_area,
)
from ..input.tables import LONGEST, Table
from . import flat, mesh

SHAPES = {"ball": ("radius",), "shell": ("radius", "inner_radius"), "ellipsoid": ("semi_axes",),
          "cylinder": ("radius", "height"), "polygon": ("vertices",), "tube": ("radius", "inner_radius", "height"),
          "torus": ("radius", "section"),
          "mesh": ("file", "scale")}
LOOPS = {"ball": circle_loop, "ellipsoid": lambda semi_axes: ellipse_loop(*semi_axes),
         "cylinder": lambda r, height: Loop(np.array([r, height / 2]) * [[0, -1], [1, -1], [1, 1], [0, 1], [-1, 1], [-1, -1]])}
MOTION = ()


def shape(table: Table, folder: Path) -> tuple[Outline, mesh.Mesh | None]:
    """The section of a body, and the mesh of its half x >= 0 where a file brings it, both about the centre of volume."""
    if table.given["shape"] == "mesh":
        half = flat.mesh_file(table, folder, "ball-axisymmetric")
        if not (half.labels == mesh.AXIS).any():
            return _tube_mesh(table, half)
        half.points[np.unique(half.edges[half.labels == mesh.AXIS]), 0] = 0.0      # what a file has of the axis to round-off
        centre = np.array([0.0, _centre_of_volume(half.points[half.triangles])])
        half = half.moved(-centre)
        return flat.mesh_outline(whole(half)), half
    if table.given["shape"] == "shell":
        radius, inner = _radii(table)
        return Outline((circle_loop(radius), circle_loop(inner))), None
    loop = _tube_loop(table) or _loop(table)
    if loop.polygon[:, 0].min() > 0:
        centre = np.array([0.0, _loop_centre(loop)])
        return TubeOutline((loop.placed(-centre, 0.0), image(loop).placed(-centre, 0.0))), None
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


def _radii(table: Table) -> tuple[float, float]:
    """Outer and inner radius [m] of a hollow body."""
    radius, inner = table.number("radius"), table.number("inner_radius")
    if not inner < radius:
        raise BadInput(f"{table.at('inner_radius')}: {inner:g} m is no smaller than radius (accepted: below {radius:g} m)")
    return radius, inner


def _tube_loop(table: Table) -> Loop | None:
    """The loop of a section to the right of the axis, that does not reach it; None of another body."""
    kind = table.given["shape"]
    if kind == "torus":
        radius, section = table.lengths(SHAPES[kind])
        if not section < radius:
            raise BadInput(f"{table.at('section')}: {section:g} m reaches the axis (accepted: below radius, {radius:g} m)")
        return circle_loop(section).placed(np.array([radius, 0.0]), 0.0)
    if kind == "tube":
        (radius, inner), height = _radii(table), table.number("height")
        return Loop(np.array([[inner, -height / 2], [radius, -height / 2], [radius, height / 2], [inner, height / 2]]))
    if kind == "polygon" and (right := table.points("vertices"))[:, 0].min() > 0:
        flat.check_simple(f"{table.path}.vertices", right)
        return Loop(right if signed_area(right) > 0 else right[::-1])
    return None


def image(loop: Loop) -> Loop:
    """The mirror image of a loop across the axis."""
    if loop.radius:
        return circle_loop(loop.radius).placed(loop.centre * [-1, 1], 0.0)
    return Loop(loop.corners[::-1] * [-1, 1])


def _tube_mesh(table: Table, half: mesh.Mesh) -> tuple[TubeOutline, mesh.Mesh]:
    """The section and the mesh of a body from a file that does not reach the axis."""
    if half.points[:, 0].min() <= 0:
        raise BadInput(f"{table.at('file')}: it lies down to x = {half.points[:, 0].min():g} m (accepted: to the right of the axis, "
                       f"or with edges of the label {mesh.AXIS} on it)")
    half = half.moved(-np.array([0.0, _centre_of_volume(half.points[half.triangles])]))
    outline = flat.mesh_outline(half)
    if len(outline.loops) > 1:
        raise BadInput(f"{table.at('file')}: a section that does not reach the axis and has a hole (accepted: without holes)")
    return TubeOutline((outline.loops[0], flat.mesh_outline(_mirror(half)).loops[0])), half


def _mirror(half: mesh.Mesh) -> mesh.Mesh:
    """The mirror image of a mesh across the axis."""
    return mesh.Mesh(half.points * [-1, 1], half.triangles[:, ::-1], half.edges[:, ::-1], half.labels, half.hubs * [-1, 1])


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


def boundary(outline: Outline) -> list[tuple[Callable[[np.ndarray], np.ndarray], Loop | None]]:
    """The boundary of the half x >= 0, counter-clockwise, as curves over [0, 1], each with the loop that it is part of, None on the
    axis: the outer surface upwards, down the axis, where there is a cavity down its surface, and down the axis."""
    curves, ends = [], []
    for k, loop in enumerate(outline.loops):
        pieces = right_half(loop)
        lower, upper = loop.corners[pieces[0]], loop.corners[(pieces[-1] + 1) % len(loop.corners)]
        if k == 0:
            curves += [(partial(loop.at, piece), loop) for piece in pieces]
            ends = [lower, upper]
        else:
            curves += [(_straight(ends[1], upper), None)]
            curves += [((lambda s, loop=loop, piece=piece: loop.at(piece, 1 - s)), loop) for piece in pieces[::-1]]
            ends[1] = lower
    return [*curves, (_straight(ends[1], ends[0]), None)]


def _straight(start: np.ndarray, end: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """A straight curve over [0, 1]."""
    return lambda s: start + s[:, None] * (end - start)


def _loop_centre(loop: Loop) -> float:
    if loop.semi_axes is not None:
        return float(loop.centre[1])
    if loop.corners[:, 0].min() > 0:
        corners = loop.corners
        return _centre_of_volume(np.stack([np.broadcast_to(corners[0], (len(corners) - 2, 2)), corners[1:-1], corners[2:]], axis=1))
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
