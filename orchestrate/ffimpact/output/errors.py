"""Converts the relative error estimates in summary.json (`estimated_error`) to the units of the
numbers. They are relative to the number itself, to the largest energy or to the speed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from .results import Record, numbers, read_answers

__all__ = ["errors", "zero_by_symmetry"]

# Energies and works whose error estimate is that of the energy, relative to the largest energy.
ENERGIES = (
    "energy_initial",
    "energy_final",
    "translation_energy",
    "rotation_energy",
    "vibration_energy",
    "creep_work",
    "viscous_work",
)
# Numbers whose error estimate is relative to the number itself.
OF_ITSELF = (
    "impulse",
    "thresholded_contact_time",
    "contact_time",
    "peak_force",
    "max_pressure",
    "max_penetration",
)


def errors(record: Record) -> dict[str, float]:
    """Returns the error estimates by the name of the number, in its unit. Numbers without an
    estimate are left out.

    The estimates do not include the effect of penalty and slip velocity, except that of a peak
    force which single contact points dominate (`peak_uncertainty`). What symmetry makes zero has no
    estimate.
    """
    summary = record.summary
    names = numbers(summary)
    share = summary.get("estimated_error") or {}
    if not share:
        return {}
    answers = read_answers(record.folder)
    energy, reach = float(answers.summary["largest_energy"]), record.scene.get("radius")
    estimates: dict[str, float] = {
        name: share[name] * abs(summary[name])
        for name in share
        if (name in OF_ITSELF or name.startswith("support_peak")) and summary.get(name) is not None
    }
    estimates |= {
        name: share.get(name, 0.0) * energy
        for name in ("friction_work", "support_work", "load_work")
        if name in share
    }
    for name in names:
        kind = re.sub(r"_[0-9]+$", "", name)
        if kind in ENERGIES:
            estimates[name] = share["energy"] * energy
        elif re.fullmatch("impulse_[xyz]", name):
            estimates[name] = share["impulse"] * abs(summary["impulse"])
        elif kind.startswith(("rebound_v", "final_v")):
            estimates[name] = share["rebound"] * answers.speed
        elif kind.startswith(("rebound_spin", "final_spin")):
            size = summary.get(f"reach{name[len(kind) :]}") or reach
            if size:
                estimates[name] = share["rebound_spin"] * answers.speed / size
        elif kind == "restitution":
            estimates[name] = share["rebound"]
    if (least := summary.get("peak_uncertainty")) and "peak_force" in estimates:
        estimates["peak_force"] = max(estimates["peak_force"], least * abs(summary["peak_force"]))
    zeros = zero_by_symmetry(summary)
    return {name: estimates[name] for name in names if name in estimates and name not in zeros}


def zero_by_symmetry(summary: Mapping) -> set[str]:
    """Returns the names of velocities and spins that symmetry makes zero: those that are exactly
    zero, and those along axes in which the scene is its own mirror image (`symmetric_along`), which
    differ from zero only as the mesh is not symmetric. A mirror plane keeps the spin about its
    normal.
    """
    axes = summary.get("symmetric_along") or []
    spins = {"spin_x": "x", "spin_y": "y", "spin": "z"}
    kinds = {f"v{axis}" for axis in axes}
    kinds |= {kind for kind, normal in spins.items() if any(axis != normal for axis in axes)}
    return {
        name
        for name in numbers(summary)
        if (match := re.fullmatch(r"(?:rebound|final)_(v[xyz]|spin(?:_[xy])?)(?:_\d+)?", name))
        and (summary[name] == 0 or match[1] in kinds)
    }
