"""The impacts of a run, a row each (contacts.csv), and restitution over several of them."""

from pathlib import Path

import numpy as np

from ..output.results import read_table
from .figures import BLUE, GREEN, GREY, ORANGE, plt

LIGHTEST = 0.01                  # of the largest impulse of a meeting: what is less is the grazing end of an impact
# of the approach, and of the largest slip of a meeting: of less the restitution along the partner is that of vibrations
LEAST_SLIP = 0.05
LEAST_APPROACH = 0.01            # of the largest of a meeting: of less, as of a body that lies on its partner, there is no restitution
HIGHEST = 1.5                    # restitution that is drawn to scale: above it a body that vibrates was pushed off as it hardly approached
COLOURS = [BLUE, ORANGE, GREEN, "#cc79a7", "#e69f00", "#56b4e9"]
TOLD = 5                         # restitutions written beside the first impacts
NEEDED = ["body", "partner", "start", "end", "impulse", "approach", "separation", "restitution", "restitution_tangential"]


def read(folder: Path) -> np.recarray:
    """contacts.csv of the run in `folder`: a row for every interval of contact of two bodies, or of a body with an obstacle (partner < 0).

    Columns and units: edp/core/run/columns.idp. Unreadable where it is not such a table.
    """
    return read_table(folder / "contacts.csv", NEEDED)


def several(table: np.recarray) -> list[np.recarray]:
    """The impacts of each meeting, where there are more than one of all; intervals with less than LIGHTEST of the largest impulse of their
    meeting are none."""
    meetings = [table[(table.body == body) & (table.partner == partner)]
                for body, partner in np.unique(np.stack([table.body, table.partner], axis=1), axis=0)]
    impacts = [rows[rows.impulse >= LIGHTEST * rows.impulse.max()] for rows in meetings]
    return impacts if sum(map(len, impacts)) > 1 else []


def draw(table: np.recarray, names: list[str], rigid: list[str]) -> plt.Figure | None:
    """Restitution, across and along the partner, over the impacts of each meeting, and below them the speeds before each; None where there
    are not several. `names`: of the bodies; `rigid`: of the obstacles."""
    impacts = several(table)
    if not impacts:
        return None
    figure, (top, below) = plt.subplots(2, 1, figsize=(6.4, 5), sharex=True)
    for colour, rows in zip(COLOURS, impacts):
        body, partner, t = int(rows.body[0]), int(rows.partner[0]), 1e3 * rows.start
        label = f"{names[body - 1]} – {names[partner - 1] if partner > 0 else rigid[-partner - 1]}"
        across = np.where(rows.approach > LEAST_APPROACH * np.fmax.reduce(rows.approach), rows.restitution, np.nan)
        pushed = across > HIGHEST
        top.plot(t, np.where(pushed, np.nan, across), "o-", color=colour, markersize=4, linewidth=0.8, label=f"{label}: across")
        if pushed.any():
            top.plot(t[pushed], np.full(pushed.sum(), HIGHEST), "^", color=colour, markersize=5,
                     label=f"{label}: across, above {HIGHEST:g}")
        slips = rows.slip_before > LEAST_SLIP * np.maximum(rows.approach, np.fmax.reduce(rows.slip_before))
        along = np.where(slips, rows.restitution_tangential, np.nan)
        if np.isfinite(along).any():
            top.plot(t, along, "s--", color=colour, markersize=4, linewidth=0.8, fillstyle="none", label=f"{label}: along")
        below.plot(t, rows.approach, "o-", color=colour, markersize=4, linewidth=0.8)
        if np.isfinite(along).any():
            below.plot(t, rows.slip_before, "s--", color=colour, markersize=4, linewidth=0.8, fillstyle="none")
    top.set(ylabel="restitution", ylim=(min(0.0, top.get_ylim()[0]), max(1.05, top.get_ylim()[1])))
    top.axhline(1, color=GREY, linewidth=0.6)
    top.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))
    below.set(xlabel="start of the contact [ms]", ylabel="speed before [m/s]", ylim=(0, 1.1 * below.get_ylim()[1]))
    return figure


def heights(history: dict[str, np.ndarray], table: np.recarray, names: list[str]) -> plt.Figure:
    """The height of each body's centre above its last one [mm] over time [s], with the instants of its impacts and the first restitutions:
    of a run until rest. Between two rows its acceleration is constant: of a flight two are enough."""
    figure, axes = plt.subplots(figsize=(6.4, 3.4))
    t = history["t"]
    dense = np.linspace(t[0], t[-1], 2000)

    def above(when: np.ndarray, of: str) -> np.ndarray:
        y, v, row = history[f"y{of}"], history[f"vy{of}"], np.clip(np.searchsorted(t, when, side="right") - 1, 0, len(t) - 2)
        past, step = when - t[row], np.maximum(t[row + 1] - t[row], 1e-300)
        return 1e3 * (y[row] + v[row] * past + (v[row + 1] - v[row]) * past**2 / (2 * step) - y[-1])

    for colour, (body, name) in zip(COLOURS, enumerate(names, 1)):
        of = f"_{body}" if len(names) > 1 else ""
        axes.plot(dense, above(dense, of), color=colour, label=f"{name}: at rest y = {history[f'y{of}'][-1]:.4g} m")
        impacts = table[(table.body == body) & np.isfinite(table.restitution)]
        axes.plot(impacts.start, above(impacts.start, of), "o", color=colour, markersize=3)
        for one in impacts[:TOLD]:
            axes.annotate(f"{one.restitution:.2f}", (one.start, above(one.start, of)), (0, -4), textcoords="offset points", ha="center",
                          va="top", fontsize=7.5)
    axes.set(xlabel="time [s]", ylabel="centre above its place at rest [mm]", xlim=(t[0], t[-1]))
    axes.margins(y=0.12)
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1), title="dots: impacts, with their restitutions", title_fontsize=7.5)
    return figure
