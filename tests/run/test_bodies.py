"""Scenes from files: bodies, one mesh and a data file. Every error is reported in one line."""

import itertools
import math

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh
from ffimpact.scene import built_in, load
from ffimpact.scenes import approach, arrays, assembly
from tests.support.bodies import BLOCK, DISC, FLOOR, SCENE, SQUARE, changed, read, with_body
from tests.support.triangles import areas, smallest_angle

# ---- shapes

# Area, centre of area in the coordinates of the file, and length.
SHAPES = {
    "disc": ({"shape": "disc", "radius": 0.3}, math.pi * 0.09, 0.6 * math.pi),
    "ellipse": ({"shape": "ellipse", "semi_axes": [0.3, 0.1]}, math.pi * 0.03, 1.33649),
    "rectangle": ({"shape": "rectangle", "width": 0.4, "height": 0.1}, 0.04, 1.0),
    "ring": ({"shape": "ring", "radius": 0.3, "inner_radius": 0.2}, math.pi * 0.05, math.pi),
    "polygon": ({"shape": "polygon", "vertices": [[0, 0], [0, 3], [1, 3], [1, 1], [2, 1], [2, 0]]}, 4.0, 10.0),
    "polygon with holes": ({"shape": "polygon", "vertices": [[0, 0], [3, 0], [3, 2], [0, 2]],
                            "holes": [[[0.5, 0.5], [1, 0.5], [1, 1.5], [0.5, 1.5]], [[2, 0.5], [2, 1], [2.5, 0.5]]]}, 6 - 0.5 - 0.125, 13 + math.sqrt(0.5) + 1),
}


@pytest.fixture(params=SHAPES, name="shape")
def _shape(request):
    return SHAPES[request.param]


def test_shapes_have_their_area_and_are_about_their_centre(shape):
    """Area and length of an outline are those of the shape, its centre of area is the origin, and
    its outer loop is counter-clockwise."""
    entries, area, length = shape
    outline = read(with_body(**entries)).bodies[0].outline
    assert outline.area == pytest.approx(area, rel=1e-12)
    assert outline.length == pytest.approx(length if entries.get("holes") is None else outline.length, rel=1e-5)
    assert abs(outline.area_centre).max() < 1e-12
    points = outline.loops[0].polygon
    assert (points[:, 0] * np.roll(points[:, 1], -1) - points[:, 1] * np.roll(points[:, 0], -1)).sum() > 0


def test_bodies_are_meshed_to_their_outline(shape):
    """The mesh of a body fills the polygon of its boundary edges, which have it to their left, with
    triangles of good shape.

    Every vertex of the boundary lies on the outline. The area is that of the shape, except for the
    error of straight edges.
    """
    entries, area, _ = shape
    scene = read(with_body(**entries) | {"symmetry": "full", "obstacle": [FLOOR | {"point": [0, -50]}]})
    built = assembly.assemble(scene)
    m, outline = built.mesh, scene.bodies[0].outline
    a, b = m.points[m.edges[:, 0]], m.points[m.edges[:, 1]]
    assert areas(m).min() > 0 and smallest_angle(m) > 20
    assert areas(m).sum() == pytest.approx((a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]).sum() / 2, rel=1e-12)
    assert areas(m).sum() == pytest.approx(area, rel=1e-12 if outline.loops[0].semi_axes is None else 0.05)
    assert set(m.triangles.flat) == set(range(len(m.points)))
    for x, y in m.points[np.unique(m.edges)]:
        on = [abs(np.hypot(*([x, y] / loop.semi_axes)) - 1) if loop.semi_axes is not None else abs(loop.gap(np.array([[x, y]]))[0]) for loop in outline.loops]
        assert min(on) < 1e-12
    for corner in (corner for loop in outline.loops for corner in loop.corners):
        assert np.linalg.norm(m.points - corner, axis=1).min() < 1e-12


# ---- mesh files

def test_a_body_may_be_a_mesh_file(tmp_path):
    """A mesh file beside the scene is a body of its own area, moved to its centre. It keeps its
    labels, and its circle is recognised."""
    mesh.write(mesh.disc(0.05, 0.02, 0.01, False), tmp_path / "disc.msh")
    m = mesh.read(tmp_path / "disc.msh")
    scene = read(with_body(shape="mesh", file="disc.msh", position=[3, 4]), tmp_path)
    body = scene.bodies[0]
    assert body.outline.loops[0].radius == pytest.approx(0.05, rel=1e-9)
    assert abs(body.file_mesh.points - (m.points - [0, 0.05])).max() < 1e-9
    built = assembly.assemble(scene)
    assert np.array_equal(built.mesh.labels, m.labels) and np.array_equal(built.mesh.triangles, m.triangles)
    assert built.arrays["arcs"] == 1


