"""The rules of entries of bodies, obstacles, supports and loads that are not parameters of a run.

The entries are points, lists of points, names, functions of time and parts of a boundary, in SI
units. The rules of single parameters are in parameter.py.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from ..failure import BadInput, brief, suggestion
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .parameter import Parameter, Rule

__all__ = [
    "ALIAS",
    "Flag",
    "Function",
    "InSpace",
    "LONGEST",
    "Name",
    "Partners",
    "Place",
    "Points",
    "Polygons",
    "REGIONS",
    "SHORTEST",
    "Text",
    "Vector",
    "Where",
    "number",
    "placeholder",
    "points",
    "vector",
]

LONGEST = 1e9  # largest accepted length [m] and velocity [m/s]
# Largest number of points of a polygon or a chain, whose sides are compared with each other.
MOST = 2000
SHORTEST = 1e-9  # smallest accepted length [m]
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")
# The two entries of each kind of region. Points and directions have a component for each axis; a
# radius is a number.
REGIONS = {"half-space": ("point", "normal"), "box": ("low", "high"), "ball": ("centre", "radius")}
ALIAS = {"half-plane": "half-space", "disc": "ball"}  # names of regions in the plane


def number(
    low: float = SHORTEST, high: float = LONGEST, unit: str = "m", meaning: str = ""
) -> Parameter:
    """The rule of a number between two bounds; without bounds the rule of a length [m]."""
    return Parameter("", "real", None, unit, meaning, low, high)


def placeholder(count: int) -> str:
    """The form of a point with `count` components as messages print it: [x, y, z]."""
    return f"[{', '.join('xyz'[:count])}]"


def vector(given: Any, count: int, low: float, high: float, at: str = "") -> list[float]:
    """Checks a list of `count` numbers between two bounds.

    Raises BadInput otherwise; its message begins with `at`, the text behind the entry's name.
    """
    if not isinstance(given, list | tuple) or len(given) != count:
        raise BadInput(
            f"{at}: '{brief(given)}' is no {placeholder(count)} (accepted: {('two', 'three')[count - 2]} numbers, each "
            f"{low:g} to {high:g})"
        )
    return [
        float(Parameter(f"{at}.{k}", "real", None, "", "", low, high).check(one))
        for k, one in enumerate(given, 1)
    ]


def points(given: Any, least: int, at: str = "") -> list[list[float]]:
    """Checks a list of at least `least` points [x, y].

    Raises BadInput otherwise; its message begins with `at`, the text behind the entry's name.
    """
    if not isinstance(given, list) or len(given) < least:
        raise BadInput(
            f"{at}: '{brief(given)}' is too little (accepted: {least} points [x, y] or more)"
        )
    if len(given) > MOST:
        raise BadInput(f"{at}: {len(given)} points (accepted: {least} to {MOST})")
    return [vector(one, 2, -LONGEST, LONGEST, f"{at}.{k}") for k, one in enumerate(given, 1)]


@dataclass(frozen=True)
class Vector(Rule):
    """A vector with a component for each axis, or with `count` components."""

    meaning: str = ""
    low: float = -LONGEST
    high: float = LONGEST
    count: int = 0

    @property
    def accepted(self) -> str:  # type: ignore[override]
        return self.accepted_in(PLANE_STRAIN)

    def accepted_in(self, of: Dimension | None) -> str:
        return f"{placeholder(self.count or (of.axes if of else 2))}, each {self.low:g} to {self.high:g}"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        open_count = len(given) if isinstance(given, list) and len(given) in (2, 3) else 2
        return vector(given, self.count or (of.axes if of else open_count), self.low, self.high)

    def schema(self) -> dict[str, Any]:
        one = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {
            "type": "array",
            "items": one,
            "minItems": self.count or 2,
            "maxItems": self.count or 3,
        }


@dataclass(frozen=True)
class Place(Vector):
    """A position or a vector; for bodies of revolution along the axis, [0, y] or y alone."""

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if of in (AXISYMMETRIC, None) and not isinstance(given, list):
            y = number(self.low, self.high, "").checked(given, of)
            return [0.0, y] if of else y
        found = super().checked(given, of)
        if of is AXISYMMETRIC and found[0] != 0:
            raise BadInput(
                f": x is {found[0]:g}, off the axis of revolution (accepted: [0, y], or y alone)"
            )
        return found

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
    meaning: str = ""
    about_z: bool = True
    low: float | None = None

    @property
    def accepted(self) -> str:  # type: ignore[override]
        return self.plane.accepted

    @property
    def _vector(self) -> Vector:
        return Vector("", self.plane.low if self.low is None else self.low, self.plane.high, 3)

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if of is PLANE_STRAIN or not isinstance(given, list) and (of is None or self.about_z):
            found = self.plane.checked(given, of)
            return [0.0, 0.0, found] if of is SOLID else found
        return self._vector.checked(given, of)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.plane.schema(), self._vector.schema()]}


@dataclass(frozen=True)
class Points(Rule):
    """A list of at least `least` points [x, y]."""

    least: int = 3
    meaning: str = ""

    @property
    def accepted(self) -> str:  # type: ignore[override]
        return f"{self.least} points [x, y] or more"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        return points(given, self.least)

    def schema(self) -> dict[str, Any]:
        return {
            "type": "array",
            "items": Vector(count=2).schema(),
            "minItems": self.least,
            "maxItems": MOST,
        }


@dataclass(frozen=True)
class Polygons(Rule):
    """A list of polygons."""

    meaning: str = ""
    accepted: str = "[[[x, y], ...], ...]"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if not isinstance(given, list):
            raise BadInput(f": '{brief(given)}' is no list of polygons (accepted: {self.accepted})")
        return [points(one, 3, f".{k}") for k, one in enumerate(given, 1)]

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Points().schema()}


@dataclass(frozen=True)
class Flag(Rule):
    """A truth value: true or false."""

    meaning: str = ""
    accepted: str = "true|false"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if not isinstance(given, bool):
            raise BadInput(
                f": '{brief(given)}' is neither true nor false (accepted: {self.accepted})"
            )
        return given

    def schema(self) -> dict[str, Any]:
        return {"type": "boolean"}


@dataclass(frozen=True)
class Text(Rule):
    """Any text."""

    meaning: str = ""
    accepted: str = "text in quotes"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if not isinstance(given, str):
            raise BadInput(f": '{brief(given)}' is no text (accepted: text in quotes)")
        return given

    def schema(self) -> dict[str, Any]:
        return {"type": "string"}


@dataclass(frozen=True)
class Name(Rule):
    """A name, which is written as one word to data files."""

    meaning: str = ""
    accepted: str = "letters, digits, _ - . without blanks, a letter first"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if not isinstance(given, str) or not NAME.fullmatch(given):
            raise BadInput(f": '{brief(given)}' is no name (accepted: {self.accepted})")
        return given

    def schema(self) -> dict[str, Any]:
        return {"type": "string", "pattern": f"^{NAME.pattern}$"}


@dataclass(frozen=True)
class Partners(Rule):
    """The names of a contact pair; scenes/scene.py looks them up in the scene."""

    meaning: str = ""
    accepted: str = "two names, one at least of a body"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        return given

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": Text().schema(), "minItems": 2, "maxItems": 2}


@dataclass(frozen=True)
class Function(Rule):
    """Functions of time, one for each component, or a `single` function of one quantity.

    time_functions.py checks them.
    """

    meaning: str = ""
    single: bool = False
    accepted: str = "numbers, expressions of t in quotes, a CSV file or a table"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        return given

    def schema(self) -> dict[str, Any]:
        kinds = ["string", "object", "number"] if self.single else ["string", "object", "array"]
        return {"type": kinds}


@dataclass(frozen=True)
class Where(Rule):
    """A part of a body's boundary: a side, a group of its file, or a region of space.

    An example of a region is {kind = "half-space", point, normal}.
    """

    sides: tuple[str, ...] = ()
    meaning: str = "a side, the name of a group of its file, or a region"

    @property
    def accepted(self) -> str:  # type: ignore[override]
        return self.accepted_in(SOLID)

    def accepted_in(self, of: Dimension | None) -> str:
        axial = {"axis": AXISYMMETRIC, "front": SOLID, "back": SOLID}
        names = [one for one in self.sides if axial.get(one, of) is of or of is None]
        return f"{', '.join(names)}, the name of a group of its file, or a region {'|'.join(_kinds(of))}"

    def checked(self, given: Any, of: Dimension | None) -> Any:
        if isinstance(given, str):
            return given
        if not isinstance(given, dict) or given.get("kind") not in _kinds(of):
            raise BadInput(
                f": '{brief(given)}' is no part of a boundary (accepted: {self.accepted_in(of)})"
            )
        first, second = REGIONS[ALIAS.get(given["kind"], given["kind"])]
        accepted = ("kind", first, second)
        for key in [key for key in given if key not in accepted]:
            said = f"set to '{brief(given[key])}'{suggestion(key, accepted)} (accepted: {', '.join(accepted)})"
            raise BadInput(f".{brief(key)}: no such entry, {said}")
        each = Vector()
        for key in (first, second):
            if key not in given:
                accepted = number().accepted if key == "radius" else each.accepted_in(of)
                raise BadInput(f".{key}: is missing (accepted: {accepted})")
        found = {"kind": given["kind"]}
        for key in (first, second):
            try:
                found[key] = (number() if key == "radius" else each).checked(given[key], of)
            except BadInput as error:
                raise BadInput(f".{key}{error}") from None
        if second == "normal" and not any(found[second]):
            raise BadInput(
                f".normal: '{brief(given[second])}' has no direction (accepted: other than 0)"
            )
        if second == "high" and any(high < low for low, high in zip(found[first], found[second])):
            raise BadInput(f".high: '{brief(given[second])}' is below low (accepted: from low on)")
        return found

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


def _kinds(of: Dimension | None) -> list[str]:
    return (
        [*REGIONS, *ALIAS]
        if of is None
        else [*REGIONS]
        if of is SOLID
        else ["half-plane", "box", "disc"]
    )
