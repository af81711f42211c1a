"""Scenes of bodies in three dimensions: shapes and their distances, meshes, files, symmetry, what is refused, and runs."""

import math
import time

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.freefem import freefem
from ffimpact.geometry import tumbling
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import curved, mesh, solid_file, solid_mesh, solids
from ffimpact.report import bodies, drawing, figures, report
from ffimpact.running import run
from ffimpact.scene import SCENES, Scene, load
from ffimpact.scene import read as read_scene
from ffimpact.scenes import approach, assembly, mirror
from test_direct import call

SCRIPT = "bodies-3d"
BALL = {"name": "ball", "shape": "ball", "radius": 0.05, "position": [0, 0.051, 0], "velocity": [0, -8, 0]}
BLOCK = {"name": "block", "shape": "box", "width": 0.24, "height": 0.08, "depth": 0.2, "position": [0, -0.04, 0]}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, -0.5, 0], "normal": [0, 1, 0]}
SCENE = {"dimension": "3d", "law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "accuracy": 0.1}


def read(*tables: dict, obstacles=(FLOOR,), folder=SCENES, **top) -> Scene:
    return read_scene(SCENE | top | {"body": [{"position": [0, 0, 0]} | table for table in tables], "obstacle": list(obstacles)}, folder, "scene")


def quality(m: solid_mesh.SolidMesh) -> np.ndarray:
    """Volume over that of the regular tetrahedron with the same mean square edge: 1 is best."""
    corners = m.points[m.cells]
    squares = [((corners[:, i] - corners[:, j])**2).sum(axis=1) for i in range(4) for j in range(i)]
    return m.volumes * 6 * math.sqrt(2) / np.mean(squares, axis=0) ** 1.5


def full_on(m: solid_mesh.SolidMesh, label: int) -> int:
    """Tetrahedra with all four corners on faces of a label."""
    on = np.zeros(len(m.points), dtype=bool)
    on[m.faces[m.labels == label]] = True
    return int(on[m.cells].all(axis=1).sum())


# ---- shapes

SHAPES = {   # volume, area
    "ball": (solids.ball(0.3), 4 / 3 * math.pi * 0.027, 4 * math.pi * 0.09),
    "box": (solids.box(np.array([0.4, 0.1, 0.2])), 0.008, 2 * (0.04 + 0.02 + 0.08)),
    "cylinder": (solids.cylinder(0.2, 0.5), math.pi * 0.02, 2 * math.pi * 0.2 * 0.7),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_know_their_surface(name):
    """Volume and area; samples lie on the surface, as close as asked; distances grow by the way from the surface, and are negative inside."""
    shape, volume, area = SHAPES[name]
    assert shape.volume == pytest.approx(volume) and shape.area == pytest.approx(area)
    points = shape.sampled(0.02)
    assert abs(shape.gap(points)).max() < 1e-12 and shape.gap(np.zeros((1, 3)))[0] < 0
    assert 0.3 < len(points) * 0.02**2 / area < 3
    assert shape.gap(np.array([[0, 10.0, 0]]))[0] == pytest.approx(10 - shape.extent[1] / 2)
    assert np.linalg.norm(points, axis=1).max() == pytest.approx(shape.reach, rel=1e-6)


def test_a_surface_of_triangles_has_the_distances_of_its_body():
    """Of a meshed box: outside, near edges and corners, and inside."""
    sizes = mesh.Sizes(0.05, 0.05, np.empty((0, 3)), 0.0)
    made = solid_mesh.mesh_shape("box", np.array([0.4, 0.1, 0.2]), np.eye(3), (), sizes, 0.1)
    surface, box = solids.surface(made.points[made.faces]), SHAPES["box"][0]
    points = np.random.default_rng(1).uniform(-0.3, 0.3, (500, 3))
    assert surface.gap(points) == pytest.approx(box.gap(points), abs=1e-12)
    assert surface.volume == pytest.approx(box.volume) and surface.area == pytest.approx(box.area)


def test_distances_from_slender_triangles():
    """Beside a long prism of 64 faces, whose triangles have their centres far from most of their points."""
    turn, count = math.tau / 64, 64
    ring = [np.column_stack([np.cos(turn * np.arange(count)), np.sin(turn * np.arange(count)), np.full(count, z)]) for z in (-50, 50)]
    faces = [(low[k], low[k - 1], high[k - 1]) for low, high in (ring, ring[::-1]) for k in range(count)]
    ends = [(one[0], one[k], one[k + 1]) for one in ring for k in range(1, count - 1)]
    angle, z = turn * (np.arange(count) + 0.5), np.linspace(-49, 49, count)
    beside = (math.cos(turn / 2) + 0.2) * np.column_stack([np.cos(angle), np.sin(angle), z / (math.cos(turn / 2) + 0.2)])
    assert solids._distances(np.array(faces + ends))(beside) == pytest.approx(np.full(count, 0.2))


def test_places_turns_and_motions():
    """turn is an axis times an angle in degrees, angle and a single spin are about z; a box turned by 90 degrees about x stands on its depth."""
    body, = read(BLOCK | {"position": [1, 2, 3], "turn": [90, 0, 0], "spin": 4}).bodies
    assert body.placed.points[:, 1].max() == pytest.approx(2.1) and body.spin.tolist() == [0, 0, 4]
    assert np.array_equal(tumbling.rotation(np.radians([0, 0, 90])), [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turned, = read(BLOCK | {"angle": 30, "spin": [1, 2, 3]}).bodies
    assert turned.angle == pytest.approx([0, 0, math.pi / 6]) and turned.spin.tolist() == [1, 2, 3]


def test_free_bodies_tumble():
    """Euler's equations in the body's axes, J w' = J w x w, in small steps of another method; a ball, and a box about a principal axis, go on turning as they
    began. No spin is above the bound."""
    extent, spin, start, t = np.array([0.05, 0.1, 0.2]), np.array([12.0, 5, -8]), tumbling.rotation(np.array([0.3, -0.2, 0.5])), 0.6
    box, w, R, n, fastest = solids.box(extent), start.T @ spin, start, 10000, 0.0
    J = np.diag(box.moments)
    for _ in range(n):
        middle = w + t / n / 2 * np.cross(J * w, w) / J
        w = w + t / n * np.cross(J * middle, middle) / J
        R = R @ tumbling.rotation(middle * t / n)
        fastest = max(fastest, np.linalg.norm(w))
    assert tumbling.turned(box.moments, start, spin, t) == pytest.approx(R, abs=1e-6)
    assert abs(R - tumbling.rotation(spin * t) @ start).max() > 0.1
    assert fastest <= tumbling.fastest(box.moments, start, spin)
    for moments, about in ((solids.ball(0.1).moments, spin), (box.moments, 7 * start[:, 0])):
        assert tumbling.turned(moments, start, about, t) == pytest.approx(tumbling.rotation(about * t) @ start, abs=1e-12)


def test_moments_of_inertia():
    """Those of a box by the formula and by its triangles; a ball and a cylinder by points that fill them."""
    sides = np.array([0.05, 0.1, 0.2])
    made = solid_mesh.mesh_shape("box", sides, np.eye(3), (), mesh.Sizes(0.1, 0.1, np.empty((0, 3)), 0.0), 0.025)
    assert solids.surface(made.points[made.faces]).moments == pytest.approx(solids.box(sides).moments, rel=1e-9, abs=1e-15)
    x = np.random.default_rng(1).uniform(-1, 1, (400000, 3))
    for shape in (solids.ball(1.0), solids.cylinder(0.7, 1.6)):
        inside = x[shape.gap(x) < 0]
        square = inside.T @ inside * 8 / len(x)
        assert shape.moments == pytest.approx(np.trace(square) * np.eye(3) - square, abs=0.01 * shape.moments.max())


def test_balls_meet_where_geometry_says():
    """Two balls off their centres: the part of their speed along the line of centres at the touch, and across it; the radius of the smaller."""
    met, = approach.meetings(read(BALL | {"position": [-0.2, 0, 0], "velocity": [3, 0, 0]}, BALL | {"name": "other", "radius": 0.08, "position": [0.2, 0.03, 0.04], "velocity": [-1, 0, 0]},
                                  obstacles=()))
    sine = 0.05 / 0.13
    assert met.closing == pytest.approx(4 * math.sqrt(1 - sine**2), rel=1e-3) and met.sliding == pytest.approx(4 * sine, rel=1e-3) and met.radius == 0.05


# ---- meshes

@pytest.mark.parametrize("symmetry, copies", [("full", 1), ("half", 2), ("quarter", 4)])
def test_bodies_are_meshed_whole_or_by_symmetry(symmetry, copies):
    """The mesh makes the bodies' volumes; spheres are spheres and planes of symmetry planes to rounding, with the labels 2 (x = 0) and 3 (z = 0);
    sound tetrahedra, none with all corners on the surface of the ball."""
    scene = read(BALL, BLOCK, {"shape": "cylinder", "radius": 0.04, "height": 0.1, "position": [0, 0.2, 0]}, symmetry=symmetry)
    built = assembly.assemble(scene)
    m = built.mesh
    assert m.volumes.min() > 0 and quality(m).min() > 0.1 and np.percentile(quality(m), 5) > 0.4
    volumes = copies * np.bincount(built.regions, weights=m.volumes)
    assert volumes[1] == pytest.approx(0.24 * 0.08 * 0.2, rel=1e-12)
    assert volumes[0] == pytest.approx(4 / 3 * math.pi * 0.05**3, rel=0.08) and volumes[2] == pytest.approx(math.pi * 0.04**2 * 0.1, rel=0.03)
    assert set(m.labels) == {1: {1}, 2: {1, 3}, 4: {1, 2, 3}}[copies]
    assert (m.points[m.faces[m.labels == 2]][..., 0] == 0).all() and (m.points[m.faces[m.labels == 3]][..., 2] == 0).all()
    assert m.points[:, 2].min() >= 0 or copies == 1
    ball = np.unique(m.faces[(m.labels == 1) & (m.faces.max(axis=1) < m.cells[built.regions == 1].min())])
    assert abs(np.linalg.norm(m.points[ball] - built.centres[0], axis=1) / 0.05 - 1).max() < 1e-12
    first = solid_mesh.SolidMesh(m.points, m.cells[built.regions == 0], m.faces, m.labels)
    assert full_on(first, 1) == 0
    edges = np.sort(m.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()          # the surface is closed


def test_bodies_stand_apart_above_each_other():
    """On the axis y, no vertex in common, the shift of each leads to its place."""
    scene = load("ball-block")
    built = assembly.assemble(scene)
    heights = [built.mesh.points[np.unique(built.mesh.cells[built.regions == k])][:, 1] for k in (0, 1)]
    assert heights[0].max() < heights[1].min() and not built.centres[:, [0, 2]].any()
    rows = [line.split() for line in built.data.splitlines()]
    assert rows[0] == ["ffimpact-bodies-3d", "1"] and rows[1] == ["copies", "4"]
    for row, body in zip(rows[4:6], scene.bodies):
        assert len(row) == 17 and np.array(row[5:8], dtype=float) + np.array(row[8:11], dtype=float) == pytest.approx(body.position)
    assert rows[6] == ["spheres", "1"]


@pytest.mark.robustness
def test_meshes_are_fine_where_bodies_touch():
    """Faces below the ball's lowest point and in the middle of the block's upper side, not elsewhere; turned along with the body."""
    scene = read(BALL, BLOCK, mesh_size=0.03, contact_mesh_size=0.006, symmetry="full")
    built = assembly.assemble(scene)
    m = built.mesh
    size = np.sqrt(np.linalg.norm(np.cross(m.points[m.faces[:, 1]] - m.points[m.faces[:, 0]], m.points[m.faces[:, 2]] - m.points[m.faces[:, 0]]), axis=1))
    from_touch = np.linalg.norm(m.points[m.faces].mean(axis=1) - [0, -0.05, 0], axis=1)
    assert size[from_touch < 0.008].max() < 0.01 and size[(from_touch > 0.08) & (m.points[m.faces][..., 1].max(axis=1) < 0.051)].min() > 0.012
    upper = np.linalg.norm(m.points[m.faces].mean(axis=1) - built.centres[1] - [0, 0.04, 0], axis=1)
    assert size[upper < 0.008].max() < 0.01
    edge = {"shape": "box", "width": 0.1, "height": 0.1, "depth": 0.1, "position": [0, 0.2, 0], "angle": 45, "velocity": [0, -5, 0]}
    tilted = assembly.assemble(read(edge, obstacles=[FLOOR | {"point": [0, 0, 0]}], mesh_size=0.03, contact_mesh_size=0.008)).mesh
    lengths = np.linalg.norm(tilted.points[tilted.faces[:, 0]] - tilted.points[tilted.faces[:, 1]], axis=1)
    assert tilted.points[:, 1].min() == pytest.approx(-0.05 * math.sqrt(2)) and tilted.points[tilted.faces[lengths.argmin(), 0], 1] < -0.04


def test_too_many_unknowns_are_refused(monkeypatch):
    """Before gmsh meshes for hours, and before FreeFEM runs for days: the number, and what helps."""
    began = time.monotonic()
    for entries in ({"mesh_size": 1e-4}, {"mesh_size": 0.01, "contact_mesh_size": 1e-4}):
        with pytest.raises(BadInput, match=r"mesh_size: 'ball' would have about .* tetrahedra \(accepted: up to 400000; larger mesh_size"):
            assembly.assemble(read(BALL | entries))
    monkeypatch.setattr(solid_mesh, "MOST_UNKNOWNS", 500)
    with pytest.raises(BadInput, match=r"mesh_size: the bodies have [0-9]* unknowns \(accepted: up to 500; larger mesh_size"):
        assembly.assemble(read(BALL))
    assert time.monotonic() - began < 60


# ---- files

@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A ball as a mesh in gmsh's formats, of second order and in Medit's, a pierced plate as geometry, a box with a named surface."""
    folder = tmp_path_factory.mktemp("files")
    with mesh.gmsh_session() as gmsh:
        gmsh.model.occ.addSphere(1, 2, 3, 0.05)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.02)
        gmsh.model.mesh.generate(3)
        for name, version, binary in (("41.msh", 4.1, 0), ("41-binary.msh", 4.1, 1), ("22.msh", 2.2, 0), ("22-binary.msh", 2.2, 1), ("ball.mesh", 4.1, 0)):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.write(str(folder / name))
        gmsh.model.mesh.setOrder(2)
        gmsh.write(str(folder / "second-order.msh"))
    with mesh.gmsh_session() as gmsh:
        occ = gmsh.model.occ
        occ.cut([(3, occ.addBox(0, 0, 0, 200, 50, 100))], [(3, occ.addCylinder(50, -1, 50, 0, 60, 0, 20))])
        occ.synchronize()
        gmsh.write(str(folder / "plate.step"))        # in mm, as the file says
    (folder / "named.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 0.2, 0.06, 0.2};\n'
                                      'Physical Surface("contact") = Surface In BoundingBox {-0.01, -0.01, -0.01, 0.21, 0.01, 0.21};\nPhysical Volume("body") = {1};\n')
    (folder / "other.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 0.2, 0.06, 0.2}; Physical Surface("top") = {4};\n')
    (folder / "twins.geo").write_text('SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 0.2, 0.06, 0.2}; Sphere(2) = {1, 0, 0, 0.1};\n')
    (folder / "flat.geo").write_text('SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 1, 1};\n')
    (folder / "text.msh").write_text("no mesh")
    (folder / "script.msh").write_text(f'SystemCall "touch {folder}/made";\n')
    (folder / "leaves.geo").write_text("Exit;\n")
    return folder


@pytest.mark.parametrize("name", ["41.msh", "41-binary.msh", "22.msh", "22-binary.msh", "second-order.msh", "ball.mesh"])
def test_meshes_of_files(files, name):
    """The same ball in every format, of second order by its corners: found to be one, about its centre, all of its surface may touch."""
    body, = read({"shape": "mesh", "file": name, "position": [0, 0.3, 0]}, folder=files).bodies
    assert body.outline.disc[1] == pytest.approx(0.05, rel=1e-8) if name != "ball.mesh" else body.outline.reach == pytest.approx(0.05, rel=1e-3)
    assert body.mesh.volumes.sum() == pytest.approx(4 / 3 * math.pi * 0.05**3, rel=0.05) and body.mesh.volumes.min() > 0
    assert abs(body.mesh.centre).max() < 1e-4 and set(body.mesh.labels) == {1}


def test_geometries_are_meshed_with_the_sizes_of_the_scene(files):
    """A STEP file in its own unit: volume of the plate with its hole, finer where it will touch; turned and in place."""
    scene = read({"shape": "mesh", "file": "plate.step", "position": [0, 0.3, 0], "turn": [0, 0, 30], "velocity": [0, -5, 0], "mesh_size": 0.025, "contact_mesh_size": 0.008},
                 folder=files, obstacles=[FLOOR | {"point": [0, 0, 0]}])
    m = assembly.assemble(scene).mesh
    assert m.volumes.sum() == pytest.approx(0.2 * 0.05 * 0.1 - math.pi * 0.02**2 * 0.05, rel=0.01)
    assert abs(m.centre).max() < 1e-9 and scene.bodies[0].outline.extent == pytest.approx([0.2, 0.05, 0.1], rel=1e-6)
    lowest = m.points[:, 1].min()
    lengths, middle = np.linalg.norm(m.points[m.faces[:, 0]] - m.points[m.faces[:, 1]], axis=1), m.points[m.faces].mean(axis=1)
    assert lengths[middle[:, 1] < lowest + 0.006].max() < 0.014 and lengths[middle[:, 1] > 0.05].mean() > 0.016


@pytest.mark.robustness
def test_named_surfaces_may_touch(files):
    """Faces of the physical surface `contact` have the label 1, all others 4; without one all have
    1, those of a cavity where something reaches them."""
    m = assembly.assemble(read({"shape": "mesh", "file": "named.geo", "position": [0, 0.1, 0]}, folder=files, obstacles=[FLOOR | {"point": [0, 0, 0]}])).mesh
    below = (m.points[m.faces][..., 1] < m.points[:, 1].min() + 1e-6).all(axis=1)
    assert np.array_equal(m.labels == 1, below) and set(m.labels) == {1, 4}
    (files / "hollow.geo").write_text('SetFactory("OpenCASCADE"); Sphere(1) = {0, 0, 0, 1}; Sphere(2) = {0, 0, 0, 0.5}; BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n')
    assert set(solid_file.read(files / "hollow.geo").labels) == {1}
    hollow = {"shape": "mesh", "file": "hollow.geo", "position": [0, 1.1, 0], "mesh_size": 0.3,
              "contact_mesh_size": 0.3}
    inside = {"name": "inside", "shape": "ball", "radius": 0.1, "position": [0.1, 1.1, 0],
              "mesh_size": 0.05, "contact_mesh_size": 0.05}
    beside = inside | {"position": [2, 1.1, 0]}
    for more, word, labels in (([], "off", {4}), ([], "on", {1}), ([inside], "off", {1}),
                               ([beside], "off", {4})):
        made = assembly.assemble(read(hollow, *more, folder=files, obstacles=[FLOOR],
                                      contact={"self_contact": word})).mesh
        away = np.linalg.norm(made.points[made.faces].mean(axis=1), axis=1)
        assert set(made.labels[away < 0.7]) == labels and set(made.labels[away > 0.7]) == {1}


@pytest.mark.parametrize("name, words", [
    ("none.step", "body.1.file: 'none.step' is no file"), ("ball.stl", "body.1.file: 'ball.stl' is no mesh or geometry (accepted: .msh, .mesh, .geo, .step, .stp)"),
    ("text.msh", "body.1.file: 'text.msh': it does not begin with $MeshFormat (accepted: gmsh's .msh)"),
    ("script.msh", "body.1.file: 'script.msh': it does not begin with $MeshFormat"), ("leaves.geo", "body.1.file: 'leaves.geo': gmsh broke down over it (exit code 0)"),
    ("", "body.1.file: is missing (accepted: .msh, .mesh, .geo, .step, .stp)"), ("flat.geo", "body.1.file: 'flat.geo': it has no volume"),
    ("twins.geo", "body.1.file: 'twins.geo': its tetrahedra are 2 pieces that hang together nowhere (accepted: one"),
    ("other.geo", "body.1.file: 'other.geo': none of its physical surfaces (top) has the name 'contact'")])
def test_files_that_cannot_be_used_are_named(files, name, words):
    """The entry, the file as given, and what is wrong with it, in one line."""
    with pytest.raises(BadInput) as caught:
        read({"shape": "mesh", "file": name}, folder=files)
    assert words in str(caught.value) and "\n" not in str(caught.value) and caught.value.code == 10
    assert not (files / "made").exists()              # gmsh would run a script that is called a mesh


# ---- what is round in a file

def prism(corners: int, path) -> None:
    """A prism of radius 0.05 and height 0.08 along y in Medit's format, whose vertices but that in the middle all lie on one sphere."""
    turn = 2 * math.pi * np.arange(corners) / corners
    points = np.vstack([[[0, 0, 0]], *(np.column_stack([0.05 * np.cos(turn), np.full(corners, y), 0.05 * np.sin(turn)]) for y in (-0.04, 0.04))])
    k = np.arange(corners)
    low, high = 1 + k, 1 + corners + k
    sides = np.vstack([np.column_stack(one) for one in ((low, high, np.roll(high, -1)), (low, np.roll(high, -1), np.roll(low, -1)))])
    ends = np.vstack([np.column_stack([np.full(corners - 2, one[0]), one[1:-1], one[2:]]) for one in (low, high)])
    cells = solid_mesh.right_handed(points, np.column_stack([np.zeros(4 * corners - 4, dtype=int), np.vstack([sides, ends])]))
    faces = mesh.boundary(cells)
    solid_mesh.write(solid_mesh.SolidMesh(points, cells, faces, np.ones(len(faces), dtype=int)), np.zeros(len(cells), dtype=int), path)


def found_in(path) -> list[tuple]:
    """The surfaces of a file that are round: whether it is a cylinder, its radius, how many of the faces lie on it."""
    m = solid_file.read(path)
    return [(len(one.axis) > 0, round(one.radius, 9), len(own) / len(m.faces)) for one, own in curved.surfaces(m.points, m.faces)]


@pytest.mark.robustness
def test_surfaces_are_round_by_the_angles_of_their_faces(tmp_path):
    """A hexagonal prism is one, though its vertices lie on a sphere; of 24 sides it is a cylinder. A shaft with flats keeps them, a ball with a flat is no ball
    but has the sphere's surface."""
    prism(6, tmp_path / "6.mesh")
    prism(24, tmp_path / "24.mesh")
    for name, made in {"shaft": "Cylinder(1) = {0, 0, 0, 0, 0.03, 0, 0.02}; Box(2) = {-0.015, -1, -1, 0.03, 2, 2}; BooleanIntersection(3)",
                       "dome": "Sphere(1) = {0, 0, 0, 0.05}; Box(2) = {-1, -1, -1, 2, 1.02, 2}; BooleanIntersection(3)"}.items():
        (tmp_path / f"{name}.geo").write_text(f'SetFactory("OpenCASCADE");\n{made} = {{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }};\n')
    assert found_in(tmp_path / "6.mesh") == [] and found_in(tmp_path / "24.mesh") == [(True, 0.05, pytest.approx(48 / 92))]
    assert [one[:2] for one in found_in(tmp_path / "shaft.geo")] == [(True, 0.02)] * 2
    assert [one[:2] for one in found_in(tmp_path / "dome.geo")] == [(False, 0.05)]
    one, = read({"shape": "mesh", "file": "dome.geo", "position": [0, 0.3, 0]}, folder=tmp_path).bodies
    assert one.outline.disc is None and one.outline.extent[1] == pytest.approx(0.07, rel=5e-3)


@pytest.mark.parametrize("corners, section, outline, warned", [
    (6, 1.5 * math.sqrt(3) * 0.05**2, "0 faces on spheres, 0 on cylinders, 20 flat faces; 20 may touch", ""),
    (24, math.pi * 0.05**2, "0 faces on spheres, 48 on cylinders, 44 flat faces; 92 may touch", "mass: body1 has 1.2 % more than the mesh in its file")])
def test_the_mass_of_a_file_is_kept_or_warned_about(tmp_path, corners, section, outline, warned):
    """The body of a file has the mass of its shape, a hexagonal prism that of one; where its sides are round the log says so, and a warning by how much that
    is more than the file's."""
    prism(corners, tmp_path / "prism.mesh")
    body = {"shape": "mesh", "file": "prism.mesh", "position": [0, 0.0402, 0], "velocity": [0, -1, 0]}
    found = run.run(read(body, obstacles=[FLOOR | {"point": [0, 0, 0]}], folder=tmp_path, end_time=4e-4), {}, tmp_path / "run", estimate=False)
    assert found.summary["energy_initial"] == pytest.approx(section * 0.08 * 1722 / 2, rel=1e-4)
    assert f"outline: body1: {outline}\n" in (found.folder / "log.txt").read_text()
    assert [one[:len(warned)] for one in found.summary["warnings"] if one.startswith("mass")] == [warned] * bool(warned)


@pytest.mark.parametrize("cells, words", [
    ([(0, 1, 2, 3), (0, 1, 4, 5)], "it hangs together by an edge alone, from (0, 0, 0) to (0, 0, 0.1)"),
    ([(0, 1, 2, 3), (0, 4, 5, 6)], "it hangs together by a point alone, (0, 0, 0)")])
def test_bodies_that_hang_together_by_less_than_a_face_are_refused(tmp_path, cells, words):
    """Two tetrahedra with an edge, or a point, in common are no body, as triangles with a point in common are none in the plane."""
    points = 0.1 * np.array([(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, -1)])[:max(map(max, cells)) + 1]
    cells = solid_mesh.right_handed(points, np.array(cells))
    faces = mesh.boundary(cells)
    solid_mesh.write(solid_mesh.SolidMesh(points, cells, faces, np.ones(len(faces), dtype=int)), np.zeros(len(cells), dtype=int), tmp_path / "joined.mesh")
    with pytest.raises(BadInput) as caught:
        read({"shape": "mesh", "file": "joined.mesh"}, folder=tmp_path)
    assert f"body.1.file: 'joined.mesh': {words}" in str(caught.value)


# ---- symmetry

@pytest.mark.parametrize("entries, top, copies", [
    ({}, {}, 4), ({"velocity": [1, -8, 0]}, {}, 2), ({"velocity": [0, -8, 1]}, {}, 1), ({"spin": 5}, {}, 2), ({"spin": [0, 5, 0]}, {}, 1),
    ({"position": [0.01, 0.051, 0]}, {}, 2), ({"position": [0, 0.051, 0.01]}, {}, 1), ({}, {"body_force_x": 1}, 2), ({}, {"symmetry": "half"}, 2), ({}, {"symmetry": "full"}, 1)])
def test_as_much_symmetry_as_there_is(entries, top, copies):
    """A quarter where nothing breaks it, half where all moves in the plane z = 0, else all; less where less is asked for."""
    assert mirror.copies(read(BALL | entries, BLOCK, **top)) == copies


@pytest.mark.parametrize("turn, copies", [([0, 0, 90], 4), ([0, 0, 30], 2), ([0, 30, 0], 1), ([90, 90, 0], 1)])
def test_a_turned_box_keeps_what_symmetry_it_has(turn, copies):
    """About z it has its mirror image in z = 0 at any angle, in x = 0 at right angles; a cylinder on its side likewise."""
    assert mirror.copies(read(BALL | {"position": [0, 0.3, 0]}, BLOCK | {"turn": turn})) == copies
    lying = {"shape": "cylinder", "radius": 0.03, "height": 0.1, "position": [0, -0.04, 0], "turn": turn}
    about_itself = turn == [0, 30, 0]
    assert mirror.copies(read(BALL | {"position": [0, 0.3, 0]}, lying)) == (4 if about_itself else copies)


def test_obstacles_break_symmetry():
    """A wall that faces x leaves half, one that faces z nothing; a sphere off the axis as well."""
    for obstacle, copies in ((FLOOR | {"normal": [1, 1, 0], "point": [-1, 0, 0]}, 2), (FLOOR | {"normal": [0, 1, 1], "point": [0, -1, -1]}, 1),
                             ({"kind": "sphere", "centre": [0, -1, 0], "radius": 0.5}, 4), ({"kind": "bowl", "centre": [0.1, 0, 0], "radius": 3}, 2),
                             (FLOOR | {"velocity": [0, 0, 1]}, 1)):
        assert mirror.copies(read(BALL, BLOCK, obstacles=[obstacle])) == copies


# ---- what is refused

BAD = [
    ({"position": [0, 1]}, {}, "body.1.position: '[0, 1]' is no [x, y, z] (accepted: three numbers"),
    ({"velocity": [0, 1]}, {}, "body.1.velocity: '[0, 1]' is no [x, y, z]"),
    ({"turn": [0, 0, 1], "angle": 3}, {}, "body.1.angle: '3' stands beside turn"),
    ({"shape": "disc"}, {}, "body.1.shape: 'disc' is not known (accepted: ball|box|cylinder|mesh)"),
    ({"width": 3}, {}, "body.1.width: no such entry, set to '3'"),
    ({"speed": 3}, {}, "body.1.speed: no such entry, set to '3'"),
    ({"radius": 0.3}, {}, "body.1.position: 'ball' overlaps 'block' (body.2)"),
    ({}, {"symmetry": "third"}, "symmetry: 'third' is not known (accepted: auto|full|half|quarter)"),
    ({"velocity": [0, -8, 1]}, {"symmetry": "half"}, "symmetry: half, but 'ball' moves along z (accepted: auto|full)"),
    ({"spin": 1}, {"symmetry": "quarter"}, "symmetry: quarter, but 'ball' spins out of the plane x = 0 (accepted: auto|full|half)"),
    ({}, {"contact": {"pairing": "pairwise"}}, "pairing: bodies-3d takes no such parameter"),
    ({}, {"script": "bodies"}, "script: 'bodies' is not that of [[body]] tables in dimension = '3d'"),
]


@pytest.mark.parametrize("entries, top, words", BAD, ids=[words.split(" (")[0] for *_, words in BAD])
def test_what_is_wrong_is_named(entries, top, words):
    """One line with the entry, the value and what is accepted, exit code 10."""
    with pytest.raises(BadInput) as caught:
        read(BALL | entries, BLOCK, **top)
    assert words in str(caught.value) and caught.value.code == 10 and "\n" not in str(caught.value)


def test_symmetry_is_an_entry_of_three_dimensions():
    """In the plane the table has no such key."""
    with pytest.raises(BadInput, match="^symmetry: no such entry, set to 'half'"):
        read_scene({"symmetry": "half", "body": [{"shape": "disc", "radius": 1, "position": [0, 0]}]}, SCENES, "scene")


def test_three_numbers_of_obstacles():
    """Planes, spheres and bowls with points and vectors [x, y, z], as scene.dat has them."""
    scene = read(BALL, obstacles=[FLOOR | {"normal": [0, 2, 0], "velocity": [0, 1, 0]}, {"kind": "sphere", "centre": [0, -1, 0], "radius": 0.5}])
    lines = assembly.assemble(scene).data.splitlines()
    assert "floor plane 6 0.0 -0.5 0.0 0.0 1.0 0.0 0.0 1.0 0.0" in lines and "obstacle2 sphere 4 0.0 -1.0 0.0 0.5 0.0 0.0 0.0" in lines
    with pytest.raises(BadInput, match=r"obstacle.1.kind: 'polyline' is not known.*accepted: plane.sphere.bowl"):
        read(BALL, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 1]]}])


# ---- runs

@pytest.fixture(scope="module")
def falls(tmp_path_factory):
    """A ball on a rigid plane: a quarter of it, half, and all, on meshes of the same sizes."""
    folder, found = tmp_path_factory.mktemp("falls"), {}
    for symmetry in ("quarter", "half", "full"):
        scene = read(BALL | {"position": [0, 0.05, 0], "velocity": [0, -2, 0]}, obstacles=[FLOOR | {"point": [0, 0, 0]}], symmetry=symmetry, fields=2)
        found[symmetry] = run.run(scene, {}, folder / symmetry, estimate=False)
    return found


@pytest.mark.robustness
def test_parts_stand_for_the_whole(falls):
    """Mass, momentum and energy of the whole ball, whatever was computed; the rebounds and impulses agree to what the meshes differ. A part has the angular
    momentum that contact gives it about the axes about which the whole may turn: of a quarter none is stated."""
    for symmetry, found in falls.items():
        s = found.summary
        assert s["energy_initial"] == pytest.approx(4 / 3 * math.pi * 0.05**3 * 1722 * 2**2 / 2, rel=0.01), symmetry
        assert s["impulse"] == pytest.approx(falls["full"].summary["impulse"], rel=0.01) and s["energy_drift"] < 1e-8
        assert s["rebound_vy"] == pytest.approx(falls["full"].summary["rebound_vy"], rel=0.02)
        assert s["contact_time"] == pytest.approx(falls["full"].summary["contact_time"], rel=0.06)
        assert s["angular_momentum_drift"] is None if symmetry == "quarter" else s["angular_momentum_drift"] < 1e-8


def test_a_cylinder_rolls(tmp_path):
    """Down 5 degrees, bouncing a little, a solid cylinder on a coarse mesh has v = 2/3 g sin(5 deg) t on the mean, to 2 %; friction and its moment about the axis
    agree to 0.5 %, as normal forces on a round side pass through that."""
    slope, end = math.radians(5), 0.06
    pull = 9.81 * math.sin(slope)
    body = {"shape": "cylinder", "radius": 0.05, "height": 0.05, "position": [0, 0.05, 0], "turn": [90, 0, 0], "mesh_size": 0.025, "contact_mesh_size": 0.025}
    scene = read(body, obstacles=[FLOOR | {"point": [0, 0, 0]}], nu=0.3, end_time=end, dt=5e-4, gravity=9.81 * math.cos(slope), body_force_x=pull,
                 contact={"friction_static": 0.5, "friction_dynamic": 0.5, "penalty": 1e8})
    found = run.run(scene, {}, tmp_path / "roll", estimate=False)
    t, v, spin = (found.history[name] for name in ("t", "vx", "spin"))
    assert found.summary["energy_drift"] < 1e-8 and t @ v / (t @ t) == pytest.approx(2 / 3 * pull, rel=0.02)
    assert t @ (v - 0.05 / 2 * spin) / (t @ t) == pytest.approx(pull, rel=0.005)


def test_report_and_figures(falls, tmp_path):
    """Forces in N, energies in J of a body in three dimensions; the parts are drawn with their mirror images among the obstacles, a whole
    body cut at z = 0."""
    found = falls["quarter"]
    text = report.report(found)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    assert figures.is_half(found.scene) and not figures.is_half(falls["half"].scene) and not figures.is_half(falls["full"].scene)
    plane, = bodies.obstacles_of(found.scene)
    assert plane.gap_in_plane(np.array([[3, 2.0]]), 1.0) == pytest.approx([2.0])
    for run_of in (found, falls["full"]):
        assert {"energies", "force", "velocity", "shapes"} <= {path.stem for path in drawing.draw(run_of.folder)}


def test_it_is_the_ball_of_the_other_dimension(falls, tmp_path):
    """The same scene as a body of revolution, to the coarse meshes' error."""
    scene = read_scene(SCENE | {"dimension": "axisymmetric", "body": [{"shape": "ball", "radius": 0.05, "position": 0.05, "velocity": -2}],
                                    "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}, tmp_path, "flat")
    flat, solid = run.run(scene, {}, tmp_path / "flat", estimate=False).summary, falls["quarter"].summary
    assert solid["impulse"] == pytest.approx(flat["impulse"], rel=0.02) and solid["rebound_vy"] == pytest.approx(flat["rebound_vy"], rel=0.02)
    assert solid["contact_time"] == pytest.approx(flat["contact_time"], rel=0.08)


def test_the_scene_as_used_makes_the_same_run(falls, tmp_path):
    """scene.toml says dimension and symmetry as used and makes the same data file again; the script alone leaves the same history."""
    found = falls["quarter"]
    again = load(str(found.folder / "scene.toml"))
    assert again.script == SCRIPT and set(again.values) <= set(parameters.names(SCRIPT)) and again.given["symmetry"] == "quarter"
    made = assembly.assemble(again)
    assert made.data == (found.folder / "scene.dat").read_text() and to_toml(made.used) == (found.folder / "scene.toml").read_text()
    flags = freefem.words_of(made.values)
    code, _, _ = call(*flags, "-mesh", str(found.folder / "mesh.mesh"), "-bodies", str(found.folder / "scene.dat"), "-out", str(tmp_path / "direct"),
                      cwd=tmp_path, script=SCRIPT)
    assert code == 0 and (tmp_path / "direct/history.csv").read_text() == (found.folder / "history.csv").read_text()


def test_a_ball_on_a_free_block(tmp_path):
    """A quarter of both, coarse and until shortly after the touch: no force from outside, so the momentum stays, and energy; the block is pushed down."""
    found = run.run(read(BALL, BLOCK, obstacles=(), end_time=8e-4, mesh_size=0.04, contact_mesh_size=0.025), {}, tmp_path / "block", estimate=False)
    h, s = found.history, found.summary
    assert s["dofs"] < 4000 and h["normal_force"].max() > 100 and s["energy_drift"] < 1e-8
    assert np.ptp(h["momentum_y"]) < 1e-8 * abs(h["momentum_y"]).max() and h["vy_2"][-1] < 0 and h["vy_1"][-1] > -8
    assert list(h) == found_columns(found) and found.scene["symmetry"] == "quarter"


@pytest.mark.robustness
def test_a_pair_is_that_of_the_other_dimension(tmp_path):
    """A ball on a free cylinder up to the largest force: impulse, velocities and force as of bodies of revolution, to the coarse meshes' error."""
    cylinder = {"name": "cylinder", "shape": "cylinder", "radius": 0.08, "height": 0.06}
    ball = {key: value for key, value in BALL.items() if key not in ("position", "velocity")}
    top = {"end_time": 2e-3, "accuracy": 0.1}
    solid = run.run(read(BALL | {"position": [0, 0.05, 0]}, cylinder | {"position": [0, -0.03, 0]}, obstacles=(), **top), {}, tmp_path / "solid", estimate=False).summary
    scene = read_scene(SCENE | top | {"dimension": "axisymmetric", "body": [ball | {"position": 0.05, "velocity": -8}, cylinder | {"position": -0.03}]}, tmp_path, "flat")
    flat = run.run(scene, {}, tmp_path / "flat", estimate=False).summary
    assert flat["impulse"] > 2.5
    for name, off in (("impulse", 0.02), ("impulse_y_1", 0.02), ("rebound_vy_1", 0.02), ("rebound_vy_2", 0.03), ("peak_force", 0.06)):
        assert solid[name] == pytest.approx(flat[name], rel=off), name


def found_columns(found) -> list[str]:
    return load(str(found.folder / "scene.toml")).columns
