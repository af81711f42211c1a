"""Estimates the error of a run from runs with larger elements and steps. Finer runs follow until the
estimate meets the requested accuracy.

The program reports the finest run. Elements and steps of the two other runs, its levels, are r =
COARSER and r^2 times as large. If errors are of the order p in them, the error of the finest run is
1/(r^p - 1) times the difference of the first two, and the next difference is r^p times as large.
But single differences mislead: errors of elements and steps have opposite signs, and at the end of
an impact runs agree by chance. So the error estimate of a result is

    SAFETY/(r^q - 1) sqrt(sum over k of (d_k^2 + h_k^2)/r^(q k)),   k = 0, 1: pairs of levels,

    d_k: difference of the result between the two runs (differences());
    h_k: difference of its time history (history_differences());
    q: the order of the errors. It is p where the runs resolve the vibrations of the bodies: 2, or 1
       in a flat strike, as its penalty follows the elements (scenes/front.py). Elsewhere errors
       fall more slowly. So q is the median of the orders of all results, by the differences of the
       two pairs, but at least SLOWEST p and at most p. The order of a single result scatters.
       The results SLOW always have the order SLOWEST p.

If errors are of order q, the two differences have the ratio r^q; if they scatter, they are about
equal. Most errors are in between, so the second difference is divided by r^(q/2). All results of
all scenes have the same factor SAFETY (benchmarks/promise.py lists the scenes of its calibration).
The estimate contains the error in 95 of 100 runs and is about four times the usual error. It covers
mesh and steps: penalty, slip velocity and the growth of elements away from the contact are the same
in all runs, except the penalty of a flat strike.

Finer runs follow if the estimate of a requested result is above WORTH times the request, unless it
would stay there after all of them even if errors fell with the order p. The former runs are then the levels of
the new one. The contact time scatters with the vibration at the end of
contact (by 0.8 % rms in hard impacts, on any mesh and with any step that was tried). If it alone is
above, a second finer run follows only if the gain of the first one, gained again, brings its
estimate there. An estimate that is still above WORTH times the request is a warning. One
that is above the request by less, or of a result that is not requested, is a note (notes.py). Runs
with different numbers of contact intervals are a warning (touches()). An impact that is not over
has no estimates of the results OF_IMPACT.
"""

import math
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from statistics import median

import numpy as np

from ..failure import Failure
from ..input.parameters import OUTPUT, Table
from .rest import rest_errors
from .results import Answers, held_bodies, suffixes

__all__ = [
    "COARSER",
    "HIGHEST",
    "LARGEST",
    "LEVELS",
    "MOST",
    "OF_IMPACT",
    "OF_ITSELF",
    "PROMISED",
    "RESULTS",
    "SAFETY",
    "WORKS",
    "WORTH",
    "differences",
    "error_estimates",
    "excess",
    "gain",
    "history_differences",
    "largest",
    "loosened",
    "output",
    "settle",
    "touches",
    "wanted",
]

