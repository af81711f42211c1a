"""Draws the figure of a sweep and describes it in words. [figure] of a sweep file has one of the
kinds

    kind = "lines"      x, y (one name or several), by: y over x, one line for each value of `by`,
                        with error bars (default)
    kind = "map"        x, y, colour, by, panel: a column of maps for each value of `by`, a row for
                        each value of `panel`; level, band: lines where colour = level +- band
    kind = "histories"  y (a column of history.csv), panel, by: y over time, one panel for each
                        value of `panel`, one line for each value of `by`

x, y of a map, by and panel are parameters that vary. Together they must distinguish all points. The
y of lines and colour are numbers that are collected. The x of lines is logarithmic if its values
span a decade and are spaced logarithmically.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator

from ..failure import BadInput, brief, suggestion, unknown
from ..input.parameters import Table
from ..output.results import read_history
from ..report import report
from ..report.figures import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LAWS,
    ORANGE,
    PURPLE,
    SMALL,
    as_written,
    legend,
    numbers_of_the_paper,
    save,
    styled,
)
from . import study

if TYPE_CHECKING:
    from .sweep import Sweep

__all__ = [
    "FALLS",
    "LEVEL",
    "MAXIMUM",
    "MINIMUM",
    "RISES",
    "Trend",
    "UNEVEN",
    "bars",
    "bars_of_all",
    "check",
    "constants",
    "course",
    "distance",
    "distances",
    "draw",
    "draw_lines",
    "findings",
    "force",
    "label",
    "level_set",
    "level_set_words",
    "ranges",
    "spans",
    "steps_against",
    "trend",
]

KINDS = {
    "lines": ("x", "y", "by"),
    "map": ("x", "y", "colour", "by", "panel", "level", "band"),
    "histories": ("y", "panel", "by"),
}
WORDS = {"nu": "ν", "penalty": "k"}
SPAN = 1e3  # ratio of the largest to the smallest value above which the axis y is logarithmic
COLOURS, MARKERS = (BLUE, ORANGE, GREEN, PURPLE, GREY), "osd^v"


def check(entries: Table, points: list[Table], collected: list[str], columns: list[str]) -> Table:
    """Returns the [figure] of a sweep with defaults, empty if there is none. `columns` are those of
    its histories. Raises BadInput if it cannot be drawn or does not distinguish all points.
    """
    if not entries:
        return {}
    kind, varied = entries.get("kind", "lines"), list(points[0])
    if kind not in list(KINDS):
        raise BadInput(f"figure: kind {unknown(kind, KINDS)}")
    for key in entries:
        if key not in ("kind", *KINDS[kind]):
            raise BadInput(
                f"figure: {brief(key)}: no such entry for {kind}{suggestion(key, KINDS[kind])} "
                f"(accepted: {', '.join(KINDS[kind])})"
            )
    figure = {"kind": kind, "by": None, "panel": None, "level": None, "band": 0.0} | entries
    if kind != "map" and isinstance(figure.get("y"), str):
        figure["y"] = [figure["y"]]
    axes, results = {
        "lines": (("x",), ("y",)),
        "map": (("x", "y"), ("colour",)),
        "histories": ((), ("y",)),
    }[kind]
    telling = [*axes, *(key for key in ("by", "panel") if figure[key] is not None)]
    for key in telling:
        _name(key, figure.get(key), varied)
    accepted = columns if kind == "histories" else collected
    for key in results:
        names = figure.get(key) if key == "y" else [figure.get(key)]
        if not isinstance(names, list) or not names:
            raise BadInput(
                f"figure: {key} is missing (accepted: one or several of {', '.join(accepted)})"
            )
        for name in names:
            _name(key, name, accepted)
    used = [figure[key] for key in telling]
    if len(set(used)) < len(used) or len(
        {tuple(point[name] for name in used) for point in points}
    ) < len(points):
        raise BadInput(
            f"figure: {', '.join(used) or 'nothing'} does not tell the points apart (accepted: different names for "
            f"{', '.join((*axes, *(key for key in ('by', 'panel') if key in KINDS[kind])))}, that together do; "
            f"{', '.join(varied)} vary)"
        )
    if kind == "map":
        _check_map(figure, points)
    return figure


def _name(key: str, name: Any, accepted: list[str]) -> None:
    if not isinstance(name, str) or name not in accepted:
        raise BadInput(
            f"figure: {key} {'is missing' if name is None else f'= {brief(repr(name))}'} (accepted: {', '.join(accepted)})"
        )


def _check_map(figure: Table, points: list[Table]) -> None:
    """Raises BadInput if an axis of a map has fewer than two numbers, or if level or band is out of
    range.
    """
    for key in ("x", "y"):
        values = {point[figure[key]] for point in points}
        if len(values) < 2 or any(isinstance(value, str) for value in values):
            raise BadInput(
                f"figure: {key} = '{brief(figure[key])}' (accepted for a map: a parameter with at least two numbers)"
            )
    for key in ("level", "band"):
        value = figure[key]
        if value is not None and (type(value) not in (int, float) or not 0 <= value < 1e300):
            raise BadInput(f"figure: {key} = {brief(value)} (accepted: a number from 0 on)")
    if figure["level"] is not None and min(point[figure["y"]] for point in points) <= 0:
        raise BadInput(
            f"figure: y = '{brief(figure['y'])}' has values up to 0 (accepted with a level: above 0)"
        )


def draw(sweep: Sweep, rows: pd.DataFrame, out: Path) -> None:
    """Draws DIR/sweep.png, if the sweep has a figure."""
    if not sweep.figure:
        return
    with styled():
        figure = {"lines": draw_lines, "map": _map, "histories": _histories}[sweep.figure["kind"]](
            sweep, rows, out
        )
        figure.suptitle("\n".join(filter(None, [as_written(sweep.title), constants(sweep)])))
        with study.complete(out / "sweep.png") as part:
            save(figure, part)


def constants(sweep: Sweep) -> str:
    """Returns the parameters that are the same in all runs, in words: law, nu, speed, contact
    stiffness and, with friction, the slip velocity.
    """
    used = sweep.sample.content
    names = ("law", "nu", "speed", "penalty") + ("slip_velocity",) * (
        used.get("friction_static", 0) > 0
    )
    words = ", ".join(
        _value(name, used[name]) for name in names if name in used and name not in sweep.axes
    )
    return words.replace("Pa/m^m", "Pa/m") if used.get("exponent", 1) == 1 else words


def findings(sweep: Sweep, rows: pd.DataFrame, out: Path) -> list[str]:
    """Returns what the figure shows, in words: trends over x, the set for which a number has its
    level, or the distances of time histories.
    """
    if not sweep.figure:
        return []
    kind = sweep.figure["kind"]
    if kind == "lines":
        if not pd.api.types.is_numeric_dtype(rows[sweep.figure["x"]]):
            return []
        return [
            trend(group, sweep.figure["x"], y, words, sweep.figure["per"])
            for y in sweep.figure["y"]
            for words, group in _groups(sweep, rows, "by")
        ]
    if kind == "map":
        return [
            line
            for words, group in _maps(sweep, rows)
            for line in level_set_words(sweep.figure, words, group)
        ]
    return [
        f"{panel}: ".removeprefix(": ")
        + f"relative L2 difference of {y.replace('_', ' ')}, {a} and {b}: {100 * value:.1f} %"
        + (f" (mesh and step change {100 * bar:.1f} %)" if sweep.refine else "")
        for panel, y, a, b, value, bar in distances(sweep, rows, out)
    ]


def label(name: str, per: str = "/m") -> str:
    """Returns the words and the unit of a parameter or a number of the summary, for an axis. `per`
    is "/m" in plane strain, "" for a ball.
    """
    unit = _quantity(name, per).unit or study.unit_of(name)
    return _words(name) if unit in ("-", "", "of the start") else f"{_words(name)} [{unit}]"


def _words(name: str) -> str:
    return WORDS.get(name, name.replace("_", " "))


def _quantity(name: str, per: str = "/m") -> report.Quantity:
    """Returns the row of the report for a number, also for one of several bodies. A name that the
    report does not have becomes a row without a unit.
    """
    key = re.sub("_[0-9]+$", "", name)
    return next(
        (quantity for quantity in report.rows(per) if quantity.key == key),
        report.Quantity(key, key),
    )


def _unit(name: str, per: str) -> str:
    """Returns the unit of a number of the summary, with a space in front."""
    return f" {_quantity(name, per).unit}".rstrip()


def _value(name: str, value: Any) -> str:
    """Returns a value of a parameter in words, with its unit."""
    if value == "auto":
        return f"{_words(name)} auto"
    if isinstance(value, str):
        return LAWS.get(value, value)
    unit = study.unit_of(name)
    return f"{_words(name)} = {value:g}" + f" {unit}" * (unit != "-")


def _groups(sweep: Sweep, rows: pd.DataFrame, key: str) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yields (words, rows) for each value of the parameter that [figure] names as `key`, or all
    rows at once if there is no such key.
    """
    name = sweep.figure.get(key)
    if name is None:
        yield "", rows
        return
    for value, group in rows.groupby(name, sort=False):
        yield _value(name, value), group


