"""The contact as a whole: its half-width and largest pressure in the history, where and when in the summary, against fields/contact.csv."""

import numpy as np
import pandas as pd
import pytest

from orchestrate import run, scene
from orchestrate.report import contact
from orchestrate.results import RunResult

SCENES = {"disc": ("disc-normal", {}), "whole disc": ("disc-oblique", {}), "revolution": ("ball-axisymmetric", {"accuracy": 0.1}),
          "ball": ("ball", {"accuracy": 0.2}), "block": ("disc-block", {}), "pairs of points": ("disc-block", {"pairing": "pairwise"})}


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """ran(which): a coarse run with snapshots at all steps, once."""
    results = {}

    def at(which: str) -> RunResult:
        if which not in results:
            name, given = SCENES[which]
            results[which] = run.run(scene.load(name), {"accuracy": 0.4, "fields": 30} | given, tmp_path_factory.mktemp("run") / "out", estimate=False)
        return results[which]
    return at


def at_the_same_times(result: RunResult) -> list[tuple[pd.DataFrame, pd.Series]]:
    """The points under load at an instant and the row of the history there."""
    history = pd.DataFrame(result.history)
    return [(points, history.iloc[(history.t - t).abs().argmin()]) for t, points in contact.read(result.folder).groupby("t")]


@pytest.mark.parametrize("which", SCENES)
def test_largest_pressure(ran, which):
    """max_pressure is the largest of contact.csv at its instant, of every body; the summary's is the largest of the history, at that time; it is at
    that point of the outline where contact.csv has it."""
    result = ran(which)
    h, s = result.history, result.summary
    for points, row in at_the_same_times(result):
        assert row.max_pressure == pytest.approx(points.pressure.max(), rel=1e-7)
        for body in range(1, 3 if "max_pressure_2" in row else 1):
            assert row[f"max_pressure_{body}"] == pytest.approx(points[points.body == body].pressure.max(), rel=1e-7)
    most = int(np.argmax(h["max_pressure"]))
    assert s["max_pressure"] == h["max_pressure"][most] > 0 and s["max_pressure_time"] == h["t"][most]
    there = [points.loc[points.pressure.idxmax()] for points, row in at_the_same_times(result) if row.t == h["t"][most]]
    assert not there or (there[0].X, there[0].Y) == pytest.approx((s["max_pressure_x"], s["max_pressure_y"]), rel=1e-6)
    assert (s["max_pressure_z"] is not None) == (which == "ball")


@pytest.mark.parametrize("which", SCENES)
def test_half_width_is_that_of_the_size(ran, which):
    """Of one patch without a hole: half the touching length, the radius of the touching area, to the distance of two points; 0 without contact."""
    h = ran(which).history
    size, touches = h["contact_size"], h["contact_size"] > 0
    radius = np.sqrt(size / np.pi) if which in ("revolution", "ball") else size / 2
    coarse = {"ball": 0.25, "block": 0.15, "pairs of points": 0.15}.get(which, 0.1)     # of two bodies the larger one, the size is their mean
    large = size > 0.5 * size.max()
    assert large.sum() > 5 and np.abs(h["contact_half_width"] / np.where(touches, radius, 1) - 1)[large].max() < coarse
    assert (h["contact_half_width"][~touches] == 0).all() and (h["contact_half_width"][touches] > 0).all()


def test_no_contact_has_no_pressure(tmp_path):
    """A disc that flies: zeros, and no time or place."""
    result = run.run(scene.load("disc-normal"), {"accuracy": 0.4, "height": 0.1, "end_time": 1e-3, "fields": 0}, tmp_path / "out", estimate=False)
    assert not result.history["max_pressure"].any() and not result.history["contact_half_width"].any()
    assert result.summary["max_pressure"] == 0 and result.summary["max_pressure_time"] is None and result.summary["max_pressure_x"] is None
