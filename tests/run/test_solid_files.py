"""Meshes and scene files of edp/program/bodies-3d.edp: every error is one line with exit code 10, and no
files are left."""

import re

import pytest

from ffimpact.freefem import freefem
from verification.solids import Scene, ball, brick, write

TWO = Scene([ball((0, 0, 0), 0.05, 1, shift=(0, 0.06, 0), velocity=(0, -2, 0)), brick((-0.1, -0.3, -0.1), (0.1, -0.2, 0.1), (2, 1, 2), shift=(0, 0.2, 0))],
            [("sphere", (0, -9, 0, 1), (0, 0, 0))])


def block(text: str, keyword: str, change) -> str:
    """The mesh with changes of the first line after a keyword and of its count."""
    lines = text.splitlines()
    at = next(k for k, line in enumerate(lines) if line.startswith(keyword)) + 2
    lines[at] = " ".join(change(lines[at].split()))
    return "\n".join(lines) + "\n"


MESHES = {
    "garbage": (lambda text: "garbage\n", "mesh: the file ends too early"),
    "cut": (lambda text: text[:text.index("Triangles") - 9], "mesh: the file ends too early .* in Tetrahedra"),
    "plane": (lambda text: text.replace("Dimension 3", "Dimension 2"), "mesh: the file does not begin with MeshVersionFormatted and Dimension 3"),
    "keyword": (lambda text: text.replace("Triangles", "Quadrilaterals"), "mesh: the word 'Quadrilaterals'"),
    "word": (lambda text: block(text, "Tetrahedra", lambda w: [*w[:2], "x", *w[3:]]), "mesh: the file ends too early or has a word .* in Tetrahedra"),
    "inside out": (lambda text: block(text, "Tetrahedra", lambda w: [w[1], w[0], *w[2:]]), "mesh: tetrahedron 1 .* is inside out or flat"),
    "no vertex": (lambda text: block(text, "Tetrahedra", lambda w: ["9999", *w[1:]]), "mesh: tetrahedron 1 .* names a vertex that is not there .accepted: 1 to "),
    "region": (lambda text: block(text, "Tetrahedra", lambda w: [*w[:4], "2"]), "mesh: tetrahedron 1 .* is of region 2 .accepted: the bodies, 0 to 1"),
    "mixed": (lambda text: block(text, "Tetrahedra", lambda w: [*w[:4], "1"]), "mesh: tetrahedron .* has neighbours of another"),
    "bare face": (lambda text: block(text, "Triangles", lambda w: [*text.splitlines()[text.splitlines().index(" ".join(w)) + 1].split()]), "mesh: .* but not among the boundary faces"),
    "symmetry": (lambda text: block(text, "Triangles", lambda w: [*w[:3], "3"]), "mesh: boundary face 1 has the label 3 .accepted: 2 on x = 0"),
    "nowhere": (lambda text: block(text, "Vertices", lambda w: ["1e10", *w[1:]]), "mesh: vertex 1 at .1e.10"),
}
SCENES = {
    "in the plane": (("ffimpact-bodies-3d", "ffimpact-bodies"), "bodies: .* does not begin with 'ffimpact-bodies-3d 1'"),
    "copies": (("copies 1", "copies 3"), "bodies: 'copies 1', 'copies 2' or 'copies 4' is missing"),
    "part": (("copies 1", "copies 2"), "mesh: region 0, body0, begins at z = -0.05"),
    "law": (("body0 neohookean", "body0 rubber"), "bodies: the law 'rubber' of body0 is not known"),
    "numbers": (("sphere 4 0.0", "sphere 3"), "bodies: obstacle 1, 'circle', is of 3 numbers .a plane has 6, a circle or bowl 4"),
    "kind": (("sphere 4", "polyline 4"), "bodies: the obstacle 'polyline' is not known"),
    "radius": (("0.0 0.05\n", "0.0 -0.05\n"), "bodies: sphere 1 of body 0, .* has the radius -0.05"),
    "short": (("pairs 0", "pairs 1"), "bodies: .* ends too early or has a word"),
    "centre": (("1722.0 0.0 0.0 0.0", "1722.0 0.0 0.5 0.0"), "mesh: region 0, body0, has its centre at y = "),
}


def refused(folder, words: str) -> None:
    words = words.replace("mesh: ", f"mesh: {folder}/mesh.mesh: ")
    flags = {"mesh": folder / "mesh.mesh", "bodies": folder / "scene.dat", "end_time": 1e-5, "out": folder / "out"}
    done = freefem.find().call("edp/program/bodies-3d.edp", *freefem.words_of(flags))
    assert done.returncode == 10 and done.stderr.count("\n") == 1 and re.match(f"ffimpact: {words}", done.stderr), done.stderr
    assert not (folder / "out").exists()


@pytest.mark.few(4)
@pytest.mark.parametrize("case", MESHES)
def test_bad_meshes(tmp_path, case):
    change, words = MESHES[case]
    mesh = write(TWO, tmp_path)["mesh"]
    mesh.write_text(change(mesh.read_text()))
    refused(tmp_path, words)


def test_the_last_line_needs_no_end(tmp_path):
    """A mesh whose last word is the end of the file is read; the wrong scene after it is refused.
    """
    mesh, data = (write(TWO, tmp_path)[name] for name in ("mesh", "bodies"))
    mesh.write_text(mesh.read_text().rstrip())
    data.write_text(data.read_text().replace("1722.0 0.0 0.0 0.0", "1722.0 0.0 0.5 0.0", 1))
    refused(tmp_path, "mesh: region 0, body0, has its centre at y = ")


@pytest.mark.few(4)
@pytest.mark.parametrize("case", SCENES)
def test_bad_scenes(tmp_path, case):
    (old, new), words = SCENES[case]
    data = write(TWO, tmp_path)["bodies"]
    text = data.read_text()
    assert old in text
    data.write_text(text.replace(old, new, 1))
    refused(tmp_path, words)


def test_what_breaks_the_symmetry(tmp_path):
    """A part of the bodies is computed only if initial state and obstacles are symmetric."""
    for part, message in (({"velocity": (0, -2, 1)}, "starts away from z = 0, along z"), ({"spin": (0, 0, 1)}, "starts away from x = 0, along x, or turning")):
        write(Scene([ball((0, 0, 0), 0.05, 1, 4, **part)], [("plane", (0, -1, 0, 0, 1, 0), (0, 0, 0))], copies=4), tmp_path)
        refused(tmp_path, f"bodies: body0 {message}")
    write(Scene([ball((0, 0, 0), 0.05, 1, 4)], [("plane", (0, -1, 0, 0.1, 1, 0), (0, 0, 0))], copies=4), tmp_path)
    refused(tmp_path, "bodies: obstacle 1, 'plane', has no mirror symmetry")
