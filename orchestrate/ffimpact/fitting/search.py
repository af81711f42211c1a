"""The search for the values of free entries: runs, interpolation, likelihood, until the runs lie
close enough around the values that are likely.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..failure import Failure
from .curves import Array
from .emulator import Box, Emulator, Scales
from .likelihood import Likelihood, Profile, covariance
from .runs import Runs

__all__ = ["Found", "search"]

ROUNDS = 14  # of boxes of runs
EXACT = 0.3  # largest error of the interpolation, relative to the other errors
APART = 1e-6  # runs that are closer are one
CORRECTIONS = 3  # by finer runs, until
STAYS = 0.5  # the best values move by fewer standard errors than this


@dataclass(frozen=True)
class Found:
    """The outcome of a search, in coordinates: `best` (k,) with chi2 `least`, the profiles, the
    information (k, k), the likelihood, its emulator's predictions (m,) at the best, and notes on how
    the search ended. `widened` (k,): standard errors over those by the errors of measurement alone.
    """

    best: Array
    least: float
    profiles: list[Profile]
    information: Array
    likelihood: Likelihood
    predicted: Array
    widened: Array
    box: Box
    notes: list[str]


class _Nodes:
    """All runs so far: coordinates (n, k) and, by experiment, features."""

    def __init__(self, runs: Runs, scales: Scales):
        self.runs, self.scales = runs, scales
        self.at = np.empty((0, len(scales.names)))

    def add(self, at: Array) -> None:
        before = len(self.at)
        for point in at:
            if not (np.abs(self.at - point).max(axis=1) < APART).any():
                self.at = np.vstack([self.at, point])
        self.runs.answers([self.scales.entries(point) for point in self.at[before:]])

    def emulator(self, box: Box) -> Emulator:
        """The emulator of all that is measured, by the runs near a box that have an answer."""
        near = self.at[box.holds(self.at, 2.0)]
        every = self.runs.answers([self.scales.entries(point) for point in near])
        for experiment, answers in zip(self.runs.experiments, every):
            if all(answer is None for answer in answers):
                raise Failure(
                    f"{experiment!r}: no run of the fit ended (accepted: narrower bounds)"
                )
        ended = [k for k, own in enumerate(zip(*every)) if all(part is not None for part in own)]
        rows = [[part for own in every if (part := own[k]) is not None] for k in ended]
        if not rows:
            raise Failure("no runs of all experiments ended alike (accepted: narrower bounds)")
        ends = np.cumsum([len(part) for part in rows[0]])[:-1]

        def observe(features: Array) -> Array:
            parts = np.split(features, ends, axis=1)
            return np.hstack([self.runs.observed(i, part) for i, part in enumerate(parts)])

        features = np.array([np.concatenate(own) for own in rows])
        return Emulator(near[ended], features, box, observe)


def search(
    runs: Runs, scales: Scales, priors: Array, robust: bool, finer: float | None = None
) -> Found:
    """Returns what was found. With `finer`, an accuracy, runs of this accuracy at the best values
    correct the others, and the search goes on until the best values stay. Raises Failure if too few
    runs end.
    """
    nodes = _Nodes(runs, scales)
    outcome = _narrowed(nodes, Box.whole(len(scales.names)), priors, robust)
    notes: list[str] = []
    for _ in range(CORRECTIONS if finer else 0):
        before = outcome
        notes = runs.correct(scales.entries(before.best), finer or 0.0)
        outcome = _narrowed(nodes, before.box, priors, robust)
        moved = outcome.best - before.best
        if moved @ outcome.information @ moved < STAYS**2:
            break
    else:
        if finer:
            notes.append(
                "corrections by finer runs still moved the values: a smaller accuracy is needed"
            )
    return replace(outcome, notes=notes + outcome.notes)


def _narrowed(nodes: _Nodes, box: Box, priors: Array, robust: bool) -> Found:
    """What is found from a box on, which is narrowed, moved and widened until it holds what is likely."""
    looked, notes = set(), []
    best = (box.low + box.high) / 2
    for _ in range(ROUNDS):
        looked.add(box)
        nodes.add(box.nodes())
        likelihood, minima, inexact = _minima(nodes, box, best, priors, robust)
        best, least = minima[0]
        region = likelihood.region(best, least, box)
        smaller = Box.around(*region)
        if smaller in looked or _same(smaller, box):
            profiles = [likelihood.profile(k, minima, box) for k in range(len(best))]
            smaller = Box.around(*_widened(region, profiles, box))
        if not _same(smaller, box) and smaller not in looked:
            box = smaller
        elif inexact > EXACT and (denser := box.denser()):
            box = denser
        else:
            # runs at the best values and at the ends of intervals
            ends = np.vstack([best, *(profile.ends for profile in profiles)])
            nodes.add(_rounded(ends, nodes.scales))
            break
    else:
        notes.append("the search did not come to rest: the intervals are uncertain")
    return _concluded(nodes, box, _minima(nodes, box, best, priors, robust), notes)


def _concluded(
    nodes: _Nodes,
    box: Box,
    last: tuple[Likelihood, list[tuple[Array, float]], float],
    notes: list[str],
) -> Found:
    """What is found in the last box."""
    likelihood, minima, inexact = last
    best, least = minima[0]
    if inexact > EXACT:
        notes.append(
            f"the interpolation between runs adds {100 * inexact:.2g} % of the other errors: narrower bounds may help"
        )
    profiles = [likelihood.profile(k, minima, box) for k in range(len(best))]
    if any(
        (p.low is None and box.low[k] > 0) or (p.high is None and box.high[k] < 1)
        for k, p in enumerate(profiles)
    ):
        notes.append("the search ended before all profiles rose or met the bounds")
    information = likelihood.information(best, box)
    predicted = likelihood.predict(best[None])[0]
    exact = [np.zeros(len(e.values)) for e in nodes.runs.experiments]
    noise = covariance(nodes.runs.experiments, exact, predicted)
    alone = likelihood.with_variance(noise).information(best, box)
    widened = np.sqrt(np.diag(np.linalg.inv(information)) / np.diag(np.linalg.inv(alone)))
    return Found(best, least, profiles, information, likelihood, predicted, widened, box, notes)


def _minima(
    nodes: _Nodes, box: Box, near: Array, priors: Array, robust: bool
) -> tuple[Likelihood, list[tuple[Array, float]], float]:
    """The likelihood in a box, its minima, the least first, and the error of the interpolation relative
    to the others.
    """
    best = np.clip(near, box.low, box.high)
    # twice, as errors that are shares of the values are those of the values at the best
    for _ in range(2):
        likelihood, inexact = _likelihood(nodes, box, best, priors, robust)
        minima = likelihood.minima(box, best[None])
        best = minima[0][0]
    return likelihood, minima, inexact


def _widened(
    region: tuple[Array, Array], profiles: Sequence[Profile], box: Box
) -> tuple[Array, Array]:
    """A region that goes on where a profile has not risen at an end of the box within the bounds."""
    low, high = (side.copy() for side in region)
    for k, profile in enumerate(profiles):
        wide = box.high[k] - box.low[k]
        if profile.low is None and box.low[k] > 0:
            low[k] = min(low[k], box.low[k] - wide / 2)
        if profile.high is None and box.high[k] < 1:
            high[k] = max(high[k], box.high[k] + wide / 2)
    return low, high


def _same(box: Box, other: Box) -> bool:
    """Whether a box is another, up to its density."""
    return bool(np.allclose(box.low, other.low) and np.allclose(box.high, other.high))


def _rounded(at: Array, scales: Scales) -> Array:
    """Coordinates whose entries have the digits that a run gets."""
    return np.array([scales.coordinates(scales.entries(point)) for point in at])


def _likelihood(
    nodes: _Nodes, box: Box, near: Array, priors: Array, robust: bool
) -> tuple[Likelihood, float]:
    """The likelihood with the interpolation in a box, and the error of the interpolation relative to
    the others. Errors that are shares of values are those of the values predicted `near` (k,).
    """
    runs, predict = nodes.runs, nodes.emulator(box)
    noise = covariance(runs.experiments, runs.stated, predict(near[None])[0])
    inexact = predict.covariance
    share = float(np.sqrt(np.mean(np.diag(inexact) / np.diag(noise))))
    measured = np.concatenate([e.values for e in runs.experiments])
    return Likelihood(measured, noise + inexact, predict, priors, robust), share
