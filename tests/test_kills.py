"""Forty kills, all along runs: nothing is orphaned or looks finished, earlier results stay, and the same command then gives the same answer."""

import contextlib
import functools
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from ffimpact.freefem import freefem
from ffimpact.input import parameters
from test_cli import hear_interrupts

COARSE = {"law": "neohookean", "nu": "0.4", "accuracy": "0.2", "fields": "5"}
SWEEP = """collect = ["impulse", "rebound_vy"]
[set]
law = "neohookean"
nu = 0.4
accuracy = 0.2
fields = 5
[product]
speed = [4, 8, 11]
"""
ROUTES = ("run", "checkpoints", "sweep", "direct", "direct-checkpoints")
ALWAYS = 6                             # of them in every `make test`, all in `make robustness`
# what appears in the folder on the way, the last long before the end: there the run is stopped and hit
POINTS = ("unfinished", "unfinished/history.csv", *(f"unfinished/fields/000{k}.vtu" for k in range(4)))


def kills() -> list:
    """Route, signal, whom it hits, at which point of the run, and whether a finished run of another scene is there already."""
    draw = random.Random(11)
    drawn = [(ROUTES[k % len(ROUTES)], draw.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT)), draw.choice(("driver", "freefem", "group")),
              draw.choice(POINTS), draw.random() < 0.5) for k in range(40)]
    return [pytest.param(*kill, marks=[] if k < ALWAYS else [pytest.mark.robustness], id=f"{k}-{kill[0]}-{kill[1].name}-{kill[2]}-{Path(kill[3]).stem}")
            for k, kill in enumerate(drawn)]


def command(route: str, out: Path, speed: str = "8", **changed: str) -> list[str]:
    given = COARSE | {"speed": speed} | changed | ({"checkpoint_every": "10"} if "checkpoints" in route else {})
    if route == "sweep":
        file = out.parent / "case.toml"
        file.write_text(SWEEP if speed == "8" else SWEEP.replace("0.4", "0.3"))
        return [sys.executable, "-m", "ffimpact", "sweep", str(file), "--out", str(out)]
    if route.startswith("direct"):
        return freefem.find().words("edp/disc-plane.edp", *freefem.words_of(given | {"out": out}))
    return [sys.executable, "-m", "ffimpact", "run", "disc-normal", "--quiet", "--set", *(f"{name}={value}" for name, value in given.items()), "--out", str(out)]


def start(words: list[str]) -> subprocess.Popen:
    return subprocess.Popen(words, cwd=parameters.ROOT, env=freefem.find().environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=hear_interrupts)


def finish(words: list[str]) -> str:
    process = start(words)
    said, error = process.communicate(timeout=120)
    assert process.returncode == 0, error
    return said


def at_work(out: Path) -> list[int]:
    """The processes that have this folder among their words."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            words, state = (place / "cmdline").read_bytes(), (place / "stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if str(out).encode() in words and state != "Z":
            found.append(int(place.name))
    return found


def freefems(out: Path) -> list[int]:
    return [pid for pid in at_work(out) if name_of(pid).startswith("FreeFem")]


def name_of(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/comm").read_text()
    except OSError:                     # it has just ended
        return ""


def answers(route: str, out: Path) -> object:
    """What a route gives, to the last digit."""
    if route == "sweep":
        return pd.read_csv(out / "sweep.csv").drop(columns="seconds").to_csv()
    return (out / "history.csv").read_text(), sorted((path.name, path.read_text()) for path in (out / "fields").iterdir())


@functools.cache
def straight(route: str, folder: Path) -> object:
    """The answers of a run that is not killed."""
    finish(command(route, folder / "straight"))
    return answers(route, folder / "straight")


def holds(folder: Path, point: str) -> bool:
    """Whether `point` is somewhere in a folder in which others come and go while it is looked through."""
    with contextlib.suppress(FileNotFoundError):
        return any(folder.rglob(point))
    return False


def stop_at(point: str, process: subprocess.Popen, out: Path) -> list[int]:
    """Stops the FreeFem++s of a run once `point` is there; they are at work, and so a kill is one."""
    end = time.monotonic() + 60
    while not holds(out.parent, point):
        assert process.poll() is None and time.monotonic() < end, f"no {point}"
    stopped = set()
    while found := set(freefems(out)) - stopped:
        for pid in found:
            send(pid, signal.SIGSTOP)
        stopped |= found
    assert (there := freefems(out)), f"it ended behind {point}"
    return there


def send(pid: int, number: signal.Signals, to=os.kill) -> None:
    with contextlib.suppress(ProcessLookupError):
        to(pid, number)


@pytest.fixture(scope="module")
def shelf(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("kills")


def place(route: str, shelf: Path) -> Path:
    (shelf / route).mkdir(exist_ok=True)
    return shelf / route


@functools.cache
def another(route: str, folder: Path) -> Path:
    """A finished run of another scene."""
    (folder / "other").mkdir()
    finish(command(route, folder / "other/earlier", speed="6"))
    return folder / "other/earlier"


def content(folder: Path) -> dict[str, bytes]:
    """All files but those of a run without Python that is at work there or was killed."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*")
            if path.is_file() and path.relative_to(folder).parts[0] != "unfinished" and not path.name.startswith("checkpoint")}


