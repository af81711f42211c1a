"""`until = rest`: bodies bounce under gravity with decreasing height until all are at rest
(edp/program/run/rest.idp)."""

import math
from pathlib import Path

import numpy as np
import pytest

from ffimpact.failure import BadInput, Failure
from ffimpact.output.results import Contents
from ffimpact.report import impacts
from tests.support.rest import (
    FALL,
    GRAVITY,
    NU,
    RADIUS,
    YOUNG,
    rests,
    weight,
)
from verification.measure import bodies, disc


@pytest.fixture(scope="module")
def fallen(tmp_path_factory):
    """A disc that fell from 0.5 m, and its contacts."""
    folder = tmp_path_factory.mktemp("fall") / "out"
    return disc(folder, **FALL), np.genfromtxt(folder / "run/contacts.csv", delimiter=",", names=True)


def test_a_disc_bounces_until_it_rests(fallen):
    """Each bounce is a row with its restitution, the corresponding height and the flight of the
    closed form. Viscosity takes all energy that is not stored at rest."""
    result, contacts = fallen
    rests(result, weight(math.pi * RADIUS**2))
    impacts = contacts[np.isfinite(contacts["restitution"])]
    assert result.summary["bounces"] == len(impacts) >= 8 and (np.diff(impacts["approach"]) < 0).all()
    flights, speeds = impacts["start"][1:] - impacts["end"][:-1], impacts["separation"][:-1]
    assert flights == pytest.approx(2 * speeds / GRAVITY, rel=0.05, abs=1e-3)
    assert result.summary["first_restitutions"] == pytest.approx(impacts["restitution"][:3])
    # It rests after the last onset of contact, and a period of its weight on the spring before the
    # end.
    assert contacts["start"][-1] <= result.summary["rest_time"] < result.history["t"][-1]
    start = 0.5 * weight(math.pi * RADIUS**2)
    assert result.summary["viscous_work"] == pytest.approx(start, rel=2e-3) and result.summary["friction_work"] == 0


def test_flights_are_gone_at_once(fallen):
    """Once vibration has decayed, a flight is one row. The time integration takes few steps for the
    longest flight."""
    result, _ = fallen
    longest = np.sort(result.history["dt"])[::-1]
    assert (longest[:4] > 0.05).all() and result.summary["steps"] < 60 * result.summary["bounces"]


def test_figures_know_the_flights(fallen):
    """Between the two rows of a flight the figures have its parabolas.

    Their height is (vy_0 - vy_1)^2/(8 g), the kinetic energy at the top is small, and the energy
    balance closes. The rows of the run are unchanged.
    """
    h = Contents(fallen[0].history, Path("history.csv"))
    drawn = impacts.with_flights(h)
    flight = int(np.argmax(h["dt"][2:])) + 2
    inside = (drawn["t"] >= h["t"][flight - 1]) & (drawn["t"] <= h["t"][flight])
    assert inside.sum() > 20 and np.isin(h["t"], drawn["t"]).all() and all(np.isin(h[name], drawn[name]).all() for name in ("y", "kinetic"))
    assert drawn["y"][inside].max() - h["y"][flight] == pytest.approx(np.diff(h["vy"])[flight - 1]**2 / (8 * GRAVITY), rel=0.01)
    assert drawn["kinetic"][inside].min() < 0.002 * h["kinetic"][flight]
    balance = sum(drawn[name] for name in ("kinetic", "elastic", "contact", "friction_work", "viscous_work")) - drawn["external_work"]
    assert balance == pytest.approx(balance[0], abs=1e-9 * fallen[0].summary["viscous_work"])


def test_at_rest_the_contact_is_hertz(fallen):
    """Half-width a = sqrt(4 P R (1 - nu^2)/(pi E)) to an element, largest pressure 2 P/(pi a) to
    the share of an element."""
    result, _ = fallen
    load = weight(math.pi * RADIUS**2)
    a = math.sqrt(4 * load * RADIUS * (1 - NU**2) / (math.pi * YOUNG))
    end = {name: column[-1] for name, column in result.history.items()}
    assert end["contact_half_width"] == pytest.approx(a, abs=0.0005)
    assert end["max_pressure"] == pytest.approx(2 * load / (math.pi * a), rel=0.0005 / a / 4)


def test_end_time_is_the_latest(tmp_path):
    """With an end_time the run ends there if nothing rests before, also during a flight."""
    result = disc(tmp_path, **FALL | {"end_time": 0.5, "contact_mesh_size": 0.002})
    assert result.summary["ended"] == "end_time" and result.history["t"][-1] == pytest.approx(0.5)
    assert result.summary["energy_drift"] < 1e-9 and result.summary["bounces"] == 1
    assert any(warning.startswith("not over: at the end_time the body does not rest yet") for warning in result.summary["warnings"])


def pulled(shape: dict, normal: list[float], **more) -> dict:
    """A soft body with damping that an acceleration of 9.81 m/s2 moves to a plane through the
    origin."""
    body = {"law": "neohookean", "young": 2e5, "nu": 0.3, "density": 1000.0, "loss": 2.0, "loss_model": "kelvin-voigt", "mesh_size": 0.02, "contact_mesh_size": 0.01}
    return {"until": "rest", "accuracy": 0.2, "body": [body | shape], "obstacle": [{"kind": "plane", "point": [0.0, 0.0], "normal": normal}]} | more


