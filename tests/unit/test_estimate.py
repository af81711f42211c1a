"""The error estimate of a run: differences of a pair of runs, estimates from them, and finer runs
until the estimate is small enough."""

import json
import math
import re
from functools import partial
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
# Error estimate over the error of the fake disc: both pairs of levels show an error of order 2.
FACTOR = estimate.SAFETY[2] * math.sqrt(3)
# Of the first run of the fake disc.
START = {"mesh_size": 0.016, "contact_mesh_size": 0.003, "dt": 0.0}


# ---- differences of two runs

def run(summary=ANSWERS, factor=lambda t: 0 * t, steps: int = 401, **columns) -> Answers:
    """A run with a force of one half wave, whose history has the relative deviation factor(t)."""
    t = np.linspace(0, 4e-3, steps)
    hump = np.sin(np.pi * t / 4e-3)
    off = 1 + factor(t)
    history = {"t": t, "dt": np.diff(t, prepend=0.0), "vx": 0 * t, "vy": 10 * off, "spin": 20 * off, "elastic": 5 * off, "contact": 0 * t,
               "friction_work": 0.5 * off, "max_pressure": 3e5 * hump * off, "max_penetration": 1e-5 * hump * off, "normal_force": 500 * np.pi * hump * off / 2} | columns
    return Answers(summary | {"largest_energy": 5.0}, {"radius": 0.5}, 10.0, history)


@pytest.mark.parametrize("change, expected", [
    ({"impulse": 2.1}, {"impulse": 0.05}), ({"rebound_vx": 1.3, "rebound_vy": 2.6}, {"rebound": 0.05}), ({"rebound_spin": -10.0}, {"rebound_spin": 0.1}),
    ({"energy_final": 4.25}, {"energy": 0.05}), ({"vibration_energy": 1.5}, {"energy": 0.1}),
    ({"friction_work": 0.75}, {"friction_work": 0.05, estimate.OF_ITSELF: 0.5}), ({"contact_time": 5e-3}, {"contact_time": 0.25}),
    ({"thresholded_contact_time": 3.51e-3}, {"thresholded_contact_time": 0.1}), ({"peak_force": 7.7e4}, {"peak_force": 0.1}), ({}, {})])
def test_each_answer_differs_over_its_scale(change, expected):
    """Velocities are relative to 10 m/s, spin times a radius of 0.5 m to the same, energies to the
    largest energy, others to themselves.

    No other difference changes.
    """
    apart = estimate.differences(run(), run(ANSWERS | change))
    assert apart == pytest.approx(dict.fromkeys(apart, 0.0) | expected) and set(expected) <= set(apart)


def test_answers_that_are_not_there_do_not_differ():
    """In a flight there are neither contact times nor a force; tables have nan for them."""
    flight = run(ANSWERS | {"contact_time": None, "thresholded_contact_time": float("nan"), "peak_force": 0.0, "impulse": 0.0}, normal_force=np.zeros(401))
    assert not any(estimate.differences(flight, flight).values()) and not any(estimate.history_differences(flight, flight).values())


def test_largest_values_and_works_of_supports_differ_over_the_value_and_the_energy():
    """The force of a support is the length of its vector."""
    t = np.linspace(0, 1, 401)
    forces = {"support_force_x_1": 3 * t, "support_force_y_1": 4 * t, "support_work": 2 * t}
    apart = estimate.differences(run(**forces), run(**forces | {"support_force_x_1": 0 * t, "support_work": t}))
    assert apart["support_peak_1"] == pytest.approx(0.2) and apart["support_work"] == pytest.approx(0.2)
    assert estimate.differences(run(), run(max_pressure=np.full(401, 3.3e5)))["max_pressure"] == pytest.approx(0.1)


def test_energies_are_compared_at_the_end_of_the_shorter_run():
    """Two runs of one motion differ in their ends alone. A gas exchanges energy with the body, so that
    energies and work at these ends differ, but not at the same time."""
    def ends(last: float) -> Answers:
        t = np.linspace(0, last, 401)
        work = np.sin(1e4 * t)
        energies = {"energy_final": 4.0 + work[-1], "vibration_energy": 1.0 + work[-1]}
        return run(ANSWERS | energies, t=t, load_work=work)

    apart = estimate.differences(ends(4e-3), ends(3.8e-3))
    assert apart["energy"] == pytest.approx(0, abs=1e-3) and apart["load_work"] == pytest.approx(0, abs=1e-3)
    assert abs(math.sin(40) - math.sin(38)) / 5 > 0.08


