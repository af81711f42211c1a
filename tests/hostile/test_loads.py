"""Loads: tractions, pressures that follow the surface, and gases in cavities."""

import math

import numpy as np
import pytest

from tests.support.checkpoint import assert_same, direct, killed_at
from tests.support.loads import PUSHED, RADIUS, SOFT, THIN, WALL, assert_exact, thin
from verification.measure import bodies, outcome, prepared


@pytest.mark.robustness
def test_a_follower_turns_with_its_body(tmp_path):
    """A pressure on one side of a stiff bar that rotates by half a turn acts backwards at the end.

    The force on the bar, from its change of momentum, is -p A n with the current normal. A dead
    load keeps its direction.
    """
    bar = {"shape": "rectangle", "width": 0.2, "height": 0.05, "position": [0, 0], "spin": math.pi / 2e-2, "mesh_size": 0.025}
    kinds = ({"where": "right", "pressure": 1e3}, {"where": "right", "traction": [-1e3, 0]})
    runs = [bodies(tmp_path / str(k), SOFT | {"young": 1e9, "accuracy": 0.05, "end_time": 0.02, "body": [bar | {"load": [load]}]}) for k, load in enumerate(kinds)]
    for run, force_x in zip(runs, (lambda angle: -50 * np.cos(angle), lambda angle: -50 + 0 * angle)):
        assert_exact(run)
        history = run.history
        middle = history["t"][1:] - history["dt"][1:] / 2
        rate = np.diff(history["momentum_x"]) / history["dt"][1:]
        assert rate == pytest.approx(force_x(math.pi / 2e-2 * middle), abs=1.5)


@pytest.mark.robustness
def test_a_gas_begins_in_equilibrium(tmp_path):
    """A flying ring is in internal equilibrium: its circumferential stress E e h/R balances the
    gauge pressure in the expanded cavity.

    The given gauge pressure is that in the expanded cavity.
    """
    gauge = 2e3
    load = [{"where": "inner", "gas": {"gauge_pressure": gauge, "exponent": 1.0}}]
    run = bodies(tmp_path, THIN | {"end_time": 5e-4, "dt": 1e-4, "body": [thin("ring", load) | {"velocity": [3, 0]}]})
    assert_exact(run)
    history = run.history
    assert np.ptp(history["elastic"]) < 1e-9 * history["elastic"][0]
    inside = RADIUS - WALL / 2
    strain = gauge * inside / (THIN["young"] * WALL)
    assert history["elastic"][0] == pytest.approx(THIN["young"] * strain**2 / 2 * 2 * math.pi * RADIUS * WALL, rel=0.05)
    assert history["gas_pressure_1"] == pytest.approx(gauge, rel=1e-9)
    assert np.ptp(history["vx"]) < 1e-9 and history["vx"][0] == pytest.approx(3, rel=1e-12)


@pytest.mark.robustness
def test_half_a_run_with_a_gas_and_the_rest_are_the_whole(tmp_path):
    """A run with a gas, dead loads and follower loads is killed twice and continues with unchanged
    results."""
    flags = prepared(tmp_path / "scene", PUSHED | {"end_time": 8e-3, "checkpoint_every": 10})
    straight = direct(flags, tmp_path / "straight", "bodies")
    assert straight.communicate(timeout=120) and straight.returncode == 0
    rows = len(outcome(tmp_path / "straight").history["t"])
    out = tmp_path / "out"
    for number, more in ((rows // 40, {}), (rows // 24, {"restart": out / "checkpoint"})):
        killed_at(number, flags | more, out, "bodies")
    last = direct(flags | {"restart": out / "checkpoint"}, out, "bodies")
    assert last.communicate(timeout=120) and last.returncode == 0
    assert_same(out, tmp_path / "straight")