def test_a_pull_to_the_side_is_one(tmp_path):
    """Under a body force a disc rests on a wall as on the floor, without a warning that its contact
    is not over."""
    result = bodies(tmp_path, pulled({"shape": "disc", "radius": 0.05, "position": [0.06, 0.0]}, [1.0, 0.0], body_force_x=-9.81))
    assert result.summary["ended"] == "rest" and not any(warning.startswith("not over") for warning in result.summary["warnings"])


def test_what_is_set_down_comes_to_rest(tmp_path):
    """On the plane from the start it needs no end_time."""
    result = bodies(tmp_path, pulled({"shape": "disc", "radius": 0.05, "position": [0.0, 0.05]}, [0.0, 1.0], gravity=9.81))
    assert result.summary["ended"] == "rest"


@pytest.mark.parametrize("shape, friction, message", [
    ({"shape": "rectangle", "width": 0.06, "height": 0.04, "angle": -30.0}, 0.3, "30 degrees to the pull: friction_static 0.3 holds up to 17"),
    ({"shape": "disc", "radius": 0.02}, 0.7, "30 degrees to the pull: what is round rolls down any")], ids=["slides", "rolls"])
def test_what_a_slope_does_not_hold_is_refused(tmp_path, shape, friction, message):
    """Refused before the first step are a block beyond its angle of friction and a disc on any
    slope.

    A block within this angle comes to rest and is accepted, as is any scene with an end_time.
    """
    up = [math.sin(math.radians(30)), math.cos(math.radians(30))]
    tables = pulled(shape | {"position": [0.0201 * component for component in up]}, up, gravity=9.81, contact={"friction_static": friction})
    with pytest.raises(Failure, match=f"exit code 10.*until: no rest in sight on a plane at {message}; give an end_time > 0"):
        bodies(tmp_path, tables)
    if "width" in shape:
        assert bodies(tmp_path, tables | {"contact": {"friction_static": 0.8}}).summary["ended"] == "rest"
    assert bodies(tmp_path, tables | {"end_time": 0.02}).summary["ended"] == "end_time"


def on_slope(degrees: float, friction: float, eps: float, **more) -> dict:
    """A soft block, released slightly above a slope through the origin that falls to the right,
    with its slip velocity [m/s]."""
    up = [math.sin(math.radians(degrees)), math.cos(math.radians(degrees))]
    block = {"shape": "rectangle", "width": 0.06, "height": 0.04, "angle": -degrees, "young": 2e4,
             "position": [0.0205 * component for component in up]}
    return pulled(block, up, gravity=9.81, contact={"friction_static": friction, "slip_velocity": eps}, **more)


@pytest.mark.parametrize("eps", [0.02, 0.01])
def test_what_creeps_below_its_limit_of_friction_rests(tmp_path, eps):
    """Regularised friction carries the force along a slope of 10 degrees at v = eps tan(10
    degrees)/mu, below eps: the block sticks.

    The run ends at rest, in equilibrium, with this speed down the slope.
    """
    friction, down, accuracy = 0.3, math.radians(10), 0.05
    result = bodies(tmp_path, on_slope(10, friction, eps, accuracy=accuracy))
    end = {name: column[-1] for name, column in result.history.items()}
    assert result.summary["ended"] == "rest" and end["sliding_fraction"] == 0
    weight_across = 0.06 * 0.04 * 1000 * GRAVITY * math.cos(down)
    assert end["normal_force"] == pytest.approx(weight_across, rel=accuracy)
    assert end["vx"] / math.cos(down) == pytest.approx(eps * math.tan(down) / friction, rel=2 * accuracy)


@pytest.mark.parametrize("friction", [0.0, 0.15])
def test_what_friction_does_not_hold_is_no_rest(tmp_path, friction):
    """On a slope of 10 degrees, tan = 0.176, with a smaller mu the block is not at rest although it
    is slower than its large slip velocity.

    The same holds without friction.
    """
    result = bodies(tmp_path, on_slope(10, friction, 0.1, end_time=0.2))
    assert result.summary["ended"] == "end_time" and result.history["vx"][-1] > 0.02


@pytest.mark.parametrize("change, message", [({"gravity": 0}, "exit code 10: ffimpact: until: rest needs what pulls"),
                                             ({"loss": 0}, "exit code 10: ffimpact: until: rest needs what takes energy")], ids=str)
def test_what_never_rests_is_refused(tmp_path, change, message):
    """Without a force, or without damping, a body cannot come to rest."""
    with pytest.raises(Failure, match=message):
        disc(tmp_path / "out", **FALL | {"speed": 1} | change)
    assert not (tmp_path / "out/run").exists()


def test_an_unknown_end_is_refused(tmp_path):
    """Where the scene is read, before any file of it is written."""
    with pytest.raises(BadInput, match="^until: 'sleep' is not known .accepted: impact.rest.$"):
        disc(tmp_path / "out", **FALL | {"until": "sleep"})
    assert not (tmp_path / "out").exists()
