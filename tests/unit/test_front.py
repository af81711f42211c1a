"""Flat strikes: their recognition, and their elements, steps and penalty (front.py)."""

import math

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.scenes import front
from ffimpact.scenes.approach import onsets_of
from tests.support.front import BLOCK, scene_of

BARS = """
accuracy = 0.02
law = "neohookean"
young = 1e6
nu = 0.0
density = 1e3
[[body]]
shape = "rectangle"
width = 0.1
height = 0.05
position = [-0.05, 0]
velocity = [0.1, 0]
[[body]]
shape = "rectangle"
width = 0.2
height = 0.05
position = [0.1, 0]
"""
C = math.sqrt(1e6 / 1e3)


def fronts(problem: scene.Scene) -> list[front.Front]:
    return front.fronts(problem, onsets_of(problem))


def test_a_face_on_a_plane_is_a_flat_strike(tmp_path):
    """Its element size is measured along the normal, and the rise time of the front is the transit
    time of an element."""
    strike, = fronts(scene_of(BLOCK, tmp_path))
    assert strike.crossed == (0,) and strike.sizes[0] == pytest.approx(front.PER_ACCURACY * 0.02 * 0.1)
    assert strike.tau == pytest.approx(strike.sizes[0] / C) and strike.transit == pytest.approx(0.1 / C)
    assert fronts(scene_of(BLOCK, tmp_path, accuracy=0.01))[0].tau == pytest.approx(strike.tau / 2)


@pytest.mark.parametrize("entries", [dict(body__1__angle=1.0, body__1__position=[0, 0.0518]), dict(body__1__velocity=[0.3, 0], gravity=9.81,
                         end_time=0.01), dict(until="rest", gravity=9.81, viscosity=10.0)], ids=["tilted", "set down", "to rest"])
def test_what_is_no_flat_strike(entries, tmp_path):
    """A face that lands on a corner first, a body that is set down, and a run to rest."""
    assert fronts(scene_of(BLOCK, tmp_path, **entries)) == []


def test_a_strike_is_the_same_however_long_it_is_followed(tmp_path):
    """Front, elements and penalty do not depend on end_time. A body that gravity alone makes land is
    set down, in a run of any length; one that falls for some transits strikes."""
    brief, long = (fronts(scene_of(BLOCK, tmp_path, end_time=end))[0] for end in (0.0, 1.0))
    assert (brief.tau, brief.transit, brief.sizes) == (long.tau, long.transit, long.sizes)
    slow = dict(gravity=9.81, end_time=1.0)
    for closing, strikes in ((0.9, 0), (1.1, 1)):
        at = dict(body__1__velocity=[0, -closing * 9.81 * 0.1 / C])
        assert len(fronts(scene_of(BLOCK, tmp_path, **slow, **at))) == strikes


PAD = """
accuracy = 0.02
law = "neohookean"
young = 5e6
nu = 0.3
density = 1e3
end_time = 0.02
[[body]]
name = "pad"
shape = "rectangle"
width = 0.1
height = 0.1
position = [0, 0.06]
[[body]]
name = "weight"
shape = "rectangle"
width = 0.4
height = 0.1
rigid = true
mass = 500
position = [0, 0.161]
velocity = [0, -0.6]
[[body]]
name = "plate"
shape = "rectangle"
width = 0.6
height = 0.02
young = 2e11
position = [0, 0]
support = [{where = "left"}, {where = "right"}]
"""


def test_a_body_that_another_one_shields_is_not_struck(tmp_path):
    """A weight falls flat on a pad that lies on a steel plate. As rigid bodies weight and plate would
    meet later; the pad is in between, so its front alone is resolved."""
    strike, = fronts(scene_of(PAD, tmp_path))
    assert strike.crossed == (0,)


def test_a_tilt_that_closes_before_the_front_has_passed_an_element_is_flat(tmp_path):
    """At a hundred times the speed the late corner lands while the front is in the first element.
    """
    tilted = dict(body__1__angle=1.0, body__1__position=[0, 0.0518])
    assert fronts(scene_of(BLOCK, tmp_path, body__1__velocity=[0, -0.5 * C], **tilted))


@pytest.mark.parametrize("name", ["disc-normal", "disc-oblique", "two-discs", "three-in-a-row", "disc-corner", "block-corner", "balls-3d", "ball-cylinder"])
def test_round_bodies_strike_no_face(name):
    """No built-in scene of round bodies or corners has a front."""
    problem = scene.load(name)
    if problem.bodies:
        assert fronts(problem) == []


def test_two_bars_have_one_front(tmp_path):
    """The shorter bar determines the elements of both."""
    strike, = fronts(scene_of(BARS, tmp_path))
    assert strike.crossed == (0, 1) and strike.sizes[0] == strike.sizes[1] == pytest.approx(front.PER_ACCURACY * 0.02 * 0.1)
    stiff, = fronts(scene_of(BARS, tmp_path, body__2__young=1e8))
    # In equal times waves travel ten times as far.
    assert stiff.sizes[1] == pytest.approx(10 * stiff.sizes[0])


