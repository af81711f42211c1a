"""Symmetry of a scene in three dimensions (`symmetry`): whether all of it is computed, its half z
>= 0, or the quarter x >= 0, z >= 0.
"""

import numpy as np

from ..failure import BadInput
from ..geometry import implicit
from ..input.dimension import SOLID
from .bodies import Body
from .obstacles import Obstacle

__all__ = ["COPIES", "FOLDED", "copies"]

COPIES = {"full": 1, "half": 2, "quarter": 4}
FOLDED = {1: (), 2: (2,), 4: (0, 2)}  # normals of the planes of symmetry, by symmetry factor
AXES = "xyz"


def copies(scene) -> int:
    """Returns the symmetry factor 1, 2 or 4: whole scene over computed part. It is 1 in the plane.
    Raises BadInput if the scene has less symmetry than its entry demands.
    """
    if scene.dimension is not SOLID:
        return 1
    asked = scene.given.get("symmetry", "auto")
    across_z = _broken(scene, 2)
    across_x = across_z or _broken(scene, 0)
    if asked == "auto":
        return 1 if across_z else 2 if across_x else 4
    why = {"full": "", "half": across_z, "quarter": across_x}[asked]
    if why:
        raise BadInput(
            f"symmetry: {asked}, but {why} (accepted: auto|full{'' if across_z else '|half'})"
        )
    return COPIES[asked]


def _broken(scene, axis: int) -> str:
    """Returns what has no mirror image in the plane through the origin normal to an axis, "" if the
    scene is symmetric.
    """
    plane = f"the plane {AXES[axis]} = 0"
    if axis == 0 and scene.values["body_force_x"]:
        return "body_force_x pushes along x"
    for one in scene.bodies:
        if why := _of_body(one, axis, plane):
            return f"'{one.name}' {why}"
    for one in scene.obstacles:
        if _of_obstacle(one, axis):
            return f"'{one.name}' is not its own mirror image in {plane}"
    return ""


def _of_body(one: Body, axis: int, plane: str) -> str:
    normal = np.eye(3)[axis]
    if one.position[axis] != 0:
        return f"has its centre off {plane}"
    if one.velocity[axis] != 0:
        return f"moves along {AXES[axis]}"
    if np.delete(one.spin, axis).any():  # a reflection keeps an axial vector along the normal
        return f"spins out of {plane}"
    if any(one.moments):
        return "has moments of inertia of its own"
    if one.mesh or one.outline.geometry:
        return "is a file's"
    if not one.outline.shape.is_mirrored(one.placed.rotation.T @ normal):
        return f"is not its own mirror image in {plane}"
    return _of_conditions(one, axis, plane)


def _of_conditions(one: Body, axis: int, plane: str) -> str:
    """Returns which support or load of a body has no mirror image or acts along the axis, "" if
    none.
    """
    for kind, listed in (("support", one.supports), ("load", one.loads)):
        if not all(each.part.is_mirrored(axis, one.placed.rotation) for each in listed):
            return f"has a {kind} that is not its own mirror image in {plane}"
    moved = [
        (each.fixed[axis] or each.normal) and not each.motion[axis].is_constant
        for each in one.supports
    ]
    pushed = [each.kind == "traction" and not each.functions[axis].is_zero for each in one.loads]
    if any(moved) or any(pushed):
        return f"has a {'support' if any(moved) else 'load'} that acts along {AXES[axis]}"
    return ""


def _of_obstacle(one: Obstacle, axis: int) -> bool:
    if one.drive and (not one.drive.way[axis].is_zero or not one.drive.turn.is_constant):
        return True
    if one.kind == "surface":
        return True
    if one.kind == "implicit":
        return one.velocity[axis] != 0 or not implicit.is_mirrored(one.numbers[2:], axis, 3)
    across = one.numbers[3 + axis] if one.kind == "plane" else one.numbers[axis]
    return across != 0 or one.velocity[axis] != 0
