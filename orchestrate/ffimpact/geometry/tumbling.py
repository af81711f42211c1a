"""The rotation of a free rigid body, from Euler's equations.

The angular momentum L is constant in space: dR/dt = w x R with w = R J^-1 R^T L, where R is the
rotation matrix, J the matrix of inertia in the body's axes and w the angular velocity [rad/s].
"""

import math
from functools import cached_property, lru_cache

import numpy as np

__all__ = ["fastest", "rotation", "turned"]

# Largest rotation [rad] in a step of the fourth-order Runge-Kutta method; its error is about 1e-9.
STEP = 0.05
# An axis is principal if |w x L| <= PRINCIPAL |w| |L|.
PRINCIPAL = 1e-9


def turned(moments: np.ndarray, start: np.ndarray, spin: np.ndarray, t: float) -> np.ndarray:
    """The rotation matrix (3, 3) of a body at time t >= 0 [s].

    `start` (3, 3) is the matrix and `spin` (3,) [rad/s] the angular velocity at t = 0; `moments`
    (3, 3) is the matrix of inertia in the body's axes, in any unit.
    """
    if _principal(moments, start, spin):
        return rotation(spin * t) @ start
    return _motion(moments.tobytes(), start.tobytes(), spin.tobytes()).at(t)


def fastest(moments: np.ndarray, start: np.ndarray, spin: np.ndarray) -> float:
    """An upper bound of the angular velocity [rad/s] at all times; arguments as of `turned`."""
    if _principal(moments, start, spin):
        return float(np.linalg.norm(spin))
    return float(np.linalg.norm(start @ moments @ start.T @ spin) / np.linalg.eigvalsh(moments)[0])


def rotation(turn: np.ndarray) -> np.ndarray:
    """The matrix (3, 3) of a rotation vector (3,) [rad], by Rodrigues' formula.

    It is exact for multiples of a right angle about a coordinate axis.
    """
    angle = float(np.linalg.norm(turn))
    if angle == 0:
        return np.eye(3)
    K = _cross(turn / angle)
    matrix = np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return np.where(abs(matrix - matrix.round()) < 1e-15, matrix.round(), matrix)


def _cross(w: np.ndarray) -> np.ndarray:
    """The matrix (3, 3) of the cross product: _cross(w) @ x = w x x."""
    x, y, z = w
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def _principal(moments: np.ndarray, start: np.ndarray, spin: np.ndarray) -> bool:
    """Whether the spin is constant: the body does not turn, or turns about a principal axis."""
    momentum = start @ moments @ start.T @ spin
    return bool(
        np.linalg.norm(np.cross(spin, momentum))
        <= PRINCIPAL * np.linalg.norm(spin) * np.linalg.norm(momentum)
    )


class _Motion:
    """The rotation of one body, with the matrices at multiples of the time step.

    The matrices are computed when they are needed. In the body's axes the spin is periodic. After
    each period the body has turned by the same angle about its angular momentum.
    """

    def __init__(self, moments: np.ndarray, start: np.ndarray, spin: np.ndarray):
        self.inverse, self.momentum, self.rotations = (
            np.linalg.inv(moments),
            start @ moments @ start.T @ spin,
            [start],
        )
        self.step, self.period = (
            STEP / fastest(moments, start, spin),
            _period(moments, self.momentum, spin),
        )

    def at(self, t: float) -> np.ndarray:
        periods = int(t / self.period)
        turned_by = rotation(periods * self._turn) if periods else np.eye(3)
        return turned_by @ self._within(t - periods * self.period)

    @cached_property
    def _turn(self) -> np.ndarray:
        """The rotation vector (3,) [rad] of the body over one period."""
        axis, once = (
            self.momentum / np.linalg.norm(self.momentum),
            self._within(self.period) @ self.rotations[0].T,
        )
        sine = (
            axis @ [once[2, 1] - once[1, 2], once[0, 2] - once[2, 0], once[1, 0] - once[0, 1]] / 2
        )
        return math.atan2(sine, (np.trace(once) - 1) / 2) * axis

    def _within(self, t: float) -> np.ndarray:
        whole = int(t / self.step)
        while len(self.rotations) <= whole:
            self.rotations.append(self._next(self.rotations[-1], self.step))
        return self._next(self.rotations[whole], t - whole * self.step)

    def _next(self, R: np.ndarray, dt: float) -> np.ndarray:
        a = self._rate(R)
        b = self._rate(R + dt / 2 * a)
        c = self._rate(R + dt / 2 * b)
        d = self._rate(R + dt * c)
        left_vectors, _, right_vectors = np.linalg.svd(R + dt / 6 * (a + 2 * b + 2 * c + d))
        return (
            left_vectors @ right_vectors
        )  # the rotation that is closest to the result of the step

    def _rate(self, R: np.ndarray) -> np.ndarray:
        return _cross(R @ self.inverse @ R.T @ self.momentum) @ R


def _period(moments: np.ndarray, momentum: np.ndarray, spin: np.ndarray) -> float:
    """The period [s] of the spin in the body's axes: 4 K(m) / p, from Jacobi's elliptic functions.

    Source: Landau and Lifshitz, Mechanics, section 37. The complete elliptic integral K is computed
    by the arithmetic-geometric mean.
    """
    (least, middle, largest), square, energy = (
        np.linalg.eigvalsh(moments),
        momentum @ momentum,
        spin @ momentum,
    )
    if square < energy * middle:
        least, largest = largest, least
    rate = (largest - middle) * (square - energy * least)
    a, b = 1.0, math.sqrt(max(1e-30, 1 - (middle - least) * (energy * largest - square) / rate))
    for _ in range(8):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi / a * math.sqrt(largest * middle * least / rate)


@lru_cache(maxsize=64)
def _motion(*buffers: bytes) -> _Motion:
    moments, start, spin = map(np.frombuffer, buffers)
    return _Motion(moments.reshape(3, 3), start.reshape(3, 3), spin)
