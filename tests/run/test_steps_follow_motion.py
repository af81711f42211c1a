"""Steps of slow loads and supports, and of stiff bodies beside soft ones, follow the motion."""

import math

import numpy as np
import pytest

from benchmarks import draws
from ffimpact import scene
from ffimpact.running.run import run as run_scene
from verification.measure import bodies

# A clamped strip of length L and height H under a step of gravity g.
LENGTH, HEIGHT, YOUNG, DENSITY, GRAVITY = 0.2, 0.01, 1e6, 1000, 1e-3
STRIP = {"shape": "rectangle", "width": LENGTH, "height": HEIGHT, "position": [LENGTH / 2, 0],
         "support": [{"where": "left", "fix": "all"}]}
LAW = {"law": "neohookean", "gravity": 0.0}
# beta_n L of a clamped beam: cos x cosh x = -1
ROOTS = (1.875104069, 4.694091133, 7.854757438, 10.99554073)


def centre_of_strip(t: np.ndarray) -> np.ndarray:
    """Displacement [m] of the centre of mass of the clamped strip under a step of gravity: the sum
    over the modes of an Euler-Bernoulli beam. Of a mode phi with the largest value 2 at the tip and
    the norm integral phi^2 = L, the mean is 2 s/(beta L), s = (sinh - sin)/(cosh + cos)."""
    y = np.zeros_like(t)
    for x in ROOTS:
        mean = 2 * (math.sinh(x) - math.sin(x)) / (math.cosh(x) + math.cos(x)) / x
        omega = x**2 / LENGTH**2 * math.sqrt(YOUNG * HEIGHT**2 / (12 * DENSITY))
        y -= GRAVITY * mean**2 / omega**2 * (1 - np.cos(omega * t))
    return y


@pytest.mark.parametrize(("accuracy", "most_steps"), [(0.02, 160), (0.005, 260)])
def test_a_slow_motion_takes_some_tens_of_steps_a_period(tmp_path, accuracy, most_steps):
    """Waves cross the strip in 6 ms, its period is 0.78 s: their steps would be thousands. Euler's
    beam has neither shear nor rotary inertia: the period differs by 0.3 %, (h/L)^2 times about 1."""
    run = bodies(tmp_path, {**LAW, "young": YOUNG, "nu": 0.0, "density": DENSITY, "accuracy": accuracy,
                            "gravity": GRAVITY, "end_time": 0.4, "body": [STRIP]})
    t, y = run.history["t"], run.history["y"]
    exact = centre_of_strip(t)
    assert np.abs(y - y[0] - exact).max() <= (accuracy + 0.003) * np.abs(exact).max()
    assert 30 < run.summary["steps"] <= most_steps
    assert run.summary["energy_drift"] < 1e-6


def strike(tmp_path, ratio: float | None, supports=(), **entries):
    """A rubber disc strikes a free block that is `ratio` times as stiff, or a rigid plane."""
    disc = {"name": "disc", "shape": "disc", "radius": 0.02, "young": 5e6, "nu": 0.45, "density": 1100,
            "position": [0, 0.0201], "velocity": [0, -3]}
    content = {**LAW, "accuracy": 0.05, "end_time": 4e-3, "body": [disc], **entries}
    if ratio is None:
        content["obstacle"] = [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]
    else:
        content["body"].append({"name": "block", "shape": "rectangle", "width": 0.12, "height": 0.03, "young": 5e6 * ratio,
                              "nu": 0.3, "density": 1100, "position": [0, -0.015], "support": list(supports)})
    return bodies(tmp_path / f"{ratio}", content)


@pytest.mark.parametrize("held", [False, True])
def test_a_stiff_body_takes_no_more_steps_than_a_rigid_obstacle(tmp_path, held):
    """At most 1.3 times as many, for moduli 100 to 1e5 times as large; and a held block that is
    much stiffer acts like the rigid plane."""
    supports = [{"where": "bottom", "fix": "all"}] if held else []
    rigid = strike(tmp_path, None)
    for ratio in (1e2, 1e5):
        run = strike(tmp_path, ratio, supports)
        assert run.summary["steps"] <= 1.3 * rigid.summary["steps"]
        assert run.summary["energy_drift"] < 1e-6
        if held and ratio > 1e4:
            assert run.summary["impulse"] == pytest.approx(rigid.summary["impulse"], rel=5e-3)


