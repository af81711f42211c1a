"""Element sizes follow the requested accuracy, and the part of a body in the errors of the results."""

import math

import pytest

from ffimpact import scene
from ffimpact.mesh.mesh import Sizes
from ffimpact.running import run
from ffimpact.scenes import approach, assembly
from tests.support.front import scene_of

SOFT = """
accuracy = 0.005
[[body]]
name = "disc"
shape = "disc"
radius = 0.02
law = "neohookean"
young = 5e6
nu = 0.45
density = 1100
position = [0.09, 0.0251]
velocity = [0, -3]
[[body]]
name = "other"
shape = "rectangle"
law = "neohookean"
young = 2.5e9
nu = 0.38
density = 1140
"""
HELD = '[[body.support]]\nwhere = "left"\nfix = "all"\n'
BEAM = SOFT + "width = 0.2\nheight = 0.01\nposition = [0, 0]\n" + HELD
BLOCK = SOFT + "width = 0.2\nheight = 0.2\nposition = [0.09, -0.095]\n"


def sizes_of(problem: scene.Scene) -> list[Sizes]:
    ask = assembly.AutomaticValues(problem, approach.onsets_of(problem))
    return [assembly.element_sizes(k, ask) for k in range(len(problem.bodies))]


def test_a_held_body_is_not_turned_by_an_impact(tmp_path):
    """Bodies strike again with other parts if the impact turns them. A disc turns neither itself,
    nor a beam that a support holds; it turns a free beam."""
    held, free = (scene_of(text, tmp_path) for text in (BEAM, BEAM.replace(HELD, "")))
    assert len(approach.onsets_of(held)) == 1 and len(approach.onsets_of(free)) > 1


@pytest.mark.parametrize("text", [BEAM, BLOCK], ids=["beam", "block"])
def test_elements_grow_with_the_accuracy_up_to_what_the_shape_needs(text, tmp_path):
    """All sizes grow like its square root, up to two elements across a slender body, four across a
    compact one, and two in the half-width of a contact."""
    last = None
    for accuracy in (0.00125, 0.0025, 0.005, 0.01, 0.02, 0.04):
        problem = scene_of(text, tmp_path, accuracy=accuracy)
        found = sizes_of(problem)
        widest = max(size.contact for size in sizes_of(scene_of(text, tmp_path, accuracy=0.4)))
        for size, before, body in zip(found, last or [None] * 2, problem.bodies):
            assert size.bulk <= body.outline.coarsest * (1 + 1e-9) and size.contact <= widest * (1 + 1e-9)
            if before:
                assert size.bulk == pytest.approx(min(math.sqrt(2) * before.bulk, body.outline.coarsest), rel=1e-6)
                assert size.contact >= min(1.3 * before.contact, 0.97 * widest)
        last = found


def test_stiff_bodies_have_the_elements_of_their_part_in_the_error(tmp_path):
    """A block, 500 times as stiff as the disc, has the largest elements, the beam those of its
    bending; of equal materials both have equal elements in contact."""
    _, block = sizes_of(scene_of(BLOCK, tmp_path))
    _, beam = sizes_of(scene_of(BEAM, tmp_path))
    disc, alike = sizes_of(scene_of(BLOCK.replace("2.5e9", "5e6").replace("0.38", "0.45"), tmp_path))
    assert block.bulk == pytest.approx(0.05) and beam.bulk == pytest.approx(0.005 * 0.32 * math.sqrt(2), rel=1e-6)
    assert alike.bulk == pytest.approx(0.1 * 0.32 * math.sqrt(2), rel=1e-6)
    assert alike.contact == pytest.approx(disc.contact, rel=0.05) and block.contact > 1.5 * alike.contact


@pytest.mark.parametrize("text", [BEAM, BLOCK], ids=["beam", "block"])
def test_coarse_elements_of_stiff_bodies_keep_the_answers(text, tmp_path):
    """With smaller elements, as equal materials have them for a quarter of the accuracy, results of
    the first 2 ms differ by less than the accuracy."""
    entries = {"dt": 5e-5, "end_time": 0.002, "accuracy": 0.02}
    fine = {"body.1.mesh_size": 0.009, "body.1.contact_mesh_size": 0.0008, "body.2.mesh_size": 0.00225, "body.2.contact_mesh_size": 0.0008}
    if text == BLOCK:
        fine["body.2.mesh_size"] = 0.04
    coarse, close = (run.run(scene_of(text, tmp_path), entries | sizes, tmp_path / name, estimate=False).summary
                     for name, sizes in (("coarse", {}), ("fine", fine)))
    assert coarse["dofs"] < 0.6 * close["dofs"]
    assert coarse["impulse"] == pytest.approx(close["impulse"], rel=0.01)
    assert coarse["final_vy_1"] == pytest.approx(close["final_vy_1"], abs=0.02 * 3)


def test_a_shielded_body_has_no_small_elements(tmp_path):
    """A rigid weight that falls on a pad would strike the plate under it with a sharp contact. The
    plate has small elements only if the pad lies aside."""
    weight = 'rigid = true\nmass = 20\n'
    text = SOFT.replace("accuracy = 0.005", "accuracy = 0.02").replace('law = "neohookean"\nyoung = 5e6\nnu = 0.45\ndensity = 1100\n', weight) \
        + 'width = 0.3\nheight = 0.01\nposition = [0, -0.02]\n' + HELD \
        + '[[body]]\nname = "pad"\nshape = "rectangle"\nwidth = 0.06\nheight = 0.02\nlaw = "neohookean"\nyoung = 5e6\nnu = 0.45\ndensity = 1200\n'
    between, aside = (sizes_of(scene_of(text + f"position = [{x}, -0.005]\n", tmp_path)) for x in (0.09, -0.05))
    assert between[1].contact > 5 * aside[1].contact and between[0].contact > 5 * aside[0].contact
