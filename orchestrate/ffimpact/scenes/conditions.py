"""Supports and loads: what a scene prescribes on the boundary of bodies beside contact.

[[body.support]] tables fix or move a part of a body's boundary (Gamma_D of the paper, section
2.2.1). [[body.load]] tables apply a stress to a part (Gamma_F). Their entries are described in
docs/how-to/supports-and-loads.md. A part is a side of the body, a region of space at the start, or
a named group of its file. Units are SI.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from ..failure import BadInput, gathered, unknown
from ..geometry import time_functions
from ..geometry.time_functions import TimeFunction, displacements, farthest, functions
from ..input import models
from ..input.dimension import Dimension
from ..input.models import listed
from ..input.parameters import Table
from ..input.rules import ALIAS, number

__all__ = ["Load", "Part", "Support", "files_renamed", "read_loads", "read_supports"]

NEVER = 1e300  # release [s] of a support that holds until the end
AMBIENT = 101325.0  # default pressure [Pa] outside of a cavity with gas: standard atmosphere
# Sides of a body: one of its own axes, and the end of the body along it (0: low, 1: high).
SIDES = {
    "left": (0, 0),
    "right": (0, 1),
    "bottom": (1, 0),
    "top": (1, 1),
    "back": (2, 0),
    "front": (2, 1),
}
WHOLE = ("all", "outer", "inner")
ON_SIDE = 1e-6  # largest distance from a side that counts as on it, over the body's extent
KINDS = {"traction": 0, "pressure": 1, "gas": 2}  # numbers as in edp/program/input/conditions.idp


@dataclass(frozen=True)
class Part:
    """A part of a body's boundary: the `name` of a side or a group, or a region of the given `kind`
    with its `numbers`. `entry` is the entry of the scene that defines it, for messages.
    """

    entry: str
    name: str = ""
    kind: str = ""
    numbers: tuple[np.ndarray, ...] = ()

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points (n, axes) are in the region."""
        first, second = self.numbers
        inside: np.ndarray
        if self.kind == "half-space":
            inside = (points - first) @ second >= 0
        elif self.kind == "box":
            inside = np.all((points >= first) & (points <= second), axis=1)
        else:
            inside = np.linalg.norm(points - first, axis=1) <= second
        return inside

    def is_mirrored(self, axis: int, rotation: np.ndarray) -> bool:
        """Whether the part is its own mirror image in the plane normal to an axis. `rotation` is
        that of the body, which turns its sides.
        """
        if self.kind == "":
            side = SIDES.get(self.name)
            if side is None or side[0] >= len(rotation):
                return self.name in WHOLE
            return bool(abs(rotation[axis, side[0]]) < 1e-9)
        first, second = self.numbers
        if self.kind == "box":
            return bool(first[axis] == -second[axis])
        return bool((second if self.kind == "half-space" else first)[axis] == 0)


@dataclass(frozen=True)
class Support:
    """A part of the boundary with prescribed displacement in the components `fixed`, or along its
    own normal if `normal`. The components follow `motion` [m] from the start until `release` [s].
    """

    part: Part
    fixed: tuple[bool, ...]
    normal: bool
    motion: tuple[TimeFunction, ...]
    release: float

    @property
    def moves(self) -> bool:
        """Whether any component is moved."""
        return not all(
            function.is_zero
            for function, fixed in zip(self.motion, self.fixed)
            if fixed or self.normal
        )

    def path(self) -> tuple[np.ndarray, float]:
        """Returns the displacement (axes,) [m] farthest from the start, and its time [s]."""
        return farthest(self.motion, self.release)


@dataclass(frozen=True)
class Load:
    """A part of the boundary with a stress; `kind` is one of KINDS.

    `functions` of time are the components of a traction, or the pressure [Pa]. `gas` holds gauge
    and ambient pressure [Pa] and the exponent of a gas. `inflated` states whether the given shape
    of the body is that under this gas.
    """

    part: Part
    kind: str
    functions: tuple[TimeFunction, ...]
    gas: tuple[float, float, float] = (0.0, 0.0, 1.0)
    inflated: bool = False

    @property
    def largest(self) -> float:
        """The largest stress of the load [Pa], without round-off, because a mesh changes with every
        digit.
        """
        largest = max([abs(self.gas[0]), *(function.largest_value for function in self.functions)])
        return float(f"{largest:.6g}")


