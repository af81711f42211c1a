"""Meshes of the user: reports of errors in a file; bodies of any outline; gmsh files."""

import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.mesh import gmsh_file, mesh, plane_file, solid_file
from ffimpact.running import run
from tests.support.foreign_meshes import DENSITY, NEAR, RADIUS, SIZE, agree, falling, go, shaped
from tests.support.triangles import areas
from verification.measure import impact

# ---- wrong files

# A square of 0.1 m with 2 x 2 squares of two triangles each; vertex 5 is its middle.
POINTS = [f"{x} {y} 0" for y in (0, 0.05, 0.1) for x in (0, 0.05, 0.1)]
TRIANGLES = [f"{a} {b} {c} 0" for k in (1, 2, 4, 5) for a, b, c in ((k, k + 1, k + 4), (k, k + 4, k + 3))]
EDGES = [f"{a} {b} 1" for a, b in ((1, 2), (2, 3), (3, 6), (6, 9), (9, 8), (8, 7), (7, 4), (4, 1))]


def square(points=POINTS, triangles=TRIANGLES, edges=EDGES, counts=None) -> str:
    return "\n".join([counts or f"{len(points)} {len(triangles)} {len(edges)}", *points, *triangles, *edges]) + "\n"


def changed(lines: list[str], number: int, text: str) -> list[str]:
    """The lines with line `number`, counted from 1, replaced."""
    return [text if k == number else line for k, line in enumerate(lines, 1)]


def another(shift: tuple[float, float], number) -> tuple[list[str], list[str], list[str]]:
    """Points, triangles and edges of a second square, moved. number(k) is the number of its vertex
    k in the file."""
    def renumbered(lines: list[str]) -> list[str]:
        return [" ".join([*(str(number(int(word))) for word in line.split()[:-1]), line.split()[-1]]) for line in lines]
    return [f"{float(x) + shift[0]} {float(y) + shift[1]} 0" for x, y, _ in map(str.split, POINTS)], renumbered(TRIANGLES), renumbered(EDGES)


