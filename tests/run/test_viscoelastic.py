"""make viscoelastic: limits of the theory, a verdict that can fail, and impacts."""

import pytest

from benchmarks import viscoelastic as study


def test_theory(monkeypatch):
    """Without viscosity e = 1 after Hertz' time 2.943 x/v.

    The first order of the equation of motion for small A is 1.730 A (k/m)^(2/5) v^(1/5). A equals
    that of Brilliantov et al. if both viscosities are proportional to the moduli, and not without
    the second one. For a slow impact a branch acts as a viscosity.
    """
    e, contact = study.impact(0.0, 0.1)
    unit = (1.25 * study.MASS * 0.1**2 / study.SPRING) ** 0.4
    assert e == pytest.approx(1, abs=1e-6) and contact == pytest.approx(2.9432 * unit / 0.1, rel=1e-3)
    a = 1e-6
    assert 1 - study.impact(a, 0.1)[0] == pytest.approx(study.first_order(a, 0.1), rel=5e-3)
    assert study.first_order(a, 0.1) == pytest.approx(1.7302 * a * (study.SPRING / study.MASS) ** 0.4 * 0.1**0.2, rel=1e-4)
    both, shear = study.KINDS["both"], study.KINDS["shear"]
    assert study.coefficient(*both) == pytest.approx(study.TIME) == pytest.approx(study.brilliantov(*both))
    # 700 times shorter than the contact: eta = G tau, on the deviator.
    monkeypatch.setattr(study, "RELAXES", (1e5, 2e-4))
    assert study.lost_to_branch(1e-6, 4000) == pytest.approx(2 * study.first_order(study.coefficient(20.0, -2 / 3 * 20.0), 1e-6), rel=5e-3)
    assert study.coefficient(*shear) > 0.8 * study.TIME and study.brilliantov(*shear) == 0
