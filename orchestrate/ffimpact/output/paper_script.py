"""The run of a script of the paper (edp/*.edp) as a finished run: scene.toml and summary.json from its
answers.json and history.csv.

The summary has `made_by` = "script", the numbers that follow from these files, and no estimate.
"""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from .results import columns_of, digest, files_of, reading, write_json

__all__ = ["ANSWERS", "evaluate_script"]

ANSWERS = "answers.json"  # written last by the scripts
# Entries of ANSWERS that are results; all others are the flags of the run.
RESULTS = (
    "contact_start",
    "contact_end",
    "mass",
    "mass_1",
    "mass_2",
    "dofs",
    "unconverged_steps",
    "cpu_seconds",
    "search_seconds",
    "passed",
)


def evaluate_script(folder: Path) -> None:
    """Writes scene.toml and summary.json of the run of a script in `folder`. Raises Unreadable if
    its files are damaged.
    """
    path = folder / ANSWERS
    with reading(path):
        answers = json.loads(path.read_text("utf-8"))
        flags = {name: value for name, value in answers.items() if name not in RESULTS}
        script = flags["script"]
    with reading(folder / "history.csv"):
        history = columns_of((folder / "history.csv").read_text("utf-8"))
        summary = _summary(answers, history)
    lines = [f"{name} = {json.dumps(value)}" for name, value in (_missing(script) | flags).items()]
    (folder / "scene.toml").write_text("\n".join(lines) + "\n")
    summary["provenance"] = {
        "script": script,
        "files": files_of(folder),
        "summary": digest(summary),
    }
    write_json(folder / "summary.json.part", summary)
    os.replace(folder / "summary.json.part", folder / "summary.json")


def _missing(script: str) -> dict[str, Any]:
    """Entries of the program's scenes that a script has no flag for, with the values it uses."""
    whole = {"angle": 90, "spin": 0, "gravity": 0, "friction_static": 0, "friction_dynamic": 0}
    return {
        "title": f"The script {script}.edp",
        "degree": 2,
        "integrator": "energy-momentum",
    } | whole


def _summary(answers: dict[str, Any], history: dict[str, np.ndarray]) -> dict[str, Any]:
    """The numbers of the run that follow from its history, and its warnings."""
    force, dt, energy = history["normal_force"], history["dt"], history["kinetic"][0]
    touched = bool((force > 0).any())
    warnings = []
    if answers["unconverged_steps"]:
        warnings.append(
            f"{answers['unconverged_steps']:g} steps did not converge: take smaller steps (dt)"
        )
    if (inverted := history["min_jacobian"] <= 0).any():
        time = 1e3 * history["t"][inverted][0]
        warnings.append(
            f"breakdown: det F <= 0 from {time:.3g} ms on; the result depends on the mesh"
        )
    if answers["passed"]:
        warnings.append("bodies slip through each other: k or pairing_range is too small")
    last = {
        f"rebound_{name}": float(values[-1])
        for name, values in history.items()
        if name.startswith(("vx", "vy", "spin"))
    }
    bodies = ("_1", "_2") if "mass_1" in answers else ("",)
    vibration = float(history["kinetic"][-1] + history["elastic"][-1]) - sum(
        answers[f"mass{body}"]
        / 2
        * (last[f"rebound_vx{body}"] ** 2 + last[f"rebound_vy{body}"] ** 2)
        + history[f"angular_momentum{body}"][-1] * last[f"rebound_spin{body}"] / 2
        for body in bodies
    )
    impulse = float((dt[1:] * force[1:]).sum())
    rises = np.diff(np.concatenate([[0.0], force > 0, [0.0]])) > 0
    return {
        "status": "ok",
        "message": "",
        "ended": "end_time" if answers["end_time"] else "impact",
        "made_by": "script",
        "integrator": "energy-momentum",
        "warnings": warnings,
        "notes": [],
        "skipped": ["error estimate"],
        "released": [],
        "symmetric_along": [],
        "estimated_error": None,
        "contact_time": answers["contact_end"] - answers["contact_start"] if touched else None,
        "contact_start": answers["contact_start"] if touched else None,
        "contact_intervals": int(rises.sum()),
        "peak_force": float(force.max()),
        "impulse": impulse,
        **{
            f"impulse_y{body}": float(
                history[f"momentum_y{body}"][-1] - history[f"momentum_y{body}"][0]
            )
            for body in bodies
            if body
        },
        **last,
        "energy_initial": float(energy + history["contact"][0]),
        "energy_final": float(
            history["kinetic"][-1] + history["elastic"][-1] + history["contact"][-1]
        ),
        "vibration_energy": vibration,
        "friction_work": float(history["friction_work"][-1]),
        "external_work": float(history["external_work"][-1]),
        "energy_drift": float(np.abs(history["balance"]).max() / energy),
        "min_jacobian": float(history["min_jacobian"].min()),
        "max_penetration": float(history["max_penetration"].max()),
        "steps": len(force) - 1,
        "newton_iterations": float(history["newton_iterations"].sum()),
        "dofs": answers["dofs"],
        "cpu_seconds": answers["cpu_seconds"],
        "phase_seconds": {"search": answers["search_seconds"]},
        **{name: answers[name] for name in ("mass", "mass_1", "mass_2") if name in answers},
        **(
            {"reach_1": answers["radius"], "reach_2": answers["block_width"] / 2}
            if "mass_1" in answers
            else {"reach": answers["radius"]}
        ),
    }
