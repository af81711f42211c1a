"""The likelihood of free entries, and their intervals by its profiles."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..failure import BadInput
from .curves import Array
from .emulator import Box
from .experiments import Experiment

__all__ = ["COVERED", "UNIFORM", "Likelihood", "Profile", "covariance"]

COVERED = 3.841458820694124  # rise of chi2 at the ends of an interval of 95 % (1 degree of freedom)
WIDE = 16.0  # rise of chi2 up to which a fit makes runs: four standard errors
SCANNED = 9  # logarithm to base 2 of the points at which chi2 is looked at
STARTS = 4  # of these from which the best values are sought, so far
APART = 0.1  # from each other, over the width of a box
DRAWN = 33  # points of a profile
UNIFORM = 12.0  # information of a uniform prior between 0 and 1
# Stated errors are so many standard errors. They are bounds, in the median four to five times the
# errors (docs/measurements); half of the errors of a normal distribution are below 0.67 of one.
STATED = 3.0
# Numbers that have the errors of another one
LIKE = {"rebound_height": "restitution", "interval_ratio": "restitution"}


def covariance(
    experiments: Sequence[Experiment], stated: Sequence[Array], predicted: Array
) -> Array:
    """The covariance (m, m) of all measured values less what they would be without errors of
    measurement and of elements and steps.

    `stated` are the relative errors of elements and steps, for each experiment. They are shares of the
    predicted values (m,) (as shares of measured ones they would bias a scale), and common to all numbers
    or coefficients of a name, as the errors `common` are.
    """
    noise, k = np.zeros((len(predicted), len(predicted))), 0
    sources: dict[tuple[str, str], Array] = defaultdict(lambda: np.zeros(len(predicted)))
    for e, relative in zip(experiments, stated):
        own = predicted[k : k + len(relative)]
        errors = relative / STATED * e.sizes(own)
        for n, number in enumerate(e.numbers):
            noise[k + n, k + n] = number.error**2
            sources["common", number.name][k + n] = number.common
            sources["elements", LIKE.get(number.name, number.name)][k + n] = errors[n]
        for curve, part in zip(e.curves, e.parts):
            at = slice(k + part.start, k + part.stop)
            noise[at, at] = curve.noise
            sources["common", curve.name][at] = curve.common * own[part]
            for n in range(part.start, part.stop):
                sources["elements", f"{curve.name} {n - part.start}"][k + n] = errors[n]
        k += len(own)
    return np.asarray(noise + sum(np.outer(part, part) for part in sources.values()))


@dataclass(frozen=True)
class Profile:
    """The rise of chi2 (n,) over the coordinate (n,) of an entry, at the best of the others. `low` and
    `high` end the interval of 95 %, None where chi2 does not rise that far within the bounds; there
    all entries have the coordinates `ends` (2, k). Within, chi2 may rise as far: then `parts` are the
    ranges in which it does not.
    """

    at: Array
    rise: Array
    low: float | None
    high: float | None
    ends: Array

    @property
    def parts(self) -> list[tuple[float, float]]:
        below = np.flatnonzero(self.rise < COVERED)
        runs = np.split(below, np.flatnonzero(np.diff(below) > 1) + 1)
        return [(float(self.at[run[0]]), float(self.at[run[-1]])) for run in runs if len(run)]


class Likelihood:
    """How far predictions are from `measured` (m,) with a covariance (m, m), in coordinates (k,).

    `predict`: (p, k) to (p, m). `priors` (k, 2): coordinate and standard error of what is known of
    an entry beforehand, infinite where nothing is. With `robust` large residuals count linearly.
    """

    def __init__(
        self,
        measured: Array,
        variance: Array,
        predict: Callable[[Array], Array],
        priors: Array,
        robust: bool = False,
    ):
        self.measured, self.predict, self.priors = measured, predict, priors
        self.loss = "soft_l1" if robust else "linear"
        try:
            np.linalg.cholesky(variance)
        except np.linalg.LinAlgError:
            raise BadInput(
                "error: the errors of the measurements are too different to be compared"
            ) from None
        # the symmetric root: what `robust` does not depend on the order of the measurements
        sizes, vectors = np.linalg.eigh(variance)
        self.variance, self.root = variance, vectors / np.sqrt(sizes) @ vectors.T

    def with_variance(self, variance: Array) -> Likelihood:
        """The same with another covariance."""
        robust = self.loss != "linear"
        return Likelihood(self.measured, variance, self.predict, self.priors, robust)

    def slopes(self, at: Array, box: Box) -> Array:
        """Derivatives (k, m) of the predictions at coordinates (k,)."""
        step = 0.02 * (box.high - box.low)
        sides = [self.predict(np.array([at + d, at - d])) for d in np.diag(step)]
        return np.array([(up - down) / (2 * h) for (up, down), h in zip(sides, step)])

    def residuals(self, at: Array) -> Array:
        """Residuals at coordinates (p, k), whitened: (p, m + k)."""
        own = (self.predict(at) - self.measured) @ self.root.T
        before = (at - self.priors[:, 0]) / self.priors[:, 1]
        return np.asarray(np.hstack([own, before]), dtype=float)

    def chi2(self, at: Array) -> Array:
        """Sum of squares (p,) of the residuals at coordinates (p, k)."""
        squares = self.residuals(at) ** 2
        if self.loss != "linear":
            squares = 2 * (np.sqrt(1 + squares) - 1)
        return np.asarray(squares.sum(axis=1))

    def _least(self, start: Array, low: Array, high: Array) -> tuple[Array, float]:
        """The coordinates between `low` and `high` with the least chi2 near `start`, and chi2."""
        from scipy.optimize import least_squares  # takes long to load

        free = high > low
        if not free.any():
            return start, float(self.chi2(start[None])[0])

        def residuals(own: Array) -> Array:
            at = start.copy()
            at[free] = own
            return np.asarray(self.residuals(at[None])[0])

        inside = np.clip(start, low, high)[free]
        least = least_squares(
            residuals,
            inside,
            bounds=(low[free], high[free]),
            jac="3-point",
            loss=self.loss,
            xtol=1e-10,
            ftol=1e-10,
        )
        at = start.copy()
        at[free] = least.x
        return at, 2 * float(least.cost)

    def minima(self, box: Box, more: Array | None = None) -> list[tuple[Array, float]]:
        """Coordinates with the least chi2 near each of several starts, and chi2, the least first."""
        points = _scattered(box)
        if more is not None:
            points = np.vstack([more, points])
        starts = _distinct(points[np.argsort(self.chi2(points))], box)
        minima = [self._least(start, box.low, box.high) for start in starts]
        return sorted(minima, key=lambda pair: pair[1])

    def region(self, best: Array, least: float, box: Box) -> tuple[Array, Array]:
        """The range (k,), (k,) of coordinates where chi2 rises by WIDE or less."""
        points = _scattered(box)
        near = points[self.chi2(points) < least + WIDE]
        sides = np.vstack([near, best[None]])
        away = np.sqrt(WIDE * np.diag(np.linalg.inv(self.information(best, box))))
        return np.minimum(sides.min(axis=0), best - away), np.maximum(
            sides.max(axis=0), best + away
        )

    def information(self, at: Array, box: Box) -> Array:
        """Fisher's information (k, k) at coordinates, with that of the bounds."""
        slopes = self.slopes(at, box) @ self.root.T
        return np.asarray(slopes @ slopes.T + np.diag(1 / self.priors[:, 1] ** 2 + UNIFORM))

    def profile(self, k: int, minima: Sequence[tuple[Array, float]], box: Box) -> Profile:
        """The profile of entry k. Its points are evenly spaced, and the `minima` of chi2 in the box."""
        best, least = minima[0]
        likely = _distinct([at for at, chi2 in minima if chi2 < least + WIDE], box)
        even = np.linspace(box.low[k], box.high[k], DRAWN)
        grid = np.unique(np.append(even, [at[k] for at in likely]))
        rises = np.full(len(grid), np.inf)
        for start in likely:
            middle = int(np.argmin(np.abs(grid - start[k])))
            for side in (range(middle, len(grid)), range(middle, -1, -1)):
                near = start
                for n in side:
                    near, own = self._at(k, float(grid[n]), near, box)
                    rises[n] = min(rises[n], own)
        rises -= least
        low = self._end(k, grid, rises, best, least, box)
        high = self._end(k, grid[::-1], rises[::-1], best, least, box)
        beyond = (grid[0] if low is None else low, grid[-1] if high is None else high)
        ends = np.array([self._at(k, float(value), best, box)[0] for value in beyond])
        return Profile(grid, rises, low, high, ends)

    def _at(self, k: int, value: float, start: Array, box: Box) -> tuple[Array, float]:
        """The best of the other entries where entry k has a value."""
        low, high, own = box.low.copy(), box.high.copy(), start.copy()
        low[k] = high[k] = own[k] = value
        return self._least(own, low, high)

    def _end(
        self, k: int, grid: Array, rises: Array, best: Array, least: float, box: Box
    ) -> float | None:
        """Where a profile, from outside inwards, first falls to COVERED; None if it begins below."""
        from scipy.optimize import brentq  # takes long to load

        def above(value: float) -> float:
            return self._at(k, value, best, box)[1] - least - COVERED

        n = int(np.argmax(rises < COVERED))
        if n == 0:
            return None
        outer, inner = float(grid[n - 1]), float(grid[n])
        # from the best values another minimum may be met than along the profile
        if above(outer) * above(inner) > 0:
            share = (rises[n - 1] - COVERED) / (rises[n - 1] - rises[n])
            return outer + float(share) * (inner - outer)
        return float(brentq(above, outer, inner, xtol=1e-6))


def _distinct(points: Iterable[Array], box: Box) -> list[Array]:
    """The first STARTS of the points that are farther than APART from those before."""
    distinct: list[Array] = []
    width = box.high - box.low
    for point in points:
        apart = [np.abs((point - other) / width).max() for other in distinct]
        if min(apart, default=1.0) > APART:
            distinct.append(point)
        if len(distinct) == STARTS:
            break
    return distinct


def _scattered(box: Box) -> Array:
    """Points that fill a box evenly (p, k)."""
    from scipy.stats.qmc import Sobol  # takes long to load

    points: Array = Sobol(len(box.levels), scramble=False).random_base2(SCANNED)
    return np.asarray(box.low + points * (box.high - box.low))
