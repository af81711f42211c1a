"""The error of a run, estimated from a second one with larger elements and steps; finer runs until
it is below what is asked.

Of the two runs of a pair the finer is the answer. What an answer differs by between them is about
its error: elements and steps of the coarser are COARSER times as large, so that an error quadratic
in them doubles. But one difference can be small by chance, and impulse, rebound and energy of an
impact without friction are one number, small together. So the error that is stated of an answer is
made from the geometric mean of three measures that mislead for different reasons,
    BOUND (D d A)^(1/3),   D: the mean of the promised answers' differences, over their usual ones;
                           d: the largest difference of its course over its scale: running impulse, velocities, elastic energy (course());
                           A = 1/n^2, n: the steps in which the force is above half its peak: what second-order steps are good for,
and no less than the difference; what friction ties together is stated together (_together()). Three
answers differ (MEASURES): the steps of an impact say little of spin and peak force (d for A), the
other answers little of friction work (d for D). A touch ends between two steps, so that times
converge more slowly: the fourth root. BOUND is what 97 of 100 runs keep on scenes other than those
of docs/measurements/promise.md, some three times the usual error. It is that of mesh and steps: penalty and slip
velocity are the same in all runs. Steps grow no more above 0.3 of a transit of waves (sizes.idp),
those of a pair asked for an accuracy of 0.06 or more are the same, of 0.05 7 % apart: its
differences are those of elements alone. The share (alike()) of what steps make of them, ALIKE A,
joins D and d. Where that of a promised answer is more than WORTH times what is asked finer runs
follow. The contact time scatters with the vibration at the last touch (by 0.8 % rms in hard
impacts, on any mesh and at any step that was tried): where it alone is off, a second finer run
follows only if what the first one gained, gained again, brings its estimate there. An answer that
is then still above WORTH times what is asked is a warning. What is above it by less, or scatters,
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

COARSER = math.sqrt(2)
COARSE, FINE = "coarser", "finer"  # folders of the runs beside the main one
MOST = 2  # refinements: elements and steps are then half as large as at first
SIZES = ("mesh_size", "contact_mesh_size", "dt")
LARGEST = 0.4  # accuracy that the scripts take
LOOSER = 2
WORTH = 1.5  # of what is asked: a stated error that a finer run is worth its price for
REGULARISED = ("penalty", "slip_velocity")
NO_ANSWER = (11, 12)  # exit codes of a run that the step or the material ended
# What the answers of a pair usually differ by, beside each other; the first six are promised. What
# is stated of them; both calibrated over other scenes than those of docs/measurements/promise.md.
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
MEASURES = {
    "rebound_spin": "Ddd",
    "friction_work": "Add",
    "peak_force": "Ddd",
}  # of the others: DdA
ROOT = {"thresholded_contact_time": 4, "contact_time": 4}  # of the others: 3
ALIKE = {
    "D": 1.4,
    "impulse": 0.3,
    "rebound": 0.7,
    "rebound_spin": 0.5,
    "energy": 1.0,
    "friction_work": 0.03,
}  # over A, by steps alone
# of flat strikes: front_errors(), calibrated likewise
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
# of scenes with supports, loads, rigid bodies or moving obstacles: held_errors(), calibrated
# likewise
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
TOUCHES_AGAIN = 2.5
SHARP, RESOLVED = {"impulse": 0.12, "rebound": 0.24, "energy": 0.48}, 7.5
PROMISED = tuple(USUAL)[:6]
COURSE = {
    "thresholded_contact_time": "impulse",
    "contact_time": "impulse",
    "peak_force": "impulse",
}  # whose course stands for theirs
# friction work where nothing turns: small slip under a patch that mostly sticks, over BOUND
STILL = 1.6
# of the rim's speed by friction's impulse, what it gives the centre: 1/2 of a disc, 2/5 of a ball,
# and a margin
LEVER = 0.7
THROUGH = 2  # friction that goes another way changes speed, spin and energy, too: its share in them
SHARES = np.linspace(0, 1, 201)  # of the impulse
NONE = 1e-12  # a difference that is round-off
STEPS = (
    "explicit steps (",
    "implicit steps (",
)  # as `skipped` says of those not chosen by integrator = auto
SCATTERS = "thresholded_contact_time"
SAME_STEPS = (
    "the error is not estimated: with steps 1.4 times larger a second run took the same ones: they are too "
    "large for this scene: ask for a smaller accuracy"
)
FILE_MESH = (
    "mesh of the file: error estimates are those of the time step: the error of the mesh is not included: "
    "run a finer one beside it"
)
OF_ITSELF = "friction_work of itself"  # accuracy_of = friction_work
HIGHEST = ("max_pressure", "max_penetration")  # largest values of a column of the history
INSTANT = 2.0  # stated of these, over what the columns differ by; 95 of 100 runs keep it

Scaled = Callable[[Mapping, Mapping, float, bool], dict[str, Value]]
Solve = Callable[
    [dict[str, Value], Path], None
]  # runs the scene with these values in a folder; Failure where it fails


def settle(
    stage: Path,
    values: Mapping[str, Value],
    own_mesh: bool,
    solve: Solve,
    read: Callable,
    scaled: Scaled | None = None,
) -> dict:
    """What joins the summary of the run in `stage`, made from the scene `values`:
    estimated_error (by answer, see difference(); None if it could not be estimated),
    estimated_error_excludes (what all runs have alike), estimate_cpu_seconds, refinements, the
    sentences `warnings` and `notes`, and `skipped`, which steps the first run has not chosen
    and why, where it is not the one in `stage` at last.

    Where sizes and steps follow from the accuracy and the estimate is above it, finer runs take
    the run's place in `stage`. `read` gives the Answers of a folder, `scaled` the entries of
    the scene with larger or smaller elements and steps (left out: other).
    """
    coarser, finer = stage / COARSE, stage / FINE
    answers = read(stage)
    summary, used = answers.summary, answers.used
    chosen = (
        {"integrator": summary["integrator"]} if values.get("integrator") == "auto" else {}
    )  # a pair differs in sizes alone
    why = [words for words in summary["skipped"] if words.startswith(STEPS)] if chosen else []
    sizes = lambda *given: (scaled or other)(*given) | chosen  # noqa: E731
    asked, seconds, refinements, before = values["accuracy"], 0.0, 0, math.inf
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
        above = [name for name in wanted(values["accuracy_of"]) if estimated[name] > WORTH * asked]
        flat = (
            summary.get("front_transit") is not None
        )  # its contact time is not of a scatter, but no finer run is worth it
        scatters = above == [SCATTERS] and (
            flat or estimated[SCATTERS] ** 2 / before > WORTH * asked
        )
        before = estimated[SCATTERS]
        exceeding = excess(stated, asked, values["accuracy_of"])
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
        "estimated_error": stated,
        "estimated_error_excludes": _excludes(summary, own_mesh),
        "estimate_cpu_seconds": seconds,
        "refinements": refinements,
        "warnings": sentences,
        "notes": [*notes, *([FILE_MESH] if stated and not own_mesh else [])],
        "skipped": why if refinements else [],
    }


def _excludes(summary: Mapping, own_mesh: bool) -> list[str]:
    """What all runs have alike. The rise of a flat strike's front on the penalty is in its
    estimate (front_errors()).
    """
    alike = [name for name in REGULARISED if name != "penalty" or summary.get("front_rise") is None]
    return alike if own_mesh else [*alike, "mesh"]


def error_estimates(
    fine: Answers, coarse: Answers, before: Mapping[str, float] | None = None
) -> dict[str, float]:
    """The error that is stated of every answer of the finer run of a pair; `before`: what was
    stated of the coarser one.
    """
    summary = fine.summary
    apart, way = (
        difference(
            summary, coarse.summary, fine.speed, fine.used.get("radius"), held_bodies(fine.used)
        ),
        course(fine, coarse),
    )
    if summary.get("front_transit"):
        lasts = summary["contact_time"] or math.inf
        found = front_errors(
            apart, way, summary["front_rise"] / lasts, summary["front_transit"] / lasts
        )
    else:
        found = errors(apart, way, resolved(fine), alike(fine, coarse))
    if summary.get("bounces", 1) > 1:
        found = strikes_again(found, way, before)
    found["energy"] = max(
        found["energy"], summary.get("energy_drift", 0.0)
    )  # of which the pair may have the same
    return found | highest(fine, coarse) | driven(fine, coarse)


def _ended(solve: Solve, values: dict[str, Value], where: Path) -> Failure | None:
    """With what a run has ended that the step or the material brought to its end; None where it
    has an answer.
    """
    try:
        return solve(values, where)
    except Failure as failure:
        if failure.code not in NO_ANSWER:
            raise
        return failure


def _swap(stage: Path, coarser: Path, finer: Path) -> None:
    """The run in `stage` becomes the coarser one, that in `finer` takes its place."""
    shutil.rmtree(coarser)
    coarser.mkdir()
    kept = (
        "checkpoint.json",
        coarser.name,
        finer.name,
    )  # what the run was asked for stays where it is
    for source, target in ((stage, coarser), (finer, stage)):
        for entry in [entry for entry in source.iterdir() if entry.name not in kept]:
            os.rename(entry, target / entry.name)
    shutil.rmtree(finer)


def other(
    values: Mapping[str, Value], used: Mapping[str, Value], factor: float, own_mesh: bool = True
) -> dict[str, Value]:
    """The scene `values` with `factor` times the elements and steps that it had as `used`; on a
    mesh file with other steps only.

    The accuracy then sets the adaptive step alone, as the sizes are given; the contact's own
    parameters stay as they were.
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
    """What a run with `factor` times the elements and steps has instead of the requests for
    output. A coarser run is only compared and writes none. A finer run takes the place of the
    first one and keeps all its requests.
    """
    return OUTPUT if factor > 1 else {}


