"""The studies: runs in parallel that survive failures, limits and interruption; hard parameters on top."""

import re
import signal
import sys

import pandas as pd
import pytest

from benchmarks import pairing_comparison, stress
from ffimpact.output import results
from ffimpact.running import run
from ffimpact.sweeps import study
from test_cli import is_alive, start, wait_for
from verification import commands

POINTS = [{"speed": speed, "dt": dt} for speed in (4.0, 8.0) for dt in (0.0, 1e-4)]
BASE = {"mesh_size": 0.02, "contact_mesh_size": 0.01, "fields": 0}


def go(folder, points=POINTS, limit=30.0) -> pd.DataFrame:
    return study.study(points, folder, BASE, limit)


def test_rows_are_parameters_outcome_and_summary(fake, tmp_path):
    """A row a point in the given order, with the numbers of its summary; a point given twice is run once."""
    rows = go(tmp_path, [*POINTS, POINTS[0]])
    assert rows[["speed", "dt"]].to_dict("records") == [*POINTS, POINTS[0]]
    assert (rows.exit == 0).all() and (rows.message == "").all() and not rows.reused.any()
    assert (rows.impulse == 208.2).all() and (rows.steps == 199).all() and fake.starts() == 4
    used = [results.read_scene(folder) for folder in (tmp_path / "runs").iterdir()]
    assert len(used) == 4 and all(scene["mesh_size"] == 0.02 for scene in used)


@pytest.mark.few(2)
@pytest.mark.parametrize("sizes", [{"mesh_size": 0.02, "contact_mesh_size": 0.01}, {"accuracy": 0.04}], ids=["sizes", "accuracy"])
@pytest.mark.parametrize("mode, again, code, words", [
    ("ok", 0, 0, ""), ("step", 0, 11, "step: no convergence"), ("crash", 4, 1, "killed by SIGABRT"),
    *(pytest.param(*more, marks=pytest.mark.robustness) for more in (("material", 0, 12, "material: det F"), ("chatter", 0, 11, "chatter")))])
def test_what_is_done_is_not_done_again(fake, tmp_path, monkeypatch, mode, again, code, words, sizes):
    """Finished runs and failures of the same code are reused, crashes are not; with other code all is run again. A point that fails keeps its code, its message and what
    the script knew; the others go on."""
    fake(mode)
    monkeypatch.setattr(sys.modules[__name__], "BASE", sizes | {"fields": 0})
    first = go(tmp_path)
    assert (first.exit == code).all() and first.message.str.contains(words).all() and len(first) == fake.starts() == 4
    assert mode == "chatter" or ("steps" in first) == (mode != "crash")
    second = go(tmp_path)
    assert fake.starts() == 4 + again and (second.reused == (again == 0)).all()
    pd.testing.assert_frame_equal(first.drop(columns="reused"), second.drop(columns="reused"))
    monkeypatch.setattr(run, "code_hash", lambda: "other")
    assert not go(tmp_path).reused.any() and fake.starts() == 8 + again


def test_time_limit_kills_and_reports(fake, tmp_path):
    """A run that does not end is killed at its limit, says so, and leaves nothing."""
    fake("slow")
    rows = go(tmp_path, POINTS[:2], limit=1.0)
    assert (rows.exit == 124).all() and (rows.message == "no end after 1 s: killed").all()
    assert not any(map(is_alive, fake.pids())) and not any((tmp_path / "runs").iterdir())


def test_an_error_that_nobody_expects_is_a_row(fake, tmp_path, monkeypatch, capsys):
    """An error of the program itself costs its own row only, and is printed."""
    work = study._outcome
    monkeypatch.setattr(study, "_outcome", lambda folder, wanted, *more: 1 / 0 if wanted.values["speed"] == 4 else work(folder, wanted, *more))
    rows = go(tmp_path)
    assert rows.exit.tolist() == [1, 1, 0, 0] and rows.message[0] == "ZeroDivisionError: division by zero"
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interruption_is_clean(fake, tmp_path, number, code):
    """One FreeFem++ a core at most; Ctrl-C ends them all, leaves no half-finished folder and no traceback."""
    fake("slow")
    process = start("stress", "--quick", "7", "--out", str(tmp_path / "out"), module="benchmarks", start_new_session=True)
    wait_for(lambda: fake.starts() >= study.CORES)
    process.send_signal(number)
    _, err = process.communicate(timeout=20)
    assert process.returncode == code and "Traceback" not in err, err
    assert fake.starts() == study.CORES and not any(map(is_alive, fake.pids()))
    assert not any((tmp_path / "out/runs").iterdir())


def test_missing_freefem_is_said_once(tmp_path, monkeypatch, capsys):
    """Without FreeFem++ a study does not fail point by point."""
    monkeypatch.setenv("FREEFEM", str(tmp_path / "nothing"))
    from benchmarks import __main__ as measurements
    from ffimpact.__main__ import guarded
    assert guarded(measurements.main, ["stress", "--quick", "3", "--out", str(tmp_path)]) == 13
    assert capsys.readouterr().err.count("make setup") == 1


