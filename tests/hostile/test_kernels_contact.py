"""The compiled contact (edp/kernels/contact*.hpp) against the scripts that define it."""

import pytest

from tests.support.kernels_contact import JUMPING, STEADY
from verification.measure import measure

DISC = ("kernels-contact", dict(accuracy=0.1))
BALL = ("kernels-contact-3d", dict(mesh_size=0.025, contact_mesh_size=0.015))
FINER = ("kernels-contact-3d", dict(mesh_size=0.03, contact_mesh_size=0.0058))   # enough unknowns for its iterative solution
CASES = {"plane": (DISC, {}), "plane-steady": (DISC, STEADY), "plane-jumping": (DISC, JUMPING), "space": (BALL, {}), "space-steady": (BALL, STEADY),
         "space-jumping": (BALL, JUMPING), "many": (FINER, STEADY)}


@pytest.mark.robustness
@pytest.mark.parametrize("case", CASES)
def test_tractions_and_solutions_are_those_of_the_scripts(case):
    """Under all laws, anywhere in the step and with springs: tractions and their derivatives to round-off, solutions as far as the scripts take them, and each
    satisfies the scripts' equations on the right side of the jump."""
    (script, mesh), friction = CASES[case]
    found = measure(script, **mesh, **friction)
    if not found["built"]:
        pytest.skip("no compiler here")
    assert found["unknowns"] > 200 or case != "many"
    assert found["failed"] == found["unsettled"] == 0
    assert found["tractions"] < 1e-12 and found["solution"] < 1e-10 and found["unsolved"] < 1e-10
