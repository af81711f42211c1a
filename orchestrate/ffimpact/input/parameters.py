"""The parameters of a run, as the scripts describe them: nothing is copied by hand."""

import math
import re
from dataclasses import dataclass
from functools import cache

from ..failure import BadInput, brief, suggestion, unknown
from ..places import ROOT as ROOT

Value = float | int | str

# What a scene fixes for others of its entries: where one of those is set and it is not, it is open again, as by default (auto, 0).
# friction_static alone sets both coefficients, loss the viscosity; a penalty is of a material, a size and an exponent; a step and meshes
# are of a size. slip_velocity and end_time stay, with their warnings.
FOLLOWS = {"friction_dynamic": ("friction_static",), "viscosity": ("loss",),
           "penalty": ("young", "density", "radius", "exponent"), "dt": ("young", "density", "radius"),
           **dict.fromkeys(("mesh_size", "contact_mesh_size", "block_width", "block_height"), ("radius",))}

NOT_DECISIVE = ("checkpoint_every",)   # parameters that do not change the answer
OUTPUT = {"fields": 0, "modes": 0}     # parameters that only ask for output, with the value that asks for none

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
# A number with a unit behind it: factors of units, of which a prefix and a name make one.
PREFIXES = {"": 1.0, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
_UNIT = rf"(?:[{''.join(PREFIXES)}]?(?:m|s|g|N|Pa|J|Hz|rad)|km|min|h|t|bar|psi|in|ft|deg(?:rees?)?|°|%)[²³]?(?:\^?-?[0-9])?"
POWERS = {ord("²"): "2", ord("³"): "3", ord("^"): None}
_QUANTITY = re.compile(rf"({_NUMBER.pattern}) *({_UNIT}(?:[*/· ]{_UNIT})*)")
# of other units than those that a prefix makes: how many of an entry's own they are
OTHER_UNITS = {"-": {"%": 0.01}, "deg": {"°": 1.0, "degree": 1.0, "degrees": 1.0}, "kg/m3": {"g/cm3": 1e3}, "m/s": {"km/h": 1 / 3.6}}


@dataclass(frozen=True)
class Parameter:
    """One row of the table. `kind` is real, int, word, numbers (text, separated by commas) or path; `low`/`high` bound numbers, `words`
    lists the words that are accepted, beside numbers too (auto); `scripts` those that take it."""

    name: str
    kind: str
    default: Value
    unit: str
    help: str
    low: float = 0.0
    high: float = 0.0
    words: tuple[str, ...] = ()
    scripts: tuple[str, ...] = ()

    @property
    def accepted(self) -> str:
        """What is accepted, in the words of the error messages."""
        if self.kind == "numbers":
            return "none, or numbers separated by commas"
        return "|".join(self.words) if self.kind == "word" else ", ".join([*self.words, f"{self.low:g} to {self.high:g}"])

    def check(self, given: Value) -> Value:
        """`given` (text, a TOML value or a number of numpy) as float, int or word; BadInput where it is not accepted."""
        if type(given).__module__ == "numpy" and hasattr(given, "item"):
            given = given.tolist()
        if isinstance(given, str) and given in self.words:
            return given
        if self.kind == "word":
            raise BadInput(f"{self.name}: {unknown(given, self.words)}")
        if self.kind == "numbers":
            each = given.split(",") if isinstance(given, str) else [str(one) for one in (given if isinstance(given, list) else [given])]
            if not each or not all(_NUMBER.fullmatch(one.strip()) for one in each):
                raise BadInput(f"{self.name}: '{brief(given)}' is no list of numbers (accepted: {self.accepted})")
            return ",".join(one.strip() for one in each)
        wanted = "a whole number" if self.kind == "int" else "a number"
        is_number = _NUMBER.fullmatch(given) if isinstance(given, str) else type(given) in (int, float)
        if not is_number or (self.kind == "int" and not isinstance(given, int) and float(given) % 1 != 0):
            said = (isinstance(given, str) and with_unit(given, self.unit)) or f"is not {wanted}{suggestion(given, self.words)}"
            raise BadInput(f"{self.name}: '{brief(given)}' {said} (accepted: {self.accepted})")
        try:
            value = float(given)
        except OverflowError:
            value = math.inf
        if not self.low <= value <= self.high:
            raise BadInput(f"{self.name}: {brief(given)} is out of range (accepted: {self.accepted})")
        return int(value) if self.kind == "int" else value


def with_unit(text: str, unit: str) -> str:
    """What is wrong with a number that has a unit, where an entry in `unit` is wanted: the number to give, if a prefix makes the
    difference; empty where the text is no number with a unit."""
    if not (found := _QUANTITY.fullmatch(text)):
        return ""
    given = found[found.lastindex].translate(POWERS)
    factors = {prefix + unit: factor for prefix, factor in PREFIXES.items()} | OTHER_UNITS.get(unit, {})
    number = f": {float(found[1]) * factors[given]:.12g}" if given in factors else ""
    return f"has a unit; give the number {'alone' if unit in ('', '-') else f'in {unit}'}{number}"


@cache
def table() -> dict[str, Parameter]:
    """All parameters by name, in the order of the table."""
    from ..freefem.describe import describe  # it looks for FreeFem++: only when the table is wanted
    rows = {}
    for row in describe()["parameters"]:
        words = row.pop("words", [])
        row["words"] = tuple(words.split("|") if isinstance(words, str) else words)
        row["scripts"] = tuple(row["scripts"].split("|"))
        if row["kind"] == "real":
            row |= {name: float(row[name]) for name in ("default", "low", "high") if not isinstance(row[name], str)}
        rows[row["name"]] = Parameter(**row)
    return rows


def names(script: str = "") -> list[str]:
    """The parameters that a scene can set (files and folders are not part of a scene): of one script, or of all."""
    return [p.name for p in table().values() if p.kind != "path" and (not script or script in p.scripts)]


def taken(name: str, script: str) -> None:
    """BadInput where a script does not take a parameter of the table."""
    if script not in table()[name].scripts:
        raise BadInput(f"{brief(name)}: {script} takes no such parameter (accepted: in {'|'.join(table()[name].scripts)})")


def check(given: dict[str, Value], script: str = "") -> dict[str, Value]:
    """The given parameters (of one script, or of all), checked and converted; BadInput names the first that is unknown or not accepted."""
    for name in given:
        if name in names() and script:
            taken(name, script)
        if name not in names():
            raise BadInput(f"{brief(name)}: no such parameter{suggestion(name, names())} (accepted: {', '.join(names(script))})")
    return {name: table()[name].check(value) for name, value in given.items()}


def defaults(script: str = "disc-plane") -> dict[str, Value]:
    """Every parameter of a scene of a script at its default."""
    return {name: table()[name].default for name in names(script)}


def whole(text: str) -> int:
    """A whole number of the command line, for argparse."""
    if not re.fullmatch("[0-9]+", text):   # int() takes the digits of every alphabet
        raise ValueError
    return int(text)


def overrides(texts: list[str]) -> dict[str, str]:
    """The pairs of --set name=value; BadInput where one has another form."""
    pairs = [text.partition("=") for text in texts]
    for name, equals, value in pairs:
        if not (name and equals and value):
            raise BadInput(f"--set: '{brief(name + equals + value)}' is not of the form name=value")
    names = [name.strip() for name, _, _ in pairs]
    for name in names:
        if names.count(name) > 1:
            raise BadInput(f"--set: {brief(name)} is given {names.count(name)} times (accepted: once)")
    return {name.strip(): value.strip() for name, _, value in pairs}
