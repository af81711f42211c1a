"""Tests of the accuracy and of the error estimates: random scenes, and verdicts that can fail."""

import pandas as pd
import pytest

from benchmarks import draws, promise
from ffimpact import scene

SEED = promise.SCENES["round"][0]


def test_drawn_scenes_cover_what_is_promised():
    """The scenes cover all materials and both laws, below breakdown speeds, oblique and spinning,
    with and without friction. All are accepted."""
    points = draws.draw(SEED, 200)
    assert {point["young"] for point in points} == {young for young, *_ in draws.MATERIALS.values()}
    shares = [point["speed"] / draws.bar_speed(point["young"], point["density"]) / draws.FASTEST[point["law"]] for point in points]
    assert max(shares) < 1.001 and min(shares) < 0.02 and {point["law"] for point in points} == {"svk", "neohookean"}
    for name in ("spin", "friction_static", "exponent"):
        assert 10 < sum(name in point for point in points) < 190, name
    assert 10 < sum(point["direction"] != -90 for point in points) < 190
    assert all(scene.load("disc-normal").override({"fields": 0, "penalty": "auto"} | point) for point in points)


def test_hard_scenes_are_hard_and_accepted():
    """Every further parameter appears in some of the scenes only."""
    points = draws.draw(SEED, 200, hard=True)
    for name in ("integrator", "degree", "penalty", "gravity", "regularization", "symmetry", "loss"):
        assert 5 < sum(name in point for point in points) < 100, name
    assert len({point["accuracy"] for point in points}) > 2 and {"incompressible"} < {point["law"] for point in points}
    assert 5 < sum(point["nu"] > 0.48 for point in points) < 100
    assert all(scene.load("disc-normal").override({"fields": 0, "penalty": "auto"} | point) for point in points)
    on_block = draws.draw(SEED, 50, hard=True, scene="disc-block")
    assert all(scene.load("disc-block").override({"fields": 0, "penalty": "auto"} | point) for point in on_block) and not any("gravity" in point for point in on_block)
    balls = draws.draw(SEED, 50, hard=True, scene="ball-axisymmetric")
    assert all(scene.load("ball-axisymmetric").override({"fields": 0, "penalty": "auto"} | point) for point in balls) and any("gravity" in point for point in balls)


@pytest.mark.parametrize("count", [10, 60])
def test_a_mixture_has_all_dimensions_friction_and_two_bodies(count):
    """Every kind has its share, and equal seeds give equal scenes. All are accepted with automatic
    penalty."""
    drawn = draws.mixture(SEED, count)
    assert drawn == draws.mixture(SEED, count) and not any(entry in drawn for entry in draws.mixture(7, count))
    assert {name for name, _ in drawn} == set(draws.MIXTURE) and abs(len(drawn) - count) < 3
    for name, point in drawn:
        made = promise.open_scene(name, point)
        assert made.contact_values["penalty"] == "auto" and draws.words(point)
    if count == 60:
        hasFriction = [point.get("friction_static", point.get("contact.friction_static", 0)) > 0 for _, point in drawn]
        assert 15 < sum(hasFriction) < 45 and len({point["accuracy"] for _, point in drawn}) > 3


RUBBER = {"young": 7e6, "density": 1722.0, "nu": 0.45, "accuracy": 0.1}


def test_promise_compares_what_is_stated_with_a_finer_run(tmp_path):
    """Runs at accuracy 0.1 give an error and an estimate of each promised result, with the cost of
    the run and its coarser one. They are kept and reused."""
    drawn = [("disc-normal", RUBBER | {"speed": 4.0, "law": "neohookean"})]
    table = promise.compare(drawn, tmp_path)
    row = table.iloc[0]
    assert row.message == "" and 0 < row.error < 1 and row.estimated > 0 and row.seconds > 0 and row["finer seconds"] > 0
    assert row["impulse stated"] > 0 and row["friction_work stated"] == row["rebound_spin"] == 0
    kept = sorted(tmp_path.rglob("summary.json"))
    before = [path.stat().st_mtime_ns for path in kept]
    assert len(kept) >= 3 and promise.compare(drawn, tmp_path).equals(table) and [path.stat().st_mtime_ns for path in kept] == before


def test_a_scene_that_fails_is_a_row_with_its_reason(tmp_path):
    table = promise.compare([("disc-normal", RUBBER | {"speed": 30.0, "law": "svk"})], tmp_path)
    assert "det F" in table.message[0] and pd.isna(table.error[0])


@pytest.mark.few(1)
@pytest.mark.parametrize("scene, point", [
    ("disc-normal", {"law": "svk", "young": 1e6, "density": 100.0, "nu": 0.0, "radius": 0.05, "speed": 0.138, "direction": -60.0, "friction_static": 0.1,
                     "friction_dynamic": 0.07}),
    ("ball-axisymmetric", {"law": "svk", "young": 1e10, "density": 700.0, "nu": 0.3, "radius": 0.005, "speed": 91.5})])
def test_stated_errors_hold_where_the_steps_of_a_pair_are_the_same(tmp_path, scene, point):
    """At accuracy 0.1 the coarser run has larger elements and equal steps: the estimates contain
    the error of the steps nevertheless."""
    row = promise.compare([(scene, point | {"accuracy": 0.1})], tmp_path).iloc[0]
    assert row.message == "" and all(row[name] <= row[f"{name} stated"] for name in ("impulse", "rebound", "energy", "peak_force"))
