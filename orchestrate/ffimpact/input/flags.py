"""Generates the flags of the FreeFEM scripts from the table of parameters.

    python -m ffimpact.input.flags

writes the part of edp/program/input/parameters.idp between its two marks.
"""

from itertools import groupby

from ..places import ROOT
from .parameter import Parameter
from .table import PARAMETERS

__all__ = ["FILE", "flags", "variable", "written"]

FILE = ROOT / "edp/program/input/parameters.idp"
BEGIN, END = "// THE TABLE", "// END OF THE TABLE\n"
# FreeFEM variables whose names differ from their flags. The scripts' own dt is that of a step, and
# start is the name of arguments.
OTHERWISE = {"dt": "dtGiven", "start": "startState"}
TYPES = {"real": "real", "int": "int", "word": "string", "numbers": "string"}


def flags() -> str:
    """The FreeFEM lines that read the flags; each script reads the flags that it takes. Entries of
    bodies are no flags.
    """
    text = f"{BEGIN}, written by python -m ffimpact.input.flags from orchestrate/ffimpact/input/table.py\n"
    for scripts, rows in groupby(PARAMETERS.values(), lambda parameter: parameter.scripts):
        if not scripts:
            continue
        text += f'takers = "{"|".join(scripts)}";\n'
        text += "".join(
            f"{TYPES[parameter.kind]} {variable(parameter.name)} = {_call(parameter)};\n"
            for parameter in rows
        )
    return text + END


def variable(name: str) -> str:
    """The FreeFEM variable of a parameter, in camelCase: FreeFEM's names have no underscore."""
    first, *others = name.split("_")
    return OTHERWISE.get(name, first + "".join(map(str.capitalize, others)))


def _call(parameter: Parameter) -> str:
    if parameter.kind == "word":
        return (
            f'parameterWord("{parameter.name}", "{parameter.default}",\n'
            f'  "{"|".join(parameter.words)}")'
        )
    if parameter.kind == "numbers":
        return f'parameterNumbers("{parameter.name}")'
    default = (
        "automatic" if parameter.default == "auto" else _number(parameter.default, parameter.kind)
    )
    kind = "Int" if parameter.kind == "int" else "Real"
    return (
        f'parameter{kind}("{parameter.name}", {default}, '
        f"{_number(parameter.low, parameter.kind)}, {_number(parameter.high, parameter.kind)})"
    )


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
