"""Bodies of revolution about the axis x = 0: their meridian sections, in SI units.

x is the radius, y the coordinate along the axis. A section is an Outline about the centre of volume that is symmetric
about x = 0; its half x >= 0 is meshed.
"""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..failure import BadInput
from ..geometry.outlines import (
    Loop,
    Outline,
    TubeOutline,
    circle_loop,
    cross,
    signed_area,
)
from . import flat, mesh

if TYPE_CHECKING:
    from ..input.shapes import Mesh

__all__ = [
    "boundary",
    "closed_over_axis",
    "crossing_axis",
    "file_section",
    "image",
    "mirrored",
    "polygon_section",
    "right_half",
    "section",
    "whole",
]


def file_section(body: "Mesh", folder: Path) -> tuple[Outline, mesh.Mesh, np.ndarray]:
    """The section of a body from a file, the mesh of its half x >= 0, and the centre.

    Both are about the centre of volume (2,) [m], which is in the coordinates of the drawing.
    Raises BadInput if the body is not accepted.
    """
    half = flat.mesh_file(body, folder, of_revolution=True)
    centre = np.array([0.0, _centre_of_volume(half.points[half.triangles])])
    if not (half.labels == mesh.AXIS).any():
        return *_tube_mesh(body, half.moved(-centre)), centre
    # Vertices on the axis get x = 0 exactly; in a file they lie there to round-off.
    half.points[np.unique(half.edges[half.labels == mesh.AXIS]), 0] = 0.0
    half = half.moved(-centre)
    return flat.mesh_outline(whole(half)), half, centre


def section(loop: Loop) -> tuple[Outline, np.ndarray]:
    """The section of a body with a loop to the right of the axis, or one over the axis, about its
    centre of volume, and this centre (2,) [m].
    """
    centre = np.array([0.0, _loop_centre(loop)])
    if loop.polygon[:, 0].min() > 0:
        return TubeOutline((loop.placed(-centre, 0.0), image(loop).placed(-centre, 0.0))), centre
    return Outline((loop.placed(-centre, 0.0),)), centre


def polygon_section(path: str, right: np.ndarray) -> Loop:
    """The loop of a chain (n, 2) [m] of the entry `path`: to the right of the axis, or from the axis
    to the axis, with its mirror image.
    """
    if right[:, 0].min() <= 0:
        return Loop(closed_over_axis(path, right))
    flat.check_simple(path, right)
    return Loop(right if signed_area(right) > 0 else right[::-1])


def image(loop: Loop) -> Loop:
    """The mirror image of a loop about the axis, counter-clockwise."""
    if loop.radius:
        return circle_loop(loop.radius).placed(loop.centre * [-1, 1], 0.0)
    return Loop(loop.corners[::-1] * [-1, 1])


def _tube_mesh(body: "Mesh", half: mesh.Mesh) -> tuple[TubeOutline, mesh.Mesh]:
    """The section and the mesh of a body that does not reach the axis, from a file.

    Raises BadInput if the mesh is not wholly to the right of the axis, or if it has a hole.
    """
    if half.points[:, 0].min() <= 0:
        raise BadInput(
            f"{body.at('file')}: it lies down to x = {half.points[:, 0].min():g} m (accepted: to the right of the axis, "
            f"or with edges of the label {mesh.AXIS} on it)"
        )
    outline = flat.mesh_outline(half)
    if len(outline.loops) > 1:
        raise BadInput(
            f"{body.at('file')}: a section that does not reach the axis and has a hole (accepted: without holes)"
        )
    return TubeOutline((outline.loops[0], flat.mesh_outline(_mirror(half)).loops[0])), half


def _mirror(half: mesh.Mesh) -> mesh.Mesh:
    """The mirror image of a mesh about the axis."""
    return mesh.Mesh(
        half.points * [-1, 1],
        half.triangles[:, ::-1],
        half.edges[:, ::-1],
        half.labels,
        half.circle_centres * [-1, 1],
    )


def closed_over_axis(path: str, right: np.ndarray) -> np.ndarray:
    """The counter-clockwise polygon of a chain `right` (n, 2) [m] and its mirror image.

    The chain leads from the axis to the axis, with x > 0 between. Otherwise, or if the polygon is
    not simple, the function raises BadInput with the entry `path`.
    """
    if right[0, 0] != 0 or right[-1, 0] != 0 or (right[1:-1, 0] <= 0).any():
        raise BadInput(
            f"{path}: do not go from the axis to the axis on its right (accepted: x = 0 for the first and the last, x > 0 "
            f"between)"
        )
    corners = np.vstack([right, right[-2:0:-1] * [-1, 1]])
    flat.check_simple(path, corners)
    return corners if right[-1, 1] > right[0, 1] else np.roll(corners[::-1], 1, axis=0)


def crossing_axis(outline: Outline) -> Outline | None:
    """The outline of a body in the plane that is its own mirror image in x = 0, with corners where
    its loops cross this axis, from top to bottom. None if a loop does not cross the axis twice.
    """
    near, loops = 1e-9 * outline.reach, []
    for loop in outline.loops:
        if loop.semi_axes is None:
            if loop.arc_centres is not None:
                return None
            loop = Loop(_with_crossings(loop.corners, near))
        if (loop.corners[:, 0] == 0).sum() != 2:
            return None
        loops.append(loop)
    outer, *holes = loops
    return Outline((outer, *sorted(holes, key=lambda hole: -hole.corners[:, 1].max())))


