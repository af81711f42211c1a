"""Estimates the error of a run from a second run with larger elements and steps. Finer runs follow
until the estimate meets the requested accuracy.

The program reports the finer run of a pair. Elements and steps of the coarser run are COARSER times
as large, which doubles an error quadratic in them, so the difference of a result is about its
error. But one difference can be small by chance. And in an impact without friction impulse, rebound
and energy are one number: their differences are small together. So the error estimate of a result
is a geometric mean of three measures that mislead for different reasons,

    BOUND (D d A)^(1/3),   D: mean of the differences of the results PROMISED over USUAL;
                           d: largest difference of its time history over its scale: running
                              impulse, velocities, elastic energy (course());
                           A = 1/n^2, n: steps with a force above half its peak; A is the accuracy
                              of second-order steps,

and at least the difference. Results that friction couples have common estimates (_together()).

Three results have other measures (MEASURES): the steps of an impact say little about spin and peak
force (d for A), the other results little about friction work (d for D). Contact ends between two
steps, so times converge more slowly: their root is the fourth. With the factors BOUND the estimate
contains the error in 97 of 100 runs (on scenes other than those of docs/measurements/promise.md),
and is about three times the usual error. The estimate covers mesh and steps: penalty and slip
velocity are the same in all runs.

Steps do not exceed 0.3 of a transit of waves (sizes.idp). Both runs of a pair have the same steps
at a requested accuracy of 0.06 or more, and steps 7 % apart at 0.05: the difference is then that of
the elements alone. The hidden share of the error of the steps (alike()), times ALIKE A, is added to
D and d.

Finer runs follow if the estimate of a promised result is above WORTH times the request. The contact
time scatters with the vibration at the end of contact (by 0.8 % rms in hard impacts, on any mesh
and with any step that was tried). If it alone is above, a second finer run follows only if the gain
of the first one, gained again, brings its estimate there. An estimate that is still above WORTH
times the request is a warning. One that is above the request by less, or of a result that scatters
or is not promised, is a note (notes.py).
"""

import math
import os
import shutil
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

import numpy as np

from ..failure import Failure
from ..input.parameters import OUTPUT, Value
from .rest import rest_errors
from .results import Answers, held_bodies, suffixes

__all__ = [
    "ALIKE",
    "BOUND",
    "COARSE",
    "COARSER",
    "COURSE",
    "FRONT",
    "HIGHEST",
    "INSTANT",
    "LARGEST",
    "LEVER",
    "MOST",
    "OF_ITSELF",
    "PROMISED",
    "STILL",
    "USUAL",
    "alike",
    "course",
    "difference",
    "driven",
    "error_estimates",
    "errors",
    "excess",
    "front_errors",
    "held_errors",
    "highest",
    "largest",
    "loosened",
    "other",
    "output",
    "resolved",
    "settle",
    "strikes_again",
    "touches",
    "wanted",
]

