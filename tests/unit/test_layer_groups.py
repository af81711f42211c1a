"""Layers by a group of a body's file: a mesh in the plane, of revolution and in space, and a STEP file."""

import re

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.failure import BadInput
from ffimpact.mesh import mesh
from ffimpact.mesh.mesh import INTERFACE
from ffimpact.scenes import assembly
from tests.support.files import write_mesh

RADIUS, CORE = 0.05, 0.03
RUBBER = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722.0}
SOFT = {"young": 1e6, "density": 1000.0}
CENTRED = {"disc": {"kind": "disc", "centre": (0, 0), "radius": CORE}, "half disc": {"kind": "disc", "centre": (0, 0), "radius": CORE},
           "box": {"kind": "half-space", "point": (0, 0, 0), "normal": (-1, 0, 0)}}  # fmt: skip


def disc(model, half=False):
    """A disc of a core and a cover, or its half x >= 0 with the axis, with the groups core, cover and core and cover."""
    occ = model.occ
    discs = [(2, occ.addDisk(0, 0, 0, radius, radius)) for radius in (RADIUS, CORE)]
    if half:
        discs = [occ.intersect([own], [(2, occ.addRectangle(0, -1, 0, 1, 2))])[0][0] for own in discs]
    _, (whole, core) = occ.fragment(discs[:1], discs[1:])
    occ.synchronize()
    cover = [piece for piece in whole if piece not in core]
    outer = {tag for _, tag in model.getBoundary(whole, oriented=False)}
    axis = {tag for tag in outer if model.occ.getCenterOfMass(1, tag)[0] < 1e-9} if half else set()
    rim = {tag for _, tag in model.getBoundary(core, oriented=False)} - axis
    for name, pieces in {"core": core, "cover": cover, "both": whole}.items():
        model.addPhysicalGroup(2, [tag for _, tag in pieces], name=name)
    for name, tags in {"contact": outer - axis, "symmetry": axis, "rim": rim}.items():
        if tags:
            model.addPhysicalGroup(1, sorted(tags), name=name)


def boxes(model):
    """Two cubes with a common face, core and an unnamed one."""
    tags = [model.occ.addBox(x, 0, 0, 0.05, 0.05, 0.05) for x in (0, 0.05)]
    model.occ.fragment([(3, tags[0])], [(3, tags[1])])
    model.occ.synchronize()
    model.addPhysicalGroup(3, [1], name="core")
    model.addPhysicalGroup(3, [2], 7)


def write_step(path, second=0.05, names=("core", "cover")):
    """A STEP file of two cubes with these names [m], which both have the faces between them."""
    with mesh.gmsh_session() as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")
        for x in (0, second):
            gmsh.model.occ.addBox(x, 0, 0, 0.05, 0.05, 0.05)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    text = path.read_text()
    for number, name in enumerate(names, 1):
        text, count = re.subn(rf"'[^']* [0-9]+\.{number}'", f"'{name}'", text)
        assert count
    path.write_text(text)
    return path


FILES = {"disc": ("plane-strain", disc), "half disc": ("axisymmetric", lambda model: disc(model, True)), "box": ("3d", boxes)}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    made = {name: (kind, write_mesh(folder / f"{name.replace(' ', '-')}.msh", draw, 0.012)) for name, (kind, draw) in FILES.items()}
    return made | {"step": ("3d", write_step(folder / "two.step"))}


def assembled(file, *layers) -> assembly.Assembly:
    kind, path = file
    axes = 3 if kind == "3d" else 2
    body = ff.Mesh(file=str(path), position=(0, 1, 0)[:axes], velocity=(0, -1, 0)[:axes], layers=[ff.Layer(**layer) for layer in layers], **RUBBER)
    return assembly.assemble(ff.Scene(bodies=[body], obstacles=[ff.Plane()], dimension=kind, accuracy=0.1).ready())


@pytest.mark.parametrize("name", CENTRED)
def test_a_group_is_the_region_that_its_cells_fill(files, name):
    """All that FreeFEM takes is the same, byte for byte, with the interface of the disc on its circle."""
    by_group = assembled(files[name], {"group": "core"} | SOFT)
    assert by_group.data == assembled(files[name], {"where": CENTRED[name]} | SOFT).data != assembled(files[name]).data
    between = by_group.mesh.labels == INTERFACE
    assert between.any() and (by_group.arrays["mesh.arc_of"][between] >= 0).all() == (name != "box")


def test_groups_win_over_regions_and_both_may_stand_together(files):
    everywhere = {"where": {"kind": "disc", "centre": (0, 0), "radius": 1.0}}
    built = assembled(files["disc"], everywhere, {"group": "core"})
    assert np.unique(built.arrays["mesh.materials"]).tolist() == [1, 2]


