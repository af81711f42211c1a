"""The compiled contact (edp/kernels/contact*.hpp) against the scripts that define it."""

import pytest

from tests.support.kernels_contact import JUMPING, STEADY
from verification.measure import measure

DISC = ("kernels-contact", dict(accuracy=0.1))
BALL = ("kernels-contact-3d", dict(mesh_size=0.025, contact_mesh_size=0.015))
# Enough unknowns for the iterative solution.
FINER = ("kernels-contact-3d", dict(mesh_size=0.03, contact_mesh_size=0.0058))
CASES = {"plane": (DISC, {}), "plane-steady": (DISC, STEADY), "plane-jumping": (DISC, JUMPING), "space": (BALL, {}), "space-steady": (BALL, STEADY),
         "space-jumping": (BALL, JUMPING), "many": (FINER, STEADY)}


@pytest.mark.robustness
@pytest.mark.parametrize("case", CASES)
def test_tractions_and_solutions_are_those_of_the_scripts(case):
    """For all laws and positions in the step, tractions and their derivatives agree with the
    scripts to round-off.

    Solutions agree as far as the scripts iterate, and satisfy the equations of the scripts on the
    correct branch of the jump.
    """
    (script, mesh), friction = CASES[case]
    found = measure(script, **mesh, **friction)
    if not found["built"]:
        pytest.skip("no compiler here")
    assert found["unknowns"] > 200 or case != "many"
    assert found["failed"] == found["unsettled"] == 0
    assert found["tractions"] < 1e-12 and found["solution"] < 1e-10 and found["unsolved"] < 1e-10
