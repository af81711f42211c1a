"""The ball in three dimensions on coarse meshes: operators, laws, energies, momenta, and impacts on
the plane."""

import numpy as np
import pytest

from verification.manufactured import SOFT
from verification.test_ellipticity import STATES, acoustic
from verification.test_stress import NU, YOUNG, assert_stress, cauchy

LAWS = ["svk", "neohookean"]
COARSE = {"mesh_size": 0.025, "contact_mesh_size": 0.015}
VOLUME = 4 / 3 * np.pi * 0.05**3


@pytest.mark.parametrize("law", LAWS)
def test_homogeneous_deformation_is_exact(measure, law):
    """V1: F, P, energy and smallest stretch of x = F X are exact to round-off at every quadrature
    point of the curved ball.

    The discrete-gradient correction of finite steps agrees with the energies.
    """
    numbers = measure("homogeneous-3d", law=law, symmetry="full", **COARSE)
    assert numbers["gradient"] < 1e-13 and numbers["stress"] < 1e-12 and numbers["energy"] < 1e-12 and numbers["stretch"] < 1e-12
    assert numbers["excess"] < 1e-13 and (numbers["largest"] > 0.1 or law == "svk")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("degree", [1, 2])
def test_snapshot_has_the_stress_of_the_closed_form(measure, tmp_path, law, degree):
    """V1: all six components of Cauchy stress, von Mises stress and det F of the same motion are
    exact in the file, to its 9 digits."""
    largest = measure("homogeneous-3d", law=law, degree=degree, young=YOUNG, nu=NU, symmetry="full", out=tmp_path, **COARSE)
    F = np.array([[1.2, 0.3, -0.1], [-0.1, 0.7, 0.2], [0.15, -0.05, 1.1]])
    assert_stress(largest, tmp_path, cauchy(law, F), F)


@pytest.mark.few(1)
@pytest.mark.parametrize("symmetry", ["quarter", "half", "full"])
def test_mass_surface_and_contact_points_are_those_of_the_sphere(measure, symmetry):
    """With the symmetry factor, mass 4/3 pi R^3 rho and surface are exact to 2e-3 on a coarse mesh,
    and 8 times better for half the size.

    The contact points lie on the sphere.
    """
    coarse = measure("homogeneous-3d", law="svk", symmetry=symmetry, **COARSE)
    fine = measure("homogeneous-3d", law="svk", symmetry=symmetry, mesh_size=0.0125, contact_mesh_size=0.0075)
    assert abs(coarse["mass"]) < 2e-3 and abs(fine["mass"]) < abs(coarse["mass"]) / 8
    assert abs(coarse["surface"]) < 2e-3 and abs(fine["surface"]) < abs(coarse["surface"]) / 8
    assert coarse["sphere"] < 1e-14 and coarse["rows"] < 1e-3 and fine["rows"] < coarse["rows"] / 4


@pytest.mark.robustness
@pytest.mark.parametrize("law", LAWS)
def test_order_in_space(measure, law):
    """V1: the L2 error of a manufactured motion with sines falls with h^3 on curved tetrahedra, the
    error of the mass with h^4.

    h is computed from the number of elements, as the meshes are not nested.
    """
    coarse, fine = (measure("manufactured-3d", law=law, mesh_size=h, contact_mesh_size=h, dt=0.005, end_time=0.025, tolerance=1e-12, **SOFT) for h in (0.35, 0.175))
    finer = np.log2(fine["elements"] / coarse["elements"]) / 3
    assert coarse["state"] == fine["state"] == 0 and fine["smallest"] < 0.95
    assert np.log2(coarse["error"] / fine["error"]) / finer == pytest.approx(3, abs=0.15)
    assert np.log2((1 - coarse["mass"]) / (1 - fine["mass"])) / finer == pytest.approx(4, abs=0.25)


@pytest.mark.parametrize("turns", [10, pytest.param(100, marks=pytest.mark.robustness)])
@pytest.mark.parametrize("law", LAWS)
def test_spinning_ball_keeps_energy_and_momenta(measure, law, turns):
    """V3: a vibrating free half ball (z >= 0) keeps energy, momentum and angular momentum to 1e-10
    over several turns of 30 steps.

    A rigid motion of a deformed body changes neither its energy nor det F.
    """
    numbers = measure("spinning-3d", law=law, spin=200, exponent=3, tolerance=5e-14, mesh_size=0.035, contact_mesh_size=0.035, symmetry="half",
                      end_time=2 * np.pi * turns / 200)
    assert numbers["state"] == 0 and numbers["strain"] > 0.02 and numbers["turns"] == turns
    assert numbers["energy"] < 1e-10 and numbers["momentum"] < 1e-10 and numbers["angular"] < 1e-10
    assert numbers["rigid"] < 1e-11


@pytest.mark.few(2)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("nu", [0, 0.3, 0.45])
def test_ellipticity_is_the_least_of_all_directions(measure, law, nu):
    """The smallest eigenvalue of the acoustic tensor in 20,000 directions, for a hundred random
    states, confirms the program.

    No direction gives a smaller value than the program, which searches the principal planes of C;
    the difference is within the spacing of the directions.
    """
    numbers = measure("ellipticity-3d", law=law, nu=nu, **COARSE)
    closed = np.array([numbers[f"closed{i}"] for i in STATES])
    entries = np.array([[numbers[f"C{name}_{i}"] for i in STATES] for name in ("11", "12", "13", "12", "22", "23", "13", "23", "33")])
    golden = np.arange(20000) + 0.5
    height, turn = 1 - golden / 20000, np.pi * (1 + 5**0.5) * golden  # evenly over half a sphere
    N = np.stack([np.sqrt(1 - height**2) * np.cos(turn), np.sqrt(1 - height**2) * np.sin(turn), height])
    least, largest = acoustic(entries.T.reshape(-1, 3, 3), nu, law, N).T
    assert (-1e-10 * largest <= least - closed).all() and (least - closed <= 1e-3 * largest).all()
    assert (closed < 0).any() or law == "neohookean"


