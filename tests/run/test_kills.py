"""Killed runs: no process is left, no folder looks finished, earlier results stay, and a second
call gives the same results."""

import contextlib
import functools
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.output.results import read_summary
from ffimpact.running import run
from ffimpact.sweeps import study
from tests.support.cli import hear_interrupts
from tests.support.direct import words as impact_words
from tests.support.kills import at_work, place

# Steps so short that a run lasts and can be stopped.
COARSE = {"law": "neohookean", "nu": "0.4", "accuracy": "0.2", "dt": "5e-6", "fields": "5"}
SWEEP = """collect = ["impulse", "rebound_vy"]
[set]
law = "neohookean"
nu = 0.4
accuracy = 0.2
dt = 5e-6
fields = 5
[product]
speed = [4, 8, 11]
"""
EARLY, LATE = "unfinished", "checkpoint"   # are in the folder of a run that goes on; LATE where it makes checkpoints
# route, signal, receiver, what the folder holds by then, whether a finished run of another scene is there already
KILLS = [
    ("run", signal.SIGKILL, "python", EARLY, True),
    ("checkpoints", signal.SIGKILL, "freefem", LATE, True),
    ("sweep", signal.SIGKILL, "python", EARLY, False),
    ("direct-checkpoints", signal.SIGKILL, "freefem", LATE, False),
]
MORE = [(route, number, receiver, point if "checkpoints" in route else EARLY, False) for route in ("run", "checkpoints", "sweep", "direct", "direct-checkpoints")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL) for receiver, point in (("python", EARLY), ("freefem", LATE))
        if not (route.startswith("direct") and receiver == "python")]


def command(route: str, out: Path, speed: str = "8", **changed: str) -> list[str]:
    values = COARSE | {"speed": speed} | changed | ({"checkpoint_every": "2"} if "checkpoints" in route else {})
    if route == "sweep":
        file = out.parent / "case.toml"
        file.write_text(SWEEP if speed == "8" else SWEEP.replace("0.4", "0.3"))
        return [sys.executable, "-m", "ffimpact", "sweep", str(file), "--out", str(out)]
    if route.startswith("direct"):   # fine enough that it does not end while it is being stopped
        return impact_words(values | {"accuracy": "0.005", "out": out})
    more = ["--no-estimate"] if "checkpoints" in route else []
    return [sys.executable, "-m", "ffimpact", "run", "disc-normal", "--quiet", "--no-figures", *more, "--set", *(f"{name}={value}" for name, value in values.items()), "--out", str(out)]


def start(words: list[str]) -> subprocess.Popen:
    return subprocess.Popen(words, cwd=parameters.ROOT, env=freefem.find().environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=hear_interrupts)


def finish(words: list[str]) -> str:
    process = start(words)
    output, error = process.communicate(timeout=120)
    assert process.returncode == 0, error
    return output


def freefems(out: Path) -> list[int]:
    return [pid for pid in at_work(out) if name_of(pid).startswith("FreeFem")]


