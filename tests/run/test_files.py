"""Bodies from files: search paths, reading, sizes, scaling, copies, and the boundaries that may
come into contact."""

import math
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.mesh import mesh, solid_file
from ffimpact.report import report
from ffimpact.running import run
from ffimpact.scene import read
from ffimpact.scenes import approach, assembly
from ffimpact.sweeps import sweep
from tests.support.files import FLOOR, solid, tables, write_mesh, write_step

BALL = {"name": "ball", "shape": "disc", "radius": 0.02, "position": [0, 0.05], "velocity": [0, -2]}
BOX = 'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 100, 60, 40};\n'  # mm
VOLUME = 0.1 * 0.06 * 0.04  # volume of the box [m3]


def block(contact: str = ""):
    """Draws a block of 0.1 x 0.05 m. If a side is given, only this side may come into contact."""
    def draw(model):
        model.occ.addRectangle(0, 0, 0, 0.1, 0.05)
        model.occ.synchronize()
        if contact:
            sides = {"lower": 1, "right": 2, "upper": 3}
            model.addPhysicalGroup(1, [sides[contact]], name="contact")
            model.addPhysicalGroup(2, [1], name="body")
    return draw


# ---- search paths

def test_a_file_is_sought_beside_its_scene(tmp_path, monkeypatch):
    """STEP and .geo files are found from any working folder, also if it changes after the scene is
    read."""
    folder = tmp_path / "scenes"
    folder.mkdir()
    write_step(folder / "part.step")
    (folder / "part.geo").write_text(BOX.replace("100, 60, 40", "0.1, 0.06, 0.04"))
    for name, working, path in (("part.step", tmp_path, "scenes/part.toml"), ("part.geo", folder, "part.toml")):
        (folder / "part.toml").write_text(assembly.to_toml(solid(name, mesh_size=0.02, contact_mesh_size=0.02)))
        monkeypatch.chdir(working)
        loaded = scene.load(path)
        monkeypatch.chdir(tmp_path.parent)
        volume = assembly.assemble(loaded).mesh.volumes.sum()
        assert volume == pytest.approx(VOLUME, rel=1e-9), (name, path)


@pytest.mark.parametrize("name", ["part.step", "merges.geo"])
def test_a_declared_unit_is_that_of_the_file(tmp_path, name):
    """A STEP file in mm is read as such, and refuses a `scale` beside its unit."""
    write_step(tmp_path / "part.step")
    (tmp_path / "merges.geo").write_text('Merge "part.step";\n')
    part = scene.read(solid(name), tmp_path, "part").bodies[0]
    assert np.ptp(part.outline.points, axis=0) == pytest.approx([0.1, 0.06, 0.04], rel=1e-9)
    with pytest.raises(BadInput, match=rf"^body.1.scale: '0.001' for '{name}', which declares its unit of length \(accepted: without scale, or "):
        scene.read(solid(name, scale=0.001), tmp_path, "part")


def test_extents_and_mass_are_in_summary_and_report(tmp_path):
    """Those of a box of 100 x 60 x 40 mm, 1000 kg/m3, and of a tube of revolution."""
    write_step(tmp_path / "part.step")
    result = run.run(scene.read(solid("part.step", mesh_size=0.02) | {"end_time": 1e-4}, tmp_path, "part"), {}, tmp_path / "out", estimate=False)
    assert [result.summary[f"extent_{axis}"] for axis in "xyz"] == pytest.approx([0.1, 0.06, 0.04], rel=1e-9)
    assert result.summary["mass"] == pytest.approx(1000 * VOLUME, rel=1e-9)
    assert any(line.startswith("part: mesh, 0.1 x 0.06 x 0.04 m, 0.24 kg, neohookean") for line in report.report(result).splitlines())
    tube = {"shape": "tube", "radius": 0.05, "inner_radius": 0.03, "height": 0.04, "position": 0.0201, "velocity": -1}
    result = run.run(scene.read(tables(tube, obstacles=[FLOOR], dimension="axisymmetric", end_time=1e-4), tmp_path, "tube"), {}, tmp_path / "tube", estimate=False)
    assert [result.summary[name] for name in ("extent_x", "extent_y", "extent_z")] == [pytest.approx(0.1, rel=1e-9), pytest.approx(0.04, rel=1e-9), None]
    assert result.summary["mass"] == pytest.approx(1000 * np.pi * (0.05**2 - 0.03**2) * 0.04, rel=1e-9)