def loosened(accuracy: float, factor: float) -> float:
    """What `factor` times the elements and steps are asked for, in as many digits as a reader
    wants.
    """
    return min(LARGEST, float(f"{factor**2 * accuracy:.9g}"))


def difference(
    fine: Mapping, coarse: Mapping, speed: float, radius: float | None, held: Collection[str] = ()
) -> dict[str, float]:
    """How far the answers of two summaries differ, each over its scale: impulse, times and
    force over themselves, velocities and spin over `speed` [m/s] (spin times `radius` [m]; of
    several bodies the largest, and spin times its reach), energies and friction work over the
    largest energy, where the summary has it, else over that at the start. A body that is `held`
    (its suffix) vibrates: its velocities at the end are of an instant and no answer.
    """

    def value(summary: Mapping, name: str) -> float:
        found = summary.get(name)
        return 0.0 if found is None or math.isnan(found) else float(found)

    def apart(name: str, scale: float) -> float:
        return abs(value(fine, name) - value(coarse, name)) / abs(scale) if scale else 0.0

    energy = (
        value(fine, "largest_energy")
        or value(fine, "energy_initial")
        or value(fine, "energy_final")
    )
    free = [of for of in suffixes(fine) if of not in held]
    rebound = max(
        (math.hypot(*(apart(f"rebound_v{axis}{of}", speed) for axis in "xyz")) for of in free),
        default=0.0,
    )
    rim = max(
        (
            math.hypot(
                *(
                    apart(f"rebound_spin{about}{of}", speed / (value(fine, f"reach{of}") or radius))
                    for about in ("", "_x", "_y")
                )
            )
            for of in free
        ),
        default=0.0,
    )
    found = {
        "impulse": apart("impulse", value(fine, "impulse")),
        "rebound": rebound,
        "rebound_spin": rim,
        "energy": max(apart(name, energy) for name in ("energy_final", "vibration_energy")),
        "friction_work": apart("friction_work", energy),
    }
    for name in ("thresholded_contact_time", "contact_time", "peak_force"):
        found[name] = apart(name, value(fine, name))
    return found | {OF_ITSELF: apart("friction_work", value(fine, "friction_work"))}


