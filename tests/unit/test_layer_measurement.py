"""The measurement of a layered ball: its verdict can fail."""

import pandas as pd
import pytest

from benchmarks import layers


def table(**changed) -> pd.DataFrame:
    """Rows of a coarse and a fine mesh; `changed` are those of the impulse on the fine one."""
    rows = [{"dofs": dofs, "answer": name, "differ": 1e-5, "without core": 0.1} for dofs in (1000, 4000) for name in layers.ANSWERS]
    rows[0]["differ"] = 0.1
    rows[4] |= changed
    return pd.DataFrame(rows)


@pytest.mark.parametrize("changed", [{"differ": 3e-5}, {"without core": 5e-4}])
def test_the_verdict_can_fail(changed):
    """A difference to NGSolve, or no difference to a ball without core. A coarser mesh does not count."""
    assert layers.holds(table()) and "holds" in layers.report(table().assign(ours=1.0, NGSolve=1.0))
    assert not layers.holds(table(**changed)) and "FAILS" in layers.report(table(**changed).assign(ours=1.0, NGSolve=1.0))
    assert not layers.holds(pd.DataFrame())
