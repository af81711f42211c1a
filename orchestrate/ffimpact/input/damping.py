"""Damping of a material: viscosities, Maxwell branches and the series of branches whose loss factor
is the same over decades of frequency (docs/explanation/materials.md). Units are SI.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from .dimension import Dimension
from .parameter import Rule
from .rules import number

__all__ = [
    "Branches",
    "Damping",
    "FlatLoss",
    "flat",
    "nonnegative",
    "refuse_uneven",
    "times_between",
]

MOST_BRANCHES = 100
PER_DECADE = 2  # number of branches for a decade of frequency
BEYOND = 0.5  # decades between the ends of the range and the outermost relaxation times
UNEVEN = 0.05  # largest accepted deviation of a flat loss factor, over its value


@dataclass(frozen=True)
class Branches(Rule):
    """A list of Maxwell branches, each a modulus [Pa] and a time [s]."""

    meaning: str = ""
    modulus = number(1e-6, 1e18, "Pa")
    time = number(1e-15, 1e9, "s")

    @property
    def accepted(self) -> str:
        return (
            f"0 to {MOST_BRANCHES} pairs [G, tau], G {self.modulus.accepted} Pa, tau "
            f"{self.time.accepted} s"
        )

    def checked(self, value: Any, dimension: Dimension | None) -> Any:
        if not isinstance(value, list) or len(value) > MOST_BRANCHES:
            raise BadInput(f": '{brief(value)}' is no such list (accepted: {self.accepted})")
        return [self._pair(f".{k}", pair, dimension) for k, pair in enumerate(value, 1)]

    def _pair(self, at: str, pair: Any, dimension: Dimension | None) -> list[float]:
        if not isinstance(pair, list) or len(pair) != 2:
            raise BadInput(f"{at}: '{brief(pair)}' is no pair (accepted: {self.accepted})")
        numbers = []
        for k, (rule, value) in enumerate(zip((self.modulus, self.time), pair), 1):
            try:
                numbers.append(float(rule.checked(value, dimension)))
            except BadInput as error:
                raise BadInput(f"{at}.{k}{error}") from None
        return numbers

    def schema(self) -> dict[str, Any]:
        pair = {"type": "array", "prefixItems": [self.modulus.schema(), self.time.schema()]}
        items = pair | {"minItems": 2, "maxItems": 2}
        return {"type": "array", "items": items, "maxItems": MOST_BRANCHES}


@dataclass(frozen=True)
class Damping:
    """Viscosities of shear and of volume [Pa s], and Maxwell branches of both, each a modulus [Pa]
    and a relaxation time [s]. It is false if there is none.
    """

    viscosity: float = 0.0
    bulk_viscosity: float = 0.0
    branches: Sequence[Sequence[float]] = ()
    bulk_branches: Sequence[Sequence[float]] = ()

    def __bool__(self) -> bool:
        return any((self.viscosity, self.bulk_viscosity, self.branches, self.bulk_branches))

    def shear(self, mu: float, omega: float) -> complex:
        """The complex shear modulus [Pa] at the angular frequency omega [1/s]; mu [Pa]: that of the
        law, to which all branches have relaxed.
        """
        return mu + 1j * omega * self.viscosity + _relaxing(self.branches, omega)

    def wave(self, modulus: float, omega: float) -> complex:
        """The complex modulus [Pa] of a pressure wave at omega [1/s]; modulus [Pa]: lambda + 2 mu of
        the law. Branches of shear act on the deviator.
        """
        viscous = 1j * omega * (self.bulk_viscosity + 2 * self.viscosity)
        of_branches = _relaxing(self.bulk_branches, omega) + 4 / 3 * _relaxing(self.branches, omega)
        return modulus + viscous + of_branches

    def shear_in_steps(self, mu: float, omega: float, dt: float) -> complex:
        """The complex shear modulus [Pa] that steps dt [s] have at omega [1/s].

        With the strain e in the middle of a step and theta = 1 - exp(-dt/tau) the dashpot of a branch
        has the strain a, a1 = a0 + theta (e - a0), and the branch the stress G (1 - theta/2) (e - a0);
        in steps dt > tau it is the viscosity G tau (edp/kernels/relaxation.hpp).
        """
        turned, rate = np.exp(1j * omega * dt), 2j * math.tan(omega * dt / 2) / dt
        modulus = mu + 1j * omega * self.viscosity
        for G, tau in self.branches:
            theta = -math.expm1(-dt / tau)
            spring = G * (1 - theta / 2) * (turned - 1) / (turned - 1 + theta)
            modulus += G * tau * rate if dt > tau else spring
        return complex(modulus)

    def longest_step(self, mu: float, omega: float, error: float) -> float:
        """The longest step [s] whose complex shear modulus at omega [1/s] has at most this `error`,
        over its amount, at most half a period; infinite without branches.
        """
        if not self.branches:
            return math.inf
        exact, dt = self.shear(mu, omega), math.pi / omega / 1.1
        while abs(self.shear_in_steps(mu, omega, dt) - exact) > error * abs(exact):
            dt /= 1.1
        return dt


def _relaxing(branches: Sequence[Sequence[float]], omega: float) -> complex:
    """The sum of G i omega tau/(1 + i omega tau) [Pa] over branches."""
    turn = 1j * omega
    return complex(sum(G * turn * tau / (1 + turn * tau) for G, tau in branches))


@dataclass(frozen=True)
class FlatLoss:
    """Maxwell branches with the loss factor tan delta = `loss` between two frequencies [Hz].

    `shares` are the moduli of the branches over the relaxed shear modulus, `times` [s] their
    relaxation times, `deviation` is the largest deviation from the loss in the range, over it.
    """

    loss: float
    lowest: float
    highest: float
    shares: tuple[float, ...]
    times: tuple[float, ...]
    deviation: float

    def branches(self, mu: float) -> list[list[float]]:
        """The branches beside a law with the shear modulus mu [Pa]."""
        return [[mu * share, time] for share, time in zip(self.shares, self.times)]


def times_between(lowest: float, highest: float) -> np.ndarray:
    """Returns relaxation times [s] for angular frequencies [1/s] between two ends, equally spaced on a
    logarithmic scale, PER_DECADE for each decade.
    """
    decades = math.log10(highest / lowest) + 2 * BEYOND
    count = min(round(decades * PER_DECADE) + 1, MOST_BRANCHES)
    return np.geomspace(10**-BEYOND / highest, 10**BEYOND / lowest, count)


def nonnegative(parts: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Returns the moduli (n,) >= 0 whose sum of parts (m, n) is nearest to the `wanted` numbers (m,)."""
    from scipy.optimize import nnls  # takes long to load

    moduli: np.ndarray = nnls(parts, wanted)[0]
    return moduli