COARSER = math.sqrt(2)  # ratio of elements and steps in two successive levels
# Folders of the other runs, in that of the main one.
LEVELS, FINE = ("coarser", "coarsest"), "finer"
MOST = 2  # largest number of refinements, after which elements and steps are half as large
SIZES = ("mesh_size", "contact_mesh_size", "dt")
LARGEST = 0.4  # largest accuracy that the scripts accept
LOOSER = 2  # factor on the accuracy for notes about results that are not promised
WORTH = 2  # error estimate over the requested accuracy above which a finer run follows
REGULARISED = ("penalty", "slip_velocity")
NO_ANSWER = (11, 12)  # exit codes of runs that the step or the material ended
# Error estimate over that of the differences, by the number of their pairs. A single pair agrees by
# chance more often.
SAFETY = {1: 2.2, 2: 0.87}
SLOWEST = 0.75  # smallest order of the errors over the order of the elements and steps
TINY = 1e-5  # differences below it show no order, but round-off
PROMISED = (
    "impulse",
    "rebound",
    "rebound_spin",
    "energy",
    "friction_work",
    "thresholded_contact_time",
)
RESULTS = (*PROMISED, "contact_time", "peak_force")
# Results of the whole impact: a later contact changes them.
OF_IMPACT = ("impulse", "rebound", "rebound_spin", "thresholded_contact_time", "contact_time")
# Results with the order SLOWEST p: vibration decides when forces end, and the largest penetration is
# that of a single point.
SLOW = ("thresholded_contact_time", "contact_time", "max_penetration")
AT_END = ("rebound", "final")  # velocities at the end of contact and of the run
# First words of the messages `skipped` about steps that integrator = auto has not chosen.
STEPS = ("explicit steps (", "implicit steps (")
SCATTERS = "thresholded_contact_time"  # the promised result that scatters
SAME_STEPS = (
    "the error is not estimated: a coarser run has the same elements and steps: this scene allows no "
    "larger ones: ask for a smaller accuracy"
)
FILE_MESH = (
    "mesh of the file: error estimates are those of the time step: the error of the mesh is not included: "
    "run a finer one beside it"
)
# Error of friction work relative to friction work itself, for accuracy_of = friction_work.
OF_ITSELF = "friction_work of itself"
HIGHEST = ("max_pressure", "max_penetration")  # largest values of columns of the history
WORKS = ("support_work", "load_work")
DAMPING = "viscous_work"  # column of the energy that damping has taken
EARLY = 0.75  # share of the contact, and of the impulse, from which on histories are compared
HIGH = 0.75  # share of a largest value above which histories are compared
# Shares of the impulse at which times are compared. They are dense at the end of contact.
SHARES = 1 - np.geomspace(1 - EARLY, 1e-4, 16)

Scaled = Callable[[Table, float], Table]
# Runs the scene with these values in a folder, and raises Failure if the run fails.
Solve = Callable[[Table, Path], None]
# Runs the scene with a factor on elements and steps in a folder; returns the failure or None.
Failed = Callable[[float, Path], Failure | None]
Columns = Callable[[Answers], list[np.ndarray]]


