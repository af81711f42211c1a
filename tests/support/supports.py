"""Helpers that the modules test_supports.py share."""

import numpy as np

FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}
SOFT = {"law": "neohookean", "young": 1e6, "nu": 0.3, "density": 1000, "accuracy": 0.1}


def energy(history: dict) -> np.ndarray:
    """Kinetic, elastic and contact energy."""
    return history["kinetic"] + history["elastic"] + history["contact"]


# ---- exactness

RUBBED = SOFT | {"end_time": 0.02, "contact": {"friction_static": 0.4}, "obstacle": [FLOOR], "body": [
    {"name": "pad", "shape": "rectangle", "width": 0.1, "height": 0.05, "position": [0, 0.0255],
     "support": [{"where": "top", "motion": ["0.003*sin(400*t)", "-0.002*(1-cos(600*t))"]}]},
    {"name": "disc", "shape": "disc", "radius": 0.03, "position": [0.09, 0.0305], "velocity": [-3, -1], "spin": 20}]}
