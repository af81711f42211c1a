"""The command line: exit codes, one-line errors, interruption, and the list of targets of `make`.
"""

import errno
import importlib
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ffimpact import __main__ as command_line
from ffimpact.__main__ import main
from ffimpact.failure import Unreadable
from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.running import run
from tests.support.cli import ROOT


def test_lists(capsys):
    """All scenes and parameters are listed."""
    assert main(["list"]) == 0 and "disc-normal" in capsys.readouterr().out
    assert main(["parameters"]) == 0
    out = capsys.readouterr().out
    assert all(re.search(rf"^{name} ", out, re.MULTILINE) for name in parameters.PARAMETERS)


def test_make_lists_every_target():
    """`make` without a target prints one line for each target."""
    out = subprocess.run(["make", "-s"], cwd=ROOT, capture_output=True, text=True).stdout
    text = (ROOT / "Makefile").read_text()
    targets, sweeps = (re.search(rf"^{name} (.*)$", text, re.MULTILINE)[1] for name in (r"\.PHONY:", "SWEEPS :="))
    targets = targets.replace("$(SWEEPS)", sweeps).split()
    assert [line.split()[1] for line in out.splitlines()] == targets


def test_a_full_disk_is_one_line(tmp_path, monkeypatch, capsys):
    """If the disk is full, one line reports it with exit code 14."""
    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(tmp_path / "out"))
    monkeypatch.setattr(run, "run", full)
    code, error = main(["run", "disc-normal", "--out", str(tmp_path / "out")]), capsys.readouterr().err
    assert code == 14 and error.count("\n") == 1 and "No space left on device" in error and "--out" in error


@pytest.mark.parametrize("module", ["verification.verify", "examples.paper.stick_slip", *(f"benchmarks.{name}" for name in (
    "promise", "bench", "stress", "oblique_angles", "disc_block_errors", "equal_errors", "scaling", "rubber", "layers"))])
def test_a_loop_of_links_is_no_folder(tmp_path, module):
    """A result folder behind a loop of links gives exit code 14 and one line, for every study."""
    (tmp_path / "loop").symlink_to(tmp_path / "pool")
    (tmp_path / "pool").symlink_to(tmp_path / "loop")
    with pytest.raises(Unreadable, match="cannot be made") as error:
        importlib.import_module(module).main(["--out", str(tmp_path / "loop/out")])
    assert error.value.code == 14


def test_a_signal_whose_exception_is_lost_ends_the_program(monkeypatch):
    """Python drops the exception of a signal handler in callbacks of imports. The next wait for a
    process ends the program with the exit code of the signal."""
    signals = []
    monkeypatch.setattr(command_line, "signals", signals)
    monkeypatch.setattr(freefem, "signals", signals)
    with pytest.raises(SystemExit):
        command_line.leave(signal.SIGTERM, None)
    with pytest.raises(SystemExit) as end, subprocess.Popen(["sleep", "0"]) as child:
        freefem.Process(child, Path(os.devnull), sys.stderr).end()
    assert end.value.code == 143
