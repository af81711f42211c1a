"""Scenes of bodies of revolution: sections, their meshes and places, what is refused, and two balls against Hertz."""

import math

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh
from ffimpact.report import report
from ffimpact.running import run
from ffimpact.scene import SCENES, Scene, load
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly
from test_direct import call
from triangles import areas

SCRIPT = "bodies-axisymmetric"
BALL = {"name": "ball", "shape": "ball", "radius": 0.5, "position": [0, 1.5], "velocity": -10}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, -1], "normal": [0, 1]}
SCENE = {"dimension": "axisymmetric", "young": 7e6, "nu": 0.45, "density": 1722, "law": "svk"}


def read(*tables: dict, obstacles=(FLOOR,), folder=SCENES, **top) -> Scene:
    return read_scene(SCENE | top | {"body": [{"position": 0} | table for table in tables], "obstacle": list(obstacles)}, folder, "scene")


def volumes(m: mesh.Mesh) -> tuple[float, float]:
    """The volume that a section's half makes about x = 0, and the height of its centre."""
    x, y = np.moveaxis(m.points[m.triangles], 2, 0)
    area = areas(m)
    volume = (2 * math.pi * area * x.mean(axis=1)).sum()
    return volume, (2 * math.pi * area / 12 * (x.sum(axis=1) * y.sum(axis=1) + (x * y).sum(axis=1))).sum() / volume


# ---- shapes

SHAPES = {   # volume
    "ball": ({"shape": "ball", "radius": 0.3}, 4 / 3 * math.pi * 0.027),
    "ellipsoid": ({"shape": "ellipsoid", "semi_axes": [0.3, 0.1]}, 4 / 3 * math.pi * 0.009),
    "cylinder": ({"shape": "cylinder", "radius": 0.2, "height": 0.5}, math.pi * 0.02),
    "cone": ({"shape": "polygon", "vertices": [[0, 1], [0.6, 2], [0, 2]]}, math.pi * 0.12),
    "cone, downwards": ({"shape": "polygon", "vertices": [[0, 2], [0.6, 2], [0, 1]]}, math.pi * 0.12),
}


@pytest.mark.parametrize("name", SHAPES)
def test_bodies_are_half_sections_about_their_centres(name):
    """The mesh is the half x >= 0 of the section: it makes the body's volume, its centre where scene.dat says; edges on the axis, and no others,
    have the label 2; vertices of the boundary lie on the outline."""
    entries, volume = SHAPES[name]
    scene = read(entries | {"position": [0, 5]}, mesh_size=0.05, contact_mesh_size=0.02)
    built = assembly.assemble(scene)
    m = built.mesh
    found, height = volumes(m)
    exact = entries["shape"] in ("cylinder", "polygon")
    assert found == pytest.approx(volume, rel=1e-12 if exact else 0.03) and abs(height) < (1e-12 if exact else 1e-3)
    assert m.points[:, 0].min() == 0
    on_axis = (m.points[m.edges] == 0).all(axis=1)[:, 0]
    assert np.array_equal(on_axis, m.labels == 2) and set(m.labels) == {1, 2}
    surface = m.points[np.unique(m.edges[~on_axis])]
    assert abs(scene.bodies[0].outline.gap(surface)).max() < (2e-3 if entries["shape"] == "ellipsoid" else 1e-12)


def test_a_cone_is_about_its_centre_of_volume():
    """A quarter of its height from the base, not a third as the centre of its section."""
    cone, = read(SHAPES["cone"][0]).bodies
    assert cone.outline.points[:, 1].max() == pytest.approx(0.25) and cone.outline.points[:, 1].min() == pytest.approx(-0.75)


def test_bodies_stand_above_each_other():
    """On the axis, apart from each other, region k body k, one circle of the ball in scene.dat; a fall finds its place by position alone."""
    scene = load("ball-cylinder")
    built = assembly.assemble(scene)
    assert (built.centres[:, 0] == 0).all() and scene.bodies[0].position.tolist() == [0, 0.051]
    tops = [built.mesh.points[np.unique(built.mesh.triangles[built.regions == k])][:, 1] for k in (0, 1)]
    assert tops[0].max() < tops[1].min()
    lines = built.data.splitlines()
    assert lines[5] == "circles 1" and lines[6].split()[0] == "0"


