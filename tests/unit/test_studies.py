"""Studies: parallel runs that survive failures, time limits and interruption; and difficult
parameters."""

import re

import pandas as pd
import pytest

from benchmarks import stress
from ffimpact.sweeps import study
from verification import commands


def test_missing_freefem_is_said_once(tmp_path, monkeypatch, capsys):
    """Without FreeFem++ a study fails once, not for every point."""
    monkeypatch.setenv("FREEFEM", str(tmp_path / "nothing"))
    from benchmarks import __main__ as measurements
    from ffimpact.__main__ import guarded
    assert guarded(measurements.main, ["stress", "--quick", "3", "--out", str(tmp_path)]) == 13
    assert capsys.readouterr().err.count("make setup") == 1


def test_table_is_markdown():
    """Columns are aligned. Missing values are empty."""
    frame = pd.DataFrame({"law": ["svk", "neohookean"], "drift": [1e-11, None]})
    assert study.table(frame, {"law": "", "drift": ".1e"}).splitlines() == [
        "|        law |   drift |", "| ---------: | ------: |", "|        svk | 1.0e-11 |", "| neohookean |         |"]


def test_stress_has_every_combination_once(fake, tmp_path, monkeypatch):
    """There are 891 different sets. A sample of them is always the same."""
    requests = []
    monkeypatch.setattr(study, "study", lambda points, *rest: requests.append(points) or pd.DataFrame(
        [point | {"exit": 0, "message": "", "energy_drift": 1e-12} for point in points]))
    monkeypatch.setattr(stress, "report", lambda *_: "")
    for quick in ([], ["--quick", "5"], ["--quick", "5"]):
        assert stress.main([*quick, "--out", str(tmp_path)]) == 0
    assert len(requests[0]) == len({tuple(point.values()) for point in requests[0]}) == 891
    assert requests[1] == requests[2] and len(requests[1]) == 5


@pytest.mark.parametrize("row, kind, good", [
    (dict(exit=0, message="", energy_drift=1e-9), "closed", True), (dict(exit=0, message="", energy_drift=1e-7), "open", False),
    (dict(exit=11, message="the step"), "no step", True), (dict(exit=11, message=""), "no step", False),
    (dict(exit=12, message="det F"), "breakdown", True), (dict(exit=10, message="end_time"), "other", False),
    (dict(exit=124, message="no end"), "other", False)])
def test_stress_requirement(row, kind, good):
    """A closed balance, or exit code 11 or 12 with a message, is required."""
    rows = pd.DataFrame([row | {"outcome": stress.outcome(pd.Series(row))}])
    assert rows.outcome[0] == kind and stress.holds(rows)[0] == good


def test_pages_say_what_measured_them():
    """The line has the command with its arguments, the commit, the day and the machine."""
    words = commands.measured(["promise", "--scenes", "3"])
    assert re.fullmatch(r"Measured by `\S.*promise --scenes 3` at commit \w+(-dirty)?, \d{4}-\d\d-\d\d, on \d+ cores, .+\.", words)
