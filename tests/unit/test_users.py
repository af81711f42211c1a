"""Tests of the scenes of users: their files, their entries by hand, and a verdict that can fail."""

import math

import pandas as pd
import pytest

from benchmarks import draws, users


@pytest.mark.parametrize("name", users.USERS)
def test_a_scene_of_users_says_what_its_user_wants(name):
    """A comment at the top of each file says what the scene is and what its user wants. The scene
    is accepted, also with the entries by hand, which include the step."""
    first = (draws.OWN / f"{name}.toml").read_text().partition("title")[0]
    assert first.startswith("# ") and "user wants" in " ".join(first.lower().replace("#", " ").split())
    case = users.USERS[name]
    by_hand = case.open().override(case.by_hand)
    assert by_hand.values["dt"] == case.by_hand["dt"] > 0 == case.open().values["dt"]


def test_the_block_under_the_disc_has_the_stiffness_of_its_name():
    """Ratios go from 1 to 1e5. The rigid plane is the limit, with the same disc."""
    discs = []
    for ratio, case in users.RATIOS.items():
        opened = case.open()
        disc, *block = opened.bodies
        discs.append((disc.made_of, *disc.start_velocity))
        assert all(body.made_of.young == ratio * disc.made_of.young for body in block) and len(block) == math.isfinite(ratio)
    assert discs.count(discs[0]) == len(discs) and max(ratio for ratio in users.RATIOS if math.isfinite(ratio)) == 1e5


def table(error: float, setting: str = users.AUTOMATIC, seconds: float = 3.0) -> dict:
    return {"scene": "rod-flat", "setting": setting, "seconds": seconds, "stated %": 1.0, "error %": error, "reference %": 0.1, "message": ""}


def test_an_error_above_the_stated_one_is_counted():
    """The verdict counts errors within the estimate, with the error of the reference added, and the
    time over that by hand."""
    rows = pd.DataFrame([table(1.05), table(1.2, users.BY_HAND, 1.0)])
    assert users.verdict(rows, 2, 1).startswith("1 of 2 runs with automatic steps have ended; 1 of 2 errors are within the stated ones; automatic steps take 3 times")
