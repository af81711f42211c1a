"""Obstacles given by an expression of their signed distance: accepted expressions, the program, the
gap."""

from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.geometry import implicit
from ffimpact.scenes import approach

POINTS = np.random.default_rng(1).uniform(-0.3, 0.3, (500, 2))


def settled(text, centre=(0.0, 0.05), half=0.1):
    return implicit.settled("obstacle.1", implicit.program("obstacle.1.distance", text, "xyz"[:len(centre)]), np.array(centre), half)


@pytest.mark.parametrize("text, value", [
    ("y - 0.002*sin(200*x)", lambda x, y: y - 0.002 * np.sin(200 * x)), ("-x^2 + 3*-y", lambda x, y: -x**2 - 3 * y),
    ("2^-1*(x - y)/(1 + x*x)", lambda x, y: 0.5 * (x - y) / (1 + x * x)), ("max(abs(x), min(y, 0.1)) - 1e-2", lambda x, y: np.maximum(abs(x), np.minimum(y, 0.1)) - 0.01),
    ("sqrt(x^2+y^2+1) - exp(cos(x))", lambda x, y: np.sqrt(x**2 + y**2 + 1) - np.exp(np.cos(x)))])
def test_a_program_is_its_expression(text, value):
    """Value and gradient; the gradient agrees with central differences."""
    code = implicit.program("obstacle.1.distance", text, "xy")
    values, slope = implicit.run(code, POINTS)
    assert values == pytest.approx(value(*POINTS.T), rel=1e-13, abs=1e-15)
    for axis, step in enumerate(1e-6 * np.eye(2)):
        assert slope[:, axis] == pytest.approx((value(*(POINTS + step).T) - value(*(POINTS - step).T)) / 2e-6, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("text, wrong", [
    ("y - z", "'z' in 'y - z' is not known"), ("__import__('os').system('id')", "is not known"), ("y if x else 1", "is not known"), ("y - ", "'y - ' is no expression"),
    ("tan(x)", "'tan(x)' in 'tan(x)' is not known"), ("sin(x, y)", "'sin(x, y)' in 'sin(x, y)' is not known"), ("2^x", "'^ x' in '2^x' is not known"),
    ("y + True", "'True' in 'y + True' is not known"), ("y; x", "is no expression"), ("", "is no expression"), (3, "'3' is no expression"), (None, "is missing"),
    ("(" * 400 + "y" + ")" * 400, "is no expression"), ("y+" * 600 + "y", "1201 characters (accepted: up to 1000)"), ("x[0]", "is not known"), ("y := 1", "is no expression")])
def test_other_text_is_refused_in_one_line(text, wrong):
    """Only numbers, coordinates, the four operations, powers with numbers and the listed functions
    are accepted."""
    with pytest.raises(BadInput, match=r"^obstacle\.1\.distance: ") as error:
        implicit.program("obstacle.1.distance", text, "xy")
    assert wrong in str(error.value) and "(accepted: " in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("text, wrong", [("1 + x^2", "no zero was found within"), ("sqrt(y)", "has no value or no gradient at")])
def test_expressions_without_a_surface_are_refused(text, wrong):
    with pytest.raises(BadInput, match=wrong):
        settled(text)


@pytest.mark.parametrize("text", ["sqrt(x^2 + y^2) - 0.1", "x*x + y*y - 0.01", "5*(x^2 + y^2 - 0.01)"])
def test_the_gap_is_the_distance(text):
    """This holds for any expression with the same zeros. Beyond `limit` the gap is at most the
    distance.

    The limit is a third of the radius of curvature.
    """
    numbers = settled(text)
    gaps, exact = implicit.gap(POINTS, numbers), np.linalg.norm(POINTS, axis=1) - 0.1
    near = abs(exact) < 0.02
    assert numbers[0] == pytest.approx(0.1 / 3, rel=1e-3) and near.any()
    assert gaps[near] == pytest.approx(exact[near], abs=1e-15) and (abs(gaps) <= abs(exact) + 1e-15).all() and (gaps * exact >= 0).all()
    assert implicit.radius_at(np.array([0.0, 0.11]), numbers) == pytest.approx(0.1, rel=1e-5)
    assert implicit.radius_at(np.array([0.0, 0.09]), settled("0.01 - x*x - y*y", (0.0, 0.0), 0.05)) == np.inf


@pytest.mark.parametrize("radius", [0.01, 0.03, 0.06])
@pytest.mark.parametrize("degrees", [40, 75, 90])
def test_nearest_point_of_a_disc(radius, degrees):
    """A disc of radius 0.05 beside a circle, also a smaller one: gap and normal are on the line between
    the centres."""
    along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    centre, turns = (radius + 0.0501) * along, np.linspace(0, 2 * np.pi, 181)
    points = centre + 0.05 * np.column_stack([np.cos(turns), np.sin(turns)])
    limit, *code = numbers = settled(f"x^2 + y^2 - {radius**2}", tuple(centre), 0.05)
    gaps = implicit.gap(points, numbers)
    gap, normal = implicit.nearest(points[gaps.argmin()], gaps.min(), code, limit, (centre, 0.05))
    assert gap == pytest.approx(1e-4, abs=1e-12) and normal == pytest.approx(along, abs=1e-6)


@pytest.mark.parametrize("text, centre", [("y - sqrt(x^2 + 1e-10)", (0.0, 0.05)),
                                          ("y - sqrt(x^2 + z^2 + 1e-10)", (0.0, 0.05, 0.0)),
                                          ("y - sqrt(x^2 + 1e-10)", (0.0, 0.05, 0.0))])
def test_the_closest_point_is_not_the_bottom_of_a_groove(text, centre):
    """Above the narrow bottom of a funnel or groove the walls are nearer than the bottom.

    This also holds exactly above it, where the bottom is a stationary point of the distance.
    """
    numbers, points = settled(text, centre), np.zeros((3, len(centre)))
    points[:, 1] = numbers[0] * np.array([0.1, 0.5, 0.9])  # the walls are within `limit`
    distance = points[:, 1] / np.sqrt(2)
    assert numbers[0] > 1e-3 and implicit.gap(points, numbers) == pytest.approx(distance, abs=1e-6)


def test_an_expression_that_is_no_distance_far_away():
    """exp(y/c) - 1 gives a distance of about c everywhere above, and overflows. Gaps are at most
    the distance and positive."""
    numbers = settled("exp(y/0.02) - 1")
    heights = np.array([1e-3, 0.09, 0.5, 3.0, 30.0, 1e5])
    gaps = implicit.gap(np.column_stack([0 * heights, heights]), numbers)
    assert gaps[:2] == pytest.approx(heights[:2]) and (0 < gaps).all() and (gaps <= heights + 1e-15).all()


EXPRESSIONS = ["y - 0.1*sin(7*x)", "x^2 + y^2 - 0.01", "(x^4 + y^4)^0.25 - 0.3", "x*y/(1 + x^2) - 0.2", "min(y, 200*(abs(x - 0.5) - 0.1))",
               "max(abs(x) - 0.2, abs(y) - 0.4)", "exp(3*y) - 1 + cos(x)/4", "sqrt(x^2 + 0.01) - y^3", "2*x - x^2 - y"]


@pytest.mark.parametrize("text", EXPRESSIONS)
def test_boxes_without_a_zero_have_none(text):
    """Interval arithmetic never excludes a zero that is there: in every excluded box D has one sign."""
    code, random = implicit.program("obstacle.1.distance", text, "xy"), np.random.default_rng(3)
    centres, half = random.uniform(-1, 1, (300, 2)), 10 ** random.uniform(-3, 0, 300)
    excluded = implicit.no_zero(code, centres, half)
    assert 20 < excluded.sum() < 300
    for centre, width in zip(centres[excluded], half[excluded]):
        value = implicit.run(code, centre + width * random.uniform(-1, 1, (200, 2)))[0]
        assert (value > 0).all() or (value < 0).all()


def test_a_wall_far_from_the_start_is_seen():
    """The scale of an operand of min changes no gap: that of a thin wall, steep and 5 m away."""
    points = np.array([[4.9, 0.06], [4.99, 0.3], [4.999, 0.05], [2.0, 0.05]])
    steep, plain = (implicit.gap(points, settled(f"min(y, {factor}*(abs(x - 5) - 0.0005))", (0.0, 0.1), 0.1)) for factor in (200, 1))
    assert steep == pytest.approx(plain, abs=1e-12) and steep[2] == pytest.approx(5e-4, abs=1e-9)


def test_a_far_surface_is_found():
    """A circle 50 m below, of radius 0.2 m."""
    numbers = settled("x^2 + (y + 0.2)^2 - 0.04", (0.0, 50.05), 0.1)
    assert implicit.gap(np.array([[0.0, 0.001]]), numbers) == pytest.approx([0.001], abs=1e-9)


@pytest.mark.parametrize("text, axes", [("y - 0.006*sin(60*x)", 2), ("min(y, x^2 + (y-1)^2 - 0.04)", 2), ("sqrt(x^2 + y^2 + z^2) - 0.3", 3)])
def test_the_least_gap_is_the_smallest_of_all(text, axes):
    """Near the surface, far from it, beside it and across it. The number is that of the point."""
    numbers = implicit.settled("obstacle.1", implicit.program("distance", text, "xyz"[:axes]), np.array([0.0, 0.3, 0.0][:axes]), 1.0)
    random = np.random.default_rng(0)
    for size in np.logspace(-3, 5, 40):
        points = size * random.normal(size=axes) + min(size, 0.1) * random.normal(size=(50, axes))
        gaps, (gap, number) = implicit.gap(points, numbers), implicit.least(points, numbers)
        assert gap == gaps.min() == gaps[number]


def test_a_body_that_flies_away_is_soon_out_of_reach(monkeypatch):
    """An ellipse strikes a wave and turns: the search for further contacts ends after some hundred
    gaps."""
    calls = []
    monkeypatch.setattr(implicit, "least", lambda *shapes, least=implicit.least: calls.append(shapes) or least(*shapes))
    ellipse = {"shape": "ellipse", "semi_axes": [0.06, 0.035], "angle": 25, "position": [0.004, 0.0565], "velocity": [2, -5]}
    content = {"law": "neohookean", "young": 7e6, "nu": 0.45, "density": 1722, "body": [ellipse],
               "obstacle": [{"kind": "implicit", "distance": "y - 0.006*sin(60*x)"}]}
    onset, = approach.onsets_of(scene.read(content, Path(), "wave"))
    assert onset.time == pytest.approx(3.1518e-3, rel=1e-4) and len(calls) < 200
