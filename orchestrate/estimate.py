"""The error of a run, estimated from a second one with larger elements and steps, and runs refined until it is below what is asked.

Of the two runs of a pair the finer is the answer. What an answer differs by between them is about its error: elements and steps of
the coarser are COARSER times as large, so that an error quadratic in them doubles. One difference can be small by chance; so
none is taken as less than the usual one of its answer times how far the pair differs on the whole.
"""

import math
from collections.abc import Mapping

import numpy as np

from .parameters import Value

COARSER = math.sqrt(2)
REFINEMENTS = 3             # at most: elements and steps are then 2.8 times smaller than at first
SIZES = ("mesh_size", "contact_mesh_size", "dt")
# What a pair usually differs by, over the accuracy asked for (medians of docs/accuracy.md): the first six are promised.
USUAL = {"impulse": 0.06, "rebound": 0.12, "rebound_spin": 0.08, "energy": 0.16, "friction_work": 0.04, "thresholded_contact_time": 0.7,
         "contact_time": 0.8, "peak_force": 1.2}
PROMISED = tuple(USUAL)[:6]


def other(values: Mapping[str, Value], used: Mapping[str, Value], factor: float) -> dict[str, Value]:
    """What a run with `factor` times the elements and steps of the scene `values` sets, where `used` are its values as used.

    The accuracy sets the adaptive step alone, as the sizes are given; the contact's own parameters stay as they were used.
    """
    sizes = {name: factor * used[name] for name in SIZES if used[name] > 0}
    sizes["mesh_size"] = min(sizes["mesh_size"], used["radius"])
    kept = {name: used[name] for name in ("penalty", "slip_velocity", "friction_dynamic")}
    return dict(values) | kept | sizes | {"accuracy": min(0.4, factor**2 * used["accuracy"]), "fields": 0}


def difference(fine: dict, coarse: dict, speed: float, radius: float) -> dict[str, float]:
    """How far the answers of two summaries differ, each over its scale: impulse, times and force over themselves, velocities and
    spin over `speed` [m/s] (spin times `radius` [m]), energies and friction work over the energy at the start."""
    energy = fine["energy_initial"] or fine["energy_final"] or 1.0

    def apart(name: str, scale: float) -> float:
        return abs((fine[name] or 0.0) - (coarse[name] or 0.0)) / abs(scale) if scale else 0.0

    return {"impulse": apart("impulse", fine["impulse"]), "rebound": math.hypot(apart("rebound_vx", speed), apart("rebound_vy", speed)),
            "rebound_spin": apart("spin", speed / radius),
            "energy": max(apart(name, energy) for name in ("energy_final", "vibration_energy")), "friction_work": apart("friction_work", energy)} | {
            name: apart(name, fine[name] or 0.0) for name in ("thresholded_contact_time", "contact_time", "peak_force")}


def errors(apart: dict[str, float], accuracy: float) -> dict[str, float]:
    """The estimated error of every answer from the differences of a pair, in the same units."""
    whole = math.sqrt(np.mean([(apart[name] / (usual * accuracy)) ** 2 for name, usual in USUAL.items() if apart[name] > 0] or [0.0]))
    return {name: max(apart[name], whole * usual * accuracy if apart[name] > 0 else 0.0) for name, usual in USUAL.items()}


def excess(estimated: dict[str, float], accuracy: float, also: str) -> list[str]:
    """Sentences for the promised answers (and `also`, the value of accuracy_of) whose estimated error is above the accuracy."""
    wanted = [*PROMISED, *([also] if also in estimated and also not in PROMISED else [])]
    return [f"{name}: the estimated error is {100 * estimated[name]:.2g} %, asked is {100 * accuracy:g} %: take a smaller accuracy, or what "
            "the other warnings say" for name in wanted if estimated[name] > accuracy]
