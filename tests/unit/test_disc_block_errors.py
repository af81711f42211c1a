"""The disc on the free block with error bars: results, error bars, checks and comparisons that can
fail, text of the page."""

import pandas as pd
import pytest

from benchmarks import disc_block_errors as block, peers
from ffimpact.sweeps import study
from tests.support.disc_block_errors import CASE, tables

PEER = {"mass_upper": 1000.0, "mass_lower": 20000.0, "velocity_upper": 2.0, "velocity_lower": -0.6, "vibration_upper": 5000.0, "vibration_lower": 39400.0,
        "energy_start": 50000.0, "contact_time_1_percent": 0.05, "contact_time": 0.055, "dofs": 4000, "steps": 150, "cpu_seconds": 5.0, "setup_seconds": 1.0}


def theirs(monkeypatch, *changes: dict) -> pd.DataFrame:
    """NGSolve's table of the case, with these changes at its refinements."""
    answers = iter([(PEER | change, "") for change in (*changes, *[{}] * (2 - len(changes)))])
    monkeypatch.setattr(peers, "two_bodies", lambda *_, **__: next(answers))
    return block.ask_peer([CASE])[0]


def test_answers_are_the_shares_of_the_energy(monkeypatch, tmp_path):
    """Motion of the centres and vibration add up to the initial energy [%]; times are in ms."""
    first = tables(monkeypatch, tmp_path).iloc[0]
    assert [first[name] for name in block.SHARES] == pytest.approx([4.0, 7.2, 10.0, 78.8]) and sum(first[name] for name in block.SHARES) == pytest.approx(100)
    assert (first["contact >1% ms"], first["contact ms"], first["v disc m/s"]) == pytest.approx((50, 55, 2))


def test_reference_has_smaller_elements_and_steps(monkeypatch, tmp_path):
    """The reference has the sizes of the most accurate run over FINER, the accuracy of the step
    over FINER squared, and the same law and stiffness."""
    requests = []
    tables(monkeypatch, tmp_path)
    simulated = study.study
    monkeypatch.setattr(study, "study", lambda points, *more: requests.extend(points) or simulated(points, *more))
    block.compare([CASE], block.ACCURACIES, tmp_path)
    fine = requests[-1]
    assert (fine["body.1.contact_mesh_size"], fine["accuracy"]) == pytest.approx((0.02 / block.FINER, 0.005 / block.FINER**2))
    assert all(fine[name] == value for name, value in CASE.items())


def test_bars_are_the_difference_from_the_reference(monkeypatch, tmp_path):
    """Errors are relative to the reference of the case. The error bar is that of the most accurate
    run and is printed to two digits."""
    table = tables(monkeypatch, tmp_path, {"rebound_vy_1": 2.5}, {"rebound_vy_1": 2.012})
    assert block.differences(table)["v disc m/s"].tolist() == pytest.approx([0.5, 0.012])
    ours = block.with_bars(table).iloc[0]
    assert (ours["v disc m/s"], ours["v disc m/s bar"]) == pytest.approx((2, 0.012)) and block.bar(ours, "v disc m/s") == "2.000 ± 0.012"


def test_disagreement_needs_more_than_both_bars(monkeypatch, tmp_path):
    """2 +- 0.01 and 2.05 +- 0.03 disagree; with 0.05 in place of 0.03 they agree. The page has the
    result and both values."""
    table = tables(monkeypatch, tmp_path, {}, {"rebound_vy_1": 2.01})
    for coarse, apart in ((2.08, True), (2.10, False)):
        others = theirs(monkeypatch, {"velocity_upper": coarse}, {"velocity_upper": 2.05})
        sentences = block.disagreements(block.with_bars(table), block.peer_with_bars(others))
        assert any("v disc m/s: ours 2.000 ± 0.010, NGSolve 2.05" in sentence for sentence in sentences) == apart
        text = block.report(table, others, "")
        assert all(f"- {sentence}" in text for sentence in sentences) and ("Further apart than both" in text) == bool(sentences) and f"refine {block.REFINEMENTS[0]:g}" in text


def test_peer_that_fails_is_said(monkeypatch):
    """The page has the reason of the failure and no other values in place of the results."""
    monkeypatch.setattr(peers, "two_bodies", lambda *_, **__: (None, "exit code 1: no answer"))
    others, reason = block.ask_peer([CASE])
    assert others.empty and reason == "exit code 1: no answer"
    assert block.ask_peer([])[1] == "none of its cases is among these"


def test_peer_is_not_run_where_it_is_not_installed(monkeypatch):
    """The reason contains the command that installs it."""
    monkeypatch.setattr(peers, "find", lambda _: None)
    assert peers.two_bodies(1.0, refine=0.5) == (None, "ngsolve is not installed (pip install ngsolve==6.2.2608)")