# ---- lines


def draw_lines(sweep: Sweep, rows: pd.DataFrame, out: Path) -> Figure:
    x, names = sweep.figure["x"], sweep.figure["y"]
    figure, grid = plt.subplots(
        len(names),
        figsize=(6.4, 3.9 if len(names) == 1 else 2.6 * len(names)),
        sharex=True,
        squeeze=False,
    )
    for axes, y in zip(grid[:, 0], names):
        for k, ((words, group), colour, marker) in enumerate(
            zip(_groups(sweep, rows, "by"), itertools.cycle(COLOURS), itertools.cycle(MARKERS))
        ):
            group = group.sort_values(x)
            there = group.exit == 0
            errors = _quantity(y).factor * bars(group[there], y)
            axes.errorbar(
                group[x][there],
                _quantity(y).factor * group[y][there],
                None if np.isnan(errors).all() else errors,
                color=colour,
                marker=marker,
                markersize=3,
                linewidth=1.1,
                elinewidth=0.9,
                capsize=1.5,
                label=words or None,
            )
            if not there.all():
                why = (
                    "broke down (det F ≤ 0), no value"
                    if (group.exit[~there] == 12).all()
                    else "failed, no value"
                )
                axes.plot(
                    group[x][~there],
                    np.full((~there).sum(), -0.03 - 0.03 * k),
                    marker="x",
                    linestyle="",
                    markersize=4,
                    color=colour,
                    transform=axes.get_xaxis_transform(),
                    clip_on=False,
                    label=f"{words}: {why}".removeprefix(": "),
                )
                # The marks of failed runs are in a row below the axis, where no value can be.
                axes.tick_params(axis="x", pad=3.5 + 9 * (k + 1))
        _published(axes, sweep, x, y)
        axes.set_ylabel(label(y, sweep.figure["per"]))
        axes.grid(alpha=0.3)
        if (rows[y] > 0).all() and rows[y].max() > SPAN * rows[y].min():
            axes.set_yscale("log")
        if _is_logarithmic(rows[x]):
            axes.set_xscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_locator(NullLocator())
    grid[-1, 0].set_xlabel(label(x))
    # Curves come before other marks in the legend.
    handles = sorted(
        zip(*grid[0, 0].get_legend_handles_labels()),
        key=lambda handle: isinstance(handle[0], Line2D),
    )
    if handles:
        grid[0, 0].legend(*zip(*handles))
    return figure