def test_a_body_may_be_a_file_of_gmsh(tmp_path):
    """A plate with a round hole and a physical curve: the hole is a circle. Edges outside of
    `contact` never come into contact."""
    with mesh.gmsh_session() as gmsh:
        occ = gmsh.model.occ
        occ.cut([(2, occ.addRectangle(1, 1, 0, 4, 2))], [(2, occ.addDisk(2, 2, 0, 0.5, 0.5))])
        occ.synchronize()
        lowest = [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(0.9, 0.9, -1, 5.1, 1.1, 1, dim=1)]
        gmsh.model.addPhysicalGroup(1, lowest, name="contact")
        gmsh.model.addPhysicalGroup(2, [tag for _, tag in gmsh.model.getEntities(2)])
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "plate.msh"))
    scene = read(with_body(shape="mesh", file="plate.msh", position=[0, 0]), tmp_path)
    outline, hole = scene.bodies[0].outline, math.pi / 4
    assert [loop.radius for loop in outline.loops] == [None, pytest.approx(0.5, rel=1e-9)]
    assert outline.area == pytest.approx(8 - hole, rel=1e-9)
    assert outline.loops[1].centre == pytest.approx([2 - (8 * 3 - hole * 2) / (8 - hole), 0], abs=1e-9)
    m = assembly.assemble(scene).mesh
    assert np.linalg.norm(np.diff(m.points[m.edges[m.labels == 1]], axis=1), axis=2).sum() == pytest.approx(4)
    assert set(m.labels) == {1, 3} and areas(m).min() > 0


def test_flats_among_the_arcs_of_a_file_stay_flat(tmp_path):
    """A shaft with two flats, with all corners on one circle, consists of arcs and flats.

    Its area, centre and distances are correct, also rotated, and scene.bin has the circle once.
    """
    radius, flat = 0.5, math.acos(0.6)
    angles = np.concatenate([np.linspace(side + flat, side + math.pi - flat, 10) for side in (0, math.pi)])
    corners = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    spokes = np.column_stack([np.full(20, 20), np.arange(20), np.roll(np.arange(20), -1)])
    mesh.write(mesh.Mesh(np.vstack([corners, [0, 0]]) + [3, 4], spokes, spokes[:, 1:], np.ones(20, dtype=int)), tmp_path / "shaft.msh")
    scene = read(with_body(shape="mesh", file="shaft.msh", position=[1, 2], angle=90), tmp_path)
    outline, placed = scene.bodies[0].outline, scene.bodies[0].placed
    assert outline.area == pytest.approx(radius**2 * (math.pi - 2 * flat + math.sin(2 * flat)), rel=1e-12) and abs(outline.area_centre).max() < 1e-12
    assert placed.area_centre == pytest.approx([1, 2], abs=1e-12) and placed.extent == pytest.approx([2 * radius, 1.2 * radius], rel=1e-4)
    assert placed.gap(np.array([[1.0, 2.4], [1, 2], [1.6, 2]])) == pytest.approx([0.1, -0.3, 0.1], abs=1e-4)
    made = assembly.assemble(scene).arrays
    assert made["arcs"] == 1 and made["arcs.centre"][0] == pytest.approx([0, 0, 0], abs=1e-12) and made["arcs.radius"] == pytest.approx(radius, rel=1e-12)
    assert made["bodies.of_file"].tolist() == [1] and sorted(made["mesh.arc_of"]) == [-1] * 2 + [0] * 18


# ---- assembly

