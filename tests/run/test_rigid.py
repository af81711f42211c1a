"""Rigid bodies: exact rigid motions, and the limit of stiff bodies."""

import json
import math
import re

import numpy as np
import pandas as pd
import pytest

from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.mesh import solid_mesh
from ffimpact.output import vtu
from ffimpact.scene import load
from ffimpact.scenes import assembly
from tests.support.rigid import DISC, FLOOR, ROLLER, run

BLOCK = """
[[body]]
shape = "rectangle"
width = 0.3
height = 0.15
position = [0, -0.075]
law = "svk"
young = 1e6
nu = 0.3
"""


def test_a_disc_slides_until_it_rolls(tmp_path):
    """Coulomb friction takes v0/3 of a homogeneous disc. Energy and momenta are conserved."""
    text = DISC + "position = [0, 0.05]\nvelocity = [1, 0]\n" + FLOOR + "friction_static = 0.3\n"
    summary, history = run(tmp_path, "gravity = 9.81\nend_time = 0.16\n" + text)
    assert summary["dofs"] == 6
    # The penetration is 2 % of R.
    assert history.vx.iloc[-1] == pytest.approx(2 / 3, rel=0.01)
    assert history.spin.iloc[-1] == pytest.approx(-2 / 3 / 0.05, rel=0.02)
    assert summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-11


def test_mass_and_inertia_are_those_given(tmp_path):
    """A disc with I = m R^2, as a thin ring, keeps half of its speed."""
    entries = "mass = 3\ninertia = 0.0075\n"
    text = DISC.replace("density = 1000\n", "") + entries + "position = [0, 0.05]\nvelocity = [1, 0]\n" + FLOOR + "friction_static = 0.3\n"
    summary, history = run(tmp_path, "gravity = 9.81\nend_time = 0.2\n" + text)
    assert summary["mass"] == pytest.approx(3, rel=1e-12)
    assert history.vx.iloc[-1] == pytest.approx(1 / 2, rel=0.015)
    assert summary["angular_momentum_drift"] < 1e-11


def test_it_is_the_limit_of_a_stiff_disc(tmp_path):
    """The same disc, a thousand times stiffer than the block."""
    text = DISC + "position = [0, 0.0501]\nvelocity = [0.3, -1]\n" + BLOCK + "[contact]\nfriction_static = 0.3\n"
    rigid, _ = run(tmp_path, text, "rigid", estimate=True)
    stiff, _ = run(tmp_path, text.replace("rigid = true", 'law = "svk"\nyoung = 1e9\nnu = 0.3'), "stiff", estimate=True, body__1__density=1000)
    for name in ("impulse", "rebound_vy_1", "rebound_vy_2"):
        apart = 0.005 * abs(stiff[name]) + max(summary["estimated_error"]["rebound"] for summary in (rigid, stiff)) * abs(stiff[name])
        assert abs(rigid[name] - stiff[name]) < apart, name
    assert rigid["energy_drift"] < 1e-9 and rigid["momentum_drift"] < 1e-10


DROPPED = """
accuracy = 0.02
[[body]]
shape = "rectangle"
width = 0.2
height = 0.1
rigid = true
density = 1000
position = [0, 0.0501]
velocity = [0, -3]
""" + FLOOR.replace("1e7", "1e8")


def test_a_block_dropped_flat_rebounds_as_a_mass_on_a_spring(tmp_path):
    """It has its mass, keeps its speed, does not turn, and is in contact for half a period.

    Its strain, which can keep energy, is 1e-5 of that of the penalty.
    """
    summary, _ = run(tmp_path, DROPPED)
    mass, stiffness = 20, 1e8 * 0.2
    assert summary["mass"] == pytest.approx(mass, rel=1e-12)
    assert summary["rebound_vy"] == pytest.approx(3, rel=1e-5) and abs(summary["rebound_spin"]) < 1e-5
    assert summary["contact_time"] == pytest.approx(math.pi * math.sqrt(mass / stiffness), rel=0.02)


def test_the_penalty_may_stand_in_the_obstacle(tmp_path):
    """It gives the answer of the same number in [contact]; a second obstacle without a number is
    refused, as no body yields."""
    common, _ = run(tmp_path, DROPPED, "common")
    text = DROPPED.replace("[contact]\n", "")
    own, _ = run(tmp_path, text, "own")
    assert all(own[name] == common[name] for name in ("rebound_vy", "contact_time", "peak_force", "warnings"))
    file = tmp_path / "two.toml"
    file.write_text(text + '[[obstacle]]\nkind = "plane"\npoint = [0, 9]\nnormal = [0, -1]\n')
    with pytest.raises(BadInput, match="contact.penalty: 'auto' follows from a body that deforms, and all are rigid"):
        load(str(file))


