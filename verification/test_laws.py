"""A law with a number of its own, Mooney-Rivlin (edp/core/law/mooney-rivlin.idp), in every dimension: what holds for it holds for any in the list of laws.idp."""

import numpy as np
import pytest

from orchestrate.output import vtu
from verification import test_stress

MOONEY = {"law": "mooney-rivlin", "law_parameters": "0.3"}
SCRIPTS = {"disc-plane": {"accuracy": 0.1}, "ball-axisymmetric": {"accuracy": 0.1}, "ball-plane": {"accuracy": 0.2, "mesh_size": 0.03, "contact_mesh_size": 0.015}}


def test_stress_is_that_of_the_formula(measure, tmp_path):
    """sigma of x = F X is F S F^T/J, S = mu [(1-b) I + b (I1 I - C)] + (l ln J - mu (1+b)) C^-1, l = lambda - 2 b mu, to the file's 9 digits."""
    measure("homogeneous", degree=2, young=test_stress.YOUNG, nu=test_stress.NU, accuracy=0.1, out=tmp_path, **MOONEY)
    F, mu, b = test_stress.F, test_stress.MU, float(MOONEY["law_parameters"])
    C, J, I = F.T @ F, np.linalg.det(F), np.eye(3)
    S = mu * ((1 - b) * I + b * (np.trace(C) * I - C)) + ((test_stress.LAMBDA - 2 * b * mu) * np.log(J) - mu * (1 + b)) * np.linalg.inv(C)
    found, sigma = vtu.read(tmp_path / "homogeneous.vtu").fields["cauchy_stress"], F @ S @ F.T / J
    assert found == pytest.approx(np.tile(sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (len(found), 1)), rel=1e-7)


@pytest.mark.parametrize("body", ["disc", "ball", "3d"])
def test_tangent_is_the_derivative_of_the_residual(measure, body):
    """Moduli D = 2 dS/dC, on curved elements in the plane, of revolution and in space, to 1e-6 of central differences."""
    coarse = {"accuracy": 0.1} if body != "3d" else {"mesh_size": 0.025, "contact_mesh_size": 0.015}
    assert measure(f"tangent-{body}", degree=2, integrator="midpoint", **coarse, **MOONEY)["tangent"] < 1e-6


@pytest.mark.parametrize("script", SCRIPTS)
def test_impact_keeps_the_energy(disc, script):
    """Energy to 1e-9 and momentum to round-off; stiffer than neo-Hookean by less than its share, which without a share it is."""
    runs = {law: disc(script=script, speed=5, nu=0.45, **SCRIPTS[script], **given).summary
            for law, given in {"own": MOONEY, "none": {"law": "mooney-rivlin", "law_parameters": "0"}, "neo-Hookean": {"law": "neohookean"}}.items()}
    assert all(run["energy_drift"] < 1e-9 and run["momentum_drift"] < 1e-12 for run in runs.values())
    assert runs["none"]["impulse"] == pytest.approx(runs["neo-Hookean"]["impulse"], rel=1e-8)
    assert 1e-6 < abs(runs["own"]["contact_time"] / runs["neo-Hookean"]["contact_time"] - 1) < 0.3
