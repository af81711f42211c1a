"""The film of a scene: its frames, its file, and the cases without ffmpeg and with interrupted
drawing."""

import numpy as np
import pytest

from ffimpact.output import vtu
from ffimpact.report import figures


def test_diameter_turns_with_the_body():
    """A whole disc rotated by 90 degrees to the left: its vertical diameter is horizontal, with the
    top on the left."""
    ring = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    points = np.vstack([[0, 0.05], np.column_stack([0.05 * np.sin(ring), 0.05 + 0.05 * np.cos(ring)])])
    triangles = np.array([[0, k + 1, (k + 1) % 24 + 1] for k in range(24)])
    turned = np.column_stack([0.05 - points[:, 1], points[:, 0] + 0.05])
    line = figures.diameter(vtu.Snapshot(points, triangles, {"displacement": np.column_stack([turned - points, np.zeros(25)])}))
    assert line[:, 1] == pytest.approx(np.full(len(line), 0.05)) and (np.diff(line[:, 0]) > 0).all()
    assert line[0, 0] == pytest.approx(-0.05, rel=0.06)
