"""Layers of a body in runs: mass and inertia, momenta, energies by layer, waves across an interface."""

import numpy as np
import pytest

import ffimpact as ff
from ffimpact import view
from ffimpact.report import drawing, movie, report
from ffimpact.report.figures import is_half
from ffimpact.scenes import assembly

RADIUS, CORE = 0.05, 0.03
SOFT = ff.NeoHookean(young=1e6, nu=0.45, density=1722)
HARD = ff.NeoHookean(young=2e7, nu=0.3, density=4000)


def flight(tmp_path, body, **entries):
    """A run of a body that flies alone."""
    run = ff.Scene(bodies=[body], end_time=2e-3, **{"accuracy": 0.02} | entries)
    return ff.run(run, out=tmp_path / "run", figures=False)


@pytest.mark.parametrize("size", [0.02, 0.01])
def test_mass_and_inertia_of_a_layered_disc(tmp_path, size):
    """m = pi sum of rho (R^2 - r^2), I = pi/2 sum of rho (R^4 - r^4): exact but for the fourth order of quadratic edges.

    The momenta of the rotating disc stay to round-off, and its energy to 1e-9.
    """
    body = ff.Disc(radius=RADIUS, material=SOFT, position=(0, 1), velocity=(1, 2), spin=100.0, mesh_size=size,
                   layers=[ff.Layer(radius=CORE, material=HARD)])  # fmt: skip
    made = flight(tmp_path, body)
    rho, core = SOFT.density, HARD.density
    mass = np.pi * (rho * (RADIUS**2 - CORE**2) + core * CORE**2)
    inertia = np.pi / 2 * (rho * (RADIUS**4 - CORE**4) + core * CORE**4)
    assert made["mass"] == pytest.approx(mass, rel=2e-3 * (size / 0.02) ** 4)
    columns = made.history
    assert columns["angular_momentum"][0] == pytest.approx(100 * inertia, rel=4e-3 * (size / 0.02) ** 4)
    for name in ("momentum_x", "momentum_y", "angular_momentum"):
        assert np.ptp(columns[name]) <= 1e-11 * abs(columns[name][0])
    assert made.summary["energy_drift"] < 1e-9


def test_mass_of_a_layered_ball(tmp_path):
    """Of revolution, 4/3 pi sum of rho (R^3 - r^3)."""
    body = ff.Ball(radius=RADIUS, material=SOFT, position=(0, 1), velocity=(0, 2), mesh_size=0.01, layers=[ff.Layer(radius=CORE, material=HARD)])
    made = flight(tmp_path, body, dimension="axisymmetric")
    mass = 4 / 3 * np.pi * (SOFT.density * (RADIUS**3 - CORE**3) + HARD.density * CORE**3)
    assert made["mass"] == pytest.approx(mass, rel=1e-4)


def test_a_layered_ball_rotates_in_space(tmp_path):
    """Mass and inertia 8/15 pi sum of rho (R^5 - r^5) of a ball with a core; momenta and energy stay."""
    body = ff.Ball(radius=RADIUS, material=SOFT, position=(0, 1, 0), velocity=(1, 2, 3), spin=(30, 100, -50), mesh_size=0.02,
                   layers=[ff.Layer(radius=CORE, material=HARD)])  # fmt: skip
    made = flight(tmp_path, body, accuracy=0.05)
    rho, core = SOFT.density, HARD.density
    assert made["mass"] == pytest.approx(4 / 3 * np.pi * (rho * (RADIUS**3 - CORE**3) + core * CORE**3), rel=2e-3)
    inertia = 8 / 15 * np.pi * (rho * (RADIUS**5 - CORE**5) + core * CORE**5)
    for name, spin in (("angular_momentum_x", 30), ("angular_momentum_y", 100), ("angular_momentum", -50)):
        column = made.history[name]
        assert column[0] == pytest.approx(spin * inertia, rel=4e-3) and np.ptp(column) < 1e-10 * 100 * inertia
    assert made.summary["energy_drift"] < 1e-9 and made["layer_elastic_final_1"] > 0


def test_a_layered_cylinder_rotates_about_its_axis_in_space(tmp_path):
    """Mass pi h sum of rho (R^2 - r^2) and inertia pi h/2 sum of rho (R^4 - r^4) of a cylinder with a core; energy stays."""
    height = 0.06
    body = ff.Cylinder(radius=RADIUS, height=height, material=SOFT, position=(0, 1, 0), velocity=(1, 2, 3), spin=(0, 100, 0), mesh_size=0.02,
                       layers=[ff.Layer(radius=CORE, material=HARD)])  # fmt: skip
    made = flight(tmp_path, body, accuracy=0.05)
    rho, core = SOFT.density, HARD.density
    assert made["mass"] == pytest.approx(np.pi * height * (rho * (RADIUS**2 - CORE**2) + core * CORE**2), rel=2e-3)
    inertia = np.pi * height / 2 * (rho * (RADIUS**4 - CORE**4) + core * CORE**4)
    column = made.history["angular_momentum_y"]
    assert column[0] == pytest.approx(100 * inertia, rel=4e-3) and np.ptp(column) < 1e-10 * 100 * inertia
    assert made.summary["energy_drift"] < 1e-9 and made["layer_elastic_final_1"] > 0