def test_gmsh_works_in_the_working_folder(tmp_path, monkeypatch):
    """Relative paths have the same meaning for gmsh, which has a process of its own."""
    write_step(tmp_path / "part.step")
    monkeypatch.chdir(tmp_path)
    volume = solid_file.meshed(Path("part.step")).volumes.sum()
    assert volume == pytest.approx(VOLUME, rel=1e-9)


# ---- gmsh 2.2

@pytest.mark.parametrize("side", ["", "contact"])
def test_elements_in_two_groups_are_read_once_in_the_plane(tmp_path, side):
    """gmsh 2.2 writes triangles and lines of two physical groups twice. Mesh and labels equal those
    of a file that has each once."""
    def draw(twice: bool):
        def model_of(model):
            block("lower" if side else "")(model)
            for k in range(2 * twice):
                model.addPhysicalGroup(2, [1], name=f"group {k}")
                if side:
                    model.addPhysicalGroup(1, [1, 2, 3, 4], name=f"side {k}")
        return model_of
    write_mesh(tmp_path / "once.msh", draw(False))
    write_mesh(tmp_path / "twice.msh", draw(True), version=2.2)
    assert (tmp_path / "twice.msh").read_text().startswith("$MeshFormat\n2.2")
    both = []
    for name in ("once", "twice"):
        body = {"shape": "mesh", "file": f"{name}.msh", "position": [0, 0]}
        both.append(read(tables(body, BALL | {"position": [0, 1]}), tmp_path, "x").bodies[0].file_mesh)
    once, twice = both
    assert len(once.triangles) == len(twice.triangles) and len(once.edges) == len(twice.edges)
    for label in np.unique(once.labels):
        first, second = (part.points[part.edges[part.labels == label]] for part in both)
        assert len(first) == len(second)
        assert first.mean(axis=(0, 1)) == pytest.approx(second.mean(axis=(0, 1)), abs=1e-12)


@pytest.mark.parametrize("side", ["", "contact"])
def test_elements_in_two_groups_are_read_once_in_space(tmp_path, side):
    """The same for tetrahedra and faces."""
    def draw(model):
        model.occ.addBox(0, 0, 0, 0.1, 0.03, 0.04)
        model.occ.synchronize()
        for k in range(2):
            model.addPhysicalGroup(3, [1], name=f"group {k}")
        if side:
            model.addPhysicalGroup(2, [3], name=side)
            model.addPhysicalGroup(2, [3, 4], name="sides")
    write_mesh(tmp_path / "solid.msh", draw, 0.02, 2.2)
    m = solid_file.read(tmp_path / "solid.msh")
    assert m.volumes.sum() == pytest.approx(0.1 * 0.03 * 0.04, rel=1e-9)
    assert len(np.unique(np.sort(m.cells), axis=0)) == len(m.cells)
    assert set(m.labels) == ({1, 4} if side else {1})
    lower = (abs(m.points[m.faces][..., 1]) < 1e-9).all(axis=1)
    assert np.array_equal(m.labels == 1, lower if side else np.ones_like(lower))


# ---- element sizes

@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    """A folder with all.msh, of which all sides may come into contact, and lower.msh and upper.msh,
    of which only that side may."""
    folder = tmp_path_factory.mktemp("plane")
    write_mesh(folder / "all.msh", block())
    for side in ("lower", "upper"):
        write_mesh(folder / f"{side}.msh", block(side))
    return folder


