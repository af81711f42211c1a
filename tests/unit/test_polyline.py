"""Polylines as obstacles: accepted chains, and their signed distance."""

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.geometry import polyline

SQUARE = [[0, 0], [0, 1], [1, 1], [1, 0]]  # clockwise
# clockwise, with a thin neck
NECK = [[0, 0], [0, 1], [1, 1], [1, 0.55], [2, 0.55], [2, 1], [3, 1], [3, 0], [2, 0], [2, 0.45], [1, 0.45], [1, 0]]
POINTS = np.random.default_rng(1).uniform(-2, 3, (2000, 2))


def distance(vertices, closed, rounding=0.0, points=POINTS):
    return polyline.gap(points, polyline.numbers(np.array(vertices, float), closed, rounding))


def square(points, rounding=0.0):
    """The closed form for the block [0, 1] x [0, 1]."""
    q = abs(points - 0.5) - 0.5
    return np.hypot(*np.maximum(q, 0).T) + np.minimum(q.max(axis=1), 0) - rounding


def test_clockwise_is_a_block_and_counter_clockwise_a_container():
    """The free side is to the left of the direction of travel. Rounding reduces the gap in both
    directions."""
    assert distance(SQUARE, True, 0.1) == pytest.approx(square(POINTS, 0.1), abs=1e-14)
    assert distance(SQUARE[::-1], True, 0.1) == pytest.approx(-square(POINTS) - 0.1, abs=1e-14)


def test_open_chains_go_straight_on_beyond_their_ends():
    """Two vertices are a plane, whatever their distance. Three are a quadrant with a convex or
    concave corner."""
    x, y = POINTS.T
    assert distance([[0, 0.5], [1e-3, 0.5]], False) == pytest.approx(y - 0.5, abs=1e-12)
    corner = np.where((x < 0) & (y < 0), -np.hypot(x, y), np.minimum(x, y))
    assert distance([[0, 1], [0, 0], [1, 0]], False) == pytest.approx(corner, abs=1e-14)
    assert distance([[1, 0], [0, 0], [0, 1]], False) == pytest.approx(-corner, abs=1e-14)


def filleted(vertices, closed, radius, points=POINTS):
    moved = polyline.inset("fillet", np.array(vertices, float), closed, radius)
    return polyline.gap(points, polyline.numbers(moved, closed, radius))


def test_a_fillet_cuts_corners_and_leaves_the_sides():
    """A block with rounded corners, in closed form; concave corners of a container stay. The
    corner of an open chain is rounded at any radius."""
    q = abs(POINTS - 0.5) - 0.5 + 0.2
    block = np.hypot(*np.maximum(q, 0).T) + np.minimum(q.max(axis=1), 0) - 0.2
    assert filleted(SQUARE, True, 0.2) == pytest.approx(block, abs=1e-14)
    outside = square(POINTS) < 0
    assert filleted(SQUARE[::-1], True, 0.2)[outside] == pytest.approx(-square(POINTS)[outside], abs=1e-14)
    x, y = POINTS.T
    for radius in (0.3, 20.0):
        corner = np.where((x < radius) & (y < radius), radius - np.hypot(x - radius, y - radius), np.minimum(x, y))
        assert filleted([[1, 0], [0, 0], [0, 1]], False, radius) == pytest.approx(-corner, abs=1e-12)


@pytest.mark.parametrize("vertices, closed, radius, words", [
    (SQUARE, True, 0.5, "fillet: 0.5 m is too large for the sides (accepted: below 0.5 m)"),
    ([[-1, 0], [0, 0], [0, 0.1], [1, 0.1]], False, 0.1, "fillet: 0.1 m is too large for the sides (accepted: below 0.1 m)"),
    (NECK, True, 0.1, "fillet: 0.1 m is too large for a solid as thin as this one (accepted: less)")])
def test_fillets_that_do_not_fit(vertices, closed, radius, words):
    with pytest.raises(BadInput) as refused:
        polyline.inset("fillet", np.array(vertices, float), closed, radius)
    assert str(refused.value) == words


def test_numbers_are_those_of_the_scripts():
    assert polyline.numbers(np.array([[0, 1], [2, 3]]), False, 0.5) == (0, 0.5, 0, 1, 2, 3)


@pytest.mark.parametrize("vertices, closed", [
    (SQUARE, True), (SQUARE[::-1], True), ([[0, 0], [1, 0]], False), ([[0, 0], [1, 0], [2, 0], [2, 1]], False),
    ([[0, 1], [0, 0], [1, 0], [1, 1]], False),  # a container with parallel walls
    # A step on a floor: both ends are on one line.
    ([[0, 0], [1, 0], [1, 1], [2, 1], [2, 0], [3, 0]], False)])
def test_chains_that_are_accepted(vertices, closed):
    polyline.check("obstacle.1", np.array(vertices, float), closed)


@pytest.mark.parametrize("vertices, closed, message", [
    ([[0, 0], [1, 0]], True, "obstacle.1.vertices: 2 given (accepted: 3 or more points [x, y] of a closed chain)"),
    ([[0, 0], [1, 0], [1, 0]], False, "obstacle.1.vertices.3: [1, 0] is the vertex before it again (accepted: each vertex once)"),
    ([[0, 0], [0, 0]], False, "obstacle.1.vertices.2: [0, 0] is the vertex before it again (accepted: each vertex once)"),
    ([*SQUARE, [0, 0]], True, "obstacle.1.vertices.5: [0, 0] is the first vertex again (accepted: a closed chain without it)"),
    ([[0, 0], [1, 0], [0.5, 0]], False,
     "obstacle.1.vertices.2: the chain turns back on itself at [1, 0] (accepted: corners of less than 180 degrees)"),
    ([[0, 0], [1, 1], [1, 0], [0, 1]], True,
     "obstacle.1.vertices: side 1 and side 3 meet at [0.5, 0.5] (accepted: a chain that does not cross or touch itself)"),
    ([[0, 0], [0.2, 1], [0.8, 1], [1, 0], [0.8, -0.5]], False,
     "obstacle.1.vertices: side 1 and side 4 meet at [-1, -5] (accepted: a chain that does not cross or touch itself; "
     "an open one goes straight on beyond its ends)"),
    ([[0, 0], [1, 0], [1, 1], [0.5, 1], [0.5, 0], [0.2, 0]], False,
     "obstacle.1.vertices: side 1 and side 4 meet at [0.5, 0] (accepted: a chain that does not cross or touch itself; "
     "an open one goes straight on beyond its ends)")])
def test_chains_that_are_not_accepted(vertices, closed, message):
    """One line with the table and the key, the value and what is accepted."""
    with pytest.raises(BadInput) as error:
        polyline.check("obstacle.1", np.array(vertices, float), closed)
    assert str(error.value) == message
