"""V2: assembled residual, contact force, tangent and contact stiffness against direct evaluations
of the same expressions."""

import math

import pytest

from verification import measure as runs
from verification.tangents import COARSE, EXPONENTIAL, METAL, MIXED, MOONEY, OGDEN

LAWS = ["svk", "neohookean"]
REGULARIZATIONS = ["linear", "linear-printed", "sqrt", "tanh"]
TRANSITIONS = ["jump", "smooth"]
CURVED = {"law": "metal", "nu": 0.3, "yield_curve": ((0, 2e5), (0.1, 3e5)), "voce": (1e5, 20), "perzyna": (10, 2)}
TANGENTS = [*((body, {"law": law, "degree": degree, "integrator": integrator} | ({"nu": 0.3} if body == "3d" else {}))
              for body, integrator in (("block", "bdf2"), ("block", "midpoint"), ("disc", "bdf2"), ("disc", "midpoint"), ("ball", "bdf2"), ("3d", "midpoint"))
              for law in LAWS for degree in (1, 2)),
            *((body, own | {"integrator": "midpoint"}) for body in COARSE for own in (MOONEY, OGDEN, METAL, EXPONENTIAL, MIXED)),
            *((body, energy | {"integrator": "midpoint", "parameters": energy["parameters"][:-1] + (("k", 1e9),)}) for body in COARSE for energy in (EXPONENTIAL, MIXED)),
            ("ball", CURVED | {"integrator": "bdf2"}),
            *((body, {"law": law, "integrator": integrator, "nu": 0.4999}) for body in COARSE
              for law, integrator in (("svk", "midpoint"), ("neohookean", "bdf2"), ("neohookean", "midpoint"))),
            ("disc", MOONEY | {"integrator": "bdf2", "nu": 0.4999})]


@pytest.mark.few(7)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("integrator, exponent", [
    ("energy-momentum", 1), ("energy-momentum", 1.5), ("midpoint", 2), ("backward-euler", 2),
    ("bdf2", 1), ("bdf2", 1.5)])
def test_residual_is_the_one_of_the_equations(measure, law, integrator, exponent):
    """Inertia, stress, load and contact of one step equal a varf that is written from the
    equations, to round-off."""
    numbers = measure("residual", law=law, integrator=integrator, exponent=exponent)
    assert numbers["state"] == 0 and numbers["strain"] > 0.3
    assert numbers["before"] > 0 and numbers["switching"] > 0 and numbers["after"] < numbers["points"]
    assert numbers["elastic"] < 1e-10 and numbers["contact"] < 1e-10 and numbers["total"] < 1e-10


@pytest.mark.few(12)
@pytest.mark.parametrize("body, flags", TANGENTS, ids=str)
def test_tangent_is_the_derivative_of_the_residual(measure, body, flags):
    """Moduli and mass give the derivative of the residual at large strain, under every law.

    Elements are straight or curved, in the plane, of revolution (with circumferential terms) and in
    space; at nu = 0.4999 with the rank-one part of every element. The symmetric factorisation
    solves the system and does not move constrained unknowns. svk at nu =
    0.45, and all laws at 0.4999, are not elliptic in this state, so that the tangent has no factor.
    """
    numbers = measure(f"tangent-{body}", **COARSE.get(body, {"accuracy": 0.1}) | flags)
    assert numbers["tangent"] < 1e-6
    degree, usual = flags.get("degree"), flags["law"] in LAWS and "degree" in flags
    if usual:
        assert numbers["state"] == 0 and (numbers["strain"] > {"ball": 1, "3d": 0.5}[body] if body in ("ball", "3d") else numbers["smallest"] < 0.6)
    if usual and body in ("disc", "ball"):
        assert numbers["solve"] < {"disc": 1e-11, "ball": 1e-10}[body] and numbers["stray"] < {"disc": 1e-15, "ball": 1e-12}[body]
    if usual and body == "3d":
        assert numbers["area"] == pytest.approx(4 / 3 * math.pi * 0.05**3, rel=3e-3 if degree == 2 else 0.15)


METALS = [METAL, CURVED, METAL | {"johnson_cook": (0.05, 0.1)}]
ELASTIC = [{"law": "neohookean", "nu": 0.3}, {"law": "svk", "nu": 0.4999}, {"law": "neohookean", "nu": 0.4999},
           *(energy | {"parameters": energy["parameters"][:-1] + (("k", k),)} for energy in (EXPONENTIAL, MIXED) for k in (6e6, 1e9))]
DAMPED = [{"law": "neohookean", "nu": 0.3, "viscosity": 300, "bulk_viscosity": 100},
          {"law": "neohookean", "nu": 0.3, "branches": ((7e6, 1e-3), (2e6, 1e-4)), "bulk_branches": ((3e6, 1e-3), (1e6, 1e-4))}]


