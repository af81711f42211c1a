"""The stress in snapshots, and the energy of a step, against closed forms."""

import numpy as np
import pytest

from verification.stress import LAMBDA, MU, NU, YOUNG, F, assert_stress, cauchy


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("degree", [1, 2])
def test_homogeneous_deformation_has_the_stress_of_the_closed_form(measure, tmp_path, law, degree):
    """Cauchy stress, its von Mises stress and det F of x = F X at every node of the curved half disc, to the file's 9 digits."""
    assert_stress(measure("homogeneous", law=law, degree=degree, young=YOUNG, nu=NU, accuracy=0.1, out=tmp_path), tmp_path, cauchy(law), F)


def longer(numbers: dict, name: str) -> np.ndarray:
    """Components 11, 22, 12, 33 of M or H at the ten points of work-excess.edp, (4, 10), in
    extended precision."""
    return np.array([[numbers[f"{name}{entry}_{i}"] for i in range(10)] for entry in ("11", "22", "12", "33")]).astype(np.longdouble)


def neo(C: np.ndarray) -> np.ndarray:
    """W/mu of (6) for C (4, points)."""
    log = np.log((C[0] * C[1] - C[2] ** 2) * C[3])
    return (C[0] + C[1] + C[3] - 3) / 2 - log / 2 + LAMBDA / MU * log**2 / 8


@pytest.mark.few(4)
@pytest.mark.parametrize("size", [1e-4, 1e-2, 0.2, 0.35])
@pytest.mark.parametrize("body", ["", "-axisymmetric"])
def test_work_of_a_step_against_extended_precision(measure, size, body):
    """Energy and discrete-gradient correction of the neo-Hookean law, for small and large steps.

    They are exact to 13 digits of H times the modulus. A difference of two energies would be exact
    to as many digits of the modulus only.
    """
    numbers = measure(f"work-excess{body}", law="neohookean", young=YOUNG, nu=NU, speed=size)
    M, H = longer(numbers, "M"), longer(numbers, "H")
    det = M[0] * M[1] - M[2] ** 2
    inverse = np.array([M[1] / det, M[0] / det, -M[2] / det, 1 / M[3]])
    # Over mu.
    S = np.array([1, 1, 0, 1])[:, None] * np.longdouble(1) + (LAMBDA / MU * np.log(det * M[3]) / 2 - 1) * inverse
    excess = 2 * (neo(M + H) - neo(M - H) - (S * H * np.array([1, 1, 2, 1])[:, None]).sum(axis=0))
    error = abs(np.array([numbers[f"excess{i}"] for i in range(10)]) - excess)
    assert (error <= 1e-12 * abs(excess) + 3e-14 * abs(H).max(axis=0)).all(), error / abs(H).max(axis=0)
    assert [numbers[f"energy{i}"] for i in range(10)] == pytest.approx(neo(M).astype(float), rel=1e-12, abs=3e-15 * size)
