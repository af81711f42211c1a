"""V2: rigid obstacles (planes, circles, bowls, polylines), at rest and moving, against closed forms and the identities of a step."""

import pytest

CURVED = ["circle", "bowl"]
CORNERS = ["block", "container", "concave", "convex", "star"]
SHAPES = ["plane", "inclined", *CURVED, *CORNERS]


@pytest.fixture(scope="module")
def found(measure):
    return measure("obstacles")


@pytest.mark.parametrize("shape", SHAPES)
def test_gap_and_normal(found, shape):
    """The gap is the closed form, also deep inside; it is continuous, and the unit normal is its gradient."""
    assert found[f"gap{shape}"] < 1e-14
    assert found[f"stretch{shape}"] < 1 + 1e-9
    assert found[f"unit{shape}"] < 1e-15 and found[f"slope{shape}"] < 1e-7


@pytest.mark.parametrize("shape", SHAPES)
def test_rows_give_the_change_of_the_gap(found, shape):
    """q0 + B d + motion = q1 and the slip along the middle tangent, to round-off, for steps of 1 m down to 1e-9 m, also across corners."""
    assert found[f"begin{shape}"] < 1e-14 and found[f"end{shape}"] < 1e-14
    assert found[f"place{shape}"] < 1e-14 and found[f"slip{shape}"] < 1e-14


@pytest.mark.parametrize("shape", SHAPES)
def test_normal_force_is_along_the_normal_of_the_middle(found, shape):
    """Where a slot stays on one piece B and S are orthogonal; where it changes pieces the rest of B is along the motion."""
    assert found[f"across{shape}"] < 1e-14 and found[f"beside{shape}"] < 1e-13
    assert (found[f"pieces{shape}"] > 0.01) == (shape in CORNERS)


@pytest.mark.parametrize("shape", CURVED)
def test_frictionless_forces_have_no_moment_about_the_centre(found, shape):
    assert found[f"moment{shape}"] < 1e-14


def test_inclined_plane_is_the_level_one_turned(found):
    """Penetrations, normal and tangential motion, moving planes included."""
    assert found["turned"] < 1e-14


def test_work_of_the_obstacles_is_force_times_way(found):
    assert found["work"] < 1e-13


def test_only_slots_within_reach_have_rows(found):
    assert found["within"] == found["expected"] and 0 < found["within"] < found["slots"]
    assert found["touching"] > 0.01 and found["placeNear"] < 1e-14 and found["stray"] == 0
    assert found["size"] == 1 and found["fixed"] == 0
    assert 1 <= found["way"] < 1.5   # of the largest motion, a bound


def test_slots_within_reach_are_found_wherever_the_body_goes(found):
    """On a way to and fro, against obstacles that move to and fro: those whose gap is below the reach, and no others."""
    assert found["none"] == 0 and found["missed"] == 0 and found["most"] < found["slots"]


def test_rows_of_planes_are_built_once(measure):
    """Planes alone, one of them moving: constant rows, those of the trace for y = 0, and exact places."""
    planes = measure("obstacle-planes")
    assert planes["fixed"] == 1 and planes["kept"] == 0 and planes["level"] < 1e-15
    assert planes["gap"] < 1e-14 and planes["place"] < 1e-14 and planes["slip"] < 1e-14


@pytest.mark.parametrize("friction", [0, 1])
def test_energy_of_particles_between_moving_obstacles(measure, friction):
    """Kinetic energy, potential and friction work less the work of the obstacles stay what they were, also across corners, to round-off."""
    flight = measure("obstacle-flight", friction=friction)
    assert flight["hits"] > 400 and flight["corners"] > 5 and flight["work"] > 0.001 and (flight["loss"] > 0.1) == (friction == 1)
    assert flight["residual"] < 1e-12 and flight["balance"] < 1e-12
