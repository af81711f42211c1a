"""The paper as FreeFEM scripts (edp/*.edp) beside the program: coarse runs of both on the same mesh
with the same penalty, bad flags, and runs from another folder.

The scripts share nothing with the program: their contact points, laws over a step and solver are
others. On the same mesh the impulse and the rebound agree to 0.5 %, the contact time to 2 %.
"""

import json
import math
import subprocess
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import ffimpact
from examples.paper import scripts
from ffimpact.__main__ import main
from ffimpact.freefem import freefem
from ffimpact.places import ROOT

SAME, SAME_TIME = 0.005, 0.02
SCRIPTS = ("disc-plane", "disc-block", "ball-axisymmetric", "ball-plane", "friction-laws")
OBLIQUE = {"speed": 12, "angle": 60, "friction_static": 0.7, "friction_dynamic": 0.5, "slip_velocity": 0.1}


def call(script: str, folder: Path, *words: str, **flags) -> subprocess.CompletedProcess:
    """A direct run of a script from `folder`, without the kernels."""
    program = freefem.find()
    command = [program.command, "-nw", "-ne", "-v", "0", str(ROOT / f"edp/{script}.edp")]
    command += [word for name, value in flags.items() for word in (f"-{name}", str(value))]
    return subprocess.run([*command, *words], cwd=folder, env=program.environment, capture_output=True, text=True, timeout=120)


def answers(script: str, folder: Path, **flags) -> tuple[dict, pd.DataFrame]:
    """answers.json and the history of a run of a script in folder/script."""
    done = call(script, folder, out="script", **flags)
    assert done.returncode == 0, done.stdout[-500:]
    return json.loads((folder / "script/answers.json").read_text()), pd.read_csv(folder / "script/history.csv")


def apart(history: pd.DataFrame, result: ffimpact.Result, speed: float) -> dict[str, float]:
    """Differences of a script from the program: of the impulse relative, of rebounds over the speed."""
    impulse = (history.dt * history.normal_force)[1:].sum()
    differences = {"impulse": impulse / result["impulse"] - 1}
    for suffix in ["_1", "_2"] if "rebound_vy_2" in result else [""]:
        for axis in "xy":
            name = f"v{axis}{suffix}"
            differences[name] = (history[name].iloc[-1] - result[f"rebound_{name}"]) / speed
    return {name: abs(float(value)) for name, value in differences.items()}


@pytest.mark.parametrize("scene, script, size, flags", [
    ("disc-normal", "disc-plane", 0.02, {"law": "svk", "dt": 1e-4}),
    ("disc-normal-incompressible", "disc-plane", 0.02, {"law": "incompressible", "dt": 1.5e-4}),
    ("disc-oblique", "disc-plane", 0.03, {"law": "neohookean", "dt": 1.2e-4} | OBLIQUE),
    ("ball-axisymmetric", "ball-axisymmetric", 0.02, {"law": "neohookean", "dt": 1.5e-4}),
])
def test_a_body_on_the_plane_as_the_program_has_it(tmp_path, scene, script, size, flags):
    """On the program's mesh impulse, rebound, contact time and spin agree; the energy is constant,
    with friction its loss included."""
    result = ffimpact.run(scene, out=tmp_path / "run", estimate=False, figures=False, mesh_size=size, contact_mesh_size=size / 2, penalty=1e9, fields=0)
    ends, history = answers(script, tmp_path, mesh=scripts.on_the_plane(tmp_path / "run/mesh.msh"), penalty=1e9, **flags)
    differences = apart(history, result, flags.get("speed", 8))
    assert max(differences.values()) < SAME, differences
    assert ends["contact_end"] - ends["contact_start"] == pytest.approx(result["contact_time"], rel=SAME_TIME)
    assert history.spin.iloc[-1] == pytest.approx(result["rebound_spin"], rel=0.01, abs=1e-9)
    assert history.balance.abs().max() < 1e-8 * history.kinetic[0] and ends["unconverged_steps"] == 0
    assert history.friction_work.is_monotonic_increasing
    reads_as_a_result(tmp_path, history, result)