def test_bodies_are_regions_apart_from_each_other():
    """Region k is body k about its centre. Bodies share no vertex, their boxes are disjoint, and
    the outlines have the label 1."""
    scene = load("three-in-a-row")
    built = assembly.assemble(scene)
    boxes = []
    for k, body in enumerate(scene.bodies):
        used = np.unique(built.mesh.triangles[built.regions == k])
        boxes.append((built.mesh.points[used, 0].min(), built.mesh.points[used, 0].max()))
        assert areas(built.mesh)[built.regions == k].sum() == pytest.approx(body.outline.area, rel=0.03)
        mine, area = built.mesh.triangles[built.regions == k], areas(built.mesh)[built.regions == k]
        centre = (built.mesh.points[mine].mean(axis=1) * area[:, None]).sum(axis=0) / area.sum()
        assert centre == pytest.approx(built.centres[k], abs=0.01 * body.outline.extent.max())
    assert all(box[1] < next_box[0] for box, next_box in itertools.pairwise(boxes))
    assert len(np.unique(built.mesh.points, axis=0)) == len(built.mesh.points)
    assert set(built.mesh.labels) == {mesh.FREE}


def test_meshes_are_fine_where_bodies_touch():
    """Disc and block have contact_mesh_size in the contact region and mesh_size on the other sides
    of the block."""
    scene = read(SCENE | {"mesh_size": 0.3, "contact_mesh_size": 0.03, "symmetry": "full"})
    m = assembly.assemble(scene).mesh
    middle, length = m.points[m.edges].mean(axis=1), np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1)
    x = middle[:, 0] - 7.5
    assert length[(middle[:, 1] == 1) & (abs(x) < 0.2)].max() < 0.045
    assert length[middle[:, 1] == -1].mean() == pytest.approx(0.3, rel=0.1) and length[(middle[:, 1] == 1) & (abs(x) > 3)].mean() > 0.25
    disc = np.hypot(*middle.T) < 0.51
    assert length[disc & (middle[:, 1] < -0.48)].max() < 0.045 and length[disc & (middle[:, 1] > 0.3)].min() > 0.1


def test_a_spinning_body_is_fine_where_it_will_touch():
    """A square that rotates by 45 degrees before it reaches the floor comes into contact with a
    corner, which is fine."""
    fall = 1.0
    square = {"shape": "rectangle", "width": 1, "height": 1, "position": [0, math.sqrt(0.5) + fall], "velocity": [0, -1], "spin": math.pi / 4}
    scene = read(SCENE | {"body": [square | {"mesh_size": 0.25, "contact_mesh_size": 0.02}], "obstacle": [FLOOR | {"point": [0, 0]}]})
    met, = approach.onsets_of(scene)
    assert met.outlines[0].points[:, 1].min() == pytest.approx(0, abs=1e-3)
    m = assembly.assemble(scene).mesh
    middle, length = m.points[m.edges].mean(axis=1), np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1)
    finest = middle[length.argmin()]
    assert np.linalg.norm(finest - [-0.5, -0.5]) < 0.05


def test_a_hole_touches_only_what_is_in_it():
    """The inner circle of a ring has the label 3.

    With a disc or an obstacle inside, or if the ring may come into contact with itself, it has the
    label 1.
    """
    ring = {"shape": "ring", "radius": 1, "inner_radius": 0.8, "position": [0, 0]}
    thin = read(SCENE | {"body": [ring, DISC | {"position": [3, 0]}]})
    alone = read(SCENE | {"body": [ring, DISC | {"position": [3, 0]}], "contact": {"self_contact": "off"}})
    filled = read(SCENE | {"body": [ring, DISC | {"position": [0.2, 0]}]})
    post = read(SCENE | {"body": [ring | {"velocity": [1, 0]}], "obstacle": [{"kind": "circle", "centre": [0.6, 0], "radius": 0.1}]})
    for scene, labels in ((thin, {1}), (alone, {1, 3}), (filled, {1}), (post, {1})):
        m = assembly.assemble(scene).mesh
        assert set(m.labels) == labels
        inner = np.hypot(*m.points[m.edges].mean(axis=1).T) < 0.85
        assert set(m.labels[inner]) == labels - {1} or labels == {1}


def test_pairs_inherit_from_contact():
    """A [[contact.pair]] overrides the entries of the scene and of its obstacle."""
    tables = changed(("contact.penalty", 1e9), ("contact.friction_static", 0.5), ("contact.slip_velocity", 0.1), ("obstacle.1.friction_static", 0.2))
    tables["contact"]["pair"] = [{"bodies": ["floor", "disc"], "friction_static": 0.3, "friction_dynamic": 0.1}, {"bodies": ["block", "disc"], "penalty": 2e9}]
    made = assembly.assemble(read(tables)).arrays
    assert (made["pairs.first"].tolist(), made["pairs.second"].tolist()) == ([0, 0, 1], [-1, 1, -1])
    assert made["pairs.values"].tolist() == [[1e9, 0.3, 0.1, 0], [2e9, 0.5, 0.5, 0], [1e9, 0.2, 0.2, 0]]   # 0: no expression to replace


