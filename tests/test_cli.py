"""The command line: exit codes, one-line errors, interruption, and that `make` lists its targets."""

import errno
import importlib
import os
import pty
import re
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import Unreadable
from ffimpact.freefem import describe
from ffimpact.input import parameters
from ffimpact.running import run

ROOT = parameters.ROOT


def hear_interrupts() -> None:
    """In a child: a shell's background job has SIGINT ignored, and hands that on."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(*arguments: str, module: str = "ffimpact", **options) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", module, *arguments], cwd=ROOT, text=True, preexec_fn=hear_interrupts,
                            **dict(stdout=subprocess.PIPE, stderr=subprocess.PIPE) | options)


def call(*arguments: str) -> tuple[int, str, str]:
    process = start(*arguments)
    out, err = process.communicate(timeout=60)
    return process.returncode, out, err


def wait_for(condition, seconds: float = 10.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_run_reports_beside_the_published_numbers(fake, tmp_path):
    """The report shows the key figures, the paper's contact time and what it leaves open, and the pictures."""
    code, out, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 0 and err == ""
    assert re.search(r"contact time +4.67 ms +4.67 ± 0.02 \(NGSolve", out)
    assert "4.8 (paper, section 3.3; k, nu not stated in the paper)" in out
    assert "figures/{energies,force,shapes,velocity}.png" in out and "half of the disc" in out
    assert "finished earlier" in call("run", "disc-normal", "--out", str(tmp_path / "out"))[1]


def test_a_run_needs_no_matplotlib(fake, tmp_path, monkeypatch, capsys):
    """Where nothing can be drawn one line says so, and the run is finished and reported all the same; drawn once it can be."""
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "ffimpact.report.drawing", None)
        without.delattr("ffimpact.report.drawing", raising=False)
        assert main(["run", "disc-normal", "--out", str(tmp_path / "out")]) == 0
    said, starts = capsys.readouterr(), fake.starts()
    assert said.err.startswith("ffimpact: the figures could not be drawn: ") and said.err.count("\n") == 1 and "contact time" in said.out
    assert main(["run", "disc-normal", "--out", str(tmp_path / "out")]) == 0 and (tmp_path / "out/figures/force.png").exists()
    assert "finished earlier" in capsys.readouterr().out and fake.starts() == starts


@pytest.mark.robustness
def test_what_a_run_does_not_load():
    """A run that is there is told of without matplotlib, pandas and pydantic."""
    for loads, heavy, said in (("import ffimpact.running.run", {"matplotlib", "pandas", "pydantic"}, "set()\n"),):
        known = subprocess.run([sys.executable, "-c", f"{loads}; import sys; print({heavy} & set(sys.modules))"], cwd=ROOT, capture_output=True, text=True)
        assert known.stdout == said, known.stderr