def _published(axes: Axes, sweep: Sweep, x: str, y: str) -> None:
    """Draws the numbers of the paper for y: a star at their x, or a line over all x if the paper
    does not state x.

    Only numbers of scenes of the sweep, law included, are drawn. The contact time of the paper, in
    which the force is not zero, is drawn for both contact times.
    """
    name, (factor, unit) = (
        y.removeprefix("thresholded_"),
        (_quantity(y).factor, _unit(y, sweep.figure["per"])),
    )
    scenes = (sweep.sample.override(point).content for point in sweep.points)
    for at, value, words in dict.fromkeys(
        number
        for scene in scenes
        for number in numbers_of_the_paper(scene, name, over=x.rpartition(".")[2])
    ):
        style: Table = dict(color=BLACK, label=f"{words}: {factor * value:.3g}{unit}")
        if at is None:
            axes.axhline(factor * value, linestyle="-.", linewidth=0.9, **style)
        else:
            axes.plot(
                at, factor * value, marker="*", linestyle="", markersize=8, zorder=10, **style
            )


def _is_logarithmic(values: pd.Series) -> bool:
    """Whether there are five values or more that span a decade, and whose logarithms are more
    evenly spaced than the values.
    """
    if (
        not pd.api.types.is_numeric_dtype(values)
        or (values <= 0).any()
        or values.nunique() < 5
        or values.max() < 10 * values.min()
    ):
        return False
    ordered = np.sort(values.unique())
    steps, ratios = np.diff(ordered), np.diff(np.log(ordered))
    return bool(ratios.std() / ratios.mean() < steps.std() / steps.mean())


