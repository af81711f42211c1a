"""What is in the folder of a finished run: its history, its scene as used, its summary."""

import json
import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from .failure import Unreadable
from .parameters import Value


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


def read_table(path: Path, columns: Iterable[str]) -> pd.DataFrame:
    """A table of a run; Unreadable where it is not one that has these columns."""
    try:
        table = pd.read_csv(path)
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


class Answers(NamedTuple):
    """Of a finished run the summary, with energy_final and largest_energy [J/m], the scene as used, the largest speed of a centre of mass [m/s], and
    the columns of its history."""

    summary: dict
    used: dict[str, Value]
    speed: float
    history: dict[str, np.ndarray]


def read_answers(folder: Path) -> Answers:
    """The answers of a finished run, and what energies and velocities are measured by: as seen by one who moves with the obstacles, or without any with the
    bodies' common centre of mass: errors do not depend on a motion that all share."""
    history, summary, used = read_history(folder), read_summary(folder), read_scene(folder)
    axes, bodies = [axis for axis in "xyz" if f"v{axis}" in history], suffixes(history)
    mass = summary["mass"]
    common = np.column_stack([history[f"v{axis}"] for axis in axes])
    frame = _frame(used, common[0], len(bodies))
    seen = common if frame is None else np.broadcast_to(frame, common.shape)
    speed = max(float(np.linalg.norm([history[f"v{axis}{of}"] - seen[:, i] for i, axis in enumerate(axes)], axis=0).max()) for of in bodies)
    shared = mass * (seen * (seen / 2 - common)).sum(axis=1)                 # from the scene's frame to the other
    energy = float((history["kinetic"] + history["elastic"] + history["contact"] + shared).max())
    last = np.array([summary.get(f"rebound_v{axis}", 0.0) for axis in axes])
    at = last if frame is None else frame
    found = summary | {"largest_energy": energy, "energy_final": summary["energy_final"] + mass * float(at @ (at / 2 - last))}
    return Answers(found, used, speed, history)


def _frame(used: dict, like: np.ndarray, bodies: int) -> np.ndarray | None:
    """The velocity of the obstacles of a scene; None where there are none."""
    if "body" not in used:
        return None if bodies > 1 else np.zeros_like(like)
    obstacles = [one.get("velocity", np.zeros_like(like)) for one in used.get("obstacle", [])]
    return np.mean([[0.0, one] if np.isscalar(one) else one for one in obstacles], axis=0) if obstacles else None    # of revolution: along the axis


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