def settle(
    stage: Path,
    values: Table,
    own_mesh: bool,
    solve: Solve,
    read: Callable[[Path], Answers],
    scaled: Scaled,
) -> Table:
    """Estimates the error of the run in `stage`, made from the scene `values`, and computes finer
    runs.

    If sizes and steps follow from the accuracy and the estimate is above it, finer runs replace the
    run in `stage`. `read` returns the Answers of a folder, `scaled` the entries of the scene with a
    factor on elements and steps.

    Returns entries of the summary: estimated_error (by result, see differences(); None if it could
    not be estimated), estimated_error_excludes (what all runs have in common),
    estimate_cpu_seconds, refinements, the messages `warnings` and `notes`, and `skipped`: which
    steps the first run has not chosen and why, if a finer run has replaced it.
    """
    runs = [read(stage)]
    summary = runs[0].summary
    # The levels differ in sizes alone, so all have the integrator of the first run.
    chosen = {"integrator": summary["integrator"]} if values.get("integrator") == "auto" else {}
    why = [words for words in summary["skipped"] if words.startswith(STEPS)] if chosen else []
    accuracy, fixed = values["accuracy"], not own_mesh or any(values[name] for name in SIZES)

    def failed(factor: float, where: Path) -> Failure | None:
        """Runs the scene with `factor` times the sizes of the finest run."""
        entries = scaled(runs[0].used, factor)
        return _ended(solve, entries | chosen, where)

    sentences = _add_levels(runs, stage, failed, read)
    notes: list[str] = []
    estimated, refinements = None, 0
    seconds = sum(run.summary["cpu_seconds"] for run in runs[1:])
    while len(runs) > 1:
        estimated = error_estimates(runs)
        above = [
            name
            for name in wanted(values["accuracy_of"])
            if estimated.get(name, 0.0) > WORTH * accuracy
        ]
        # Whether only scatter is left, which a second finer run reduces too little.
        scatter = (
            refinements > 0
            and above == [SCATTERS]
            and estimated[SCATTERS] * gain(runs) > WORTH * accuracy
        )
        # Whether an error stays above after the finer runs that are left, even at full order.
        decrease = COARSER ** (-_order(runs[0]) * (MOST - refinements))
        hopeless = any(decrease * estimated[name] > WORTH * accuracy for name in above)
        made = 0.0 if fixed else accuracy / 2**refinements
        exceeding = excess(estimated, accuracy, values["accuracy_of"], made, scatter)
        sentences, notes = (exceeding, []) if above else ([], exceeding)
        lost = runs[0].summary.get("ellipticity_lost_time") is not None
        if not above or scatter or hopeless or fixed or lost or refinements == MOST:
            break
        if failure := failed(1 / COARSER, stage / FINE):
            sentences.append(
                f"no finer run: with {COARSER:.1f} times smaller elements and steps it ended: {failure}"
            )
            break
        seconds += runs[0].summary["cpu_seconds"]
        _swap(stage)
        runs = [read(stage), *runs[:2]]
        refinements += 1
    if _lacks_contact(runs[0].summary):  # all levels lack it
        estimated, sentences, notes = None, [], []
    sentences += touches(runs)
    for name in (*LEVELS, FINE):
        shutil.rmtree(stage / name, ignore_errors=True)
    return {
        "estimated_error": estimated,
        "estimated_error_excludes": _excludes(runs[0].summary, own_mesh),
        "estimate_cpu_seconds": seconds,
        "refinements": refinements,
        "warnings": sentences,
        "notes": [*notes, *([FILE_MESH] if estimated and not own_mesh else [])],
        "skipped": why if refinements else [],
    }


def _add_levels(
    runs: list[Answers], stage: Path, failed: Failed, read: Callable[[Path], Answers]
) -> list[str]:
    """Appends the coarser levels of the run in `stage` to `runs`, until one fails or has the elements
    and steps of the one before. Returns a message if there are none.
    """
    for k, name in enumerate(LEVELS, 1):
        if failure := failed(COARSER**k, stage / name):
            break
        level = read(stage / name)
        if _same(runs[-1], level):
            break
        runs.append(level)
    if len(runs) > 1:
        return []
    if not failure:
        return [SAME_STEPS]
    return [
        f"the error is not estimated: the run with {COARSER:.1f} times larger elements and steps ended with: {failure}"
    ]


def _same(fine: Answers, coarse: Answers) -> bool:
    """Whether two runs have the same unknowns and steps."""
    names = ("dofs", "steps")
    return all(fine.summary.get(name) == coarse.summary.get(name) is not None for name in names)


def _lacks_contact(summary: Table) -> bool:
    """Whether the rule for the end of an impact has cut it: the results lack a contact that may
    follow. The results at an end_time are those at this time, with or without such a contact.
    """
    return bool(summary.get("later_contact_possible")) and summary["ended"] != "end_time"


def _excludes(summary: Table, own_mesh: bool) -> list[str]:
    """Returns what all runs have in common. For a flat strike the penalty is not among it, because
    it changes with the element size (finer.py).
    """
    alike = [name for name in REGULARISED if name != "penalty" or summary.get("front_rise") is None]
    return alike if own_mesh else [*alike, "mesh"]


