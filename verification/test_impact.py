"""V4 and V8: impacts with exact solutions, computed by the whole time integration of a scene."""

import math

import pytest

from ffimpact.output.results import read_summary

from . import impact


def test_bar_on_a_wall(tmp_path):
    """V4: an elastic bar (nu = 0, v << c) is in contact with a stiff plane for 2L/c under the
    stress rho c v and rebounds with its speed.

    The error is below 1 % with 160 elements, and smaller than with 40.
    """
    coarse, fine = ([row.error for row in impact.bar(tmp_path, elements)] for elements in (40, 160))
    assert max(fine) < 0.01, fine
    assert sum(fine) < sum(coarse), (coarse, fine)


@pytest.mark.few(2)
@pytest.mark.parametrize("exponent", [1, 1.5, 2])
@pytest.mark.parametrize("speed", [1, 2])
def test_rigid_body_on_the_penalty(tmp_path, exponent, speed):
    """V8: depth and contact time of a nearly rigid body on F = K d^m agree with the closed form
    within 1 %."""
    rows = {row.what: row for row in impact.rigid(tmp_path, exponent, speed, 4e-5)}
    assert all(row.error < 0.01 for row in rows.values())
    assert read_summary(tmp_path)["rebound_vy"] == pytest.approx(speed, rel=1e-3)
    if exponent == 1:
        # For m = 1 the contact time does not depend on the speed.
        time = math.pi * math.sqrt(impact.DENSITY * impact.LENGTH / 1e7)
        assert rows["m = 1: contact time"].expected == pytest.approx(time)
