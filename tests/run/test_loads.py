"""Loads: tractions, pressures that follow the surface, and gases in cavities."""

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from tests.support.loads import FLOOR, PUSHED, RADIUS, SOFT, THIN, WALL, assert_exact, energy, thin
from verification.measure import bodies

ROUND = SOFT | {"dimension": "axisymmetric", "end_time": 0.01, "contact": {"friction_static": 0.4}, "obstacle": [FLOOR], "body": [
    {"shape": "cylinder", "radius": 0.04, "height": 0.04, "position": 0.0205, "support": [{"where": "top", "motion": [0, "-0.002*(1-cos(600*t))"]}],
     "load": [{"where": "right", "pressure": "3e4*sin(300*t)"}, {"where": "bottom", "traction": [500, 1e3]}]}]}
SOLID = SOFT | {"dimension": "3d", "end_time": 4e-3, "contact": {"friction_static": 0.4}, "symmetry": "full",
                "obstacle": [{"kind": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]}],
                "body": [{"shape": "box", "width": 0.04, "height": 0.04, "depth": 0.04, "position": [0, 0.0202, 0], "mesh_size": 0.02,
                          "contact_mesh_size": 0.02, "support": [{"where": "top", "motion": [0, "-0.002*(1-cos(900*t))", 0]}],
                          "load": [{"where": "right", "pressure": "3e4*sin(300*t)"}, {"where": "front", "traction": [1e3, 2e3, "1e4*sin(500*t)"]}]}]}


@pytest.mark.parametrize("scene", [PUSHED | {"mesh_size": 0.01, "contact_mesh_size": 0.01}, ROUND, SOLID], ids=["plane", "revolution", "space"])
def test_loads_do_exact_work(tmp_path, scene):
    """Dead and follower loads and a gas, on bodies with supports, motion and friction."""
    run = bodies(tmp_path, scene)
    assert_exact(run)
    summary = run.summary
    assert abs(summary["load_work"]) > 1e-3 * energy(run.history).max() and summary["friction_work"] > 1e-3 * energy(run.history).max()
    assert summary["external_work"] == pytest.approx(summary["support_work"] + summary["load_work"], rel=1e-12)


@pytest.mark.parametrize("dimension", ["plane-strain", "3d"])
def test_a_push_on_a_free_body(tmp_path, dimension):
    """A free block is pushed at the end of one side for a while, then free.

    The momentum is exactly the integral of the dead load and is constant afterwards.
    """
    axes = 3 if dimension == "3d" else 2
    size = {"shape": "box", "width": 0.1, "height": 0.04, "depth": 0.04} if axes == 3 else {"shape": "rectangle", "width": 0.1, "height": 0.04}
    high = {"kind": "box", "low": [-0.06, 0.0, -1][:axes], "high": [-0.04, 0.03, 1][:axes]}
    push = {"where": "left", "traction": [{"t": [0, 2e-3, 4e-3], "x": [0, 1e4, 0], "y": [0, 0, 0], "z": [0, 0, 0]}]}
    push["traction"] = {name: push["traction"][0][name] for name in ["t", *"xyz"[:axes]]}
    load = [push, {"where": high, "pressure": {"t": [0, 1e-3, 4e-3], "p": [0, 5e3, 0]}}]
    run = bodies(tmp_path, SOFT | {"dimension": dimension, "end_time": 6e-3, "dt": 1e-4, "mesh_size": 0.02,
                                   "body": [size | {"position": [0] * axes, "load": load}]} | ({"symmetry": "full"} if axes == 3 else {}))
    history = run.history
    assert_exact(run)
    later = history["t"] > 4e-3 * (1 + 1e-9)
    assert np.ptp(energy(history)[later]) < 1e-9 * energy(history).max() and np.ptp(history["momentum_x"][later]) < 1e-12
    assert np.ptp(history["angular_momentum"][later]) < 1e-8 * abs(history["angular_momentum"]).max() > 0


def test_a_constant_pressure_around_a_body_has_no_resultant(tmp_path):
    """Its work is p times the change of the area to round-off. Momentum and angular momentum stay
    0."""
    block = {"shape": "rectangle", "width": 0.1, "height": 0.06, "position": [0, 0], "mesh_size": 0.02, "load": [{"where": "all", "pressure": 1e5}]}
    run = bodies(tmp_path, SOFT | {"end_time": 0.01, "body": [block]})
    assert_exact(run)
    assert run.summary["load_work"] > 0
    assert abs(run.history["momentum_x"]).max() < 1e-12 and abs(run.history["angular_momentum"]).max() < 1e-12


# ---- gas

