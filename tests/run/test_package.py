"""The installed package: its files, its use from any folder, and its messages if something is
missing."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ffimpact
from ffimpact.input.parameters import ROOT
from ffimpact.running import run
from tests.support.package import packed


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A folder of packages that contains the installed package."""
    folder = tmp_path_factory.mktemp("site-packages")
    for name, path in packed().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / name)
    return folder


def call(site: Path, cwd: Path, *words: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, *words], cwd=cwd, env=os.environ | {"PYTHONPATH": str(site)} | environment, capture_output=True, text=True, timeout=60)


def test_it_runs_in_any_folder(fake, site, tmp_path):
    """The installed package runs a scene with the same code, writes results below the working
    folder, and uses its own name."""
    done = call(site, tmp_path, "-c", "from ffimpact import scene; from ffimpact.running import run; run.run(scene.load('disc-normal'), {'fields': 0}, estimate=False)")
    assert done.returncode == 0, done.stderr
    provenance = json.loads((tmp_path / "results/disc-normal/summary.json").read_text())["provenance"]
    assert provenance["code"] == run.code_hash() and provenance["version"] == ffimpact.__version__ and provenance["git"] == "unknown"
    assert call(site, tmp_path, "-m", "ffimpact", "run", "--help").stdout.startswith("usage: ffimpact run ")


def test_what_is_not_there_is_one_line(fake, site, tmp_path):
    """A run without FreeFem++ ends with exit code 13 and a line with its sources."""
    line = "ffimpact: /none not found; install it: apt-get install freefem.*conda-forge.*FreeFem-sources/releases"
    done = call(site, tmp_path, "-m", "ffimpact", "run", "disc-normal", FREEFEM="/none")
    assert done.returncode == 13 and re.fullmatch(f"{line}.*\n", done.stderr), done.stderr


def test_one_version(site, tmp_path):
    """--version, the summaries and CHANGELOG.md have the same version. Importing the package does
    not load pandas."""
    assert call(site, tmp_path, "-m", "ffimpact", "--version").stdout == f"ffimpact {ffimpact.__version__}\n"
    assert re.findall(r"^## ([0-9.]+)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[0] == ffimpact.__version__
    assert call(site, tmp_path, "-c", "import ffimpact, sys; print({'pandas', 'numpy'} & set(sys.modules))").stdout == "set()\n"