def test_a_strike_after_a_long_rest_is_resolved(tmp_path):
    """A held pad rests under its gravity until a disc falls on it: steps that have grown return to
    those of the impact before the first force, which is the same as without the rest."""
    pad = {"name": "pad", "shape": "rectangle", "width": 0.1, "height": 0.02, "position": [0, -0.01], "young": 2e6, "nu": 0.3,
           "density": 1000, "support": [{"where": "bottom", "fix": "all"}]}
    runs = []
    for wait in (0.002, 0.2):
        disc = {"name": "disc", "shape": "disc", "radius": 0.02, "young": 5e6, "nu": 0.3, "density": 1100,
                "position": [0, 0.02 + 2 * wait], "velocity": [0, -2]}
        shake = {"where": "right", "traction": [{"t": [0, wait / 2, wait], "x": [0, 10, 0]}, 0]}
        runs.append(bodies(tmp_path / f"{wait}", {**LAW, "accuracy": 0.02, "end_time": wait + 8e-3,
                                                  "body": [disc, {**pad, "load": [shake]}]}))
    soon, late = (run.summary for run in runs)
    assert late["steps"] < 1.5 * soon["steps"]
    for answer in ("impulse", "rebound_vy_1", "peak_force"):
        assert late[answer] == pytest.approx(soon[answer], rel=0.01)


def test_pressing_takes_few_steps(tmp_path):
    """A disc between two plates, of which one moves on by a tenth of the radius in a third of a
    second, 3000 transits: contact, sizes and penalty are those of the depth that the plate reaches.
    The force F of either plate follows from delta = F/(pi E*) (2 ln(4 R/b) - 1),
    b^2 = 4 F R/(pi E*), for a disc that is pressed by delta on either side (Johnson 1985, 5.57)."""
    radius, young, nu, depth = 0.02, 4e6, 0.3, 2.5e-4
    run = bodies(tmp_path, {**LAW, "young": young, "nu": nu, "density": 1150, "accuracy": 0.02, "end_time": 0.3,
                            "body": [{"shape": "disc", "radius": radius, "position": [0, radius]}],
                            "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]},
                                         {"kind": "plane", "point": [0, 2 * radius], "normal": [0, -1],
                                          "motion": [0, f"-{2 * depth}*(1-cos(pi*t/0.3))/2"]}]})
    stiffness = young / (1 - nu**2)
    force = 1.0
    for _ in range(60):
        force = depth * math.pi * stiffness / (2 * math.log(4 * radius / math.sqrt(4 * force * radius / (math.pi * stiffness))) - 1)
    last = run.history["t"] > 0.29
    plates = run.history["normal_force"][last]   # both
    assert plates.mean() / 2 == pytest.approx(force, rel=0.04)
    assert run.summary["steps"] < 800 and run.summary["energy_drift"] < 1e-6
    assert not [words for words in run.summary["warnings"] if words.startswith(("not over", "chatter"))]


def test_steps_follow_the_vibration_after_an_impact(tmp_path):
    """A disc leaves a clamped strip, which vibrates on. Its slowest period is 200 transits of the
    disc: no further contact is waited for in steps of an impact."""
    strip = {**STRIP, "young": 5e6, "nu": 0.3, "density": 1000}
    disc = {"shape": "disc", "radius": 0.01, "young": 1e6, "nu": 0.3, "density": 100, "position": [0.1, 0.0151], "velocity": [0, -2]}
    run = bodies(tmp_path, {**LAW, "accuracy": 0.05, "end_time": 0.1, "body": [disc, strip]})
    t, dt = run.history["t"], run.history["dt"]
    during = (run.history["normal_force"] > 0) & (t < t[run.history["normal_force"] > 0][0] + 1e-3)
    assert dt[t > 0.06].mean() > 4 * dt[during].mean()
    assert run.summary["energy_drift"] < 1e-6


