"""The stress in the snapshots against closed forms."""

import numpy as np
import pytest

from orchestrate import vtu

YOUNG, NU = 7e6, 0.4
LAMBDA, MU = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
F = np.array([[1.2, 0.3, 0], [-0.1, 0.7, 0], [0, 0, 1]])   # of homogeneous.edp


def cauchy(law: str) -> np.ndarray:
    """sigma = F S F^T / J [Pa], (3, 3), of the laws (5) and (6) in three dimensions."""
    C, J = F.T @ F, np.linalg.det(F)
    if law == "svk":
        E = (C - np.eye(3)) / 2
        S = LAMBDA * np.trace(E) * np.eye(3) + 2 * MU * E
    else:
        S = MU * np.eye(3) + (LAMBDA * np.log(J) - MU) * np.linalg.inv(C)
    return F @ S @ F.T / J


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("degree", [1, 2])
def test_homogeneous_deformation_has_the_stress_of_the_closed_form(measure, tmp_path, law, degree):
    """Cauchy stress, its von Mises stress and det F of x = F X at every node of the curved half disc, to the file's 9 digits."""
    measure("homogeneous", law=law, degree=degree, young=YOUNG, nu=NU, accuracy=0.05, out=tmp_path)
    found, sigma = vtu.read(tmp_path / "homogeneous.vtu").fields, cauchy(law)
    deviator = sigma - np.trace(sigma) / 3 * np.eye(3)
    voigt = sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]   # xx yy zz xy yz xz
    assert found["cauchy_stress"] == pytest.approx(np.tile(voigt, (len(found["jacobian"]), 1)), rel=1e-7)
    assert found["von_mises"] == pytest.approx(np.full(len(found["jacobian"]), np.sqrt(1.5 * (deviator**2).sum())), rel=1e-7)
    assert found["jacobian"] == pytest.approx(np.full(len(found["jacobian"]), np.linalg.det(F)), rel=1e-7)
