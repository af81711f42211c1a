"""The impacts of a run (contacts.csv, one row for each impact), the restitution over several
impacts, and the vibration after them: the energy in each natural mode (modes.csv) and the spectrum
of the force.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from ..output.results import Contents, read_table
from .figures import BLUE, GREEN, GREY, ORANGE, legend

__all__ = [
    "HIGHEST",
    "draw",
    "heights",
    "read",
    "read_modes",
    "several",
    "spectrum",
    "vibration",
    "with_flights",
]

# Smallest impulse of an impact, relative to the largest impulse of the contact pair. An interval of
# contact with a smaller impulse is the grazing end of an impact.
LIGHTEST = 0.01
# Smallest slip velocity before an impact, relative to the approach velocity and to the largest slip
# velocity of the contact pair. Below it the tangential restitution is due to vibrations.
LEAST_SLIP = 0.05
# Smallest approach velocity, relative to the largest one of the contact pair. Below it, as for a
# body that rests on the other surface, no restitution is drawn.
LEAST_APPROACH = 0.01
# Largest restitution that is drawn to scale. A larger value means that a vibrating body with a
# small approach velocity was pushed off.
HIGHEST = 1.5
COLOURS = [BLUE, ORANGE, GREEN, "#cc79a7", "#e69f00", "#56b4e9"]
TOLD = 3  # number of first impacts that are labelled with their restitution
INSIDE = 40  # number of rows that are inserted into a flight
MODES = ["mode", "frequency", "energy", "strain_energy", "kinetic_energy"]
NEEDED = [
    "body",
    "partner",
    "start",
    "end",
    "impulse",
    "approach",
    "separation",
    "restitution",
    "restitution_tangential",
]


def read(folder: Path) -> np.recarray:
    """Reads contacts.csv of the run in `folder`: one row for every interval of contact of two
    bodies, or of a body with an obstacle (`partner` < 0).

    output/columns.py describes the columns and their units. Raises Unreadable if the file is not
    such a table.
    """
    return read_table(folder / "contacts.csv", NEEDED)


def several(table: np.recarray) -> list[np.recarray]:
    """Returns the impacts of each contact pair, or an empty list if no pair has more than one
    impact. Intervals without a restitution, as of a body that rolls, and those with an impulse
    below LIGHTEST times the largest impulse of the pair do not count.
    """
    onsets_of = [
        table[(table.body == body) & (table.partner == partner)]
        for body, partner in np.unique(np.stack([table.body, table.partner], axis=1), axis=0)
    ]
    impacts = [
        rows[(rows.impulse >= LIGHTEST * rows.impulse.max()) & np.isfinite(rows.restitution)]
        for rows in onsets_of
    ]
    return impacts if any(len(rows) > 1 for rows in impacts) else []


def draw(table: np.recarray, names: list[str], rigid: list[str]) -> Figure | None:
    """Draws normal and tangential restitution over the impacts of each contact pair, and below them
    the speeds before each impact. Returns None if there are not several impacts. `names` are those
    of the bodies, `rigid` those of the obstacles.
    """
    impacts = [rows for rows in several(table) if len(rows)]
    if not impacts:
        return None
    figure, (top, below) = plt.subplots(2, 1, figsize=(6.4, 5), sharex=True)
    for colour, rows in zip(COLOURS, impacts):
        body, partner, t = int(rows.body[0]), int(rows.partner[0]), 1e3 * rows.start
        label = f"{names[body - 1]} – {names[partner - 1] if partner > 0 else rigid[-partner - 1]}"
        across = np.where(
            rows.approach > LEAST_APPROACH * np.fmax.reduce(rows.approach), rows.restitution, np.nan
        )
        pushed = across > HIGHEST
        top.plot(
            t,
            np.where(pushed, np.nan, across),
            "o-",
            color=colour,
            markersize=4,
            linewidth=0.8,
            label=f"{label}: normal" if np.isfinite(across).any() else None,
        )
        if pushed.any():
            top.plot(
                t[pushed],
                np.full(pushed.sum(), HIGHEST),
                "^",
                color=colour,
                markersize=5,
                label=f"{label}: normal, above {HIGHEST:g}",
            )
        slips = rows.slip_before > LEAST_SLIP * np.maximum(
            rows.approach, np.fmax.reduce(rows.slip_before)
        )
        along = np.where(slips, rows.restitution_tangential, np.nan)
        below.plot(t, rows.approach, "o-", color=colour, markersize=4, linewidth=0.8)
        if np.isfinite(along).any():
            top.plot(
                t,
                along,
                "s--",
                color=colour,
                markersize=4,
                linewidth=0.8,
                fillstyle="none",
                label=f"{label}: tangential",
            )
            below.plot(
                t,
                rows.slip_before,
                "s--",
                color=colour,
                markersize=4,
                linewidth=0.8,
                fillstyle="none",
            )
    top.set(ylabel="restitution", ylim=(min(0.0, top.get_ylim()[0]), max(1.05, top.get_ylim()[1])))
    top.axhline(1, color=GREY, linewidth=0.6)
    legend(top, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))
    low, high = below.get_ylim()
    below.set(
        xlabel="start of the contact [ms]",
        ylabel="speed before [m/s]",
        ylim=(min(0.0, low), 1.1 * high),
    )
    return figure


def with_flights(history: Contents[np.ndarray]) -> Contents[np.ndarray]:
    """Returns the history with INSIDE + 1 additional rows in each flight, for which a run has one
    row only.

    Let s in [0, 1] be the fraction of a flight of duration T, in which a velocity changes by dv = g
    T. All columns are linear in s with two exceptions: positions are reduced by s (1 - s) dv T/2,
    and kinetic energy and work of gravity by s (1 - s) m dv^2/2. Forces and the size of the contact
    vanish from the very beginning of the flight on.
    """
    t = history["t"]
    flies = (history["newton_iterations"][1:] == 0) & (history["normal_force"][1:] == 0)
    shares = np.append(np.linspace(0, 1, INSIDE + 2)[1:-1], 1e-6)
    inside = (t[:-1][flies] + np.outer(shares, np.diff(t)[flies])).ravel()
    times = np.sort(np.concatenate([t, inside]))
    step = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    share = (times - t[step]) / np.diff(t)[step]
    bend = np.where(flies[step], share * (1 - share) / 2, 0)
    filled = {name: np.interp(times, t, column) for name, column in history.items()}
    filled["dt"][1:] = np.diff(times)
    for name in filled:
        if "force" in name or name.startswith("contact_"):
            filled[name][flies[step] & (share > 0)] = 0
    for suffix in (
        "",
        *(name.removeprefix("kinetic") for name in history if name.startswith("kinetic_")),
    ):
        gained = np.zeros(len(t) - 1)
        for axis in (axis for axis in "xyz" if axis + suffix in history):
            change = np.diff(history[f"v{axis}{suffix}"])
            filled[axis + suffix] -= bend * (change * np.diff(t))[step]
            gained += change * np.diff(history[f"momentum_{axis}{suffix}"])
        for name in ("kinetic", "external_work") if suffix == "" else (f"kinetic{suffix}",):
            filled[name] -= bend * gained[step]
    return Contents(filled, history.path)


def heights(history: dict[str, np.ndarray], table: np.recarray, names: list[str]) -> Figure:
    """Draws the height of each body's centre above its final position [mm] over time [s], with the
    instants of the impacts and the first restitutions. It is meant for a run until rest, with the
    history of with_flights().
    """
    figure, axes = plt.subplots(figsize=(6.4, 3.4))
    t = history["t"]
    for colour, (body, name) in zip(COLOURS, enumerate(names, 1)):
        y = history["y" if len(names) == 1 else f"y_{body}"]
        above = 1e3 * (y - y[-1])
        axes.plot(t, above, color=colour, label=f"{name}: at rest y = {y[-1]:.4g} m")
        impacts = table[(table.body == body) & np.isfinite(table.restitution)]
        axes.plot(
            impacts.start, np.interp(impacts.start, t, above), "o", color=colour, markersize=3
        )
        for impact in impacts[:TOLD]:
            axes.annotate(
                f"{impact.restitution:.2f}",
                (impact.start, np.interp(impact.start, t, above)),
                (0, -4),
                textcoords="offset points",
                ha="center",
                va="top",
                fontsize=7.5,
            )
    axes.set(xlabel="time [s]", ylabel="centre above its place at rest [mm]", xlim=(t[0], t[-1]))
    axes.margins(y=0.12)
    legend(
        axes,
        ncols=2,
        loc="lower center",
        bbox_to_anchor=(0.5, 1),
        title="dots: impacts, with their restitutions",
        title_fontsize=7.5,
    )
    return figure


# ---- vibration


def read_modes(folder: Path) -> np.recarray:
    """Reads modes.csv of the run in `folder`: mode (from 1), frequency [Hz], energy of the last
    state in the mode and its two parts, strain and kinetic energy [J; in a plane problem J/m].

    Raises Unreadable if the file is not such a table.
    """
    return read_table(folder / "modes.csv", MODES)


def spectrum(
    t: np.ndarray, dt: np.ndarray, force: np.ndarray, frequencies: np.ndarray
) -> np.ndarray:
    """Returns |integral of F exp(-i 2 pi f t) dt| [N s] at `frequencies` [Hz] for a force that is
    constant in each step; t is the end of a step.
    """
    turns = np.exp(-2j * np.pi * np.outer(frequencies, t - dt / 2)) * np.sinc(
        np.outer(frequencies, dt)
    )
    amplitudes: np.ndarray = np.abs(turns @ (force * dt))
    return amplitudes


def vibration(table: np.recarray, history: dict[str, np.ndarray], per: str) -> Figure | None:
    """Draws the energy of each mode over its frequency and, above, the spectrum of the force up to
    the last mode. Returns None without modes or energies. `per` is "/m" in plane strain.
    """
    if np.isnan(table.energy).all():
        return None
    largest = np.nanmax(table.energy)
    figure, (top, below) = plt.subplots(2, 1, figsize=(6.4, 5), sharex=True)
    frequencies = np.linspace(0, 1.05 * table.frequency.max(), 600)
    top.plot(
        1e-3 * frequencies,
        spectrum(history["t"], history["dt"], history["normal_force"], frequencies),
        color=BLUE,
        linewidth=1,
    )
    top.set(ylabel=f"spectrum of the force [N s{per}]", yscale="log")
    for name, colour, style in (
        ("kinetic_energy", "#e69f00", "s"),
        ("strain_energy", GREEN, "^"),
        ("energy", "black", "o"),
    ):
        shown = table[table[name] > 1e-6 * largest]
        below.plot(
            1e-3 * shown.frequency,
            shown[name],
            style,
            color=colour,
            markersize=3.5,
            label=name.replace("_", " "),
        )
    below.vlines(
        1e-3 * table.frequency,
        1e-6 * largest,
        table.energy,
        color="#bbbbbb",
        linewidth=0.6,
        zorder=0,
    )
    below.set(ylabel=f"energy of a mode [J{per}]", xlabel="frequency [kHz]", yscale="log")
    legend(below)
    return figure
