"""Converts the relative error estimates in summary.json (`estimated_error`) to the units of the
numbers. They are relative to the number itself, to the largest energy or to the speed. Restitutions,
the angle after contact and the ratio of the impulses follow from velocities and impulses, and so do
their errors.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..input.parameters import Table
from .estimate import OF_IMPACT
from .results import Answers, Contents, Record, held_bodies, numbers, read_answers, read_table

__all__ = ["errors", "zero_by_symmetry"]

# Energies and works whose error estimate is that of the energy, relative to the largest energy.
ENERGIES = (
    "energy_final",
    "translation_energy",
    "rotation_energy",
    "vibration_energy",
    "creep_work",
    "viscous_work",
    "plastic_work",
    "penalty_damping_work",
)
# Numbers whose error estimate is relative to the number itself.
OF_ITSELF = (
    "impulse",
    "thresholded_contact_time",
    "contact_time",
    "peak_force",
    "max_pressure",
    "max_plastic_strain",
    "max_penetration",
    "bounces",
    "rest_time",
)
# Numbers whose error follows from those of velocities and impulses; columns of contacts.csv that are
# needed.
PROPAGATED = ("restitution", "restitution_tangential", "angle_out", "impulse_ratio")
COLUMNS = ("body", "partner", "approach", "lever", "partner_lever", "slip_before")


def errors(record: Record) -> dict[str, float]:
    """Returns the error estimates by the name of the number, in its unit. Numbers without an
    estimate are left out, as are those that are zero without a contact.

    The estimates do not include the effect of penalty and slip velocity, except in a peak force
    with a `peak_uncertainty`. Numbers that are zero by symmetry have no estimate.
    """
    summary = record.summary
    names = numbers(summary)
    if not summary.get("estimated_error"):
        return {}
    share = Contents(
        dict.fromkeys(OF_IMPACT, math.nan) | summary["estimated_error"],
        record.folder / "summary.json",
    )
    answers = read_answers(record.folder)
    energy, reach = float(answers.summary["largest_energy"]), record.scene.get("radius")
    estimates: dict[str, float] = {
        name: share[name] * abs(summary[name])
        for name in share
        if (name in OF_ITSELF or name.startswith("support_peak")) and summary.get(name)
    }
    estimates |= {
        name: share.get(name, 0.0) * energy
        for name in ("friction_work", "support_work", "load_work")
        if name in share
    }
    held = held_bodies(answers.used)
    for name in names:
        kind = re.sub(r"_[0-9]+$", "", name)
        if name[len(kind) :] in held and kind.startswith(("rebound_", "final_")):
            continue  # of one instant of a vibration
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
    path = record.folder / "contacts.csv"
    if any(name in names for name in PROPAGATED) and path.exists():
        estimates |= _of_impact(record, answers, share)
    if "first_restitutions" in share:  # a list of numbers, each with this error
        names.append("first_restitutions")
        estimates["first_restitutions"] = share["first_restitutions"]
    if (least := summary.get("peak_uncertainty")) and "peak_force" in estimates:
        estimates["peak_force"] = max(estimates["peak_force"], least * abs(summary["peak_force"]))
    zeros = zero_by_symmetry(summary)
    return {
        name: estimates[name]
        for name in names
        if not math.isnan(estimates.get(name, math.nan)) and name not in zeros
    }


def zero_by_symmetry(summary: Table) -> set[str]:
    """Returns the names of velocities and spins that are zero by symmetry. They are exactly zero, or
    zero up to the asymmetry of the mesh: velocities along the axes `symmetric_along`, normal to
    mirror planes, and spins about other axes than this normal.
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


def _of_impact(record: Record, answers: Answers, share: Mapping[str, float]) -> dict[str, float]:
    """Returns the error estimates of PROPAGATED. They follow from those of the velocities dv and of
    the rim speeds R dw of the bodies in contact, and of the impulse dJ:

        restitution             sqrt(sum dv^2 + (lever dw)^2) / approach
        restitution_tangential  sqrt(sum dv^2 + (R dw)^2) / slip_before
        angle_out               sqrt(sum dv^2) / speed of the centres
        impulse_ratio  r        sqrt((m dv)^2 + (r dJ)^2) / J,  m the smaller mass

    A body that supports hold vibrates. Its velocity after contact is that of one instant, for which
    there is no estimate, so only impulse_ratio has one. angle_in follows from the start of the
    scene.
    """
    rows = read_table(record.folder / "contacts.csv")
    if not set(COLUMNS) <= set(rows.dtype.names or ()):  # written by an earlier version
        return {}
    bodies = [int(rows.body[0]), *([int(rows.partner[0])] if rows.partner[0] > 0 else [])]
    several = any(name.startswith("mass_") for name in answers.summary)
    suffix = [f"_{number}" if several else "" for number in bodies]
    held, summary = held_bodies(answers.used), answers.summary
    velocity, rim = (share[name] * answers.speed for name in ("rebound", "rebound_spin"))
    free = [summary[f"mass{end}"] for end in suffix if end not in held]
    ratio, impulse = summary["impulse_ratio"], summary["impulse"]
    estimates = {}
    if free and ratio:
        across = math.hypot(min(free) * velocity, ratio * share["impulse"] * impulse)
        estimates["impulse_ratio"] = across / impulse
    if len(free) < len(bodies):
        return estimates
    levers = (float(rows.lever.max()), float(rows.partner_lever.max()))
    turning = [
        lever / summary[f"reach{end}"] * rim for lever, end in zip(levers, suffix, strict=False)
    ]
    every = math.sqrt(len(bodies))
    if rows.approach[0] > 0:  # else the body is set down without a velocity
        estimates["restitution"] = math.hypot(every * velocity, *turning) / float(rows.approach[0])
    if rows.slip_before[0] > 0:
        estimates["restitution_tangential"] = (
            every * math.hypot(velocity, rim) / float(rows.slip_before[0])
        )
    leaves = _centres_speed(answers, suffix, int(rows.partner[0]))
    if leaves:
        estimates["angle_out"] = math.degrees(every * velocity / leaves)
    return estimates


def _centres_speed(answers: Answers, suffix: list[str], partner: int) -> float | None:
    """Returns the relative speed of the centres [m/s] at the end of contact, None if the obstacle
    follows a function of time.
    """
    axes = [axis for axis in "xyz" if f"rebound_v{axis}{suffix[0]}" in answers.summary]
    after = [
        np.array([answers.summary[f"rebound_v{axis}{end}"] for axis in axes]) for end in suffix
    ]
    used: Mapping[str, Any] = answers.used
    obstacles = used.get("obstacle", [])
    if len(suffix) == 1 and obstacles:
        obstacle = obstacles[-partner - 1]
        if "motion" in obstacle or "rotation" in obstacle:
            return None
        moves = obstacle.get("velocity", 0.0)  # a number is along y
        moves = dict(zip("xyz", [0.0, moves] if np.isscalar(moves) else moves, strict=False))
        after.append(np.array([moves.get(axis, 0.0) for axis in axes]))
    return float(np.linalg.norm(after[0] - after[-1] if len(after) > 1 else after[0]))
