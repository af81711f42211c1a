"""The contact of a run along the outlines of its bodies: pressure at several instants and over
time, and stick and slip if there is friction.

Every panel shows the projected pressure (`projected_pressure` of fields/contact.csv).
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator

from ..input.parameters import Table
from ..output.results import read_table
from .figures import BLACK, BLUE, ORANGE, SMALL, STICKS, evenly, legend

__all__ = [
    "PRESSURE",
    "SLIDES",
    "draw",
    "draw_profiles",
    "hertz",
    "radial",
    "read",
    "representatives",
]

# Largest speed, relative to sqrt(E/rho), at which the pressure of a ball is compared with Hertz.
SLOW = 0.03
MOST_BODIES = 4  # largest number of bodies shown: those with the largest pressure
# Load relative to the largest load at which profiles are drawn before and after the largest one.
HALF = 0.5
NUMBERS = 4  # largest number of intervals between the ticks of a horizontal axis
PRESSURE = "contact pressure [MPa]"
# v_T < 0 slides back, v_T > 0 slides forward. On the plane the direction of v_T is x.
SLIP = {"slides back": BLUE, "sticks": STICKS, "slides forward": ORANGE}
# The same for slip towards the axis and away from it.
RADIAL = {"slides inwards": BLUE, "sticks": STICKS, "slides outwards": ORANGE}
SLIDES = {"sticks": STICKS, "slides": ORANGE}
# Two contacts are separate if their distance exceeds this multiple of the median point distance.
FAR = 3
MAPS = 5  # largest number of instants with a map of the contact area
ALONG = "along the outline"
ABOVE: dict[str, Any] = {
    "loc": "lower center",
    "bbox_to_anchor": (0.5, 1),
    "ncols": 3,
    "fontsize": SMALL,
    "handlelength": 1.0,
    "handletextpad": 0.4,
    "columnspacing": 0.8,
}
COLUMNS = [
    "t",
    "body",
    "partner",
    "s",
    "X",
    "Y",
    "x",
    "y",
    "weight",
    "pressure",
    "shear",
    "slip_velocity",
    "slides",
    "projected_pressure",
]


def read(folder: Path) -> np.recarray:
    """Reads fields/contact.csv of the run in `folder`: one row for every contact point that bears
    load, at each instant of the snapshots.

    docs/reference/results.md describes the columns and their units; in three dimensions the unit of
    `weight` is m2. Raises Unreadable if the file is not such a table.
    """
    return read_table(folder / "fields/contact.csv", COLUMNS)


def draw(
    table: np.recarray,
    names: list[str],
    half: bool,
    free: np.ndarray,
    ball: Table | None = None,
    symmetry: str = "full",
    history: dict[str, np.ndarray] | None = None,
) -> Figure | None:
    """Draws a row of panels for each body: pressure over the outline at three instants; pressure
    over outline and time; with friction stick and slip; with a `history` also contact half-width
    and largest pressure. Returns None without contact. Of two bodies in contact one represents
    both (representatives()). `free`: times [s] without contact.

    Half a body is drawn with its mirror image. `ball` is the scene if the body is a ball that does
    not rotate; its panels use the distance from the axis. Other bodies in three dimensions: a
    single body is shown by the points nearest to the plane z = 0, several bodies by all points over
    the distance from the first contact point; maps of the contact area at some instants follow
    below. `symmetry` (quarter, half, full) states which part of a body in three dimensions was
    computed.
    """
    if not len(table):
        return None
    bodies = representatives(table)
    instants = np.union1d(table.t, free[(free > table.t.min()) & (free < table.t.max())])
    rubs, solid = bool(table.shear.any()), hasattr(table, "Z")
    shown = (
        ["profiles", "pressure"]
        + ["slip"] * rubs
        + ["history"] * (history is not None and "contact_half_width" in history)
    )
    maps = (1 + rubs) * (solid and not ball)
    figure = plt.figure(
        figsize=(max(2.8 * len(shown), 7.0 if maps else 0), (2.5 + 1.7 * maps) * len(bodies) + 0.6),
        layout="constrained" if maps else None,
    )
    heights = [2.5, 1.7 * maps] * len(bodies)
    parts = (
        figure.subfigures(len(heights), 1, squeeze=False, height_ratios=heights) if maps else None
    )
    rows = (
        figure.subplots(len(bodies), len(shown), squeeze=False)
        if parts is None
        else [part.subplots(1, len(shown)) for part in parts[::2, 0]]
    )
    for k, body in enumerate(bodies):
        points, panels = table[table.body == body], dict(zip(shown, rows[k]))
        own, words, states = (
            radial(points, ball) if ball or solid and len(names) > 1 else _section(points, half)
        )
        times = _times_of_profiles(points)
        line = "" if solid and words == ALONG else "-"
        draw_profiles(panels["profiles"], own, words, line, times)
        if ball:
            _beside_hertz(panels["profiles"], points, ball, times)
        picture = _over_time(
            panels["pressure"], own, instants, 1e-6 * own.pressure, cmap="viridis", vmin=0
        )
        figure.colorbar(
            picture, cax=panels["pressure"].inset_axes((1.04, 0, 0.06, 1)), label=PRESSURE
        )
        if rubs:
            _over_time(panels["slip"], own, instants, own.state, **_colours(states))
            panels["slip"].legend(*_keys(states), **ABOVE)
        for axes in [panels[name] for name in ("pressure", "slip") if name in panels]:
            axes.set(
                ylabel=f"{words} [mm]",
                xlabel="time [ms]",
                ylim=(0, None) if words != ALONG else (None, None),
            )
        if history and "history" in shown:
            suffix, width = (
                f"_{body}" if len(names) > 1 else "",
                "contact radius" if ball else "half-width",
            )
            _history(panels["history"], history, own, instants, suffix, width)
        lasts = np.array([own.t.min(), own.t.max()]) + np.array([-0.02, 0.02]) * np.ptp(own.t)
        for axes in [panels[name] for name in shown if name != "profiles" and lasts[0] < lasts[1]]:
            axes.set_xlim(1e3 * lasts)
        if len(names) > 1:
            partners = np.unique(points.partner).astype(int)
            on = f" on {names[partners[0] - 1]}" if len(partners) == 1 and partners[0] > 0 else ""
            panels["pressure"].set_title(names[body - 1] + on)
        for axes in panels.values():
            axes.xaxis.set_major_locator(MaxNLocator(NUMBERS, steps=(1, 2, 2.5, 5, 10)))
        if parts is not None:
            _maps(parts[2 * k + 1, 0], points, rubs, symmetry, len(names) > 1)
    return figure


def representatives(table: np.recarray) -> list[int]:
    """Returns the bodies that are shown, at most MOST_BODIES with the largest pressure. Each contact
    pair is shown once: first by bodies that are in contact with one other surface only.
    """
    pairs = {
        int(body): {
            frozenset((int(body), int(partner)))
            for partner in np.unique(table.partner[table.body == body])
        }
        for body in np.unique(table.body)
    }
    chosen: list[int] = []
    for body in sorted(pairs, key=lambda body: (len(pairs[body]), body)):
        if pairs[body].difference(*(pairs[other] for other in chosen)):
            chosen.append(body)
    chosen.sort(key=lambda body: -table.pressure[table.body == body].max())
    return sorted(chosen[:MOST_BODIES])


def _times_of_profiles(points: np.recarray) -> list[float]:
    """Returns the instants [s] of the profiles: that of the largest load, and the nearest ones
    before and after it with at most HALF of this load, or the first and last instant.
    """
    times, instant = np.unique(points.t, return_inverse=True)
    load = np.bincount(instant, points.projected_pressure * points.weight)
    peak = int(load.argmax())
    low = np.flatnonzero(load <= HALF * load[peak])
    before, after = low[low < peak], low[low > peak]
    first, last = before[-1] if len(before) else 0, after[0] if len(after) else len(times) - 1
    return [float(times[k]) for k in sorted({int(first), peak, int(last)})]


def _columns(**columns: np.ndarray) -> np.recarray:
    return np.rec.fromarrays(columns.values(), dtype=[(name, float) for name in columns])


def _section(points: np.recarray, half: bool) -> tuple[np.recarray, str, dict[str, str]]:
    """Returns the points along the outline: t [s], s [m], pressure [Pa] and state (SLIP: -1, 0, 1).
    In three dimensions these are the points near the plane z = 0.
    """
    if hasattr(points, "Z"):
        away = np.abs(points.Z)
        points = points[away <= max(0.15 * away.max(), away.min())]
    state, sides = (
        np.where(points.slides > 0, np.sign(points.slip_velocity), 0.0),
        (1, -1) if half else (1,),
    )
    own = np.concatenate(
        [
            _columns(
                t=points.t,
                s=side * points.s,
                pressure=points.projected_pressure,
                state=side * state,
            )
            for side in sides
        ]
    )
    # Removes duplicate points, which occur on the axis and in self-contact.
    once = np.unique(np.stack([own["t"], own["s"]]), axis=1, return_index=True)[1]
    return own[once].view(np.recarray), ALONG, SLIP


def radial(points: np.recarray, ball: Table | None) -> tuple[np.recarray, str, dict[str, str]]:
    """Returns the points over their distance s [m] from the axis of a ball, or from the first
    contact point: t [s], s, pressure [Pa], state. For a surface these are averages over rings: the
    load divided by the area of all points that ever bear load; a ring slides if more than half of
    its load slides. The second and third results are the name of the distance and the colours of
    the states.
    """
    solid = hasattr(points, "Z")
    if ball:
        away, words, states = (
            np.hypot(points.X, points.Z) if solid else points.X,
            "distance from the axis",
            RADIAL,
        )
        slip = (
            (points.slip_velocity * points.X + points.slip_velocity_z * points.Z) / away
            if solid
            else points.slip_velocity
        )
    else:
        away, words, states, slip = (
            np.abs(points.s),
            "distance from the first contact point",
            SLIDES,
            np.ones(len(points)),
        )
    state = np.where(points.slides > 0, np.sign(slip), 0.0)
    if not solid:
        return (
            _columns(t=points.t, s=away, pressure=points.projected_pressure, state=state),
            words,
            states,
        )
    _, every = np.unique(np.stack([points.X, points.Y, points.Z]), axis=1, return_index=True)
    count = int(np.clip(np.sqrt(len(every)), 4, 40))
    width = 1.0001 * away.max() / count
    ring = (away / width).astype(int)
    area = np.bincount(ring[every], points.weight[every], count)
    times, instant = np.unique(points.t, return_inverse=True)
    at, load = instant * count + ring, points.projected_pressure * points.weight
    total, turned, slid = (
        np.bincount(at, weights) for weights in (load, load * state, load * (points.slides > 0))
    )
    cells = np.unique(at)
    own = _columns(
        t=times[cells // count],
        s=(cells % count + 0.5) * width,
        pressure=total[cells] / area[cells % count],
        state=np.where(slid > total / 2, np.sign(turned), 0.0)[cells],
    )
    return own, words, states


def _history(
    axes: Axes,
    history: dict[str, np.ndarray],
    own: np.recarray,
    instants: np.ndarray,
    suffix: str,
    width: str,
) -> None:
    """Draws the half-width of the contact (label `width`) [mm] over time and, on the right axis,
    the largest pressure [MPa] at the instants [s], as in the other panels. Both are left out
    without contact.
    """
    half_width, other = history[f"contact_half_width{suffix}"], axes.twinx()
    largest = np.full(len(instants), np.nan)
    np.fmax.at(largest, np.searchsorted(instants, own.t), 1e-6 * own.pressure)
    for where, t, values, colour, label in (
        (
            axes,
            history["t"],
            np.where(half_width > 0, 1e3 * half_width, np.nan),
            BLUE,
            f"{width} [mm]",
        ),
        (other, instants, largest, ORANGE, "largest pressure [MPa]"),
    ):
        where.plot(1e3 * t, values, color=colour, linewidth=1)
        where.set_ylim(0, None)
        where.set_ylabel(label, color=colour)
        where.tick_params(axis="y", colors=colour)
    other.spines["right"].set_visible(True)
    axes.set(xlabel="time [ms]")


def _maps(figure: Figure, points: np.recarray, rubs: bool, symmetry: str, several: bool) -> None:
    """Draws the points under load at some instants, each as a square of its area: coloured by
    pressure and, with friction, below by stick and slip. A single body on the plane y = 0 is drawn
    at x, z. Other points are drawn in the reference configuration, along the two principal
    directions of all points.
    """
    mirrored = {"quarter": ("X", "Z"), "half": ("Z",)}.get(symmetry, ())
    columns = {name: points[name] for name in ("t", "X", "Y", "Z", "x", "y", "z")}
    columns["pressure"] = points.projected_pressure
    columns["area"] = points.weight / 2 ** len(mirrored)
    columns["state"] = np.where(
        points.slides > 0, 1.0 if several else np.sign(points.slip_velocity), 0.0
    )
    for axis in mirrored:
        turned = (axis, axis.lower(), *(("state",) if axis == "X" and not several else ()))
        columns = {
            name: np.concatenate([values, -values if name in turned else values])
            for name, values in columns.items()
        }
    # The points are on the plane.
    if not several and np.abs(columns["y"]).max() < 0.1 * np.ptp(columns["x"]):
        columns |= {"across": columns["x"], "up": columns["z"]}
        labels = "x [mm]", "z [mm]"
    else:
        columns["across"], columns["up"] = _in_plane(
            np.stack([columns[axis] for axis in "XYZ"], axis=1)
        )
        labels = "along the patch [mm]", "across [mm]"
    points = _columns(**columns)
    times = list(np.unique(points.t))
    shown = _instants(points, evenly(times, MAPS + 2)[1:-1] if len(times) > MAPS else times)
    grid = figure.subplots(1 + rubs, len(shown), squeeze=False, sharex=True, sharey=True)
    states = SLIDES if several else SLIP
    low, high = (1e3 * np.array([end(points.across), end(points.up)]) for end in (np.min, np.max))
    low, high = low - 0.04 * (high - low), high + 0.04 * (high - low)
    # Typographic points per mm.
    scale = 72 * min(5.2 / len(shown) / (high - low)[0], 1.1 / (high - low)[1])
    for row, (column, colours) in zip(
        grid,
        (
            ("pressure", dict(cmap="viridis", vmin=0, vmax=1e-6 * points.pressure.max())),
            ("state", _colours(states)),
        ),
    ):
        for axes, (t, now, _) in zip(row, shown):
            values = 1e-6 * now.pressure if column == "pressure" else now.state
            picture = axes.scatter(
                1e3 * now.across,
                1e3 * now.up,
                c=values,
                s=np.maximum(1e6 * now.area * scale**2, 1.5),
                marker="s",
                linewidths=0,
                **colours,
            )
            axes.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1]))
            axes.tick_params(labelsize=7)
            if column == "pressure":
                axes.set_title(f"{1e3 * t:.3g} ms", fontsize=8)
        row[0].set_ylabel(labels[1])
        if column == "pressure":
            figure.colorbar(picture, ax=list(grid.flat), shrink=0.7, label=PRESSURE)
        else:
            row[len(shown) // 2].legend(*_keys(states), **ABOVE)
    plt.setp(grid[-1], xlabel=labels[0])


def _in_plane(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the coordinates of `places` (n, 3) [m] relative to their centre along their two
    principal directions. The second direction is the one nearer to z.
    """
    places = places - places.mean(axis=0)
    two = np.linalg.svd(places, full_matrices=False)[2][:2]
    two = two[np.argsort(np.abs(two[:, 2]))]
    two = two * np.sign(two[[0, 1], np.abs(two).argmax(axis=1)])[:, None]
    return places @ two[0], places @ two[1]


