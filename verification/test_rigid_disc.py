"""V10: a stiff disc hits the plane obliquely. Expected is the rigid limit with the measured
restitution e."""

import math

import pytest

from .rigid_disc import STIFF, leaves

RADIUS = STIFF["radius"]


def impact(disc, friction: float, angle: float, **flags):
    """The summary of an impact, its initial speeds along and across the plane, and e."""
    summary = disc(**STIFF | dict(penalty=1e10, angle=angle, friction_static=friction, friction_dynamic=friction) | flags).summary
    along, across = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    assert summary["energy_drift"] < 1e-8
    return summary, along, across, summary["rebound_vy"] / across


@pytest.mark.parametrize("law, regularization, friction, angle", [
    ("neohookean", "linear", 0.2, 30), ("svk", "linear", 0.3, 20), ("neohookean", "sqrt", 0.2, 20), ("svk", "tanh", 0.2, 20)])
def test_disc_that_slides_throughout(disc, law, regularization, friction, angle):
    """For v_t/v_n > 3 mu (1 + e) the disc slides throughout, within 3 %.

    It loses mu (1 + e) v_n along the plane and turns forward (clockwise, negative, for a motion to
    +x) with 2 mu (1 + e) v_n / R.
    """
    summary, along, across, e = impact(disc, friction, angle, law=law, regularization=regularization)
    lost = friction * (1 + e) * across / along
    centre, rim = leaves(lost)
    assert 1 > 3.2 * lost
    assert summary["rebound_vx"] / along - 1 == pytest.approx(centre - 1, rel=0.03)
    assert summary["rebound_spin"] == pytest.approx(-rim * along / RADIUS, rel=0.03)
    assert summary["sticking_time"] < 0.03 * summary["contact_time"]


@pytest.mark.few(2)
@pytest.mark.parametrize("law", ["neohookean", "svk"])
@pytest.mark.parametrize("angle", [45, 60, 75])
def test_disc_that_rolls(disc, law, angle):
    """For smaller v_t/v_n the disc leaves rolling, with 2/3 of its speed along the plane and the
    spin of rolling."""
    summary, along, across, e = impact(disc, 0.2, angle, law=law)
    lost = 0.2 * (1 + e) * across / along
    centre, rim = leaves(lost)
    assert 1 < 0.95 * 3 * lost
    assert summary["rebound_vx"] == pytest.approx(centre * along, rel=0.03)
    assert summary["rebound_spin"] == pytest.approx(-rim * along / RADIUS, rel=0.03)
    assert summary["sliding_time"] < 0.9 * summary["contact_time"]


def test_rolling_is_the_limit_of_a_rigid_disc(disc):
    """A disc whose compliance is not small relative to the penalty recoils along the plane and
    leaves, at 60 degrees, with more spin than rolling.

    The difference falls with the stiffness of the penalty to within 0.3 % of rolling.
    """
    slips = []
    for penalty in (1e11, 1e10, 2e9):
        summary, along, _, _ = impact(disc, 0.2, 60, law="neohookean", penalty=penalty)
        slips.append((summary["rebound_vx"] + RADIUS * summary["rebound_spin"]) / along)
    assert slips[0] < -0.01 and abs(slips[0]) > 3 * abs(slips[1]) and abs(slips[2]) < 0.003, slips
