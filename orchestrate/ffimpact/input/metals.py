"""Metals: the entries of their yield stress, and their checks (docs/explanation/materials.md).
Units are SI.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from ..failure import BadInput, brief
from .dimension import Dimension
from .entries import Entries
from .parameter import Rule, real
from .rules import Vector, number

__all__ = ["OfMetal", "YIELD_ENTRIES", "YieldCurve"]

LARGEST_CURVE = 1000  # points of a table
TABOR = 2.8  # mean pressure of a dent over the yield stress


@dataclass(frozen=True)
class YieldCurve(Rule):
    """A table of true stress [Pa] over logarithmic plastic strain."""

    meaning: str = ""
    strain = number(0, 100, "1")
    stress = number(1e-6, 1e18, "Pa")

    @property
    def accepted(self) -> str:
        return (
            f"1 to {LARGEST_CURVE} pairs [plastic strain, true stress in Pa], strains from 0 on and "
            "growing, stresses above 0 that do not fall"
        )

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, list) or not 1 <= len(value) <= LARGEST_CURVE:
            raise BadInput(f": '{brief(value)}' is no such table (accepted: {self.accepted})")
        for k, pair in enumerate(value, 1):
            if not isinstance(pair, list) or len(pair) != 2:
                raise BadInput(f".{k}: '{brief(pair)}' is no pair (accepted: {self.accepted})")
        curve = [
            [float(rule.checked(x, dimension)) for rule, x in zip((self.strain, self.stress), pair)]
            for pair in value
        ]
        strains, stresses = np.array(curve).T
        if strains[0] != 0 or (np.diff(strains) <= 0).any() or (np.diff(stresses) < 0).any():
            raise BadInput(f": '{brief(value)}' is no such table (accepted: {self.accepted})")
        return curve

    def schema(self) -> dict[str, Any]:
        pair = {"type": "array", "prefixItems": [self.strain.schema(), self.stress.schema()]}
        items = pair | {"minItems": 2, "maxItems": 2}
        return {"type": "array", "items": items, "minItems": 1, "maxItems": LARGEST_CURVE}


class OfMetal(Entries):
    """The entries of the yield stress sigma_y(alpha) r(rate), alpha the equivalent plastic strain:

    sigma_y = yield_stress + hardening alpha + Q (1 - exp(-b alpha)), or a table in place of
    yield_stress; r = 1 + (rate/rate0)^(1/n), or 1 + C ln(rate/rate0) above rate0.
    """

    yield_stress: Annotated[
        float | None, real(0, 1e-6, 1e18, "Pa"), "metal: stress at which it yields"
    ] = None
    yield_curve: Annotated[
        list[list[float]] | None,
        YieldCurve(),
        "metal: in place of yield_stress, pairs [logarithmic plastic strain, true stress in Pa]",
    ] = None
    hardening: Annotated[
        float | None,
        real(0, 0, 1e18, "Pa"),
        "metal: slope of its yield stress over plastic strain",
    ] = None
    voce: Annotated[
        list[float] | None,
        Vector(1e-9, 1e18, 2),
        "metal: [Q, b] adds Q (1 - exp(-b alpha)) [Pa], alpha the plastic strain",
    ] = None
    perzyna: Annotated[
        list[float] | None,
        Vector(1e-9, 1e18, 2),
        "metal: [rate0, n] multiplies the yield stress by 1 + (rate/rate0)^(1/n), rate0 in 1/s, n to 100",
    ] = None
    johnson_cook: Annotated[
        list[float] | None,
        Vector(1e-9, 1e18, 2),
        "metal: [C, rate0] multiplies the yield stress by 1 + C ln(rate/rate0) above rate0 in 1/s",
    ] = None

    @property
    def yield_numbers(self) -> list[float]:
        """The numbers of the yield stress for the kernels: H, Q, b, n, C, rate0, then plastic strain
        and stress of each point of the curve (yieldOf() of edp/kernels/kernels.cpp).
        """
        curve = self.yield_curve or ([[0.0, self.yield_stress]] if self.yield_stress else [])
        if not curve:
            return []
        Q, b = self.voce or (0.0, 0.0)
        rate0, n = self.perzyna or (1.0, 0.0)  # n = 0 and C = 0: no influence of the rate
        C, rate0 = self.johnson_cook or (0.0, rate0)
        return [self.hardening or 0.0, Q, b, n, C, rate0, *np.ravel(curve).tolist()]

    @property
    def hardness(self) -> float:
        """The mean pressure [Pa] of a contact that yields, TABOR sigma_y; infinite without a metal."""
        numbers = self.yield_numbers
        return TABOR * numbers[7] if numbers else math.inf

    def refusals_of_metal(self, young: float) -> Iterator[tuple[str, str]]:
        """Yields what is wrong with the yield stress beside Young's modulus [Pa]."""
        present = [name for name in ("yield_stress", "yield_curve") if name in self]
        if not present:
            yield (
                "yield_stress",
                ": is missing, of law = metal (accepted: yield_stress, or yield_curve)",
            )
        elif len(present) == 2:
            yield "yield_curve", ": beside yield_stress (accepted: one of the two)"
        initial = self.yield_numbers[7] if present else 0.0
        if initial >= young:
            yield present[0], f": {initial:g} Pa is not below young, {young:g} Pa (accepted: less)"
        for entry, at, low, high in (("perzyna", 1, 0.1, 100.0), ("johnson_cook", 0, 0.0, 1.0)):
            if (rate := getattr(self, entry)) and not low <= rate[at] <= high:
                yield (
                    f"{entry}.{at + 1}",
                    f": {rate[at]:g} is out of range (accepted: {low:g} to {high:g})",
                )
        if "perzyna" in self and "johnson_cook" in self:
            yield "johnson_cook", ": beside perzyna (accepted: one of the two)"


YIELD_ENTRIES = tuple(OfMetal.model_fields)
