"""Finds the boundary elements of supports and loads on the meshes of the bodies, and gives the
prescribed conditions of a scene as arrays (edp/program/input/conditions.idp).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from ..freefem.arrays import Entries, joined, table
from ..geometry.outlines import rotation
from ..geometry.time_functions import NOTHING, TimeFunction
from ..input.bodies import Body
from ..input.conditions import KINDS, ON_SIDE, SIDES, Load, Part, Support
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from ..input.obstacles import Drive, Obstacle
from ..mesh import mesh
from ..mesh.mesh import Mesh
from ..mesh.solid_mesh import SolidMesh
from ..mesh.solids import Solid
from .mirror import mirror_axes

__all__ = ["conditions"]

ALONG = 1e-6  # deviation of the components of a unit normal that counts as along an axis


def conditions(
    bodies: Sequence[Body],
    meshes: Sequence[Mesh | SolidMesh],
    obstacles: Sequence[Obstacle],
    dimension: Dimension,
    copies: int,
) -> Entries:
    """Returns the arrays of functions of time, driven obstacles, supports and loads.

    Raises BadInput if a part of a boundary does not exist, is in contact at the start, or cannot
    have its support or load.
    """
    functions: list[TimeFunction] = []
    supports: list[Entries] = []
    loads: list[Entries] = []
    elements: dict[str, list[np.ndarray]] = {"supports": [], "loads": []}
    first = 0
    for k, (body, made) in enumerate(zip(bodies, meshes)):
        surface = _Surface(body, made, dimension, copies)
        for support in body.supports:
            part = surface.elements(support.part)
            _refuse_touching(support.part, surface.placed(part), k, bodies, obstacles)
            supports.append(
                {"body": k} | _support_row(support, surface.fixed(support, part), functions)
            )
            elements["supports"].append(first + part)
        _refuse_all_held(body, surface)
        _refuse_opposite(body, surface)
        _refuse_without_effect(body, surface)
        _refuse_two_gases(body, surface)
        for load in body.loads:
            loads.append({"body": k} | _load_row(load, body.inflated, functions))
            elements["loads"].append(first + surface.elements(load.part))
        first += len(made.sides)
    drives = [
        {"obstacle": k} | _drive_row(obstacle.drive, functions)
        for k, obstacle in enumerate(obstacles)
        if obstacle.drive
    ]
    made_of_rows = table("supports", supports) | table("loads", loads) | table("drives", drives)
    made_of_lists = [joined(f"{name}.elements", lists) for name, lists in elements.items()]
    return made_of_rows | made_of_lists[0] | made_of_lists[1] | _functions(functions)


def _support_row(
    support: Support, fixed: tuple[bool, ...], functions: list[TimeFunction]
) -> Entries:
    """The row of a support: fixed components, release, functions."""
    moved = [function if held else None for function, held in zip(support.functions, fixed)]
    return {
        "fixed": _padded(fixed),
        "release": support.held_until,
        "motion": _numbered(functions, moved),
    }


def _load_row(load: Load, inflated: bool, functions: list[TimeFunction]) -> Entries:
    """The row of a load: kind, functions, and the numbers of a gas. FreeFEM sets its volume at the
    start and the largest distance of the body from its centre.
    """
    return {
        "kind": KINDS[load.kind],
        "functions": _numbered(functions, list(load.functions)),
        "gas": (*load.gas_numbers, 0.0, float(inflated), 0.0),
    }


def _drive_row(drive: Drive, functions: list[TimeFunction]) -> Entries:
    """The row of a driven obstacle: functions of displacement and rotation, pivot, axis."""
    numbers = _numbered(functions, list(drive.translation))
    return {
        "functions": numbers + _numbered(functions, [drive.turn])[:1],
        "pivot": _padded(drive.pivot),
        "axis": drive.axis,
    }


def _functions(functions: list[TimeFunction]) -> Entries:
    """Returns the knots of all functions behind each other, with the largest absolute value up to
    each; the largest absolute value and slope of each function; the kinks of all in the order of
    time.
    """
    largest = [
        {"largest": (function.largest_value, function.largest_slope)} for function in functions
    ]
    knots = [
        dict(zip(("time", "value", "slope", "largest"), (*knot, peak)))
        for function in functions
        for knot, peak in zip(
            function.knots.tolist(), np.maximum.accumulate(abs(function.knots[:, 1])).tolist()
        )
    ]
    kinks = sorted(
        (time, change / max(function.largest_until(time), NOTHING))
        for function in functions
        for time, change in function.kinks.tolist()
    )
    return (
        table("functions", largest)
        | {"functions.first": np.cumsum([0, *(len(function.knots) for function in functions)])}
        | table("knots", knots)
        | table("kinks", [{"time": time, "change": change} for time, change in kinks])
    )


def _padded(vector: Any) -> list[Any]:
    """A vector with three components."""
    return [*vector, 0, 0][:3]


def _numbered(functions: list[TimeFunction], added: list[TimeFunction | None]) -> list[int]:
    """Appends time functions to `functions`, which are those of the scene, and returns their
    numbers in it. The number -1 stands for 0 at all times.
    """
    numbers = []
    for function in added:
        if function is None or function.is_zero:
            numbers.append(-1)
        else:
            numbers.append(len(functions))
            functions.append(function)
    return numbers + [-1] * (3 - len(added))


class _Surface:
    """The boundary elements of a body's mesh."""

    def __init__(self, body: Body, made: Mesh | SolidMesh, dimension: Dimension, copies: int):
        self.body, self.made, self.dimension, self.copies = body, made, dimension, copies
        # `axes` transforms the mesh to the body's own axes, `turn` to its orientation at the start.
        turn = rotation(body.start_angle) if dimension is PLANE_STRAIN else np.eye(dimension.axes)
        solid = body.placed_at(0.0, np.zeros(dimension.axes))
        self.axes = solid.rotation if isinstance(solid, Solid) else np.eye(2)
        self.turn = turn
        self.own = made.points @ self.axes

    def placed(self, elements: np.ndarray) -> np.ndarray:
        """Returns the corners (f, axes, axes) [m] of boundary elements at the start."""
        corners: np.ndarray = (self.made.points @ self.turn.T + self.body.start_position)[
            self.made.sides[elements]
        ]
        return corners

    @property
    def own_labels(self) -> np.ndarray:
        """Whether each element (f,) is on the boundary of the body, and not on a plane or axis of
        symmetry.
        """
        if self.dimension is not SOLID:
            own: np.ndarray = self.made.labels != mesh.AXIS
            return own
        own = np.ones(len(self.made.sides), dtype=bool)
        corners = self.made.points[self.made.sides] + self.body.start_position
        for axis in mirror_axes(self.dimension, self.copies):
            own &= abs(corners[:, :, axis]).max(axis=1) > ON_SIDE * np.ptp(self.own)
        return own

    def elements(self, part: Part) -> np.ndarray:
        """Returns the numbers of the elements of a part among those of the body. Raises BadInput if
        the part has none.
        """
        on = self.own_labels
        if part.kind:
            inside = on & part.contains(self.placed(np.arange(len(on))).mean(axis=1))
            if not inside.any():
                raise BadInput(
                    f"{part.entry}: no boundary element of '{self.body.own_name}' has its middle in the region "
                    f"(accepted: a region that holds a part of its boundary at the start)"
                )
            return np.flatnonzero(inside)
        sides = self.sides()
        if part.name not in sides:
            raise BadInput(
                f"{part.entry}: '{self.body.own_name}' has no side or group '{brief(part.name)}' "
                f"(accepted: {', '.join(sides)}, or a region)"
            )
        return sides[part.name]

    def sides(self) -> dict[str, np.ndarray]:
        """Returns the elements of every side and group of the body by name."""
        on, corners = self.own_labels, self.own[self.made.sides]
        extent = np.ptp(self.own, axis=0).max()
        sides = {}
        for name, (axis, end) in SIDES.items():
            if axis < self.dimension.axes:
                extreme = (self.own.max if end else self.own.min)(axis=0)[axis]
                sides[name] = on & (
                    abs(corners[:, :, axis] - extreme).max(axis=1) <= ON_SIDE * extent
                )
        inner = np.zeros(len(on), dtype=bool)
        surface = np.flatnonzero(on)
        for outline in mesh.inner_outlines(self.made.points, self.made.sides[surface]):
            inner[surface[outline]] = True
        sides |= {"all": on, "outer": on & ~inner, "inner": on & inner}
        if self.dimension is AXISYMMETRIC:
            sides["axis"] = self.made.labels == mesh.AXIS
        sides |= {
            name: on & np.isin(np.arange(len(on)), numbers)
            for name, numbers in self.made.groups.items()
        }
        return {name: np.flatnonzero(mask) for name, mask in sides.items() if mask.any()}

    def fixed(self, support: Support, elements: np.ndarray) -> tuple[bool, ...]:
        """Returns which components a support fixes. For fix = "normal" this is the component normal
        to the part. Raises BadInput if the part is not normal to x, y or z.
        """
        if not support.normal:
            return support.fixed
        corners = self.placed(elements)
        along = corners[:, 1:] - corners[:, :1]
        if self.dimension is SOLID:
            normals = np.cross(along[:, 0], along[:, 1])
        else:
            normals = along[:, 0] @ np.array([[0.0, -1.0], [1.0, 0.0]])
        normals = abs(normals) / np.linalg.norm(normals, axis=1, keepdims=True)
        axis = int(normals.mean(axis=0).argmax())
        if abs(normals[:, axis] - 1).max() > ALONG:
            raise BadInput(
                f"{support.at('fix')}: 'normal', but the part is not flat across x, y or z "
                f"(accepted: all, {', '.join('xyz'[: self.dimension.axes])}, or a part that is)"
            )
        for k, function in enumerate(support.functions):
            if k != axis and not function.is_zero:
                raise BadInput(
                    f"{support.at('motion')}: moves along {'xyz'[k]}, which fix = 'normal' leaves free on this part "
                    f"(accepted: 0 there, or fix = 'all')"
                )
        return tuple(axis == k for k in range(self.dimension.axes))

    def refuse_open(self, part: Part, elements: np.ndarray) -> None:
        """Raises BadInput if elements, together with planes or the axis of symmetry, do not enclose
        a cavity.
        """
        sides = self.made.sides[elements]
        ends = (
            sides
            if self.dimension is not SOLID
            else np.sort(sides[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        )
        once = ends.ravel() if self.dimension is not SOLID else ends
        rims, count = np.unique(once, axis=0, return_counts=True)
        open_rims = self.made.points[rims[count == 1]] + self.body.start_position
        extent = np.ptp(self.own)
        closed = np.zeros(len(open_rims), dtype=bool)
        for axis in mirror_axes(self.dimension, self.copies):
            away = abs(open_rims[..., axis]).reshape(len(open_rims), -1)
            closed |= away.max(axis=1, initial=0.0) <= ON_SIDE * extent
        inner = self.sides().get("inner", np.array([], dtype=int))
        if not closed.all() or not np.isin(elements, inner).all():
            raise BadInput(
                f"{part.entry}: is no closed cavity of '{self.body.own_name}', which a gas is in "
                f"(accepted: 'inner' of a body with a hole or cavity, or a closed part of it)"
            )


def _refuse_touching(
    part: Part, corners: np.ndarray, k: int, bodies: Sequence[Body], obstacles: Sequence[Obstacle]
) -> None:
    """Raises BadInput if a part with a support is in contact with an obstacle or another body at
    the start.
    """
    points = corners.reshape(-1, corners.shape[2])
    near = ON_SIDE * bodies[k].outline.half_thickness
    others: list[Body | Obstacle] = [body for j, body in enumerate(bodies) if j != k]
    for other in [*others, *obstacles]:
        gap = other.placed.gap(points) if isinstance(other, Body) else other.gap(points)
        if gap.min() <= near:
            raise BadInput(
                f"{part.entry}: the part is in contact with '{other.own_name}' at the start (accepted: a part without contact)"
            )


def _refuse_all_held(body: Body, surface: _Surface) -> None:
    """Raises BadInput if supports fix all components on the whole boundary of a body."""
    held = np.zeros(len(surface.made.sides), dtype=bool)
    for support in body.supports:
        if all(support.fixed) and not support.normal:
            held[surface.elements(support.part)] = True
    on = surface.own_labels
    if body.supports and held[on].all():
        raise BadInput(
            f"{body.supports[0].part.entry}: the whole boundary of '{body.own_name}' is held (accepted: a part of it)"
        )


def _refuse_opposite(body: Body, surface: _Surface) -> None:
    """Raises BadInput if two supports prescribe different motions of a component on the same
    boundary elements, and the one that applies, the later in the scene, is not released first.
    """
    for j, second in enumerate(body.supports):
        for first in body.supports[:j]:
            elements = [surface.elements(support.part) for support in (first, second)]
            common = np.intersect1d(elements[0], elements[1])
            if not len(common) or second.held_until < first.held_until:
                continue
            fixed = [surface.fixed(*pair) for pair in zip((first, second), elements)]
            for k, both in enumerate(zip(*fixed)):
                if all(both) and not _alike(first.functions[k], second.functions[k]):
                    raise BadInput(
                        f"{second.at('motion')}: moves '{body.own_name}' along {'xyz'[k]} otherwise than {first.entry}, where "
                        f"both hold it (accepted: the same motion there, parts without common facets, or "
                        f"an earlier release of {second.entry})"
                    )


def _alike(first: TimeFunction, second: TimeFunction) -> bool:
    """Whether two motions are the same."""
    return (first.is_zero and second.is_zero) or np.array_equal(first.knots, second.knots)


def _refuse_two_gases(body: Body, surface: _Surface) -> None:
    """Raises BadInput if a gas is not in a closed cavity, or if a cavity has two gases."""
    filled: set[int] = set()  # elements of the cavities that have a gas already
    for load in body.loads:
        if load.kind != "gas":
            continue
        elements = surface.elements(load.part)
        surface.refuse_open(load.part, elements)
        if filled & set(elements.tolist()):
            raise BadInput(
                f"{load.part.entry}: there is a gas in this cavity of '{body.own_name}' already "
                f"(accepted: one gas a cavity)"
            )
        filled |= set(elements.tolist())


def _refuse_without_effect(body: Body, surface: _Surface) -> None:
    """Raises BadInput if a load acts only where supports hold all components until the end. The
    gas in a cavity also has a volume, and may act elsewhere on its body.
    """
    held = np.zeros((len(surface.made.sides), surface.dimension.axes), dtype=bool)
    for support in body.supports:
        if support.release is None:
            elements = surface.elements(support.part)
            held[elements] |= np.array(surface.fixed(support, elements))
    for load in body.loads:
        if load.kind != "gas" and held[surface.elements(load.part)].all():
            raise BadInput(
                f"{load.part.entry}: supports hold this part of '{body.own_name}' until the end, so the {load.kind} has no effect "
                f"(accepted: a part that is free)"
            )
