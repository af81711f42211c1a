"""Scenes of bodies of revolution: sections, meshes and positions, refused input, and two balls
against Hertz."""

import math

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh
from ffimpact.report import report
from ffimpact.running import run
from ffimpact.scene import load
from ffimpact.scenes import assembly
from tests.support.bodies_axisymmetric import BALL, FLOOR, SHAPES, read
from tests.support.direct import call
from tests.support.triangles import areas

SCRIPT = "bodies-axisymmetric"


def volumes(m: mesh.Mesh) -> tuple[float, float]:
    """The volume of revolution of half a section about x = 0, and the height of its centre."""
    x, y = np.moveaxis(m.points[m.triangles], 2, 0)
    area = areas(m)
    volume = (2 * math.pi * area * x.mean(axis=1)).sum()
    return volume, (2 * math.pi * area / 12 * (x.sum(axis=1) * y.sum(axis=1) + (x * y).sum(axis=1))).sum() / volume


@pytest.mark.parametrize("name", SHAPES)
def test_bodies_are_half_sections_about_their_centres(name):
    """The mesh is the half x >= 0 of the section, with the volume of the body and the centre of
    scene.bin.

    Edges on the axis, and no others, have the label 2. Vertices of the boundary lie on the outline.
    """
    entries, volume = SHAPES[name]
    scene = read(entries | {"position": [0, 5]}, mesh_size=0.05, contact_mesh_size=0.02)
    built = assembly.assemble(scene)
    m = built.mesh
    mesh_volume, height = volumes(m)
    exact = entries["shape"] in ("cylinder", "polygon")
    assert mesh_volume == pytest.approx(volume, rel=1e-12 if exact else 0.03) and abs(height) < (1e-12 if exact else 1e-3)
    assert m.points[:, 0].min() == 0
    on_axis = (m.points[m.edges] == 0).all(axis=1)[:, 0]
    assert np.array_equal(on_axis, m.labels == 2) and set(m.labels) == {1, 2}
    surface = m.points[np.unique(m.edges[~on_axis])]
    assert abs(scene.bodies[0].outline.gap(surface)).max() < (2e-3 if entries["shape"] == "ellipsoid" else 1e-12)


def test_bodies_stand_above_each_other():
    """Bodies are on the axis, apart from each other, region k is body k, and scene.bin has one
    circle of the ball. A number as position is the height."""
    scene = load("ball-cylinder")
    built = assembly.assemble(scene)
    assert (built.centres[:, 0] == 0).all() and scene.bodies[0].start_position.tolist() == [0, 0.051]
    tops = [built.mesh.points[np.unique(built.mesh.triangles[built.regions == k])][:, 1] for k in (0, 1)]
    assert tops[0].max() < tops[1].min()
    assert built.arrays["arcs"] == 1 and set(built.regions[(built.mesh.triangles == built.mesh.edges[built.arrays["mesh.arc_of"] == 0][0, 0]).any(axis=1)]) == {0}


def test_meshes_are_fine_where_bodies_touch():
    """Both faces in contact are fine near the axis."""
    m = assembly.assemble(read(BALL, {"shape": "cylinder", "radius": 2, "height": 1, "position": 0.4}, obstacles=(), mesh_size=0.3, contact_mesh_size=0.02)).mesh
    surface = m.labels == 1
    length, middle = np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1), m.points[m.edges].mean(axis=1)
    assert (length[surface] < 0.03).sum() > 10 and middle[surface & (length < 0.03)][:, 0].max() < 0.5
    assert length[surface & (middle[:, 0] > 1.9)].min() > 0.15


def test_a_body_may_be_a_mesh_file(tmp_path):
    """Half a section in a file, with the label 2 on its axis, is centred at its centre of volume,
    and its circle is recognised. A whole section is refused."""
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), tmp_path / "half.msh")
    mesh.write(mesh.disc(0.05, 0.02, 0.01, False), tmp_path / "whole.msh")
    body, = read({"shape": "mesh", "file": "half.msh", "position": 3}, folder=tmp_path).bodies
    assert body.outline.loops[0].radius == pytest.approx(0.05, rel=1e-9) and abs(body.outline.loops[0].centre).max() < 1e-3
    assert volumes(body.file_mesh)[1] == pytest.approx(0, abs=1e-9)
    with pytest.raises(BadInput, match="^body.1.file: it lies down to x"):
        read({"shape": "mesh", "file": "whole.msh"}, folder=tmp_path)


def test_open_values_are_those_of_a_ball():
    """Automatic penalty and sizes are those of the ball on the plane at the same speed, not those
    of the disc."""
    ball = {"shape": "ball", "radius": 0.05, "position": 0.0501, "velocity": -8}
    body = assembly.assemble(read(ball, obstacles=[FLOOR | {"point": [0, 0]}])).used
    alone = assembly.assemble(load("ball-axisymmetric").override({"law": "svk", "penalty": "auto"})).used
    assert body["contact"]["penalty"] == pytest.approx(alone["contact"]["penalty"], rel=1e-9)
    assert body["body"][0]["contact_mesh_size"] == pytest.approx(alone["body"][0]["contact_mesh_size"], rel=1e-9)


# ---- runs

