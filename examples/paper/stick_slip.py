"""Searches slip velocity, contact stiffness and Poisson's ratio for the sliding and sticking of
section 3.1.

In the paper the oblique disc slides first, sticks in the last third of the contact with constant
energy, and is in contact for 4.5 ms. The three parameters are not given. The angle pi/3 is 60
degrees from the plane, as normal incidence is pi/2; 30 degrees, pi/3 from the normal, is searched,
too.
"""

import argparse
import itertools
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle

from ffimpact.__main__ import start
from ffimpact.failure import Unreadable
from ffimpact.output.folder import result_folder
from ffimpact.output.results import read_history
from ffimpact.places import RESULTS, shown
from ffimpact.report.figures import LAWS, ORANGE, SMALL, STYLE, save
from ffimpact.sweeps import study

AXES = {"direction": (-60.0, -30.0), "slip_velocity": (0.03, 0.3, 1.0, 3.0), "penalty": (1e8, 1e9, 1e10), "nu": (0.3, 0.4, 0.45)}
# Settings that the paper may have used.
LAW = {"svk": {"degree": 1, "mesh_size": 0.01, "contact_mesh_size": 0.005, "breakdown": "continue", "accuracy": 0.0025},
       "neohookean": {"accuracy": 0.005}}
SCENE, BASE = "disc-oblique", {"fields": 0}
# The contact time of the paper [s] and the permitted relative difference.
PAPER = 4.5e-3, 0.02
LIMIT = 300.0  # longest time of a run [s]
# Below this share of the friction work in the last third the energy counts as constant.
QUIET = 0.05
THIRDS = ("first", "second", "last")


