"""Meshes as arrays: refusals, parts of the boundary, and the way through a scene file."""

import numpy as np
import pytest

import ffimpact as ff
from ffimpact.mesh import given
from ffimpact.mesh.mesh import AXIS, FREE, Mesh
from ffimpact.scenes.parts import conditions

RUBBER = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
# A square of 0.1 m with 2 x 2 squares of two triangles each; point 4 is its middle.
POINTS = np.array([[x, y] for y in (0, 0.05, 0.1) for x in (0, 0.05, 0.1)])
CELLS = np.array([t for k in (0, 1, 3, 4) for t in ((k, k + 1, k + 4), (k, k + 4, k + 3))])
BOTTOM = [[0, 1], [1, 2]]
# Two tetrahedra on both sides of a triangle.
CORNERS = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]])
SOLID = {"points": CORNERS, "cells": [[0, 1, 2, 3], [0, 1, 2, 4]], "position": (0, 0.2, 0), "velocity": (0, -3, 0)}


def scene(**entries) -> ff.Scene:
    body = {"points": POINTS, "cells": CELLS, "position": (0, 0.06), "velocity": (0, -3)} | entries
    return ff.Scene(bodies=[ff.Mesh(material=RUBBER, **body)], obstacles=[ff.Plane()])


REFUSED = {
    "no cells": ({"cells": None}, "Mesh: cells: is missing (accepted: points and cells, or a file)"),
    "no points": ({"points": None}, "Mesh: points: is missing (accepted: points and cells, or a file)"),
    "labels alone": ({"points": None, "cells": None, "labels": {"a": BOTTOM}}, "Mesh: points: is missing"),
    "beside a file": ({"file": "a.msh"}, "Mesh: file: stands beside points (accepted: a file, or points and cells)"),
    "words": ({"points": "x"}, "Mesh: points: 'x' are no such rows (accepted: 1 to 2000000 rows of 2 or 3 numbers"),
    "ragged": ({"points": [[0, 1], [2]]}, "Mesh: points: '[[0, 1], [2]]' are no such rows"),
    "nan": ({"points": [[0, np.nan]]}, "Mesh: points: row 0 is [0, nan] (accepted: "),
    "numbers from 1": ({"cells": CELLS + 1}, "body.1.cells: names point 9 (accepted: 0 to 8)"),
    "negative": ({"cells": CELLS - 1}, "Mesh: cells: row 0 is [-1, 0, 3] (accepted: "),
    "fractions": ({"cells": CELLS + 0.5}, "Mesh: cells: row 0 is [0.5, 1.5, 4.5] (accepted: "),
    "tetrahedra in the plane": ({"cells": [[0, 1, 4, 3]]}, "body.1.cells: 4 corners in 2 dimensions (accepted: triangles"),
    "twice": ({"cells": np.vstack([CELLS, CELLS[:1]])}, "body.1.cells: triangle 1 (vertices 1, 2, 5) and triangle 9"),
    "inner side": ({"labels": {"contact": [[0, 4]]}}, "body.1.labels.contact: [0, 4] is no side on the boundary"),
    "name": ({"labels": {"a b": BOTTOM}}, "Mesh: labels: 'a b' is no name"),
    "list": ({"labels": BOTTOM}, "Mesh: labels: '[[0, 1], [1, 2]]' is no table"),
    "half a body": ({"labels": {"symmetry": [[0, 3], [3, 6]]}}, "body.1.labels.symmetry: of a whole body"),
    "flat": ({**SOLID, "points": CORNERS * [1, 1, 0]}, "body.1.cells: a tetrahedron is flat"),
    "sizes": ({"mesh_size": 0.01}, "body.1.mesh_size: '0.01' for a mesh from a file"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_wrong_arrays_are_refused_by_name(case):
    entries, line = REFUSED[case]
    with pytest.raises(ff.BadInput) as refused:
        scene(**entries)
    assert str(refused.value).startswith(line)


def test_labels_decide_contact_and_name_parts():
    """The part `contact` alone may come into contact; a mesh without this part all around. Points
    that no cell uses do not count."""
    labels = {"contact": BOTTOM, "left": [[3, 0]]}
    numbers = np.array([*range(1, 10)])
    shifted = {"points": np.vstack([[9, 9], POINTS]), "cells": numbers[CELLS], "labels":
               {name: numbers[np.array(rows)] for name, rows in labels.items()}}  # fmt: skip
    for entries in ({"points": POINTS, "cells": CELLS[:, ::-1], "labels": labels}, shifted):
        made = given.plane(ff.Mesh(position=(0, 0), **entries))
        assert set(map(tuple, made.edges[made.labels == FREE].tolist())) == {(0, 1), (1, 2)}
        assert set(made.labels) == {FREE, Mesh.NEVER}
        assert made.edges[made.groups["left"]].tolist() == [[3, 0]]
    assert set(given.plane(ff.Mesh(position=(0, 0), points=POINTS, cells=CELLS)).labels) == {FREE}
    half = given.plane(ff.Mesh(position=(0, 0), points=POINTS, cells=CELLS, labels={"symmetry": [[0, 3], [3, 6]]}))
    assert (half.labels == AXIS).sum() == 2 and (half.labels == FREE).sum() == 6


def test_a_part_is_the_place_of_a_support():
    body = ff.Mesh(points=POINTS, cells=CELLS, labels={"foot": BOTTOM}, material=RUBBER, position=(0, 1),
                   support=[ff.Support(where="foot")])  # fmt: skip
    read = ff.Scene(bodies=[body], gravity=9.81, end_time=0.01).ready()
    made = read.bodies[0].file_mesh
    found = conditions(read.bodies, [made], [], read.kind, 1)["supports.elements"]
    assert made.edges[found].tolist() == BOTTOM


def test_in_space_with_both_orientations():
    made = scene(**SOLID).ready().bodies[0].file_mesh
    assert made.volumes == pytest.approx([1e-3 / 6] * 2)
    assert len(made.faces) == 6


def test_the_file_of_the_scene_has_the_arrays(tmp_path):
    """Saved and read, the scene is the same; what identifies a run has no long table."""
    first = scene(labels={"contact": BOTTOM})
    again = ff.Scene.load(first.save(tmp_path / "folder/scene.toml"))
    assert again == first and again.model_dump() == first.model_dump()
    many = np.column_stack([np.tile(np.linspace(0, 0.1, 101), 2), np.repeat([0, 0.1], 101)])
    strip = np.array([t for k in range(100) for t in ((k, k + 1, k + 102), (k, k + 102, k + 101))])
    decisive = scene(points=many, cells=strip).ready().decisive_entries["body"][0]
    other = scene(points=1.001 * many, cells=strip).ready().decisive_entries["body"][0]
    assert len(str(decisive)) < 1000 and decisive["cells"] == other["cells"]
    assert decisive["points"] != other["points"]