def test_energies_of_damped_bodies_are_compared_at_the_end_of_the_shorter_run():
    """A body goes on losing energy after its contact, so that a longer run has less of it."""
    def ends(last: float, rate: float = 500.0) -> Answers:
        t = np.linspace(0, last, 401)
        lost = rate * t
        return run(ANSWERS | {"energy_final": 4.0 - lost[-1], "vibration_energy": 3.0 - lost[-1]}, t=t, viscous_work=lost)

    assert estimate.differences(ends(4e-3), ends(3.6e-3))["energy"] == pytest.approx(0, abs=1e-9)
    assert estimate.differences(ends(4e-3), ends(3.6e-3, 450.0))["energy"] == pytest.approx(50 * 3.6e-3 / 5, rel=0.1)


def test_time_histories_are_compared_near_their_ends():
    """A deviation of 1 % in the last quarter is one of all results, over their scales. An earlier one
    counts for the friction work, and for largest values while they are reached. A history with other
    steps does not differ."""
    late = estimate.history_differences(run(), run(factor=lambda t: 0.01 * (t >= 3e-3)))
    assert late["rebound"] == late["energy"] == pytest.approx(0.01, rel=1e-2) and late["rebound_spin"] == pytest.approx(0.01, rel=1e-2)
    assert late["friction_work"] == pytest.approx(0.001, rel=1e-2) and late[estimate.OF_ITSELF] == pytest.approx(0.01, rel=1e-2)
    early = estimate.history_differences(run(), run(factor=lambda t: 0.01 * ((t > 1e-3) & (t < 2.9e-3))))
    assert early["rebound"] == early["energy"] == 0
    assert 0.008 < early["peak_force"] < 0.01 and 0.008 < early["max_pressure"] < 0.01 and early["friction_work"] == pytest.approx(0.001)
    before = estimate.history_differences(run(), run(factor=lambda t: 0.01 * (t < 1e-3)))
    assert before["peak_force"] == before["max_pressure"] == 0  # the force is below 0.71 of its peak
    same = estimate.history_differences(run(), run(steps=801))
    assert max(same.values()) < 2e-3


def test_a_flight_after_the_contact_is_no_agreement():
    """Runs that differ at the end of contact alone, and agree in a flight of four times its duration
    that follows, differ as they do without the flight."""
    def flown(deviation: float, flight: int) -> Answers:
        short = run(factor=lambda t: deviation * (t >= 3e-3))
        add = {name: np.full(flight, column[-1]) for name, column in run().history.items()}
        add |= {"t": 4e-3 + 1e-5 * np.arange(1, flight + 1), "dt": np.full(flight, 1e-5), "normal_force": np.zeros(flight)}
        return short._replace(history={name: np.append(column, add[name]) for name, column in short.history.items()})
    near, far = (estimate.history_differences(flown(0, n), flown(0.01, n)) for n in (1, 1600))
    for name in ("rebound", "rebound_spin", "energy", "impulse"):
        assert near[name] > 0 and far[name] == pytest.approx(near[name], rel=1e-2), name


def test_a_later_end_is_a_difference_of_times():
    """In a run that is 2 % longer the half wave of the force reaches each share s of the impulse 2 %
    later: at T acos(1 - 2 s)/pi, in units of the contact time."""
    longer = run()
    longer = longer._replace(history=longer.history | {name: 1.02 * longer.history[name] for name in ("t", "dt")})
    later = 0.02 * 4e-3 * np.arccos(1 - 2 * estimate.SHARES) / np.pi / ANSWERS["contact_time"]
    apart = estimate.history_differences(run(), longer)
    assert apart["contact_time"] == pytest.approx(later.max(), rel=1e-2)
    assert apart["thresholded_contact_time"] == pytest.approx(math.sqrt(np.mean(later**2)), rel=1e-2)


def test_the_gain_of_a_level_is_the_ratio_of_the_differences_around_it():
    """Times that fall off by 3 and 4 %, of a force with the same history, have the gain 0.75; two
    runs have none."""
    runs = [run(ANSWERS | {"thresholded_contact_time": time}) for time in (1.0, 1.03, 1.0712)]
    assert estimate.gain(runs) == pytest.approx(0.75, rel=1e-3) and estimate.gain(runs[:2]) == 0


