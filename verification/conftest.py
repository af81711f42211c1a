"""The runs of the verification cases, each set of flags once."""

from functools import cache
from itertools import count

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


@pytest.fixture
def march(tmp_path):
    """march(tables, name=value, ...): edp/bodies.edp run for the scene in these tables."""
    numbers = count()
    return lambda tables, **given: runs.bodies(tmp_path / str(next(numbers)), tables, **given)


@pytest.fixture
def steps(tmp_path):
    """steps(tables): what bodies-steps.edp prints of the scene in these tables."""
    return lambda tables: runs.measure("bodies-steps", **runs.prepared(tmp_path, tables))
