"""The figure of a fit: profiles of the free entries, what was measured beside the predictions, curves."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from .figures import BLUE, GREY, ORANGE, styled

if TYPE_CHECKING:
    from ..fitting.fitted import Fit

__all__ = ["draw"]

COVERED = 3.84  # rise of chi2 at the ends of an interval of 95 %
HIGHEST = 10.0  # drawn rise
DECADE = 20.0  # ratio of the ends of an axis from which on it is logarithmic
CURVES = 3  # drawn at most
POINTS = 60  # measured values drawn singly


def draw(fit: Fit) -> Figure:
    """Draws the rise of chi2 over each entry, how far each measured value is from its prediction, in
    standard errors, and the first curves as measured and predicted.
    """
    with styled():
        count, curves = len(fit.table), dict(itertools.islice(fit.curves.items(), CURVES))
        rows = 3 if curves else 2
        figure = plt.figure(figsize=(3.2 * max(count, 2), 2.8 * rows), layout="constrained")
        grid = figure.add_gridspec(rows, 1)
        blocks = [figure.add_subfigure(grid[row, 0]) for row in range(rows)]
        for ax, name in zip(np.ravel(blocks[0].subplots(1, count)), fit.table.index):
            _profile(ax, fit, str(name))
        _deviations(blocks[1].subplots(), fit)
        if curves:
            for ax, drawn in zip(np.ravel(blocks[2].subplots(1, len(curves))), curves.items()):
                _curve(ax, *drawn)
    return figure


def _curve(ax: Axes, name: str, curve: pd.DataFrame) -> None:
    ax.plot(curve["t"], curve["measured"], ".", color=GREY, label="measured")
    ax.plot(curve["t"], curve["predicted"], color=BLUE, label="predicted")
    ax.set(xlabel="time in s", ylabel="SI units", title=name)
    ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.legend(fontsize="small")


def _profile(ax: Axes, fit: Fit, name: str) -> None:
    profile, row = fit.profiles[name], fit.table.loc[name]
    ax.plot(profile["value"], profile["rise"], color=BLUE)
    ax.axhline(COVERED, color=GREY, linewidth=0.8)
    for end in ("low", "high"):
        if np.isfinite(row[end]):
            ax.axvline(row[end], color=ORANGE, linewidth=0.8)
    near = profile["rise"] < HIGHEST
    low, high = profile["value"][near].min(), profile["value"][near].max()
    if low > 0 and high / low > DECADE:
        ax.set_xscale("log")
    else:
        ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.set(
        ylim=(0, HIGHEST),
        xlim=(low, high),
        ylabel=r"rise of $\chi^2$" if name == fit.table.index[0] else "",
    )
    unit = "" if row["unit"] in ("-", "1") else f" in {row['unit']}"
    ax.set_xlabel(f"{name}{unit}")
    words = str(row["known"]).removeprefix("yes").removeprefix(", ")
    if words:
        beside = words if str(row["known"]).startswith("yes") else "not known by these data"
        ax.set_title(beside, fontsize="small")


def _deviations(ax: Axes, fit: Fit) -> None:
    table = fit.measurements
    numbers = list(dict.fromkeys(table["number"]))
    for name in numbers:
        own = table[table["number"] == name]
        ax.plot(
            own.index + 1, own["off"], "o", markersize=4 if len(table) > POINTS else 6, label=name
        )
    ax.axhspan(-2, 2, color=GREY, alpha=0.2, linewidth=0)
    ax.axhline(0, color=GREY, linewidth=0.8)
    ax.set(xlabel="measured value", ylabel="measured less predicted,\nin standard errors")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.legend(fontsize="small")
