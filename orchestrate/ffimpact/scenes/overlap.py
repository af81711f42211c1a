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
    centres = np.array([shape.area_centre for shape in placed])
    reaches = np.array([shape.reach for shape in placed])
    distances = np.linalg.norm(centres[:, None] - centres, axis=2)
    sinks = _sinks(scene)
    for i, j in np.argwhere(np.triu(distances <= reaches[:, None] + reaches, 1)):
        gap = gap_between(placed[i], placed[j])
        _refuse_overlap(scene.bodies[i], scene.bodies[j], gap, sinks)
    for body, obstacle in itertools.product(scene.bodies, scene.obstacles):
        _refuse_overlap(body, obstacle, gap_to_obstacle(body.placed, obstacle), sinks)


def _units(surface: Body | Obstacle) -> str:
    """Returns a hint for a message if a body comes from a file and is wider than WIDE."""
    file = getattr(surface, "file", None)
    if not file or isinstance(surface, Obstacle) or declares_unit(surface.context.folder / file):
        return ""
    if (width := 2 * surface.outline.reach) <= WIDE:
        return ""
    scale = surface.at("scale")
    return f"; its file is {width:.3g} m wide: other units? {scale} = 0.001 takes them as mm"


def _sinks(scene: Scene) -> float:
    """Returns the overlap at the start that is not refused, over half the thickness of the body."""
    presses = any(scene.values.get(name) for name in ("gravity", "body_force_x", "body_force_y"))
    return SUNK if presses or any(body.loads for body in scene.bodies) else TOUCHING


def _refuse_overlap(body: Body, other: Body | Obstacle, gap: float, sinks: float) -> None:
    if gap < -sinks * body.outline.half_thickness:
        side = ", on the side that its normal points to" if isinstance(other, Obstacle) else ""
        raise BadInput(
            f"{body.at('position')}: '{body.own_name}' overlaps '{other.own_name}' ({other.entry}) by {-gap:.3g} m at the start "
            f"(accepted: apart or touching{side}){_units(body) or _units(other)}"
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
