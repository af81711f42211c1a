"""make verify: the verdicts follow from the numbers, the table has the worst number, the exit code
shows whether all pass."""

import json
import os
import signal
import time

import pandas as pd
import pytest

from examples.paper import page as paper
from ffimpact.__main__ import guarded
from ffimpact.failure import Failure
from tests.support.verify import case
from verification import verify
from verification.case import Row


@pytest.fixture
def cases(monkeypatch, fake):
    """cases(case, ...): replaces the real cases."""
    return lambda *replacements: monkeypatch.setattr(verify, "CASES", replacements)


FINE = [("half: a", 0.2, 1.05, 1, 1), ("half: b", 0.2, 1e-9, 0), ("half: a", 0.1, 1.004, 1, 1), ("half: b", 0.1, 1e-9, 0)]


def test_all_pass(cases, tmp_path, capsys):
    """Exit code 0, a table with a row for each case, all numbers in verify.csv, a figure for each
    case, and the page of the report."""
    def beside(axes, folder):
        axes.plot([0, 1], [1, 0])
    cases(case(FINE, name="V1 space", beside=beside),
          case([("e", 2, 0.4, 0, 2), ("e", 1, 0.1, 0, 2)], name="V2", by_order=True, tolerance=0.15))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "all pass" in out and "NOT" not in out and out.count(" pass |") == 2 and "half: a" in out and "order of e" in out
    frame = pd.read_csv(tmp_path / "verify.csv")
    assert list(frame) == verify.COLUMNS and len(frame) == 4 + 1 + 2 + 1 and frame.tolerance.notna().sum() == 3 + 1
    assert (tmp_path / "v1-space.png").exists() and (tmp_path / "v2.png").exists()
    assert json.loads((tmp_path / "summary.json").read_text())["provenance"]["code"] == verify.code_hash()
    page = paper.verification(tmp_path)
    assert page.count("data:image/png") == 2 and "<b>all pass</b>" in page and "<td>half: a</td>" in page


def test_a_case_that_fails_is_named(cases, tmp_path, capsys):
    """Exit code 1 with the number, the expected value and the tolerance; also on the page."""
    cases(case(FINE), case([("depth", 2, 1.3, 1), ("depth", 1, 1.2, 1)], name="V9"))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "NOT all pass" in out and "FAILED  V9, depth: 1.2, expected 1, error 0.2 > 0.01" in out
    assert " FAIL |" in out and " pass |" in out
    assert "NOT all pass" in paper.verification(tmp_path) and not json.loads((tmp_path / "summary.json").read_text())["passed"]


def test_a_case_that_does_not_run_fails(cases, tmp_path, capsys):
    """Its message replaces the numbers, and the other cases run."""
    def broken(folder):
        yield Row("a", 1, 1, 1)
        raise Failure("rod.edp: exit code 8")
    cases(case([], name="V5", rows=broken), case(FINE))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "FAILED  V5, rod.edp: exit code 8" in out and " pass |" in out and not (tmp_path / "v5.png").exists()


def test_a_run_that_was_cut_short_leaves_no_verdict(cases, tmp_path):
    """summary.json belongs to a finished verification only: otherwise the report requires a new
    one."""
    cases(case(FINE))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 0
    cases(case([], rows=lambda folder: 1 / 0))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 0, "what the same code has left is taken as it is"
    def stopped(folder):
        os.kill(os.getpid(), signal.SIGINT)  # Ctrl-C while the case runs
        yield from ()
    cases(case([], rows=stopped))
    assert guarded(verify.main, ["--force", "--out", str(tmp_path)]) == 130 and not (tmp_path / "summary.json").exists()


def test_parts_run_side_by_side_in_one_order(cases, tmp_path):
    """Two parts of a case run simultaneously in one folder. Whichever ends first, verify.csv has
    the order of sequential runs."""
    def part(name, other, value):
        def rows(folder):
            (folder / name).touch()
            # The first part ends only after the second has run.
            while not (folder / other).exists() and value > 0:
                time.sleep(0.01)
            yield from (Row(name, size, value + size, value) for size in (0.2, 0.1))
        return rows
    written = []
    for cores, wait in ((2, "b"), (1, "a")):
        cases(case([], name="V5", rows=(part("a", wait, 100), part("b", "b", 101))), case(FINE, name="V6"))
        assert guarded(verify.main, ["--force", "--cores", f"{cores}", "--out", str(tmp_path)]) == 0
        written.append((tmp_path / "verify.csv").read_bytes())
    assert written[0] == written[1] and written[0].index(b",a,") < written[0].index(b",b,") < written[0].index(b"V6")


def test_a_case_that_breaks_down_fails(cases, tmp_path, capfd):
    """An unexpected error affects its case only, which fails."""
    cases(case([], name="V5", rows=lambda folder: 1 / 0), case(FINE))
    assert guarded(verify.main, ["--out", str(tmp_path)]) == 1
    out = capfd.readouterr().out
    assert "FAILED  V5, ZeroDivisionError: division by zero" in out and " pass |" in out
