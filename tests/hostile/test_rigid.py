"""Rigid bodies: exact rigid motions, and the limit of stiff bodies."""

import pytest

from tests.support.rigid import ROLLER, run


@pytest.mark.robustness
def test_a_constant_motion_is_a_velocity(tmp_path):
    """The displacement -2 t gives the results of the velocity -2."""
    drive, _ = run(tmp_path, ROLLER.format('motion = [0, "-2*t"]'), "drive")
    speed, _ = run(tmp_path, ROLLER.format("velocity = [0, -2]"), "speed")
    assert drive["impulse"] == pytest.approx(speed["impulse"], rel=2e-2)


@pytest.mark.robustness
def test_a_circle_that_turns_about_its_centre_only_rubs(tmp_path):
    """The gaps do not change. Friction accelerates the body, in the opposite direction for the
    opposite rotation. The circle slips at 800 m/s, so the work of the residual force is far above the
    energy of the body unless the tolerance is small."""
    both = [run(tmp_path, ROLLER.format(f'motion = [0, "-0.3*t"]\nrotation = "{turn}*t"'), name, tolerance=1e-12)[0]
            for name, turn in (("left", 20000), ("right", -20000))]
    assert both[0]["rebound_vx"] == pytest.approx(-both[1]["rebound_vx"], rel=0.05) and abs(both[0]["rebound_vx"]) > 1e-3
    assert max(summary["energy_drift"] for summary in both) < 1e-9
