"""The meshes of the scenes."""

import math

import numpy as np
import pytest

from ffimpact.mesh import mesh


def test_file_keeps_every_digit(tmp_path):
    """A mesh in FreeFEM's format reads back with all digits."""
    m = mesh.disc(0.05, 0.01, 0.004, True)
    mesh.write(m, tmp_path / "m.msh")
    back = mesh.read(tmp_path / "m.msh")
    for name in ("points", "triangles", "edges", "labels"):
        assert np.array_equal(getattr(m, name), getattr(back, name)), name


def test_same_input_same_mesh():
    """The mesh depends on its input only."""
    first, second = (mesh.disc(0.05, 0.01, 0.002, True) for _ in range(2))
    assert np.array_equal(first.points, second.points)


def test_no_mesh_depends_on_the_unit_of_length():
    """A disc in metres and in millimetres has the same mesh except for round-off."""
    metres, millimetres = (mesh.disc(0.05 * metre, 0.011313708499 * metre, 0.0028 * metre, False, 1.2) for metre in (1, 1000))
    assert metres.points.shape == millimetres.points.shape and abs(1000 * metres.points - millimetres.points).max() < 1e-11 * 50


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_elements_are_longer_across_a_direction(turn):
    """Of 2 m by 1 m with sizes of 0.05 m along a direction and four times as much across it: lengths
    and area of the elements, extents and area of the body, turned or not."""
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    corners = np.array([[-1, -0.5], [1, -0.5], [1, 0.5], [-1, 0.5]]) @ axes
    sides = [(lambda s, a=a, b=b: a + s[:, None] * (b - a), np.inf, 1) for a, b in zip(corners, np.roll(corners, -1, axis=0))]
    made = mesh.mesh_body([sides], mesh.Sizes(0.05, 0.05, np.empty((0, 2)), 0.0, axes[1], 4.0), 1.0)
    own = made.points @ axes.T
    edges = (own[made.triangles] - own[np.roll(made.triangles, 1, axis=1)]).reshape(-1, 2)
    across, along = np.sqrt((edges**2).mean(axis=0))
    assert across / along == pytest.approx(4, rel=0.15)
    assert 2 / len(made.triangles) == pytest.approx(math.sqrt(3) / 4 * 0.05 * 0.2, rel=0.15)
    assert abs(np.ptp(own, axis=0) - [2, 1]).max() < 1e-12
    a, b, c = own[made.triangles].swapaxes(0, 1)
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert areas.min() > 0 and areas.sum() == pytest.approx(2, rel=1e-12)
