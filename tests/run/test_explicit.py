"""Central differences: contact and friction are solved on the lumped mass.

Hence only waves in the bodies determine the substeps of a step.
"""

import math
from functools import cache

import pytest

from ffimpact import scene
from ffimpact.running import run
from tests.support.explicit import EXPLICIT, OBLIQUE
from verification.measure import disc


@pytest.fixture(scope="module")
def explicit(tmp_path_factory):
    """explicit(name=value, ...): a run of the oblique disc with explicit steps. Every run is made
    once."""
    return cache(lambda **more: disc(tmp_path_factory.mktemp("explicit"), **OBLIQUE | EXPLICIT | more))


@pytest.fixture(scope="module")
def runs(tmp_path_factory, explicit):
    """The oblique disc with the implicit default and with explicit steps."""
    return {"implicit": disc(tmp_path_factory.mktemp("implicit"), **OBLIQUE), "explicit": explicit()}


def parts(result) -> int:
    return result.summary["residual_evaluations"]


def conserves(result, drift: float) -> None:
    assert result.summary["momentum_drift"] < 1e-12 and (result.summary["angular_momentum_drift"] or 0) < 1e-12
    assert result.summary["energy_drift"] < drift


def test_explicit_steps_agree_with_the_conserving_ones(runs):
    """Impulse, rebound and friction work agree with the implicit run on the same mesh. Momenta are
    exact, and the small energy drift is reported."""
    there, summary = runs["implicit"].summary, runs["explicit"].summary
    assert summary["impulse"] == pytest.approx(there["impulse"], rel=0.002)
    for name, scale in (("rebound_vx", 12), ("rebound_vy", 12), ("rebound_spin", 12 / 0.05)):
        assert summary[name] == pytest.approx(there[name], abs=0.005 * scale), name
    assert summary["friction_work"] == pytest.approx(there["friction_work"], abs=0.005 * there["energy_initial"])
    assert summary["contact_time"] == pytest.approx(there["contact_time"], rel=0.03)
    conserves(runs["explicit"], 2e-4)


@pytest.mark.few(1)
@pytest.mark.parametrize("change", [{"penalty": 1e11}, {"penalty": 1e12}, {"slip_velocity": 0.01}], ids=str)
def test_penalty_and_slip_velocity_do_not_set_the_step(runs, explicit, change):
    """Ten and a hundred times the penalty, and a tenth of slip_velocity, do not change the number
    of substeps."""
    result = explicit(**change)
    assert parts(result) == pytest.approx(parts(runs["explicit"]), rel=0.05)
    assert result.summary["impulse"] == pytest.approx(runs["explicit"].summary["impulse"], rel=0.01)
    conserves(result, 2e-3)


@pytest.mark.robustness
def test_no_node_bounces_alone(runs, explicit, tmp_path):
    """For any penalty, rebound and spin agree with the implicit run at 1e11 to 0.5 % of the speed,
    the friction work to 1 % of the energy.

    The run reports the penalty at which nodes do not bounce.
    """
    there = disc(tmp_path / "implicit", **OBLIQUE | {"penalty": 1e11}).summary
    for penalty in (1e11, 1e13):
        result = explicit(penalty=penalty)
        for name, scale in (("rebound_vx", 12), ("rebound_vy", 12), ("rebound_spin", 12 / 0.05), ("friction_work", 2 * there["energy_initial"])):
            assert result.summary[name] == pytest.approx(there[name], abs=0.005 * scale), name
        conserves(result, 1e-3)
        assert any(words.startswith("explicit penalty: ") for words in result.summary["warnings"])
    assert not any(words.startswith("explicit penalty: ") for words in runs["explicit"].summary["warnings"])


def test_records_follow_the_accuracy(runs):
    """The number of recorded steps is that of an implicit run, whatever the substeps. Their forces
    add up to the impulse."""
    result = runs["explicit"]
    assert result.summary["steps"] < 1.5 * runs["implicit"].summary["steps"] and parts(result) > 5 * result.summary["steps"]
    assert (result.history["dt"] * result.history["normal_force"]).sum() == pytest.approx(result.summary["impulse"], rel=1e-12)


@pytest.mark.robustness
def test_a_step_that_is_given_is_parted(runs, tmp_path):
    """`dt` is the recorded step. Contact times have the resolution of the substeps and hardly
    depend on `dt`."""
    result = disc(tmp_path, **OBLIQUE | EXPLICIT | {"dt": 2e-5})
    for name in ("contact_start", "contact_time"):
        assert result.summary[name] == pytest.approx(runs["explicit"].summary[name], rel=0.005, abs=1e-7), name


