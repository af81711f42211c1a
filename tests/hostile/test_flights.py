"""Free flights of rigid bodies of any duration until contact, and the end of a run if no further
contact follows."""

import numpy as np
import pytest

from tests.support.flights import FLOOR, go, read


@pytest.mark.robustness
def test_a_body_tumbles_for_long(tmp_path):
    """After 30 s of free tumbling, about seventy rotations, the spin agrees with Euler's equations
    in small steps. Angular momentum is constant."""
    box = {"shape": "box", "width": 0.1, "height": 0.06, "depth": 0.03, "mesh_size": 0.015, "contact_mesh_size": 0.015, "position": [0, 100, 0],
           "velocity": [0, 0.1, 0], "spin": [3.0, 14.0, 1.0]}
    scene = read(box, obstacles=({"kind": "plane", "point": [0, 0, 0], "normal": [0, 1, 0]},), dimension="3d", end_time=30.0, accuracy=0.2)
    _, result = go(tmp_path, scene)
    moments, spin, h = np.array([0.06**2 + 0.03**2, 0.1**2 + 0.03**2, 0.1**2 + 0.06**2]), np.array(box["spin"]), 1e-3
    of_unlike = np.array([moments[1] - moments[2], moments[2] - moments[0], moments[0] - moments[1]]) / moments
    for _ in range(round(30 / h)):
        rates = [of_unlike * spin[[1, 2, 0]] * spin[[2, 0, 1]]]
        for part in (0.5, 0.5, 1):
            w = spin + part * h * rates[-1]
            rates.append(of_unlike * w[[1, 2, 0]] * w[[2, 0, 1]])
        spin = spin + h / 6 * (rates[0] + 2 * rates[1] + 2 * rates[2] + rates[3])
    last = [result.history[name][-1] for name in ("spin_x", "spin_y", "spin")]
    # In the axes of the body.
    assert np.linalg.norm(last) == pytest.approx(np.linalg.norm(spin), rel=1e-6)
    before, after = ([result.history[f"angular_momentum{axis}"][k] for axis in ("_x", "_y", "")] for k in (0, -1))
    assert after == pytest.approx(before, abs=1e-8 * np.linalg.norm(before))


@pytest.mark.robustness
def test_a_body_that_vibrates_is_not_gone(tmp_path):
    """A slotted ring leaves the floor slowly after its first contact, with most of its energy in
    vibration.

    Further contacts follow, and the run has all contacts of a run of twice the duration.
    """
    half, gap = np.linspace(0, 2 * np.pi - 0.5, 41) + 0.25, np.linspace(2 * np.pi - 0.25, 0.25, 41)
    ring = np.vstack([0.05 * np.column_stack([np.cos(half), np.sin(half)]), 0.035 * np.column_stack([np.cos(gap), np.sin(gap)])])
    body = {"shape": "polygon", "vertices": ring.tolist(), "position": [0, 0.06], "velocity": [0, -7]}
    rows, result = go(tmp_path / "open", read(body, obstacles=(FLOOR,)))
    _, longer = go(tmp_path / "longer", read(body, obstacles=(FLOOR,), end_time=2 * float(result.history["t"][-1])))
    assert rows.vibration_energy[0] > rows.translation_energy[0] and len(rows) >= 4
    assert (result.summary["contact_intervals"], result.summary["impulse"]) == pytest.approx((longer.summary["contact_intervals"], longer.summary["impulse"]), rel=1e-9)