def _instants(
    table: np.recarray, times: Sequence[float]
) -> list[tuple[float, np.recarray, np.ndarray]]:
    """Returns (t, rows, colour) for each of the `times` [s]."""
    colours = plt.get_cmap("plasma")(np.linspace(0, 0.85, len(times)))
    return [(t, table[table.t == t], colour) for t, colour in zip(times, colours)]


def draw_profiles(
    axes: Axes, own: np.recarray, words: str, line: str, times: Sequence[float]
) -> None:
    """Draws pressure [MPa] over s [mm] at the `times` [s]; `words` is the label of s. With a
    line style `line` the points are joined, except between separate contacts. Without it only the
    points are drawn.
    """
    for t, now, colour in _instants(own, times):
        now = now[now.s.argsort(kind="stable")]
        gap = _between(now.s)[0] if line else np.empty(0)  # interrupts the line between contacts
        s, values = np.append(now.s, gap), np.append(now.pressure, np.full(len(gap), np.nan))
        order = np.argsort(s, kind="stable")
        values = values[order]
        axes.plot(
            1e3 * s[order],
            1e-6 * values,
            color=colour,
            linestyle=line,
            marker="" if line else ".",
            markersize=2.5,
            linewidth=1.1,
            label=f"{1e3 * t:.3g} ms",
        )
        if (lone := _lone(values)).any():  # a line of one point is invisible
            axes.plot(1e3 * s[order][lone], 1e-6 * values[lone], ".", color=colour, markersize=4)
    axes.set(xlabel=f"{words} [mm]", ylabel=PRESSURE, ylim=(0, None))
    legend(axes, **ABOVE)