@pytest.mark.few(1)
@pytest.mark.parametrize("key, value", [("mesh_size", 0.001), ("contact_mesh_size", 0.0005)])
def test_element_sizes_of_a_mesh_from_a_file_are_its_own(plane, key, value):
    """Another size is refused for the body, at the top if no other body uses it, and if set later.

    Beside a shape the size at the top applies to the shape.
    """
    body = {"name": "block", "shape": "mesh", "file": "all.msh", "position": [0, 0]}
    accepted = ("mesh_size, contact_mesh_size where gmsh makes the mesh: of a shape, or of a geometry, "
                r"\.geo, \.step, \.stp")
    message = f"^body.1.{key}: '{value}' .*accepted: {accepted}"
    for make in (lambda: read(tables(body | {key: value}, BALL), plane, "x"),
                 lambda: read(tables(body, BALL), plane, "x").override({f"body.1.{key}": value})):
        with pytest.raises(BadInput, match=message) as caught:
            make()
        assert caught.value.code == 10
    low = FLOOR | {"point": [0, -1]}
    with pytest.raises(BadInput, match=f"^{key}: '{value}' changes nothing"):
        read(tables(body, obstacles=[low], gravity=9.81, **{key: value}), plane, "x")
    both = read(tables(body | {key: 0}, BALL, **{key: value}), plane, "x")
    size = {"mesh_size": "bulk_size", "contact_mesh_size": "contact_size"}[key]
    assert getattr(both.bodies[0], size) == 0 and getattr(both.bodies[1], size) == value
    used = assembly.assemble(read(tables(body, BALL), plane, "x")).used["body"]
    assert key not in used[0] and used[1][key] > 0


# ---- boundaries that may come into contact

def prepared(entries: dict, folder, where) -> str:
    """The text of scene.toml of a run that is ready to start in `where`."""
    where.mkdir(parents=True, exist_ok=True)
    return assembly.prepare(read(entries, folder, "x"), where)[2]


def test_what_may_not_touch_is_refused_where_it_meets_a_plane(plane, tmp_path):
    """A block of which only the upper side may come into contact is hit there, also beside a plane
    that it does not reach.

    It must not fall on a plane, unless the run ends before or it is rotated.
    """
    upper, lower = ({"name": "block", "shape": "mesh", "file": f"{side}.msh", "position": [0, 0]}
                    for side in ("upper", "lower"))
    prepared(tables(upper, BALL), plane, tmp_path / "1")
    prepared(tables(upper, BALL, obstacles=[FLOOR | {"point": [0, -1]}]), plane, tmp_path / "2")
    falls = {"obstacles": [FLOOR | {"point": [0, -0.1]}], "gravity": 9.81, "end_time": 1}
    prepared(tables(lower, **falls), plane, tmp_path / "3")
    prepared(tables(upper, **falls | {"end_time": 0.01}), plane, tmp_path / "4")
    prepared(tables(upper | {"angle": 180}, **falls), plane, tmp_path / "5")
    message = (r"^body.1.file: 'block' comes to 'floor' with \(.*, -0.1\) m, which is no contact boundary "
               ".*accepted: a file whose label 1, or physical group 'contact'")
    with pytest.raises(BadInput, match=message) as caught:
        prepared(tables(upper, **falls), plane, tmp_path / "6")
    assert caught.value.code == 10


def test_what_may_not_touch_is_refused_in_space(tmp_path):
    """A geometry of which only the upper face may come into contact is refused in this position,
    not if it is rotated."""
    (tmp_path / "named.geo").write_text(
        'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 0.1, 0.06, 0.04};\n'
        'Physical Surface("contact") = Surface In BoundingBox {-1, 0.059, -1, 1, 0.061, 1};\n')
    with pytest.raises(BadInput, match="^body.1.file: 'part' comes to 'floor' with"):
        prepared(solid("named.geo"), tmp_path, tmp_path / "1")
    prepared(solid("named.geo", turn=[0, 0, 180]), tmp_path, tmp_path / "2")


