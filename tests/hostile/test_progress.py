"""The display of progress: one line with nested parts, and a sentence about long runs."""

import pytest

from ffimpact.freefem import freefem
from verification.measure import impact, prepared


@pytest.mark.robustness
@pytest.mark.parametrize("kind, values", [("disc", {"accuracy": 0.01, "dt": 5e-6}), ("disc-block", {"accuracy": 0.03, "dt": 1e-5, "end_time": 3e-3})])
def test_scripts_report_the_share_of_their_steps(tmp_path, kind, values):
    """Near half of its steps a script reports this share, to a fifth, with the unknowns."""
    seen, flags = [], prepared(tmp_path, impact(kind, **values)) | {"out": tmp_path / "out"}
    assert freefem.run(freefem.find(), "edp/program/bodies.edp", flags, tmp_path / "log.txt", seen.append)[0] == 0
    taken = (tmp_path / "out/history.csv").read_text().count("\n") - 2
    middle = min(seen, key=lambda at: abs(at.steps / taken - 0.5))
    assert middle.share == pytest.approx(middle.steps / taken, abs=0.2) and middle.steps / taken > 0.2
    assert middle.unknowns > 100 and 0 < seen[0].share < 0.3 and 0 < seen[0].t < 1e-3
