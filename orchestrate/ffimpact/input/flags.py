"""Generates the flags of the FreeFEM scripts from the table of parameters.

    python -m ffimpact.input.flags

writes the part of edp/core/input/parameters.idp between its two marks.
"""

from itertools import groupby

from ..places import ROOT
from .parameter import Parameter
from .table import PARAMETERS

__all__ = ["FILE", "flags", "variable", "written"]

FILE = ROOT / "edp/core/input/parameters.idp"
BEGIN, END = "// THE TABLE", "// END OF THE TABLE\n"
# FreeFEM variables whose names differ from their flags. The scripts' own dt is that of a step.
OTHERWISE = {"dt": "dtGiven"}
TYPES = {"real": "real", "int": "int", "word": "string", "numbers": "string"}


def flags() -> str:
    """The FreeFEM lines that read the flags; each script reads the flags that it takes."""
    text = f"{BEGIN}, written by python -m ffimpact.input.flags from orchestrate/ffimpact/input/table.py\n"
    for scripts, rows in groupby(PARAMETERS.values(), lambda one: one.scripts):
        text += f'takers = "{"|".join(scripts)}";\n'
        text += "".join(f"{TYPES[one.kind]} {variable(one.name)} = {_call(one)};\n" for one in rows)
    return text + END


def variable(name: str) -> str:
    """The FreeFEM variable of a parameter, in camelCase: FreeFEM's names have no underscore."""
    first, *others = name.split("_")
    return OTHERWISE.get(name, first + "".join(map(str.capitalize, others)))


def _call(one: Parameter) -> str:
    if one.kind == "word":
        return f'parameterWord("{one.name}", "{one.default}",\n  "{"|".join(one.words)}")'
    if one.kind == "numbers":
        return f'parameterNumbers("{one.name}")'
    default = "automatic" if one.default == "auto" else _number(one.default, one.kind)
    kind = "Int" if one.kind == "int" else "Real"
    return f'parameter{kind}("{one.name}", {default}, {_number(one.low, one.kind)}, {_number(one.high, one.kind)})'


def _number(value: float | str, kind: str) -> str:
    """A number as FreeFEM reads it: a real number has a point or an exponent."""
    text = next(form for form in (f"{value:g}", str(value)) if float(form) == value)
    return f"{text}." if kind == "real" and text.lstrip("-").isdigit() else text


def written() -> str:
    """The text of the whole file with a newly generated table."""
    before, _, rest = FILE.read_text().partition(BEGIN)
    return before + flags() + rest.partition(END)[2]


if __name__ == "__main__":
    FILE.write_text(written())
