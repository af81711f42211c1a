"""Which numbers a law can take (law_parameters)."""

import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.scenes.laws import refuse_numbers


@pytest.mark.parametrize("law, text, nu", [("svk", "none", 0.3), ("incompressible", "none", 0.5), ("ogden", "1.3, 0.5, 5, 0.5", 0.4), ("mooney-rivlin", "0.9", 0.5),
                                           ("mooney-rivlin", "1", 0.34)])
def test_numbers_that_a_law_takes(law, text, nu):
    refuse_numbers("law_parameters", law, text, nu)


@pytest.mark.parametrize("law, text, nu, what", [
    ("svk", "1", 0.3, "'1' is not what svk takes (accepted: none)"),
    ("mooney-rivlin", "none", 0.3, "'none' is not what mooney-rivlin takes (accepted: 1, the share"),
    ("mooney-rivlin", "1.1", 0.4, "mooney-rivlin has share 1.1 (accepted: 0 to 1)"),
    ("mooney-rivlin", "0.5", 0.2, "mooney-rivlin has share 0.5 with a Poisson's ratio that is too small (accepted: to lambda/(2 mu), 0.333333)"),
    ("ogden", "2, 1, 3", 0.4, "'2, 1, 3' is not what ogden takes"),
    ("ogden", "2", 0.4, "'2' is not what ogden takes"), ("ogden", "1,1,1,1,1,1,1,1", 0.4, "is not what ogden takes (accepted: one to three"),
    ("ogden", "2,1.5,-2,-0.5", 0.4, "ogden has the exponent -2 with share -0.5"),
    ("ogden", "0, 1", 0.4, "ogden has the exponent 0 with share 1"),
    ("ogden", "2, 0.5", 0.4, "ogden has shares that add up to 0.5")])
def test_numbers_that_a_law_does_not_take(law, text, nu, what):
    with pytest.raises(BadInput, match="law_parameters: ") as refused:
        refuse_numbers("law_parameters", law, text, nu)
    assert what in str(refused.value)


def test_a_scene_is_refused_for_the_numbers_of_a_law():
    with pytest.raises(BadInput, match="ogden has shares that add up to 0.5"):
        scene.load("disc-normal").override({"law": "ogden", "law_parameters": "2,0.5"})
