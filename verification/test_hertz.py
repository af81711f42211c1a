"""V6: a cylinder is pressed on the plane with a small load (Hertz)."""

import pytest

from .hertz import hertz


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("nu", [0, 0.45])  # test_patch.py tests nu = 0.3
def test_half_width_and_pressure_of_hertz(tmp_path, law, nu):
    """Half-width and largest pressure agree within 2 % for elements of 0.15 b and better than for
    0.3 b, for both laws."""
    coarse, fine = (list(hertz(tmp_path / str(share), share, law, nu)) for share in (0.3, 0.15))
    assert all(row.error < 0.02 for row in fine)
    assert max(row.error for row in fine) < max(row.error for row in coarse)


@pytest.mark.robustness
def test_finest_cylinder_of_the_report(tmp_path):
    """A difficult case for the line search: elements of 1/27 of the half-width, and steps that
    bring the cylinder to rest at once."""
    assert max(row.error for row in hertz(tmp_path, 0.0375)) < 5e-3
