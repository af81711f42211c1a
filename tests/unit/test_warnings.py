"""Warnings and notes: each appears if its condition holds, with its number, and not otherwise;
tables and reports show them."""

from pathlib import Path

import numpy as np
import pytest

import pages
from ffimpact.output import notes
from ffimpact.output.results import Record
from ffimpact.output.warnings import Evidence
from ffimpact.report import report
from ffimpact.sweeps import study


def test_what_stands_behind_a_warning_is_a_note():
    """A warning that the results are invalid turns the warnings that it explains into notes. No
    sentence is lost."""
    warnings = ["ellipticity: a", "breakdown: b", "penalty: c", "locking: d", "penetration: e", "estimated errors: f"]
    sentences = notes.settled(warnings, ["peak force: g"])
    assert sentences["warnings"] == ["breakdown: b", "penetration: e", "estimated errors: f"] and sorted(sentences["warnings"] + sentences["notes"]) == sorted([*warnings, "peak force: g"])
    assert notes.settled(["touches: a", "penalty: b"], []) == {"warnings": ["touches: a"], "notes": ["penalty: b"]}
    assert notes.settled(["estimated errors: a", "steps: b", "penalty: c"], []) == {"warnings": ["estimated errors: a", "penalty: c"], "notes": ["steps: b"]}
    assert notes.settled(["penalty: a", "contact points: b"], ["peak force: c"]) == {"warnings": ["penalty: a", "contact points: b"], "notes": ["peak force: c"]}


def test_every_note_is_about_a_number_of_the_report():
    """Every sentence that is a note, or becomes one, refers to a row of the report."""
    always = {row.split(" | ")[0].strip("| ") for row in pages.warnings().splitlines()[2:] if "note" in row.split(" | ")[1]}
    behind = {name for names in notes.BEHIND.values() for name in names}
    rows = {row.key for row in report.rows("/m")} | {"estimated_error"}
    assert {"touches again", "peak force"} <= always and not [name for name in always | behind if notes.number(name) not in rows]


def test_a_line_is_no_wider_than_the_screen():
    """The line ends before the second colon. A name that is too long for the screen is cut."""
    assert notes.line("  warning   ", "mass: it is off: whose: take") == "  warning   mass: it is off"
    assert len(notes.line("  warning   ", f"mass: {'x' * 200}: take")) == notes.WIDEST
    assert notes.line("", "no contact: by the end_time") == "no contact: by the end_time"


def test_warnings_are_counted_by_name():
    """The most frequent warning is first. Without warnings the text is empty."""
    assert study.warned(["penalty: a; creep: b", "", "creep: c"]) == "creep in 2, penalty in 1 of 3 runs"
    assert study.warned(["", ""]) == ""


def test_footnotes_are_numbered_in_the_order_of_their_numbers():
    """The first mark of the table is [1], whatever the order of the notes in the summary. If the
    report is verbose, notes about numbers without a row follow; otherwise they are left out."""
    sentences = ["touches again: c", "peak force: a", "contact time: b", "contact points: d"]
    keys = ["contact_time", "peak_force"]
    brief = notes.footnotes(sentences, keys)
    assert brief == {"contact_time": ["contact time: b"], "peak_force": ["peak force: a", "contact points: d"]}
    assert list(notes.footnotes(sentences, keys, verbose=True)) == [*keys, "contact_intervals"]


def test_several_numbers_in_one_row():
    """Each has its own error estimate, the last one none."""
    row = report.Quantity("first_restitutions", "first restitutions", "1")
    assert row.text([0.7, 0.65, 0.6], [0.01, 0.02]) == "0.7 ± 0.01, 0.65 ± 0.02, 0.6 1"


def printed(scene: dict, **numbers: object) -> list[str]:
    """The keys of the rows of a run with these numbers."""
    record = Record(Path("out"), {"provenance": {"script": "bodies"}} | numbers, reused=False)
    record.__dict__["scene"] = scene  # else read from the folder
    return [row.key for row in report.rows_of(record)]


def test_a_run_to_rest_prints_bounces_and_not_a_rebound():
    """What a run has at rest, its velocity and the time since the first contact, says nothing."""
    numbers = dict(contact_time=13.0, bounces=70, first_restitutions=[0.9, 0.91, 0.92], rest_time=12.1, peak_force=300.0, rebound_vy=4e-5, contact_intervals=91)
    assert printed({"until": "rest"}, **numbers) == ["bounces", "first_restitutions", "rest_time", "peak_force"]
    assert printed({"until": "impact"}, **numbers) == ["contact_time", "peak_force", "rebound_vy", "contact_intervals"]


def test_what_is_zero_or_unknown_has_no_row():
    """Zero by symmetry, no friction, no velocity at end_time, no bounce that is over."""
    assert printed({"until": "rest"}, first_restitutions=[], bounces=0) == ["bounces"]
    numbers = dict(rebound_vx=1e-5, rebound_vy=2.0, rebound_spin=0, final_vy=None, friction_work=0, symmetric_along=["x"])
    assert printed({}, **numbers) == ["rebound_vy"]
    assert printed({}, **numbers | {"symmetric_along": [], "final_vy": 1.0}) == ["rebound_vx", "rebound_vy", "final_vy"]


@pytest.mark.parametrize("means_of_ends, largest, loaded", [(0, 6.0, 2), (1, 4.0, 3)])
def test_force_and_penalty_are_judged_by_the_history(means_of_ends, largest, loaded):
    """Steps in contact and the largest mean force, of integrators with forces over the step and at its
    ends; the penalty's share of the energy where the elastic energy is largest in contact (0.2 / 4),
    not in the flight after it (5). Rigid bodies have none."""
    columns = dict(t=[0, 1, 2, 3, 4], dt=[0, 1, 1, 1, 1], newton_iterations=[0, 3, 3, 3, 3],
                   normal_force=[0, 2, 6, 0, 0], contact=[0, 0.1, 0.2, 0, 0], elastic=[0, 1, 4, 5, 5])
    history = {name: np.array(column, float) for name, column in columns.items()}
    evidence = Evidence({"diagnostics": {"means_of_ends": means_of_ends}}, history, [])
    assert (evidence.largest_force, evidence.loaded_steps) == (largest, loaded)
    assert evidence.penalty_share == pytest.approx(0.05)
    assert Evidence(evidence.record, history | {"elastic": np.zeros(5)}, []).penalty_share == 0