APART = another((0.3, 0), lambda k: k + 9)
# Its first vertex is vertex 9 of the first square.
BY_A_POINT = another((0.1, 0.1), lambda k: k + 8)
BAD = {
    "empty": ("", "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "words": ("hello world\n", "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "medit": ("MeshVersionFormatted 2\nDimension 2\n", "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "bytes": ("\x00\x01\x02", "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "two counts": ("9 8", "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "count 1e1": (square(counts="1e1 8 8"), "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"),
    "no vertices": (square(counts="0 8 8"), "0 vertices (accepted: 3 to 2000000)"),
    "negative vertices": (square(counts="-9 8 8"), "-9 vertices (accepted"),
    "absurd vertices": (square(counts="999999999999 8 8"), "999999999999 vertices (accepted"),
    "vertices beyond any integer": (square(counts="99999999999999999999 8 8"), "99999999999999999999 vertices (accepted"),
    "no triangles": (square(triangles=[]), "0 triangles (accepted: 1 to 2000000)"),
    "negative triangles": (square(counts="9 -8 8"), "-8 triangles"),
    "no boundary": (square(edges=[]), "0 boundary edges (accepted: 3 to 2000000)"),
    "negative edges": (square(counts="9 8 -8"), "-8 boundary edges"),
    "too short": (square()[:-30], "ends at boundary edge 4 of 8"),
    "too few vertices": (square(counts="90 8 8"), "ends at vertex 28 of 90"),
    "label missing": (square()[:-3], "ends at boundary edge 8 of 8"),
    "cut in its last number": (square(edges=changed(EDGES, 8, "4 1 12"))[:-2], "ends at boundary edge 8 (accepted: a line end behind its label)"),
    "garbage behind": (square() + "\n 7 8 9\n", "'7' follows behind the last boundary edge"),
    "garbage in the last line": (square()[:-1] + "x\n", "boundary edge 8 is not v1 v2 label in numbers"),
    "broken last label": (square()[:-1] + ".5\n", "boundary edge 8 is not v1 v2 label in numbers"),
    "nan": (square(points=changed(POINTS, 5, "0.05 nan 0")), "vertex 5 is not x y label in numbers"),
    "inf": (square(points=changed(POINTS, 5, "inf 0.05 0")), "vertex 5 is not x y label in numbers"),
    "beyond any number": (square(points=changed(POINTS, 5, "1e400 0.05 0")), "vertex 5 is not x y label in numbers"),
    "decimal comma": (square(points=changed(POINTS, 5, "0,05 0.05 0")), "vertex 5 is not x y label in numbers"),
    "letters": (square(triangles=changed(TRIANGLES, 3, "2 3 b 0")), "triangle 3 is not v1 v2 v3 region in numbers"),
    "broken index": (square(triangles=changed(TRIANGLES, 3, "2 3.5 6 0")), "triangle 3 is not v1 v2 v3 region in numbers"),
    "broken edge": (square(edges=changed(EDGES, 3, "3 x 1")), "boundary edge 3 is not v1 v2 label in numbers"),
    "three coordinates": (square(points=[f"{p} 0" for p in POINTS]), "vertex 3 is not x y label in numbers"),
    "index 0": (square(triangles=changed(TRIANGLES, 3, "2 0 6 0")), "triangle 3 (vertices 2, 0, 6) names a vertex that is not there (accepted: 1 to 9)"),
    "negative index": (square(triangles=changed(TRIANGLES, 3, "2 -3 6 0")), "triangle 3 (vertices 2, -3, 6) names a vertex that is not there"),
    "index 10": (square(triangles=changed(TRIANGLES, 3, "2 10 6 0")), "triangle 3 (vertices 2, 10, 6) names a vertex that is not there"),
    "edge index 10": (square(edges=changed(EDGES, 3, "3 10 1")), "boundary edge 3 (vertices 3, 10) names a vertex that is not there"),
    "negative label": (square(edges=changed(EDGES, 3, "3 6 -1")), "boundary edge 3 has the label -1 (accepted: from 0)"),
    "clockwise": (square(triangles=changed(TRIANGLES, 3, "2 6 3 0")), "triangle 3 (vertices 2, 6, 3) is clockwise"),
    "all clockwise": (square(triangles=[" ".join((b, a, c, r)) for a, b, c, r in map(str.split, TRIANGLES)]), "triangle 1 (vertices 2, 1, 5) is clockwise"),
    "inverted": (square(points=changed(POINTS, 5, "0.2 0.05 0")), "is clockwise"),
    "flat": (square(points=changed(POINTS, 5, "0.025 0.025 0"), triangles=changed(TRIANGLES, 3, "2 3 5 0")), "the side (vertices 2, 5) belongs to 3 triangles"),
    "one vertex twice": (square(triangles=changed(TRIANGLES, 3, "2 6 6 0")), "triangle 3 (vertices 2, 6, 6) is degenerate"),
    "on a line": (square(triangles=changed(TRIANGLES, 3, "1 2 3 0")), "triangle 3 (vertices 1, 2, 3) is degenerate"),
    "far": (square(points=changed(POINTS, 9, "1e300 0.1 0")), "vertex 9 at (1e+300, 0.1) (accepted: coordinates of at most 1e+09 m)"),
    "needle": (square(points=changed(POINTS, 9, "4e4 0.1 0")), "is degenerate: its height is below 1e-06 of its longest side"),
    "same place": (square(points=[*POINTS, "0.05 0.05 0"], triangles=changed(TRIANGLES, 1, "1 2 10 0")), "vertices 5 and 10 at (0.05, 0.05) are at the same place"),
    "nearly the same place": (square(points=[*POINTS, "0.05 0.0500000000001 0"], triangles=changed(TRIANGLES, 1, "1 2 10 0")), "vertices 5 and 10 at (0.05, 0.05) are at the same place"),
    "unused": (square(points=[*POINTS, "0.03 0.01 0"]), "vertex 10 at (0.03, 0.01) belongs to no triangle"),
    "triangle twice": (square(triangles=[*TRIANGLES, TRIANGLES[2]]), "triangle 3 (vertices 2, 3, 6) and triangle 9 (vertices 2, 3, 6) are the same"),
    "overlap": (square(points=[*POINTS, "0.02 0.04 0"], triangles=[*TRIANGLES, "1 2 10 0"]), "triangle 1 (vertices 1, 2, 5) and triangle 9 (vertices 1, 2, 10) overlap"),
    "three at a side": (square(points=[*POINTS, "0.04 0.08 0"], triangles=[*TRIANGLES, "2 5 10 0"]), "the side (vertices 2, 5) belongs to 3 triangles"),
    "edge missing": (square(edges=EDGES[:-1]), "the side (vertices 4, 1) of triangle 2 (vertices 1, 5, 4) is on the boundary but not among the boundary edges"),
    "edge twice": (square(edges=[*EDGES, "2 1 1"]), "boundary edge 1 (vertices 1, 2) is listed twice"),
    "edge inside": (square(edges=[*EDGES, "1 5 1"]), "boundary edge 9 (vertices 1, 5) lies inside the body"),
    "edge nowhere": (square(edges=[*EDGES, "1 9 1"]), "boundary edge 9 (vertices 1, 9) is no side of a triangle"),
    "edge of no length": (square(edges=[*EDGES, "1 1 1"]), "boundary edge 9 (vertices 1, 1) is no side of a triangle"),
    "hole unlisted": (square(triangles=TRIANGLES[:3] + TRIANGLES[4:]), "on the boundary but not among the boundary edges"),
    "two bodies": (square(POINTS + APART[0], TRIANGLES + APART[1], EDGES + APART[2]), "2 bodies that are apart (accepted: one piece)"),
    "by a point": (square(POINTS + BY_A_POINT[0][1:], TRIANGLES + BY_A_POINT[1], EDGES + BY_A_POINT[2]), "vertex 9 at (0.1, 0.1) has 4 boundary edges: the body hangs together by a point"),
    "nothing may touch": (square(edges=[edge[:-1] + "7" for edge in EDGES]), "no boundary edge has the label 1 of the contact boundary, but labels from 7 to 7"),
    "slanted axis": (square(edges=changed(EDGES, 1, "1 2 2")), "boundary edge 1 (vertices 1, 2) has the label 2 of the symmetry axis but does not lie on the vertical line x = 0"),
    "right of the body": (square(edges=[e[:-1] + "2" if e[:3] in ("3 6", "6 9") else e for e in EDGES]), "its axis is x = 0.1 (accepted: half a meridian plane, to the right of its axis x = 0)"),
    "half an axis": (square(edges=changed(EDGES, 7, "7 4 2")), "boundary edge 8 (vertices 4, 1) lies on the symmetry axis, the vertical line x = 0, but has the label 1 (accepted: 2)"),
}


OF_AN_AXIS = ("slanted axis", "right of the body", "half an axis")  # of bodies of revolution


@pytest.mark.few(14)
@pytest.mark.parametrize("name", BAD)
def test_bad_mesh_is_named(tmp_path, name):
    """The error of a mesh and its place are one line."""
    text, words = BAD[name]
    (tmp_path / "m.msh").write_text(text)
    with pytest.raises(BadInput) as error:
        scene.read(impact("ball-axisymmetric" if name in OF_AN_AXIS else "disc", file=tmp_path / "m.msh"), tmp_path, "mesh")
    message = str(error.value)
    assert message.startswith(f"body.1.file: {tmp_path}/m.msh: ") and "\n" not in message and words in message, message


def test_the_square_without_a_fault_is_accepted(tmp_path):
    """The square without errors is a valid mesh: every refusal above is due to its error."""
    for number, text in enumerate([square(), square().replace("\n", "\r\n"), square() + "\n \n"]):
        (tmp_path / f"{number}.msh").write_text(text, newline="")
        assert np.isnan(plane_file.load(tmp_path / f"{number}.msh").arc_centres).all()


def test_large_mesh_is_checked_within_a_second(tmp_path):
    """20,000 triangles are read and checked in less than a second of processor time."""
    n = 101
    number = np.arange(n * n).reshape(n, n)
    low, right, up, far = number[:-1, :-1].ravel(), number[:-1, 1:].ravel(), number[1:, :-1].ravel(), number[1:, 1:].ravel()
    triangles = np.vstack([np.stack([low, right, far], axis=1), np.stack([low, far, up], axis=1)])
    points = np.stack(np.meshgrid(np.linspace(0, 0.1, n), np.linspace(0, 0.1, n)), axis=-1).reshape(-1, 2)
    edges = mesh.boundary(triangles)
    mesh.write(mesh.Mesh(points, triangles, edges, np.ones(len(edges), dtype=int)), tmp_path / "m.msh")
    started = time.process_time()
    made = plane_file.load(tmp_path / "m.msh")
    assert time.process_time() - started < 1 and np.isnan(made.arc_centres).all() and len(made.edges) == 400


def ellipse(occ):
    occ.addDisk(0.3, -0.7, 0, 0.06, 0.04)


def tilted_square(occ):
    occ.addRectangle(-0.04, -0.04, 0, 0.08, 0.08)
    occ.rotate([(2, 1)], 0, 0, 0, 0, 0, 1, 0.5)


def ring(occ):
    occ.addDisk(0.1, 0.1, 0, RADIUS, RADIUS)
    occ.addDisk(0.1, 0.1, 0, 0.02, 0.02)
    occ.cut([(2, 1)], [(2, 2)])


@pytest.mark.few(1)
@pytest.mark.parametrize("draw, size", [(ellipse, math.pi * 0.06 * 0.04), (tilted_square, 0.08**2), (ring, math.pi * (RADIUS**2 - 0.02**2))])
def test_any_outline_falls_and_bounces(tmp_path, draw, size):
    """An ellipse, a rotated square and a ring at any place in the file have the kinetic energy of
    their area.

    Contact begins at once at the lowest point, energy is conserved, and the impulse is the change
    of momentum.
    """
    m = shaped(draw)
    assert areas(m).sum() == pytest.approx(size, rel=0.05)
    result = go(tmp_path / "out", m)
    h, s = result.history, result.summary
    assert (np.isnan(plane_file.load(tmp_path / "out.msh").arc_centres).any(axis=1) == (draw is not ring)).all()
    # Circles are curved, other outlines are as in the mesh.
    exact = size if draw is ring else areas(m).sum()
    assert s["energy_initial"] == pytest.approx(DENSITY * exact * 4**2 / 2, rel=1e-4 if draw is ring else 1e-9)
    assert s["energy_drift"] < 1e-8 and s["rebound_vy"] > 0
    assert s["impulse"] == pytest.approx(h["momentum_y"][-1] - h["momentum_y"][0], rel=1e-9)
    # The first contact point of an edge is at 0.113 of its length from its lower end.
    assert 0 <= s["contact_start"] * 4 < 0.113 * SIZE + 2 * NEAR
    assert "half" not in str(s["skipped"]) and result.scene["symmetry"] == "full"


def fan(angles: np.ndarray, x: float, y: float) -> mesh.Mesh:
    """Corners of a circle at angles [rad], joined with its centre."""
    n = len(angles)
    points = np.vstack([RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1), [[0, 0]]]) + (x, y)
    edges = np.stack([np.arange(n), np.roll(np.arange(n), -1)], axis=1)
    return mesh.Mesh(points, np.hstack([edges, np.full((n, 1), n)]), edges, np.ones(n, dtype=int))


def round_of(sides: int) -> np.ndarray:
    return 2 * math.pi * np.arange(sides) / sides


# Two flats of 75 degrees.
SHAFT = np.array([angle for k, angle in enumerate(round_of(48)) if not 0 < k % 24 < 10])


@pytest.mark.parametrize("angles, place, outline", [
    (round_of(8), (2, 0), "8 straight edges"), (round_of(24), (2, 0), "circle of radius 0.05 about (2, 0)"), (round_of(12), (2, 0), "circle of radius 0.05 about (2, 0)"),
    (round_of(11), (2, 0), "11 straight edges"), (round_of(6), (0, RADIUS), "6 straight edges"),
    (SHAFT, (2, 0), "circle of radius 0.05 about (2, 0), 2 straight edges"), (SHAFT, (0, RADIUS), "circle of radius 0.05 about (0, 0.05), 2 straight edges"),
    (np.array([0, 0.2, 0.4, 0.6, 3, 4]), (2, 0), "6 straight edges")],
    ids=["octagon", "24", "12", "11", "hexagon on the scene's own circle", "shaft", "shaft on the scene's own circle", "three edges"])
def test_edges_up_to_30_degrees_are_a_circle(tmp_path, angles, place, outline):
    """Consecutive edges that lie on a circle and span at most 30 degrees each are arcs. Longer
    ones, also flats among them, stay straight."""
    mesh.write(fan(angles, *place), tmp_path / "m.msh")
    centres = plane_file.load(tmp_path / "m.msh").arc_centres
    straight = np.isnan(centres).any(axis=1)
    assert centres[~straight] == pytest.approx(np.tile(place, (np.count_nonzero(~straight), 1)), abs=1e-12)
    chords = abs(np.diff([*angles, angles[0] + 2 * math.pi]))
    assert straight.tolist() == [chord > math.pi / 6 + 1e-9 or "circle" not in outline for chord in chords]


def test_another_mass_than_the_file_is_a_warning(tmp_path):
    """A disc of 24 sides is 1.2 % heavier than its file, which is a warning; one of 48 sides agrees
    to 0.3 % without a warning."""
    for sides, warns in ((24, True), (48, False)):
        m = fan(round_of(sides), 2, 0)
        result = go(tmp_path / str(sides), m, end_time=1e-4)
        assert result.summary["energy_initial"] == pytest.approx(DENSITY * math.pi * RADIUS**2 * 4**2 / 2, rel=1e-3)
        warned = [warning for warning in result.summary["warnings"]
                  if warning.startswith("mass: ball has 1.2 % more than the mesh in its file")]
        assert len(warned) == warns and ("mass:" in str(result.summary["warnings"])) == warns


@pytest.mark.few(1)
@pytest.mark.parametrize("spin", [60, -200])
def test_body_that_is_not_round_turns_on_its_way_down(tmp_path, spin):
    """An ellipse that falls and rotates lands as one whose flight is integrated in time."""
    m = shaped(ellipse, 0.02)
    values = dict(height=0.02, spin=spin, end_time=0.012)
    flown, marched = go(tmp_path / "flown", m, **values), go(tmp_path / "marched", m, without="flight", **values)
    assert flown.summary["contact_start"] > 2e-3
    assert flown.summary["contact_start"] == pytest.approx(marched.summary["contact_start"], rel=1e-2)
    assert flown.summary["energy_initial"] == pytest.approx(marched.summary["energy_initial"], rel=1e-9)


# ---- gmsh's files

def test_named_curves_without_contact_are_named(tmp_path):
    """A gmsh file whose physical curves have names, but none `contact`, is refused with these
    names."""
    m = fan(round_of(24), 0, 1)
    in_gmsh(tmp_path / "m.msh", replace(m, labels=np.where(np.arange(24) < 5, 2, 3)), 4.1, False, named=True)
    with pytest.raises(BadInput, match=r"none of its physical curves \(rest, Symmetry\) has the name 'contact', or without a name the number 1"):
        gmsh_file.load(tmp_path / "m.msh")


def in_gmsh(path: Path, m: mesh.Mesh, version: float, binary: bool, named: bool = False) -> None:
    """Writes a mesh as gmsh does, with a physical curve for each label of the boundary."""
    with mesh.gmsh_session() as gmsh:
        surface = gmsh.model.addDiscreteEntity(2)
        gmsh.model.mesh.addNodes(2, surface, range(1, len(m.points) + 1), np.column_stack([m.points, np.zeros(len(m.points))]).ravel())
        gmsh.model.mesh.addElementsByType(surface, 2, [], (m.triangles + 1).ravel())
        for label in np.unique(m.labels):
            curve = gmsh.model.addDiscreteEntity(1)
            gmsh.model.mesh.addElementsByType(curve, 1, [], (m.edges[m.labels == label] + 1).ravel())
            number = 10 - int(label) if named else int(label)
            gmsh.model.addPhysicalGroup(1, [curve], number, name={1: "contact", 2: "Symmetry"}.get(int(label), "rest") if named else "")
        gmsh.model.addPhysicalGroup(2, [surface], 1)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(str(path))


def the_same(a: mesh.Mesh, b: mesh.Mesh) -> bool:
    """Whether points agree to gmsh's 16 digits, and triangles and labelled boundary edges in any
    order."""
    labelled = [{(*sorted(edge), label) for edge, label in zip(m.edges.tolist(), m.labels.tolist())} for m in (a, b)]
    corners = [sorted(sorted(triangle) for triangle in m.triangles.tolist()) for m in (a, b)]
    return a.points.shape == b.points.shape and abs(a.points - b.points).max() < 1e-15 and labelled[0] == labelled[1] and corners[0] == corners[1]


@pytest.mark.few(4)
@pytest.mark.parametrize("version, binary", [(2.2, False), (2.2, True), (4.1, False), (4.1, True)])
@pytest.mark.parametrize("half, named", [(True, False), (False, True)])
def test_gmsh_formats_are_our_own(tmp_path, version, binary, half, named):
    """A disc in gmsh 2.2 or 4.1, ascii or binary, with numbers or names of physical curves, equals
    the disc in FreeFEM's format."""
    m = mesh.disc(RADIUS, 0.015, 0.006, half)
    in_gmsh(tmp_path / "disc.msh", m, version, binary, named)
    assert the_same(gmsh_file.load(tmp_path / "disc.msh"), m)


def test_gmsh_file_gives_the_same_answer(tmp_path):
    """The run with gmsh's binary file equals that with ours to the round-off of the solver, and is
    reused."""
    m = mesh.disc(RADIUS, 0.015, 0.006, False)
    in_gmsh(tmp_path / "gmsh.msh", m, 4.1, True)
    ours = go(tmp_path / "ours", m)
    tables = falling(tmp_path / "gmsh.msh", float(m.points[:, 1].min()))
    theirs, again = (run.run(scene.read(tables, tmp_path, "mesh"), {}, tmp_path / "theirs", estimate=False) for _ in range(2))
    # Of the points at the edge of contact round-off decides.
    agree(ours, theirs, 1e-6, ("normal_force", "kinetic", "elastic", "contact", "y", "vy"))
    assert again.reused


def test_gmsh_by_default_lets_all_of_the_boundary_touch(tmp_path):
    """Without physical curves all outlines may come into contact (1); on a plane alone, holes do
    not (3).

    Triangles with six nodes give their corners. Unused nodes are removed.
    """
    for order in (1, 2):
        with mesh.gmsh_session() as gmsh:
            gmsh.option.setNumber("Mesh.MeshSizeMax", 0.01)
            ring(gmsh.model.occ)
            gmsh.model.occ.addPoint(1, 1, 0)
            gmsh.model.occ.synchronize()
            gmsh.model.mesh.generate(2)
            gmsh.model.mesh.setOrder(order)
            gmsh.write(str(tmp_path / "ring.msh"))
        m = gmsh_file.load(tmp_path / "ring.msh")
        middle = np.hypot(*(m.points[m.edges].mean(axis=1) - (0.1, 0.1)).T)
        assert set(m.labels) == {1}
        alone = mesh.without_inner(m)
        assert ((middle > 0.03) == (alone.labels == mesh.FREE)).all()
        assert set(alone.labels) == {1, 3}
        assert areas(m).sum() == pytest.approx(math.pi * (RADIUS**2 - 0.02**2), rel=0.03)
        assert set(m.triangles.flat) == set(range(len(m.points)))


def test_gmsh_triangles_are_turned(tmp_path):
    """Clockwise triangles of gmsh are reversed."""
    m = mesh.disc(RADIUS, 0.03, 0.02, False)
    in_gmsh(tmp_path / "m.msh", replace(m, triangles=m.triangles[:, ::-1]), 2.2, False)
    assert the_same(gmsh_file.load(tmp_path / "m.msh"), m)


def test_names_come_before_numbers(tmp_path):
    """Names of physical curves have priority: gmsh numbers curves with names 1, 2 ...
    automatically."""
    with mesh.gmsh_session() as gmsh:
        gmsh.model.occ.addRectangle(0, 0, 0, 0.1, 0.1)
        gmsh.model.occ.synchronize()
        # Bottom 1, right 2, top 3, left 4: in no group.
        for curve, name in ((2, "right"), (3, "top"), (1, "contact")):
            gmsh.model.addPhysicalGroup(1, [curve], name=name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.05)
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "m.msh"))
    m = gmsh_file.load(tmp_path / "m.msh")
    assert ((m.points[m.edges, 1].max(axis=1) == 0) == (m.labels == 1)).all() and set(m.labels) == {1, 3}