COARSER = math.sqrt(2)  # ratio of elements and steps in the two runs of a pair
COARSE, FINE = "coarser", "finer"  # folders of the other runs, in that of the main one
MOST = 2  # largest number of refinements, after which elements and steps are half as large
SIZES = ("mesh_size", "contact_mesh_size", "dt")
LARGEST = 0.4  # largest accuracy that the scripts accept
LOOSER = 2  # factor on the accuracy for notes about results that are not promised
WORTH = 1.5  # error estimate over the requested accuracy above which a finer run follows
REGULARISED = ("penalty", "slip_velocity")
NO_ANSWER = (11, 12)  # exit codes of runs that the step or the material ended
# USUAL: usual differences of the results of a pair, relative to each other; the first six are
# promised. BOUND: factors of the error estimates. Both are calibrated on scenes other than those of
# docs/measurements/promise.md.
USUAL = {
    "impulse": 0.06,
    "rebound": 0.12,
    "rebound_spin": 0.08,
    "energy": 0.16,
    "friction_work": 0.04,
    "thresholded_contact_time": 0.4,
    "contact_time": 0.8,
    "peak_force": 1.2,
}
BOUND = {
    "impulse": 0.4,
    "rebound": 0.51,
    "rebound_spin": 0.98,
    "energy": 0.81,
    "friction_work": 4.2,
    "thresholded_contact_time": 0.79,
    "contact_time": 1.22,
    "peak_force": 4.34,
}
# Measures whose product gives the estimate of a result, DdA for all others, and the root of the
# product, 3 for all others.
MEASURES = {"rebound_spin": "Ddd", "friction_work": "Add", "peak_force": "Ddd"}
ROOT = {"thresholded_contact_time": 4, "contact_time": 4}
# D and differences d of results by the error of the steps alone, over A.
ALIKE = {
    "D": 1.4,
    "impulse": 0.3,
    "rebound": 0.7,
    "rebound_spin": 0.5,
    "energy": 1.0,
    "friction_work": 0.03,
}
# Factors of the error estimates of flat strikes (front_errors()), calibrated likewise.
FRONT = {
    "impulse": 3.0,
    "rebound": 3.0,
    "rebound_spin": 5.0,
    "energy": 3.0,
    "friction_work": 3.0,
    "thresholded_contact_time": 3.8,
    "contact_time": 3.2,
    "peak_force": 9.0,
}
# Smallest error estimates over the accuracy (held_errors()), calibrated likewise: HELD for scenes
# with supports, rigid bodies or moving obstacles, LOADED for scenes with loads.
HELD = {
    "impulse": 0.1,
    "rebound": 0.8,
    "rebound_spin": 0.05,
    "energy": 0.35,
    "friction_work": 0.3,
    "thresholded_contact_time": 0.7,
    "contact_time": 1.0,
    "peak_force": 1.0,
}
LOADED = {
    "impulse": 0.7,
    "rebound": 1.2,
    "rebound_spin": 0.05,
    "energy": 4.0,
    "friction_work": 0.3,
    "thresholded_contact_time": 1.5,
    "contact_time": 1.5,
    "peak_force": 7.0,
}
TOUCHES_AGAIN = 2.5  # factor on these if there are several contact intervals
# SHARP: error by an unresolved front over its transit through an element. It is full if this
# transit is RESOLVED times the rise time or more (front_errors()).
SHARP, RESOLVED = {"impulse": 0.12, "rebound": 0.24, "energy": 0.48}, 7.5
PROMISED = tuple(USUAL)[:6]
AT_END = ("rebound", "final")  # velocities at the end of contact and of the run
# Results that take the time history of another result.
COURSE = {
    "thresholded_contact_time": "impulse",
    "contact_time": "impulse",
    "peak_force": "impulse",
}
# Factor on BOUND of friction work if nothing turns: small slip under a patch that mostly sticks.
STILL = 1.6
# Velocity that an impulse of friction gives the centre, over the rim speed of the spin that it
# causes: 1/2 for a disc, 2/5 for a ball, and a margin.
LEVER = 0.7
# Factor of a difference of friction work in those of speed, spin and energy, which it changes, too.
THROUGH = 2
SHARES = np.linspace(0, 1, 201)  # shares of the impulse at which friction work is compared
NONE = 1e-12  # largest relative difference that is round-off
# First words of the messages `skipped` about steps that integrator = auto has not chosen.
STEPS = ("explicit steps (", "implicit steps (")
SCATTERS = "thresholded_contact_time"  # the promised result that scatters
SAME_STEPS = (
    "the error is not estimated: with steps 1.4 times larger a second run took the same ones: they are too "
    "large for this scene: ask for a smaller accuracy"
)
FILE_MESH = (
    "mesh of the file: error estimates are those of the time step: the error of the mesh is not included: "
    "run a finer one beside it"
)
# Error of friction work relative to friction work itself, for accuracy_of = friction_work.
OF_ITSELF = "friction_work of itself"
HIGHEST = ("max_pressure", "max_penetration")  # largest values of columns of the history
# Error estimate of these values over the difference of the columns. It contains the error in 95 of
# 100 runs.
INSTANT = 2.0

