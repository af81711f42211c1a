"""make oblique-angles: limits of the theories, verdicts that can fail, wrong input, and impacts of
a disc."""

import numpy as np
import pytest

from benchmarks import __main__ as measurements, oblique_angles as angles
from ffimpact.__main__ import guarded
from tests.support.oblique_angles import rows
from verification.oblique_ball import NU


@pytest.mark.parametrize("body, inertia", [("disc", 2), ("ball", 2.5)])
def test_rigid_theory(body, inertia):
    """At steep incidence a rigid body leaves rolling, psi_2 = 0. For v_t/v_n > (1 + R^2/k^2) mu (1
    + e), a factor of 3 or 7/2, it slides.

    Then beta = -1 + (6 or 7)(1 + e)(1 - nu)/((2 - nu) psi_1). A rolling centre keeps 2/3 or 5/7 of
    its speed, a sliding one all but mu (1 + e) v_n.
    """
    e, friction = 0.8, 0.3
    border = (1 + inertia) * friction * (1 + e)
    steep, flat = (float(angles.number(border * share, friction)) for share in (0.99, 1.5))
    assert angles.INERTIA[body] == inertia and angles.rigid(steep, e, inertia) == 0
    beta = -float(angles.rigid(flat, e, inertia)) / flat
    assert beta == pytest.approx(-1 + (2 + 2 * inertia) * (1 + e) * (1 - NU) / ((2 - NU) * flat), rel=1e-12) and beta < 0
    assert angles.centre(steep, 0.0, inertia) == pytest.approx(inertia / (1 + inertia))
    assert angles.centre(flat, angles.rigid(flat, e, inertia), inertia) == pytest.approx(1 - friction * (1 + e) / (1.5 * border))


def test_a_failed_run_is_no_agreement():
    """A failed run has no numbers, is reported with its reason, and the requirement fails."""
    table = rows()
    table.loc[0, ["e", "along", "psi_2", "psi_2_error"]] = np.nan
    table.loc[0, ["exit", "message"]] = 11, "step: no convergence"
    table = angles.judge(table)
    assert table.verdict[0] == "failed" and not angles.holds(table)
    assert "failed, exit 11: disc, stiff, 20 degrees: step: no convergence" in angles.report(table) and "FAILS" in angles.report(table)


@pytest.mark.parametrize("words, message", [
    (["--angles", "20,ninety"], "--angles: 'ninety' is not accepted (accepted: numbers from 5 to 85"), (["--angles", "20,90"], "'90' is not accepted"),
    (["--angles", "20,,40"], "--angles: '' is not accepted"), (["--angles", "20,20"], "'20' is given twice"), (["--angles", "nan"], "'nan' is not accepted"),
    (["--friction", "0"], "--friction: '0' is not accepted (accepted: numbers from 0.01 to 10"), (["--friction", "0.2,0.3"], "accepted: one number"),
    (["--friction", "smooth"], "'smooth' is not accepted"), (["--bodies", "disc,cube"], "--bodies: 'cube' is not known (accepted: disc, ball"),
    (["--kinds", "soft"], "--kinds: 'soft' is not known (accepted: stiff, paper, slow")])
def test_bad_input(tmp_path, capsys, words, message):
    """Exit code 10, one line with the option, the value and what is accepted. Nothing runs and no
    folder is made."""
    assert guarded(measurements.main, ["oblique-angles", *words, "--out", str(tmp_path / "out")]) == 10
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and message in error and not (tmp_path / "out").exists()