IMPACT = {"law": "neohookean", "accuracy": 0.1, "mesh_size": 0.025, "contact_mesh_size": 0.012}


@pytest.mark.parametrize("law", LAWS)
def test_impact_keeps_the_energy_and_its_impulse_is_the_change_of_momentum(disc, law):
    """A whole contact at 2 m/s keeps the energy to 1e-9. Impulse and change of momentum agree to
    1e-9. The centre of mass stays on its axis."""
    run = disc(kind="ball", **IMPACT | {"law": law, "speed": 2})
    s, h = run.summary, run.history
    mass = 2 * s["energy_initial"] / 2**2
    assert s["status"] == "ok" and s["contact_intervals"] >= 1 and s["rebound_vy"] > 1.8
    assert mass == pytest.approx(1722 * VOLUME, rel=2e-3)
    assert s["energy_drift"] < 1e-9 and s["momentum_drift"] < 1e-9
    assert s["impulse"] == pytest.approx(mass * (2 + s["rebound_vy"]), rel=1e-9)
    assert not h["momentum_x"].any() and not h["momentum_z"].any() and not h["z"].any()


@pytest.mark.parametrize("law, speed", [("neohookean", 8), ("svk", 4)])
def test_impact_is_that_of_a_body_of_revolution(disc, law, speed):
    """Impact of the ball agrees with that of the axisymmetric ball.

    Contact time between thresholds, impulse, rebound, and the force history (means over a fiftieth
    of the contact, L2 norm) agree to 4 %. For St. Venant-Kirchhoff the speed is low enough for
    ellipticity.
    """
    flags = {"law": law, "speed": speed, "penalty": 1e10, "accuracy": 0.01}
    runs = [disc(kind="ball", **flags), disc(kind="ball-axisymmetric", **flags | {"accuracy": 0.005})]
    solid, revolved = (run.summary for run in runs)
    assert solid["min_ellipticity"] > 0 and revolved["min_ellipticity"] > 0
    assert solid["thresholded_contact_time"] == pytest.approx(revolved["thresholded_contact_time"], rel=0.01)
    assert solid["impulse"] == pytest.approx(revolved["impulse"], rel=2e-3)
    assert solid["rebound_vy"] == pytest.approx(revolved["rebound_vy"], rel=2e-3)
    instants = np.linspace(0, 1.1 * revolved["contact_time"], 56)
    forces = [np.diff(np.interp(instants, run.history["t"], np.cumsum(run.history["dt"] * run.history["normal_force"]))) for run in runs]
    assert np.linalg.norm(forces[0] - forces[1]) < 0.04 * np.linalg.norm(forces[1])


@pytest.mark.few(2)
@pytest.mark.parametrize("regularization", ["linear", "linear-printed", "sqrt", "tanh"])
@pytest.mark.parametrize("transition", ["jump", "smooth"])
def test_friction_in_space_is_the_law_in_every_direction(measure, regularization, transition):
    """Along z = 0 friction agrees with the plane law to round-off, and rotates with the slip
    direction.

    Stiffness, drag and coupling are derivatives of the forces to 1e-6.
    """
    numbers = measure("friction-3d", friction_static=0.7, friction_dynamic=0.5, regularization=regularization,
                      friction_transition=transition, symmetry="full", **COARSE)
    assert numbers["plane"] < 1e-13 and numbers["turned"] < 1e-13
    assert numbers["stiff"] < 1e-6 and numbers["drag"] < 1e-6 and numbers["coupling"] < 1e-6
    assert numbers["depth"] < 5e-3 and numbers["others"] == 0


OBLIQUE = {"law": "neohookean", "accuracy": 0.2, "speed": 8, "angle": 45, "spin": 20, "mesh_size": 0.03, "contact_mesh_size": 0.015}


def test_oblique_impact_with_friction_keeps_its_balances(disc):
    """Half of a ball with static and dynamic friction and spin: energy with friction work and both
    momenta are balanced to 1e-9."""
    s = disc(kind="ball", friction_static=0.7, friction_dynamic=0.5, end_time=0.001, **OBLIQUE).summary
    assert s["energy_drift"] < 1e-9 and s["momentum_drift"] < 1e-9 and s["friction_work"] > 0.1
    assert s["skipped"] and "half of the body (symmetry)" in s["skipped"]


@pytest.mark.robustness
def test_gross_slip_is_that_of_the_rigid_ball(disc):
    """V10: a slow ball at grazing incidence slides throughout.

    The tangential impulse is mu times the normal impulse, except for the part that the outward
    spreading of the contact deflects. The spin is 5/2 mu (1 + e) v_n/R to 3 %, as the indentation
    shortens the lever.
    """
    run = disc(kind="ball", law="neohookean", accuracy=0.05, speed=1, angle=20, nu=0.3, friction_static=0.1)
    s, h = run.summary, run.history
    normal = -h["vy"][0]
    restitution = s["rebound_vy"] / normal
    assert s["sticking_time"] < 0.01 * s["contact_time"] and s["energy_drift"] < 1e-9
    assert h["momentum_x"][0] - h["momentum_x"][-1] == pytest.approx(0.1 * s["impulse"], rel=1e-3)
    assert -s["rebound_spin"] == pytest.approx(2.5 * 0.1 * (1 + restitution) * normal / 0.05, rel=0.03)