Scaled = Callable[[Mapping, Mapping, float, bool], dict[str, Value]]
# Runs the scene with these values in a folder, and raises Failure if the run fails.
Solve = Callable[[dict[str, Value], Path], None]


def settle(
    stage: Path,
    values: Mapping[str, Value],
    own_mesh: bool,
    solve: Solve,
    read: Callable,
    scaled: Scaled | None = None,
) -> dict:
    """Estimates the error of the run in `stage`, made from the scene `values`, and computes finer
    runs.

    If sizes and steps follow from the accuracy and the estimate is above it, finer runs replace the
    run in `stage`. `read` returns the Answers of a folder, `scaled` the entries of the scene with
    larger or smaller elements and steps (default: other()).

    Returns entries of the summary: estimated_error (by result, see difference(); None if it could
    not be estimated), estimated_error_excludes (what all runs have in common),
    estimate_cpu_seconds, refinements, the messages `warnings` and `notes`, and `skipped`: which
    steps the first run has not chosen and why, if a finer run has replaced it.
    """
    coarser, finer = stage / COARSE, stage / FINE
    answers = read(stage)
    summary, used = answers.summary, answers.used
    # The runs of a pair differ in sizes alone, so the second one has the integrator of the first.
    chosen = {"integrator": summary["integrator"]} if values.get("integrator") == "auto" else {}
    why = [words for words in summary["skipped"] if words.startswith(STEPS)] if chosen else []
    sizes = lambda *arguments: (scaled or other)(*arguments) | chosen  # noqa: E731
    accuracy, seconds, refinements, before = values["accuracy"], 0.0, 0, math.inf
    sentences, notes, estimated, stated = [], [], None, None
    if failure := _ended(solve, sizes(values, used, COARSER, own_mesh), coarser):
        sentences = [
            f"the error is not estimated: the run with {COARSER:.1f} times larger elements and steps ended with: {failure}"
        ]
    while not sentences:
        before_it = read(coarser)
        coarse = before_it.summary
        seconds += coarse["cpu_seconds"]
        if all(coarse.get(name) == summary.get(name) is not None for name in ("dofs", "steps")):
            sentences = [SAME_STEPS]
            break
        estimated = error_estimates(answers, before_it, estimated)
        stated = held_errors(estimated, answers, before_it)
        above = [
            name for name in wanted(values["accuracy_of"]) if estimated[name] > WORTH * accuracy
        ]
        # The contact time of a flat strike does not scatter, but no finer run follows from it
        # alone.
        flat = summary.get("front_transit") is not None
        scatters = above == [SCATTERS] and (
            flat or estimated[SCATTERS] ** 2 / before > WORTH * accuracy
        )
        before = estimated[SCATTERS]
        exceeding = excess(stated, accuracy, values["accuracy_of"])
        exceeding = exceeding and (touches(summary, coarse) or exceeding)
        sentences, notes = (exceeding, []) if above and (flat or not scatters) else ([], exceeding)
        fixed = not own_mesh or any(values[name] for name in SIZES)
        if (
            not above
            or scatters
            or fixed
            or refinements == MOST
            or summary.get("ellipticity_lost_time") is not None
        ):
            break
        if failure := _ended(solve, sizes(values, used, 1 / COARSER, own_mesh), finer):
            sentences.append(
                f"no finer run: with {COARSER:.1f} times smaller elements and steps it ended: {failure}"
            )
            break
        _swap(stage, coarser, finer)
        answers = read(stage)
        summary, used = answers.summary, answers.used
        refinements += 1
        sentences = []
    for folder in (coarser, finer):
        shutil.rmtree(folder, ignore_errors=True)
    return {
        # Both runs of a pair lack a contact that would follow.
        "estimated_error": None if _lacks_contact(summary) else stated,
        "estimated_error_excludes": _excludes(summary, own_mesh),
        "estimate_cpu_seconds": seconds,
        "refinements": refinements,
        "warnings": sentences,
        "notes": [*notes, *([FILE_MESH] if stated and not own_mesh else [])],
        "skipped": why if refinements else [],
    }


