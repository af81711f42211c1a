"""Where things lie: the program's files, and where results go."""

import os
import sys
from pathlib import Path

from .failure import NotInstalled

PACKAGE = Path(__file__).resolve().parent                             # the Python side: scenes, sweeps
# the folder that edp/ lies in: the package where it is installed, else the source folder
ROOT = PACKAGE if (PACKAGE / "edp").is_dir() else PACKAGE.parent
RESULTS = Path("results")                                             # below the working folder
INSTALLED = ROOT == PACKAGE                                           # without the source folder, its verification/ and Makefile
COMMAND = "ffimpact" if __package__ == "ffimpact" else f"python -m {__package__}"


def shown(path: Path) -> Path:
    """A path for the reader: relative where it is below the working folder."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path


def from_source(argv: list[str]) -> None:
    """For a command that needs verification/, which is not installed: NotInstalled without the source folder; where the package is that of
    another name (pip install -e) it is run from there."""
    if INSTALLED:
        raise NotInstalled(f"{argv[0]}: needs the program's source folder (verification/), which pip install does not bring: run "
                           f"python -m orchestrate {argv[0]} in a clone of it, or make it reachable by pip install -e .")
    if __package__ != "orchestrate":
        os.environ["PYTHONPATH"] = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
        os.execv(sys.executable, [sys.executable, "-m", "orchestrate", *argv])
