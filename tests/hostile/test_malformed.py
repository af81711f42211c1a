"""Malformed input by all three interfaces.

Each gives one line on stderr with the error and exit code 10 or 14, leaves no files and does not
hang.
"""

import signal
from pathlib import Path

import pytest

from tests.support.malformed import by_python


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


@pytest.mark.robustness
def test_more_snapshots_than_memory(capsys):
    """Snapshots that do not fit into the memory are refused. The message has the possible number.
    """
    bytes_there = next(int(line.split()[1]) * 1024 for line in Path("/proc/meminfo").read_text().splitlines() if line.startswith("MemAvailable"))
    if bytes_there > 60e9:
        pytest.skip("so much memory that the mesh would be too fine for a test")
    by_python(capsys, r"fields: 10000 .*accepted here: 0 to \d+\)", "run", "disc-normal", "--no-estimate", "--set", "fields=10000", "mesh_size=7e-4")
