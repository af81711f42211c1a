"""A finished run goes on from its end: the same rows up to there, then as the longer run."""

import shutil

import numpy as np
import pytest

import ffimpact as ff

QUIET = {"progress": False, "figures": False, "accuracy": 0.1}


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """An oblique impact that ends amid the contact."""
    return ff.run("disc-oblique", end_time=3e-3, fields=5, out=tmp_path_factory.mktemp("runs") / "first", **QUIET)


def assert_agree(longer: ff.Result, whole: ff.Result, names: tuple[str, ...]) -> None:
    for name in names:
        assert abs(longer[name] - whole[name]) <= whole.errors[name], name


def test_the_rows_stay_and_the_answers_are_those_of_the_longer_run(first, tmp_path):
    """Contact intervals, states and sums are those of the whole; the first run stays as it is. The
    same extension is not run twice."""
    longer = first.extend(9e-3, progress=False, figures=False)
    whole = ff.run("disc-oblique", end_time=9e-3, fields=5, out=tmp_path / "whole", **QUIET)
    rows = len(first.history)
    assert longer.history[:rows].equals(first.history) and len(longer.history) > rows
    assert longer["resumed_at"] == first.history.t.iloc[-1] and longer.scene["end_time"] == 9e-3
    assert_agree(longer, whole, ("impulse", "rebound_vx", "rebound_vy", "rebound_spin", "contact_time", "peak_force"))
    assert len(longer.contacts) == len(whole.contacts) == 1 and longer.contacts.over[0] == 1
    times = np.array([state.time for state in longer.fields])
    assert times[0] < 1e-5 and times[-1] == pytest.approx(9e-3) and len(times) == 5
    assert longer["impulse"] > 1.05 * first["impulse"] and longer["energy_drift"] < 1e-8
    assert longer.errors["impulse"] > 0
    assert ff.load(first.folder)["impulse"] == first["impulse"]
    assert first.extend(9e-3, progress=False, figures=False).reused


def test_an_expression_of_time_goes_on(tmp_path):
    """A moved support follows its expression beyond the former end."""
    rubber = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
    support = ff.Support(where="top", motion=[0, "-1e-3*sin(200*t)"])
    bar = ff.Rectangle(width=0.02, height=0.1, material=rubber, position=(0, 0), support=[support])
    scene = ff.Scene(bodies=[bar], end_time=3e-3, accuracy=0.2)
    options = {"progress": False, "figures": False, "estimate": False}
    longer = ff.run(scene, out=tmp_path / "run", **options).extend(8e-3, **options)
    whole = ff.run(scene, {"end_time": 8e-3}, out=tmp_path / "whole", **options)
    assert longer["support_work"] == pytest.approx(whole["support_work"], rel=0.02)
    assert longer["energy_drift"] < 1e-6


@pytest.mark.parametrize(
    "end_time, message",
    [
        (3e-3, "end_time: 0.003 is not after the end of the run (accepted: above 0.003 s)"),
        (0, "end_time: 0 is not after the end of the run (accepted: above 0.003 s)"),
        ("late", "end_time: 'late' is not a number (accepted: 0 to 1e+09)"),
    ],
)
def test_wrong_ends_are_refused(first, end_time, message):
    with pytest.raises(ff.BadInput) as refused:
        first.extend(end_time)
    assert str(refused.value) == message


def test_a_run_without_its_last_state_cannot_go_on(first, tmp_path):
    folder = shutil.copytree(first.folder, tmp_path / "copy")
    (folder / "last-state").unlink()
    with pytest.raises(ff.Unreadable, match="so it cannot go on .accepted: run it again"):
        ff.load(folder).extend(0.01)
    with pytest.raises(ff.BadInput, match="out: '3' is no path"):
        first.extend(0.01, out=3)
