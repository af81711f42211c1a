"""Scenes from files: bodies, one mesh and a data file. Every error is reported in one line."""

import math
import os
import tomllib

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.geometry.outlines import ellipse_loop, polygon_loop, self_crossing
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh
from ffimpact.output.errors import zero_by_symmetry
from ffimpact.scene import load, read as read_scene
from ffimpact.scenes import assembly
from ffimpact.scenes.entries import set_entry
from ffimpact.scenes.mirror import symmetric_along
from ffimpact.scenes.sizes import Impact
from tests.support.bodies import FLOOR, SCENE, SQUARE, changed, read, with_body


def test_bodies_lie_where_the_file_says():
    """`position` is the centre of area, and `angle` rotates the body about it counter-clockwise."""
    body = read(with_body(shape="polygon", vertices=[[5, 5], [7, 5], [7, 6], [5, 6]], position=[1, 2], angle=90)).bodies[0]
    assert sorted(map(tuple, body.placed.loops[0].corners.round(12))) == [(0.5, 1.0), (0.5, 3.0), (1.5, 1.0), (1.5, 3.0)]
    assert body.placed.area_centre == pytest.approx([1, 2])


@pytest.mark.parametrize("position, low", [(None, [2, 1]), ([1, 3], [3, 4])])
def test_a_drawn_body_keeps_its_coordinates(position, low):
    """`position` moves the origin of the drawing; the body turns about its centre of mass. Without
    placement the position of the centre is required."""
    entries = {"shape": "polygon", "vertices": [[2, 1], [5, 1], [2, 4]], "placement": "as-drawn"}
    entries |= {"position": position} if position else {}
    body, = read(SCENE | {"body": [entries]}).bodies
    assert body.placed.points.min(axis=0) == pytest.approx(low)
    turned, = read(SCENE | {"body": [entries | {"angle": 90}]}).bodies
    for made in (body, turned):
        assert made.start_position == pytest.approx(np.add(low, [1, 1]))
    missing = {name: value for name, value in entries.items() if name not in ("placement", "position")}
    with pytest.raises(BadInput, match="body.1.position: is missing"):
        read(SCENE | {"body": [missing]})


def test_a_drawn_section_keeps_its_coordinates():
    """A cone of revolution with its base at y = 2 and its tip at y = 6: centre a quarter up."""
    cone = {"shape": "polygon", "vertices": [[0, 2], [1, 2], [0, 6]], "placement": "as-drawn"}
    body, = read(SCENE | {"dimension": "axisymmetric", "body": [cone]}).bodies
    assert body.start_position == pytest.approx([0, 3])


@pytest.mark.parametrize("entries, velocity", [({"velocity": [1, -2]}, [1, -2]), ({"speed": 3, "direction": -90}, [0, -3]),
                                               ({"speed": 2, "direction": 30}, [math.sqrt(3), 1]), ({}, [0, 0])])
def test_velocity_or_speed_and_direction(entries, velocity):
    """`direction` is measured counter-clockwise from x. Right angles are exact."""
    assert read(with_body(shape="disc", radius=1, **entries)).bodies[0].start_velocity == pytest.approx(velocity, rel=1e-15, abs=0)


def test_material_comes_from_the_body_or_from_the_top():
    """Material entries that a body does not have come from the top of the file."""
    first, second = read(changed(("body.2.young", 1e9), ("body.2.law", "neohookean"))).bodies
    soft = first.made_of
    assert (soft.law, soft.young, soft.nu, soft.density) == ("svk", 7e6, 0.45, 1722)
    assert second.made_of == soft.model_copy(update={"law": "neohookean", "young": 1e9})


def test_the_radius_of_a_body_is_half_its_thickness():
    """The radius of the size field is that of a disc, half the height of a block, and at most the
    wall thickness of a ring."""
    def thickness(**entries):
        return read(with_body(**entries)).bodies[0].outline.half_thickness
    assert thickness(shape="disc", radius=0.5) == pytest.approx(0.5, rel=1e-5)
    assert thickness(shape="rectangle", width=10, height=2) == pytest.approx(1)
    assert thickness(shape="ring", radius=1, inner_radius=0.9) == pytest.approx(0.1, rel=1e-5)


