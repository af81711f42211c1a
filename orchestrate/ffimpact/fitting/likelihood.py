"""The likelihood of free entries, and their intervals by its profiles."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..failure import BadInput
from .curves import Array
from .emulator import Box
from .experiments import Experiment

__all__ = ["COVERED", "Likelihood", "Profile", "covariance"]

COVERED = 3.841458820694124  # rise of chi2 at the ends of an interval of 95 % (1 degree of freedom)
WIDE = 16.0  # rise of chi2 up to which a fit makes runs: four standard errors
SCANNED = 9  # logarithm to base 2 of the points at which chi2 is looked at
STARTS = 4  # of these from which the best values are sought
DRAWN = 33  # points of a profile
UNIFORM = 12.0  # information of a uniform prior between 0 and 1
# Stated errors are so many standard errors. They are bounds, in the median four to five times the
# errors (docs/measurements); half of the errors of a normal distribution are below 0.67 of one.
STATED = 3.0


def covariance(
    experiments: Sequence[Experiment], stated: Sequence[Array], predicted: Array
) -> Array:
    """The covariance (m, m) of all measured values less what they would be without errors of
    measurement and of elements and steps.

    `stated` are the relative errors of elements and steps, for each experiment. They are shares of the
    predicted values (m,) (as shares of measured ones they would bias a scale), and for numbers common to
    all of a name, as the errors `common` are.
    """
    noise, k = np.zeros((len(predicted), len(predicted))), 0
    sources: dict[tuple[str, str], Array] = defaultdict(lambda: np.zeros(len(predicted)))
    for e, relative in zip(experiments, stated):
        own = predicted[k : k + len(relative)]
        errors = relative / STATED * e.sizes(own)
        for n, number in enumerate(e.numbers):
            noise[k + n, k + n] = number.error**2
            sources["common", number.name][k + n] = number.common
            sources["elements", number.name][k + n] = errors[n]
        for curve, part in zip(e.curves, e.parts):
            at = slice(k + part.start, k + part.stop)
            noise[at, at] = curve.noise + np.diag(errors[part] ** 2)
            sources["common", curve.name][at] = curve.common * own[part]
        k += len(own)
    return np.asarray(noise + sum(np.outer(part, part) for part in sources.values()))


@dataclass(frozen=True)
class Profile:
    """The rise of chi2 (n,) over the coordinate (n,) of an entry, at the best of the others. `low` and
    `high` end the interval of 95 %, None where chi2 does not rise that far within the bounds; there
    all entries have the coordinates `ends` (2, k).
    """

    at: Array
    rise: Array
    low: float | None
    high: float | None
    ends: Array


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
            self.root = np.linalg.inv(np.linalg.cholesky(variance))
        except np.linalg.LinAlgError:
            raise BadInput(
                "error: the errors of the measurements are too different to be compared"
            ) from None

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

    def best(self, box: Box, more: Array | None = None) -> tuple[Array, float]:
        """The coordinates in a box with the least chi2, and chi2; several starts, and those of `more`."""
        points = _scattered(box)
        if more is not None:
            points = np.vstack([more, points])
        starts = points[np.argsort(self.chi2(points))[:STARTS]]
        return min(
            (self._least(start, box.low, box.high) for start in starts), key=lambda pair: pair[1]
        )

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
        step = 0.02 * (box.high - box.low)
        jacobian = np.array(
            [
                (self.residuals((at + d)[None])[0] - self.residuals((at - d)[None])[0])
                for d in np.diag(step)
            ]
        ) / (2 * step[:, None])
        return np.asarray(jacobian @ jacobian.T + UNIFORM * np.eye(len(at)))

    def profile(self, k: int, best: Array, least: float, box: Box) -> Profile:
        """The profile of entry k."""
        grid = np.linspace(box.low[k], box.high[k], DRAWN)
        rises = np.full(DRAWN, np.nan)
        middle = int(np.argmin(np.abs(grid - best[k])))
        for side in (range(middle, DRAWN), range(middle, -1, -1)):
            start = best
            for n in side:
                start, rises[n] = self._at(k, float(grid[n]), start, box)
        rises -= least
        low, high = (self._end(k, grid, rises, middle, best, least, box, sign) for sign in (-1, 1))
        beyond = (grid[0] if low is None else low, grid[-1] if high is None else high)
        ends = np.array([self._at(k, float(value), best, box)[0] for value in beyond])
        return Profile(grid, rises, low, high, ends)

    def _at(self, k: int, value: float, start: Array, box: Box) -> tuple[Array, float]:
        """The best of the other entries where entry k has a value."""
        low, high, own = box.low.copy(), box.high.copy(), start.copy()
        low[k] = high[k] = own[k] = value
        return self._least(own, low, high)

    def _end(
        self,
        k: int,
        grid: Array,
        rises: Array,
        middle: int,
        best: Array,
        least: float,
        box: Box,
        sign: int,
    ) -> float | None:
        """Where the profile first rises to COVERED on one side of the best value."""
        from scipy.optimize import brentq  # takes long to load

        def above(value: float) -> float:
            return self._at(k, value, best, box)[1] - least - COVERED

        inner, n = float(best[k]), middle
        while 0 <= n < len(grid):
            outer = float(grid[n])
            # from the best values a smaller chi2 may be met than along the profile
            if sign * (outer - best[k]) > 0 and rises[n] >= COVERED and above(outer) >= 0:
                return inner if above(inner) >= 0 else float(brentq(above, inner, outer, xtol=1e-6))
            inner = outer if sign * (outer - best[k]) > 0 else inner
            n += sign
        return None


def _scattered(box: Box) -> Array:
    """Points that fill a box evenly (p, k)."""
    from scipy.stats.qmc import Sobol  # takes long to load

    points: Array = Sobol(len(box.levels), scramble=False).random_base2(SCANNED)
    return np.asarray(box.low + points * (box.high - box.low))
