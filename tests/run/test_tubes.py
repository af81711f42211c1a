"""Bodies of revolution that do not reach the axis: tubes, rings, O-rings."""

import math

import numpy as np
import pytest

from ffimpact.__main__ import main
from tests.support.tubes import HEAD, run


def test_a_tube_on_its_end_is_a_bar(tmp_path):
    """nu = 0: it leaves with its speed after 2 h/c, within the error estimates. Its mass is that of
    Pappus' theorem."""
    summary = run(tmp_path, 'shape = "tube"\nradius = 0.03\ninner_radius = 0.02\nheight = 0.1\nposition = [0, 0.0501]')
    error = summary["estimated_error"]
    assert abs(summary["restitution"] - 1) < error["rebound"] < 0.05
    exact = 2 * 0.1 / math.sqrt(1000)
    assert abs(summary["contact_time"] / exact - 1) < error["contact_time"]
    assert summary["mass"] == pytest.approx(1000 * math.pi * (0.03**2 - 0.02**2) * 0.1, rel=1e-12)
    assert summary["energy_drift"] < 1e-8 and summary["momentum_drift"] < 1e-10


def test_an_o_ring_has_the_mass_of_a_torus(tmp_path):
    """The mass is 2 pi R pi r^2 times the density, on curved elements. Energy and momentum are
    conserved."""
    summary = run(tmp_path, 'shape = "torus"\nradius = 0.03\nsection = 0.01\nposition = [0, 0.0101]', nu=0.3)
    assert summary["mass"] == pytest.approx(1000 * 2 * math.pi * 0.03 * math.pi * 0.01**2, rel=1e-3)
    assert summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-10 and 0.5 < summary["restitution"] < 1


def test_a_ball_is_caught_by_a_ring(tmp_path):
    """It falls on the round inner edge of the ring, and both are driven apart without overlap."""
    ball = '[[body]]\nshape = "ball"\nradius = 0.025\nposition = [0, 0.0445]\nvelocity = [0, -0.3]\n'
    summary = run(tmp_path, 'shape = "torus"\nradius = 0.03\nsection = 0.01\nposition = [0, 0.0101]', nu=0.3, accuracy=0.1, beside=ball)
    assert summary["energy_drift"] < 1e-8 and not any("overlap" in warning for warning in summary["warnings"])


def test_a_mesh_file_beside_the_axis(tmp_path):
    """FreeFEM's .msh of a rectangle at x > 0 is the same tube."""
    n, m = 2, 12
    x, y = np.meshgrid(np.linspace(0.02, 0.03, n + 1), np.linspace(0, 0.1, m + 1), indexing="ij")
    number = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1) + 1
    cells = [(number[i, j], number[i + 1, j], number[i + 1, j + 1]) for i in range(n) for j in range(m)]
    cells += [(number[i, j], number[i + 1, j + 1], number[i, j + 1]) for i in range(n) for j in range(m)]
    ring = [*number[:, 0], *number[-1, 1:], *number[-2::-1, -1], *number[0, -2:0:-1]]
    lines = [f"{(n + 1) * (m + 1)} {len(cells)} {len(ring)}", *(f"{a} {b} 1" for a, b in zip(x.ravel(), y.ravel())),
             *(f"{a} {b} {c} 0" for a, b, c in cells), *(f"{a} {b} 1" for a, b in zip(ring, ring[1:] + ring[:1]))]
    (tmp_path / "tube.msh").write_text("\n".join(lines) + "\n")
    summary = run(tmp_path, 'shape = "mesh"\nfile = "tube.msh"\nposition = [0, 0.0501]')
    assert summary["mass"] == pytest.approx(1000 * math.pi * (0.03**2 - 0.02**2) * 0.1, rel=1e-12)
    assert summary["restitution"] == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("entries, named", [
    ('shape = "shell"\nradius = 0.03\ninner_radius = 0.04', "body.1.inner_radius"),
    ('shape = "tube"\nradius = 0.03\ninner_radius = 0.03\nheight = 0.1', "body.1.inner_radius"),
    ('shape = "torus"\nradius = 0.03\nsection = 0.03', "body.1.section"),
    ('shape = "polygon"\nvertices = [[0.0, 0], [0.03, 0], [0.03, 0.1], [0.02, 0.1]]', "body.1.vertices"),
    ('shape = "polygon"\nvertices = [[-0.01, 0], [0.03, 0], [0.03, 0.1]]', "body.1.vertices"),
    ('shape = "polygon"\nvertices = [[0.02, 0], [0.03, 0.1], [0.03, 0], [0.02, 0.1]]', "body.1.vertices")])
def test_wrong_sections(tmp_path, capsys, entries, named):
    """One line with the entry, exit code 10."""
    file = tmp_path / "scene.toml"
    file.write_text(HEAD.format(nu=0.0, accuracy=0.1) + entries + "\nposition = [0, 0.1]\n")
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    message = capsys.readouterr().err
    assert named in message and message.count("\n") == 1


def test_a_wall_too_thin_to_mesh_is_refused(tmp_path, capsys):
    """The refusal is immediate, in place of a mesh of millions of elements."""
    scene = tmp_path / "thin.toml"
    scene.write_text('dimension = "axisymmetric"\nlaw = "neohookean"\nyoung = 7e6\nnu = 0.45\ndensity = 1000\n[[body]]\nshape = "shell"\nradius = 0.05\n'
                     'inner_radius = 0.0499999\nposition = 0.06\nvelocity = -1\n[[obstacle]]\nkind = "plane"\npoint = [0, 0]\nnormal = [0, 1]\n')
    assert main(["run", str(scene), "--out", str(tmp_path / "out")]) == 10
    assert capsys.readouterr().err.startswith("ffimpact: mesh_size: ")
