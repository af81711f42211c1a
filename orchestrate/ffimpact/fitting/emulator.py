"""Interpolation of the answers of runs over free entries, and the entries of the next runs."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..failure import Failure
from .curves import Array

__all__ = ["Box", "Emulator", "Scales"]

NDBool = NDArray[np.bool_]

LOGARITHMIC = 3.0  # bounds further apart than this ratio are taken logarithmically
DIGITS = 7  # of the value of an entry
DEEPEST = 12  # the finest spacing of nodes is 2^-12 of the bounds
WIDTH = 4  # spacings of nodes across a box, at first
WIDEST = {1: 16, 2: 8, 3: 8}  # by the number of entries; of more entries a box stays as it is
CORNERS = 3  # from so many entries on the nodes in the corners of a box are left out:
FARTHEST = (
    0.75  # those further from its centre, summed over the entries, than this share of its width
)


@dataclass(frozen=True)
class Scales:
    """Free entries and the coordinates, 0 to 1 between their bounds, in which they are varied."""

    bounds: dict[str, tuple[float, float]]

    @property
    def names(self) -> list[str]:
        return list(self.bounds)

    @property
    def logarithmic(self) -> Array:
        """1 for entries whose logarithm is varied (k,)."""
        return np.array(
            [float(low > 0 and high / low > LOGARITHMIC) for low, high in self.bounds.values()]
        )

    def values(self, at: Array) -> Array:
        """The values of entries (..., k) at coordinates (..., k)."""
        low, high = np.array(list(self.bounds.values())).T
        logs = self.logarithmic.astype(bool)
        ratio = np.where(logs, high / np.where(logs, low, 1), 1.0)
        even = np.where(logs, low * ratio**at, low + (high - low) * at)
        return np.asarray(even, dtype=float)

    def entries(self, at: Array) -> dict[str, float]:
        """The entries of the scene at coordinates (k,)."""
        return {
            name: float(f"{value:.{DIGITS}g}") for name, value in zip(self.names, self.values(at))
        }

    def coordinates(self, values: Mapping[str, float]) -> Array:
        """The coordinates (k,) of values of the entries."""
        low, high = np.array(list(self.bounds.values())).T
        own = np.array([values[name] for name in self.names])
        logs = self.logarithmic.astype(bool)
        even: Array = (own - low) / (high - low)
        even[logs] = np.log(own[logs] / low[logs]) / np.log(high[logs] / low[logs])
        return even


@dataclass(frozen=True)
class Box:
    """A box of nodes: for each entry its spacing is 2^-level and it begins at `first` spacings. Boxes
    share nodes, so that runs are shared.
    """

    levels: tuple[int, ...]
    first: tuple[int, ...]
    width: int = WIDTH

    @classmethod
    def whole(cls, count: int) -> Box:
        return cls((2,) * count, (0,) * count)

    def denser(self) -> Box | None:
        """The box with half the spacing, None if its runs were too many."""
        if self.width >= WIDEST.get(len(self.levels), WIDTH):
            return None
        return Box(
            tuple(n + 1 for n in self.levels), tuple(2 * k for k in self.first), 2 * self.width
        )

    @classmethod
    def around(cls, low: Array, high: Array) -> Box:
        """The smallest box that holds the range from `low` to `high` (k,)."""
        levels, first = [], []
        for begin, end in zip(np.clip(low, 0, 1), np.clip(high, 0, 1)):
            for level in range(DEEPEST, 1, -1):
                h = 2.0**-level
                k = int(
                    np.clip(round(((begin + end) / 2 - WIDTH * h / 2) / h), 0, 2**level - WIDTH)
                )
                if k * h <= begin + 1e-12 and (k + WIDTH) * h >= end - 1e-12:
                    break
            levels.append(level)
            first.append(k)
        return cls(tuple(levels), tuple(first))

    @property
    def spacing(self) -> Array:
        return 2.0 ** -np.array(self.levels, dtype=float)

    @property
    def low(self) -> Array:
        return np.array(self.first) * self.spacing

    @property
    def high(self) -> Array:
        return self.low + self.width * self.spacing

    def nodes(self) -> Array:
        """Coordinates of the nodes (n, k)."""
        steps = np.array(list(itertools.product(range(self.width + 1), repeat=len(self.levels))))
        if len(self.levels) >= CORNERS:
            steps = steps[np.abs(steps - self.width // 2).sum(axis=1) <= FARTHEST * self.width]
        return np.asarray(self.low + steps * self.spacing)

    def holds(self, at: Array, margin: float = 0.0) -> NDBool:
        """Whether coordinates (n, k) are in the box, widened by `margin` spacings."""
        more = margin * self.spacing + 1e-9
        return np.asarray(((at >= self.low - more) & (at <= self.high + more)).all(axis=1))


class Emulator:
    """Answers between runs, by cubic radial basis functions on a quadratic trend; of what is positive
    the logarithm is interpolated. `covariance` (m, m) is the mean, over runs inside the box, of the
    products of errors: the interpolation without a run less the run.

    at (n, k): coordinates of the runs; answers (n, f); observe: (p, f) to (p, m).
    """

    def __init__(self, at: Array, answers: Array, box: Box, observe: Callable[[Array], Array]):
        used = box.holds(at, 2.0)
        self.at, self.box, self.observe = (at[used] - box.low) / box.spacing, box, observe
        answers = answers[used]
        count = at.shape[1]
        self.degree = 2 if len(self.at) > (count + 1) * (count + 2) / 2 else 1
        if len(self.at) < count + 2:
            raise Failure(
                f"{len(self.at)} runs near the best values ended (needed: {count + 2}); narrower bounds may help"
            )
        self.logs = (answers > 0).all(axis=0)
        self.columns = np.where(self.logs, np.log(np.where(self.logs, answers, 1.0)), answers)
        self.model = self._fitted(np.ones(len(self.at), dtype=bool))
        wrong = self._left_out()
        self.covariance = wrong.T @ wrong / len(wrong)

    def _fitted(self, used: NDBool) -> Callable[[Array], Array]:
        from scipy.interpolate import RBFInterpolator  # takes long to load

        model: Callable[[Array], Array] = RBFInterpolator(
            self.at[used], self.columns[used], kernel="cubic", degree=self.degree
        )
        return model

    def _observed(self, columns: Array) -> Array:
        return self.observe(np.where(self.logs, np.exp(np.where(self.logs, columns, 0.0)), columns))

    def _left_out(self) -> Array:
        """Interpolation without a run less the run, for runs inside the box (n, m)."""
        inside = np.flatnonzero(((self.at > 0.01) & (self.at < self.box.width - 0.01)).all(axis=1))
        every = np.arange(len(self.at))
        few = inside if len(inside) > 1 else every
        rows = [
            self._observed(self._fitted(every != k)(self.at[k : k + 1]))
            - self._observed(self.columns[k : k + 1])
            for k in few
        ]
        return np.concatenate(rows)

    def __call__(self, at: Array) -> Array:
        """The answers (p, m) at coordinates (p, k)."""
        return self._observed(self.model((at - self.box.low) / self.box.spacing))
