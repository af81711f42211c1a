"""`until = rest`: bodies bounce under gravity with decreasing height until all are at rest
(edp/program/run/rest.idp)."""

import math

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput, Failure
from ffimpact.report import drawing
from ffimpact.running import run
from tests.support.rest import (
    DENSITY,
    FALL,
    GRAVITY,
    NU,
    RADIUS,
    REST,
    YOUNG,
    rests,
    weight,
)
from verification.measure import bodies, disc


@pytest.mark.robustness
def test_a_ball_comes_to_rest(tmp_path):
    """A ball of revolution: its contact is Hertz' circle, a^3 = 3 P R (1 - nu^2)/(4 E), to an
    element."""
    result = disc(tmp_path, "ball-axisymmetric", **FALL | {"height": 0.02, "contact_mesh_size": 0.001, "loss": 2, "loss_model": "kelvin-voigt"})
    load = weight(4 / 3 * math.pi * RADIUS**3)
    rests(result, load)
    assert result.history["contact_half_width"][-1] == pytest.approx((0.75 * load * RADIUS * (1 - NU**2) / YOUNG)**(1 / 3), abs=0.001)


@pytest.mark.robustness
def test_friction_stops_a_disc(tmp_path):
    """With a backspin of 2 v/R friction stops sliding and spin together. On a rough plane the disc
    stops after v^2/(2 mu g)."""
    result = disc(tmp_path, **REST | {"speed": 0.5, "angle": 0, "spin": 20, "friction_static": 0.5, "symmetry": "full"})
    rests(result, weight(math.pi * RADIUS**2))
    energy = weight(math.pi * RADIUS**2) / GRAVITY * (0.5**2 / 2 + (RADIUS * 20)**2 / 4)
    assert result.summary["friction_work"] == pytest.approx(energy, rel=0.02)
    assert np.interp(0.1, result.history["t"], result.history["x"]) == pytest.approx(0.5**2 / (2 * 0.5 * GRAVITY), rel=0.05)


@pytest.mark.robustness
def test_what_rolls_on_ends_the_run(tmp_path):
    """A soft rolling disc loses a few percent of its energy per second: the run ends while it rolls
    with its weight on the plane, and reports it.

    Its outline is fine all around. With an end_time the run continues.
    """
    rolls = REST | {"young": 7e5, "speed": 0.5, "angle": 0, "spin": -10, "friction_static": 0.5, "loss": 0.2, "loss_model": "kelvin-voigt", "accuracy": 0.2, "symmetry": "full", "mesh_size": 0.025,
                    "contact_mesh_size": 0.003}
    result = disc(tmp_path / "on", **rolls)
    assert result.summary["ended"] == "rolling" and result.summary["energy_drift"] < 1e-9 and any(warning.startswith("rest: ") for warning in result.summary["warnings"])
    assert result.history["normal_force"][-1] == pytest.approx(weight(math.pi * RADIUS**2), rel=0.2)
    assert result.history["vx"][-1] == pytest.approx(0.5, rel=0.05) == pytest.approx(-RADIUS * result.history["spin"][-1], rel=0.05)
    assert disc(tmp_path / "until", **rolls, end_time=0.05).summary["ended"] == "end_time"


@pytest.mark.robustness
def test_a_scene_says_it_in_toml_and_python(tmp_path):
    """The built-in scene, coarser: the figure of its height is drawn, an unknown word is refused,
    and a free block cannot come to rest."""
    coarse = {"mesh_size": 0.02, "contact_mesh_size": 0.005, "loss": 2, "loss_model": "kelvin-voigt", "penalty": 1e10, "position": [0, 0.1], "accuracy": 0.2}
    result = run.run(scene.load("disc-rest"), coarse, tmp_path / "out", estimate=False)
    assert result.scene["until"] == "rest" and result.summary["ended"] == "rest"
    drawing.draw(result.folder)
    assert (result.folder / "figures/height.png").stat().st_size > 5000
    with pytest.raises(BadInput, match="until: 'sleep'"):
        scene.load("disc-rest").override({"until": "sleep"})
    with pytest.raises(Failure, match="until: rest needs an obstacle"):
        run.run(scene.load("disc-block"), {"until": "rest", "gravity": 9.81, "loss": 1, "loss_model": "kelvin-voigt", "accuracy": 0.3}, tmp_path / "block", estimate=False)


@pytest.mark.robustness
def test_two_bodies_rest(tmp_path):
    """A disc falls on another one in a hollow circle: both come to rest, with their weights on the
    circle."""
    body = {"shape": "disc", "radius": 0.05, "law": "neohookean", "young": 2e6, "nu": 0.3, "density": 1000.0, "loss": 2.0, "loss_model": "kelvin-voigt", "mesh_size": 0.03,
            "contact_mesh_size": 0.01}
    tables = {"gravity": 9.81, "until": "rest", "accuracy": 0.2, "contact": {"friction_static": 0.3},
              "body": [body | {"name": "low", "position": [0.0, 0.051]}, body | {"name": "high", "position": [0.0, 0.16]}],
              "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}, {"kind": "plane", "point": [-0.0501, 0], "normal": [1, 0]},
                           {"kind": "plane", "point": [0.0501, 0], "normal": [-1, 0]}]}
    result = bodies(tmp_path, tables)
    assert result.summary["ended"] == "rest" and result.summary["energy_drift"] < 1e-9
    assert result.history["y_2"][-1] - result.history["y_1"][-1] == pytest.approx(0.1, rel=0.02)


@pytest.mark.robustness
def test_nothing_rests_while_another_body_falls(tmp_path):
    """A slab lies still long before the disc above it lands. The run ends when both rest, each
    weight on its support."""
    slab = {"name": "slab", "shape": "rectangle", "width": 0.4, "height": 0.1, "position": [0, 0.05], "loss": 2.0, "loss_model": "kelvin-voigt", "mesh_size": 0.05, "contact_mesh_size": 0.05}
    falls = {"name": "disc", "shape": "disc", "radius": 0.005, "position": [0, 0.16], "loss": 1.0, "loss_model": "kelvin-voigt", "mesh_size": 0.004}
    result = bodies(tmp_path / "out", REST | {"young": 1e6, "density": DENSITY, "loss": 0, "accuracy": 0.2, "body": [slab, falls], "obstacle": [
        {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}]})
    table = np.genfromtxt(tmp_path / "out/run/contacts.csv", delimiter=",", names=True)
    last = table[table["partner"] == 2][-1]
    assert result.summary["ended"] == "rest" and last["over"] == 0 and last["start"] > math.sqrt(2 * 0.055 / GRAVITY)
    assert result.history["force_y_2"][-1] == pytest.approx(weight(math.pi * 0.005**2), rel=0.2)