def test_a_segment_of_a_circle_has_its_area_and_centre():
    """Area and centre of a half disc, a loop of arcs and a straight side in either direction, agree
    with closed forms."""
    angles = np.linspace(0, math.pi, 8)
    corners = np.column_stack([np.cos(angles), np.sin(angles)]) + [3, 4]
    arc_centres = np.where(np.arange(8)[:, None] < 7, [3.0, 4.0], math.nan)
    for loop in (polygon_loop(corners, arc_centres), polygon_loop(corners[::-1], np.roll(arc_centres[::-1], -1, axis=0))):
        assert loop.area == pytest.approx(math.pi / 2, rel=1e-12) and loop.area_centre == pytest.approx([3, 4 + 4 / (3 * math.pi)], rel=1e-12)
        assert abs(np.linalg.norm(loop.polygon[loop.polygon[:, 1] > 4 + 1e-9] - [3, 4], axis=1) - 1).max() < 1e-12


def test_mesh_files_that_cannot_be_used_are_named(tmp_path):
    """Half a body, a file without a mesh and a missing file: the message has the entry, the file
    and what is accepted."""
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), tmp_path / "half.msh")
    (tmp_path / "text.msh").write_text("no mesh")
    (tmp_path / "empty.msh").write_text("0 0 0\n")
    (tmp_path / "nan.msh").write_text("3 1 3\n0 0 1\n1 nan 1\n0 1 1\n1 2 3 0\n1 2 1\n2 3 1\n3 1 1\n")
    (tmp_path / "index.msh").write_text("3 1 3\n0 0 1\n1 0 1\n0 1 1\n1 2 4 0\n1 2 1\n2 3 1\n3 1 1\n")
    for name, words in [("half.msh", r"body.1.file: 'half.msh' has edges with the label 2 of a symmetry axis \(accepted: whole bodies"),
                        ("text.msh", "body.1.file: text.msh: is no mesh"), ("none.msh", "body.1.file: .*none.msh: cannot be read: No such file")]:
        with pytest.raises(BadInput, match=words):
            read(with_body(shape="mesh", file=name), tmp_path)


def test_open_values_are_those_of_the_softest_body():
    """The automatic penalty is that of a disc with the material of the softest body and the
    smallest radius at the largest closing speed.

    `friction_dynamic` follows `friction_static`. Prescribed values do not change.
    """
    tables = changed(("body.1.young", 1e9), ("contact.friction_static", 0.4), ("body.2.position", [0, 0]))
    values = assembly.assemble(read(tables)).values
    like = Impact(False, 0.5, 7e6, 0.45, 1722, 10, 0.005)
    assert values["penalty"] == pytest.approx(like.penalty, rel=1e-4) and values["friction_dynamic"] == 0.4
    assert values["slip_velocity"] == pytest.approx(like.slip_velocity, rel=1e-4)
    assert assembly.assemble(read(set_entry(tables, "contact.penalty", 5e8))).values["penalty"] == 5e8


def test_a_file_is_named_with_what_is_wrong_in_it(tmp_path):
    (tmp_path / "mine.toml").write_text('[[body]]\nshape = "disk"\n')
    with pytest.raises(BadInput, match=r"mine.toml: body.1.shape: 'disk' is not known"):
        load(str(tmp_path / "mine.toml"))
    with pytest.raises(BadInput, match=r"^none: no such scene \(built in: ball, .*disc-block, "):
        load("none")


# ---- entries by dotted names

def test_entries_are_set_by_name():
    """Dotted names, counted from 1, reach every entry, also a missing one. The scene itself does
    not change."""
    scene = read(SCENE | {"obstacle": [FLOOR]})
    other = scene.override({"body.2.young": "2e6", "body.1.velocity.2": -5, "contact.penalty": 1e8, "gravity": 9.81, "obstacle.1.point": "[0, -2]"})
    assert other.bodies[1].made_of.young == 2e6 and list(other.bodies[0].start_velocity) == [0, -5]
    assert other.contact_values["penalty"] == 1e8 and other.values["gravity"] == 9.81
    assert scene.bodies[1].made_of.young == 7e6 and list(scene.bodies[0].start_velocity) == [0, -10] and scene.content == SCENE | {"obstacle": [FLOOR]}


