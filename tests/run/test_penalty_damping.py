"""Damping of the penalty (`penalty_damping`, edp/kernels/contact-law.hpp)."""

import math

import numpy as np
import pytest

from tests.support.slope import (
    ALPHA,
    DENSITY,
    DEPTH,
    GRAVITY,
    HEIGHT,
    MASS,
    PENALTY,
    WIDTH,
    along,
    slope,
)
from verification.measure import bodies

FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}


def dropped(speed: float, tau: float, **top) -> dict:
    """A rigid block that strikes a plane flat: a mass on a spring and a dashpot."""
    return {"accuracy": 0.05, "end_time": 2e-3, "obstacle": [FLOOR], "contact": {"penalty": PENALTY, "penalty_damping": tau},
            "body": [{"shape": "rectangle", "width": WIDTH, "height": HEIGHT, "rigid": True, "density": DENSITY, "position": [0, HEIGHT / 2],
                      "velocity": [0, -speed], "mesh_size": 0.01, "contact_mesh_size": 0.01}]} | top


def exact_rebound(speed: float, tau: float, width: float) -> float:
    """Velocity at which a mass leaves a spring k and a dashpot c = tau k that may not pull: there
    k q + c dq/dt = 0. `width` [m] of the contact: corners belong to the sides, too."""
    stiffness = PENALTY * width
    decay, whirl = tau * stiffness / (2 * MASS), math.sqrt(stiffness / MASS)
    omega = math.sqrt(whirl**2 - decay**2)
    # q = v/omega e^(-decay t) sin(omega t), and q + tau dq/dt = 0 at tan(omega t) = -tau omega/(1 - tau decay)
    end = (math.pi - math.atan2(tau * omega, 1 - tau * decay)) / omega
    return -speed * math.exp(-decay * end) * (math.cos(omega * end) - decay / omega * math.sin(omega * end))


# midpoint does not conserve energy in the steps in which contact begins and ends.
@pytest.mark.parametrize("tau, integrator, open_balance", [(5e-5, "energy-momentum", 1e-9), (2e-4, "energy-momentum", 1e-9), (2e-4, "midpoint", 1e-5)])
def test_a_damped_penalty_takes_its_share(tmp_path, tau, integrator, open_balance):
    """Rebound of a damped mass on a spring. The column is what the balance lacks, and never falls."""
    run = bodies(tmp_path, dropped(0.5, tau, dt=5e-6, integrator=integrator))
    h, start = run.history, run.summary["energy_initial"]
    assert h["vy"][-1] == pytest.approx(exact_rebound(0.5, tau, h["contact_size"].max()), rel=2e-3)
    work = h["penalty_damping_work"]
    assert (np.diff(work) >= 0).all() and (h["normal_force"] >= 0).all()
    assert abs(h["balance"]).max() < open_balance * start and run.summary["momentum_drift"] < 1e-9
    assert work[-1] == pytest.approx(start - h["kinetic"][-1] - h["elastic"][-1], rel=10 * open_balance)
    assert run.summary["penalty_damping_work"] == work[-1]
    assert any(note.startswith("penalty damping:") for note in run.summary["notes"])


def test_explicit_steps_count_it_in_their_substeps(tmp_path):
    """An elastic block with friction: the balance is that of Verlet's method without damping."""
    scene = {"law": "neohookean", "young": 1e6, "nu": 0.3, "density": 1000, "accuracy": 0.2, "integrator": "central-difference", "end_time": 4e-3,
             "obstacle": [FLOOR], "contact": {"friction_static": 0.3, "penalty_damping": 2e-4},
             "body": [{"shape": "rectangle", "width": 0.05, "height": 0.05, "position": [0, 0.02501], "velocity": [0.5, -1]}]}
    run = bodies(tmp_path, scene)
    work = run.history["penalty_damping_work"]
    assert (np.diff(work) >= 0).all() and work[-1] > 0.01 * run.summary["energy_initial"]
    assert run.summary["energy_drift"] < 2e-3


def test_a_block_thrown_up_a_slope_stops_and_stays(tmp_path):
    """It slides v^2/(2 g (sin a + mu_d cos a)) up the slope, and from then on creeps.

    Without damping it bounces on its penalty and slips in each flight.
    """
    run = bodies(tmp_path, slope(speed=1.0, accuracy=0.02, end_time=0.3, contact={"penalty_damping": 1e-3}))
    way, speed = along(run.history), along(run.history, "vx", "vy")
    top = int(way.argmax())
    assert way[top] - way[0] == pytest.approx(1 / (2 * GRAVITY * (math.sin(ALPHA) + 0.3 * math.cos(ALPHA))), rel=1e-4)
    creep = 2e-3 * math.tan(ALPHA) / 0.6
    left = run.history["t"][-1] - run.history["t"][top]
    assert way[top] - way[-1] == pytest.approx(creep * left, rel=0.05) and speed[-1] == pytest.approx(-creep, rel=1e-3)
    assert run.summary["contact_intervals"] == 1 and abs(run.history["balance"]).max() < 1e-9 * run.summary["energy_initial"]


def test_a_block_that_bounces_on_its_penalty_is_said_to_slip(tmp_path):
    """The same block on an undamped penalty slides down again; with what the warning advises it
    stays."""
    run = bodies(tmp_path, slope(speed=1.0, accuracy=0.1, end_time=0.3))
    said = [sentence for sentence in run.summary["warnings"] if sentence.startswith("bounces: ")]
    assert along(run.history, "vx", "vy")[-1] < -0.1 and len(said) == 1
    advised = float(said[0].split("penalty_damping = ")[1].split(",")[0])
    damped = bodies(tmp_path, slope(speed=1.0, accuracy=0.1, end_time=0.3, contact={"penalty_damping": advised}))
    assert along(damped.history, "vx", "vy")[-1] == pytest.approx(-2e-3 * math.tan(ALPHA) / 0.6, rel=0.05)
    assert not [sentence for sentence in damped.summary["warnings"] if sentence.startswith("bounces: ")]


def test_the_depth_at_rest_is_that_of_the_penalty(tmp_path):
    """`until = "rest"` accepts the damping as what takes energy."""
    scene = dropped(0.01, 5e-4, gravity=GRAVITY, until="rest", end_time=0.0)
    run = bodies(tmp_path, scene)
    assert run.summary["ended"] == "rest"
    assert run.history["normal_force"][-1] == pytest.approx(MASS * GRAVITY, rel=0.05)
    assert HEIGHT / 2 - run.history["y"][-1] == pytest.approx(DEPTH / math.cos(ALPHA), rel=0.05)


def test_long_steps_do_not_skip_the_stick(tmp_path):
    """A step in which the block would change from sliding up to sliding down is taken smaller."""
    run = bodies(tmp_path, slope(-DEPTH, speed=1.0, end_time=0.25, contact={"penalty_damping": 1e-3}))
    assert along(run.history, "vx", "vy")[-1] == pytest.approx(-2e-3 * math.tan(ALPHA) / 0.6, rel=1e-3)
