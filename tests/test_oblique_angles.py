"""make oblique-angles: what theory says in its limits, verdicts that can fail, bad input, and real impacts of a disc."""

import math

import numpy as np
import pandas as pd
import pytest

from benchmarks import __main__ as measurements
from benchmarks import oblique_angles as angles
from ffimpact.__main__ import guarded
from verification.oblique_ball import NU, slides_throughout, springs

SLIDES, STICKS = 20.0, 60.0      # degrees, at a friction of 0.3


def rows(psi_2=None, e=1.0, **given) -> pd.DataFrame:
    """A run of each body and kind at SLIDES and STICKS that does what the theory of its kind says; `given` replaces columns."""
    table = []
    for body, inertia in angles.INERTIA.items():
        for kind in angles.KINDS:
            for angle in (SLIDES, STICKS):
                psi = angles.number(1 / math.tan(math.radians(angle)), 0.3)
                after = angles.elastic(psi, e, inertia) if (body, kind) == ("ball", "slow") else angles.rigid(psi, e, inertia)
                table.append({"body": body, "kind": kind, "friction": 0.3, "angle": angle, "speed": angles.KINDS[kind][body]["speed"], "psi_1": psi, "e": e,
                              "along": 0.7, "psi_2": float(after), "e_error": 0.0, "along_error": 0.0, "psi_2_error": 0.01, "exit": 0, "message": "", "warnings": ""})
    return pd.DataFrame(table).assign(**given)


@pytest.mark.parametrize("body, inertia", [("disc", 2), ("ball", 2.5)])
def test_rigid_theory(body, inertia):
    """Steeply a rigid body leaves rolling, psi_2 = 0; beyond v_t/v_n = (1 + R^2/k^2) mu (1 + e), 3 or 7/2 times, it slides: beta = -1 + (6 or 7)(1 + e)(1 - nu)/((2 - nu) psi_1);
    the centre then keeps 2/3 or 5/7 of its speed, or all but mu (1 + e) v_n."""
    e, friction = 0.8, 0.3
    border = (1 + inertia) * friction * (1 + e)
    steep, flat = (float(angles.number(border * share, friction)) for share in (0.99, 1.5))
    assert angles.INERTIA[body] == inertia and angles.rigid(steep, e, inertia) == 0
    beta = -float(angles.rigid(flat, e, inertia)) / flat
    assert beta == pytest.approx(-1 + (2 + 2 * inertia) * (1 + e) * (1 - NU) / ((2 - NU) * flat), rel=1e-12) and beta < 0
    assert angles.centre(steep, 0.0, inertia) == pytest.approx(inertia / (1 + inertia))
    assert angles.centre(flat, angles.rigid(flat, e, inertia), inertia) == pytest.approx(1 - friction * (1 + e) / (1.5 * border))


def test_elastic_theory():
    """A ball that slides throughout loses 7 (1 + e)(1 - nu)/(2 - nu) of psi, e = 1, also where that turns the slip round, which a rigid one never does; one that sticks
    recoils, near the normal by little. For a disc it is 6 for 7, and there is no theory where it sticks."""
    psi = np.array([0.2, 1.4, 2.8, 3.8, 4.1, 6.5])
    after, slides = angles.elastic(psi, 1, 2.5), slides_throughout(psi, NU, 2.5)
    assert slides.tolist() == [False] * 4 + [True] * 2
    assert after[slides] == pytest.approx(psi[slides] - 14 * (1 - NU) / (2 - NU), rel=1e-12) and after[4] < -0.5 and angles.rigid(4.1, 1, 2.5) == 0
    assert (after[1:3] < -0.5).all() and after[0] == pytest.approx(0.2 * (1 - float(springs(0.2, NU)))) and abs(after[0]) < 0.1
    just = 4 * (1 - NU) * 3.5 / (2 - NU) - 1
    assert angles.elastic(just - 1e-3, 1, 2.5) == pytest.approx(float(angles.elastic(just + 1e-3, 1, 2.5)), abs=0.01), "one curve across the border"
    disc = angles.elastic(psi, 0.9, 2.0)
    assert np.isnan(disc[:3]).all() and disc[3:] == pytest.approx(psi[3:] - 6 * 1.9 * (1 - NU) / (2 - NU), rel=1e-12)


def test_what_theory_says_agrees():
    """Asked of all stiff ones, of slow balls, and of slow discs that slide throughout: all those agree, and a requirement that holds says so."""
    table = angles.judge(rows())
    assert angles.holds(table) and table[table.verdict == ""][["body", "kind", "angle"]].values.tolist() == [
        ["disc", "paper", SLIDES], ["disc", "paper", STICKS], ["disc", "slow", STICKS], ["ball", "paper", SLIDES], ["ball", "paper", STICKS]]
    said = angles.report(table)
    assert "7 of 7 that a theory is asked of agree," in said and "The requirement holds" in said
    assert table.loc[table.kind == "stiff", "asked [%]"].eq(5).all()
    sticks = table[(table.kind == "slow") & (table.body == "ball") & (table.angle == STICKS)]["asked [%]"].item()
    assert 5 < sticks < 30, "a ball that sticks is granted a share of the contact's radius over its own"


