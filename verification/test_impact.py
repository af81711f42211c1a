"""V4 and V8: impacts with exact solutions, run through the whole march of a scene."""

import math

import pytest

from ffimpact.output.results import read_summary

from . import impact


def test_bar_on_a_wall(tmp_path):
    """V4: an elastic bar (nu = 0, v << c) stays 2L/c on a stiff plane under the stress rho c v and leaves with its
    speed: within 1 % at 160 elements, and closer than at 40."""
    coarse, fine = ([row.error for row in impact.bar(tmp_path, elements)] for elements in (40, 160))
    assert max(fine) < 0.01, fine
    assert sum(fine) < sum(coarse), (coarse, fine)


@pytest.mark.few(2)
@pytest.mark.parametrize("exponent", [1, 1.5, 2])
@pytest.mark.parametrize("speed", [1, 2])
def test_rigid_body_on_the_penalty(tmp_path, exponent, speed):
    """V8: a nearly rigid body on F = K d^m goes as deep and stays as long as the closed form, within 1 %."""
    rows = {row.what: row for row in impact.rigid(tmp_path, exponent, speed, 4e-5)}
    assert all(row.error < 0.01 for row in rows.values())
    assert read_summary(tmp_path)["rebound_vy"] == pytest.approx(speed, rel=1e-3)
    if exponent == 1:
        time = math.pi * math.sqrt(impact.DENSITY * impact.LENGTH / 1e7)   # whatever the speed
        assert rows["m = 1: contact time"].expected == pytest.approx(time)
