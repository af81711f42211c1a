"""The table of parameters, and scenes made of it."""

import re

import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.input import parameters
from ffimpact.input.contact import CONTACT
from ffimpact.input.models import RUN
from ffimpact.places import ROOT


def test_the_scripts_take_the_parameters_of_the_table():
    """edp/program/input/parameters.idp takes every parameter of a run, and no other entry."""
    text = (ROOT / "edp/program/input/parameters.idp").read_text()
    assert sorted(re.findall(r'input(?:Real|Int|Text)\("(\w+)"', text)) == sorted((*CONTACT, *RUN))


def test_every_row_has_its_words():
    """Each parameter has a unit, a meaning and an accepted default."""
    for row in parameters.PARAMETERS.values():
        assert row.unit and row.help and row.check(row.default) == row.default, row.name


def test_known_rows():
    """Values of the table have their types."""
    table = parameters.PARAMETERS
    assert (table["young"].default, table["young"].unit, table["young"].low) == (7e6, "Pa", 1e-6)
    assert table["law"].words[:2] == ("svk", "neohookean")
    assert table["fields"].kind == "int" and type(table["fields"].default) is int
    assert "mesh" not in parameters.PARAMETERS


@pytest.mark.parametrize("entry, value", [("8", 8.0), ("+8.5", 8.5), (".5", 0.5), ("1e-3", 1e-3), (8, 8.0)])
def test_numbers_that_are_accepted(entry, value):
    """Text and TOML values give the same number."""
    assert parameters.check({"speed": entry}) == {"speed": value}


@pytest.mark.parametrize("name, entry, message", [
    ("speed", "8x", "speed: '8x' is not a number (accepted: 0 to 1e+09)"),
    ("speed", float("nan"), "speed: nan is out of range (accepted: 0 to 1e+09)"),
    ("speed", True, "speed: 'true' is not a number (accepted: 0 to 1e+09)"),
    ("fields", "2.5", "fields: '2.5' is not a whole number (accepted: 0 to 10000)"),
    ("law", "hooke", "law: 'hooke' is not known; did you mean neohookean? (accepted: " + "|".join(parameters.PARAMETERS["law"].words) + ")"),
])
def test_bad_values_are_named_with_what_is_accepted(name, entry, message):
    """The message has the parameter, the value and the range or the words, as in the scripts."""
    with pytest.raises(BadInput) as error:
        parameters.check({name: entry})
    assert str(error.value) == message and error.value.code == 10


def test_unknown_parameter_gets_a_suggestion():
    """The message has the misspelt parameter, the closest match and the list of all parameters."""
    with pytest.raises(BadInput, match="sped: no such parameter; did you mean speed.*accepted: law, young"):
        parameters.check({"sped": 8})
    with pytest.raises(BadInput, match="^mesh: no such parameter"):
        parameters.check({"mesh": "file.msh"})


def test_scene_file(tmp_path):
    """A TOML file sets entries that differ from the defaults. Overriding does not change the
    original."""
    path = tmp_path / "fast.toml"
    path.write_text((scene.SCENES / "disc-normal.toml").read_text().replace("speed = 8", "speed = 11").replace("A disc falls", "Fast"))
    loaded = scene.load(str(path))
    assert (loaded.name, loaded.title[:4], loaded.values["degree"]) == ("fast", "Fast", 2) and loaded.bodies[0].start_velocity[1] == -11
    assert loaded.override({"speed": "2"}).bodies[0].start_velocity[1] == -2 and loaded.bodies[0].start_velocity[1] == -11


@pytest.mark.parametrize("text, words", [
    ("speed = = 3", "bad.toml: cannot be read"),
    ("[accuracy]\nvalue = 3", "bad.toml: accuracy: .* is not a number"),
    ("script = 'disc-plane'\nspeed = 4", r"bad.toml: script: 'disc-plane' is no kind of scene any more .accepted: tables"),
    ("script = ['nothing']", "bad.toml: script: "),
])
def test_bad_scene_files_are_named(tmp_path, text, words):
    """A broken scene file raises BadInput with the file and the key."""
    (tmp_path / "bad.toml").write_text(text)
    with pytest.raises(BadInput, match=words):
        scene.load(str(tmp_path / "bad.toml"))


@pytest.mark.parametrize("text, message", [("", "says nothing .accepted: a scene"), ('[[obstacle]]\nkind = "plane"\n', "body: is missing .accepted: one table"),
                                           ("[contact]\nfriction_static = 0.3\n", "body: is missing")])
def test_a_file_without_bodies_is_no_scene(tmp_path, text, message):
    """An empty file is not a run with defaults. Obstacles or contact without bodies are reported as
    incomplete."""
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(BadInput, match=message):
        scene.load(str(path))
