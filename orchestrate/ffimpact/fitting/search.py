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
    the search ended.
    """

    best: Array
    least: float
    profiles: list[Profile]
    information: Array
    likelihood: Likelihood
    predicted: Array
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

    def emulators(self, box: Box) -> list[Emulator]:
        made = []
        near = self.at[box.holds(self.at, 2.0)]
        every = self.runs.answers([self.scales.entries(point) for point in near])
        for i, (experiment, answers) in enumerate(zip(self.runs.experiments, every)):
            ended = [k for k, answer in enumerate(answers) if answer is not None]
            if not ended:
                raise Failure(
                    f"{experiment!r}: no run of the fit ended (accepted: narrower bounds)"
                )
            own = np.array([answers[k] for k in ended])
            made.append(Emulator(near[ended], own, box, lambda p, i=i: self.runs.observed(i, p)))  # type: ignore[misc]
        return made


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
    return replace(outcome, notes=notes + outcome.notes)


def _narrowed(nodes: _Nodes, box: Box, priors: Array, robust: bool) -> Found:
    """What is found from a box on, which is narrowed, moved and widened until it holds what is likely."""
    scales, looked, notes = nodes.scales, set(), []
    best = (box.low + box.high) / 2
    for _ in range(ROUNDS):
        looked.add(box)
        nodes.add(box.nodes())
        likelihood, best, least, inexact = _best(nodes, box, best, priors, robust)
        profiles = _profiles(likelihood, best, least, box)
        smaller = Box.around(*_widened(likelihood.region(best, least, box), profiles, box))
        if not _same(smaller, box) and smaller not in looked:
            box = smaller
        elif inexact > EXACT and (denser := box.denser()):
            box = denser
        else:
            break
    else:
        notes.append("the search did not come to rest: the intervals are uncertain")
    nodes.add(_rounded(np.vstack([best, *(profile.ends for profile in profiles)]), scales))
    likelihood, best, least, inexact = _best(nodes, box, best, priors, robust)
    if inexact > EXACT:
        notes.append(
            f"the interpolation between runs adds {100 * inexact:.2g} % of the other errors: narrower bounds may help"
        )
    profiles = _profiles(likelihood, best, least, box)
    information = likelihood.information(best, box)
    predicted = likelihood.predict(best[None])[0]
    return Found(best, least, profiles, information, likelihood, predicted, box, notes)


def _best(
    nodes: _Nodes, box: Box, near: Array, priors: Array, robust: bool
) -> tuple[Likelihood, Array, float, float]:
    """The likelihood in a box, the coordinates with the least chi2, chi2, and the error of the
    interpolation relative to the others.
    """
    best = np.clip(near, box.low, box.high)
    # twice, as errors that are shares of the values are those of the values at the best
    for _ in range(2):
        likelihood, inexact = _likelihood(nodes, box, best, priors, robust)
        best, least = likelihood.best(box, best[None])
    return likelihood, best, least, inexact


def _profiles(likelihood: Likelihood, best: Array, least: float, box: Box) -> list[Profile]:
    return [likelihood.profile(k, best, least, box) for k in range(len(best))]


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
    runs, emulators = nodes.runs, nodes.emulators(box)

    def predict(at: Array) -> Array:
        return np.hstack([emulator(at) for emulator in emulators])

    noise = covariance(runs.experiments, runs.stated, predict(near[None])[0])
    inexact = _blocks([emulator.covariance for emulator in emulators])
    share = float(np.sqrt(np.mean(np.diag(inexact) / np.diag(noise))))
    measured = np.concatenate([e.values for e in runs.experiments])
    return Likelihood(measured, noise + inexact, predict, priors, robust), share


def _blocks(matrices: Sequence[Array]) -> Array:
    from scipy.linalg import block_diag  # takes long to load

    return np.asarray(block_diag(*matrices))
