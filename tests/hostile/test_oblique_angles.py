"""make oblique-angles: limits of the theories, verdicts that can fail, wrong input, and impacts of
a disc."""

import pandas as pd
import pytest

from benchmarks import __main__ as measurements
from ffimpact.__main__ import guarded


@pytest.mark.robustness
def test_real_impacts_of_a_stiff_disc(tmp_path, capsys):
    """A stiff disc slides at 20 degrees and rolls at 60 as a rigid one. Table, figure and page
    exist; finished runs are reused."""
    call = ["oblique-angles", "--bodies", "disc", "--kinds", "stiff", "--angles", "60,20", "--friction", "0.2", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "page.md")]
    assert guarded(measurements.main, call) == 0
    out = capsys.readouterr().out
    table = pd.read_csv(tmp_path / "out/oblique-angles.csv")
    assert table.angle.tolist() == [20, 60] and table.verdict.tolist() == ["agrees"] * 2 and table.psi_2[0] > 4 and abs(table.psi_2[1]) < 0.05
    assert (table.psi_2_error < 0.05).all() and (tmp_path / "out/oblique-angles.png").stat().st_size > 5000
    assert "2 of 2 runs with a theory agree with it" in out and "python -m benchmarks oblique-angles --bodies disc" in (tmp_path / "page.md").read_text()
    made = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("summary.json")}
    assert len(made) == 4 and guarded(measurements.main, call) == 0 and made == {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("summary.json")}
