"""Figures of a run, drawn into matplotlib axes: result.plot.force(ax=...). Importing this module
changes no setting of matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .failure import BadInput, Unreadable, unknown
from .input.dimension import per_metre
from .output import vtu
from .output.results import body_names
from .report.bodies import down_the_slope, draw_energies, draw_obstacles, limits, obstacles_of
from .report.drawing import pictures
from .report.figures import (
    UNITS,
    arranged,
    colour_limits,
    deformed,
    draw_body,
    draw_interfaces,
    is_half,
    styled,
)

if TYPE_CHECKING:
    from .result import Result

__all__ = ["Plots"]

MS = 1e3


class Plots:
    """Draws the pictures of a finished run. A method with `ax` draws into these axes, by default into
    new ones, and returns them. The others return a figure, that of the same name in figures/.
    """

    def __init__(self, result: Result):
        self.result = result
        self.per = per_metre(result["provenance"]["script"])

    def force(self, ax: Axes | None = None, filter: str | None = None) -> Axes:
        """Draws normal force and friction force [N or kN] over time [ms]. With a `filter`, as "CFC
        600" (Result.force), the filtered forces stand before the unfiltered ones in a light colour.
        """
        forces, ax = self.result.force(filter), _axes(ax)
        unit, factor = ("kN", 1e-3) if self.result.history.normal_force.max() >= 1e3 else ("N", 1.0)
        suffix = f", {filter}" if filter else ""
        labels = {"normal_force": "normal", "friction_force": "friction"}
        for name, label in (labels | {"friction_force_z": "friction, z"}).items():
            if name in forces and (name == "normal_force" or forces[name].any()):
                [line] = ax.plot(MS * forces.t, factor * forces[name], label=label + suffix)
                if filter:
                    history = self.result.history
                    x, y, colour = MS * history.t, factor * history[name], line.get_color()
                    ax.plot(x, y, color=colour, alpha=0.35, linewidth=0.8, zorder=1)
        return _labelled(ax, f"force [{unit}{self.per}]")

    def energies(self, ax: Axes | None = None) -> Axes:
        """Draws the energies and the work of friction and viscosity [J] over time [ms]."""
        history, ax = self.result.history, _axes(ax)
        draw_energies(ax, {str(name): history[name].to_numpy() for name in history}, {})
        return _labelled(ax, f"energy [J{self.per}]")

    def velocities(self, ax: Axes | None = None) -> Axes:
        """Draws the velocities [m/s] of the bodies' centres of mass over time [ms]."""
        history, ax = self.result.history, _axes(ax)
        several = "vx_1" in history
        names = body_names(self.result.scene) if several else [""]
        for k, body in enumerate(names, 1):
            for axis in "xyz":
                name = f"v{axis}_{k}" if several else f"v{axis}"
                if name in history and history[name].any():
                    ax.plot(MS * history.t, history[name], label=f"v{axis} {body}".rstrip())
        return _labelled(ax, "velocity [m/s]")

    def shapes(
        self, ax: Axes | None = None, field: str = "von_mises", time: float | None = None
    ) -> Axes:
        """Draws the deformed bodies, coloured by a field, at the kept state nearest to `time` [s],
        by default the time of the largest normal force. Raises Unreadable if the run kept no states
        (entry `fields`), BadInput if the field is unknown.
        """
        ax, series = _axes(ax), vtu.series(self.result.folder / "fields.pvd")
        if not series:
            raise Unreadable(
                f"{self.result.folder}: has no states (accepted: a run with fields = 20, for example)"
            )
        if time is None:
            time = float(self.result.history.t[self.result.history.normal_force.idxmax()])
        when, path = min(series, key=lambda entry: abs(entry[0] - time))
        state = vtu.read(path)
        if field not in state.fields:
            raise BadInput(f"field: {unknown(field, state.fields, ', ')}")
        scene = self.result.scene
        body, rigid = deformed(state, is_half(scene), field), obstacles_of(scene)
        view = x_min, x_max, y_min, y_max = down_the_slope(limits([body]), rigid)
        drawn = draw_body(ax, body, colour_limits([body]))
        draw_interfaces(ax, body)
        drawn.set_rasterized(True)
        unit, name = (
            UNITS.get(field, "MPa"),
            field.replace("_", " ").replace("mises", "Mises stress"),
        )
        ax.figure.colorbar(drawn, ax=ax, label=f"{name} [{unit}]" if unit else name)
        draw_obstacles(ax, rigid, view, when)
        ax.set(aspect="equal", xlim=(x_min, x_max), ylim=(y_min, y_max))
        ax.set(xlabel="x [m]", ylabel="y [m]", title=f"t = {MS * when:.3g} ms")
        return ax

    def bodies(self) -> Figure:
        """Draws the deformed bodies at up to nine instants: figures/shapes.png."""
        return self._picture("shapes")

    def contact(self) -> Figure:
        """Draws pressure, stick and slip along the outlines and over time: figures/contact.png."""
        return self._picture("contact")

    def bounces(self) -> Figure:
        """Draws the restitution of each of several impacts: figures/bounces.png."""
        return self._picture("bounces")

    def heights(self) -> Figure:
        """Draws the height of each body until it rests: figures/height.png."""
        return self._picture("height")

    def modes(self) -> Figure:
        """Draws the energy left in each natural mode (entry `modes`): figures/vibration.png."""
        return self._picture("vibration")

    def _picture(self, name: str) -> Figure:
        """Draws figures/<name>.png. Raises BadInput if the run has nothing to show there."""
        drawn = pictures(self.result.folder)
        with styled():
            figure = drawn[name]() if name in drawn else None
        if not figure:
            raise BadInput(f"plot: the run has no picture '{name}' (accepted: {', '.join(drawn)})")
        return arranged(figure)


def _axes(ax: Axes | None) -> Axes:
    return ax if ax is not None else plt.subplots(layout="constrained")[1]


def _labelled(ax: Axes, label: str) -> Axes:
    ax.set(xlabel="time [ms]", ylabel=label)
    ax.legend(  # above the axes, where it covers no curve
        loc="lower left",
        bbox_to_anchor=(0, 1),
        ncols=3,
        frameon=False,
        columnspacing=1.2,
        handlelength=1.3,
        fontsize="small",
    )
    return ax
