"""Which entries a law takes beside young and nu: share, or alpha and mu."""

import numpy as np
import pytest

import ffimpact as ff
from ffimpact import scene
from ffimpact.failure import BadInput

MATERIAL = {"young": 7e6, "nu": 0.4, "density": 1722}
TERMS = {"alpha": [1.3, 5, -2], "mu": [1e6, 2e5, -3e5]}


def made(law: str, **entries) -> ff.Material:
    return ff.Material(law=law, **MATERIAL | entries)


@pytest.mark.parametrize("law, entries", [("svk", {"nu": 0.3}), ("incompressible", {"nu": 0.5}), ("mooney-rivlin", {"share": 0.9, "nu": 0.5}),
                                          ("mooney-rivlin", {"share": 1, "nu": 0.34})])
def test_entries_that_a_law_takes(law, entries):
    assert made(law, **entries).numbers == ([entries["share"]] if "share" in entries else [])


def test_the_terms_of_ogden_make_its_stiffness_and_shares():
    """W = sum mu/alpha (...) has the shear modulus sum mu alpha / 2; the kernels take the shares of it."""
    ogden = ff.Ogden(nu=0.4, density=1722, **TERMS)
    parts = np.array([1.3e6, 1e6, 6e5])
    assert ogden.young is None and ogden.stiffness_of_terms == pytest.approx(2 * 1.4 * parts.sum() / 2)
    assert ogden.numbers == pytest.approx([1.3, 1.3e6 / 2.9e6, 5, 1e6 / 2.9e6, -2, 6e5 / 2.9e6])
    assert made("ogden", young=ogden.stiffness_of_terms, **TERMS).numbers == ogden.numbers


@pytest.mark.parametrize("law, entries, what", [
    ("svk", {"share": 1}, "share: of law = mooney-rivlin, not of svk (accepted: without it)"),
    ("neohookean", TERMS, "alpha: of law = ogden, not of neohookean"),
    ("mooney-rivlin", {}, "share: is missing, of law = mooney-rivlin (accepted: 0 to 1)"),
    ("mooney-rivlin", {"share": 1.1}, "share: 1.1 is out of range (accepted: 0 to 1)"),
    ("mooney-rivlin", {"share": 0.5, "nu": 0.2}, "share: 0.5 with a Poisson's ratio that is too small (accepted: to lambda/(2 mu), 0.333333)"),
    ("ogden", {"alpha": [2, 3], "mu": [1]}, "mu: '[1.0]' beside 2 of alpha (accepted: as many)"),
    ("ogden", {"alpha": [2]}, "mu: is missing, of law = ogden"),
    ("ogden", {"alpha": 4 * [2], "mu": 4 * [1]}, "alpha: '[2, 2, 2, 2]' is no list of numbers (accepted: 1 to 3 numbers"),
    ("ogden", {"alpha": [2, -2], "mu": [1, 1]}, "mu.2: 1 with the exponent -2"),
    ("ogden", {"alpha": [0], "mu": [1]}, "mu.1: 1 with the exponent 0"),
    ("ogden", TERMS, "young: 7e+06 beside alpha and mu, which make it 4060000 (accepted: without it)"),
    ("incompressible", {}, "nu: 0.4 of law = incompressible (accepted: 0.5)"),
    ("svk", {"nu": 0.49995}, "nu: 0.49995 is out of range (accepted: 0 to 0.4999, or 0.5: J = 1)")])
def test_entries_that_a_law_does_not_take(law, entries, what):
    with pytest.raises(BadInput) as refused:
        made(law, **entries)
    assert str(refused.value).startswith(f"Material: {what}")


def test_a_scene_takes_and_refuses_them():
    """By the names of the file; mu makes young; former names are refused with the present ones."""
    disc = scene.load("disc-normal")
    with pytest.raises(BadInput, match="^body.1.mu: is missing, of law = ogden"):
        disc.override({"law": "ogden", "alpha": [2]})
    with pytest.raises(BadInput, match="body.1.law_parameters: '2,1' is no entry any more .accepted: share of mooney-rivlin, alpha and mu of ogden"):
        disc.override({"law": "ogden", "body.1.law_parameters": "2,1"})
    ogden = disc.override({"law": "ogden", "nu": 0.4, "alpha": [2], "mu": [2e6]})
    assert ogden.bodies[0].made_of.young == pytest.approx(2 * 1.4 * 2e6) and any("young is reset" in line for line in ogden.released)


def test_a_body_takes_the_law_at_the_top_with_its_entries_or_another_one():
    top = {"law": "ogden", "nu": 0.4, "density": 1722, "alpha": [2.0], "mu": [2e6]}
    discs = [{"shape": "disc", "radius": 0.05, "position": [k, 0.06], "velocity": [0, -1]} for k in (0, 1)]
    discs[1] |= {"law": "neohookean", "young": 1e6}
    first, second = ff.Scene.read(top | {"body": discs, "obstacle": [{"kind": "plane"}]}).ready().bodies
    assert first.made_of.numbers == [2, 1] and first.made_of.young == pytest.approx(5.6e6)
    assert second.made_of.numbers == [] and second.made_of.young == 1e6
