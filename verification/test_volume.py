"""V1, V11: nu -> 0.5 beside published and independent solutions (edp/core/law/volume.idp)."""

from math import log2

import pytest

COOK = {"integrator": "backward-euler", "nu": 0.4999, "young": 240.565, "density": 1e-6, "radius": 1, "law": "neohookean", "without": "frozen-factorisation"}
# Of the same equations with P5, P6 / P4, P5 Taylor-Hood elements that are graded towards the corners (NGSolve 6.2.2608): 8.0677 to 8.0684,
# 6.9302 to 6.9304.
TIP = {"small": 8.068, "large": 6.930}


@pytest.mark.parametrize("strains, load, parts", [("small", 6.25e-4, 1), ("large", 6.25, 10)])
def test_cooks_membrane_does_not_lock(measure, strains, load, parts):
    """V11: the tip of Cook's membrane at nu = 0.4999 is within 1 % of its converged place, under a small load and the published one."""
    found = measure("cook", gravity=load, end_time=parts, mesh_size=1 / 32, contact_mesh_size=1 / 32, **COOK)
    assert found["state"] == 0 and found["tip"] * 6.25 / load == pytest.approx(TIP[strains], rel=0.01)


def test_cooks_membrane_locks_without(measure):
    """Beside it plain elements, as large, are stiffer by more than twice as much."""
    errors = [1 - 1e4 * measure("cook", gravity=6.25e-4, end_time=1, mesh_size=1 / 16, contact_mesh_size=1 / 16, volume=volume, **COOK)["tip"] / TIP["small"]
              for volume in ("projected", "plain")]
    assert 0 < 2 * errors[0] < errors[1]


@pytest.mark.parametrize("law, nu", [("neohookean", 0.4999), ("incompressible", 0.5)])
def test_a_manufactured_motion_at_its_order(measure, law, nu):
    """V1: order 2 in the displacement, 1 in the pressure, those of one pressure an element, at nu = 0.4999 and J = 1; at the former as many iterations on
    every mesh, a quarter apart at most, as a small mesh renews its matrix earlier."""
    found = [measure("manufactured-rubber", law=law, nu=nu, mesh_size=h, contact_mesh_size=h, dt=0.0025, end_time=0.05, young=10, density=1, radius=1)
             for h in (1 / 8, 1 / 16, 1 / 32)]
    order = {name: log2(found[0][name] / found[2][name]) / 2 for name in ("error", "off")}
    assert order["error"] > 1.85 and order["off"] > 0.85
    assert law == "incompressible" or max(one["iterations"] for one in found) < 1.25 * min(one["iterations"] for one in found)
