"""Functions of time: extremes, kinks, and expressions that change fast."""

import math
import time
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from ffimpact.failure import BadInput
from ffimpact.geometry import implicit
from ffimpact.geometry.enclosures import enclosure
from ffimpact.geometry.time_functions import (
    CLOSE,
    TimeFunction,
    farthest,
    functions,
    of_entry,
    of_table,
)

TRIANGLE = "max(0, 1e6*(1 - abs(t - 0.0103)/4e-6))"
# Expression, end [s], largest value, largest slope per second, integral.
FAST = {
    "triangle of 8 us": (TRIANGLE, 0.02, 1e6, 1e6 / 4e-6, 4.0),
    "bell of 20 us": ("1e5*exp(-((t-0.0103)/2e-5)^2)", 0.02, 1e5, 1e5 / 2e-5 * math.sqrt(2 / math.e), 2 * math.sqrt(math.pi)),
    "bell of 1 ns": ("exp(-((t-0.3)/1e-9)^2)", 1.0, 1.0, 1e9 * math.sqrt(2 / math.e), 1e-9 * math.sqrt(math.pi)),
    "triangle of 1 ns": ("max(0, 1 - abs(t-0.3)/5e-10)", 1.0, 1.0, 2e9, 5e-10),
    "rational": ("1/(1 + ((t-3e-6)/1e-7)^2)", 1e-5, 1.0, 1e7 * 3 * math.sqrt(3) / 8, 1e-7 * (math.atan(30) + math.atan(70))),
}


@pytest.mark.parametrize("name", FAST)
def test_what_is_short_is_found(name):
    """A pulse that no fixed times would hit has its height, slope and integral, to CLOSE of the
    expression; its integral to 1e-6."""
    expression, end, value, slope, integral = FAST[name]
    function = of_entry("load", expression, end)
    assert function.largest_value == pytest.approx(value, rel=CLOSE)
    assert function.largest_slope == pytest.approx(slope, rel=1e-4)
    assert CubicHermiteSpline(*function.knots.T).integrate(0.0, end) == pytest.approx(integral, rel=1e-6)
    assert end <= function.knots[-1, 0] < 1.25 * end


@pytest.mark.parametrize("expression", ["exp(-((t-0.3)/1e-13)^2)", "exp(-((t-0.3)/1e-15)^2)", "abs(t-0.3)/(t-0.3)"])
def test_what_is_too_short_is_named(expression):
    """What changes faster than round-off allows to follow is refused and not lost."""
    with pytest.raises(BadInput, match=r"load: .* jumps, or has no limit, at t = 0\.3 s"):
        of_entry("load", expression, 1.0)


@pytest.mark.parametrize("expression", [
    "sin(40*t)*exp(-3*t)", "t^1.5", "1/(0.1+t)^2", "sqrt(t+1e-3)", "max(sin(9*t), cos(7*t)^3)", "abs(t-0.4)*t",
    "0.02*min(t/0.1, 1)^2 - max(0, t-0.7)^3", "max(0, max(0, t-0.5))", "exp(-t)/(2+cos(30*t))", "min(abs(sin(5*t)), 0.5)"])
def test_an_expression_is_followed_to_its_error(expression):
    """At 20,000 random times the polynomials differ by at most CLOSE of the largest value."""
    function = of_entry("load", expression, 1.0)
    t = np.random.default_rng(0).uniform(0, 1, 20_000)
    value = implicit.run(implicit.program("load", expression, "t"), t[:, None])[0]
    assert abs(function(t) - value).max() <= CLOSE * abs(value).max() and len(function.knots) < 3000


@pytest.mark.parametrize("expression", [
    "0.01*t", "1-cos(100*t)", "t/0.1-sin(2*3.14159*t/0.1)/(2*3.14159)", "sin(200*t)-200*t", "exp(-((t-0.01)/0.0002)^2)", "abs(sin(300*t))",
    "(1-cos(10*t))^3", "max(0, t-0.03)^2"])
@pytest.mark.parametrize("end", [0.003, 0.09, 0.125])
def test_a_longer_use_of_an_expression_has_the_same_knots(expression, end):
    """Knots up to the first grid time after the end, to the last digit, for seven times the end."""
    short, long = (of_entry("load", expression, factor * end).knots for factor in (1, 7))
    assert len(short) < len(long) and (short == long[: len(short)]).all()


