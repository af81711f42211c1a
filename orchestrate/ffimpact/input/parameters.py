"""The parameters of a run by name, and checks of their values."""

import argparse
import re

from ..failure import BadInput, brief, suggestion
from ..places import ROOT as ROOT
from .models import PARAMETERS as PARAMETERS
from .parameter import (
    Parameter as Parameter,
    Table as Table,
    Value as Value,
    with_unit as with_unit,
)

__all__ = [
    "DEPENDS_ON",
    "KEPT",
    "NOT_DECISIVE",
    "OUTPUT",
    "PARAMETERS",
    "Parameter",
    "ROOT",
    "Table",
    "Value",
    "add_set",
    "check",
    "overrides",
    "whole",
    "with_unit",
]

_OF_ENERGY = ("energy", "parameters")
# Entries of a scene that depend on other entries. If one of the other entries is changed and the
# dependent entry is not, the dependent entry is reset to automatic (auto, 0, none).
# `friction_static` sets both coefficients of friction, and `loss` sets the viscosity; the range of a
# flat loss belongs to a material and a size. A law has
# parameters of its own. A penalty belongs to a material, a size and an exponent; a time step
# belongs to a material and a size; mesh sizes belong to a size. `slip_velocity` and `end_time` are
# not reset; they have their own warnings.
DEPENDS_ON = {
    "friction_dynamic": ("friction_static",),
    "viscosity": ("loss",),
    "loss_range": ("young", "mu", *_OF_ENERGY, "density", "radius"),
    **dict.fromkeys(("share", "alpha", "mu", "energy", "parameters"), ("law",)),
    "young": ("mu", *_OF_ENERGY),
    "nu": _OF_ENERGY,
    "penalty": ("young", "mu", *_OF_ENERGY, "density", "material", "radius", "exponent"),
    "dt": ("young", "mu", *_OF_ENERGY, "density", "material", "radius"),
    **dict.fromkeys(("mesh_size", "contact_mesh_size"), ("radius",)),
}

# A value of a dependent entry that does not depend on others: J = 1 with every energy.
KEPT = {"nu": 0.5}

NOT_DECISIVE = ("checkpoint_every",)  # parameters that do not change the results
# Parameters that only request output, with the value that requests none.
OUTPUT = {"fields": 0, "modes": 0}


def check(values: dict[str, Value]) -> dict[str, Value]:
    """Checks and converts parameters by name.

    Raises BadInput with the name of the first parameter that is unknown or not accepted.
    """
    for name in values:
        if name not in PARAMETERS:
            raise BadInput(
                f"{brief(name)}: no such parameter{suggestion(name, PARAMETERS)} (accepted: {', '.join(PARAMETERS)})"
            )
    return {name: PARAMETERS[name].check(value) for name, value in values.items()}


def whole(text: str) -> int:
    """A whole number of the command line, for argparse; raises ValueError for other text."""
    if not re.fullmatch("[0-9]+", text):  # int() would also accept digits of other alphabets
        raise ValueError
    return int(text)


def add_set(parser: argparse.ArgumentParser, meaning: str) -> None:
    """Adds the option --set to a command; `overrides` reads its words."""
    parser.add_argument(
        "--set", metavar="NAME=VALUE", nargs="+", action="extend", default=[], help=meaning
    )


def overrides(texts: list[str]) -> dict[str, Value]:
    """The names and values of --set name=value.

    Raises BadInput if a text has another form or a name occurs more than once.
    """
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
