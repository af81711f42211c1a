"""The folder of a run: created beside its final place, locked during the run, resumed from its
checkpoint, and renamed at the end.

A run writes to the folder DIR.part. When it is finished, DIR.part is renamed to DIR: a folder with
summary.json is a finished run. An interrupted run leaves nothing, or DIR.part if it has a
checkpoint; the same scene and code then resume it. An earlier folder DIR stays as DIR.1 (.2 ...),
unless it is of the same scene: then the files of the program are deleted and all others move to the
new folder.
"""

import fcntl
import fnmatch
import itertools
import json
import logging
import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from ..failure import Busy, Unreadable
from ..input.parameters import Table
from ..places import shown
from .results import read_summary, why

log = logging.getLogger("ffimpact")

__all__ = [
    "FIGURES",
    "checkpoints",
    "clear",
    "failed_beside",
    "finished_in",
    "replace",
    "result_folder",
    "staging",
    "unfinished",
]

# Files that the program writes into a folder: results of a run, temporary files, and pictures.
RECORDS = (
    "scene.toml",
    "history.csv",
    "contacts.csv",
    "modes.csv",
    "states.bin",
    "contacts.bin",
    "modes.bin",
    "record.json",
    "summary.json",
)
FIELDS = [
    f"fields/{name}"
    for name in (
        "[0-9][0-9][0-9][0-9].vtu",
        "contact.csv",
        "contact.pvd",
        "contact-[0-9][0-9][0-9][0-9].vtu",
    )
]
FIGURES = (
    "energies",
    "velocity",
    "force",
    "rolling",
    "shapes",
    "pressure",
    "flight",
    "contact",
    "bounces",
    "height",
    "vibration",
    "solid",
)
OWN = (
    *RECORDS,
    "unfinished",
    "failure.json",
    "log.txt",
    "view.html",
    "mesh.msh",
    "mesh.mesh",
    "scene.bin",
    "scene.bin.unstressed",
    "scene.dat",
    "summary.json.part",
    "checkpoint",
    "checkpoint.new",
    "checkpoint.json",
    "last-state",
    "body-files/*",
    "fields.pvd",
    *FIELDS,
    *(f"figures/{name}.png" for name in FIGURES),
)
# A folder with one of these was written by the program.
OURS = {"scene.toml", "failure.json", "unfinished", "checkpoint.json"}


def result_folder(out: Path) -> Path:
    """Returns the path of a result folder without links. Raises Unreadable if it cannot be a result
    folder.
    """
    try:
        folder = out.resolve()
    except (OSError, RuntimeError) as error:  # a loop of links
        raise Unreadable(
            f"{out} cannot be made: {getattr(error, 'strerror', None) or error}; choose another --out"
        ) from None
    if not folder.name:
        raise Unreadable(f"{out} cannot be the folder of a run; choose another --out")
    return folder


def failed_beside(folder: Path) -> Path:
    """Returns the folder for the files of a failed run if `folder` holds an earlier finished
    one.
    """
    return folder.with_name(folder.name + ".failed")


def finished_in(folder: Path, force: bool) -> Table | None:
    """Returns the summary of the finished run in `folder`, None if there is none. Raises Unreadable
    if the folder was not written by this program.
    """
    for path in (folder, failed_beside(folder)):
        if path.exists() and not path.is_dir():
            raise Unreadable(f"{path} is a file; choose another --out")
        if path.exists() and any(path.iterdir()) and not OURS & set(os.listdir(path)):
            raise Unreadable(
                f"{path} has files of others in it and no scene.toml; choose another --out"
            )
    if folder.is_mount():
        raise Unreadable(
            f"{folder} is a mount point, which cannot be put aside; choose another --out, such as a folder in it"
        )
    if not (folder / "summary.json").exists():
        return None
    try:
        return read_summary(folder)
    except Unreadable:
        if force:
            return None
        raise


# ---- created beside its final place


@contextmanager
def staging(folder: Path) -> Iterator[tuple[Path, int]]:
    """Yields the folder DIR.part and its lock, which excludes a second run.

    At the end the folder is removed, unless it has the checkpoint of an unfinished run. Files that
    are in it at the beginning were left by a run that was killed.
    """
    stage = folder.with_name(folder.name + ".part")
    with ExitStack() as leaving:
        # This is registered before the folders are created, as a signal may come at any moment.
        # `stage` itself is removed below, under its lock: without it another run may have made it anew.
        leaving.callback(_take_away, [parent for parent in stage.parents if not parent.exists()])
        leaving.callback(os.close, lock := _lock(stage, folder))
        # A run may have been killed between the two renames of replace().
        if not folder.exists() and _is_complete(stage):
            os.rename(stage, folder)  # its lock stays
            leaving.callback(os.close, lock := _lock(stage, folder))
        # The folder of a run always contains checkpoint.json. A folder of that name without it
        # belongs to someone else.
        if os.listdir(stage) and not (stage / "checkpoint.json").exists():
            raise Unreadable(
                f"{stage}, where the run would be made, has files of others in it; choose another --out"
            )
        try:
            yield stage, lock
        finally:
            # After the rename another run may already use the name DIR.part.
            if _holds(lock, stage) and not checkpoints(stage):
                with suppress(OSError):
                    clear(stage)
                    stage.rmdir()


