"""A stored record of a run is evaluated without FreeFEM. The run is coarse: a disc hits the plane at
60 degrees, with friction and a gravity of 100 m/s2, by BDF2, whose forces are those at the ends of
steps. Its record is in tests/records/oblique."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.output import contacts, modes, warnings
from ffimpact.output.evaluate import evaluate
from ffimpact.output.results import read_answers, read_history, read_json, read_summary, read_table

RECORD = Path(__file__).parents[1] / "records/oblique"


def evaluated(folder: Path, **facts: float) -> Path:
    """The record, with other facts, evaluated in a folder."""
    shutil.copytree(RECORD, folder)
    record = json.loads((folder / "record.json").read_text())
    record["diagnostics"] |= facts
    (folder / "record.json").write_text(json.dumps(record))
    evaluate(folder)
    return folder


@pytest.fixture
def run(tmp_path):
    return evaluated(tmp_path / "run")


def test_numbers_are_those_of_the_table(run):
    """Names and order are those of the scene. What the record or the history has is under its name: a
    number of the record, a last and a largest value of a column, the place of an extreme."""
    summary, history, facts = read_summary(run), read_history(run), read_json(RECORD / "record.json")["diagnostics"]
    names = scene.load(RECORD / "scene.toml").numbers
    assert [name for name in summary if name in names] == names
    assert summary["steps"] == facts["steps"] == len(history["t"]) - 1 and summary["final_vx"] == history["vx"][-1]
    assert summary["friction_work"] == history["friction_work"][-1] == summary["creep_work"] + summary["slip_work"]
    assert summary["peak_force"] == max(history["normal_force"]) and summary["min_jacobian"] == min(history["min_jacobian"])
    assert [summary[f"max_shear{end}"] for end in ("", "_time", "_x", "_y")] == facts["max_shear"][:4] and summary["max_shear_z"] is None
    assert summary["energy_drift"] == max(abs(history["balance"])) / facts["supplied_energy"] and summary["breakdown_time"] is None


def test_numbers_of_an_impact(run):
    """The impulse is the time integral of the forces. The angle of incidence is the scene's, and the
    restitution is of the velocities before and after."""
    summary, history, (row,) = read_summary(run), read_history(run), read_table(run / "contacts.csv")
    force = history["normal_force"]
    impulse = ((force[1:] + force[:-1]) / 2 * np.diff(history["t"])).sum()
    assert [row.impulse, summary["impulse"]] == pytest.approx([impulse, impulse], rel=1e-3)
    assert row.approach == pytest.approx(-history["vy"][0], rel=1e-4) and row.slip_before == pytest.approx(6, rel=1e-4)
    assert summary["angle_in"] == pytest.approx(60, abs=0.01) and 60 < summary["angle_out"] < 90
    assert summary["bounces"] == 1 and summary["restitution"] == pytest.approx(row.separation / row.approach, rel=1e-6)
    assert row.restitution == pytest.approx(summary["restitution"]) and 0.7 < row.restitution < 0.9


def test_velocity_at_the_end_of_contact(run):
    """It lies on the straight line through the two states that follow."""
    summary, history = read_summary(run), read_history(run)
    end = summary["contact_start"] + summary["contact_time"]
    k = int(np.searchsorted(history["t"], end))
    line = np.polyfit(history["t"][k:k + 2], history["vy"][k:k + 2], 1)
    assert abs(np.polyval(line, end) - history["vy"][k]) > 1e-3
    assert summary["rebound_vy"] == pytest.approx(np.polyval(line, end), rel=1e-9)
    assert summary["final_vy"] == pytest.approx(history["vy"][-1], rel=1e-9)


def test_warnings_compare_with_the_accuracy(run, tmp_path):
    """BDF2 loses 22 % of the energy: less than an accuracy of 40 %, more than one of 10 %. The penalty
    holds a small part of the energy."""
    assert not read_summary(run)["warnings"]
    (warning,) = [text for text in read_summary(evaluated(tmp_path / "exact", accuracy=0.1))["warnings"] if text.startswith("energy: ")]
    assert "lost 22 %" in warning and "the requested accuracy is 10 %" in warning
    record = read_json(RECORD / "record.json")
    evidence = warnings.Evidence(record, read_history(run), contacts.intervals_of(RECORD, record["diagnostics"]))
    assert 0.001 < evidence.penalty_share < 0.2


def test_answers_do_not_depend_on_a_common_motion(run):
    """Body and plane move along with 30 m/s: energies and the largest speed are those in the frame of
    the plane."""
    before, speed = read_answers(run), 30.0
    history, summary = dict(read_history(run)), read_summary(run)
    mass = summary["mass"]
    history["kinetic"] = history["kinetic"] + mass * speed * (history["vx"] + speed / 2)
    history["vx"] = history["vx"] + speed
    np.savetxt(run / "history.csv", np.stack(list(history.values()), axis=1), delimiter=",", header=",".join(history), comments="")
    moved = {name: summary[name] + speed for name in ("rebound_vx", "final_vx")}
    moved["energy_final"] = summary["energy_final"] + mass * speed * (summary["final_vx"] + speed / 2)
    (run / "summary.json").write_text(json.dumps(summary | moved))
    scene = (run / "scene.toml").read_text()
    (run / "scene.toml").write_text(scene.replace('kind = "plane"', f'kind = "plane"\nvelocity = [{speed}, 0.0]'))
    after = read_answers(run)
    assert after.speed == pytest.approx(before.speed)
    for name in ("largest_energy", "energy_final"):
        assert after.summary[name] == pytest.approx(before.summary[name])


def test_energy_in_modes(tmp_path):
    """Two masses m between three springs k vibrate in their first mode, omega^2 = k/m, and move in the
    second, omega^2 = 3 k/m."""
    k, m, shift = 400.0, 2.0, 7.0
    rows, columns = np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1])
    arrays = dict(
        options=[2, 0, shift], free=[1, 1],
        stiffness=[2 * k + shift * m, -k, -k, 2 * k + shift * m], stiffnessRow=rows, stiffnessColumn=columns,
        mass=[m, 0, 0, m], massRow=rows, massColumn=columns,
        displacement=[0.1, 0.1], velocity=[0.3, -0.3])
    with open(tmp_path / modes.RECORDED, "wb") as file:
        for name, values in arrays.items():
            file.write(f"{name}\n".encode() + np.int64(len(values)).tobytes() + np.array(values, float).tobytes())
        file.write(b"end\n")
    modes.write_modes(tmp_path)
    first, second = read_table(tmp_path / "modes.csv")
    assert [first.frequency, second.frequency] == pytest.approx([np.sqrt(k / m) / (2 * np.pi), np.sqrt(3 * k / m) / (2 * np.pi)])
    assert [first.strain_energy, first.kinetic_energy] == pytest.approx([k * 0.1**2, 0.0], abs=1e-9)
    assert [second.strain_energy, second.kinetic_energy] == pytest.approx([0.0, m * 0.3**2], abs=1e-9)
