"""make rubber: the verdict can fail, and two runs make a row each and a figure."""

import pandas as pd
import pytest

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


@pytest.mark.robustness
def test_runs_become_rows_and_a_figure(tmp_path, monkeypatch):
    """Both bodies, with the mean volume and plain where they differ; the report ends with the verdict."""
    monkeypatch.setattr(rubber, "BASE", rubber.BASE | {"accuracy": 0.1})
    found = rubber.compare([0.45, 0.499], 60, tmp_path)
    assert len(found) == 6 and (found.outcome == "").all() and (found[found.volume == "projected"].energy < 1e-9).all()
    assert (found["finer [ms]"].notna() == (found.volume == "projected")).all()
    rubber.draw(found, tmp_path / "rubber.png")
    assert (tmp_path / "rubber.png").exists() and "The requirement" in rubber.report(found, []).splitlines()[-1]
