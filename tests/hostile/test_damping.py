"""Kelvin-Voigt damping and a Maxwell branch (edp/kernels/laws.cpp).

Tested are exact decay, objectivity and the exact energy balance, in scripts and kernels.
"""

import pytest

from verification.measure import disc


@pytest.mark.robustness
def test_a_branch_is_a_viscosity_where_it_is_fast_and_a_spring_where_it_is_slow(tmp_path):
    """For tau short relative to the contact, restitution and viscous work equal those of the
    viscosity G tau.

    For long tau little energy is lost, and the branch stiffens the body: the contact is shorter.
    """
    flags = {"law": "neohookean", "nu": 0.4, "speed": 1, "accuracy": 0.1, "dt": 1e-5}
    elastic, viscous, fast, slow = (disc(tmp_path / str(k), **flags, **more) for k, more in enumerate(
        ({}, {"viscosity": 600}, {"branches": [[2e7, 3e-5]]}, {"branches": [[2e6, 1]]})))
    assert fast.summary["restitution"] == pytest.approx(viscous.summary["restitution"], abs=0.02)
    assert fast.summary["restitution"] < elastic.summary["restitution"] - 0.1
    assert fast.summary["viscous_work"] == pytest.approx(viscous.summary["viscous_work"], rel=0.05)
    assert slow.summary["viscous_work"] < 0.01 * slow.summary["energy_initial"]
    assert slow.summary["contact_time"] < 0.97 * elastic.summary["contact_time"]
