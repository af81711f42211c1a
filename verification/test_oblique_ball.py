"""V17: oblique impact of a ball in three dimensions: the rigid limit, and the elastic ball of Maw,
Barber and Fawcett (1976)."""

import pytest

from .oblique_ball import INERTIA, NU, RADIUS, lost_slip, rigid, slides_throughout, springs
from .rigid_disc import leaves


@pytest.mark.few(1)
@pytest.mark.parametrize("angle, slides", [(20, True), (60, False)])
def test_rigid_ball(tmp_path, angle, slides):
    """A rigid ball slides throughout for v_t/v_n > 7/2 mu (1 + e), else it leaves rolling; within 2
    % with the measured restitution.

    A sliding ball loses mu (1 + e) v_n along the plane and turns forward with 5/2 mu (1 + e) v_n/R.
    A rolling ball keeps 5/7 of its speed along the plane.
    """
    summary, along, _, lost = rigid(tmp_path, angle, 0.2)
    centre, rim = leaves(lost, INERTIA)
    assert (1 > 3.5 * lost) == slides and summary["energy_drift"] < 1e-8
    assert 1 - summary["rebound_vx"] / along == pytest.approx(1 - centre, rel=0.02)
    assert -summary["rebound_spin"] * RADIUS / along == pytest.approx(rim, rel=0.02)
    assert (summary["sticking_time"] < 0.01 * summary["contact_time"]) == slides


@pytest.mark.parametrize("nu", [0.3, 0.45, 0.5])
def test_theory_in_gross_slip(nu):
    """If the ball slides throughout, and only then, theory is beta = -1 + 7 (1 + e)(1 - nu)/((2 -
    nu) psi_1) with e = 1."""
    for psi in (0.5, 2, 3, 4, 5, 6, 8):
        closed = 14 * (1 - nu) / ((2 - nu) * psi)
        assert (springs(psi, nu) == pytest.approx(closed, rel=1e-3)) == slides_throughout(psi, nu)


def test_theory_in_partial_slip():
    """nu = 0.3: a ball that sticks at first keeps some of its slip (beta < 0) up to about psi_1 =
    0.8. Above it recoils, at most by 0.46 at 2.6."""
    assert springs(0.3, 0.3) < 1 and springs(0.7, 0.3) < 1 < springs(1.0, 0.3)
    assert max(springs(psi, 0.3) for psi in (2.2, 2.4, 2.6, 2.8, 3.0)) - 1 == pytest.approx(0.465, abs=0.005)


@pytest.mark.parametrize("psi, error", [pytest.param(psi, error, marks=pytest.mark.robustness) for psi, error in ((0.6, 0.22), (5.0, 0.02))])
def test_elastic_ball(tmp_path, psi, error):
    """At 0.2 m/s the slip that is lost and regained backwards agrees with theory.

    A ball that slides throughout agrees to 2 %. A ball that sticks and recoils deviates more, as
    its contact radius is an eighth of its radius and the theory is for half-spaces; this deviation
    falls with the contact radius (`make verify`). On finer elements it is 22 %.
    """
    lost, summary = lost_slip(tmp_path, psi, 0.2)
    assert lost == pytest.approx(springs(psi, NU), rel=error) and summary["energy_drift"] < 1e-9