@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    """The built-in scene at a fiftieth of its speed."""
    values = {"body.1.velocity": -0.01, "body.2.velocity": 0.01, "body.1.position": 0.010001, "body.2.position": -0.010001, "fields": 2}
    result = run.run(load("two-balls"), values, tmp_path_factory.mktemp("slow") / "slow", estimate=False)
    report.draw(result)
    return result


def test_two_balls_of_hertz(slow):
    """Contact time, largest force and approach of a slow impact agree with Hertz to 2 % (Johnson,
    Contact mechanics, 11.4).

    The momentum of each ball is reversed, columns of other axes are empty, and no unit is per
    metre.
    """
    h, s = slow.history, slow.summary
    mass, stiff, radius, closing = 4 / 3 * math.pi * 1e-6 * 2500, 1e8 / (1 - 0.3**2) / 2, 0.005, 0.02
    approach = (15 * mass / 2 * closing**2 / (16 * math.sqrt(radius) * stiff)) ** 0.4
    assert s["contact_time"] == pytest.approx(2.9432 * approach / closing, rel=0.02)
    assert s["peak_force"] == pytest.approx(4 / 3 * stiff * math.sqrt(radius) * approach**1.5, rel=0.02)
    assert (h["y_1"] - h["y_2"])[0] - (h["y_1"] - h["y_2"]).min() - 2e-6 == pytest.approx(approach, rel=0.02)
    assert s["impulse"] == pytest.approx(2 * mass * closing / 2, rel=2e-3) and s["mass_1"] == pytest.approx(mass, rel=2e-3)
    assert not h["vx_1"].any() and not h["spin_2"].any() and s["energy_drift"] < 1e-8
    assert s["rebound_vy_1"] == pytest.approx(-s["rebound_vy_2"], rel=1e-6)
    text = report.report(slow, verbose=True)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    assert {path.stem for path in (slow.folder / "figures").iterdir()} == {"energies", "force", "velocity", "shapes", "contact"}


@pytest.mark.robustness
def test_the_scene_as_used_makes_the_same_run(slow, tmp_path):
    """scene.toml has the dimension and only parameters of the script, and gives the same data file
    and mesh. The script alone gives exactly the same history."""
    again = load(str(slow.folder / "scene.toml"))
    assert again.kind.script == SCRIPT and set(again.values) <= set(parameters.PARAMETERS)
    made = assembly.assemble(again)
    assert made.data == (slow.folder / "scene.bin").read_bytes() and to_toml(made.used) == (slow.folder / "scene.toml").read_text()
    code, _, _ = call("-scene", str(slow.folder / "scene.bin"), "-out", str(tmp_path / "direct"), cwd=tmp_path, kind=SCRIPT)
    assert code == 0 and (tmp_path / "direct/history.csv").read_text() == (slow.folder / "history.csv").read_text()


def test_a_ball_alone_is_that_of_its_own_script(tmp_path):
    """On a rigid plane, with equal mesh sizes, penalty and step, it agrees with ball-axisymmetric
    to the difference of the meshes."""
    values = {"law": "neohookean", "nu": 0.3, "accuracy": 0.02, "speed": 2}
    alone = run.run(load("ball-axisymmetric"), values | {"penalty": "auto", "fields": 0}, tmp_path / "alone", estimate=False).summary
    scene = read({"shape": "ball", "radius": 0.05, "position": 0.05, "velocity": -2}, obstacles=[FLOOR | {"point": [0, 0]}], law="neohookean", nu=0.3, accuracy=0.02)
    body = run.run(scene, {}, tmp_path / "body", estimate=False).summary
    for name, off in (("impulse", 2e-3), ("peak_force", 0.01), ("rebound_vy", 2e-3), ("contact_time", 0.02)):
        assert body[name] == pytest.approx(alone[name], rel=off), name


def test_a_ball_falls_through_a_rigid_funnel_with_friction(tmp_path):
    """A ball falls into a cone under gravity: friction on the radial creep takes energy, and the
    balance closes."""
    scene = read({"shape": "ball", "radius": 0.05, "position": 0.0715, "velocity": -3}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 1]]}],
                 law="neohookean", accuracy=0.1, gravity=9.81, contact={"friction_static": 0.3}, end_time=4e-3)
    summary = run.run(scene, {}, tmp_path / "funnel", estimate=False).summary
    assert summary["peak_force"] > 0 and summary["friction_work"] > 0 and summary["energy_drift"] < 1e-6


@pytest.mark.parametrize("wall", [
    {"kind": "implicit", "distance": "y - sqrt(x^2 + 1e-10)"}, {"kind": "polyline", "vertices": [[0, 0], [1, 1]]}])
def test_a_ball_in_a_funnel_touches_its_wall(tmp_path, wall):
    """A ball falls into a funnel of 45 degrees. Its centre on the axis is nearer to the wall than
    to the apex.

    Contact begins when the centre is sqrt(2) radii above the apex, and energy is conserved.
    """
    ball = {"shape": "ball", "radius": 0.03, "position": 0.05, "velocity": -2}
    scene = read(ball, obstacles=(wall,), young=7e6, nu=0.3, density=1000, law="neohookean", accuracy=0.1)
    s = run.run(scene, {}, tmp_path / "out", estimate=False).summary
    assert s["contact_start"] == pytest.approx((0.05 - 0.03 * math.sqrt(2)) / 2, rel=5e-3)
    assert s["energy_drift"] < 1e-9 and 0.9 < s["restitution"] < 1
