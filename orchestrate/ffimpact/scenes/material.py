"""Completes the materials of the bodies of a scene: with entries at its top and with defaults, in SI
units (docs/explanation/materials.md).
"""

from typing import Any

from ..failure import BadInput
from ..input import models
from ..input.bodies import Body
from ..input.materials import DAMPING, LAW_ENTRIES, MATERIAL, Material
from ..input.parameters import PARAMETERS

__all__ = ["read", "rigid"]

NEEDED = ("law", "young", "nu", "density")
DEFAULTS = {name: PARAMETERS[name].default for name in (*DAMPING, "loss")}


def rigid(density: float) -> Material:
    """Returns the material of a rigid body [kg/m3]. Its `young` follows from the other bodies
    (bodies.stiffened()).
    """
    return Material.model_construct(law="svk", young=1.0, nu=0.0, density=density, **DEFAULTS)


def read(table: Body, top: models.Top) -> Material:
    """Returns the material of a body: its own entries, else those at the top of the file. Raises
    BadInput if one is in neither.

    A viscosity of the body replaces a loss at the top of the file, and a loss of the body a
    viscosity there; the law of a body replaces the entries of another law there.
    """
    law = table.law or top.law
    of_law = LAW_ENTRIES.get(law or "", ())
    has_terms = law == "ogden" and all(name in table or name in top for name in of_law)
    needed = [name for name in NEEDED if not (name == "young" and has_terms)]
    missing = [name for name in needed if name not in table and name not in top]
    if missing:
        raise BadInput(
            *(
                f"{table.at(name)}: is missing, here and at the top of the file (accepted: "
                f"{PARAMETERS[name].accepted})"
                for name in missing
            )
        )
    values: dict[str, Any] = dict.fromkeys(MATERIAL) | DEFAULTS
    for name in MATERIAL:
        other = {"viscosity": "loss", "loss": "viscosity"}.get(name)
        of_another_law = table.law not in (None, top.law) and name in ("share", "alpha", "mu")
        if name in table:
            values[name] = getattr(table, name)
        elif name in top and not (other and other in table) and not of_another_law:
            values[name] = getattr(top, name)
    if values["relaxation_modulus"] == 0 and "relaxation_modulus" in table:
        values["relaxation_time"] = 0.0
    if (values["relaxation_modulus"] > 0) != (values["relaxation_time"] > 0):
        raise BadInput(
            f"{table.at('relaxation_time')}: {values['relaxation_time']:g} s with relaxation_modulus "
            f"{values['relaxation_modulus']:g} Pa (accepted: both above 0, or none)"
        )
    if has_terms and "mu" in table and "young" not in table:
        values["young"] = None  # that at the top is of other bodies
    if has_terms and values["young"] is None:
        values["young"] = Material.model_construct(**values).stiffness_of_terms
    return Material.model_construct(**values)
