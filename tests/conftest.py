"""Fixtures of all tests: a substitute for FreeFem++, and result folders made without FreeFem++."""

import shlex
import signal
import sys

import pytest

from ffimpact.freefem import freefem, kernels
from tests.support import fake_freefem

# A shell makes its background jobs ignore Ctrl-C, which tests send.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Replaces FreeFem++ by the substitute. fake(mode) selects its behaviour, fake.starts() counts
    its runs."""
    program, count = tmp_path / "FreeFem++", tmp_path / "starts"
    program.write_text(f'#!/bin/sh\nexec {shlex.join([sys.executable, "-I", "-S", fake_freefem.__file__])} "$@"\n')
    program.chmod(0o755)
    word = freefem.find().plugin  # the substitute has no compiler
    monkeypatch.setattr(kernels, "build", lambda *_: word)
    monkeypatch.setenv("FREEFEM", str(program))
    monkeypatch.setenv("FAKE_REAL", fake_freefem.REAL)
    monkeypatch.setenv("FAKE_COUNT", str(count))

    def choose(mode: str) -> None:
        monkeypatch.setenv("FAKE", mode)

    choose.pids = lambda: [int(line) for line in count.read_text().split()] if count.exists() else []
    choose.starts = lambda: len(choose.pids())
    choose("ok")
    return choose


@pytest.fixture
def finished_folder(tmp_path):
    """A result folder with a history, a scene and nine snapshots of half a disc."""
    folder = tmp_path / "finished"
    folder.mkdir()
    fake_freefem.write_history(folder)
    fake_freefem.write_fields(folder, 9)
    fake_freefem.write_scene(folder)
    return folder
