"""Scenes of bodies in three dimensions: shapes and distances, meshes, files, symmetry, refused
input, and runs."""

import functools
import math
import time

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.freefem.arrays import unpacked
from ffimpact.geometry import tumbling
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh, solid_file, solid_mesh, solids
from ffimpact.output import folder, results
from ffimpact.report import bodies, drawing, figures, report
from ffimpact.running import run
from ffimpact.scene import load, read as read_scene
from ffimpact.scenes import assembly
from tests.support.bodies_3d import BALL, BLOCK, FLOOR, SCENE, prism, read
from tests.support.direct import call
from verification.measure import bodies as measure_bodies

SCRIPT = "bodies-3d"


def quality(m: solid_mesh.SolidMesh) -> np.ndarray:
    """The volume over that of the regular tetrahedron with the same mean square edge; 1 is best."""
    corners = m.points[m.cells]
    squares = [((corners[:, i] - corners[:, j])**2).sum(axis=1) for i in range(4) for j in range(i)]
    return m.volumes * 6 * math.sqrt(2) / np.mean(squares, axis=0) ** 1.5


def full_on(m: solid_mesh.SolidMesh, label: int) -> int:
    """The number of tetrahedra with all four corners on faces with this label."""
    on = np.zeros(len(m.points), dtype=bool)
    on[m.faces[m.labels == label]] = True
    return int(on[m.cells].all(axis=1).sum())


def test_free_bodies_tumble():
    """Euler's equations in the axes of the body, J w' = J w x w, are integrated by another method
    in small steps.

    A ball, and a box about a principal axis, keep their rotation. No spin exceeds the bound.
    """
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


# ---- meshes

@pytest.mark.parametrize("symmetry, copies", [("full", 1), ("half", 2), ("quarter", 4)])
def test_bodies_are_meshed_whole_or_by_symmetry(symmetry, copies):
    """The mesh has the volumes of the bodies. Spheres and planes of symmetry are exact to rounding,
    with the labels 2 (x = 0) and 3 (z = 0).

    The tetrahedra have a good shape, and none has all corners on the surface of the ball.
    """
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
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()  # the surface is closed


def test_bodies_stand_apart_above_each_other():
    """Bodies stand on the y axis without common vertices. The shift of each leads to its position.
    """
    scene = load("ball-block")
    built = assembly.assemble(scene)
    heights = [built.mesh.points[np.unique(built.mesh.cells[built.regions == k])][:, 1] for k in (0, 1)]
    assert heights[0].max() < heights[1].min() and not built.centres[:, [0, 2]].any()
    made = built.arrays
    assert made["script"] == "bodies-3d" and made["symmetry_factor"] == 4 and made["arcs"] == 1 and not made["arcs.axis"].any()
    assert made["bodies.centre"] + made["bodies.shift"] == pytest.approx(np.array([body.start_position for body in scene.bodies]))


def test_too_many_unknowns_are_refused(monkeypatch):
    """They are refused before gmsh meshes for hours and FreeFEM runs for days, with their number
    and advice."""
    began = time.monotonic()
    for entries in ({"mesh_size": 1e-4}, {"mesh_size": 0.01, "contact_mesh_size": 1e-4}):
        with pytest.raises(BadInput, match=r"mesh_size: 'ball' would have about .* tetrahedra \(accepted: up to 1000000; larger mesh_size"):
            assembly.assemble(read(BALL | entries))
    monkeypatch.setattr(solid_mesh, "MOST_UNKNOWNS", 500)
    with pytest.raises(BadInput, match=r"mesh_size: the bodies have [0-9]* unknowns \(accepted: up to 500; larger mesh_size"):
        assembly.assemble(read(BALL))
    assert time.monotonic() - began < 60


# ---- files

