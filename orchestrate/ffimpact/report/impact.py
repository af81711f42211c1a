"""The impact of a single disc or ball on the plane y = 0, as the paper describes it: speed and angle
instead of the tables of a scene. Figures and published numbers are about it.
"""

import math
from collections.abc import Mapping
from typing import Any

from ..input import dimension
from ..input.materials import MATERIAL
from ..output.results import Contents

__all__ = ["KINDS", "impact_of"]

# The kinds of impacts, by the dimension of the scene and the shape of its body.
KINDS = {
    ("plane-strain", "disc"): "disc",
    ("axisymmetric", "ball"): "ball-axisymmetric",
    ("3d", "ball"): "ball",
}
ROUND_OFF = 1e-9


def impact_of(scene: Mapping[str, Any]) -> dict[str, Any] | None:
    """Returns what a scene as used is as an impact: its `kind` (KINDS), entries of the scene, of the
    material and of the contact, tables of layers, radius [m], speed [m/s], angle of the velocity to the plane
    [degrees], spin [rad/s], and height above the plane [m].

    Returns None if the scene is no disc or ball alone above the plane y = 0 without motion,
    supports and loads.
    """
    bodies, obstacles = scene.get("body", []), scene.get("obstacle", [])
    if len(bodies) != 1 or len(obstacles) != 1 or not _is_ground(obstacles[0]):
        return None
    body, word = bodies[0], scene.get("dimension", dimension.PLANE_STRAIN.name)
    kind = KINDS.get((word, body.get("shape")))
    if not kind or body.get("rigid") or body.get("support") or body.get("load"):
        return None
    axes = dimension.DIMENSIONS[word].axes
    x, y, *z = _vector(body.get("position", 0.0), axes)
    vx, vy, *vz = _velocity(body, axes)
    spin = body.get("spin", 0.0)
    if any(z) or any(vz) or vy > 0 or not isinstance(spin, int | float):
        return None
    own = {name: body[name] for name in MATERIAL if name in body}
    contact = {name: value for name, value in scene.get("contact", {}).items() if name != "pair"}
    own |= {
        name: value
        for pair in scene.get("contact", {}).get("pair", [])
        for name, value in pair.items()
    }
    entries = {
        name: value for name, value in scene.items() if name not in ("body", "obstacle", "contact")
    }
    # Left and right are alike: the angle is at most 90 degrees, the body moves along x.
    angle = math.degrees(math.atan2(-vy, abs(vx))) if vx or vy else 90.0
    impact = (
        entries
        | contact
        | own
        | {
            "kind": kind,
            "layer": body.get("layer", []),
            "radius": body["radius"],
            "speed": _rounded(math.hypot(vx, vy)),
            "angle": _rounded(angle),
            "spin": spin if vx >= 0 else -spin,
            "height": y - body["radius"]
            if y - body["radius"] > ROUND_OFF * body["radius"]
            else 0.0,
        }
    )
    return Contents(impact, scene.path) if isinstance(scene, Contents) else impact


def _is_ground(obstacle: Mapping[str, Any]) -> bool:
    """Whether an obstacle is the plane y = 0 with its normal along y, at rest."""
    normal = obstacle.get("normal", [0.0, 1.0])
    moves = any(name in obstacle for name in ("velocity", "motion", "rotation"))
    ground = obstacle["kind"] == "plane" and obstacle.get("point", [0.0, 0.0])[1] == 0
    return ground and not moves and normal[1] > 0 and not any((normal[0], *normal[2:]))


def _velocity(body: Mapping[str, Any], axes: int) -> list[float]:
    if "speed" in body:
        turn = math.radians(body["direction"])
        along = [body["speed"] * math.cos(turn), body["speed"] * math.sin(turn), 0.0][:axes]
        return [0.0 if abs(v) < ROUND_OFF * body["speed"] else v for v in along]
    return _vector(body.get("velocity", 0.0), axes)


def _vector(value: Any, axes: int) -> list[float]:
    """Returns the components of an entry; of revolution a number is that along y."""
    return list(value) if isinstance(value, list | tuple) else [0.0, float(value), 0.0][:axes]


def _rounded(value: float) -> float:
    return float(f"{value:.12g}")
