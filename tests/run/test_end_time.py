"""Mesh and steps up to a time are the same for a longer end_time."""

import pytest

from ffimpact import scene
from ffimpact.running import run
from tests.support.front import BLOCK, scene_of

BEAM = """
accuracy = 0.1
law = "neohookean"
young = 5e6
nu = 0.45
density = 1100
end_time = 1
[[body]]
shape = "disc"
radius = 0.02
position = [0.09, 0.0251]
velocity = [0.5, -3]
[[body]]
shape = "rectangle"
width = 0.2
position = [0, 0]
height = 0.01
[[body.support]]
where = "left"
fix = "all"
[[body.load]]
where = "top"
pressure = 1000
[contact]
friction_static = 0.3
"""


@pytest.mark.parametrize("name, end", [("disc-oblique", 0.02), ("held", 0.0006), ("slides", 0.01)])
def test_a_longer_run_repeats_a_shorter_one(name, end, tmp_path):
    """A disc that strikes obliquely and rolls on under gravity, a held and loaded beam with a disc
    that slides along it, and a block that a body force pulls along the plane: mesh, values of the
    scene and all rows but the last, which ends at end_time, are the same bytes for twice the time."""
    if name == "disc-oblique":
        problem, entries = scene.load(name), {"gravity": 9.81, "fields": 0, "accuracy": 0.05}
    elif name == "held":
        problem, entries = scene_of(BEAM, tmp_path), {}
    else:
        problem = scene_of(BLOCK, tmp_path, gravity=9.81, body_force_x=3.0, body__1__velocity=[0, 0])
        entries = {"accuracy": 0.1, "contact.friction_static": 0.1}
    short, long = (run.run(problem, entries | {"end_time": factor * end}, tmp_path / str(factor), estimate=False) for factor in (1, 2))
    first, second = ((result.folder / "history.csv").read_text().splitlines() for result in (short, long))
    assert len(second) > len(first) > 10 and first[:-1] == second[: len(first) - 1]
    assert (short.folder / "mesh.msh").read_bytes() == (long.folder / "mesh.msh").read_bytes()
    assert short.scene | {"end_time": 0} == long.scene | {"end_time": 0}
