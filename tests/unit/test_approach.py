"""Onsets of contact: bodies that keep others apart, and falls onto bodies that are held."""

import math

import pytest

from ffimpact.scenes.approach import onsets_of
from tests.support.front import scene_of

STACK = """
law = "neohookean"
end_time = 0.01
[[body]]
shape = "disc"
radius = 0.03
rigid = true
mass = 20
position = [0, 0.0551]
velocity = [0, -2]
[[body]]
shape = "rectangle"
width = 0.08
height = 0.02
young = 5e6
nu = 0.45
density = 1200
position = [0, 0.015]
[[body]]
shape = "rectangle"
width = 0.3
height = 0.01
young = 2.1e11
nu = 0.3
density = 7850
position = [0, 0]
[[body.support]]
where = "left"
"""


def test_a_body_in_between_shields_a_pair(tmp_path):
    """A weight reaches the plate under a pad only when the pad is pressed flat; at the side of the
    pad, or where it passes through a corner of it, it reaches the plate itself."""
    for entries, shielded in (({}, True), ({"body__1__position": [0.1, 0.0551]}, False),
                              ({"body__1__position": [0.065, 0.0551]}, False),
                              ({"body__1__velocity": [0, 0], "body__3__velocity": [0, 2], "body__2__velocity": [0, 2],
                                "gravity": 9.81}, True)):
        pairs = {(onset.first, onset.second): onset.shielded for onset in onsets_of(scene_of(STACK, tmp_path, **entries))}
        assert pairs == {pair: shielded and pair == (0, 2) for pair in pairs} and (0, 2) in pairs


def test_the_middle_body_of_a_row_shields_the_outer_ones(tmp_path):
    """Of three balls in a row, in space, the first reaches the last one through the second."""
    text = 'law = "neohookean"\nyoung = 1e6\nnu = 0.3\ndensity = 1e3\nend_time = 0.1\ndimension = "3d"\n'
    for k in range(3):
        text += f'[[body]]\nshape = "ball"\nradius = 0.05\nposition = [{0.11 * k}, 0, 0]\nvelocity = [{3 - 1.4 * k}, 0, 0]\n'
    pairs = {(onset.first, onset.second): onset.shielded for onset in onsets_of(scene_of(text, tmp_path))}
    assert pairs == {(0, 1): False, (0, 2): True, (1, 2): False}


def test_a_fall_onto_a_held_body_ends_in_contact(tmp_path):
    """From rest at the height h: after sqrt(2 h/g), at sqrt(2 g h)."""
    problem = scene_of(STACK, tmp_path, gravity=9.81, body__1__velocity=[0, 0], body__1__position=[0.1, 0.0551])
    fall, = (onset for onset in onsets_of(problem) if (onset.first, onset.second) == (0, 2))
    height = 0.0551 - 0.03 - 0.005
    assert fall.time == pytest.approx(math.sqrt(2 * height / 9.81), rel=1e-6)
    assert fall.closing == pytest.approx(math.sqrt(2 * height * 9.81), rel=1e-6)
