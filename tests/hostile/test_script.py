"""The Python interface in an environment that has only the program and its dependencies."""

import shutil
import subprocess
import venv

import pytest

from ffimpact.input.parameters import ROOT
from tests.support.block import CELLS


@pytest.mark.robustness
def test_the_block_runs_where_only_the_package_is_installed(tmp_path, monkeypatch):
    """After pip install . in a fresh environment the block runs as a script in an empty folder, with
    figures and the player."""
    for name in ("PYTHONPATH", "PYTHONHOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MPLBACKEND", "agg")
    tree = shutil.copytree(ROOT, tmp_path / "tree", ignore=shutil.ignore_patterns(".*", "results", "build", "*.egg-info"))
    venv.create(tmp_path / "venv", with_pip=True)
    pip = [tmp_path / "venv/bin/pip", "install", "-q", "--disable-pip-version-check", "--retries", "1", "--timeout", "20"]
    done = subprocess.run([*pip, tree], capture_output=True, text=True, timeout=900)
    if any(sign in done.stderr for sign in ("No matching distribution", "Connection", "Temporary failure in name resolution")):
        pytest.skip(f"the package index cannot be reached: {done.stderr.splitlines()[-1]}")
    assert done.returncode == 0, done.stderr
    place = tmp_path / "empty"
    place.mkdir()
    script = tmp_path / "block.py"
    script.write_text("\n".join(CELLS))
    done = subprocess.run([tmp_path / "venv/bin/python", script], cwd=place, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr and "pip install" not in done.stdout + done.stderr, done.stdout
    assert (place / "impact.html").exists()
    assert (place / "drop.toml").exists() and (place / "results/slow/summary.json").exists()
