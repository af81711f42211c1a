"""The compiled contact (edp/kernels/contact*.hpp) has the tractions of the scripts."""

import pytest

from tests.support.kernels_contact import JUMPING, STEADY
from verification.measure import measure

DISC = ("kernels-contact", dict(accuracy=0.1))
BALL = ("kernels-contact-3d", dict(mesh_size=0.025, contact_mesh_size=0.015))
CASES = {"plane": (DISC, {}), "plane-steady": (DISC, STEADY), "plane-jumping": (DISC, JUMPING), "space": (BALL, {}), "space-steady": (BALL, STEADY),
         "space-jumping": (BALL, JUMPING)}


@pytest.mark.few(2)
@pytest.mark.parametrize("case", CASES)
def test_tractions_are_those_of_the_scripts(case):
    """For all laws and positions in the step, tractions and contact forces agree with the scripts to round-off."""
    (script, mesh), friction = CASES[case]
    numbers = measure(script, **mesh, **friction)
    if not numbers["built"]:
        pytest.skip("no compiler here")
    assert numbers["tractions"] < 1e-12 and numbers["force"] < 1e-12
