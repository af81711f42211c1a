"""Materials: their entries, which a body and the top of a scene have too, and one class for each
law (docs/explanation/materials.md). Units are SI.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from pydantic import model_validator

from ..failure import BadInput, brief
from .damping import Branches, Damping, flat
from .dimension import Dimension
from .energies import Energy, Refused, energy
from .entries import Entries, no_more, rule_of
from .metals import YIELD_ENTRIES, OfMetal
from .parameter import real, word
from .rules import Named, Numbers, Text, Vector, number

__all__ = [
    "Hyperelastic",
    "Incompressible",
    "LAWS",
    "LAW_ENTRIES",
    "LAW_WORDS",
    "MADE",
    "MATERIAL",
    "MadeOf",
    "Material",
    "Metal",
    "MooneyRivlin",
    "NOT_RIGID",
    "NeoHookean",
    "OWN_ENTRIES",
    "OfMaterial",
    "Ogden",
    "STIFFEST",
    "SaintVenantKirchhoff",
    "accepted",
    "completed",
    "rigid",
]

# The words of the laws in edp/kernels/laws.cpp.
LAW_WORDS = ("svk", "neohookean", "mooney-rivlin", "ogden", "energy", "incompressible", "metal")
LAW = word("svk", LAW_WORDS).means(
    "constitutive law: St. Venant-Kirchhoff (5), compressible neo-Hookean (6), or another"
)
YOUNG = real(7e6, 1e-6, 1e18, "Pa").means(
    "Young's modulus E; with branches or a flat loss that of slow motions, and impacts are stiffer"
)
NU = real(0.45, 0, 0.5, "-").means(
    "Poisson's ratio; the paper says only nu -> 0.5; 0.5: J = 1, of all laws but svk"
)
DENSITY = real(1722, 1e-15, 1e12, "kg/m3").means("reference density")
LOSS_MODELS = ("flat", "kelvin-voigt")
# Largest nu in the speed of waves. The stiffness by a larger nu acts on the volume of elements.
STIFFEST = 0.45
# The entries of some laws beside young and nu; those without which a law may be; those of the others
# that these make.
LAW_ENTRIES = {
    "mooney-rivlin": ("share",),
    "ogden": ("alpha", "mu"),
    "energy": ("energy", "parameters"),
    "metal": YIELD_ENTRIES,
}
OWN_ENTRIES = {name for entries in LAW_ENTRIES.values() for name in entries}
OPTIONAL = ("parameters", *YIELD_ENTRIES)
MADE = {"ogden": ("young",), "energy": ("nu", "young")}


class OfMaterial(OfMetal, Entries):
    """The entries of a material, which a body and the top of a scene may have, too."""

    law: Annotated[str | None, LAW] = None
    young: Annotated[float | None, YOUNG] = None
    nu: Annotated[float | None, NU] = None
    density: Annotated[float | None, DENSITY] = None
    share: Annotated[
        float | None, number(0.0, 1.0, "-"), "mooney-rivlin: part of I2 in the shear modulus"
    ] = None
    alpha: Annotated[
        list[float] | None, Numbers(-30.0, 30.0, 3), "ogden: exponents of one to three terms"
    ] = None
    mu: Annotated[
        list[float] | None,
        Numbers(-1e18, 1e18, 3),
        "ogden: moduli of the terms [Pa], in place of young",
    ] = None
    energy: Annotated[
        str | None,
        Text(accepted="an expression of I1, I2, J or of L1, L2, L3, J in quotes"),
        "energy: W [J/m3], an expression of the invariants I1, I2 of C and J = det F, or of the "
        "principal stretches L1, L2, L3 and J; in place of young and nu",
    ] = None
    parameters: Annotated[
        dict[str, float] | None,
        Named(-1e18, 1e18),
        "energy: numbers by their names in the expression",
    ] = None
    viscosity: Annotated[
        float | None,
        real(0, 0, 1e18, "Pa s"),
        "viscosity eta of the material: beside the law's stress 2 eta D, D the rate of deformation",
    ] = None
    bulk_viscosity: Annotated[
        float | None,
        real(0, 0, 1e18, "Pa s"),
        "viscosity zeta of volume: beside it zeta tr(D) I",
    ] = None
    branches: Annotated[
        list[list[float]] | None,
        Branches(),
        "Maxwell branches [G, tau] beside the law: G exp(-t/tau) [Pa] is left of the shear modulus "
        "G after t [s]",
    ] = None
    bulk_branches: Annotated[
        list[list[float]] | None,
        Branches(),
        "Maxwell branches [K, tau] of volume: K exp(-t/tau) [Pa] is left of the bulk modulus K",
    ] = None
    loss: Annotated[
        float | None,
        real(0, 0, 10, "-"),
        "loss factor tan delta of shear, by loss_model; 0 = by viscosity and branches",
    ] = None
    loss_model: Annotated[
        str | None,
        word("flat", LOSS_MODELS),
        "what `loss` sets: flat: branches, for all of loss_range; kelvin-voigt: viscosity, for the "
        "first mode of the disc or ball",
    ] = None
    loss_range: Annotated[
        list[float] | None,
        Vector(1e-9, 1e12, 2),
        "flat: lowest and highest frequency [Hz]; without it a tenth to ten times that of the "
        "first mode",
    ] = None

    @classmethod
    def refused(cls, name: str, value: Any, dimension: Dimension | None) -> str:
        if name in ("law_parameters", "relaxation_modulus", "relaxation_time"):
            return no_more(name, value)
        return super().refused(name, value, dimension)


class MadeOf(OfMaterial):
    """The entries of a material of a body or of a layer, which `material` sets together."""

    aliases = {"material": "a Material"}

    @model_validator(mode="before")
    @classmethod
    def _of_material(cls, entries: Any) -> Any:
        """Replaces the entry `material` by the entries of the material; entries of the body win."""
        if not isinstance(entries, dict):
            return entries
        if not isinstance(entries.get("material"), Material | None):
            text = brief(entries["material"])
            raise BadInput(
                f"material: '{text}' is no material (accepted: NeoHookean(young=..., nu=..., density=...), say)"
            )
        own = {name: value for name, value in entries.items() if name != "material"}
        return (entries["material"].table() if "material" in entries else {}) | own


class Material(OfMaterial):
    """The material of a body; `law` is a constitutive law, and the classes below are the laws.

    The laws are in edp/program/law. The damping is of the Kelvin-Voigt type with `viscosity` and
    `bulk_viscosity` [Pa s], or by Maxwell `branches` [Pa, s]; `loss` sets one or the other. With
    branches `young` is the relaxed modulus, that of slow motions.
    """

    law: Annotated[str, LAW]
    young: Annotated[float, YOUNG]
    nu: Annotated[float, NU]
    density: Annotated[float, DENSITY]

    @classmethod
    def names(cls, dimension: Dimension | None) -> list[str]:
        """The names of the entries, without those of other laws."""
        law = cls.model_fields["law"]
        others = set() if law.is_required() else OWN_ENTRIES
        others = others - set(LAW_ENTRIES.get(law.default, ()))
        return [name for name in super().names(dimension) if name not in others]

    def refusals(self) -> Iterator[tuple[str, str]]:
        own = type(self).model_fields["law"]
        if not own.is_required() and self.law != own.default:
            other = LAWS[self.law].__name__ if self.law in LAWS else "Material"
            yield "law", f": '{self.law}' is another law (accepted: {other})"
            return
        yield from self._of_law()
        if self.loss_range and self.loss_range[0] >= self.loss_range[1]:
            yield "loss_range", f": {brief(self.loss_range)} does not grow (accepted: low, high)"
        if self.law == "energy":
            yield from self._of_energy() if "energy" in self else ()
            return
        if self.law == "incompressible" and self.nu != 0.5:
            yield "nu", f": {self.nu:g} of law = incompressible (accepted: 0.5)"
        elif 0.4999 < self.nu < 0.5:
            yield "nu", f": {self.nu:g} is out of range (accepted: 0 to 0.4999, or 0.5: J = 1)"
        limit = self.nu / (1 - 2 * self.nu) if self.nu < 0.5 else np.inf  # lambda / (2 mu)
        if self.law == "mooney-rivlin" and (self.share or 0.0) > limit:
            yield (
                "share",
                f": {self.share:g} with a Poisson's ratio that is too small (accepted: to "
                f"lambda/(2 mu), {limit:g})",
            )
        if self.alpha and self.mu:
            yield from self._of_terms(self.alpha, self.mu)

    def _of_energy(self) -> Iterator[tuple[str, str]]:
        """Yields what the energy lacks."""
        try:
            W = self.expression
        except Refused as refused:
            yield refused.entry, refused.text
            return
        if text := W.refusal(self.nu):
            yield "energy", text
            return
        nu = 0.5 if self.nu == 0.5 else W.nu()
        for name, own, made in (("nu", self.nu, nu), ("young", self.young, W.young(nu))):
            if own is not None and not math.isclose(own, made, rel_tol=1e-6, abs_tol=1e-9):
                other = " or 0.5: J = 1" if name == "nu" else ""
                yield (
                    name,
                    f": {own:g} beside energy, which makes it {made:.9g} (accepted: without it{other})",
                )
                return

    def _of_law(self) -> Iterator[tuple[str, str]]:
        """Yields entries of other laws, and what those of its own lack."""
        taken = LAW_ENTRIES.get(self.law, ())
        for law, entries in LAW_ENTRIES.items():
            for entry in entries:
                if entry in self and entry not in taken:
                    yield entry, f": of law = {law}, not of {self.law} (accepted: without it)"
                if entry not in self and entry in taken and entry not in OPTIONAL:
                    yield entry, f": is missing, of law = {self.law} (accepted: {accepted(entry)})"
        if self.law == "metal":
            yield from self.refusals_of_metal(self.young)
            for entry in ("branches", "loss"):
                if getattr(self, entry):
                    yield entry, ": beside law = metal (accepted: without it, or viscosity)"

    def _of_terms(self, alpha: list[float], mu: list[float]) -> Iterator[tuple[str, str]]:
        """Yields what the terms of ogden lack."""
        if len(alpha) != len(mu):
            yield "mu", f": '{brief(mu)}' beside {len(alpha)} of alpha (accepted: as many)"
            return
        for k, (exponent, modulus) in enumerate(zip(alpha, mu), 1):
            if exponent * modulus <= 0:
                yield (
                    f"mu.{k}",
                    f": {modulus:g} with the exponent {exponent:g} (accepted: an exponent other "
                    "than 0, and a modulus of its sign)",
                )
                return
        stiffness = self.stiffness_of_terms
        if self.young is not None and not np.isclose(self.young, stiffness, rtol=1e-6):
            yield (
                "young",
                f": {self.young:g} beside alpha and mu, which make it {stiffness:.9g} (accepted: "
                "without it)",
            )

    @property
    def stiffness_of_terms(self) -> float:
        """Young's modulus [Pa] of the terms of ogden: half the sum of mu alpha is the shear modulus."""
        return float((1 + self.nu) * np.dot(self.mu or [0.0], self.alpha or [0.0]))

    @property
    def expression(self) -> Energy:
        """The energy of law = energy. Raises Refused."""
        return energy(self.energy, self.parameters or {})

    @property
    def made(self) -> dict[str, float]:
        """The entries that those of the law make, without nu = 0.5 of law = energy. Raises Refused."""
        if self.law == "ogden":
            return {"young": self.stiffness_of_terms}
        W = self.expression
        if text := W.refusal(self.nu):
            raise Refused("energy", text)
        nu = 0.5 if self.nu == 0.5 else W.nu()
        return {"nu": nu, "young": W.young(nu)}

    @property
    def projectable(self) -> bool:
        """Whether it has a part of the volume that can act on element means (edp/program/law)."""
        return self.nu > STIFFEST and (
            self.law != "energy" or self.numbers[1] > 0 or self.nu == 0.5
        )

    @property
    def numbers(self) -> list[float]:
        """The numbers of the law for the kernels (edp/kernels/laws.cpp): a share of the shear modulus,
        each exponent with such a share, the programs of the energy, or those of the yield stress.
        """
        if self.law == "metal":
            return self.yield_numbers
        if self.law == "energy":
            return self.expression.numbers(self.nu == 0.5)
        if self.law != "ogden":
            return [self.share] if self.share is not None else []
        parts = np.multiply(self.mu or [], self.alpha or [])
        return np.column_stack([self.alpha or [], parts / parts.sum()]).ravel().tolist()

    @property
    def damped(self) -> bool:
        """Whether it has any damping."""
        return any(
            (self.viscosity, self.bulk_viscosity, self.branches, self.bulk_branches, self.loss)
        )

    @property
    def damping(self) -> Damping:
        """Its viscosities and Maxwell branches, without what loss_model = "kelvin-voigt" sets."""
        branches = self.branches or []
        if self.loss and self.loss_model == "flat" and self.loss_range:
            shear = self.young / (2 * (1 + self.nu))
            branches = flat(self.loss, *self.loss_range).branches(shear)
        return Damping(
            self.viscosity or 0.0, self.bulk_viscosity or 0.0, branches, self.bulk_branches or []
        )

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
        omega = math.pi * math.sqrt(wave / self.density) / thickness
        return abs(self.damping.wave(wave, omega)), abs(self.damping.shear(mu, omega))