def _lacks_contact(summary: Mapping) -> bool:
    """Whether the rule for the end of an impact has cut it: the results lack a contact that may
    follow. The results at an end_time are those at this time, with or without such a contact.
    """
    return bool(summary.get("later_contact_possible")) and summary["ended"] != "end_time"


def _excludes(summary: Mapping, own_mesh: bool) -> list[str]:
    """Returns what all runs have in common. For a flat strike the penalty is not among it, because
    the estimate includes the rise time of the front on the penalty (front_errors()).
    """
    alike = [name for name in REGULARISED if name != "penalty" or summary.get("front_rise") is None]
    return alike if own_mesh else [*alike, "mesh"]


def error_estimates(
    fine: Answers, coarse: Answers, before: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Returns the error estimates of the results of the finer run of a pair. `before` holds the
    estimates of the coarser run.
    """
    summary = fine.summary
    apart, over_time = (
        difference(
            summary, coarse.summary, fine.speed, fine.used.get("radius"), held_bodies(fine.used)
        ),
        course(fine, coarse),
    )
    if summary.get("front_transit"):
        lasts = summary["contact_time"] or math.inf
        estimates = front_errors(
            apart, over_time, summary["front_rise"] / lasts, summary["front_transit"] / lasts
        )
    else:
        estimates = errors(apart, over_time, resolved(fine), alike(fine, coarse))
    if summary.get("bounces", 1) > 1:
        estimates = strikes_again(estimates, over_time, before)
    # Both runs of a pair may have the same drift, so their difference does not show it.
    estimates["energy"] = max(estimates["energy"], summary.get("energy_drift", 0.0))
    return estimates | highest(fine, coarse) | driven(fine, coarse) | rest_errors(fine, coarse)


def _ended(solve: Solve, values: dict[str, Value], where: Path) -> Failure | None:
    """Runs the scene. Returns the failure if the step or the material ended the run, None if the
    run has a result. Other failures are raised.
    """
    try:
        return solve(values, where)
    except Failure as failure:
        if failure.code not in NO_ANSWER:
            raise
        return failure


def _swap(stage: Path, coarser: Path, finer: Path) -> None:
    """Makes the run in `stage` the coarser one and puts the run in `finer` in its place."""
    shutil.rmtree(coarser)
    coarser.mkdir()
    # checkpoint.json, the request of the run, stays in its folder.
    kept = ("checkpoint.json", coarser.name, finer.name)
    for source, target in ((stage, coarser), (finer, stage)):
        for entry in [entry for entry in source.iterdir() if entry.name not in kept]:
            os.rename(entry, target / entry.name)
    shutil.rmtree(finer)


def other(
    values: Mapping[str, Value], used: Mapping[str, Value], factor: float, own_mesh: bool = True
) -> dict[str, Value]:
    """Returns the scene `values` with `factor` times the elements and steps of `used`; on a mesh
    file with other steps only.

    The accuracy then sets the adaptive step alone, because the sizes are given. The contact
    parameters keep their values.
    """
    sizes = {
        name: factor * used[name] for name in SIZES if used[name] > 0 and (own_mesh or name == "dt")
    }
    if own_mesh:
        sizes["mesh_size"] = min(sizes["mesh_size"], used["radius"])
    kept = {name: used[name] for name in ("penalty", "slip_velocity", "friction_dynamic")}
    return (
        dict(values)
        | kept
        | sizes
        | {"accuracy": loosened(used["accuracy"], factor)}
        | output(factor)
    )


def output(factor: float) -> dict[str, Value]:
    """Returns the requests for output of a run with `factor` times the elements and steps, as
    entries to override. A coarser run is only compared and writes no output. A finer run takes the
    place of the first one and keeps all its requests.
    """
    return OUTPUT if factor > 1 else {}


def loosened(accuracy: float, factor: float) -> float:
    """Returns the accuracy for `factor` times the elements and steps, rounded to nine digits for
    readers.
    """
    return min(LARGEST, float(f"{factor**2 * accuracy:.9g}"))


def difference(
    fine: Mapping, coarse: Mapping, speed: float, radius: float | None, held: Collection[str] = ()
) -> dict[str, float]:
    """Returns the differences of the results of two summaries, relative to their scales.

    - impulse, times and force: the value itself;
    - velocities: `speed` [m/s]; spin: `speed` over `radius` [m]; of several bodies the one with the
      largest difference counts, and its spin is scaled by its own bounding radius;
    - energies and friction work: the largest energy if the summary has it, else that at the start.

    A body with a suffix in `held` vibrates on its support: its velocities at the end are of one
    instant and are left out.
    """

    def value(summary: Mapping, name: str) -> float:
        number = summary.get(name)
        return 0.0 if number is None or math.isnan(number) else float(number)

    def apart(name: str, scale: float) -> float:
        return abs(value(fine, name) - value(coarse, name)) / abs(scale) if scale else 0.0

    energy = (
        value(fine, "largest_energy")
        or value(fine, "energy_initial")
        or value(fine, "energy_final")
    )
    free = [suffix for suffix in suffixes(fine) if suffix not in held]
    rebound = max(
        (
            math.hypot(*(apart(f"{kind}_v{axis}{suffix}", speed) for axis in "xyz"))
            for suffix in free
            for kind in AT_END
        ),
        default=0.0,
    )
    rim = max(
        (
            math.hypot(
                *(
                    apart(
                        f"{kind}_spin{about}{suffix}",
                        speed / (value(fine, f"reach{suffix}") or radius),
                    )
                    for about in ("", "_x", "_y")
                )
            )
            for suffix in free
            for kind in AT_END
        ),
        default=0.0,
    )
    differences = {
        "impulse": apart("impulse", value(fine, "impulse")),
        "rebound": rebound,
        "rebound_spin": rim,
        "energy": max(apart(name, energy) for name in ("energy_final", "vibration_energy")),
        "friction_work": apart("friction_work", energy),
    }
    for name in ("thresholded_contact_time", "contact_time", "peak_force"):
        differences[name] = apart(name, value(fine, name))
    return differences | {OF_ITSELF: apart("friction_work", value(fine, "friction_work"))}


def course(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the largest differences of the time histories of two runs, by result and relative to
    the scales of difference().

    Histories: running impulse, velocities, spins, and elastic energy with that of the contact.
    THROUGH times the largest difference of friction work is added to those that friction changes
    (to spin only if anything turns). Friction work itself is compared at equal shares of the
    impulse, root mean square, because by Coulomb's law it depends on impulse and path: a contact
    that is a little later is no error.
    """
    summary, history = fine.summary, (fine.history, coarse.history)
    ends = [run["t"] for run in history]
    t = np.union1d(*ends)
    t = t[t <= min(times[-1] for times in ends)]

    def apart(values: Callable[[Mapping], list[np.ndarray]], scale: float) -> float:
        first, second = (
            np.array([np.interp(t, run["t"], column) for column in values(run)]) for run in history
        )
        return float(np.linalg.norm(first - second, axis=0).max() / abs(scale)) if scale else 0.0

    def vector(*names: str) -> Callable[[Mapping], list[np.ndarray]]:
        return lambda run: [run[name] for name in names if name in run]

    energy, work = summary["largest_energy"], summary["friction_work"] or 0.0
    bodies = [suffix for suffix in suffixes(fine.history) if suffix not in held_bodies(fine.used)]
    reach = {suffix: summary.get(f"reach{suffix}") or fine.used["radius"] for suffix in bodies}
    differences = {
        "impulse": apart(
            lambda run: [np.cumsum(run["normal_force"] * run["dt"])], summary["impulse"]
        ),
        "rebound": max(
            (
                apart(vector(*(f"v{axis}{suffix}" for axis in "xyz")), fine.speed)
                for suffix in bodies
            ),
            default=0.0,
        ),
        "rebound_spin": max(
            (
                apart(
                    vector(*(f"spin{about}{suffix}" for about in ("", "_x", "_y"))),
                    fine.speed / reach[suffix],
                )
                for suffix in bodies
            ),
            default=0.0,
        ),
        "energy": apart(lambda run: [run["elastic"] + run["contact"]], energy),
    }
    for name in (
        "rebound",
        "energy",
        *(["rebound_spin"] if differences["rebound_spin"] > NONE else []),
    ):
        differences[name] += THROUGH * apart(vector("friction_work"), energy)
    work_paths = (
        [_over_impulse(answers.history) for answers in (fine, coarse)] if work else [0.0, 0.0]
    )
    differences["friction_work"] = (
        float(np.sqrt(np.mean((work_paths[0] - work_paths[1]) ** 2)) / energy) if work else 0.0
    )
    differences |= {name: differences[stands] for name, stands in COURSE.items()}
    return differences | {OF_ITSELF: differences["friction_work"] * energy / work if work else 0.0}


def _over_impulse(history: Mapping) -> np.ndarray:
    """Returns the friction work [J/m] at equal SHARES of the impulse."""
    impulse = np.cumsum(history["normal_force"] * history["dt"])
    return np.interp(SHARES * impulse[-1], impulse, history["friction_work"])


def highest(fine: Answers, coarse: Answers, names: Sequence[str] = HIGHEST) -> dict[str, float]:
    """Returns the error estimates of the largest values of columns, relative to these values.

    Such a value is of one instant, so two runs may agree in it by chance. The estimate is INSTANT
    times the root mean square difference of the two histories while one of them is above half the
    largest value, and at least the difference of the largest values.
    """

    def stated(name: str) -> float:
        histories = [(answers.history["t"], answers.history[name]) for answers in (fine, coarse)]
        largest, other = (column.max() for _, column in histories)
        t = np.union1d(*(times for times, _ in histories))
        first, second = (np.interp(t, *history, right=0.0) for history in histories)
        high = np.maximum(first, second) > largest / 2
        if not largest:
            return 0.0
        share = np.gradient(t)[high]
        apart = math.sqrt(np.sum(share * (first - second)[high] ** 2) / share.sum())
        return float(max(INSTANT * apart, abs(largest - other)) / largest)

    return {name: stated(name) for name in names}


def driven(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the error estimates of the results of supports and loads.

    The estimate of the largest force of a support is that of highest(). That of works is INSTANT
    times the largest difference of the histories, relative to the largest energy.
    """

    def force(answers: Answers, number: int) -> np.ndarray:
        return np.linalg.norm(
            [
                answers.history[f"support_force_{axis}_{number}"]
                for axis in "xyz"
                if f"support_force_{axis}_{number}" in answers.history
            ],
            axis=0,
        )

    estimates, number = {}, 1
    while f"support_force_x_{number}" in fine.history:
        name = f"support_peak_{number}"
        both = [
            answers._replace(history={"t": answers.history["t"], name: force(answers, number)})
            for answers in (fine, coarse)
        ]
        estimates |= highest(*both, names=(name,))
        number += 1
    energy = fine.summary["largest_energy"]
    for name in ("support_work", "load_work"):
        if name in fine.history and energy:
            t = fine.history["t"]
            other = np.interp(t, coarse.history["t"], coarse.history[name])
            estimates[name] = float(INSTANT * abs(fine.history[name] - other).max() / energy)
    return estimates


def resolved(run: Answers) -> float:
    """Returns A = 1/n^2, the accuracy of second-order steps; n is the number of steps with more
    than half the peak force (without a contact all steps).
    """
    return 1 / np.count_nonzero(_high(run)) ** 2


def _high(run: Answers) -> np.ndarray:
    """Returns which steps (steps + 1,) have at least half the peak force."""
    force = run.history["normal_force"]
    return force >= force.max() / 2


def alike(fine: Answers, coarse: Answers) -> float:
    """Returns the share of the error of the steps that the difference of a pair does not show.

    It is 2 - q^2 for an error quadratic in the step; q is the mean step of the coarser run over
    that of the finer one while the force is high. It is 0 from q = COARSER on, and 1 for equal
    steps.
    """
    q = coarse.history["dt"][_high(coarse)].mean() / fine.history["dt"][_high(fine)].mean()
    return float(np.clip(COARSER**2 - q**2, 0, 1))


def errors(
    apart: Mapping[str, float], over_time: dict[str, float], steps: float, hidden: float = 0.0
) -> dict[str, float]:
    """Returns the error estimates of all results.

    `apart` are the differences of a pair at the end (difference()), `over_time` those of the time
    histories (course()), in the same units; `steps` is A (resolved()), `hidden` the share of
    alike().
    """
    shares = [apart[name] / USUAL[name] for name in PROMISED if apart[name] > NONE]
    measures = {
        "D": sum(shares) / len(shares) + ALIKE["D"] * hidden * steps if shares else 0.0,
        "A": steps,
    }
    # Without friction no step changes the spin.
    moved = [
        name
        for name in BOUND
        if over_time[name] > NONE and (name != "rebound_spin" or over_time["friction_work"] > NONE)
    ]
    seen = over_time | {
        name: over_time[name] + ALIKE[COURSE.get(name, name)] * hidden * steps for name in moved
    }

    def mean(name: str) -> float:
        return math.prod(
            (measures | {"d": seen[name]})[letter] for letter in MEASURES.get(name, "DdA")
        ) ** (1 / ROOT.get(name, 3))

    estimates = _together(
        {name: bound * mean(name) for name, bound in BOUND.items()},
        over_time["rebound_spin"] > NONE,
    )
    estimates = {name: max(apart[name], bound) for name, bound in estimates.items()}
    return estimates | {
        OF_ITSELF: estimates["friction_work"] * over_time[OF_ITSELF] / over_time["friction_work"]
        if over_time["friction_work"]
        else 0.0
    }


def strikes_again(
    stated: Mapping[str, float], over_time: Mapping[str, float], before: Mapping[str, float] | None
) -> dict[str, float]:
    """Returns the error estimates of a run with several impacts.

    A later impact depends on the vibration that an earlier one left, and the steps change its
    phase. Two runs can then agree by chance in all results at once. So an estimate is not below the
    largest difference of the time histories, and not below the estimate of the coarser run divided
    by COARSER^2 (second order).
    """
    least = {name: before[name] / COARSER**2 if before else 0.0 for name in BOUND}
    return dict(stated) | {
        name: max(stated[name], over_time[name], least[name])
        for name in BOUND
        if name not in COURSE
    }


def held_errors(estimated: Mapping[str, float], fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the error estimates of a scene with supports, loads, rigid bodies or moving
    obstacles; those of other scenes are unchanged.

    A heavy rigid body stays in contact for hundreds of steps; a beam and a shell with gas strike
    again as they vibrate. Both runs of a pair then have the same time history, right or wrong, and
    differ by too little. So an estimate is not below HELD (with loads LOADED) times the accuracy
    for which elements and steps were chosen, and not below TOUCHES_AGAIN times that if there are
    several contact intervals. No finer run follows from this alone.
    """
    loaded = any(body.get("load") for body in fine.used.get("body", []))
    shares = LOADED if loaded else HELD if _is_held(fine.used) else {}
    again = max(answers.summary.get("contact_intervals", 1) for answers in (fine, coarse)) > 1
    accuracy = fine.used["accuracy"] * (TOUCHES_AGAIN if again else 1.0)
    return dict(estimated) | {
        name: max(estimated[name], share * accuracy)
        for name, share in shares.items()
        if estimated[name] > NONE
    }


def _is_held(used: Mapping) -> bool:
    """Whether a scene as used has supports, rigid bodies or obstacles that follow functions of
    time.
    """
    return any(body.get("rigid") or body.get("support") for body in used.get("body", [])) or any(
        "motion" in obstacle or "rotation" in obstacle for obstacle in used.get("obstacle", [])
    )


def front_errors(
    apart: Mapping[str, float], over_time: Mapping[str, float], rise: float, element: float
) -> dict[str, float]:
    """Returns the error estimates of a flat strike. Its results converge with the first power of
    the element size, and the penalty follows the element size. `rise` and `element` [1] are the
    rise time of the front, and its transit through an element, over the contact time.

    As in errors() one difference can be small by chance. An estimate is FRONT d sqrt(r): d is the
    largest difference of the time history, r the mean over the results of (difference at the
    end)/d. Contact ends 1.7 rise times late (front.py), which is about the error of contact times.
    A front that rises in less than its transit through an element keeps a share of the speed, in
    runs of all element sizes alike: SHARP element.
    """
    moved = [name for name in ("impulse", "rebound", "energy") if over_time[name] > NONE]
    share = (
        math.sqrt(min(1.0, sum(apart[name] / over_time[name] for name in moved) / len(moved)))
        if moved
        else 0.0
    )
    measures = {name: over_time[name] * share for name in BOUND}
    measures["energy"] = max(measures["energy"], 2 * measures["rebound"])  # dE/E = 2 dv/v
    measures |= {name: rise + apart[name] for name in ("thresholded_contact_time", "contact_time")}
    measures["peak_force"] = over_time["impulse"] + apart["peak_force"]
    sharp = element * min(1.0, element / (RESOLVED * rise)) if rise else 0.0
    estimates = {
        name: max(apart[name], FRONT[name] * measure, SHARP.get(name, 0.0) * sharp)
        for name, measure in measures.items()
    }
    return estimates | {
        OF_ITSELF: estimates["friction_work"] * over_time[OF_ITSELF] / over_time["friction_work"]
        if over_time["friction_work"]
        else 0.0
    }


def _together(stated: dict[str, float], turns: bool) -> dict[str, float]:
    """Returns the estimates with common values for results that friction couples.

    The impulse of friction turns a body and moves its centre. If nothing turns, friction takes its
    work from the energy E of the rebound. In a head-on contact that loses little dE/E = 2 dv/v = 4
    dp/p, with speed v and impulse p.
    """
    rebound, energy = max(stated["rebound"], LEVER * stated["rebound_spin"]), stated["energy"]
    if turns or not stated["friction_work"]:
        return stated | {"rebound": rebound}
    work = STILL * stated["friction_work"]
    energy = max(energy, work)
    return stated | {
        "friction_work": work,
        "energy": energy,
        "rebound": max(rebound, energy / 2),
        "impulse": max(stated["impulse"], energy / 4),
    }


def wanted(also: str) -> list[str]:
    """Returns the names PROMISED and the one in the entry accuracy_of."""
    return [
        *PROMISED,
        *([] if also == "promised" else [OF_ITSELF if also == "friction_work" else also]),
    ]


def largest(estimated: Mapping[str, float]) -> float:
    """Returns the largest error estimate of the results PROMISED."""
    return max(estimated[name] for name in PROMISED)


def touches(fine: Mapping, coarse: Mapping) -> list[str]:
    """Returns a message if the runs of a pair have different numbers of contact intervals. Their
    difference then estimates nothing.
    """
    seen, other = (summary.get("contact_intervals") for summary in (fine, coarse))
    return (
        [
            f"touches: contact intervals {seen}, with {COARSER:.1f} times larger elements and steps {other}: "
            "the two runs have different intervals of contact, so results that miss the requested accuracy "
            "have no smaller error: see contacts.csv, or ask for a smaller accuracy"
        ]
        if seen != other
        else []
    )


def excess(estimated: Mapping[str, float], accuracy: float, also: str) -> list[str]:
    """Returns a message about the results whose error estimate is above the accuracy, or above
    LOOSER times the accuracy if they are not promised.
    """
    limits = {name: accuracy for name in wanted(also)} | {
        name: LOOSER * accuracy for name in ("contact_time", "peak_force") if name != also
    }
    above = {
        name: f"{name.replace('_', ' ')} {100 * estimated[name]:.2g} %"
        for name, limit in limits.items()
        if estimated[name] > limit
    }
    worst = max(
        [name for name in wanted(also) if name in above] or above, key=estimated.get, default=None
    )
    return (
        [
            f"estimated errors: {above[worst]}, requested {100 * accuracy:g} %: "
            f"all above it: {', '.join(above.values())}: ask for a smaller accuracy if you need these numbers"
        ]
        if above
        else []
    )