def reads_as_a_result(folder: Path, history: pd.DataFrame, result: ffimpact.Result) -> None:
    """load() makes a summary of the script's files, marked and without estimates; compare() reads it
    beside the run in folder/run."""
    loaded = ffimpact.load(folder / "script")
    assert loaded.summary["made_by"] == "script" and not loaded.errors and "by a script of the paper" in repr(loaded)
    assert loaded["impulse"] == pytest.approx((history.dt * history.normal_force)[1:].sum()) and loaded["steps"] == len(history) - 1
    assert loaded["rebound_vy"] == history.vy.iloc[-1] and loaded["mass"] == pytest.approx(result["mass"], rel=1e-3)
    assert loaded["vibration_energy"] == pytest.approx(result["vibration_energy"], abs=2 * SAME * result["energy_initial"])
    table = ffimpact.compare(folder / "script", folder / "run")
    assert {"contact_time", "impulse", "rebound_vy", "peak_force", "energy_drift"} <= set(table.index)


def test_a_ball_in_space_keeps_its_energy(tmp_path):
    """Its first steps in contact push it upwards, without a loss."""
    _, history = answers("ball-plane", tmp_path, law="neohookean", dt=4e-4, mesh_size=0.04, contact_mesh_size=0.025, penalty=1e9, end_time=1.2e-3)
    assert history.balance.abs().max() < 1e-8 * history.kinetic[0]
    momentum = (history.vy.iloc[-1] - history.vy[0]) * history.kinetic[0] * 2 / history.vy[0] ** 2
    assert 0 < momentum == pytest.approx((history.dt * history.normal_force)[1:].sum(), rel=1e-6)


@pytest.mark.robustness
def test_a_ball_in_space_as_the_program_has_it(tmp_path):
    """With elements of the same sizes impulse and rebound agree with those of the program's ball."""
    sizes = {"mesh_size": 0.03, "contact_mesh_size": 0.015, "penalty": 1e9}
    result = ffimpact.run("ball", out=tmp_path / "run", estimate=False, figures=False, fields=0, **sizes)
    ends, history = answers("ball-plane", tmp_path, law="neohookean", dt=2e-4, **sizes)
    differences = apart(history, result, 8)
    assert max(differences.values()) < SAME, differences
    assert ends["contact_end"] - ends["contact_start"] == pytest.approx(result["contact_time"], rel=SAME_TIME)
    assert history.balance.abs().max() < 1e-8 * history.kinetic[0]


def test_a_disc_on_a_block_as_the_program_has_it(tmp_path):
    """By closest points (9), on the program's mesh, impulse and rebounds agree with the program;
    momentum is constant."""
    result = ffimpact.run("disc-block", out=tmp_path / "run", estimate=False, figures=False, fields=0, mesh_size=0.4, contact_mesh_size=0.2, penalty=1e9)
    ends, history = answers("disc-block", tmp_path, mesh=scripts.on_the_block(tmp_path / "run/mesh.msh"), penalty=1e9, dt=2e-3)
    assert ends["mass_2"] == pytest.approx(result["mass_2"], rel=1e-12) and ends["mass_1"] == pytest.approx(result["mass_1"], rel=1e-3)
    differences = apart(history, result, 10)
    assert max(differences.values()) < SAME, differences
    # A step is 4 % of the contact, and its end is not interpolated.
    assert ends["contact_end"] - ends["contact_start"] == pytest.approx(result["contact_time"], abs=2e-3 + SAME_TIME * result["contact_time"])
    assert np.ptp(history.momentum_y) < 1e-9 * abs(history.momentum_y[0])
    # With steps of 0.3 ms: 1e-4.
    assert history.balance.abs().max() < 2e-3 * history.kinetic[0]


