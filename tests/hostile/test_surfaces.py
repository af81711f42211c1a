"""Rigid obstacles with the surface of an STL file or of a mesh."""

import pytest

from ffimpact.mesh import surface_file
from tests.support.surfaces import run, slab, sphere


@pytest.mark.robustness
def test_a_ball_on_an_edge_keeps_energy(tmp_path):
    """Contact points pass from the face over the edge to the side."""
    slab(tmp_path / "slab.stl", size=(0.02, 0.05, 0.02))
    summary = run(tmp_path, 'kind = "surface"\nfile = "slab.stl"\nrounding = 0.005', position="[0.03, 0.0545, 0.0]")
    assert summary["contact_intervals"] > 0 and summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-7


@pytest.mark.robustness
def test_a_sphere_converges_with_its_triangles(tmp_path):
    """Gaps and impacts converge to those of kind = "sphere", quadratically in the size of the
    triangles."""
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