@pytest.mark.parametrize("dimension", [2, 3])
def test_sides_of_second_order_that_bend_too_far(tmp_path, dimension):
    """Of second order only the corners are used. With 8 sides a disc would be an octagon with 90 %
    of the mass; a hole with 4 sides in a block is refused, too. With 16 and 24 sides circles are
    recognised, and straight sides are no matter."""
    def load_circle(sides, order=2):
        with mesh.gmsh_session() as gmsh:
            if dimension == 2:
                gmsh.model.occ.addDisk(0, 0, 0, RADIUS, RADIUS)
            else:
                occ = gmsh.model.occ
                occ.cut([(3, occ.addBox(-2, -2, 0, 4, 4, 1))], [(3, occ.addCylinder(0, 0, -1, 0, 0, 3, 1))])
            gmsh.model.occ.synchronize()
            for _, curve in gmsh.model.getEntities(1):
                if gmsh.model.getType(1, curve) in ("Circle", "Ellipse"):
                    gmsh.model.mesh.setTransfiniteCurve(curve, sides + 1)
            gmsh.model.mesh.generate(dimension)
            gmsh.model.mesh.setOrder(order)
            gmsh.write(str(tmp_path / "m.msh"))
        return gmsh_file.load(tmp_path / "m.msh") if dimension == 2 else solid_file.read(tmp_path / "m.msh")
    bent, fine = (8, 16) if dimension == 2 else (4, 24)
    with pytest.raises(BadInput, match=f"bends by {360 / bent:g} degrees, and only its ends are used .accepted: up to 30 degrees"):
        load_circle(bent)
    load_circle(bent, order=1)
    load_circle(fine)