@dataclass(frozen=True)
class Trend:
    """How y changes with x.

    `course` is its shape (course()); `first`, `last` are the values at the ends; `low`, `high` are
    x and y of the extreme values; `typical` is the typical error of a point (nan without error
    bars).

    The other fields are about steps between neighbouring points: the number of `steps`, how many go
    `against` the direction from the first to the last value, how many of those by more than one
    (`beyond`) and two (`established`) error bars of the step, the `largest` of them, the typical
    error `bar` of a step, and the typical `step`.
    """

    course: str
    first: float
    last: float
    low: tuple[float, float]
    high: tuple[float, float]
    typical: float
    steps: int
    against: int
    beyond: int
    established: int
    largest: float
    bar: float
    step: float

    @property
    def falls(self) -> bool:
        return self.course == FALLS

    @property
    def ends_lower(self) -> bool:
        """Whether the last value is below the first by more than two error bars, whatever is
        between.
        """
        return bool(self.first - self.last > 2 * np.nan_to_num(self.bar))


def bars(group: pd.DataFrame, y: str) -> np.ndarray:
    """Returns the error bars of the points of a curve (n,), nan without them.

    Each is the larger of the point's own error and the root mean square of all, because one
    difference of two runs can be small by chance.
    """
    if f"{y}_error" not in group:
        return np.full(len(group), np.nan)
    own: np.ndarray = group[f"{y}_error"].to_numpy(dtype=float, copy=True)
    finite = own[np.isfinite(own)]
    if len(finite):
        np.fmax(own, np.sqrt(np.mean(finite**2)), out=own)
    return own


def bars_of_all(sweep: Sweep, rows: pd.DataFrame, y: str) -> pd.Series:
    """Returns the error bars (bars()) of every row of the table, each in its own curve or map of
    the figure; nan where a run failed. Without a figure all points are one curve.
    """
    all_bars = pd.Series(np.nan, rows.index)
    for _, panel in _groups(sweep, rows, "panel"):
        for _, group in _groups(sweep, panel, "by"):
            there = group[group.exit == 0]
            all_bars[there.index] = bars(there, y)
    return all_bars


FALLS, RISES, LEVEL = "falls", "rises", "does not change beyond its error bars"
MINIMUM, MAXIMUM, UNEVEN = "has a minimum", "has a maximum", "goes up and down"


def course(values: np.ndarray, errors: np.ndarray) -> str:
    """Returns the shape of a curve from its first to its last point. A value counts as above
    another one if it is above by more than twice the root of the sum of squares of their error
    bars; nan counts as 0.

    - The curve does not change if its largest value is not above its smallest.
    - It falls if no value is above the first or below the last, and the first is above the last,
      whatever rises are between. It rises likewise.
    - It has a minimum if both ends are above the smallest value and nothing is above both ends. A
      maximum likewise.
    - Else it goes up and down.
    """
    errors, ends = np.nan_to_num(errors), (0, len(values) - 1)
    low, high = int(np.argmin(values)), int(np.argmax(values))

    def above(i: int, j: int) -> bool:
        return bool(values[i] - values[j] > 2 * np.hypot(errors[i], errors[j]))

    first_low, last_low = (not above(end, low) for end in ends)
    first_high, last_high = (not above(high, end) for end in ends)
    if not above(high, low):
        return LEVEL
    if first_high and last_low and above(*ends):
        return FALLS
    if first_low and last_high and above(*ends[::-1]):
        return RISES
    if not (first_low or last_low) and (first_high or last_high):
        return MINIMUM
    return MAXIMUM if not (first_high or last_high) and (first_low or last_low) else UNEVEN