def _lone(values: np.ndarray) -> np.ndarray:
    """Returns which of the values (n,) are finite and have no finite neighbour."""
    finite = np.pad(np.isfinite(values), 1)
    lone: np.ndarray = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    return lone


def _beside_hertz(axes: Axes, points: np.recarray, ball: Table, times: Sequence[float]) -> None:
    """Adds the Hertz pressure for the same force at each instant of the profiles, if the impact of
    the ball is slow (SLOW).
    """
    if ball["speed"] <= SLOW * np.sqrt(ball["young"] / ball["density"]):
        for _, now, colour in _instants(points, times):
            r, pressure = hertz((now.pressure * now.weight).sum(), ball)
            axes.plot(1e3 * r, 1e-6 * pressure, color=colour, linewidth=0.9)
        axes.plot([], [], color=BLACK, linewidth=0.9, label="Hertz, same force")
        legend(axes, **ABOVE)
    axes.set_xlim(0, None)


def hertz(force: float, ball: Table) -> tuple[np.ndarray, np.ndarray]:
    """Returns radii [m] and Hertz pressure [Pa] at these radii for a ball that is pressed onto a
    rigid plane by `force` [N]: a^3 = 3 F R / (4 E*), p_0 = 3 F / (2 pi a^2).
    """
    stiffness = ball["young"] / (1 - ball["nu"] ** 2)
    a = (3 * force * ball["radius"] / (4 * stiffness)) ** (1 / 3)
    r = a * np.sin(np.linspace(0, np.pi / 2, 60))
    return r, 3 * force / (2 * np.pi * a**2) * np.sqrt(np.maximum(1 - (r / a) ** 2, 0))


