"""What the contact points of a pair bore, from the recorded steps."""

from types import SimpleNamespace

import numpy as np
import pytest

from ffimpact.output.points import corner_share, of_pairs, whole_load

PAIR = {"body": 0, "counter_body": -1, "between": 3e-4}
OTHER = {"body": 0, "counter_body": -2, "between": 0.0}


def interval(pair: dict, start: float, *steps: tuple[float, ...]) -> SimpleNamespace:
    """Steps of 1 ms from `start` on: load, points, depth, share of corners, both sides pressed."""
    rows = np.zeros((len(steps), 41))
    rows[:, 1] = start + 1e-3 * (np.arange(len(steps)) + 0.5)
    rows[:, 2] = 1e-3
    rows[:, 36:] = steps
    return SimpleNamespace(pair=pair, rows=rows, step=rows[:, 2])


def test_points_under_the_largest_load():
    """They are those of the step with the largest load, of all intervals of the pair; the deepest is
    between the points, where that is more."""
    intervals = [interval(PAIR, 0, (5, 3, 1e-4, 0, 0), (9, 6, 2e-4, 0, 0)), interval(OTHER, 0, (20, 9, 5e-4, 0, 0)), interval(PAIR, 1, (7, 12, 1e-4, 0, 0))]
    first, second, third = of_pairs([PAIR, OTHER, {"body": 1, "counter_body": -1, "between": 0.0}], intervals)
    assert (first["peak"], first["points_at_peak"], first["at_points"], first["deepest"]) == (9, 6, 2e-4, 3e-4)
    assert (second["peak"], second["points_at_peak"], second["deepest"]) == (20, 9, 5e-4)
    assert (third["peak"], third["points_at_peak"], third["at_points"], third["deepest"]) == (0, 0, 0, 0)
    assert whole_load(intervals) == pytest.approx(0.041)


@pytest.mark.parametrize("first, pressed, pause, share", [
    (0.8, 1, 1e-3, 1), (0.7, 1, 1e-3, 0), (0.8, 0, 1e-3, 0), (0.8, 1, 5e-3, 0.25)],
    ids=["at a corner", "beside it", "one side", "a second contact"])
def test_share_of_contacts_that_begin_at_a_corner(first, pressed, pause, share):
    """The whole contact counts, over a pause shorter than a wave's transit, if its first step is on
    facets with a corner and both sides are pressed at some time."""
    intervals = [interval(PAIR, 0, (1, 2, 0, first, pressed)), interval(PAIR, 1e-3 + pause, (3, 9, 0, 0.1, 0))]
    assert corner_share([PAIR], intervals, 2e-3) == pytest.approx(share)
    assert corner_share([PAIR], [], 2e-3) is None
