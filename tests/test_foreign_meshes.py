"""Meshes of the user's own: what is wrong with a file is named, on both ways in; bodies of any outline; gmsh's files."""

import json
import math
import re
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from orchestrate import freefem, gmsh_file, mesh, run, scene
from orchestrate.describe import describe
from orchestrate.failure import BadInput
from orchestrate.parameters import ROOT

RADIUS, DENSITY = 0.05, 1722.0


# ---- files with something wrong

# a square of 0.1 m, 2 x 2 cells of two triangles each; vertex 5 is its middle
POINTS = [f"{x} {y} 0" for y in (0, 0.05, 0.1) for x in (0, 0.05, 0.1)]
TRIANGLES = [f"{a} {b} {c} 0" for k in (1, 2, 4, 5) for a, b, c in ((k, k + 1, k + 4), (k, k + 4, k + 3))]
EDGES = [f"{a} {b} 1" for a, b in ((1, 2), (2, 3), (3, 6), (6, 9), (9, 8), (8, 7), (7, 4), (4, 1))]


def square(points=POINTS, triangles=TRIANGLES, edges=EDGES, counts=None) -> str:
    return "\n".join([counts or f"{len(points)} {len(triangles)} {len(edges)}", *points, *triangles, *edges]) + "\n"


def changed(lines: list[str], number: int, text: str) -> list[str]:
    """The lines with the one of this number, counted from 1, replaced."""
    return [text if k == number else line for k, line in enumerate(lines, 1)]


def beside(shift: float, first: int) -> tuple[list[str], list[str], list[str]]:
    """A second square, `shift` metres to the right, its vertices numbered from `first` on."""
    more = [f"{float(x) + shift} {y} {label}" for x, y, label in map(str.split, POINTS)]
    def renumbered(lines, n):
        return [" ".join([*(str(int(word) + first - 1) for word in line.split()[:n]), line.split()[n]]) for line in lines]
    return more, renumbered(TRIANGLES, 3), renumbered(EDGES, 2)


TWO = beside(0.3, 10)
# the second square shares the corner vertex 9 of the first with its vertex 1
POINT = [[re.sub(rf"\b{10}\b", "9", line) if k else line for line in lines]
         for k, lines in enumerate(([f"{float(x) + 0.1} {float(y) + 0.1} 0" for x, y, _ in map(str.split, POINTS)], *beside(0, 10)[1:]))]
POINT = [POINT[0][1:], *([" ".join(str(int(w) - 1) if k < n and int(w) > 9 else w for k, w in enumerate(line.split())) for line in lines]
                         for n, lines in ((3, POINT[1]), (2, POINT[2])))]
# the middle cell of 3 x 3 cells with an edge that three triangles share: a flap below the bottom side of the square
FLAP = ["1 2 6 0"]

