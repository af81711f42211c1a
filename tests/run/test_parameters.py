"""The table of parameters, and the scripts."""

import json

from ffimpact.freefem import freefem


def test_the_first_start_shows_the_version_alone():
    """FreeFem++ starts and finds the plugins."""
    assert set(json.loads(freefem.find().call(freefem.VERSION).stdout)) == {"version"}