class SaintVenantKirchhoff(Material):
    """St. Venant-Kirchhoff law, S = lambda tr(E) I + 2 mu E, paper (5)."""

    law: Annotated[str, LAW] = "svk"


class NeoHookean(Material):
    """Compressible neo-Hookean law, paper (6)."""

    law: Annotated[str, LAW] = "neohookean"


class Incompressible(Material):
    """Incompressible neo-Hookean law, J = 1."""

    law: Annotated[str, LAW] = "incompressible"
    nu: Annotated[float, NU] = 0.5


class MooneyRivlin(Material):
    """Mooney-Rivlin law, W = mu/2 ((1 - s) I1 + s I2) and terms of det F; s is the `share`."""

    law: Annotated[str, LAW] = "mooney-rivlin"


class Ogden(Material):
    """Ogden's law, W = sum of mu_k/alpha_k (l1^alpha_k + l2^alpha_k + l3^alpha_k - 3) and terms of
    det F, with one to three terms; `young` follows from them.
    """

    law: Annotated[str, LAW] = "ogden"
    young: Annotated[float | None, YOUNG] = None  # type: ignore[assignment]


class Metal(Material):
    """Metal: J2 plasticity of finite strain by logarithmic strain (Hencky), with isotropic hardening.
    `yield_stress` or a `yield_curve`, `hardening`, `voce`; `perzyna` or `johnson_cook`.
    """

    law: Annotated[str, LAW] = "metal"


