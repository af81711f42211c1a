"""The installed package: what is in it, that it runs from any folder, and what it says where something is missing."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest

import ffimpact
from ffimpact.input.parameters import ROOT
from ffimpact.running import run

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def packed() -> dict[str, Path]:
    """What pyproject.toml puts into site-packages: the name there, and the file."""
    tools = PROJECT["tool"]["setuptools"]
    found = {}
    for package in tools["packages"]:
        owner = next(name for name in sorted(tools["package-dir"], key=len, reverse=True) if f"{package}.".startswith(f"{name}."))
        folder = ROOT / tools["package-dir"][owner] / package.removeprefix(owner).lstrip(".").replace(".", "/")
        for pattern in ["*.py", *tools["package-data"].get(package, [])]:
            found |= {f"{package.replace('.', '/')}/{path.relative_to(folder)}": path for path in folder.glob(pattern)}
    return found


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A folder of packages with ours in it, as it is installed."""
    folder = tmp_path_factory.mktemp("site-packages")
    for name, path in packed().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, folder / name)
    return folder


def call(site: Path, cwd: Path, *words: str, **environment: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, *words], cwd=cwd, env=os.environ | {"PYTHONPATH": str(site)} | environment, capture_output=True, text=True, timeout=60)


def test_the_package_holds_every_file_of_the_program():
    """Nothing of orchestrate/ffimpact/ and edp/ is forgotten, nothing else comes along, and no other name lands in site-packages."""
    there = {path for place in ("orchestrate/ffimpact", "edp") for path in (ROOT / place).rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert {str(path.relative_to(ROOT)) for path in there - set(packed().values())} == set()
    assert set(packed().values()) <= there and {name.split("/")[0] for name in packed()} == {"ffimpact"}


def test_it_runs_in_any_folder(fake, site, tmp_path):
    """Installed it runs a scene by the same code, with its results below the working folder, and names itself by its own name."""
    done = call(site, tmp_path, "-c", "from ffimpact import scene; from ffimpact.running import run; run.run(scene.load('disc-normal'), {'fields': 0}, estimate=False)")
    assert done.returncode == 0, done.stderr
    said = json.loads((tmp_path / "results/disc-normal/summary.json").read_text())["provenance"]
    assert said["code"] == run.code_hash() and said["version"] == ffimpact.__version__ and said["git"] == "unknown"
    assert call(site, tmp_path, "-m", "ffimpact", "run", "--help").stdout.startswith("usage: ffimpact run ")


def test_what_is_not_there_is_one_line(fake, site, tmp_path):
    """A run without FreeFem++ ends with exit code 13 and a line that says where to get it."""
    line = "ffimpact: /none not found; install it: apt-get install freefem.*conda-forge.*FreeFem-sources/releases"
    done = call(site, tmp_path, "-m", "ffimpact", "run", "disc-normal", FREEFEM="/none")
    assert done.returncode == 13 and re.fullmatch(f"{line}.*\n", done.stderr), done.stderr


def test_one_version(site, tmp_path):
    """--version, the summaries and the newest number of CHANGELOG.md say the same; importing the package takes no pandas."""
    assert call(site, tmp_path, "-m", "ffimpact", "--version").stdout == f"ffimpact {ffimpact.__version__}\n"
    assert re.findall(r"^## ([0-9.]+)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[0] == ffimpact.__version__
    assert call(site, tmp_path, "-c", "import ffimpact, sys; print({'pandas', 'numpy'} & set(sys.modules))").stdout == "set()\n"


def test_the_lock_is_within_the_ranges():
    """requirements.lock pins every dependency, and pytest, at a version that pyproject.toml accepts."""
    def numbers(version: str) -> tuple[int, ...]:
        return tuple(map(int, version.split(".")))
    pins = dict(line.replace("_", "-").split("==") for line in (ROOT / "requirements.lock").read_text().splitlines() if not line.startswith("#"))
    for wanted in PROJECT["project"]["dependencies"] + PROJECT["project"]["optional-dependencies"]["test"]:
        name, low, high = re.fullmatch(r"([\w-]+)>=([\d.]+)(?:,<(\d+))?", wanted).groups()
        pin = numbers(pins[name.replace("_", "-")])
        assert numbers(low) <= pin and (not high or pin < numbers(high))


@pytest.mark.robustness
@pytest.mark.parametrize("how", [[], ["-e"]])
def test_pip_installs_it(how, tmp_path):
    """pip install ., and -e, in a fresh environment: the command and the package; of a wheel exactly the files that are promised."""
    tree = shutil.copytree(ROOT, tmp_path / "tree", ignore=shutil.ignore_patterns(".venv", ".git", "results", "build"))
    venv.create(tmp_path / "venv", with_pip=True)
    subprocess.run([tmp_path / "venv/bin/pip", "install", "-q", *how, tree], check=True, timeout=600)
    assert subprocess.run([tmp_path / "venv/bin/ffimpact", "--version"], cwd=tmp_path, capture_output=True, text=True).stdout == f"ffimpact {ffimpact.__version__}\n"
    done = subprocess.run([tmp_path / "venv/bin/ffimpact", "run", "disc-normal", "--set", "accuracy=0.1"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and (tmp_path / "results/disc-normal/summary.json").exists(), done.stderr
    site = next((tmp_path / "venv/lib").glob("python*/site-packages"))
    there = {str(path.relative_to(site)) for path in (site / "ffimpact").rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert there == (set() if how else set(packed())) and not (site / "orchestrate").exists() and not (site / "verification").exists()