def test_explicit_steps_have_no_rigid_bodies(tmp_path):
    """A rigid body has no diagonal mass."""
    file = tmp_path / "scene.toml"
    file.write_text('integrator = "central-difference"\n' + DROPPED)
    line = "integrator: 'central-difference', but rigid bodies need another value (accepted: auto|energy-momentum|midpoint|backward-euler|bdf2)"
    with pytest.raises(BadInput, match=re.escape(line)):
        load(str(file))


PUSHED = """
end_time = 0.02
[[body]]
shape = "rectangle"
width = 0.1
height = 0.1
rigid = true
mass = 10
position = [0, 0.5]
[[body.load]]
where = "top"
traction = [1000, 500]
""" + FLOOR


def test_a_load_moves_a_rigid_body_from_rest(tmp_path):
    """v = F t/m, although there is no initial energy as a scale of the residual."""
    summary, _ = run(tmp_path, "young = 1e6\nnu = 0.3\ndensity = 1000\naccuracy = 0.2\n" + PUSHED)
    assert summary["rebound_vx"] == pytest.approx(0.2, rel=1e-9)
    assert summary["rebound_vy"] == pytest.approx(0.1, rel=1e-9)
    assert summary["energy_drift"] < 1e-9


def test_a_rigid_ring_bears_a_gas(tmp_path):
    """It falls as without the gas, for any pressure."""
    ring = PUSHED.replace('"rectangle"\nwidth = 0.1\nheight = 0.1', '"ring"\nradius = 0.05\ninner_radius = 0.04\nvelocity = [0, -1]')
    gas = ring.replace('where = "top"\ntraction = [1000, 500]', 'where = "inner"\ngas = {gauge_pressure = 1e5}')
    summary, _ = run(tmp_path, "accuracy = 0.2\n" + gas)
    assert summary["rebound_vy"] == pytest.approx(-1, rel=1e-9) and summary["energy_drift"] < 1e-9


def test_a_rigid_body_is_asked_for_no_material(tmp_path):
    """The stiffness that represents rigidity is not a material of the user."""
    steel = BLOCK.replace("young = 1e6", "young = 2e11")
    summary, _ = run(tmp_path, DISC + "position = [0, 0.0501]\nvelocity = [0, -50]\n" + steel, accuracy=0.3)
    assert not [warning for warning in summary["warnings"] if warning.startswith("density")]


def test_fields_show_where_a_rigid_body_is(tmp_path):
    """A rigid body has no stress, J = 1, and the displacement of its centre at all nodes: a
    translation."""
    text = DISC + "position = [0, 0.0501]\nvelocity = [0, -1]\n" + BLOCK
    run(tmp_path, "fields = 3\n" + text)
    snapshot = vtu.read(sorted((tmp_path / "scene" / "fields").glob("0*.vtu"))[-1])
    disc = np.linalg.norm(snapshot.points, axis=1) < 0.05 + 1e-6  # in the mesh it is about the origin
    moved = snapshot.fields["displacement"][disc]
    assert disc.sum() > 20 and all(np.isfinite(field).all() for field in snapshot.fields.values())
    assert np.ptp(moved[:, 1]) < 1e-4 * abs(moved[:, 1]).max() and snapshot.fields["von_mises"][disc].max() == 0 < snapshot.fields["von_mises"].max()
    assert snapshot.fields["jacobian"][disc] == pytest.approx(1, abs=1e-4)


def test_two_rigid_discs_on_a_soft_one(tmp_path):
    """The total momentum is constant."""
    soft = '[[body]]\nshape = "disc"\nradius = 0.05\nposition = [0, 0]\nlaw = "neohookean"\nyoung = 1e6\nnu = 0.3\n'
    template = '[[body]]\nshape = "disc"\nradius = 0.03\nrigid = true\nposition = [{}, 0]\nvelocity = [{}, 0]\n'
    summary, history = run(tmp_path, "density = 1000\naccuracy = 0.1\n" + soft + template.format(0.0801, -1) + template.format(-0.0801, 1))
    assert summary["momentum_drift"] < 1e-11 and summary["energy_drift"] < 1e-9
    assert history.momentum_x.abs().max() < 1e-9 * history.momentum_x_2.abs().max()
    assert summary["rebound_vx_2"] == pytest.approx(-summary["rebound_vx_3"], rel=0.02)


