"""The parameters of a run by name, and checks of what is given for them."""

import argparse
import re

from ..failure import BadInput, brief, suggestion
from ..places import ROOT as ROOT
from .parameter import Parameter as Parameter, Value as Value, with_unit as with_unit
from .table import PARAMETERS as PARAMETERS

__all__ = [
    "FOLLOWS",
    "NOT_DECISIVE",
    "OUTPUT",
    "PARAMETERS",
    "Parameter",
    "ROOT",
    "Value",
    "add_set",
    "check",
    "defaults",
    "names",
    "overrides",
    "taken",
    "whole",
    "with_unit",
]

# What a scene fixes for others of its entries: where one of those is set and it is not, it is open
# again, as by default (auto, 0). friction_static alone sets both coefficients, loss the viscosity;
# a penalty is of a material, a size and an exponent; a step and meshes are of a size. slip_velocity
# and end_time stay, with their warnings.
FOLLOWS = {
    "friction_dynamic": ("friction_static",),
    "viscosity": ("loss",),
    "penalty": ("young", "density", "radius", "exponent"),
    "dt": ("young", "density", "radius"),
    **dict.fromkeys(("mesh_size", "contact_mesh_size", "block_width", "block_height"), ("radius",)),
}

NOT_DECISIVE = ("checkpoint_every",)  # parameters that do not change the answer
OUTPUT = {
    "fields": 0,
    "modes": 0,
}  # parameters that only ask for output, with the value that asks for none


def names(script: str = "") -> list[str]:
    """The parameters of one script, or of all."""
    return [one.name for one in PARAMETERS.values() if not script or script in one.scripts]


def taken(name: str, script: str) -> None:
    """BadInput where a script does not take a parameter of the table."""
    if script not in PARAMETERS[name].scripts:
        raise BadInput(
            f"{brief(name)}: {script} takes no such parameter (accepted: in {'|'.join(PARAMETERS[name].scripts)})"
        )


def check(given: dict[str, Value], script: str = "") -> dict[str, Value]:
    """The given parameters (of one script, or of all), checked and converted; BadInput names
    the first that is unknown or not accepted.
    """
    for name in given:
        if name in names() and script:
            taken(name, script)
        if name not in names():
            raise BadInput(
                f"{brief(name)}: no such parameter{suggestion(name, names())} (accepted: {', '.join(names(script))})"
            )
    return {name: PARAMETERS[name].check(value) for name, value in given.items()}


def defaults(script: str = "disc-plane") -> dict[str, Value]:
    """Every parameter of a scene of a script at its default."""
    return {name: PARAMETERS[name].default for name in names(script)}


def whole(text: str) -> int:
    """A whole number of the command line, for argparse."""
    if not re.fullmatch("[0-9]+", text):  # int() takes the digits of every alphabet
        raise ValueError
    return int(text)


def add_set(parser: argparse.ArgumentParser, meaning: str) -> None:
    """The option --set of a command, whose words overrides() reads."""
    parser.add_argument(
        "--set", metavar="NAME=VALUE", nargs="+", action="extend", default=[], help=meaning
    )


def overrides(texts: list[str]) -> dict[str, str]:
    """The pairs of --set name=value; BadInput where one has another form."""
    pairs = [text.partition("=") for text in texts]
    for name, equals, value in pairs:
        if not (name and equals and value):
            raise BadInput(f"--set: '{brief(name + equals + value)}' is not of the form name=value")
    names = [name.strip() for name, _, _ in pairs]
    for name in names:
        if names.count(name) > 1:
            raise BadInput(
                f"--set: {brief(name)} is given {names.count(name)} times (accepted: once)"
            )
    return {name.strip(): value.strip() for name, _, value in pairs}
