"""Helpers that the modules test_equilibrium.py and test_penalty_damping.py share: a block on a slope."""

import math

GRAVITY, ALPHA, WIDTH, HEIGHT, DENSITY, PENALTY = 9.81, math.radians(25), 0.1, 0.02, 1000.0, 1e8
UP, NORMAL = (math.cos(ALPHA), math.sin(ALPHA)), (-math.sin(ALPHA), math.cos(ALPHA))
MASS = DENSITY * WIDTH * HEIGHT
# Penetration [m] at which the penalty below the whole block carries its weight.
DEPTH = MASS * GRAVITY * math.cos(ALPHA) / (PENALTY * WIDTH)


def slope(gap: float = 0.0, speed: float = 0.0, contact: dict | None = None, **top) -> dict:
    """A rigid block on a slope, `gap` [m] above it, with a speed [m/s] up the slope."""
    return {"gravity": GRAVITY, "accuracy": 0.05, "obstacle": [{"kind": "plane", "point": [0, 0], "normal": list(NORMAL)}],
            "body": [{"shape": "rectangle", "width": WIDTH, "height": HEIGHT, "angle": 25, "rigid": True, "density": DENSITY,
                      "position": [n * (HEIGHT / 2 + gap) for n in NORMAL], "velocity": [speed * e for e in UP],
                      "mesh_size": 0.01, "contact_mesh_size": 0.01}],
            "contact": {"penalty": PENALTY, "friction_static": 0.6, "friction_dynamic": 0.3, "slip_velocity": 2e-3} | (contact or {})} | top


def along(history: dict, x: str = "x", y: str = "y"):
    """The component up the slope of the columns x, y."""
    return history[x] * UP[0] + history[y] * UP[1]
