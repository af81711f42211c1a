"""Symmetry of a scene in three dimensions (`symmetry`): whether all of it is computed, its half z
>= 0, or the quarter x >= 0, z >= 0.
"""

import numpy as np

from ..failure import BadInput
from ..input.dimension import SOLID
from .bodies import Body
from .obstacles import Obstacle

__all__ = ["COPIES", "MIRROR_AXES", "copies"]

COPIES = {"full": 1, "half": 2, "quarter": 4}
MIRROR_AXES = {1: (), 2: (2,), 4: (0, 2)}  # normals of the planes of symmetry, by symmetry factor
AXES = "xyz"


def copies(scene) -> int:
    """Returns the symmetry factor 1, 2 or 4: whole scene over computed part. It is 1 in the plane.
    Raises BadInput if the scene has less symmetry than its entry demands.
    """
    if scene.dimension is not SOLID:
        return 1
    symmetry = scene.content.get("symmetry", "auto")
    across_z = _broken(scene, 2)
    across_x = across_z or _broken(scene, 0)
    if symmetry == "auto":
        return 1 if across_z else 2 if across_x else 4
    why = {"full": "", "half": across_z, "quarter": across_x}[symmetry]
    if why:
        raise BadInput(
            f"symmetry: {symmetry}, but {why} (accepted: auto|full{'' if across_z else '|half'})"
        )
    return COPIES[symmetry]


def _broken(scene, axis: int) -> str:
    """Returns what has no mirror image in the plane through the origin normal to an axis, "" if the
    scene is symmetric.
    """
    plane = f"the plane {AXES[axis]} = 0"
    if axis == 0 and scene.values["body_force_x"]:
        return "body_force_x pushes along x"
    for body in scene.bodies:
        if why := _of_body(body, axis, plane):
            return f"'{body.name}' {why}"
    for obstacle in scene.obstacles:
        if _of_obstacle(obstacle, axis):
            return f"'{obstacle.name}' is not its own mirror image in {plane}"
    return ""


def _of_body(body: Body, axis: int, plane: str) -> str:
    normal = np.eye(3)[axis]
    if body.position[axis] != 0:
        return f"has its centre off {plane}"
    if body.velocity[axis] != 0:
        return f"moves along {AXES[axis]}"
    if np.delete(body.spin, axis).any():  # a reflection keeps an axial vector along the normal
        return f"spins out of {plane}"
    if any(body.moments):
        return "has moments of inertia of its own"
    if body.mesh or body.outline.geometry:
        return "is a file's"
    if not body.outline.shape.is_mirrored(body.placed.rotation.T @ normal):
        return f"is not its own mirror image in {plane}"
    return _of_conditions(body, axis, plane)


def _of_conditions(body: Body, axis: int, plane: str) -> str:
    """Returns which support or load of a body has no mirror image or acts along the axis, "" if
    none.
    """
    for kind, listed in (("support", body.supports), ("load", body.loads)):
        if not all(condition.part.is_mirrored(axis, body.placed.rotation) for condition in listed):
            return f"has a {kind} that is not its own mirror image in {plane}"
    moved = [
        (support.fixed[axis] or support.normal) and not support.motion[axis].is_constant
        for support in body.supports
    ]
    pushed = [load.kind == "traction" and not load.functions[axis].is_zero for load in body.loads]
    if any(moved) or any(pushed):
        return f"has a {'support' if any(moved) else 'load'} that acts along {AXES[axis]}"
    return ""


def _of_obstacle(obstacle: Obstacle, axis: int) -> bool:
    if obstacle.drive and (
        not obstacle.drive.translation[axis].is_zero or not obstacle.drive.turn.is_constant
    ):
        return True
    return obstacle.velocity[axis] != 0 or not obstacle.is_mirrored(axis)