@cache
def flat(loss: float, lowest: float, highest: float) -> FlatLoss:
    """Returns the branches with a flat loss factor from `lowest` to `highest` [Hz].

    With x = omega tau_i the condition sum g_i (x - loss x^2)/(1 + x^2) = loss is linear in the
    shares g_i >= 0.
    """
    ends = 2 * np.pi * lowest, 2 * np.pi * highest
    times = times_between(*ends)
    x = np.geomspace(*ends, 40 * len(times))[:, None] * times
    shares = nonnegative((x - loss * x**2) / (1 + x**2), np.full(len(x), loss))
    used = shares > 0
    tangent = (x / (1 + x**2)) @ shares / (1 + (x**2 / (1 + x**2)) @ shares)
    return FlatLoss(
        loss,
        lowest,
        highest,
        tuple(shares[used].tolist()),
        tuple(times[used].tolist()),
        float(abs(tangent / loss - 1).max()),
    )


def refuse_uneven(entry: str, series: FlatLoss) -> None:
    """Raises BadInput if the loss factor of the series is not flat."""
    if series.deviation > UNEVEN:
        raise BadInput(
            f"{entry}: {series.loss:g} deviates by {100 * series.deviation:.2g} % between "
            f"{series.lowest:g} and {series.highest:g} Hz, with {len(series.times)} branches "
            f"(accepted: to {100 * UNEVEN:g} %: a smaller loss, a narrower loss_range, or loss_model = kelvin-voigt)"
        )
