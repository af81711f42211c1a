"""Restitution, angles and slip of spinning bodies, and results that are omitted because they have
no meaning."""

import json
import math

import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.freefem import freefem
from ffimpact.input.parameters import ROOT
from ffimpact.mesh import gmsh_file, mesh
from ffimpact.output.evaluate import evaluate
from ffimpact.report import report
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from tests.support.direct import case

COARSE = {"law": "neohookean", "accuracy": 0.1, "fields": 0}
RADIUS = 0.05


def go(out, name: str, values: dict | None = None) -> tuple[pd.Series, run.Record]:
    result = run.run(scene.load(name), values or {}, out, estimate=False)
    return pd.read_csv(result.folder / "contacts.csv").iloc[0], result


@pytest.mark.few(1)
@pytest.mark.parametrize("name, speed, spin", [("disc-normal", 1, 100), ("ball", 3, 400)])
def test_spin_has_no_part_in_restitution(tmp_path, name, speed, spin):
    """For a round body without friction, approach and all three restitutions are those of the
    centre for any spin. The slip is that of the rim."""
    row, result = go(tmp_path / "out", name, COARSE | {"speed": speed, "spin": spin, "body.1.position.2": 0.06})
    e = result.summary["rebound_vy"] / speed
    assert row.approach == pytest.approx(speed, rel=1e-9) and row.separation == pytest.approx(e * speed, rel=1e-6)
    assert [row.restitution, row.restitution_poisson, row.restitution_energetic] == pytest.approx([e, e, e], rel=1e-5)
    assert result.summary["restitution"] == pytest.approx(row.restitution, rel=1e-9)
    assert row.slip_before == pytest.approx(spin * RADIUS, rel=1e-3)


def test_spin_of_two_discs(tmp_path):
    """Two spinning discs collide off centre: the approach velocity is that of the centres along the
    line between them at contact."""
    text = (ROOT / "orchestrate/ffimpact/scenes/two-discs.toml").read_text().replace("friction_static = 0.3", "friction_static = 0")
    path = tmp_path / "spinning.toml"
    path.write_text("accuracy = 0.1\n" + text.replace("velocity = [3, 0]", "velocity = [3, 0]\nspin = 200").replace("velocity = [-3, 0]", "velocity = [-3, 0]\nspin = 150"))
    row, result = go(tmp_path / "out", str(path), {"fields": 0})
    assert row.approach == pytest.approx(6 * math.sqrt(0.1**2 - 0.02**2) / 0.1, rel=2e-4)
    assert row.slip_before == pytest.approx(abs(6 * 0.2 - 350 * RADIUS), rel=2e-4)


def test_circle_about_another_point(tmp_path):
    """A disc with a hole beside its centre has rotated before contact. The contact point is below
    the centre of the circle, which rotates about the centre of mass."""
    hole, beside = 0.02, 0.025
    with mesh.gmsh_session() as gmsh:
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.008)
        occ = gmsh.model.occ
        occ.cut([(2, occ.addDisk(0, 0, 0, RADIUS, RADIUS))], [(2, occ.addDisk(0, beside, 0, hole, hole))])
        occ.synchronize()
        gmsh.model.mesh.generate(2)
        mesh.write(gmsh_file.taken(gmsh.model), tmp_path / "m.msh")
    body = {"shape": "mesh", "file": str(tmp_path / "m.msh"), "radius": None, "position.2": RADIUS + 0.01, "speed": 1, "spin": 100}
    row, _ = go(tmp_path / "out", "disc-normal", {f"body.1.{name}": value for name, value in body.items()} | {"accuracy": 0.2})
    turned, lever = 100 * row.start, beside * hole**2 / (RADIUS**2 - hole**2)
    assert 0.5 < turned < 1.5
    assert row.approach == pytest.approx(1 + 100 * lever * math.sin(turned), rel=2e-3)


HEAD = 'law = "neohookean"\nyoung = 7e6\nnu = 0.3\ndensity = 1722\naccuracy = 0.2\n'
FLOOR = '[[obstacle]]\nname = "floor"\nkind = "plane"\npoint = [0, 0]\nnormal = [0, 1]\n'
DISC = '[[body]]\nname = "{name}"\nshape = "disc"\nradius = 0.05\nposition = [{x}, 0]\nvelocity = [{v}, {across}]\n'
SQUARE = '[[body]]\nname = "square"\nshape = "rectangle"\nwidth = 0.1\nheight = 0.1\nangle = {angle}\nposition = [0, {y}]\nvelocity = [0, {v}]\n'
BLOCK = '[[body]]\nname = "block"\nshape = "rectangle"\nwidth = 0.3\nheight = 0.1\nposition = [0.011, -0.05]\n'
ABOUT_AN_IMPACT = ("restitution", "restitution_tangential", "angle_out")


def simulate(tmp_path, text: str, values: dict | None = None) -> tuple[pd.DataFrame, run.Record]:
    (tmp_path / "given.toml").write_text(HEAD + text)
    result = run.run(scene.load(str(tmp_path / "given.toml")), {"fields": 0} | (values or {}), tmp_path / "out", estimate=False)
    return pd.read_csv(result.folder / "contacts.csv"), result


def test_a_corner_has_the_normal_of_its_contact(tmp_path):
    """A square lands on a block with a corner, whose two faces come into contact one after the
    other.

    The approach velocity is the speed, and Newton's restitution equals Poisson's.
    """
    rows, result = simulate(tmp_path, SQUARE.format(angle=45, y=0.0731, v=-2) + BLOCK)
    assert rows.approach[0] == pytest.approx(2, rel=1e-3) and rows.restitution[0] == pytest.approx(rows.restitution_poisson[0], rel=5e-3)
    assert rows.restitution_energetic[0] == pytest.approx(rows.restitution_poisson[0], rel=5e-3) and result.summary["restitution"] == pytest.approx(rows.restitution[0])


