"""Hollow bodies in equilibrium with the gases in them at the start."""

import math

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

import ffimpact as ff
from ffimpact.failure import Failure
from verification.measure import bodies

INNER, OUTER, SHEAR = 0.025, 0.03, 1e6
RUBBER = {"law": "incompressible", "young": 3 * SHEAR, "nu": 0.5, "density": 1000, "accuracy": 0.1, "end_time": 2e-5, "dt": 1e-5}


def exact_pressure(inner: float, power: int) -> float:
    """The pressure [Pa] in an incompressible neo-Hookean tube (`power` 2, plane strain) or hollow ball
    (3) with the inner radius `inner` [m]: the integral of (sigma_theta - sigma_r)/r over r."""
    def difference(r: float) -> float:
        stretch = r / (r**power - inner**power + INNER**power)**(1 / power)
        return (power - 1) * SHEAR * (stretch**2 - stretch**(2 - 2 * power)) / r

    outer = (inner**power - INNER**power + OUTER**power)**(1 / power)
    return quad(difference, inner, outer)[0]


def exact_inner(pressure: float, power: int) -> float:
    """The inner radius [m] at a pressure [Pa] below the largest one."""
    return brentq(lambda inner: exact_pressure(inner, power) - pressure, INNER, 1.4 * INNER)


def filled(tmp_path, power: int, pressure: float, exponent: float = 0.0, **more):
    """A run of a tube or hollow ball of rubber that nothing touches, with a gas in it."""
    gas = {"gauge_pressure": pressure, "exponent": exponent}
    body = {"shape": "ring" if power == 2 else "shell", "radius": OUTER, "inner_radius": INNER, "position": [0, 0],
            "load": [{"where": "inner", "gas": gas}]}
    return bodies(tmp_path / "run", RUBBER | more | {"body": [body]} | ({"dimension": "axisymmetric"} if power == 3 else {}))


@pytest.mark.parametrize("power, pressure, exponent", [(3, 2e5, 0.0), (3, 1e5, 1.4), (2, 1e5, 1.4)])
def test_the_pressure_is_that_in_equilibrium(tmp_path, power, pressure, exponent):
    """A tube and a hollow ball start with the stated pressure in the cavity of the exact solution, also
    at 0.89 of the largest pressure, and stay at rest."""
    run = filled(tmp_path, power, pressure, exponent)
    volume = run.history["gas_volume_1"]
    assert run.history["gas_pressure_1"][0] == pytest.approx(pressure, rel=1e-9)
    assert volume == pytest.approx(volume[0], rel=1e-8)
    measured = math.sqrt(volume[0] / math.pi) if power == 2 else (3 * volume[0] / (4 * math.pi))**(1 / 3)
    assert measured == pytest.approx(exact_inner(pressure, power), rel=1e-4)


def test_a_gas_above_the_largest_pressure_is_refused(tmp_path):
    """The largest pressure that a hollow ball bears is named, to 0.5 % of that of the exact solution."""
    largest = -minimize_scalar(lambda inner: -exact_pressure(inner, 3), bounds=(INNER, 2 * INNER), method="bounded").fun
    with pytest.raises(Failure, match="body.1.load.1.gas.gauge_pressure: 'body1' has no equilibrium with 240000 Pa; the largest found is ") as failure:
        filled(tmp_path, 3, 2.4e5, mesh_size=0.0025)
    assert float(str(failure.value).split("largest found is ")[1].split()[0]) == pytest.approx(largest, rel=5e-3)
    assert filled(tmp_path, 3, 0.99 * largest).history["gas_pressure_1"][0] == pytest.approx(0.99 * largest, rel=1e-9)


def test_the_given_shape_is_that_under_the_gas(tmp_path):
    """A hollow ball given as inflated starts with its stated shape and pressure. Its unstressed shape is
    that of the exact solution: the elastic energy agrees to 1e-3."""
    inner, outer = 0.03115, 0.0346

    def over_shell(law, less: float) -> float:
        return quad(lambda r: law(r / (r**3 - less)**(1 / 3), r), inner, outer)[0]

    less = brentq(lambda less: over_shell(lambda stretch, r: 2 * SHEAR * (stretch**2 - stretch**-4) / r, less) - 2e5, 0, 0.5 * inner**3)
    energy = over_shell(lambda stretch, r: SHEAR / 2 * (2 * stretch**2 + stretch**-4 - 3) * 4 * math.pi * r**2, less)
    scene = ff.Scene(
        dimension="axisymmetric", accuracy=0.1, end_time=2e-5, obstacles=[],
        bodies=[ff.Shell(radius=outer, inner_radius=inner, position=(0, 0), material=ff.Incompressible(young=3 * SHEAR, density=1000),
                         load=[ff.Load(where="inner", gas=ff.Gas(gauge_pressure=2e5, exponent=0, given_shape="inflated"))])])
    result = ff.run(scene, out=tmp_path / "run", estimate=False, figures=False, mesh_size=0.0034)
    assert result.history.gas_pressure_1[0] == pytest.approx(2e5, rel=1e-9)
    assert (3 * result.history.gas_volume_1[0] / (4 * math.pi))**(1 / 3) == pytest.approx(inner, rel=1e-6)
    volume = 4 / 3 * math.pi * (outer**3 - inner**3)  # which is that of the stress-free shell
    assert result["mass"] == pytest.approx(1000 * volume, rel=1e-4)
    assert (result["gas_pressure_start_1"], result["gas_volume_start_1"]) == (2e5, result.history.gas_volume_1[0])
    assert result["gas_radius_start_1"] == pytest.approx(outer, rel=1e-6)
    assert result["energy_initial"] == pytest.approx(energy, rel=1e-3)


@pytest.mark.parametrize("start", ["given", "equilibrium"])
def test_a_relaxing_shell_has_the_stated_pressure(tmp_path, start):
    """A Maxwell branch is unstrained in the equilibrium with the gas: the shell stays as it is."""
    law = {"law": "neohookean", "nu": 0.45, "branches": [[2 * SHEAR, 1e-4]], "end_time": 5e-4, "dt": 0, "start": start}
    run = filled(tmp_path, 2, 5e4, 1.4, **law)
    assert run.history["gas_pressure_1"] == pytest.approx(5e4, rel=1e-8)
    assert run.summary["viscous_work"] < 1e-12 * run.history["elastic"][0] == pytest.approx(1e-12 * run.history["elastic"][-1], rel=1e-8)


def test_vibration_is_what_the_impact_leaves_beside_the_flight(tmp_path):
    """Without damping and spin, the kinetic energy that an inflated ball has lost is in its vibration. That of
    its equilibrium with the gas, which is larger, is no vibration."""
    ball = {"shape": "ring", "radius": OUTER, "inner_radius": INNER, "position": [0, 0.04], "velocity": [0, -3], "mesh_size": 0.004,
            "load": [{"where": "inner", "gas": {"gauge_pressure": 1e5, "exponent": 1.4}}]}
    run = bodies(tmp_path, RUBBER | {"law": "neohookean", "nu": 0.45, "end_time": 0, "dt": 0, "body": [ball],
                                     "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]})
    lost = run.history["kinetic"][0] - run.summary["translation_energy"] - run.summary["rotation_energy"]
    assert run.summary["vibration_energy"] == pytest.approx(lost, rel=1e-6)
    assert 0 < 2 * lost < run.history["elastic"][0]
