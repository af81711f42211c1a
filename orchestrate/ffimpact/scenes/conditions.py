"""Supports and loads: what a scene prescribes on the boundary beside contact.

[[body.support]] tables hold or move a part of a body's boundary (Gamma_D of the paper, section
2.2.1), [[body.load]] tables give a part a stress (Gamma_F). docs/supports-and-loads.md says what they
hold. A part is a side of the body, a region of space where the body is at the start, or a named group
of its file. Units are SI.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..failure import BadInput, brief, unknown
from ..geometry import time_functions
from ..geometry.time_functions import TimeFunction, farthest, functions
from ..input.dimension import AXISYMMETRIC, SOLID, Dimension
from ..input.tables import LONGEST, SHORTEST, Table, listed

__all__ = ["Load", "Part", "Support", "inlined", "read_loads", "read_supports"]

NEVER = 1e300                # s: the release of a support that holds throughout
AMBIENT = 101325.0           # Pa: outside of a gas, the standard atmosphere
MOST_PRESSURE = 1e15         # Pa
# sides of a body by its own axes: the axis, and the end of the body along it
SIDES = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1), "back": (2, 0), "front": (2, 1)}
WHOLE = ("all", "outer", "inner")
# what a region is made of: the counts of numbers, of points and directions as many as axes
REGIONS = {"half-space": ("point", "normal"), "box": ("low", "high"), "ball": ("centre", "radius")}
ALIAS = {"half-plane": "half-space", "disc": "ball"}          # in the plane
ON_SIDE = 1e-6               # of the body's extent: as near to its end is on a side
KINDS = {"traction": 0, "pressure": 1, "gas": 2}              # as edp/core/input/conditions.idp


@dataclass(frozen=True)
class Part:
    """A part of a body's boundary: `name` of a side or a group, or a region of `kind` with its
    `numbers`; `entry` says so in the scene."""

    entry: str
    name: str = ""
    kind: str = ""
    numbers: tuple[np.ndarray, ...] = ()

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points (n, axes) are in the region."""
        first, second = self.numbers
        if self.kind == "half-space":
            return (points - first) @ second >= 0
        if self.kind == "box":
            return ((points >= first) & (points <= second)).all(axis=1)
        return np.linalg.norm(points - first, axis=1) <= second

    def is_mirrored(self, axis: int, rotation: np.ndarray) -> bool:
        """Whether it is its own mirror image across an axis; of a side of a body that is turned."""
        if self.kind == "":
            side = SIDES.get(self.name)
            return self.name in WHOLE or side is not None and abs(rotation[axis, side[0]]) < 1e-9
        first, second = self.numbers
        if self.kind == "box":
            return bool(first[axis] == -second[axis])
        return bool((second if self.kind == "half-space" else first)[axis] == 0)


@dataclass(frozen=True)
class Support:
    """A part that is held in the components `fixed`, or across itself where `normal`; these follow
    `motion` [m] from the start on, until `release` [s]."""

    part: Part
    fixed: tuple[bool, ...]
    normal: bool
    motion: tuple[TimeFunction, ...]
    release: float

    @property
    def moves(self) -> bool:
        """Whether something of it is moved."""
        return not all(one.is_constant for one, fixed in zip(self.motion, self.fixed) if fixed or self.normal)

    def path(self) -> tuple[np.ndarray, float]:
        """How far it has moved when it is farthest from the start [m], and when [s]."""
        return farthest(self.motion, self.release)


@dataclass(frozen=True)
class Load:
    """A part with a stress: `kind` of KINDS; functions of the components of a traction, or of the
    pressure [Pa]; of a gas gauge and ambient pressure [Pa] and its exponent."""

    part: Part
    kind: str
    functions: tuple[TimeFunction, ...]
    gas: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @property
    def largest(self) -> float:
        """The largest stress of it [Pa]."""
        return max([abs(self.gas[0]), *(float(abs(one.knots[:, 1]).max()) for one in self.functions)])


def inlined(given: dict, folder: Path, of: Dimension) -> dict:
    """The tables of a scene with the CSV files of its supports and loads as tables in them."""
    bodies = []
    for b, body in enumerate(listed(given, "body"), 1):
        changed = dict(body)
        for key, names in (("support", ("motion",)), ("load", ("traction", "pressure"))):
            if key in body:
                changed[key] = [_with_tables(f"body.{b}.{key}.{k}", one, names, folder, of)
                                for k, one in enumerate(listed({f"body.{b}.{key}": body[key]}, f"body.{b}.{key}"), 1)]
        bodies.append(changed)
    obstacles = [_with_tables(f"obstacle.{k}", one, ("motion", "rotation"), folder, of)
                 for k, one in enumerate(listed(given, "obstacle"), 1)]
    return given | ({"body": bodies} if bodies else {}) | ({"obstacle": obstacles} if obstacles else {})


