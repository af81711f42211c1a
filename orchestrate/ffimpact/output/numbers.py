"""Names the numbers of a run: those of summary.json in the table of columns.py, from what FreeFEM has
recorded (`diagnostics` of record.json) and from the history.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..input.parameters import Table
from .columns import Features, recorded

__all__ = ["in_order", "numbers_of"]

History = Mapping[str, np.ndarray]
# Names of extremes, each recorded as value, time (-1: never) and reference position, and the names
# of which the value itself is none.
EXTREMES = ("max_von_mises", "max_pressure", "max_tension", "max_shear")
FIRST = ("ellipticity_lost", "breakdown")
# Extremes of a column: the name is that of the column.
LARGEST, SMALLEST = ("max_penetration",), ("min_jacobian", "min_stretch", "min_ellipticity")
# Numbers that are the last value of the column of their name, or of another one.
LAST = {
    name: name
    for name in (
        *("external_work", "friction_work", "penalty_damping_work", "viscous_work"),
        *("plastic_work", "max_plastic_strain"),
        *("support_work", "load_work"),
    )
} | {f"rebound_{name}": name for name in ("vx", "vy", "vz", "spin", "spin_x", "spin_y")}
LAST_OF_BODY = {"kinetic_final": "kinetic", "elastic_final": "elastic"} | LAST


def numbers_of(facts: Table, history: History, forces: tuple[np.ndarray, ...]) -> Table:
    """The numbers of a run but those that follow from its intervals of contact, by name. forces:
    middle, length and mean normal force of its steps (warnings.Evidence.forces).
    """
    numbers = {name: history[name].max() for name in LARGEST}
    numbers |= {name: history[name].min() for name in SMALLEST}
    numbers |= _of_contact(facts, history)
    numbers |= _of_bodies(facts, history)
    numbers |= _drifts(facts, history)
    numbers |= _extremes(facts)
    numbers |= {
        "peak_force": history["normal_force"].max(),
        "impulse": forces[1] @ forces[2],
        "slip_work": history["friction_work"][-1] - facts["creep_work"],
        "resumed_at": facts["resumed_at"] if facts["resumed_at"] >= 0 else None,
        "front_transit": facts["front_transit"] or None,
        "front_rise": facts["front_rise"] or None,
        "volume_change": facts["volume_change"] if facts["projected"] else None,
        "volume_spread": facts["volume_spread"][0] if facts["projected"] else None,
    }
    for k, peak in enumerate(facts["support_peaks"], 1):
        numbers[f"support_peak_{k}"] = peak
    for gas in facts["gases"]:
        for name in ("pressure", "volume", "radius"):
            numbers[f"gas_{name}_start_{gas['load']}"] = gas[name]
    numbers |= {
        name.replace("elastic", "elastic_final"): column[-1]
        for name, column in history.items()
        if name.startswith("layer_")
    }
    plain = {name: value for name, value in facts.items() if isinstance(value, int | float)}
    return plain | {name: _plain(value) for name, value in numbers.items()}


def in_order(facts: Table, numbers: Mapping[str, Any]) -> Table:
    """The numbers that the table has for this scene, in its order."""
    words = {
        "penalty_damped": "penalty_damping_work" in numbers,
        "damped": facts["damped"],
        "metals": "plastic_work" in numbers,
        "projected": facts["projected"],
        "solid": facts["dimension"] == 3,
    }
    features = Features(
        frozenset(word for word, has in words.items() if has),
        len(facts["bodies"]),
        len(facts["support_peaks"]),
        facts["loads"],
        tuple(gas["load"] for gas in facts["gases"]),
        sum(name.startswith("layer_elastic_final_") for name in numbers),
    )
    return {name: numbers[name] for name in recorded("summary.json", features)}


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _of_contact(facts: Table, history: History) -> Table:
    """Onset and duration of the contact, up to the end of the run if it is not over."""
    if not facts["contact_intervals"]:
        return {"contact_time": None, "contact_start": None}
    end = facts["time"] if facts["in_contact"] else facts["contact_end"]
    return {"contact_time": end - facts["contact_start"], "contact_start": facts["contact_start"]}


def _of_bodies(facts: Table, history: History) -> Table:
    """The numbers of each body and of all together. Without end_time the rebound is that at the end of
    contact: what gravity has changed since then is subtracted.
    """
    over = facts["contact_intervals"] and not facts["in_contact"] and not facts["end_time"]
    since = facts["time"] - facts["contact_end"] if over else 0.0
    gained = since * np.array(facts["acceleration"])
    bodies, several = facts["bodies"], len(facts["bodies"]) > 1
    last = {name: column[-1] for name, column in history.items()}
    numbers: Table = {}
    final = last["kinetic"] + last["elastic"] + last["contact"]
    for b, body in enumerate(bodies, 1):
        end = f"_{b}" if several else ""
        own = {name: last[f"{column}{end}"] for name, column in LAST_OF_BODY.items()
               if f"{column}{end}" in last}  # fmt: skip
        for axis, gain in zip("xyz", gained):
            if f"rebound_v{axis}" in own:
                own[f"rebound_v{axis}"] -= gain
                final -= body["mass"] * gain * (own[f"rebound_v{axis}"] + gain / 2)
        own |= {name: body[name] for name in ("mass", "reach", "vibration_energy")}
        own |= {f"impulse_{axis}": value for axis, value in zip("xyz", body["impulse"])}
        own |= _extents(facts, [body])
        numbers |= {f"{name}_{b}": value for name, value in own.items() if several}
    numbers |= {name: last[column] for name, column in LAST.items() if column in last}
    for axis, gain in zip("xyz", gained):
        if f"rebound_v{axis}" in numbers:
            numbers[f"rebound_v{axis}"] -= gain
    return numbers | _extents(facts, bodies) | {
        "energy_final": final,
        "vibration_energy": sum(body["vibration_energy"] for body in bodies),
        "mass": sum(body["mass"] for body in bodies),
        "reach": max(body["reach"] for body in bodies),
    }  # fmt: skip


def _extents(facts: Table, bodies: list[Table]) -> Table:
    """The widths of a body, or the largest of several."""
    axes = "xyz"[: facts["dimension"]]
    widths = {f"extent_{a}": max(b["extent"][k] for b in bodies) for k, a in enumerate(axes)}
    return {"extent_z": None} | widths


def _drifts(facts: Table, history: History) -> Table:
    """What conservation misses, over the energy supplied and the fastest motion."""
    fastest = facts["fastest_motion"]
    return {
        "energy_drift": abs(facts["worst_balance"]) / max(facts["supplied_energy"], 1e-300),
        "momentum_drift": facts["off_momentum"] / fastest,
        "angular_momentum_drift": None if facts["mirrored"] else facts["off_angular"] / fastest,
    }


def _extremes(facts: Table) -> Table:
    """Value, time and place of each extreme; None if there was none."""
    numbers: Table = {}
    for name in (*EXTREMES, *FIRST):
        value, time, *place = facts[name]
        numbers[name] = value
        numbers[f"{name}_time"] = time if time >= 0 else None
        for k, (axis, x) in enumerate(zip("xyz", place)):
            numbers[f"{name}_{axis}"] = x if time >= 0 and k < facts["dimension"] else None
    return numbers