def test_equal_materials_are_one_material(tmp_path):
    """On the mesh of a layered rectangle: a layer with the entries of its body changes no number by more than 1e-9."""
    layer = ff.Layer(where={"kind": "box", "low": (-0.02, -0.02), "high": (0.02, 0.03)})
    block = ff.Rectangle(width=0.1, height=0.08, material=SOFT, position=(0, 1), velocity=(0, -1), mesh_size=0.02, layers=[layer])
    mesh = assembly.assemble(ff.Scene(bodies=[block], obstacles=[ff.Plane()], symmetry="full").ready()).mesh
    results = []
    for k, layers in enumerate(([], [layer])):
        body = ff.Mesh(points=mesh.points, cells=mesh.triangles, material=SOFT, position=(0, 0.06), angle=30.0, velocity=(0, -2), layers=layers)
        results.append(ff.run(ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.05), out=tmp_path / f"run{k}", figures=False))
    one, two = results
    assert len(one.history["t"]) == len(two.history["t"])
    for name in ("impulse", "peak_force", "contact_time", "rebound_vy", "mass", "vibration_energy"):
        assert two.summary[name] == pytest.approx(one.summary[name], rel=1e-9)
    assert (two.history["layer_elastic_1"] < two.history["elastic"] + 1e-12).all() and two.history["layer_elastic_1"].max() > 0


LENGTH, PULSE = 1.0, 2.5e-4


def bar(tmp_path, size, impedance):
    """A bar with nu = 0, in which all motion is along y: a pulse of stress enters at the lower end. Both
    halves have the wave speed 1,000 m/s.
    """
    far = ff.SaintVenantKirchhoff(young=1e9 * impedance, nu=0.0, density=1000.0 * impedance)
    upper = ff.Layer(where={"kind": "half-plane", "point": (0, 0), "normal": (0, 1)}, material=far)
    pulse = ff.Load(where="bottom", traction=(0, f"1000*sin(pi*min(t, {PULSE})/{PULSE})^2"))
    body = ff.Rectangle(width=0.1, height=LENGTH, law="svk", young=1e9, nu=0.0, density=1000.0, position=(0, 0), mesh_size=size,
                        layers=[upper], load=[pulse])  # fmt: skip
    run = ff.Scene(bodies=[body], end_time=8.5e-4, dt=PULSE * size / 0.5, accuracy=0.02)
    return ff.run(run, out=tmp_path / f"{size}-{impedance}", figures=False)


@pytest.mark.parametrize("impedance", [3.0, 0.2])
def test_reflection_and_transmission_of_a_two_layer_bar(tmp_path, impedance):
    """A wave of small amplitude at an interface keeps the share 1 - R^2 of its energy beyond it, R = (Z2 - Z1)/(Z2 + Z1).

    Half of the energy of a travelling wave is elastic. The error falls with the square of size and step, at least.
    """
    reflected = (impedance - 1) / (impedance + 1)
    errors = []
    for size in (0.04, 0.02):
        made = bar(tmp_path, size, impedance)
        share = made["layer_elastic_final_1"] / made.history["elastic"].iloc[-1]
        errors.append(abs(share - (1 - reflected**2)))
        assert made.summary["energy_drift"] < 1e-9
    print(errors)
    assert errors[1] < 2e-3 and errors[1] < errors[0] / 2


KINDS = {
    "plane": (ff.Disc, {"position": (0, 0.05), "velocity": (0, -2)}, {}),
    "revolved": (ff.Ball, {"position": (0, 0.05), "velocity": (0, -2)}, {"dimension": "axisymmetric"}),
    "space": (ff.Ball, {"position": (0, 0.05, 0), "velocity": (0, -2, 0)}, {}),
}


@pytest.mark.parametrize("kind", KINDS)
def test_pictures_and_reports_have_the_layers(tmp_path, kind):
    """The player and films draw the circle between core and cover; report, plan, pictures and repr name the core."""
    shape, moves, entries = KINDS[kind]
    body = shape(radius=RADIUS, material=SOFT, layers=[ff.Layer(name="heart", radius=CORE, young=2e7)], **moves)
    scene = ff.Scene(bodies=[body], obstacles=[ff.Plane()], end_time=2e-3, accuracy=0.1, fields=4, **entries)
    made = ff.run(scene, out=tmp_path / "run", estimate=False)
    states = view.states_of(made, True)
    ends = states.places[0][states.interfaces]
    away = np.linalg.norm(ends - [0, 0.05, 0], axis=2)
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum()
    circles = 2 if kind == "space" else 1  # a quarter and its image have a half circle each on two planes
    assert states.kind == kind and away == pytest.approx(CORE, rel=2e-2) and length == pytest.approx(2 * np.pi * CORE * circles, rel=0.02)
    assert '"interfaces": {"id":' in made.view().page
    motion = movie.Motion(made.folder / "fields.pvd", is_half(made.scene))
    between = motion.at(made.fields.times[1] / 2)[0]
    assert len(between.interfaces) > 20 and len(between.interfaces) == len(motion.bodies[0].interfaces)
    name = "heart of body1: inside 0.03 m, neohookean, young = 2e+07 Pa"
    assert name in report.report(made.record) and name in str(ff.plan(scene)) and "heart: neo-Hookean, E = 20 MPa" in drawing.title(made.scene)
    assert "layer 1.1" in repr(scene)


def test_viscous_work_by_layer(tmp_path):
    """A damped core in an elastic disc takes all that is dissipated."""
    core = ff.Layer(radius=CORE, young=2e6, viscosity=100.0)
    body = ff.Disc(radius=RADIUS, material=SOFT, position=(0, 0.051), velocity=(0, -2), layers=[core])
    made = ff.run(ff.Scene(bodies=[body], obstacles=[ff.Plane()], accuracy=0.05), out=tmp_path / "run", figures=False)
    assert made["layer_viscous_work_1"] == pytest.approx(made["viscous_work"], rel=1e-12) and made["viscous_work"] > 0
    assert made.summary["energy_drift"] < 1e-9 and "layer_elastic_final_1" in made.summary
