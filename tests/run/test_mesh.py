"""The meshes of the scenes."""

import numpy as np
import pytest

from ffimpact.freefem import freefem
from ffimpact.mesh import mesh
from tests.support.direct import used
from tests.support.triangles import areas, smallest_angle

CASES = [
    pytest.param((0.05, 0.05 / 8, 0.05 / 25, True), id="half, default size"),
    pytest.param((0.05, 0.05 / 8, 0.05 / 25, False), id="full, default size"),
    pytest.param((0.05, 0.02, 0.01, True), id="half, very coarse"),
    pytest.param((0.05, 0.004, 0.0002, True), id="half, 0.2 mm at the contact"),
    pytest.param((0.05, 0.003, 0.003, False), id="full, uniform"),
    pytest.param((0.5, 0.06, 0.0006, False), id="full, size ratio 100"),
]


@pytest.fixture(scope="module", params=CASES)
def case(request):
    return *request.param, mesh.disc(*request.param)


def test_triangles_are_sound(case):
    """Every triangle is counter-clockwise and has no angle below 20 degrees."""
    *_, m = case
    assert areas(m).min() > 0
    assert smallest_angle(m) > 20


def test_triangles_fill_the_polygon(case):
    """The triangles add up to the polygon of the labelled boundary edges, and nothing is used
    twice."""
    *_, m = case
    a, b = m.points[m.edges[:, 0]], m.points[m.edges[:, 1]]
    enclosed = abs((a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]).sum())
    assert areas(m).sum() == pytest.approx(enclosed / 2, rel=1e-12)
    assert set(m.triangles.flat) == set(range(len(m.points)))


def test_every_boundary_edge_has_its_label(case):
    """The edges of only one triangle are exactly the labelled ones: 1 on the circle, 2 on the axis
    x = 0."""
    radius, _, _, half, m = case
    sides = np.sort(np.vstack([m.triangles[:, [0, 1]], m.triangles[:, [1, 2]], m.triangles[:, [2, 0]]]), axis=1)
    unique, count = np.unique(sides, axis=0, return_counts=True)
    assert set(map(tuple, unique[count == 1])) == set(map(tuple, np.sort(m.edges, axis=1)))
    assert count.max() == 2
    distance = np.hypot(m.points[:, 0], m.points[:, 1] - radius)
    assert abs(distance[m.edges[m.labels == mesh.FREE]] - radius).max() < 1e-12
    assert set(m.labels) == ({mesh.FREE, mesh.AXIS} if half else {mesh.FREE})
    if half:
        assert (m.points[m.edges[m.labels == mesh.AXIS], 0] == 0).all()
        assert m.points[:, 0].min() == 0


def test_sizes_are_as_asked(case):
    """Edges near the lowest point have the contact size, edges at the top the bulk size, to 40 per
    cent."""
    radius, bulk, contact, _, m = case
    ends = m.points[m.edges[m.labels == mesh.FREE]]
    length, height = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), ends[:, :, 1].mean(1)
    assert length[height < 0.2 * radius].mean() == pytest.approx(contact, rel=0.4)
    assert length[height > 1.8 * radius].mean() == pytest.approx(bulk, rel=0.4)
    assert np.hypot(*m.points.T).min() == 0  # the lowest point is a vertex, on the plane


def test_freefem_reads_it(tmp_path):
    """FreeFEM finds the same area, and the same length of each labelled boundary."""
    m = mesh.disc(0.05, 0.01, 0.004, True)
    mesh.write(m, tmp_path / "m.msh")
    (tmp_path / "read.edp").write_text(
        f'mesh Th = readmesh("{tmp_path}/m.msh"); cout.precision(15);\n'
        'cout << Th.area << " " << int1d(Th, 1)(1.) << " " << int1d(Th, 2)(1.) << " " << Th.nv << endl;\n')
    answer = freefem.find().call(tmp_path / "read.edp", check=True).stdout
    length = np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1)
    expected = [areas(m).sum(), length[m.labels == 1].sum(), length[m.labels == 2].sum(), len(m.points)]
    assert list(map(float, answer.split())) == pytest.approx(expected, rel=1e-12)
    assert length[m.labels == 2].sum() == pytest.approx(0.1, rel=1e-12)


def sizes(**values) -> tuple[float, float]:
    entries = used(values)
    return entries["mesh_size"], entries["contact_mesh_size"]


def test_sizes_follow_the_accuracy():
    """A size of 0 follows from the accuracy. A prescribed size is kept, and the other one follows
    from it."""
    bulk, contact = sizes(accuracy=1e-2)
    finer_bulk, finer_contact = sizes(accuracy=1e-3)
    assert finer_bulk < bulk and finer_contact < contact < bulk
    assert sizes(mesh_size=1e-3) == (1e-3, 1e-3)
    assert sizes(contact_mesh_size=1e-2)[1] == 1e-2 and sizes(contact_mesh_size=4e-2) == (4e-2, 4e-2)


def test_gmsh_starts_again_where_a_script_has_ended_it():
    """A script that uses gmsh itself may call finalize() between two runs."""
    gmsh = mesh.start_gmsh()
    gmsh.finalize()
    assert mesh.start_gmsh().isInitialized()
    assert len(mesh.disc(0.05, 0.02, 0.01, True).points)
