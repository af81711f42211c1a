"""Reads the folder of a finished run: its history, its scene as used, its summary.

Whatever is wrong with a file is Unreadable, in one line: the file is missing, is damaged, lacks
what is needed, or differs from the one that the run has written (`files` of the provenance).
"""

import hashlib
import json
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Never, TypeVar

import numpy as np

from ..failure import Unreadable, brief, unknown
from ..input.parameters import Table
from . import former

if TYPE_CHECKING:
    from pandas import DataFrame  # slow to load, so it is imported only where a table is needed

__all__ = [
    "Answers",
    "Contents",
    "Record",
    "body_names",
    "check_files",
    "columns_of",
    "content",
    "digest",
    "files_of",
    "force_times",
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

T = TypeVar("T")

# Files of a run that the program reads again.
WRITTEN = (
    "scene.toml",
    "history.csv",
    "contacts.csv",
    "modes.csv",
    "fields.pvd",
    "fields/*.vtu",
    "fields/contact.csv",
)
STILL = 1e-6  # smallest speed that errors are relative to, over sqrt(2 energy/mass)
AGAIN = "delete its folder, or run it again with --force"


@dataclass(frozen=True)
class Record:
    """The files of a finished run, read when they are needed: the summary, the scene as used, the
    history. `reused`: the run was in the folder already.
    """

    folder: Path
    summary: Table
    reused: bool

    @cached_property
    def history(self) -> "Contents[np.ndarray]":
        """The columns of history.csv, each (steps,), SI units."""
        return read_history(self.folder)

    @cached_property
    def scene(self) -> "Contents[Any]":
        """Every parameter as used, as tables."""
        return read_scene(self.folder)


def read_record(folder: Path) -> Record:
    """Returns the record of a finished run in a folder. Raises Unreadable if a file is not as the
    run has written it.
    """
    record = Record(folder, read_summary(folder), reused=True)
    check_files(folder)
    return record


# ---- files


class Contents(dict[str, T]):
    """The content of the file `path` of a run by name. A missing name is Unreadable, with a list of
    the names that exist.
    """

    def __init__(self, entries: Mapping[str, T], path: Path):
        super().__init__({name: _contents(value, path) for name, value in entries.items()})
        self.path = path

    def __missing__(self, name: str) -> Never:
        raise Unreadable(brief(f"{self.path}: {unknown(name, self, ', ')}"))

    def __reduce__(self) -> tuple[type, tuple[dict[str, T], Path]]:
        return Contents, (dict(self), self.path)


def _contents(value: Any, path: Path) -> Any:
    """Returns a value of a file, with the tables in it as Contents."""
    if isinstance(value, list):
        return [_contents(item, path) for item in value]
    return Contents(value, path) if isinstance(value, dict) else value


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Makes Unreadable of any error in the content of the file `path` of a run."""
    try:
        if path.exists() and not path.is_file():  # a pipe or a device might never end
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
    """Returns the text of the file `path` of a run. Raises Unreadable if the file is missing or is
    not the one that the run has written.
    """
    folder = path.parent.parent if path.parent.name == "fields" else path.parent
    with reading(path):
        data = path.read_bytes()
        files = (read_json(folder / "summary.json").get("provenance") or {}).get("files", {})
        if hashlib.sha256(data).hexdigest() != files.get(
            path.relative_to(folder).as_posix(), hashlib.sha256(data).hexdigest()
        ):
            raise ValueError("it is not as the run has written it")
        return data.decode()


def files_of(folder: Path) -> dict[str, str]:
    """Returns the sha256, by name, of the files in `folder` that a run has written and that are
    read again.
    """
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for pattern in WRITTEN
        for path in sorted(folder.glob(pattern))
    }


def check_files(folder: Path) -> None:
    """Raises Unreadable if a file of a finished run is not as the run has written it. A file that
    was deleted is no error.
    """
    for name in (read_json(folder / "summary.json").get("provenance") or {}).get("files", {}):
        if (folder / name).exists():
            content(folder / name)


def read_table(path: Path, columns: Iterable[str] = ()) -> np.recarray:
    """Returns a table of a run, which holds numbers only, with one field per column. Raises
    Unreadable if it lacks one of `columns` or is cut off.
    """
    head, end, rows = content(path).partition("\n")
    with reading(path):
        # An empty entry stands for an unknown value.
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
        return np.rec.fromarrays(numbers.T, dtype=[(name, float) for name in names])


def read_frame(path: Path, columns: Iterable[str] = (), **options: Any) -> "DataFrame":
    """Returns a table that a study or a sweep has written, which may hold words."""
    import pandas as pd

    with reading(path):
        table = pd.read_csv(path, **options)
        if lacks := [name for name in columns if name not in table]:
            raise ValueError(f"it lacks the columns {', '.join(lacks)}")
        return table


def read_history(folder: Path) -> Contents[np.ndarray]:
    """Returns the columns of history.csv by name, each (steps,)."""
    path = folder / "history.csv"
    text = content(path)
    with reading(path):
        columns = columns_of(text)
        rows = len(next(iter(columns.values())))
        # The history has one row more than steps, that of the start.
        if rows <= (steps := read_json(folder / "summary.json").get("steps", 0)):
            raise ValueError(f"it has {rows} rows of {steps + 1}")
        return Contents(columns, path)


def columns_of(text: str) -> dict[str, np.ndarray]:
    """Returns the columns of a history by name. Raises ValueError if the text is cut off."""
    head, _, rows = text.partition("\n")
    if not rows.endswith("\n"):
        raise ValueError("it is empty or cut off")
    lines = rows.splitlines()
    table = np.loadtxt(lines, delimiter=",", ndmin=2)
    if len(table) < len(lines):
        raise ValueError("it has empty lines")
    return dict(zip(head.split(","), table.T, strict=True))


def read_scene(folder: Path) -> Contents[Any]:
    """Returns scene.toml: every parameter as used, as tables."""
    path = folder / "scene.toml"
    text = content(path)
    with reading(path):
        return Contents(former.tables(tomllib.loads(text)), path)


class Answers(NamedTuple):
    """The results of a finished run: the summary, with energy_final and largest_energy [J/m], the
    scene as used, the largest speed of a centre of mass [m/s], and the columns of its history.
    """

    summary: Table
    used: Table
    speed: float
    history: dict[str, np.ndarray]


def read_answers(folder: Path) -> Answers:
    """Returns the results of a finished run, and the energy and speed to which errors are relative.

    They refer to the frame of the obstacles, or without obstacles to that of the common centre of
    mass. So errors do not depend on a motion that all bodies share.
    """
    history, summary, used = read_history(folder), read_summary(folder), read_scene(folder)
    axes, bodies = [axis for axis in "xyz" if f"v{axis}" in history], suffixes(history)
    mass = summary["mass"]
    common = np.column_stack([history[f"v{axis}"] for axis in axes])
    held = "support_work" in history  # supports do not move with the bodies
    frame = np.zeros_like(common[0]) if held else _frame(used, common[0], len(bodies))
    seen = common if frame is None else np.broadcast_to(frame, common.shape)
    speed = max(
        float(
            np.linalg.norm(
                [history[f"v{axis}{suffix}"] - seen[:, i] for i, axis in enumerate(axes)], axis=0
            ).max()
        )
        for suffix in bodies
    )
    # Change of the kinetic energy from the frame of the scene to the moving frame.
    shared = mass * (seen * (seen / 2 - common)).sum(axis=1)
    energy = float((mechanical_energy(history) + shared).max())
    # Without an entry `final_...` the velocities of the rebound are those at the end of the run.
    final = {axis: summary.get(f"final_v{axis}") for axis in axes}
    last = np.array(
        [summary.get(f"rebound_v{axis}", 0.0) if v is None else v for axis, v in final.items()]
    )
    at = last if frame is None else frame
    extended = summary | {
        "largest_energy": energy,
        "energy_final": summary["energy_final"] + mass * float(at @ (at / 2 - last)),
    }
    return Answers(
        extended, used, max(speed, (1 if held else STILL) * math.sqrt(2 * energy / mass)), history
    )


def _frame(used: Table, like: np.ndarray, bodies: int) -> np.ndarray | None:
    """Returns the velocity of the obstacles of a scene [m/s], None if there are none."""
    if "body" not in used:
        return None if bodies > 1 else np.zeros_like(like)
    # For bodies of revolution the velocity is a number, along the axis.
    velocities = [
        np.array([0.0, velocity] if np.isscalar(velocity) else velocity)
        for obstacle in used.get("obstacle", [])
        for velocity in [obstacle.get("velocity", np.zeros_like(like))]
    ]
    return np.mean(velocities, axis=0) if velocities else None


def mechanical_energy(history: Mapping[str, np.ndarray]) -> np.ndarray:
    """Returns the sum of kinetic, elastic and contact energy (steps,) [J, in plane strain J/m]."""
    total: np.ndarray = history["kinetic"] + history["elastic"] + history["contact"]
    return total


# Integrators whose forces are those at the end of a step.
END_FORCES = ("bdf2", "backward-euler")


def force_times(history: Mapping[str, np.ndarray], integrator: object) -> np.ndarray:
    """Returns the times [s] of the forces of a history. Forces are means over a step and belong to
    its middle, except for the integrators of END_FORCES.
    """
    at_end = integrator in END_FORCES
    times: np.ndarray = history["t"] - (0 if at_end else history["dt"] / 2)
    return times


def suffixes(columns: Iterable[str]) -> list[str]:
    """Returns the suffixes _1, _2 ... of the bodies in names of columns (of history.csv) or numbers
    (of summary.json); one empty suffix if there is only one body.
    """
    return [
        f"_{b}"
        for b in range(
            1, 1 + sum(re.fullmatch("(rebound_)?spin_[0-9]+", name) is not None for name in columns)
        )
    ] or [""]


def body_names(used: Table) -> list[str]:
    """Returns the names of several bodies of a scene as used, in the order of the suffixes."""
    return [body["name"] for body in used["body"]] if "body" in used else ["disc", "block"]


def held_bodies(used: Table) -> set[str]:
    """Returns the suffixes of the bodies with a support that holds until the end, for a scene as
    used.
    """
    tables = used.get("body", [])
    holding = [
        any("release" not in support for support in body.get("support", [])) for body in tables
    ]
    return {f"_{b}" if len(tables) > 1 else "" for b, holds in enumerate(holding, 1) if holds}


def read_summary(folder: Path) -> Table:
    """Returns summary.json of a finished run. Raises Unreadable if it is damaged: if an entry has
    another kind than the program writes, or if it is not as the run has written it.
    """
    path = folder / "summary.json"
    with reading(path):
        summary = json.loads(path.read_text("utf-8"))
        if not isinstance(summary, dict) or "status" not in summary:
            raise ValueError("it is no summary of a run")
        if summary["status"] != "ok":
            raise ValueError(f"status is {summary['status']!r}")
        for name, value in summary.items():
            kind, is_of_kind = KINDS_OF.get(name, NUMBER)
            if not is_of_kind(value):
                raise ValueError(f"{name} is no {kind}")
        if summary.get("provenance", {}).get("summary", digest(summary)) != digest(summary):
            raise ValueError("it is not as the run has written it")
        _renew_script(summary.get("provenance", {}))
        return Contents(summary, path)


def _renew_script(provenance: Table) -> None:
    """Replaces a script of former versions by the one that has taken its place."""
    script = provenance.get("script")
    if script in former.SCRIPTS:
        provenance["script"] = former.SCRIPTS[script][0]


def digest(summary: Table) -> str:
    """Returns the sha256 of all entries of a summary but its provenance."""
    entries = {name: value for name, value in summary.items() if name != "provenance"}
    return hashlib.sha256(json.dumps(entries, sort_keys=True).encode()).hexdigest()


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | None) and not isinstance(value, bool)


def _are(values: object, is_of_kind: Callable[[object], bool]) -> bool:
    return isinstance(values, list) and all(map(is_of_kind, values))


def _is_provenance(value: object) -> bool:
    return (
        isinstance(value, dict)
        and isinstance(value.get("files", {}), dict)
        and isinstance(value.get("script", ""), str)
    )


# Kinds of the entries of a summary: words for a message, and whether a value is of this kind.
# All entries that KINDS_OF does not list are numbers or null.
Kind = tuple[str, Callable[[object], bool]]
NUMBER: Kind = "number", _is_number
TEXT: Kind = "text", lambda value: isinstance(value, str)
TEXTS: Kind = "list of texts", lambda value: _are(value, TEXT[1])
NUMBERS: Kind = "list of numbers", lambda value: _are(value, _is_number)
TABLE: Kind = (
    "table of numbers",
    lambda value: (
        value is None
        or isinstance(value, dict)
        and all(_is_number(number) or NUMBERS[1](number) for number in value.values())
    ),
)
KINDS_OF: dict[str, Kind] = (
    dict.fromkeys(("status", "message", "ended", "made_by", "integrator", "volume"), TEXT)
    | dict.fromkeys(
        (
            "warnings",
            "notes",
            "skipped",
            "released",
            "symmetric_along",
            "estimated_error_excludes",
        ),
        TEXTS,
    )
    | dict.fromkeys(("estimated_error", "phase_seconds"), TABLE)
    | {
        "later_contact_possible": ("truth value", lambda value: isinstance(value, bool)),
        "first_restitutions": NUMBERS,
        "provenance": ("table", _is_provenance),
    }
)


def numbers(summary: Table) -> list[str]:
    """Returns the names of the numbers of a summary."""
    return [
        name
        for name, value in summary.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    ]


def read_json(path: Path) -> Table:
    """Returns the content of a file, {} if it is missing or damaged."""
    try:
        data = json.loads(path.read_text("utf-8")) if path.is_file() else {}
    except (OSError, ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}


def write_json(path: Path, content: Table) -> None:
    path.write_text(json.dumps(content, indent=2) + "\n")


def why(error: Exception) -> str:
    message = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
    return getattr(error, "strerror", None) or message
