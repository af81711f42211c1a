"""Malformed input by all three interfaces.

Each gives one line on stderr with the error and exit code 10 or 14, leaves no files and does not
hang.
"""

import re
import signal
from pathlib import Path

import pytest

from tests.support.malformed import (
    COMMANDS,
    INPUTS,
    NAMES,
    SENSELESS,
    VALUES,
    by_python,
    in_a_scene,
    special,
    toml,
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


# All forms of numbers run with flags, and a third of ranges and words, which come from one table. A
# fifth shows that the other interfaces use the same parser.
SOME = [value if k % 5 == 0 else pytest.param(*value, marks=pytest.mark.robustness) for k, value in enumerate(VALUES)]


@pytest.mark.parametrize("name, value", SOME)
def test_value_given_to_python(capsys, name, value):
    """A value that --set does not accept."""
    by_python(capsys, f"{name}: ", "run", "disc-normal", "--set", f"{name}={value}", "--out", "a/out") if value.strip() == value else \
        by_python(capsys, f"{name}: |--set: ", "run", "disc-normal", "--set", f"{name}=?{value}", "--out", "a/out")


@pytest.mark.parametrize("name, value", SOME)
def test_value_in_a_scene(capsys, name, value):
    """A value that is not accepted in a scene file, as text and, if TOML permits, as it is."""
    in_a_scene(capsys, f"scene.toml: {name}: ", f"{name} = {toml(value)}\n")
    if re.fullmatch(r"-?[0-9.]+(e-?[0-9]+)?|-?inf|nan|true|\[8\]", value) and value not in (".", "-", "8.") and len(value) < 4000:
        in_a_scene(capsys, f"scene.toml: {name}: ", f"{name} = {value}\n")


# ---- scene files

SCENES = {
    "a table": b"[speed]\n", "nested": b"speed = {a = {b = 1}}\n", "a list": b"speed = [8]\n", "a date": b"speed = 2020-01-01\n", "true": b"speed = true\n",
    "an integer beyond all": b"speed = " + b"9" * 5000, "twice": b"speed = 8\nspeed = 8\n", "no value": b"speed =\n", "no name": b"= 8\n", "half a string": b'law = "svk\n',
    "no TOML": b"speed: 8\n", "JSON": b'{"speed": 8}\n', "XML": b"<speed>8</speed>\n", "an ELF": b"\x7fELF\x02\x01\x01\x00\x00", "latin-1": "title = \"Stoß\"\n".encode("latin-1"),
    "UTF-16": "speed = 8\n".encode("utf-16"), "a zero": b"speed = 8\x00\n", "a mark": b"\xef\xbb\xbfspeed : 8\n", "half a character": b'title = "\xc3"\n',
    "deep": b"speed = " + b"[" * 100_000 + b"]" * 100_000, "deep tables": b"speed = " + b"{a=" * 100_000, "another script": b'script = "friction-laws"\n',
    "a script elsewhere": b'script = "../../tmp/x"\n', "a script that is none": b"script = 8\n", "a title that is none": b"title = 1\n", "scripts": b'script = ["disc-plane"]\n', "unknown table": b"[body]\nlaw = 1\n",
    "a code point": b'law = "\\ud800"\n', "python": b"import os\n"}


@pytest.mark.parametrize("name", SCENES)
def test_scene_file(capsys, name):
    """An invalid scene file: form, encoding or content."""
    in_a_scene(capsys, r"scene\.toml: ", SCENES[name])


@pytest.mark.parametrize("kind", INPUTS)
def test_path_of_a_scene(capsys, kind):
    """A path that cannot be a scene file. The program does not wait for any of them."""
    path = special(kind)
    by_python(capsys, re.escape(path), "run", path, "--out", "a/out")
    by_python(capsys, re.escape(path), "sweep", path, "--out", "a/out")


# ---- sweeps

# test_sweep.py has further files.
SWEEPS = {
    "nothing varies": ('scene = "disc-normal"\n', "product: "), "a range without end": ("[product]\nspeed = { from = 1, points = 3 }\n", "speed: "),
    "an empty zip": ("[[zip]]\n", "zip: "), "a scene that is not there": ('scene = "x.toml"\n[product]\nspeed = [1]\n', "x.toml: "),
    "coarser": ("[product]\naccuracy = [0.1]\nspeed=[1]\n[refine]\naccuracy = 0.2\n", "refine: "), "no number": ("[product]\nspeed=[1]\n[refine]\naccuracy = \"x\"\n", "accuracy: 'x' is not a number"), "deep": ("product = " + "[" * 100_000, "nested too deep"),
    "a zero in a name": ('scene = "a\\u0000b"\n[product]\nspeed = [1]\n', "sweep.toml: ")}


@pytest.mark.parametrize("name", SWEEPS)
def test_sweep_file(capsys, name):
    """An invalid or meaningless sweep file."""
    text, words = SWEEPS[name]
    Path("sweep.toml").write_text(text)
    by_python(capsys, words, "sweep", "sweep.toml", "--out", "a/out")


def test_there_are_enough():
    """There are at least 150 inputs over all three interfaces."""
    assert 3 * len(VALUES) + 3 * len(NAMES) + 3 * len(SENSELESS) + len(SCENES) + len(COMMANDS) + len(SWEEPS) >= 150
