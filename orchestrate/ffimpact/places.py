"""Where things lie: the program's files, and where results go."""

from pathlib import Path

__all__ = ["INSTALLED", "PACKAGE", "RESULTS", "ROOT", "shown"]

PACKAGE = Path(__file__).resolve().parent  # the Python side: scenes, sweeps
# the folder that edp/ lies in: the package where it is installed, else the source folder
ROOT = PACKAGE if (PACKAGE / "edp").is_dir() else PACKAGE.parents[1]
RESULTS = Path("results")  # below the working folder
INSTALLED = ROOT == PACKAGE  # without the source folder, its verification/ and Makefile


def shown(path: Path) -> Path:
    """A path for the reader: relative where it is below the working folder."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path