# ---- estimates

@pytest.mark.parametrize("rise, order", [(None, 2), (1e-5, 1)])
def test_errors_of_the_order_of_the_scene_are_estimated_with_the_safety(rise, order):
    """The impulse has the error 1 % of that order, and the histories do not differ: the estimate is
    SAFETY times sqrt(1 + r^p) of it, from one pair SAFETY."""
    runs = [run(ANSWERS | {"impulse": 2 * (1 + 0.01 * ROOT2 ** (order * k)), "front_rise": rise}) for k in range(3)]
    stated = estimate.error_estimates(runs)["impulse"] * runs[0].summary["impulse"] / 2
    assert stated == pytest.approx(estimate.SAFETY[2] * math.sqrt(1 + ROOT2**order) * 0.01, rel=0.03)
    single = estimate.error_estimates(runs[:2])["impulse"] * runs[0].summary["impulse"] / 2
    assert single == pytest.approx(estimate.SAFETY[1] * 0.01, rel=1e-6)


def test_runs_that_agree_by_chance_are_estimated_by_the_others_and_by_their_histories():
    """The finest two agree in the impulse. The estimate is the next difference over r^(p/2), and at
    least the difference of the histories. Without any difference there is no error."""
    odd = run(ANSWERS | {"impulse": 2.04})
    assert estimate.error_estimates([run(), run(), odd])["impulse"] == pytest.approx(estimate.SAFETY[2] * 0.02 / ROOT2)
    off = estimate.error_estimates([run(), run(factor=lambda t: 0.01 * (t >= 3e-3))])
    assert off["rebound"] == pytest.approx(estimate.SAFETY[1] * 0.01, rel=1e-2)
    assert not any(estimate.error_estimates([run(), run(), run()]).values())


@pytest.mark.parametrize("others, ratio", [(4.0, 2.0), (1.8, 1.8), (1.2, 2**0.75)])
def test_the_order_is_the_median_of_all_results(others, ratio):
    """The impulse falls as the square of the sizes in all cases. The other differences fall in the
    ratio `others`, and with them the error estimates, but at most with p and at least with 3/4 p."""
    def level(square: float, other: float) -> Answers:
        changed = {name: ANSWERS[name] * (1 + 0.01 * other) for name in ("friction_work", "contact_time", "thresholded_contact_time", "peak_force")}
        return run(ANSWERS | changed | {"impulse": 2 * (1 + 0.01 * square)})
    stated = estimate.error_estimates([level(0, 0), level(1, 1), level(3, 1 + others)])["impulse"]
    assert stated == pytest.approx(estimate.SAFETY[2] / (ratio - 1) * 0.01 * math.sqrt(1 + 4.0 / ratio), rel=0.05)


def test_contact_times_have_the_smallest_order():
    """Contact times that fall as the square of the sizes are estimated as if they fell with 3/4 of it."""
    runs = [run(ANSWERS | {"contact_time": 1 + 0.01 * 2**k, "impulse": 2 * (1 + 0.01 * 2**k)}) for k in range(3)]
    stated, ratio = estimate.error_estimates(runs), 2**0.75
    expected = estimate.SAFETY[2] / (ratio - 1) * 0.01 * math.sqrt(1 + 4 / ratio)
    assert stated["contact_time"] * runs[0].summary["contact_time"] == pytest.approx(expected, rel=0.02)
    assert stated["impulse"] * runs[0].summary["impulse"] / 2 == pytest.approx(estimate.SAFETY[2] * 0.01 * math.sqrt(3), rel=0.03)


def test_an_impact_that_is_not_over_has_no_estimates_of_its_end():
    """A later contact would change impulse, rebound and times; energy, works and peaks are those of
    the record."""
    cut = [run(ANSWERS | {"later_contact_possible": True}), run(ANSWERS | {"impulse": 2.1})]
    stated = estimate.error_estimates(cut)
    assert set(estimate.error_estimates(cut[::-1])) - set(stated) == set(estimate.OF_IMPACT)
    assert estimate.largest(stated) == 0 and not estimate.excess(stated, 0.01, "impulse", 0.01)


def test_a_drift_that_all_runs_have_is_an_error_of_the_energy():
    drifting = run(ANSWERS | {"energy_drift": 0.03})
    assert estimate.error_estimates([drifting] * 3)["energy"] == 0.03