@pytest.mark.parametrize("name, words", [
    ("body.3.young", "body.3.young: there is no body.3 in the scene (accepted: body.1 to body.2)"),
    ("body.0.young", "body.0.young: there is no body.0 in the scene (accepted: body.1 to body.2)"),
    ("body.two.young", "body.two.young: there is no body.two in the scene"),
    ("obstacle.2.point", "obstacle.2.point: there is no obstacle.2 in the scene (accepted: obstacle.1)"),
    ("wall.1.point", "wall.1.point: there is no wall in the scene (accepted: young, nu, density, law, body, obstacle)"),
    ("body.1.velocity.3", "body.1.velocity.3: there is no body.1.velocity.3 in the scene (accepted: body.1.velocity.1 to body.1.velocity.2)"),
    ("body.1.radius.2", "body.1.radius.2: body.1.radius is '0.5' and has no entry 2"),
    ("body..young", "body..young: has an empty part"),
    ("", ": has an empty part"),
    ("contact.pair.1.penalty", "contact.pair.1.penalty: there is no contact.pair in the scene"),
])
def test_names_that_reach_nothing_are_named(name, words):
    with pytest.raises(BadInput) as caught:
        set_entry(SCENE | {"obstacle": [FLOOR]}, name, 1)
    assert words in str(caught.value)


# ---- polygons

def test_plane_geometry():
    """Distances are signed and exact for a circle and a polygon. A polygon that crosses itself is
    detected."""
    disc = ellipse_loop(2, 2)
    assert disc.gap(np.array([[0, 0], [3, 4], [0, 2]])) == pytest.approx([-2, 3, 0])
    square = np.array(SQUARE, dtype=float)
    outline = read(with_body(shape="polygon", vertices=SQUARE)).bodies[0].outline
    assert outline.gap(np.array([[0, 0], [1, 0], [1.5, 1.5], [0.4, 0.1]])) == pytest.approx([-0.5, 0.5, math.sqrt(2), -0.1])
    assert self_crossing(square) is None and self_crossing(square[[0, 2, 1, 3]]) == (0, 2)


@pytest.mark.parametrize("file", ["\0", "folder", "pipe"])
def test_a_mesh_that_is_no_file(file, tmp_path):
    """A folder, a pipe without a writer and an impossible name are refused at once, with the name.
    """
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(BadInput, match=r"^body.1.file: '.*' is no file"):
        read_scene(SCENE | {"body": [dict(shape="mesh", file=file, position=[0, 1])]}, tmp_path, "mine")


def test_a_broken_mesh_file_is_named_as_given(tmp_path):
    """The message has the user's name of the file only, and what is accepted."""
    (tmp_path / "mine.msh").write_text("3 1 3\n0 0")
    with pytest.raises(BadInput, match="^body.1.file: mine.msh: ends at vertex 1 of 3"):
        read_scene(SCENE | {"body": [dict(shape="mesh", file="mine.msh", position=[0, 1])]}, tmp_path, "mine")


def test_a_sliver_is_refused_by_its_thickness():
    """A polygon thinner than any accepted length is refused."""
    with pytest.raises(BadInput, match=r"^body.1: is 1e-12 m thick \(accepted: from 2e-09 m\)"):
        read(with_body(shape="polygon", vertices=[[0, 0], [1, 0], [1, 1e-12]]))


# ---- writing

def odd_texts(count: int) -> list[str]:
    """Random texts of characters that are difficult in files. The first has all control characters.
    """
    rng = np.random.default_rng(20)
    odd = [*map(chr, range(0x80)), *"\x80\x85\xa0\u2028\u2029\ufeff\ufffd\U0001f600ß中", '"""', "'''", "\r\n", "\\u0041", "]]", " # ", " = "]
    return ["".join(map(chr, range(0xa1))), *("".join(rng.choice(odd, rng.integers(0, 12))) for _ in range(count))]