def test_table_is_markdown():
    """Columns are aligned; what is missing is left empty."""
    frame = pd.DataFrame({"law": ["svk", "neohookean"], "drift": [1e-11, None]})
    assert study.table(frame, {"law": "", "drift": ".1e"}).splitlines() == [
        "|        law |   drift |", "| ---------: | ------: |", "|        svk | 1.0e-11 |", "| neohookean |         |"]


@pytest.mark.parametrize("mode, returned, words", [pytest.param("ok", 0, "requirement holds", marks=pytest.mark.robustness), ("material", 0, "exit 12: law"),
                                                   ("crash", 1, "requirement FAILS for 6 sets")])
def test_stress_reports(fake, tmp_path, capsys, mode, returned, words):
    """The verdict follows the requirement; every set that did not finish is listed; the CSV is there."""
    fake(mode)
    assert stress.main(["--quick", "6", "--out", str(tmp_path)]) == returned
    out = capsys.readouterr().out
    assert words in out and "6 sets:" in out and out.count("\nexit ") == (0 if mode == "ok" else 6)
    assert len(pd.read_csv(tmp_path / "stress.csv")) == 6


def test_stress_has_every_combination_once(fake, tmp_path, monkeypatch):
    """891 sets, none twice; a part of them is always the same part."""
    asked = []
    monkeypatch.setattr(study, "study", lambda points, *rest: asked.append(points) or pd.DataFrame(
        [point | {"exit": 0, "message": "", "energy_drift": 1e-12} for point in points]))
    monkeypatch.setattr(stress, "report", lambda *_: "")
    for quick in ([], ["--quick", "5"], ["--quick", "5"]):
        assert stress.main([*quick, "--out", str(tmp_path)]) == 0
    assert len(asked[0]) == len({tuple(point.values()) for point in asked[0]}) == 891
    assert asked[1] == asked[2] and len(asked[1]) == 5


@pytest.mark.parametrize("row, kind, good", [
    (dict(exit=0, message="", energy_drift=1e-9), "closed", True), (dict(exit=0, message="", energy_drift=1e-7), "open", False),
    (dict(exit=11, message="the step"), "no step", True), (dict(exit=11, message=""), "no step", False),
    (dict(exit=12, message="det F"), "breakdown", True), (dict(exit=10, message="end_time"), "other", False),
    (dict(exit=124, message="no end"), "other", False)])
def test_stress_requirement(row, kind, good):
    """Closed balance, or 11 or 12 with a message; nothing else will do."""
    rows = pd.DataFrame([row | {"outcome": stress.outcome(pd.Series(row))}])
    assert rows.outcome[0] == kind and stress.holds(rows)[0] == good


@pytest.mark.robustness
def test_stress_holds_on_real_runs(tmp_path, monkeypatch, capsys):
    """A few hard sets with the real FreeFem++ do what is required."""
    monkeypatch.setattr(stress, "AXES", {"law": ("svk", "neohookean"), "nu": (0.49,), "speed": (10.0,), "penalty": (1e12,),
                                         "exponent": (1.0, 2.0), "dt": (1e-4,)})
    assert stress.main(["--out", str(tmp_path)]) == 0, capsys.readouterr().out


def test_pairs_are_held_against_closest_points_of_the_same_penalty(monkeypatch, tmp_path):
    """A row a run, differences from closest points with the same k in per cent; one that fails is a row that says why, and fails the requirement."""
    def runs(points, *_, **__):
        return pd.DataFrame([{"exit": 0, "message": "", "warnings": "", "rebound_vy_1": 5 + (point["pairing"] == "pairwise") * 0.05, "energy_drift": 1e-12,
                              "rebound_vy_2": -0.5, "impulse_y_1": 2e4, "thresholded_contact_time": 0.05} | point for point in points])
    monkeypatch.setattr(study, "study", runs)
    monkeypatch.setattr(pairing_comparison, "read_scene", lambda folder: {"pairing_range": 0.1, "penalty": 1e9, "contact_mesh_size": 0.1})
    monkeypatch.setattr(pairing_comparison, "read_history", lambda folder: {"momentum_y": pd.Series([-1.0, -1.0])})
    monkeypatch.setattr(study, "place", lambda *_: tmp_path)
    for name in ("scene.toml", "history.csv"):
        (tmp_path / name).touch()
    table = pairing_comparison.compare(["neohookean"], tmp_path)
    assert table.pairing.value_counts().to_dict() == {"pairwise": 11, "closest-point": 4, "pairwise-printed": 2} and pairing_comparison.holds(table)
    assert table["differ [%]"][table.pairing == "pairwise"].tolist() == pytest.approx([0.5] * 11) and (table[table.pairing != "pairwise"]["differ [%]"] == 0).all()
    assert not pairing_comparison.holds(table.assign(outcome="step"))


def test_pages_say_what_measured_them(tmp_path):
    """At the top of a page stand the command as it was given, the commit, the day and the machine, then the verdict."""
    commands.page(tmp_path / "page.md", "A title", ["promise", "--scenes", "3"], "text\n\nverdict")
    title, words, _, verdict, _, text = (tmp_path / "page.md").read_text().splitlines()
    assert re.fullmatch(r"Written by `\S.*promise --scenes 3` at commit \w+(-dirty)?, \d{4}-\d\d-\d\d, on \d+ cores, .+\.", words) and (title, verdict, text) == ("# A title", "verdict", "text")
