"""Natural modes of the free disc and ball against Love's and Lamb's closed forms, and their energy
against the vibration energy."""

import math

import numpy as np
import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.report import impacts
from ffimpact.running import run
from verification import measure as runs, modes, solids

NU = 0.3
SLOW = {"law": "neohookean", "nu": NU, "speed": 0.2, "fields": 0}

FINE = {"accuracy": 0.02, "mesh_size": 0.01, "end_time": 1e-5}


def modes_of(tmp_path, name: str, values: dict) -> tuple[pd.DataFrame, run.Record]:
    result = run.run(scene.load(name), SLOW | values, tmp_path / "out", estimate=False)
    return pd.read_csv(result.folder / "modes.csv"), result


def reduced(table: pd.DataFrame) -> np.ndarray:
    """The eigenvalues omega R/c_s of a table of modes."""
    shear = math.sqrt(7e6 / (2 * (1 + NU)) / 1722)
    return 2 * math.pi * table.frequency.to_numpy() * 0.05 / shear


def test_frequencies_of_the_disc(tmp_path):
    """The first twelve modes of the whole disc agree to 0.5 %, with double modes as pairs; the half
    disc has its symmetric modes."""
    frequencies, exact = reduced(modes_of(tmp_path, "disc-normal", FINE | {"symmetry": "full", "modes": 12})[0]), modes.disc(NU, 6)
    assert len(frequencies) == 12 and frequencies == pytest.approx(exact[:12], rel=5e-3)
    half = reduced(modes_of(tmp_path, "disc-normal", FINE | {"modes": 6})[0])
    single = np.unique(exact.round(9))
    assert all(abs(single / frequency - 1).min() < 5e-3 for frequency in half)


def test_frequencies_of_the_ball(tmp_path):
    """The body of revolution has one spheroidal mode of each order, to 0.5 %, and no torsional
    modes; the ball in three dimensions has both."""
    exact = np.sort(np.concatenate([modes.spheroidal(NU, n, 6) for n in range(9)]))
    frequencies = reduced(modes_of(tmp_path, "ball-axisymmetric", FINE | {"modes": 6})[0])
    assert frequencies == pytest.approx(exact[:6], rel=5e-3)
    solid = reduced(modes_of(tmp_path, "ball", {"accuracy": 0.1, "mesh_size": 0.015, "contact_mesh_size": 0.0125, "end_time": 1e-5, "modes": 3})[0])
    every = np.concatenate([exact, *(modes.torsional(n, 6) for n in range(1, 6))])
    assert all(abs(every / frequency - 1).min() < 5e-3 for frequency in solid)


@pytest.mark.parametrize("name, values", [("disc-normal", {}), ("disc-normal", {"direction": -60, "spin": 20, "friction_static": 0.3}), ("ball-axisymmetric", {"speed": 2})], ids=str)
def test_energies_add_up(tmp_path, name, values):
    """After a slow impact the energies of all modes add up to the vibration energy to 1 %, the
    strain energies to that of the law."""
    table, result = modes_of(tmp_path, name, {"accuracy": 0.3, "mesh_size": 0.02, "contact_mesh_size": 0.01, "modes": 500} | values)
    assert table.energy.sum() == pytest.approx(result.summary["vibration_energy"], rel=0.01)
    assert table.strain_energy.sum() == pytest.approx(result.history["elastic"][-1], rel=0.02)
    assert (table.energy >= 0).all() and table.frequency.is_monotonic_increasing


def test_spectrum_of_a_force(tmp_path):
    """The spectrum of a half sine agrees with 2 T/pi cos(pi f T)/|1 - (2 f T)^2|.

    The figure is drawn with the requested number of modes.
    """
    t, period = np.linspace(0, 1, 2001)[1:], 1.0
    f = np.array([0.0, 0.8, 2.3])
    exact = 2 / np.pi * abs(np.cos(np.pi * f * period) / (1 - (2 * f * period) ** 2))
    assert impacts.spectrum(t, np.full(2000, 5e-4), np.sin(np.pi * (t - 2.5e-4)), f) == pytest.approx(exact, rel=1e-5)
    table, result = modes_of(tmp_path, "disc-normal", {"accuracy": 0.3, "modes": 12})
    assert len(impacts.read_modes(result.folder)) == 12 and (figure := impacts.vibration(table, result.history, "/m")) and len(figure.axes) == 2


@pytest.mark.robustness
def test_modes_of_a_body_that_turns_about_any_axis(tmp_path):
    """Modes are computed in axes that rotate with the body.

    To the accuracy of the mesh, a falling ball that spins about x has the same modal energies as
    one that spins about z. They do not exceed its vibration energy. Steps are short: long ones
    leave energy in higher modes than these.
    """
    shares = []
    for name, spin in (("about z", (0, 0, 300)), ("about x", (300, 0, 0))):
        scene = solids.Scene([solids.ball((0, 0, 0), 0.05, 2, shift=(0, 0.051, 0), velocity=(0, -2, 0), spin=spin)], [("plane", (0, 0, 0, 0, 1, 0), (0, 0, 0))])
        folder = tmp_path / name
        folder.mkdir()
        summary = runs.solid_bodies(folder, scene, modes=60, accuracy=0.02).summary
        shares.append(pd.read_csv(folder / "run/modes.csv").energy.sum() / summary["vibration_energy"])
        assert 0.8 < shares[-1] < 1.02, (name, shares)
    assert shares[1] == pytest.approx(shares[0], abs=0.03)
