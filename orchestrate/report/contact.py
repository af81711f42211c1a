"""The contact of a run along the outlines of its bodies: pressure at instants and over time, and with friction where it sticks and slides."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.colors import ListedColormap

from ..parameters import Value
from ..results import read_table

INSTANTS = 6                     # profiles at most
SLOW = 0.03                      # speed over sqrt(E/rho) up to which the pressure of a ball is shown beside Hertz'
MOST_BODIES = 4                  # those with the largest pressure
PRESSURE = "contact pressure [MPa]"
SLIP = {"slips back": "#0072b2", "sticks": "#bbbbbb", "slips forward": "#d55e00"}    # v_T < 0, > 0: on the plane along x
ABOVE = {"loc": "lower center", "bbox_to_anchor": (0.5, 1), "ncols": 3, "fontsize": 6.5, "handlelength": 1.0, "columnspacing": 0.8}
COLUMNS = ["t", "body", "partner", "s", "X", "Y", "x", "y", "weight", "pressure", "shear", "slip_velocity", "slides"]


def read(folder: Path) -> pd.DataFrame:
    """fields/contact.csv of the run in `folder`: a row for every point of an outline that bears load, at the instants of the snapshots.

    t [s]; body (from 1); partner (k: body k, -k: obstacle k); s: along the body's outline from where it was first touched, the body to the left;
    X, Y, x, y: reference and present place; weight: share of the outline [m]; pressure (10), shear (11) [Pa] per reference length, means over the
    step that ends at t; slip_velocity [m/s]; slides (1 or 0). In three dimensions also Z, z, shear_z, slip_velocity_z; weight [m2]. Unreadable where it is not such a table.
    """
    return read_table(folder / "fields/contact.csv", COLUMNS)


def draw(table: pd.DataFrame, names: list[str], half: bool, free: np.ndarray, ball: dict[str, Value] | None = None) -> plt.Figure | None:
    """A row of panels a body: pressure over the outline at some instants, over outline and time, and with friction the slip; None without contact.
    Half a body is drawn with its mirror image, of one in three dimensions the points nearest to the plane z = 0. `free`: times [s] at which nothing is
    touched. `ball`: the scene where the body is a ball that nothing turns: its pressure is drawn over the radius."""
    if table.empty:
        return None
    all_points = table
    if "Z" in table:
        table = table[table.Z.abs() <= max(0.15 * table.Z.abs().max(), table.Z.abs().min())]
    largest = table.groupby("body").pressure.max().nlargest(MOST_BODIES)
    instants = np.union1d(table.t, free[(free > table.t.min()) & (free < table.t.max())])
    rubs, bodies = bool(table.shear.any()), sorted(largest.index)
    figure, grid = plt.subplots(len(bodies), 3 if rubs else 2, figsize=(8.4, 2.5 * len(bodies) + 0.6), squeeze=False)
    for row, body in zip(grid, bodies):
        own = table[table.body == body].groupby(["t", "s"], as_index=False).first()     # twice only where an outline meets itself
        if half:
            own = pd.concat([own, own.assign(s=-own.s, shear=-own.shear, slip_velocity=-own.slip_velocity)]).drop_duplicates(["t", "s"])
        if ball:
            _over_radius(row[0], all_points, ball)
        else:
            _profiles(row[0], own, "-" if "Z" not in table else "")
        times, places, pressure = _over_time(own, "pressure", instants)
        picture = row[1].pcolormesh(1e3 * times, 1e3 * places, 1e-6 * pressure.T, shading="nearest", cmap="viridis", vmin=0, rasterized=True)
        figure.colorbar(picture, ax=row[1], label=PRESSURE)
        if rubs:
            _slip(row[2], own, instants)
        for axes in row[1:]:
            axes.set(ylabel="along the outline [mm]", xlabel="time [ms]")
        if len(names) > 1:
            row[1].set_title(names[body - 1])
    return figure


def _instants(table: pd.DataFrame) -> list[tuple[float, pd.DataFrame, tuple]]:
    """(t, rows, colour) of up to INSTANTS times."""
    times = np.unique(table.t)
    picked = times[np.unique(np.linspace(0, len(times) - 1, INSTANTS + 2).round().astype(int)[1:-1])] if len(times) > INSTANTS else times
    return [(t, table[table.t == t], colour) for t, colour in zip(picked, plt.get_cmap("plasma")(np.linspace(0, 0.85, len(picked))))]


def _profiles(axes: plt.Axes, own: pd.DataFrame, line: str) -> None:
    """Pressure [MPa] along the outline [mm] at up to INSTANTS times."""
    for t, now, colour in _instants(own):
        now = now.sort_values("s")
        axes.plot(1e3 * now.s, 1e-6 * now.pressure, color=colour, linestyle=line, linewidth=1.1, marker=".", markersize=2.5, label=f"{1e3 * t:.3g} ms")
    axes.set(xlabel="along the outline [mm]", ylabel=PRESSURE, ylim=(0, None))
    axes.legend(**ABOVE)


def _over_radius(axes: plt.Axes, table: pd.DataFrame, ball: dict[str, Value]) -> None:
    """Pressure [MPa] at the points over their present distance [mm] from the axis, at up to INSTANTS times; in a slow impact Hertz' of the same force."""
    slow = ball["speed"] <= SLOW * np.sqrt(ball["young"] / ball["density"])
    for t, now, colour in _instants(table):
        away = np.hypot(now.x, now.z) if "z" in now else now.x
        axes.plot(1e3 * away, 1e-6 * now.pressure, color=colour, linestyle="", marker=".", markersize=3.5, label=f"{1e3 * t:.3g} ms")
        if slow:
            r, pressure = hertz((now.pressure * now.weight).sum(), ball)
            axes.plot(1e3 * r, 1e-6 * pressure, color=colour, linewidth=0.9)
    if slow:
        axes.plot([], [], color="#222222", linewidth=0.9, label="Hertz, same force")
    axes.set(xlabel="distance from the axis [mm]", ylabel=PRESSURE, xlim=(0, None), ylim=(0, None))
    axes.legend(**ABOVE)


