"""The rotation of a free rigid body (edp/kernels/turning.hpp)."""

import ctypes
import math
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from ..failure import NotInstalled
from ..freefem import kernels
from ..freefem.compiled import QUIET, compiled

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
    J, w, R = (np.array(values, dtype=float, order="C") for values in (moments, spin, start))
    _turn()(J.ctypes.data, t, w.ctypes.data, R.ctypes.data)
    # The result is the rotation closest to the solution.
    left_vectors, _, right_vectors = np.linalg.svd(R)
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


@cache
def _turn() -> Callable[[int, float, int, int], None]:
    """The function of edp/kernels/turning.cpp, by which flights turn bodies, too. Arguments: addresses
    of the moments, time [s], addresses of spin and matrix, which it replaces."""
    sources = [kernels.SOURCES / name for name in ("turning.cpp", "turning.hpp")]

    def make(folder: Path) -> None:
        subprocess.run(
            [
                "c++",
                "-O2",
                "-std=c++17",
                "-shared",
                "-fPIC",
                "-o",
                folder / "turning.so",
                sources[0],
            ],
            check=True,
            timeout=60,
            **QUIET,
        )

    library = compiled("turning.so", [source.read_text() for source in sources], make)
    if not library:
        raise NotInstalled(f"the rotation of bodies cannot be compiled; {kernels.HOW}")
    function = ctypes.CDLL(str(library)).ffimpact_turn
    function.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
    function.restype = None
    return function
