"""Helpers that the modules test_malformed.py share."""

import os
import re
from pathlib import Path

from ffimpact.__main__ import main

LONG = "x" * 300  # longer than a name may be
NO_NUMBERS = ["x", "8x", "--8", "+-8", "1e", "e5", "1e+", ".", "-", "8.", "nan", "inf", "-inf", "1,5", "1 2", "８", "٣.٥", "½",
              "8\n9", "true", "[8]", "$(touch pwned)", "`touch pwned`", "'; touch pwned; '", '"', "\\", "8" * 5000]
RANGES = [("young", "0"), ("young", "1e30"), ("nu", "0.51"), ("nu", "-0.1"), ("density", "0"), ("density", "-1722"), ("radius", "0"), ("radius", "1e30"),
          ("speed", "-1"), ("speed", "1e10"), ("speed", "1e400"), ("speed", "-1e-300"), ("angle", "90.001"), ("angle", "-1"), ("spin", "1e30"), ("height", "-1e-9"),
          ("gravity", "-9.81"), ("body_force_x", "1e30"), ("penalty", "0"), ("exponent", "0.5"), ("exponent", "5"), ("friction_static", "-0.1"),
          ("friction_dynamic", "11"), ("slip_velocity", "0"), ("mesh_size", "-1"), ("degree", "3"), ("degree", "1.5"), ("dt", "-1e-5"), ("accuracy", "0"),
          ("accuracy", "1"), ("tolerance", "0"), ("end_time", "-1"), ("fields", "-1"), ("fields", "2.5"), ("fields", "1e9"), ("checkpoint_every", "-1")]
WORDS = [("law", "hooke"), ("law", "SVK"), ("law", "svk|neohookean"), ("law", " "), ("law", "svk\n"), ("law", "'; touch pwned; '"), ("symmetry", "third"),
         ("integrator", "euler"), ("breakdown", "ignore"), ("regularization", "Linear"), ("without", "everything")]
NAMES = ["sped", "SPEED", "spéed", "out2", "velocity", "speed ", "young's"]
# Values that are accepted individually, but not together.
SENSELESS = {
    "symmetry: half, but the scene is not its own mirror image": {"direction": "-60", "symmetry": "half"},
    "symmetry: half, but": {"spin": "1", "symmetry": "half"}, r"mesh_size: 0\.06 does not fit": {"mesh_size": "0.06"},
    "contact_mesh_size: 0.02 is larger than mesh_size 0.01": {"mesh_size": "0.01", "contact_mesh_size": "0.02"},
    "contact_mesh_size: 1e-07 does not fit": {"contact_mesh_size": "1e-7"}, "(?<!contact_)mesh_size: 1e-09 does not fit": {"mesh_size": "1e-9"},
    "friction_static": {"friction_static": "0.1", "friction_dynamic": "0.2"}, "nothing": {"speed": "0"}}


def toml(text: str) -> str:
    return '"' + "".join(f"\\u{ord(c):04x}" if ord(c) < 32 or c in '"\\' else c for c in text) + '"'


def tree(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def check(code: int, error: str, words: str, expected: int, before: set[str]) -> None:
    assert code == expected, error
    assert re.match(rf"ffimpact: .*(?:{words})", error) and error.endswith("\n"), error
    lines = error.splitlines()
    assert len(lines) < 25 and all(line.startswith("ffimpact: ") for line in lines), error
    assert "8" * 201 not in error and max(map(len, lines)) < 2500  # length of a value
    assert tree(Path.cwd()) == before


def by_python(capsys, words: str, *arguments: str, code: int = 10) -> None:
    """Runs the command line in this process."""
    before = tree(Path.cwd())
    check(main(list(arguments)), capsys.readouterr().err, words, code, before)


def in_a_scene(capsys, words: str, text: str | bytes, code: int = 10) -> None:
    """Runs a scene file."""
    Path("scene.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    by_python(capsys, words, "run", "scene.toml", "--out", "a/out", code=code)


# ---- values, by all three interfaces

VALUES = [("speed", text) for text in NO_NUMBERS] + RANGES + WORDS


def special(kind: str) -> str:
    """Makes a path on which reading or writing would block, loop or fail."""
    if kind == "pipe":
        os.mkfifo("pipe")
    if kind == "loop":
        os.symlink("back", "loop")
        os.symlink("loop", "back")
    if kind == "dangling":
        os.symlink("nowhere/at/all", "dangling")
    if kind == "folder":
        Path("folder").mkdir()
    if kind in ("file", "below a file", "empty"):
        Path("file").write_text("" if kind == "empty" else "hello")
    return {"device": "/dev/zero", "long": LONG, "below a file": "file/x", "empty": "file", "root": "/", "proc": "/proc/nowhere"}.get(kind, kind)


INPUTS = ("pipe", "loop", "dangling", "folder", "device", "long", "below a file", "nowhere")
# ---- arguments of the command line

COMMANDS = {
    (): "COMMAND", ("swep",): "COMMAND: 'swep' is not known; did you mean sweep. .accepted: run, view, evaluate, list, parameters, schema, figures, sweep, ", ("run",): "SCENE", ("run", ""): "no such scene", ("run", "disc-normal", "more"): "more", ("run", "disc-normal", "--set"): "--set",
    ("run", "disc-normal", "--set", "speed"): "--set: 'speed' is not of the form name=value", ("run", "disc-normal", "--set", "=8"): "--set: '=8'", ("run", "disc-normal", "--set", "speed="): "--set: 'speed='",
    ("run", "disc-normal", "--set", ""): "--set: ''", ("run", "disc-normal", "--speed", "8"): "--speed", ("run", "disc-normal", "--checkpoint-every", "often"): "checkpoint_every: 'often'",
    ("run", "disc-normal", "--checkpoint-every", "-1"): "checkpoint_every: -1", ("run", "disc-normal", "--out"): "--out", ("sweep",): "SWEEP",
    ("sweep", "nothing"): "nothing: no such sweep", ("sweep", "oblique", "--run", "x"): "--run: 'x'", ("movie", "disc-oblique", "--frames", "٣"): "--frames",
    ("compare", "disc-normal"): "two or more different scenes", ("compare", "disc-oblique", "disc-oblique"): "two or more different scenes",
    ("run", "disc-normal\n"): "no such scene", ("run", "disc-normal", "--set", "speed=\udcff"): r"speed: '\\udcff' is not a number",
    ("run", "disc-normal", "--set", "\udcff=8"): r"\\udcff: no such entry", ("run", "disc-normal", "--set", "speed=" + "8" * 5000): "speed: 8.* is out of range",
    ("run", "disc-normal", "--set", "speed=0x" + "f" * 5000): "speed: an integer with more digits than Python writes is out of range"}
