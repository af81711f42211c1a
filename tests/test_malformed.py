"""Malformed input over all three routes: each is one line on stderr that names what is wrong, exit code 10 or 14, nothing left behind, no hang."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.scenes.entries import set_entry, toml_value

LONG = "x" * 300                        # longer than a name may be
NO_NUMBERS = ["x", "8x", "--8", "+-8", "1e", "e5", "1e+", ".", "-", "8.", "0x10", "nan", "inf", "-inf", "1,5", "1 2", "1_000", "８", "٣.٥", "½",
              "8\n9", "true", "[8]", "$(touch pwned)", "`touch pwned`", "'; touch pwned; '", '"', "\\", "8" * 5000]
RANGES = [("young", "0"), ("young", "1e30"), ("nu", "0.5"), ("nu", "0.51"), ("nu", "-0.1"), ("density", "0"), ("density", "-1722"), ("radius", "0"), ("radius", "1e30"),
          ("speed", "-1"), ("speed", "1e10"), ("speed", "1e400"), ("speed", "-1e-300"), ("angle", "90.001"), ("angle", "-1"), ("spin", "1e30"), ("height", "-1e-9"),
          ("gravity", "-9.81"), ("body_force_x", "1e30"), ("penalty", "0"), ("exponent", "0.5"), ("exponent", "5"), ("friction_static", "-0.1"),
          ("friction_dynamic", "11"), ("slip_velocity", "0"), ("mesh_size", "-1"), ("degree", "3"), ("degree", "1.5"), ("dt", "-1e-5"), ("accuracy", "0"),
          ("accuracy", "1"), ("tolerance", "0"), ("end_time", "-1"), ("fields", "-1"), ("fields", "2.5"), ("fields", "1e9"), ("checkpoint_every", "-1")]
WORDS = [("law", "hooke"), ("law", "SVK"), ("law", "svk|neohookean"), ("law", " "), ("law", "svk\n"), ("law", "'; touch pwned; '"), ("symmetry", "third"),
         ("integrator", "euler"), ("breakdown", "ignore"), ("regularization", "Linear"), ("without", "everything")]
NAMES = ["sped", "SPEED", "spéed", "out2", "velocity", "speed ", "young's"]
SENSELESS = {   # what is accepted by itself, but not together: these reach the scripts
    "speed: 0 without spin, gravity or body force": {"speed": "0"}, "symmetry: half": {"angle": "60", "symmetry": "half"},
    "symmetry: half needs": {"spin": "1", "symmetry": "half"}, "mesh_size: 0.06 is larger than the radius 0.05": {"mesh_size": "0.06"},
    r"mesh_size: 0\.06 is larger than the radius": {"contact_mesh_size": "0.06"}, "contact_mesh_size: 0.02 is larger than mesh_size 0.01": {"mesh_size": "0.01", "contact_mesh_size": "0.02"},
    "contact_mesh_size: 1e-07 is too small .*accepted: from": {"contact_mesh_size": "1e-7"},
    "(?<!contact_)mesh_size: 1e-09 is too small": {"mesh_size": "1e-9"}, "end_time: a body that is set down on the plane": {"angle": "0"}, "dt: ": {"dt": "1e-300"}, "end_time: ": {"end_time": "1e6"},
    "friction_static: ": {"friction_static": "0.1", "friction_dynamic": "0.2"}}


def toml(text: str) -> str:
    return '"' + "".join(f"\\u{ord(c):04x}" if ord(c) < 32 or c in '"\\' else c for c in text) + '"'


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An empty working folder; afterwards nothing is in it but what the test itself put there. Twenty seconds at most."""
    def too_long(*_):
        raise AssertionError("no answer after 20 s")
    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(20)
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def tree(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def check(code: int, error: str, words: str, wanted: int, before: set[str]) -> None:
    assert code == wanted, error
    assert re.match(rf"ffimpact: .*(?:{words})", error) and error.endswith("\n"), error
    lines = error.splitlines()
    assert len(lines) < 25 and all(line.startswith("ffimpact: ") for line in lines), error
    assert "8" * 201 not in error and max(map(len, lines)) < 2500  # of a value
    assert tree(Path.cwd()) == before


def by_python(capsys, words: str, *arguments: str, code: int = 10) -> None:
    """The command line, in this process."""
    before = tree(Path.cwd())
    check(main(list(arguments)), capsys.readouterr().err, words, code, before)


def by_process(words: str, *arguments: str | bytes, code: int = 10) -> None:
    """The command line, in a process of its own."""
    before = tree(Path.cwd())
    process = subprocess.run([sys.executable, "-m", "ffimpact", *arguments], stdin=subprocess.DEVNULL, capture_output=True, timeout=20,
                             env=os.environ | {"PYTHONPATH": str(parameters.ROOT)})
    check(process.returncode, process.stderr.decode(errors="replace"), words, code, before)


def directly(words: str, *flags: str, code: int = 10) -> str:
    """FreeFem++ without Python; what it says."""
    before = tree(Path.cwd())
    process = freefem.find().call(parameters.ROOT / "edp/disc-plane.edp", *flags, cwd=None, timeout=20)
    check(process.returncode, process.stderr, words, code, before)
    return process.stderr[len("ffimpact: "):-1]


def in_a_scene(capsys, words: str, text: str | bytes, code: int = 10) -> None:
    """A scene file."""
    Path("scene.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    by_python(capsys, words, "run", "scene.toml", "--out", "a/out", code=code)


# ---- values, over all three routes

VALUES = [("speed", text) for text in NO_NUMBERS] + RANGES + WORDS
# By flag all forms of numbers, and a third of ranges and words, of which one table says what is accepted; that the other routes lead to the same parser a fifth shows.
SOME = [value if k % 5 == 0 else pytest.param(*value, marks=pytest.mark.robustness) for k, value in enumerate(VALUES)]


@pytest.mark.parametrize("name, value", SOME)
def test_value_given_to_python(capsys, name, value):
    """A value that is not accepted, by --set."""
    by_python(capsys, f"{name}: ", "run", "disc-normal", "--set", f"{name}={value}", "--out", "a/out") if value.strip() == value else \
        by_python(capsys, f"{name}: |--set: ", "run", "disc-normal", "--set", f"{name}=?{value}", "--out", "a/out")


@pytest.mark.parametrize("name, value", SOME)
def test_value_in_a_scene(capsys, name, value):
    """A value that is not accepted, in a scene file, as text and, where TOML takes it so, as it is."""
    in_a_scene(capsys, f"scene.toml: {name}: ", f"{name} = {toml(value)}\n")
    if re.fullmatch(r"-?[0-9.]+(e-?[0-9]+)?|-?inf|nan|true|\[8\]", value) and value not in (".", "-", "8.") and len(value) < 4000:
        in_a_scene(capsys, f"scene.toml: {name}: ", f"{name} = {value}\n")


@pytest.mark.few(10)
@pytest.mark.parametrize("name, value", [value if k < len(NO_NUMBERS) or k % 3 == 0 else pytest.param(*value, marks=pytest.mark.robustness)
                                         for k, value in enumerate(VALUES)])
def test_value_of_a_flag(name, value):
    """A value that is not accepted, as a flag of FreeFem++: in the words of Python but for suggestions, with what is accepted."""
    said = directly(f"{name}: ", f"-{name}", value, "-out", "a/out")
    if (name, value) not in (("nu", "0.5"), ("checkpoint_every", "-1")):   # that hangs on the law; this has words of its own
        with pytest.raises(BadInput) as error:
            parameters.check({name: value})
        assert said == re.sub(r"; did you mean [^?]*\?", "", str(error.value)) and said.endswith(f"(accepted: {parameters.PARAMETERS[name].accepted})")


@pytest.mark.few(3)
@pytest.mark.parametrize("name", NAMES)
def test_name(capsys, name):
    """A parameter that there is not, over all three routes."""
    if name.strip() == name:
        by_python(capsys, f"{name}: no such parameter", "run", "disc-normal", "--set", f"{name}=8", "--out", "a/out")
    directly(rf"-{name}: no such parameter \(accepted: .*speed", f"-{name}", "8", "-out", "a/out")
    in_a_scene(capsys, f"scene.toml: {name}: no such parameter", f"{toml(name)} = 8\n")


@pytest.mark.few(4)
@pytest.mark.parametrize("words", SENSELESS)
def test_values_that_do_not_go_together(capsys, words):
    """What contradicts itself, or asks for more than can be, over all three routes; the folders made for it are gone again."""
    given = SENSELESS[words]
    by_python(capsys, words, "run", "disc-normal", "--set", *(f"{name}={value}" for name, value in given.items()), "--out", "a/b/out")
    directly(words, *freefem.words_of(given), "-out", "a/b/out")
    in_a_scene(capsys, words, "".join(f"{name} = {toml(value)}\n" for name, value in given.items()))


@pytest.mark.robustness
def test_more_snapshots_than_memory(capsys):
    """Snapshots that do not fit into the memory are refused with the number that does."""
    bytes_there = next(int(line.split()[1]) * 1024 for line in Path("/proc/meminfo").read_text().splitlines() if line.startswith("MemAvailable"))
    if bytes_there > 60e9:
        pytest.skip("so much memory that the mesh would be too fine for a test")
    directly(r"fields: 10000 .*accepted here: 0 to \d+\)", "-fields", "10000", "-mesh_size", "7e-4", "-out", "a/out")


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
    """A scene file that is none, in form, encoding or content."""
    in_a_scene(capsys, r"scene\.toml: ", SCENES[name])


ENTRIES = ("title", "dimension", "young", "script", "body", "obstacle", "contact", "body.1.shape", "body.1.name", "body.1.radius", "body.1.position", "body.1.velocity",
           "body.1.file", "obstacle.1.kind", "obstacle.1.normal", "obstacle.1.name", "contact.friction_static", "contact.pair", "fields", "symmetry", "8" * 400)
VALUES_TOO_LONG = ['"' + "8" * 5000 + '"', "[" + "88, " * 2000 + "]", "{a = '" + "8" * 5000 + "'}", "{" + "8" * 5000 + " = 1}", "[" * 90 + "8" * 400 + "]" * 90]


@pytest.mark.few(8)
@pytest.mark.parametrize("entry", ENTRIES)
def test_a_message_repeats_two_hundred_characters_of_a_value(capsys, entry):
    """Whatever is in the place of an entry of a scene of bodies, the line that refuses it is short, by file and by --set."""
    scene = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "body": [{"name": "a", "shape": "disc", "radius": 0.05, "position": [0, 0.1], "velocity": [0, -1]}],
             "obstacle": [{"name": "b", "kind": "plane", "point": [0, 0], "normal": [0, 1]}]}
    for text in VALUES_TOO_LONG:
        if entry == "title" and text.startswith('"'):
            continue
        in_a_scene(capsys, r"scene\.toml: ", to_toml(set_entry(scene, entry, toml_value(text))))
        Path("scene.toml").write_text(to_toml(scene))
        by_python(capsys, "", "run", "scene.toml", "--set", f"{entry}={text}", "--out", "a/out")


def special(kind: str) -> str:
    """A path on which reading or writing would hang, loop or fail."""
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


@pytest.mark.parametrize("kind", INPUTS)
def test_path_of_a_scene(capsys, kind):
    """A scene that cannot be a file; none of these is waited for."""
    path = special(kind)
    by_python(capsys, re.escape(path), "run", path, "--out", "a/out")
    by_python(capsys, re.escape(path), "sweep", path, "--out", "a/out")


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", [*INPUTS, "file", "empty"])
def test_path_of_a_mesh(capsys, kind):
    """A mesh that cannot be a file, or is none."""
    path = special(kind)
    by_python(capsys, "mesh: ", "run", "disc-normal", "--mesh", path, "--out", "a/out")
    directly("mesh: the file 'nowhere' cannot be read" if kind == "nowhere" else "mesh: ", "-mesh", path, "-out", "a/out")


@pytest.mark.few(4)
@pytest.mark.parametrize("kind", [*INPUTS[:-1], "file", "root", "proc"])
def test_path_of_results(capsys, kind):
    """A folder that cannot be made, or is not one: exit code 14. An empty folder can be used, a dangling link cannot."""
    path = special(kind)
    if kind == "folder":
        Path(path, "thesis.tex").write_text("years of work")
    if kind != "dangling":   # Python makes what it points to
        by_python(capsys, ".*(--out|folder)", "run", "disc-normal", "--set", "accuracy=0.4", "--out", path, code=14)
    directly("out: ", "-accuracy", "0.4", "-out", path, code=14)


@pytest.mark.robustness
def test_path_of_a_checkpoint():
    """A checkpoint that is not there, or is none: exit code 14, and the folders made for it are gone again."""
    for kind in ("pipe", "folder", "file", "nowhere", "loop", "device"):
        directly("checkpoint '", "-restart", special(kind), "-out", "a/b/out", code=14)


# ---- words of the command line

FLAGS = {   # what FreeFem++ gets, what the line names
    ("speed=8",): "'speed=8'", ("8",): "'8'", ("-",): "'-'", ("",): "''", ("--", "-speed", "8"): "'8'", ("-speed", "8", "9"): "'9'", ("-8",): "'-8'", ("=",): "'='",
    ("-speed",): "speed: a value is missing", ("-law",): "law: a value is missing", ("-speed", ""): "speed: the value is empty", ("-out", ""): "out: the value is empty",
    ("-speed", "8", "-speed", "8"): "speed: given twice", ("-out", "a", "-out", "b"): "out: given twice", ("-speed", "-nu", "0.4"): "'0.4'",
    ("-out", "-speed"): "out: a value is missing", ("--speed", "8"): "--speed: no such", ("-Speed", "8"): "-Speed: no such", ("-speed=8",): "'-speed=8'", ("-speed=8", "-nu", "0.4"): "'-speed=8'",
    ("-", "speed", "8"): "'-'", ("-speed", "8", "\n"): "' '", ("'; touch pwned; '",): "touch pwned", ("-$(touch pwned)", "8"): "touch pwned",
    ("-speed", "8", "-\x07", "8"): "no such"}


@pytest.mark.few(6)
@pytest.mark.parametrize("flags", FLAGS)
def test_flags(flags):
    """Words that belong to no parameter, values that are missing, empty or given twice."""
    directly(re.escape(FLAGS[flags]), *flags)


COMMANDS = {
    (): "COMMAND", ("swep",): "COMMAND: 'swep' is not known; did you mean sweep. .accepted: run, list, parameters, schema, kernels, figures, sweep, ", ("run",): "SCENE", ("run", ""): "no such scene", ("run", "disc-normal", "more"): "more", ("run", "disc-normal", "--set"): "--set",
    ("run", "disc-normal", "--set", "speed"): "--set: 'speed' is not of the form name=value", ("run", "disc-normal", "--set", "=8"): "--set: '=8'", ("run", "disc-normal", "--set", "speed="): "--set: 'speed='",
    ("run", "disc-normal", "--set", ""): "--set: ''", ("run", "disc-normal", "--speed", "8"): "--speed", ("run", "disc-normal", "--checkpoint-every", "often"): "checkpoint_every: 'often'",
    ("run", "disc-normal", "--checkpoint-every", "-1"): "checkpoint_every: -1", ("run", "disc-normal", "--out"): "--out", ("sweep",): "SWEEP",
    ("sweep", "nothing"): "nothing: no such sweep", ("sweep", "oblique", "--run", "x"): "--run: 'x'", ("movie", "disc-oblique", "--frames", "٣"): "--frames",
    ("compare", "disc-normal"): "two or more different scenes", ("compare", "disc-oblique", "disc-oblique"): "two or more different scenes",
    ("run", "disc-normal\n"): "no such scene"}


@pytest.mark.parametrize("arguments", COMMANDS)
def test_commands(capsys, arguments):
    """Words of the command line that are missing, unknown or too many."""
    by_python(capsys, COMMANDS[arguments], *arguments)


# ---- sweeps

SWEEPS = {   # others are in test_sweep.py
    "nothing varies": ('scene = "disc-normal"\n', "product: "), "a range without end": ("[product]\nspeed = { from = 1, points = 3 }\n", "speed: "),
    "an empty zip": ("[[zip]]\n", "zip: "), "a scene that is not there": ('scene = "x.toml"\n[product]\nspeed = [1]\n', "x.toml: "),
    "coarser": ("[product]\naccuracy = [0.1]\nspeed=[1]\n[refine]\naccuracy = 0.2\n", "refine: "), "deep": ("product = " + "[" * 100_000, "nested too deep"),
    "a zero in a name": ('scene = "a\\u0000b"\n[product]\nspeed = [1]\n', "sweep.toml: ")}


@pytest.mark.parametrize("name", SWEEPS)
def test_sweep_file(capsys, name):
    """A sweep file that is none, or does not make sense."""
    text, words = SWEEPS[name]
    Path("sweep.toml").write_text(text)
    by_python(capsys, words, "sweep", "sweep.toml", "--out", "a/out")


# ---- the same in processes of their own

@pytest.mark.few(3)
@pytest.mark.parametrize("arguments, words, code", [
    (("run", "disc-normal", "--set", "speed=8x"), r"speed: '8x' is not a number \(accepted: 0 to 1e\+09\)", 10), (("run", "disc-normal", "--set", b"speed=\xff"), "speed: ", 10),
    (("run", b"\xff"), "no such scene", 10), (("run", "disc-normal", "--out", "/"), "/ cannot be the folder", 14), (("run", "pipe"), "pipe: is no file", 10),
    (("run", "disc-normal", "--out", "loop"), "loop cannot be made", 14), (("run", "disc-normal", "--mesh", "pipe"), "mesh: ", 10), (("figures", "/dev/null"), "cannot be read", 14),
    (("run", "deep.toml"), "nested too deep", 10), (("run", "disc-normal", "--set", "speed=8\n9"), "speed: '8 9'", 10), (("run", "disc-normal", "--out", b"\xff/x", "--set", "nu=1"), "nu: 1", 10)])
def test_in_a_process_of_its_own(arguments, words, code):
    """Nothing of the interpreter (an encoding, a traceback at its end) comes on top of the line."""
    special("pipe")
    special("loop")
    Path("deep.toml").write_text("speed = " + "[" * 100_000)
    by_process(words, *arguments, code=code)


def test_there_are_enough():
    """At least 150 of them, over all three routes."""
    assert 3 * len(VALUES) + 3 * len(NAMES) + 3 * len(SENSELESS) + len(SCENES) + len(FLAGS) + len(COMMANDS) + len(SWEEPS) >= 150
