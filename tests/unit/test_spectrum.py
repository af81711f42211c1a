"""Branches from measured moduli, and the flat loss (ffimpact/spectrum.py, ffimpact/input/damping.py)."""

import subprocess
import sys

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.failure import BadInput, Unreadable
from ffimpact.input.damping import Damping, flat, times_between

FREQUENCY = np.geomspace(0.1, 1e4, 40)     # [Hz]
YOUNG = 5e6                                # relaxed [Pa]


def measured(nu, branches, frequency=FREQUENCY):
    """Moduli of tension from the definitions: K elastic, mu complex."""
    turn, mu, bulk = 2j * np.pi * frequency, YOUNG / (2 * (1 + nu)), YOUNG / (3 * (1 - 2 * nu))
    shear = mu + sum(G * turn * tau / (1 + turn * tau) for G, tau in branches)
    modulus = 1 / (1 / (3 * shear) + 1 / (9 * bulk))
    return np.column_stack([frequency, modulus.real, modulus.imag])


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
def test_branches_at_the_times_of_the_fit_are_found(nu):
    times = times_between(*(2 * np.pi * FREQUENCY[[0, -1]]))
    branches = [[2e6, times[3]], [1e6, times[7]], [3e5, times[8]]]
    spectrum = ff.dma(measured(nu, branches), nu)
    assert spectrum.young == pytest.approx(YOUNG, rel=1e-6) and spectrum.deviation < 1e-6
    found = {time: modulus for modulus, time in spectrum.branches}
    assert all(found.get(time, 0) == pytest.approx(modulus, rel=1e-4) for modulus, time in branches)
    assert spectrum.modulus(FREQUENCY[:2]) == pytest.approx(measured(nu, branches)[:2] @ [0, 1, 1j], rel=1e-6)


def test_a_fractional_power_is_fitted_within_one_percent():
    """Rubber between its plateau and the glass: E* grows with a power of the frequency."""
    modulus = YOUNG * (1 + 0.3 * (2j * np.pi * FREQUENCY * 1e-3) ** 0.3)
    spectrum = ff.dma(np.column_stack([FREQUENCY, modulus.real, modulus.imag]), 0.45)
    assert spectrum.deviation < 0.01 and len(spectrum.branches) > 8
    assert ff.NeoHookean(**spectrum.entries, density=1100).branches == spectrum.branches


def test_temperatures_shift_frequencies(tmp_path):
    """Measured at three temperatures over two decades each, a material gives the branches of all five."""
    c1, c2, reference = 8.86, 101.6, 20.0
    rows = []
    for temperature in (0.0, 20.0, 40.0):
        shift = 10 ** (-c1 * (temperature - reference) / (c2 + temperature - reference))
        at = measured(0.45, [[2e6, 1e-3]], np.geomspace(1, 100, 15) * shift)
        rows += [[f / shift, storage, loss, temperature] for f, storage, loss in at]
    path = tmp_path / "rubber it's.csv"
    path.write_text("temperature, frequency ,Storage,loss\n" + "".join(f"{T},{f},{s},{lost}\n" for f, s, lost, T in rows))
    spectrum = ff.dma(path, 0.45, wlf=(c1, c2, reference))
    assert spectrum.deviation < 0.02 and np.ptp(np.log10(spectrum.frequency)) > 4
    assert ff.dma(path, 0.45).deviation > 0.2   # without the shift nothing fits


@pytest.mark.parametrize("text, options, message", [
    ("frequency,storage\n1,2\n", {}, "has no column loss"),
    ("", {}, "has no column frequency, storage, loss"),
    ("frequency,storage,loss\n1,2\n", {}, "row 1 is '1,2'"),
    ("frequency,storage,loss\n1,2e6,1e5\n2,2e6,nan\n3,3e6,1e5\n", {}, "row 2 is"),
    ("frequency,storage,loss\n1,2e6,1e5\n2,2e6,1e5\n", {}, "2 x 3 numbers .accepted: 3 rows"),
    ("frequency,storage,loss\n1,2e6,1e5\n2,-2e6,1e5\n3,3e6,1e5\n", {}, "row 2 is"),
    ("frequency,storage,loss\n1,2e6,1e5\n2,2e6,1e5\n3,3e6,1e5\n", {"nu": 0.5}, "nu: 0.5 is out of range"),
    ("frequency,storage,loss\n1,2e6,1e5\n2,2e6,1e5\n3,3e6,1e5\n", {"wlf": (8, 100, 20)}, "no column temperature"),
    ("frequency,storage,loss,temperature\n1,2e6,1e5,0\n2,2e6,1e5,0\n3,3e6,1e5,-90\n", {"wlf": (8, 100, 20)}, "temperature: -90 is below"),
    ("frequency,storage,loss\n1,1e6,1e7\n10,1e6,1e7\n100,1e6,1e7\n", {}, "no relaxed modulus fits")])
def test_other_measurements_are_refused(tmp_path, text, options, message):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(BadInput, match=message):
        ff.dma(tmp_path / "a.csv", **{"nu": 0.3} | options)


def test_the_command_prints_entries_and_draws(tmp_path):
    path = tmp_path / "a.csv"
    np.savetxt(path, measured(0.3, [[2e6, 1e-3]]), delimiter=",", header="frequency,storage,loss", comments="")
    shown = subprocess.run([sys.executable, "-m", "ffimpact", "dma", path, "--nu", "0.3", "--figure", tmp_path / "a.png"],
                           capture_output=True, text=True, check=True).stdout
    assert "young = " in shown and "branches = [" in shown and (tmp_path / "a.png").stat().st_size > 1e4
    with pytest.raises(Unreadable, match="cannot be read"):
        ff.dma(tmp_path / "b.csv", 0.3)


@pytest.mark.parametrize("loss", [0.01, 0.1, 0.3])
@pytest.mark.parametrize("ends", [(10, 1000), (1, 1e4)])
def test_a_flat_loss_is_flat(loss, ends):
    """tan delta of the branches, from the complex modulus, is that of the entry within 0.2 %."""
    damping = Damping(branches=flat(loss, *ends).branches(1e6))
    shear = np.array([damping.shear(1e6, 2 * np.pi * f) for f in np.geomspace(*ends, 200)])
    assert abs(shear.imag / shear.real / loss - 1).max() < 2e-3
    assert flat(loss, *ends).deviation == pytest.approx(abs(shear.imag / shear.real / loss - 1).max(), rel=0.1)
    growth = np.diff(np.log10(abs(shear[[0, -1]])))[0] / np.log10(ends[1] / ends[0])
    assert growth == pytest.approx(2 / np.pi * np.arctan(loss), rel=0.03)


def test_long_steps_keep_the_modulus():
    """Steps over a branch's time take its dashpot: the error of the complex modulus falls with the
    square of the step, and is that of longest_step at its step."""
    damping, mu, omega = Damping(branches=[[1e6, 1e-6], [1e6, 1e-3]]), 1e6, 300.0
    exact = damping.shear(mu, omega)
    wrong = [abs(damping.shear_in_steps(mu, omega, dt) - exact) for dt in (2e-4, 1e-4)]
    assert 3.5 < wrong[0] / wrong[1] < 4.5
    dt = damping.longest_step(mu, omega, 1e-3)
    assert 0.8e-3 < abs(damping.shear_in_steps(mu, omega, dt) - exact) / abs(exact) <= 1e-3
