"""Hyperelastic laws of the literature as energies: each makes the expression of a Hyperelastic.

Those of rubber have the isochoric invariant I1 J^(-2/3) and a volume term with the bulk modulus k
[Pa]; without k J = 1. Further entries are those of a material: density, viscosity, branches ...
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from .materials import Hyperelastic

__all__ = ["ArrudaBoyce", "BlatzKo", "Gent", "Hyperfoam", "Yeoh"]

I1 = "(I1*J^(-2/3)-3)"  # of the isochoric C, minus 3
# The series of the inverse Langevin function for this invariant, over mu.
CHAINS = (
    "1/2*(X-3) + 1/20/n*(X^2-9) + 11/1050/n^2*(X^3-27) + 19/7000/n^3*(X^4-81) "
    "+ 519/673750/n^4*(X^5-243)"
).replace("X", "(I1*J^(-2/3))")


def _of_rubber(
    terms: str, numbers: dict[str, float], k: float | None, more: dict[str, Any]
) -> Hyperelastic:
    if k is None:
        return Hyperelastic(terms, parameters=numbers, **{"nu": 0.5, **more})
    volume = "k/4*(J^2 - 1 - 2*log(J))"
    return Hyperelastic(f"{terms} + {volume}", parameters=numbers | {"k": k}, **more)


def Yeoh(
    c10: float, c20: float = 0.0, c30: float = 0.0, k: float | None = None, **more: Any
) -> Hyperelastic:
    """Yeoh's law (1993): W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3 [Pa]; mu = 2 c10."""
    numbers = {"c10": c10, "c20": c20, "c30": c30}
    return _of_rubber(f"c10*{I1} + c20*{I1}^2 + c30*{I1}^3", numbers, k, more)


def Gent(mu: float, jm: float, k: float | None = None, **more: Any) -> Hyperelastic:
    """Gent's law (1996): W = -mu jm/2 ln(1 - (I1 - 3)/jm); chains are stretched out at I1 - 3 = jm."""
    return _of_rubber(f"-mu*jm/2*log(1 - {I1}/jm)", {"mu": mu, "jm": jm}, k, more)


def ArrudaBoyce(mu: float, n: float, k: float | None = None, **more: Any) -> Hyperelastic:
    """The eight-chain law of Arruda and Boyce (1993) with n segments between crosslinks, in five
    terms: W = mu [(I1 - 3)/2 + (I1^2 - 9)/(20 n) + ...].
    """
    return _of_rubber(f"mu*({CHAINS})", {"mu": mu, "n": n}, k, more)


def BlatzKo(mu: float, **more: Any) -> Hyperelastic:
    """The law of Blatz and Ko (1962) for foamed rubber, nu = 1/4: W = mu/2 (I2/J^2 + 2 J - 5)."""
    return Hyperelastic("mu/2*(I2/J^2 + 2*J - 5)", parameters={"mu": mu}, **more)


def Hyperfoam(
    mu: Sequence[float], alpha: Sequence[float], nu: Sequence[float], **more: Any
) -> Hyperelastic:
    """Foams (Ogden, Storakers): W = sum of 2 mu/alpha^2 [L1^alpha + L2^alpha + L3^alpha - 3
    + (J^(-alpha beta) - 1)/beta], beta = nu/(1 - 2 nu), with a mu [Pa], alpha and nu < 1/2 each.
    """
    columns = [np.atleast_1d(numbers) for numbers in (mu, alpha, nu)]
    if len({len(column) for column in columns}) != 1 or not (columns[2] < 0.5).all():
        raise BadInput(
            f"Hyperfoam: '{brief(nu)}' of nu (accepted: as many as of mu and alpha, each below 0.5)"
        )
    terms: list[str] = []
    numbers: dict[str, float] = {}
    for j, (modulus, power, ratio) in enumerate(zip(*columns), 1):
        beta = float(ratio / (1 - 2 * ratio))
        numbers |= {f"mu{j}": float(modulus), f"alpha{j}": float(power)}
        volume = f"-alpha{j}*log(J)"
        if beta:
            numbers[f"beta{j}"] = beta
            volume = f"(J^(-alpha{j}*beta{j}) - 1)/beta{j}"
        powers = " + ".join(f"L{i}^alpha{j}" for i in (1, 2, 3))
        terms.append(f"2*mu{j}/alpha{j}^2*({powers} - 3 + {volume})")
    return Hyperelastic(" + ".join(terms), parameters=numbers, **more)