@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A ball as a mesh in gmsh's formats, of second order and in Medit's, a pierced plate as
    geometry, and a box with a physical surface."""
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
        gmsh.write(str(folder / "plate.step"))  # in mm, the unit of the file
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
    """The same ball in every format, of second order by its corners, is recognised and centred. All
    of its surface may come into contact."""
    body, = read({"shape": "mesh", "file": name, "position": [0, 0.3, 0]}, folder=files).bodies
    assert body.outline.disc[1] == pytest.approx(0.05, rel=1e-8) if name != "ball.mesh" else body.outline.reach == pytest.approx(0.05, rel=1e-3)
    assert body.file_mesh.volumes.sum() == pytest.approx(4 / 3 * math.pi * 0.05**3, rel=0.05) and body.file_mesh.volumes.min() > 0
    assert abs(body.file_mesh.centre).max() < 1e-4 and set(body.file_mesh.labels) == {1}


def test_geometries_are_meshed_with_the_sizes_of_the_scene(files):
    """A STEP file in its own unit, rotated and shifted: the plate has its volume with the hole, and
    is finer in the contact region."""
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
    """Faces of the physical surface `contact` have the label 1, all others 4.

    Without this surface all have 1, those of a cavity only if something reaches them.
    """
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
    """One line with the entry, the file as given, and the error."""
    with pytest.raises(BadInput) as caught:
        read({"shape": "mesh", "file": name}, folder=files)
    assert words in str(caught.value) and "\n" not in str(caught.value) and caught.value.code == 10
    # gmsh would run a script with the name of a mesh.
    assert not (files / "made").exists()


@pytest.mark.parametrize("corners, section, flat, warned", [
    (6, 1.5 * math.sqrt(3) * 0.05**2, 20, ""),
    (24, math.pi * 0.05**2, 44, "mass: body1 has 1.2 % more than the mesh in its file")])
def test_the_mass_of_a_file_is_kept_or_warned_about(tmp_path, corners, section, flat, warned):
    """The body of a file has the mass of its shape; a hexagonal prism has that of a prism.

    If its sides are round, a warning has the difference from the mass of the file.
    """
    prism(corners, tmp_path / "prism.mesh")
    body = {"shape": "mesh", "file": "prism.mesh", "position": [0, 0.0402, 0], "velocity": [0, -1, 0]}
    result = run.run(read(body, obstacles=[FLOOR | {"point": [0, 0, 0]}], folder=tmp_path, end_time=4e-4), {}, tmp_path / "run", estimate=False)
    assert result.summary["energy_initial"] == pytest.approx(section * 0.08 * 1722 / 2, rel=1e-4)
    arcs = unpacked((result.folder / "scene.bin").read_bytes())["mesh.arc_of"].ravel()
    assert (arcs == -1).sum() == flat and (arcs >= 0).sum() == 2 * corners * bool(warned)
    assert [warning[:len(warned)] for warning in result.summary["warnings"] if warning.startswith("mass")] == [warned] * bool(warned)


@pytest.mark.parametrize("cells, words", [
    ([(0, 1, 2, 3), (0, 1, 4, 5)], "it hangs together by an edge alone, from (0, 0, 0) to (0, 0, 0.1)"),
    ([(0, 1, 2, 3), (0, 4, 5, 6)], "it hangs together by a point alone, (0, 0, 0)")])
def test_bodies_that_hang_together_by_less_than_a_face_are_refused(tmp_path, cells, words):
    """Two tetrahedra with a common edge or point are not a body, as triangles with a common point
    are not one in the plane."""
    points = 0.1 * np.array([(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, -1)])[:max(map(max, cells)) + 1]
    cells = solid_mesh.right_handed(points, np.array(cells))
    faces = mesh.boundary(cells)
    solid_mesh.write(solid_mesh.SolidMesh(points, cells, faces, np.ones(len(faces), dtype=int)), np.zeros(len(cells), dtype=int), tmp_path / "joined.mesh")
    with pytest.raises(BadInput) as caught:
        read({"shape": "mesh", "file": "joined.mesh"}, folder=tmp_path)
    assert f"body.1.file: 'joined.mesh': {words}" in str(caught.value)


def test_three_numbers_of_obstacles():
    """Planes, spheres and hollow spheres with points and vectors [x, y, z], as in scene.bin."""
    scene = read(BALL, obstacles=[FLOOR | {"normal": [0, 2, 0], "velocity": [0, 1, 0]}, {"kind": "sphere", "centre": [0, -1, 0], "radius": 0.5}])
    made = assembly.assemble(scene).arrays
    assert list(made["obstacles.name"]) == ["floor", "obstacle2"] and made["obstacles.kind"].tolist() == [0, 1] and made["obstacles.velocity"].tolist() == [[0, 1, 0], [0, 0, 0]]
    assert made["obstacles.numbers"].tolist() == [0, -0.5, 0, 0, 1, 0, 0, -1, 0, 0.5] and made["obstacles.numbers.first"].tolist() == [0, 6, 10]
    with pytest.raises(BadInput, match=r"obstacle.1.kind: 'polyline' is not known.*accepted: plane.sphere.bowl"):
        read(BALL, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 1]]}])


# ---- runs

@pytest.fixture(scope="module")
def fall(tmp_path_factory):
    """fall(symmetry): a ball on a rigid plane as a quarter, half or whole, on meshes of the same sizes."""
    @functools.cache
    def of(symmetry: str, **entries) -> results.Record:
        scene = read(BALL | {"position": [0, 0.05, 0], "velocity": [0, -2, 0]}, obstacles=[FLOOR | {"point": [0, 0, 0]}], symmetry=symmetry, fields=2, **entries)
        return run.run(scene, {}, tmp_path_factory.mktemp("fall") / symmetry, estimate=False)
    return of


@pytest.mark.robustness
def test_parts_stand_for_the_whole(fall):
    """Mass, momentum and energy are those of the whole ball. Rebounds and impulses agree to the
    difference of the meshes.

    Half a ball has the angular momentum about the axes about which the whole may rotate; a quarter
    has none.
    """
    whole = fall("full").summary
    for symmetry in ("quarter", "half", "full"):
        s = fall(symmetry).summary
        assert s["energy_initial"] == pytest.approx(4 / 3 * math.pi * 0.05**3 * 1722 * 2**2 / 2, rel=0.01), symmetry
        assert s["impulse"] == pytest.approx(whole["impulse"], rel=0.01) and s["energy_drift"] < 1e-8
        assert s["rebound_vy"] == pytest.approx(whole["rebound_vy"], rel=0.02)
        assert s["contact_time"] == pytest.approx(whole["contact_time"], rel=0.06)
        assert s["angular_momentum_drift"] is None if symmetry == "quarter" else s["angular_momentum_drift"] < 1e-8


def test_a_cylinder_rolls(tmp_path):
    """On a slope of 5 degrees, with small bounces, a solid cylinder on a coarse mesh has v = 2/3 g
    sin(5 deg) t in the mean, to 2 %.

    Friction and its moment about the axis agree to 0.5 %, as normal forces on a round side pass
    through the axis.
    """
    slope, end = math.radians(5), 0.06
    pull = 9.81 * math.sin(slope)
    body = {"shape": "cylinder", "radius": 0.05, "height": 0.05, "position": [0, 0.05, 0], "turn": [90, 0, 0], "mesh_size": 0.025, "contact_mesh_size": 0.025}
    scene = read(body, obstacles=[FLOOR | {"point": [0, 0, 0]}], nu=0.3, end_time=end, dt=5e-4, gravity=9.81 * math.cos(slope), body_force_x=pull,
                 contact={"friction_static": 0.5, "friction_dynamic": 0.5, "penalty": 1e8})
    result = run.run(scene, {}, tmp_path / "roll", estimate=False)
    t, v, spin = (result.history[name] for name in ("t", "vx", "spin"))
    assert result.summary["energy_drift"] < 1e-8 and t @ v / (t @ t) == pytest.approx(2 / 3 * pull, rel=0.02)
    assert t @ (v - 0.05 / 2 * spin) / (t @ t) == pytest.approx(pull, rel=0.005)


def test_report_and_figures(fall):
    """Forces are in N, energies in J. Parts are drawn with their mirror images among the obstacles,
    a whole body as its section z = 0."""
    result, whole = fall("quarter"), fall("full", end_time=4e-4)
    text = report.report(result, verbose=True)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    assert figures.is_half(result.scene) and not figures.is_half(result.scene | {"symmetry": "half"}) and not figures.is_half(whole.scene)
    plane, = bodies.obstacles_of(result.scene)
    assert plane.gap_in_plane(np.array([[3, 2.0]]), 1.0) == pytest.approx([2.0])
    for run_of in (result, whole):
        assert {"energies", "force", "velocity", "shapes"} <= {path.stem for path in drawing.draw(run_of.folder)} <= set(folder.FIGURES)


def test_it_is_the_ball_of_the_other_dimension(fall, tmp_path):
    """It agrees with the same scene as a body of revolution, to the error of the coarse meshes."""
    scene = read_scene(SCENE | {"dimension": "axisymmetric", "body": [{"shape": "ball", "radius": 0.05, "position": 0.05, "velocity": -2}],
                                    "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}, tmp_path, "flat")
    flat, solid = run.run(scene, {}, tmp_path / "flat", estimate=False).summary, fall("quarter").summary
    assert solid["impulse"] == pytest.approx(flat["impulse"], rel=0.02) and solid["rebound_vy"] == pytest.approx(flat["rebound_vy"], rel=0.02)
    assert solid["contact_time"] == pytest.approx(flat["contact_time"], rel=0.08)


def test_the_scene_as_used_makes_the_same_run(fall, tmp_path):
    """scene.toml has dimension and symmetry as used and gives the same data file. The script alone
    gives the same history."""
    result = fall("quarter")
    again = load(str(result.folder / "scene.toml"))
    assert again.kind.script == SCRIPT and set(again.values) <= set(parameters.PARAMETERS) and again.content["symmetry"] == "quarter"
    made = assembly.assemble(again)
    assert made.data == (result.folder / "scene.bin").read_bytes() and to_toml(made.used) == (result.folder / "scene.toml").read_text()
    code, _, _ = call("-scene", str(result.folder / "scene.bin"), "-out", str(tmp_path / "direct"), cwd=tmp_path, kind=SCRIPT)
    assert code == 0 and (tmp_path / "direct/history.csv").read_text() == (result.folder / "history.csv").read_text()


def test_a_ball_on_a_free_block(tmp_path):
    """A quarter of both bodies, coarse, until shortly after contact: momentum and energy are
    constant, and the block is pushed down."""
    result = run.run(read(BALL, BLOCK, obstacles=(), end_time=8e-4, mesh_size=0.04, contact_mesh_size=0.025), {}, tmp_path / "block", estimate=False)
    h, s = result.history, result.summary
    assert s["dofs"] < 4000 and h["normal_force"].max() > 100 and s["energy_drift"] < 1e-8
    assert np.ptp(h["momentum_y"]) < 1e-8 * abs(h["momentum_y"]).max() and h["vy_2"][-1] < 0 and h["vy_1"][-1] > -8
    assert list(h) == found_columns(result) and result.scene["symmetry"] == "quarter"


def found_columns(result) -> list[str]:
    return load(str(result.folder / "scene.toml")).columns


@pytest.mark.parametrize("kind, lengths, mirror_axes", [
    ("shell", [0.05, 0.04], (0, 2)), ("shell", [0.05, 0.01], ()), ("tube", [0.05, 0.03, 0.08], (2,))])
def test_hollow_solids_are_meshed_on_both_surfaces(kind, lengths, mirror_axes):
    """All corners on curved faces lie on their sphere or cylinder, the cavity of a shell never
    comes into contact, and the volume converges to the exact one."""
    shape = getattr(solids, kind)(*lengths)
    turn = np.eye(3) if kind == "shell" else tumbling.rotation(np.radians([90, 0, 0]))
    off = []
    for size in (0.02, 0.01):
        sizes = mesh.Sizes(size, size, np.empty((0, 3)), 0.0)
        made = solid_mesh.mesh_shape(kind, np.array(lengths), turn, mirror_axes, sizes, 0.01)
        own = np.unique(made.faces[np.isin(made.labels, (mesh.FREE, made.NEVER))])
        assert abs(shape.gap(made.points[own] @ turn)).max() < 1e-12
        middle = np.linalg.norm(made.points[made.faces].mean(axis=1), axis=1)
        if kind == "shell":
            inner = (middle < sum(lengths) / 2) & np.isin(made.labels, (mesh.FREE, made.NEVER))
            assert ((made.labels == made.NEVER) == inner).all()
        off.append(made.volumes.sum() * 2 ** len(mirror_axes) / shape.volume - 1)
    assert abs(off[1]) < abs(off[0]) < 0.1


def test_a_hollow_ball_with_gas_as_in_revolution(tmp_path):
    """A thick shell with gas hits a plane: in space, a quarter of it, as the body of revolution,
    to 1 % of impulse and rebound on coarse meshes."""
    shell = {"shape": "shell", "radius": 0.03, "inner_radius": 0.02, "mesh_size": 0.01, "contact_mesh_size": 0.006,
             "load": [{"where": "inner", "gas": {"gauge_pressure": 2e4, "exponent": 1.4}}]}
    entries = SCENE | {"young": 1e6, "density": 1000, "dt": 1e-4, "contact": {"penalty": 3e9}}
    flat = entries | {"dimension": "axisymmetric", "body": [shell | {"position": 0.0305, "velocity": -3}],
                      "obstacle": [FLOOR | {"point": [0, 0], "normal": [0, 1]}]}
    solid = entries | {"body": [shell | {"position": [0, 0.0305, 0], "velocity": [0, -3, 0]}], "obstacle": [FLOOR | {"point": [0, 0, 0]}]}
    first, second = (measure_bodies(tmp_path / name, scene).summary for name, scene in (("flat", flat), ("solid", solid)))
    for name in ("impulse", "rebound_vy"):
        assert second[name] == pytest.approx(first[name], rel=0.01)


def test_a_solid_of_a_file_keeps_its_coordinates(tmp_path):
    """A prism about the origin of its file: `position` moves the origin, or the centre."""
    prism(6, tmp_path / "prism.mesh")
    entries = {"shape": "mesh", "file": "prism.mesh", "placement": "as-drawn", "position": [0, 0.5, 0]}
    body, = read(entries, folder=tmp_path).bodies
    assert body.placed.points[:, 1].min() == pytest.approx(0.46)
