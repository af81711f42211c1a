"""What is in the folder of a finished run: its history, its scene as used, its summary. Whatever is
wrong with a file of it is Unreadable, in one line: where it is not there, makes no sense or lacks
what is asked of it, or is another than the run has written (`files` of the provenance).
"""

import hashlib
import json
import math
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..failure import Unreadable, brief, unknown
from ..input.parameters import Value

if TYPE_CHECKING:
    from pandas import DataFrame  # takes longer to load than a run: only where a table is wanted

__all__ = [
    "Answers",
    "Contents",
    "Record",
    "body_names",
    "check_files",
    "content",
    "files_of",
    "held_bodies",
    "mechanical_energy",
    "numbers",
    "read_answers",
    "read_frame",
    "read_history",
    "read_json",
    "read_record",
    "read_scene",
    "read_summary",
    "read_table",
    "reading",
    "suffixes",
    "why",
    "write_json",
]

# what is read again
WRITTEN = (
    "scene.toml",
    "history.csv",
    "contacts.csv",
    "modes.csv",
    "fields.pvd",
    "fields/*.vtu",
    "fields/contact.csv",
)
STILL = 1e-6  # of the speed of all energy: a body as slow does not move
AGAIN = "delete its folder, or run it again with --force"


@dataclass(frozen=True)
class Record:
    """The files of a finished run as they are read: the summary, the scene as used, the
    history. `reused`: the run was there already.
    """

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


def read_record(folder: Path) -> Record:
    """The record of a finished run that is there; Unreadable if a file is not as the run has
    written it.
    """
    record = Record(folder, read_summary(folder), reused=True)
    check_files(folder)
    return record


# ---- files


class Contents(dict):
    """What the file `path` of a run says by name; Unreadable, with the names that are there,
    where a name is not.
    """

    def __init__(self, said: dict, path: Path):
        super().__init__({name: _contents(value, path) for name, value in said.items()})
        self.path = path

    def __missing__(self, name: str):
        raise Unreadable(f"{self.path}: {unknown(name, self, ', ')}")

    def __reduce__(self):
        return Contents, (dict(self), self.path)


def _contents(value, path: Path):
    """A value of a file, the tables in it as Contents."""
    if isinstance(value, list):
        return [_contents(one, path) for one in value]
    return Contents(value, path) if isinstance(value, dict) else value


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Unreadable where something fails over what is in the file `path` of a run."""
    try:
        if path.exists() and not path.is_file():  # reading a pipe or a device might never end
            raise ValueError("it is no file")
        yield
    except (FileNotFoundError, NotADirectoryError) as error:
        raise Unreadable(
            f"{path} cannot be read: {error.strerror} (accepted: the folder of a finished run)"
        ) from None
    except (
        OSError,
        ValueError,
        ArithmeticError,
        LookupError,
        TypeError,
        AttributeError,
        RecursionError,
        SyntaxError,
    ) as error:
        raise Unreadable(f"{path} cannot be read: {brief(why(error))}; {AGAIN}") from None


def content(path: Path) -> str:
    """The text of the file `path` of a run; Unreadable where there is none, and where the run
    has written another one.
    """
    folder = path.parent.parent if path.parent.name == "fields" else path.parent
    with reading(path):
        found = path.read_bytes()
        files = (read_json(folder / "summary.json").get("provenance") or {}).get("files", {})
        if hashlib.sha256(found).hexdigest() != files.get(
            path.relative_to(folder).as_posix(), hashlib.sha256(found).hexdigest()
        ):
            raise ValueError("it is not as the run has written it")
        return found.decode()


def files_of(folder: Path) -> dict[str, str]:
    """sha256 by name of what a run has written into `folder` to be read."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for pattern in WRITTEN
        for path in sorted(folder.glob(pattern))
    }


def check_files(folder: Path) -> None:
    """Unreadable where one of the files of a finished run is not as the run has written it; one
    that was taken away is not missed.
    """
    for name in (read_json(folder / "summary.json").get("provenance") or {}).get("files", {}):
        if (folder / name).exists():
            content(folder / name)


def read_table(path: Path, columns: Iterable[str] = ()) -> np.recarray:
    """A table of a run, all numbers: a field a column; Unreadable where it is not one that has
    these columns, and where it is cut off.
    """
    head, end, rows = content(path).partition("\n")
    with reading(path):
        # what is not known is written as nothing
        names, lines = head.split(","), re.sub(r"(?<![^,\n])(?=[,\n])", "nan", rows).splitlines()
        if (
            not end
            or rows[-1:] not in ("", "\n")
            or {len(line.split(",")) for line in lines} - {len(names)}
        ):
            raise ValueError("it is empty, cut off, or has rows of several lengths")
        if lacks := [name for name in columns if name not in names]:
            raise ValueError(f"it lacks the columns {', '.join(lacks)}")
        numbers = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.empty((0, len(names)))
        return np.rec.fromarrays(numbers.T, names=names)


def read_frame(path: Path, columns: Iterable[str] = (), **options) -> "DataFrame":
    """A table that a study or a sweep has written, words too."""
    import pandas as pd

    with reading(path):
        table = pd.read_csv(path, **options)
        if lacks := [name for name in columns if name not in table]:
            raise ValueError(f"it lacks the columns {', '.join(lacks)}")
        return table


