"""Helpers that the modules test_surfaces.py share."""

import json
from pathlib import Path

import numpy as np

from ffimpact.__main__ import main

SCENE = """
dimension = "3d"
symmetry = "full"
law = "neohookean"
young = 1e6
nu = 0.3
density = 1000
accuracy = 0.3
[[body]]
shape = "ball"
radius = 0.05
position = {position}
velocity = [0.5, -1, 0]
[[obstacle]]
{obstacle}
[contact]
friction_static = 0.3
"""


def stl(path: Path, points: np.ndarray, triangles: np.ndarray) -> Path:
    """Writes an ASCII STL file."""
    with open(path, "w") as file:
        file.write("solid one\n")
        for corners in points[triangles]:
            file.write("facet normal 0 0 0\nouter loop\n")
            file.writelines("vertex {!r} {!r} {!r}\n".format(*map(float, vertex)) for vertex in corners)
            file.write("endloop\nendfacet\n")
        file.write("endsolid one\n")
    return path


def slab(path: Path, size=(200.0, 50.0, 200.0)) -> Path:
    """Writes a box with its top at y = 0."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 0) for z in (-1, 1)]) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return stl(path, corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))


def sphere(path: Path, radius: float, splits: int) -> Path:
    """Writes a sphere about (0, -radius, 0): an octahedron whose triangles are split repeatedly."""
    points = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], dtype=float)
    corners = np.array([points[[i, j, k]] if ((i > 2) + (j > 2) + (k > 2)) % 2 == 0 else points[[i, k, j]]
                        for i in (0, 3) for j in (1, 4) for k in (2, 5)])
    for _ in range(splits):
        a, b, c = corners.transpose(1, 0, 2)
        ab, bc, ca = a + b, b + c, c + a
        corners = np.vstack([np.stack(triangle, axis=1) for triangle in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        corners /= np.linalg.norm(corners, axis=2, keepdims=True)
    return stl(path, (radius * corners - [0, radius, 0]).reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def run(tmp_path, obstacle: str, position="[0.01, 0.0501, 0.003]", name="scene", **sizes: float) -> dict:
    """The summary of a ball, with these element sizes, that hits the obstacle."""
    file, out = tmp_path / f"{name}.toml", tmp_path / name
    file.write_text(SCENE.format(obstacle=obstacle, position=position))
    assert main(["run", str(file), "--out", str(out), "--quiet", "--no-figures", "--no-estimate",
                 *(word for size, value in sizes.items() for word in ("--set", f"{size}={value}"))]) == 0
    return json.loads((out / "summary.json").read_text())
