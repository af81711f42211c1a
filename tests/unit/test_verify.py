"""make verify: the verdicts follow from the numbers, the table has the worst number, the exit code
shows whether all pass."""

import math

import pytest

from ffimpact.__main__ import guarded
from tests.support.verify import case
from verification import verify
from verification.case import Row


def passes(rows, **entries) -> bool:
    tested_case = case(rows, **entries)
    return bool(verify.judged(verify.judge(tested_case, list(tested_case.rows(None))))["pass"].all())


# The first two: only the finest size counts. The next two: the finest must be more accurate than
# the coarsest.
@pytest.mark.parametrize("values, good", [
    ((1.1, 1.05, 1.009), True), ((1.1, 1.05, 1.011), False),
    ((1.001, 1.0, 1.002), False), ((0.9, 1.2, 0.995), True),
    ((1.1, 1.05, math.nan), False)])
def test_a_case_passes_within_its_tolerance_and_converging(values, good):
    """At the finest size the error must be within the tolerance and below that at the coarsest
    size, in any order of the rows."""
    rows = [("a", size, value, 1) for size, value in zip((4, 2, 1), values)]
    assert passes(rows) is passes(rows[::-1]) is good


def test_every_number_of_a_case_counts():
    """One number beyond its tolerance fails the case. A number with a single size is judged at this
    size."""
    good = [("a", 2, 1.05, 1), ("a", 1, 1.005, 1)]
    assert passes(good + [("b", 1, 3.02, 3)]) and not passes(good + [("b", 1, 3.04, 3)])


@pytest.mark.parametrize("fine, good", [(1 / 4, True), (1 / 2 ** 1.86, True), (1 / 2 ** 1.84, False), (1 / 2 ** 2.2, False)])
def test_orders_are_taken_from_the_two_finest_sizes(fine, good):
    """Between them the order must be within the tolerance of the expected one, above and below. The
    coarsest size does not count."""
    assert passes([("e", 4, 9, 0, 2), ("e", 2, 1, 0, 2), ("e", 1, fine, 0, 2)], by_order=True, tolerance=0.15) is good


def test_errors_are_relative():
    """Errors are relative to the expected value. If this is 0, the number itself is the error."""
    assert Row("a", 1, 2.2, 2).error == pytest.approx(0.1) and Row("a", 1, -0.3, 0).error == 0.3


def test_no_cores_are_refused(tmp_path, capsys):
    """One line with exit code 10, before anything runs."""
    assert guarded(verify.main, ["--cores", "0", "--out", str(tmp_path / "out")]) == 10
    assert capsys.readouterr().err == "ffimpact: --cores: 0 (accepted: from 1)\n" and not (tmp_path / "out").exists()


def test_tolerances_are_the_documented_ones():
    """They were fixed before the cases were run."""
    assert {entry.name: entry.tolerance for entry in verify.CASES} == {
        "V1 space": 0.15, "V1 time": 0.15, "V4": 0.01, "V5": 0.01, "V6": 0.02, "V7": 0.02, "V8": 0.01, "V9": 0.01, "V10": 0.03, "V11": 0.01, "V12": 0.005, "V13": 0.01, "V14": 0.01, "V16": 0.01, "V17": 0.05,
        "V18": 0.05, "V19": 0.01, "V24": 0.01, "annulus": 0.02}