def test_meshes_are_fine_where_bodies_touch():
    """Near the axis, on both faces that meet."""
    m = assembly.assemble(read(BALL, {"shape": "cylinder", "radius": 2, "height": 1, "position": 0.4}, obstacles=(), mesh_size=0.3, contact_mesh_size=0.02)).mesh
    surface = m.labels == 1
    length, middle = np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1), m.points[m.edges].mean(axis=1)
    assert (length[surface] < 0.03).sum() > 10 and middle[surface & (length < 0.03)][:, 0].max() < 0.5
    assert length[surface & (middle[:, 0] > 1.9)].min() > 0.15


def test_a_body_may_be_a_mesh_file(tmp_path):
    """Half a section in a file, its axis labelled 2: about its centre of volume, the circle found; a whole section is refused."""
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), tmp_path / "half.msh")
    mesh.write(mesh.disc(0.05, 0.02, 0.01, False), tmp_path / "whole.msh")
    body, = read({"shape": "mesh", "file": "half.msh", "position": 3}, folder=tmp_path).bodies
    assert body.outline.loops[0].radius == pytest.approx(0.05, rel=1e-9) and abs(body.outline.loops[0].centre).max() < 1e-3
    assert volumes(body.mesh)[1] == pytest.approx(0, abs=1e-9)
    with pytest.raises(BadInput, match="^body.1.file: it lies down to x"):
        read({"shape": "mesh", "file": "whole.msh"}, folder=tmp_path)


def test_a_rigid_profile_is_a_surface_of_revolution():
    """A polyline from the axis outwards and its mirror image: distances from a cone's tip and from its flank; from axis to axis it closes."""
    with pytest.raises(BadInput, match="is no section of a surface of revolution"):
        read(BALL, obstacles=[{"kind": "polyline", "vertices": [[1, -1], [2, 0]]}])
    with pytest.raises(BadInput, match="overlaps"):                       # travelled inwards all but the cone is solid
        read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[1, -1], [0, 0]]}])
    cone = read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, -1]]}]).obstacles[0]
    assert cone.gap(np.array([[0, 1.0], [1, 0], [-1, 0], [0, -1]])) == pytest.approx([1, math.sqrt(0.5), math.sqrt(0.5), -math.sqrt(0.5)])
    block = read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 0], [1, -1], [0, -1]]}]).obstacles[0]
    assert block.numbers[0] == 1 and block.gap(np.array([[0, 1.0], [0, -0.4]])) == pytest.approx([1, -0.4])


def test_open_values_are_those_of_a_ball():
    """Penalty and sizes are what the ball on the plane gets of the same speed, not the disc."""
    ball = {"shape": "ball", "radius": 0.05, "position": 0.0501, "velocity": -8}
    body = assembly.assemble(read(ball, obstacles=[FLOOR | {"point": [0, 0]}])).used
    alone = load("ball-axisymmetric").override({"law": "svk", "penalty": "auto"}).description()["used"]
    assert body["contact"]["penalty"] == pytest.approx(alone["penalty"], rel=1e-9)
    assert body["body"][0]["contact_mesh_size"] == pytest.approx(alone["contact_mesh_size"], rel=1e-9)


# ---- what is refused

BAD = [
    ({"position": [0.1, 2]}, {}, "body.1.position: x is 0.1, off the axis of revolution (accepted: [0, y], or y alone)"),
    ({"velocity": [1, 0]}, {}, "body.1.velocity: x is 1, off the axis"),
    ({"velocity": "fast"}, {}, "body.1.velocity: 'fast' is not a number"),
    ({"spin": 3}, {}, "body.1.spin: no such entry, set to '3'"),
    ({"angle": 30}, {}, "body.1.angle: no such entry, set to '30'"),
    ({"shape": "disc"}, {}, "body.1.shape: 'disc' is not known (accepted: ball|shell|ellipsoid|cylinder|polygon|tube|torus|mesh)"),
    ({"shape": "polygon", "vertices": [[0, 0], [1, 0], [1, 1]]}, {}, "body.1.vertices: do not go from the axis to the axis"),
    ({}, {"body_force_x": 1}, "body_force_x: bodies-axisymmetric takes no such parameter"),
    ({}, {"contact": {"pairing": "pairwise"}}, "pairing: bodies-axisymmetric takes no such parameter"),
    ({}, {"dimension": "2d"}, "dimension: '2d' is not known (accepted: plane-strain|axisymmetric"),
    ({}, {"script": "bodies"}, "script: 'bodies' is not that of [[body]] tables in dimension = 'axisymmetric' (accepted: bodies-axisymmetric)"),
    ({"position": -0.8}, {}, "body.1.position: 'ball' overlaps 'floor'"),
]


