"""Points inside a body near one of its vertices: the corners of a narrow block press into two
discs."""

import pytest

from ffimpact import scene
from ffimpact.running import run


@pytest.mark.robustness
def test_three_in_a_row_takes_no_small_steps(tmp_path):
    """The block of the scene is narrower than the discs that strike it. None of its steps is
    refused."""
    s = run.run(scene.load("three-in-a-row"), {"accuracy": 0.1, "fields": 0}, tmp_path / "run", estimate=False).summary
    assert s["rejected_steps"] <= 5 and s["factorizations"] < 1.5 * s["steps"] and s["newton_iterations"] < 20 * s["steps"]