@pytest.mark.few(5)
@pytest.mark.parametrize("name", [name for name in built_in() if load(name).bodies])
def test_the_scene_as_used_is_the_same_scene(name, tmp_path):
    """Every built-in scene has a mesh of good quality.

    scene.toml, which has all automatic values, gives the same mesh, data and values, byte by byte.
    """
    first, second, scene = tmp_path / "first", tmp_path / "second", load(name)
    for folder, source in ((first, name), (second, str(first / "scene.toml"))):
        folder.mkdir()
        built = assembly.assemble(load(source))
        assert built.mesh.volumes.min() > 0 if scene.kind.axes == 3 else areas(built.mesh).min() > 0 and smallest_angle(built.mesh) > 20
        assert set(built.regions) == set(range(len(scene.bodies)))
        assert "auto" not in {name: value for name, value in built.values.items() if name != "volume"}.values()
        built.write(folder)
        (folder / "scene.toml").write_text(to_toml(built.used))
    for file in (scene.mesh_name, "scene.bin", "scene.toml"):
        assert (first / file).read_bytes() == (second / file).read_bytes(), file


# ---- what is refused

BAD = [
    ([("body.2.youngg", 1)], "body.2.youngg: no such entry, set to '1'; did you mean young? (accepted: shape, width, height, name, position"),
    ([("bodies", 1)], "bodies: no such entry, set to '1'; did you mean modes or body? (accepted: title, script, dimension, "),
    ([("friction_static", 1)], "friction_static: no such entry, set to '1'; did you mean contact.friction_static? (accepted: title,"),
    ([("radius", 1)], "radius: no such entry, set to '1'; did you mean body.1.radius? (accepted: title,"),
    ([("contact.penality", 1)], "contact.penality: no such entry, set to '1'; did you mean penalty?"),
    ([("body.2.young", "soft")], "body.2.young: 'soft' is not a number (accepted: 1e-06 to 1e+18)"),
    ([("body.2.nu", 0.6)], "body.2.nu: 0.6 is out of range (accepted: 0 to 0.5)"),
    ([("body.1.law", "incompressible"), ("body.1.nu", "0.3")], "body.1.nu: 0.3 of law = incompressible (accepted: 0.5)"),
    ([("body.1.law", "hooke")], "body.1.law: 'hooke' is not known; did you mean neohookean? (accepted: svk|neohookean|mooney-rivlin|ogden|energy|incompressible|metal)"),
    ([("body.1.shape", "blob")], "body.1.shape: 'blob' is not known (accepted: disc|ellipse|rectangle|ring|polygon|mesh)"),
    ([("body.1.shape", "ring")], "body.1.inner_radius: is missing (accepted: 1e-09 to 1e+09)"),
    ([("body.1.shape", "ring"), ("body.1.inner_radius", 0.5)], "body.1.inner_radius: 0.5 is not less than the radius 0.5"),
    ([("body.1.width", 1)], "body.1.width: no such entry, set to '1'"),
    ([("body.1.radius", -1)], "body.1.radius: -1 is out of range (accepted: 1e-09 to 1e+09)"),
    ([("body.1.radius", True)], "body.1.radius: 'true' is not a number"),
    ([("body.1.position", 3)], "body.1.position: '3' is no [x, y] (accepted: two numbers"),
    ([("body.1.position", [0, 1, 2])], "body.1.position: '[0, 1, 2]' is no [x, y]"),
    ([("body.1.position.2", "up")], "body.1.position.2: 'up' is not a number"),
    ([("body.1.speed", 3)], "body.1.velocity: '[0, -10]' stands beside speed or direction (accepted: velocity, or speed with direction)"),
    ([("body.2.speed", 3)], "body.2.direction: is missing (accepted: speed [m/s] with direction [deg]"),
    ([("body.1.name", "my disc")], "body.1.name: 'my disc' is no name (accepted: letters, digits, _ - . without blanks, a letter first)"),
    ([("body.1.name", 7)], "body.1.name: '7' is no name"),
    ([("body.1.name", "block")], "body.2.name: 'block' is the name of body.1 too (accepted: each name once)"),
    ([("obstacle.1.name", "block")], "obstacle.1.name: 'block' is the name of body.2 too"),
    ([("body.1.mesh_size", 0.1), ("body.1.contact_mesh_size", 0.2)], "body.1.contact_mesh_size: 0.2 is larger than mesh_size 0.1"),
    ([("body.1.position", [0, 1.4])], "body.1.position: 'disc' overlaps 'block' (body.2) by 0.1 m at the start (accepted: apart or touching)"),
    ([("body.1.position", [0, 0])], "body.1.position: 'disc' overlaps 'block' (body.2)"),
    ([("body.2.position", [0, -0.25])], "body.2.position: 'block' overlaps 'floor' (obstacle.1) by 0.25 m at the start"),
    ([("obstacle.1.normal", [0, 0])], "obstacle.1.normal: '[0, 0]'"),
    ([("obstacle.1.friction_static", -1)], "obstacle.1.friction_static: -1 is out of range (accepted: 0 to 10)"),
    ([("contact", 3)], "contact: '3' is no table"),
    ([("contact.pairing", "pairwise")], "contact.pairing: 'pairwise' is no entry any more (accepted: closest points, of all scenes; pairs of points are in edp/disc-block.edp)"),
    ([("contact.pair", 3)], "contact.pair: '3' is no list of tables (accepted: [[contact.pair]])"),
    ([("contact.pair", [{"penalty": 1e9}])], "contact.pair.1.bodies: '' is no pair (accepted: two names, one at least of a body, of disc, block, floor)"),
    ([("contact.pair", [{"bodies": ["disc", "ball"]}])], "contact.pair.1.bodies: 'ball' is not in the scene (accepted: two names, one at least of a body, of disc, block, floor)"),
    ([("contact.pair", [{"bodies": ["floor", "floor"]}])], "contact.pair.1.bodies: '['floor', 'floor']' cannot come into contact with each other"),
    ([("contact.pair", [{"bodies": ["disc", "block"]}, {"bodies": ["block", "disc"]}])], "contact.pair.2.bodies: '['block', 'disc']' has a table already"),
    ([("contact.pair", [{"bodies": ["disc", "block"], "exponent": 2}])],
     "contact.pair.1.exponent: '2' holds for the whole scene (accepted: in [contact]; here penalty, friction_static, friction_dynamic)"),
    ([("obstacle.1.slip_velocity", 0.1)], "obstacle.1.slip_velocity: '0.1' holds for the whole scene (accepted: in [contact]"),
    ([("contact.pair", [{"bodies": ["disc", "block"], "penalty": 0}])], "contact.pair.1.penalty: 0 is out of range"),
    ([("end_time", -1)], "end_time: -1 is out of range (accepted: 0 to 1e+09)"),
    ([("radius", 1)], "radius: no such entry, set to '1'"),
    ([("script", "disc-plane")], "script: 'disc-plane' is no kind of scene any more (accepted: tables [[body]], [[obstacle]] and [contact]"),
    ([("title", 1)], "title: '1' is no text"),
]
TABLES = [
    ({"obstacle": []}, "body: is missing (accepted: one table [[body]] or more)"),
    ({"body": {"shape": "disc"}}, "body: '{'shape': 'disc'}' is no list of tables (accepted: [[body]])"),
    ({"body": [DISC], "obstacle": [], "contact": {"self_contact": "off"}}, "contact.self_contact: off, but a body without obstacles and other bodies may come into contact with itself (accepted: auto|on"),
    ({"body": [{}]}, "body.1.shape: is missing (accepted: disc|"),
    ({"body": [3]}, "body.1: '3' is no table (accepted: [[body]])"),
    ({"body": [DISC], "obstacle": [3]}, "obstacle.1: '3' is no table (accepted: [[obstacle]])"),
    ({"body": [{k: v for k, v in DISC.items() if k != "position"}]}, "body.1.position: is missing (accepted: [x, y], each -1e+09 to 1e+09)"),
]
POLYGONS = [
    ({"vertices": [[0, 0], [1, 1], [1, 0], [0, 1]]}, "body.1.vertices: the side from vertex 1 to 2 meets the side from vertex 3 to 4 (accepted: a polygon that does not cross or touch itself)"),
    ({"vertices": [[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]]}, "body.1.vertices: the side from vertex 1 to 2 meets the side from vertex 3 to 4"),
    ({"vertices": [[0, 0], [2, 0], [1, 0]]}, "body.1.vertices: the side from vertex 1 to 2 meets the side from vertex 2 to 3"),
    ({"vertices": [*SQUARE, [0, 0]]}, "body.1.vertices: vertices 5 and 1 coincide (accepted: each vertex once, the polygon closes itself)"),
    ({"vertices": SQUARE[:2]}, "body.1.vertices: '[[0, 0], [1, 0]]' is too little (accepted: 3 points [x, y] or more)"),
    ({"vertices": [[math.cos(k), math.sin(k)] for k in range(2001)]}, "body.1.vertices: 2001 points (accepted: 3 to 2000)"),
    ({"vertices": SQUARE, "holes": [[[2, 2], [3, 2], [3, 3]]]}, "body.1.holes.1: is not inside body.1.vertices (accepted: holes that neither cross nor touch the outline)"),
    ({"vertices": SQUARE, "holes": [[[0.5, 0.5], [2, 0.5], [0.5, 0.6]]]}, "body.1.holes.1: is not inside body.1.vertices"),
    ({"vertices": SQUARE, "holes": [[[0, 0.5], [0.5, 0.5], [0.5, 0.6]]]}, "body.1.holes.1: is not inside body.1.vertices"),
    ({"vertices": SQUARE, "holes": [[[0.1, 0.1], [0.9, 0.1], [0.9, 0.9]], [[0.6, 0.5], [0.8, 0.5], [0.8, 0.6]]]}, "body.1.holes.2: overlaps body.1.holes.1 (accepted: holes apart"),
    ({"vertices": SQUARE, "holes": [[[0.2, 0.2], [0.5, 0.2], [0.4, 0.6]], [[0.4, 0.3], [0.8, 0.3], [0.8, 0.6]]]}, "body.1.holes.2: overlaps body.1.holes.1"),
    # The holes overlap at a corner only.
    ({"vertices": SQUARE, "holes": [[[0.2, 0.2], [0.5, 0.2], [0.4, 0.6]], [[0.5, 0.2], [0.8, 0.3], [0.8, 0.6]]]}, "body.1.holes.2: overlaps body.1.holes.1"),
]
NO_OBSTACLES = [
    ({"kind": "cone"}, "obstacle.1.kind: 'cone' is not known (accepted: plane|circle|bowl|polyline|implicit)"),
    ({}, "obstacle.1.kind: is missing (accepted: plane|"),
    ({"kind": "bowl", "centre": [0, 0]}, "obstacle.1.radius: is missing"),
    ({"kind": "bowl", "center": [0, 0]}, "obstacle.1.center: no such entry, set to '[0, 0]'; did you mean centre? (accepted: kind, centre, radius, name, velocity, motion, rotation, pivot, axis"),
    ({"kind": "polyline", "vertices": [[0, 0]]}, "obstacle.1.vertices: '[[0, 0]]' is too little (accepted: 2 points [x, y] or more)"),
    ({"kind": "polyline", "vertices": [[0, 0], [1, 0], [1, 0]]}, "obstacle.1.vertices.3: [1, 0] is the vertex before it again"),
    ({"kind": "polyline", "vertices": [[0, 0], [1, 0]], "closed": "yes"}, "obstacle.1.closed: 'yes' is neither true nor false (accepted: true|false)"),
]
REFUSED = [*((changed(*entries), words) for entries, words in BAD),
           *(({k: v for k, v in SCENE.items() if k != name}, f"body.1.{name}: is missing, here and at the top of the file (accepted: ") for name in ("law", "young", "nu", "density")),
           *(({k: v for k, v in SCENE.items() if k != "body"} | tables, words) for tables, words in TABLES),
           *((with_body(shape="polygon", **entries), words) for entries, words in POLYGONS),
           *((with_body(shape="disc", radius=0.1, position=[0, 9]) | {"obstacle": [entries]}, words) for entries, words in NO_OBSTACLES)]


