"""Figures of a run: energies of each body and of all (figures 6a, 9a, 9b of the paper), velocities,
forces, and deformed shapes among the obstacles.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.transforms import AffineDeltaTransform

from ..input import dimension, models
from ..input.parameters import Value
from ..output import vtu
from ..output.results import body_names, mechanical_energy, suffixes
from ..scenes import obstacles
from ..scenes.obstacles import Obstacle
from .figures import (
    BAND,
    BLACK,
    BLUE,
    COLOURED,
    GREEN,
    GREY,
    ORANGE,
    ORIGIN,
    PURPLE,
    SHAPES,
    VISCOUS,
    Body,
    amid,
    as_written,
    balance_error,
    deformed,
    end_of_contact,
    evenly,
    flight,
    friction_force,
    goes_along,
    is_half,
    least,
    legend,
    material,
    over_time,
    per_metre,
    plt,
    rolling,
    side_by_side,
)

__all__ = [
    "are_several",
    "columns_of",
    "down_the_slope",
    "draw",
    "draw_obstacles",
    "ends",
    "energies",
    "forces",
    "limits",
    "obstacles_of",
    "panels",
    "shapes",
    "title",
    "velocities",
    "width",
]

ALONE = ("disc-plane", "ball-axisymmetric", "ball-plane")  # scripts of one body on the plane
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, "#56b4e9", "#e69f00")  # of bodies
ACROSS = 3  # panels side by side
NAMED = 6  # of many bodies the first and the last that titles and legends name
PLANE = Obstacle(
    "plane", "plane", (0.0, 0.0, 0.0, 0.0, 1.0, 0.0), np.zeros(3)
)  # y = 0, of a scene of one body
GRID = 200  # points along each side of a picture, at which obstacles are looked for
DOTS = (0, (1, 1.5))
ABOVE = {
    "loc": "lower center",
    "bbox_to_anchor": (0.5, 1),
    "handlelength": 1.4,
    "columnspacing": 1.0,
}


def are_several(scene: dict[str, Value]) -> bool:
    """Whether a scene, as used, has several bodies or obstacles of its own; else it is a body
    on the plane y = 0.
    """
    return "script" in scene and scene["script"] not in ALONE


def title(scene: dict[str, Value]) -> str:
    """Each body's material; of a disc on a block the speed."""
    if "body" not in scene:
        return f"disc on block: {material(scene)}, {scene['speed']:g} m/s"
    materials = {}
    for body in scene["body"]:
        materials.setdefault(material(body), []).append(body["name"])
    lines = [
        as_written(scene["title"]),
        *(f"{', '.join(ends(of, '...'))}: {words}" for words, of in materials.items()),
    ]
    return "\n".join(lines)


def ends(items: list, between=None) -> list:
    """The first and the last of many, `between` in the place of the others where it is given."""
    return (
        items
        if len(items) <= 2 * NAMED
        else [*items[:NAMED], *[between] * (between is not None), *items[-NAMED:]]
    )


def draw(
    history: dict[str, np.ndarray],
    contact: dict[str, np.ndarray],
    scene: dict[str, Value],
    snapshots: list[tuple[float, Path]],
) -> dict[str, plt.Figure]:
    """The figures by name; `contact` is the history from the first touch on."""
    rubs = not are_several(scene) and history["friction_force"].any()
    drawn = {"energies": energies(contact, scene), "velocity": velocities(contact, scene)}
    drawn |= (
        {"force": friction_force(contact, scene), "rolling": rolling(contact, scene)}
        if rubs
        else {"force": forces(contact, scene)}
    )
    if snapshots and len(
        vtu.read(snapshots[0][1]).triangles
    ):  # none where no body crosses the plane z = 0
        drawn |= {
            name: shapes(snapshots, scene, *field)
            for name, field in COLOURED.items()
            if name == "shapes" or "hydrostatic_pressure" in history
        }
    if (
        len(snapshots) > 2
        and not are_several(scene)
        and not is_half(scene)
        and goes_along(history, scene)
    ):
        drawn |= {"flight": flight(history, scene, snapshots)}
    return drawn


def width(body: int) -> float:
    """Of the line of a body (from 0): a little thinner from body to body, so that one under
    another is seen.
    """
    return max(1.0, 2.0 - 0.4 * body)


def panels(count: int, height: float = 2.4) -> tuple[plt.Figure, list[plt.Axes]]:
    """A figure of so many panels over the same time [ms]."""
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


def columns_of(history: dict[str, np.ndarray], scene: dict[str, Value]) -> dict[str, str]:
    """What stands behind the names of the columns of each body, by its name."""
    return dict(zip(body_names(scene), suffixes(history)))


