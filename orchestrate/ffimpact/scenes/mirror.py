"""Symmetry of a scene. It decides whether all of it is computed, in the plane its half x >= 0, or in
three dimensions its half z >= 0 or the quarter x >= 0, z >= 0 (`symmetry`). It also makes velocities
and spins zero.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..failure import BadInput
from ..geometry.outlines import rotation
from ..input.bodies import Body
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from ..input.obstacles import Obstacle
from ..mesh import revolution
from ..mesh.solids import Solid

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["COPIES", "copies", "mirror_axes", "symmetric_along"]

COPIES = {"full": 1, "half": 2, "quarter": 4}
AXES = "xyz"
# Largest distance between an outline and its mirror image that is round-off, over the bounding
# radius of the bodies. Points at which obstacles are compared with their mirror images.
ALIKE, SAMPLES = 1e-9, 500


def mirror_axes(dimension: Dimension, copies: int) -> tuple[int, ...]:
    """Returns the normals (0: x, 1: y, 2: z) of the planes on one side of which bodies are computed, by
    the symmetry factor `copies`. Of revolution this is the half x >= 0 of their sections.
    """
    if dimension is SOLID:
        return {1: (), 2: (2,), 4: (0, 2)}[copies]
    return (0,) if dimension is AXISYMMETRIC or copies == 2 else ()


def copies(scene: Scene) -> int:
    """Returns the symmetry factor 1, 2 or 4: whole scene over computed part. Of revolution it is 1.
    Raises BadInput if the scene has less symmetry than its entry demands.
    """
    if scene.kind is AXISYMMETRIC:
        return 1
    symmetry = scene.symmetry or "auto"
    if scene.kind is SOLID:
        half = _broken(scene, 2)
        quarter = half or _broken(scene, 0)
    else:
        half, quarter = _broken_in_plane(scene), "the scene is in the plane"
    if symmetry == "auto":
        return 1 if half else 2 if quarter else 4
    why = {"full": "", "half": half, "quarter": quarter}[symmetry]
    if why:
        raise BadInput(
            f"symmetry: {symmetry}, but {why} (accepted: auto|full{'' if half else '|half'})"
        )
    return COPIES[symmetry]


def symmetric_along(scene: Scene) -> list[str]:
    """Returns the axes along which no body can move, because the scene is its own mirror image in a
    plane normal to the axis. A case of the paper (without bodies) counts as not symmetric.
    """
    if scene.kind is SOLID:
        return [AXES[axis] for axis in (0, 2) if not _broken(scene, axis)]
    planar = scene.bodies and scene.kind is PLANE_STRAIN
    return [AXES[axis] for axis in (0, 1) if planar and _is_mirrored_in_plane(scene, axis)]


def _is_mirrored_in_plane(scene: Scene, axis: int) -> bool:
    """Whether a plane scene is its own mirror image in the line normal to an axis through the centre
    of its first body. Shapes are compared by their signed distances.
    """
    values, at = scene.values, scene.bodies[0].start_position[axis]
    radius = max(body.placed.reach for body in scene.bodies)
    image = np.where(np.arange(2) == axis, -1.0, 1.0)

    def mirrored(points: np.ndarray) -> np.ndarray:
        image_points: np.ndarray = points * image + (1 - image) * at
        return image_points

    def is_its_image(body: Body) -> bool:
        own = np.abs(body.placed.gap(mirrored(body.placed.points))).max() <= ALIKE * radius
        moves = (
            body.start_position[axis] != at
            or body.start_velocity[axis] != 0
            or body.start_spin != 0
        )
        moves = moves or not _has_mirrored_layers(body, axis)
        conditions = body.supports or body.loads
        moves = moves or body.has_fields
        return (
            own and not moves and not (conditions and (at != 0 or _of_conditions(body, axis, "")))
        )

    pulled = values[f"body_force_{AXES[axis]}"] or axis == 1 and values["gravity"]
    if pulled or not all(is_its_image(body) for body in scene.bodies):
        return False
    centres = np.array([body.start_position for body in scene.bodies])
    points = np.random.default_rng(1).uniform(
        centres.min(axis=0) - 2 * radius, centres.max(axis=0) + 2 * radius, (SAMPLES, 2)
    )
    return all(
        obstacle.start_velocity[axis] == 0
        and obstacle.drive is None
        and np.abs(obstacle.gap(points) - obstacle.gap(mirrored(points))).max() <= ALIKE * radius
        for obstacle in scene.obstacles
    )


def _broken_in_plane(scene: Scene) -> str:
    """Returns why the half x >= 0 of a plane scene does not represent all of it, "" if it does."""
    if scene.bodies[0].start_position[0] != 0 or not _is_mirrored_in_plane(scene, 0):
        return "the scene is not its own mirror image in x = 0"
    for k, body in enumerate(scene.bodies):
        if body.file_mesh or body.start_angle or any(body.moments):
            return (
                f"'{body.own_name}' is a file's, is turned, or has a moment of inertia of its own"
            )
        if not revolution.crossing_axis(body.flat_outline):
            return f"'{body.own_name}' has parts that do not cross x = 0"
        if any(pair.first == pair.second == k for pair in scene.pairs):
            return f"'{body.own_name}' may come into contact with itself"
    return ""


def _broken(scene: Scene, axis: int) -> str:
    """Returns what has no mirror image in the plane through the origin normal to an axis, "" if the
    scene is symmetric.
    """
    plane = f"the plane {AXES[axis]} = 0"
    if axis == 0 and scene.values["body_force_x"]:
        return "body_force_x pushes along x"
    for body in scene.bodies:
        if why := _of_body(body, axis, plane):
            return f"'{body.own_name}' {why}"
    for obstacle in scene.obstacles:
        if _of_obstacle(obstacle, axis):
            return f"'{obstacle.own_name}' is not its own mirror image in {plane}"
    return ""


def _has_mirrored_layers(body: Body, axis: int) -> bool:
    """Whether the layers of a body are their own mirror image in the plane normal to an axis. Those of
    a file count as not.
    """
    if any(layer.group is not None for layer in body.layers):
        return False
    regions = [layer.part for layer in body.layers if layer.radius is None]
    turned = bool(np.any(body.start_angle))
    axes = np.eye(body.dimension.axes)
    return all(not turned and part.is_mirrored(axis, axes) for part in regions)


def _of_body(body: Body, axis: int, plane: str) -> str:
    normal = np.eye(3)[axis]
    if not _has_mirrored_layers(body, axis):
        return f"has a layer that is not its own mirror image in {plane}"
    if body.start_position[axis] != 0:
        return f"has its centre off {plane}"
    if body.start_velocity[axis] != 0:
        return f"moves along {AXES[axis]}"
    if body.has_fields:
        return "has a field at the start"
    if np.delete(
        body.start_spin, axis
    ).any():  # a reflection keeps an axial vector along the normal
        return f"spins out of {plane}"
    if any(body.moments):
        return "has moments of inertia of its own"
    placed = body.placed
    if body.file_mesh or not isinstance(placed, Solid) or placed.geometry:
        return "is a file's"
    if not placed.shape.is_mirrored(placed.rotation.T @ normal):
        return f"is not its own mirror image in {plane}"
    return _of_conditions(body, axis, plane)


def _of_conditions(body: Body, axis: int, plane: str) -> str:
    """Returns which support or load of a body has no mirror image or acts along the axis, "" if
    none.
    """
    placed = body.placed
    turned = placed.rotation if isinstance(placed, Solid) else rotation(body.start_angle)
    for kind, listed in (("support", body.supports), ("load", body.loads)):
        if not all(condition.part.is_mirrored(axis, turned) for condition in listed):
            return f"has a {kind} that is not its own mirror image in {plane}"
    moved = [
        (support.fixed[axis] or support.normal) and not support.functions[axis].is_zero
        for support in body.supports
    ]
    pushed = [load.kind == "traction" and not load.functions[axis].is_zero for load in body.loads]
    if any(moved) or any(pushed):
        return f"has a {'support' if any(moved) else 'load'} that acts along {AXES[axis]}"
    return ""


def _of_obstacle(obstacle: Obstacle, axis: int) -> bool:
    if obstacle.drive and (
        not obstacle.drive.translation[axis].is_zero or not obstacle.drive.turn.is_zero
    ):
        return True
    return obstacle.start_velocity[axis] != 0 or not obstacle.is_mirrored(axis)
