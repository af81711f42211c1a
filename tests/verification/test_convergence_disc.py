"""V1 on the curved outline: the isoparametric elements of the disc lose no order."""

import math

import pytest


@pytest.mark.parametrize("law", ["svk", "neohookean"])
def test_order_in_space_on_the_disc(measure, law):
    """The L2 error of a motion with sines on the disc falls with h^3, the area of the elements with h^4."""
    coarse, fine = (measure("manufactured-disc", law=law, radius=1, young=10, density=1, nu=0.3, mesh_size=h, dt=0.005,
                            end_time=0.025, tolerance=1e-12) for h in (0.25, 0.125))
    assert coarse["state"] == fine["state"] == 0 and fine["smallest"] < 0.95
    assert math.log2(coarse["error"] / fine["error"]) == pytest.approx(3, abs=0.15)
    assert math.log2((1 - coarse["area"]) / (1 - fine["area"])) == pytest.approx(4, abs=0.15)
