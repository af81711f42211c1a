"""Helpers that the modules test_bodies_axisymmetric.py share."""

import math

from ffimpact.scene import SCENES, Scene, read as read_scene

BALL = {"name": "ball", "shape": "ball", "radius": 0.5, "position": [0, 1.5], "velocity": -10}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, -1], "normal": [0, 1]}
SCENE = {"dimension": "axisymmetric", "young": 7e6, "nu": 0.45, "density": 1722, "law": "svk"}


def read(*tables: dict, obstacles=(FLOOR,), folder=SCENES, **top) -> Scene:
    return read_scene(SCENE | top | {"body": [{"position": 0} | table for table in tables], "obstacle": list(obstacles)}, folder, "scene")


# ---- shapes

# The volume of each shape.
SHAPES = {
    "ball": ({"shape": "ball", "radius": 0.3}, 4 / 3 * math.pi * 0.027),
    "ellipsoid": ({"shape": "ellipsoid", "semi_axes": [0.3, 0.1]}, 4 / 3 * math.pi * 0.009),
    "cylinder": ({"shape": "cylinder", "radius": 0.2, "height": 0.5}, math.pi * 0.02),
    "cone": ({"shape": "polygon", "vertices": [[0, 1], [0.6, 2], [0, 2]]}, math.pi * 0.12),
    "cone, downwards": ({"shape": "polygon", "vertices": [[0, 2], [0.6, 2], [0, 1]]}, math.pi * 0.12),
}