def course(fine: Answers, coarse: Answers) -> dict[str, float]:
    """How far two runs are apart on their way, by answer and over its scale as in difference():
    impulse, velocities, spins and elastic energy (with the contact's) at the time when they are
    farthest from each other, and what friction changes in them (in the spin of what turns at
    all); friction work, by Coulomb's law of impulse and path, at equal shares of the impulse,
    root mean square: a touch that is a little later is no error.
    """
    summary, history = fine.summary, (fine.history, coarse.history)
    ends = [one["t"] for one in history]
    t = np.union1d(*ends)
    t = t[t <= min(one[-1] for one in ends)]

    def apart(values: Callable[[Mapping], list[np.ndarray]], scale: float) -> float:
        first, second = (
            np.array([np.interp(t, one["t"], each) for each in values(one)]) for one in history
        )
        return float(np.linalg.norm(first - second, axis=0).max() / abs(scale)) if scale else 0.0

    def vector(*names: str) -> Callable[[Mapping], list[np.ndarray]]:
        return lambda one: [one[name] for name in names if name in one]

    energy, work = summary["largest_energy"], summary["friction_work"] or 0.0
    bodies = [of for of in suffixes(fine.history) if of not in held_bodies(fine.used)]
    reach = {of: summary.get(f"reach{of}") or fine.used["radius"] for of in bodies}
    found = {
        "impulse": apart(
            lambda one: [np.cumsum(one["normal_force"] * one["dt"])], summary["impulse"]
        ),
        "rebound": max(
            (apart(vector(*(f"v{axis}{of}" for axis in "xyz")), fine.speed) for of in bodies),
            default=0.0,
        ),
        "rebound_spin": max(
            (
                apart(
                    vector(*(f"spin{about}{of}" for about in ("", "_x", "_y"))),
                    fine.speed / reach[of],
                )
                for of in bodies
            ),
            default=0.0,
        ),
        "energy": apart(lambda one: [one["elastic"] + one["contact"]], energy),
    }
    for name in ("rebound", "energy", *(["rebound_spin"] if found["rebound_spin"] > NONE else [])):
        found[name] += THROUGH * apart(vector("friction_work"), energy)
    way = [_over_impulse(one.history) for one in (fine, coarse)] if work else [0.0, 0.0]
    found["friction_work"] = (
        float(np.sqrt(np.mean((way[0] - way[1]) ** 2)) / energy) if work else 0.0
    )
    found |= {name: found[stands] for name, stands in COURSE.items()}
    return found | {OF_ITSELF: found["friction_work"] * energy / work if work else 0.0}


