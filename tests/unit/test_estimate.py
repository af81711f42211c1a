"""The error estimate of a run: differences of a pair of runs, estimates from them, and finer runs
until the estimate is small enough."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from ffimpact.failure import Failure
from ffimpact.input import parameters
from ffimpact.output import estimate, notes
from ffimpact.output.results import Answers

ANSWERS = {"impulse": 2.0, "rebound_vx": 1.0, "rebound_vy": 3.0, "rebound_spin": -8.0, "energy_initial": 5.0, "energy_final": 4.5, "vibration_energy": 1.0,
           "friction_work": 0.5, "thresholded_contact_time": 3.9e-3, "contact_time": 4e-3, "peak_force": 7e4}
ROOT2 = estimate.COARSER
# Of the first run of the fake disc.
START = {"mesh_size": 0.016, "contact_mesh_size": 0.003, "dt": 0.0}


# ---- differences of two runs

@pytest.mark.parametrize("change, expected", [
    ({"impulse": 2.1}, {"impulse": 0.05}), ({"rebound_vx": 1.3, "rebound_vy": 2.6}, {"rebound": 0.05}), ({"rebound_spin": -10.0}, {"rebound_spin": 0.1}),
    ({"energy_final": 4.25}, {"energy": 0.05}), ({"vibration_energy": 1.5}, {"energy": 0.1}),
    ({"friction_work": 0.75}, {"friction_work": 0.05, estimate.OF_ITSELF: 0.5}), ({"contact_time": 5e-3}, {"contact_time": 0.25}),
    ({"thresholded_contact_time": 3.51e-3}, {"thresholded_contact_time": 0.1}), ({"peak_force": 7.7e4}, {"peak_force": 0.1}), ({}, {})])
def test_each_answer_differs_over_its_scale(change, expected):
    """Velocities are relative to 10 m/s, spin times a radius of 0.5 m to the same, energies to the
    initial energy, others to themselves.

    No other difference changes.
    """
    apart = estimate.difference(ANSWERS, ANSWERS | change, 10.0, 0.5)
    assert apart == pytest.approx(dict.fromkeys(apart, 0.0) | expected) and set(expected) <= set(apart)


def test_answers_that_are_not_there_do_not_differ():
    """In a flight there are neither contact times nor a force; tables have nan for them."""
    flight = ANSWERS | {"contact_time": None, "thresholded_contact_time": float("nan"), "peak_force": 0.0, "impulse": 0.0}
    assert not any(estimate.difference(flight, flight, 10.0, 0.5).values())


def on_its_way(impulse: float = 0.0, speed: float = 0.0, spin: float = 0.0, elastic: float = 0.0, work: float = 0.0, steps: int = 41) -> Answers:
    """A run with these deviations, as shares of the scales, in the middle of its contact, and
    without deviation at its end."""
    t = np.linspace(0, 4e-3, steps)
    hump = np.sin(np.pi * t / 4e-3)
    history = {"t": t, "dt": np.diff(t, prepend=0.0), "vx": 10 * speed * hump, "vy": 10 * t / 4e-3, "spin": spin * 10 / 0.5 * hump, "elastic": 5 * elastic * hump,
               "contact": 0 * t, "max_pressure": 3e5 * hump, "max_penetration": 1e-5 * hump, "friction_work": 0.5 * (t / 4e-3 + impulse * hump) + 5 * work * hump}
    history["normal_force"] = np.diff(2 * (t / 4e-3 + impulse * hump), prepend=0.0) / np.where(history["dt"] > 0, history["dt"], 1.0)
    return Answers(ANSWERS | {"largest_energy": 5.0}, {"radius": 0.5}, 10.0, history)


@pytest.mark.parametrize("off, expected", [
    ({"impulse": 0.1}, {"impulse": 0.1, "rebound": 0.02, "energy": 0.02} | dict.fromkeys(estimate.COURSE, 0.1)), ({"speed": 0.2}, {"rebound": 0.2}),
    ({"spin": -0.3}, {"rebound_spin": 0.3}), ({"elastic": 0.4}, {"energy": 0.4}), ({}, {}),
    ({"work": 0.05}, {"friction_work": 0.05 / ROOT2, estimate.OF_ITSELF: 0.5 / ROOT2, "rebound": 0.1, "energy": 0.1}),
    ({"work": 0.05, "spin": 0.3}, {"friction_work": 0.05 / ROOT2, estimate.OF_ITSELF: 0.5 / ROOT2, "rebound": 0.1, "energy": 0.1, "rebound_spin": 0.4})])
def test_two_runs_that_end_alike_are_apart_on_their_way(off, expected):
    """The largest differences of impulse, velocity, spin and elastic energy during contact, over
    their scales, cannot be small by chance.

    They do not depend on the steps of the two runs. The friction work is compared at equal impulse
    (rms of the hump). Its difference counts in speed, energy and spin.
    """
    apart = estimate.course(on_its_way(**off), on_its_way())
    assert apart == pytest.approx(dict.fromkeys([*estimate.USUAL, estimate.OF_ITSELF], 0.0) | expected, rel=5e-3, abs=1e-12)
    assert estimate.course(on_its_way(**off), on_its_way(steps=81)) == pytest.approx(apart, rel=0.01, abs=2e-3)


def usual(times: float) -> dict[str, float]:
    return {name: times * value for name, value in estimate.USUAL.items()} | {estimate.OF_ITSELF: times}


STEPS = 1e-3  # 32 steps while the force is high, squared


def test_an_estimate_is_no_less_than_the_difference_nor_fooled_by_chance():
    """If the differences of impulse, rebound and energy are all small by chance, the time histories
    give the estimate. Without any difference there is no error."""
    course = usual(0.1)
    by_chance = usual(1e-3) | {name: 1e-9 for name in ("impulse", "rebound", "energy")}
    errors = estimate.errors(by_chance, course, STEPS)
    assert all(errors[name] > 0.002 * estimate.USUAL[name] for name in ("impulse", "rebound", "energy"))
    assert all(value >= by_chance[name] for name, value in errors.items())
    assert estimate.errors(usual(1.0), course, STEPS)["impulse"] == estimate.USUAL["impulse"]
    none = dict.fromkeys(course, 0.0)
    assert estimate.errors(none, none, STEPS) == none


@pytest.mark.parametrize("others, own, steps, raised", [
    (8, 1, 1, ("impulse", "rebound", "energy", "rebound_spin", "peak_force")), (1, 1, 8, ("impulse", "rebound", "energy", "friction_work"))])
def test_an_estimate_is_the_geometric_mean_of_three_measures(others, own, steps, raised):
    """Eight times the differences of all results, or steps sqrt(8) times larger, double the
    estimate; estimates of times grow by the fourth root.

    Where this has no information (steps for spin and peak force, other results for friction work)
    only the time histories count. All three times eight give eight times the error.
    """
    # The spin is small, as its share in the rebound has another test.
    small, course = usual(1e-6), usual(1.0) | {"rebound_spin": 1e-4}
    times = ("thresholded_contact_time", "contact_time")
    errors, before = estimate.errors(usual(others * 1e-6), course, steps * STEPS), estimate.errors(small, course, STEPS)
    for name in estimate.BOUND:
        assert errors[name] / before[name] == pytest.approx(8**0.25 if name in times else 2 if name in raised else 1), name
    all_three = estimate.errors(usual(8e-6), {name: 8 * value for name, value in course.items()}, 8 * STEPS)
    for name in estimate.BOUND:
        assert all_three[name] / before[name] == pytest.approx(8**0.75 if name in times else 8), name


def test_what_friction_ties_together_is_stated_together():
    """For bodies that rotate, the estimate of the rebound is at least LEVER times that of the spin.

    Without rotation the larger estimate of the friction work does not exceed that of the energy,
    and raises that of the impulse by at most a quarter of it, that of the rebound by half of it.
    Without friction it does not count.
    """
    small, course = usual(1e-6), usual(1e-3)
    turns = estimate.errors(small, course | {"rebound_spin": 1.0}, STEPS)
    assert turns["rebound"] == pytest.approx(estimate.LEVER * turns["rebound_spin"])
    still = course | {"rebound_spin": 0.0, "friction_work": 1.0}
    rubs = estimate.errors(small, still, STEPS)
    work = estimate.errors(small, still | {"rebound_spin": 1e-9}, STEPS)["friction_work"]
    assert rubs["friction_work"] == pytest.approx(estimate.STILL * work)
    assert [rubs[name] for name in ("energy", "rebound", "impulse")] == pytest.approx([rubs["friction_work"] / part for part in (1, 2, 4)])
    slides = estimate.errors(small, still | {"friction_work": 0.0}, STEPS)
    assert all(slides[name] < rubs[name] / 2 for name in ("energy", "rebound", "impulse"))


@pytest.mark.parametrize("name", estimate.HIGHEST)
def test_largest_values_are_stated_by_their_histories(name):
    """If two runs have equal largest values by chance but histories that differ by 10 %, the
    estimate is INSTANT times the rms difference.

    If the largest values differ by 30 %, the estimate is this difference. Equal runs have no error.
    """
    fine = on_its_way()
    t, column = fine.history["t"], fine.history[name]
    def other(values: np.ndarray) -> Answers:
        return fine._replace(history=fine.history | {name: values})
    swing = 0.1 * column.max() * np.sin(40 * np.pi * t / t[-1] + 0.5 * np.pi)
    swing[np.argmax(column)] = 0.0
    off = estimate.highest(fine, other(column + swing))
    assert off[name] == pytest.approx(estimate.INSTANT * 0.1 / ROOT2, rel=0.6) and off[name] > 0.05
    assert estimate.highest(fine, other(column + (column == column.max()) * 0.3 * column.max()))[name] >= 0.3
    assert estimate.highest(fine, fine) == dict.fromkeys(estimate.HIGHEST, 0.0)
    assert estimate.highest(other(0 * column), other(0 * column))[name] == 0


def test_steps_count_where_the_force_is_high():
    """These are the steps with a force above half of its peak; in a flight all steps."""
    run = on_its_way()
    force = np.array([0.0, 1.0, 3.0, 4.0, 2.0, 0.5])
    assert estimate.resolved(run._replace(history={"normal_force": force})) == 1 / 9
    assert estimate.resolved(run._replace(history={"normal_force": 0 * force})) == 1 / 36


@pytest.mark.parametrize("coarser, share", [(1.0, 1.0), (1.2, 0.56), (ROOT2, 0.0), (2.0, 0.0)])
def test_steps_that_a_pair_has_alike_do_not_show_in_it(coarser, share):
    """For an error quadratic in the step: all of it is hidden if both runs have equal steps while
    the force is high, none for a ratio of 1.4 or more."""
    fine = on_its_way(steps=81)
    coarse = fine._replace(history=fine.history | {"dt": coarser * fine.history["dt"]})
    assert estimate.alike(fine, coarse) == pytest.approx(share, abs=1e-12)


def test_what_does_not_show_is_stated():
    """If a pair differs in its elements only, and hardly in its results, the estimate contains the
    error of the steps.

    A pair with different steps keeps its estimate. Half hidden lies between.
    """
    small, course = usual(1e-3), usual(1e-3)
    stated = [estimate.errors(small, course, 1e-2, hidden) for hidden in (0.0, 0.5, 1.0)]
    assert stated[0] == estimate.errors(small, course, 1e-2)
    for name in estimate.BOUND:
        none, half, whole = (errors[name] for errors in stated)
        assert none < half < whole and whole > 2 * none, name
    none = dict.fromkeys(course, 0.0)
    assert estimate.errors(none, none, 1e-2, 1.0) == none
    # Without friction the mesh causes spin. Steps affect its estimate through other results only.
    smooth = course | {"friction_work": 0.0}
    assert estimate.errors(small, smooth, 1e-2, 1.0)["rebound_spin"] < 0.3 * stated[2]["rebound_spin"]


def test_friction_work_of_itself_is_stated_as_friction_work_is():
    """Both are one error on two scales."""
    errors = estimate.errors(usual(1.0), usual(1.0) | {"friction_work": 0.01, estimate.OF_ITSELF: 0.03}, STEPS)
    assert errors[estimate.OF_ITSELF] == pytest.approx(3 * errors["friction_work"]) and errors["friction_work"] > 0


@pytest.mark.parametrize("name, times, also, named", [
    ("impulse", 1.1, "promised", True), ("impulse", 0.9, "promised", False), ("thresholded_contact_time", 1.1, "promised", True),
    ("peak_force", 1.9, "promised", False), ("peak_force", 2.1, "promised", True), ("peak_force", 1.1, "peak_force", True),
    ("contact_time", 2.1, "peak_force", True), (estimate.OF_ITSELF, 9.0, "promised", False), (estimate.OF_ITSELF, 1.1, "friction_work", True)])
def test_answers_above_what_is_asked_are_named(name, times, also, named):
    """One sentence with name and per cent for promised results and the requested one above the
    accuracy, and for others above twice the accuracy."""
    estimated = dict.fromkeys([*estimate.USUAL, estimate.OF_ITSELF], 0.0) | {name: times * 0.01}
    sentences = estimate.excess(estimated, 0.01, also)
    assert len(sentences) == named and all(f"{name.replace('_', ' ')} {times:.2g} %" in sentence and ", requested 1 %: all above it: " in sentence for sentence in sentences)


# ---- the runs

def answers_of(folder: Path) -> Answers:
    """The results of the fake disc in a folder. Its time history has no deviation."""
    summary, used, speed = json.loads((folder / "result.json").read_text())
    return Answers(summary | {"largest_energy": 5.0}, used | {"radius": 0.5}, speed, on_its_way().history)


# Requests of a user besides the accuracy.
REQUESTS = {"fields": 5, "modes": 4, "checkpoint_every": 7}


class Disc:
    """A disc whose impulse has the relative error `error` at the sizes START. The error is
    quadratic in the sizes.

    The time history has no deviation. A run fails with `code` at the factors `fails` of the sizes.
    """

    def __init__(self, stage: Path, error: float, fails=(), code: int = 11, lost: float | None = None, **values):
        self.error, self.fails, self.code, self.lost, self.asked = error, fails, code, lost, []
        self.values = parameters.defaults() | REQUESTS | {"accuracy": 0.01} | values
        self.stage = stage
        self.solve(self.values, stage)
        (stage / "checkpoint.json").write_text("what the run was asked for")

    def solve(self, values: dict, folder: Path) -> None:
        self.asked.append(values)
        used = values | {name: values[name] or START[name] for name in START} | {"penalty": 1e10, "slip_velocity": 0.1, "friction_dynamic": 0.0}
        # With a mesh file only the step changes.
        factor = (values["accuracy"] / self.values["accuracy"])**0.5
        if any(factor == pytest.approx(failing_factor) for failing_factor in self.fails):
            raise Failure(f"no step at {factor:.2f}", code=self.code)
        folder.mkdir(exist_ok=True)
        summary = ANSWERS | {"impulse": 2 * (1 + self.error * factor**2), "cpu_seconds": 1.0, "ellipticity_lost_time": self.lost}
        (folder / "result.json").write_text(json.dumps([summary, used, 10.0]))
        (folder / f"of {factor:.2f}").touch()

    def settle(self, own_mesh: bool = True) -> dict:
        return estimate.settle(self.stage, self.values, own_mesh, self.solve, answers_of)

    def factors(self) -> list[float]:
        """The sizes of the runs over START."""
        return [(values["mesh_size"] or START["mesh_size"]) / START["mesh_size"] for values in self.asked]


def test_an_estimate_below_the_accuracy_is_one_coarser_run(tmp_path):
    """Elements and steps are 1.4 times larger and the error doubles, so that the difference is the
    error. No other files stay in the folder."""
    disc = Disc(tmp_path, 0.006)
    summary = disc.settle()
    assert disc.factors() == pytest.approx([1, ROOT2]) and disc.asked[1]["fields"] == 0
    assert summary["estimated_error"]["impulse"] == pytest.approx(0.006, rel=0.02)
    assert summary["refinements"] == 0 and summary["warnings"] == []
    assert summary["estimate_cpu_seconds"] == 1 and {path.name for path in tmp_path.iterdir()} == {"result.json", "of 1.00", "checkpoint.json"}


def test_finer_runs_follow_until_it_is(tmp_path):
    """3.6 % is halved twice. The finest run becomes the result; each former run is the coarser one
    of the next pair."""
    disc = Disc(tmp_path, 0.036)
    summary = disc.settle()
    assert disc.factors() == pytest.approx([1, ROOT2, 1 / ROOT2, 1 / 2])
    assert summary["estimated_error"]["impulse"] == pytest.approx(0.009, rel=0.02)
    assert summary["refinements"] == 2 and summary["warnings"] == []
    assert summary["estimate_cpu_seconds"] == 3
    assert {path.name for path in tmp_path.iterdir()} == {"result.json", "of 0.50", "checkpoint.json"}
    assert (tmp_path / "checkpoint.json").read_text() == "what the run was asked for"


@pytest.mark.parametrize("name, expected", [("fields", [5, 0, 5, 5]), ("modes", [4, 0, 4, 4]), ("checkpoint_every", [7] * 4)])
def test_what_was_asked_for_is_asked_of_every_run_that_may_stay(tmp_path, name, expected):
    """A finer run replaces the first one and has all its requests. The coarser run writes no
    output."""
    disc = Disc(tmp_path, 0.036)
    disc.settle()
    assert [values[name] for values in disc.asked] == expected


def test_what_asks_for_output_is_off_by_default():
    """The values that request no output are the defaults of the table for every script."""
    assert {name: parameters.PARAMETERS[name].default for name in parameters.OUTPUT} == parameters.OUTPUT


@pytest.mark.parametrize("off, runs", [(0.009, 2), (0.0149, 2), (0.0151, 3), (0.03, 3)])
def test_scatter_is_a_reason_for_no_more_than_one_finer_run(tmp_path, off, runs):
    """The contact time above 1 % of the peak scatters. If a finer run does not reduce its error
    enough, no other run follows.

    Up to WORTH times the accuracy (1 %) no finer run follows at all. In both cases an excess over
    the accuracy is a note, not a warning.
    """
    disc = Disc(tmp_path, 1e-9)
    def read(folder):
        longer = 1 + off if folder == tmp_path / "coarser" else 1
        return answers_of(folder)._replace(summary=answers_of(folder).summary | {"thresholded_contact_time": 4e-3 * longer})
    summary = estimate.settle(tmp_path, disc.values, True, disc.solve, read)
    assert summary["estimated_error"]["thresholded_contact_time"] == pytest.approx(off) and len(disc.asked) == runs
    assert any(f"thresholded contact time {100 * off:.2g} %" in note for note in summary["notes"]) == (off > 0.01)
    assert summary["warnings"] == []


@pytest.mark.parametrize("offs, runs", [((0.035, 0.021, 0.0126), 4), ((0.03, 0.025, 0.02), 3),
                                        ((0.029, 0.0207, 0.014), 4), ((0.029, 0.0211, 0.014), 3)])
def test_a_second_finer_run_follows_where_it_brings_the_contact_time_there(tmp_path, offs, runs):
    """Errors are offs[k] after k finer runs, for an accuracy of 1 %. A second finer run follows if
    offs[1]^2/offs[0] is at most WORTH times 1 %."""
    disc = Disc(tmp_path, 1e-9)
    def read(folder):
        longer = 1 + offs[len(disc.asked) - 2] if folder == tmp_path / "coarser" else 1
        return answers_of(folder)._replace(summary=answers_of(folder).summary | {"thresholded_contact_time": 4e-3 * longer})
    estimate.settle(tmp_path, disc.values, True, disc.solve, read)
    assert len(disc.asked) == runs


@pytest.mark.parametrize("values", [{"mesh_size": 0.016}, {"contact_mesh_size": 0.003}, {"dt": 1e-5}, {"mesh": "own"}, {"lost": 1e-3}, {"error": 3.0}])
def test_what_stays_above_is_said(tmp_path, values):
    """Prescribed sizes or steps, a mesh file or lost ellipticity prevent refinement. There are at
    most MOST refinements."""
    own_mesh = not values.pop("mesh", None)
    disc = Disc(tmp_path, values.pop("error", 0.03), **values)
    summary = disc.settle(own_mesh)
    assert summary["refinements"] == (estimate.MOST if disc.error > 1 else 0) == len(disc.asked) - 2
    warned, = summary["warnings"]
    assert re.fullmatch(r"estimated errors: \S.* %, requested 1 %: all above it: impulse \S+ %.*: ask .*", warned)
    # Which is not varied.
    assert [notes.name(note) for note in summary["notes"]] == ([] if own_mesh else ["mesh of the file"])
    assert summary["estimated_error"]["impulse"] > 0.01
    assert summary["estimated_error_excludes"] == ["penalty", "slip_velocity", *([] if own_mesh else ["mesh"])]


@pytest.mark.parametrize("code", [11, 12])
def test_a_coarser_run_that_fails_is_no_estimate(tmp_path, code):
    """The result stays without an error estimate, and a sentence has the reason. Other failures are
    failures of the run."""
    summary = Disc(tmp_path / "a", 0.03, fails=[ROOT2], code=code).settle()
    assert summary["estimated_error"] is None and summary["refinements"] == 0 and "no step at 1.41" in summary["warnings"][0]
    with pytest.raises(Failure, match="no step"):
        Disc(tmp_path / "b", 0.03, fails=[ROOT2], code=14).settle()


def test_a_finer_run_that_fails_leaves_the_run(tmp_path):
    """The existing result stays with its estimate. Sentences report that it exceeds the accuracy,
    and why the finer run failed."""
    summary = Disc(tmp_path, 0.036, fails=[1 / 2]).settle()
    assert summary["refinements"] == 1 and summary["estimated_error"]["impulse"] == pytest.approx(0.018, rel=0.02)
    assert len(summary["warnings"]) == 2 and "impulse 1.8 %" in summary["warnings"][0] and "no step at 0.50" in summary["warnings"][1]
    assert {path.name for path in tmp_path.iterdir()} == {"result.json", "of 0.71", "checkpoint.json"}


def test_another_run_is_the_same_body_on_the_same_plane():
    """Sizes and steps change, and the accuracy with their square. Contact parameters keep their
    used values.

    With a mesh file only the step changes. No element is larger than the radius.
    """
    values = parameters.defaults() | {"dt": 1e-5}
    used = values | {"mesh_size": 0.04, "contact_mesh_size": 0.003, "penalty": 1e10, "slip_velocity": 0.1, "friction_dynamic": 0.3}
    twice = estimate.other(values, used, 2.0)
    assert twice == values | {"mesh_size": 0.05, "contact_mesh_size": 0.006, "dt": 2e-5, "accuracy": 4 * values["accuracy"], "penalty": 1e10,
                              "slip_velocity": 0.1, "friction_dynamic": 0.3, "fields": 0}
    assert estimate.other(values, used, 2.0, own_mesh=False) == twice | {"mesh_size": 0, "contact_mesh_size": 0}
    assert estimate.other(values | {"dt": 0.0}, used | {"dt": 0.0}, 2.0)["dt"] == 0
    assert estimate.other(values, used, 100.0)["accuracy"] == estimate.LARGEST


def test_the_same_steps_are_no_estimate(tmp_path):
    """If the coarser run has equal unknowns and steps, its results are the same and give no
    estimate."""
    disc = Disc(tmp_path, 0.03)
    def read(folder):
        return answers_of(folder)._replace(summary=answers_of(folder).summary | {"dofs": 260, "steps": 4})
    summary = estimate.settle(tmp_path, disc.values, True, disc.solve, read)
    assert summary["estimated_error"] is None and "a second run took the same ones" in summary["warnings"][0]


@pytest.mark.parametrize("name, times, kind", [
    ("rebound", 1.1, "notes"), ("rebound", 1.6, "warnings"), ("thresholded_contact_time", 1.6, "warnings"), ("contact_time", 1.9, None),
    ("contact_time", 9.0, "notes"), ("peak_force", 9.0, "notes")])
def test_a_promised_answer_far_above_the_accuracy_is_a_warning(tmp_path, monkeypatch, name, times, kind):
    """An excess above 1.5 times the accuracy (1 %) is a warning. Below that, and for results that
    are not promised above twice the accuracy, it is a note."""
    disc = Disc(tmp_path, 1e-9, mesh_size=0.016)  # prescribed sizes prevent finer runs
    monkeypatch.setattr(estimate, "errors", lambda *_: dict.fromkeys([*estimate.BOUND, estimate.OF_ITSELF], 0.0) | {name: 0.01 * times})
    summary = disc.settle()
    for key in ("warnings", "notes"):
        assert [notes.name(sentence) for sentence in summary[key]] == (["estimated errors"] if key == kind else [])
        assert all(f"{name.replace('_', ' ')} {times:.2g} %, requested 1 %" in sentence for sentence in summary[key])


@pytest.mark.parametrize("transit, kind", [(None, "notes"), (1e-5, "warnings")])
def test_a_contact_time_that_is_far_off_is_a_note_only_where_it_scatters(tmp_path, monkeypatch, transit, kind):
    """Only the contact time exceeds the accuracy, and a finer run does not halve its error: after a
    round impact it scatters, after a flat strike it is late."""
    disc, far = Disc(tmp_path, 1e-9), {"thresholded_contact_time": 0.03}
    monkeypatch.setattr(estimate, "error_estimates", lambda *_: dict.fromkeys([*estimate.BOUND, estimate.OF_ITSELF], 0.0) | far)
    summary = estimate.settle(tmp_path, disc.values, True, disc.solve, lambda folder: answers_of(folder)._replace(summary=answers_of(folder).summary | {"front_transit": transit}))
    assert {key: [notes.name(sentence) for sentence in summary[key]] for key in ("warnings", "notes")} == {"warnings": [], "notes": []} | {kind: ["estimated errors"]}


def test_runs_that_saw_different_touches_say_so():
    """If the runs of a pair have different numbers of contact intervals, a warning reports both
    numbers; else there is none."""
    sentence, = estimate.touches({"contact_intervals": 3}, {"contact_intervals": 2})
    assert sentence.startswith("touches: contact intervals 3, with 1.4 times larger elements and steps 2: ")
    assert not estimate.touches({"contact_intervals": 3}, {"contact_intervals": 3})


# ---- flat strikes

def test_errors_of_a_flat_strike_fall_with_their_measures():
    """Doubling the differences of a pair doubles the errors of impulse and rebound. The rise time
    of the front enters contact times.

    A front that the elements do not resolve leaves an error that no pair shows.
    """
    names = {name: 1e-2 for name in [*estimate.BOUND, estimate.OF_ITSELF]}
    resolved = estimate.front_errors(names, names, 0.01, 1e-3)
    twice = estimate.front_errors({name: 2e-2 for name in names}, {name: 2e-2 for name in names}, 0.01, 1e-3)
    assert twice["impulse"] == pytest.approx(2 * resolved["impulse"]) and twice["rebound"] == pytest.approx(2 * resolved["rebound"])
    later = estimate.front_errors(names, names, 0.02, 1e-3)["contact_time"] - resolved["contact_time"]
    assert later == pytest.approx(estimate.FRONT["contact_time"] * 0.01)
    none = dict.fromkeys(names, 0.0)
    sharp = estimate.front_errors(none, none, 0.01, 0.1)
    assert sharp["rebound"] == 2 * sharp["impulse"] == pytest.approx(0.024) and estimate.front_errors(none, none, 0.01, 0.0)["rebound"] == 0


def test_errors_of_several_impacts_fall_no_faster_than_second_order():
    """If runs agree at the end by chance, the estimate contains the difference of their histories
    and half of the former estimate."""
    small, course = {name: 1e-6 for name in estimate.BOUND}, {name: 1e-3 for name in estimate.BOUND}
    assert estimate.strikes_again(small, course, None)["rebound"] == 1e-3
    again = estimate.strikes_again(small, course, {name: 1e-2 for name in estimate.BOUND})
    assert again["rebound"] == pytest.approx(5e-3) and again["peak_force"] == 1e-6


@pytest.mark.parametrize("used, intervals, least", [
    ({"body": [{"rigid": True}, {}]}, 1, 0.1), ({"body": [{}, {"support": [{"where": "left"}]}]}, 2, 0.25),
    ({"body": [{"load": [{"where": "inner"}]}]}, 1, 0.7), ({"body": [{}], "obstacle": [{"motion": [0, 1]}]}, 1, 0.1),
    ({"body": [{}], "obstacle": [{"kind": "plane"}]}, 2, 0.0), ({}, 1, 0.0)])
def test_what_is_held_or_rigid_is_stated_with_a_share_of_the_accuracy(used, intervals, least):
    """The estimate is at least this share of the accuracy. A larger estimate does not change, nor
    does a result that is exactly 0."""
    run = Answers({"contact_intervals": intervals}, used | {"accuracy": 0.02}, 1.0, {})
    small = dict.fromkeys(estimate.BOUND, 1e-6)
    assert estimate.held_errors(small, run, run)["impulse"] == pytest.approx(max(1e-6, least * 0.02))
    large = dict.fromkeys(estimate.BOUND, 1.0) | {"friction_work": 0.0}
    assert estimate.held_errors(large, run, run) == large