@pytest.mark.parametrize("scene, words", REFUSED, ids=[words.split(" (")[0] for _, words in REFUSED])
def test_what_is_wrong_is_named(scene, words):
    """Bad input gives exit code 10 and one line with the entry, its value and what is accepted.

    The cases are entries, a missing material, missing tables, polygons and holes that cross, touch
    or repeat themselves, and invalid obstacles.
    """
    with pytest.raises(BadInput) as caught:
        read(scene)
    assert words in str(caught.value) and caught.value.code == 10


def test_overlaps_that_no_vertex_shows():
    """Two crossed bars, a small body inside a large one and an obstacle inside a body overlap; a
    disc in the hole of a ring does not."""
    bar = {"shape": "rectangle", "width": 10, "height": 0.1, "position": [0, 0]}
    for others in ([bar, bar | {"angle": 90}], [BLOCK, DISC | {"position": [0, 0], "radius": 0.01}]):
        with pytest.raises(BadInput, match="overlaps"):
            read(SCENE | {"body": others})
    with pytest.raises(BadInput, match="'block' overlaps 'stone'"):
        read(SCENE | {"body": [BLOCK], "obstacle": [{"name": "stone", "kind": "circle", "centre": [3, 0.1], "radius": 0.2}]})
    read(SCENE | {"body": [{"shape": "ring", "radius": 1, "inner_radius": 0.8, "position": [0, 0]}, DISC | {"position": [0.3, 0]}]})


