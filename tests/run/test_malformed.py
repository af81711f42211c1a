"""Malformed input by both interfaces.

Each gives one line on stderr with the error and exit code 10 or 14, leaves no files and does not
hang.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.scenes.entries import set_entry, toml_value
from tests.support.malformed import (
    COMMANDS,
    INPUTS,
    NAMES,
    SENSELESS,
    by_python,
    check,
    in_a_scene,
    special,
    toml,
    tree,
)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An empty working folder that must be clean after the test. The test ends after twenty seconds
    at most."""
    def too_long(*_):
        raise AssertionError("no answer after 20 s")
    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(20)
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def by_process(words: str, *arguments: str | bytes, code: int = 10) -> None:
    """Runs the command line in a process of its own."""
    before = tree(Path.cwd())
    process = subprocess.run([sys.executable, "-m", "ffimpact", *arguments], stdin=subprocess.DEVNULL, capture_output=True, timeout=20,
                             env=os.environ | {"PYTHONPATH": str(parameters.ROOT)})
    check(process.returncode, process.stderr.decode(errors="replace"), words, code, before)


@pytest.mark.few(3)
@pytest.mark.parametrize("name", NAMES)
def test_name(capsys, name):
    """An unknown parameter, by both interfaces."""
    if name.strip() == name:
        by_python(capsys, f"{name}: ", "run", "disc-normal", "--set", f"{name}=8", "--out", "a/out")
    in_a_scene(capsys, f"scene.toml: {name}: no such entry", f"{toml(name)} = 8\n")


@pytest.mark.few(4)
@pytest.mark.parametrize("words", SENSELESS)
def test_values_that_do_not_go_together(capsys, words):
    """Contradictory or impossible values, by both interfaces. The folders made for the run are
    removed."""
    values = SENSELESS[words]
    by_python(capsys, words, "run", "disc-normal", "--set", *(f"{name}={value}" for name, value in values.items()), "--out", "a/b/out")


ENTRIES = ("title", "dimension", "young", "script", "body", "obstacle", "contact", "body.1.shape", "body.1.name", "body.1.radius", "body.1.position", "body.1.velocity",
           "body.1.file", "obstacle.1.kind", "obstacle.1.normal", "obstacle.1.name", "contact.friction_static", "contact.pair", "fields", "symmetry", "8" * 400)
VALUES_TOO_LONG = ['"' + "8" * 5000 + '"', "[" + "88, " * 2000 + "]", "{a = '" + "8" * 5000 + "'}", "{" + "8" * 5000 + " = 1}", "[" * 90 + "8" * 400 + "]" * 90]


@pytest.mark.few(8)
@pytest.mark.parametrize("entry", ENTRIES)
def test_a_message_repeats_two_hundred_characters_of_a_value(capsys, entry):
    """For any value in place of an entry of a scene of bodies, the refusing line is short, from a
    file and from --set."""
    scene = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "body": [{"name": "a", "shape": "disc", "radius": 0.05, "position": [0, 0.1], "velocity": [0, -1]}],
             "obstacle": [{"name": "b", "kind": "plane", "point": [0, 0], "normal": [0, 1]}]}
    for text in VALUES_TOO_LONG:
        if entry == "title" and text.startswith('"'):
            continue
        in_a_scene(capsys, r"scene\.toml: ", to_toml(set_entry(scene, entry, toml_value(text))))
        Path("scene.toml").write_text(to_toml(scene))
        by_python(capsys, "", "run", "scene.toml", "--set", f"{entry}={text}", "--out", "a/out")


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", [*INPUTS, "file", "empty"])
def test_path_of_a_mesh(capsys, kind):
    """The path of a mesh that cannot be a file, or is not a mesh."""
    path = special(kind)
    in_a_scene(capsys, r"body\.1\.file: ", f'[[body]]\nshape = "mesh"\nposition = [0, 1]\nlaw = "svk"\nyoung = 1e6\nnu = 0.3\ndensity = 1e3\nfile = "{path}"\n')


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", [*INPUTS[:-1], "file", "root", "proc"])
def test_path_of_results(capsys, kind):
    """A folder that cannot be made, or is not one: exit code 14. An empty folder can be used, a
    dangling link cannot."""
    path = special(kind)
    if kind == "folder":
        Path(path, "thesis.tex").write_text("years of work")
    if kind != "dangling":  # Python makes the target of the link
        by_python(capsys, ".*(--out|folder)", "run", "disc-normal", "--set", "accuracy=0.4", "--out", path, code=14)


@pytest.mark.parametrize("arguments", COMMANDS)
def test_commands(capsys, arguments):
    """Arguments of the command line that are missing, unknown or too many."""
    by_python(capsys, COMMANDS[arguments], *arguments)


# ---- the same in separate processes

@pytest.mark.few(3)
@pytest.mark.parametrize("arguments, words, code", [
    (("run", "disc-normal", "--set", "speed=8x"), r"speed: '8x' is not a number \(accepted: 0 to 1e\+09\)", 10), (("run", "disc-normal", "--set", b"speed=\xff"), "speed: ", 10),
    (("run", b"\xff"), "no such scene", 10), (("run", "disc-normal", "--out", "/"), "/ cannot be the folder", 14), (("run", "pipe"), "pipe: is no file", 10),
    (("run", "disc-normal", "--out", "loop"), "loop cannot be made", 14), (("run", "disc-normal", "--mesh", "pipe"), "--mesh: is no option any more", 10), (("figures", "/dev/null"), "cannot be read", 14),
    (("run", "deep.toml"), "nested too deep", 10), (("run", "disc-normal", "--set", "speed=8\n9"), "speed: '8 9'", 10), (("run", "disc-normal", "--out", b"\xff/x", "--set", "nu=1"), "nu: 1", 10)])
def test_in_a_process_of_its_own(arguments, words, code):
    """The interpreter adds nothing to the line (encoding errors, a traceback at its end)."""
    special("pipe")
    special("loop")
    Path("deep.toml").write_text("speed = " + "[" * 100_000)
    by_process(words, *arguments, code=code)