def test_what_toml_accepts_is_written_back():
    """Everything that a TOML file can contain is written so that it reads back equal."""
    texts = odd_texts(400)
    tables = {text: [text, 1e-300, -0.0, True, 10**30, [[], [1.5, "x"]], math.inf] for text in texts}
    tables |= {"table": {text: text for text in texts}, "list": [{"a": text, "b": {text: {}}} for text in texts], "none": [], "mixed": [{"a": "\x7f"}, 1]}
    tables |= tomllib.loads("day = 2026-11-23\nat = 07:32:00.5\nboth = 1979-05-27T07:32:00.25Z\n")
    assert tomllib.loads(to_toml(tables)) == tables


def test_values_of_numpy_are_written_as_numbers():
    values = {"number": np.float64(1e-9), "whole": np.int64(3), "flag": np.bool_(True), "points": np.array([[0.0, 1.0]])}
    assert tomllib.loads(to_toml({"of": values})) == {"of": {"number": 1e-9, "whole": 3, "flag": True, "points": [[0.0, 1.0]]}}
    with pytest.raises(BadInput, match="is no text in UTF-8"):
        to_toml({"body": [{"surface": "\udcff.stl"}]})


@pytest.mark.parametrize("entries, axes", [
    ((), ["x"]),
    ((("body.1.position", [0.3, 1.5]),), []),                  # off the axis of the block
    ((("body.1.position", [0.3, 1.5]), ("body.2.position", [0.3, 0])), ["x"]),
    ((("body.1.spin", 1.0),), []),
    ((("body.1.velocity", [1e-3, -10]),), []),
    ((("body.2.angle", 10.0), ("body.1.position", [0, 3]), ("obstacle.1.point", [0, -3])), []),
    ((("body_force_x", 1.0),), []),
    ((("gravity", 9.81),), ["x"]),
    ((("obstacle.1.normal", [0.1, 1]), ("obstacle.1.point", [0, -3])), []),
])
def test_a_scene_is_symmetric_along_an_axis(entries, axes):
    """If bodies, motions, forces and obstacles of a plane scene have a common mirror line, nothing
    moves along its normal."""
    assert symmetric_along(read(changed(*entries))) == axes


def test_what_symmetry_makes_zero_has_no_error_estimate():
    """A mirror plane normal to x keeps velocities along x and spins about y and z at zero, but for
    the mesh. A number that is exactly zero is one of a half of the body."""
    summary = {"rebound_vx_1": 1e-4, "final_vx_1": 1e-4, "rebound_vy_1": 2.0, "rebound_vy_2": 0, "rebound_spin_1": 1e-3, "rebound_spin_x_1": 1e-3, "impulse": 0}
    assert zero_by_symmetry(summary) == {"rebound_vy_2"}
    assert zero_by_symmetry(summary | {"symmetric_along": ["x"]}) == {"rebound_vx_1", "final_vx_1", "rebound_vy_2", "rebound_spin_1"}


@pytest.mark.parametrize("kind, axes", [("plane-strain", 2), ("axisymmetric", 2), ("3d", 3)])
def test_a_plane_is_the_floor_by_default(kind, axes):
    """A [[obstacle]] of kind plane without point and normal is y < 0, as ff.Plane() is; one of both
    entries may be set."""
    ball = {"name": "ball", "shape": "disc" if axes == 2 and kind == "plane-strain" else "ball", "radius": 0.5, "position": [0, 1.5, 0][:axes]}
    tables = {key: value for key, value in SCENE.items() if key != "body"} | {"dimension": kind, "body": [ball]}
    floor, higher = (read(tables | {"obstacle": [{"kind": "plane"} | entries]}).obstacles[0] for entries in ({}, {"point": [0, 0.25, 0][:axes]}))
    assert floor.numbers == (*[0.0] * axes, *[0.0, 1.0, 0.0][:axes]) and higher.numbers[1] == 0.25 and higher.numbers[axes + 1] == 1
