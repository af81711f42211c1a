"""The dent of a body from the displacement of its outline."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ffimpact.output.dent import dent
from ffimpact.output.states import State

DEPTH, WIDTH = 1e-4, 5e-3


def square(n: int, left: float) -> State:
    """A block from x = left to 0.02 m with a dent exp(-(x/WIDTH)^2) on its top, moved and turned."""
    x, y = np.meshgrid(np.linspace(left, 0.02, n), np.linspace(-0.02, 0, n), indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    number = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    corners = np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    cells = np.hstack([corners, corners])   # the middles of sides take no part
    near = np.exp(-((points[:, 0] / WIDTH) ** 2) - (points[:, 1] / WIDTH) ** 2)
    bent = points - DEPTH * near[:, None] * [0, 1, 0]
    moved = (Rotation.from_euler("z", 0 if left == 0 else 30, degrees=True).apply(bent) + [0.1 if left else 0, 0.3, 0]) - points
    zero = np.zeros(len(points))
    strain = np.where(near > 1e-3, near, 0)
    return State(0.0, points, cells, np.ones(len(cells), np.int32), moved, moved, zero, zero, zero, zero, np.zeros((len(points), 6)), strain)


@pytest.mark.parametrize("left, mirrored", [(-0.02, ()), (0.0, ("x",))])
def test_depth_and_radius(left, mirrored):
    """Also of a body that has moved, and of half of one."""
    found = dent(square(161, left), 1, mirrored)
    assert found.depth == pytest.approx(DEPTH, rel=1e-3)
    assert found.radius == pytest.approx(WIDTH * np.sqrt(np.log(100)), rel=0.01)
