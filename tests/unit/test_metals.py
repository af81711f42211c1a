"""Entries of metals: what is refused, and their numbers."""

import math
from dataclasses import replace

import pytest

import ffimpact as ff
from ffimpact.failure import BadInput
from ffimpact.scenes import assembly
from ffimpact.scenes.sizes import Impact

STEEL = {"young": 210e9, "nu": 0.3, "density": 7800.0}


@pytest.mark.parametrize("entries, words", [
    ({}, "yield_stress: is missing"),
    ({"yield_stress": 0}, "yield_stress: 0"),
    ({"yield_stress": -1e8}, "yield_stress: -100000000.0 is out of range"),
    ({"yield_stress": 3e11}, "yield_stress: 3e+11 Pa is not below young"),
    ({"yield_stress": 1e8, "yield_curve": [[0, 1e8]]}, "yield_curve: beside yield_stress"),
    ({"yield_curve": [[0.1, 1e8]]}, "yield_curve: "),
    ({"yield_curve": [[0, 1e8], [0.1, 9e7]]}, "yield_curve: "),
    ({"yield_curve": [[0, 1e8], [0, 2e8]]}, "yield_curve: "),
    ({"yield_curve": [[0, 1e8, 1]]}, "yield_curve.1: "),
    ({"yield_curve": [[0, "a"]]}, "yield_curve"),
    ({"yield_curve": []}, "yield_curve: "),
    ({"yield_stress": 1e8, "hardening": -1}, "hardening: -1"),
    ({"yield_stress": 1e8, "voce": [1e8]}, "voce: "),
    ({"yield_stress": 1e8, "perzyna": [10, 0]}, "perzyna"),
    ({"yield_stress": 1e8, "perzyna": [4, 1e4]}, "perzyna.2: 10000 is out of range"),
    ({"yield_stress": 1e8, "johnson_cook": [10, 0.1]}, "johnson_cook.1: 10 is out of range"),
    ({"yield_stress": 1e8, "perzyna": [10, 2], "johnson_cook": [0.1, 1]}, "johnson_cook: beside perzyna"),
    ({"yield_stress": 1e8, "branches": [[1e8, 1e-5]]}, "branches: beside law = metal"),
    ({"yield_stress": 1e8, "loss": 0.1}, "loss: beside law = metal"),
    ({"yield_stress": 1e8, "share": 0.1}, "share: "),
], ids=str)  # fmt: skip
def test_wrong_entries_are_named(entries, words):
    with pytest.raises(BadInput, match="^Metal: ") as caught:
        ff.Metal(**STEEL | entries)
    assert words in str(caught.value)


def test_other_laws_do_not_yield():
    with pytest.raises(BadInput, match="yield_stress"):
        ff.NeoHookean(yield_stress=1e8, **STEEL)
    scene = {"law": "svk", "body": [{"shape": "disc", "radius": 0.01, "position": [0, 0.02], "velocity": [0, -1], "yield_stress": 1e8} | STEEL], "obstacle": [{"kind": "plane"}]}
    with pytest.raises(BadInput, match="yield_stress: of law = metal, not of svk"):
        assembly.assemble(ff.Scene.read(scene).ready())


def test_numbers_for_the_kernels():
    """H, Q, b, n, C, rate0, then the points of the curve."""
    table = [[0, 1e8], [0.1, 2e8]]
    metal = ff.Metal(yield_curve=table, hardening=1e9, voce=[5e7, 10], perzyna=[100, 2], **STEEL)
    assert metal.numbers == [1e9, 5e7, 10, 2, 0, 100, 0, 1e8, 0.1, 2e8]
    assert ff.Metal(yield_stress=1e8, johnson_cook=[0.02, 1], **STEEL).numbers == [0, 0, 0, 0, 0.02, 1, 0, 1e8]


def test_a_body_of_another_law_does_not_take_the_yield_stress_of_the_scene():
    bodies = [{"shape": "disc", "radius": 0.01, "position": [0, 0.02], "velocity": [0, -1]}, {"shape": "disc", "radius": 0.01, "position": [0, 0.05], "law": "svk"}]
    scene = ff.Scene.read(STEEL | {"law": "metal", "yield_stress": 1e8, "body": bodies}).ready()
    first, second = (body.made_of for body in scene.bodies)
    assert first.yield_stress == 1e8 and second.yield_stress is None


@pytest.mark.parametrize("sphere, work", [(True, lambda a, p: math.pi * a**4 * p / 4), (False, lambda a, p: 2 * a**3 * p / 3)], ids=["ball", "disc"])
def test_a_yielding_contact_is_wider(sphere, work):
    """Its half-width stores the kinetic energy at a pressure of 2.8 sigma_y; the penalty follows it."""
    elastic = Impact(sphere, 1.0, 210e9, 0.3, 7800.0, 20.0, 0.02)
    soft = replace(elastic, hardness=ff.Metal(**STEEL, yield_stress=2e8).hardness)
    mass = 7800.0 * math.pi * (4 / 3 if sphere else 1)
    assert work(soft.yielding_half_width, 2.8 * 2e8) == pytest.approx(mass * 20.0**2 / 2)
    assert soft.penalty == pytest.approx(elastic.penalty * elastic.half_width / soft.yielding_half_width)
    assert replace(elastic, hardness=1e12).penalty == elastic.penalty