def steps_against(group: pd.DataFrame, x: str, y: str) -> Trend | None:
    """Returns the trend of the finished points of `group`, in SI units; None for fewer than three
    points. The error bar of a step is the root of the sum of squares of those of its ends.
    """
    there = group[(group.exit == 0) & group[y].notna()].sort_values(x)
    if len(there) < 3:
        return None
    values, errors = there[y].to_numpy(), bars(there, y)
    steps = np.hypot(errors[1:], errors[:-1])
    against = np.diff(values) * (1 if values[-1] < values[0] else -1)
    low, high = ((there[x].iloc[k], values[k]) for k in (np.argmin(values), np.argmax(values)))
    return Trend(
        course(values, errors),
        values[0],
        values[-1],
        low,
        high,
        float(np.min(errors)),
        len(against),
        int((against > 0).sum()),
        int((against > steps).sum()),
        int((against > 2 * steps).sum()),
        float(against.max()),
        float(np.median(steps)),
        float(np.median(np.abs(against))),
    )


def trend(group: pd.DataFrame, x: str, y: str, words: str, per: str = "/m") -> str:
    """Returns the trend (steps_against()) in words."""
    name = f"{words}: " * bool(words) + f"{y.replace('_', ' ')} over {x.replace('_', ' ')}"
    curve, factor, unit = steps_against(group, x, y), _quantity(y).factor, _unit(y, per)
    if not curve:
        return f"{name}: too few points for a trend"
    size = abs(group[group.exit == 0][y]).mean()
    text = (
        f"{name}: {curve.course}{_extremes(curve, x, factor)} "
        f"from {factor * curve.first:.5g} to {factor * curve.last:.5g}{unit}"
    )
    if curve.course in (FALLS, RISES):
        text += f"; of {curve.steps} steps {curve.against} {'rise' if curve.falls else 'fall'}"
    if np.isnan(curve.typical):
        return text + " (no error bars: no estimate or [refine], or no finished run)"
    if curve.course in (FALLS, RISES):
        text += f", {curve.beyond} of them by more than their error bar, {curve.established} by more than twice that"
        if curve.largest > 0:
            text += f"; the largest by {factor * curve.largest:.2g}{unit} ({100 * curve.largest / size:.2f} %)"
    return (
        text
        + f"; error of a point {factor * curve.typical:.2g}{unit} ({100 * curve.typical / size:.2f} %, rms)"
    )


def _extremes(curve: Trend, x: str, factor: float) -> str:
    """Returns the extreme values of a curve that neither falls nor rises throughout, with their x,
    in words.
    """
    low, high = (
        f"{factor * value:.5g} at {_value(x, at)}" for at, value in (curve.low, curve.high)
    )
    return {MINIMUM: f", {low},", MAXIMUM: f", {high},", UNEVEN: f" between {low} and {high},"}.get(
        curve.course, ""
    )


# ---- maps


