"""Measured curves, and how runs are compared with them. Units are SI.

A curve counts by its coefficients of smooth functions of time, polynomials orthonormal over the measured
times: for a force these are its impulse, duration, asymmetry and so on. Vibrations and the roughness
that elements and steps make are left out, and the noise of many values averages.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..failure import BadInput

__all__ = ["WINDOW", "Array", "Curve", "as_measured", "pulse"]

Array = NDArray[np.float64]
DEGREES = 8  # of the polynomials, from 0 on: one less
POINTS = 96  # largest number of times; of more values the means are taken
MANY = 60  # values of which the neighbours show the noise
WINDOW = 3.0  # a pulse is looked at so many standard deviations around its mean time
ABOVE_NOISE = 4.0  # a pulse is so many times as large as its error
HALF = 0.5  # share of the largest value from which the times of a pulse are first taken
LOW = 0.1  # share below which a pulse is over
ROUNDS = 30  # in which the window of a pulse is found


@dataclass(frozen=True)
class Curve:
    """A measured curve: column `name` of the history, `samples` (n,) at `times` (n,) [s]. Of the column
    at these times, `basis` (m, n) makes the `values` (m,) that are compared, whose errors have the
    covariance `noise` (m, m). `error` is that of one value as it was measured, `scatter` what
    neighbouring values show of it (NaN of few), `common` the relative standard error of the scale.

    The times of a `pulse` count from its mean time, in the run likewise; those of other curves are the
    run's. Of a `marker`, a body and a material point of it from the centre of mass on [m], the samples
    are the ways along the axis `name` since the first time.
    """

    name: str
    times: Array
    samples: Array
    basis: Array
    noise: Array
    error: float
    scatter: float
    common: float = 0.0
    pulse: bool = False
    marker: tuple[int, tuple[float, ...]] | None = None

    @functools.cached_property
    def values(self) -> Array:
        """The coefficients of the curve (m,)."""
        return np.asarray(self.basis @ self.samples)


def as_measured(
    name: str,
    times: Array,
    samples: Array,
    error: float,
    common: float = 0.0,
    *,
    aligned: bool = False,
    marker: tuple[int, tuple[float, ...]] | None = None,
) -> Curve:
    """The curve of samples (n,) at times (n,), each with this standard error; an `aligned` one is a
    pulse. Raises BadInput if a pulse is not whole or not above its noise.
    """
    if aligned:
        centre, width = _whole_pulse(name, times, samples, error)
        near = np.abs(times - centre) < WINDOW * width
        times, samples = times[near] - centre, samples[near]
    if len(times) < 4:
        raise BadInput(f"{name}: {len(times)} values in the pulse (accepted: 4 or more)")
    # third differences of a smooth curve vanish, those of noise have 20 times its variance
    third = np.diff(samples, 3) if len(samples) >= MANY else np.array([np.nan])
    scatter = float(np.sqrt(np.mean(third**2) / 20))
    many = -(-len(times) // POINTS)  # values of which the mean is taken
    count = len(times) // many
    times, samples = (
        column[: count * many].reshape(count, many).mean(axis=1) for column in (times, samples)
    )
    even = 2 * (times - times[0]) / (times[-1] - times[0]) - 1
    columns = np.polynomial.legendre.legvander(even, min(DEGREES, count // 2) - 1)
    if aligned:  # the first coefficient of a pulse is that of its mean time, which is used already
        columns[:, :2] = np.column_stack([times, columns[:, 0]])
    basis = np.linalg.qr(columns)[0].T
    noisy = basis  # (m, n) errors of the values by those of the samples
    if aligned:
        smooth = basis.T @ (basis @ samples)
        basis = basis[1:]
        # the error of the mean time shifts the whole pulse
        late = times * np.gradient(times) / (samples @ np.gradient(times))
        noisy = basis + np.outer(basis @ np.gradient(smooth, times), late)
    elif marker:  # the ways are measured from the first place
        noisy = basis - np.outer(basis.sum(axis=1), np.eye(count)[0])
        samples = samples - samples[0]
    noise = error**2 / many * noisy @ noisy.T
    return Curve(name, times, samples, basis, noise, error, scatter, common, aligned, marker)


def _whole_pulse(name: str, times: Array, samples: Array, error: float) -> tuple[float, float]:
    """Mean time and standard deviation of a measured pulse."""
    largest = float(samples.max())
    if not largest > 2 * ABOVE_NOISE * error:
        raise BadInput(
            f"{name}: is {largest:g} at most, its error is {error:g} (accepted: a curve above its noise)"
        )
    for end, value in (("begins", samples[0]), ("ends", samples[-1])):
        if value > HALF * largest:
            raise BadInput(
                f"{name}: {end} at {value:g}, with {largest:g} at most (accepted: the whole pulse, or start = 'clock')"
            )
    centre, width = pulse(times, samples)
    # beside the largest pulse, within twice its window, there is no other
    near = np.abs(times - centre) < 2 * WINDOW * width
    levels = np.where(samples > HALF * largest, 1, np.where(samples < LOW * largest, -1, 0))[near]
    steps = np.diff(levels[levels != 0])
    if (steps > 0).sum() > 1:
        second = times[near][levels != 0][1:][steps > 0][1]
        raise BadInput(
            f"{name}: rises again at t = {second:g} s (accepted: one impact, the others cut off)"
        )
    return centre, width


def pulse(times: Array, values: Array) -> tuple[float, float]:
    """Mean time and standard deviation of a pulse, the largest of a curve, with the values as weights."""
    step = np.gradient(times)
    centre = float(times[np.argmax(values)])
    width = HALF * float(step[values > HALF * values.max()].sum())
    for _ in range(ROUNDS):
        weights = np.where(np.abs(times - centre) < WINDOW * width, values * step, 0.0)
        centre = float(weights @ times / weights.sum())
        width = float(
            np.sqrt(max(weights @ (times - centre) ** 2 / weights.sum(), step.min() ** 2))
        )
    return centre, width
