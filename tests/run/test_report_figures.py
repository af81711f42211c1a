"""Content of figures: start of time, end of contact, the paper's number, a scale; and the section
of a body in three dimensions."""

import itertools
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from matplotlib.transforms import Bbox

from ffimpact.report import compare, figures
from ffimpact.sweeps import sweep, sweep_figures
from tests.support.report_figures import SCENE, history, labels


@pytest.fixture(autouse=True)
def closed():
    yield
    figures.plt.close("all")


def test_the_key_of_a_comparison_stands_above_its_panels(tmp_path, monkeypatch):
    """The names of the runs cover no panel and are in the figure, without their warnings."""
    summary = dict(dofs=294, warnings=["ellipticity: lost", "peak force: scatters"], reach=0.05, energy_initial=432.8)
    run = SimpleNamespace(history=history(max_penetration=np.full(100, 1e-4)), scene=SCENE | {"exponent": 1}, summary=summary)
    monkeypatch.setattr(compare.plt, "close", lambda figure: None)
    compare.draw({"disc-normal": run, "disc-normal-neohookean": run}, tmp_path / "both.png")
    figure = compare.plt.gcf()
    assert "ellipticity" not in " ".join(text.get_text() for legend in figure.legends for text in legend.get_texts())
    boxes = [artist.get_tightbbox() for artist in (*figure.legends, *figure.axes)]
    assert all(0 <= box.y0 and box.y1 <= figure.bbox.y1 for box in boxes)
    assert not [pair for pair in itertools.combinations(boxes, 2) if Bbox.intersection(*pair)]


def test_limits_of_friction_are_not_clipped():
    """Figure 5: all curves of the friction limits are in the panel, each panel has a label on its y
    axis, and there is no enlargement if all slides."""
    h = history()
    h["friction_force"] = -0.5 * h["normal_force"]
    scene = SCENE | dict(friction_static=0.7, friction_dynamic=0.5)
    figure = figures.friction_force(h, scene)
    assert len(figure.axes) == 2
    low, high = figure.axes[1].get_ylim()
    assert low < -0.7e-3 * h["normal_force"].max() and all(axes.get_ylabel() for axes in figure.axes)
    h["sliding_fraction"] = np.where(np.arange(100) % 4 < 2, 1.0, 0.0)
    figure = figures.friction_force(h, scene)
    assert len(figure.axes) == 4 and all(axes.get_ylabel() for axes in figure.axes)


# ---- sweeps

def test_failed_points_have_rows_of_their_own():
    """Points without a value are marked below the axis, with a row for each curve; a breakdown is
    labelled; the paper's number is a star at its speed."""
    plan = sweep.load("contact-time-svk")
    rows = pd.DataFrame([point | dict(exit=12 * (point["speed"] > 10), contact_time=5e-3, thresholded_contact_time=4.9e-3) for point in plan.points])
    figure = sweep_figures.draw_lines(plan, rows, None)
    crosses = [line for line in figure.axes[0].lines if line.get_marker() == "x"]
    heights = [set(line.get_ydata()) for line in crosses]
    assert len(crosses) == 2 and all(max(levels) < 0 for levels in heights) and not heights[0] & heights[1]
    assert {"ν = 0.3: broke down (det F ≤ 0), no value", "paper, section 3.3: 4.8 ms"} <= set(labels(figure.axes[0]))
    for axes in figure.axes:
        star, = (line for line in axes.lines if line.get_marker() == "*")
        assert star.get_xdata() == [8] and star.get_ydata() == pytest.approx([4.8])
