"""Supports: parts of a boundary that are held or moved, with beams, rods and pressed discs."""

import numpy as np
import pytest

from tests.support.checkpoint import assert_same, direct, killed_at
from tests.support.supports import RUBBED, SOFT, energy
from verification.measure import bodies, outcome, prepared


@pytest.mark.robustness
def test_stacked_cantilevers_rub(tmp_path):
    """The scene V5.02.140 of code_aster: two beams of 1 x 0.1 m, E = 200 GPa, nu = 0, 7800 kg/m3,
    on each other with friction 0.2.

    They are clamped at x = 0, and a force acts on the upper one from the start (10 kN/m; the source
    does not print it). The initial gap is 1 um. The beams bend together: friction takes energy, the
    balance closes, and both clamps carry the force in the mean.
    """
    beams = [{"name": name, "shape": "rectangle", "width": 1, "height": 0.1, "position": [0.5, y], "mesh_size": 0.05,
              "contact_mesh_size": 0.05, "support": [{"where": "left"}]} for name, y in (("lower", 0), ("upper", 0.100001))]
    beams[1]["load"] = [{"where": "right", "traction": [0, -1e5]}]
    run = bodies(tmp_path, {"law": "svk", "young": 2e11, "nu": 0, "density": 7800, "accuracy": 0.1, "end_time": 0.012, "body": beams,
                            "contact": {"friction_static": 0.2}})
    history = run.history
    assert abs(history["balance"]).max() < 1e-9 * energy(history).max() and run.summary["friction_work"] > 1e-3 * energy(history).max()
    assert run.summary["momentum_drift"] < 1e-8 and run.summary["angular_momentum_drift"] < 1e-8
    forces = sum(np.average(history[f"support_force_y_{k}"][1:], weights=history["dt"][1:]) for k in (1, 2))
    assert forces == pytest.approx(1e4, rel=0.1)


# ---- symmetry in space

def cantilever(symmetry: str, **support) -> dict:
    """A ball falls on the middle of a clamped beam."""
    beam = {"name": "beam", "shape": "box", "width": 0.12, "height": 0.02, "depth": 0.04, "position": [0, 0, 0], "mesh_size": 0.01,
            "contact_mesh_size": 0.01, "support": [{"where": "left"} | support], "load": [{"where": "bottom", "pressure": 1e3}]}
    ball = {"name": "ball", "shape": "ball", "radius": 0.02, "position": [0.03, 0.0305, 0], "velocity": [0, -1, 0],
            "mesh_size": 0.015, "contact_mesh_size": 0.01}
    return SOFT | {"dimension": "3d", "symmetry": symmetry, "accuracy": 0.3, "end_time": 3e-3, "body": [beam, ball]}


@pytest.mark.robustness
def test_symmetric_supports_keep_the_symmetry(tmp_path):
    """Half of a ball on a clamped beam gives the forces, moments and works of the whole, to the
    difference of such coarse meshes."""
    whole, half = (bodies(tmp_path / word, cantilever(word)) for word in ("full", "half"))
    assert half.summary["dofs"] < 0.7 * whole.summary["dofs"] and half.summary["momentum_drift"] < 1e-8
    assert half.summary["impulse"] == pytest.approx(whole.summary["impulse"], rel=0.03)
    for name in ("support_force_y_1", "support_moment_1"):
        ours, theirs = half.history[name], np.interp(half.history["t"], whole.history["t"], whole.history[name])
        assert np.abs(ours - theirs).max() < 0.12 * np.abs(theirs).max(), name
    assert half.summary["load_work"] == pytest.approx(whole.summary["load_work"], rel=0.1)


# ---- restart

@pytest.mark.robustness
def test_half_a_run_with_supports_and_the_rest_are_the_whole(tmp_path):
    """A run that is killed before and after the release of the support continues with unchanged
    results."""
    scene = RUBBED | {"body": [RUBBED["body"][0] | {"support": [RUBBED["body"][0]["support"][0] | {"release": 8e-3}]}, RUBBED["body"][1]]}
    flags = prepared(tmp_path / "scene", scene | {"checkpoint_every": 7})
    straight = direct(flags, tmp_path / "straight", "bodies")
    assert straight.communicate(timeout=120) and straight.returncode == 0
    rows = len(outcome(tmp_path / "straight").history["t"])
    out = tmp_path / "out"
    for number, more in ((rows // 35, {}), (rows // 15, {"restart": out / "checkpoint"})):
        killed_at(number, flags | more, out, "bodies")
    last = direct(flags | {"restart": out / "checkpoint"}, out, "bodies")
    assert last.communicate(timeout=120) and last.returncode == 0
    assert_same(out, tmp_path / "straight")