def _with_tables(path: str, table: dict, names: tuple[str, ...], folder: Path, of: Dimension) -> dict:
    changed = dict(table)
    for name in names:
        value = table.get(name)
        if isinstance(value, str) and value.lower().endswith(".csv"):
            columns = "p" if name == "pressure" else "xyz"[:of.axes]
            changed[name] = time_functions.of_csv(f"{path}.{name}", folder / value, columns)
    return changed


def read_supports(path: str, tables: list, of: Dimension, end_time: float) -> tuple[Support, ...]:
    """The [[body.support]] tables of the body `path`. BadInput for whatever is wrong in them."""
    return tuple(_support(f"{path}.support.{k}", one, of, end_time)
                 for k, one in enumerate(listed({f"{path}.support": tables}, f"{path}.support"), 1))


def read_loads(path: str, tables: list, of: Dimension, end_time: float) -> tuple[Load, ...]:
    """The [[body.load]] tables of the body `path`. BadInput for whatever is wrong in them."""
    return tuple(_load(f"{path}.load.{k}", one, of, end_time)
                 for k, one in enumerate(listed({f"{path}.load": tables}, f"{path}.load"), 1))


def _support(path: str, given: dict, of: Dimension, end_time: float) -> Support:
    table = Table(path, given, ("where", "fix", "motion", "release"))
    axes = "xyz"[:of.axes]
    words = ("all", *axes, "normal")
    fix = table.text("fix", "all")
    if fix not in words:
        raise BadInput(f"{path}.fix: {unknown(fix, words)}")
    fixed = tuple(fix in ("all", axis) for axis in axes)
    motion = (time_functions.constant(0.0),) * of.axes
    if "motion" in table:
        motion = functions(table, "motion", axes, end_time)
        for axis, one, held in zip(axes, motion, fixed):
            if not (held or fix == "normal") and not one.is_zero:
                raise BadInput(f"{path}.motion: moves along {axis}, which fix = '{fix}' leaves free "
                               f"(accepted: 0 there, or fix = 'all')")
    release = table.number("release", 0.0, LONGEST, NEVER) if "release" in table else NEVER
    return Support(_part(table, of), fixed, fix == "normal", motion, release)


def _load(path: str, given: dict, of: Dimension, end_time: float) -> Load:
    table = Table(path, given, ("where", *KINDS))
    kinds = [kind for kind in KINDS if kind in table]
    if len(kinds) != 1:
        raise BadInput(f"{path}: has {' and '.join(kinds) or 'no stress'} (accepted: one of {', '.join(KINDS)})")
    kind, part = kinds[0], _part(table, of)
    if kind == "gas":
        gas = Table(f"{path}.gas", given["gas"], ("gauge_pressure", "exponent", "ambient_pressure"))
        ambient = gas.number("ambient_pressure", 0.0, MOST_PRESSURE, AMBIENT)
        gauge = gas.number("gauge_pressure", -ambient, MOST_PRESSURE)
        return Load(part, kind, (), (gauge, ambient, gas.number("exponent", 0.0, 10.0, 1.0)))
    if kind == "pressure":
        return Load(part, kind, functions(table, kind, "p", end_time))
    return Load(part, kind, functions(table, kind, "xyz"[:of.axes], end_time))


def _part(table: Table, of: Dimension) -> Part:
    entry, given = table.at("where"), table.given.get("where")
    kinds = [*REGIONS] if of is SOLID else ["half-plane", "box", "disc"]
    accepted = f"(accepted: {', '.join(_sides(of))}, the name of a group of its file, or a region {'|'.join(kinds)})"
    if given is None:
        raise BadInput(f"{entry}: is missing {accepted}")
    if isinstance(given, str):
        return Part(entry, given)
    if not isinstance(given, dict) or given.get("kind") not in kinds:
        raise BadInput(f"{entry}: '{brief(given)}' is no part of a boundary {accepted}")
    kind = ALIAS.get(given["kind"], given["kind"])
    first, second = REGIONS[kind]
    region = Table(entry, given, ("kind", first, second))
    start = region.numbers(first, count=of.axes)
    if second == "radius":
        return Part(entry, "", kind, (start, np.array(region.number(second, SHORTEST))))
    end = region.numbers(second, count=of.axes)
    if second == "normal" and not end.any():
        raise BadInput(f"{entry}.normal: '{brief(given[second])}' has no direction (accepted: other than 0)")
    if second == "high" and not (end >= start).all():
        raise BadInput(f"{entry}.high: '{brief(given[second])}' is below low (accepted: from low on)")
    return Part(entry, "", kind, (start, end))


def _sides(of: Dimension) -> list[str]:
    """The names of parts that any body of a dimension may have."""
    return [*(name for name, (axis, _) in SIDES.items() if axis < of.axes), *WHOLE,
            *(["axis"] if of is AXISYMMETRIC else [])]