@pytest.mark.few(2)
@pytest.mark.parametrize("route, number, whom, point, before", kills())
def test_kill(shelf, tmp_path, route, number, whom, point, before):
    """After the signal every process of the run is gone within seconds; a folder that looks finished is; the earlier result is whole,
    where it was or beside it; and the same command ends well with the same answer, byte for byte."""
    expected = straight(route, place(route, shelf))
    out = tmp_path / "out"
    before = before and route != "sweep"                        # another sweep in the folder of one runs its own points beside
    if before:
        shutil.copytree(another(route, place(route, shelf)), out)
    earlier = content(out) if before else {}
    words = command(route, out)
    process = start(words)
    stopped = stop_at(point, process, out)
    for pid in stopped if whom == "freefem" else [process.pid]:
        send(pid, number, os.killpg if whom == "group" else os.kill)
    for pid in stopped:
        send(pid, signal.SIGCONT)
    process.communicate(timeout=60)
    end = time.monotonic() + 5
    while at_work(out) and time.monotonic() < end:
        time.sleep(0.02)
    assert not at_work(out)
    for folder in (out, tmp_path / "out.1"):
        if route != "sweep" and (folder / "summary.json").exists():
            assert content(folder) == earlier or answers(route, folder) == expected   # it was through, or waited for a shell: SIGINT passes
    if before:
        assert earlier in (content(out), content(tmp_path / "out.1"))
    for summary in (kept := {path: path.read_bytes() for path in out.glob("runs/*/summary.json")}):
        assert (summary.parent / "history.csv").exists()
    finish(words)
    assert answers(route, out) == expected
    assert all(path.read_bytes() == text for path, text in kept.items())          # what was finished was not run again
    if before:
        assert content(tmp_path / "out.1") == earlier
    assert not list(tmp_path.glob("out.part")) and not list(out.rglob("*.part"))


TIDIES = """
import time
from ffimpact import stopping
stopping.obey()
try:
    print("up", flush=True)
    time.sleep(60)
finally:
    print("tidies", flush=True)
    time.sleep(0.3)
    print("tidy", flush=True)
"""


def test_the_way_out_is_not_interrupted():
    """A study ends its runs that the same signal has reached already: a second one does not raise amid what is tidied up."""
    process = start([sys.executable, "-c", TIDIES])
    said = [process.stdout.readline()]
    process.terminate()
    said.append(process.stdout.readline())
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        process.send_signal(number)
    rest, error = process.communicate(timeout=20)
    assert (*said, rest, error, process.returncode) == ("up\n", "tidies\n", "tidy\n", "", 143)


DELAYS = [0.6 * k / 60 for k in range(60)]


@pytest.mark.few(1)
@pytest.mark.parametrize("delay", [pytest.param(delay, marks=[] if k % 8 == 4 else [pytest.mark.robustness]) for k, delay in enumerate(DELAYS)])
def test_sigterm_at_the_start(tmp_path, delay):
    """SIGTERM is obeyed while modules load and FreeFem++ starts as well: exit code 143 (of the shell), nothing said, nothing left."""
    process = start(command("run", tmp_path / "out", accuracy="1e-3"))          # which takes much longer than any delay
    time.sleep(delay)
    process.terminate()
    _, error = process.communicate(timeout=20)
    assert process.returncode in (143, -signal.SIGTERM) and error == ""
    end = time.monotonic() + 5
    while at_work(tmp_path / "out") and time.monotonic() < end:
        time.sleep(0.02)
    assert not at_work(tmp_path / "out") and not list(tmp_path.iterdir())