def _take_away(folders: list[Path]) -> None:
    """Removes those of the folders that are empty."""
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()


def _is_complete(stage: Path) -> bool:
    try:
        # The provenance is the last that a run writes.
        return (stage / "checkpoint.json").exists() and "code" in read_summary(stage).get(
            "provenance", {}
        )
    except Unreadable:
        return False


def _lock(stage: Path, folder: Path) -> int:
    """Returns the opened and locked folder `stage`, which is created if it does not exist. Raises
    Busy if another run holds it.
    """
    while True:
        try:
            stage.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Unreadable(
                f"{stage} cannot be made: {error.strerror}; choose another --out"
            ) from None
        try:
            lock = _lock_folder(stage, folder)
        except FileNotFoundError:  # its run has just renamed it
            continue
        if _holds(lock, stage):  # else it was renamed before it was locked
            return lock
        os.close(lock)


def _holds(lock: int, path: Path) -> bool:
    """Whether `path` is still the folder that was opened as `lock`."""
    try:
        return os.path.samestat(os.fstat(lock), os.stat(path))
    except FileNotFoundError:
        return False


def _lock_folder(path: Path, folder: Path) -> int:
    """Returns the folder `path`, opened and locked. Raises Busy if a run in `folder` holds it.

    The lock is flock() on the folder itself. FreeFem++ shares the open folder and so the lock. No
    lock file is left.
    """
    lock = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(lock)
        raise Busy(
            f"{folder} is being written by another run; wait, or choose another --out"
        ) from None
    return lock


# ---- a run that was killed


def clear(stage: Path) -> None:
    for checkpoint in checkpoints(stage):  # first, as they are of no use without the other files
        checkpoint.unlink()
    # checkpoint.json comes last, because it marks the folder as one of the program.
    for left_over in sorted(stage.iterdir(), key=lambda path: path.name == "checkpoint.json"):
        shutil.rmtree(left_over) if left_over.is_dir() else left_over.unlink()


def checkpoints(stage: Path) -> list[Path]:
    """Returns the checkpoints of the run in `stage`, and of the runs that estimate its error."""
    return [path for path in (stage / "checkpoint", *stage.glob("*/checkpoint")) if path.exists()]


def unfinished(stage: Path) -> Table | None:
    """Returns the request of the run whose checkpoint is in `stage`, None if there is none. Raises
    Unreadable if the request cannot be read.
    """
    if not checkpoints(stage):
        return None
    try:
        request: Table = json.loads((stage / "checkpoint.json").read_text())
        return request
    except (OSError, ValueError) as error:
        raise Unreadable(
            f"{stage / 'checkpoint.json'} cannot be read: {why(error)}; delete {shown(stage)} to start from the "
            "beginning, or run with --force"
        ) from None


# ---- renamed to its final place


def replace(stage: Path, folder: Path, same: bool) -> None:
    """Puts `stage` in the place of `folder`, complete or not at all.

    The earlier folder stays as DIR.1 (.2 ...). If it is of the `same` scene, the files of the
    program in it are deleted and all others move to `folder`.
    """
    earlier = None
    if folder.exists() and any(folder.iterdir()):
        earlier = next(
            path
            for n in itertools.count(1)
            if not os.path.lexists(path := folder.with_name(f"{folder.name}.{n}"))
        )
        os.rename(folder, earlier)
    os.rename(stage, folder)
    (folder / "checkpoint.json").unlink(missing_ok=True)
    if earlier and not (same and _merge(earlier, folder)):
        log.info("what was in %s before is now in %s", shown(folder), shown(earlier))


def _merge(earlier: Path, folder: Path) -> bool:
    """Deletes the files of the program in `earlier` and moves all others to `folder`. Returns False
    if `folder` has a file of the same name.
    """
    (earlier / "summary.json").unlink(missing_ok=True)  # first: it is no finished run any longer
    for path in sorted(earlier.rglob("*"), reverse=True):  # files of a folder, then the folder
        name = path.relative_to(earlier).as_posix()
        if path.is_dir() and not path.is_symlink():
            if not any(path.iterdir()):
                path.rmdir()
        elif any(fnmatch.fnmatchcase(name, own) for own in OWN):
            path.unlink()
        elif not os.path.lexists(folder / name):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            os.rename(path, folder / name)
    if any(earlier.iterdir()):
        return False
    earlier.rmdir()
    return True