BAD = {
    "empty": ("", "does not begin with its numbers of vertices, triangles and boundary edges"),
    "words": ("hello world\n", "does not begin with its numbers"),
    "medit": ("MeshVersionFormatted 2\nDimension 2\n", "does not begin with its numbers"),
    "bytes": ("\x00\x01\x02", "does not begin with its numbers"),
    "two counts": ("9 8", "does not begin with its numbers"),
    "count 1e1": (square(counts="1e1 8 8"), "does not begin with its numbers"),
    "no vertices": (square(counts="0 8 8"), "0 vertices (accepted: 3 to 2000000)"),
    "negative vertices": (square(counts="-9 8 8"), "-9 vertices (accepted"),
    "absurd vertices": (square(counts="999999999999 8 8"), "999999999999 vertices (accepted"),
    "vertices beyond any integer": (square(counts="99999999999999999999 8 8"), "does not begin with its numbers"),
    "no triangles": (square(triangles=[]), "0 triangles (accepted: 1 to 2000000)"),
    "negative triangles": (square(counts="9 -8 8"), "-8 triangles"),
    "no boundary": (square(edges=[]), "0 boundary edges (accepted: 3 to 2000000)"),
    "negative edges": (square(counts="9 8 -8"), "-8 boundary edges"),
    "too short": (square()[:-30], "the file ends at boundary edge 4 (it has to have 9 vertices, 8 triangles, 8 boundary edges)"),
    "too few vertices": (square(counts="90 8 8"), "the file ends at vertex 28"),
    "label missing": (square()[:-3], "the file ends at boundary edge 8"),
    "cut in its last number": (square(edges=changed(EDGES, 8, "4 1 12"))[:-2], "the file ends at boundary edge 8 (accepted: a line end behind its label)"),
    "garbage behind": (square() + "\n 7 8 9\n", "'7 8 9' follows behind the last boundary edge"),
    "garbage in the last line": (square()[:-1] + "x\n", "boundary edge 8 ends with '1x' (accepted: its label, a whole number)"),
    "broken last label": (square()[:-1] + ".5\n", "boundary edge 8 ends with '1.5'"),
    "nan": (square(points=changed(POINTS, 5, "0.05 nan 0")), "vertex 5 is not x y label in numbers"),
    "inf": (square(points=changed(POINTS, 5, "inf 0.05 0")), "vertex 5 is not x y label in numbers"),
    "beyond any number": (square(points=changed(POINTS, 5, "1e400 0.05 0")), "vertex 5 is not x y label in numbers"),
    "decimal comma": (square(points=changed(POINTS, 5, "0,05 0.05 0")), "vertex 5 is not x y label in numbers"),
    "letters": (square(triangles=changed(TRIANGLES, 3, "2 3 b 0")), "triangle 3 is not v1 v2 v3 region in numbers"),
    "broken index": (square(triangles=changed(TRIANGLES, 3, "2 3.5 6 0")), "triangle 3 is not v1 v2 v3 region in numbers"),
    "broken edge": (square(edges=changed(EDGES, 3, "3 x 1")), "boundary edge 3 is not v1 v2 label in numbers"),
    "three coordinates": (square(points=[f"{p} 0" for p in POINTS]), "triangle"),
    "index 0": (square(triangles=changed(TRIANGLES, 3, "2 0 6 0")), "triangle 3 (vertices 2, 0, 6) names a vertex that is not there (accepted: 1 to 9)"),
    "negative index": (square(triangles=changed(TRIANGLES, 3, "2 -3 6 0")), "triangle 3 (vertices 2, -3, 6) names a vertex that is not there"),
    "index 10": (square(triangles=changed(TRIANGLES, 3, "2 10 6 0")), "triangle 3 (vertices 2, 10, 6) names a vertex that is not there"),
    "edge index 10": (square(edges=changed(EDGES, 3, "3 10 1")), "boundary edge 3 (vertices 3, 10) names a vertex that is not there"),
    "negative label": (square(edges=changed(EDGES, 3, "3 6 -1")), "boundary edge 3 has the label -1 (accepted: 0 to"),
    "clockwise": (square(triangles=changed(TRIANGLES, 3, "2 6 3 0")), "triangle 3 (vertices 2, 6, 3) is clockwise"),
    "all clockwise": (square(triangles=[" ".join((b, a, c, r)) for a, b, c, r in map(str.split, TRIANGLES)]), "triangle 1 (vertices 2, 1, 5) is clockwise"),
    "inverted": (square(points=changed(POINTS, 5, "0.2 0.05 0")), "is clockwise"),
    "flat": (square(points=changed(POINTS, 5, "0.025 0.025 0"), triangles=changed(TRIANGLES, 3, "2 3 5 0")), "triangle"),
    "one vertex twice": (square(triangles=changed(TRIANGLES, 3, "2 6 6 0")), "triangle 3 (vertices 2, 6, 6) is degenerate"),
    "on a line": (square(triangles=changed(TRIANGLES, 3, "1 2 3 0")), "triangle 3 (vertices 1, 2, 3) is degenerate"),
    "far": (square(points=changed(POINTS, 9, "1e300 0.1 0")), "vertex 9 at (1e+300, 0.1) (accepted: coordinates of at most 1e+06 m)"),
    "needle": (square(points=changed(POINTS, 9, "9e5 0.1 0")), "is degenerate: its height is below 1e-06 of its longest side"),
    "same place": (square(points=[*POINTS, "0.05 0.05 0"], triangles=changed(TRIANGLES, 1, "1 2 10 0")), "vertices 5 and 10 at (0.05, 0.05) are at the same place"),
    "nearly the same place": (square(points=[*POINTS, "0.05 0.0500000000001 0"], triangles=changed(TRIANGLES, 1, "1 2 10 0")), "vertices 5 and 10 at (0.05, 0.05) are at the same place"),
    "unused": (square(points=[*POINTS, "0.03 0.01 0"]), "vertex 10 at (0.03, 0.01) belongs to no triangle"),
    "triangle twice": (square(triangles=[*TRIANGLES, TRIANGLES[2]]), "triangle 3 (vertices 2, 3, 6) and triangle 9 (vertices 2, 3, 6) are the same"),
    "overlap": (square(points=[*POINTS, "0.02 0.04 0"], triangles=[*TRIANGLES, "1 2 10 0"]), "triangle 1 (vertices 1, 2, 5) and triangle 9 (vertices 1, 2, 10) overlap"),
    "three at a side": (square(points=[*POINTS, "0.04 0.08 0"], triangles=[*TRIANGLES, "2 5 10 0"]), "the side (vertices 2, 5) belongs to 3 triangles"),
    "edge missing": (square(edges=EDGES[:-1]), "the side (vertices 4, 1) of triangle 2 (vertices 1, 5, 4) is on the boundary but not among the boundary edges"),
    "edge twice": (square(edges=[*EDGES, "2 1 1"]), "boundary edge"),
    "edge inside": (square(edges=[*EDGES, "1 5 1"]), "boundary edge 9 (vertices 1, 5) lies inside the body"),
    "edge nowhere": (square(edges=[*EDGES, "1 9 1"]), "boundary edge 9 (vertices 1, 9) is no side of a triangle"),
    "edge of no length": (square(edges=[*EDGES, "1 1 1"]), "boundary edge 9 (vertices 1, 1) is no side of a triangle"),
    "hole unlisted": (square(triangles=TRIANGLES[:3] + TRIANGLES[4:]), "on the boundary but not among the boundary edges"),
    "two bodies": (square(POINTS + TWO[0], TRIANGLES + TWO[1], EDGES + TWO[2]), "2 bodies that are apart (accepted: one piece)"),
    "by a point": (square(POINTS + POINT[0], TRIANGLES + POINT[1], EDGES + POINT[2]), "vertex 9 at (0.1, 0.1) has 4 boundary edges: the body hangs together by a point"),
    "nothing may touch": (square(edges=[edge[:-1] + "7" for edge in EDGES]), "no boundary edge has the label 1 of what may touch, only 7"),
    "other units": (square(points=[f"{1e3 * float(x)} {1e3 * float(y)} 0" for x, y, _ in map(str.split, POINTS)]), "is 100 m wide but radius is 0.05 m: other units?"),
    "tiny": (square(points=[f"{1e-3 * float(x)} {1e-3 * float(y)} 0" for x, y, _ in map(str.split, POINTS)]), "is 0.0001 m wide but radius is 0.05 m: other units?"),
    "slanted axis": (square(edges=changed(EDGES, 1, "1 2 2")), "boundary edge 1 (vertices 1, 2) has the label 2 of the symmetry axis but does not lie on the vertical line x = 0"),
    "right of the body": (square(edges=[e[:-1] + "2" if e[:3] in ("3 6", "6 9") else e for e in EDGES]), "vertex 1 at (0, 0) lies to the left of the symmetry axis"),
    "half an axis": (square(edges=changed(EDGES, 7, "7 4 2")), "boundary edge 8 (vertices 4, 1) lies on the symmetry axis, the vertical line x = 0, but has the label 1 (accepted: 2)"),
}