def name_of(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/comm").read_text()
    except OSError:  # it has just ended
        return ""


def answers(route: str, out: Path) -> object:
    """The results of a route, to the last digit."""
    if route == "sweep":
        return pd.read_csv(out / "sweep.csv").drop(columns="seconds").to_csv()
    return (out / "history.csv").read_text(), sorted((path.name, path.read_bytes()) for path in [*out.glob("fields/*"), *out.glob("states.bin")])


def made(words: list[str]) -> None:
    """Runs a command to its end: one of the program in this process, in which its modules are loaded."""
    if words[1:3] == ["-m", "ffimpact"]:
        assert main(words[3:]) == 0
    else:
        finish(words)


@functools.cache
def straight(route: str, folder: Path) -> object:
    """The results of a run that is not killed."""
    made(command(route, folder / "straight"))
    return answers(route, folder / "straight")


def holds(folder: Path, point: str) -> bool:
    """Whether `point` is in a folder whose content changes during the search."""
    with contextlib.suppress(FileNotFoundError):
        return any(folder.rglob(point))
    return False


def stop_at(point: str, process: subprocess.Popen, out: Path) -> list[int]:
    """Stops the FreeFem++ processes of a run in which `point` exists. They are stopped before one
    looks, so that none ends in between."""
    end = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < end:
        stopped = set()
        while pids := set(freefems(out)) - stopped:
            for pid in pids:
                send(pid, signal.SIGSTOP)
            stopped |= pids
        if freefems(out) and holds(out.parent, point):
            # Also a command of FreeFem++ that now has another name.
            return sorted(stopped)
        for pid in stopped:
            send(pid, signal.SIGCONT)
        time.sleep(0.01)
    raise AssertionError(f"no {point} while FreeFem++ is at work")


def send(pid: int, number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, number)


@pytest.fixture(scope="module")
def shelf(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("kills")


@functools.cache
def another(route: str, folder: Path) -> Path:
    """A finished run of another scene."""
    (folder / "other").mkdir()
    made(command(route, folder / "other/earlier", speed="6"))
    return folder / "other/earlier"


def content(folder: Path) -> dict[str, bytes]:
    """All files except those of a run without Python that is running or was killed."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*")
            if path.is_file() and path.name != "unfinished" and not path.name.startswith("checkpoint")}


@pytest.mark.parametrize("route, number, receiver, point, before", [
    *KILLS, *(pytest.param(*kill, marks=pytest.mark.robustness) for kill in MORE if kill not in KILLS)])
def test_kill(shelf, tmp_path, route, number, receiver, point, before):
    """After the signal every process of the run ends within seconds, and a folder that looks
    finished is finished.

    The earlier result is complete, in its place or beside it. The same command gives the same
    result, byte for byte.
    """
    expected = straight(route, place(route, shelf))
    out = tmp_path / "out"
    if before:
        shutil.copytree(another(route, place(route, shelf)), out)
    earlier = content(out) if before else {}
    words = command(route, out)
    process = start(words)
    stopped = stop_at(point, process, out)
    for pid in stopped if receiver == "freefem" else [process.pid]:
        send(pid, number)
    for pid in stopped:
        send(pid, signal.SIGCONT)
    process.communicate(timeout=60)
    end = time.monotonic() + 5
    while at_work(out) and time.monotonic() < end:
        time.sleep(0.02)
    assert not at_work(out)
    for folder in (out, tmp_path / "out.1"):
        if route != "sweep" and (folder / "summary.json").exists():
            # The run had ended or waited for a shell: SIGINT passes.
            assert content(folder) == earlier or answers(route, folder) == expected
    if before:
        assert earlier in (content(out), content(tmp_path / "out.1"))
    kept = {path: path.read_bytes() for path in out.glob("runs/*/summary.json") if path.parent.suffix != ".part"}
    assert all((path.parent / "history.csv").exists() for path in kept)
    has_checkpoint = (tmp_path / "out.part/checkpoint").exists()
    if not (route.startswith("direct") and (out / "record.json").exists()):   # a direct run that had ended is not repeated
        finish(words)
    assert answers(route, out) == expected
    # Finished runs were reused.
    assert all(path.read_bytes() == text for path, text in kept.items())
    if has_checkpoint:  # the run continues
        assert read_summary(out)["resumed_at"] > 0
    if before:
        assert content(tmp_path / "out.1") == earlier
    assert not list(tmp_path.glob("out.part")) and not list(out.rglob("*.part"))


@pytest.mark.few(3)
@pytest.mark.parametrize("delay", [0.6 * k / 12 for k in range(12)])
def test_sigterm_at_the_start(tmp_path, delay):
    """SIGTERM while modules load and FreeFem++ starts ends the program with exit code 143 (of the
    shell) and leaves no files."""
    # Which takes much longer than any delay.
    process = start(command("run", tmp_path / "out", accuracy="1e-3"))
    time.sleep(delay)
    process.terminate()
    process.communicate(timeout=20)
    assert process.returncode in (143, -signal.SIGTERM)
    end = time.monotonic() + 5
    while at_work(tmp_path / "out") and time.monotonic() < end:
        time.sleep(0.02)
    # The signal may come between the making of a folder and its lock: the folder then stays, empty.
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert not at_work(tmp_path / "out") and not left


def test_a_library_changes_no_signal_handlers(fake, tmp_path):
    """Only the command line installs handlers. run() and studies do not change those of a program
    that imports ffimpact."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM)
    before = [signal.getsignal(number) for number in numbers]
    run.run(scene.load("disc-normal"), {"fields": 0}, tmp_path / "out")
    study.study([{"speed": 4.0}], tmp_path / "study", {"fields": 0}, 60.0)
    assert [signal.getsignal(number) for number in numbers] == before