def test_a_rigid_ball_of_revolution_falls(tmp_path):
    """On a plane of stiffness k it moves along the axis only and rebounds with its speed."""
    text = ('dimension = "axisymmetric"\ndensity = 1000\naccuracy = 0.05\n[[body]]\nshape = "ball"\nradius = 0.05\nrigid = true\n'
            "position = [0, 0.0501]\nvelocity = [0, -1]\n" + FLOOR)
    summary, _ = run(tmp_path, text)
    assert summary["restitution"] == pytest.approx(1, abs=1e-6)
    assert summary["mass"] == pytest.approx(1000 * 4 / 3 * math.pi * 0.05**3, rel=1e-3)


def test_a_box_spins_freely_in_space(tmp_path):
    """With prescribed moments of inertia angular momentum and energy are constant, and the spin
    precesses."""
    text = ('dimension = "3d"\naccuracy = 0.1\nend_time = 0.12\nmesh_size = 0.02\n[[body]]\nshape = "box"\nwidth = 0.1\nheight = 0.06\n'
            "depth = 0.08\nrigid = true\nmass = 2\ninertia = [0.003, 0.004, 0.0035]\nposition = [0, 1, 0]\nspin = [5, 20, -4]\n"
            '[[obstacle]]\nkind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n[contact]\npenalty = 1e8\n')
    summary, history = run(tmp_path, text, without="flight")
    spin = history[["spin_x", "spin_y", "spin"]].to_numpy()
    assert summary["energy_drift"] < 1e-9 and summary["angular_momentum_drift"] < 1e-9
    energy = 0.5 * np.array([0.003, 0.004, 0.0035]) @ np.array([5.0, 20, -4])**2
    assert summary["rotation_energy"] == pytest.approx(energy, rel=1e-4)
    assert np.abs(spin - spin[0]).max() > 1


@pytest.mark.parametrize("turn, warns", [(0.1, False), (0.3, True)])
def test_a_driven_obstacle_must_not_turn_far_in_a_step(tmp_path, turn, warns):
    """Above 0.2 rad in a step of a given dt there is a warning, with the dt that is small enough.
    Automatic steps are small enough."""
    text = ROLLER.format(f'rotation = "{math.degrees(turn) / 1e-4:.6f}*t"')
    for dt, expected in ((1e-4, warns), (0, False)):
        words = [words for words in run(tmp_path, text, f"dt{dt:g}", dt=dt, end_time=2e-3)[0]["warnings"] if words.startswith("driven obstacle: ")]
        assert bool(words) == expected and all("take a dt of at most 6.7e-05" in line for line in words)


def test_an_obstacle_works_exactly_what_the_body_gains(tmp_path):
    """A polygonal roller moves down and rotates: its work is the energy, its impulse the momentum.
    """
    corners = "kind = 'polyline'\nvertices = [[0.03, 0.06], [-0.03, 0.06], [-0.03, 0.12], [0.03, 0.12]]\nclosed = true\nrounding = 0.004"
    moved = 'motion = [0, "-0.01*sin(pi*t/0.01)"]\nrotation = "-1500*t"\npivot = [0, 0.09]'
    text = ROLLER.replace('kind = "circle"\ncentre = [0, 0.0905]\nradius = 0.04', corners).format(moved)
    summary, history = run(tmp_path, text)
    assert history.friction_work.iloc[-1] > 0.1 and history.external_work.iloc[-1] > 1
    assert summary["energy_drift"] < 1e-9 and summary["momentum_drift"] < 1e-8 and summary["angular_momentum_drift"] < 1e-8


@pytest.mark.parametrize("law, nu", [("svk", 0.47), ("neohookean", 0.49)])
def test_a_rigid_body_has_no_part_in_the_projected_volume_of_others(tmp_path, law, nu):
    """A rigid body has hardly any strain, and the volume ratio of its elements is 1."""
    short = [f"law={law}", f"nu={nu}", "accuracy=0.1", "end_time=0.002"]
    assert main(["run", "drop-weight", "--no-figures", "--no-estimate", "--out", str(tmp_path / "run"), *(word for entry in short for word in ("--set", entry))]) == 0
    history = pd.read_csv(tmp_path / "run/history.csv")
    assert abs(history["elastic_1"]).max() < 1e-4 * history["elastic_2"].max()
    assert 0 < json.loads((tmp_path / "run/summary.json").read_text())["volume_change"] < 0.1


BOX = """
dimension = "3d"
accuracy = 0.1
[[body]]
shape = "box"
width = 0.06
height = 0.03
depth = 0.02
rigid = true
mass = 1
velocity = [0, -1, 0]
"""
GROUND = FLOOR.replace("[0, 0]", "[0, 0, 0]").replace("[0, 1]", "[0, 1, 0]")
TILTED = BOX + "position = [0, 0.0335, 0]\nturn = [20, 0, 30]\n" + GROUND.replace("1e7", "1e9")


