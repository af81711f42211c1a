"""V20, V21: duration of free flights, and a body that strikes with several corners in sequence."""

import math

import pytest

from .scenes import plane, scene

RUBBER = {"young": 7e6, "nu": 0.3, "density": 1722, "law": "neohookean"}


def square(**more) -> dict:
    return {"shape": "rectangle", "width": 0.1, "height": 0.1} | more


@pytest.mark.parametrize("height, gravity, velocity", [(1e4, 9.81, 0), (1e3, 0, -1), (1, 9.81, 10)])
def test_a_flat_face_lands_when_the_closed_form_says(march, height, gravity, velocity):
    """A square that falls far, or is thrown upwards, reaches the floor at its time of flight, to a
    relative error of 1e-9."""
    body = square(position=[0, height + 0.05], velocity=[0, velocity], mesh_size=0.05, contact_mesh_size=0.05)
    time = (velocity + math.sqrt(velocity**2 + 2 * gravity * height)) / gravity if gravity else -height / velocity
    result = march(scene(body, obstacles=(plane(),), gravity=gravity, end_time=time * (1 + 1e-6)))
    assert result.history["t"][1] == pytest.approx(time, rel=1e-9)
    assert result.history["y"][1] == pytest.approx(0.05, abs=1e-9 * height)


@pytest.mark.robustness
def test_a_square_strikes_with_three_corners(march):
    """A square of 0.1 m dropped at 20 degrees with 2 m/s comes into contact repeatedly until it
    rebounds.

    Impulse, rebound and spin agree with a run of 0.06 s at accuracy 0.002. The energy is constant
    to 1e-9, the impulses equal the change of momentum, and their moments about the centre the
    change of spin.
    """
    body = square(position=[0, 0.08], angle=20, velocity=[0, -2])
    result = march(scene(body, obstacles=(plane(),), **RUBBER, accuracy=1.25e-3))
    s, history = result.summary, result.history
    assert s["impulse"] == pytest.approx(55.6, abs=0.6) and s["rebound_vy"] == pytest.approx(1.23, abs=0.03) and s["rebound_spin"] == pytest.approx(-37.9, abs=0.6)
    assert s["contact_intervals"] >= 2 and s["energy_drift"] < 1e-9
    assert s["impulse"] == pytest.approx(history["momentum_y"][-1] - history["momentum_y"][0], rel=1e-9) and abs(history["momentum_x"]).max() < 1e-9 * s["impulse"]
    assert s["angular_momentum_drift"] < 1e-6
