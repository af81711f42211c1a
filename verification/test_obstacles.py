"""V2: rigid obstacles (planes, circles, hollow circles, polylines, expressions), at rest and
moving.

They are compared with closed forms and the identities of a step.
"""

import numpy as np
import pandas as pd
import pytest

from . import measure as runs

CURVED = ["circle", "bowl"]
CORNERS = ["block", "container", "concave", "convex", "star"]
IMPLICIT = ["planeImplicit", "circleImplicit"]
SHAPES = ["plane", "inclined", *CURVED, *CORNERS, *IMPLICIT]


@pytest.fixture(scope="module")
def numbers(measure):
    return measure("obstacles")


@pytest.mark.few(4)
@pytest.mark.parametrize("shape", SHAPES)
def test_gap_and_normal(numbers, shape):
    """The gap agrees with the closed form, also far inside. It is continuous, and the unit normal
    is its gradient."""
    assert numbers[f"gap{shape}"] < 1e-14
    assert numbers[f"stretch{shape}"] < 1 + 1e-9
    assert numbers[f"unit{shape}"] < 1e-15 and numbers[f"slope{shape}"] < 1e-7


@pytest.mark.parametrize("shape", SHAPES)
def test_rows_give_the_change_of_the_gap(numbers, shape):
    """q0 + B d + motion = q1 and the slip along the middle tangent are exact to round-off for steps
    of 1 m to 1e-9 m, also across corners. Normals of expressions are iterated to 1e-12."""
    assert numbers[f"begin{shape}"] < 1e-14 and numbers[f"end{shape}"] < 1e-14
    assert numbers[f"place{shape}"] < 1e-14 and numbers[f"slip{shape}"] < (1e-12 if shape in IMPLICIT else 1e-14)


@pytest.mark.parametrize("shape", SHAPES)
def test_normal_force_is_along_the_normal_of_the_middle(numbers, shape):
    """The gap Jacobian B and the slip Jacobian S are orthogonal if a contact candidate stays on one
    plane or round segment.

    If it changes segments, or the segment is neither flat nor round, the remainder of B is along
    the motion.
    """
    assert numbers[f"across{shape}"] < (1e-12 if shape in IMPLICIT else 1e-14) and numbers[f"beside{shape}"] < (1e-12 if shape in IMPLICIT else 1e-13)
    assert (numbers[f"pieces{shape}"] > 0.01) == (shape in [*CORNERS, "circleImplicit"])


@pytest.mark.parametrize("shape", CURVED)
def test_frictionless_forces_have_no_moment_about_the_centre(numbers, shape):
    assert numbers[f"moment{shape}"] < 1e-14


def test_inclined_plane_is_the_level_one_turned(numbers):
    """Penetrations, normal and tangential motion agree, also for moving planes."""
    assert numbers["turned"] < 1e-14


def test_work_of_the_obstacles_is_force_times_way(numbers):
    assert numbers["work"] < 1e-13


def test_only_slots_within_reach_have_rows(numbers):
    assert numbers["within"] == numbers["expected"] and 0 < numbers["within"] < numbers["slots"]
    assert numbers["touching"] > 0.01 and numbers["placeNear"] < 1e-14 and numbers["stray"] == 0
    assert numbers["size"] == 1 and numbers["fixed"] == 0
    # An upper bound of the largest motion.
    assert 1 <= numbers["way"] < 1.5


def test_slots_within_reach_are_found_wherever_the_body_goes(numbers):
    """While the body and the obstacles move to and fro, exactly the contact candidates with a gap
    below the search distance are found."""
    assert numbers["none"] == 0 and numbers["missed"] == 0 and numbers["most"] < numbers["slots"]


def test_rows_of_planes_are_built_once(measure):
    """Planes, both of them moving, have constant Jacobians that satisfy the same identities."""
    planes = measure("obstacles", planes=1)
    assert planes["fixed"] == 1 and planes["kept"] == 0
    for shape in ("plane", "inclined"):
        assert max(planes[name + shape] for name in ("gap", "begin", "end", "place", "slip")) < 1e-14 and planes[f"across{shape}"] < 1e-14