class Hyperelastic(Material):
    """A law by its energy W [J/m3], an expression of I1, I2, J or of L1, L2, L3, J.

    Parameters are keywords:
    Hyperelastic("c10*(I1-3) - 2*c10*log(J) + k/2*log(J)^2", c10=1e6, k=1e7, density=1100).
    `young` and `nu` follow, except nu = 0.5: J = 1. Yeoh, Gent, ArrudaBoyce, BlatzKo and Hyperfoam
    make energies of the literature.
    """

    law: Annotated[str, LAW] = "energy"
    nu: Annotated[float | None, NU] = None  # type: ignore[assignment]
    young: Annotated[float | None, YOUNG] = None  # type: ignore[assignment]

    if TYPE_CHECKING:

        def __init__(self, energy: str = "", /, **entries: Any) -> None: ...

    @classmethod
    def named(cls, unnamed: tuple[Any, ...], entries: dict[str, Any]) -> dict[str, Any]:
        own = {name: value for name, value in entries.items() if name in cls.names(None)}
        parameters = {name: value for name, value in entries.items() if name not in own}
        if unnamed:
            own["energy"] = unnamed[0]
        if parameters:
            own["parameters"] = (own.get("parameters") or {}) | parameters
        return super().named(unnamed[1:], own)


LAWS: dict[str, type[Material]] = {
    model.model_fields["law"].default: model
    for model in (
        SaintVenantKirchhoff,
        NeoHookean,
        Incompressible,
        MooneyRivlin,
        Ogden,
        Hyperelastic,
        Metal,
    )
}
MATERIAL = tuple(OfMaterial.model_fields)
NOT_RIGID = tuple(
    name for name in MATERIAL if name != "density"
)  # entries that a rigid body has not