def _between(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Finds the intervals between separate contacts in sorted `places` (n). Returns the positions
    one median distance behind the start and before the end of each interval.
    """
    usual = np.median(np.diff(places)) if len(places) > 1 else 0.0
    far = np.flatnonzero(np.diff(places) > FAR * usual)
    return places[far] + usual, places[far + 1] - usual


def _over_time(
    axes: Axes, own: np.recarray, instants: np.ndarray, values: np.ndarray, **colours: Any
) -> QuadMesh:
    """Draws the values of the points over the instants [s] and the positions of the points. Points
    without load are left blank.
    """
    places, between = np.unique(own.s), _between(np.unique(own.s))
    places = np.sort(np.concatenate([places, *between]))  # blank rows between contacts
    matrix = np.full((len(places), len(instants)), np.nan)
    matrix[np.searchsorted(places, own.s), np.searchsorted(instants, own.t)] = values
    return axes.pcolormesh(
        1e3 * instants, 1e3 * places, matrix, shading="nearest", rasterized=True, **colours
    )


def _colours(states: dict[str, str]) -> dict[str, Any]:
    """Returns the colour scale for the three states -1, 0, 1 or the two states 0, 1."""
    return dict(cmap=ListedColormap(list(states.values())), vmin=1.5 - len(states), vmax=1.5)


def _keys(states: dict[str, str]) -> tuple[list[Rectangle], list[str]]:
    return [Rectangle((0, 0), 1, 1, color=colour) for colour in states.values()], list(states)
