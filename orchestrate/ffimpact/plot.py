"""Figures of a run, drawn into matplotlib axes: result.plot.force(ax=...). Importing this module
changes no setting of matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.tri import Triangulation

from .failure import BadInput, Unreadable, unknown
from .input.dimension import per_metre
from .output import vtu
from .output.results import body_names
from .report.bodies import draw_obstacles, obstacles_of
from .report.figures import is_half

if TYPE_CHECKING:
    from .result import Result

__all__ = ["Plots"]

MS = 1e3
# Units of the fields of a state. All other fields are in Pa.
UNITS = {"displacement": "m", "velocity": "m/s", "jacobian": ""}
ENERGIES = {
    "kinetic": "kinetic",
    "elastic": "elastic",
    "contact": "contact",
    "friction_work": "friction",
    "viscous_work": "viscosity",
    "penalty_damping_work": "damping of the penalty",
}


class Plots:
    """Draws the figures of a finished run. Each method draws into the axes `ax`, by default into
    new axes, and returns the axes.
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
        for name, label in ENERGIES.items():
            if name in history and history[name].any():
                ax.plot(MS * history.t, history[name], label=label)
        mechanical = history.kinetic + history.elastic + history.contact
        ax.plot(MS * history.t, mechanical, "k--", label="mechanical")
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
        values = state.fields[field]
        values = np.linalg.norm(values, axis=1) if values.ndim > 1 else values
        points, triangles = (
            state.points[:, :2] + state.fields["displacement"][:, :2],
            state.triangles,
        )
        if is_half(self.result.scene):  # adds the mirror image of the computed half
            triangles = np.vstack([triangles, triangles + len(points)])
            points, values = np.vstack([points, points * [-1, 1]]), np.concatenate([values, values])
        drawn = ax.tripcolor(
            Triangulation(points[:, 0], points[:, 1], triangles),
            values,
            shading="gouraud",
            rasterized=True,
        )
        unit = UNITS.get(field, "Pa")
        ax.figure.colorbar(
            drawn, ax=ax, label=f"{field.replace('_', ' ')} [{unit}]" if unit else field
        )
        low, high = points.min(axis=0), points.max(axis=0)
        margin = 0.06 * (high - low).max()
        draw_obstacles(
            ax,
            obstacles_of(self.result.scene),
            (low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin),
            when,
        )
        ax.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=f"t = {MS * when:.3g} ms")
        return ax


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
