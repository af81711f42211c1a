"""Run times at equal errors: safe settings, references that must agree, the verdict, the page. No
other program is needed."""

import math

import pandas as pd
import pytest

from benchmarks import equal_errors as equal

CASE = equal.CASES["normal"]
FINE = {equal.OURS: [{"impulse": 208.1, "vy": 7.39}, {"impulse": 208.22, "vy": 7.394}, {"impulse": 208.2, "vy": 7.394}],
        equal.TUNED: [{"impulse": 208.0, "vy": 7.38}, {"impulse": 208.15, "vy": 7.39}, {"impulse": 208.18, "vy": 7.393}]}


def rows(program: str, *settings: tuple[float, float]) -> pd.DataFrame:
    """Settings of a program from coarse to fine: error [%] and processor seconds of the process.
    The time integration takes half of them."""
    return pd.DataFrame([{"program": program, "setting": f"{n}", "exit": 0, "message": "", "error": error, "cpu_seconds": seconds / 2, "process_seconds": seconds}
                         for n, (error, seconds) in enumerate(settings)])


def test_luck_is_no_accuracy():
    """A setting is safe if all finer ones satisfy the level and finish. The fastest of the safe
    settings is reported."""
    table = rows(equal.OURS, (0.05, 1.0), (0.3, 2.0), (0.08, 5.0), (0.02, 4.0))
    assert equal.safe(table, equal.OURS, 0.1).setting == "3" and equal.safe(table, equal.OURS, 0.5).setting == "0"
    assert equal.safe(table, equal.OURS, 0.01) is None
    assert equal.safe(table.assign(exit=[0, 0, 1, 0]), equal.OURS, 0.5).setting == "3"
    assert equal.safe(table.assign(exit=[0, 0, 0, 1]), equal.OURS, 0.5) is None
    assert equal.safe(table, equal.TUNED, 0.5) is None and equal.safe(table.drop(columns="error").assign(exit=1), equal.OURS, 1.0) is None


def test_errors_are_relative_to_what_the_page_says():
    """The impulse is relative to itself, velocities to the impact speed, the spin to this speed at
    the rim. The error is the largest."""
    errors = equal.errors(CASE, {"impulse": 206.0, "vy": 7.4}, {"impulse": 200.0, "vy": 7.0})
    assert errors == pytest.approx({"impulse %": 3.0, "vy %": 5.0, "error": 5.0})
    oblique = equal.CASES["oblique"]
    still = dict.fromkeys(oblique.answers, 1.0)
    rim = math.pi * 1722 * 0.05**4 / 2 / 0.05 * 12.0
    assert equal.errors(oblique, still | {"spin": 1.0 + 0.01 * rim}, still)["spin %"] == pytest.approx(1.0)


def test_references_agree_within_their_bars():
    """The error bar is the largest difference of a program's finest run from the two next.

    References that differ by more than both error bars do not agree, whichever program is wrong.
    """
    table = equal.compare(CASE, FINE)
    assert table.agree.all() and table["its bar %"][0] == pytest.approx(0.05) and table["bar %"][0] == pytest.approx(100 * 0.013 / 8)
    for program in FINE:
        off = [run | {"vy": run["vy"] + 0.05} for run in FINE[program]]
        assert equal.compare(CASE, FINE | {program: off}).agree.tolist() == [True, False]
    assert equal.compare(CASE, FINE | {equal.TUNED: [None] * 3}).empty


def test_bars_see_mesh_and_step():
    """The finest run of a reference has elements and steps of at most three quarters of those of
    the two next, for each program and case.

    If two runs had equal elements or steps, the error bar would miss this error.
    """
    for case in equal.CASES.values():
        for program, points in case.finest.items():
            *others, finest = [case.settings[program][-1], *points]
            for name, value in finest.items():
                assert all(value <= 0.75 * other[name] or name == "refine" and value >= 1.25 * other[name] for other in others), (case.title, program)


def test_verdict_says_who_is_quicker():
    """The ratios are the fastest other program over ours at equal levels. A ratio below 1 means
    that ours is not the fastest; a level that one side misses is not compared."""
    table = pd.concat([rows(equal.OURS, (0.9, 1.0), (0.4, 2.0)), rows(equal.TUNED, (0.8, 0.5), (0.4, 6.0), (0.05, 9.0))], ignore_index=True)
    ratios = equal.beside(table)
    assert ratios[1.0] == pytest.approx((0.5, 0.5)) and ratios[0.5] == pytest.approx((3.0, 3.0)) and all(map(math.isnan, ratios[0.1]))
    text = equal.verdict({"normal": True, "ball": False}, {"normal": ratios})
    assert "agree within their bars in 1 of 2 cases (not: ball)" in text and "time integration is the quickest in 1 of 2 comparisons, our whole process in 1" in text
    assert "1 %: 0.5 / 0.5, 0.5 %: 3.0 / 3.0, 0.1 %: -" in text