def frequency(t: np.ndarray, values: np.ndarray, guess: float) -> float:
    """The angular frequency [rad/s] of the oscillation with its second harmonic that fits the
    values best."""
    def off(frequencies: np.ndarray) -> np.ndarray:
        matrix = np.column_stack([np.ones_like(t), *(turn(k * frequencies[0] * t) for k in (1, 2) for turn in (np.cos, np.sin))])
        return (matrix @ np.linalg.lstsq(matrix, values, rcond=None)[0] - values) / abs(values).max()

    return float(least_squares(off, [guess], x_scale=[guess]).x[0])


AMBIENT, EXPONENT = 1e6, 1.4


@pytest.mark.few(2)
@pytest.mark.parametrize("shape", ["ring", "shell"])
@pytest.mark.parametrize("filled", [False, True], ids=["empty", "gas"])
def test_thin_bodies_breathe_as_membranes(tmp_path, shape, filled):
    """Under a small step of outer pressure with nu = 0, a ring oscillates with omega^2 = E/(rho
    R^2), a spherical shell with twice that.

    A gas at ambient pressure adds its stiffness, n p_a dV/V for each radius. Omega agrees to 1 %.
    """
    ways = 2 if shape == "ring" else 3  # dV/V over dR/R
    load = [{"where": "outer", "pressure": -1e3}]
    squared = THIN["young"] / (THIN["density"] * RADIUS**2) * (ways - 1)
    if filled:
        load.append({"where": "inner", "gas": {"gauge_pressure": 0.0, "ambient_pressure": AMBIENT, "exponent": EXPONENT}})
        squared += ways * EXPONENT * AMBIENT * (1 - WALL / 2 / RADIUS)**(ways - 2) / (THIN["density"] * WALL * RADIUS)
    period = 2 * math.pi / math.sqrt(squared)
    tables = THIN | {"end_time": 2.5 * period, "dt": period / 50, "body": [thin(shape, load)]}
    if shape == "shell":
        tables["dimension"] = "axisymmetric"
    run = bodies(tmp_path, tables)
    assert_exact(run)
    assert frequency(run.history["t"], run.history["elastic"], math.sqrt(squared)) == pytest.approx(math.sqrt(squared), rel=0.01)
    if filled:
        volume = run.history["gas_volume_2"]
        inside = RADIUS - WALL / 2
        assert volume[0] == pytest.approx(math.pi * inside**2 if shape == "ring" else 4 / 3 * math.pi * inside**3, rel=2e-3)
        pressure = AMBIENT * ((volume[0] / volume)**EXPONENT - 1)  # state at the end of a step
        assert np.abs(run.history["gas_pressure_2"] - pressure).max() < 1e-9 * AMBIENT


@pytest.mark.parametrize("shape", [pytest.param("ring", marks=pytest.mark.robustness), "shell"])
def test_more_pressure_makes_a_contact_shorter(tmp_path, shape):
    """A hollow disc, or a hollow ball, falls on a plane: with a stiffer gas it leaves earlier."""
    times, inner = [], {"ring": 0.044, "shell": 0.047}[shape]
    for gauge in (0, 8e3, 2e4):
        tyre = {"shape": shape, "radius": 0.052, "inner_radius": inner, "position": [0, 0.06], "velocity": [0, -1],
                "load": [{"where": "inner", "gas": {"gauge_pressure": gauge, "exponent": 1.4}}]}
        run = bodies(tmp_path / f"{gauge:g}", SOFT | {"accuracy": 0.2, "end_time": 0.0, "body": [tyre], "obstacle": [FLOOR]}
                     | ({"dimension": "axisymmetric"} if shape == "shell" else {}))
        assert_exact(run)
        assert run.summary["load_work"] == pytest.approx(run.history["load_work"][-1], rel=1e-9)
        if shape == "shell":
            assert run.summary["mass"] == pytest.approx(1000 * 4 / 3 * math.pi * (0.052**3 - inner**3), rel=2e-3)
        times.append(run.summary["thresholded_contact_time"])
    assert times[0] > 1.1 * times[1] and times[1] > 1.1 * times[2]


def test_a_gas_stiffer_than_its_shell_is_settled(tmp_path):
    """The outer pressure on a soft ring is as large as Young's modulus. Only the gas resists a
    change of volume."""
    tyre = {"shape": "ring", "radius": 0.05, "inner_radius": 0.03, "position": [0, 0.0525], "velocity": [0, -0.1],
            "load": [{"where": "inner", "gas": {"gauge_pressure": 200.0, "exponent": 1.0}}]}
    soft = {"law": "neohookean", "young": 1e5, "nu": 0.4, "density": 1000.0, "accuracy": 0.1, "end_time": 1e-3}
    run = bodies(tmp_path / "run", soft | {"body": [tyre], "obstacle": [FLOOR]})
    assert_exact(run)