@pytest.mark.few(2)
@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("names", [("contact", "bottom"), ("bottom", "contact"), ("contact", "symmetry")])
def test_lines_in_two_groups(tmp_path, version, names):
    """A line in `contact` and in another group may come into contact, in any order. A line also in
    `symmetry` is refused."""
    with mesh.gmsh_session() as gmsh:
        gmsh.model.occ.addRectangle(0, 0, 0, 0.1, 0.1)
        gmsh.model.occ.synchronize()
        for name in names:
            gmsh.model.addPhysicalGroup(1, [1, 2, 3, 4] if name == "contact" else [1], name=name)
        gmsh.model.addPhysicalGroup(2, [1])
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.05)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "m.msh"))
    if "symmetry" in names:
        with pytest.raises(BadInput, match="both as contact and as symmetry .accepted: one of them"):
            gmsh_file.load(tmp_path / "m.msh")
    else:
        assert set(gmsh_file.load(tmp_path / "m.msh").labels) == {mesh.FREE}


HEAD = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
NODES = "$Nodes\n4\n1 0 0 0\n2 0.1 0 0\n3 0.1 0.1 {z}\n4 0 0.1 0\n$EndNodes\n"


@pytest.mark.few(5)
@pytest.mark.parametrize("text, words", [
    ("$MeshFormat\n", "gmsh cannot read it"), (HEAD, "it has no triangles"), ("$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "gmsh cannot read it: Unknown MSH file version 9.9"),
    (HEAD + NODES.format(z=0), "it has no triangles"),
    (HEAD + NODES.format(z=0) + "$Elements\n1\n1 3 2 0 1 1 2 3 4\n$EndElements\n", "it has elements 'Quadrilateral 4' (accepted: triangles of 3 or 6 nodes)"),
    (HEAD + NODES.format(z=0.01) + "$Elements\n2\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4\n$EndElements\n", "it is not flat: z from 0 to 0.01 m"),
    (HEAD + NODES.format(z=0) + "$Elements\n1\n1 2 2 0 1 1 2 7\n$EndElements\n", "gmsh cannot read it: Wrong node index 7"),
    (HEAD + NODES.format(z=0) + "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n", "it has elements 'Tetrahedron 4'"),
    (HEAD + NODES.format(z=0) + "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n", None),
    (HEAD + "$Nodes\n-3\n", "it has no triangles"), (HEAD + "$Nodes\n3000000000\n1 0 0 0\n", "")])
def test_bad_gmsh_file_is_one_line(tmp_path, text, words):
    """A file that gmsh or we cannot use is bad input with the file and the reason."""
    (tmp_path / "m.msh").write_text(text)
    if words is None:  # the same file without error
        assert len(plane_file.load(tmp_path / "m.msh").edges) == 3
        return
    with pytest.raises(BadInput) as error:
        scene.read(falling(tmp_path / "m.msh", 0.0), tmp_path, "mesh")
    assert str(error.value).startswith("body.1.file: ") and words in str(error.value) and "\n" not in str(error.value)


def test_other_files_are_not_executed(tmp_path):
    """A script of gmsh (.geo) is not a mesh and is not passed to gmsh, which would run it."""
    (tmp_path / "m.geo").write_text(f'SystemCall "touch {tmp_path}/pwned";\n')
    with pytest.raises(BadInput, match="m.geo: is no mesh"):
        scene.read(falling(tmp_path / "m.geo", 0.0), tmp_path, "mesh")
    assert not (tmp_path / "pwned").exists()
