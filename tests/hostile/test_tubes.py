"""Bodies of revolution that do not reach the axis: tubes, rings, O-rings."""

import pytest

from tests.support.tubes import run


@pytest.mark.robustness
def test_a_polygon_to_the_right_of_the_axis_is_the_same_tube(tmp_path):
    """The vertices may have either direction."""
    corners = [[0.02, 0], [0.03, 0], [0.03, 0.1], [0.02, 0.1]]
    tube = run(tmp_path, 'shape = "tube"\nradius = 0.03\ninner_radius = 0.02\nheight = 0.1\nposition = [0, 0.0501]', accuracy=0.1)
    for vertices in (corners, corners[::-1]):
        summary = run(tmp_path, f'shape = "polygon"\nvertices = {vertices}\nposition = [0, 0.0501]', accuracy=0.1)
        assert summary["restitution"] == pytest.approx(tube["restitution"], abs=5e-3)
