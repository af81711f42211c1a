"""Studies: parallel runs that survive failures, time limits and interruption; and difficult
parameters."""

import signal
import sys

import pandas as pd
import pytest

from benchmarks import stress
from ffimpact.output import results
from ffimpact.running import run
from ffimpact.sweeps import study
from tests.support.cli import is_alive, start, wait_for

POINTS = [{"speed": speed, "dt": dt} for speed in (4.0, 8.0) for dt in (0.0, 1e-4)]
BASE = {"mesh_size": 0.02, "contact_mesh_size": 0.01, "fields": 0}


def go(folder, points=POINTS, limit=30.0) -> pd.DataFrame:
    return study.study(points, folder, BASE, limit)


def test_rows_are_parameters_outcome_and_summary(fake, tmp_path):
    """There is a row for each point in the given order, with the numbers of its summary. A repeated
    point runs once."""
    rows = go(tmp_path, [*POINTS, POINTS[0]])
    assert rows[["speed", "dt"]].to_dict("records") == [*POINTS, POINTS[0]]
    assert (rows.exit == 0).all() and (rows.message == "").all() and not rows.reused.any()
    assert (rows.impulse == 208.2).all() and (rows.steps == 199).all() and fake.starts() == 4
    used = [results.read_scene(folder) for folder in (tmp_path / "runs").iterdir()]
    assert len(used) == 4 and all(used)


@pytest.mark.few(2)
@pytest.mark.parametrize("sizes", [{"mesh_size": 0.02, "contact_mesh_size": 0.01}, {"accuracy": 0.04}], ids=["sizes", "accuracy"])
@pytest.mark.parametrize("mode, again, code, words", [
    ("ok", 0, 0, ""), ("step", 0, 11, "step: no convergence"), ("crash", 4, 1, "killed by SIGABRT"),
    *(pytest.param(*more, marks=pytest.mark.robustness) for more in (("material", 0, 12, "material: det F"), ("chatter", 0, 11, "chatter")))])
def test_what_is_done_is_not_done_again(fake, tmp_path, monkeypatch, mode, again, code, words, sizes):
    """Finished runs and failures of the same code are reused, crashes are not. With other code
    everything runs again.

    A failed point keeps its code, its message and the numbers of the script. The others continue.
    """
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
    """A run that does not end is killed at its limit, reports it, and leaves no files."""
    fake("slow")
    rows = go(tmp_path, POINTS[:2], limit=1.0)
    assert (rows.exit == 124).all() and (rows.message == "no end after 1 s: killed").all()
    assert not any(map(is_alive, fake.pids())) and not any((tmp_path / "runs").iterdir())


def test_an_error_that_nobody_expects_is_a_row(fake, tmp_path, monkeypatch, capsys):
    """An error of the program itself affects its own row only and is printed."""
    work = study.outcome_of
    monkeypatch.setattr(study, "outcome_of", lambda folder, problem, *more: 1 / 0 if problem.content["body"][0]["speed"] == 4 else work(folder, problem, *more))
    rows = go(tmp_path)
    assert rows.exit.tolist() == [1, 1, 0, 0] and rows.message[0] == "ZeroDivisionError: division by zero"
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interruption_is_clean(fake, tmp_path, number, code):
    """At most one FreeFem++ runs on each core. Ctrl-C ends them all and leaves neither an
    incomplete folder nor a traceback."""
    fake("slow")
    process = start("stress", "--quick", "7", "--out", str(tmp_path / "out"), module="benchmarks", start_new_session=True)
    wait_for(lambda: fake.starts() >= study.CORES)
    process.send_signal(number)
    _, err = process.communicate(timeout=20)
    assert process.returncode == code and "Traceback" not in err, err
    assert fake.starts() == study.CORES and not any(map(is_alive, fake.pids()))
    assert not any((tmp_path / "out/runs").iterdir())


@pytest.mark.parametrize("mode, returned, words", [pytest.param("ok", 0, "requirement holds", marks=pytest.mark.robustness), ("material", 0, "exit 12: law"),
                                                   ("crash", 1, "requirement FAILS for 6 sets")])
def test_stress_reports(fake, tmp_path, capsys, mode, returned, words):
    """The verdict follows the requirement, every set that did not finish is listed, and the CSV
    file exists."""
    fake(mode)
    assert stress.main(["--quick", "6", "--out", str(tmp_path)]) == returned
    out = capsys.readouterr().out
    assert words in out and "6 sets:" in out and out.count("\nexit ") == (0 if mode == "ok" else 6)
    assert len(pd.read_csv(tmp_path / "stress.csv")) == 6