@pytest.mark.parametrize("name, times, also, named", [
    ("impulse", 1.1, "promised", True), ("impulse", 0.9, "promised", False), ("peak_force", 2.1, "promised", True), ("peak_force", 1.9, "promised", False),
    ("peak_force", 1.1, "peak_force", True), ("contact_time", 1.9, "peak_force", False),
    ("contact_time", 2.1, "peak_force", True), (estimate.OF_ITSELF, 9.0, "promised", False), (estimate.OF_ITSELF, 1.1, "friction_work", True)])
def test_answers_above_what_is_asked_are_named(name, times, also, named):
    """One sentence with name and per cent for promised results and the requested one above the
    accuracy, and for others above twice the accuracy."""
    estimated = dict.fromkeys([*estimate.RESULTS, estimate.OF_ITSELF], 0.0) | {name: times * 0.01}
    sentences = estimate.excess(estimated, 0.01, also, 0.01)
    assert len(sentences) == named and all(f"{name.replace('_', ' ')} {times:.2g} %" in sentence and ", requested 1 %: all above it: " in sentence for sentence in sentences)


# ---- the runs

def answers_of(folder: Path) -> Answers:
    """The results of the fake disc in a folder. Its time history has no deviation."""
    summary, used, speed = json.loads((folder / "result.json").read_text())
    return Answers(summary | {"largest_energy": 5.0}, used | {"radius": 0.5}, speed, run().history)


# Requests of a user besides the accuracy.
REQUESTS = {"fields": 5, "modes": 4, "checkpoint_every": 7}


class Disc:
    """A disc whose impulse has the relative error `error` at the sizes START. The error is
    quadratic in the sizes.

    The time history has no deviation. A run fails with `code` at the factors `fails` of the sizes.
    """

    def __init__(self, stage: Path, error: float, fails=(), code: int = 11, lost: float | None = None, **values):
        self.error, self.fails, self.code, self.lost, self.asked = error, fails, code, lost, []
        self.values = {**dict.fromkeys(START, 0.0), "accuracy": 0.01, "accuracy_of": "promised", **REQUESTS, **values}
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
        return estimate.settle(self.stage, self.values, own_mesh, self.solve, answers_of, partial(self.scaled, own_mesh))

    def scaled(self, own_mesh: bool, used: dict, factor: float) -> dict:
        """The entries of the disc with `factor` times its elements, unless they are of a file, and steps."""
        sizes = {name: factor * used[name] for name in START if used[name] > 0 and (own_mesh or name == "dt")}
        return self.values | sizes | {"accuracy": estimate.loosened(used["accuracy"], factor)} | estimate.output(factor)

    def factors(self) -> list[float]:
        """The sizes of the runs over START."""
        return [(values["mesh_size"] or START["mesh_size"]) / START["mesh_size"] for values in self.asked]


def test_an_estimate_below_the_accuracy_takes_two_coarser_runs(tmp_path):
    """Elements and steps are 1.4 and 2 times larger. No other files stay in the folder."""
    disc = Disc(tmp_path, 0.003)
    summary = disc.settle()
    assert disc.factors() == pytest.approx([1, ROOT2, 2]) and disc.asked[1]["fields"] == disc.asked[2]["fields"] == 0
    assert summary["estimated_error"]["impulse"] == pytest.approx(FACTOR * 0.003, rel=0.02)
    assert summary["refinements"] == 0 and summary["warnings"] == []
    assert summary["estimate_cpu_seconds"] == 2 and {path.name for path in tmp_path.iterdir()} == {"result.json", "of 1.00", "checkpoint.json"}


def test_finer_runs_follow_until_it_is(tmp_path):
    """3 % is halved twice. The finest run becomes the result; the former runs are its levels."""
    disc = Disc(tmp_path, 0.03)
    summary = disc.settle()
    assert disc.factors() == pytest.approx([1, ROOT2, 2, 1 / ROOT2, 1 / 2])
    assert summary["estimated_error"]["impulse"] == pytest.approx(FACTOR * 0.0075, rel=0.02)
    assert summary["refinements"] == 2 and summary["warnings"] == []
    assert summary["estimate_cpu_seconds"] == 4
    assert {path.name for path in tmp_path.iterdir()} == {"result.json", "of 0.50", "checkpoint.json"}
    assert (tmp_path / "checkpoint.json").read_text() == "what the run was asked for"