def test_a_body_at_rest_has_no_restitution(tmp_path):
    """A square on the floor under its weight approaches with round-off and never leaves."""
    rows, result = simulate(tmp_path, SQUARE.format(angle=0, y=0.05, v=-1e-13) + FLOOR, {"gravity": 9.81, "end_time": 0.01, "body.1.contact_mesh_size": 0.01})
    assert len(rows) == 1 and rows.loc[0, [*ABOUT_AN_IMPACT, "restitution_poisson", "restitution_energetic", "separation", "angle_in"]].isna().all()
    assert all(result.summary[name] is None for name in (*ABOUT_AN_IMPACT, "angle_in")) and result.summary["impulse_ratio"] == 0


def test_two_corners_are_two_impacts(tmp_path):
    """A square lands on one corner, then on the other: each impact has its restitution, the run has
    none."""
    rows, result = simulate(tmp_path, SQUARE.format(angle=20, y=0.08, v=-2) + FLOOR, {"end_time": 0.045})
    assert 0.5 < rows.restitution[0] < 1 and rows.approach[1] > 0.3 and result.summary["restitution"] is result.summary["angle_out"] is None


def test_a_head_on_hit_has_no_tangential_restitution(tmp_path):
    """In a central impact of two discs the meshes cause the slip. Without friction there is no
    tangential impulse, also if both drift."""
    discs = [DISC.format(name=name, x=x, v=v, across=40) for name, x, v in (("left", -0.0502, 3), ("right", 0.0502, -3))]
    rows, result = simulate(tmp_path, "".join(discs), {"contact.friction_static": 0.3})
    assert rows.restitution_tangential.isna().all() and result.summary["restitution_tangential"] is None and 0.5 < result.summary["restitution"] <= 1
    assert result.summary["impulse_ratio"] < 1e-2 and result.summary["angular_momentum_drift"] < 1e-6
    assert simulate(tmp_path, "".join(discs))[1].summary["impulse_ratio"] == 0


@pytest.mark.parametrize("spin", [50, 60])
def test_angles_of_a_body_that_comes_along_the_normal(tmp_path, spin):
    """The tangential velocity of its centre before the impact is round-off of either sign. The
    angle afterwards is on the side to which it leaves."""
    values = dict(law="neohookean", speed=4, spin=spin, friction_static=0.3, accuracy=0.1, fields=0, out=tmp_path / "out")
    freefem.find().call(*case(values), check=True)
    evaluate(tmp_path / "out")
    row, s = pd.read_csv(tmp_path / "out/contacts.csv").iloc[0], json.loads((tmp_path / "out/summary.json").read_text())
    assert abs(s["rebound_vx"]) > 1
    assert s["angle_out"] == pytest.approx(math.degrees(math.atan2(s["rebound_vy"], abs(s["rebound_vx"]))), rel=1e-6) == pytest.approx(row.angle_out)


def test_a_spin_about_x_strains_too(tmp_path):
    """The flight to contact is that of an unstressed body. The strain that its spin would cause is
    reported for any axis."""
    ball = {"shape": "ball", "radius": 0.05, "position": [0, 0.06, 0], "velocity": [0, -1, 0], "spin": [700, 0, 0], "mesh_size": 0.03, "contact_mesh_size": 0.02}
    tables = {"dimension": "3d", "law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "accuracy": 0.2, "degree": 1, "dt": 5e-5, "end_time": 0.0107,
              "body": [ball], "obstacle": [{"kind": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]}]}
    result = run.run(read_scene(tables, tmp_path, "ball"), {"fields": 0}, tmp_path / "out", estimate=False)
    assert any(warning.startswith("flight: ") and "by 31 %" in warning for warning in result.summary["warnings"])


def test_velocities_at_the_end_of_contact_and_of_the_run(tmp_path):
    """A disc that spins falls on a rough floor and flies on until end_time: at the end of contact it
    has the rebound, at the end of the run g t less, and the same spin and velocity along the
    floor but for the vibration. Without end_time the run does not go on."""
    tables = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "gravity": 9.81, "accuracy": 0.05,
              "body": [{"name": "disc", "shape": "disc", "radius": 0.05, "position": [0, 0.06], "velocity": [1, -3], "spin": 50}],
              "obstacle": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}], "contact": {"friction_static": 0.3}}
    result = run.run(read_scene(tables | {"end_time": 0.03}, ROOT, "on"), {"fields": 0}, tmp_path / "on", estimate=False)
    s = result.summary
    flown = 0.03 - s["contact_start"] - s["contact_time"]
    assert flown > 0.01 and s["final_vy"] == pytest.approx(s["rebound_vy"] - 9.81 * flown, rel=1e-9)
    assert s["final_vx"] == pytest.approx(s["rebound_vx"], rel=1e-9) and s["final_spin"] == pytest.approx(s["rebound_spin"], rel=0.02)
    assert s["restitution"] == pytest.approx(s["rebound_vy"] / math.hypot(3, math.sqrt(2 * 9.81 * 0.01)), rel=1e-3)
    lines = [line.split()[:3] for line in report.report(result).splitlines()]
    assert ["rebound", "velocity,", "y"] in lines and ["final", "velocity,", "y"] in lines
    single = run.run(read_scene(tables, ROOT, "single"), {"fields": 0}, tmp_path / "single", estimate=False)
    assert single.summary["final_vy"] is None and single.summary["rebound_vy"] == pytest.approx(s["rebound_vy"], rel=1e-3)