@pytest.mark.few(2)
@pytest.mark.parametrize("name, settings", [("two-discs", {}), ("disc-corner", {}), ("ball", {"end_time": 2e-3}), ("ball-axisymmetric", {})], ids=str)
def test_every_kind_of_scene_conserves(tmp_path, name, settings):
    """Gap Jacobians that rotate with two bodies are iterated until momenta are exact, also with
    several obstacles, in space and of revolution."""
    conserves(run.run(scene.load(name), settings | EXPLICIT | {"accuracy": 0.2}, tmp_path / "out", estimate=False), 5e-3)


def test_every_body_has_its_mass(tmp_path):
    """The mass of a round and a straight body of revolution is that of the implicit run."""
    content = {"dimension": "axisymmetric", "law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "accuracy": 0.1, "end_time": 1e-4,
               "body": [{"shape": "ball", "radius": 0.05, "position": 0.0501, "velocity": -4},
                        {"shape": "cylinder", "radius": 0.03, "height": 0.04, "position": -0.0201}]}
    masses = []
    for integrator in ("energy-momentum", "central-difference"):
        read = scene.read(content | {"integrator": integrator}, tmp_path, integrator)
        summary = run.run(read, {}, tmp_path / integrator, estimate=False).summary
        masses += [[summary["mass_1"], summary["mass_2"]]]
    assert masses[1] == pytest.approx(masses[0], rel=1e-13)


def test_an_obstacle_has_its_own_penalty(tmp_path):
    """The scene's penalty does not limit that of an obstacle, which may be stiffer: a plane with
    1e10 is the same whether the scene has 1e9 or 1e10."""
    depths = []
    for own, common in (({"penalty": 1e10}, 1e9), ({}, 1e10)):
        content = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "end_time": 2e-3, "dt": 2e-5, **EXPLICIT, "contact": {"penalty": common},
                   "body": [{"shape": "disc", "radius": 0.05, "position": [0, 0.0501], "velocity": [0, -4], "mesh_size": 0.012, "contact_mesh_size": 0.006}],
                   "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1], **own}]}
        result = run.run(scene.read(content, tmp_path, "own"), {}, tmp_path / f"out{common:g}", estimate=False)
        depths.append(result.summary["max_penetration"])
        assert not any(words.startswith("explicit penalty: ") for words in result.summary["warnings"])
    assert depths[0] == pytest.approx(depths[1], rel=1e-9) and depths[0] > 1e-5


DRIVEN = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000, "accuracy": 0.1, "end_time": 2.5e-3,
          "contact": {"penalty": 2e9, "friction_static": 0.4, "slip_velocity": 0.05}, **EXPLICIT}


def struck(tmp_path, name, velocity, obstacle):
    """A disc that hits a driven obstacle."""
    disc = {"shape": "disc", "radius": 0.05, "position": [0, 0.0501], "velocity": velocity, "contact_mesh_size": 0.005}
    tables = DRIVEN | {"body": [disc], "obstacle": [obstacle]}
    return run.run(scene.read(tables, tmp_path, name), {}, tmp_path / name, estimate=False)


def test_a_driven_plane_strikes_as_it_is_struck(tmp_path):
    """A plane that a function of time moves at V strikes a disc at rest as the disc strikes the plane
    at rest, seen from a frame at V. The work of the plane is V times the impulse."""
    plane, speed = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}, 2.0
    moved = struck(tmp_path, "moved", [0, 0], plane | {"motion": ["0", f"{speed}*t"]}).summary
    still = struck(tmp_path, "still", [0, -speed], plane).summary
    assert moved["impulse"] == pytest.approx(still["impulse"], rel=1e-4) and moved["rebound_vy"] == pytest.approx(still["rebound_vy"] + speed, rel=1e-4)
    assert moved["external_work"] == pytest.approx(speed * moved["impulse"], rel=1e-9)


def test_a_turning_cylinder_works_by_its_moment(tmp_path):
    """The work of a cylinder that turns at a constant rate is the rate times the angular momentum
    that the disc gains about the cylinder's axis."""
    rate, axis = math.radians(3000), -0.2
    cylinder = {"kind": "circle", "centre": [0, axis], "radius": -axis, "rotation": "3000*t", "pivot": [0, axis]}
    result = struck(tmp_path, "turns", [0, -2], cylinder)
    mass, at = result.summary["mass"], result.history
    about = at["angular_momentum"] + mass * (at["x"] * at["vy"] - (at["y"] - axis) * at["vx"])
    gained = about[-1] - about[0]
    assert result.summary["external_work"] == pytest.approx(rate * gained, rel=1e-3) and result.summary["friction_work"] > 0.1 * abs(rate * gained) > 0
    assert result.summary["energy_drift"] < 1e-3
