"""V1: observed orders of convergence to manufactured motions at large strain, plane strain."""

import math

import pytest

LAWS = ["svk", "neohookean"]
BODY = dict(young=10, density=1, nu=0.3, radius=1)


def order(coarse: float, fine: float) -> float:
    """Observed order when size or step is halved."""
    return math.log2(coarse / fine)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("degree, sizes, expected", [(2, (0.125, 0.0625), 3), (1, (0.125, 0.0625), 2)])
def test_order_in_space(measure, law, degree, sizes, expected):
    """The L2 error of the displacement falls with h^(degree + 1), at a step whose error is far smaller."""
    errors = [measure("manufactured", law=law, degree=degree, mesh_size=h, dt=0.0025, end_time=0.1, tolerance=1e-12,
                      integrator="energy-momentum", **BODY)["error"] for h in sizes]
    assert order(*errors) == pytest.approx(expected, abs=0.15)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator, expected", [
    ("energy-momentum", 2), ("midpoint", 2), ("newmark", 2), ("bdf2", 2), ("backward-euler", 1)])
def test_order_in_time(measure, law, integrator, expected):
    """For a motion that the elements hold exactly the error falls with dt^2, with dt for backward Euler."""
    steps = (0.0025, 0.00125) if integrator == "backward-euler" else (0.01, 0.005)
    errors = [measure("manufactured", law=law, degree=2, mesh_size=0.5, dt=dt, end_time=0.4, tolerance=1e-13,
                      integrator=integrator, breakdown="continue", **BODY)["error"] for dt in steps]
    assert order(*errors) == pytest.approx(expected, abs=0.15)
