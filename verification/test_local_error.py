"""The local error of a step (edp/program/run/control.idp) for a smooth force, against a fine
reference."""

import math

import pytest

RULES = ("energy-momentum", "midpoint")
STEPS = (2.5e-6, 1.25e-6)


@pytest.fixture
def step(measure, tmp_path):
    """step(integrator, dt): the numbers of local-error.edp for a soft block that falls on a soft
    plane at 10 m/s."""
    return lambda integrator, dt: measure("local-error", integrator=integrator, dt=dt, nu=0.3, radius=0.05, density=1722, young=7e6, penalty=1e9, speed=10,
                                          law="svk", tolerance=1e-14, chatter="continue", out=tmp_path / f"{integrator}-{dt}")


@pytest.mark.parametrize("integrator", RULES)
def test_local_error_of_the_impulse(step, integrator):
    """(a): the error is dt^3 |N''| / 12 within 2 %; of third order in dt, hence of second order
    relative to the impulse of the step."""
    coarse, fine = (step(integrator, dt) for dt in STEPS)
    assert fine["true"] == pytest.approx(fine["leading"], rel=0.02)
    assert math.log2(coarse["true"] / fine["true"]) == pytest.approx(2, abs=0.15)


@pytest.mark.parametrize("integrator", RULES)
def test_what_steers_the_step_is_a_bound(step, integrator):
    """(b): the controlling estimate dt |N1 - N0| / 12 is one order lower and exceeds the true error
    while the force rises, by more for smaller steps."""
    coarse, fine = (step(integrator, dt) for dt in STEPS)
    for errors in (coarse, fine):
        assert errors["estimate"] == pytest.approx(errors["change"] / 12, rel=1e-9) and errors["estimate"] > errors["true"]
    assert math.log2(coarse["estimate"] / fine["estimate"]) == pytest.approx(1, abs=0.25)
    assert fine["estimate"] / fine["true"] > 1.7 * coarse["estimate"] / coarse["true"]