def test_touching_is_no_overlap():
    """Bodies may be in contact at the start: discs, faces, a corner on a face, also rotated and far
    from the origin."""
    square = {"shape": "rectangle", "width": 1, "height": 1}
    read(SCENE | {"body": [DISC | {"position": [0, 0]}, DISC | {"name": "other", "position": [1, 0]}]})
    read(SCENE | {"body": [square | {"position": [1000, 0.3]}, square | {"position": [1001, 0]}]})
    read(SCENE | {"body": [square | {"position": [0, math.sqrt(0.5)], "angle": 45}], "obstacle": [FLOOR | {"point": [0, 0]}]})


def test_sizes_that_do_not_fit_a_body_are_named():
    """A mesh size beyond the thickness of a body is reported with the entry of the body."""
    with pytest.raises(BadInput, match="^body.2.mesh_size: 3 does not fit the thickness of 'block' .accepted: 0, or from 5e-05 to 1.67"):
        assembly.assemble(read(changed(("body.2.mesh_size", 3))))


def test_dynamic_friction_beyond_static_is_named():
    with pytest.raises(BadInput, match="^contact.friction_dynamic: 0.5 is larger than friction_static 0.2"):
        assembly.assemble(read(changed(("contact.friction_static", 0.2), ("contact.friction_dynamic", 0.5))))