@pytest.mark.parametrize("entries, top, words", BAD, ids=[words.split(" (")[0] for *_, words in BAD])
def test_what_is_wrong_is_named(entries, top, words):
    """One line with the entry, the value and what is accepted, exit code 10."""
    table = {key: value for key, value in BALL.items() if key != "radius" or entries.get("shape", "ball") == "ball"}
    with pytest.raises(BadInput) as caught:
        read(table | entries, **top)
    assert words in str(caught.value) and caught.value.code == 10 and "\n" not in str(caught.value)


@pytest.mark.parametrize("obstacle, words", [
    ({"normal": [1, 1]}, "obstacle.1.normal: '[1, 1]' is not along the axis of revolution (accepted: [0, 1] or [0, -1])"),
    ({"velocity": [1, 0]}, "obstacle.1.velocity: x is 1, off the axis"),
    ({"kind": "circle"}, "obstacle.1.kind: 'circle' is not known (accepted: plane|sphere|bowl|polyline|implicit)")])
def test_obstacles_off_the_axis_are_refused(obstacle, words):
    """Planes across the axis, everything else on it."""
    with pytest.raises(BadInput) as caught:
        read(BALL, obstacles=[FLOOR | obstacle])
    assert words in str(caught.value)


@pytest.mark.parametrize("old, new, said", [
    ("0 1.5 0.0 0.0 -10", "0 1.5 0.0 1.0 -10", "ball leaves the axis of revolution: its x, angle, vx or spin is not 0"),
    ("plane 4 0.0 -1.0 0.0 1.0", "plane 4 0.0 -1.0 1.0 1.0", "obstacle 1 is none of revolution"),
    (" 2\n", " 1\n", "has the label 1 (accepted: 2 on x = 0")])
def test_the_script_looks_at_its_files(tmp_path, old, new, said):
    """Of files that were made by hand the script refuses what is not of revolution, with exit code 10 and one line."""
    assembly.assemble(read(BALL, mesh_size=0.3, contact_mesh_size=0.1)).write(tmp_path)
    file = tmp_path / ("mesh.msh" if "\n" in old else "scene.dat")
    text = file.read_text().replace("0.0 1.5 0.0 0.0 -10", "0 1.5 0.0 0.0 -10")
    assert old in text
    file.write_text(text.replace(old, new))
    code, _, error = call("-mesh", "mesh.msh", "-bodies", "scene.dat", "-accuracy", "0.4", "-out", "out", cwd=tmp_path, script=SCRIPT)
    assert code == 10 and said in error and error.count("\n") == 1


# ---- runs

@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    """The built-in scene at a fiftieth of its speed."""
    given = {"body.1.velocity": -0.01, "body.2.velocity": 0.01, "body.1.position": 0.010001, "body.2.position": -0.010001, "fields": 2}
    found = run.run(load("two-balls"), given, tmp_path_factory.mktemp("slow") / "slow", estimate=False)
    report.draw(found)
    return found


def test_two_balls_of_hertz(slow):
    """Contact time, largest force and approach of a slow impact are Hertz' to 2 % (Johnson, Contact mechanics, 11.4), the momentum of each
    ball turns round, the other axes stay empty, and nothing is per metre."""
    h, s = slow.history, slow.summary
    mass, stiff, radius, closing = 4 / 3 * math.pi * 1e-6 * 2500, 1e8 / (1 - 0.3**2) / 2, 0.005, 0.02
    approach = (15 * mass / 2 * closing**2 / (16 * math.sqrt(radius) * stiff)) ** 0.4
    assert s["contact_time"] == pytest.approx(2.9432 * approach / closing, rel=0.02)
    assert s["peak_force"] == pytest.approx(4 / 3 * stiff * math.sqrt(radius) * approach**1.5, rel=0.02)
    assert (h["y_1"] - h["y_2"])[0] - (h["y_1"] - h["y_2"]).min() - 2e-6 == pytest.approx(approach, rel=0.02)
    assert s["impulse"] == pytest.approx(2 * mass * closing / 2, rel=2e-3) and s["mass_1"] == pytest.approx(mass, rel=2e-3)
    assert not h["vx_1"].any() and not h["spin_2"].any() and s["energy_drift"] < 1e-8
    assert s["rebound_vy_1"] == pytest.approx(-s["rebound_vy_2"], rel=1e-6)
    text = report.report(slow)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    assert {path.stem for path in (slow.folder / "figures").iterdir()} == {"energies", "force", "velocity", "shapes", "contact"}


