"""The rule of a single entry of a scene: checks of its value, and messages about refused values."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from ..failure import BadInput, brief, suggestion, unknown

if TYPE_CHECKING:
    from .dimension import Dimension

__all__ = [
    "Parameter",
    "Rule",
    "Table",
    "Value",
    "integer",
    "plain",
    "real",
    "with_unit",
    "word",
]

Value = float | int | str
Table = dict[str, Any]  # a table of a TOML or JSON file

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
# A number with a unit behind it is recognised for messages. A unit is a prefix and a name; the
# factors are those of the prefixes.
PREFIXES = {
    "": 1.0,
    "n": 1e-9,
    "u": 1e-6,
    "µ": 1e-6,
    "μ": 1e-6,
    "m": 1e-3,
    "c": 1e-2,
    "k": 1e3,
    "M": 1e6,
    "G": 1e9,
}
_UNIT = rf"(?:[{''.join(PREFIXES)}]?(?:m|s|g|N|Pa|J|Hz|rad)|km|min|h|t|bar|psi|in|ft|deg(?:rees?)?|°|%)[²³]?(?:\^?-?[0-9])?"
POWERS = {ord("²"): "2", ord("³"): "3", ord("^"): None}
_QUANTITY = re.compile(rf"({_NUMBER.pattern}) *({_UNIT}(?:[*/· ]{_UNIT})*)")
# By the unit of an entry: other units that no prefix makes, and their factors to the entry's unit.
OTHER_UNITS = {
    "-": {"%": 0.01},
    "deg": {"°": 1.0, "degree": 1.0, "degrees": 1.0},
    "kg/m3": {"g/cm3": 1e3},
    "m/s": {"km/h": 1 / 3.6},
}


class Rule:
    """The base of rules: an entry of a model is declared as Annotated[float, rule, meaning]."""

    @property
    def accepted(self) -> str:
        """The accepted values as messages print them."""
        raise NotImplementedError

    @property
    def meaning(self) -> str:
        return ""

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        """Returns the value as the program uses it; `dimension` is that of the scene, if known.

        Raises BadInput if the value is not accepted. The message contains the text behind the
        entry's name: ": 'x' is not a number (accepted: ...)", or ".2: ..." for a component.
        """
        raise NotImplementedError

    def accepted_in(self, dimension: Dimension | None) -> str:
        """The accepted values in a dimension, as messages print them."""
        return self.accepted

    def schema(self) -> dict[str, Any]:
        """The rule as a JSON schema."""
        raise NotImplementedError

    def means(self, text: str) -> Self:
        """The rule with the meaning of its entry."""
        made: Self = replace(self, meaning=text)  # type: ignore[type-var]
        return made

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self._validated)

    def __get_pydantic_json_schema__(
        self, core: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.schema() | ({"description": self.meaning} if self.meaning else {})

    def _validated(self, value: Any, info: ValidationInfo) -> Any:
        try:
            return self.checked(plain(value), (info.context or {}).get("of"))
        except BadInput as error:
            raise ValueError(str(error)) from None


def plain(value: Any) -> Any:
    """A value with the types of TOML: numpy's arrays and numbers, and tuples, are converted."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return {key: plain(item) for key, item in value.items()} if isinstance(value, dict) else value


@dataclass(frozen=True)
class Parameter(Rule):
    """The rule of one parameter.

    `kind` is real, int or word. `low` and `high` bound numbers. `words` are the accepted words; a
    number may have them too (auto).
    """

    name: str
    kind: str
    default: Any  # None: the parameter has no default
    unit: str
    help: str = ""
    low: float = 0.0
    high: float = 0.0
    words: tuple[str, ...] = ()

    @property
    def meaning(self) -> str:
        """The meaning of the parameter, with its unit."""
        return f"{self.help} [{self.unit}]" if self.unit not in ("", "-") else self.help

    def means(self, text: str) -> Self:
        return replace(self, help=text)

    def checked(self, value: Any, dimension: Dimension | None) -> Value:
        return replace(self, name="").check(value)

    def schema(self) -> dict[str, Any]:
        if self.kind == "word":
            return {"enum": list(self.words)}
        number = {
            "type": "integer" if self.kind == "int" else "number",
            "minimum": self.low,
            "maximum": self.high,
        }
        return {"anyOf": [number, {"enum": list(self.words)}]} if self.words else number

    @property
    def accepted(self) -> str:
        """The accepted values, as messages print them."""
        return (
            "|".join(self.words)
            if self.kind == "word"
            else ", ".join([*self.words, f"{self.low:g} to {self.high:g}"])
        )

    def check(self, raw: Any) -> Value:
        """Converts `raw` (text, a TOML value or a number of numpy) to a float, an int or a word.

        Raises BadInput, with the name of the parameter, if the value is not accepted.
        """
        raw = plain(raw)
        if isinstance(raw, str) and raw in self.words:
            return raw
        if self.kind == "word":
            raise BadInput(f"{self.name}: {unknown(raw, self.words)}")
        expected = "a whole number" if self.kind == "int" else "a number"
        is_number = _NUMBER.fullmatch(raw) if isinstance(raw, str) else type(raw) in (int, float)
        if not is_number or (
            self.kind == "int" and not isinstance(raw, int) and float(raw) % 1 != 0
        ):
            problem = (
                isinstance(raw, str) and with_unit(raw, self.unit)
            ) or f"is not {expected}{suggestion(raw, self.words)}"
            raise BadInput(f"{self.name}: '{brief(raw)}' {problem} (accepted: {self.accepted})")
        try:
            value = float(raw)
        except OverflowError:
            value = math.inf
        if not self.low <= value <= self.high:
            raise BadInput(f"{self.name}: {brief(raw)} is out of range (accepted: {self.accepted})")
        return int(value) if self.kind == "int" else value


def with_unit(text: str, unit: str) -> str:
    """The message about a number with a unit, for an entry in `unit`.

    The message contains the converted number if the units are known multiples of each other. It is
    empty if the text is not a number with a unit.
    """
    if not (match := _QUANTITY.fullmatch(text)):
        return ""
    user_unit = match[match.lastindex or 0].translate(POWERS)
    factors = {prefix + unit: factor for prefix, factor in PREFIXES.items()} | OTHER_UNITS.get(
        unit, {}
    )
    number = f": {float(match[1]) * factors[user_unit]:.12g}" if user_unit in factors else ""
    return f"has a unit; give the number {'alone' if unit in ('', '-') else f'in {unit}'}{number}"


def real(default: float | str, low: float, high: float, unit: str) -> Parameter:
    """The rule of a number between two bounds; `auto` is accepted if it is the default."""
    words = ("auto",) if default == "auto" else ()
    number = default if words else float(default)
    return Parameter("", "real", number, unit, "", float(low), float(high), words)


def integer(default: int, low: int, high: int, unit: str) -> Parameter:
    """The rule of a whole number between two bounds."""
    return Parameter("", "int", default, unit, "", low, high)


def word(default: str, words: tuple[str, ...]) -> Parameter:
    """The rule of a choice between words."""
    return Parameter("", "word", default, "-", words=words)
