"""What is to be questioned in measurements and in what a fit finds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain

from .experiments import Experiment, Number
from .fitted import Fit

__all__ = ["questions"]

MOST = 12  # notes
UNIT = 2.5  # a number so many times as large as predicted may have another unit, if it is
OFF = 5.0  # so many errors off; two alike that are so many errors apart contradict each other
FAR = 3.0  # errors from what was known beforehand, or between numbers that cannot refuse a model
SCATTERED = 2.0  # ratio of the scatter of neighbours to the given error
TOO_GOOD = 0.01  # chi2 of a degree of freedom
WIDENED = 1.4  # ratio of standard errors to those of the measurements alone
AT_BOUND = 1e-3  # distance from a bound, over the distance of both


def questions(made: Fit) -> list[str]:
    """What is to be questioned, in sentences, at most MOST."""
    experiments = made.experiments
    parts = (
        _of_numbers(made),
        _of_repeats(experiments),
        _of_curves(experiments),
        _of_runs(made),
        _of_entries(made),
    )
    return list(chain.from_iterable(parts))[:MOST]


def _of_numbers(made: Fit) -> list[str]:
    notes = []
    for row in made.measurements.drop_duplicates(["experiment", "number"]).itertuples():
        ratio = row.measured / row.predicted if row.predicted > 0 else 1.0
        where = f"{row.number} of experiment {row.experiment}"
        if not 1 / UNIT < ratio < UNIT and abs(row.off) > OFF:
            notes.append(
                f"{where} is {row.measured:.4g}, predicted {row.predicted:.4g}: is its unit right?"
            )
        elif made.freedom < 1 and abs(row.off) > FAR:
            notes.append(
                f"{where} is off by {abs(row.off):.2g} errors: no values between the bounds agree"
            )
    return notes


def _of_repeats(experiments: Sequence[Experiment]) -> list[str]:
    """Of numbers of experiments that are alike."""
    notes, seen = [], dict[tuple[str, str], Number]()
    for e in experiments:
        for number in e.numbers:
            key = (repr((sorted(e.entries.items()), e.speed, e.height)), number.name)
            other = seen.setdefault(key, number)
            if abs(other.value - number.value) > OFF * math.hypot(other.error, number.error):
                notes.append(
                    f"{number.name}: {other.value:.4g} and {number.value:.4g} in two experiments that are alike contradict each other"
                )
    return notes


def _of_curves(experiments: Sequence[Experiment]) -> list[str]:
    return [
        f"{curve.name} of {e!r}: neighbouring values scatter by {curve.scatter:.2g}, the error of a value is given as "
        f"{curve.error:.2g}: are errors of neighbours independent?"
        for e in experiments
        for curve in e.curves
        if not math.isnan(curve.scatter)
        and not 1 / SCATTERED < curve.scatter / curve.error < SCATTERED
    ]


def _of_runs(made: Fit) -> list[str]:
    notes = []
    if made.outcome.widened.max() > WIDENED:
        notes.append(
            f"errors of elements, steps and interpolation make the intervals up to {made.outcome.widened.max():.2g} times as wide: "
            "a smaller accuracy narrows them"
        )
    if (
        made.freedom > 1
        and made.chi2 < TOO_GOOD * made.freedom
        and made.outcome.widened.max() < WIDENED
    ):
        notes.append("the deviations are far smaller than the errors given: are these too large?")
    unanswered = made.laboratory.unanswered
    if unanswered:
        message, _ = unanswered.most_common(1)[0]
        notes.append(f"{unanswered.total()} runs have no answer and were left out: {message}")
    return notes


def _of_entries(made: Fit) -> list[str]:
    notes = []
    for at, (value, error), (name, row) in zip(
        made.outcome.best, made.outcome.likelihood.priors, made.table.iterrows()
    ):
        best = made.best[str(name)]
        if abs(at - value) > FAR * error:
            notes.append(
                f"{name}: {best:.4g} is far from what was known beforehand: is it another material?"
            )
        if min(at, 1 - at) < AT_BOUND and row["known"] == "yes":
            notes.append(f"{name}: the best value is at a bound, {best:.4g}: are the bounds right?")
    return notes
