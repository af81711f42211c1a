"""The stress of a homogeneous deformation in closed form, and its comparison with snapshots."""

from pathlib import Path

import numpy as np
import pytest

from ffimpact.output import vtu
from ffimpact.output.fields import write_fields

YOUNG, NU = 7e6, 0.4
LAMBDA, MU = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
F = np.array([[1.2, 0.3, 0], [-0.1, 0.7, 0], [0, 0, 1]])  # as in homogeneous.edp


def cauchy(law: str, F: np.ndarray = F) -> np.ndarray:
    """sigma = F S F^T / J [Pa], (3, 3), for the laws (5) and (6) in three dimensions."""
    C, J = F.T @ F, np.linalg.det(F)
    if law == "svk":
        E = (C - np.eye(3)) / 2
        S = LAMBDA * np.trace(E) * np.eye(3) + 2 * MU * E
    else:
        S = MU * np.eye(3) + (LAMBDA * np.log(J) - MU) * np.linalg.inv(C)
    return F @ S @ F.T / J


def assert_stress(largest: dict, folder: Path, sigma: np.ndarray, F: np.ndarray) -> None:
    """Cauchy stress, its von Mises stress and det F of the state recorded in `folder` are these at every node; von Mises, tension and shear of stress.idp are those of this stress."""
    write_fields(folder)
    fields, principal = vtu.read(folder / "fields/0000.vtu").fields, np.linalg.eigvalsh(sigma)
    mises, count = np.sqrt(((principal - np.roll(principal, 1)) ** 2).sum() / 2), len(fields["jacobian"])
    # xx yy zz xy yz xz
    assert count > 20 and fields["cauchy_stress"] == pytest.approx(np.tile(sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (count, 1)), rel=1e-7)
    assert fields["von_mises"] == pytest.approx(np.full(count, mises), rel=1e-7)
    assert fields["jacobian"] == pytest.approx(np.full(count, np.linalg.det(F)), rel=1e-7)
    assert largest["mises"] == pytest.approx(mises, rel=1e-10)
    assert largest["tension"] == pytest.approx(max(principal[2], 0.0), rel=1e-9) and largest["shear"] == pytest.approx((principal[2] - principal[0]) / 2, rel=1e-9)
