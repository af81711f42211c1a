"""`integrator = auto`: explicit steps if they are cheaper by their number, else the default. The
choice is reported."""

import pytest

from ffimpact import scene
from ffimpact.running import run


@pytest.mark.robustness
def test_a_stated_error_covers_an_explicit_answer(tmp_path):
    """The second run, which estimates the error, has the same integrator.

    The results of a finer run with the default integrator are within the error estimate. The
    estimate of the energy is at least its drift.
    """
    problem = scene.load("ball-axisymmetric")
    result = run.run(problem, {"integrator": "auto"}, tmp_path / "auto")
    assert len([words for words in result.summary["skipped"] if words.startswith("implicit steps (a step takes")]) == 1
    assert result.summary["integrator"] == "central-difference" and result.summary["estimated_error"]["energy"] >= result.summary["energy_drift"] > 0
    finer = run.run(problem, {"accuracy": 0.0005}, tmp_path / "finer", estimate=False).summary
    for name, stated, scale in (("impulse", "impulse", finer["impulse"]), ("rebound_vy", "rebound", 8), ("energy_final", "energy", finer["energy_initial"]),
                                ("thresholded_contact_time", "thresholded_contact_time", finer["thresholded_contact_time"])):
        assert abs(result.summary[name] - finer[name]) <= result.summary["estimated_error"][stated] * scale, name
