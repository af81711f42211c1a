"""make rubber: the verdict can fail, and two runs give a row each and a figure."""

import pandas as pd

from benchmarks import rubber


def table(**changed) -> pd.DataFrame:
    rows = [{"body": "disc", "volume": "projected", "nu": nu, "contact [ms]": ms, "impulse": 1.0, "rebound [m/s]": 1.0, "energy": 1e-11, "CPU [s]": 1.0,
             "outcome": ""} for nu, ms in ((0.45, 4.5), (0.49, 4.4), (0.4999, 4.4))]
    rows[-1] |= changed
    return pd.DataFrame(rows)


def test_the_verdict_can_fail():
    """A failed run, energy drift, a rising contact time and excessive cost each fail; so does a
    difference from NGSolve."""
    assert rubber.holds(table())
    for changed in ({"outcome": "step"}, {"energy": 1e-8}, {"contact [ms]": 4.5}, {"CPU [s]": 1.6}):
        assert not rubber.holds(table(**changed))
    assert rubber.agrees([{"differ": 4e-3}]) and not rubber.agrees([{"differ": 6e-3}])