def test_a_disc_from_a_file_is_not_turned(tmp_path):
    """The part that may come into contact stays where the scene has it."""
    m = mesh.disc(0.05, 0.02, 0.01, False)
    labels = np.where(m.points[m.edges].mean(axis=1)[:, 1] < 0.05, mesh.FREE, 3)
    mesh.write(replace(m, labels=labels), tmp_path / "disc.msh")
    wall = {"kind": "plane", "point": [0.2, 0], "normal": [-1, 0]}
    body = {"shape": "mesh", "file": "disc.msh", "position": [0, 0], "angle": 90, "velocity": [1, 0]}
    problem = read(tables(body, obstacles=[wall]), tmp_path, "x")
    assert problem.bodies[0].outline.disc
    assert approach.with_discs_aligned(problem).bodies[0].start_angle == pytest.approx(math.pi / 2)
    prepared(tables(body, obstacles=[wall]), tmp_path, tmp_path / "1")
    with pytest.raises(BadInput, match="^body.1.file: .* which is no contact boundary"):
        prepared(tables(body | {"angle": -90}, obstacles=[wall]), tmp_path, tmp_path / "2")


@pytest.mark.robustness
def test_what_sinks_is_named_and_meshes_of_files_are_not_to_be_resized(plane, tmp_path):
    """A block of which only the upper side may come into contact falls through a peg: a warning
    `sinks` with body, obstacle and place.

    If the lower side is in contact, there is none. No warning advises to change the element sizes
    of a file.
    """
    peg = {"name": "peg", "kind": "circle", "centre": [0, -0.1], "radius": 0.1}
    body = {"name": "block", "shape": "mesh", "position": [0, 0.0255], "velocity": [0, -1]}
    top = {"obstacles": [peg], "end_time": 0.06}
    warned = {}
    for name in ("upper", "lower"):
        problem = read(tables(body | {"file": f"{name}.msh"}, **top), plane, name)
        warned[name] = run.run(problem, {}, tmp_path / name, estimate=False).summary["warnings"]
    sunk, = (warning for warning in warned["upper"] if warning.startswith("sinks: "))
    assert re.match(r"sinks: block is up to 0\.\d+ m inside peg near X = \(.*\) m, at t = ", sunk)
    assert not any(warning.startswith("sinks") for warning in warned["lower"])
    assert any("a finer mesh in the file" in warning for warning in warned["upper"])
    assert "contact_mesh_size" not in " ".join(warned["upper"] + warned["lower"])


# ---- copies in a result

@pytest.mark.few(1)
@pytest.mark.parametrize("name", ["part.step", "all.msh", "merges.geo"])
def test_a_result_has_the_files_of_its_bodies(plane, tmp_path, name):
    """scene.toml contains no path of this machine. In another folder, without the original file, it
    gives the same mesh.

    A .geo that includes another file has a path relative to the result.
    """
    folder = tmp_path / "scenes"
    folder.mkdir()
    write_step(folder / "part.step")
    shutil.copy(plane / "all.msh", folder)
    (folder / "merges.geo").write_text('Merge "part.step";\n')
    entries = solid(name)
    if name == "all.msh":
        body = entries["body"][0] | {"position": [0, 0.1], "velocity": [0, -1]}
        entries = tables(body, obstacles=[FLOOR])
    where = tmp_path / "results/run"
    text = prepared(entries, folder, where)
    first = assembly.assemble(read(entries, folder, "x"))
    (where / "scene.toml").write_text(text)
    assert str(tmp_path) not in text
    moved = tmp_path / "elsewhere/run"
    if name == "merges.geo":
        assert 'file = "../../scenes/merges.geo"' in text
        moved.parent.mkdir()
        shutil.copytree(where, moved)
    else:
        assert f'file = "body-files/part{name[name.index("."):]}"' in text
        shutil.move(folder, tmp_path / "gone")
        shutil.move(where, moved)
    again = assembly.assemble(scene.load(moved / "scene.toml"))
    assert again.mesh.points == pytest.approx(first.mesh.points, abs=1e-12)
    assert again.data == first.data


def test_scene_and_sweep_with_a_byte_order_mark(tmp_path):
    """Some editors write it."""
    text = assembly.to_toml(tables(BALL, obstacles=[FLOOR]))
    (tmp_path / "drop.toml").write_text("\ufeff" + text, "utf-8")
    assert scene.load(tmp_path / "drop.toml").bodies[0].own_name == "ball"
    text = 'scene = "disc-normal"\n[product]\nspeed = [1, 2]\n'
    (tmp_path / "sweep.toml").write_text("\ufeff" + text, "utf-8")
    assert len(sweep.load(str(tmp_path / "sweep.toml")).points) == 2