def test_solids_of_a_step_file_share_faces_and_are_groups(files):
    """The volumes are those of the cubes; a wave goes from one to the other through one common square."""
    built = assembled(files["step"], {"group": "cover"} | SOFT)
    assert np.bincount(built.arrays["mesh.materials"], built.mesh.volumes) == pytest.approx([0.05**3] * 2, rel=1e-9)
    a, b, c = built.mesh.points[built.mesh.faces[built.mesh.labels == INTERFACE]].transpose(1, 0, 2)
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(0.05**2, rel=1e-9)


def test_regions_of_freefem_are_groups_by_number(tmp_path):
    """Two triangles in a square; FreeFEM lists the side between them among the boundary edges."""
    text = "4 2 5\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n1 2 3 4\n1 3 4 9\n1 2 1\n2 3 1\n3 4 1\n4 1 1\n1 3 5\n"
    (tmp_path / "square.msh").write_text(text)
    built = assembled(("plane-strain", tmp_path / "square.msh"), {"group": "9"} | SOFT)
    assert built.arrays["mesh.materials"].tolist() == [0, 1] and (built.mesh.labels == INTERFACE).sum() == 1


@pytest.mark.parametrize("file, layers, words", [
    ("disc", ["kore"], ["layer.1.group: 'kore' is not known", "did you mean core?", "(accepted: core, cover, both)"]),
    ("disc", ["rim"], ["layer.1.group: 'rim' is a group of lines, not of triangles", "(accepted: core, cover, both)"]),
    ("disc", ["core", "both"], ["layer.2.group: 'both' has", "triangles of 'core', which is another layer's"]),
    ("box", ["8"], ["layer.1.group: '8' is not known", "(accepted: core, 7)"]),
    ("step", ["core", "core"], ["layer.2.group: 'core' has", "tetrahedra of 'core'"]),
])  # fmt: skip
def test_what_is_no_group_is_refused_in_one_line(files, file, layers, words):
    with pytest.raises(BadInput) as caught:
        assembled(files[file], *({"group": group} for group in layers))
    lines = str(caught.value).splitlines()
    assert len(lines) == 1 and all(word in lines[0] for word in ("body.1.", *words)), lines


def test_physical_curves_are_parts_of_the_boundary(files):
    """A load on the group `contact` acts on all of the boundary; `rim` is inside, and no part of it."""
    kind, path = files["disc"]
    loads = [[ff.Load(where=name, pressure="1e3")] for name in ("contact", "all", "rim")]
    bodies = [ff.Mesh(file=str(path), position=(0, 1), load=load, **RUBBER) for load in loads]
    scenes = [ff.Scene(bodies=[body], end_time=1e-3, dimension=kind).ready() for body in bodies]
    named, every = (assembly.assemble(scene).arrays["loads.elements"] for scene in scenes[:2])
    assert np.array_equal(named, every) and len(every) > 20
    with pytest.raises(BadInput, match="no side or group 'rim' .*contact"):
        assembly.assemble(scenes[2])


def test_solids_of_a_step_file_that_overlap(tmp_path):
    """They share a piece: a layer of both is refused, one of either is not."""
    path = write_step(tmp_path / "two.step", second=0.04)
    assert len(np.unique(assembled(("3d", path), {"group": "core"}).arrays["mesh.materials"])) == 2
    with pytest.raises(BadInput, match="layer.2.group: 'cover' has [0-9]+ tetrahedra of 'core'"):
        assembled(("3d", path), {"group": "core"}, {"group": "cover"})


@pytest.mark.parametrize("layer, words", [
    ({"group": "core"}, "body.1.layer.1.group: 'core', but 'body1' has no file"),
    ({"group": "core", "radius": 0.01}, "body.1.layer.1.group: stands beside radius"),
    ({"group": 7}, "body.1.layer.1.group: '7' is no text"),
])  # fmt: skip
def test_a_shape_has_no_groups(layer, words):
    body = {"shape": "disc", "radius": RADIUS, "position": [0, 0.06], "velocity": [0, -1], "layer": [layer]} | RUBBER
    with pytest.raises(BadInput, match=words):
        ff.Scene.read({"body": [body], "obstacle": [{"kind": "plane"}]}).ready()


def test_estimates_for_a_body_take_the_cells_of_its_mesh(files):
    """The softest material on the surface, and the mean density: of revolution by volume."""
    kind, path = files["half disc"]
    layers = [ff.Layer(group="core", **SOFT)]
    body = ff.Mesh(file=str(path), position=(0, 0.06), velocity=(0, -1), layers=layers, **RUBBER)
    read = ff.Scene(bodies=[body], obstacles=[ff.Plane()], dimension=kind).ready().bodies[0]
    share = (CORE / RADIUS) ** 3
    assert read.mean_density == pytest.approx(1000 * share + 1722 * (1 - share), rel=0.02) and read.touching.young == 7e6
