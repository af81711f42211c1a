"""The disc with friction: balances of energy, momentum and angular momentum, symmetry, integrators,
body forces."""

import math

import numpy as np
import pytest

from ffimpact.mesh import mesh
from ffimpact.scene import read
from ffimpact.scenes import assembly
from tests.support.triangles import whole_of

from .measure import impact

COARSE = dict(mesh_size=0.025, contact_mesh_size=0.0079, accuracy=0.03, slip_velocity=0.1)
RUBBING = dict(friction_static=0.7, friction_dynamic=0.5)
# Section 3.1 of the paper, on a coarse mesh.
OBLIQUE = dict(law="neohookean", speed=12, angle=60) | RUBBING | COARSE
MASS = 1722 * math.pi * 0.05**2


# ---- balances

def check_balances(result):
    """Checks energy in every step, non-negative friction work, and forces against the change of
    momentum (the definition of the paper)."""
    h = result.history
    assert abs(h["balance"]).max() < 1e-8 * h["kinetic"][0]
    total = h["kinetic"] + h["elastic"] + h["contact"] + h["friction_work"] - h["external_work"]
    assert abs(total - total[0]).max() < 1e-8 * h["kinetic"][0]
    assert np.diff(h["friction_work"]).min() >= 0 and h["friction_work"][-1] > 0.02 * h["kinetic"][0]
    for force, momentum in (("friction_force", "momentum_x"), ("normal_force", "momentum_y")):
        change = np.diff(h[momentum]) / np.diff(h["t"])
        assert abs(change - h[force][1:]).max() < 1e-8 * h["normal_force"].max()
    assert (abs(h["friction_force"]) <= 0.7 * (1 + 1e-12) * h["normal_force"]).all()
    assert ((h["sliding_fraction"] >= 0) & (h["sliding_fraction"] <= 1 + 1e-12)).all()


@pytest.mark.few(4)
@pytest.mark.parametrize("law, speed, transition, regularization", [
    *(("neohookean", 12, transition, regularization) for transition in ("jump", "smooth") for regularization in ("linear", "linear-printed", "sqrt", "tanh")),
    ("svk", 6, "jump", "linear"), ("svk", 6, "smooth", "tanh")])
def test_energy_and_momentum_are_accounted_for(disc, law, speed, transition, regularization):
    """In every step energy and friction work add up to the initial energy within 1e-8.

    Friction never returns energy, and both columns of forces are the change of momentum.
    """
    result = disc(**OBLIQUE | dict(law=law, speed=speed, regularization=regularization, friction_transition=transition))
    check_balances(result)
    s = result.summary
    assert s["sliding_time"] > 0 and s["sticking_time"] > 0
    assert s["sliding_time"] + s["sticking_time"] == pytest.approx(s["contact_time"], rel=0.05)


@pytest.mark.robustness
def test_balances_hold_at_a_finer_setting(disc):
    """The same with a better accuracy and a smaller slip velocity."""
    check_balances(disc(**OBLIQUE | dict(mesh_size=8e-3, contact_mesh_size=2.5e-3, accuracy=3e-3, slip_velocity=0.01)))


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("integrator", ["energy-momentum", "midpoint"])
def test_each_step_obeys_the_momentum_principles(measure, law, integrator):
    """In every step of a spinning, falling disc with friction, the tractions of single points
    satisfy the momentum balances.

    Their sums give the changes of momentum, of angular momentum about a fixed point and of friction
    work. They obey Coulomb's law.
    """
    numbers = measure("rubbing-disc", law=law, integrator=integrator, speed=6, spin=40, angle=50, gravity=300, body_force_x=100,
                      dt=4e-5, end_time=6e-3, mesh_size=0.02, contact_mesh_size=0.006, tolerance=2e-14, **RUBBING)
    assert numbers["state"] == 0 and 50 < numbers["touched"] < numbers["steps"] and numbers["spun"] < -10
    assert numbers["momentum"] < 1e-11 and numbers["angular"] < 1e-8 and numbers["work"] < 1e-13 and numbers["law"] <= 1e-14
    assert numbers["drift"] < 1e-10 or integrator == "midpoint"


@pytest.mark.parametrize("spin, sense", [(-400, 1), (400, -1)])
def test_friction_acts_against_the_slip(disc, spin, sense):
    """Friction accelerates a spinning disc with vertical velocity against the motion of its lowest
    point, and slows its spin."""
    result = disc(**OBLIQUE | dict(angle=90, speed=6, spin=spin))
    check_balances(result)
    assert sense * result.summary["rebound_vx"] > 1 and abs(result.summary["rebound_spin"]) < 300


# ---- limits