def files_renamed(content: Table, rename: Callable[[str, str], str]) -> Table:
    """Returns the tables of a scene with rename(label, name) in place of the names of all files: of
    bodies and obstacles, and of CSV files of supports, loads and driven obstacles. A label is unique
    in the scene.
    """
    bodies = []
    for b, body in enumerate(listed(content, "body"), 1):
        changed = _with_file(f"body{b}", body, rename)
        for key, names in (("support", ("motion",)), ("load", ("traction", "pressure"))):
            if key in body:
                changed[key] = [
                    _csv_renamed(f"body-{b}-{key}-{k}", table, names, rename)
                    for k, table in enumerate(listed(body, key), 1)
                ]
        bodies.append(changed)
    obstacles = [
        _csv_renamed(
            f"obstacle-{k}",
            _with_file(f"obstacle{k}", table, rename),
            ("motion", "rotation"),
            rename,
        )
        for k, table in enumerate(listed(content, "obstacle"), 1)
    ]
    return (
        content
        | ({"body": bodies} if bodies else {})
        | ({"obstacle": obstacles} if obstacles else {})
    )


def _with_file(label: str, table: Table, rename: Callable[[str, str], str]) -> Table:
    if "file" not in table:
        return dict(table)
    return table | {"file": rename(table.get("name", label), str(table["file"]))}


def _csv_renamed(
    label: str, table: Table, names: tuple[str, ...], rename: Callable[[str, str], str]
) -> Table:
    files = {name: table[name] for name in names if time_functions.is_csv(table.get(name))}
    return table | {name: rename(f"{label}-{name}", file) for name, file in files.items()}


def read_supports(
    tables: list[models.Support], dimension: Dimension, end_time: float, folder: Path
) -> tuple[Support, ...]:
    """Returns the supports in the [[body.support]] tables of a body. CSV files are relative to
    `folder`. Raises BadInput for whatever is wrong in them.
    """
    return tuple(
        gathered([partial(_support, table, dimension, end_time, folder) for table in tables])
    )


def read_loads(
    tables: list[models.Load], dimension: Dimension, end_time: float, folder: Path
) -> tuple[Load, ...]:
    """Returns the loads in the [[body.load]] tables of a body. CSV files are relative to `folder`.
    Raises BadInput for whatever is wrong in them.
    """
    loads = tuple(
        gathered([partial(_load, table, dimension, end_time, folder) for table in tables])
    )
    shapes = [load.inflated for load in loads if load.kind == "gas"]
    if len(set(shapes)) > 1:
        entry = next(table.gas.at("given_shape") for table in tables if table.gas)
        raise BadInput(f"{entry}: differs between gases of one body (accepted: one for all)")
    return loads


def _support(table: models.Support, dimension: Dimension, end_time: float, folder: Path) -> Support:
    axes = "xyz"[: dimension.axes]
    words = ("all", *axes, "normal")
    fix = table.fix or "all"
    if fix not in words:
        raise BadInput(f"{table.at('fix')}: {unknown(fix, words)}")
    fixed = tuple(fix in ("all", axis) for axis in axes)
    motion = (time_functions.constant(0.0),) * dimension.axes
    if table.motion is not None:
        motion = displacements(table.at("motion"), table.motion, axes, end_time, folder)
        for axis, function, held in zip(axes, motion, fixed):
            if not (held or fix == "normal") and not function.is_zero:
                raise BadInput(
                    f"{table.at('motion')}: moves along {axis}, which fix = '{fix}' leaves free "
                    f"(accepted: 0 there, or fix = 'all')"
                )
    if table.release is not None and 0 < end_time <= table.release:
        raise BadInput(
            f"{table.at('release')}: {table.release:g} is not before the end_time, {end_time:g} s: nothing "
            f"would be released (accepted: less, a larger end_time, or no release)"
        )
    return Support(
        _part(table),
        fixed,
        fix == "normal",
        motion,
        NEVER if table.release is None else table.release,
    )


def _load(table: models.Load, dimension: Dimension, end_time: float, folder: Path) -> Load:
    kind, part = table.kinds[0], _part(table)
    if table.gas:
        gas = table.gas
        ambient = AMBIENT if gas.ambient_pressure is None else gas.ambient_pressure
        gauge = replace(
            number(-ambient, models.MOST_PRESSURE), name=gas.at("gauge_pressure")
        ).check(gas.gauge_pressure)
        exponent = 1.0 if gas.exponent is None else gas.exponent
        return Load(
            part, kind, (), (float(gauge), ambient, exponent), gas.given_shape == "inflated"
        )
    components = "p" if kind == "pressure" else "xyz"[: dimension.axes]
    definition = getattr(table, kind)
    return Load(part, kind, functions(table.at(kind), definition, components, end_time, folder))


def _part(table: models.Support | models.Load) -> Part:
    entry, where = table.at("where"), table.where
    if isinstance(where, str):
        return Part(entry, where)
    kind, *numbers = where.values()
    return Part(entry, "", ALIAS.get(kind, kind), tuple(np.array(vector) for vector in numbers))