def test_no_step_leaps_into_a_contact(tmp_path):
    """A ring flies to a strip whose supports hardly move, in steps in which it would pass through the
    strip. No such step is computed: its contact would take most of the time of the run."""
    grips = [{"where": side, "motion": [f"{sign}1e-5*(1-cos(pi*t/0.1))/2", 0]} for side, sign in (("left", "-"), ("right", ""))]
    strip = {"shape": "rectangle", "width": 0.3, "height": 0.01, "position": [0, 0], "young": 5e7, "nu": 0.3, "density": 100, "support": grips}
    ring = {"shape": "ring", "radius": 0.03, "inner_radius": 0.024, "young": 5e6, "nu": 0.3, "density": 1200,
            "position": [0, 0.235], "velocity": [0, -20]}
    run = bodies(tmp_path, {**LAW, "accuracy": 0.1, "end_time": 0.0106, "body": [ring, strip]})
    first = int((run.history["normal_force"] > 0).argmax())
    assert run.history["dt"][1:first].max() > 2e-3
    assert run.summary["phase_seconds"]["contact"] < 0.4 * run.summary["cpu_seconds"]


def test_bodies_at_rest_on_each_other_are_not_flown(tmp_path):
    """A nail stands on a block until a hammer arrives. Its gap of round-off is closed, which no
    flight of a thousand passes has to show."""
    problem = scene.load(str(draws.OWN / "hammer-nail.toml"))
    summary = run_scene(problem, {"end_time": 1e-5, "accuracy": 0.1}, tmp_path / "run", estimate=False).summary
    assert summary["phase_seconds"]["flight"] < 0.2 * summary["cpu_seconds"]


def test_a_jump_of_the_residual_does_not_shorten_steps(tmp_path):
    """A pad slides on a plate, and its contact points change their facets, where the gap Jacobian
    jumps. Steps that balance but for a jump are accepted; their work stays in the balance."""
    problem = scene.load(str(draws.OWN / "weight-pad-plate.toml"))
    summary = run_scene(problem, {"end_time": 0.003, "accuracy": 0.1}, tmp_path / "run", estimate=False).summary
    assert summary["steps"] < 200 and summary["rejected_steps"] < 0.2 * summary["steps"]
    assert summary["impulse"] == pytest.approx(84.5958, rel=2e-3)   # with 547 steps, of which none ends at a jump
    assert summary["energy_drift"] < 1e-7


def test_slow_pressing_with_friction_takes_few_steps(tmp_path):
    """A finger is moved slowly against a round part. The contact problem of a long step may pass
    states far from its solution."""
    problem = scene.load(str(draws.OWN / "gripper-finger.toml"))
    summary = run_scene(problem, {}, tmp_path / "run", estimate=False).summary
    assert summary["steps"] < 700 and summary["rejected_steps"] < 120
    assert summary["energy_drift"] < 1e-9



@pytest.fixture(scope="module")
def feather_alone(tmp_path_factory):
    return longest_step_in_contact(tmp_path_factory.mktemp("alone"), [])


def longest_step_in_contact(folder, others: list) -> float:
    """The longest step [s] in which a feather of 0.3 g/m, which falls on a held pad, is in contact."""
    pad = {"name": "pad", "shape": "rectangle", "width": 0.1, "height": 0.02, "position": [0, -0.01], "young": 2e6, "nu": 0.3,
           "density": 1000, "support": [{"where": "bottom"}], "mesh_size": 0.01, "contact_mesh_size": 0.004}
    feather = {"name": "feather", "shape": "disc", "radius": 0.01, "young": 1e5, "nu": 0.3, "density": 1.0,
               "position": [0, 0.0101], "velocity": [0, -1], "mesh_size": 0.004, "contact_mesh_size": 0.002}
    history = bodies(folder, {**LAW, "gravity": 9.81, "accuracy": 0.1, "end_time": 0.003, "body": [feather, pad, *others],
                              "obstacle": [{"kind": "plane", "point": [0, -0.03], "normal": [0, 1]}]}).history
    return history["dt"][history["normal_force"] > 0].max()


@pytest.mark.parametrize("mass", [1e-3, 1e8])
def test_a_light_strike_is_resolved_beside_a_heavy_body(tmp_path, feather_alone, mass):
    """Its steps in contact are the same beside a body of any weight, which falls elsewhere."""
    other = {"name": "other", "shape": "disc", "radius": 0.01, "rigid": True, "mass": mass, "position": [0.3, 1.0]}
    assert longest_step_in_contact(tmp_path, [other]) == pytest.approx(feather_alone, rel=1e-6)
