"""Restitution, angles and slip of spinning bodies, and results that are omitted because they have
no meaning."""

import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.running import run


@pytest.mark.robustness
def test_what_rolls_has_no_restitution(tmp_path):
    """A disc that is released on the wall of a hollow circle hardly approaches it; its weight
    presses it on. The speeds of a scene are those that it reaches."""
    result = run.run(scene.load("disc-bowl"), {"accuracy": 0.4, "fields": 0, "end_time": 0.07, "contact.slip_velocity": 0.015}, tmp_path / "out", estimate=False)
    rows, s = pd.read_csv(result.folder / "contacts.csv"), result.summary
    assert len(rows) > 1 and rows.impulse_ratio.notna().all() and not (rows.restitution > 2).any()
    assert s["restitution"] is s["restitution_tangential"] is s["angle_out"] is None
    assert result.history["vy"].min() < -0.3 and not [sentence for sentence in s["warnings"] if sentence.startswith("slip velocity")]
