"""Helpers that the modules test_loads.py share."""

import numpy as np

FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}
SOFT = {"law": "neohookean", "young": 1e6, "nu": 0.3, "density": 1000, "accuracy": 0.1}
# Mean radius and thickness of thin rings and shells [m].
RADIUS, WALL = 0.05, 0.002
THIN = {"law": "svk", "young": 1e7, "nu": 0.0, "density": 1000, "accuracy": 0.05}


def energy(history: dict) -> np.ndarray:
    """Kinetic, elastic and contact energy."""
    return history["kinetic"] + history["elastic"] + history["contact"]


def assert_exact(run) -> None:
    """Asserts that the energy with all works is balanced to 1e-9 of its largest value, and momenta
    to 1e-8."""
    assert abs(run.history["balance"]).max() < 1e-9 * energy(run.history).max()
    assert run.summary["momentum_drift"] < 1e-8 and (run.summary["angular_momentum_drift"] or 0) < 1e-8


# ---- exactness

PUSHED = SOFT | {"end_time": 0.02, "contact": {"friction_static": 0.4}, "obstacle": [FLOOR], "body": [
    {"name": "pad", "shape": "rectangle", "width": 0.1, "height": 0.05, "position": [0, 0.0255],
     "support": [{"where": "top", "motion": ["0.003*sin(400*t)", "-0.002*(1-cos(600*t))"]}],
     "load": [{"where": "right", "pressure": "2e4*sin(300*t)"}, {"where": "left", "traction": ["1e4*t/0.02", -3e3]}]},
    {"name": "tyre", "shape": "ring", "radius": 0.03, "inner_radius": 0.02, "position": [0.15, 0.0315], "velocity": [1, -3], "spin": 20,
     "load": [{"where": "inner", "gas": {"gauge_pressure": 2e4, "exponent": 1.4}}]}]}


def thin(shape: str, load: list) -> dict:
    """A ring in the plane, or a spherical shell of revolution."""
    return {"shape": shape, "radius": RADIUS + WALL / 2, "inner_radius": RADIUS - WALL / 2, "position": [0, 0], "mesh_size": WALL / 2, "load": load}
