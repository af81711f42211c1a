"""V4 and V8: impacts with exact solutions, run through the whole march of a scene."""

import json
import math

import numpy as np
import pytest

DENSITY, WIDTH, LENGTH = 1722, 2e-3, 0.05
MASS = DENSITY * WIDTH * LENGTH


@pytest.fixture
def impact(measure, tmp_path):
    """impact(name=value, ...) -> (summary, history) of the falling block."""
    def run(**given):
        measure("impact", nu=0, radius=LENGTH, density=DENSITY, out=tmp_path, **given)
        history = np.genfromtxt(tmp_path / "history.csv", delimiter=",", names=True)
        return json.loads((tmp_path / "summary.json").read_text()), history
    return run


def test_bar_on_a_wall(impact):
    """V4: an elastic bar (nu = 0, v << c) stays 2L/c on a stiff plane under the stress rho c v and leaves with its
    speed: within 1 % at 160 elements, and closer than at 40."""
    speed, young = 0.05, 7e6
    c = math.sqrt(young / DENSITY)
    errors = []
    for elements in (40, 160):
        summary, history = impact(speed=speed, young=young, penalty=1e12, mesh_size=LENGTH / elements, dt=LENGTH / elements / c / 2)
        time = summary["contact_time"]
        plateau = (history["t"] > 0.1 * time) & (history["t"] < 0.9 * time)
        force = np.average(history["normal_force"][plateau], weights=history["dt"][plateau])
        errors.append([time * c / (2 * LENGTH) - 1, force / (DENSITY * c * speed * WIDTH) - 1, summary["rebound_vy"] / speed - 1])
    coarse, fine = np.abs(errors)
    assert (fine < 0.01).all(), errors
    assert fine.sum() < coarse.sum(), errors


@pytest.mark.parametrize("exponent", [1, 1.5, 2])
@pytest.mark.parametrize("speed", [1, 2])
def test_rigid_body_on_the_penalty(impact, exponent, speed):
    """V8: a nearly rigid body on F = K d^m goes as deep and stays as long as the closed form, within 1 %."""
    summary, _ = impact(speed=speed, young=1e12, penalty=1e7, exponent=exponent, mesh_size=LENGTH / 4, dt=4e-5)
    stiffness = 1e7 * WIDTH
    depth = ((exponent + 1) * MASS * speed**2 / (2 * stiffness)) ** (1 / (exponent + 1))
    time = 2 * math.sqrt(math.pi) * math.gamma(1 + 1 / (exponent + 1)) / math.gamma(0.5 + 1 / (exponent + 1)) * depth / speed
    assert summary["max_penetration"] == pytest.approx(depth, rel=0.01)
    assert summary["contact_time"] == pytest.approx(time, rel=0.01)
    assert summary["rebound_vy"] == pytest.approx(speed, rel=1e-3)
    if exponent == 1:
        assert time == pytest.approx(math.pi * math.sqrt(MASS / stiffness))   # whatever the speed
