"""Studies: many runs of one scene, one FreeFem++ a core at most; whatever a run comes to becomes a row of a table."""

import hashlib
import multiprocessing
import os
import signal
import time
from collections import Counter, deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from .. import scene, stopping
from ..failure import BadInput, Busy, Failure, TooLong, Unreadable
from ..freefem import freefem
from ..input.parameters import Value
from ..mesh import mesh
from ..output.folder import failed_beside
from ..output.results import read_json
from ..progress import Line, forward
from ..running import run

CORES = freefem.CORES
STOPS = (signal.SIGTERM, signal.SIGHUP, signal.SIGINT)
LONGEST = 200               # characters of a folder's name
Key = TypeVar("Key", bound=Hashable)
Point = dict[str, Value]    # the parameters that tell this run from the others of the study


def study(points: list[Point], folder: Path, base: Point, limit: float, name: str = "disc-normal", cores: int = CORES) -> pd.DataFrame:
    """A row for each of `points`, in their order: its parameters, exit, message, warnings (joined by "; "), reused, and
    the numbers of its summary.

    Every run is the scene `name` with `base` and the point's parameters on top, in folder/runs/, and may take `limit` seconds; `cores` of
    them run at a time, none estimates its error. What is there already is not run again: finished runs, and failures of the same scene and
    code. A run that fails is a row like any other, with its exit code and message; NotInstalled, without FreeFem++, is raised. Several
    studies may share a folder: what one is running, the others leave to it.
    """
    places = [place(folder, point) for point in points]
    given = scene.load(name)
    found = outcomes(points, folder, base, given)
    tasks = {where: given.override(base | point) for where, point in zip(places, points) if where not in found}
    if tasks:
        freefem.find()
        if given.meshed:
            mesh.start_gmsh()     # once for all runs, which are forks of this process
        (folder / "runs").mkdir(parents=True, exist_ok=True)   # here: a run takes away what it had to make if it is interrupted
    acts = {where: partial(_outcome, where, wanted, limit) for where, wanted in tasks.items()}
    for where, outcome in side_by_side(acts, cores, "/".join(folder.parts[-2:]), len(found)):
        found[where] = _row(1, str(outcome), False, {}) if isinstance(outcome, Failure) else outcome
    return pd.DataFrame([point | found[where] for where, point in zip(places, points)])


def outcomes(points: list[Point], folder: Path, base: Point, given: scene.Scene) -> dict[Path, dict]:
    """By folder what is known of the points without a run: what is there already, and those that the scene `given` refuses."""
    found = {}
    for point in points:
        where = place(folder, point)
        try:
            outcome = there(where, given.override(base | point))
        except BadInput as error:
            outcome = _row(error.code, str(error), False, {})
        found |= {where: outcome} if outcome else {}
    return found


def place(folder: Path, point: Point) -> Path:
    """The result folder of a point of the study in `folder`, named after its parameters; where that is too long for a name by its hash."""
    name = ",".join(f"{name}={value}" for name, value in point.items()).replace("/", "_") or "run"
    if len(name) > LONGEST:
        name = f"{name[:LONGEST - 20]},{hashlib.sha256(name.encode()).hexdigest()[:16]}"
    return folder / "runs" / name


def side_by_side(acts: dict[Key, Callable], cores: int, name: str, before: int = 0) -> Iterator[tuple[Key, Any]]:
    """(key, what its act returns) as they are ready, `cores` at a time, a process each; a Failure where the process was lost. An act that
    returns None is asked again later. Leaving this in any way ends them and their FreeFem++. A line of progress, by its `name`, says which
    of how many, `before` of which were there already.
    """
    context = multiprocessing.get_context("fork")
    waiting, running, done = deque(acts), {}, before
    try:
        with Line(name, dict.fromkeys(acts, 1.0), words=f"{done} of {before + len(acts)} done") as line:
            while waiting or running:
                while waiting and len(running) < cores:
                    key = waiting.popleft()
                    receiver, sender = context.Pipe(duplex=False)
                    process = context.Process(target=_work, args=(sender, os.getpid(), acts[key]))
                    signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)      # a handler inside the fork would be lost
                    process.start()
                    signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPS)
                    sender.close()
                    running[receiver] = key, process
                for receiver in wait(running):
                    key, process = running[receiver]
                    try:
                        ended, outcome = receiver.recv()
                    except EOFError:
                        process.join()
                        ended, outcome = True, Failure(f"its process ended with exit code {process.exitcode}")
                    if not ended:         # how far it is
                        line.at(key, outcome, f"{done} of {before + len(acts)} done")
                        continue
                    del running[receiver]
                    if outcome is None:   # another study is at it: see later what came of it
                        waiting.append(key)
                        time.sleep(0.3)
                    else:
                        done += 1
                        line.at(key, 1.0, f"{done} of {before + len(acts)} done")
                        yield key, outcome
    finally:
        for _, process in running.values():
            process.terminate()
        for _, process in running.values():
            process.join()