@pytest.mark.few(4)
@pytest.mark.parametrize("body, kind, angle, share, verdict", [
    ("disc", "stiff", SLIDES, 0.94, "DEVIATES"), ("disc", "stiff", SLIDES, 0.96, "agrees"), ("disc", "stiff", STICKS, 1.06, "DEVIATES"),
    ("ball", "stiff", STICKS, 1.06, "DEVIATES"), ("ball", "slow", SLIDES, 1.06, "DEVIATES"), ("ball", "slow", STICKS, 1.04, "agrees"), ("ball", "slow", STICKS, 1.1, "partly"),
    ("ball", "slow", STICKS, 1.4, "DEVIATES"), ("disc", "slow", SLIDES, 0.9, "DEVIATES"), ("disc", "slow", STICKS, 2.0, ""), ("ball", "paper", STICKS, 2.0, "")])
def test_a_changed_slip_is_judged(body, kind, angle, share, verdict):
    """Where `share` of the slip that theory says is lost the run deviates beyond what is asked of it, and only where something is; beyond 5 % it agrees partly at best."""
    table = rows()
    here = (table.body == body) & (table.kind == kind) & (table.angle == angle)
    table.loc[here, "psi_2"] = table.psi_1 - share * (table.psi_1 - table.psi_2)
    table = angles.judge(table)
    assert table[here].verdict.item() == verdict and angles.holds(table) == (verdict != "DEVIATES")
    assert ("FAILS" in angles.report(table)) == (verdict == "DEVIATES")


def test_a_failed_run_is_no_agreement():
    """It has no numbers, is named with its reason, and the requirement fails."""
    table = rows()
    table.loc[0, ["e", "along", "psi_2", "psi_2_error"]] = np.nan
    table.loc[0, ["exit", "message"]] = 11, "step: no convergence"
    table = angles.judge(table)
    assert table.verdict[0] == "failed" and not angles.holds(table)
    assert "failed, exit 11: disc, stiff, 20 degrees: step: no convergence" in angles.report(table) and "FAILS" in angles.report(table)


@pytest.mark.parametrize("words, said", [
    (["--angles", "20,ninety"], "--angles: 'ninety' is not accepted (accepted: numbers from 5 to 85"), (["--angles", "20,90"], "'90' is not accepted"),
    (["--angles", "20,,40"], "--angles: '' is not accepted"), (["--angles", "20,20"], "'20' is given twice"), (["--angles", "nan"], "'nan' is not accepted"),
    (["--friction", "0"], "--friction: '0' is not accepted (accepted: numbers from 0.01 to 10"), (["--friction", "0.2,0.3"], "accepted: one number"),
    (["--friction", "smooth"], "'smooth' is not accepted"), (["--bodies", "disc,cube"], "--bodies: 'cube' is not known (accepted: disc, ball"),
    (["--kinds", "soft"], "--kinds: 'soft' is not known (accepted: stiff, paper, slow")])
def test_bad_input(tmp_path, capsys, words, said):
    """Exit code 10, one line that names the option, the value and what is accepted; nothing is run or made."""
    assert guarded(measurements.main, ["oblique-angles", *words, "--out", str(tmp_path / "out")]) == 10
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and said in error and not (tmp_path / "out").exists()


@pytest.mark.robustness
def test_real_impacts_of_a_stiff_disc(tmp_path, capsys):
    """It slides at 20 degrees and rolls at 60, as a rigid one; table, figure and page are there; what is finished is not run again."""
    call = ["oblique-angles", "--bodies", "disc", "--kinds", "stiff", "--angles", "60,20", "--friction", "0.2", "--out", str(tmp_path / "out"), "--page", str(tmp_path / "page.md")]
    assert guarded(measurements.main, call) == 0
    out = capsys.readouterr().out
    table = pd.read_csv(tmp_path / "out/oblique-angles.csv")
    assert table.angle.tolist() == [20, 60] and table.verdict.tolist() == ["agrees"] * 2 and table.psi_2[0] > 4 and abs(table.psi_2[1]) < 0.05
    assert (table.psi_2_error < 0.05).all() and (tmp_path / "out/oblique-angles.png").stat().st_size > 5000
    assert "2 of 2 that a theory is asked of agree," in out and "python -m benchmarks oblique-angles --bodies disc" in (tmp_path / "page.md").read_text()
    made = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("summary.json")}
    assert len(made) == 4 and guarded(measurements.main, call) == 0 and made == {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("summary.json")}
