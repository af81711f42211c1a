"""disc-normal with the real FreeFem++: what the folder holds, and that both ways in say the same."""

import re
import subprocess

import numpy as np
import pytest

from orchestrate import freefem, parameters, report, run, scene, vtu

COLUMNS = ("t dt normal_force friction_force kinetic elastic contact friction_work external_work balance momentum_x momentum_y "
           "vx vy spin max_penetration contact_size sliding_fraction min_jacobian min_stretch newton_iterations").split()
KEYS = ("status message contact_time contact_intervals peak_force impulse rebound_vx rebound_vy spin energy_initial energy_final "
        "vibration_energy friction_work energy_drift momentum_drift min_jacobian min_stretch breakdown_time max_penetration "
        "sliding_time sticking_time steps rejected_steps newton_iterations factorizations dofs wall_seconds phase_seconds "
        "skipped provenance").split()


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return run.run(scene.load("disc-normal"), {}, tmp_path_factory.mktemp("real") / "disc-normal")


def test_folder_holds_what_the_contract_says(result):
    """history.csv has every column, summary.json every key, scene.toml every parameter."""
    assert set(COLUMNS) <= set(result.history) and any(name.startswith("angular_momentum") for name in result.history)
    assert set(KEYS) <= set(result.summary)
    assert set(parameters.names()) <= set(result.scene)
    assert {p.name for p in (result.folder / "figures").iterdir()} == {
        "energies.png", "force.png", "shapes.png", "velocity.png"}


def test_history_and_summary_agree(result):
    """What the summary says can be found in the history again."""
    h, s = result.history, result.summary
    assert len(h["t"]) == s["steps"] + (h["dt"][0] == 0)
    assert (np.diff(h["t"]) > 0).all()
    assert h["min_jacobian"].min() == pytest.approx(s["min_jacobian"], rel=1e-3)
    assert abs(h["balance"]).max() / s["energy_initial"] == pytest.approx(s["energy_drift"], rel=1e-2, abs=1e-15)
    assert h["momentum_y"][-1] - h["momentum_y"][0] == pytest.approx(s["impulse"], rel=1e-3)
    assert h["vy"][-1] == pytest.approx(s["rebound_vy"], rel=1e-6)
    assert s["energy_drift"] < 1e-8


def test_result_meets_the_independent_programs(result):
    """Contact time, impulse and rebound agree with NGSolve and GetFEM to the 0.5 % that the scene asks for."""
    for key, numbers in report.references("disc-plane", result.scene).items():
        for number in numbers:
            if "error" in number:
                assert result.summary[key] == pytest.approx(number["value"], rel=5e-3), key


def test_snapshots_can_be_read(result):
    """As many snapshots as asked for, with the fields that the figures need, on points that fill half the disc."""
    series = vtu.series(result.folder / "fields.pvd")
    assert len(series) == result.scene["fields"]
    snapshot = vtu.read(series[-1][1])
    assert {"displacement", "velocity", "jacobian", "von_mises"} <= set(snapshot.fields)
    assert snapshot.points[:, 0].min() >= 0 and np.isfinite(snapshot.fields["von_mises"]).all()


def direct(*flags: str) -> subprocess.CompletedProcess:
    program = freefem.find()
    return subprocess.run([program.command, "-nw", "-ne", "-v", "0", "edp/disc-plane.edp", *flags], cwd=parameters.ROOT,
                          env=program.environment, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=120)


def test_freefem_alone_gives_the_same(result, tmp_path):
    """FreeFem++ without Python, on the same mesh, writes the same history to the last digit."""
    used = [word for name, value in result.scene.items() if name in parameters.names() for word in (f"-{name}", str(value))]
    process = direct(*used, "-mesh", str(result.folder / "mesh.msh"), "-out", str(tmp_path / "alone"))
    assert process.returncode == 0, process.stdout + process.stderr
    assert (tmp_path / "alone/history.csv").read_text() == (result.folder / "history.csv").read_text()


@pytest.mark.parametrize("flags, given", [
    (("-speed", "8x"), {"speed": "8x"}), (("-speed", "-1"), {"speed": "-1"}), (("-law", "hooke"), {"law": "hooke"}),
    (("-fields", "2.5"), {"fields": "2.5"})])
def test_both_ways_in_refuse_alike(tmp_path, flags, given):
    """A bad value gets the same words and exit code 10 from the script and from Python."""
    process = direct(*flags, "-out", str(tmp_path / "out"))
    with pytest.raises(parameters.BadInput) as error:
        parameters.check(given)
    said = re.findall(r"^ffimpact: (.*)$", process.stdout + process.stderr, re.MULTILINE)
    assert process.returncode == 10 and said == [str(error.value)]
