"""Pictures of bodies in three dimensions: surfaces and pressure, and the behaviour without PyVista.
"""

import re
import tomllib

import numpy as np
import pytest

from ffimpact.input.parameters import ROOT
from ffimpact.report import contact, solid
from tests.support.solid import RADIUS


def test_body_without_contact_has_no_pressure():
    """For a table without rows the pressure is zero everywhere at any time."""
    empty = np.rec.fromarrays(np.empty((6, 0)), names=["t", "X", "Y", "Z", "weight", "pressure"])
    assert not solid.Pressure(empty, (0, 2), np.random.default_rng(1).random((5, 3))).at(0.1).any()


def test_hertz_pressure_bears_its_force():
    """The integral of the ellipsoid over its circle is the force."""
    r, pressure = contact.hertz(30.0, {"young": 7e6, "nu": 0.45, "radius": RADIUS})
    assert np.trapezoid(2 * np.pi * r * pressure, r) == pytest.approx(30, rel=2e-3)


def test_what_is_missing_is_the_extra():
    """The installation message contains the packages of the extra in pyproject.toml."""
    extra = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]["solid"]
    assert solid.INSTALL.endswith(f"pip install {' '.join(re.split('[<>=]', requirement)[0] for requirement in extra)}")
