"""The rules of entries of bodies, obstacles, supports and loads that are not parameters of a run.

The entries are points, lists of points, names, functions of time and parts of a boundary, in SI
units. The rules of single parameters are in parameter.py.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..failure import BadInput, brief, suggestion
from ..geometry import implicit
from ..geometry.limits import LONGEST, SHORTEST
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .parameter import Parameter, Rule

__all__ = [
    "ALIAS",
    "Components",
    "Expression",
    "Flag",
    "Function",
    "InSpace",
    "MOST_TURN",
    "Name",
    "Named",
    "Numbers",
    "OfPlace",
    "Partners",
    "Parts",
    "Place",
    "Placed",
    "Points",
    "Polygons",
    "REGIONS",
    "Region",
    "Rows",
    "Text",
    "Timed",
    "Vector",
    "Where",
    "number",
    "placeholder",
    "points",
    "vector",
]

# Largest number of points of a polygon or a chain, whose sides are compared with each other.
MOST = 2000
MOST_TURN = 36000.0  # largest accepted angle [degrees]
LARGEST = 2_000_000  # largest number of points, cells or sides of a mesh
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")
# The two entries of each kind of region. Points and directions have a component for each axis; a
# radius is a number.
REGIONS = {"half-space": ("point", "normal"), "box": ("low", "high"), "ball": ("centre", "radius")}
# Types of entries. Arrays and tuples become lists; Python functions become tables.
Components = list[float] | float  # one for each axis, or the only one
Timed = float | str | list[Any] | dict[str, Any] | Callable[[float], Any]  # functions of time
Placed = list[float | str] | dict[str, Any] | Callable[[np.ndarray], Any]  # functions of place
ALIAS = {"half-plane": "half-space", "disc": "ball"}  # names of regions in the plane


def number(low: float = SHORTEST, high: float = LONGEST, unit: str = "m") -> Parameter:
    """The rule of a number between two bounds; without bounds the rule of a length [m]."""
    return Parameter("", "real", None, unit, "", low, high)


def placeholder(count: int) -> str:
    """The form of a point with `count` components as messages print it: [x, y, z]."""
    return f"[{', '.join('xyz'[:count])}]"


def vector(value: Any, count: int, low: float, high: float, at: str = "") -> list[float]:
    """Checks a list of `count` numbers between two bounds.

    Raises BadInput otherwise; its message begins with `at`, the text behind the entry's name.
    """
    if not isinstance(value, list | tuple) or len(value) != count:
        raise BadInput(
            f"{at}: '{brief(value)}' is no {placeholder(count)} (accepted: {('two', 'three')[count - 2]} numbers, each "
            f"{low:g} to {high:g})"
        )
    return [
        float(Parameter(f"{at}.{k}", "real", None, "", "", low, high).check(component))
        for k, component in enumerate(value, 1)
    ]


def points(value: Any, least: int, at: str = "") -> list[list[float]]:
    """Checks a list of at least `least` points [x, y].

    Raises BadInput otherwise; its message begins with `at`, the text behind the entry's name.
    """
    if not isinstance(value, list) or len(value) < least:
        raise BadInput(
            f"{at}: '{brief(value)}' is too little (accepted: {least} points [x, y] or more)"
        )
    if len(value) > MOST:
        raise BadInput(f"{at}: {len(value)} points (accepted: {least} to {MOST})")
    return [vector(point, 2, -LONGEST, LONGEST, f"{at}.{k}") for k, point in enumerate(value, 1)]


@dataclass(frozen=True)
class Vector(Rule):
    """A vector with a component for each axis, or with `count` components."""

    low: float = -LONGEST
    high: float = LONGEST
    count: int = 0
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return self.accepted_in(PLANE_STRAIN)

    def accepted_in(self, dimension: Dimension | None) -> str:
        return f"{placeholder(self.count or (dimension.axes if dimension else 2))}, each {self.low:g} to {self.high:g}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        open_count = len(value) if isinstance(value, list) and len(value) in (2, 3) else 2
        return vector(
            value, self.count or (dimension.axes if dimension else open_count), self.low, self.high
        )

    def schema(self) -> dict[str, Any]:
        component = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {
            "type": "array",
            "items": component,
            "minItems": self.count or 2,
            "maxItems": self.count or 3,
        }


@dataclass(frozen=True)
class Numbers(Rule):
    """A list of up to `largest_count` numbers between two bounds."""

    low: float
    high: float
    largest_count: int
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return f"1 to {self.largest_count} numbers, each {self.low:g} to {self.high:g}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, list) or not 1 <= len(value) <= self.largest_count:
            raise BadInput(f": '{brief(value)}' is no list of numbers (accepted: {self.accepted})")
        component = number(self.low, self.high, "")
        return [float(component.checked(item, dimension)) for item in value]

    def schema(self) -> dict[str, Any]:
        component = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {"type": "array", "items": component, "minItems": 1, "maxItems": self.largest_count}


@dataclass(frozen=True)
class Named(Rule):
    """A table of numbers by names, which are words that an expression may contain."""

    low: float
    high: float
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return f"a table of names, each with a number {self.low:g} to {self.high:g}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, dict):
            raise BadInput(f": '{brief(value)}' is no table (accepted: {self.accepted})")
        component, numbers = number(self.low, self.high, ""), {}
        for name, item in value.items():
            if not (isinstance(name, str) and name.isidentifier() and name.isascii()):
                raise BadInput(f".{brief(name)}: is no name (accepted: letters, digits and _)")
            try:
                numbers[name] = float(component.checked(item, dimension))
            except BadInput as error:
                raise BadInput(f".{name}{error}") from None
        return numbers

    def schema(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": number(self.low, self.high, "").schema()}


@dataclass(frozen=True)
class Place(Vector):
    """A position or a vector; for bodies of revolution along the axis, [0, y] or y alone."""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if dimension in (AXISYMMETRIC, None) and not isinstance(value, list):
            y = number(self.low, self.high, "").checked(value, dimension)
            return [0.0, y] if dimension else y
        position = super().checked(value, dimension)
        if dimension is AXISYMMETRIC and position[0] != 0:
            raise BadInput(
                f": x is {position[0]:g}, off the axis of revolution (accepted: [0, y], or y alone)"
            )
        return position

    def schema(self) -> dict[str, Any]:
        return {
            "anyOf": [
                super().schema(),
                {"type": "number", "minimum": self.low, "maximum": self.high},
            ]
        }


@dataclass(frozen=True)
class InSpace(Rule):
    """A number in the plane and a vector in space.

    If `about_z` is true, a number in space is the component along z.
    """

    plane: Parameter
    about_z: bool = True
    low: float | None = None
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return self.plane.accepted

    @property
    def _vector(self) -> Vector:
        return Vector(self.plane.low if self.low is None else self.low, self.plane.high, 3)

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if (
            dimension is PLANE_STRAIN
            or not isinstance(value, list)
            and (dimension is None or self.about_z)
        ):
            rotation = self.plane.checked(value, dimension)
            return [0.0, 0.0, rotation] if dimension is SOLID else rotation
        return self._vector.checked(value, dimension)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.plane.schema(), self._vector.schema()]}


@dataclass(frozen=True)
class Points(Rule):
    """A list of at least `least` points [x, y]."""

    least: int = 3
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return f"{self.least} points [x, y] or more"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        return points(value, self.least)

    def schema(self) -> dict[str, Any]:
        return {
            "type": "array",
            "items": Vector(count=2).schema(),
            "minItems": self.least,
            "maxItems": MOST,
        }


@dataclass(frozen=True)
class Rows(Rule):
    """A list of rows of numbers, of one of these `widths`; `whole` ones are numbers of points."""

    widths: tuple[int, ...]
    whole: bool = False
    meaning: str = ""

    @property
    def accepted(self) -> str:
        kind = (
            "numbers of points, from 0"
            if self.whole
            else f"numbers, each {-LONGEST:g} to {LONGEST:g}"
        )
        return f"1 to {LARGEST} rows of {' or '.join(map(str, self.widths))} {kind}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        try:
            rows = np.array(value, dtype=float)
        except (TypeError, ValueError):  # text, or rows of different lengths
            rows = np.empty(0)
        if rows.ndim != 2 or rows.shape[1] not in self.widths or not 1 <= len(rows) <= LARGEST:
            raise BadInput(f": '{brief(value)}' are no such rows (accepted: {self.accepted})")
        wrong = ~(abs(rows) <= LONGEST)
        if self.whole:
            wrong |= (rows < 0) | (rows % 1 != 0)
        if wrong.any():
            k = int(wrong.any(axis=1).argmax())
            raise BadInput(f": row {k} is {brief(value[k])} (accepted: {self.accepted})")
        return (rows.astype(int) if self.whole else rows).tolist()

    def schema(self) -> dict[str, Any]:
        number = {"type": "integer", "minimum": 0} if self.whole else {"type": "number"}
        row = {
            "type": "array",
            "items": number,
            "minItems": min(self.widths),
            "maxItems": max(self.widths),
        }
        return {"type": "array", "items": row, "minItems": 1, "maxItems": LARGEST}


@dataclass(frozen=True)
class Parts(Rule):
    """Parts of the boundary of a mesh by name, each with rows of numbers of points."""

    sides: Rows
    meaning: str = ""

    @property
    def accepted(self) -> str:
        return f"a table of names, each with {self.sides.accepted}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, dict):
            raise BadInput(f": '{brief(value)}' is no table (accepted: {self.accepted})")
        parts = {}
        for name, rows in value.items():
            Name().checked(name, dimension)
            try:
                parts[name] = self.sides.checked(rows, dimension)
            except BadInput as error:
                raise BadInput(f".{name}{error}") from None
        return parts

    def schema(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": self.sides.schema()}


@dataclass(frozen=True)
class Polygons(Rule):
    """A list of polygons."""

    accepted: str = "[[[x, y], ...], ...]"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, list):
            raise BadInput(f": '{brief(value)}' is no list of polygons (accepted: {self.accepted})")
        return [points(polygon, 3, f".{k}") for k, polygon in enumerate(value, 1)]

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Points().schema()}


@dataclass(frozen=True)
class Flag(Rule):
    """A truth value: true or false."""

    accepted: str = "true|false"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, bool):
            raise BadInput(
                f": '{brief(value)}' is neither true nor false (accepted: {self.accepted})"
            )
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "boolean"}


@dataclass(frozen=True)
class Text(Rule):
    """Any text."""

    accepted: str = "text in quotes"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, str):
            raise BadInput(f": '{brief(value)}' is no text (accepted: text in quotes)")
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "string"}


@dataclass(frozen=True)
class Expression(Text):
    """An expression of the slip velocity v and the pressure p, or a number."""

    accepted: str = "a number, or an expression of v and p in quotes"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if isinstance(value, int | float) and not isinstance(value, bool):
            value = repr(float(value))
        try:
            implicit.program("", value, "vp")
        except BadInput as error:
            raise BadInput(str(error)) from None
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": ["string", "number"]}


@dataclass(frozen=True)
class Name(Rule):
    """A name, which is written as one word to data files."""

    accepted: str = "letters, digits, _ - . without blanks, a letter first"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, str) or not NAME.fullmatch(value):
            raise BadInput(f": '{brief(value)}' is no name (accepted: {self.accepted})")
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{NAME.pattern}$"}


@dataclass(frozen=True)
class Partners(Rule):
    """The names of a contact pair; scenes/pairs.py looks them up in the scene."""

    accepted: str = "two names, one at least of a body"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Text().schema(), "minItems": 2, "maxItems": 2}


@dataclass(frozen=True)
class Function(Rule):
    """Functions of time, one for each component, or a `single` function of one quantity.

    time_functions.py checks them.
    """

    single: bool = False
    accepted: str = "numbers, expressions of t in quotes, a CSV file or a table"
    meaning: str = ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        return value

    def schema(self) -> dict[str, Any]:
        kinds = ["string", "object", "number"] if self.single else ["string", "object", "array"]
        return {"type": kinds}


@dataclass(frozen=True)
class OfPlace(Function):
    """A vector at each place at the start; geometry/place_functions.py checks it."""

    accepted: str = "numbers, expressions of x, y (, z) [m] in quotes for each axis, or a table"

    def schema(self) -> dict[str, Any]:
        return {"type": ["array", "object"]}


@dataclass(frozen=True)
class Where(Rule):
    """A part of a body's boundary: a side, a group of its file, or a region of space.

    An example of a region is {kind = "half-space", point, normal}.
    """

    sides: tuple[str, ...] = ()
    what: ClassVar[str] = "part of a boundary"
    meaning: str = "a side, the name of a group of its file, or a region"

    @property
    def accepted(self) -> str:
        return self.accepted_in(SOLID)

    def accepted_in(self, dimension: Dimension | None) -> str:
        axial = {"axis": AXISYMMETRIC, "front": SOLID, "back": SOLID}
        names = [
            side
            for side in self.sides
            if axial.get(side, dimension) is dimension or dimension is None
        ]
        return f"{', '.join(names)}, the name of a group of its file, or a region {'|'.join(_kinds(dimension))}"

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if isinstance(value, str) and self.sides:
            return value
        kind: Any = value.get("kind") if isinstance(value, dict) else None
        if kind not in _kinds(dimension):
            raise BadInput(
                f": '{brief(value)}' is no {self.what} (accepted: {self.accepted_in(dimension)})"
            )
        first, second = REGIONS[ALIAS.get(kind, kind)]
        entries = ("kind", first, second)
        for key in [key for key in value if key not in entries]:
            details = f"set to '{brief(value[key])}'{suggestion(key, entries)} (accepted: {', '.join(entries)})"
            raise BadInput(f".{brief(key)}: no such entry, {details}")
        vector_rule = Vector()
        for key in (first, second):
            if key not in value:
                accepted = (
                    number().accepted if key == "radius" else vector_rule.accepted_in(dimension)
                )
                raise BadInput(f".{key}: is missing (accepted: {accepted})")
        region: dict[str, Any] = {"kind": kind}
        for key in (first, second):
            try:
                region[key] = (number() if key == "radius" else vector_rule).checked(
                    value[key], dimension
                )
            except BadInput as error:
                raise BadInput(f".{key}{error}") from None
        if second == "normal" and not any(region[second]):
            raise BadInput(
                f".normal: '{brief(value[second])}' has no direction (accepted: other than 0)"
            )
        if second == "high" and any(high < low for low, high in zip(region[first], region[second])):
            raise BadInput(f".high: '{brief(value[second])}' is below low (accepted: from low on)")
        return region

    def schema(self) -> dict[str, Any]:
        return {
            "anyOf": [
                {"type": "string"},
                {
                    "type": "object",
                    "properties": {"kind": {"enum": [*REGIONS, *ALIAS]}},
                    "required": ["kind"],
                },
            ]
        }


class Region(Where):
    """A region of space, as of Where."""

    what: ClassVar[str] = "region"
    meaning: str = "a region"

    def accepted_in(self, dimension: Dimension | None) -> str:
        return f"a region {'|'.join(_kinds(dimension))}"

    def schema(self) -> dict[str, Any]:
        region: dict[str, Any] = super().schema()["anyOf"][1]
        return region


def _kinds(dimension: Dimension | None) -> list[str]:
    return (
        [*REGIONS, *ALIAS]
        if dimension is None
        else [*REGIONS]
        if dimension is SOLID
        else ["half-plane", "box", "disc"]
    )
