"""make rubber: the verdict can fail, and two runs give a row each and a figure."""

import pytest

from benchmarks import rubber


@pytest.mark.robustness
def test_runs_become_rows_and_a_figure(tmp_path, monkeypatch):
    """Both bodies run with the projected volume, and with the plain one where they differ. The
    report ends with the verdict."""
    monkeypatch.setattr(rubber, "BASE", rubber.BASE | {"accuracy": 0.1})
    table = rubber.compare([0.45, 0.499], 60, tmp_path)
    assert len(table) == 6 and (table.outcome == "").all() and (table[table.volume == "projected"].energy < 1e-9).all()
    assert (table["finer [ms]"].notna() == (table.volume == "projected")).all()
    rubber.draw(table, tmp_path / "rubber.png")
    assert (tmp_path / "rubber.png").exists() and "The requirement" in rubber.report(table, []).splitlines()[-1]