def main(argv: list[str]) -> int:
    """Runs the grid, prints the share of sliding in each third of the contact and draws the map.
    Always returns 0."""
    parser = argparse.ArgumentParser(prog="python -m examples.paper.stick_slip", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", metavar="DIR", type=Path, default=RESULTS / "stick-slip", help="the result folder")
    parser.add_argument("--quick", action="store_true", help="a corner of the grid")
    options = parser.parse_args(argv)
    out = result_folder(options.out)
    axes = {name: values[-2:] for name, values in AXES.items()} if options.quick else AXES
    points = grid(axes)
    rows = study.study(points, out, BASE, LIMIT, SCENE)
    rows = pd.concat([rows, pd.DataFrame([thirds(study.place(out, point)) for point in points])], axis=1)
    rows["angle"] = -rows.direction
    rows["order"] = as_told(rows)
    rows["quiet"] = rows.work_last <= QUIET
    rows["time"] = (rows.contact_time / PAPER[0] - 1).abs() <= PAPER[1]
    draw(rows, axes, out / "stick-slip.png")
    study.save(rows, out / "stick-slip.csv")
    print(f"{report(rows)}\n\n{shown(out)}/stick-slip.{{csv,png}}")
    return 0


def grid(axes: dict[str, tuple[float, ...]]) -> list[study.Point]:
    """Every combination of the axes, for both laws."""
    return [{"law": law} | LAW[law] | dict(zip(axes, values)) for law in LAW for values in itertools.product(*axes.values())]


def thirds(folder: Path) -> dict[str, float]:
    """The mean share of the normal load on sliding points in each third of the contact time.

    Also returns the share of the friction work in the last third. All are nan for a failed run.
    """
    try:
        history = read_history(folder)
    except Unreadable:
        return dict.fromkeys((*THIRDS, "work_last"), np.nan)
    end, dt = history["t"], history["dt"]
    touching = history["normal_force"] > 0
    if not touching.any():
        return dict.fromkeys((*THIRDS, "work_last"), np.nan)
    start, stop = (end - dt)[touching][0], end[touching][-1]
    edges = start + (stop - start) * np.array([0, 1 / 3, 2 / 3, 1])
    sliding = np.where(touching, history["sliding_fraction"], 0.0)
    slid = np.interp(edges, end, np.cumsum(sliding * dt))
    shares = np.diff(slid) / np.diff(edges)
    work = np.interp(edges, end, history["friction_work"])
    total = work[-1] - work[0]
    return dict(zip(THIRDS, shares)) | {"work_last": (work[-1] - work[-2]) / total if total > 0 else np.nan}


def as_told(rows: pd.DataFrame) -> pd.Series:
    """Whether a run has the paper's order: mostly sliding in the first and second third, mostly
    sticking in the last."""
    return (rows["first"] > 0.5) & (rows["second"] > 0.5) & (rows["last"] < 0.5)


def report(rows: pd.DataFrame) -> str:
    """A table of all runs, and the numbers of runs with the order, with the contact time and with
    both."""
    formats = {"law": "", "angle": "g", "nu": "g", "penalty": ".0e", "slip_velocity": "g", "contact_time": ".5f", "first": ".2f",
               "second": ".2f", "last": ".2f", "work_last": ".2f", "breakdown_time": ".5f", "exit": ".0f"}
    rows = rows if "breakdown_time" in rows else rows.assign(breakdown_time=np.nan)
    lines = [study.table(rows, formats), "",
             "first, second, last: share of the normal load that slides in each third of the contact; "
             "work_last: share of the friction work in the last third", ""]
    for (angle, law), group in rows.groupby(["angle", "law"], sort=False):
        lines.append(f"{angle:g} degrees, {LAWS[law]}: of {len(group)} runs {group['order'].sum()} slide first and "
                     f"stick in the last third, {group['quiet'].sum()} lose at most {100 * QUIET:g} % of the friction work in it, "
                     f"{group['time'].sum()} last {1e3 * PAPER[0]:g} ms within {100 * PAPER[1]:g} %, "
                     f"{(group['order'] & group['quiet'] & group['time']).sum()} do all three; {(group.exit != 0).sum()} failed")
    return "\n".join(lines)


def draw(rows: pd.DataFrame, axes: dict[str, tuple[float, ...]], path: Path) -> None:
    """Draws the map: a column for each law and angle, a row for each nu.

    A panel has a field for each slip velocity and penalty, coloured by the contact time. Three bars
    in each field show the share that slides in the first, second and last third of the contact, on
    a common axis from 0 to 100 %. A frame marks the paper's order.
    """
    low, high = 1e3 * rows.contact_time.min(), 1e3 * rows.contact_time.max()
    columns = list(itertools.product(LAW, [-direction for direction in axes["direction"]]))
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(len(axes["nu"]), len(columns), figsize=(4.1 * len(columns) + 0.4, 1.9 * len(axes["nu"]) + 1.2),
                                    squeeze=False, sharex=True, sharey=True, layout="constrained")
        for panels, (law, angle) in zip(grid.T, columns):
            for panel, nu in zip(panels, axes["nu"]):
                here = rows[(rows.law == law) & (rows.angle == angle) & (rows.nu == nu)].set_index(["penalty", "slip_velocity"])
                picture = _cells(panel, here, axes, low, high)
                panel.set_title(f"{LAWS[law]}{', coarse P1 mesh' if law == 'svk' else ''}, {angle:g}°, ν = {nu:g}")
        plt.setp(grid[-1], xlabel="slip velocity ε [m/s]")
        plt.setp(grid[:, 0], ylabel="k [Pa/m]")
        bar = figure.colorbar(picture, ax=grid, label="contact time [ms]", shrink=0.6)
        bar.ax.axhline(1e3 * PAPER[0], color=ORANGE, linewidth=2)
        figure.suptitle("Share of the normal load that slides [%], a bar each for the first, second and last third of the contact (full "
                        "height: 100 %);\n"
                        f"framed ({rows['order'].sum()} of {len(rows)}): slides first, sticks last, as in the paper, whose contact time is "
                        f"{1e3 * PAPER[0]:g} ms (line in the bar of colours)")
        save(figure, path)


def _cells(panel: plt.Axes, here: pd.DataFrame, axes: dict[str, tuple[float, ...]], low: float, high: float) -> AxesImage:
    """Draws the fields of a panel, by (penalty, slip velocity), with their bars and frames."""
    cells = np.array([[here.loc[(k, e), "contact_time"] for e in axes["slip_velocity"]] for k in axes["penalty"]])
    picture = panel.imshow(1e3 * cells, vmin=low, vmax=high, cmap="viridis", origin="lower", aspect="auto")
    for i, k in enumerate(axes["penalty"]):
        for j, e in enumerate(axes["slip_velocity"]):
            row = here.loc[(k, e)]
            _bars(panel, j, i, row)
            if row["order"]:
                panel.add_patch(Rectangle((j - 0.48, i - 0.47), 0.96, 0.94, fill=False, color=ORANGE, linewidth=2))
    panel.set_xticks(range(len(axes["slip_velocity"])), [f"{e:g}" for e in axes["slip_velocity"]])
    panel.set_yticks(range(len(axes["penalty"])), [f"$10^{{{np.log10(k):.0f}}}$" for k in axes["penalty"]])
    panel.spines[:].set_visible(False)
    return picture


def _bars(panel: plt.Axes, column: int, row: int, run: pd.Series) -> None:
    """Draws the shares of a run in its field: white bars with their numbers [%] above, from the
    lower edge up to 0.6 of the height (100 %)."""
    if run.exit:
        panel.text(column, row, "failed", ha="center", va="center", fontsize=SMALL)
        return
    for place, name in zip((-0.28, 0, 0.28), THIRDS):
        panel.add_patch(Rectangle((column + place - 0.11, row - 0.42), 0.22, 0.6, facecolor="none", edgecolor="white", linewidth=0.5))
        panel.add_patch(Rectangle((column + place - 0.11, row - 0.42), 0.22, 0.6 * run[name], facecolor="white", edgecolor="none"))
        panel.text(column + place, row + 0.31, f"{100 * run[name]:.0f}", ha="center", va="center", fontsize=SMALL, color="black",
                   bbox=dict(facecolor="white", alpha=0.75, edgecolor="none", pad=0.6))


if __name__ == "__main__":
    sys.exit(start(main))