def test_a_box_dropped_flat_in_space_rebounds_as_a_mass_on_a_spring(tmp_path):
    """It keeps its speed, and is in contact for half a period of sqrt(m/(k A)). Its sides, which go
    in by 0.3 mm, add 2 % to the area on average."""
    summary, _ = run(tmp_path, BOX + "position = [0, 0.0152, 0]\n" + GROUND.replace("1e7", "1e10"))
    assert summary["dofs"] == 12 and summary["mass"] == pytest.approx(1, rel=1e-12)
    assert summary["rebound_vy"] == pytest.approx(1, rel=1e-5)
    assert summary["contact_time"] == pytest.approx(math.pi * math.sqrt(1 / (1e10 * 0.06 * 0.02)), rel=0.03)


SLIDING = BOX.replace("[0, -1, 0]", "[1, 0, 0]") + "position = [0, 0.015, 0]\n" + GROUND.replace("1e7", "1e8") + "friction_static = 0.5\n"


@pytest.mark.parametrize("accuracy", [0.1, 0.02])
def test_a_box_slides_as_far_as_friction_lets_it(tmp_path, accuracy):
    """The distance is v^2/(2 mu g) until the speed is slip_velocity, below which friction fades.
    The penalty is soft, so a step need not be short: a run has a few hundred steps."""
    text = 'gravity = 9.81\nuntil = "rest"\n' + SLIDING + "penalty_damping = 0.002\n"
    summary, history = run(tmp_path, text, accuracy=accuracy)
    assert history.x.iloc[-1] - history.x.iloc[0] == pytest.approx(1 / (2 * 0.5 * 9.81), rel=2e-3)
    assert summary["friction_work"] == pytest.approx(0.5, rel=2e-3)
    assert summary["steps"] < 300 and summary["dofs"] == 12 and summary["energy_drift"] < 1e-9


def test_a_rigid_body_that_bounces_on_the_penalty_does_not_chatter(tmp_path):
    """Without damping it bounces in short flights. Chatter compares flights with waves, which a
    rigid body does not have."""
    tile = SLIDING.replace("width = 0.06\nheight = 0.03\ndepth = 0.02", "width = 0.1\nheight = 0.04\ndepth = 0.1").replace("0.015", "0.02")
    summary, _ = run(tmp_path, "gravity = 9.81\nend_time = 0.4\n" + tile, accuracy=0.02)
    assert summary["contact_intervals"] > 30 and not [words for words in summary["warnings"] if words.startswith("chatter")]


def test_a_rigid_body_on_a_corner_has_a_coarse_mesh(tmp_path, monkeypatch):
    """A body that deforms at a corner has elements a thousandth as large as itself. The limit of
    unknowns counts those that are solved for."""
    monkeypatch.setattr(solid_mesh, "MOST_UNKNOWNS", 100)
    file = tmp_path / "box.toml"
    file.write_text(TILTED)
    tilted = assembly.assemble(load(str(file)))
    assert 1000 < len(tilted.mesh.cells) < 10_000 and tilted.used["body"][0]["contact_mesh_size"] > 0.001
    monkeypatch.setattr(solid_mesh, "MOST_RIGID_CELLS", 1000)
    with pytest.raises(BadInput, match="contact_mesh_size: the rigid bodies have [0-9]+ tetrahedra .accepted: up to 1000;"):
        assembly.assemble(load(str(file)))
    with pytest.raises(BadInput, match="mesh_size: the bodies have [0-9]+ unknowns"):
        file.write_text(TILTED.replace("rigid = true\nmass = 1", "law = 'svk'\nyoung = 1e7\nnu = 0.3\ndensity = 1000\nmesh_size = 0.01\ncontact_mesh_size = 0.01"))
        assembly.assemble(load(str(file)))


@pytest.mark.robustness
def test_a_corner_needs_no_finer_mesh(tmp_path):
    """With half the element size at the contact, speed and spin after the impact change by less
    than the accuracy, 10 %, of those before."""
    coarse, fine = (run(tmp_path, TILTED, f"size{size}", body__1__contact_mesh_size=size)[0] for size in (0, 0.001))
    assert coarse["rebound_vy"] == pytest.approx(fine["rebound_vy"], abs=0.01)
    assert coarse["rebound_spin"] == pytest.approx(fine["rebound_spin"], abs=0.1 / 0.03)
