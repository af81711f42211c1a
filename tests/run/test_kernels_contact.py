"""The compiled contact (edp/kernels/contact*.hpp) against the scripts that define it."""

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.running import run
from tests.support.kernels_contact import STEADY

# Unsolved residuals of steps must not affect the comparison; 1e-14 is at round-off.
COARSE = dict(fields=0, accuracy=0.2, tolerance=1e-13)
RUNS = {"disc-oblique": STEADY, "disc-rolling": STEADY | dict(end_time=0.02), "ball-oblique": STEADY, "two-discs": {}}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", RUNS)
def test_histories_are_those_of_the_scripts(tmp_path, name):
    """If the coefficient of friction does not depend on speed, whole runs agree to 3e-7 of the
    largest value, and energy is conserved.

    Both stop where the relative work of the residual is below the tolerance. The error of a
    displacement is then below the square root of the tolerance.
    """
    kernels, scripts = (run.run(scene.load(name), COARSE | RUNS[name] | {"without": without}, tmp_path / without, estimate=False) for without in ("none", "kernels"))
    if not kernels.summary["kernels"]:
        pytest.skip("no compiler here")
    assert kernels.summary["steps"] == scripts.summary["steps"] and kernels.summary["energy_drift"] < 1e-11
    for column in set(kernels.history) - {"newton_iterations", "balance"}:
        # A sum over bodies may be 0.
        largest = max(np.abs(values).max() for also, values in scripts.history.items() if also.startswith(column))
        np.testing.assert_allclose(kernels.history[column], scripts.history[column], rtol=0, atol=COARSE["tolerance"]**0.5 * largest, err_msg=column)
