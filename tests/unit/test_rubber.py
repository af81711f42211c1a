"""make rubber: the verdict can fail, and two runs make a row each and a figure."""

import pandas as pd

from benchmarks import rubber


def table(**changed) -> pd.DataFrame:
    rows = [{"body": "disc", "volume": "projected", "nu": nu, "contact [ms]": ms, "impulse": 1.0, "rebound [m/s]": 1.0, "energy": 1e-11, "CPU [s]": 1.0,
             "outcome": ""} for nu, ms in ((0.45, 4.5), (0.49, 4.4), (0.4999, 4.4))]
    rows[-1] |= changed
    return pd.DataFrame(rows)


def test_the_verdict_can_fail():
    """A run that fails, energy that drifts, a contact time that rises and a cost that is too high each do; NGSolve may differ as well."""
    assert rubber.holds(table())
    for changed in ({"outcome": "step"}, {"energy": 1e-8}, {"contact [ms]": 4.5}, {"CPU [s]": 1.6}):
        assert not rubber.holds(table(**changed))
    assert rubber.agrees([{"differ": 4e-3}]) and not rubber.agrees([{"differ": 6e-3}])
