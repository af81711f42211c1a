"""Helpers that the modules test_bodies_3d.py share."""

import math

import numpy as np

from ffimpact.mesh import mesh, solid_mesh
from ffimpact.scene import SCENES, Scene, read as read_scene

BALL = {"name": "ball", "shape": "ball", "radius": 0.05, "position": [0, 0.051, 0], "velocity": [0, -8, 0]}
BLOCK = {"name": "block", "shape": "box", "width": 0.24, "height": 0.08, "depth": 0.2, "position": [0, -0.04, 0]}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, -0.5, 0], "normal": [0, 1, 0]}
SCENE = {"dimension": "3d", "law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "accuracy": 0.1}


def read(*tables: dict, obstacles=(FLOOR,), folder=SCENES, **top) -> Scene:
    return read_scene(SCENE | top | {"body": [{"position": [0, 0, 0]} | table for table in tables], "obstacle": list(obstacles)}, folder, "scene")


# ---- recognition of round surfaces in a file

def prism(corners: int, path) -> None:
    """Writes a prism of radius 0.05 and height 0.08 along y in Medit's format. All vertices but the
    central one lie on one sphere."""
    turn = 2 * math.pi * np.arange(corners) / corners
    points = np.vstack([[[0, 0, 0]], *(np.column_stack([0.05 * np.cos(turn), np.full(corners, y), 0.05 * np.sin(turn)]) for y in (-0.04, 0.04))])
    k = np.arange(corners)
    low, high = 1 + k, 1 + corners + k
    sides = np.vstack([np.column_stack(columns) for columns in ((low, high, np.roll(high, -1)),
                                                                (low, np.roll(high, -1), np.roll(low, -1)))])
    ends = np.vstack([np.column_stack([np.full(corners - 2, indices[0]), indices[1:-1], indices[2:]]) for indices in (low, high)])
    cells = solid_mesh.right_handed(points, np.column_stack([np.zeros(4 * corners - 4, dtype=int), np.vstack([sides, ends])]))
    faces = mesh.boundary(cells)
    solid_mesh.write(solid_mesh.SolidMesh(points, cells, faces, np.ones(len(faces), dtype=int)), np.zeros(len(cells), dtype=int), path)
