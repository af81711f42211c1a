"""Studies: many runs of one scene, at most one FreeFem++ per core. The outcome of each run becomes
a row of a table.
"""

import hashlib
import math
import os
import threading
import time
import traceback
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from .. import scene
from ..failure import BadInput, Busy, Failure, Unreadable
from ..freefem import freefem
from ..input import models, parameters
from ..input.parameters import Table, Value
from ..mesh import mesh
from ..output.errors import errors
from ..output.folder import failed_beside
from ..output.results import Record, read_json
from ..progress import Line, forward
from ..running import run
from ..scene import Scene

__all__ = [
    "CORES",
    "Point",
    "cell",
    "complete",
    "outcome_of",
    "outcomes",
    "place",
    "save",
    "run_parallel",
    "study",
    "table",
    "find_finished",
    "unit_of",
    "warned",
]

CORES = freefem.CORES
POLL = 0.2  # time [s] between two updates of the progress of the runs
LONGEST = 200  # largest number of characters of a folder's name
Key = TypeVar("Key", bound=Hashable)
Point = dict[str, Value]  # the parameters in which this run differs from others


def study(
    points: list[Point],
    folder: Path,
    base: Point,
    limit: float = math.inf,
    run_scene: Scene | str = "disc-normal",
    cores: int = CORES,
    estimate: bool = False,
    force: bool = False,
) -> pd.DataFrame:
    """Runs all `points` and returns a row for each, in their order: its parameters, exit, message,
    warnings (joined by "; "), reused, and the numbers of its summary; with `estimate` also their
    errors, <name>_error.

    Every run is the scene `run_scene` with `base` and the parameters of the point, in folder/runs/,
    and may take `limit` seconds. `cores` runs are computed at a time. Finished runs in the folder, and
    failures of the same scene and code, are not repeated unless `force` is set. A run that fails is
    a row like any other, with its exit code and message. Several studies may share a folder: each
    leaves out the runs that another one is computing. Raises NotInstalled if FreeFem++ is missing.
    """
    places = [place(folder, point) for point in points]
    loaded = scene.load(run_scene) if isinstance(run_scene, str) else run_scene
    rows = outcomes(points, folder, base, loaded, estimate, force)
    tasks = {
        where: loaded.override(base | point)
        for where, point in zip(places, points)
        if where not in rows
    }
    if tasks:
        freefem.find()
        # The folder is made here, because an interrupted run removes the folders that it made.
        (folder / "runs").mkdir(parents=True, exist_ok=True)
    acts = {
        where: partial(outcome_of, where, requested, limit, estimate, force)
        for where, requested in tasks.items()
    }
    for where, outcome in run_parallel(acts, cores, "/".join(folder.parts[-2:]), len(rows)):
        rows[where] = _row(1, str(outcome), False, {}) if isinstance(outcome, Failure) else outcome
    return pd.DataFrame([point | rows[where] for where, point in zip(places, points)])


def outcomes(
    points: list[Point],
    folder: Path,
    base: Point,
    loaded: Scene,
    estimate: bool = False,
    force: bool = False,
) -> dict[Path, Table]:
    """Returns, by folder, the outcomes of points that need no run: those that are in the folder
    already (with `force` none), and those that the scene `loaded` refuses.
    """
    rows: dict[Path, Table] = {}
    for point in points:
        where = place(folder, point)
        try:
            requested = loaded.override(base | point)
            outcome = None if force else find_finished(where, requested, estimate)
        except BadInput as error:
            outcome = _row(error.code, str(error), False, {})
        rows |= {where: outcome} if outcome else {}
    return rows


def place(folder: Path, point: Point) -> Path:
    """Returns the result folder of a point of the study in `folder`. It is named after the
    parameters of the point; if the name is too long it is cut and ends with a hash.
    """
    name = ",".join(f"{name}={value}" for name, value in point.items()).replace("/", "_") or "run"
    if len(name) > LONGEST:
        name = f"{name[: LONGEST - 20]},{hashlib.sha256(name.encode()).hexdigest()[:16]}"
    return folder / "runs" / name


def run_parallel(
    acts: Mapping[Key, Callable[[], Any]], cores: int, name: str, before: int = 0
) -> Iterator[tuple[Key, Any]]:
    """Calls the functions `acts`, `cores` at a time, each in a thread, which mostly waits for its
    FreeFem++.

    Yields (key, result) as they end. The result is a Failure if a function raises an error that it
    does not expect. A function that returns None is called again later. Leaving the generator in
    any way ends the functions and their FreeFem++. A line of progress with this `name` shows how
    many are done, including `before` that were done already.
    """
    stop, done = threading.Event(), before
    shares: dict[Key, float] = {}  # progress of the functions that are running
    mesh.start_gmsh()  # it resets signal handlers, which only the main thread restores

    def words() -> str:
        return f"{done} of {before + len(acts)} done"

    with Line(name, dict.fromkeys(acts, 1.0), words=words()) as line:
        pool = ThreadPoolExecutor(cores)
        try:
            running = {pool.submit(_work, key, act, stop, shares): key for key, act in acts.items()}
            while running:
                for future in wait(running, POLL, FIRST_COMPLETED).done:
                    key, outcome = running.pop(future), _outcome_of(future)
                    shares.pop(key, None)
                    if outcome is None:  # another study computes this run
                        time.sleep(POLL)
                        running[pool.submit(_work, key, acts[key], stop, shares)] = key
                        continue
                    done += 1
                    line.at(key, 1.0, words())
                    yield key, outcome
                for key, share in shares.copy().items():
                    line.at(key, share, words())
        finally:
            stop.set()
            pool.shutdown(cancel_futures=True)


