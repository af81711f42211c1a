"""Refuses scenes whose bodies overlap each other or obstacles at the start."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np

from ..failure import BadInput
from ..geometry.outlines import Shape, normal_of
from ..input.bodies import Body
from ..input.obstacles import Obstacle
from ..mesh.solid_file import declares_unit

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["gap_between", "gap_to_obstacle", "refuse_overlaps"]

WIDE = 100.0  # width [m] of a body from a file above which its units are doubtful
TOUCHING = 1e-9  # overlap at the start that is round-off, over half the thickness of the body
# Overlap, likewise, that may be the depth at rest under weight or loads. The solver knows the penalty
# and judges it by its force (edp/program/run/start.idp).
SUNK = 0.05


def refuse_overlaps(scene: Scene) -> None:
    """Raises BadInput if a body overlaps another one or an obstacle at the start."""
    placed = [body.placed for body in scene.bodies]
    centres, reaches = (
        np.array([shape.area_centre for shape in placed]),
        np.array([shape.reach for shape in placed]),
    )
    distances = np.linalg.norm(centres[:, None] - centres, axis=2)
    for i, j in np.argwhere(np.triu(distances <= reaches[:, None] + reaches, 1)):
        body, other = scene.bodies[i], scene.bodies[j]
        _refuse_overlap(
            f"body.{i + 1}",
            body,
            f"body.{j + 1}",
            other.own_name,
            gap_between(placed[i], placed[j]),
            _sinks(scene),
            _units(body) or _units(other),
        )
    for (i, body), (j, other) in itertools.product(
        enumerate(scene.bodies, 1), enumerate(scene.obstacles, 1)
    ):
        _refuse_overlap(
            f"body.{i}",
            body,
            f"obstacle.{j}",
            other.own_name,
            gap_to_obstacle(body.placed, other),
            _sinks(scene),
            _units(body),
        )


def _units(body: Body) -> str:
    """Returns a hint for a message if a body comes from a file and is wider than WIDE."""
    width, file = 2 * body.outline.reach, getattr(body, "file", None)
    return (
        f"; its file is {width:.3g} m wide: other units? {body.at('scale')} = 0.001 takes them as mm"
        if file and width > WIDE and not declares_unit(body.context.folder / file)
        else ""
    )


def _sinks(scene: Scene) -> float:
    """Returns the overlap at the start that is not refused, over half the thickness of the body."""
    presses = any(scene.values.get(name) for name in ("gravity", "body_force_x", "body_force_y"))
    return SUNK if presses or any(body.loads for body in scene.bodies) else TOUCHING


def _refuse_overlap(
    path: str, body: Body, other_path: str, other: str, gap: float, sinks: float, hint: str = ""
) -> None:
    if gap < -sinks * body.outline.half_thickness:
        raise BadInput(
            f"{path}.position: '{body.own_name}' overlaps '{other}' ({other_path}) by {-gap:.3g} m at the start "
            f"(accepted: apart or touching{'' if other_path.startswith('body') else ', on the side that its normal points to'})"
            f"{hint}"
        )


def gap_between(first: Shape, second: Shape) -> float:
    """Returns the distance [m] of two bodies. It is negative where they overlap: minus the depth of
    the deepest point of one inside the other.
    """
    return min(second.least(first.gap), first.least(second.gap))


def gap_to_obstacle(outline: Shape, obstacle: Obstacle) -> float:
    """Returns the distance [m] of a body from an obstacle, negative where they overlap."""
    centre, least = outline.area_centre, obstacle.gap_from(outline)
    nearest = centre - obstacle.gap(centre[None]) * normal_of(obstacle.gap, centre)
    # The projection `nearest` is not on the obstacle where its distance has no gradient. The gap of
    # the body at `nearest` finds an obstacle inside the body.
    is_of_it = obstacle.gap(nearest[None])[0] < 1e-4 * outline.half_thickness
    return float(min(least, outline.gap(nearest[None])[0]) if is_of_it else least)
