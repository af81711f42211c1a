"""What repeated measurements say: their middle, how far they scatter, and the errors of both."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["middle", "scatter"]

Array = NDArray[np.float64]
FEW = 20  # values, of fewer the standard deviation is taken
LINE = 6  # values from which on they may follow a line


def middle(values: Array) -> tuple[float, float]:
    """Median of values (n,) and its standard error. Repeats of impacts scatter asymmetrically, since
    roughness makes spin of speed (Montaine and others 2011), so no mean is taken. Of one value the
    error is infinite.
    """
    count = len(values)
    median = float(np.median(values))
    if count < 2:
        return median, math.inf
    spread = 1.4826 * float(np.median(np.abs(values - median)))
    if count < FEW or spread == 0:
        spread = float(np.std(values, ddof=1)) * _wider(count - 1)
    return median, 1.2533 * spread / math.sqrt(count)


def scatter(x: Array, y: Array, errors: Array) -> float:
    """The standard deviation of y (n,) about its mean, or about a line over x if there are enough
    values, beyond their standard errors. Of one value infinite.
    """
    degree = 1 if len(y) >= LINE else 0
    freedom = len(y) - degree - 1
    if freedom < 1:
        return math.inf
    off = y - np.polyval(np.polyfit(x, y, degree), x)
    beyond = float(off @ off) / freedom - float(np.median(errors)) ** 2
    return math.sqrt(max(beyond, 0.0)) * _wider(freedom)


def _wider(freedom: int) -> float:
    """The ends of 95 % of few values over 1.96 standard deviations (Student)."""
    from scipy.stats import t  # takes long to load

    return float(t.ppf(0.975, freedom)) / 1.96
