"""V9: a stiff block on the plane slides to a stop, starts to slide on an incline, and creeps below
that angle."""

import math

import pytest

from . import sliding_block
from .sliding_block import CREEP, GRAVITY, MASS, stop_time, stop_way

BLOCK = sliding_block.BLOCK | dict(slip_velocity=1e-3, dt=1e-3)


@pytest.mark.few(3)
@pytest.mark.parametrize("law, static, dynamic", [
    ("linear", 0.5, 0.5), ("linear", 0.7, 0.5), ("sqrt", 0.7, 0.5), ("tanh", 0.5, 0.5), ("linear-printed", 0.7, 0.5)])
def test_block_slides_to_a_stop(measure, law, static, dynamic):
    """A block with speed v0 stops after v0/(mu_d g) and v0^2/(2 mu_d g); the friction work is then
    1/2 m v0^2."""
    speed = 1
    numbers = measure("sliding-block", speed=speed, angle=0, end_time=0.22, friction_static=static, friction_dynamic=dynamic,
                      regularization=law, **BLOCK)
    assert numbers["state"] == 0
    assert numbers["stop"] == pytest.approx(stop_time(speed, dynamic), rel=0.01)
    assert numbers["distance"] == pytest.approx(stop_way(speed, dynamic), rel=0.01)
    assert numbers["work"] == pytest.approx(MASS * speed**2 / 2, rel=1e-5)
    assert numbers["backwards"] == 0 and numbers["drift"] < 1e-9


@pytest.mark.few(3)
# Expected is the largest friction below slip_velocity: mu_e for linear. sqrt and tanh do not reach
# mu_e, and the printed phi reaches half.
@pytest.mark.parametrize("law, transition, expected", [
    ("linear", "jump", 0.7), ("linear", "smooth", 0.7), ("sqrt", "jump", 0.7 / math.sqrt(2)), ("tanh", "jump", 0.7 * math.tanh(1)),
    ("linear-printed", "jump", 0.4)])
def test_block_starts_to_slide_on_an_incline(measure, law, transition, expected):
    """On a slowly tilted plane the block starts to slide at tan alpha = mu_e phi(slip_velocity),
    which is mu_e for linear (or at mu_d, if that is larger). Its acceleration is then g (sin alpha
    - mu_d cos alpha).

    With a smooth transition friction falls with speed, and a step longer than slip_velocity / g
    (mu_e - mu_d) has several solutions: the step has to be small. With the jump, the block stays at
    rest for any step.
    """
    step = dict(slip_velocity=5e-4, dt=5e-4) if transition == "smooth" else dict(slip_velocity=2e-5, dt=1e-3)
    tilt = math.atan(1.05 * expected)
    numbers = measure("sliding-block", speed=0, angle=math.degrees(tilt), end_time=0.6, friction_static=0.7, friction_dynamic=0.4,
                      regularization=law, friction_transition=transition, **BLOCK | step)
    assert numbers["state"] == 0
    assert numbers["breakaway"] == pytest.approx(expected, rel=0.01)
    assert numbers["pull"] == pytest.approx(GRAVITY * (math.sin(tilt) - 0.4 * math.cos(tilt)), rel=0.01)
    assert numbers["backwards"] == 0 and numbers["drift"] < 1e-9


@pytest.mark.few(3)
@pytest.mark.parametrize("law, share", [("linear", 0.4), ("linear", 0.9), ("sqrt", 0.4), ("sqrt", 0.9), ("tanh", 0.4), ("tanh", 0.9), ("linear-printed", 0.4)])
def test_block_creeps_on_an_incline(measure, law, share):
    """Below tan alpha = mu the block creeps at the speed at which phi of the regularisation is tan
    alpha / mu."""
    numbers = measure("sliding-block", speed=0, angle=math.degrees(math.atan(0.6 * share)), end_time=0.2, friction_static=0.6,
                      friction_dynamic=0.6, regularization=law, **BLOCK)
    assert numbers["state"] == 0
    assert numbers["creep"] == pytest.approx(CREEP[law](share), rel=0.01)
    assert numbers["normal"] == pytest.approx(1, rel=0.01)
    assert numbers["backwards"] == 0 and numbers["drift"] < 1e-9