@pytest.mark.parametrize("pairing", ["pairwise", "pairwise-printed"])
def test_pairs_of_points_conserve(tmp_path, pairing):
    """(14), (15): pairs repel each other centrally, and the energy is constant to round-off."""
    _, history = answers("disc-block", tmp_path, pairing=pairing, mesh_size=0.5, contact_mesh_size=0.25, penalty=1e8, dt=1e-3, end_time=0.01)
    assert history.balance.abs().max() < 1e-8 * history.kinetic[0] and history.vy_1.iloc[-1] > -9
    assert np.ptp(history.momentum_y) < 1e-9 * abs(history.momentum_y[0])


def test_a_set_down_disc_slips(tmp_path):
    """Rolling: while a disc slides, friction is mu_d times the load, and the work of the weight is
    in the balance."""
    _, history = answers("disc-plane", tmp_path, law="neohookean", speed=1, angle=0, gravity=9.81, friction_static=0.5, friction_dynamic=0.4,
                         slip_velocity=0.01, mesh_size=0.02, contact_mesh_size=0.02, penalty=1e9, dt=2e-4, end_time=4e-3)
    sliding = history[history.sliding_fraction > 0.999]
    assert len(sliding) > 10 and sliding.friction_force.to_numpy() == pytest.approx(-0.4 * sliding.normal_force.to_numpy())
    assert history.balance.abs().max() < 1e-8 * history.kinetic[0] and history.external_work.iloc[-1] != 0
    assert main(["figures", str(tmp_path / "script")]) == 0 and (tmp_path / "script/figures/force.png").exists()


@pytest.mark.parametrize("words, line", [
    (["-nu", "0.6"], "nu: 0.6 is out of range (accepted: 0 to 0.4999)"),
    (["-nu", "x"], "nu: 'x' is not a number (accepted: 0 to 0.4999)"),
    (["-nu"], "nu: has no value"),
    (["-nu", "0.3", "-nu", "0.4"], "nu: is given twice"),
    (["-law", "hooke"], "law: 'hooke' is not known (accepted: svk|neohookean|incompressible)"),
    (["-mesh", "none.msh"], "mesh: 'none.msh' cannot be read"),
    (["-friction_static", "0.2", "-friction_dynamic", "0.3"], "friction_dynamic: 0.3 is out of range (accepted: 0 to 0.2)"),
    (["-hight", "1"], "'-hight' is no flag (accepted, with - in front: law|"),
])
def test_a_wrong_flag_is_one_line(tmp_path, words, line):
    """Exit code 10, and one line that names the flag, its value and what is accepted."""
    done = call("disc-plane", tmp_path, *words)
    assert done.returncode == 10 and done.stderr.startswith(f"ffimpact: {line}") and done.stderr.count("\n") == 1


def test_material_turned_inside_out_is_one_line(tmp_path):
    """Exit code 12, and no answers."""
    done = call("disc-plane", tmp_path, out="run", speed=80, mesh_size=0.02, contact_mesh_size=0.01, dt=1e-5)
    assert done.returncode == 12 and done.stderr.startswith("ffimpact: det F = -") and done.stderr.count("\n") == 1
    assert not (tmp_path / "run/answers.json").exists()


@pytest.mark.parametrize("script", SCRIPTS)
def test_each_script_refuses_an_unknown_flag(tmp_path, script):
    """All scripts compile from another folder and check their flags."""
    done = call(script, tmp_path, "-folder", "x")
    assert done.returncode == 10 and "'-folder' is no flag" in done.stderr


def test_the_answers_are_printed(tmp_path):
    """A run from another folder prints its answers and writes them and the history to -out."""
    done = call("disc-plane", tmp_path, out="a b", mesh_size=0.04, contact_mesh_size=0.02, dt=2e-4, end_time=1e-3)
    assert done.returncode == 0 and {path.name for path in (tmp_path / "a b").iterdir()} == {"history.csv", "answers.json"}
    for words in ("contact time", "impulse", "rebound", "spin", "kinetic", "elastic", "drift", "unknowns", "did not converge"):
        assert words in done.stdout
    history = pd.read_csv(tmp_path / "a b/history.csv")
    assert len(history) == 6 and math.isclose(history.t.iloc[-1], 1e-3)
