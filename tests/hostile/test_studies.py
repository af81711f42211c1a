"""Studies: parallel runs that survive failures, time limits and interruption; and difficult
parameters."""

import pytest

from benchmarks import stress


@pytest.mark.robustness
def test_stress_holds_on_real_runs(tmp_path, monkeypatch, capsys):
    """A few difficult sets satisfy the requirements with the real FreeFem++."""
    monkeypatch.setattr(stress, "AXES", {"law": ("svk", "neohookean"), "nu": (0.49,), "speed": (10.0,), "penalty": (1e12,),
                                         "exponent": (1.0, 2.0), "dt": (1e-4,)})
    assert stress.main(["--out", str(tmp_path)]) == 0, capsys.readouterr().out