@pytest.mark.parametrize("angle", [90, 60])
def test_coefficients_of_zero_are_no_friction(disc, angle):
    """With both coefficients zero, every number of the history equals that of a run without
    friction entries."""
    settings = COARSE | dict(law="neohookean", speed=6, angle=angle)
    without, zero = disc(**settings).history, disc(friction_static=0, friction_dynamic=0, regularization="tanh", **settings).history
    assert without.keys() == zero.keys()
    for name in without:
        assert np.array_equal(without[name], zero[name]), name
    assert not without["friction_force"].any() and not without["friction_work"].any()


def test_friction_fades_with_its_coefficient(disc):
    """With a coefficient of 1e-6 the impact agrees with the frictionless one to 1e-5 and loses 1e-6
    of the impulse along the plane."""
    settings = dict(law="neohookean", speed=6, angle=60)
    without = disc(**settings | COARSE).summary
    little = disc(friction_static=1e-6, friction_dynamic=1e-6, **settings | COARSE).summary
    for name in ("contact_time", "impulse", "rebound_vy", "peak_force"):
        assert little[name] == pytest.approx(without[name], rel=1e-5), name
    assert without["rebound_vx"] - little["rebound_vx"] == pytest.approx(1e-6 * little["impulse"] / MASS, rel=0.01)


def test_nothing_rubs_where_nothing_slides(measure, tmp_path):
    """A rigid body that falls vertically (V8) behaves the same with and without friction."""
    histories = []
    for friction in (0, 0.7):
        measure("impact", nu=0, radius=0.05, mesh_size=0.0125, speed=1, young=1e12, penalty=1e7, dt=4e-5, friction_static=friction,
                friction_dynamic=friction, out=tmp_path / str(friction))
        histories.append(np.genfromtxt(tmp_path / str(friction) / "history.csv", delimiter=",", names=True))
    without, rubbing = histories
    assert rubbing["friction_work"].max() < 1e-8 * rubbing["kinetic"][0]
    for name in ("normal_force", "kinetic", "contact", "vy"):
        assert abs(without[name] - rubbing[name]).max() < 1e-6 * abs(without[name]).max(), name


@pytest.mark.few(2)
# With the jump from static to dynamic friction, round-off in the solver decides when a point that
# is about to slip does so. The law itself does not determine the friction then, so that only the
# motion is compared.
@pytest.mark.parametrize("regularization, static, band", [("linear", 0.5, 1e-5), ("sqrt", 0.5, 1e-5), ("linear", 0.7, 2e-2)])
def test_half_a_rubbing_disc_is_the_whole_disc(disc, tmp_path, regularization, static, band):
    """At a normal impact friction acts symmetrically: half and whole disc give the same history on
    a mirrored mesh."""
    settings = dict(law="neohookean", speed=10, dt=4e-5, penalty=1e10, slip_velocity=0.1, regularization=regularization, friction_static=static, friction_dynamic=0.5)
    halved = dict(mesh_size=0.015, contact_mesh_size=0.006, symmetry="half")
    part = assembly.assemble(read(impact(**settings, **halved), tmp_path, "half")).mesh
    mesh.write(whole_of(part), tmp_path / "full.msh")
    half = disc(**halved, **settings)
    full = disc(file=tmp_path / "full.msh", **settings)
    assert half.summary["friction_work"] > 5e-3 * half.summary["energy_initial"]
    of_friction = () if static > 0.5 else ("friction_work", "sliding_fraction", "contact_size")
    for name in ("normal_force", "kinetic", "elastic", "contact", "y", "vy", "max_penetration", *of_friction):
        # A jump of mu may cost a further step.
        a, b = half.history[name], np.interp(half.history["t"], full.history["t"], full.history[name])
        assert abs(a - b).max() < band * abs(a).max(), name
    assert abs(half.history["friction_force"]).max() == 0
    even = 1e-6 if static == 0.5 else band
    assert abs(full.history["friction_force"]).max() < even * full.history["normal_force"].max()
    assert full.summary["contact_time"] == pytest.approx(half.summary["contact_time"], rel=band)
    assert full.summary["energy_drift"] < 1e-9 and half.summary["energy_drift"] < 1e-9
    assert abs(full.summary["rebound_vx"]) < 0.1 * even and abs(full.summary["rebound_spin"]) < 10 * even


def test_two_ways_are_mirror_images(disc):
    """At a normal impact the opposite spin gives the mirror image of the motion."""
    forward, backward = (disc(**OBLIQUE | dict(angle=90, speed=6, spin=spin)).summary for spin in (400, -400))
    # The mesh itself is not symmetric.
    assert forward["rebound_vx"] == pytest.approx(-backward["rebound_vx"], rel=0.01)
    assert forward["rebound_spin"] == pytest.approx(-backward["rebound_spin"], rel=0.01)
    assert forward["friction_work"] == pytest.approx(backward["friction_work"], rel=0.03)


# ---- integrators

