"""Fixtures of all tests: a substitute for FreeFem++, and result folders made without FreeFem++."""

import re
import shlex
import shutil
import signal
import sys

import pytest

from ffimpact.freefem import freefem
from tests.support import fake_freefem

# A shell makes its background jobs ignore Ctrl-C, which tests send.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Replaces FreeFem++ by the substitute. fake(mode) selects its behaviour, fake.starts() counts
    its runs."""
    program, count = tmp_path / "FreeFem++", tmp_path / "starts"
    program.write_text(f'#!/bin/sh\nexec {shlex.join([sys.executable, fake_freefem.__file__])} "$@"\n')
    program.chmod(0o755)
    plugin = re.search('="(.*)"', freefem.find().plugin)[1]  # the substitute has no compiler
    (tmp_path / "ff-c++").write_text(f"#!/bin/sh\nexec {shutil.which('cp')} {shlex.quote(f'/{plugin}.so')} kernels.so\n")
    (tmp_path / "ff-c++").chmod(0o755)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
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
