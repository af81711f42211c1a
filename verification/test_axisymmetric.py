"""V2, V7 and V15 of bodies of revolution: their operators, and the impacts of one ball and of two
balls."""

import math

import pytest

from . import hertz
from .case import LAWS
from .measure import outcome

KEPT = ("energy", "radial", "axial", "even")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("degree", [1, 2])
def test_homogeneous_strain_is_exact(measure, tmp_path, law, degree):
    """F = diag(1.2, 0.7, 1.2) with the radial, axial and circumferential components.

    Stresses, energy and internal forces agree to round-off with those of the volume of the
    elements. A ball that moves along its axis has no internal forces. Volume and mass of curved
    elements agree with the ball.
    """
    numbers = measure("homogeneous-ball", law=law, degree=degree, accuracy=0.02, out=tmp_path)
    assert max(abs(numbers[name]) for name in KEPT) < 1e-12 and numbers["resting"] < 1e-13
    assert numbers["mass"] == pytest.approx(numbers["volume"], rel=1e-4)
    if degree == 2:
        assert numbers["mass"] == pytest.approx(1, rel=2e-4)


def test_impact_of_hertz(tmp_path):
    """Contact time and largest force of a slow ball agree within 2 % and better than those of a
    faster one; the same for two balls."""
    for impact in (hertz.ball, hertz.balls):
        fast, slow = (list(impact(tmp_path / f"{impact.__name__}-{speed:g}", speed)) for speed in (1, 0.01))
        assert all(row.error < 0.02 for row in slow)
        assert all(row.error < before.error for row, before in zip(slow, fast))


@pytest.mark.robustness
def test_two_balls_are_one_on_a_plane(disc, tmp_path):
    """Two balls, each at half the speed, agree with one ball on a plane with twice the penalty,
    since their common tangent plane is at rest."""
    sizes = dict(mesh_size=3e-3, contact_mesh_size=3e-4)
    list(hertz.balls(tmp_path, 1, penalty=2e12, **sizes))
    pair = outcome(tmp_path / "run").summary
    single = disc(kind="ball-axisymmetric", speed=0.5, penalty=4e12, **hertz.BALL, **sizes).summary
    assert pair["contact_time"] == pytest.approx(single["contact_time"], rel=5e-3)
    assert pair["thresholded_contact_time"] == pytest.approx(single["thresholded_contact_time"], rel=1e-3)
    assert pair["impulse"] == pytest.approx(single["impulse"], rel=1e-4)
    assert pair["peak_force"] == pytest.approx(single["peak_force"], rel=2e-3)
    assert pair["rebound_vy_1"] == pytest.approx(single["rebound_vy"], rel=1e-4) and pair["rebound_vy_2"] == pytest.approx(-pair["rebound_vy_1"], rel=1e-9)
    assert pair["momentum_drift"] < 1e-9 and pair["energy_drift"] < 1e-9


@pytest.mark.parametrize("flags", [{"law": "neohookean"}, {"law": "svk", "speed": 3}, {"law": "neohookean", "friction_static": 0.4, "friction_dynamic": 0.2},
                                   {"law": "neohookean", "gravity": 50, "height": 0.01, "exponent": 1.5}, {"law": "neohookean", "degree": 1}], ids=str)
def test_balance_of_energy_and_momentum(disc, flags):
    """The energy balance of kinetic, elastic and contact energy, friction work and work of gravity
    closes to 1e-9 in every step.

    The impulse is the change of momentum.
    """
    result = disc(kind="ball-axisymmetric", accuracy=0.02, **flags)
    summary, history = result.summary, result.history
    assert summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-9
    mass = 2 * summary["energy_initial"] / history["vy"][0] ** 2
    if "height" not in flags:
        assert summary["impulse"] == pytest.approx(mass * (history["vy"][-1] - history["vy"][0]), rel=1e-9)
        assert mass == pytest.approx(4 / 3 * math.pi * 0.05**3 * 1722, rel=0.05 if flags.get("degree") == 1 else 1e-3)
    assert (summary["friction_work"] > 1e-3 * summary["energy_initial"]) == ("friction_static" in flags)
    assert not history["momentum_x"].any() and not history["spin"].any() and not history["friction_force"].any()