def _over_impulse(history: Mapping) -> np.ndarray:
    """Friction work [J/m] at equal SHARES of the impulse."""
    impulse = np.cumsum(history["normal_force"] * history["dt"])
    return np.interp(SHARES * impulse[-1], impulse, history["friction_work"])


def highest(fine: Answers, coarse: Answers, names: Sequence[str] = HIGHEST) -> dict[str, float]:
    """The error that is stated of the largest values of columns, over themselves. Such a value
    is of one instant: two runs may agree in it by chance. So the stated error is INSTANT times
    the root mean square difference of the two histories while one of them is above half the
    largest value, and no less than the difference of the largest values.
    """

    def stated(name: str) -> float:
        histories = [(one.history["t"], one.history[name]) for one in (fine, coarse)]
        largest, other = (column.max() for _, column in histories)
        t = np.union1d(*(times for times, _ in histories))
        first, second = (np.interp(t, *one, right=0.0) for one in histories)
        high = np.maximum(first, second) > largest / 2
        if not largest:
            return 0.0
        share = np.gradient(t)[high]
        apart = math.sqrt(np.sum(share * (first - second)[high] ** 2) / share.sum())
        return float(max(INSTANT * apart, abs(largest - other)) / largest)

    return {name: stated(name) for name in names}


def driven(fine: Answers, coarse: Answers) -> dict[str, float]:
    """The error that is stated of what supports and loads do: of the largest force of a support
    as of other largest values (highest()), of their work INSTANT times the largest difference
    of the histories, over the largest energy.
    """

    def force(one: Answers, number: int) -> np.ndarray:
        return np.linalg.norm(
            [
                one.history[f"support_force_{axis}_{number}"]
                for axis in "xyz"
                if f"support_force_{axis}_{number}" in one.history
            ],
            axis=0,
        )

    found, number = {}, 1
    while f"support_force_x_{number}" in fine.history:
        name = f"support_peak_{number}"
        both = [
            one._replace(history={"t": one.history["t"], name: force(one, number)})
            for one in (fine, coarse)
        ]
        found |= highest(*both, names=(name,))
        number += 1
    energy = fine.summary["largest_energy"]
    for name in ("support_work", "load_work"):
        if name in fine.history and energy:
            t = fine.history["t"]
            other = np.interp(t, coarse.history["t"], coarse.history[name])
            found[name] = float(INSTANT * abs(fine.history[name] - other).max() / energy)
    return found


