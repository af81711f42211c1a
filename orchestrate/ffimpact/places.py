"""The folders of the program's files and of its results."""

from pathlib import Path

__all__ = ["INSTALLED", "PACKAGE", "RESULTS", "ROOT", "shown"]

PACKAGE = Path(__file__).resolve().parent  # the Python package with scenes and sweeps
# The folder that contains edp/: the package if the program is installed, else the source folder.
ROOT = PACKAGE if (PACKAGE / "edp").is_dir() else PACKAGE.parents[1]
RESULTS = Path("results")  # relative to the working folder
# Whether the program is installed, without the source folder, its verification/ and Makefile.
INSTALLED = ROOT == PACKAGE


def shown(path: Path) -> Path:
    """Returns a path as it is printed: relative to the working folder if it lies below that
    folder.
    """
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path
