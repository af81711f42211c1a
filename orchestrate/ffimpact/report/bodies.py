"""Figures of a run: energies of each body and of all bodies (figures 6a, 9a, 9b of the paper),
velocities, forces, and the deformed shapes with the obstacles.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.transforms import AffineDeltaTransform

from ..input import dimension, models
from ..input.obstacles import Obstacle
from ..input.parameters import Table
from ..output import vtu
from ..output.materials import layer_name
from ..output.results import Contents, body_names, force_times, mechanical_energy, suffixes
from .figures import (
    BAND,
    BLACK,
    BLUE,
    GREEN,
    GREY,
    MEAN_PRESSURE,
    ORANGE,
    ORIGIN,
    PLASTIC_STRAIN,
    PURPLE,
    SHAPES,
    STRESS,
    VISCOUS,
    Body,
    as_written,
    balance_error,
    deformed,
    end_of_contact,
    evenly,
    flight,
    friction_force,
    is_half,
    is_oblique,
    legend,
    material,
    over_time,
    peak_suffix,
    per_metre,
    rolling,
    rows_of_bodies,
)
from .impact import impact_of

__all__ = [
    "columns_of",
    "down_the_slope",
    "draw_energies",
    "draw_obstacles",
    "ends",
    "energies",
    "forces",
    "limits",
    "made_of",
    "obstacles_of",
    "panels",
    "pictures",
    "shapes",
    "title",
    "velocities",
    "width",
]

T = TypeVar("T")

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, "#56b4e9", "#e69f00")  # of the bodies
ACROSS = 3  # largest number of panels side by side
# Of many bodies, titles and legends list this number of the first and of the last ones.
NAMED = 6
IN_TITLE = 2  # the same in titles
GRID = 200  # grid points along each side of a picture, at which the gap to obstacles is computed
DOTS = (0, (1, 1.5))
# Work: its name, its column, how it enters the sum that is constant, its sign there, its colour.
WORKS = (
    ("lost to friction", "friction_work", "+ lost", 1, "#d4a017"),
    ("lost to viscosity", "viscous_work", "+ lost", 1, VISCOUS),
    ("lost to plastic strain", "plastic_work", "+ lost", 1, "#7a5195"),
    ("lost to penalty damping", "penalty_damping_work", "+ lost", 1, "#0072b2"),
    ("external work", "external_work", "− work", -1, "#888888"),
)
ABOVE: dict[str, Any] = {
    "loc": "lower center",
    "bbox_to_anchor": (0.5, 1),
    "handlelength": 1.4,
    "columnspacing": 1.0,
}


def title(scene: Table) -> str:
    """Returns the title of the scene and the material of each body and layer."""
    materials: dict[str, list[str]] = {}
    for body in scene["body"]:
        materials.setdefault(material(body), []).append(body["name"])
        for k, layer in enumerate(body.get("layer", []), 1):
            name = f"{layer_name(layer, k)} of {body['name']}"
            materials.setdefault(material(layer), []).append(name)
    return "\n".join([as_written(scene["title"]), *made_of(materials)])


def made_of(materials: Mapping[str, list[str]]) -> list[str]:
    """Returns a line for each material with the names of what is made of it; of many the first and
    the last.
    """
    kinds = [
        f"{', '.join(ends(names, '...', IN_TITLE))}: {words}" for words, names in materials.items()
    ]
    return ends(kinds, "...", IN_TITLE)


def ends(items: list[T], between: T | None = None, count: int = NAMED) -> list[T]:
    """Returns the first and the last `count` of many items, with `between` instead of the others if
    it is not None. Few items are returned unchanged.
    """
    return (
        items
        if len(items) <= 2 * count
        else [*items[:count], *([] if between is None else [between]), *items[-count:]]
    )


def pictures(
    history: dict[str, np.ndarray],
    contact: dict[str, np.ndarray],
    scene: Table,
    snapshots: list[tuple[float, Path]],
) -> dict[str, Callable[[], Figure]]:
    """Returns the functions that draw the pictures of a run, by name. `contact` is the part of the
    history from the onset of contact on.
    """
    impact = impact_of(scene)
    drawn: dict[str, Callable[[], Figure]] = {
        "energies": lambda: energies(contact, scene),
        "velocity": lambda: velocities(contact, scene),
        "force": lambda: forces(contact, scene),
    }
    if impact and history["friction_force"].any():
        drawn["force"] = lambda: friction_force(contact, impact)
        drawn["rolling"] = lambda: rolling(contact, impact)
    # There are no triangles if no body crosses the plane z = 0.
    if snapshots and len(vtu.read(snapshots[0][1]).triangles):
        drawn["shapes"] = lambda: shapes(snapshots, scene, "von_mises", STRESS)
        if "plastic_work" in history:
            drawn["plastic"] = lambda: shapes(snapshots, scene, "plastic_strain", PLASTIC_STRAIN)
        elif "hydrostatic_pressure" in history:
            drawn["pressure"] = lambda: shapes(snapshots, scene, "pressure", MEAN_PRESSURE)
    if len(snapshots) > 2 and impact and not is_half(scene) and is_oblique(history, impact):
        drawn["flight"] = lambda: flight(history, impact, snapshots)
    return drawn


def width(body: int) -> float:
    """Returns the line width for a body (counted from 0). It decreases from body to body, so that
    overlapping lines remain visible.
    """
    return max(1.0, 2.0 - 0.4 * body)


def panels(count: int, height: float = 2.4) -> tuple[Figure, list[Axes]]:
    """Returns a figure with `count` panels over the same time [ms]."""
    columns = min(count, 2 if count == 4 else ACROSS)
    rows = -(-count // columns)
    figure, grid = plt.subplots(
        rows,
        columns,
        figsize=(max(5.2, 3.0 * columns), height * rows + 0.5),
        squeeze=False,
        sharex=True,
    )
    for axes in grid.flat[count:]:
        axes.set_axis_off()
    for axes in grid.flat[:count]:
        axes.margins(x=0)
    for axes in grid.flat[max(0, count - columns) : count]:
        axes.set_xlabel("time [ms]")
        axes.tick_params(labelbottom=True)
    return figure, list(grid.flat[:count])


def columns_of(history: dict[str, np.ndarray], scene: Table) -> dict[str, str]:
    """Maps the name of each body to the suffix of its columns in the history."""
    return dict(zip(body_names(scene), suffixes(history)))


def energies(history: dict[str, np.ndarray], scene: Table) -> Figure:
    """Draws energies [J/m] over time. Each of several bodies has a panel. One panel shows all
    (draw_energies), the last one the error of their balance.
    """
    t, bodies = 1e3 * history["t"], columns_of(history, scene)
    if several := len(bodies) > 1:
        figure, (*own, together, balance) = panels(len(bodies) + 2)
    else:
        figure, (*own, together, balance) = plt.subplots(
            2, sharex=True, figsize=(5.6, 4.6), height_ratios=[3, 1]
        )
        balance.set_xlabel("time [ms]")
    for axes, (name, suffix), colour in zip(own, bodies.items(), COLOURS * len(bodies)):
        kinetic, elastic = history[f"kinetic{suffix}"], history[f"elastic{suffix}"]
        axes.plot(t, kinetic + elastic, color=colour, label=name)
        axes.plot(t, kinetic, color=colour, linestyle="--", linewidth=1.0, label="kinetic")
        axes.plot(t, elastic, color=colour, linestyle=DOTS, linewidth=1.0, label="elastic")
    largest = draw_energies(together, history, bodies if several else {})
    for axes in (*own, together):
        axes.axhline(0, color=GREY, linewidth=0.6)
        axes.set_ylabel(f"energy [J{per_metre(scene)}]")
    over_time([together, balance, *own], history, scene)
    for axes in (*own, together):
        legend(axes, ends, **ABOVE, ncols=2 if axes is together and 1 < len(bodies) < 4 else 3)
    # The error is relative to the largest of all energies. The total alone can vanish, for example
    # for bodies at rest under gravity.
    balance_error(balance, history, largest or 1.0)
    balance.set_ylabel("|balance| /\nlargest energy")
    return figure


def draw_energies(
    axes: Axes, history: Mapping[str, np.ndarray], bodies: Mapping[str, str]
) -> float:
    """Draws into `axes` the energies over time [ms]: those of the `bodies` (suffixes of their
    columns by name), or without these all kinetic and all elastic energy; the contact energy, which
    belongs to no body; and the work of friction, viscosity and external forces, so that the dashed
    sum is constant. Returns the largest energy.
    """
    t, kinetic, elastic = 1e3 * history["t"], history["kinetic"], history["elastic"]
    for body, ((name, suffix), colour) in enumerate(zip(bodies.items(), COLOURS * len(bodies))):
        own = history[f"kinetic{suffix}"] + history[f"elastic{suffix}"]
        axes.plot(t, own, color=colour, linewidth=width(body), label=name)
    total, words = mechanical_energy(history), "total"
    lines = {} if bodies else {"kinetic": (kinetic, BLUE), "elastic": (elastic, ORANGE)}
    lines["contact"] = history["contact"], "#56b4e9"
    for name, column, words_of_it, sign, colour in WORKS:
        if np.any(history.get(column, 0)):
            lines[name] = history[column], colour
            total, words = (
                total + sign * history[column],
                words if words.endswith(words_of_it) else f"{words} {words_of_it}",
            )
    drawn = [values for values, _ in lines.values()]
    largest = max(float(np.abs(values).max()) for values in (total, kinetic, elastic, *drawn))
    if words != "total":
        axes.plot(t, mechanical_energy(history), color=BAND, linewidth=4.5, zorder=1, label="total")
    # The line width decreases, so that overlapping lines remain visible.
    for k, (name, (values, colour)) in enumerate(lines.items(), 2 if bodies else 0):
        label = name + peak_suffix(values, largest)
        axes.plot(t, values, color=colour, linewidth=2.6 - 0.4 * k, label=label)
    axes.plot(t, total, color=BLACK, linestyle="--", linewidth=1.0, label=words)
    return largest


def velocities(history: dict[str, np.ndarray], scene: Table) -> Figure:
    """Draws the velocities of the centres of mass [m/s] and the spins [rad/s]: one panel for each
    component that is not zero, one line for each body.
    """
    bodies = columns_of(history, scene)
    components = {
        **{f"v{axis}": f"velocity along {axis} [m/s]" for axis in "xyz"},
        "spin_x": "spin about x [rad/s]",
        "spin_y": "spin about y [rad/s]",
        "spin": "spin about z [rad/s]" if "spin_x" in history else "spin [rad/s]",
    }
    moving = [
        name
        for name in components
        if any(np.any(history.get(name + body_suffix, 0)) for body_suffix in bodies.values())
    ] or ["vy"]
    figure, grid = panels(len(moving), 2.8)
    for axes, name in zip(grid, moving):
        axes.axhline(0, color=GREY, linewidth=0.6)
        for body, ((called, suffix), colour) in enumerate(
            zip(bodies.items(), COLOURS * len(bodies))
        ):
            axes.plot(
                1e3 * history["t"],
                history[name + suffix],
                color=colour,
                linewidth=width(body) if len(bodies) > 1 else None,
                label=called if len(bodies) > 1 else None,
            )
        axes.set_ylabel(components[name])
    over_time(grid, history, scene)
    legend(grid[0], ends, **ABOVE, ncols=3)
    return figure


def forces(history: dict[str, np.ndarray], scene: Table) -> Figure:
    """Draws contact forces [kN/m] over time: the normal and friction forces of all contacts, and
    the components of the force on each of several bodies.
    """
    t, unit, bodies = (
        1e3 * force_times(history, scene.get("integrator")),
        f"[kN{per_metre(scene)}]",
        columns_of(history, scene),
    )
    lines = {f"normal force {unit}": {"": "normal_force"}}
    if history["friction_force"].any():
        lines[f"friction force {unit}"] = {"": "friction_force"}
    own = {
        f"force along {component} {unit}": {
            name: f"force_{component}{suffix}" for name, suffix in bodies.items()
        }
        for component in "xyz"
        if len(bodies) > 1
    }
    own = {
        words: columns
        for words, columns in own.items()
        if any(np.any(history.get(column, 0)) for column in columns.values())
    }
    # The normal force is then the same as the force on each body.
    if len(own) == 1 and len(bodies) == 2 and not obstacles_of(scene):
        lines = dict(list(lines.items())[1:])
    lines |= own
    figure, grid = panels(len(lines), 2.8)
    for axes, (words, columns) in zip(grid, lines.items()):
        axes.axhline(0, color=GREY, linewidth=0.6)
        for (name, column), colour in zip(
            columns.items(), COLOURS * len(columns) if len(columns) > 1 else (BLACK,)
        ):
            axes.plot(t, 1e-3 * history[column], color=colour, label=name or None)
        axes.set_ylabel(words)
    end_of_contact(grid, history, scene)
    # Without contact there are no panels for the forces on bodies.
    if len(columns) > 1:
        legend(grid[-1], ends, **ABOVE, ncols=3)
    return figure


# ---- shapes


def shapes(series: list[tuple[float, Path]], scene: Table, field: str, label: str) -> Figure:
    """Draws all bodies with the obstacles at up to SHAPES instants, coloured by a field [MPa]."""
    picked = evenly(series, SHAPES)
    bodies = [deformed(vtu.read(path), is_half(scene), field) for _, path in picked]
    rigid = obstacles_of(scene)
    x_min, x_max, y_min, y_max = view = down_the_slope(limits(bodies), rigid)
    columns = 3 if x_max - x_min < 3 * (y_max - y_min) else 2
    moves = any(obstacle.moves for obstacle in rigid)
    label += " in the plane z = 0" if scene["script"] == dimension.SOLID.script else ""

    def behind(axes: Axes, times: list[float], places: list[np.ndarray]) -> None:
        for t, at in zip(times, [[shift] for shift in places]) if moves else [(0.0, places)]:
            draw_obstacles(axes, rigid, view, t, at)

    return rows_of_bodies(
        bodies, [t for t, _ in picked], view, min(columns, len(bodies)), behind, label
    )


def obstacles_of(scene: Table) -> list[Obstacle]:
    """Returns the rigid obstacles of a scene as used. Their files are sought beside its scene.toml."""
    folder = scene.path.parent if isinstance(scene, Contents) else Path()
    return models.obstacles_of(scene, dimension.of_scene(scene), folder)


def limits(bodies: list[Body]) -> tuple[float, float, float, float]:
    """Returns the left, right, lower and upper end [m] of a picture that contains all bodies, with
    a margin.
    """
    low, high = (
        np.array([end(body.points, axis=0) for body in bodies]) for end in (np.min, np.max)
    )
    (x_min, y_min), (x_max, y_max) = low.min(axis=0), high.max(axis=0)
    margin = 0.06 * max(x_max - x_min, y_max - y_min)
    return x_min - margin, x_max + margin, y_min - margin, y_max + margin


def down_the_slope(
    view: tuple[float, float, float, float], rigid: list[Obstacle]
) -> tuple[float, float, float, float]:
    """Extends a view [m] downwards by up to half its height, until no surface of an obstacle
    crosses its lower end. Without this a slope would end within the picture.
    """
    x_min, x_max, y_min, y_max = view
    for lower in y_min - (y_max - y_min) * np.linspace(0, 0.5, 11) if rigid else ():
        edge = np.stack([np.linspace(x_min, x_max, GRID), np.full(GRID, lower)], axis=-1)
        gap = np.min([obstacle.gap_in_plane(edge, 0.0) for obstacle in rigid], axis=0)
        if gap.min() > 0 or gap.max() < 0:
            return x_min, x_max, lower, y_max
    return view


def draw_obstacles(
    axes: Axes,
    rigid: list[Obstacle],
    view: tuple[float, float, float, float],
    t: float,
    places: Sequence[np.ndarray] = (ORIGIN,),
) -> list[ContourSet]:
    """Draws the obstacles at time t [s] in grey within the limits `view` [m], once for each shift
    in `places` [m]. Returns the artists.
    """
    x_min, x_max, y_min, y_max = view
    if not rigid:
        return []
    count = 2 if [obstacle.kind for obstacle in rigid] == ["plane"] else GRID  # gap is linear
    x, y = np.linspace(x_min, x_max, count), np.linspace(y_min, y_max, count)
    points = np.stack(np.meshgrid(x, y), axis=-1)
    gap = np.min(
        [obstacle.gap_in_plane(points.reshape(-1, 2), t) for obstacle in rigid], axis=0
    ).reshape(points.shape[:2])
    if not gap.min() < 0 < gap.max():
        return []
    drawn: list[ContourSet] = [
        axes.contourf(x, y, gap, levels=[gap.min(), 0], colors=["#d0d0d0"]),
        axes.contour(x, y, gap, levels=[0], colors=[BLACK], linewidths=0.8),
    ]
    for artist in drawn:
        shift = AffineDeltaTransform(axes.transData)  # type: ignore[arg-type]  # takes a Transform
        artist.set(offsets=places, offset_transform=shift)
    return drawn