def resolved(run: Answers) -> float:
    """A = 1/n^2: what second-order steps are good for, n of them with more than half the peak
    force (without a contact: all).
    """
    return 1 / np.count_nonzero(_high(run)) ** 2


def _high(run: Answers) -> np.ndarray:
    """Which steps have more than half the peak force."""
    force = run.history["normal_force"]
    return force >= force.max() / 2


def alike(fine: Answers, coarse: Answers) -> float:
    """The share of the steps' error that does not show in what a pair differs by: 2 - q^2 of an
    error quadratic in the step, which is q times as large in the coarser run while the force is
    high; 0 from q = COARSER on, 1 of the same steps.
    """
    q = coarse.history["dt"][_high(coarse)].mean() / fine.history["dt"][_high(fine)].mean()
    return float(np.clip(COARSER**2 - q**2, 0, 1))


def errors(
    apart: Mapping[str, float], way: dict[str, float], steps: float, hidden: float = 0.0
) -> dict[str, float]:
    """The error that is stated of every answer, from the differences of a pair at the end and
    on its way (course()), in the same units, from resolved(), and from alike().
    """
    shares = [apart[name] / USUAL[name] for name in PROMISED if apart[name] > NONE]
    measures = {
        "D": sum(shares) / len(shares) + ALIKE["D"] * hidden * steps if shares else 0.0,
        "A": steps,
    }
    moved = [
        name
        for name in BOUND
        if way[name] > NONE and (name != "rebound_spin" or way["friction_work"] > NONE)
    ]  # spin by friction
    seen = way | {
        name: way[name] + ALIKE[COURSE.get(name, name)] * hidden * steps for name in moved
    }

    def mean(name: str) -> float:
        return math.prod(
            (measures | {"d": seen[name]})[each] for each in MEASURES.get(name, "DdA")
        ) ** (1 / ROOT.get(name, 3))

    found = _together(
        {name: bound * mean(name) for name, bound in BOUND.items()}, way["rebound_spin"] > NONE
    )
    found = {name: max(apart[name], bound) for name, bound in found.items()}
    return found | {
        OF_ITSELF: found["friction_work"] * way[OF_ITSELF] / way["friction_work"]
        if way["friction_work"]
        else 0.0
    }


