"""Selects the test cases that run by default.

The marker few(n) keeps n cases of a test, evenly spread. The others, and all of tests/hostile, run
with `make robustness`.
"""

import os
from collections import defaultdict
from pathlib import Path

import pytest

pytest.register_assert_rewrite("tests.support", "verification.stress", "verification.tangents")
HOSTILE = Path(__file__).parent / "tests/hostile"


def pytest_ignore_collect(collection_path, config):
    """Leaves out tests/hostile, all of whose tests a run without robustness would drop."""
    left_out = collection_path == HOSTILE and config.option.markexpr == "not robustness"
    return left_out or None


def _same_environment():
    """Overwrites the name of the present test: for each new environment FreeFem++ is sought anew."""
    os.environ["PYTEST_CURRENT_TEST"] = ""


@pytest.hookimpl(tryfirst=True)
def pytest_fixture_setup():
    _same_environment()


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call():
    _same_environment()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    cases = defaultdict(list)
    for item in items:
        if item.path.is_relative_to(HOSTILE):
            item.add_marker(pytest.mark.robustness)
        elif item.get_closest_marker("few"):
            cases[item.nodeid.partition("[")[0]].append(item)
    for items_of_test in cases.values():
        count = items_of_test[0].get_closest_marker("few").args[0]
        kept = {round(k * (len(items_of_test) - 1) / max(count - 1, 1)) for k in range(count)}
        for k, item in enumerate(items_of_test):
            if k not in kept:
                item.add_marker(pytest.mark.robustness)
