"""The command line: exit codes, one-line errors, interruption, and the list of targets of `make`.
"""

import os
import pty
import re
import signal
import sys
import termios

import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.running import run
from tests.support.cli import call, is_alive, start, wait_for


def test_run_reports_beside_the_published_numbers(fake, tmp_path, capsys):
    """The report shows the key results, the contact time of the paper, missing statements of the
    paper, and the figures."""
    code, out, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 0 and err == ""
    assert re.search(r"contact time +4.67 ms +4.67 ± 0.02 \(NGSolve", out)
    assert "4.8 (paper, section 3.3; k, nu not stated in the paper)" in out
    assert "figures/{energies,force,shapes,velocity}.png" in out and "half of the disc" in out
    assert main(["run", "disc-normal", "--out", str(tmp_path / "out")]) == 0 and "finished earlier" in capsys.readouterr().out


def test_a_run_needs_no_matplotlib(fake, tmp_path, monkeypatch, capsys):
    """If drawing is impossible, one line reports it, and the run is finished and reported. It is
    drawn when possible."""
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "ffimpact.report.drawing", None)
        without.delattr("ffimpact.report.drawing", raising=False)
        assert main(["run", "disc-normal", "--out", str(tmp_path / "out")]) == 0
    captured, starts = capsys.readouterr(), fake.starts()
    assert (captured.err.startswith("ffimpact: the figures could not be drawn: ") and captured.err.count("\n") == 1
            and "contact time" in captured.out)
    assert main(["run", "disc-normal", "--out", str(tmp_path / "out")]) == 0 and (tmp_path / "out/figures/force.png").exists()
    assert "finished earlier" in capsys.readouterr().out and fake.starts() == starts


def test_published_numbers_are_not_shown_beside_another_scene(fake, tmp_path, capsys):
    """The paper has no number at another speed, and none is shown."""
    assert main(["run", "disc-normal", "--no-figures", "--set", "speed=4", "--set", "fields=0", "--out", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    assert "contact time" in out and "paper" not in out and "NGSolve" not in out


def test_quiet_is_quiet(fake, tmp_path):
    """--quiet prints warnings only, not even the new place of an earlier run of another scene."""
    run.run(scene.load("disc-normal"), {"speed": 4, "fields": 0}, tmp_path / "out")
    code, out, error = call("run", "disc-normal", "--quiet", "--no-figures", "--set", "speed=5", "fields=0", "--out", str(tmp_path / "out"))
    assert (code, out) == (0, "") and all(line.startswith("ffimpact: warning: ") for line in error.splitlines())
    assert (tmp_path / "out.1").exists()


def test_quiet_leaves_warnings(fake, tmp_path, capsys, monkeypatch):
    """With --quiet each warning is a line on stderr."""
    result = run.run(scene.load("disc-normal"), {"fields": 0}, tmp_path / "out")
    result.summary["warnings"] = ["penalty: too soft"]
    monkeypatch.setattr(run, "run", lambda *_, **__: result)
    assert main(["run", "disc-normal", "--quiet"]) == 0
    assert tuple(capsys.readouterr()) == ("", "ffimpact: warning: penalty: too soft\n")


def test_failure_of_the_script_is_passed_on(fake, tmp_path):
    """The line of the script appears on stderr unchanged, with its exit code. stdout has the place
    of the files."""
    fake("step")
    code, out, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 11 and err == "ffimpact: step: no convergence at t = 1.2e-3 s, dt = 1e-9 s, residual 3e-4\n"
    assert str(tmp_path.name) in out


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_run_leaves_nothing(fake, tmp_path, number, code):
    """Ctrl-C (or SIGTERM) ends FreeFem++, too, and leaves no folder, finished or not."""
    fake("slow")
    process = start("run", "disc-normal", "--out", str(tmp_path / "out"))
    wait_for(fake.starts)
    process.send_signal(number)
    _, err = process.communicate(timeout=10)
    assert process.returncode == code and "Traceback" not in err
    assert not is_alive(fake.pids()[0])
    assert not list(tmp_path.glob("out*"))


def test_progress_is_shown_on_a_terminal_only(fake, tmp_path):
    """On a terminal one line shows the run, the number of runs, the state and the total remaining
    time, from the mesh on; elsewhere it is not shown."""
    master, slave = pty.openpty()
    termios.tcsetwinsize(slave, (24, 100))
    process = start("run", "disc-normal", "--no-figures", "--set", "fields=0", "--out", str(tmp_path / "out"), stderr=slave)
    os.close(slave)
    seen = ""
    try:
        while block := os.read(master, 10000):
            seen += block.decode()
    except OSError:  # the other end is closed
        os.close(master)
    process.communicate(timeout=60)
    assert re.search(r"disc-normal: main run 1 of 3, t = 3.000 ms, 150 steps +51% .*, \d\d:\d\d left", seen) and process.returncode == 0
    assert "main run 1 of 3, mesh" in seen and "coarser run 2 of 3" in seen