def accepted(name: str) -> str:
    """Returns the accepted values of an entry, as messages print them."""
    rule = rule_of(OfMaterial, name)
    return rule.accepted if rule else ""


NEEDED = ("law", "young", "nu", "density")
UNDAMPED: dict[str, Any] = dict.fromkeys(("viscosity", "bulk_viscosity", "loss"), 0.0)
UNDAMPED["loss_model"] = LOSS_MODELS[0]


def _replaced(name: str, table: OfMaterial) -> bool:
    """Whether damping of the body itself replaces this entry at the top of the file."""
    if name.startswith("loss"):
        return "viscosity" in table or "branches" in table
    return name in ("viscosity", "branches") and "loss" in table


def rigid(density: float) -> Material:
    """Returns the material of a rigid body [kg/m3]. Its `young` follows from the other bodies."""
    return Material.model_construct(law="svk", young=1.0, nu=0.0, density=density, **UNDAMPED)


def completed(table: OfMaterial, top: OfMaterial) -> Material:
    """Returns the material of a body: its own entries, else those at the top of the scene, else
    defaults. Raises BadInput if one without a default is in neither.

    Viscosity or branches of the body replace a loss at the top of the file, and a loss of the body
    both; the law of a body replaces the entries of another law there.
    """
    law = table.law or top.law or ""
    made, own = (
        MADE.get(law, ()),
        [name for name in LAW_ENTRIES.get(law, ()) if name not in OPTIONAL],
    )
    needed = [name for name in (*NEEDED, *own) if name not in made]
    missing = [name for name in needed if name not in table and name not in top]
    if missing:
        raise BadInput(
            *(
                f"{table.at(name)}: is missing, "
                f"{f'of law = {law}' if name in own else 'here and at the top of the file'} (accepted: "
                f"{accepted(name)})"
                for name in missing
            )
        )
    values: dict[str, Any] = dict.fromkeys(MATERIAL) | UNDAMPED
    for name in MATERIAL:
        of_another_law = table.law not in (None, top.law) and name in OWN_ENTRIES
        if name in table:
            values[name] = getattr(table, name)
        elif name in top and not of_another_law and not _replaced(name, table):
            values[name] = getattr(top, name)
    if (
        values["loss"]
        and values["loss_model"] == "flat"
        and (values["branches"] or values["viscosity"])
    ):
        name = "branches" if values["branches"] else "viscosity"
        raise BadInput(
            f"{table.at(name)}: '{brief(values[name])}' beside loss_model = 'flat', which sets branches "
            "(accepted: one of the two)"
        )
    for name in made:
        # those at the top are of other bodies
        if name not in table and any(entry in table for entry in LAW_ENTRIES[law]):
            values[name] = None
    if made:
        try:
            follow = Material.model_construct(**values).made
        except Refused as refused:
            raise BadInput(f"{table.at(refused.entry)}{refused.text}") from None
        values |= {name: number for name, number in follow.items() if values[name] is None}
    return Material.model_construct(**values)