def strikes_again(
    stated: Mapping[str, float], way: Mapping[str, float], before: Mapping[str, float] | None
) -> dict[str, float]:
    """The estimated errors of a run with several impacts. A later impact hangs on the vibration
    that an earlier one left, whose phase the steps change: two runs can then agree by chance in
    all answers at once. So an error is no less than the largest difference of the time
    histories, and no less than second order makes of the error that was stated of the coarser
    run.
    """
    least = {name: before[name] / COARSER**2 if before else 0.0 for name in BOUND}
    return dict(stated) | {
        name: max(stated[name], way[name], least[name]) for name in BOUND if name not in COURSE
    }


def held_errors(estimated: Mapping[str, float], fine: Answers, coarse: Answers) -> dict[str, float]:
    """What is stated of a scene with supports, loads, rigid bodies or moving obstacles; of
    others the same as estimated.

    A heavy rigid body stays in contact for hundreds of steps, a beam and a shell with gas
    strike again as they vibrate: both runs of a pair then follow the same course, right or
    wrong, and differ by too little. So an error is no less than HELD of the accuracy of the
    sizes of elements and steps, of bodies with loads LOADED, and TOUCHES_AGAIN times that where
    bodies touch several times. No finer run follows from that alone.
    """
    loaded = any(body.get("load") for body in fine.used.get("body", []))
    shares = LOADED if loaded else HELD if _is_held(fine.used) else {}
    again = max(one.summary.get("contact_intervals", 1) for one in (fine, coarse)) > 1
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
        "motion" in one or "rotation" in one for one in used.get("obstacle", [])
    )


def front_errors(
    apart: Mapping[str, float], way: Mapping[str, float], rise: float, element: float
) -> dict[str, float]:
    """The estimated errors of a flat strike, where answers converge with the first power of the
    element size and the penalty follows it. `rise` and `element` [1] are the rise time of the
    front, and its transit through an element, over the contact time.

    As in errors() one difference can be small by chance. An error is FRONT d sqrt(r), d the
    largest difference of its time history, r the mean of the differences at the end over d.
    Contact ends 1.7 rises late (front.py), which is about its error. A front that rises in less
    than its transit through an element keeps a share of the speed, in runs of all element sizes
    alike: SHARP element.
    """
    moved = [name for name in ("impulse", "rebound", "energy") if way[name] > NONE]
    share = (
        math.sqrt(min(1.0, sum(apart[name] / way[name] for name in moved) / len(moved)))
        if moved
        else 0.0
    )
    measures = {name: way[name] * share for name in BOUND}
    measures["energy"] = max(measures["energy"], 2 * measures["rebound"])  # dE/E = 2 dv/v
    measures |= {name: rise + apart[name] for name in ("thresholded_contact_time", "contact_time")}
    measures["peak_force"] = way["impulse"] + apart["peak_force"]
    sharp = element * min(1.0, element / (RESOLVED * rise)) if rise else 0.0
    found = {
        name: max(apart[name], FRONT[name] * measure, SHARP.get(name, 0.0) * sharp)
        for name, measure in measures.items()
    }
    return found | {
        OF_ITSELF: found["friction_work"] * way[OF_ITSELF] / way["friction_work"]
        if way["friction_work"]
        else 0.0
    }


def _together(stated: dict[str, float], turns: bool) -> dict[str, float]:
    """With what friction ties together: its impulse turns a body and moves its centre; where
    nothing turns what it takes is the rebound's energy E, of which dE/E = 2 dv/v = 4 dp/p of
    speed v and impulse p in a head-on touch that loses little.
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
    """The promised answers, and the one that accuracy_of names."""
    return [
        *PROMISED,
        *([] if also == "promised" else [OF_ITSELF if also == "friction_work" else also]),
    ]


def largest(estimated: Mapping[str, float]) -> float:
    """The largest estimated error of the promised answers."""
    return max(estimated[name] for name in PROMISED)


def touches(fine: Mapping, coarse: Mapping) -> list[str]:
    """A sentence where the runs of a pair saw different numbers of touches, so that what they
    differ by estimates nothing.
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
    """A sentence about the answers whose estimated error is above the accuracy; above LOOSER
    times it where it is not promised.
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
