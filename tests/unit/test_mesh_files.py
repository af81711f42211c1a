"""Meshes, geometries and surfaces from files, read in this process: in runs gmsh has its own."""

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.mesh import gmsh_file, mesh, solid_file, surface_file
from ffimpact.mesh.mesh import AXIS, FREE, Sizes
from tests.support.files import write_mesh, write_step
from tests.support.surfaces import slab, sphere, stl

BOX = np.array([0.1, 0.06, 0.04])


@pytest.fixture(autouse=True)
def here(monkeypatch):
    """Reads files in this process."""
    for module in (mesh, solid_file, surface_file):
        monkeypatch.setattr(module, "in_own_process", lambda read, path, *given: read(path, *given))


def rectangle(**curves):
    """Draws a rectangle of 0.1 x 0.06 m with physical curves by name."""
    def draw(model):
        model.occ.addRectangle(0, 0, 0, 0.1, 0.06)
        model.occ.synchronize()
        model.addPhysicalGroup(2, [1], name="body")
        for name, numbers in curves.items():
            model.addPhysicalGroup(1, numbers, name=name)
    return draw


def box(**surfaces):
    def draw(model):
        model.occ.addBox(0, 0, 0, *BOX)
        model.occ.synchronize()
        model.addPhysicalGroup(3, [1], name="body")
        for name, numbers in surfaces.items():
            model.addPhysicalGroup(2, numbers, name=name)
    return draw


def on(points: np.ndarray, sides: np.ndarray, axis: int, place: float) -> np.ndarray:
    """Whether all corners of sides are at a place along an axis."""
    return (abs(points[sides][..., axis] - place) < 1e-9).all(axis=1)


# ---- in the plane

@pytest.mark.parametrize("version", [2.2, 4.1])
def test_curves_of_a_plane_mesh_have_their_labels(tmp_path, version):
    """`contact` and `symmetry` by name, other curves never touch. Triangles are counter-clockwise."""
    made = gmsh_file.load(write_mesh(tmp_path / "part.msh", rectangle(contact=[1], symmetry=[4], top=[3]), 0.02, version))
    corners = made.points[made.triangles]
    areas = np.linalg.det(np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)) / 2
    assert (areas > 0).all() and areas.sum() == pytest.approx(0.006)
    assert np.array_equal(made.labels == FREE, on(made.points, made.edges, 1, 0))
    assert np.array_equal(made.labels == AXIS, on(made.points, made.edges, 0, 0))


def test_all_of_a_plane_mesh_without_names_may_touch(tmp_path):
    """The whole boundary has the label of contact, 0.32 m long."""
    made = gmsh_file.load(write_mesh(tmp_path / "part.msh", rectangle(), 0.02))
    lengths = np.linalg.norm(np.diff(made.points[made.edges], axis=1)[:, 0], axis=1)
    assert (made.labels == FREE).all() and lengths.sum() == pytest.approx(0.32)


@pytest.mark.parametrize("draw, message", [
    (rectangle(top=[3]), r"none of its physical curves \(top\) has the name 'contact'"),
    (rectangle(contact=[1], symmetry=[1, 4]), "both as contact and as symmetry"), (box(), "it has elements 'Tetrahedron 4'")])
def test_what_a_plane_mesh_must_not_be(tmp_path, draw, message):
    """No contact boundary, a curve with two meanings, a solid."""
    with pytest.raises(BadInput, match=message):
        gmsh_file.load(write_mesh(tmp_path / "part.msh", draw, 0.02))


# ---- in space

@pytest.mark.parametrize("surfaces, at", [({}, None), ({"contact": [3], "clamp": [4]}, 0.0)])
def test_surfaces_of_a_solid_mesh_have_their_labels(tmp_path, surfaces, at):
    """All faces may touch, or those of the surface `contact`."""
    made = solid_file.read(write_mesh(tmp_path / "part.msh", box(**surfaces), 0.02))
    assert made.volumes.sum() == pytest.approx(BOX.prod())
    expected = np.ones(len(made.faces), bool) if at is None else on(made.points, made.faces, 1, at)
    assert np.array_equal(made.labels == FREE, expected) and expected.any()