def error_estimates(runs: Sequence[Answers]) -> dict[str, float]:
    """Returns the error estimates of the results of the first run, the finest. Each further one has
    COARSER times the elements and steps of the one before. If a later contact may belong to the
    impact, the results OF_IMPACT have no estimate.
    """
    pairs = [_sizes(*pair) for pair in pairwise(runs)]
    ratio = _ratio(pairs, _order(runs[0]))
    slowest = math.pow(COARSER, SLOWEST * _order(runs[0]))
    estimates = {
        name: _extrapolated([pair[name] for pair in pairs], slowest if name in SLOW else ratio)
        for name in pairs[0]
    }
    # All levels may have the same drift, so their differences do not show it.
    estimates["energy"] = max(estimates["energy"], runs[0].summary.get("energy_drift") or 0.0)
    estimates |= rest_errors(*runs[:2])
    missing = OF_IMPACT if runs[0].summary.get("later_contact_possible") else ()
    return {name: error for name, error in estimates.items() if name not in missing}


def _extrapolated(apart: Sequence[float], ratio: float) -> float:
    """Returns the error estimate from the differences of successive levels, whose errors have this
    ratio.
    """
    squares = sum(difference**2 / ratio**k for k, difference in enumerate(apart))
    return SAFETY[len(apart)] / (ratio - 1) * math.sqrt(squares)


def _order(run: Answers) -> int:
    """Returns the order of the errors in elements and steps."""
    return 1 if run.summary.get("front_rise") else 2


