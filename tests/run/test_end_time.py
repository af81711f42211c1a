"""Mesh and steps up to a time are the same for a longer end_time."""

import pytest

from ffimpact import scene
from ffimpact.running import run
from tests.support.front import BLOCK, scene_of

RUBBER = """
accuracy = 0.1
law = "neohookean"
young = 5e6
density = 1100
end_time = 1
"""
A_DISC = """
[[body]]
shape = "disc"
radius = 0.02
"""
BEAM = RUBBER + "nu = 0.45" + A_DISC + """
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


# A disc above a plane, one of them moved.
DISC = RUBBER + "nu = 0.4" + A_DISC + """
position = [0, 0.0201]
"""
PRESSED = DISC + """
[[body.support]]
where = {kind = "box", low = [-0.02, 0.03], high = [0.02, 0.05]}
motion = MOTION
[[obstacle]]
kind = "plane"
"""
STRUCK = DISC + """
[[obstacle]]
kind = "plane"
motion = MOTION
"""
LOADED = BEAM[: BEAM.index("[[body]]")] + BEAM[BEAM.rindex("[[body]]") : BEAM.index("pressure")] + """
pressure = "MOTION"
"""
TABLE = "{t = [0, 0.005, 0.03], x = [0, 0, 0], y = [0, -5e-4, -2e-3]}"
OBLIQUE = {"gravity": 9.81, "accuracy": 0.05}
SLIDES = {"gravity": 9.81, "body_force_x": 3.0, "body.1.velocity": [0, 0], "accuracy": 0.1, "contact.friction_static": 0.1}


@pytest.mark.parametrize("problem, motion, end, entries", [
    ("disc-oblique", "", 0.02, OBLIQUE), (BEAM, "", 0.0006, {}), (BLOCK, "", 0.01, SLIDES), (BLOCK, "", 0.06, {"accuracy": 0.1}),
    (BLOCK, "", 0.16, {"accuracy": 0.2}),
    (PRESSED, '[0, "-0.002*sin(150*t)"]', 0.015, {}), (PRESSED, '[0, "-0.001*min(t/0.003, 1)"]', 0.004, {}), (PRESSED, TABLE, 0.01, {}),
    (STRUCK, '[0, "0.001*sin(500*t)"]', 0.008, {}), (LOADED, "1000*t", 0.04, {}), (LOADED, "500*(1 - cos(60*t))", 0.06, {})],
    ids=["rolls", "held", "slides", "strikes flat", "followed for long", "pressed by a sine", "pressed by a ramp", "pressed by a table", "struck", "loaded", "loaded smoothly"])
def test_a_longer_run_repeats_a_shorter_one(problem, motion, end, entries, tmp_path):
    """A disc that strikes obliquely and rolls on under gravity, a held and loaded beam with a disc
    that slides along it, a block that a body force pulls along the plane, one that strikes flat and
    is followed for 19 and 38, or 51 and 101 transits, a disc that its support presses down or an oscillating plane
    strikes, and a held bar under a growing load: mesh and all rows but the last, which ends at
    end_time, are the same bytes for twice the time."""
    made = scene.load(problem) if problem == "disc-oblique" else scene_of(problem.replace("MOTION", motion), tmp_path)
    short, long = (run.run(made, entries | {"end_time": factor * end}, tmp_path / str(factor), estimate=False) for factor in (1, 2))
    first, second = ((result.folder / "history.csv").read_text().splitlines() for result in (short, long))
    assert len(second) > len(first) > 10 and first[:-1] == second[: len(first) - 1]
    assert (short.folder / "mesh.msh").read_bytes() == (long.folder / "mesh.msh").read_bytes()
    if motion not in ("1000*t",):  # there the penalty of a contact that does not occur
        assert short.scene | {"end_time": 0} == long.scene | {"end_time": 0}
