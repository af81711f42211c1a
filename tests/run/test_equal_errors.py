"""Run times at equal errors: safe settings, references that must agree, the verdict, the page. No
other program is needed."""

import pandas as pd
import pytest

from benchmarks import equal_errors as equal


@pytest.mark.parametrize("installed, code", [(True, 0), (False, 1)])
def test_page(monkeypatch, tmp_path, capsys, installed, code):
    """The page has the seconds and errors of every program, command, commit and missing programs.
    Without another program it reports no agreement."""
    def once(case, program, point):
        if program not in equal.OWN and not (installed and program == equal.TUNED):
            return None, f"{program} is not installed (pip)"
        off = 1e-4 * (1 + list(case.settings[program]).index(point)) if point in case.settings[program] else 0.0
        return {"dofs": 100, "steps": 10, "impulse": 208.2 * (1 + off), "rebound_vy": 7.394, "imports_seconds": 0.2, "setup_seconds": 0.1, "cpu_seconds": 1.0,
                "process_seconds": 1.3}, ""
    monkeypatch.setattr(equal, "once", once)
    assert equal.main(["normal", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "bench.md")]) == code
    page = (tmp_path / "bench.md").read_text()
    rows = pd.read_csv(tmp_path / "bench.csv")
    assert "Measured by `python -m benchmarks equal-errors normal" in page and "at commit" in page and "[bench-levels.csv](bench-levels.csv)" in page
    assert "getfem, tuned is not installed (pip)" in set(rows.message) and (tmp_path / "bench-references.csv").exists() == installed
    assert (rows[rows.program == equal.OURS].process == 1.3).all() and (tmp_path / "bench.svg").stat().st_size > 5000
    assert f"agree within their bars in {int(installed)} of 1 cases" in page and len(pd.read_csv(tmp_path / "out/equal-errors.csv")) == (21 if installed else 16)
