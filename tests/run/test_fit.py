"""Fits with runs: a modulus and a loss of data that runs have made, going on, and the command."""

import json
import math
import signal

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from tests.support.cli import start, wait_for

SCENE = """dimension = "axisymmetric"
accuracy = 0.05
[[body]]
shape = "ball"
radius = 0.021
law = "neohookean"
young = 6e7
nu = 0.45
density = 1070
loss = 0.07
loss_model = "flat"
position = [0, 0.0211]
velocity = [0, -2.2]
[[obstacle]]
kind = "plane"
"""
TRUTH = {"body.1.young": 4.3e7, "body.1.loss": 0.11}
MODULUS = {"body.1.young": (1e7, 1e9)}
FREE = {"body.1.young": (1e7, 1e9), "body.1.loss": (0.01, 0.5)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("fits")
    (place / "ball.toml").write_text(SCENE)
    return place


@pytest.fixture(scope="module")
def measured(folder):
    """A run with the true entries and smaller elements and steps."""
    return ff.run(folder / "ball.toml", TRUTH, accuracy=0.01, estimate=False, figures=False, out=folder / "truth", progress=False)


@pytest.fixture(scope="module")
def fitted(folder, measured):
    """A fit to restitution and force of one impact, with the errors of a good laboratory."""
    step = slice(None, None, max(1, len(measured.history) // 100))
    error, times = 0.01 * measured["peak_force"], measured.history.t[step].to_numpy()
    table = {"t": times, "normal_force": measured.history.normal_force[step] + error * np.random.default_rng(1).standard_normal(len(times))}
    impact = ff.Experiment(restitution=(measured["restitution"], 0.003), normal_force={"table": table, "error": error})
    return ff.fit(folder / "ball.toml", FREE, impact, out=folder / "fit", progress=False)


def test_entries_of_a_force_and_a_restitution_are_those_of_the_run(fitted):
    for name, true in TRUTH.items():
        row = fitted.table.loc[name]
        assert row["low"] < true < row["high"] and row["known"] == "yes"
        assert row["high"] / row["low"] < 1.35
    assert fitted.p > 0.05 and "not refused" in fitted.verdict
    assert [note.split(":")[0] for note in fitted.notes] in ([], ["errors of elements, steps and interpolation exceed those of most measurements"])


def test_the_fitted_scene_runs_and_other_speeds_are_predicted(fitted, folder):
    table = fitted.predict({"body.1.velocity.2": -4.0}, ["restitution", "contact_time", "rebound_height"])
    fine = ff.run(folder / "ball.toml", TRUTH | {"body.1.velocity.2": -4.0}, accuracy=0.01, estimate=False, figures=False, out=folder / "fast", progress=False)
    for name in ("restitution", "contact_time"):
        assert table.loc[name, "low"] < fine[name] < table.loc[name, "high"]
    height = fine["rebound_vy"] ** 2 / 19.62
    assert 0.97 * height < table.loc["rebound_height", "value"] < height  # drag lowers it by 2 %
    assert fitted.scene.bodies[0].material.young == pytest.approx(fitted.best["body.1.young"])


def test_the_experiment_that_tells_most_is_first(fitted):
    table = fitted.next([ff.Experiment(speed=2, restitution=(None, error)) for error in (0.1, 0.0005)])
    loss = table["body.1.loss"]
    assert (table <= 1).all().all() and loss.iloc[0] < 0.9 < 0.99 < loss.iloc[1]
    assert list(table.index) == ["speed = 2 m/s: restitution +- 0.0005", "speed = 2 m/s: restitution +- 0.1"]


def test_a_free_entry_is_not_set_by_what_is_predicted(fitted):
    for act in (lambda: fitted.predict({"body.1.young": 5e7}), lambda: fitted.next(ff.Experiment({"body.1.young": 5e7}, contact_time=(None, 1e-5)))):
        with pytest.raises(BadInput, match="body.1.young is free"):
            act()


@pytest.mark.parametrize("words, by", [("width", {"t": 1e3}), ("largest value", {"normal_force": 1e-3})])
def test_a_force_in_another_unit_is_questioned(folder, measured, tmp_path, words, by):
    table = {name: measured.history[name].to_numpy() * by.get(name, 1) for name in ("t", "normal_force")}
    impact = ff.Experiment(normal_force={"table": table, "error": 0.01 * table["normal_force"].max()})
    with pytest.raises(BadInput, match=f"its {words}.*is its unit right"):
        ff.fit(folder / "ball.toml", FREE, impact, out=folder / "fit", progress=False)


def test_how_a_run_went_is_not_measured(folder):
    with pytest.raises(BadInput, match="'wall_seconds' is not known"):
        ff.fit(folder / "ball.toml", FREE, ff.Experiment(wall_seconds=(1, 0.1), restitution=(0.9, 0.1)), out=folder / "fit", progress=False)


def test_as_many_values_as_entries_that_do_not_agree(folder, measured, tmp_path):
    """A contact time outside what the bounds allow: the model is refused all the same."""
    told = ff.fit(folder / "ball.toml", {"body.1.young": (3e8, 1e9)}, ff.Experiment(contact_time=(measured["contact_time"], 1e-5)), out=tmp_path / "fit", confirm=False, progress=False)
    assert told.freedom == 0 and "is refused" in told.verdict and any("no values between the bounds agree" in note for note in told.notes)


def test_files_of_a_fit_make_it_again(fitted, folder, capsys):
    fitted.save(folder / "saved", figure=False)
    record = json.loads((folder / "saved/fit.json").read_text())
    assert [row["value"] for row in record["entries"]] == pytest.approx(fitted.table["value"])
    assert ff.Scene.load(folder / "saved/scene.toml").bodies[0].material.loss == pytest.approx(fitted.best["body.1.loss"])
    assert main(["fit", str(folder / "saved/fit.toml"), "--out", str(folder / "fit"), "--no-figures"]) == 0
    again = json.loads((folder / "fit/fit.json").read_text())
    assert [row["low"] for row in again["entries"]] == pytest.approx([row["low"] for row in record["entries"]], rel=1e-6)
    assert "not refused" in capsys.readouterr().out


def test_restitution_alone_does_not_tell_the_modulus(folder, measured, tmp_path):
    """Flat loss: one restitution for all moduli. The loss has an interval, that of all moduli; two
    values and two entries cannot refuse the model."""
    ratio = {"interval_ratio": (measured["restitution"], 0.01)}
    told = ff.fit(folder / "ball.toml", FREE, [ff.Experiment(**ratio, restitution=ratio["interval_ratio"])], out=tmp_path / "fit", confirm=False, progress=False)
    assert math.isnan(told.table.loc["body.1.young", "value"]) and told.table.loc["body.1.young", "known"].startswith("no")
    assert told.table.loc["body.1.loss", "known"] == "yes" and told.freedom == 1  # the modulus takes none


def test_a_marker_on_the_ball_determines_the_modulus(folder, tmp_path):
    """The way of a point near the top, in mm on a film whose origin is anywhere."""
    seen = ff.run(folder / "ball.toml", TRUTH, accuracy=0.02, fields=200, estimate=False, figures=False, out=tmp_path / "film", progress=False).probe(0.0, 0.015)
    part = seen.iloc[:: max(1, len(seen) // 30)]
    table = {"t": part.t.tolist(), "y": (1e3 * part.y + 7).tolist()}
    film = ff.Experiment(track={"table": table, "error": 2e-2, "point": (0.0, 0.015), "scale": 1e-3})
    told = ff.fit(folder / "ball.toml", MODULUS, film, {"body.1.loss": 0.11, "end_time": 2.5e-3}, out=tmp_path / "fit", confirm=False, progress=False)
    row = told.table.iloc[0]
    assert row["low"] < 4.3e7 < row["high"] < 1.2 * row["low"] and told.p > 0.05


def test_contradictory_and_misread_data_are_questioned(folder, measured, tmp_path):
    """Heights in cm, and two contact times of the same impact that differ by a tenth."""
    time = measured["contact_time"]
    data = [ff.Experiment(height=0.3, rebound_height=(23.0, 0.1)), *(ff.Experiment(contact_time=(share * time, 0.005 * time)) for share in (1, 1.1))]
    told = ff.fit(folder / "ball.toml", MODULUS, data, out=tmp_path / "fit", confirm=False, progress=False)
    assert told.p < 0.01 and "is refused" in told.verdict
    assert any("contradict" in note for note in told.notes) and any("unit" in note for note in told.notes)


def test_an_interrupted_fit_goes_on_to_the_same_numbers(folder, tmp_path):
    """Interrupted after some runs, the same command ends with the intervals of a fit at once."""
    (folder / "modulus.toml").write_text('scene = "ball.toml"\n[free]\n"body.1.young" = [1e7, 1e9]\n[[experiment]]\ncontact_time = [1e-3, 5e-6]\n')
    words = ("fit", str(folder / "modulus.toml"), "--quick", "--no-figures", "--out")
    process = start(*words, str(tmp_path / "broken"))
    wait_for(lambda: len(list(tmp_path.glob("broken/runs/*/summary.json"))) > 3)
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 130 and not (tmp_path / "broken/fit.json").exists()
    ended = len(list(tmp_path.glob("broken/runs/*/summary.json")))
    assert main([*words, str(tmp_path / "broken")]) == main([*words, str(tmp_path / "whole")]) == 0
    broken, whole = (json.loads((tmp_path / name / "fit.json").read_text()) for name in ("broken", "whole"))
    assert broken["entries"] == whole["entries"] and 0 < broken["runs"] <= whole["runs"] - ended + 2


def test_unknown_numbers_and_failing_commands(folder, capsys):
    """Each is one line with the code of wrong input, and nothing is written."""
    (folder / "fit-1.toml").write_text('scene = "ball.toml"\n[free]\n"body.1.young" = [1e7, 1e9]\n[[experiment]]\nrestitutio = [0.9, 0.01]\n')
    before = {path.name for path in folder.iterdir()}
    assert main(["fit", str(folder / "fit-1.toml"), "--out", str(folder / "none")]) == 10
    assert "did you mean restitution" in capsys.readouterr().err
    assert main(["fit", str(folder / "nowhere.toml")]) == 10 and not (folder / "none/fit.json").exists()
    assert {path.name for path in folder.iterdir()} - before <= {"none"}
