"""The runs of the verification cases, each set of flags once."""

from functools import cache

import pytest

from . import measure as runs


@pytest.fixture(scope="session")
def measure():
    """measure(script, name=value, ...): what verification/<script>.edp prints with these flags."""
    return runs.measure


@pytest.fixture(scope="session")
def disc(tmp_path_factory):
    """disc(name=value, ...): edp/disc-plane.edp run without Python with these flags; disc(script="disc-block", ...) another."""
    @cache
    def go(**given) -> runs.Outcome:
        return runs.disc(tmp_path_factory.mktemp("disc"), **given)
    return go
