"""Studies: parallel runs that survive failures, time limits and interruption; and difficult
parameters."""

import re

import pandas as pd
import pytest

from benchmarks import pairing_comparison, stress
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


def test_pairs_are_held_against_closest_points_of_the_same_penalty(monkeypatch, tmp_path):
    """There is a row for each run, with differences from closest points with the same k in per
    cent.

    A failed run is a row with the reason and fails the requirement.
    """
    def runs(points, *_, **__):
        return pd.DataFrame([{"exit": 0, "message": "", "warnings": "", "rebound_vy_1": 5 + (point["pairing"] == "pairwise") * 0.05, "energy_drift": 1e-12,
                              "rebound_vy_2": -0.5, "impulse_y_1": 2e4, "thresholded_contact_time": 0.05} | point for point in points])
    monkeypatch.setattr(study, "study", runs)
    monkeypatch.setattr(pairing_comparison, "read_scene", lambda folder: {"contact": {"pairing_range": 0.1, "penalty": 1e9}, "body": [{"contact_mesh_size": 0.1}]})
    monkeypatch.setattr(pairing_comparison, "read_history", lambda folder: {"momentum_y": pd.Series([-1.0, -1.0])})
    monkeypatch.setattr(study, "place", lambda *_: tmp_path)
    for name in ("scene.toml", "history.csv"):
        (tmp_path / name).touch()
    table = pairing_comparison.compare(["neohookean"], tmp_path)
    assert table.pairing.value_counts().to_dict() == {"pairwise": 11, "closest-point": 4, "pairwise-printed": 2} and pairing_comparison.holds(table)
    assert table["differ [%]"][table.pairing == "pairwise"].tolist() == pytest.approx([0.5] * 11) and (table[table.pairing != "pairwise"]["differ [%]"] == 0).all()
    assert not pairing_comparison.holds(table.assign(outcome="step"))


def test_pages_say_what_measured_them():
    """The line has the command with its arguments, the commit, the day and the machine."""
    words = commands.measured(["promise", "--scenes", "3"])
    assert re.fullmatch(r"Measured by `\S.*promise --scenes 3` at commit \w+(-dirty)?, \d{4}-\d\d-\d\d, on \d+ cores, .+\.", words)