# ---- scale

def test_a_file_in_millimetres_has_a_scale(tmp_path):
    """In the plane, of revolution and in space, for meshes and geometries: body, circles, centre
    and element sizes are in m."""
    disc, half = (mesh.disc(50, 20, 10, symmetric) for symmetric in (False, True))
    mesh.write(disc, tmp_path / "disc.msh")
    mesh.write(half, tmp_path / "half.msh")
    (tmp_path / "box.geo").write_text(BOX)
    with mesh.gmsh_session() as gmsh:
        gmsh.open(str(tmp_path / "box.geo"))
        gmsh.option.setNumber("Mesh.MeshSizeMax", 20)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(tmp_path / "box.msh"))
    body = {"shape": "mesh", "file": "disc.msh", "scale": 0.001, "position": [0, 0.06],
            "velocity": [0, -1]}
    built_body = read(tables(body, obstacles=[FLOOR]), tmp_path, "x").bodies[0]
    assert built_body.outline.disc[1] == pytest.approx(0.05, rel=1e-9)
    assert np.ptp(built_body.file_mesh.points, axis=0) == pytest.approx([0.1, 0.1], rel=0.05)
    assert abs(built_body.outline.disc[0]).max() < 1e-12
    revolved = body | {"file": "half.msh", "position": 0.06, "velocity": -1}
    entries = tables(revolved, obstacles=[FLOOR], dimension="axisymmetric")
    built = assembly.assemble(read(entries, tmp_path, "x"))
    assert np.ptp(built.mesh.points, axis=0) == pytest.approx([0.05, 0.1], rel=0.02)
    volumes = {}
    for name in ("box.msh", "box.geo"):
        built = assembly.assemble(read(solid(name, scale=0.001), tmp_path, "x"))
        volumes[name] = built.mesh.volumes.sum()
        assert built.mesh.centre == pytest.approx([0, 0, 0], abs=1e-9)
    assert volumes == {name: pytest.approx(0.1 * 0.06 * 0.04, rel=1e-9) for name in volumes}
    ends, used = built.mesh.points[built.mesh.faces[:, :2]], built.used["body"][0]
    longest = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
    assert used["scale"] == 0.001 and longest < 2 * used["mesh_size"] < 0.1


@pytest.mark.parametrize("value, message", [
    (0, "body.1.scale: 0 is out of range (accepted: 1e-09 to 1e+09)"),
    (-1, "body.1.scale: -1 is out of range"), ("mm", "body.1.scale: 'mm' is not a number")])
def test_a_scale_that_is_none_is_named(plane, value, message):
    body = {"shape": "mesh", "file": "all.msh", "position": [0, 0.1], "scale": value}
    with pytest.raises(BadInput, match="^" + re.escape(message)):
        read(tables(body, obstacles=[FLOOR]), plane, "x")


def test_a_file_in_millimetres_without_a_scale_is_told_of_it(tmp_path):
    """The message mentions the scale if such a large body overlaps something, not for small bodies
    or shapes."""
    mesh.write(mesh.disc(60, 20, 10, False), tmp_path / "disc.msh")
    body = {"shape": "mesh", "file": "disc.msh", "position": [0, 0.06], "velocity": [0, -1]}
    for partner in ({"obstacles": [FLOOR]}, {"bodies": [BALL | {"position": [0, -0.05]}]}):
        entries = tables(body, *partner.pop("bodies", []), **partner)
        message = r"body.1.position: .*overlaps.*120 m wide: other units\? body.1.scale = 0.001"
        with pytest.raises(BadInput, match=message):
            read(entries, tmp_path, "x")
    disc = {"shape": "disc", "radius": 60, "position": [0, 0], "velocity": [0, -1]}
    for small in (body | {"scale": 0.01}, disc):
        with pytest.raises(BadInput, match="overlaps") as caught:
            read(tables(small, obstacles=[FLOOR]), tmp_path, "x")
        assert "scale" not in str(caught.value)
