"""Motions and loads that change fast, hold, or end: impulse, work and forces are exact."""

import math

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from ffimpact.__main__ import main
from tests.support.supports import energy
from verification.measure import bodies

RUBBER = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000}
FLOOR = {"kind": "plane", "point": [0, -0.5], "normal": [0, 1]}
BLOCK = {"shape": "rectangle", "width": 0.02, "height": 0.02, "position": [0, 0], "mesh_size": 0.01}
# Largest stress [Pa] and impulse over area [Pa s] of pulses at 1.03 ms.
PULSES = {
    "triangle of 8 us": ("max(0, 1e6*(1 - abs(t - 0.00103)/4e-6))", 4.0),
    "bell of 20 us": ("1e5*exp(-((t - 0.00103)/2e-5)^2)", 2 * np.sqrt(np.pi)),
    "bell of 20 ns": ("1e8*exp(-((t - 0.00103)/2e-8)^2)", 2 * np.sqrt(np.pi)),
}


@pytest.mark.parametrize("dt", [0.0, 2e-4], ids=["adaptive", "given"])
@pytest.mark.parametrize("name", PULSES)
def test_a_pulse_gives_its_impulse(tmp_path, name, dt):
    """A free block at rest has the momentum that the integral of the load gives, and a warning says
    that waves so short are not resolved."""
    traction, impulse = PULSES[name]
    block = BLOCK | {"load": [{"where": "top", "traction": [0, traction]}]}
    run = bodies(tmp_path, RUBBER | {"accuracy": 0.2, "dt": dt, "end_time": 2e-3, "body": [block], "obstacle": [FLOOR]})
    history = run.history
    assert history["momentum_y"][-1] == pytest.approx(0.02 * impulse, rel=1e-6)
    before = history["t"] < 1.03e-3 - max(dt, 1e-4)
    assert before.sum() > 3 and abs(history["momentum_y"][before]).max() < 1e-9 * 0.02 * impulse
    assert abs(history["balance"]).max() < 1e-7 * energy(history).max()
    assert [warning for warning in run.summary["warnings"] if warning.startswith("functions of time: at t = 0.00")]


@pytest.mark.parametrize("t, y", [([0, 2e-4, 4e-4], [0, -4e4, -5e4]), ([1e-4, 2e-4, 4e-4], [-1e4, -4e4, -5e4])])
def test_the_impulse_of_a_table_that_ends_within_a_step(tmp_path, t, y):
    """Without end_time a table may begin and end within steps, where it is constant from there on."""
    block = BLOCK | {"position": [0, -0.486], "velocity": [0, -3], "load": [{"where": "top", "traction": {"t": t, "x": [0, 0, 0], "y": y}}]}
    run = bodies(tmp_path, RUBBER | {"accuracy": 0.3, "dt": 1.7e-4, "body": [block], "obstacle": [FLOOR]})
    h, table = run.history, PchipInterpolator(t, y).antiderivative()
    exact = table(np.clip(h["t"], t[0], t[-1])) - table(t[0]) + y[0] * np.minimum(h["t"], t[0]) + y[-1] * np.maximum(h["t"] - t[-1], 0)
    got = h["momentum_y"] - h["momentum_y"][0] - np.cumsum(h["dt"] * h["normal_force"])
    assert got == pytest.approx(0.02 * exact, abs=1e-9 * 0.02 * abs(exact).max()) and h["t"][-1] > 4e-4


@pytest.mark.parametrize("name", ["press", "yank"])
def test_obstacles_that_hold_move_and_hold_do_exact_work(tmp_path, name):
    """The slope of their tables is 0 at all knots. The balance of energy is closed to 1e-9."""
    if name == "press":
        block = {"shape": "rectangle", "width": 0.2, "height": 0.04, "position": [0, 0], "mesh_size": 0.02, "support": [{"where": "bottom"}]}
        table = {"t": [0, 1e-3, 5e-3, 0.03], "x": [0, 0, 0.002, 0.002], "y": [0, 0, -0.006, -0.006]}
        obstacle = {"kind": "circle", "centre": [0, 0.071], "radius": 0.05, "motion": table}
        tables = {"body": [block], "end_time": 6e-3, "contact": {"friction_static": 0.5}}
    else:
        disc = {"shape": "disc", "radius": 0.05, "position": [0, 0.0501], "velocity": [0, -4], "mesh_size": 0.02}
        table = {"t": [0, 0.002, 0.004, 0.012], "x": [0, 0, 0, 0], "y": [0, 0, -0.01, -0.01]}
        obstacle = {"kind": "plane", "point": [0, 0], "normal": [0, 1], "motion": table}
        tables = {"body": [disc], "end_time": 6e-3}
    run = bodies(tmp_path, RUBBER | {"accuracy": 0.2, "obstacle": [obstacle]} | tables)
    history = run.history
    assert abs(history["external_work"]).max() > 0.02 * energy(history).max()
    assert abs(history["balance"]).max() < 1e-9 * energy(history).max()


def test_a_support_that_moves_with_its_body_needs_no_force(tmp_path):
    """A bar flies at the velocity of its support until the end, without force and stress."""
    bar = {"shape": "rectangle", "width": 0.02, "height": 0.1, "position": [0, 0], "velocity": [0, 1], "mesh_size": 0.01,
           "support": [{"where": "bottom", "motion": [0, "1*t"]}]}
    run = bodies(tmp_path, RUBBER | {"nu": 0.0, "accuracy": 0.2, "end_time": 0.00298807, "body": [bar]})
    stress = 7e6 * 1e-9
    assert abs(run.history["support_force_y_1"]).max() < 0.02 * stress and run.history["elastic"].max() < 1e-15
    assert run.history["vy"] == pytest.approx(1, rel=1e-9)


