"""Natural modes of the free disc (plane strain; Love 1892, Lamb) and of the free sphere (Lamb 1882)
in closed form.

omega is in units of c_s/R. Displacement of the disc: grad(phi) + curl(psi e_z) with phi = A J_n(h
r) cos(n theta), psi = B J_n(k r) sin(n theta), h = omega/c_p, k = omega/c_s. Spheroidal modes of
the sphere: grad(phi) + curl curl(r psi) with spherical functions; torsional modes: curl(r psi). The
surface is free of traction.
"""

from collections.abc import Callable
from math import pi, sqrt

import numpy as np

# Intervals of the trapezoidal rule, which is exact to round-off for these arguments.
STEPS = 100


def bessel(n: int, x: np.ndarray) -> np.ndarray:
    """J_n(x), by Bessel's integral."""
    tau = (np.arange(STEPS) + 0.5) * pi / STEPS
    return np.cos(n * tau - np.multiply.outer(x, np.sin(tau))).mean(axis=-1)


def spherical(n: int, x: np.ndarray) -> np.ndarray:
    """j_n(x), by upward recurrence from sin(x)/x. n must be small and x > n/2."""
    before, now = np.cos(x) / x, np.sin(x) / x
    for k in range(n):
        before, now = now, (2 * k + 1) / x * now - before
    return now


def wave_ratio(nu: float) -> float:
    """The ratio of wave speeds c_s/c_p."""
    return sqrt((1 - 2 * nu) / (2 * (1 - nu)))


def roots(function: Callable[[np.ndarray], np.ndarray], end: float, start: float = 0.3) -> np.ndarray:
    """Zeros of a smooth function in (start, end), by bisection of its changes of sign."""
    x = np.linspace(start, end, 4000)
    f = function(x)
    at = np.flatnonzero(f[1:] * f[:-1] < 0)
    low, high, sign = x[at], x[at + 1], np.sign(f[at])
    for _ in range(50):
        middle = (low + high) / 2
        same_sign = np.sign(function(middle)) == sign
        low, high = np.where(same_sign, middle, low), np.where(same_sign, high, middle)
    return low


def disc(nu: float, end: float) -> np.ndarray:
    """omega R/c_s of all modes of the disc below `end`, sorted.

    Each mode appears as often as it occurs: twice for n > 0, once for n = 0 and for the torsional
    modes with n = 0.
    """
    ratio, frequencies = wave_ratio(nu), []

    def free(n: int) -> Callable[[np.ndarray], np.ndarray]:
        def determinant(k: np.ndarray) -> np.ndarray:
            h, less = ratio * k, n * n - n - k**2 / 2
            a, b = less * bessel(n, h) + h * bessel(n + 1, h), n * (n - 1) * bessel(n, k) - n * k * bessel(n + 1, k)
            c, d = n * (n - 1) * bessel(n, h) - n * h * bessel(n + 1, h), less * bessel(n, k) + k * bessel(n + 1, k)
            return a * d - b * c
        return determinant
    for n in range(1, int(end) + 3):
        frequencies += [*roots(free(n), end)] * 2
    frequencies += [*roots(lambda k: -k**2 / 2 * bessel(0, ratio * k) + ratio * k * bessel(1, ratio * k), end)]
    frequencies += [*roots(lambda k: bessel(2, k), end)]
    return np.sort(frequencies)


def spheroidal(nu: float, n: int, end: float) -> np.ndarray:
    """omega R/c_s of the spheroidal modes of order n of the sphere below `end`."""
    ratio = wave_ratio(nu)

    def determinant(k: np.ndarray) -> np.ndarray:
        h = ratio * k
        less = n * n - n - k**2 / 2
        # sigma_rr/(2 mu) of phi and of psi at r = 1.
        a = less * spherical(n, h) + 2 * h * spherical(n + 1, h)
        if n == 0:
            return a
        b = n * (n + 1) * ((n - 1) * spherical(n, k) - k * spherical(n + 1, k))
        c = (n - 1) * spherical(n, h) - h * spherical(n + 1, h)  # sigma_rt/(2 mu)
        d = (n * n - 1 - k**2 / 2) * spherical(n, k) + k * spherical(n + 1, k)
        return a * d - b * c
    # At smaller arguments the upward recurrence loses all digits.
    return roots(determinant, end, max(1.0, 0.8 * n))


def torsional(n: int, end: float) -> np.ndarray:
    """omega R/c_s of the torsional modes of order n of the sphere below `end`: (n - 1) j_n(k) = k
    j_{n+1}(k)."""
    return roots(lambda k: (n - 1) * spherical(n, k) - k * spherical(n + 1, k), end, max(1.0, 0.8 * n))
