"""Measurements of runs: run time against error, runs without savings, other units, phases."""

import numpy as np
import pandas as pd
import pytest

from benchmarks import bench
from ffimpact import scene
from ffimpact.running import run


def rows(**columns) -> pd.DataFrame:
    return pd.DataFrame({"program": "ffimpact", "exit": 0, "setting": ""} | columns)


def test_cheapest_setting_reaches_the_level_in_every_answer():
    """The least time among settings below the level in all columns. There is none if no setting is
    below it or the run failed."""
    table = rows(family=["a", "b", "c"], seconds=[1.0, 2.0, 3.0], impulse_error=[0.5, 0.1, 0.01], rebound_vy_error=[9.0, 0.1, 0.01])
    assert bench.cheapest(table, ["impulse_error"], 1.0) == "1.00 s: a"
    assert bench.cheapest(table, ["impulse_error", "rebound_vy_error"], 1.0) == "2.00 s: b"
    assert bench.cheapest(table, ["impulse_error"], 0.001) == bench.cheapest(table.assign(exit=12), ["impulse_error"], 5.0) == "none"


@pytest.mark.parametrize("name", [name for name, case in bench.CASES.items() if not case.families])
def test_settings_cover_what_is_compared(name):
    """Mesh size, both degrees, fixed and adaptive steps and every integrator, from coarse to fine.
    The reference is finer than all."""
    case = bench.CASES[name]
    families = bench.settings(case, quick=False)
    assert {"midpoint", "backward-euler", "bdf2", "central-difference"} <= set(families)
    every = [point for points in families.values() for point in points]
    assert {point.get("degree", 2) for point in every} == {1, 2} and len({str(point) for point in every}) == len(every)
    finest = min(point["accuracy"] for point in every if "accuracy" in point and point.get("degree", 2) == 2)
    by_accuracy, by_size = bench.references(case, quick=False)
    assert by_accuracy["accuracy"] < finest / 2
    assert by_size["dt"] < min(point["dt"] for point in every if "dt" in point)
    assert by_size["mesh_size"] < min(point["mesh_size"] for point in every if "mesh_size" in point)


def answers(folder, name="disc-normal", **settings) -> np.ndarray:
    """Impulse and rebound of a coarse run."""
    end = run.run(scene.load(name), {"fields": 0} | settings, folder, estimate=False).summary
    return np.array([end["impulse"], end["rebound_vy"]])


@pytest.mark.few(3)
@pytest.mark.parametrize("instead", [{"symmetry": "full"}, *({"without": word} for word in ("flight", "friction", "body-force", "frozen-factorisation",
                                                                                           "contact-culling"))], ids=str)
def test_what_is_saved_changes_no_answer(tmp_path_factory, instead):
    """Without one of the savings, impulse and rebound stay within the accuracy of the run."""
    base = {"accuracy": 0.03, "body.1.position.2": 0.06}
    full = answers(tmp_path_factory.getbasetemp() / "all-savings", **base)
    assert answers(tmp_path_factory.mktemp("without"), **base, **instead) == pytest.approx(full, rel=base["accuracy"])


@pytest.mark.parametrize("world", [{"young": 7.0, "density": 1.722e-9, "radius": 50.0}, {"young": 2.1e11, "density": 7850.0, "radius": 0.05}],
                         ids=["millimetres", "steel"])
def test_one_impact_in_other_units_and_materials(tmp_path, world):
    """V19: with automatic penalty and sizes the dimensionless results depend on v/c, nu and law
    only, to 1e-6."""
    paper, ratios = {"young": 7e6, "density": 1722.0, "radius": 0.05}, []
    for name, material in (("paper", paper), ("other", world)):
        c = (material["young"] / material["density"]) ** 0.5
        impulse, rebound = answers(tmp_path / name, law="svk", nu=0.45, accuracy=0.02, penalty="auto", speed=8 / 63.757559 * c, **material,
                                  **{"body.1.position.2": material["radius"]})
        ratios.append([impulse / (material["density"] * material["radius"] ** 2 * c), rebound / c])
    assert ratios[1] == pytest.approx(ratios[0], rel=1e-6)


@pytest.mark.parametrize("without, effect", [("flight", "flight before touch"), ("friction", "friction"), ("body-force", "body force")])
def test_what_is_left_out_is_not_called_skipped(tmp_path, without, effect):
    """`skipped` in the summary lists only effects that a run really skipped."""
    settings = {"accuracy": 0.2, "body.1.position.2": 0.051, "end_time": 5e-4}
    full, left_out = (run.run(scene.load("disc-normal"), settings | {"without": word, "fields": 0}, tmp_path / word, estimate=False)
                      for word in ("none", without))
    assert effect in full.summary["skipped"] and effect not in left_out.summary["skipped"]
    assert left_out.summary["energy_drift"] < 1e-9


# Iterations per step; 13, 14 and 9 with rarer updates.
EFFORTS = {"disc-normal": 9, "disc-oblique": 10, "two-discs": 8}


@pytest.mark.few(3)
@pytest.mark.parametrize("name", EFFORTS)
def test_a_step_takes_few_iterations(tmp_path, name):
    """Iterations and factorisations per step of the kernels: a matrix is updated as soon as this pays."""
    end = run.run(scene.load(name), {"accuracy": 0.05, "fields": 0}, tmp_path / "a", estimate=False).summary
    assert end["newton_iterations"] < EFFORTS[name] * end["steps"] and end["factorizations"] < end["steps"]
    assert end["energy_drift"] < 1e-9 and end["momentum_drift"] < 1e-9 and end["rejected_steps"] == 0


def test_phases_add_up_to_the_wall_time(tmp_path):
    """phase_seconds adds up to the wall time, and `other` is not negative beyond the 10 ms of the
    clock."""
    end = run.run(scene.load("disc-normal"), {"accuracy": 0.1, "fields": 0}, tmp_path / "a", estimate=False).summary
    assert sum(end["phase_seconds"].values()) == pytest.approx(end["wall_seconds"], abs=1e-9) and end["phase_seconds"]["other"] > -0.02
    assert set(end["phase_seconds"]) == {"assembly", "factor", "solve", "contact", "search", "output", "audit", "flight", "setup", "other"}
    assert end["residual_evaluations"] >= end["newton_iterations"] and 1e6 < end["peak_memory"] < 1e9