@pytest.mark.few(1)
# Tolerances of rebound (both components and spin), friction work and energy balance. Backward Euler
# loses 7 % of the energy at this step, and 9 % of the friction work.
@pytest.mark.parametrize("integrator, rebound, work, balance", [
    ("midpoint", 1e-3, 5e-3, 1e-4), ("bdf2", 3e-3, 1e-2, 3e-3), ("backward-euler", 3e-2, 0.15, 0.15)])
def test_integrators_agree_at_small_steps(disc, integrator, rebound, work, balance):
    """With friction, too, every implicit integrator converges to the results of the energy-momentum
    integrator."""
    settings = OBLIQUE | dict(dt=1e-5, penalty=1e9)
    reference, summary = disc(**settings).summary, disc(integrator=integrator, **settings).summary
    for name in ("rebound_vx", "rebound_vy", "rebound_spin"):
        assert summary[name] == pytest.approx(reference[name], rel=rebound), name
    assert summary["friction_work"] == pytest.approx(reference["friction_work"], rel=work)
    assert summary["sticking_time"] == pytest.approx(reference["sticking_time"], rel=0.05)
    assert summary["energy_drift"] < balance


def test_explicit_steps_agree(disc):
    """Central differences agree with the energy-momentum integrator to 3 % (the friction work to 10
    %), the error of the lumped mass on this mesh.

    The sticking time agrees, too.
    """
    settings = OBLIQUE | dict(penalty=1e9, slip_velocity=1)
    reference, summary = disc(dt=1e-5, **settings).summary, disc(integrator="central-difference", **settings).summary
    for name, band in (("rebound_vx", 0.03), ("rebound_vy", 0.03), ("rebound_spin", 0.03), ("friction_work", 0.1), ("sticking_time", 0.05)):
        assert summary[name] == pytest.approx(reference[name], rel=band), name
    assert summary["energy_drift"] < 1e-3


# ---- body forces

def test_flight_under_a_body_force_is_a_parabola(disc):
    """High above the plane gravity and body force give the exact parabola, and the balance includes
    their work."""
    bx, by, g, speed, time = -7.0, 3.0, 12.0, 4.0, 0.1
    result = disc(height=5, speed=speed, angle=30, spin=11, gravity=g, body_force_x=bx, body_force_y=by, end_time=time, **COARSE)
    h = result.history
    vx, vy = speed * math.cos(math.pi / 6), -speed / 2
    x, y = vx * time + bx * time**2 / 2, vy * time + (by - g) * time**2 / 2
    assert h["t"][-1] == pytest.approx(time, rel=1e-12)
    assert h["x"][-1] - h["x"][0] == pytest.approx(x, rel=1e-10)
    assert h["y"][-1] - h["y"][0] == pytest.approx(y, rel=1e-10)
    assert h["vx"][-1] == pytest.approx(vx + bx * time, rel=1e-10)
    assert h["vy"][-1] == pytest.approx(vy + (by - g) * time, rel=1e-10)
    assert h["spin"][-1] == pytest.approx(11, rel=1e-10)
    # The mesh lacks some area.
    assert h["external_work"][-1] == pytest.approx(MASS * (bx * x + (by - g) * y), rel=1e-2)
    assert h["external_work"][-1] == pytest.approx(h["kinetic"][-1] - h["kinetic"][0], rel=1e-10)
    assert abs(h["balance"]).max() < 1e-10 * h["kinetic"][0]


def test_rebound_under_a_body_force_is_a_parabola(disc):
    """After an impact with friction, the centre of the vibrating disc follows its parabola exactly
    in every step."""
    bx, by, g = -150.0, 60.0, 260.0
    result = disc(**OBLIQUE | dict(speed=6, gravity=g, body_force_x=bx, body_force_y=by, end_time=9e-3))
    h = result.history
    late = np.arange(len(h["t"])) > np.flatnonzero(h["normal_force"])[-1]
    assert late.sum() > 10
    t, t0 = h["t"][late], h["t"][late][0]
    for place, velocity, force in (("x", "vx", bx), ("y", "vy", by - g)):
        p, w = h[place][late], h[velocity][late]
        assert abs(w - w[0] - force * (t - t0)).max() < 1e-9
        assert abs(p - p[0] - w[0] * (t - t0) - force * (t - t0) ** 2 / 2).max() < 1e-12
    assert np.ptp(h["elastic"][late]) > 0
    assert abs(h["balance"]).max() < 1e-8 * h["kinetic"][0]
    assert abs(h["external_work"]).max() > 0.02 * h["kinetic"][0]
    assert result.summary["momentum_drift"] < 1e-10


def test_body_force_and_gravity_add_up(disc):
    """A body force towards the plane has the effect of gravity: equal histories, with friction."""
    settings = OBLIQUE | dict(speed=6)
    a, b = disc(gravity=400, **settings).history, disc(body_force_y=-400, **settings).history
    for name in a:
        assert abs(a[name] - b[name]).max() <= 1e-9 * abs(a[name]).max(), name
