"""Mooney-Rivlin and Ogden laws (edp/program/law) in every dimension, as examples of laws with
parameters of their own."""


import numpy as np
import pytest

from verification import stress
from verification.test_residual_and_tangent import MOONEY, OGDEN

TERMS = ((1.3, 0.5), (5.0, 0.2), (-2.0, 0.3))  # exponents and shares of OGDEN
# entries that make them neo-Hookean
NEOHOOKEAN = {"mooney-rivlin": {"share": 0}, "ogden": {"alpha": (2,), "mu": (7e6 / 2.9,)}}
NU = 0.45
KINDS = {"disc": {"accuracy": 0.1}, "ball-axisymmetric": {"accuracy": 0.1}, "ball": {"accuracy": 0.2, "mesh_size": 0.03, "contact_mesh_size": 0.015}}


def test_stress_is_that_of_the_formula(measure, tmp_path):
    """sigma of x = F X is F S F^T/J to the 9 digits of the file.

    S = mu [(1-b) I + b (I1 I - C)] + (l ln J - mu (1+b)) C^-1 with l = lambda - 2 b mu.
    """
    largest = measure("homogeneous", degree=2, young=stress.YOUNG, nu=stress.NU, accuracy=0.1, out=tmp_path, **MOONEY)
    F, mu, b = stress.F, stress.MU, MOONEY["share"]
    C, J, I = F.T @ F, np.linalg.det(F), np.eye(3)
    S = mu * ((1 - b) * I + b * (np.trace(C) * I - C)) + ((stress.LAMBDA - 2 * b * mu) * np.log(J) - mu * (1 + b)) * np.linalg.inv(C)
    stress.assert_stress(largest, tmp_path, F @ S @ F.T / J, F)


def energy(law: str, L: np.ndarray, nu: float) -> float:
    """W over mu for the principal stretches L."""
    ratio, J = 2 * nu / (1 - 2 * nu), np.prod(L)
    if law == "mooney-rivlin":
        b, I1, I2 = 0.3, np.sum(L**2), np.sum((J / L) ** 2)
        return ((1 - b) * (I1 - 3) + b * (I2 - 3)) / 2 - (1 + b) * np.log(J) + (ratio - 2 * b) / 2 * np.log(J) ** 2
    return sum(2 * s / a**2 * (np.sum(L**a) - 3 - a * np.log(J)) for a, s in TERMS) + ratio / 2 * np.log(J) ** 2


def slope(law: str, stretches, x: float, nu: float) -> float:
    """dW/dx over mu for stretches(x), by differences of eighth order with a step of 0.01."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    return sum(w * (energy(law, stretches(x + 0.01 * k), nu) - energy(law, stretches(x - 0.01 * k), nu)) for k, w in weights.items()) / 0.01


def free(law: str, stretches, nu: float) -> float:
    """The stretch a of free sides, at which W(stretches(a)) is least, by bisection of its slope."""
    low, high = 0.15, 3.0
    for _ in range(60):
        a = (low + high) / 2
        low, high = (low, a) if slope(law, stretches, a, nu) > 0 else (a, high)
    return a


@pytest.mark.parametrize("flags", [MOONEY, OGDEN], ids=lambda flags: flags["law"])
def test_curves_of_tension_and_shear_are_those_of_the_formula(measure, flags):
    """Tension and shear curves agree with derivatives of the energy in principal stretches.

    P = dW/dL with free sides, half of it in equibiaxial tension, and dW/dg in shear agree to 1e-6
    for stretches 0.5 to 2.75 and shears to 2.25; energies to 1e-12. Without deformation (L = 1, g =
    0) there is no stress; equal stretches, two of which are equal in all of tension, give finite
    numbers.
    """
    numbers, law = measure("curves", nu=NU, mesh_size=0.025, contact_mesh_size=0.015, **flags), flags["law"]
    for i in range(10):
        L, g = 0.5 + 0.25 * i, 0.25 * i
        a, b = free(law, lambda x: np.array([L, x, x]), NU), free(law, lambda x: np.array([L, L, x]), NU)
        sheared = lambda x: np.array([np.sqrt(1 + x**2 / 4) + x / 2, np.sqrt(1 + x**2 / 4) - x / 2, 1.0])
        assert numbers[f"uniaxial{i}"] == pytest.approx(slope(law, lambda x: np.array([x, a, a]), L, NU), rel=1e-6, abs=1e-9)
        assert numbers[f"equibiaxial{i}"] == pytest.approx(slope(law, lambda x: np.array([x, x, b]), L, NU) / 2, rel=1e-6, abs=1e-9)
        assert numbers[f"shear{i}"] == pytest.approx(slope(law, sheared, g, NU), rel=1e-6, abs=1e-9)
        assert numbers[f"shearEnergy{i}"] == pytest.approx(energy(law, sheared(g), NU), rel=1e-12, abs=1e-14)
        assert numbers[f"uniaxialEnergy{i}"] == pytest.approx(energy(law, np.array([L, a, a]), NU), rel=1e-6, abs=1e-14)


@pytest.mark.few(2)
@pytest.mark.parametrize("own", [MOONEY, OGDEN], ids=lambda flags: flags["law"])
@pytest.mark.parametrize("kind", KINDS)
def test_impact_keeps_the_energy(disc, kind, own):
    """Energy is constant to 1e-9 and momentum to round-off. Results differ from neo-Hookean, unless
    the parameters make the law neo-Hookean."""
    runs = {law: disc(kind=kind, speed=5, nu=0.45, **KINDS[kind], **flags).summary
            for law, flags in {"own": own, "none": own | NEOHOOKEAN[own["law"]], "neo-Hookean": {"law": "neohookean"}}.items()}
    assert all(run["energy_drift"] < 1e-9 and run["momentum_drift"] < 1e-12 for run in runs.values())
    assert runs["none"]["impulse"] == pytest.approx(runs["neo-Hookean"]["impulse"], rel=1e-8)
    assert 1e-6 < abs(runs["own"]["contact_time"] / runs["neo-Hookean"]["contact_time"] - 1) < 0.3
