"""The rotation of a free rigid body, from Euler's equations.

The angular momentum L is constant in space: dR/dt = w x R with w = R J^-1 R^T L, where R is the
rotation matrix, J the matrix of inertia in the body's axes and w the angular velocity [rad/s].
"""

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy.integrate import OdeSolution

__all__ = ["fastest", "rotation", "turned"]

# An axis is principal if |w x L| <= PRINCIPAL |w| |L|.
PRINCIPAL = 1e-9


def turned(moments: np.ndarray, start: np.ndarray, spin: np.ndarray, t: float) -> np.ndarray:
    """The rotation matrix (3, 3) of a body at time t >= 0 [s].

    `start` (3, 3) is the matrix and `spin` (3,) [rad/s] the angular velocity at t = 0; `moments`
    (3, 3) is the matrix of inertia in the body's axes, in any unit.
    """
    if _principal(moments, start, spin):
        turned: np.ndarray = rotation(spin * t) @ start
        return turned
    # Solutions are kept for horizons that double, the first of one radian.
    radian = 1 / fastest(moments, start, spin)
    horizon = radian * 2.0 ** max(0, math.ceil(math.log2(max(t / radian, 1))))
    solution = _solution(moments.tobytes(), start.tobytes(), spin.tobytes(), horizon)
    # The result is the rotation closest to the solution.
    left_vectors, _, right_vectors = np.linalg.svd(solution(t).reshape(3, 3))
    closest: np.ndarray = left_vectors @ right_vectors
    return closest


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
    rounded: np.ndarray = matrix.round()
    return np.where(abs(matrix - rounded) < 1e-15, rounded, matrix)


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


@lru_cache(maxsize=64)
def _solution(moments: bytes, start: bytes, spin: bytes, horizon: float) -> "OdeSolution":
    """The rotation matrix as a function of time from 0 to `horizon` [s], with an error of about
    1e-9 a radian."""
    from scipy.integrate import solve_ivp  # imported here: most scenes need none

    J, R, w = (np.frombuffer(buffer) for buffer in (moments, start, spin))
    inverse = np.linalg.inv(J.reshape(3, 3))
    momentum = R.reshape(3, 3) @ J.reshape(3, 3) @ R.reshape(3, 3).T @ w

    def rate(_: float, entries: np.ndarray) -> np.ndarray:
        R = entries.reshape(3, 3)
        change: np.ndarray = _cross(R @ inverse @ R.T @ momentum) @ R
        return change.ravel()

    solution: OdeSolution = solve_ivp(
        rate, (0, horizon), R, method="DOP853", rtol=1e-10, atol=1e-10, dense_output=True
    ).sol
    return solution
