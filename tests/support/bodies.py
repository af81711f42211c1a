"""Helpers that the modules test_bodies.py share."""

import copy

from ffimpact.scene import SCENES, Scene, read as read_scene
from ffimpact.scenes.entries import set_entry

DISC = {"name": "disc", "shape": "disc", "radius": 0.5, "position": [0, 1.5], "velocity": [0, -10]}
BLOCK = {"name": "block", "shape": "rectangle", "width": 10, "height": 2, "position": [0, 0]}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, -1], "normal": [0, 1]}
SCENE = {"young": 7e6, "nu": 0.45, "density": 1722, "law": "svk", "body": [DISC, BLOCK]}
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def read(tables: dict, folder=SCENES) -> Scene:
    return read_scene(tables, folder, "scene")


def with_body(**entries) -> dict:
    """A scene of one body with these entries."""
    return SCENE | {"body": [{"position": [0, 0]} | entries]}


def changed(*entries: tuple) -> dict:
    tables = copy.deepcopy(SCENE | {"obstacle": [FLOOR]})
    for name, value in entries:
        tables = set_entry(tables, name, value)
    return tables
