"""Contact point by point against theory.

The cases are Hertz' profile (V6), the first microseconds of a disc (V18), and partial slip of
Cattaneo and Mindlin (annulus).
"""

import math

import numpy as np
import pytest

from . import cattaneo, first_touch
from .hertz import hertz, profile


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("body", ["cylinder", "ball"])
def test_profile_of_hertz(tmp_path, body, law):
    """Half-width, largest pressure and every point in 0.9 b agree within 2 % with the exact ellipse
    for elements of 0.15 b.

    The error is less than half of that with elements of 0.3 b.
    """
    errors = {}
    for share in (0.3, 0.15):
        rows = [*hertz(tmp_path / str(share), share, law, body=body), *profile(tmp_path / str(share), share, body=body)]
        errors[share] = max(row.error for row in rows)
    assert errors[0.15] < 0.02 and errors[0.15] < errors[0.3] / 2


@pytest.mark.parametrize("speed", first_touch.SPEEDS)
def test_first_touch(tmp_path, speed):
    """Force and impulse of the first microseconds agree within 5 % with a bar on a wall above every
    point, at 8 m/s and a tenth of it."""
    assert all(row.error < 0.05 for row in first_touch.early(tmp_path, speed, 0.05))


def test_shock_speed():
    """For small v the shock speed is c_L. At any speed rho U v is the stress of the column that is
    compressed by v/U."""
    assert first_touch.shock(1e-6) == pytest.approx(first_touch.WAVE, rel=1e-6)
    U, stretch = first_touch.shock(8), 1 - 8 / first_touch.shock(8)
    stress = first_touch.SHEAR * (stretch - 1 / stretch) + first_touch.LAME * math.log(stretch) / stretch
    assert -stress == pytest.approx(first_touch.DENSITY * U * 8, rel=1e-12) and 1.03 < U / first_touch.WAVE < 1.05


def test_partial_slip(tmp_path):
    """Elements of 0.1 b: the half-width of the stick zone and the traction, edge by edge, agree
    within 3 %.

    Every point outside 1.1 c slides with its full friction; every point inside 0.9 c sticks.
    """
    numbers, table = cattaneo.sheared(tmp_path, 0.1)
    b, c, p0 = cattaneo.widths(numbers)
    assert all(row.error < 0.03 for row in cattaneo.annulus(tmp_path, 0.1))
    away, slides = table.x.abs(), table.v.abs() >= cattaneo.CREEP * cattaneo.SPEED
    assert slides[away > 1.1 * c].all() and not slides[away < 0.9 * c].any() and 0.6 < c / b < 0.8
    np.testing.assert_allclose(table.q[slides], cattaneo.FRICTION * table.p[slides], rtol=1e-6)


def test_exact_traction_carries_the_force():
    """The integral of q is Q = mu P (1 - (c/b)^2)."""
    x = np.linspace(-1, 1, 200001)
    for c in (0.2, 0.7):
        assert np.trapezoid(cattaneo.exact(x, 1, c), x) / (math.pi / 2) == pytest.approx(1 - c**2, rel=1e-5)