@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_the_penalty_lets_the_front_rise_in_its_time(exponent, tmp_path):
    """At the pressure rho c v of the strike the penetration is v times the rise time. Two bodies
    share it."""
    wall, = fronts(scene_of(BLOCK, tmp_path))
    bodies = scene_of(BLOCK, tmp_path).bodies
    assert wall.penalty(bodies, exponent) * (0.3 * wall.rise)**exponent == pytest.approx(1e3 * C * 0.3)
    assert wall.rise_on(wall.penalty(bodies, exponent), bodies, exponent) == pytest.approx(wall.rise)
    bars, both = fronts(scene_of(BARS, tmp_path))[0], scene_of(BARS, tmp_path).bodies
    assert bars.penalty(both, exponent) * (0.1 * bars.rise)**exponent == pytest.approx(1e3 * C * 0.1 / 2)


def test_the_unknowns_of_a_front_are_limited(tmp_path):
    """The number of elements of a thin plate is bounded."""
    plate = scene_of(BLOCK, tmp_path, body__1__width=2.0, body__1__height=0.02, body__1__position=[0, 0.01], accuracy=0.0001)
    strike, = fronts(plate)
    stretch = front.stretch_of(0, [strike], strike.sizes[0])
    assert 9.5 * 2.0 * 0.02 / stretch / strike.sizes[0]**2 == pytest.approx(front.MOST_UNKNOWNS[2])
    body = plate.bodies[0]
    almost, limit = (body.model_copy(update={"made_of": body.made_of.model_copy(update={"nu": nu})}) for nu in (0.4999, 0.45))
    assert np.isfinite(almost.wave_speed) and almost.wave_speed == limit.wave_speed


def stretch(problem: scene.Scene, k: int = 0) -> float:
    strikes = fronts(problem)
    return front.stretch_of(k, strikes, strikes[0].sizes[k])


def test_elements_are_long_across_a_plane_front(tmp_path):
    """Half the thickness without lateral stress; the less the larger its ratio to that along the
    normal, nu / (1 - nu), and the smaller the accuracy."""
    half, size = 0.05, front.PER_ACCURACY * 0.02 * 0.1
    assert stretch(scene_of(BLOCK, tmp_path)) == pytest.approx(half / size)
    fine = dict(accuracy=0.0064, body__1__nu=0.4)
    size *= 0.0064 / 0.02
    expected = front.ACROSS * (0.0064 / (0.4 / 0.6)**2)**(1 / 3) * half / size
    assert 1 < expected < front.LONGER
    assert stretch(scene_of(BLOCK, tmp_path, **fine)) == pytest.approx(expected)
    assert stretch(scene_of(BLOCK, tmp_path, accuracy=1e-3)) == front.LONGER
    assert [stretch(scene_of(BARS, tmp_path), k) for k in (0, 1)] == pytest.approx([2.5, 2.5])


TRAPEZOID = [[-0.1, 0], [0.1, 0], [0.08, 0.1], [-0.08, 0.1]]


@pytest.mark.parametrize("change", [
    ('shape = "rectangle"\nwidth = 0.2\nheight = 0.1', f'shape = "polygon"\nvertices = {TRAPEZOID}'),
    ("[[obstacle]]", '[[body.load]]\nwhere = "top"\npressure = 10\n[[obstacle]]'),
    ("[[obstacle]]", '[[body]]\nshape = "disc"\nradius = 0.02\nposition = [0, 0.3]\nvelocity = [0, -1]\n[[obstacle]]'),
    ("[[obstacle]]\n", '[[body]]\nshape = "rectangle"\nwidth = 0.6\nheight = 0.1\nposition = [0, -0.05]\n[[obstacle]]\nname = "low"\n'),
    ("height = 0.1", "height = 0.1\nmesh_size = 0.01"),
], ids=["slanted sides", "load", "struck by a disc", "lands on a wider face", "own size"])
def test_no_elements_are_long_where_a_front_does_not_stay_plane(change, tmp_path):
    """Bodies that scatter a front, or that something else deforms, have elements of equal sides."""
    problem = scene_of(BLOCK.replace(*change).replace("point = [0, 0]", "point = [0, -9]" if "low" in change[1] else "point = [0, 0]"), tmp_path)
    assert fronts(problem) and stretch(problem) == 1


def test_the_normal_turns_with_the_body(tmp_path):
    """A block that lands flat on a slope: its elements are long along its own side."""
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    turned = scene_of(BLOCK, tmp_path, body__1__angle=30.0, body__1__position=[-0.05 * s, 0.05 * c], body__1__velocity=[0.3 * s, -0.3 * c],
                      obstacle__1__normal=[-s, c])
    strike, = fronts(turned)
    assert strike.onset.own_normal(0, turned.bodies[0]) == pytest.approx([0, 1]) and stretch(turned) == pytest.approx(stretch(scene_of(BLOCK, tmp_path)))


@pytest.mark.parametrize("value, words", [
    (0.5, "body.1.mesh_stretch: 0.5 is below 1 (accepted: 0, or from 1 to 20)"),
    (21, "body.1.mesh_stretch: 21 is out of range"), ("long", "body.1.mesh_stretch: 'long'")])
def test_other_ratios_are_refused(value, words, tmp_path):
    """The message has the entry, the value and what is accepted."""
    with pytest.raises(BadInput) as error:
        scene_of(BLOCK, tmp_path, body__1__mesh_stretch=value)
    assert str(error.value).startswith(words) and "accepted" in str(error.value)