def test_published_numbers_are_not_shown_beside_another_scene(fake, tmp_path, capsys):
    """At another speed the paper has no number, and none is shown."""
    assert main(["run", "disc-normal", "--set", "speed=4", "--set", "fields=0", "--out", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    assert "contact time" in out and "paper" not in out and "NGSolve" not in out


def test_quiet_is_quiet(fake, tmp_path):
    """--quiet prints warnings alone, not even where an earlier run of another scene goes."""
    for speed in ("4", "5"):
        words = "run", "disc-normal", "--quiet", "--set", f"speed={speed}", "fields=0", "--out", str(tmp_path / "out")
        code, out, error = call(*words)
        assert (code, out) == (0, "") and all(line.startswith("ffimpact: warning: ") for line in error.splitlines())
    assert (tmp_path / "out.1").exists()


def test_scripts_that_do_not_answer_are_one_line(monkeypatch, capsys):
    """Where FreeFem++ is not done in time with what its scripts are asked: a line and exit code 13."""
    monkeypatch.setattr(describe, "LIMIT", 1e-3)
    assert main(["run", "disc-normal", "--set", "nu=0.43210987"]) == 13
    error = capsys.readouterr().err
    assert re.match(r"ffimpact: \S+ does not finish edp/describe.edp in 0.001 s", error) and error.count("\n") == 1


def test_quiet_leaves_warnings(fake, tmp_path, capsys, monkeypatch):
    """With --quiet each warning is a line on stderr."""
    found = run.run(scene.load("disc-normal"), {"fields": 0}, tmp_path / "out")
    found.summary["warnings"] = ["penalty: too soft"]
    monkeypatch.setattr(run, "run", lambda *_, **__: found)
    assert main(["run", "disc-normal", "--quiet"]) == 0
    assert tuple(capsys.readouterr()) == ("", "ffimpact: warning: penalty: too soft\n")


def test_failure_of_the_script_is_passed_on(fake, tmp_path):
    """The script's own line arrives on stderr as it is, with its exit code; stdout says where the files are."""
    fake("step")
    code, out, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 11 and err == "ffimpact: step: no convergence at t = 1.2e-3 s, dt = 1e-9 s, residual 3e-4\n"
    assert str(tmp_path.name) in out


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_run_leaves_nothing(fake, tmp_path, number, code):
    """Ctrl-C (or SIGTERM) ends FreeFem++ too and leaves no folder, finished or half-finished."""
    fake("slow")
    process = start("run", "disc-normal", "--out", str(tmp_path / "out"))
    wait_for(fake.starts)
    process.send_signal(number)
    _, err = process.communicate(timeout=10)
    assert process.returncode == code and "Traceback" not in err
    assert not is_alive(fake.pids()[0])
    assert not list(tmp_path.glob("out*"))


@pytest.mark.robustness
def test_two_runs_do_not_share_a_folder(fake, tmp_path):
    """A second run into the same folder is refused while the first one is at work."""
    fake("slow")
    first = start("run", "disc-normal", "--out", str(tmp_path / "out"))
    wait_for(fake.starts)
    code, _, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 14 and "being written by another run" in err and first.poll() is None
    first.terminate()
    first.communicate()


def test_progress_is_shown_on_a_terminal_only(fake, tmp_path):
    """On a terminal one line shows which run it is, of how many, what it is at and the time left of all, from the mesh on; elsewhere there is none."""
    master, slave = pty.openpty()
    termios.tcsetwinsize(slave, (24, 100))
    process = start("run", "disc-normal", "--set", "fields=0", "--out", str(tmp_path / "out"), stderr=slave)
    os.close(slave)
    seen = ""
    try:
        while block := os.read(master, 10000):
            seen += block.decode()
    except OSError:   # the other end is closed
        os.close(master)
    process.communicate(timeout=60)
    assert re.search(r"disc-normal: main run 1 of 2, t = 3.000 ms, 150 steps +55% .*, \d\d:\d\d left", seen) and process.returncode == 0
    assert "main run 1 of 2, mesh" in seen and "coarser run 2 of 2" in seen


def test_lists(capsys):
    """Scenes and parameters are listed, every one."""
    assert main(["list"]) == 0 and "disc-normal" in capsys.readouterr().out
    assert main(["parameters"]) == 0
    out = capsys.readouterr().out
    assert all(re.search(rf"^{name} ", out, re.MULTILINE) for name in parameters.names())


def test_make_lists_every_target():
    """`make` alone lists every target with one line each."""
    out = subprocess.run(["make", "-s"], cwd=ROOT, capture_output=True, text=True).stdout
    text = (ROOT / "Makefile").read_text()
    targets, sweeps = (re.search(rf"^{name} (.*)$", text, re.MULTILINE)[1] for name in (r"\.PHONY:", "SWEEPS :="))
    targets = targets.replace("$(SWEEPS)", sweeps).split()
    assert [line.split()[1] for line in out.splitlines()] == targets


def test_a_full_disk_is_one_line(tmp_path, monkeypatch, capsys):
    """Where the results cannot be written for want of room, one line says so with exit code 14."""
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(tmp_path / "out"))
    monkeypatch.setattr(run, "run", full)
    code, error = main(["run", "disc-normal", "--out", str(tmp_path / "out")]), capsys.readouterr().err
    assert code == 14 and error.count("\n") == 1 and "No space left on device" in error and "--out" in error


@pytest.mark.parametrize("module", ["verification.verify", "examples.paper.stick_slip", *(f"benchmarks.{name}" for name in (
    "promise", "bench", "stress", "oblique_angles", "disc_block_errors", "equal_errors", "scaling", "rubber"))])
def test_a_loop_of_links_is_no_folder(tmp_path, module):
    """A result folder behind a loop of links is exit code 14 in one line, for every study."""
    (tmp_path / "loop").symlink_to(tmp_path / "pool")
    (tmp_path / "pool").symlink_to(tmp_path / "loop")
    with pytest.raises(Unreadable, match="cannot be made") as error:
        importlib.import_module(module).main(["--out", str(tmp_path / "loop/out")])
    assert error.value.code == 14
