"""Contact's onset is sought once for all levels of an error estimate."""

import pytest

from ffimpact import scene
from ffimpact.scenes.approach import onsets_of, with_discs_aligned


@pytest.mark.parametrize("entries, alike", [
    ({"accuracy": 0.02, "mesh_size": 0.01, "contact.penalty": 1e9, "fields": 0}, True),
    ({"body.1.velocity": [4, 0]}, False), ({"body.2.spin": 5}, False), ({"body.1.radius": 0.04}, False)])  # fmt: skip
def test_scenes_that_move_alike_share_their_onsets(entries, alike):
    """So do the scenes with their discs aligned. Other scenes have other times of contact."""
    first = scene.load("two-discs")
    other = first.override(entries)
    for change in (lambda problem: problem, with_discs_aligned):
        mine, its = onsets_of(change(first)), onsets_of(change(other))
        assert (mine is its) == alike
        assert alike or mine[0].time != its[0].time or mine[0].sliding != its[0].sliding