SPEED = 1000**0.5  # sqrt(E/rho), of waves in the bar [m/s]


def base_force(t: np.ndarray, speed) -> np.ndarray:
    """Force [N/m] at the base of a free bar of 0.1 m by characteristics. `speed` is the velocity of
    the base. Waves return after 2 L/c with the opposite stress and pass the base again.
    """
    force, turn = speed(t), 0.2 / SPEED
    for k in range(1, int(t.max() / turn) + 1):
        force = force + 2 * (-1) ** k * np.where(t >= k * turn, speed(t - k * turn), 0)
    return 1000 * SPEED * 0.02 * force


@pytest.mark.parametrize("end", ["goes on", "stops"])
def test_a_shaken_bar_has_the_forces_of_its_waves(tmp_path, end):
    """The force at the base agrees with characteristics, also in the last steps.

    A table "stops" in full motion, at a kink: the step ends there and the force drops at once.
    """
    omega, bar = 2.5 * math.pi * SPEED / 0.2, {"shape": "rectangle", "width": 0.02, "height": 0.1, "position": [0, 0.05]}
    stop, until = np.pi / omega * 2.5, 0.01
    if end == "goes on":
        motion = [0, f"1e-05*(1-cos({omega!r}*t))"]
    else:
        t = np.linspace(0, stop, 200)
        motion = {"t": t.tolist(), "x": [0.0] * 200, "y": (1e-5 * (1 - np.cos(omega * t))).tolist()}
    bar |= {"support": [{"where": "bottom", "motion": motion}], "mesh_size": 0.01}
    run = bodies(tmp_path, {"law": "neohookean", "young": 1e6, "nu": 0.0, "density": 1000, "accuracy": 0.02, "end_time": until, "body": [bar]})
    history = run.history

    def speed(t):
        return np.where((t > 0) & ((t <= stop) | (end == "goes on")), 1e-5 * omega * np.sin(omega * t), 0)

    t, force = history["t"][1:] - history["dt"][1:] / 2, history["support_force_y_1"][1:]
    exact = base_force(t, speed)
    assert np.sqrt(np.mean((force - exact) ** 2)) < 0.06 * abs(exact).max()
    assert abs(force[-3:] - exact[-3:]).max() < 0.1 * abs(exact).max()
    if end == "stops":
        assert abs(history["t"] - stop).min() < 1e-12 * stop


def test_a_table_in_a_file_is_copied_to_the_results(tmp_path):
    """The scene of the results names the copy, and runs from there with the same history."""
    (tmp_path / "shake.csv").write_text("t,x,y\n0,0,0\n0.001,0,1e-5\n0.002,0,0\n")
    (tmp_path / "scene.toml").write_text(
        'law = "svk"\nyoung = 1e6\nnu = 0.3\ndensity = 1000\naccuracy = 0.3\nend_time = 0.003\n[[body]]\nshape = "rectangle"\n'
        'width = 0.1\nheight = 0.1\nposition = [0, 1]\nmesh_size = 0.05\n[[body.support]]\nwhere = "bottom"\nmotion = "shake.csv"\n')
    assert main(["run", str(tmp_path / "scene.toml"), "--quiet", "--no-figures", "--out", str(tmp_path / "out")]) == 0
    (tmp_path / "shake.csv").unlink()
    (tmp_path / "out").rename(tmp_path / "kept")
    scene = tmp_path / "kept" / "scene.toml"
    assert 'motion = "body-files/body-1-support-1-motion.csv"' in scene.read_text()
    assert main(["run", str(scene), "--quiet", "--no-figures", "--out", str(tmp_path / "again")]) == 0
    kept, again = (np.genfromtxt(tmp_path / name / "history.csv", delimiter=",", names=True) for name in ("kept", "again"))
    assert np.array_equal(kept["support_force_y_1"], again["support_force_y_1"]) and kept["support_work"][-1] > 0


def test_a_belt_takes_a_box_along(tmp_path):
    """A box at rest on a belt that moves under it slides until it has the velocity of the belt.

    While it slides, friction is mu times the normal force, so that vx = mu (g t + vy).
    """
    box = {"shape": "rectangle", "width": 0.1, "height": 0.02, "rigid": True, "mass": 2, "position": [0, 0.01]}
    belt = {"kind": "plane", "point": [0, 0], "normal": [0, 1], "motion": ["0.2*t", 0]}
    run = bodies(tmp_path, {"gravity": 9.81, "end_time": 0.06, "accuracy": 0.05, "body": [box], "obstacle": [belt],
                            "contact": {"friction_static": 0.5, "penalty": 1e7}})
    history = run.history
    sliding = (history["t"] > 5e-3) & (history["t"] < 0.03)
    pushed = 9.81 * history["t"] + history["vy"]
    assert history["vx"][sliding] == pytest.approx(0.5 * pushed[sliding], rel=1e-3)
    assert history["vx"][-1] == pytest.approx(0.2, rel=0.03)  # it rocks
    assert abs(history["balance"]).max() < 1e-9 * (energy(history).max() + history["external_work"].max())
