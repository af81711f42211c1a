"""Rigid obstacles whose surface is that of an STL file or of a mesh."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from ffimpact.__main__ import main
from ffimpact.mesh import surface_file

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
    """Writes an ASCII STL."""
    with open(path, "w") as file:
        file.write("solid one\n")
        for corners in points[triangles]:
            file.write("facet normal 0 0 0\nouter loop\n")
            file.writelines("vertex {!r} {!r} {!r}\n".format(*map(float, one)) for one in corners)
            file.write("endloop\nendfacet\n")
        file.write("endsolid one\n")
    return path


def slab(path: Path, size=(200.0, 50.0, 200.0)) -> Path:
    """A box with its top at y = 0."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 0) for z in (-1, 1)]) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return stl(path, corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))


def sphere(path: Path, radius: float, splits: int) -> Path:
    """An octahedron, its triangles split again and again, on a sphere about (0, -radius, 0)."""
    points = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], dtype=float)
    corners = np.array([points[[i, j, k]] if ((i > 2) + (j > 2) + (k > 2)) % 2 == 0 else points[[i, k, j]]
                        for i in (0, 3) for j in (1, 4) for k in (2, 5)])
    for _ in range(splits):
        a, b, c = corners.transpose(1, 0, 2)
        ab, bc, ca = a + b, b + c, c + a
        corners = np.vstack([np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        corners /= np.linalg.norm(corners, axis=2, keepdims=True)
    return stl(path, (radius * corners - [0, radius, 0]).reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def run(tmp_path, obstacle: str, position="[0.01, 0.0501, 0.003]", name="scene") -> dict:
    """The summary of a ball that hits the obstacle."""
    file, out = tmp_path / f"{name}.toml", tmp_path / name
    file.write_text(SCENE.format(obstacle=obstacle, position=position))
    assert main(["run", str(file), "--out", str(out), "--quiet"]) == 0
    return json.loads((out / "summary.json").read_text())


def test_a_slab_is_a_plane(tmp_path):
    """To the accuracy of the solver; the file stands beside the scene, in mm, and a copy goes into the results."""
    slab(tmp_path / "slab.stl")
    found = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"\nscale = 0.001')
    plane = run(tmp_path, 'kind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]', name="plane")
    for name in ("impulse", "rebound_vx", "rebound_vy", "rebound_spin", "friction_work"):
        assert found[name] == pytest.approx(plane[name], rel=1e-6), name
    assert found["energy_drift"] < 1e-9
    assert list((tmp_path / "scene" / "body-files").glob("*.stl"))


@pytest.mark.robustness
def test_a_ball_on_an_edge_keeps_energy(tmp_path):
    """Points go from the face over the edge to the side."""
    slab(tmp_path / "slab.stl", size=(0.02, 0.05, 0.02))
    found = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"\nrounding = 0.005', position="[0.03, 0.0545, 0.0]")
    assert found["contact_intervals"] > 0 and found["energy_drift"] < 1e-9 and found["momentum_drift"] < 1e-7


@pytest.mark.robustness
def test_a_sphere_converges_with_its_triangles(tmp_path):
    """Gaps and impacts are those of kind = "sphere", by the square of the triangles' size."""
    exact = run(tmp_path, 'kind = "sphere"\ncentre = [0, -0.1, 0]\nradius = 0.1', name="exact")
    off = []
    for splits in (3, 4):
        sphere(tmp_path / f"sphere{splits}.stl", 0.1, splits)
        points, triangles = surface_file.read(tmp_path / f"sphere{splits}.stl")
        assert len(triangles) == 8 * 4**splits and len(points) == 4 * 4**splits + 2
        off.append(abs(run(tmp_path, f'kind = "surface"\nfile = "sphere{splits}.stl"', name=f"s{splits}")["rebound_vy"] - exact["rebound_vy"]))
    assert off[1] < 0.02 and off[1] < max(off[0], 0.005)


@pytest.mark.robustness
def test_position_and_turn(tmp_path):
    """A box on its side is the same plane."""
    slab(tmp_path / "slab.stl", size=(0.2, 0.05, 0.2))
    straight = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"', name="straight")
    moved = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"\nturn = [0, 90, 0]\nposition = [0.02, 0, -0.01]', name="moved")
    assert moved["impulse"] == pytest.approx(straight["impulse"], rel=1e-6)


def test_a_fine_surface_is_read_whole(tmp_path):
    """8192 triangles, turned outward, of the volume of the sphere."""
    points, triangles = surface_file.read(sphere(tmp_path / "fine.stl", 0.1, 5))
    assert len(triangles) == 8192
    a, b, c = points[triangles].transpose(1, 0, 2)
    volume = (a * np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 / 3 * math.pi * 0.1**3, rel=5e-3) and volume > 0


@pytest.mark.parametrize("what, named", [
    ('scale = 1', "obstacle.1.file: is missing"), ('file = "none.stl"', "obstacle.1.file"), ('file = "scene.toml"', "obstacle.1.file"), ('file = "open.stl"', "not closed"),
    ('file = "text.stl"', "obstacle.1.file"), ('file = "slab.stl"\nscale = -1', "obstacle.1.scale"),
    ('file = "slab.stl"\nrounding = -1', "obstacle.1.rounding"), ('fil = "slab.stl"', "obstacle.1.fil")])
def test_wrong_files(tmp_path, capsys, what, named):
    """One line that names the entry, exit code 10."""
    slab(tmp_path / "slab.stl")
    lines = (tmp_path / "slab.stl").read_text().split("facet normal")
    (tmp_path / "open.stl").write_text("facet normal".join(lines[:-1]) + "endsolid one\n")
    (tmp_path / "text.stl").write_text("no surface\n")
    file = tmp_path / "scene.toml"
    file.write_text(SCENE.format(obstacle='kind = "surface"\n' + what, position="[0, 0.0501, 0]"))
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    said = capsys.readouterr().err
    assert named in said and said.startswith("ffimpact: ")