def test_enclosures_contain_the_derivatives():
    """Taylor coefficients of every operation at random times are within those of the interval."""
    code = implicit.program("f", "exp(sin(3*t))/(2+t)^2 + sqrt(1+t^3) - cos(t)^3", "t")
    begin, width, step = np.linspace(0, 1, 21)[:-1], 0.05, 1e-3
    (low, high), _ = enclosure(code, begin, begin + width)
    inside = begin + width * np.random.default_rng(1).uniform(0.1, 0.9, 20)
    stencil = np.arange(-4, 5)
    values = implicit.run(code, (inside[:, None] + step * stencil).ravel()[:, None])[0].reshape(20, 9)
    local = np.polynomial.polynomial.polyfit(step * stencil, values.T, 8)[:5]
    size = abs(high) + abs(low) + 1
    assert (low - 1e-3 * size <= local).all() and (local <= high + 1e-3 * size).all()
    assert ((high - low)[0] < 0.5).all()


def test_extremes_lie_between_knots():
    """Two knots with value 0 and slopes of opposite signs: the extremes are inside."""
    arch = TimeFunction(np.array([[0.0, 0.0, 1.0], [2.0, 0.0, -1.0]]))  # t - t^2/2
    assert arch.largest_value == pytest.approx(0.5) and 1.0 in arch.extreme_times
    assert not arch.is_constant
    held = of_table("motion", [0.0, 0.005, 0.015, 0.03], [0.0, 0.0, 0.002, 0.002])
    assert not held.knots[:, 2].any() and held.largest_slope == pytest.approx(1.5 * 0.002 / 0.01, rel=1e-12)
    assert farthest([arch])[1] == pytest.approx(1.0) and farthest([arch], 0.25) == (pytest.approx(0.25 - 0.25**2 / 2), 0.25)


def test_a_table_holds_its_last_value_and_an_expression_goes_on():
    """The slope at the last knot is that before it; kinks are where a table begins and ends."""
    ramp = of_table("motion", [1e-3, 2e-3], [0.0, 1.0])
    assert ramp.kinks == pytest.approx(np.array([[1e-3, 1e3], [2e-3, 1e3]]))
    assert ramp(np.array([0.0, 5e-4, 1.5e-3, 2e-3, 3e-3])) == pytest.approx([0, 0, 0.5, 1, 1])
    assert float(ramp.slope(2e-3)) == pytest.approx(1e3) and float(ramp.slope(2.5e-3)) == 0
    for end in (1e-3, 3e-3):
        (whole,) = functions("motion", {"t": [1e-3, 2e-3], "x": [0.0, 1.0]}, "x", end, Path())
        assert whole.knots[[0, -1], 0] == pytest.approx([0, 2e-3]) and float(whole.slope(2e-3)) == pytest.approx(1e3)
    line = of_entry("motion", "3*t", 1.0)
    assert float(line(1.5)) == pytest.approx(4.5) and float(line.slope(1.0)) == pytest.approx(3) and not len(line.kinks)


def test_a_table_of_100_000_rows_is_read_in_seconds(tmp_path):
    """Reading, and the extremes, of a long CSV file take seconds of processor time."""
    t = np.linspace(0, 1, 100_000)
    rows = np.column_stack([t, np.sin(20 * t)])
    np.savetxt(tmp_path / "turn.csv", rows, "%.17g", ",", header="t,r", comments="")
    began = time.process_time()
    (turn,) = functions("rotation", "turn.csv", "r", 0.9, tmp_path)
    assert turn.largest_value == pytest.approx(1) and turn.largest_slope == pytest.approx(20, rel=1e-4)
    assert CubicHermiteSpline(*turn.knots.T).integrate(0, 0.9) == pytest.approx((1 - math.cos(18)) / 20, rel=1e-9)
    assert len(turn.knots) == pytest.approx(100_000, abs=3) and time.process_time() - began < 3.3


def test_rows_of_a_file_are_checked(tmp_path):
    """A row of another length, a word, and a file without rows are named."""
    for text, message in (("t,x\n0,0,1,1\n2,2,3,3\n", "line 2 of 'a.csv' is '0,0,1,1'"), ("t,x\n0,0\n\n1,b\n", "is '1,b'"),
                          ("t,x\n", "motion.x: 0 times and 0 values"), ("x\n1\n", "begins with 'x'")):
        (tmp_path / "a.csv").write_text(text)
        with pytest.raises(BadInput, match=message):
            functions("motion", "a.csv", "x", 1.0, tmp_path)


def test_kinks_are_found_where_branches_change():
    """Times to round-off, with the change of the slope; a smooth change of branch is none."""
    shape = of_entry("motion", "min(max(t-0.1, 0)*10, 1) - max(t-0.5, 0)^2", 1.0)
    assert shape.kinks == pytest.approx(np.array([[0.1, 10.0], [0.2, 10.0]]), rel=1e-12)
    assert shape.largest_slope == pytest.approx(10.0) and len(shape.knots) < 180
