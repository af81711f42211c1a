"""The command line: exit codes, one-line errors, interruption, and the list of targets of `make`.
"""

import subprocess
import sys

import pytest

from tests.support.cli import ROOT, call, start, wait_for


@pytest.mark.robustness
def test_what_a_run_does_not_load():
    """The report of an existing run needs neither matplotlib nor pandas."""
    for loads, heavy, expected in (("import ffimpact.running.run", {"matplotlib", "pandas"}, "set()\n"),):
        process = subprocess.run([sys.executable, "-c", f"{loads}; import sys; print({heavy} & set(sys.modules))"], cwd=ROOT, capture_output=True, text=True)
        assert process.stdout == expected, process.stderr


@pytest.mark.robustness
def test_two_runs_do_not_share_a_folder(fake, tmp_path):
    """A second run into the same folder is refused while the first one is running."""
    fake("slow")
    first = start("run", "disc-normal", "--out", str(tmp_path / "out"))
    wait_for(fake.starts)
    code, _, err = call("run", "disc-normal", "--out", str(tmp_path / "out"))
    assert code == 14 and "being written by another run" in err and first.poll() is None
    first.terminate()
    first.communicate()
