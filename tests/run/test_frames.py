"""Results and their error estimates do not depend on the reference frame of a scene."""

import math
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.running.run import run
from ffimpact.scene import read

ANSWERS = ("impulse", "contact_time", "thresholded_contact_time", "peak_force", "friction_work", "vibration_energy", "max_pressure", "max_von_mises", "dofs", "steps")
MATERIAL = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722.0, "accuracy": 0.1}
ON_PLANE = MATERIAL | {"body": [{"shape": "rectangle", "width": 0.1, "height": 0.06, "position": [0.0, 0.04], "velocity": [1.0, -3.0], "angle": 10.0}],
                       "obstacle": [{"kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}], "contact": {"friction_static": 0.4}, "end_time": 0.005}
FRAMES = {"at 60 m/s": {"drift": (48.0, -36.0)}, "turned and 1 km away": {"turn": 37.0, "shift": (800.0, -600.0)}}


def seen(tables: dict, turn: float = 0.0, drift=(0.0, 0.0), shift=(0.0, 0.0)) -> dict:
    """The tables of a scene rotated [deg], moved [m] and moving [m/s]. Discs, which look alike in
    all directions, keep their angle."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    R = np.array([[c, -s], [s, c]])
    def moved(table: dict) -> dict:
        places = {key: (R @ table[key] + shift).tolist() for key in ("position", "point") if key in table}
        normal = {"normal": (R @ table["normal"]).tolist()} if "normal" in table else {}
        angle = {"angle": table.get("angle", 0.0) + turn} if table.get("shape") == "rectangle" else {}
        return table | places | normal | angle | {"velocity": (R @ table.get("velocity", (0.0, 0.0)) + drift).tolist()}
    return tables | {key: [moved(table) for table in tables[key]] for key in ("body", "obstacle") if key in tables}


def numbers_of(tables: dict, folder: Path) -> dict[str, float]:
    summary = run(read(tables, folder, "frames"), {"fields": 0}, folder).summary
    spins = {name: value for name, value in summary.items() if name.startswith("rebound_spin")}
    return {name: summary[name] for name in ANSWERS} | spins | {f"error of {name}": value for name, value in summary["estimated_error"].items()}


@pytest.mark.few(1)
@pytest.mark.parametrize("tables", [scene.load("two-discs").content | {"accuracy": 0.1}, ON_PLANE], ids=["two discs", "a body on a plane"])
def test_no_answer_and_no_stated_error_depends_on_the_frame(tables, tmp_path):
    """At 60 m/s, and rotated by 37 degrees at a distance of 1 km, a scene has the same results and
    error estimates as at rest, to 1e-3."""
    at_rest = numbers_of(tables, tmp_path / "at rest")
    assert at_rest["error of rebound"] > 0 and at_rest["friction_work"] > 0
    for name, frame in FRAMES.items():
        assert numbers_of(seen(tables, **frame), tmp_path / name) == pytest.approx(at_rest, rel=1e-3, abs=1e-9), name


def test_a_disc_is_meshed_finely_where_it_touches_whatever_its_angle(tmp_path):
    """A disc comes into contact with its lowest point. The angle in the scene has no effect."""
    from ffimpact.scenes import approach
    for angle in (0.0, 50.0):
        problem = approach.with_discs_aligned(read(seen(scene.load("two-discs").content | {"body": [body | {"angle": angle} for body in scene.load("two-discs").content["body"]]}), tmp_path, "x"))
        met, = approach.onsets_of(problem)
        touching = problem.bodies[0].start_position * 0 - met.normal
        assert problem.bodies[0].start_angle - math.pi / 2 == pytest.approx(math.atan2(touching[1], touching[0]), abs=1e-6)
        assert met.closing == pytest.approx(6 * math.sqrt(1 - 0.2**2), rel=1e-7) and met.sliding == pytest.approx(6 * 0.2, rel=1e-6)


SHAPES = [{"shape": "disc", "radius": 0.05}, {"shape": "ring", "radius": 0.05, "inner_radius": 0.03}, {"shape": "polygon", "vertices": [[0, 0], [0.07, 0.01], [0.05, 0.06], [0.02, 0.04]]},
          {"shape": "box", "width": 0.05, "height": 0.07, "depth": 0.04, "turn": [10, 0, 20]}, {"shape": "cylinder", "radius": 0.03, "height": 0.07, "turn": [10, 0, 20]}]
# Powers of a length.
POWERS = {"position": 1, "velocity": 1, "radius": 1, "inner_radius": 1, "width": 1, "height": 1, "depth": 1, "vertices": 1, "gravity": 1, "young": -1, "density": -3}


def in_unit(tables: dict, metre: int) -> dict:
    """The same tables with a unit of length of which `metre` make a metre."""
    def times(value, factor: float):
        return [times(component, factor) for component in value] if isinstance(value, list) else float(f"{value * factor:.12g}")
    return {key: times(value, metre**POWERS[key]) if key in POWERS else value for key, value in tables.items()}


@pytest.mark.few(2)
@pytest.mark.parametrize("shape", SHAPES, ids=[shape["shape"] for shape in SHAPES])
def test_no_mesh_depends_on_the_unit_of_length(shape, tmp_path):
    """In metres, centimetres and millimetres a body has the same mesh except for round-off."""
    from ffimpact.scenes import approach, assembly
    solid, node_sets = shape["shape"] in ("box", "cylinder"), []
    body = shape | {"position": [0.0, 0.07, 0.0][:3 if solid else 2], "velocity": [0.3, -2.0, 0.0][:3 if solid else 2]}
    floor = {"kind": "plane", "point": [0.0, 0.0, 0.0][:len(body["position"])], "normal": [0.0, 1.0, 0.0][:len(body["position"])]}
    for metre in (1, 100, 1000):
        tables = in_unit(MATERIAL | {"gravity": 9.81}, metre) | {"body": [in_unit(body, metre)], "obstacle": [floor], "dimension": "3d" if solid else "plane-strain"}
        tables = approach.with_discs_aligned(read(tables, tmp_path, "unit"))
        node_sets.append(assembly.assemble(tables, onsets=approach.onsets_of(tables)).mesh.points / metre)
    assert node_sets[1].shape == node_sets[0].shape == node_sets[2].shape
    assert max(abs(nodes - node_sets[0]).max() for nodes in node_sets) < 1e-12
