"""Evaluates the record of a run that FreeFEM has left in a folder: contacts.csv, modes.csv, the
fields, and last summary.json, or failure.json of a run that failed.
"""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from . import contacts, warnings
from .fields import write_fields
from .modes import write_modes
from .numbers import in_order
from .paper_script import ANSWERS, evaluate_script
from .results import read_history, read_json, reading, write_json

__all__ = ["RECORD", "evaluate", "evaluate_numbers"]

RECORD = "record.json"  # written last by edp/program/run/summary.idp


def evaluate(folder: Path) -> None:
    """Evaluates the record in `folder` and removes it, or the answers of a script of the paper; does
    nothing if there are none. Raises Unreadable if a file of them is damaged.
    """
    if (folder / ANSWERS).exists():
        return evaluate_script(folder)
    if _record(folder):
        write_fields(folder)
        evaluate_numbers(folder)


def _record(folder: Path) -> Path | None:
    """The file of a run that has ended and is not evaluated yet."""
    if (folder / RECORD).exists():
        return folder / RECORD
    return folder / "failure.json" if "diagnostics" in read_json(folder / "failure.json") else None


def evaluate_numbers(folder: Path) -> None:
    """As evaluate(), for a run of the program, without its fields."""
    if not (path := _record(folder)):
        return
    with reading(path):
        record = json.loads(path.read_text("utf-8"))
        facts = record["diagnostics"]
    write_modes(folder)
    intervals = contacts.intervals_of(folder, facts)
    contacts.write_contacts(folder / "contacts.csv", intervals, bool(facts["damped"]))
    record = contacts.with_self_contact(record, intervals)
    evidence = warnings.Evidence(record, read_history(folder), intervals)
    summary = _summary(evidence)
    if path.name != RECORD:
        write_json(path, summary)
    else:
        write_json(folder / "summary.json.part", summary)
        os.replace(folder / "summary.json.part", folder / "summary.json")
        path.unlink()
    (folder / contacts.RECORDED).unlink()


def _summary(evidence: warnings.Evidence) -> dict[str, Any]:
    """The numbers and sentences of a run; without sentences if it failed, as its message says what
    to know.
    """
    record, facts = evidence.record, evidence.facts
    crossings = evidence.thresholds()
    lasted = crossings[1] - crossings[0] if crossings else None
    numbers = evidence.numbers | contacts.of_run(list(evidence.intervals)) | {
        "thresholded_contact_time": lasted,
        "peak_uncertainty": warnings.peak_uncertainty(evidence),
        "rest_time": facts["rest_since"] if record["ended"] == "rest" else None,
        "corner_share": evidence.corner_share,
    }  # fmt: skip
    for name, value in evidence.numbers.items():
        if name.startswith("rebound_"):
            numbers |= _at_both_ends(evidence, name, value)
    ok = record["status"] == "ok"
    sentences = warnings.sentences(evidence) if ok else {"warnings": [], "notes": []}
    summary: dict[str, Any] = {}
    for name, value in record.items():
        if name == "diagnostics":
            summary |= sentences | in_order(facts, numbers)
        else:
            summary[name] = value
        if name == "ended":
            summary["later_contact_possible"] = evidence.later_contact_possible
    return summary


def _at_both_ends(evidence: warnings.Evidence, name: str, value: float) -> dict[str, Any]:
    """A velocity or spin `rebound_...` at the end of the run, as two numbers: `final_...` if the run
    goes on after the contact until its end_time, and the value at the end of contact t_e. This is
    extrapolated from the following step, in which no contact force acts: v(t_e) = v(t_1) +
    (t_e - t_1) dv/dt.
    """
    final = name.replace("rebound", "final")
    t, end = evidence.history["t"], evidence.facts["contact_end"]
    k = int(np.searchsorted(t, end))
    touched = evidence.facts["contact_intervals"] and not evidence.facts["in_contact"]
    if not (evidence.facts["end_time"] > 0 and touched and k + 1 < len(t)):
        return {name: value, final: None}
    v = evidence.history[name.removeprefix("rebound_")]
    slope = (v[k + 1] - v[k]) / (t[k + 1] - t[k])
    return {name: float(v[k] + (end - t[k]) * slope), final: value}