def energies(history: dict[str, np.ndarray], scene: dict[str, Value]) -> plt.Figure:
    """Energies [J/m] over time: a panel each of several bodies; one of all, with the contact's,
    which belongs to no body, and the work that friction, viscosity and gravity take and give,
    so that the dashed sum is constant; the error of this balance.
    """
    t, unit, bodies = (
        1e3 * history["t"],
        f"energy [J{per_metre(scene)}]",
        columns_of(history, scene),
    )
    if several := len(bodies) > 1:
        figure, (*own, together, balance) = panels(len(bodies) + 2)
    else:
        figure, (*own, together, balance) = plt.subplots(
            2, sharex=True, figsize=(5.6, 4.6), height_ratios=[3, 1]
        )
        balance.set_xlabel("time [ms]")
    for body, (axes, (name, of), colour) in enumerate(
        zip(own, bodies.items(), COLOURS * len(bodies))
    ):
        kinetic, elastic = history[f"kinetic{of}"], history[f"elastic{of}"]
        axes.plot(t, kinetic + elastic, color=colour, label=name)
        axes.plot(t, kinetic, color=colour, linestyle="--", linewidth=1.0, label="kinetic")
        axes.plot(t, elastic, color=colour, linestyle=DOTS, linewidth=1.0, label="elastic")
        together.plot(t, kinetic + elastic, color=colour, linewidth=width(body), label=name)
    total, words = mechanical_energy(history), "total"
    lines = (
        {}
        if several
        else {"kinetic": (history["kinetic"], BLUE), "elastic": (history["elastic"], ORANGE)}
    )
    lines["contact"] = history["contact"], "#56b4e9"
    for name, column, words_of_it, sign, colour in (
        ("lost to friction", "friction_work", "+ lost", 1, "#d4a017"),
        ("lost to viscosity", "viscous_work", "+ lost", 1, VISCOUS),
        ("external work", "external_work", "− work", -1, "#888888"),
    ):
        if np.any(history.get(column, 0)):
            lines[name] = history[column], colour
            total, words = (
                total + sign * history[column],
                words if words.endswith(words_of_it) else f"{words} {words_of_it}",
            )
    largest = max(
        np.abs(values).max()
        for values in (
            total,
            *(values for values, _ in lines.values()),
            history["kinetic"],
            history["elastic"],
        )
    )
    if words != "total":
        together.plot(
            t, mechanical_energy(history), color=BAND, linewidth=4.5, zorder=1, label="total"
        )
    for k, (name, (values, colour)) in enumerate(
        lines.items()
    ):  # thinner and thinner, so that one on another is seen
        together.plot(
            t,
            values,
            color=colour,
            linewidth=2.6 - 0.4 * (k + 2 * several),
            label=name + least(values, largest),
        )
    together.plot(t, total, color=BLACK, linestyle="--", linewidth=1.0, label=words)
    for axes in (*own, together):
        axes.axhline(0, color=GREY, linewidth=0.6)
        axes.set_ylabel(unit)
    over_time([together, balance, *own], history, scene)
    for axes in (*own, together):
        legend(axes, ends, **ABOVE, ncols=2 if axes is together and 1 < len(bodies) < 4 else 3)
    balance_error(
        balance, history, largest or 1.0
    )  # not of the total alone: bodies at rest under gravity have none
    balance.set_ylabel("|balance| /\nlargest energy")
    return figure


