"""Figures of a finished run: energies, contact force, velocity of the centre of mass, deformed shapes."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from . import vtu
from .parameters import Value
from .run import read_history, read_scene

LAWS = {"svk": "St. Venant–Kirchhoff", "neohookean": "neo-Hookean", "incompressible": "incompressible neo-Hookean"}
BLUE, ORANGE, GREEN, PURPLE, BLACK, GREY = "#0072b2", "#d55e00", "#009e73", "#aa4499", "#222222", "#999999"
STYLE = {"font.size": 9, "axes.titlesize": 9, "axes.spines.top": False, "axes.spines.right": False,
         "axes.linewidth": 0.8, "lines.linewidth": 1.4, "legend.frameon": False, "figure.dpi": 100, "savefig.dpi": 150,
         "figure.constrained_layout.use": True, "figure.constrained_layout.w_pad": 0.08}
SHAPES = 9   # small multiples at most


def draw(folder: Path) -> list[Path]:
    """Draws all figures of the run in `folder` into folder/figures; the files. Unreadable where the folder is broken."""
    history, scene = read_history(folder), read_scene(folder)
    snapshots = vtu.series(folder / "fields.pvd")
    target = folder / "figures"
    target.mkdir(exist_ok=True)
    with plt.rc_context(STYLE):
        drawn = {"energies": _energies(history), "force": _force(history), "velocity": _velocity(history)}
        if snapshots:
            drawn["shapes"] = _shapes(snapshots)
        files = []
        for name, figure in drawn.items():
            figure.suptitle(_title(scene), fontsize=9)
            files.append(target / f"{name}.png")
            figure.savefig(files[-1])
            plt.close(figure)
    return files


def _title(scene: dict[str, Value]) -> str:
    """Law, nu, speed, and the angle where the impact is oblique."""
    angle = "" if scene.get("angle", 90) == 90 else f" at {scene['angle']:g}°"
    return f"{LAWS.get(scene['law'], scene['law'])}, ν = {scene['nu']:g}, {scene['speed']:g} m/s{angle}"


def _per(history: dict[str, np.ndarray]) -> str:
    """Plane strain is per metre of thickness, a ball is not."""
    return "" if "vz" in history else "/m"


def _energies(history: dict[str, np.ndarray]) -> plt.Figure:
    """Energies [J/m] over time, and below them the error of their balance, relative to the energy at the start."""
    t = 1e3 * history["t"]
    total = history["kinetic"] + history["elastic"] + history["contact"]
    start = total[0] or total.max() or 1.0   # at rest: over the largest energy
    figure, (top, bottom) = plt.subplots(2, sharex=True, figsize=(5.2, 4.2), height_ratios=[3, 1])
    lines = {"kinetic": (history["kinetic"], BLUE), "elastic": (history["elastic"], ORANGE),
             "contact": (history["contact"], GREEN)}
    if history["friction_work"].any():
        lines["lost to friction"] = history["friction_work"], PURPLE
        total = total + history["friction_work"]
    if history["external_work"].any():
        lines["work of gravity"] = history["external_work"], GREY
        total = total - history["external_work"]
    for name, (values, colour) in lines.items():
        top.plot(t, values, color=colour, label=name)
    top.plot(t, total, color=BLACK, linestyle="--", label="balance" if len(lines) > 3 else "total")
    top.set(ylabel=f"energy [J{_per(history)}]", ylim=(min(0, 1.05 * min(v.min() for v, _ in lines.values())), None))
    top.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=min(len(lines) + 1, 4), handlelength=1.6, columnspacing=1.4)
    error = np.abs(history["balance"]) / start
    bottom.semilogy(t, np.where(error > 0, error, np.nan), color=BLACK, linewidth=0.9)
    bottom.set(xlabel="time [ms]", ylabel="|balance| / $E_0$")
    bottom.margins(y=0.15)
    top.margins(x=0)
    return figure


def _force(history: dict[str, np.ndarray]) -> plt.Figure:
    """Normal (and friction) force [kN/m] over time."""
    t = 1e3 * history["t"]
    figure, axes = plt.subplots(figsize=(5.2, 3.2))
    axes.plot(t, 1e-3 * history["normal_force"], color=BLUE, label="normal")
    if history["friction_force"].any():
        axes.plot(t, 1e-3 * history["friction_force"], color=ORANGE, label="friction")
        axes.axhline(0, color=GREY, linewidth=0.6)
        axes.legend()
    axes.set(xlabel="time [ms]", ylabel=f"contact force [kN{_per(history)}]")
    if not history["friction_force"].any():
        axes.set_ylabel(f"normal force [kN{_per(history)}]")
        axes.set_ylim(bottom=0)
    axes.margins(x=0)
    return figure


def _velocity(history: dict[str, np.ndarray]) -> plt.Figure:
    """Velocity of the centre of mass [m/s] over time, a line a component."""
    t = 1e3 * history["t"]
    figure, axes = plt.subplots(figsize=(5.2, 3.2))
    axes.axhline(0, color=GREY, linewidth=0.6)
    moving = [name for name in ("vx", "vy", "vz") if name in history and history[name].any()]
    for name, colour in zip(moving, (BLUE, ORANGE, GREEN)):
        axes.plot(t, history[name], color=colour, label=f"$v_{name[1]}$")
    axes.set(xlabel="time [ms]", ylabel="velocity of the centre of mass [m/s]")
    if moving == ["vy"]:
        axes.set_ylabel("$v_y$ of the centre of mass [m/s]")
    else:
        axes.legend()
    axes.margins(x=0)
    return figure


def _shapes(series: list[tuple[float, Path]]) -> plt.Figure:
    """The body at up to SHAPES instants above the plane y = 0, coloured by the von Mises stress [MPa]."""
    picked = [series[k] for k in np.unique(np.linspace(0, len(series) - 1, SHAPES).round().astype(int))]
    bodies = [_deformed(vtu.read(path)) for _, path in picked]
    largest = max(stress.max() for _, _, stress in bodies)
    left, right = min(points[:, 0].min() for points, _, _ in bodies), max(points[:, 0].max() for points, _, _ in bodies)
    left, right = left - 0.03 * (right - left), right + 0.03 * (right - left)
    low = min(points[:, 1].min() for points, _, _ in bodies)
    high = 1.04 * max(points[:, 1].max() for points, _, _ in bodies)
    floor = min(low, 0) - 0.08 * high

    columns = min(3, len(bodies))
    rows = -(-len(bodies) // columns)
    size = 6.4 / columns
    figure, grid = plt.subplots(rows, columns, figsize=(6.4 + 0.8, rows * (size * (high - floor) / (right - left) + 0.25) + 0.3),
                                squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, (points, triangles, stress), (t, _) in zip(grid.flat, bodies, picked):
        axes.fill_between([left, right], floor, 0, color="#d0d0d0", linewidth=0)
        axes.axhline(0, color=BLACK, linewidth=0.8)
        picture = axes.tripcolor(*points.T, triangles, stress, shading="gouraud", cmap="viridis", vmin=0, vmax=largest)
        axes.set(xlim=(left, right), ylim=(floor, high), aspect="equal")
        axes.set_title(f"{1e3 * t:.2f} ms", pad=2)
    figure.colorbar(picture, ax=grid, label="von Mises stress [MPa]", shrink=0.7, aspect=30)
    return figure


def _deformed(snapshot: vtu.Snapshot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Deformed points (n, 2) in m, triangles (t, 3) and von Mises stress (n,) in MPa of the whole body."""
    points = snapshot.points + snapshot.fields["displacement"][:, :2]
    triangles, stress = snapshot.triangles, 1e-6 * snapshot.fields["von_mises"]
    if snapshot.points[:, 0].min() >= 0:   # half a body: the other half is its mirror image
        triangles = np.vstack([triangles, triangles + len(points)])
        points, stress = np.vstack([points, points * (-1, 1)]), np.concatenate([stress, stress])
    return points, triangles, stress
