"""The conserving gap between a body and its own outline (edp/kernels/pairs.cpp), for a randomly
deformed hairpin with closed slot."""

import pytest

ROUND_OFF = 1e-14
CASES = [(2, 0.05, 0.02, 0), (1, 0.2, 0.02, 0.7), (2, 0.3, 0.05, 2.5)]


@pytest.mark.few(2)
@pytest.mark.parametrize("degree, depth, noise, tilt", CASES)
def test_rows_of_a_body_on_itself_conserve(measure, degree, depth, noise, tilt):
    """The rows satisfy B d = q1 - q0 in a random step, a rotation and in sliding; no row
    of B has a resultant force or moment.

    Only points on the walls of the slot are inside the body; none is without deformation. A step
    begins with the penetrations at the end of the last step.
    """
    numbers = measure("self-contact", degree=degree, depth=depth, noise=noise, tilt=tilt)
    assert numbers["randomInside"] > 10 and numbers["outside"] == 0 and numbers["undeformed"] < 0
    for name in ("random", "turn"):
        assert numbers[name + "Exact"] < ROUND_OFF and numbers[name + "Force"] < ROUND_OFF and numbers[name + "Moment"] < ROUND_OFF
    assert numbers["turnChange"] < ROUND_OFF and numbers["slideExact"] < ROUND_OFF and numbers["slideJump"] < ROUND_OFF
