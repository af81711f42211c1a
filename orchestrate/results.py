"""What is in the folder of a finished run: its history, its scene as used, its summary."""

import json
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .failure import Unreadable
from .parameters import Value

if TYPE_CHECKING:
    from pandas import DataFrame   # takes longer to load than a run: only where a table is wanted


@dataclass(frozen=True)
class RunResult:
    """A finished run. `reused`: it was there already."""

    folder: Path
    summary: dict
    reused: bool

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """The columns of history.csv, each (steps,), SI units."""
        return read_history(self.folder)

    @cached_property
    def scene(self) -> dict[str, Value]:
        """Every parameter as used."""
        return read_scene(self.folder)


def read_history(folder: Path) -> dict[str, np.ndarray]:
    """The columns of history.csv by name, each (steps,); Unreadable when it is missing or no table of numbers."""
    path = folder / "history.csv"
    try:
        with open(path) as file:
            columns = file.readline().strip().split(",")
            rows = np.loadtxt(file, delimiter=",", ndmin=2)
        return dict(zip(columns, rows.T, strict=True))
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path} cannot be read: {why(error)}") from None


def read_table(path: Path, columns: Iterable[str]) -> "DataFrame":
    """A table of a run; Unreadable where it is not one that has these columns."""
    from pandas import read_csv
    try:
        table = read_csv(path)
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path} cannot be read: {error}; run with --force") from None
    if lacks := [name for name in columns if name not in table]:
        raise Unreadable(f"{path} lacks the columns {', '.join(lacks)}; run with --force")
    return table


def read_scene(folder: Path) -> dict[str, Value]:
    """scene.toml: every parameter as used."""
    try:
        return tomllib.loads((folder / "scene.toml").read_text())
    except (OSError, ValueError) as error:
        raise Unreadable(f"{folder / 'scene.toml'} cannot be read: {why(error)}") from None


def read_answers(folder: Path) -> tuple[dict, dict[str, Value], float]:
    """Of a finished run the summary, with largest_energy of its history [J/m], the scene as used, and the largest speed of a centre of
    mass [m/s]: what energies and velocities are measured by."""
    history, summary = read_history(folder), read_summary(folder)
    energy = float((history["kinetic"] + history["elastic"] + history["contact"]).max())
    speed = max(float(np.sqrt(sum(history[f"v{axis}{of}"]**2 for axis in "xyz" if f"v{axis}{of}" in history)).max()) for of in suffixes(history))
    return summary | {"largest_energy": energy}, read_scene(folder), speed


def suffixes(columns: Iterable[str]) -> list[str]:
    """What stands behind the names of columns (of history.csv) or numbers (of summary.json) that are of one body: _1, _2 ..., or
    nothing, where there is one body only."""
    return [f"_{b}" for b in range(1, 1 + sum(re.fullmatch("(rebound_)?spin_[0-9]+", name) is not None for name in columns))] or [""]


def read_summary(folder: Path) -> dict:
    """summary.json of a finished run."""
    try:
        summary = json.loads((folder / "summary.json").read_text())
        if summary["status"] != "ok":
            raise ValueError(f"status is {summary['status']!r}")
        if not isinstance(summary.get("provenance", {}), dict):
            raise ValueError("provenance is no table")
        return summary
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"{folder / 'summary.json'} cannot be read: {why(error)}") from None


def read_json(path: Path) -> dict:
    """What is in a file, {} where there is none or it makes no sense."""
    try:
        content = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def write_json(path: Path, content: dict) -> None:
    path.write_text(json.dumps(content, indent=2) + "\n")


def why(error: Exception) -> str:
    return getattr(error, "strerror", None) or f"{type(error).__name__}: {error}"