def read_history(folder: Path) -> dict[str, np.ndarray]:
    """The columns of history.csv by name, each (steps,)."""
    path = folder / "history.csv"
    head, _, rows = content(path).partition("\n")
    with reading(path):
        if not rows.endswith("\n"):
            raise ValueError("it is empty or cut off")
        table = np.loadtxt(rows.splitlines(), delimiter=",", ndmin=2)
        if len(table) <= (
            steps := read_json(folder / "summary.json").get("steps", 0)
        ):  # one more, of the start
            raise ValueError(f"it has {len(table)} rows of {steps + 1}")
        return Contents(dict(zip(head.split(","), table.T, strict=True)), path)


def read_scene(folder: Path) -> dict[str, Value]:
    """scene.toml: every parameter as used."""
    path = folder / "scene.toml"
    text = content(path)
    with reading(path):
        return Contents(tomllib.loads(text), path)


class Answers(NamedTuple):
    """Of a finished run the summary, with energy_final and largest_energy [J/m], the scene as
    used, the largest speed of a centre of mass [m/s], and the columns of its history.
    """

    summary: dict
    used: dict[str, Value]
    speed: float
    history: dict[str, np.ndarray]


def read_answers(folder: Path) -> Answers:
    """The answers of a finished run, and what energies and velocities are measured by: as seen
    by one who moves with the obstacles, or without any with the bodies' common centre of mass:
    errors do not depend on a motion that all share.
    """
    history, summary, used = read_history(folder), read_summary(folder), read_scene(folder)
    axes, bodies = [axis for axis in "xyz" if f"v{axis}" in history], suffixes(history)
    mass = summary["mass"]
    common = np.column_stack([history[f"v{axis}"] for axis in axes])
    held = "support_work" in history  # by what does not move with the bodies
    frame = np.zeros_like(common[0]) if held else _frame(used, common[0], len(bodies))
    seen = common if frame is None else np.broadcast_to(frame, common.shape)
    speed = max(
        float(
            np.linalg.norm(
                [history[f"v{axis}{of}"] - seen[:, i] for i, axis in enumerate(axes)], axis=0
            ).max()
        )
        for of in bodies
    )
    shared = mass * (seen * (seen / 2 - common)).sum(axis=1)  # from the scene's frame to the other
    energy = float((mechanical_energy(history) + shared).max())
    last = np.array([summary.get(f"rebound_v{axis}", 0.0) for axis in axes])
    at = last if frame is None else frame
    found = summary | {
        "largest_energy": energy,
        "energy_final": summary["energy_final"] + mass * float(at @ (at / 2 - last)),
    }
    return Answers(
        found, used, max(speed, (1 if held else STILL) * math.sqrt(2 * energy / mass)), history
    )


def _frame(used: dict, like: np.ndarray, bodies: int) -> np.ndarray | None:
    """The velocity of the obstacles of a scene; None where there are none."""
    if "body" not in used:
        return None if bodies > 1 else np.zeros_like(like)
    obstacles = [one.get("velocity", np.zeros_like(like)) for one in used.get("obstacle", [])]
    # of revolution: along the axis
    return (
        np.mean([[0.0, one] if np.isscalar(one) else one for one in obstacles], axis=0)
        if obstacles
        else None
    )


def mechanical_energy(history: dict[str, np.ndarray]) -> np.ndarray:
    """Kinetic, elastic and contact energy together (steps,) [J, in plane strain J/m]."""
    return history["kinetic"] + history["elastic"] + history["contact"]


def suffixes(columns: Iterable[str]) -> list[str]:
    """What stands behind the names of columns (of history.csv) or numbers (of summary.json)
    that are of one body: _1, _2 ..., or nothing, where there is one body only.
    """
    return [
        f"_{b}"
        for b in range(
            1, 1 + sum(re.fullmatch("(rebound_)?spin_[0-9]+", name) is not None for name in columns)
        )
    ] or [""]


def body_names(used: dict) -> list[str]:
    """The names of several bodies of a scene as used, in the order of the suffixes."""
    return [body["name"] for body in used["body"]] if "body" in used else ["disc", "block"]


def held_bodies(used: Mapping) -> set[str]:
    """The suffixes of bodies that a support holds until the end, of a scene as used."""
    tables = used.get("body", [])
    holding = [any("release" not in one for one in body.get("support", [])) for body in tables]
    return {f"_{b}" if len(tables) > 1 else "" for b, holds in enumerate(holding, 1) if holds}


def read_summary(folder: Path) -> dict:
    """summary.json of a finished run."""
    path = folder / "summary.json"
    with reading(path):
        summary = json.loads(path.read_text("utf-8"))
        if summary["status"] != "ok":
            raise ValueError(f"status is {summary['status']!r}")
        for name, kind in (("provenance", dict), ("warnings", list), ("notes", list)):
            if not isinstance(summary.get(name, kind()), kind):
                raise ValueError(f"{name} is no {kind.__name__}")
        return Contents(summary, path)


def numbers(summary: Mapping) -> list[str]:
    """The names of the numbers of a summary."""
    return [
        name
        for name, value in summary.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    ]


def read_json(path: Path) -> dict:
    """What is in a file, {} where there is none or it makes no sense."""
    try:
        said = json.loads(path.read_text("utf-8")) if path.is_file() else {}
    except (OSError, ValueError, RecursionError):
        return {}
    return said if isinstance(said, dict) else {}


def write_json(path: Path, content: dict) -> None:
    path.write_text(json.dumps(content, indent=2) + "\n")


def why(error: Exception) -> str:
    said = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
    return getattr(error, "strerror", None) or said
