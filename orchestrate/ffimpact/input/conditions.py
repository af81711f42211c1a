"""Supports and loads: what a scene prescribes on the boundary of bodies beside contact.

[[body.support]] tables fix or move a part of a body's boundary (Gamma_D of the paper, section
2.2.1). [[body.load]] tables apply a stress to a part (Gamma_F). Their entries are described in
docs/how-to/supports-and-loads.md. A part is a side of the body, a region of space at the start, or
a named group of its file. Units are SI.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from ..failure import BadInput, unknown
from ..geometry import time_functions
from ..geometry.limits import LONGEST
from ..geometry.time_functions import TimeFunction, displacements, farthest
from .entries import Entries
from .parameter import Parameter
from .rules import ALIAS, Function, Timed, Where, number

__all__ = [
    "Condition",
    "Gas",
    "KINDS",
    "Load",
    "NEVER",
    "ON_SIDE",
    "Part",
    "SIDES",
    "Support",
    "WHOLE",
    "refuse_mixed_gases",
]

MOST_PRESSURE = 1e15  # largest accepted pressure [Pa]
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
WHERE = Where((*SIDES, *WHOLE, "axis"))
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
        elif self.kind == "cylinder":  # about the axis `first` through the centre
            inside = np.linalg.norm(np.cross(points, first), axis=1) <= second
        else:
            inside = np.linalg.norm(points - first, axis=1) <= second
        return inside

    def is_mirrored(self, axis: int, rotation: np.ndarray) -> bool:
        """Whether the part is its own mirror image in the plane normal to an axis. `rotation` is
        that of the body and of its sides.
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


class Condition(Entries):
    """A support or a load, on the part `where` of a body's boundary."""

    where: Annotated[str | dict[str, Any], WHERE]

    @cached_property
    def part(self) -> Part:
        """The part of the boundary."""
        entry, where = self.at("where"), self.where
        if isinstance(where, str):
            return Part(entry, where)
        kind, *numbers = where.values()
        region = tuple(np.array(vector) for vector in numbers)
        return Part(entry, "", ALIAS.get(kind, kind), region)


