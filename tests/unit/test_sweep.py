"""Sweeps: the file and its errors, the table, killed and simultaneous sweeps, Snakemake, trends,
maps and histories."""

import numpy as np
import pandas as pd
import pytest

from ffimpact.sweeps import sweep_figures

# ---- text of figures

def rows_over_speed(values, error=0.01) -> pd.DataFrame:
    return pd.DataFrame({"speed": np.arange(1.0, 1 + len(values)), "contact_time": 1e-3 * np.array(values), "exit": 0,
                         "contact_time_error": 1e-3 * error})


def test_trend_counts_rises_beyond_the_error_bar():
    """A rise counts if it exceeds the root of the sum of squares of the error bars at both ends."""
    text = sweep_figures.trend(rows_over_speed([5.0, 4.8, 4.81, 4.7, 4.9, 4.6]), "speed", "contact_time", "")
    assert "falls from 5 to 4.6 ms; of 5 steps 2 rise, 1 of them by more than their error bar" in text and "largest by 0.2 ms" in text
    assert "0 of them by more" in sweep_figures.trend(rows_over_speed([5, 4.8, 4.9, 4.7, 4.6], 0.1), "speed", "contact_time", "")
    assert "0 rise" in sweep_figures.trend(rows_over_speed([5, 4.9, 4.8]), "speed", "contact_time", "")
    failed = rows_over_speed([5, 4.9, 4.8]).assign(exit=[0, 0, 12])
    assert "too few points" in sweep_figures.trend(failed, "speed", "contact_time", "")


@pytest.mark.parametrize("values, error, course", [
    ([5, 4.8, 4.81, 4.7, 4.9, 4.6], 0.01, sweep_figures.FALLS), ([4.6, 4.9, 4.7, 5], 0.01, sweep_figures.RISES),
    ([5, 4.4, 4.3, 4.5, 4.9], 0.01, sweep_figures.MINIMUM), ([4.3, 4.9, 5, 4.8, 4.4], 0.01, sweep_figures.MAXIMUM),
    ([5, 4.4, 4.3, 4.5, 4.9], np.nan, sweep_figures.MINIMUM), ([5, 4.6, 4.4, 4.3, 4.35], 0.02, sweep_figures.FALLS),
    ([4.5, 5, 4.2, 4.6], 0.01, sweep_figures.UNEVEN), ([5, 4.8, 4.9, 4.7, 4.6], 0.2, sweep_figures.LEVEL)])
def test_a_trend_is_the_course_of_the_curve(values, error, course):
    """A curve falls if it begins at its highest and ends at its lowest value, by more than twice
    the error bars.

    A minimum is reported with its position. The curve with opposite sign does the opposite.
    """
    there, opposite = rows_over_speed(values, error), {sweep_figures.FALLS: sweep_figures.RISES,
                                                       sweep_figures.MINIMUM: sweep_figures.MAXIMUM}
    steps = sweep_figures.steps_against(there, "speed", "contact_time")
    assert steps.course == course and steps.falls == (course == sweep_figures.FALLS)
    text = sweep_figures.trend(there, "speed", "contact_time", "")
    assert f"contact time over speed: {course}" in text
    assert ("4.3 at speed = 3 m/s" in text) == (course == sweep_figures.MINIMUM)
    turned = sweep_figures.steps_against(rows_over_speed([10 - value for value in values], error), "speed", "contact_time")
    assert turned.course == (opposite | {other: kind for kind, other in opposite.items()}).get(course, course)


def test_trend_does_not_trust_one_small_difference():
    """A point whose two runs agree by chance has the error bar of its curve."""
    rows = rows_over_speed([5.0, 4.8, 4.9, 4.7, 4.6]).assign(contact_time_error=[1e-4, 0, 0, 1e-4, 1e-4])
    assert "1 rise, 0 of them by more" in sweep_figures.trend(rows, "speed", "contact_time", "")


def test_set_of_a_level():
    """The range of y in which the value is within the band of the level, interpolated in the
    logarithm."""
    group = pd.DataFrame({"nu": 0.3, "penalty": [1e9, 1e10, 1e11], "contact_time": [5e-3, 4.8e-3, 4.6e-3], "exit": 0})
    figure = {"x": "nu", "y": "penalty", "colour": "contact_time", "level": 4.8e-3, "band": 1e-4}
    lines = sweep_figures.level_set_words(figure, "", group)
    assert "4.8 ± 0.1 ms is met" in lines[0] and lines[1] == "  ν = 0.3: k [Pa/m^m] 3.2e+09 to 3.2e+10"
    assert sweep_figures.level_set_words(figure | {"level": 1.0}, "", group)[1] == "  ν = 0.3: no k [Pa/m^m]"


def test_distance_of_histories():
    """||b - a|| / ||a|| in L2 over time, for different time steps."""
    fine, coarse = np.linspace(0, 1, 2001), np.linspace(0, 1, 101)
    a, b = (fine, np.sin(np.pi * fine)), (coarse, 1.1 * np.sin(np.pi * coarse))
    assert sweep_figures.distance(a, b) == pytest.approx(0.1, rel=1e-3) and sweep_figures.distance(a, a) == 0