# ---- obstacles

OBSTACLES = [
    ({"kind": "plane", "point": [1, 2], "normal": [0, 1e-200]}, "plane 4 1.0 2.0 0.0 1.0", [[0, 2.5], [0, 1]], [0.5, -1]),
    ({"kind": "circle", "centre": [1, 0], "radius": 2}, "circle 3 1.0 0.0 2.0", [[4, 4], [1, 1]], [3, -1]),
    ({"kind": "bowl", "centre": [1, 0], "radius": 2}, "bowl 3 1.0 0.0 2.0", [[4, 4], [1, 1]], [-3, 1]),
    ({"kind": "polyline", "vertices": [[0, 0], [2, 0]], "rounding": 0.1}, "polyline 6 0.0 0.1 0.0 0.0 2.0 0.0", [[1, 1], [1, -1]], [0.9, -1.1]),
    ({"kind": "polyline", "vertices": [[0, 0], [0, 1], [1, 1], [1, 0]], "closed": True}, "polyline 10 1.0 0.0 0.0 0.0 0.0 1.0 1.0 1.0 1.0 0.0", [[0.5, 0.75], [3, 1]], [-0.25, 2]),
]


@pytest.mark.parametrize("entries, words, points, gaps", OBSTACLES)
def test_obstacles_are_their_numbers_and_gaps(entries, words, points, gaps):
    """scene.bin has the numbers and the velocity of an obstacle. The gap is the signed distance,
    negative inside."""
    far = with_body(shape="disc", radius=0.01, position=[0.5, 5] if entries["kind"] != "bowl" else [1, 0]) | {"obstacle": [entries | {"velocity": [0.5, -0.25]}]}
    scene = read(far)
    made, (kind, _, *numbers) = assembly.assemble(scene).arrays, words.split()
    assert list(made["obstacles.name"]) == ["obstacle1"] and made["obstacles.kind"].tolist() == [arrays.SHAPES.index(kind)]
    assert made["obstacles.numbers"].tolist() == list(map(float, numbers)) and made["obstacles.velocity"].tolist() == [[0.5, -0.25, 0.0]]
    assert scene.obstacles[0].gap(np.array(points, dtype=float)) == pytest.approx(gaps)