@pytest.fixture(scope="module")
def direct():
    """direct(flag, value, ...): edp/disc-plane.edp without Python."""
    program = freefem.find()   # the real one, also where a test puts another in its place

    def go(*flags: str) -> subprocess.CompletedProcess:
        return subprocess.run([program.command, "-nw", "-ne", "-v", "0", "edp/disc-plane.edp", *flags], cwd=ROOT, env=program.environment,
                              capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL, timeout=120)
    return go


@pytest.fixture(scope="module")
def refused(direct):
    """refused(mesh, out, flags): the one line with which the script alone refuses; it leaves nothing behind."""
    def go(path: Path, out: Path, *flags: str) -> str:
        process = direct("-mesh", str(path), "-out", str(out), *flags)
        assert process.returncode == 10, process.stdout
        assert process.stderr.startswith("ffimpact: ") and process.stderr.count("\n") == 1
        assert not out.exists()
        return process.stderr[len("ffimpact: "):-1]
    return go


@pytest.mark.parametrize("name", BAD)
def test_bad_mesh_is_named_alike_on_both_ways(refused, fake, tmp_path, name):
    """What is wrong with a mesh, and where, is one line and exit code 10, from the script and from Python, which starts no run;
    within a second."""
    text, words = BAD[name]
    (tmp_path / "m.msh").write_text(text)
    started = time.perf_counter()
    said = refused(tmp_path / "m.msh", tmp_path / "out")
    assert time.perf_counter() - started < 1
    assert said.startswith("mesh: ") and words in said
    with pytest.raises(BadInput) as error:
        run.run(scene.load("disc-normal"), {"penalty": "auto"}, tmp_path / "out", mesh_file=tmp_path / "m.msh")
    assert str(error.value) == said and fake.starts() == 0 and not (tmp_path / "out").exists()


def test_the_square_without_a_fault_is_accepted(tmp_path):
    """The square that the faults are put into is a mesh: every refusal above is for its fault."""
    for number, text in enumerate([square(), square().replace("\n", "\r\n"), square() + "\n \n"]):
        (tmp_path / f"{number}.msh").write_text(text, newline="")
        assert describe({"mesh": str(tmp_path / f"{number}.msh")})["outline"] == "8 straight edges"
