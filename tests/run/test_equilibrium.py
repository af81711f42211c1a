"""`start = "equilibrium"` (edp/program/run/equilibrium.idp), and overlaps at the start that are the depth at rest."""

import math

import numpy as np
import pytest

from ffimpact.failure import Failure
from tests.support.slope import ALPHA, DEPTH, GRAVITY, MASS, PENALTY, along, slope
from verification.measure import bodies

FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}
SOFT = {"law": "neohookean", "young": 1e6, "nu": 0.3, "density": 1000, "gravity": GRAVITY, "accuracy": 0.1, "start": "equilibrium"}


def block(width: float, height: float, x: float, y: float, **more) -> dict:
    return {"shape": "rectangle", "width": width, "height": height, "position": [x, y], "mesh_size": 0.0125, "contact_mesh_size": 0.0125} | more


def is_still(run, force: float) -> None:
    """Asserts that nothing moves and that the contact carries `force`, from the first row on."""
    h = run.history
    assert h["normal_force"] == pytest.approx(force, rel=1e-8)
    assert h["kinetic"].max() < 1e-9 * h["elastic"].min() and run.summary["contact_intervals"] == 1
    assert run.summary["momentum_drift"] < 1e-8 and abs(h["balance"]).max() < 1e-9 * h["elastic"].max()


def test_an_elastic_block_rests_under_its_weight(tmp_path):
    """Reaction = weight; with nu = 0 the centre sinks by rho g h^2/(3 E) and the penalty's depth."""
    young, height, penalty = 1e7, 0.05, 1e12
    scene = SOFT | {"young": young, "nu": 0.0, "end_time": 5e-3, "body": [block(0.1, height, 0, height / 2)], "obstacle": [FLOOR], "contact": {"penalty": penalty}}
    run = bodies(tmp_path, scene)
    is_still(run, 1000 * 0.1 * height * GRAVITY)
    stress = 1000 * GRAVITY * height
    sunk = stress * height / (3 * young) + stress / penalty
    assert height / 2 - run.history["y"] == pytest.approx(sunk, rel=1e-4)


@pytest.mark.parametrize("damping", [{"branches": [[3e6, 1e-3]]}, {"viscosity": 100.0}])
def test_a_damped_block_rests_as_an_elastic_one(tmp_path, damping):
    """A relaxing branch is unstrained at rest: the block neither sinks nor rises, and nothing is dissipated."""
    scene = SOFT | {"end_time": 5e-3, "body": [block(0.1, 0.05, 0, 0.025)], "obstacle": [FLOOR], "contact": {"penalty": 1e10}}
    run = bodies(tmp_path, scene | damping)
    is_still(run, 1000 * 0.1 * 0.05 * GRAVITY)
    elastic = bodies(tmp_path, scene | {"end_time": 1e-3})
    assert run.history["y"] == pytest.approx(elastic.history["y"][0], rel=1e-9)
    assert run.summary["viscous_work"] < 1e-9 * run.history["elastic"].min()


def test_a_ball_of_revolution_rests(tmp_path):
    scene = SOFT | {"dimension": "axisymmetric", "end_time": 2e-3, "obstacle": [FLOOR],
                    "body": [{"shape": "ball", "radius": 0.05, "position": 0.05, "mesh_size": 0.015, "contact_mesh_size": 0.006}]}
    run = bodies(tmp_path, scene)
    is_still(run, run.summary["mass"] * GRAVITY)


def test_a_bar_starts_stretched_by_its_load(tmp_path):
    """A load that acts from t = 0 on causes no vibration: the bar has its static length."""
    bar = block(0.1, 0.0125, 0, 0, support=[{"where": "left"}], load=[{"where": "right", "traction": [1e3, 0]}]) | {"mesh_size": 0.006, "contact_mesh_size": 0.006}
    scene = SOFT | {"gravity": 0.0, "nu": 0.0, "end_time": 2e-3, "body": [bar]}
    run = bodies(tmp_path, scene)
    assert run.history["kinetic"].max() < 1e-9 * run.history["elastic"].min()
    assert run.history["x"] == pytest.approx(0.05 * 1e3 / 1e6, rel=2e-3)  # mean of x T/E; large strain: 1e-3
    assert run.history["support_force_x_1"][1:] == pytest.approx(-1e3 * 0.0125, rel=1e-8)


def test_two_blocks_on_each_other(tmp_path):
    scene = SOFT | {"end_time": 1e-3, "obstacle": [FLOOR], "contact": {"friction_static": 0.4},
                    "body": [block(0.1, 0.05, 0, 0.025, name="low"), block(0.06, 0.05, 0, 0.075, name="up")]}
    run = bodies(tmp_path, scene)
    low, up = run.summary["mass_1"] * GRAVITY, run.summary["mass_2"] * GRAVITY
    assert run.history["normal_force"][0] == pytest.approx(low + 2 * up, rel=1e-4)
    assert abs(run.history["force_y_2"][1:] - up).max() < 0.02 * up and run.summary["contact_intervals"] == 1


