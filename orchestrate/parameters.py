"""The parameters of a run, read from THE TABLE of edp/core/parameters.idp: nothing is copied by hand."""

import difflib
import math
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .failure import BadInput

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "edp/core/parameters.idp"

Value = float | int | str

NOT_DECISIVE = ("checkpoint_every",)   # parameters that do not change the answer

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_ROW = re.compile(
    r"""^(?:real|int|string)\s+\w+\s*=\s*parameter(?P<kind>Real|Int|Word|Path)\(\s*"(?P<name>\w+)",\s*"""
    r"""(?P<rest>.*?)\);\s*//\s*\[(?P<unit>[^]]*)\]\s*(?P<help>.*?)\s*$""", re.MULTILINE)


@dataclass(frozen=True)
class Parameter:
    """One row of the table. `kind` is real, int, word or path; `low`/`high` bound numbers, `words` lists words."""

    name: str
    kind: str
    default: Value
    unit: str
    help: str
    low: float = 0.0
    high: float = 0.0
    words: tuple[str, ...] = ()

    @property
    def accepted(self) -> str:
        """What is accepted, in the words of the error messages."""
        return "|".join(self.words) if self.kind == "word" else f"{self.low:g} to {self.high:g}"

    def check(self, given: Value) -> Value:
        """`given` (text, or a TOML value) as float, int or word; BadInput where it is not accepted."""
        if self.kind == "word":
            if given not in self.words:
                raise BadInput(f"{self.name}: '{given}' is not known (accepted: {self.accepted})")
            return given
        wanted = "a whole number" if self.kind == "int" else "a number"
        is_number = _NUMBER.fullmatch(given) if isinstance(given, str) else type(given) in (int, float)
        if not is_number or (self.kind == "int" and not isinstance(given, int) and float(given) % 1 != 0):
            raise BadInput(f"{self.name}: '{given}' is not {wanted} (accepted: {self.accepted})")
        try:
            value = float(given)
        except OverflowError:
            value = math.inf
        if not self.low <= value <= self.high:
            raise BadInput(f"{self.name}: {given} is out of range (accepted: {self.accepted})")
        return int(value) if self.kind == "int" else value


@cache
def table() -> dict[str, Parameter]:
    """All parameters by name, in the order of the table."""
    text = TABLE.read_text().partition("// THE TABLE")[2].partition("// END OF THE TABLE")[0]
    rows = {}
    for row in _ROW.finditer(text):
        name, kind = row["name"], row["kind"].lower()
        default, *bounds = [part.strip().strip('"') for part in row["rest"].split(",")]
        common = dict(name=name, kind=kind, unit=row["unit"], help=row["help"])
        if kind == "word":
            rows[name] = Parameter(default=default, words=tuple(bounds[0].split("|")), **common)
        elif kind == "path":
            rows[name] = Parameter(default=default, **common)
        else:
            number = int if kind == "int" else float
            rows[name] = Parameter(default=number(default), low=float(bounds[0]), high=float(bounds[1]), **common)
    return rows


def names() -> list[str]:
    """The parameters that a scene can set (files and folders are not part of a scene)."""
    return [p.name for p in table().values() if p.kind != "path"]


def decisive(values: dict[str, Value]) -> dict[str, Value]:
    """Those of a scene's values that decide its answer: two scenes that agree in them are one run."""
    return {name: value for name, value in values.items() if name not in NOT_DECISIVE}


def check(given: dict[str, Value]) -> dict[str, Value]:
    """The given parameters, checked and converted; BadInput names the first one that is unknown or not accepted."""
    for name in given:
        if name not in names():
            close = difflib.get_close_matches(name, names(), n=2)
            hint = f"; did you mean {' or '.join(close)}?" if close else ""
            raise BadInput(f"{name}: no such parameter{hint} (accepted: {', '.join(names())})")
    return {name: table()[name].check(value) for name, value in given.items()}


def defaults() -> dict[str, Value]:
    """Every parameter of a scene at its default."""
    return {name: table()[name].default for name in names()}


def overrides(texts: list[str]) -> dict[str, str]:
    """The pairs of --set name=value; BadInput where one has another form."""
    pairs = [text.partition("=") for text in texts]
    for name, equals, value in pairs:
        if not (name and equals and value):
            raise BadInput(f"--set: '{name}{equals}{value}' is not of the form name=value")
    return {name.strip(): value.strip() for name, _, value in pairs}
