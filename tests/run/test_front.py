"""Flat strikes: their recognition, and their elements, steps and penalty (front.py)."""

import tomllib

import pytest

from ffimpact import scene
from ffimpact.running import run
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
    coarse = assembly.assemble(problem.override(finer.scaled(problem, used, 1.25))).used
    assert coarse["body"][0]["mesh_size"] == pytest.approx(1.25 * 0.01)
    assert coarse["contact"]["pair"][0]["penalty"] == pytest.approx(pair["penalty"] / 1.25)


def test_what_the_user_gives_stays(tmp_path):
    """A prescribed penalty and prescribed element sizes do not change, in a coarser run at least
    the penalty."""
    problem = scene_of(BLOCK, tmp_path, contact__penalty=1e9, body__1__mesh_size=0.02)
    used = tomllib.loads(assembly.to_toml(assembly.assemble(problem).used))
    assert used["contact"]["penalty"] == 1e9 and used["contact"].get("pair", []) == [] and used["body"][0]["mesh_size"] == 0.02
    assert finer.scaled(problem, used, 2.0)["contact.penalty"] == 1e9


@pytest.mark.parametrize("nu, share", [(0.0, 0.05), (0.3, 0.5)])
def test_a_bar_needs_elements_along_it_only(nu, share, tmp_path):
    """A bar that lands flat has at most 0.6 of the unknowns of equal sides, and impulse and rebound
    differ by less than a share of the accuracy: its front is plane, and for nu > 0 waves from its
    sides follow.

    Both are the whole bar: its half is one long element wide, so that not the lengths alone differ,
    but also the pattern of the triangles. The half keeps the accuracy, too.
    """
    bar = BLOCK.replace("width = 0.2", "width = 0.04")
    problem, accuracy = scene_of(bar, tmp_path, body__1__nu=nu, accuracy=0.01, symmetry="full"), 0.01
    long = run.run(problem, {}, tmp_path / "long", estimate=False)
    size, stretch = (long.scene["body"][0][name] for name in ("mesh_size", "mesh_stretch"))
    plain = run.run(problem, {"body.1.mesh_size": size, "body.1.mesh_stretch": 1}, tmp_path / "plain", estimate=False)
    first, second = long.summary, plain.summary
    assert stretch > 2 and first["dofs"] < 0.6 * second["dofs"]
    assert abs(first["rebound_vy"] - second["rebound_vy"]) < share * accuracy * 0.3
    assert first["impulse"] == pytest.approx(second["impulse"], rel=share * accuracy)
    if nu == 0:
        half = run.run(problem, {"symmetry": "half"}, tmp_path / "half", estimate=False).summary
        assert [first["rebound_vy"], half["rebound_vy"]] == pytest.approx([0.3, 0.3], rel=accuracy)