def _sizes(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the differences of two runs by result, those of the histories included."""
    over_time = history_differences(fine, coarse)
    apart = differences(fine, coarse)
    return {name: math.hypot(value, over_time[name]) for name, value in apart.items()}


def _ratio(pairs: Sequence[Mapping[str, float]], order: int) -> float:
    """Returns the ratio r^q of the errors of two successive levels. The order q is the one that the
    differences of the results have in the median, at most `order` and at least SLOWEST times it.
    """
    highest = COARSER**order
    first, last = pairs[0], pairs[-1]
    shown = [name for name in first if min(first[name], last[name]) > TINY]
    if len(pairs) == 1 or not shown:
        return highest
    seen = median(last[name] / first[name] for name in shown)
    return min(highest, max(math.pow(highest, SLOWEST), seen))


def gain(runs: Sequence[Answers]) -> float:
    """Returns the difference of the result that scatters between the first two levels, over that
    between the next two; 0 if there is one pair.
    """
    apart = [_sizes(*pair)[SCATTERS] for pair in pairwise(runs)]
    return apart[0] / apart[1] if len(apart) > 1 and apart[1] else 0.0


def _ended(solve: Solve, values: Table, where: Path) -> Failure | None:
    """Runs the scene. Returns the failure if the step or the material ended the run, None if the
    run has a result. Other failures are raised.
    """
    try:
        solve(values, where)
    except Failure as failure:
        if failure.code not in NO_ANSWER:
            raise
        return failure
    return None


def _swap(stage: Path) -> None:
    """Puts the run in the folder FINE in the place of the main one, which becomes the first level;
    the first level becomes the second one.
    """
    coarser, coarsest, finer = (stage / name for name in (*LEVELS, FINE))
    shutil.rmtree(coarsest, ignore_errors=True)
    os.rename(coarser, coarsest)
    coarser.mkdir()
    # checkpoint.json, the request of the run, stays in its folder.
    kept = ("checkpoint.json", *LEVELS, FINE)
    for source, target in ((stage, coarser), (finer, stage)):
        for entry in [entry for entry in source.iterdir() if entry.name not in kept]:
            os.rename(entry, target / entry.name)
    shutil.rmtree(finer)


def output(factor: float) -> Table:
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


def differences(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the differences of the results of two runs, relative to their scales.

    - impulse, times, largest force, pressure and penetration: the value itself;
    - velocities: the largest speed; spin: that speed over the bounding radius; of several bodies
      the one with the largest difference counts;
    - energies and works: the largest energy. Friction work is also compared to itself.

    Gases and supports exchange energy with their bodies after contact, too, and damped bodies lose
    energy. So works, and energies without the work that follows, are compared at the end of the shorter run. A held body vibrates
    on its support: its velocities at the end are of one instant and are left out.
    """
    first, second = fine.summary, coarse.summary
    energy = first["largest_energy"]

    def value(summary: Table, name: str) -> float:
        number = summary.get(name)
        return 0.0 if number is None or math.isnan(number) else float(number)

    def apart(name: str, scale: float) -> float:
        return abs(value(first, name) - value(second, name)) / abs(scale) if scale else 0.0

    together = min(run.history["t"][-1] for run in (fine, coarse))
    works = [name for name in WORKS if name in fine.history]

    def until(run: Answers, name: str) -> float:
        return float(np.interp(together, run.history["t"], run.history[name]))

    def later(run: Answers) -> float:
        """The work [J/m] after the end of the shorter run, less what damping takes."""
        signs = dict.fromkeys(works, 1.0) | dict.fromkeys({DAMPING} & {*run.history}, -1.0)
        return sum(
            sign * (float(run.history[name][-1]) - until(run, name)) for name, sign in signs.items()
        )

    def energy_apart(name: str) -> float:
        return abs(value(first, name) - later(fine) - value(second, name) + later(coarse))

    def velocity(names: Sequence[str], scales: Mapping[str, float]) -> float:
        vectors = (
            math.hypot(*(apart(f"{kind}_{name}{suffix}", scale) for name in names))
            for suffix, scale in scales.items()
            for kind in AT_END
        )
        return max(vectors, default=0.0)

    apart_by_name = {
        "impulse": apart("impulse", value(first, "impulse")),
        "rebound": velocity(("vx", "vy", "vz"), dict.fromkeys(_free(fine), fine.speed)),
        "rebound_spin": velocity(("spin", "spin_x", "spin_y"), _rim_speeds(fine)),
        "energy": max(map(energy_apart, ("energy_final", "vibration_energy")))
        / (energy or math.inf),
        "friction_work": apart("friction_work", energy),
    }
    for name in ("thresholded_contact_time", "contact_time", "peak_force"):
        apart_by_name[name] = apart(name, value(first, name))
    apart_by_name[OF_ITSELF] = apart("friction_work", value(first, "friction_work"))
    for name in _highest(fine):
        largest, other = (_column(run, name).max() for run in (fine, coarse))
        apart_by_name[name] = abs(largest - other) / largest if largest else 0.0
    for name in works:
        apart_by_name[name] = abs(until(fine, name) - until(coarse, name)) / (energy or math.inf)
    return {name: float(number) for name, number in apart_by_name.items()}


def history_differences(fine: Answers, coarse: Answers) -> dict[str, float]:
    """Returns the differences of the time histories of two runs, by result and relative to the scales
    of differences().

    Root mean squares:
    - impulse, velocities, spin, energy (elastic, with that of the contact): in the last quarter of
      the contact, as nothing changes them afterwards;
    - works of supports and loads: in the last quarter of the common record;
    - thresholded contact time: of the times at which the same share of the impulse is reached, in
      its last quarter;
    - largest values: while one of the runs is above the share HIGH of the value.
    Largest differences:
    - friction work, whose differences change sign: in the common record;
    - contact time, which depends on the very end: as the thresholded one.
    """
    summary, energy = fine.summary, fine.summary["largest_energy"]
    work, lasts = summary["friction_work"] or 0.0, summary["contact_time"]
    shared = _SharedRecord(fine, coarse)
    apart = shared.apart

    def of_bodies(names: Sequence[str], scales: Mapping[str, float]) -> float:
        columns = {s: [n + s for n in names if n + s in fine.history] for s in scales}
        return max((apart(named(*columns[s]), scale) for s, scale in scales.items()), default=0.0)

    def named(*names: str) -> Columns:
        return lambda run: [run.history[name] for name in names]

    friction = math.sqrt(shared.squares(named("friction_work")).max())
    over_time = {
        "impulse": apart(lambda run: [_impulse(run.history)], summary["impulse"]),
        "rebound": of_bodies(("vx", "vy", "vz"), dict.fromkeys(_free(fine), fine.speed)),
        "rebound_spin": of_bodies(("spin", "spin_x", "spin_y"), _rim_speeds(fine)),
        "energy": apart(lambda run: [run.history["elastic"] + run.history["contact"]], energy),
        "friction_work": friction / energy if energy else 0.0,
        OF_ITSELF: friction / abs(work) if work else 0.0,
    }
    over_time |= {name: shared.apart_while_high(name) for name in ("peak_force", *_highest(fine))}
    over_time |= {
        name: apart(named(name), energy, shared.late) for name in WORKS if name in fine.history
    }
    reached = [_times_of_shares(run.history) for run in (fine, coarse)]
    delays = abs(reached[0] - reached[1]) / (lasts or math.inf)
    return over_time | {
        "thresholded_contact_time": math.sqrt(np.mean(delays**2)),
        "contact_time": float(delays.max()),
    }


class _SharedRecord:
    """The times [s] at which either of two runs has a step, up to the end of the shorter one, and
    which of them are in the last quarter of the record (`late`) and of the contact (`leaving`).
    """

    def __init__(self, fine: Answers, coarse: Answers):
        self.runs = fine, coarse
        steps = [run.history["t"] for run in self.runs]
        t = np.union1d(*steps)
        self.t = t = t[t <= min(times[-1] for times in steps)]
        # the time that each point stands for
        self.share = np.diff(np.concatenate([t[:1], (t[1:] + t[:-1]) / 2, t[-1:]]))
        self.late = self._last_quarter(t[0], t[-1])
        loaded = [run.history["t"][run.history["normal_force"] > 0] for run in self.runs]
        ends = np.minimum(np.concatenate(loaded), t[-1])
        self.leaving = self._last_quarter(ends.min(), ends.max()) if len(ends) else self.late

    def _last_quarter(self, start: float, end: float) -> np.ndarray:
        """Which times are in the last quarter from `start` to `end` [s]."""
        quarter: np.ndarray = (self.t >= start + EARLY * (end - start)) & (self.t <= end)
        return quarter

    def squares(self, columns: Columns) -> np.ndarray:
        """The squared differences of a vector with these columns."""
        first, second = (
            np.array([np.interp(self.t, run.history["t"], column) for column in columns(run)])
            for run in self.runs
        )
        squares: np.ndarray = ((first - second) ** 2).sum(axis=0)
        return squares

    def apart(
        self,
        columns: Columns,
        scale: float,
        when: np.ndarray | None = None,
    ) -> float:
        """The root mean square difference of a vector with these columns, over `scale`, at the times
        `when` (by default the last quarter of the contact).
        """
        when = self.leaving if when is None else when
        if not scale or not self.share[when].any():
            return 0.0
        squares = self.squares(columns)[when]
        return math.sqrt(np.average(squares, weights=self.share[when])) / abs(scale)

    def apart_while_high(self, name: str) -> float:
        """apart() of a result that is a largest value, while a run is above the share HIGH of it."""
        values = [np.interp(self.t, run.history["t"], _column(run, name)) for run in self.runs]
        largest = _column(self.runs[0], name).max()
        high = np.maximum(*values) > HIGH * largest
        return self.apart(lambda run: [_column(run, name)], largest, high)


def _impulse(history: Mapping[str, np.ndarray]) -> np.ndarray:
    """Returns the normal impulse up to each time [N s/m]."""
    return np.cumsum(history["normal_force"] * history["dt"])


def _times_of_shares(history: Mapping[str, np.ndarray]) -> np.ndarray:
    """Returns the times [s] at which the impulse reaches its SHARES, from the onset of contact."""
    impulse = _impulse(history)
    onset = max(int(np.argmax(history["normal_force"] > 0)) - 1, 0)
    reached, first = np.unique(np.maximum.accumulate(impulse), return_index=True)
    times: np.ndarray = (
        np.interp(SHARES * reached[-1], reached, history["t"][first]) - history["t"][onset]
    )
    return times


def _free(run: Answers) -> list[str]:
    """Returns the suffixes of the bodies that no support holds at the end."""
    return [suffix for suffix in suffixes(run.history) if suffix not in held_bodies(run.used)]


def _rim_speeds(run: Answers) -> dict[str, float]:
    """Returns the scale of the spin [rad/s] of each free body: the speed over its bounding radius."""
    reach = {s: run.summary.get(f"reach{s}") or run.used.get("radius") for s in _free(run)}
    return {suffix: run.speed / radius for suffix, radius in reach.items() if radius}


def _highest(run: Answers) -> list[str]:
    """Returns the names of the results that are largest values of columns, and of the forces of
    supports.
    """
    numbers = [name for name in run.history if name.startswith("support_force_x_")]
    return [*HIGHEST, *(name.replace("force_x", "peak") for name in numbers)]


def _column(run: Answers, name: str) -> np.ndarray:
    """Returns the history (steps + 1,) whose largest value is the result `name`."""
    if name == "peak_force":
        return run.history["normal_force"]
    if name in run.history:
        return run.history[name]
    number = name.rpartition("_")[2]
    axes = [f"support_force_{axis}_{number}" for axis in "xyz"]
    sizes: np.ndarray = np.linalg.norm(
        [run.history[axis] for axis in axes if axis in run.history], axis=0
    )
    return sizes


def wanted(also: str) -> list[str]:
    """Returns the names PROMISED and the one in the entry accuracy_of."""
    return [
        *PROMISED,
        *([] if also == "promised" else [OF_ITSELF if also == "friction_work" else also]),
    ]


def largest(estimated: Mapping[str, float]) -> float:
    """Returns the largest error estimate of the results PROMISED."""
    return max(estimated.get(name, 0.0) for name in PROMISED)


def touches(runs: Sequence[Answers]) -> list[str]:
    """Returns a message if the run and one of its levels have different numbers of contact intervals.
    Their differences then estimate little.
    """
    seen = [run.summary.get("contact_intervals") for run in runs]
    other = next((k for k, touched in enumerate(seen) if touched != seen[0]), 0)
    return (
        [
            f"touches: in contact {seen[0]} times, {seen[other]} times with {COARSER**other:.1f} times larger elements and "
            "steps: results of runs with different numbers of contacts may differ by more than the error "
            "estimates: see contacts.csv, or ask for a smaller accuracy"
        ]
        if other
        else []
    )


def excess(
    estimated: Mapping[str, float], accuracy: float, also: str, made: float, scatter: bool = False
) -> list[str]:
    """Returns a message about the results whose error estimate is above the accuracy, or above
    LOOSER times the accuracy if they are not promised. It names the accuracy that would do, as errors
    are about proportional to the one that elements and steps were `made` for (0: they are given),
    or, if only `scatter` is left, says so.
    """
    limits = {name: accuracy for name in wanted(also)} | {
        name: LOOSER * accuracy for name in ("contact_time", "peak_force") if name != also
    }
    above = {
        name: f"{name.replace('_', ' ')} {100 * estimated[name]:.2g} %"
        for name, limit in limits.items()
        if estimated.get(name, 0.0) > limit
    }
    if not above:
        return []
    main = [name for name in wanted(also) if name in above] or list(above)
    worst = max(main, key=lambda name: estimated[name])
    needed = made / max(estimated[name] / limits[name] for name in above)
    advice = f"ask for accuracy = {needed:.1g}" if made else "take smaller elements and steps"
    if scatter:
        advice = "ask for a smaller accuracy, which may not help: it scatters from mesh to mesh"
    return [
        f"estimated errors: {above[worst]}, requested {100 * accuracy:g} %: "
        f"all above it: {', '.join(above.values())}: if you need these numbers, {advice}"
    ]
