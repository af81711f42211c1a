"""The installed package: its files, its use from any folder, and its messages if something is
missing."""

import shutil
import subprocess
import venv

import pytest

import ffimpact
from ffimpact.input.parameters import ROOT
from tests.support.package import packed


@pytest.mark.robustness
@pytest.mark.parametrize("how", [[], ["-e"]])
def test_pip_installs_it(how, tmp_path):
    """pip install . and -e in a fresh environment provide the command and the package; a wheel
    contains exactly the expected files."""
    tree = shutil.copytree(ROOT, tmp_path / "tree", ignore=shutil.ignore_patterns(".venv", ".git", "results", "build"))
    venv.create(tmp_path / "venv", with_pip=True)
    subprocess.run([tmp_path / "venv/bin/pip", "install", "-q", *how, tree], check=True, timeout=600)
    assert subprocess.run([tmp_path / "venv/bin/ffimpact", "--version"], cwd=tmp_path, capture_output=True, text=True).stdout == f"ffimpact {ffimpact.__version__}\n"
    done = subprocess.run([tmp_path / "venv/bin/ffimpact", "run", "disc-normal", "--set", "accuracy=0.1"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and (tmp_path / "results/disc-normal/summary.json").exists(), done.stderr
    site = next((tmp_path / "venv/lib").glob("python*/site-packages"))
    there = {str(path.relative_to(site)) for path in (site / "ffimpact").rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert there == (set() if how else set(packed())) and not (site / "orchestrate").exists() and not (site / "verification").exists()