@pytest.mark.few(6)
@pytest.mark.parametrize("body", COARSE)
@pytest.mark.parametrize("flags", ELASTIC + DAMPED + METALS, ids=str)
def test_terms_agree_with_differences_of_their_work(measure, body, flags):
    """In a step of energy-momentum d times the forces of a term is the energy that it stores and
    dissipates, with a history from the step before.

    The forces of elastic bodies and of contact are the slope of their energy, as are those of a metal
    with linear hardening and without rates. The tangent at d = 0 is the derivative of all forces, those of
    damping among them; that of a metal at yield has two sides there."""
    if body == "3d" and flags["law"] == "svk":
        flags = flags | {"nu": 0.3}
    numbers = measure(f"terms-{body}", **COARSE[body] | flags)
    assert numbers["smallest"] < 0.6
    assert abs(numbers["workBodies"]) < 1e-12 and abs(numbers["workInertia"]) < 1e-12 and abs(numbers["workContact"]) < 1e-12
    assert abs(numbers["slopeContact"]) < 1e-6
    if flags in METALS:
        assert numbers["dissipated"] > 0.05
        assert flags != METAL or abs(numbers["slope"]) < 1e-6
        return
    assert numbers["tangent"] < 1e-7
    if flags in DAMPED:
        assert numbers["dissipated"] > 0.1
    else:
        assert abs(numbers["slope"]) < 1e-6 and numbers["dissipated"] == 0


@pytest.mark.parametrize("degree", [1, 2])
def test_forces_of_a_gas_agree_with_differences_of_its_energy(degree, tmp_path):
    """In a step the work of a gas on its body is the energy that it loses by p V^n = const, and its
    forces are the slope of that energy."""
    ring = {"shape": "ring", "radius": 0.05, "inner_radius": 0.04, "position": [0, 0.053], "velocity": [0, -3],
            "load": [{"where": "inner", "gas": {"gauge_pressure": 5e4, "exponent": 1.4}}]}
    tables = {"law": "neohookean", "young": 3e6, "nu": 0.45, "density": 1100, "accuracy": 0.1, "degree": degree, "body": [ring],
              "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}
    numbers = runs.measure("loads", **runs.prepared(tmp_path, tables))
    assert abs(numbers["grows"]) > 0.01
    assert abs(numbers["gas"]) < 1e-9 and abs(numbers["work"]) < 1e-9 and abs(numbers["slope"]) < 1e-7


def test_curved_outline_has_the_area_of_the_disc(measure):
    """The weights of the isoparametric half disc add up to its area; straight triangles miss about
    2 % of it."""
    exact = math.pi * 0.05**2
    flags = dict(law="svk", integrator="bdf2", mesh_size=0.025, contact_mesh_size=0.0099)
    assert measure("tangent-disc", degree=2, **flags)["area"] == pytest.approx(exact, rel=1e-4)
    assert 0.96 * exact < measure("tangent-disc", degree=1, **flags)["area"] < 0.99 * exact


@pytest.mark.parametrize("exponent", [1, 1.5, 2])
def test_contact_stiffness_is_the_derivative_of_the_traction(measure, exponent):
    """This holds for points that stay open or closed, rest, open and close, for every position in
    the step at which the law is evaluated."""
    numbers = measure("contact-law", exponent=exponent)
    for place in range(3):
        assert numbers[f"stiffness{place}"] < 1e-6 and numbers[f"open{place}"] == 0
    assert abs(numbers["work"]) < 1e-13 and numbers["alone"] < 1e-10


@pytest.mark.few(4)
@pytest.mark.parametrize("integrator, transition, regularization", [
    ("energy-momentum", "jump", "linear"), ("bdf2", "jump", "linear-printed"), ("midpoint", "jump", "sqrt"), ("energy-momentum", "jump", "tanh"),
    ("midpoint", "smooth", "linear"), ("energy-momentum", "smooth", "linear-printed"), ("bdf2", "smooth", "sqrt"), ("midpoint", "smooth", "tanh")])
def test_friction_force_is_the_one_of_the_equations(measure, integrator, transition, regularization):
    """Friction (11)-(13) equals a varf to round-off for points that stick, slip, reverse, open and
    close in the step.

    The next test shows that every law is the same for every position in the step at which it is
    evaluated.
    """
    numbers = measure("residual", law="svk", integrator=integrator, exponent=1.5, friction_static=0.7, friction_dynamic=0.5,
                      slip_velocity=2.5, regularization=regularization, friction_transition=transition)
    assert numbers["slow"] > 1 and numbers["fast"] > 1 and numbers["backwards"] > 1 and numbers["switching"] > 0
    assert numbers["friction"] < 1e-10 and numbers["contact"] < 1e-10 and numbers["total"] < 1e-10


@pytest.mark.few(6)
@pytest.mark.parametrize("regularization", REGULARIZATIONS)
@pytest.mark.parametrize("transition", TRANSITIONS)
@pytest.mark.parametrize("coefficients", [(0.7, 0.5), (0.9, 0.2), (0.4, 0.4)])
def test_friction_derivatives(measure, coefficients, transition, regularization):
    """t_T is the printed law for the branch, static or dynamic, that the velocity selects.

    Stiffness, drag and coupling are the derivatives of t_N and t_T on either branch, for three
    exponents and every position in the step.
    """
    numbers = measure("friction-law", friction_static=coefficients[0], friction_dynamic=coefficients[1])
    kind = f"{regularization.removeprefix('linear-')}_{transition}"
    assert numbers[f"law_{kind}"] < 1e-13 and numbers[f"normal_{kind}"] == 0
    assert numbers[f"stiff_{kind}"] < 1e-6 and numbers[f"drag_{kind}"] < 1e-6 and numbers[f"coupling_{kind}"] < 1e-6
    assert numbers[f"cross_{kind}"] == 0
    assert numbers[f"falls_{kind}"] == 0  # no branch decreases with speed
