"""make viscoelastic: limits of the theory, a verdict that can fail, and impacts."""

import pandas as pd
import pytest

from benchmarks import __main__ as measurements, viscoelastic as study
from ffimpact.__main__ import guarded


@pytest.mark.robustness
def test_impacts_agree_with_it(tmp_path, monkeypatch, capsys):
    """With two speeds, a loss and a relaxation time the requirement holds; table and figure exist.

    It fails if a balance does not close or 1 - e deviates.
    """
    for name, few in (("SPEEDS", (1e-3, 1e-2)), ("LOSSES", (0.0, 0.1)), ("TIMES", (0.3,))):
        monkeypatch.setattr(study, name, few)
    assert guarded(measurements.main, ["viscoelastic", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "page.md")]) == 0
    assert "the requirement holds." in capsys.readouterr().out and (tmp_path / "page.md").read_text().startswith("# Damped impacts\n")
    table = pd.read_csv(tmp_path / "out/viscoelastic.csv")
    ball, disc = table[table.viscous.notna()], table[table.viscous.isna()]
    assert len(ball) == 8 and len(disc) == 3 and (tmp_path / "out/viscoelastic.png").stat().st_size > 5000
    assert study.holds(ball, disc) and not study.holds(ball, disc.assign(balance=1e-8))
    assert not study.holds(ball.assign(**{"off [%]": 1.02 * ball["off [%]"] + 3}), disc)
