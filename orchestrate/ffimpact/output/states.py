"""The kept states of a run as numpy arrays, and the motion of a material point through them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, overload

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ..failure import BadInput, NotInstalled, Unreadable, brief, unknown
from ..places import shown
from . import vtu
from .dent import Dent, dent

if TYPE_CHECKING:
    import meshio
    import pyvista

__all__ = ["Fields", "State"]

Array = NDArray[np.float64]
# Sides of quadratic triangles and tetrahedra, in the order of the nodes behind the corners.
SIDES = {6: [(0, 1), (1, 2), (0, 2)], 10: [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]}
OUTSIDE = 1e-3  # how far outside an element a point still belongs to it, in barycentric coordinates
# Components of the fields in the columns of a probe.
AXES = {1: ("",), 3: ("_x", "_y", "_z"), 6: ("_xx", "_yy", "_zz", "_xy", "_yz", "_xz")}
UNITS = {
    "displacement": "m", "velocity": "m/s", "jacobian": "1", "von_mises": "Pa", "pressure": "Pa",
    "energy_density": "J/m3", "cauchy_stress": "Pa", "plastic_strain": "1",
}  # fmt: skip


@dataclass(frozen=True, repr=False)
class State:
    """The bodies at one instant, in SI units, with values at the n nodes of quadratic elements.

    time [s]; points (n, 3): reference coordinates [m], in which the bodies lie side by side;
    cells (m, 6) triangles or (m, 10) tetrahedra: the nodes of each element, corners first, then the
    middles of its sides 01, 12, 20 (03, 13, 23); what symmetry leaves out is not there; body
    (m,): the number of its body, from 1; displacement (n, 3) from `points` [m], velocity (n, 3)
    [m/s], jacobian (n,): det F; von_mises, pressure (-tr/3 of Cauchy's stress) (n,) [Pa],
    energy_density (n,) [J/m3 of the reference], cauchy_stress (n, 6): xx yy zz xy yz xz [Pa];
    plastic_strain (n,): the equivalent one, 0 without metals.
    state["von_mises"] is state.von_mises.
    """

    time: float
    points: Array
    cells: NDArray[np.int64]
    body: NDArray[np.int32]
    displacement: Array
    velocity: Array
    jacobian: Array
    von_mises: Array
    pressure: Array
    energy_density: Array
    cauchy_stress: Array
    plastic_strain: Array

    @classmethod
    def read(cls, time: float, path: Path) -> State:
        """The state in a file of a run. Raises Unreadable if the file is none."""
        points, _, cells, values, body, _ = vtu.read_parts(path)
        none = {"plastic_strain": np.zeros(len(points))}
        return cls(time, points, cells, body, *((none | dict(values))[name] for name in UNITS))

    @property
    def positions(self) -> Array:
        """The positions of the nodes at this time (n, 3) [m]."""
        return self.points + self.displacement

    def __getitem__(self, name: str) -> Array:
        names = [entry.name for entry in fields(self)]
        if name not in names:
            raise BadInput(f"state: {unknown(name, names, ', ')}")
        values: Array = getattr(self, name)
        return values

    def __repr__(self) -> str:
        return f"State at {self.time:.6g} s: {len(self.points)} nodes, {len(self.cells)} elements"

    def to_meshio(self) -> meshio.Mesh:
        """The state as a mesh of meshio."""
        import meshio

        kind = vtu.QUADRATIC_TRIANGLE if self.cells.shape[1] == 6 else vtu.QUADRATIC_TETRAHEDRON
        values = {name: getattr(self, name) for name in UNITS}
        return meshio.Mesh(self.points, [(kind, self.cells)], values, {"body": [self.body]})

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The state as a grid of PyVista. Raises NotInstalled without PyVista."""
        try:
            import pyvista
        except ImportError:
            raise NotInstalled("fields: need pyvista; install it: pip install pyvista") from None
        return pyvista.from_meshio(self.to_meshio())


class Fields(Sequence[State]):
    """The kept states of a run in order of time; `times` has their times [s]. A state is read from its
    file at each access. Access raises Unreadable if the run kept none.
    """

    def __init__(self, folder: Path, of_revolution: bool, symmetric_along: Sequence[str]):
        self.series = vtu.series(folder / "fields.pvd")
        self.times = [time for time, _ in self.series]
        self.folder, self.of_revolution = folder, of_revolution
        self.symmetric_along = symmetric_along

    def __len__(self) -> int:
        return len(self.series)

    def __repr__(self) -> str:
        return f"{len(self)} states of {shown(self.folder)}"

    @overload
    def __getitem__(self, index: int) -> State: ...
    @overload
    def __getitem__(self, index: slice) -> list[State]: ...
    def __getitem__(self, index: int | slice) -> State | list[State]:
        if not self.series:
            raise Unreadable(
                f"{self.folder}: has no states (accepted: a run with fields = 20, for example)"
            )
        if isinstance(index, slice):
            return [State.read(*entry) for entry in self.series[index]]
        return State.read(*self.series[index])

    def probe(self, point: Sequence[float], body: int = 1) -> pd.DataFrame:
        """The motion of a material point: a row for each state with its time, its position x, y (, z)
        and the fields there, interpolated in its element.

        `point` is its place in the body as drawn, from the centre of mass on and not turned [m]:
        two coordinates in the plane and of a body of revolution (from the axis, along it), three in
        space. The units are in `.attrs["units"]`. Raises BadInput if the body has no such point.
        """
        nodes, shape = _locate(self[0], point, body, self.of_revolution, self.symmetric_along)
        names = [name for name in UNITS if name != "displacement"]
        rows = []
        for state in self:
            row = {"t": state.time} | dict(zip("xyz", shape @ state.positions[nodes]))
            for name in names:
                row |= _named(name, np.atleast_1d(shape @ getattr(state, name)[nodes]))
            rows.append(row)
        table = pd.DataFrame(rows)
        if state.cells.shape[1] == 6:
            table = table.drop(columns=["z", "velocity_z"])
        units = {"t": "s", "x": "m", "y": "m", "z": "m"} | {
            column: UNITS[name] for name in names for column in table if column.startswith(name)
        }
        table.attrs["units"] = {column: units[column] for column in table}
        return table

    def dent(self, body: int = 1) -> Dent:
        """The dent in body number `body` in the last state: its depth and radius [m], after elastic
        recovery if the contact is over by then. Raises BadInput if there is no such body or it has
        not yielded.
        """
        last = self[-1]
        if not (last.body == body).any():
            raise BadInput(f"dent: '{body}' is no body (accepted: 1 to {last.body.max()})")
        if not last.plastic_strain[last.cells[last.body == body]].any():
            raise BadInput(f"dent: body {body} has not yielded (accepted: a body that has)")
        strain = last.plastic_strain[np.unique(last.cells[last.body == body])]
        if np.mean(strain > 1e-3 * strain.max()) > 0.9:
            raise BadInput(
                f"dent: body {body} has yielded nearly everywhere (accepted: a dent in a body that is elastic elsewhere)"
            )
        return dent(last, body, ("x",) if self.of_revolution else self.symmetric_along)


def _named(name: str, values: Array) -> dict[str, float]:
    return {name + axis: float(value) for axis, value in zip(AXES[len(values)], values)}


def _locate(
    state: State, point: Sequence[float], body: int, of_revolution: bool, symmetric: Sequence[str]
) -> tuple[NDArray[np.int64], Array]:
    """The nodes of the element at a point of a body (see Fields.probe) and the shape functions."""
    axes = 2 if state.cells.shape[1] == 6 else 3
    if len(point) != axes or not np.isfinite(point).all():
        raise BadInput(f"probe: '{brief(point)}' is no point (accepted: {axes} coordinates in m)")
    own = state.cells[state.body == body]
    if not len(own):
        raise BadInput(f"probe: '{body}' is no body (accepted: 1 to {state.body.max()})")
    elements = state.points[own][:, :, :axes]
    centre = _centre(elements, of_revolution)
    centre[["xyz".index(axis) for axis in symmetric]] = 0.0
    at = centre + np.asarray(point, float)
    low, high = elements.min(axis=1), elements.max(axis=1)
    margin = 0.1 * (high - low)
    near = np.all((low - margin <= at) & (at <= high + margin), axis=1)
    places = {int(k): _barycentric(elements[k], at) for k in np.flatnonzero(near)}
    best = max(places, key=lambda k: float(places[k].min()), default=None)
    if best is None or places[best].min() < -OUTSIDE:
        ends = zip("xyz", low.min(axis=0) - centre, high.max(axis=0) - centre)
        box = ", ".join(f"{axis} from {a:.4g} to {b:.4g}" for axis, a, b in ends)
        raise BadInput(
            f"probe: '{brief(list(point))}' is outside body {body} (accepted, in m from its centre of "
            f"mass on, in the part that is computed: {box})"
        )
    return own[best], _shape(places[best])


def _centre(elements: Array, of_revolution: bool) -> Array:
    """The centre of mass of quadratic elements (m, nodes, axes), by a rule with a point for each
    corner. That of a body of revolution is on its axis, where the first coordinate is 0.
    """
    corners = elements.shape[2] + 1
    outer = {3: 2 / 3, 4: 0.5854101966249685}[corners]
    inner = (1 - outer) / (corners - 1)
    moment, content = np.zeros(corners - 1), 0.0
    for k in range(corners):
        places = np.full(corners, inner)
        places[k] = outer
        x = np.einsum("a,mac->mc", _shape(places), elements)
        slopes = _slopes(places)
        share = np.abs(np.linalg.det(np.einsum("ad,mac->mcd", slopes, elements)))
        if of_revolution:
            share = share * x[:, 0]
        moment, content = moment + share @ x, content + share.sum()
    centre: Array = moment / content
    if of_revolution:
        centre[0] = 0.0
    return centre


def _shape(places: Array) -> Array:
    """The quadratic shape functions at barycentric coordinates."""
    sides = SIDES[6 if len(places) == 3 else 10]
    corners = places * (2 * places - 1)
    return np.concatenate([corners, [4 * places[i] * places[j] for i, j in sides]])


def _slopes(places: Array) -> Array:
    """The derivatives (nodes, axes) of the shape functions by all barycentric coordinates but the
    first, which is 1 less the others.
    """
    sides = SIDES[6 if len(places) == 3 else 10]
    slopes = np.zeros((len(places) + len(sides), len(places)))
    slopes[: len(places)] = np.diag(4 * places - 1)
    for k, (i, j) in enumerate(sides, len(places)):
        slopes[k, i], slopes[k, j] = 4 * places[j], 4 * places[i]
    return slopes[:, 1:] - slopes[:, :1]


def _barycentric(element: Array, at: Array) -> Array:
    """The barycentric coordinates of a position in a quadratic element (nodes, axes), by Newton's
    method from those in the straight element.
    """
    corners = len(at) + 1
    own = np.linalg.solve((element[1:corners] - element[0]).T, at - element[0])
    for _ in range(10):
        places = np.concatenate([[1 - own.sum()], own])
        miss = at - element.T @ _shape(places)
        own = own + np.linalg.solve(element.T @ _slopes(places), miss)
    return np.concatenate([[1 - own.sum()], own])