def _work(key: Key, act: Callable[[], Any], stop: threading.Event, shares: dict[Key, float]) -> Any:
    """Calls one function in its thread. Its progress goes into `shares`, and its FreeFem++ ends
    once `stop` is set.
    """
    with forward(lambda share, _: shares.update({key: share})), freefem.limited(stop=stop):
        return act()


def _outcome_of(future: Future[Any]) -> Any:
    """Returns the result of a function. If it raised an error that it does not expect, this prints
    the error and returns a Failure.
    """
    error = future.exception()
    if error is None:
        return future.result()
    if not isinstance(error, Exception):
        raise error
    traceback.print_exception(error)
    return Failure(f"{type(error).__name__}: {error}")


def find_finished(folder: Path, requested: Scene, estimate: bool = False) -> Table | None:
    """Returns the outcome that is in `folder` already, None if there is none: a finished run, with
    `estimate` one that has its error estimate, or a failure of the same scene and code, which would
    be repeated.
    """
    for candidate in (folder, failed_beside(folder)):
        failed = read_json(candidate / "failure.json")
        made = failed.get("provenance") or {}
        if (
            failed.get("exit_code") in (11, 12)
            and made.get("code") == run.code_hash()
            and made.get("asked") == requested.decisive_entries
        ):
            return _row(failed["exit_code"], str(failed.get("message")), True, failed)
    try:
        result = run.reusable(requested, folder, estimate)
        return _finished(result, estimate) if result else None
    except Failure:  # the run reports it
        return None


def outcome_of(
    folder: Path, requested: Scene, limit: float, estimate: bool = False, force: bool = False
) -> Table | None:
    """Runs a scene, unless its outcome is there already and `force` is not set. Returns the row of the
    table: exit code, message, warnings, reused, and the numbers of the summary, as far as the run
    came in `limit` seconds. None if another process is computing this run.
    """
    if row := None if force else find_finished(folder, requested, estimate):
        return row
    try:
        with freefem.limited(limit):
            result = run.run(requested, out=folder, force=force, estimate=estimate, progress=False)
        return _finished(result, estimate)
    except Busy:
        return None
    except Failure as failure:
        record = read_json(failure.folder / "failure.json") if failure.folder else {}
        return _row(failure.code, str(failure), False, record)
    except OSError as error:  # a full disk
        return _row(Unreadable.code, f"{error.filename or folder}: {error.strerror}", False, {})


def _finished(result: Record, estimate: bool) -> Table:
    """The row of a finished run, with the errors of its numbers where they are estimated."""
    row = _row(0, result.summary["message"], result.reused, result.summary)
    by_name = errors(result) if estimate else {}
    return row | {f"{name}_error": error for name, error in by_name.items()}


def _row(code: int, message: str, reused: bool, summary: Table) -> Table:
    numbers = {
        name: value
        for name, value in summary.items()
        if type(value) in (int, float) and name != "exit_code"
    }
    return {
        "exit": code,
        "message": message,
        "warnings": "; ".join(summary.get("warnings", [])),
        "reused": reused,
    } | numbers


def warned(warnings: Iterable[str]) -> str:
    """Returns how many runs have which warning, "" if none has any. `warnings` holds those of each
    run, joined by "; ".
    """
    every = list(warnings)
    counts = Counter(
        sentence.split(":")[0] for joined in every for sentence in joined.split("; ") if sentence
    )
    return (
        f"{', '.join(f'{name} in {count}' for name, count in counts.most_common())} of {len(every)} runs"
        if counts
        else ""
    )


def table(frame: pd.DataFrame, formats: dict[str, str]) -> str:
    """Returns columns as a table of text in markdown. `formats` maps the names of columns to
    formats such as ".3f" ("": as it is).
    """
    cells = [[cell(value, form) for value in frame[name]] for name, form in formats.items()]
    widths = [max(map(len, [name, *column])) for name, column in zip(formats, cells)]
    lines = [list(formats), ["-" * (width - 1) + ":" for width in widths], *zip(*cells)]
    return "\n".join(
        "| " + " | ".join(f"{cell:>{width}}" for cell, width in zip(line, widths)) + " |"
        for line in lines
    )


def cell(value: Any, form: str) -> str:
    """Returns a value as text in a format, "" for a missing value."""
    return "" if pd.isna(value) else format(value, form)


def save(frame: pd.DataFrame, path: Path) -> None:
    """Writes a tidy CSV, one row per run."""
    with complete(path) as part:
        frame.to_csv(part, index=False)


@contextmanager
def complete(path: Path) -> Iterator[Path]:
    """Yields a temporary path to write to, which is renamed to `path` at the end. A reader or a
    second writer never sees an incomplete file.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"part-{os.getpid()}-{path.name}")
    try:
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def unit_of(name: str) -> str:
    """Returns the unit of a parameter (of body.2.young that of young), "-" if it has none."""
    entry = name.rpartition(".")[2]
    parameter = parameters.PARAMETERS.get(entry) or models.rule_of_body(entry)
    return parameter.unit if parameter and parameter.unit else "-"
