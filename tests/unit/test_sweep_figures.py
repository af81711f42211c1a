"""Figures and words of the built-in sweeps, drawn from tables whose numbers are known."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from ffimpact.sweeps import sweep, sweep_figures

BAR = 1e-5  # error bar of every number


def rows_of(loaded: sweep.Sweep, name: str, values) -> pd.DataFrame:
    """The table of a sweep of which every point has finished, with `values` of a number."""
    rows = pd.DataFrame(loaded.points).assign(exit=0, message="", **dict.fromkeys(loaded.collect, 1.0))
    return rows.assign(**{name: values, f"{name}_error": BAR})


@pytest.fixture
def figure(monkeypatch, tmp_path):
    """figure(sweep, rows): the figure that draw() makes of a table, with its file."""
    kept = []
    save = sweep_figures.save
    monkeypatch.setattr(sweep_figures, "save", lambda made, path: (kept.append(made), save(made, path)))

    def draw(loaded, rows):
        sweep_figures.draw(loaded, rows, tmp_path)
        assert (tmp_path / "sweep.png").stat().st_size > 10_000
        return kept[-1]
    yield draw
    plt.close("all")


def test_lines_have_their_bars_and_what_failed_is_below(figure):
    """A curve for each value of `by`, with error bars, in the unit of the report. The paper's number
    has a star. Failed points are marked below the axis."""
    loaded = sweep.load("contact-time-svk")
    speed = np.array([point["speed"] for point in loaded.points])
    rows = rows_of(loaded, "contact_time", 5e-3 - 1e-4 * speed)
    rows.loc[rows.speed > 12, "exit"] = 12
    made = figure(loaded, rows)
    axes = made.axes[0]
    assert len(axes.containers) == 2 and axes.get_ylabel() == "contact time [ms]"
    for curve in axes.containers:
        x, y = curve.lines[0].get_data()
        assert len(x) == 58 and y == pytest.approx(5 - 0.1 * x)
        (sticks,) = curve.lines[2]
        assert np.ptp(sticks.get_segments()[0][:, 1]) == pytest.approx(2e3 * BAR)
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert words[:2] == ["ν = 0.3", "ν = 0.45"] and sum("broke down" in text for text in words) == 2
    assert made.get_suptitle() == "Contact time over speed, St. Venant–Kirchhoff (figure 6b)\nSt. Venant–Kirchhoff"
    texts = sweep_figures.findings(loaded, rows, None)
    assert len(texts) == 4 and all("contact time over speed: falls from 4.95 to" in text for text in texts[:2])


def test_a_wide_range_is_drawn_in_logarithms(figure):
    """Both axes of the limit of the slip velocity, where values span more than three decades."""
    loaded = sweep.load("slip-limit")
    epsilon = np.array([point["slip_velocity"] for point in loaded.points])
    axes = figure(loaded, rows_of(loaded, "rebound_vx", epsilon**2)).axes[0]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert figure(loaded, rows_of(loaded, "rebound_vx", 4 + epsilon)).axes[0].get_yscale() == "linear"


def test_a_map_has_a_cell_for_each_point_and_the_line_of_its_level(figure):
    """Cells have their numbers. What failed has none. The words name where the level is met."""
    loaded = sweep.load("calibrate")
    stiffness = np.array([point["penalty"] for point in loaded.points])
    rows = rows_of(loaded, "contact_time", 4.8e-3 - 1e-4 * np.log10(stiffness / 1e10))
    rows.loc[(rows.law == "svk") & (rows.nu == 0.4999), "exit"] = 11
    made = figure(loaded, rows)
    maps = [axes for axes in made.axes if axes.images]
    assert [axes.get_title() for axes in maps] == ["St. Venant–Kirchhoff", "neo-Hookean", "neo-Hookean with J = 1"]
    cells = np.asarray(maps[0].images[0].get_array())
    assert cells.shape == (8, 8) and np.isnan(cells[:, -1]).all() and cells[0, 0] == pytest.approx(4.95)
    assert [text.get_text() for text in maps[0].texts].count("failed") == 8
    levels = maps[1].collections[0].get_paths()[0].vertices
    assert levels[:, 1] == pytest.approx(3, abs=1e-6), "k = 1e10 is row 3"
    met = [line for line in sweep_figures.findings(loaded, rows, None) if "k [Pa" in line]
    assert met and all(line.endswith("2.5e+09 to 4e+10") for line in met)


def test_histories_have_a_line_for_each_run(figure, monkeypatch, tmp_path):
    """Forces stand at the middle of their steps. The difference of two lines, and that of a run and
    its finer one, are in words."""
    loaded = sweep.load("law-comparison")

    def history(folder):
        size = (1.1 if "neohookean" in folder.name else 1.0) * (1.02 if "accuracy=0.0006" in folder.name else 1.0)
        t = np.linspace(1e-5, 5e-3, 500)
        return {"t": t, "dt": np.full(500, 1e-5), "normal_force": 1e4 * size * np.sin(np.pi * t / 5e-3)}
    monkeypatch.setattr(sweep_figures, "read_history", history)
    rows = rows_of(loaded, "contact_time", 5e-3)
    made = figure(loaded, rows)
    assert [axes.get_title() for axes in made.axes] == ["speed = 1 m/s", "speed = 10 m/s"]
    for axes in made.axes:
        first, second = axes.lines
        assert first.get_xdata()[0] == pytest.approx(5e-3) and axes.get_xlabel() == "time [ms]"
        assert second.get_ydata() == pytest.approx(1.1 * first.get_ydata())
    assert made.axes[0].get_ylabel() == "normal force [kN/m]"
    texts = sweep_figures.findings(loaded, rows, tmp_path)
    assert len(texts) == 2 and all("10.0 %" in text and "(mesh and step change 2.0 %)" in text for text in texts)
    monkeypatch.setitem(loaded.figure, "y", ["presure"])
    with pytest.raises(sweep_figures.BadInput, match="figure: y = 'presure'"):
        sweep_figures.draw(loaded, rows, tmp_path)


def test_a_sweep_without_a_figure_draws_none(tmp_path):
    """No file and no words."""
    loaded = sweep.load("closest-points")
    loaded.figure.clear()
    assert sweep_figures.findings(loaded, pd.DataFrame(), tmp_path) == [] and sweep_figures.draw(loaded, pd.DataFrame(), tmp_path) is None
    assert not list(tmp_path.iterdir())
