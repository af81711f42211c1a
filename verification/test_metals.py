"""Metals against exact solutions (verification/metals.py), and their steps and states in runs."""

import numpy as np
import pytest

from . import metals


def errors(rows) -> dict[str, float]:
    return {row.what: row.error for row in rows}


def test_pulled_bar(tmp_path):
    """Strain, work and plastic work are exact to 1e-4, and the balance to 1e-10."""
    found = errors(metals.uniaxial(tmp_path, 100))
    assert found.pop("1 + balance") < 1e-10
    assert max(found.values()) < 1e-4


def test_sheared_layer(tmp_path):
    """The shear stress is sigma_y/sqrt(3); what the free ends lack falls with the width."""
    narrow, wide = (metals.sheared_layer(tmp_path / str(n), n) for n in (10, 20))
    assert 0.98 < narrow < wide < 1
    assert 2 * wide - narrow == pytest.approx(1, abs=1e-3)


RATE = 0.1 * np.pi / 0.01 / 1.1   # of the logarithmic stretch at half the way [1/s]


@pytest.mark.parametrize("yields, stress", [
    ({"yield_stress": 400e6, "voce": [200e6, 15]}, lambda p: 400e6 - 200e6 * np.expm1(-15 * p)),
    ({"yield_curve": [[0, 400e6], [0.05, 500e6], [0.1, 550e6]]}, lambda p: np.interp(p, [0, 0.05, 0.1], [400e6, 500e6, 550e6])),
    ({"yield_stress": 400e6, "perzyna": [100, 2]}, lambda p: 400e6 * (1 + np.sqrt(RATE / 100))),
    ({"yield_stress": 400e6, "johnson_cook": [0.05, 1]}, lambda p: 400e6 * (1 + 0.05 * np.log(RATE))),
], ids=["voce", "curve", "perzyna", "johnson_cook"])
def test_hardening_and_rates(tmp_path, yields, stress):
    """At half the way the force of a pulled bar is sigma_y(p) r(rate) over the stretch, to 0.1 %."""
    history = metals.pulled_bar(tmp_path, 200, **yields).history
    middle = history["t"] - history["dt"] / 2
    k = int(np.argmin(abs(middle - 0.005)))
    stretch = 1.1 - 0.1 * np.cos(np.pi * middle[k] / 0.01)
    p = 0.0
    for _ in range(50):
        p = np.log(stretch) - stress(p) / metals.E
    assert history["support_force_y_2"][k] == pytest.approx(stress(p) * np.pi * 0.005**2 / stretch, rel=1e-3)


def test_shell_under_pressure(tmp_path):
    """Second order; with 8 elements across the wall 1 %, unloaded 2.5 %."""
    coarse, fine = (errors(metals.shell(tmp_path / str(n), n)) for n in (4, 8))
    assert coarse.pop("1 + balance") < 1e-9 and fine.pop("1 + balance") < 1e-9
    assert all(fine[name] < 0.3 * coarse[name] for name in fine)
    assert fine["inner surface"] < 0.01 and fine["outer surface"] < 0.01 and fine["outer surface, unloaded"] < 0.025


@pytest.mark.parametrize("case, coarse, fine, accepted", [(metals.plate, 20, 80, 0.007), (metals.slender_bar, 1, 2, 0.006)])
def test_waves(tmp_path, case, coarse, fine, accepted):
    """The stress on the wall converges to that behind the elastic and the plastic wave."""
    first, last = (errors(case(tmp_path / str(n), n)) for n in (coarse, fine))
    assert last["1 + balance"] < 1e-9
    assert last["stress on the wall"] < min(accepted, 0.7 * first["stress on the wall"])


def test_first_yield_of_a_ball(tmp_path):
    """A ball first yields at p0 = 1.6 sigma_y (nu = 0.3), below its surface."""
    first = 1e9
    below, above = (metals.ball(tmp_path / str(p), metals.yield_speed(first, p), first, accuracy=1e-3).summary for p in (1.5, 1.7))
    assert below["plastic_work"] == 0 and below["restitution"] > 0.995
    assert above["plastic_work"] > 0
    assert below["max_pressure"] == pytest.approx(1.5e9, rel=0.02)
    depth = metals.E / (1 - metals.NU**2)
    a = np.pi * 1.7 * first * 0.005 / (2 * depth)   # Hertz's contact radius
    assert -0.005 + 0.3 * a < above["max_von_mises_y"] < -0.005 + 0.7 * a


@pytest.mark.few(1)
@pytest.mark.parametrize("integrator", ["energy-momentum", "midpoint", "central-difference", "bdf2"])
def test_integrators_agree(tmp_path, integrator):
    """Restitution of a ball at 20 m/s by all integrators to 1 %; the balance of energy-momentum steps to 1e-9."""
    fine = metals.ball(tmp_path / "fine", 20, 1e9, end_time=2.2e-5, dt=2e-8).summary
    run = metals.ball(tmp_path / "run", 20, 1e9, integrator=integrator, dt=4e-8, end_time=2.2e-5).summary
    assert run["restitution"] == pytest.approx(fine["restitution"], abs=0.005)
    assert run["energy_drift"] < (1e-9 if integrator == "energy-momentum" else 2e-3)


def test_locked_in_stress_does_not_vibrate(tmp_path):
    """A viscous ball comes to rest after its impact: what is left of its elastic energy is in stresses
    that plastic strain has left in it, and no part of vibration_energy. Without viscosity these
    stresses make no later contact possible."""
    rest = metals.ball(tmp_path / "rest", 20, 3e8, viscosity=2e4, end_time=3e-4)
    assert rest.history["elastic"][-1] > 0.3 * rest.summary["energy_final"]
    assert rest.summary["vibration_energy"] < 1e-6 * rest.summary["energy_final"]
    assert not metals.ball(tmp_path / "free", 20, 3e8).summary["later_contact_possible"]