def velocities(history: dict[str, np.ndarray], scene: dict[str, Value]) -> plt.Figure:
    """Velocities [m/s] of the centres of mass and spins [rad/s], a panel a component, a line a
    body.
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
        if any(np.any(history.get(name + of, 0)) for of in bodies.values())
    ] or ["vy"]
    figure, grid = panels(len(moving), 2.8)
    for axes, name in zip(grid, moving):
        axes.axhline(0, color=GREY, linewidth=0.6)
        for body, ((called, of), colour) in enumerate(zip(bodies.items(), COLOURS * len(bodies))):
            axes.plot(
                1e3 * history["t"],
                history[name + of],
                color=colour,
                linewidth=width(body) if len(bodies) > 1 else None,
                label=called if len(bodies) > 1 else None,
            )
        axes.set_ylabel(components[name])
    over_time(grid, history, scene)
    legend(grid[0], ends, **ABOVE, ncols=3)
    return figure


def forces(history: dict[str, np.ndarray], scene: dict[str, Value]) -> plt.Figure:
    """Contact forces [kN/m] over time: normal and friction forces of all contacts, and the
    components on each of several bodies.
    """
    t, unit, bodies = amid(history, scene), f"[kN{per_metre(scene)}]", columns_of(history, scene)
    lines = {f"normal force {unit}": {"": "normal_force"}}
    if history["friction_force"].any():
        lines[f"friction force {unit}"] = {"": "friction_force"}
    own = {
        f"force along {component} {unit}": {
            name: f"force_{component}{of}" for name, of in bodies.items()
        }
        for component in "xyz"
        if len(bodies) > 1
    }
    own = {
        words: columns
        for words, columns in own.items()
        if any(np.any(history.get(column, 0)) for column in columns.values())
    }
    if (
        len(own) == 1 and len(bodies) == 2 and not obstacles_of(scene)
    ):  # the normal force is then that on each
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
    if len(columns) > 1:  # no forces on bodies where nothing touched
        legend(grid[-1], ends, **ABOVE, ncols=3)
    return figure


# ---- shapes


def shapes(
    series: list[tuple[float, Path]], scene: dict[str, Value], field: str, label: str
) -> plt.Figure:
    """All bodies at up to SHAPES instants among the obstacles, coloured by a field [MPa]."""
    picked = evenly(series, SHAPES)
    found = [deformed(vtu.read(path), is_half(scene), field) for _, path in picked]
    rigid = obstacles_of(scene)
    left, right, low, high = view = down_the_slope(limits(found), rigid)
    columns = 3 if right - left < 3 * (high - low) else 2
    moves = any(one.velocity.any() for one in rigid)
    label += (
        " in the plane z = 0"
        if scene["script"] in (dimension.SOLID.script, *dimension.SOLID.cases)
        else ""
    )

    def behind(axes: plt.Axes, times: list[float], places: list[np.ndarray]) -> None:
        for t, at in zip(times, [[place] for place in places]) if moves else [(0.0, places)]:
            draw_obstacles(axes, rigid, view, t, at)

    return side_by_side(
        found, [t for t, _ in picked], view, min(columns, len(found)), behind, label
    )


def obstacles_of(scene: dict[str, Value]) -> list[Obstacle]:
    """The rigid obstacles of a scene as used."""
    if not are_several(scene):
        return [PLANE]
    of = dimension.of(scene)
    return obstacles.read(
        models.tables(scene, "obstacle", of), of, scene.get("end_time") or 0.0, Path()
    )


def limits(found: list[Body]) -> tuple[float, float, float, float]:
    """Left, right, lower and upper end [m] of a picture that has room for all bodies."""
    low, high = (np.array([end(body.points, axis=0) for body in found]) for end in (np.min, np.max))
    (left, bottom), (right, top) = low.min(axis=0), high.max(axis=0)
    margin = 0.06 * max(right - left, top - bottom)
    return left - margin, right + margin, bottom - margin, top + margin


def down_the_slope(
    view: tuple[float, float, float, float], rigid: list[Obstacle]
) -> tuple[float, float, float, float]:
    """A view [m] whose lower end, by up to half its height lower, no obstacle's surface
    crosses: else a slope would end in the picture.
    """
    left, right, low, high = view
    for lower in low - (high - low) * np.linspace(0, 0.5, 11) if rigid else ():
        edge = np.stack([np.linspace(left, right, GRID), np.full(GRID, lower)], axis=-1)
        gap = np.min([one.gap_in_plane(edge, 0.0) for one in rigid], axis=0)
        if gap.min() > 0 or gap.max() < 0:
            return left, right, lower, high
    return view


def draw_obstacles(
    axes: plt.Axes,
    rigid: list[Obstacle],
    view: tuple[float, float, float, float],
    t: float,
    places: Sequence[np.ndarray] = (ORIGIN,),
) -> list:
    """The obstacles where they are at time t [s], grey, within the limits `view` [m], drawn at
    places [m]; what was drawn.
    """
    left, right, low, high = view
    if not rigid:
        return []
    count = 2 if [one.kind for one in rigid] == ["plane"] else GRID  # whose distance is linear
    x, y = np.linspace(left, right, count), np.linspace(low, high, count)
    points = np.stack(np.meshgrid(x, y), axis=-1)
    gap = np.min([one.gap_in_plane(points.reshape(-1, 2), t) for one in rigid], axis=0).reshape(
        points.shape[:2]
    )
    if not gap.min() < 0 < gap.max():
        return []
    drawn = [
        axes.contourf(x, y, gap, levels=[gap.min(), 0], colors=["#d0d0d0"]),
        axes.contour(x, y, gap, levels=[0], colors=[BLACK], linewidths=0.8),
    ]
    for one in drawn:
        one.set(offsets=places, offset_transform=AffineDeltaTransform(axes.transData))
    return drawn