@pytest.mark.few(1)
@pytest.mark.parametrize("friction", [0, 1])
def test_energy_of_particles_between_moving_obstacles(measure, friction):
    """Kinetic energy, potential and friction work minus the work of the obstacles are constant to
    round-off, also across corners."""
    flight = measure("obstacle-flight", friction=friction)
    assert flight["hits"] > 400 and flight["corners"] > 5 and flight["work"] > 0.001 and (flight["loss"] > 0.1) == (friction == 1)
    assert flight["residual"] < 1e-12 and flight["balance"] < 1e-12


def falling(obstacle, **body):
    """A scene with a disc that hits an obstacle with friction."""
    return {"law": "svk", "young": 7e6, "nu": 0.4, "density": 1722, "accuracy": 0.05, "obstacle": [{"name": "floor"} | obstacle], "contact": {"friction_static": 0.3},
            "body": [{"name": "disc", "shape": "disc", "radius": 0.05, "position": [0.006, 0.053], "velocity": [0.5, -3]} | body]}


@pytest.mark.parametrize("position, kind, distance", [
    ([0.006, 0.053], {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, "2*y"),
    ([0.01, 0.153], {"kind": "circle", "centre": [0, 0], "radius": 0.1, "velocity": [0.1, 0.05]}, "x*x + y*y - 0.01")])
def test_an_expression_of_a_plane_or_circle_is_one(march, position, kind, distance):
    """The history equals that of the built-in kind, including mesh, flight and onset of contact.

    Only the built-in kind includes penetrations between contact points in the largest penetration.
    """
    expression = {key: value for key, value in kind.items() if key == "velocity"} | {"kind": "implicit", "distance": distance}
    reference, other = (march(falling(obstacle, position=position)) for obstacle in (kind, expression))
    for column in set(reference.history) - {"balance", "newton_iterations", "sliding_fraction", "max_penetration"}:
        # Points with a force below round-off are counted, too.
        pressed = reference.history["normal_force"] > (
            1e-6 * max(reference.history["normal_force"]) if column.startswith("contact_") else -1)
        ours, theirs = (np.asarray(run.history[column])[pressed] for run in (other, reference))
        assert ours == pytest.approx(theirs, rel=1e-6, abs=1e-6 * abs(theirs).max()), column


def test_a_disc_on_a_wavy_floor_keeps_energy_and_momentum(march, tmp_path):
    """The energy is constant to 1e-9 of its initial value. The change of momentum of the disc is
    the impulse of the floor."""
    result = march(falling({"kind": "implicit", "distance": "y - 0.002*sin(200*x)"}))
    impulse = pd.read_csv(next(tmp_path.glob("**/contacts.csv")), comment="#")
    assert result.summary["energy_drift"] < 1e-9 and result.summary["contact_time"] > 1e-3
    for axis in "xy":
        momentum = np.asarray(result.history[f"momentum_{axis}"])
        assert momentum[-1] - momentum[0] == pytest.approx(impulse[f"impulse_{axis}"].sum(), abs=1e-8 * abs(momentum).max())


@pytest.mark.robustness
def test_a_dish_of_revolution_is_the_same_in_space(tmp_path):
    """A ball in a paraboloid of revolution, axisymmetric and as a quarter in three dimensions:
    impulse within 1 %, energy to 1e-9."""
    ball = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "accuracy": 0.1}
    shape = {"name": "ball", "shape": "ball", "radius": 0.05}
    results = [runs.bodies(tmp_path / dimension, ball | {"dimension": dimension, "body": [shape | place], "obstacle": [{"kind": "implicit", "distance": distance}]})
               for dimension, place, distance in (("axisymmetric", {"position": 0.06, "velocity": -3}, "y - 2*x^2"),
                                                  ("3d", {"position": [0, 0.06, 0], "velocity": [0, -3, 0]}, "y - 2*(x^2 + z^2)"))]
    assert results[1].summary["impulse"] == pytest.approx(results[0].summary["impulse"], rel=0.01)
    assert all(result.summary["energy_drift"] < 1e-9 for result in results)