def _maps(sweep: Sweep, rows: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yields (words, rows) of each map, row by row."""
    for panel, part in _groups(sweep, rows, "panel"):
        for words, group in _groups(sweep, part, "by"):
            yield ", ".join(filter(None, (panel, words))), group


def _map(sweep: Sweep, rows: pd.DataFrame, out: Path) -> Figure:
    entries = sweep.figure
    x, y, colour = (entries[key] for key in ("x", "y", "colour"))
    maps, height = list(_maps(sweep, rows)), len(list(_groups(sweep, rows, "panel")))
    # The width of a map follows from the number of its values of x.
    widths = [max(2.5, group[x].nunique()) for _, group in maps[: len(maps) // height]]
    figure, grid = plt.subplots(
        height,
        len(widths),
        figsize=(1.2 + 3.4 * sum(widths) / max(widths), 0.8 + 2.8 * height),
        sharex="col",
        sharey=True,
        squeeze=False,
        width_ratios=widths,
        layout="constrained",
    )
    values = _quantity(colour).factor * rows[colour]
    low, high = values.min(), values.max()
    for axes, (words, group) in zip(grid.flat, maps):
        table = group.pivot(index=y, columns=x, values=colour) * _quantity(colour).factor
        # The cells of the picture are evenly spaced, whatever the values of x and y.
        cells = np.where(group.pivot(index=y, columns=x, values="exit") == 0, table, np.nan)
        picture = axes.imshow(
            cells, origin="lower", aspect="auto", cmap="viridis", vmin=low, vmax=high
        )
        for (row, column), value in np.ndenumerate(cells):
            share = (value - low) / (high - low or 1.0)
            axes.text(
                column,
                row,
                "failed" if np.isnan(value) else f"{value:#.3g}",
                ha="center",
                va="center",
                fontsize=SMALL,
                color="black" if np.isnan(value) or share > 0.5 else "white",
                zorder=5,  # in front of the lines of the level
                bbox=dict(
                    facecolor="white" if np.isnan(value) else plt.get_cmap("viridis")(share),
                    edgecolor="none",
                    pad=1.2,
                ),
            )
        if entries["level"] is not None:
            level, band = (_quantity(colour).factor * entries[key] for key in ("level", "band"))
            alone = cells.shape[1] == 1  # then the lines of the level cross the whole column
            across = [-0.5, 0.5] if alone else np.arange(cells.shape[1])
            drawn = across, np.arange(len(cells)), cells.repeat(2, axis=1) if alone else cells
            axes.contour(*drawn, levels=[level], colors=[ORANGE], linewidths=2)
            if band:
                axes.contour(
                    *drawn,
                    levels=[level - band, level + band],
                    colors=[ORANGE],
                    linewidths=1,
                    linestyles="--",
                )
        axes.set_xticks(
            range(len(table.columns)), [f"{value:g}" for value in table.columns], fontsize=SMALL
        )
        axes.set_yticks(range(len(table.index)), [_tick(value) for value in table.index])
        axes.set_title(words)
        axes.spines[:].set_visible(False)
    plt.setp(grid[-1], xlabel=label(x))
    plt.setp(grid[:, 0], ylabel=label(y))
    figure.colorbar(picture, ax=grid, label=label(colour, entries["per"]))
    return figure


def _tick(value: float) -> str:
    """Returns a number beside an axis as text, large and small ones as powers of ten."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.2g}"
    factor, _, power = f"{value:.1e}".partition("e")
    return f"$10^{{{int(power)}}}$" if factor == "1.0" else f"${factor}\\cdot 10^{{{int(power)}}}$"


def level_set(figure: Table, group: pd.DataFrame) -> dict[float, list[tuple[float, float]]]:
    """Returns for each value of x the ranges of y in which colour has its level, within the sum of
    band and error bar. Between points colour is interpolated linearly in the logarithm of y.
    """
    x, y, colour = (figure[key] for key in ("x", "y", "colour"))
    levels, band = {}, figure["band"] + _typical(group, colour)
    for value, column in group[group.exit == 0].groupby(x):
        column = column.sort_values(y)
        fine = np.geomspace(column[y].iloc[0], column[y].iloc[-1], 2001)
        levels[value] = ranges(
            fine,
            np.abs(np.interp(np.log(fine), np.log(column[y]), column[colour]) - figure["level"])
            <= band,
        )
    return levels


def ranges(values: np.ndarray, holds: np.ndarray) -> list[tuple[float, float]]:
    """Returns the first and last values of each range of `values` in which `holds` is true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(int), [0]]))).reshape(-1, 2)
    return [(float(values[first]), float(values[last - 1])) for first, last in edges]


def _typical(group: pd.DataFrame, name: str) -> float:
    """Returns the typical error bar of a column, 0 without error bars."""
    errors = bars(group[group.exit == 0], name)
    return float(np.nanmin(errors)) if np.isfinite(errors).any() else 0.0


def level_set_words(figure: Table, words: str, group: pd.DataFrame) -> list[str]:
    """Returns the level set in words, a line for each value of x."""
    if figure["level"] is None:
        return []
    x, y, colour = (figure[key] for key in ("x", "y", "colour"))
    unit, factor = _unit(colour, figure.get("per", "/m")), _quantity(colour).factor
    lines = [
        f"{words}: "
        * bool(words)
        + f"{colour.replace('_', ' ')} = {factor * figure['level']:g} ± {factor * figure['band']:g}{unit} "
        f"is met, within an error bar of {factor * _typical(group, colour):.2g}{unit}, for"
    ]
    for value, met in level_set(figure, group).items():
        lines.append(
            f"  {_value(x, value)}: " + (f"{label(y)} " + spans(met) if met else f"no {label(y)}")
        )
    return lines


def spans(ranges: list[tuple[float, float]]) -> str:
    """Returns ranges of numbers in words."""
    return ", ".join(f"{first:.2g} to {last:.2g}" for first, last in ranges)


# ---- histories


def _histories(sweep: Sweep, rows: pd.DataFrame, out: Path) -> Figure:
    panels, names = list(_groups(sweep, rows, "panel")), sweep.figure["y"]
    figure, grid = plt.subplots(
        len(names),
        len(panels),
        figsize=(1 + 3.4 * len(panels), 0.6 + 2.8 * len(names)),
        squeeze=False,
    )
    for k, (title, part) in enumerate(panels):
        for axes, y in zip(grid[:, k], names):
            for (words, group), colour, line in zip(
                _groups(sweep, part, "by"), itertools.cycle(COLOURS), itertools.cycle(("-", "--"))
            ):
                for _, row in group[group.exit == 0].iterrows():
                    t, values = _history(sweep, row, out, y, refined=bool(sweep.refine))
                    axes.plot(
                        1e3 * t,
                        1e-3 * values if "force" in y else values,
                        color=colour,
                        linestyle=line,
                        label=words,
                    )
            axes.set(xlabel="time [ms]", title=title)
            axes.margins(x=0)
            axes.grid(alpha=0.3)
            if k == 0:
                axes.set_ylabel(
                    f"{y.replace('_', ' ')}" + f" [kN{sweep.figure['per']}]" * ("force" in y)
                )
    legend(grid[0, 0])
    return figure


def _history(
    sweep: Sweep, row: pd.Series, out: Path, y: str, refined: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (t, values) of the run of a point. Forces are means over a step, so their t is the
    middle of the step.
    """
    point = row[sweep.axes].to_dict() | (sweep.refine if refined else {})
    history = read_history(study.place(out, point))
    if y not in history:
        raise BadInput(f"figure: y = '{y}' (accepted: {', '.join(history)})")
    return force(history, y) if y.endswith("_force") else (history["t"], history[y])


def force(
    history: dict[str, np.ndarray], name: str = "normal_force"
) -> tuple[np.ndarray, np.ndarray]:
    """Returns (t, force). The force is the mean over a step, t the middle of the step."""
    return history["t"] - history["dt"] / 2, history[name]


def distances(
    sweep: Sweep, rows: pd.DataFrame, out: Path
) -> Iterator[tuple[str, str, str, str, float, float]]:
    """Yields (panel, y, a, b, distance, error) for each line b of a panel and its first line a. The
    distance is ||y_b - y_a|| / ||y_a|| over time. The error is the larger such distance between a
    run of a or b and its refined run, nan without [refine].
    """
    refined = bool(sweep.refine)
    for panel, part in _groups(sweep, rows, "panel"):
        runs = [
            (words, row)
            for words, group in _groups(sweep, part, "by")
            for _, row in group[group.exit == 0].iterrows()
        ]
        for y, (b, row) in itertools.product(sweep.figure["y"], runs[1:]):
            a, first = runs[0]
            bars = [
                distance(
                    _history(sweep, point, out, y, True), _history(sweep, point, out, y, False)
                )
                for point in (first, row)
                if refined
            ]
            yield (
                panel,
                y,
                a,
                b,
                distance(*(_history(sweep, point, out, y, refined) for point in (first, row))),
                max(bars, default=np.nan),
            )


def distance(first: tuple[np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray]) -> float:
    """Returns ||second - first|| / ||first|| in L2 over time. Both are zero outside their times.
    The result is nan if the first is zero.
    """
    t = np.union1d(first[0], second[0])
    if not first[1].any():
        return np.nan
    a, b = (np.interp(t, *history, left=0, right=0) for history in (first, second))
    return float(np.sqrt(np.trapezoid((b - a) ** 2, t) / np.trapezoid(a**2, t)))