@pytest.mark.parametrize("estimated, runs", [(0.07, 5), (0.09, 3)])
def test_no_finer_run_follows_where_none_can_meet_the_request(tmp_path, estimated, runs):
    """Two finer runs reduce errors of order 2 to a quarter: 8 % to twice the accuracy of 1 %."""
    disc = Disc(tmp_path, estimated / FACTOR)
    summary = disc.settle()
    assert len(disc.factors()) == runs and summary["refinements"] == runs - 3
    assert bool(summary["warnings"]) == (runs == 3)


@pytest.mark.parametrize("name, expected", [("fields", [5, 0, 0, 5, 5]), ("modes", [4, 0, 0, 4, 4]), ("checkpoint_every", [7] * 5)])
def test_what_was_asked_for_is_asked_of_every_run_that_may_stay(tmp_path, name, expected):
    """A finer run replaces the first one and has all its requests. The coarser run writes no
    output."""
    disc = Disc(tmp_path, 0.03)
    disc.settle()
    assert [values[name] for values in disc.asked] == expected


def test_what_asks_for_output_is_off_by_default():
    """The values that request no output are the defaults of the table for every script."""
    assert {name: parameters.PARAMETERS[name].default for name in parameters.OUTPUT} == parameters.OUTPUT


@pytest.mark.parametrize("offs, falls, runs", [
    ((0.009,), (2,), 3), ((0.0199,), (2,), 3), ((0.0201, 0.0201), (2, 1), 4), ((0.035, 0.021, 0.0126), (2, 0.95, 1), 5),
    ((0.035, 0.034), (0.57, 0.6), 4), ((0.035, 0.034, 0.0201), (0.57, 0.58, 1), 5)])
def test_scatter_is_a_reason_for_a_second_finer_run_only_where_it_brings_the_contact_time_there(tmp_path, monkeypatch, offs, falls, runs):
    """The estimate of the contact time above 1 % of the peak is offs[k] after k finer runs, for an
    accuracy of 1 %. Up to WORTH times the accuracy no finer run follows. Above, one follows, and
    a second one if the estimate times falls[1], the gain of the first, is at most WORTH times 1 %. What stays above
    WORTH times it is a warning, which says whether a finer run was not worth it; what is above the
    accuracy by less is a note."""
    disc = Disc(tmp_path, 1e-9)
    monkeypatch.setattr(estimate, "error_estimates", lambda _: dict.fromkeys([*estimate.RESULTS, estimate.OF_ITSELF], 0.0) | {
        "thresholded_contact_time": offs[len(disc.asked) - 3]})
    monkeypatch.setattr(estimate, "gain", lambda _: falls[len(disc.asked) - 3])
    summary = disc.settle()
    last = summary["estimated_error"]["thresholded_contact_time"]
    assert last == offs[runs - 3] and len(disc.asked) == runs
    sentences = {kind: [f"thresholded contact time {100 * last:.2g} %" in sentence for sentence in summary[kind]] for kind in ("warnings", "notes")}
    assert sentences == {"warnings": [True] * (last > 0.02), "notes": [True] * (0.01 < last <= 0.02)}
    why = [sentence.endswith("it scatters from mesh to mesh") for sentence in summary["warnings"]]
    assert why == [True] * (last > 0.02)


@pytest.mark.parametrize("values", [{"mesh_size": 0.016}, {"contact_mesh_size": 0.003}, {"dt": 1e-5}, {"mesh": "own"}, {"lost": 1e-3}, {"error": 3.0}])
def test_what_stays_above_is_said(tmp_path, values):
    """Prescribed sizes or steps, a mesh file, lost ellipticity, or an error that no refinement
    reduces to the request prevent refinement."""
    own_mesh = not values.pop("mesh", None)
    disc = Disc(tmp_path, values.pop("error", 0.03), **values)
    summary = disc.settle(own_mesh)
    assert summary["refinements"] == 0 == len(disc.asked) - 3
    warned, = summary["warnings"]
    assert re.fullmatch(r"estimated errors: \S.* %, requested 1 %: all above it: impulse \S+ %.*: if you need these numbers, (ask|take) .*", warned)
    # Errors fall in proportion to the accuracy that the last run was made for.
    needed = 1e-4 / 2**summary["refinements"] / summary["estimated_error"]["impulse"]
    free = own_mesh and not {"mesh_size", "contact_mesh_size", "dt"} & values.keys()
    assert warned.endswith(f"ask for accuracy = {needed:.1g}" if free else "take smaller elements and steps")
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


