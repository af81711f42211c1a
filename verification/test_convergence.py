"""V1: observed orders of convergence for manufactured motions at large strain in plane strain."""

import math

import pytest

from . import manufactured
from .case import LAWS


def order(coarse: float, fine: float) -> float:
    """The observed order if size or step is halved."""
    return math.log2(coarse / fine)


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("degree", [2, 1])
def test_order_in_space(law, degree):
    """The L2 error of the displacement falls with h^(degree + 1). The error of the step is far
    smaller."""
    coarse, fine = (manufactured.square(law, degree, h) for h in (0.25, 0.125))
    assert order(coarse.error, fine.error) == pytest.approx(fine.order, abs=0.15) and fine.order == degree + 1


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator", manufactured.ORDERS)
def test_order_in_time(integrator, law):
    """For a motion that the elements represent exactly, the error falls with dt^2; for backward
    Euler with dt."""
    steps = (0.0025, 0.00125) if integrator == "backward-euler" else (0.01, 0.005)
    coarse, fine = (manufactured.step(integrator, law, dt) for dt in steps)
    assert order(coarse.error, fine.error) == pytest.approx(fine.order, abs=0.15) and fine.order == (1 if integrator == "backward-euler" else 2)


@pytest.mark.few(1)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", ["disc", "axisymmetric"])
def test_order_in_space_on_the_disc(law, body):
    """Neither the curved outline nor the axis of a ball reduces the order.

    The L2 error of a motion with sines falls with h^3 and the error of the mass with h^4. The error
    on the ball exceeds the error on the disc by at most a twentieth.
    """
    coarse, fine = (manufactured.disc(law, h, body) for h in (0.25, 0.125))
    assert coarse["state"] == fine["state"] == 0 and fine["smallest"] < 0.95
    assert order(coarse["error"], fine["error"]) == pytest.approx(3, abs=0.15) and fine["error"] < 1.05 * manufactured.disc(law, 0.125)["error"]
    assert order(1 - coarse["mass"], 1 - fine["mass"]) == pytest.approx(4, abs=0.15)
