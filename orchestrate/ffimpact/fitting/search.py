"""The search for the values of free entries: runs, interpolation, likelihood, until the runs lie
close enough around the values that are likely.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..failure import Failure
from .emulator import Box, Emulator, Scales
from .experiments import Array
from .likelihood import Likelihood, Profile, covariance
from .predictions import Runs, observed

__all__ = ["Found", "search"]

ROUNDS = 14  # of boxes of runs
EXACT = 0.3  # largest error of the interpolation, relative to the other errors
CONFIRMED = (
    0.3  # largest change of chi2's root by runs at the best values and the ends of intervals
)


@dataclass(frozen=True)
class Found:
    """The outcome of a search, in coordinates: `best` (k,) with chi2 `least`, the profiles, the
    information (k, k), the likelihood, and its emulator's predictions (m,) at the best.
    """

    best: Array
    least: float
    profiles: list[Profile]
    information: Array
    likelihood: Likelihood
    predicted: Array
    interpolation: float
    box: Box


class _Nodes:
    """All runs so far: coordinates (n, k) and, by experiment, features."""

    def __init__(self, runs: Runs, scales: Scales):
        self.runs, self.scales = runs, scales
        self.at = np.empty((0, len(scales.names)))

    def add(self, at: Array) -> None:
        new = [
            point
            for point in at
            if not len(self.at) or np.abs(self.at - point).max(axis=1).min() > 1e-9
        ]
        if new:
            self.at = np.vstack([self.at, new])
            self.runs.answers([self.scales.entries(point) for point in new])

    def emulators(self, box: Box) -> list[Emulator]:
        made = []
        near = self.at[box.holds(self.at, 2.0)]
        every = self.runs.answers([self.scales.entries(point) for point in near])
        for experiment, answers in zip(self.runs.experiments, every):
            ended = [k for k, answer in enumerate(answers) if answer is not None]
            if not ended:
                raise Failure(
                    f"{experiment!r}: no run of the fit ended (accepted: narrower bounds)"
                )
            own = np.array([answers[k] for k in ended])
            made.append(Emulator(near[ended], own, box, lambda p, e=experiment: observed(e, p)))  # type: ignore[misc]
        return made


def search(runs: Runs, scales: Scales, priors: Array, robust: bool) -> Found:
    """Returns what was found. Raises Failure if too few runs end."""
    nodes, count = _Nodes(runs, scales), len(scales.names)
    box, looked = Box.whole(count), set()
    best = np.full(count, 0.5)
    for _ in range(ROUNDS):
        looked.add(box)
        nodes.add(box.nodes())
        # twice, as errors that are shares of the values are those of the values at the best
        for _ in range(2):
            best = np.clip(best, box.low, box.high)
            likelihood, inexact = _likelihood(nodes, box, best, priors, robust)
            best, least = likelihood.best(box, best[None])
        smaller = Box.around(*likelihood.region(best, least, box))
        if not _same(smaller, box) and smaller not in looked:
            box = smaller
        elif inexact > EXACT and (denser := box.denser()):
            box = denser
        else:
            break
    profiles = [likelihood.profile(k, best, least, box) for k in range(count)]
    ends = [best] + [
        _with(best, k, end)
        for k, p in enumerate(profiles)
        for end in (p.low, p.high)
        if end is not None
    ]
    nodes.add(_rounded(np.array(ends), scales))
    likelihood, inexact = _likelihood(nodes, box, best, priors, robust)
    best, least = likelihood.best(box, best[None])
    profiles = [likelihood.profile(k, best, least, box) for k in range(count)]
    return Found(
        best,
        least,
        profiles,
        likelihood.information(best, box),
        likelihood,
        likelihood.predict(best[None])[0],
        inexact,
        box,
    )


def _same(box: Box, other: Box) -> bool:
    """Whether a box is another, up to its density."""
    return bool(np.allclose(box.low, other.low) and np.allclose(box.high, other.high))


def _with(best: Array, k: int, value: float) -> Array:
    changed = best.copy()
    changed[k] = value
    return changed


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
