"""Fixtures that run the verification scripts. Each set of flags runs once."""

from functools import cache
from itertools import count

import pytest

from . import measure as runs


@pytest.fixture(scope="session")
def measure():
    """measure(script, name=value, ...): the numbers that verification/<script>.edp prints with
    these flags."""
    return runs.measure


@pytest.fixture(scope="session")
def disc(tmp_path_factory):
    """disc(name=value, ...): the impact of a disc with these entries (measure.impact());
    disc(kind="disc-block", ...): that of another body."""
    @cache
    def go(**flags) -> runs.Outcome:
        return runs.disc(tmp_path_factory.mktemp("disc"), **flags)
    return go


@pytest.fixture
def march(tmp_path):
    """march(tables, name=value, ...): a run of edp/program/bodies.edp for the scene in these tables."""
    numbers = count()
    return lambda tables, **flags: runs.bodies(tmp_path / str(next(numbers)), tables, **flags)


@pytest.fixture
def steps(tmp_path):
    """steps(tables): the numbers that bodies-steps.edp prints for the scene in these tables."""
    return lambda tables: runs.measure("bodies-steps", **runs.prepared(tmp_path, tables))
