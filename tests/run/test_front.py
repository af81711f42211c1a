"""Flat strikes: their recognition, and their elements, steps and penalty (front.py)."""

import tomllib

import pytest

from ffimpact import scene
from ffimpact.scenes import assembly, finer
from tests.support.front import BLOCK, scene_of


def test_what_is_used_makes_the_same_scene_again(tmp_path):
    """The scene as used reads back with equal front, elements and penalty. For a coarser scene all
    are coarser."""
    problem = scene_of(BLOCK, tmp_path)
    built = assembly.assemble(problem)
    used = tomllib.loads(assembly.to_toml(built.used))
    assert assembly.assemble(scene.read(used, tmp_path, "again")).data == built.data
    pair, = used["contact"]["pair"]
    assert used["body"][0]["mesh_size"] == pytest.approx(0.01) and pair["penalty"] == pytest.approx(1e6 / (0.02 * 0.1))
    coarse = assembly.assemble(problem.override(finer.scaled(problem, problem.values, used, 1.25))).used
    assert coarse["body"][0]["mesh_size"] == pytest.approx(1.25 * 0.01)
    assert coarse["contact"]["pair"][0]["penalty"] == pytest.approx(pair["penalty"] / 1.25)


def test_what_the_user_gives_stays(tmp_path):
    """A prescribed penalty and prescribed element sizes do not change, in a coarser run at least
    the penalty."""
    problem = scene_of(BLOCK, tmp_path, contact__penalty=1e9, body__1__mesh_size=0.02)
    used = tomllib.loads(assembly.to_toml(assembly.assemble(problem).used))
    assert used["contact"]["penalty"] == 1e9 and used["contact"].get("pair", []) == [] and used["body"][0]["mesh_size"] == 0.02
    assert finer.scaled(problem, problem.values, used, 2.0)["contact.penalty"] == 1e9