def _with_crossings(corners: np.ndarray, near: float) -> np.ndarray:
    """The corners (n, 2) of a polygon with those where its sides cross x = 0. Corners within `near`
    [m] of this axis move onto it.
    """
    corners, listed = corners.copy(), []
    corners[abs(corners[:, 0]) <= near, 0] = 0.0
    for first, second in zip(corners, np.roll(corners, -1, axis=0)):
        listed.append(first)
        if first[0] * second[0] < 0:
            share = first[0] / (first[0] - second[0])
            listed.append(np.array([0.0, first[1] + share * (second[1] - first[1])]))
    return np.array(listed)


def right_half(loop: Loop) -> list[int]:
    """The numbers of the segments of a section's loop to the right of the axis, upwards."""
    crossing = np.flatnonzero(loop.corners[:, 0] == 0).tolist()
    lower, upper = sorted(crossing, key=lambda k: loop.corners[k, 1])
    return [(lower + k) % len(loop.corners) for k in range((upper - lower) % len(loop.corners))]


def boundary(outline: Outline) -> list[tuple[mesh.Curve, Loop | None]]:
    """The boundary of the half x >= 0, counter-clockwise, as curves over [0, 1].

    Each curve comes with the loop to which it belongs, None on the axis. The boundary leads upwards
    along the outer surface and down the axis. Where it reaches a cavity, it follows the surface of
    the cavity downwards and then continues down the axis.
    """
    curves: list[tuple[mesh.Curve, Loop | None]] = []
    ends: list[np.ndarray] = []
    for k, loop in enumerate(outline.loops):
        pieces = right_half(loop)
        lower, upper = loop.corners[pieces[0]], loop.corners[(pieces[-1] + 1) % len(loop.corners)]
        if k == 0:
            curves += [(partial(loop.at, piece), loop) for piece in pieces]
            ends = [lower, upper]
        else:
            curves += [(_straight(ends[1], upper), None)]
            curves += [(partial(_backwards, loop, piece), loop) for piece in pieces[::-1]]
            ends[1] = lower
    return [*curves, (_straight(ends[1], ends[0]), None)]


def _backwards(loop: Loop, piece: int, s: np.ndarray) -> np.ndarray:
    return loop.at(piece, 1 - s)


def _straight(start: np.ndarray, end: np.ndarray) -> mesh.Curve:
    """The straight curve over [0, 1] from start (2,) to end (2,)."""
    return lambda s: start + s[:, None] * (end - start)


def _loop_centre(loop: Loop) -> float:
    if loop.semi_axes is not None:
        return float(loop.centre[1])
    if loop.corners[:, 0].min() > 0:
        corners = loop.corners
        return _centre_of_volume(
            np.stack(
                [np.broadcast_to(corners[0], (len(corners) - 2, 2)), corners[1:-1], corners[2:]],
                axis=1,
            )
        )
    first, *pieces = right_half(loop)
    corners = loop.corners[[first, *pieces, (pieces[-1] + 1) % len(loop.corners)]]
    return _centre_of_volume(
        np.stack(
            [np.broadcast_to(corners[0], (len(corners) - 2, 2)), corners[1:-1], corners[2:]], axis=1
        )
    )


def _centre_of_volume(triangles: np.ndarray) -> float:
    """y [m] of the centre of the volume that triangles (t, 3, 2) generate about the axis.

    It is the integral of x y over the triangles divided by that of x; areas have signs.
    """
    areas = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2
    x, y = triangles[..., 0], triangles[..., 1]
    moments = areas / 12 * (x.sum(axis=1) * y.sum(axis=1) + (x * y).sum(axis=1))
    return float(moments.sum() / (areas * x.mean(axis=1)).sum())


def whole(half: mesh.Mesh) -> mesh.Mesh:
    """The mesh of a half section and its mirror image, with common vertices on the axis."""
    n, off = len(half.points), half.points[:, 0] != 0
    mirrored = np.where(off, n + np.cumsum(off) - 1, np.arange(n))
    outer = half.labels != mesh.AXIS
    return mesh.Mesh(
        np.vstack([half.points, half.points[off] * [-1, 1]]),
        np.vstack([half.triangles, mirrored[half.triangles][:, ::-1]]),
        np.vstack([half.edges[outer], mirrored[half.edges[outer]][:, ::-1]]),
        np.tile(half.labels[outer], 2),
        np.vstack([half.circle_centres[outer], half.circle_centres[outer] * [-1, 1]]),
    )


def mirrored(path: str, chain: np.ndarray) -> tuple[np.ndarray, bool]:
    """The vertices of a rigid chain (n, 2) with its mirror image, and whether they form a loop.

    The chain begins or ends on the axis, and all other vertices have x > 0; otherwise the function
    raises BadInput with the entry `path`. The mirror image is travelled backwards, so that the free
    side stays to the left.
    """
    begins, ends = bool(chain[0, 0] == 0), bool(chain[-1, 0] == 0)
    if not (begins or ends) or (chain[begins : len(chain) - ends, 0] <= 0).any():
        raise BadInput(
            f"{path}: is no section of a surface of revolution (accepted: x = 0 for the first or the last vertex, x > 0 for "
            f"the others)"
        )
    image = chain[::-1] * [-1, 1]
    if begins and ends:
        return np.vstack([chain, image[1:-1]]), True
    return np.vstack([image, chain[1:]] if begins else [chain, image[1:]]), False
