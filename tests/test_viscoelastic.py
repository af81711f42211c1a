"""make viscoelastic: what the theory says in its limits, a verdict that can fail, and real impacts."""

import pandas as pd
import pytest

from benchmarks import __main__ as measurements
from benchmarks import viscoelastic as study
from ffimpact.__main__ import guarded


def test_theory(monkeypatch):
    """Without viscosity e = 1 after Hertz' 2.943 x/v; the first order is that of the equation of motion for small A, 1.730 A (k/m)^(2/5) v^(1/5); A is that of Brilliantov et al.
    where both viscosities go with the moduli, and not without the second; a slow impact
    sees a branch as a viscosity."""
    e, contact = study.impact(0.0, 0.1)
    unit = (1.25 * study.MASS * 0.1**2 / study.SPRING) ** 0.4
    assert e == pytest.approx(1, abs=1e-6) and contact == pytest.approx(2.9432 * unit / 0.1, rel=1e-3)
    a = 1e-6
    assert 1 - study.impact(a, 0.1)[0] == pytest.approx(study.first_order(a, 0.1), rel=5e-3)
    assert study.first_order(a, 0.1) == pytest.approx(1.7302 * a * (study.SPRING / study.MASS) ** 0.4 * 0.1**0.2, rel=1e-4)
    both, shear = study.KINDS["both"], study.KINDS["shear"]
    assert study.coefficient(*both) == pytest.approx(study.TIME) == pytest.approx(study.brilliantov(*both))
    monkeypatch.setattr(study, "RELAXES", (1e5, 2e-4))                # 700 times shorter than the contact: eta = G tau
    assert study.lost_to_branch(1e-6, 4000) == pytest.approx(2 * study.first_order(study.coefficient(20.0, 0.0), 1e-6), rel=5e-3)
    assert study.coefficient(*shear) > 0.8 * study.TIME and study.brilliantov(*shear) == 0


@pytest.mark.robustness
def test_impacts_agree_with_it(tmp_path, monkeypatch, capsys):
    """Two speeds, a loss and a relaxation time: the requirement holds, table and figure are there; it fails where a balance does not close or 1 - e is off."""
    for name, few in (("SPEEDS", (1e-3, 1e-2)), ("LOSSES", (0.0, 0.1)), ("TIMES", (0.3,))):
        monkeypatch.setattr(study, name, few)
    assert guarded(measurements.main, ["viscoelastic", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "page.md")]) == 0
    assert "the requirement holds." in capsys.readouterr().out and (tmp_path / "page.md").read_text().startswith("# Damped impacts\nWritten by")
    table = pd.read_csv(tmp_path / "out/viscoelastic.csv")
    ball, disc = table[table.viscous.notna()], table[table.viscous.isna()]
    assert len(ball) == 8 and len(disc) == 3 and (tmp_path / "out/viscoelastic.png").stat().st_size > 5000
    assert study.holds(ball, disc) and not study.holds(ball, disc.assign(balance=1e-8))
    assert not study.holds(ball.assign(**{"off [%]": 1.02 * ball["off [%]"] + 3}), disc)
