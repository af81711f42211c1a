"""Rigid obstacles with the surface of an STL file or of a mesh."""

import math

import numpy as np
import pytest

from ffimpact.__main__ import main
from ffimpact.mesh import surface_file
from ffimpact.report import drawing
from tests.support.surfaces import SCENE, run, slab, sphere


def test_a_slab_is_a_plane(tmp_path):
    """They agree to the accuracy of the solver. The file is beside the scene, in mm, and is copied
    to the results."""
    slab(tmp_path / "slab.stl")
    sizes = {"mesh_size": 0.03, "contact_mesh_size": 0.02}
    summary = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"\nscale = 0.001', **sizes)
    plane = run(tmp_path, 'kind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]', name="plane", **sizes)
    assert plane["sliding_time"] > 0 < plane["sticking_time"]
    for name in ("impulse", "rebound_vx", "rebound_vy", "rebound_spin", "friction_work"):
        assert summary[name] == pytest.approx(plane[name], rel=1e-6), name
    assert summary["energy_drift"] < 1e-9
    assert list((tmp_path / "scene" / "body-files").glob("*.stl"))
    assert drawing.pictures(tmp_path / "scene")["shapes"]()


def test_a_fine_surface_is_read_whole(tmp_path):
    """8192 triangles, oriented outwards, with the volume of the sphere."""
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
    """One line with the entry, exit code 10."""
    slab(tmp_path / "slab.stl")
    lines = (tmp_path / "slab.stl").read_text().split("facet normal")
    (tmp_path / "open.stl").write_text("facet normal".join(lines[:-1]) + "endsolid one\n")
    (tmp_path / "text.stl").write_text("no surface\n")
    file = tmp_path / "scene.toml"
    file.write_text(SCENE.format(obstacle='kind = "surface"\n' + what, position="[0, 0.0501, 0]"))
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    message = capsys.readouterr().err
    assert named in message and message.startswith("ffimpact: ")
