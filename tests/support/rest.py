"""Helpers that the modules test_rest.py share."""

import pytest

RADIUS, YOUNG, NU, DENSITY, GRAVITY, ACCURACY = 0.05, 7e6, 0.4, 1722, 9.81, 0.1
REST = {"law": "neohookean", "nu": NU, "loss": 1, "loss_model": "kelvin-voigt", "gravity": GRAVITY, "until": "rest", "accuracy": ACCURACY}
FALL = REST | {"speed": 0, "height": 0.5, "mesh_size": 0.015, "contact_mesh_size": 0.0005, "penalty": 2e11}


def weight(volume: float) -> float:
    return volume * DENSITY * GRAVITY


def rests(result, force: float) -> None:
    """Asserts that a run ended at rest.

    The contact force equals the weight to the accuracy, momentum is exact, and the balance of all
    energies closes.
    """
    assert result.summary["ended"] == "rest" and result.summary["status"] == "ok"
    assert result.history["normal_force"][-1] == pytest.approx(force, rel=ACCURACY)
    assert result.summary["energy_drift"] < 1e-9 and result.summary["momentum_drift"] < 1e-7
