"""Two and more deformable bodies that hit each other: what a step and a run conserve, and what they must agree with."""

import numpy as np
import pytest

from .scenes import HITS


@pytest.mark.parametrize("degree", [2, 1])
@pytest.mark.parametrize("hit", HITS)
def test_every_step_conserves(steps, hit, degree):
    """At the increment of every step B d = q1 - q0, and no row, no sum of contact forces and none of their moments is left, to round-off;
    a step begins with the gaps the last one ended with. Over the hit the energy with the work of friction stays to 1e-9, momentum to 1e-12,
    angular momentum to 1e-9."""
    found = steps({"end_time": 6e-3, "dt": 1e-4, "degree": degree} | HITS[hit])
    assert found["state"] == 0 and found["rejected"] < 3 and found["touching"] > 20 and found["depth"] > 1e-5
    assert found["exact"] < 1e-12 and found["begin"] < 1e-11
    assert max(found["rowForce"], found["rowMoment"], found["force"], found["moment"]) < 1e-14
    assert found["balance"] < 1e-9 and found["momentum"] < 1e-12 and found["angular"] < 1e-9
    assert (found["friction"] > 1e-4) == (HITS[hit]["contact"]["friction_static"] > 0)


@pytest.mark.parametrize("hit", HITS)
def test_march_conserves(march, hit):
    """The same of energy and momenta over a whole run with steps of its own, from the flight to the last row."""
    run = march(HITS[hit])
    history, bodies = run.history, len(HITS[hit]["body"])
    scale = sum(np.hypot(history[f"momentum_x_{b}"], history[f"momentum_y_{b}"]).max() for b in range(1, bodies + 1))
    assert run.summary["contact_intervals"] >= 1 and run.summary["impulse"] > 0
    assert np.abs(history["balance"]).max() < 1e-9 * run.summary["energy_initial"]
    for axis in "xy":
        assert np.ptp(history[f"momentum_{axis}"]) < 1e-12 * scale
    assert np.ptp(history["angular_momentum"]) < 1e-9 * scale * 0.05
