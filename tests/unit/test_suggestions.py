"""Messages about words and numbers with a unit: entry, value, nearest accepted word, unit of the
entry, exit code."""

import re

import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import BadInput, suggestion
from ffimpact.input import parameters

# Arguments, entry, value and the suggestion of the message.
MESSAGES = [
    (("run", "disk-normal"), "disk-normal", "no such scene", "did you mean disc-normal?"),
    (("run", "disc-normol.toml"), "disc-normol.toml", "no such file", "did you mean disc-normal?"),
    (("rum", "disc-normal"), "COMMAND", "'rum'", "did you mean run?"),
    (("sweep", "calibrat"), "calibrat", "no such sweep", "did you mean calibrate?"),
    (("movie", "disc-normal", "--format", "gfi"), "--format", "'gfi'", "did you mean gif?"),
    (("run", "disc-normal", "--set", "law=neo-hookean"), "law", "'neo-hookean'", "did you mean neohookean?"),
    (("run", "disc-normal", "--set", "penalty=auot"), "contact.penalty", "'auot'", "did you mean auto?"),
    (("run", "disc-normal", "--set", "spede=8"), "spede", "no such entry", "did you mean body.1.speed?"),
    (("run", "two-discs", "--set", "body.1.shape=dics"), "body.1.shape", "'dics'", "did you mean disc?"),
    (("run", "disc-bowl", "--set", "obstacle.1.kind=bowel"), "obstacle.1.kind", "'bowel'", "did you mean bowl?"),
    (("run", "two-discs", "--set", "body.1.shap=disc"), "body.1.shap", "'disc'", "did you mean shape?"),
    (("run", "two-discs", "--set", "contact.self_contact=true"), "contact.self_contact", "'true'", "did you mean on?"),
    (("run", "disc-normal", "--set", "speed=4m/s"), "body.1.speed", "'4m/s'", "in m/s: 4 (accepted: 0 to "),
    (("run", "disc-normal", "--set", "young=7MPa"), "young", "'7MPa'", "in Pa: 7000000 (accepted: "),
    (("run", "disc-normal", "--set", "young=7 GPa"), "young", "'7 GPa'", "in Pa: 7000000000 (accepted: "),
    (("run", "disc-normal", "--set", "density=1.7g/cm^3"), "density", "'1.7g/cm^3'", "in kg/m3: 1700 (accepted: "),
    (("run", "disc-normal", "--set", "penalty=1e10N/m"), "contact.penalty", "'1e10N/m'", "in Pa/m^m (accepted: auto, "),
    (("run", "disc-normal", "--set", "accuracy=1%"), "accuracy", "'1%'", "alone: 0.01 (accepted: "),
    (("run", "two-discs", "--set", "body.2.radius=50mm"), "body.2.radius", "'50mm'", "in m: 0.05 (accepted: "),
]


@pytest.mark.parametrize("arguments, entry, value, hint", MESSAGES, ids=lambda value: " ".join(value) if isinstance(value, tuple) else None)
def test_a_wrong_word_names_the_nearest_and_a_unit_the_number(capsys, tmp_path, monkeypatch, arguments, entry, value, hint):
    """One line, exit code 10, and what is accepted."""
    monkeypatch.chdir(tmp_path)
    assert main(list(arguments)) == 10
    line, = capsys.readouterr().err.splitlines()
    assert line.startswith(f"ffimpact: {entry}: ") and value in line and hint in line
    assert "(accepted: " in line or "(built in: " in line


@pytest.mark.parametrize("word, accepted", [("zzz", ("run", "list")), ("", ("run",)), ("hooke", ("svk", "ogden")), (True, ("svk", "ogden"))])
def test_what_is_near_to_nothing_gets_no_suggestion(word, accepted):
    assert suggestion(word, accepted) == ""


def test_a_second_word_is_suggested_only_where_it_is_as_near():
    assert suggestion("aa", ("ab", "ac")) == "" and suggestion("cab", ("cat", "car")) == "; did you mean cat or car?"
    assert suggestion("disk-normal", scene.built_in()) == "; did you mean disc-normal?"


@pytest.mark.parametrize("text", ["8x", "0x10", "1,5", "nan", "4 m/s fast", "m/s", "1e5e"])
def test_other_text_has_no_unit(text):
    """The message reports that it is not a number, and nothing else."""
    with pytest.raises(BadInput, match=re.escape(f"speed: '{text}' is not a number (accepted: 0 to 1e+09)")):
        parameters.check({"speed": text})


@pytest.mark.parametrize("line, message", [
    ("speed = 4m/s   # fast", "speed: '4m/s' has a unit; give the number in m/s: 4 (accepted: 0 to 1e+09)"),
    ("young = 7MPa", "young: '7MPa' has a unit; give the number in Pa: 7000000 (accepted: "), ("speed = ", "cannot be read: ")])
def test_a_unit_in_a_scene_file_is_named(tmp_path, line, message):
    """TOML does not accept such a line. The message mentions the unit if it is the reason."""
    path = tmp_path / "own.toml"
    path.write_text(f'[[body]]\nshape = "disc"\n{line}\n')
    with pytest.raises(BadInput, match=re.escape(f"{path}: {message}")) as error:
        scene.load(path)
    assert error.value.code == 10


@pytest.mark.parametrize("top, message", [({"smooth": True}, "body.1.smooth: no such entry, set to 'true' (accepted: shape, radius, "),
                                          ({"radius": True}, "body.1.radius: 'true' is not a number (accepted: "),
                                          ({"shape": True}, "body.1.shape: 'true' is not known (accepted: disc|"),
                                          ({"law": False}, "body.1.law: 'false' is not known (accepted: svk|")])
def test_a_boolean_is_written_as_in_the_file(top, message):
    """For a number, a word or a missing entry the message has true, not Python's True."""
    body = {"shape": "disc", "radius": 0.05, "position": [0, 0.1]} | top
    with pytest.raises(BadInput, match="^" + re.escape(message)):
        scene.read({"body": [body], "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}, scene.SCENES, "own")
