"""Scenes of former versions, whose scripts took flat entries (speed, angle, height), as the tables
that take their place. So result folders of these versions are read like others.
"""

from collections.abc import Mapping
from typing import Any

from ..input.contact import CONTACT, Contact
from ..input.materials import MATERIAL

__all__ = ["SCRIPTS", "tables"]

# By former script: the script that has taken its place, and the dimension.
SCRIPTS = {
    "disc-plane": ("bodies", "plane-strain"),
    "disc-block": ("bodies", "plane-strain"),
    "ball-axisymmetric": ("bodies-axisymmetric", "axisymmetric"),
    "ball-plane": ("bodies-3d", "3d"),
}
AXES = {"plane-strain": 2, "axisymmetric": 2, "3d": 3}
SIZES = ("mesh_size", "contact_mesh_size")
OF_THE_SCRIPT = (
    "radius",
    "speed",
    "angle",
    "spin",
    "height",
    "block_width",
    "block_height",
    "mesh",
)


def tables(flat: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the tables of a scene with flat entries. Of a scene of tables, pairings are left out."""
    if flat.get("script") not in SCRIPTS or "body" in flat:
        contact = {
            name: value
            for name, value in flat.get("contact", {}).items()
            if name in Contact.model_fields
        }
        return dict(flat) | ({"contact": contact} if "contact" in flat else {})
    script, dimension = SCRIPTS[flat["script"]]
    ball, radius = flat["script"].startswith("ball"), flat["radius"]
    material = {name: flat[name] for name in (*MATERIAL, *SIZES) if name in flat}
    place = [0.0, flat.get("height", 0.0) + radius, 0.0]
    first: dict[str, Any] = {
        "name": "ball" if ball else "disc",
        "shape": "ball" if ball else "disc",
    }
    first |= {"radius": radius, "position": place[: AXES[dimension]]}
    first |= {"speed": flat["speed"], "direction": -flat.get("angle", 90.0)}
    first |= {"spin": flat["spin"]} if flat.get("spin") else {}
    bodies, obstacles = [first | material], []
    if flat["script"] == "disc-block":
        width, height = flat["block_width"], flat["block_height"]
        block = {"name": "block", "shape": "rectangle", "width": width, "height": height}
        bodies.append(block | {"position": [0.0, -height / 2]} | material)
    else:
        normal = [0.0, 1.0, 0.0][: AXES[dimension]]
        point = [0.0] * AXES[dimension]
        obstacles.append({"name": "plane", "kind": "plane", "point": point, "normal": normal})
    taken = (*OF_THE_SCRIPT, *material, *CONTACT, "script")
    top = {name: value for name, value in flat.items() if name not in taken}
    contact = {name: flat[name] for name in CONTACT if name in flat}
    return (
        {"title": first["name"], "script": script, "dimension": dimension}
        | top
        | {"body": bodies, "obstacle": obstacles, "contact": contact}
    )
