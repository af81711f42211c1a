"""Free flights of rigid bodies of any duration until contact, and the end of a run if no further
contact follows."""

import math

import pytest

from ffimpact.failure import BadInput
from ffimpact.scenes import approach
from tests.support.flights import DISC, FLOOR, read

MISSES = {
    "discs that pass": read(DISC | {"position": [-100, 0.101], "velocity": [1, 0], "spin": 50}, DISC | {"position": [100, 0]}),
    "discs that part": read(DISC | {"position": [-1, 0], "velocity": [-1, 0]}, DISC | {"position": [1, 0]}),
    "falls beside a post": read(DISC | {"position": [0.2, 1], "velocity": [0, 30]}, gravity=9.81, obstacles=({"kind": "circle", "centre": [0, 0], "radius": 0.1},)),
    "along the floor": read(DISC | {"position": [0, 0.06], "velocity": [1, 0]}, obstacles=(FLOOR,)),
}


@pytest.mark.parametrize("case", MISSES)
def test_what_misses_never_touches(case):
    """Bodies that miss each other, be it by a millimetre, have no contact at any time."""
    """Bodies that pass each other by a millimetre are said to miss, those alone."""
    # Pairs are skipped if their bounding spheres stay apart.
    assert all(pair.never for pair in approach.onsets_of(MISSES[case]))


def test_a_body_set_down_is_refused_at_once():
    """A square on the floor, also with a ceiling in contact, never leaves. Without end_time this is
    refused before the computation."""
    square = {"shape": "rectangle", "width": 0.1, "height": 0.1, "position": [0, 0.05]}
    for more in ((), ({"kind": "plane", "point": [0, 0.1], "normal": [0, -1]},)):
        scene = read(square, obstacles=(FLOOR, *more), gravity=9.81)
        with pytest.raises(BadInput, match="end_time: 0 .* 'body1' is set down on 'obstacle1'"):
            approach.refuse_nothing(scene, approach.onsets_of(scene))


def test_corners_that_follow_are_fine():
    """A square that falls on a corner rotates and strikes with the next one: the pair has two
    contacts, the second with another lowest corner."""
    square = {"shape": "rectangle", "width": 0.1, "height": 0.1, "position": [0, 0.08], "angle": 20, "velocity": [0, -2]}
    first, second = approach.onsets_of(read(square, obstacles=(FLOOR,)))
    assert first.time < math.inf and second.closing < first.closing
    x = [pair.outlines[0].points[pair.outlines[0].points[:, 1].argmin(), 0] for pair in (first, second)]
    assert x[0] < -0.02 and x[1] > 0.02