def hertz(force: float, ball: dict[str, Value]) -> tuple[np.ndarray, np.ndarray]:
    """Radii [m] and Hertz' pressure there [Pa] of a ball that is pressed on a rigid plane by `force` [N]: a^3 = 3 F R / (4 E*), p_0 = 3 F / (2 pi a^2)."""
    stiffness = ball["young"] / (1 - ball["nu"] ** 2)
    a = (3 * force * ball["radius"] / (4 * stiffness)) ** (1 / 3)
    r = a * np.sin(np.linspace(0, np.pi / 2, 60))
    return r, 3 * force / (2 * np.pi * a**2) * np.sqrt(np.maximum(1 - (r / a) ** 2, 0))


def _over_time(own: pd.DataFrame, column: str, instants: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The instants (n) [s], places (m) [m] and the values (n, m) there; nan where there is no load."""
    wide = own.pivot(index="t", columns="s", values=column).reindex(instants)
    return instants, wide.columns.to_numpy(), wide.to_numpy()


def _slip(axes: plt.Axes, own: pd.DataFrame, instants: np.ndarray) -> None:
    """Where the points under load stick and slide, over outline and time."""
    state = own.assign(state=np.where(own.slides > 0, np.sign(own.slip_velocity), 0.0))
    times, places, values = _over_time(state, "state", instants)
    axes.pcolormesh(1e3 * times, 1e3 * places, values.T, shading="nearest", cmap=ListedColormap(list(SLIP.values())), vmin=-1.5, vmax=1.5, rasterized=True)
    axes.legend([plt.Rectangle((0, 0), 1, 1, color=colour) for colour in SLIP.values()], list(SLIP), **ABOVE)
