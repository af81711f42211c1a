"""The disc on the free block with error bars: results, error bars, checks and comparisons that can
fail, text of the page, a coarse run."""

import math

import pandas as pd
import pytest

from benchmarks import disc_block_errors as block, peers
from tests.support.disc_block_errors import tables


@pytest.mark.parametrize("change, word", [
    ({}, None), ({"rebound_vy_2": -0.37}, "block's velocity"), ({"rebound_vy_2": -0.77}, "block's velocity"), ({"rebound_vy_1": -0.1}, "does not rebound"),
    ({"rebound_vy_2": -0.6001}, "momentum"), ({"energy_drift": 1.1e-9}, "energy drifts"), ({"energy_drift": math.nan}, "energy drifts"),
    ({"exit": 11, "message": "no step"}, "no answer: no step")])
@pytest.mark.parametrize("which", [1, 2])
def test_checks_fail_on_a_run_that_is_wrong(monkeypatch, tmp_path, change, word, which):
    """Each check reports the run and the error, also for the reference. The page has the verdict on
    the requirement."""
    table = tables(monkeypatch, tmp_path, *[{}] * which, change)
    sentences = block.violations(table)
    assert any(word in sentence for sentence in sentences) if word else not sentences
    assert all(("reference" if which == 2 else "accuracy 0.005") in sentence for sentence in sentences)
    text = block.report(table, block.ask_peer([])[0], "ngsolve is not installed")
    assert "The reference has an error of its own" in text and ("the requirement FAILS" in text) == bool(word) and "Not run: ngsolve is not installed." in text


def test_a_coarse_real_run(tmp_path, monkeypatch, capsys):
    """One case at an accuracy of 0.1 passes every check and writes tables and page."""
    monkeypatch.setattr(peers, "find", lambda _: None)
    assert block.main(["--cases", "1", "--accuracy", "0.1", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "page.md")]) == 0
    printed, page = capsys.readouterr().out, (tmp_path / "page.md").read_text()
    assert "2 runs: the requirement holds" in printed and page.startswith("# A disc on a free block, with error bars\n") and "Measured by `python -m benchmarks disc-block-errors --cases 1" in page
    table = pd.read_csv(tmp_path / "out/disc-block-errors.csv")
    assert table.accuracy.tolist() == ["0.1", "reference"] and table[list(block.SHARES)].sum(axis=1).to_list() == pytest.approx([100, 100], abs=1e-6)
    assert block.differences(table)["v disc m/s"].iloc[0] < 0.3