class Support(Condition):
    """A part of a body's boundary that is held or moves with a given displacement."""

    where: Annotated[str | dict[str, Any], WHERE]
    fix: Annotated[
        str | None,
        Parameter("", "word", None, "", words=("all", "x", "y", "z", "normal")),
        "what is held",
    ] = None
    motion: Annotated[
        Timed | None, Function(), "displacement [m], a function of t for each axis"
    ] = None
    release: Annotated[float | None, number(1e-12, LONGEST, "s"), "time from which it is free"] = (
        None
    )

    @property
    def axes(self) -> str:
        """The names of the axes of the scene."""
        return "xyz"[: self.context.dimension.axes]

    @property
    def normal(self) -> bool:
        """Whether the displacement along the normal of the part is prescribed."""
        return self.fix == "normal"

    @property
    def fixed(self) -> tuple[bool, ...]:
        """Which components of the displacement are prescribed, for all parts but normal ones."""
        return tuple((self.fix or "all") in ("all", axis) for axis in self.axes)

    @cached_property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The components of the displacement [m], which hold until held_until."""
        if self.motion is None:
            return (time_functions.constant(0.0),) * len(self.axes)
        end_time, folder = self.context.end_time, self.context.folder
        return displacements(self.at("motion"), self.motion, self.axes, end_time, folder)

    @property
    def held_until(self) -> float:
        """The time [s] until which the support holds."""
        return NEVER if self.release is None else self.release

    @property
    def moves(self) -> bool:
        """Whether any component is moved."""
        held = [fixed or self.normal for fixed in self.fixed]
        return any(own and not function.is_zero for own, function in zip(held, self.functions))

    def path(self) -> tuple[np.ndarray, float]:
        """Returns the displacement (axes,) [m] farthest from the start, and its time [s]."""
        return farthest(self.functions, self.held_until)

    def check(self) -> None:
        """Raises BadInput if its entries do not agree with the scene."""
        words, end_time = ("all", *self.axes, "normal"), self.context.end_time
        if self.fix is not None and self.fix not in words:
            raise BadInput(f"{self.at('fix')}: {unknown(self.fix, words)}")
        for axis, function, fixed in zip(self.axes, self.functions, self.fixed):
            if not (fixed or self.normal) and not function.is_zero:
                raise BadInput(
                    f"{self.at('motion')}: moves along {axis}, which fix = '{self.fix}' leaves free "
                    f"(accepted: 0 there, or fix = 'all')"
                )
        if self.release is not None and 0 < end_time <= self.release:
            raise BadInput(
                f"{self.at('release')}: {self.release:g} is not before the end_time, {end_time:g} s: nothing "
                f"would be released (accepted: less, a larger end_time, or no release)"
            )


class Gas(Entries):
    """A gas in a closed cavity, with p V^n = const."""

    gauge_pressure: Annotated[
        float,
        number(-MOST_PRESSURE, MOST_PRESSURE, "Pa"),
        "over the pressure outside, in equilibrium with the body at the start",
    ]
    exponent: Annotated[
        float | None, number(0.0, 10.0, ""), "n of p V^n; 1: isothermal, 1.4: air"
    ] = None
    ambient_pressure: Annotated[
        float | None, number(0.0, MOST_PRESSURE, "Pa"), "outside; an atmosphere where it is open"
    ] = None
    given_shape: Annotated[
        str | None,
        Parameter("", "word", None, "", words=("unstressed", "inflated")),
        "of the body: unstressed (default), or inflated as at the start",
    ] = None

    @property
    def numbers(self) -> tuple[float, float, float]:
        """Gauge and ambient pressure [Pa] and the exponent."""
        ambient = AMBIENT if self.ambient_pressure is None else self.ambient_pressure
        rule = replace(number(-ambient, MOST_PRESSURE), name=self.at("gauge_pressure"))
        exponent = 1.0 if self.exponent is None else self.exponent
        return float(rule.check(self.gauge_pressure)), ambient, exponent


class Load(Condition):
    """A stress on a part of a body's boundary: one of `traction`, `pressure` and `gas`."""

    nested = {"gas": Gas}
    where: Annotated[str | dict[str, Any], WHERE]
    traction: Annotated[
        Timed | None, Function(), "per reference area [Pa], a function of t for each axis"
    ] = None
    pressure: Annotated[
        Timed | None, Function(single=True), "follows the surface [Pa], a function of t"
    ] = None
    gas: Gas | None = None

    @property
    def kinds(self) -> list[str]:
        """Which stresses it has."""
        return [kind for kind in ("traction", "pressure", "gas") if kind in self]

    def refusals(self) -> Iterator[tuple[str, str]]:
        if len(self.kinds) != 1:
            has = " and ".join(self.kinds) or "no stress"
            yield "", f": has {has} (accepted: one of traction, pressure, gas)"

    @property
    def kind(self) -> str:
        """Which stress it has, one of KINDS."""
        return self.kinds[0]

    @cached_property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The components of the traction, or the pressure [Pa]; none of a gas."""
        if self.gas:
            return ()
        context = self.context
        names = "p" if self.kind == "pressure" else "xyz"[: context.dimension.axes]
        definition, end_time = getattr(self, self.kind), context.end_time
        return time_functions.functions(
            self.at(self.kind), definition, names, end_time, context.folder
        )

    @property
    def gas_numbers(self) -> tuple[float, float, float]:
        """Gauge and ambient pressure [Pa] and the exponent of its gas; 0, 0, 1 without one."""
        return self.gas.numbers if self.gas else (0.0, 0.0, 1.0)

    @property
    def inflated(self) -> bool:
        """Whether the given shape of the body is that under its gas."""
        return self.gas is not None and self.gas.given_shape == "inflated"

    @property
    def largest(self) -> float:
        """The largest stress [Pa], without round-off, because a mesh changes with every digit."""
        stresses = [function.largest_value for function in self.functions]
        return float(f"{max([abs(self.gas_numbers[0]), *stresses]):.6g}")

    def check(self) -> None:
        """Raises BadInput if a function or the pressure of a gas is not accepted."""
        _ = self.functions, self.gas_numbers


def refuse_mixed_gases(loads: Sequence[Load]) -> None:
    """Raises BadInput if the gases of a body are not all under its given shape, or all not."""
    gases = [load for load in loads if load.gas]
    if len({load.inflated for load in gases}) > 1:
        entry = f"{gases[0].at('gas')}.given_shape"
        raise BadInput(f"{entry}: differs between gases of one body (accepted: one for all)")
