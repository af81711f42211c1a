"""Numbers that a run reports beside its history: each is what its meaning says, and an independent
computation gives it again."""

import math

import pytest

from verification.measure import bodies

SOFT = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000, "accuracy": 0.1}
FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}

# ---- the energy to which the balance is relative

# A rigid cylinder under a shell with a gas, both thrown into a bowl: the gas could bring 30 times
# the energy that the bodies have.
RADIUS, OUTER, INNER, SPEED = 0.068, 0.0405, 0.0324, 1.2366
CYLINDER = {"name": "cylinder", "shape": "cylinder", "radius": RADIUS, "height": RADIUS, "position": [0, 0.0451], "rigid": True, "density": 1722,
            "velocity": [0, -SPEED]}
SHELL = {"name": "shell", "shape": "shell", "radius": OUTER, "inner_radius": INNER, "position": [0, 0.1213], "velocity": [0, -SPEED], "young": 3.1e6,
         "nu": 0, "density": 823.8, "load": [{"where": "inner", "gas": {"gauge_pressure": 7517, "exponent": 0}}]}
THROWN = SOFT | {"dimension": "axisymmetric", "integrator": "midpoint", "end_time": 0.02, "body": [CYLINDER, SHELL],
                 "obstacle": [{"kind": "bowl", "centre": [0, 0.6588], "radius": 0.6588}]}


def test_the_balance_is_relative_to_energy_that_is_there(tmp_path):
    """Beside a load energy_drift is relative to the energy of the bodies, here that of the throw,
    not to what the load might have brought."""
    run = bodies(tmp_path, THROWN | {"dt": 1e-4})
    thrown = (1722 * math.pi * RADIUS**3 + 823.8 * 4 / 3 * math.pi * (OUTER**3 - INNER**3)) * SPEED**2 / 2
    gained = abs(run.history["balance"]).max()
    assert gained > 1e-3 * thrown
    assert run.summary["energy_drift"] == pytest.approx(gained / thrown, rel=0.02)   # the gas has strained the shell


def test_without_energy_at_the_start_the_balance_is_relative_to_that_supplied(tmp_path):
    """A block at rest is pressed by a support: largest sum of energies, which round-off leaves."""
    block = {"shape": "rectangle", "width": 0.04, "height": 0.02, "position": [0, 0.0101],
             "support": [{"where": "top", "motion": [0, "-5e-4*(1-cos(2000*t))"]}]}
    run = bodies(tmp_path, SOFT | {"end_time": 2e-3, "integrator": "midpoint", "dt": 2e-5, "obstacle": [FLOOR], "body": [block]})
    energies = run.history["kinetic"] + run.history["elastic"] + run.history["contact"] - run.history["balance"]
    assert run.summary["energy_drift"] == pytest.approx(abs(run.history["balance"]).max() / energies.max(), rel=1e-6)
    assert run.summary["energy_drift"] > 1e-9
