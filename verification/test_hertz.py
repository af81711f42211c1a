"""V6: a cylinder pressed on the plane, small load: Hertz."""

import pytest

from .hertz import hertz


@pytest.mark.parametrize("law", ["svk", "neohookean"])
@pytest.mark.parametrize("nu", [0, 0.45])     # 0.3: test_patch.py
def test_half_width_and_pressure_of_hertz(tmp_path, law, nu):
    """Half-width and largest pressure within 2 % with elements of 0.15 b, nearer than with 0.3 b, for both laws and any nu."""
    coarse, fine = (list(hertz(tmp_path / str(share), share, law, nu)) for share in (0.3, 0.15))
    assert all(row.error < 0.02 for row in fine)
    assert max(row.error for row in fine) < max(row.error for row in coarse)


@pytest.mark.robustness
def test_finest_cylinder_of_the_report(tmp_path):
    """Elements of a twenty-seventh of the half-width, steps that take the cylinder to rest at once: hard for the line search."""
    assert max(row.error for row in hertz(tmp_path, 0.0375)) < 5e-3