@pytest.mark.robustness
def test_the_scene_as_used_makes_the_same_run(slow, tmp_path):
    """scene.toml names the dimension, has only parameters that the script takes, and makes the same data file and mesh again; the very same
    history comes from the script alone."""
    again = load(str(slow.folder / "scene.toml"))
    assert again.script == SCRIPT and set(again.values) <= set(parameters.names(SCRIPT))
    made = assembly.assemble(again)
    assert made.data == (slow.folder / "scene.dat").read_text() and to_toml(made.used) == (slow.folder / "scene.toml").read_text()
    flags = freefem.words_of({name: value for name, value in (again.values | made.values).items() if name != "pair"})
    code, _, _ = call(*flags, "-mesh", str(slow.folder / "mesh.msh"), "-bodies", str(slow.folder / "scene.dat"), "-out", str(tmp_path / "direct"),
                      cwd=tmp_path, script=SCRIPT)
    assert code == 0 and (tmp_path / "direct/history.csv").read_text() == (slow.folder / "history.csv").read_text()


def test_a_ball_alone_is_that_of_its_own_script(tmp_path):
    """On a rigid plane, of the same mesh sizes, penalty and step, it is ball-axisymmetric's ball to what their meshes differ."""
    given = {"law": "neohookean", "nu": 0.3, "accuracy": 0.02, "speed": 2}
    alone = run.run(load("ball-axisymmetric"), given | {"penalty": "auto", "fields": 0}, tmp_path / "alone", estimate=False).summary
    scene = read({"shape": "ball", "radius": 0.05, "position": 0.05, "velocity": -2}, obstacles=[FLOOR | {"point": [0, 0]}], law="neohookean", nu=0.3, accuracy=0.02)
    body = run.run(scene, {}, tmp_path / "body", estimate=False).summary
    for name, off in (("impulse", 2e-3), ("peak_force", 0.01), ("rebound_vy", 2e-3), ("contact_time", 0.02)):
        assert body[name] == pytest.approx(alone[name], rel=off), name


def test_a_ball_falls_through_a_rigid_funnel_with_friction(tmp_path):
    """A ball falls into a conical bowl under gravity: friction of the radial creep takes energy, and the balance stays closed."""
    scene = read({"shape": "ball", "radius": 0.05, "position": 0.0715, "velocity": -3}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 1]]}],
                 law="neohookean", accuracy=0.1, gravity=9.81, contact={"friction_static": 0.3}, end_time=4e-3)
    summary = run.run(scene, {}, tmp_path / "funnel", estimate=False).summary
    assert summary["peak_force"] > 0 and summary["friction_work"] > 0 and summary["energy_drift"] < 1e-6


@pytest.mark.parametrize("wall", [
    {"kind": "implicit", "distance": "y - sqrt(x^2 + 1e-10)"}, {"kind": "polyline", "vertices": [[0, 0], [1, 1]]}])
def test_a_ball_in_a_funnel_touches_its_wall(tmp_path, wall):
    """A ball comes down a funnel of 45 degrees: its centre, on the axis, is nearer to the wall than to
    the tip. It touches the wall when its centre is sqrt(2) radii above the tip, and energy is kept."""
    ball = {"shape": "ball", "radius": 0.03, "position": 0.05, "velocity": -2}
    given = read(ball, obstacles=(wall,), young=7e6, nu=0.3, density=1000, law="neohookean", accuracy=0.1)
    s = run.run(given, {}, tmp_path / "out", estimate=False).summary
    assert s["contact_start"] == pytest.approx((0.05 - 0.03 * math.sqrt(2)) / 2, rel=5e-3)
    assert s["energy_drift"] < 1e-9 and 0.9 < s["restitution"] < 1