def test_a_geometry_is_meshed_by_sizes_in_metres(tmp_path):
    """A STEP file in mm, with smaller elements near a point."""
    write_step(tmp_path / "box.step")
    coarse = solid_file.read(tmp_path / "box.step")
    assert np.ptp(coarse.points, axis=0) == pytest.approx(BOX) and coarse.volumes.sum() == pytest.approx(BOX.prod())
    near = np.array([0.05, 0, 0.02])
    fine = solid_file.meshed(tmp_path / "box.step", Sizes(0.02, 0.005, near[None], 0.005))
    away = np.linalg.norm(fine.points[fine.cells].mean(axis=1) - near, axis=1)
    assert np.median(fine.volumes[away < 0.01]) < 0.1 * np.median(fine.volumes[away > 0.04])


def test_elements_at_a_rounding_follow_from_what_they_cut_off(tmp_path):
    """Flat elements at the fillets of a box cut off no more than the share that is asked for, and
    less if less is asked for."""
    radius, shares = 8.0, (0.1, 0.01)
    write_step(tmp_path / "box.step", radius)
    a, b, c = 1e3 * BOX - 2 * radius
    exact = 1e-9 * (a * b * c + 2 * radius * (a * b + b * c + c * a) + np.pi * radius**2 * (a + b + c) + 4 / 3 * np.pi * radius**3)
    sizes = Sizes(0.03, 0.03, np.empty((0, 3)), 0.0)
    cut = [1 - solid_file.meshed(tmp_path / "box.step", sizes, share).volumes.sum() / exact for share in shares]
    assert all(0 < found < share for found, share in zip(cut, shares)) and cut[1] < 0.5 * cut[0]


@pytest.mark.parametrize("text, message", [
    ("no mesh", r"does not begin with \$MeshFormat"), ("$MeshFormat\n4.1 0 8\n", "it has no tetrahedra")])
def test_a_solid_that_cannot_be_read_is_named(tmp_path, text, message):
    (tmp_path / "part.msh").write_text(text)
    with pytest.raises(BadInput, match=f"^'part.msh': .*{message}"):
        solid_file.read(tmp_path / "part.msh")


@pytest.mark.parametrize("surfaces, message", [({"top": [4]}, r"none of its physical surfaces \(top\) has the name 'contact'")])
def test_a_solid_without_contact_is_refused(tmp_path, surfaces, message):
    with pytest.raises(BadInput, match=message):
        solid_file.read(write_mesh(tmp_path / "part.msh", box(**surfaces), 0.03))


# ---- surfaces of obstacles

def test_a_surface_is_closed_and_seen_from_outside(tmp_path):
    """Vertices of an STL file are merged: Euler's number is 2. Triangles that are all turned inwards
    are turned outwards; the volume is that of the sphere, from below."""
    points, triangles = surface_file.read(sphere(tmp_path / "ball.stl", 0.05, 3))
    assert len(points) - len(triangles) * 3 // 2 + len(triangles) == 2
    a, b, c = points[triangles].transpose(1, 0, 2)
    assert (a * np.cross(b, c)).sum() / 6 == pytest.approx(4 / 3 * np.pi * 0.05**3, rel=0.05)
    inwards = surface_file.read(stl(tmp_path / "inwards.stl", points, triangles[:, ::-1]))
    a, b, c = inwards[0][inwards[1]].transpose(1, 0, 2)
    assert (a * np.cross(b, c)).sum() > 0


def test_the_surface_of_a_solid_mesh_is_one(tmp_path):
    """The boundary of the tetrahedra of a box."""
    points, triangles = surface_file.read(write_mesh(tmp_path / "part.msh", box(), 0.02))
    a, b, c = points[triangles].transpose(1, 0, 2)
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == pytest.approx(2 * (0.006 + 0.004 + 0.0024))


def test_a_surface_with_a_fault_is_named(tmp_path):
    """A hole, a triangle that is turned, a triangle without area, another kind of file, none."""
    points, triangles = surface_file.read(slab(tmp_path / "slab.stl"))
    turned = triangles.copy()
    turned[0] = turned[0, ::-1]
    for name, given, message in (("hole", triangles[1:], "3 edges do not belong to two triangles"), ("turned", turned, "not all turned alike"),
                                 ("point", np.zeros((1, 3), int), "no triangles")):
        with pytest.raises(BadInput, match=f"^'{name}.stl': .*{message}"):
            surface_file.read(stl(tmp_path / f"{name}.stl", points, given))
    for name in ("part.obj", "absent.stl"):
        with pytest.raises(BadInput, match=f"'{name}'"):
            surface_file.read(tmp_path / name)
