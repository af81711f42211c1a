"""Style and helpers that the figures share, and the figures of a single body on the plane: friction
force, stick and slip, and flight, like figures 4 and 5 of the paper.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field as dataclass_field
from pathlib import Path
from typing import Any, TypeVar
from warnings import catch_warnings, filterwarnings

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, TriMesh
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import AutoLocator, MaxNLocator, NullLocator
from matplotlib.transforms import ScaledTranslation
from matplotlib.tri import LinearTriInterpolator, Triangulation

from ..geometry.outlines import rotation
from ..input import dimension
from ..input.parameters import Table, Value
from ..mesh import mesh
from ..output import vtu
from ..output.results import force_times
from . import literature

__all__ = [
    "ABOVE",
    "BAND",
    "BELOW",
    "BLACK",
    "BLUE",
    "BODY",
    "Body",
    "DASHED",
    "GREEN",
    "GREY",
    "LAWS",
    "MEAN_PRESSURE",
    "ORANGE",
    "ORIGIN",
    "PLASTIC_STRAIN",
    "PURPLE",
    "Pose",
    "SHAPES",
    "SMALL",
    "STICKS",
    "STRESS",
    "STYLE",
    "UNITS",
    "VISCOUS",
    "arranged",
    "as_written",
    "balance_error",
    "colour_limits",
    "deformed",
    "diameter",
    "draw_body",
    "draw_interfaces",
    "end_of_contact",
    "evenly",
    "flight",
    "flown",
    "friction_force",
    "is_oblique",
    "is_half",
    "peak_suffix",
    "legend",
    "material",
    "numbers_of_the_paper",
    "over_time",
    "per_metre",
    "pose_at",
    "rigid_rolling",
    "rolling",
    "save",
    "scale_bar",
    "rows_of_bodies",
    "styled",
    "contact_bounds",
]

T = TypeVar("T")

LAWS = {
    "svk": "St. Venant–Kirchhoff",
    "neohookean": "neo-Hookean",
    "mooney-rivlin": "Mooney–Rivlin",
    "ogden": "Ogden",
    "metal": "metal",
    "energy": "by an energy",
    "incompressible": "neo-Hookean with J = 1",
}
BLUE, ORANGE, GREEN, PURPLE, BLACK, GREY = (
    "#0072b2",
    "#d55e00",
    "#009e73",
    "#aa4499",
    "#222222",
    "#999999",
)
STICKS = "#bbbbbb"  # colour of stick; slip is orange, backward slip blue
# Font size of legends, of numbers in cells and of text below figures. STYLE has the size of other
# text.
SMALL = 7.5
# Two settings make drawing quicker: text.hinting keeps the outlines of letters unchanged, and
# axes.titley fixes the height of titles.
STYLE: dict[str, Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "legend.fontsize": SMALL,
    "figure.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "figure.dpi": 100,
    "savefig.dpi": 150,
    "figure.constrained_layout.w_pad": 0.08,
    "text.hinting": "none",
    "axes.titley": 1.0,
}
NUMBERS = 6  # largest number of intervals between the ticks of an axis
BODY = {"ball": "ball: ", "ball-axisymmetric": "ball as a body of revolution: "}
STRESS = "von Mises stress [MPa]"
MEAN_PRESSURE = "pressure −tr(σ)/3 [MPa]"
PLASTIC_STRAIN = "equivalent plastic strain"
# Units of the fields of a state as they are drawn; that of all others is MPa.
UNITS = {"displacement": "m", "velocity": "m/s", "jacobian": "", "plastic_strain": ""}
SHAPES = 9  # largest number of shapes in one picture
# A legend above its panel.
ABOVE: dict[str, Any] = {
    "loc": "lower center",
    "bbox_to_anchor": (0.5, 1),
    "handlelength": 1.6,
    "columnspacing": 1.4,
}
# A legend below its panel, below the tick labels and the label of the axis.
BELOW: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0), "borderaxespad": 5.5}
# Removes the ticks of a panel without axes, which matplotlib would lay out even if they are hidden.
BARE: dict[str, Any] = {"xticks": [], "yticks": []}
BAND = "#c8c8c8"  # colour of a wide line or an area behind other curves
VISCOUS = "#8c510a"
DASHED = (0, (4, 2))
ORIGIN = np.zeros(2)
# Converts digits to superscript letters. Parsing a formula takes as long as drawing a picture.
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@contextmanager
def styled() -> Iterator[None]:
    """Figures in the STYLE of the program. The first figure of a process loads the backend, and that
    of a notebook makes matplotlib interactive, which must outlive the style.
    """
    with plt.style.context(STYLE):
        yield
        interactive = plt.isinteractive()
    matplotlib.interactive(interactive)


def arranged(figure: Figure) -> Figure:
    """Gives the figure a layout without overlaps, and its axes few ticks."""
    if not figure.get_layout_engine():
        figure.set_layout_engine("constrained")
    for axes in (part for panel in figure.axes for part in (panel, *panel.child_axes)):
        for axis in (axes.xaxis, axes.yaxis):
            if type(axis.get_major_locator()) is AutoLocator:
                axis.set_major_locator(MaxNLocator(NUMBERS, steps=(1, 2, 2.5, 5, 10)))
    return figure


def save(figure: Figure, path: Path) -> None:
    """Writes the figure to a file and closes it."""
    with catch_warnings():
        # A letter that the font lacks is drawn as an empty box, without a warning.
        filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        arranged(figure).savefig(path)
    plt.close(figure)


def material(body: Table) -> str:
    """Returns the law of a body with its parameters, E, nu, density and viscosities. For a rigid
    body it returns mass or density.
    """
    if body.get("rigid"):
        return (
            f"rigid, m = {body['mass']:g} kg"
            if "mass" in body
            else f"rigid, ρ = {body['density']:g} kg/m³"
        )
    listed = [
        f"{name} = {body[name]}" for name in ("share", "alpha", "mu", "parameters") if name in body
    ]
    own = f" ({', '.join(listed)})" if listed else ""
    viscosities = "".join(
        f", {sign} = {body[name]:.3g} Pa s"
        for name, sign in (("viscosity", "η"), ("bulk_viscosity", "ζ"))
        if body.get(name)
    )
    branches = body.get("branches", [])
    if len(branches) == 1:
        viscosities += f", G = {1e-6 * branches[0][0]:.3g} MPa for τ = {branches[0][1]:.3g} s"
    elif branches:
        viscosities += f", {len(branches)} Maxwell branches"
    if body.get("loss") and body.get("loss_model") == "flat":
        viscosities += ", tan δ = {:g} from {:g} to {:g} Hz".format(
            body["loss"], *body["loss_range"]
        )
    yields = "".join(
        f", {sign} = {1e-6 * body[name]:g} MPa"
        for name, sign in (("yield_stress", "σ_y"), ("hardening", "H"))
        if body.get(name)
    )
    law = LAWS.get(body["law"], body["law"])
    return f"{law}{own}, E = {1e-6 * body['young']:g} MPa, ν = {body['nu']:g}, ρ = {body['density']:g} kg/m³{yields}{viscosities}"


def as_written(text: str) -> str:
    """Returns a user's text as matplotlib shows it literally: dollar signs start no formula, and
    blanks replace control characters.
    """
    return "".join(letter if letter.isprintable() else " " for letter in text).replace("$", r"\$")


def per_metre(scene: Table) -> str:
    """Returns the suffix for the units of forces and energies of a scene."""
    return dimension.per_metre(scene.get("script", ""))


def contact_bounds(summary: Table) -> tuple[float, float] | None:
    """Returns the begin and the end of the contact [s], both interpolated within their steps.
    Returns None without contact or if the contact has not ended.
    """
    if summary.get("contact_time") is None or summary.get("contact_start") is None:
        return None
    return summary["contact_start"], summary["contact_start"] + summary["contact_time"]


def over_time(panels: list[Axes], history: dict[str, np.ndarray], scene: Table) -> None:
    """Sets the limits of the time axis [ms]. It begins at 0, unless the run begins with a long
    flight. A dotted line marks the end of the contact if the run continues after it for longer than
    the longest pause between two contacts. The legend of the first panel lists this line.
    """
    t, touches = 1e3 * history["t"], history["normal_force"] > 0
    last = 1e3 * scene["touched"][1] if scene.get("touched") else t[-1]
    for axes in panels:
        axes.set_xlim(0 if t[0] < 0.05 * t[-1] else t[0] - 0.02 * np.ptp(t), t[-1])
        if t[-1] - last > np.diff(t[touches]).max(initial=0.0):
            axes.axvline(
                last,
                color=BLACK,
                linestyle=":",
                linewidth=0.8,
                label=f"end of the contact, {last:.4g} ms" if axes is panels[0] else None,
            )


def numbers_of_the_paper(
    scene: Table, key: str, over: str
) -> list[tuple[Value | None, float, str]]:
    """Returns all numbers `key` (as in summary.json, SI) that the paper prints for this scene with
    any value of the parameter `over`: (value of `over`, number, words).
    """
    return [
        (run["when"].get(over), run["numbers"][key]["value"], run["source"])
        for run in literature.published(scene, (over,))
        if run["source"].startswith("paper") and key in run["numbers"]
    ]


def legend(axes: Axes, shown: Callable[[list[Any]], list[Any]] = list, **how: Any) -> None:
    """Draws the legend of a panel. `shown` selects from the lists of artists and names. Without
    named artists there is no legend.
    """
    artists, names = axes.get_legend_handles_labels()
    if names:
        axes.legend(shown(artists), shown(names), **how)


def balance_error(axes: Axes, history: dict[str, np.ndarray], energy: float) -> None:
    """Draws the error of the energy balance over time [ms], relative to `energy` [J/m]."""
    error = np.abs(history["balance"]) / energy
    axes.semilogy(
        1e3 * history["t"], np.where(error > 0, error, np.nan), color=BLACK, linewidth=0.9
    )
    axes.yaxis.set_major_formatter(
        lambda value, _: "10" + f"{np.log10(value):.0f}".translate(RAISED)
    )
    axes.yaxis.set_minor_locator(NullLocator())


def peak_suffix(values: np.ndarray, largest: float) -> str:
    """Returns a suffix for the name of a curve that is hardly distinguishable from 0: its largest
    absolute value. Otherwise it is empty.
    """
    peak = np.abs(values).max()
    return f" (up to {float(f'{peak:.1g}'):g})" if 0 < peak < 0.01 * largest else ""


def end_of_contact(panels: list[Axes], history: dict[str, np.ndarray], scene: Table) -> None:
    """Sets up the time axes of panels. The end of the contact is listed above the first panel."""
    over_time(panels, history, scene)
    legend(panels[0], **ABOVE, ncols=2)


def friction_force(history: dict[str, np.ndarray], scene: Table) -> Figure:
    """Draws normal and friction force [kN/m] over time (figure 5). If stick and slip alternate, a
    second column enlarges the interval in which they alternate most.

    The broken lines are the friction coefficients times the normal force. If all points of a body
    slide in the same direction, the friction force lies on the line of the dynamic coefficient.
    """
    t, per = 1e3 * force_times(history, scene.get("integrator")), per_metre(scene)
    normal, friction = 1e-3 * history["normal_force"], 1e-3 * history["friction_force"]
    window = _liveliest(history)
    figure, grid = plt.subplots(
        2,
        2 if window else 1,
        figsize=(8.4 if window else 5.6, 5.2),
        sharex="col",
        squeeze=False,
        height_ratios=[1, 1.4],
        width_ratios=[1.6, 1] if window else None,
    )
    force, drag = grid[:, 0]
    force.plot(t, normal, color=BLUE)
    force.set(ylabel=f"normal force [kN{per}]", ylim=(0, None))
    signs = [sign for sign in (-1, 1) if (sign * friction).max() > 0.05 * np.abs(friction).max()]
    for axes in grid[1]:
        axes.axhline(0, color=GREY, linewidth=0.6)
        for name, line in (("friction_static", (0, (1, 1.5))), ("friction_dynamic", (0, (4, 2)))):
            for sign in signs:
                axes.plot(
                    t,
                    sign * scene[name] * normal,
                    color=BLACK,
                    linestyle=line,
                    linewidth=0.8,
                    label=f"{name.partition('_')[2]} limit, {scene[name]:g} of the normal force"
                    if sign == signs[0]
                    else None,
                )
        axes.set_xlabel("time [ms]")
    drag.plot(t, friction, color=ORANGE, linewidth=1.2)
    drag.set_ylabel(f"friction force [kN{per}]")
    legend(drag, **ABOVE, ncols=2)
    end_of_contact([force, drag], history, scene)
    if window:
        _enlarge(grid, history, scene, window)
    return figure


def _enlarge(
    grid: np.ndarray,
    history: dict[str, np.ndarray],
    scene: Table,
    window: tuple[int, int],
) -> None:
    """Draws the right panels of figure 5 in the interval `window` of rows, which is marked in the
    left panels: the fraction of the load that slides, and the friction force [kN/m].
    """
    t, friction = (
        1e3 * force_times(history, scene.get("integrator")),
        1e-3 * history["friction_force"],
    )
    first, last = window
    inside, (share, zoom) = slice(first, last + 1), grid[:, 1]
    for axes in grid[:, 0]:
        axes.axvspan(t[first], t[last], color=BAND, alpha=0.6, linewidth=0, zorder=0)
    share.step(
        1e3 * history["t"],
        100 * history["sliding_fraction"],
        where="pre",
        color=PURPLE,
        linewidth=1.0,
    )
    share.set(
        title="grey on the left, enlarged",
        ylabel="load that slides [%]",
        xlim=(t[first], t[last]),
        ylim=(0, 1.08 * max(1.0, 100 * history["sliding_fraction"][inside].max())),
    )
    zoom.plot(t, friction, color=ORANGE, linewidth=1.0, marker=".", markersize=3)
    # The range includes the friction limits on the same side of zero as the force.
    lines = [
        line.get_ydata()[inside] for line in grid[1, 0].lines if len(line.get_ydata()) == len(t)
    ]
    near = np.concatenate(
        [
            friction[inside],
            *(values for values in lines if values.mean() * friction[inside].mean() > 0),
        ]
    )
    margin = 0.15 * (np.ptp(near) or abs(near[0]) or 1.0)
    zoom.set(
        ylabel=f"friction force [kN{per_metre(scene)}]",
        ylim=(near.min() - margin, near.max() + margin),
    )


def _liveliest(history: dict[str, np.ndarray]) -> tuple[int, int] | None:
    """Returns the first and last row of the interval in which the sliding fraction of the load,
    weighted with the load, goes up and down most. The interval has the length of a twelfth of the
    contact, or of a third of its longest interval if that is less. Returns None if the variation is
    less than a twentieth of the largest load.
    """
    touching = np.flatnonzero(history["normal_force"] > 0)
    t, force = history["t"], history["normal_force"]
    intervals = np.split(touching, np.flatnonzero(np.diff(touching) > 1) + 1)
    width = min(
        (t[touching[-1]] - t[touching[0]]) / 12,
        max(t[interval[-1]] - t[interval[0]] for interval in intervals) / 3,
    )
    change = np.diff(history["sliding_fraction"]) * np.minimum(force[1:], force[:-1])
    up, travelled = (
        np.concatenate([[0], np.cumsum(values)]) for values in (change, np.abs(change))
    )
    ends = np.minimum(np.searchsorted(t, t + width), len(t) - 1)
    lively = travelled[ends] - travelled - np.abs(up[ends] - up)  # total variation minus net change
    idle = np.cumsum(force == 0)
    lively = np.where(idle[ends] > idle, -1.0, lively)  # excludes intervals with free flight
    first = int(np.argmax(lively))
    return (
        (first, int(ends[first]))
        if lively[first] > 0.05 * force.max() and ends[first] > first
        else None
    )


def rolling(history: dict[str, np.ndarray], scene: Table) -> Figure:
    """Draws the velocities of the centre and of the rim [m/s], which are equal in rolling, and the
    fractions of the load that stick and slide. For a disc that starts on the plane it adds the
    velocities of a rigid disc.
    """
    t = 1e3 * history["t"]
    figure, (top, bottom) = plt.subplots(2, sharex=True, figsize=(5.6, 4.6), height_ratios=[1.6, 1])
    top.axhline(0, color=GREY, linewidth=0.6)
    if rigid := rigid_rolling(history["t"], scene):
        for values, label in zip(rigid, ("rigid disc", None)):
            top.plot(t, values, color=BLACK, linestyle="--", linewidth=0.9, label=label)
    top.plot(t, history["vx"], color=BLUE, label="centre, along x")
    top.plot(t, -scene["radius"] * history["spin"], color=ORANGE, label="rim, −ωR")
    top.set_ylabel("velocity [m/s]")
    touches = history["normal_force"] > 0
    shares = {
        "sticks": (1 - history["sliding_fraction"], STICKS),
        "slides": (history["sliding_fraction"], ORANGE),
    }
    floor = np.zeros(len(t))
    for label, (values, colour) in shares.items():
        values = np.where(touches, 100 * values, 0)
        bottom.fill_between(
            t, floor, floor + values, step="pre", color=colour, linewidth=0, label=label
        )
        floor = floor + values
    bottom.fill_between(
        t,
        0,
        np.where(touches, 0, 100),
        step="pre",
        color="#f2f2f2",
        linewidth=0,
        label="no contact",
    )
    bottom.set(xlabel="time [ms]", ylabel="share of the load [%]", ylim=(0, 100))
    legend(bottom, **ABOVE | {"handlelength": 1.0}, ncols=4, handleheight=1.0)
    over_time([top, bottom], history, scene)
    legend(top, **ABOVE, ncols=4)
    return figure


def rigid_rolling(t: np.ndarray, scene: Table) -> tuple[np.ndarray, np.ndarray] | None:
    """Returns v_x and -omega R [m/s], each (steps,), of a rigid disc that slides until both
    velocities are equal and then rolls.

    Returns None if the disc does not start on the plane or if forces other than gravity act. With
    initial velocity v0 and no spin, it slides with v0 - mu_d g t and rolls from t = v0/(3 mu_d g)
    on with 2/3 v0.
    """

    def value(name: str) -> float:
        return float(scene.get(name, 0))

    pull = value("friction_dynamic") * value("gravity")
    if (
        pull <= 0
        or value("angle") != 0
        or any(map(value, ("height", "body_force_x", "body_force_y")))
    ):
        return None
    slip = scene["speed"] + value("spin") * scene["radius"]
    gained = np.sign(slip) * pull * np.minimum(t, abs(slip) / (3 * pull))
    return scene["speed"] - gained, 2 * gained - value("spin") * scene["radius"]


@dataclass(frozen=True)
class Pose:
    """Position and shape of the body at time t [s]: centre of mass (2,), closed outline (n, 2) and
    a material diameter (m, 2), all in m. The first point of the diameter is marked.
    """

    t: float
    centre: np.ndarray
    outline: np.ndarray
    diameter: np.ndarray


def is_oblique(history: dict[str, np.ndarray], scene: Table) -> bool:
    """Returns whether the body moves along the plane or rotates, so that its path is more
    informative than its shapes.
    """
    along = max(np.abs(history["vx"]).max(), scene["radius"] * np.abs(history["spin"]).max())
    return bool(along > 1e-3 * max(np.abs(history["vy"]).max(), along))


def flight(
    history: dict[str, np.ndarray], scene: Table, series: list[tuple[float, Path]]
) -> Figure:
    """Draws the path of the centre of the body and the body at some instants (figure 4b). A
    material diameter shows the rotation.

    A run begins at the onset of contact and ends soon after the contact. Before and after it the
    motion is continued as that of a rigid body (parabola, constant spin); this part is dashed and
    labelled.
    """

    def row(t: float) -> int:
        return int(np.argmin(np.abs(history["t"] - t)))

    impact = history["vy"][0] < 0 or scene.get("height", 0) > 0
    picked: list[tuple[tuple[float, Path], str, Any]]  # with the colour
    if impact:
        lowest = min(series, key=lambda state: history["y"][row(state[0])])
        picked = [
            (series[0], "touch", BLUE),
            (lowest, "lowest", ORANGE),
            (series[-1], "end of the run", GREEN),
        ]
    else:
        places = evenly(range(len(series)), 5)
        picked = [(series[k], "", plt.get_cmap("viridis")(0.85 * k / places[-1])) for k in places]
    figure, axes = plt.subplots(figsize=(6.4, 5.6 if impact else 3.6))
    run = history["t"] >= series[0][0]
    axes.plot(
        history["x"][run], history["y"][run], color=BLACK, linewidth=1.0, label="centre of mass"
    )
    poses = [pose_at(t, path, history) for (t, path), _, _ in picked]
    for pose, (_, name, colour) in zip(poses, picked):
        _draw_pose(axes, pose, colour, "-", f"{name}, {1e3 * pose.t:.2f} ms" if name else None)
        if not name:
            axes.text(
                pose.centre[0],
                pose.outline[:, 1].max(),
                f"{1e3 * pose.t:.0f} ms",
                color=colour,
                ha="center",
                va="bottom",
            )
    room = 0.0
    if impact:
        _draw_flight(axes, poses[0], -1, row(poses[0].t), history, scene, BLUE)
        axes.plot(
            [], [], color=BLUE, linestyle=DASHED, label="continued as rigid motion, shape frozen"
        )
        # The body has left the plane.
        if history["normal_force"][-1] == 0 and history["vy"][-1] > 0:
            _draw_flight(axes, poses[-1], 1, -1, history, scene, GREEN)
            at, ahead = row(poses[0].t), np.sign(history["vx"][0]) or 1.0
            before, after = (
                np.degrees(np.arctan2(abs(history["vy"][k]), ahead * history["vx"][k]))
                for k in (at, -1)
            )
            axes.set_title(
                f"angle to the plane: {before:.1f}° before, {after:.1f}° after"
                + " (backwards)" * bool(after > 90.05)
            )
        room = 1.2 * scene["radius"]  # space for the times beside the outlines
    x_min, x_max = axes.get_xlim()
    high = axes.get_ylim()[1] + (0 if impact else 0.2 * scene["radius"])
    axes.axhline(0, color=BLACK, linewidth=0.8)
    axes.axhspan(-0.3 * scene["radius"], 0, color="#d0d0d0", linewidth=0)
    axes.set(
        xlim=(x_min - room, x_max + room),
        ylim=(-0.3 * scene["radius"], high),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
    )
    legend(axes, **BELOW, ncols=2, handlelength=1.8)
    return figure


def _draw_flight(
    axes: Axes,
    pose: Pose,
    sign: int,
    row: int,
    history: dict[str, np.ndarray],
    scene: Table,
    colour: str,
) -> None:
    """Draws two outlines after (`sign` 1) or before (`sign` -1) the pose, in rigid motion with the
    velocities in `row` of the history.
    """
    # The distance between the outlines is one and a half diameters.
    pause = 3 * scene["radius"] / np.hypot(history["vx"][row], history["vy"][row])
    if sign < 0 and scene.get("height", 0) > 0:
        pause = min(pause, pose.t / 2)  # avoids times before the start
    for k in (1, 2):
        moved = flown(pose, sign * k * pause, row, history, scene)
        _draw_pose(axes, moved, colour, DASHED, None)
        axes.annotate(
            f"{1e3 * moved.t:.1f} ms".replace("-", "−"),
            moved.outline[np.argmax(sign * moved.outline[:, 0])],
            (3 * sign, 0),
            textcoords="offset points",
            color=colour,
            ha="left" if sign > 0 else "right",
            va="center",
        )
    waits = np.linspace(0, 2 * sign * pause, 50)
    centres = np.array([flown(pose, wait, row, history, scene).centre for wait in waits])
    axes.plot(*centres.T, color=BLACK, linewidth=0.8, linestyle=":")


def pose_at(t: float, path: Path, history: dict[str, np.ndarray]) -> Pose:
    """Returns the deformed outline of a snapshot of a whole disc and its deformed diameter that is
    vertical in the reference configuration. The mark is at the top.
    """
    snapshot = vtu.read(path)
    moved = snapshot.points + snapshot.fields["displacement"][:, :2]
    following = dict(mesh.boundary(snapshot.triangles).tolist())
    loop = [next(iter(following))]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
    centre = np.array([np.interp(t, history["t"], history[name]) for name in ("x", "y")])
    return Pose(t, centre, moved[loop + loop[:1]], diameter(snapshot))


def diameter(snapshot: vtu.Snapshot) -> np.ndarray:
    """Returns the deformed positions (m, 2) [m] of the material diameter of a whole body that is
    vertical in the reference configuration, from top to bottom.
    """
    low, high = snapshot.points.min(axis=0), snapshot.points.max(axis=0)
    x = np.full(41, (low[0] + high[0]) / 2)
    y = np.linspace(high[1], low[1], 43)[1:-1]  # without the end points: the outline is a polygon
    grid = Triangulation(snapshot.points[:, 0], snapshot.points[:, 1], snapshot.triangles)
    moved = snapshot.points + snapshot.fields["displacement"][:, :2]
    # Points outside the mesh are masked.
    columns = [LinearTriInterpolator(grid, values)(x, y).compressed() for values in moved.T]
    return np.stack(columns, axis=1)


def flown(pose: Pose, wait: float, row: int, history: dict[str, np.ndarray], scene: Table) -> Pose:
    """Returns the pose after another `wait` seconds (before, if negative) of rigid flight with the
    velocities in `row` of the history.
    """
    velocity = np.array([history["vx"][row], history["vy"][row]])
    pull = np.array(
        [scene.get("body_force_x", 0), scene.get("body_force_y", 0) - scene.get("gravity", 0)]
    )
    turn = rotation(history["spin"][row] * wait)
    centre = pose.centre + velocity * wait + pull * wait**2 / 2
    outline, diameter = (
        (points - pose.centre) @ turn.T + centre for points in (pose.outline, pose.diameter)
    )
    return Pose(pose.t + wait, centre, outline, diameter)


def _draw_pose(axes: Axes, pose: Pose, colour: Any, line: Any, label: str | None) -> None:
    axes.plot(*pose.outline.T, color=colour, linestyle=line, linewidth=1.1, label=label)
    axes.plot(*pose.diameter.T, color=colour, linewidth=0.7)
    axes.plot(*pose.diameter[0], color=colour, marker="o", markersize=4)


def evenly(items: Sequence[T], limit: int) -> list[T]:
    """Returns up to `limit` of the items, evenly spaced from the first to the last."""
    return [items[k] for k in np.unique(np.linspace(0, len(items) - 1, limit).round().astype(int))]


def rows_of_bodies(
    bodies: list["Body"],
    times: list[float],
    view: tuple[float, float, float, float],
    columns: int,
    behind: Callable[[Axes, list[float], list[np.ndarray]], None],
    label: str,
) -> Figure:
    """Draws the bodies in rows, each at its time [s] within the limits `view` [m]. The function
    behind(axes, times, places) draws the background. The bodies are coloured by their stress, with
    `label` at the colour bar. All share one panel, because drawing a panel takes as long as drawing
    a body.
    """
    x_min, x_max, y_min, y_max = view
    rows, inch = -(-len(bodies) // columns), (x_max - x_min) * columns / 6.5  # [m] per inch
    step = np.array([x_max - x_min + 0.1 * inch, y_max - y_min + 0.3 * inch])
    figure, axes = plt.subplots(figsize=(7.5, rows * step[1] / inch + 0.4), subplot_kw=BARE)
    axes.set_axis_off()
    axes.set(
        xlim=(x_min, x_max + (columns - 1) * step[0]),
        ylim=(y_min - (rows - 1) * step[1], y_min + step[1]),
        aspect="equal",
    )
    ends = colour_limits(bodies)
    places = [step * (k % columns, -(k // columns)) for k in range(len(bodies))]
    behind(axes, times, places)
    for body, t, shift in zip(bodies, times, places):
        picture = draw_body(axes, body, ends, shift)
        draw_interfaces(axes, body, shift)
        x, y = shift + ((x_min + x_max) / 2, y_max)
        axes.text(x, y, f"{1e3 * t:.2f} ms", ha="center", va="bottom")
    scale_bar(axes, 0.25 / columns)
    figure.colorbar(
        picture,
        cax=axes.inset_axes((1.03, 0.15, 0.025, 0.7)),
        label=label,
        extend="both" if ends[0] < 0 else "max",
    )
    return figure


def colour_limits(bodies: Sequence["Body"]) -> tuple[float, float]:
    """Returns the ends of the colour scale: the 0.5 % and 99.5 % quantiles of all nodes and 0, so that
    a single spot does not dominate it.
    """
    low, high = np.quantile(np.concatenate([body.stress for body in bodies]), [0.005, 0.995])
    return min(0.0, float(low)), float(high) or 1.0


def scale_bar(axes: Axes, share: float = 0.25) -> None:
    """Draws a scale bar below axes in m without ticks. Its length is 1, 2 or 5 times a power of ten
    and at most `share` of the width.
    """
    x_min, x_max = axes.get_xlim()
    longest = share * (x_max - x_min)
    size = max(
        length
        for digit in (1, 2, 5)
        if (length := digit * 10.0 ** np.floor(np.log10(longest))) <= longest
    )
    # x in m, y in typographic points: nine points below the axes.
    below = axes.get_xaxis_transform() + ScaledTranslation(0, -9 / 72, axes.figure.dpi_scale_trans)
    axes.plot(
        [x_min, x_min + size],
        [0, 0],
        color=BLACK,
        linewidth=2.0,
        solid_capstyle="butt",
        transform=below,
        clip_on=False,
    )
    factor, unit = (1e6, "μm") if size < 1e-3 else (1e3, "mm") if size < 1 else (1, "m")
    axes.text(
        x_min + size + share / 16 * (x_max - x_min),
        0,
        f"{factor * size:.3g} {unit}",
        fontsize=SMALL,
        ha="left",
        va="center",
        transform=below,
    )
    axes.set_xlim(x_min, x_max)


@dataclass(frozen=True)
class Body:
    """The whole deformed body: points (n, 2) in m, triangles (t, 3), and the field (n,) that colours
    it: von Mises stress in MPa, or another (UNITS). `interfaces` (e, 2) are sides between layers.
    """

    points: np.ndarray
    triangles: np.ndarray
    stress: np.ndarray
    interfaces: np.ndarray = dataclass_field(default_factory=lambda: vtu.NO_SIDES)


def is_half(scene: Table) -> bool:
    """Returns whether only the part to the right of the axis was computed: half of the body or of
    its meridian plane, or a quarter of a body in three dimensions.
    """
    script = scene.get("script", "")
    part = "quarter" if script == dimension.SOLID.script else "half"
    return scene.get("symmetry") == part or script == dimension.AXISYMMETRIC.script


def deformed(snapshot: vtu.Snapshot, half: bool, field: str = "von_mises") -> Body:
    """Returns the deformed body of a snapshot. If half of the body was computed, its mirror image
    at the left end, the axis, is added.
    """
    points = snapshot.points + snapshot.fields["displacement"][:, :2]
    triangles, stress = snapshot.triangles, snapshot.fields[field]
    between = snapshot.interfaces
    stress = np.linalg.norm(stress, axis=1) if stress.ndim > 1 else stress
    stress = stress if field in UNITS else 1e-6 * stress
    if half:
        triangles = np.vstack([triangles, triangles + len(points)])
        between = np.vstack([between, between + len(points)])
        points, stress = (
            np.vstack([points, points * (-1, 1) + (2 * snapshot.points[:, 0].min(), 0)]),
            np.concatenate([stress, stress]),
        )
    return Body(points, triangles, stress, between)


def draw_body(
    axes: Axes, body: Body, ends: tuple[float, float], shift: np.ndarray = ORIGIN
) -> TriMesh:
    """Draws the body, shifted by `shift` [m], and coloured by its stress on a scale with the given
    `ends` [MPa].
    """
    x, y = (body.points + shift).T
    picture: TriMesh = axes.tripcolor(
        Triangulation(x, y, body.triangles),
        body.stress,
        shading="gouraud",
        cmap="viridis",
        clim=ends,
    )
    picture.set_in_layout(False)
    return picture


def draw_interfaces(axes: Axes, body: Body, shift: np.ndarray = ORIGIN) -> LineCollection:
    """Draws the sides between layers of the body, shifted by `shift` [m]."""
    ends = (body.points + shift)[body.interfaces]
    outlined = [withStroke(linewidth=1.4, foreground=BLACK)]
    lines = LineCollection(list(ends), colors="white", linewidths=0.6, path_effects=outlined)
    if len(ends):
        axes.add_collection(lines, autolim=False)
    return lines
