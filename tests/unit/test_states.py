"""Kept states as arrays, and the motion of a material point through them."""

import meshio
import numpy as np
import pytest

from ffimpact.failure import BadInput, Unreadable
from ffimpact.output.states import Fields

CENTRE = np.array([0.3, -0.2])


def disc(radius: float = 0.1, around: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) and quadratic triangles of a fan about CENTRE, with curved outer sides."""
    angles = 2 * np.pi * np.arange(2 * around) / (2 * around)
    rim = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    inner = rim[::2] / 2
    points = np.concatenate([[[0.0, 0.0]], rim, inner]) + CENTRE
    k = np.arange(around)
    corner, middle, following = 1 + 2 * k, 2 + 2 * k, 1 + 2 * ((k + 1) % around)
    half = 1 + 2 * around
    cells = np.stack([0 * k, corner, following, half + k, middle, half + (k + 1) % around], axis=1)
    return np.pad(points, [(0, 0), (0, 1)]), cells


def write(folder, points, cells, moves, kind="triangle6") -> None:
    """States 0, 1, 2 with the displacements moves(points, t)."""
    (folder / "fields").mkdir()
    n = len(points)
    for t in range(3):
        values = {"displacement": moves(points, t), "velocity": np.ones((n, 3)), "jacobian": np.ones(n), "von_mises": 1e6 * points[:, 0],
                  "pressure": np.zeros(n), "energy_density": np.zeros(n), "cauchy_stress": np.zeros((n, 6))}
        meshio.vtu.write(folder / f"fields/{t:04d}.vtu", meshio.Mesh(points, [(kind, cells)], values, {"body": [np.ones(len(cells), np.int32)]}),
                         compression=None)
    sets = "".join(f'<DataSet timestep="{t}" file="fields/{t:04d}.vtu"/>' for t in range(3))
    (folder / "fields.pvd").write_text(f"<VTKFile><Collection>{sets}</Collection></VTKFile>")


def turned(points: np.ndarray, t: float) -> np.ndarray:
    """Displacements of a stretch by 1 + t / 10 along x, a turn by t, and a move by (0, t)."""
    stretched = (points[:, :2] - CENTRE) * [1 + t / 10, 1]
    turn = np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])
    return np.pad(stretched @ turn.T + [0, t] - points[:, :2], [(0, 0), (0, 1)])


@pytest.mark.parametrize("point", [(0.0, 0.0), (0.05, 0.02), (-0.1, 0.0), (0.03, -0.09)])
def test_a_point_moves_with_the_body(tmp_path, point):
    """A motion that is linear in the place is followed exactly, by the point of the disc's rim too;
    points are given from the centre of mass on."""
    write(tmp_path, *disc(), turned)
    states = Fields(tmp_path, False, ())
    table = states.probe(point)
    at = np.array([[*(CENTRE + point), 0.0]])
    exact = [(at + turned(at, t))[0, :2] for t in range(3)]
    assert table[["x", "y"]].to_numpy() == pytest.approx(np.array(exact), abs=1e-12)
    assert table.von_mises.to_numpy() == pytest.approx(1e6 * at[0, 0]) and list(table.t) == [0, 1, 2]
    assert "velocity_z" not in table and table.attrs["units"]["cauchy_stress_xy"] == "Pa" and set(table.attrs["units"]) == set(table)


def test_a_tetrahedron(tmp_path):
    """In space: a curved tetrahedron keeps its own nodes in place; a point has three coordinates."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    sides = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    points = np.concatenate([corners, [(corners[i] + corners[j]) / 2 for i, j in sides]])
    write(tmp_path, points, np.arange(10)[None], lambda points, t: t * points**2, "tetra10")
    table = Fields(tmp_path, False, ()).probe((-0.05, 0.05, 0.15))
    at = np.array([0.2, 0.3, 0.4])
    assert table[["x", "y", "z"]].to_numpy()[2] == pytest.approx(at + 2 * at**2, abs=1e-12)


def test_a_section_of_a_body_of_revolution(tmp_path):
    """Heights count from the centre of mass of the body: of a cone it is a quarter up; radii from
    the axis."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    points = np.concatenate([corners, [(corners[i] + corners[j]) / 2 for i, j in [(0, 1), (1, 2), (0, 2)]]])
    write(tmp_path, points, np.arange(6)[None], lambda points, t: 0 * points)
    table = Fields(tmp_path, True, ()).probe((0.3, 0.05))
    assert table[["x", "y"]].to_numpy()[0] == pytest.approx([0.3, 0.3])


def test_half_a_body(tmp_path):
    """Where half of a body is computed, its centre of mass is on the plane of symmetry."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    points = np.concatenate([corners, [(corners[i] + corners[j]) / 2 for i, j in [(0, 1), (1, 2), (0, 2)]]])
    write(tmp_path, points, np.arange(6)[None], lambda points, t: 0 * points)
    table = Fields(tmp_path, False, ("x",)).probe((0.3, 0.0))
    assert table[["x", "y"]].to_numpy()[0] == pytest.approx([0.3, 1 / 3])


@pytest.mark.parametrize("point, body, words", [
    ((0.2, 0.0), 1, "outside body 1"),
    ((0.1,), 1, "2 coordinates"),
    ((float("nan"), 0), 1, "2 coordinates"),
    ((0.0, 0.0), 2, "'2' is no body (accepted: 1 to 1)"),
])
def test_wrong_points_are_refused(tmp_path, point, body, words):
    write(tmp_path, *disc(), turned)
    with pytest.raises(BadInput) as refusal:
        Fields(tmp_path, False, ()).probe(point, body)
    assert words in str(refusal.value) and str(refusal.value).startswith("probe: ")


def test_a_state_is_arrays(tmp_path):
    """Fields by attribute and by name, positions, the mesh of meshio; slices; a wrong name; no states."""
    points, cells = disc()
    write(tmp_path, points, cells, turned)
    states = Fields(tmp_path, False, ())
    last = states[-1]
    assert last.time == 2 and last.points.shape == (len(points), 3) and (last.cells == cells).all() and set(last.body) == {1}
    assert (last["von_mises"] == last.von_mises).all() and last.cauchy_stress.shape == (len(points), 6)
    assert last.positions == pytest.approx(points + turned(points, 2)) and len(states[1:]) == 2
    mesh = last.to_meshio()
    assert mesh.cells[0].type == "triangle6" and (mesh.point_data["displacement"] == last.displacement).all()
    with pytest.raises(BadInput, match="von_mises"):
        last["mises"]
    with pytest.raises(Unreadable, match="fields = 20"):
        Fields(tmp_path / "none", False, ())[0]
