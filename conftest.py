"""Which cases of a test run by default: marker few(n) keeps n of them, evenly spread, and leaves the others to make robustness."""

from collections import defaultdict

import pytest


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("few"):
            cases[item.nodeid.partition("[")[0]].append(item)
    for items_of_test in cases.values():
        count = items_of_test[0].get_closest_marker("few").args[0]
        kept = {round(k * (len(items_of_test) - 1) / max(count - 1, 1)) for k in range(count)}
        for k, item in enumerate(items_of_test):
            if k not in kept:
                item.add_marker(pytest.mark.robustness)
