"""Scenes of several bodies by every interface: disc-block, a TOML file, direct runs, sweeps,
figures."""

from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.scene import read as read_scene


def test_an_entry_that_no_body_takes_is_refused():
    """An entry at the top applies to bodies without their own value. If all bodies have one, it
    would change nothing, also in a sweep."""
    tables = scene.load("disc-bowl").content
    own = read_scene(tables | {"body": [tables["body"][0] | {"young": 7e6}]}, Path("."), "own")
    with pytest.raises(BadInput, match=r"young: changes nothing, as every body has its own \(accepted: body.1.young and so on\)"):
        own.override({"young": 1e6})
    assert scene.load("disc-bowl").override({"young": 1e6}).bodies[0].made_of.young == 1e6


def test_nonsense_that_is_set_is_refused_in_words():
    """Any value in place of a table or an entry, beside entries with dependent entries, is accepted
    or raises BadInput."""
    bowl, refused = scene.load("disc-bowl"), 0
    for name in ("body", "body.1", "obstacle", "obstacle.1", "contact", "contact.pair", "body.1.radius", "contact.penalty", "dt", "contact.friction_dynamic"):
        for text in ("3", "x", "[3]", "[]", "{}", "[{}]", "{pair = 3}", "{pair = [3]}", "{penalty = {a = 1}}", "true", "1979-05-27", "[[[1]]]", "nan"):
            try:
                bowl.override({name: text, "young": 3e6, "contact.exponent" if name != "contact" else "gravity": 2, "contact.friction_static" if name != "contact" else "density": 0.1})
            except BadInput as error:
                refused += 1
                assert len(str(error)) < 800
    assert refused > 100
