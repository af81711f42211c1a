"""Friction as an expression of slip velocity and pressure: against exact motions, and what is refused."""

import tomllib

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ffimpact as ff
from ffimpact.failure import BadInput

GRAVITY, WIDTH, HEIGHT, DENSITY = 9.81, 0.4, 0.01, 1000.0


def sliding(tmp_path, friction, **contact):
    """A flat rigid block that slides on the floor, for 0.1 s; it begins at its depth at rest."""
    penalty = 1e9
    middle = HEIGHT / 2 - DENSITY * GRAVITY * HEIGHT / penalty
    block = ff.Rectangle(width=WIDTH, height=HEIGHT, rigid=True, density=DENSITY, position=(0, middle), velocity=(1, 0))
    law = ff.Contact(friction=friction, penalty=penalty, slip_velocity=1e-3, **contact)
    scene = ff.Scene(bodies=[block], obstacles=[ff.Plane()], contact=law, gravity=GRAVITY, start="given", end_time=0.1, dt=2e-4)
    return ff.run(scene, out=tmp_path / "run", estimate=False, figures=False)


@pytest.mark.parametrize("friction, mu", [
    ("0.2 + 0.3*exp(-v/0.5)", lambda v: 0.2 + 0.3 * np.exp(-v / 0.5)),
    ("0.3*(p/1e3)^-0.5 + 0.1*v", lambda v: 0.3 * (DENSITY * GRAVITY * HEIGHT / 1e3) ** -0.5 + 0.1 * v)])
def test_a_sliding_block_is_braked_as_the_expression_has_it(tmp_path, friction, mu):
    """dv/dt = -g mu(v, p), with the pressure of the weight; the energy balance closes to the tolerance of
    500 steps."""
    result = sliding(tmp_path, friction)
    exact = solve_ivp(lambda t, v: -GRAVITY * mu(v), (0, 0.1), [1.0], rtol=1e-10).y[0, -1]
    assert exact < 0.8 and result.history["vx"].iloc[-1] == pytest.approx(exact, abs=2e-3)
    assert result["friction_work"] > 0 and result["energy_drift"] < 500 * 5e-12


def test_a_constant_is_the_coefficient(tmp_path):
    """The answers are the same bytes, in the plane; in space to round-off."""
    for axes, shape in (("plane", ff.Disc), ("space", ff.Ball)):
        zero = (0,) * (axes == "space")
        body = shape(radius=0.05, material=ff.NeoHookean(young=7e6, nu=0.4, density=1722), position=(0, 0.0501, *zero), velocity=(6, -6, *zero))
        runs = [ff.run(ff.Scene(bodies=[body], obstacles=[ff.Plane()], contact=ff.Contact(**law), accuracy=0.2), out=tmp_path / f"{axes}{k}", estimate=False, figures=False)
                for k, law in enumerate(({"friction_static": 0.5}, {"friction": 0.5 if axes == "plane" else "0.5"}))]
        for name in ("impulse", "rebound_vx", "friction_work"):
            assert runs[0][name] == pytest.approx(runs[1][name], rel=1e-9), name


def test_rubber_under_pressure_has_less_friction(tmp_path):
    """A disc with mu = 0.5 (p/p0)^(-1/5) takes more friction work from a slow press than from a fast impact;
    the scene as used is read again with the same answer."""
    rubber = ff.NeoHookean(young=7e6, nu=0.45, density=1722)
    disc = ff.Disc(radius=0.05, material=rubber, position=(0, 0.0501), velocity=(6, -10))
    result = ff.run(ff.Scene(bodies=[disc], obstacles=[ff.Plane()], contact=ff.Contact(friction="0.5*(p/1e5 + 0.01)^-0.2"), accuracy=0.1),
                    out=tmp_path / "first", estimate=False, figures=False)
    used = tomllib.loads((tmp_path / "first/scene.toml").read_text())
    assert used["contact"]["friction"].startswith("0.5*") and "friction_static" not in used["contact"]
    again = ff.run(ff.Scene.load(tmp_path / "first/scene.toml"), out=tmp_path / "again", estimate=False, figures=False)
    assert again["friction_work"] == result["friction_work"] and result["energy_drift"] < 1e-9


@pytest.mark.parametrize("contact, message", [
    ({"friction": "-0.1"}, "friction: is -0.1 at v = 0 m/s"),
    ({"friction": "exp(v)"}, "friction: is .* .accepted: 0 to 1000 everywhere"),
    ({"friction": "1/v"}, "friction: is inf at v = 0 m/s"),
    ({"friction": "p^-0.3*1e9"}, "friction: is .* Pa"),
    ({"friction": "__import__('os').system('ls')"}, "friction: .* is not known"),
    ({"friction": "0.3*w"}, "friction: 'w' in .* is not known"),
    ({"friction": "0.3", "friction_static": 0.2}, "friction_static: beside friction"),
    ({"friction": "0.3", "regularization": "linear-printed"}, "regularization: 'linear-printed' beside friction"),
    ({"pair": [{"bodies": ["disc", "plane"], "friction": "0.3"}]}, "friction: '0.3' holds for the whole scene")])
def test_other_expressions_are_refused(contact, message):
    disc = {"name": "disc", "shape": "disc", "radius": 0.05, "law": "svk", "young": 7e6, "nu": 0.4, "density": 1000, "position": [0, 0.05], "velocity": [1, -1]}
    with pytest.raises(BadInput, match=message):
        ff.Scene(bodies=[disc], obstacles=[{"kind": "plane", "name": "plane"}], contact=contact)