def test_a_block_creeps_on_a_slope_that_holds_it(tmp_path):
    """tan(alpha) < mu_e: friction carries the block while it creeps at epsilon t_T/(mu_e t_N)."""
    run = bodies(tmp_path, slope(start="equilibrium", end_time=0.1))
    creep, weight = 2e-3 * math.tan(ALPHA) / 0.6, MASS * GRAVITY
    assert run.history["normal_force"] == pytest.approx(weight * math.cos(ALPHA), rel=1e-6)
    assert run.history["friction_force"] == pytest.approx(weight * math.sin(ALPHA), rel=1e-6)
    assert along(run.history, "vx", "vy") == pytest.approx(-creep, rel=1e-5)
    assert np.ptp(along(run.history)) == pytest.approx(creep * 0.1, rel=1e-5)
    assert run.summary["sliding_time"] == 0 and run.summary["momentum_drift"] < 1e-8


def test_what_nothing_holds_is_named(tmp_path):
    """tan(alpha) > mu_e: there is no equilibrium."""
    with pytest.raises(Failure, match=r"exit code 10.*start: no equilibrium: nothing holds body\.1 .*\(accepted: "):
        bodies(tmp_path, slope(start="equilibrium", end_time=0.1, contact={"friction_static": 0.4}))


def test_a_block_slides_on_a_steeper_slope(tmp_path):
    """It starts at the depth at rest, which is accepted, and slides with g (sin a - mu cos a).

    Before, below epsilon, its friction is mu v/epsilon of the normal force.
    """
    run = bodies(tmp_path, slope(-DEPTH, end_time=0.1, contact={"friction_static": 0.4, "friction_dynamic": 0.4}))
    held, epsilon = 0.4 * GRAVITY * math.cos(ALPHA), 2e-3
    fall = GRAVITY * math.sin(ALPHA) - held
    creeps = -epsilon / held * math.log(fall / (fall + held))
    assert -along(run.history, "vx", "vy")[-1] == pytest.approx(epsilon + fall * (0.1 - creeps), rel=5e-3)
    # Friction tilts the block, which oscillates about that tilt.
    assert run.history["normal_force"][1:] == pytest.approx(MASS * GRAVITY * math.cos(ALPHA), rel=0.05)


def test_the_depth_at_rest_on_a_soft_penalty_is_accepted(tmp_path):
    """A hundred times softer, 2 % of the half thickness: the weight is carried from the start on."""
    soft = {"penalty": PENALTY / 100, "friction_dynamic": 0.6}
    run = bodies(tmp_path, slope(-100 * DEPTH, end_time=0.02, contact=soft))
    assert run.history["normal_force"][1] == pytest.approx(MASS * GRAVITY * math.cos(ALPHA), rel=0.03)


def test_deeper_overlaps_are_refused(tmp_path):
    with pytest.raises(Failure, match=r"exit code 10.*overlaps obstacle1 by .* which takes a force of .*\(accepted: "):
        bodies(tmp_path, slope(-3 * DEPTH, end_time=0.1))


def test_a_gas_does_not_excuse_an_overlap(tmp_path):
    """The gas in a ball presses on no obstacle: without weight no overlap is that at rest."""
    ball = {"shape": "ring", "radius": 0.05, "inner_radius": 0.04, "position": [0, 0.05274], "velocity": [0, -0.5],
            "load": [{"where": "inner", "gas": {"gauge_pressure": 5e4, "exponent": 1.4}}]}
    scene = SOFT | {"start": "given", "young": 3e6, "nu": 0.45, "gravity": 0.0, "body": [ball], "obstacle": [FLOOR]}
    with pytest.raises(Failure, match=r"exit code 10.*load\.1\.gas: the gas inflates body1, and body1 overlaps obstacle1 by .*\(accepted: a gap that is "):
        bodies(tmp_path, scene)


def test_the_peak_of_a_support_in_less_than_a_step(tmp_path):
    """A bar that starts stretched by its load pulls at its support, also until the end of half a step."""
    bar = block(0.1, 0.025, 0, 0, support=[{"where": "left"}], load=[{"where": "right", "traction": [1e3, 0]}])
    run = bodies(tmp_path, SOFT | {"gravity": 0.0, "nu": 0.0, "end_time": 1e-6, "body": [bar]})
    assert run.summary["support_peak_1"] == pytest.approx(1e3 * 0.025, rel=1e-6)