def test_without_the_coarsest_run_a_single_pair_is_the_estimate(tmp_path):
    """It fails, or it has the unknowns and steps of the coarser one."""
    summary = Disc(tmp_path, 0.003, fails=[2]).settle()
    assert summary["estimated_error"]["impulse"] == pytest.approx(estimate.SAFETY[1] * 0.003, rel=0.02) and not summary["warnings"]


def test_a_finer_run_that_fails_leaves_the_run(tmp_path):
    """The existing result stays with its estimate. Sentences report that it exceeds the accuracy,
    and why the finer run failed."""
    summary = Disc(tmp_path, 0.03, fails=[1 / 2]).settle()
    assert summary["refinements"] == 1 and summary["estimated_error"]["impulse"] == pytest.approx(FACTOR * 0.015, rel=0.03)
    assert len(summary["warnings"]) == 2 and "impulse 2.3 %" in summary["warnings"][0] and "no step at 0.50" in summary["warnings"][1]
    assert {path.name for path in tmp_path.iterdir()} == {"result.json", "of 0.71", "checkpoint.json"}


def test_the_accuracy_goes_with_the_square_of_the_sizes():
    """It stays below the largest one."""
    assert estimate.loosened(0.01, 2.0) == 0.04 and estimate.loosened(0.01, 0.5) == 0.0025
    assert estimate.loosened(0.01, 100.0) == estimate.LARGEST


def test_the_same_steps_are_no_estimate(tmp_path):
    """If the coarser run has equal unknowns and steps, its results are the same and give no
    estimate."""
    disc = Disc(tmp_path, 0.03)
    def read(folder):
        return answers_of(folder)._replace(summary=answers_of(folder).summary | {"dofs": 260, "steps": 4})
    summary = estimate.settle(tmp_path, disc.values, True, disc.solve, read, partial(disc.scaled, True))
    assert summary["estimated_error"] is None and "a coarser run has the same elements and steps" in summary["warnings"][0]


@pytest.mark.parametrize("name, times, kind", [
    ("rebound", 1.9, "notes"), ("rebound", 2.1, "warnings"), ("thresholded_contact_time", 2.1, "warnings"), ("contact_time", 1.9, None),
    ("contact_time", 9.0, "notes"), ("peak_force", 9.0, "notes")])
def test_a_promised_answer_far_above_the_accuracy_is_a_warning(tmp_path, monkeypatch, name, times, kind):
    """An excess above twice the accuracy (1 %) is a warning. Below that, and for results that
    are not promised above twice the accuracy, it is a note."""
    disc = Disc(tmp_path, 1e-9, mesh_size=0.016)  # prescribed sizes prevent finer runs
    monkeypatch.setattr(estimate, "error_estimates", lambda _: dict.fromkeys([*estimate.RESULTS, estimate.OF_ITSELF], 0.0) | {name: 0.01 * times})
    summary = disc.settle()
    for key in ("warnings", "notes"):
        assert [notes.name(sentence) for sentence in summary[key]] == (["estimated errors"] if key == kind else [])
        assert all(f"{name.replace('_', ' ')} {times:.2g} %, requested 1 %" in sentence for sentence in summary[key])


def test_runs_with_other_numbers_of_contacts_are_a_warning():
    """If a level has another number of contact intervals than the run, a warning reports both
    numbers and the level; else there is none."""
    several = [run(ANSWERS | {"contact_intervals": number}) for number in (3, 2, 3)]
    sentence, = estimate.touches(several)
    assert sentence.startswith("touches: in contact 3 times, 2 times with 1.4 times larger elements and steps: ")
    coarsest, = estimate.touches([several[0], several[2], several[1]])
    assert "2 times with 2.0 times larger" in coarsest
    assert not estimate.touches(several[::2]) and not estimate.touches(several[:1])


def test_a_missed_accuracy_is_a_warning_beside_any_other():
    """Of the warnings that make notes of others, none makes one of an estimated error or of runs
    that differ in kind."""
    for other in notes.BEHIND:
        both = notes.settled([f"{other}: a", "estimated errors: b", "touches: c"], [])
        assert both["warnings"][-2:] == ["estimated errors: b", "touches: c"], other
