"""V1: observed orders of convergence to manufactured motions at large strain, plane strain."""

import math

import pytest

from . import manufactured
from .case import LAWS


def order(coarse: float, fine: float) -> float:
    """Observed order when size or step is halved."""
    return math.log2(coarse / fine)


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("degree", [2, 1])
def test_order_in_space(law, degree):
    """The L2 error of the displacement falls with h^(degree + 1), at a step whose error is far smaller."""
    coarse, fine = (manufactured.square(law, degree, h) for h in (0.25, 0.125))
    assert order(coarse.error, fine.error) == pytest.approx(fine.order, abs=0.15) and fine.order == degree + 1


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator", manufactured.ORDERS)
def test_order_in_time(integrator, law):
    """For a motion that the elements hold exactly the error falls with dt^2, with dt for backward Euler."""
    steps = (0.0025, 0.00125) if integrator == "backward-euler" else (0.01, 0.005)
    coarse, fine = (manufactured.step(integrator, law, dt) for dt in steps)
    assert order(coarse.error, fine.error) == pytest.approx(fine.order, abs=0.15) and fine.order == (1 if integrator == "backward-euler" else 2)


@pytest.mark.few(1)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", ["disc", "axisymmetric"])
def test_order_in_space_on_the_disc(law, body):
    """The curved outline loses no order, nor does the axis of a ball: the L2 error of a motion with sines falls with h^3, the mass of the elements with h^4; that of the ball
    is no more than a twentieth above that on the disc."""
    coarse, fine = (manufactured.disc(law, h, body) for h in (0.25, 0.125))
    assert coarse["state"] == fine["state"] == 0 and fine["smallest"] < 0.95
    assert order(coarse["error"], fine["error"]) == pytest.approx(3, abs=0.15) and fine["error"] < 1.05 * manufactured.disc(law, 0.125)["error"]
    assert order(1 - coarse["mass"], 1 - fine["mass"]) == pytest.approx(4, abs=0.15)
