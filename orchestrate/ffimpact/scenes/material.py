"""Materials of the bodies of a scene: a law with its numbers and damping, in SI units, and the moduli
of waves in it (docs/explanation/materials.md).
"""

import math
from dataclasses import dataclass

from ..failure import BadInput
from ..input import models
from ..input.models import MATERIAL
from ..input.parameters import PARAMETERS, Table

__all__ = ["DAMPING", "Material", "NOT_RIGID", "STIFFEST", "read", "rigid"]

DAMPING = ("viscosity", "bulk_viscosity", "relaxation_modulus", "relaxation_time")
OPTIONAL = ("law_parameters", *DAMPING, "loss")
NOT_RIGID = ("law", "young", "nu", *OPTIONAL)  # entries that a rigid body has not
# Largest nu in the speed of waves. The stiffness by a larger nu acts on the volume of elements.
STIFFEST = 0.45


@dataclass(frozen=True)
class Material:
    """The entries of a material, all of them set."""

    law: str
    young: float
    nu: float
    density: float
    law_parameters: str
    viscosity: float
    bulk_viscosity: float
    relaxation_modulus: float
    relaxation_time: float
    loss: float

    @property
    def damped(self) -> bool:
        """Whether it has any damping."""
        return any((self.viscosity, self.bulk_viscosity, self.relaxation_modulus, self.loss))

    @property
    def damping(self) -> tuple[float, ...]:
        """The values of DAMPING."""
        return tuple(float(getattr(self, name)) for name in DAMPING)

    def moduli(self, thickness: float) -> tuple[float, float]:
        """lambda + 2 mu and mu [Pa] in a wave across a body of this thickness [m]. Damping adds to
        them: they are absolute values at omega = pi / transit (stiffen() of
        edp/program/run/scales.idp).

        The part of lambda above nu = STIFFEST acts on the volume of elements and not in waves.
        """
        nu = min(self.nu, STIFFEST)
        mu, wave = self.young / (2 * (1 + nu)), self.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
        if not self.damped:
            return wave, mu
        turn = 1j * math.pi * math.sqrt(wave / self.density) / thickness
        branch = self.relaxation_modulus * turn / (1 / (self.relaxation_time or 1) + turn)
        shear = abs(mu + turn * self.viscosity + branch)
        return abs(wave - 2 * mu + turn * self.bulk_viscosity) + 2 * shear, shear


def rigid(density: float) -> Material:
    """Returns the material of a rigid body [kg/m3]. Its `young` follows from the other bodies
    (bodies.stiffened()).
    """
    defaults = {key: PARAMETERS[key].default for key in OPTIONAL}
    return Material(law="svk", young=1.0, nu=0.0, density=density, **defaults)


def read(table: models.Body, top: models.Top) -> Material:
    """Returns the material of a body: its own entries, else those at the top of the file. Raises
    BadInput if one is in neither.

    A viscosity of the body replaces a loss at the top of the file, and a loss of the body a
    viscosity there.
    """
    missing = [
        key for key in MATERIAL if key not in table and key not in top and key not in OPTIONAL
    ]
    if missing:
        raise BadInput(
            *(
                f"{table.at(key)}: is missing, here and at the top of the file (accepted: "
                f"{PARAMETERS[key].accepted})"
                for key in missing
            )
        )
    values: Table = {}
    for key in MATERIAL:
        other = {"viscosity": "loss", "loss": "viscosity"}.get(key)
        absent = key not in top or other and other in table
        common = PARAMETERS[key].default if absent else getattr(top, key)
        values[key] = getattr(table, key) if key in table else common
    if values["relaxation_modulus"] == 0 and "relaxation_modulus" in table:
        values["relaxation_time"] = 0.0
    if (values["relaxation_modulus"] > 0) != (values["relaxation_time"] > 0):
        raise BadInput(
            f"{table.at('relaxation_time')}: {values['relaxation_time']:g} s with relaxation_modulus "
            f"{values['relaxation_modulus']:g} Pa (accepted: both above 0, or none)"
        )
    return Material(**values)