def _work(sender: Connection, parent: int, act: Callable) -> None:
    """One act in a process of its own."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)         # Ctrl-C is for the parent, who then ends us
    stopping.on(signal.SIGTERM, stopping.leave)          # run() tidies up on the way out
    signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPS)
    freefem.die_with_parent(parent, signal.SIGTERM)
    forward(lambda share, _: sender.send((False, share)))
    sender.send((True, act()))


def end_after(limit: float) -> None:
    """TooLong is raised in `limit` seconds."""
    def too_long(number):
        raise TooLong(f"no end after {limit:g} s: killed")
    stopping.on(signal.SIGALRM, too_long)                # run() tidies up on the way out
    signal.setitimer(signal.ITIMER_REAL, limit)


def there(folder: Path, wanted: scene.Scene) -> dict | None:
    """The outcome that is in `folder` already: a finished run, or a failure of the same scene and code, which would be repeated."""
    for place in (folder, failed_beside(folder)):
        failed = read_json(place / "failure.json")
        made = failed.get("provenance") or {}
        if failed.get("exit_code") in (11, 12) and made.get("code") == run.code_hash() and made.get("asked") == wanted.asked:
            return _row(failed["exit_code"], str(failed.get("message")), True, failed)
    try:
        result = run.reusable(wanted, folder)
    except Failure:                                      # will be said by the run
        return None
    return result and _row(0, result.summary["message"], True, result.summary)


def _outcome(folder: Path, wanted: scene.Scene, limit: float) -> dict | None:
    """Exit code, message, whether it was there already, and the numbers of the summary, as far as the run came in `limit` seconds; None
    where another run is at it."""
    end_after(limit)
    if found := there(folder, wanted):
        return found
    try:
        result = run.run(wanted, out=folder, estimate=False)
        return _row(0, result.summary["message"], result.reused, result.summary)
    except Busy:
        return None
    except Failure as failure:
        record = read_json(failure.folder / "failure.json") if failure.folder else {}
        return _row(failure.code, str(failure), False, record)
    except OSError as error:                             # a full disk
        return _row(Unreadable.code, f"{error.filename or folder}: {error.strerror}", False, {})


def _row(code: int, message: str, reused: bool, summary: dict) -> dict:
    numbers = {name: value for name, value in summary.items() if type(value) in (int, float) and name != "exit_code"}
    return {"exit": code, "message": message, "warnings": "; ".join(summary.get("warnings", [])), "reused": reused} | numbers


def warned(warnings: Iterable[str]) -> str:
    """How many runs have which warning, from the warnings of each, joined by "; "; empty where none has any."""
    every = list(warnings)
    counts = Counter(sentence.split(":")[0] for joined in every for sentence in joined.split("; ") if sentence)
    return f"{', '.join(f'{name} in {count}' for name, count in counts.most_common())} of {len(every)} runs" if counts else ""


def table(frame: pd.DataFrame, formats: dict[str, str]) -> str:
    """The columns named in `formats` (column: format, such as ".3f"; "" as it is) as a table of text in markdown."""
    cells = [[cell(value, form) for value in frame[name]] for name, form in formats.items()]
    widths = [max(map(len, [name, *column])) for name, column in zip(formats, cells)]
    lines = [list(formats), ["-" * (width - 1) + ":" for width in widths], *zip(*cells)]
    return "\n".join("| " + " | ".join(f"{cell:>{width}}" for cell, width in zip(line, widths)) + " |" for line in lines)


def cell(value, form: str) -> str:
    """A value as text in a format; nothing where there is no value."""
    return "" if pd.isna(value) else format(value, form)


def save(frame: pd.DataFrame, path: Path) -> None:
    """Writes a tidy CSV, a row a run."""
    with complete(path) as part:
        frame.to_csv(part, index=False)


@contextmanager
def complete(path: Path) -> Iterator[Path]:
    """A name to write to, which takes the name `path` in the end: a reader or a second writer never sees half a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"part-{os.getpid()}-{path.name}")
    try:
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)
