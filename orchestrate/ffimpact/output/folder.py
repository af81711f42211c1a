"""The folder of a run: made beside its place, locked while it is made, gone on with from its
checkpoint, put in its place by rename.

A run happens in the folder DIR.part. Finished, it takes DIR's place, complete: a folder with
summary.json is a finished run. Interrupted, it leaves nothing, or DIR.part where it has made a
checkpoint: there the same scene and code go on. What a run finds in its place stays as DIR.1 (.2
...), unless it is of the same scene: then what the program wrote goes, and what else is there moves
over.
"""

import fcntl
import fnmatch
import itertools
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from ..failure import Busy, Unreadable
from ..places import shown
from .results import read_summary, why

__all__ = [
    "FIGURES",
    "checkpoints",
    "clear",
    "failed_beside",
    "finished_in",
    "lock_folder",
    "replace",
    "result_folder",
    "staging",
    "unfinished",
]

# what the program writes into a folder: what a run leaves, what it needs on its way, and its
# pictures
RECORDS = (
    "scene.toml",
    "history.csv",
    "contacts.csv",
    "modes.csv",
    "states.bin",
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
    "scene.dat",
    "summary.json.part",
    "checkpoint",
    "checkpoint.new",
    "checkpoint.json",
    "body-files/*",
    "fields.pvd",
    *FIELDS,
    *(f"figures/{name}.png" for name in FIGURES),
)
OURS = {
    "scene.toml",
    "failure.json",
    "unfinished",
    "checkpoint.json",
}  # a folder with one of these is the program's


def result_folder(out: Path) -> Path:
    """The path of a result folder without links; Unreadable where there cannot be one."""
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
    """Where a failed run leaves its files if `folder` holds an earlier finished one."""
    return folder.with_name(folder.name + ".failed")


def finished_in(folder: Path, force: bool) -> dict | None:
    """The summary of the finished run in `folder`, None if there is none; Unreadable if the
    folder is not ours.
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


# ---- made beside its place


@contextmanager
def staging(folder: Path) -> Iterator[tuple[Path, int]]:
    """The folder DIR.part and its lock, against a second run. Gone in the end, unless it has
    the checkpoint of a run that is not finished. What is in it at first was left by a run that
    was killed.
    """
    stage = folder.with_name(folder.name + ".part")
    with ExitStack() as leaving:
        leaving.callback(
            _take_away, [made for made in (stage, *stage.parents) if not made.exists()]
        )  # a signal may come at any moment
        leaving.callback(os.close, lock := _lock(stage, folder))
        if not folder.exists() and _is_complete(stage):  # killed between the two renames of replace
            os.rename(stage, folder)  # with its lock, which stays
            leaving.callback(os.close, lock := _lock(stage, folder))
        elif folder.exists():
            leaving.callback(os.close, lock_folder(folder, folder))  # against a run without Python
        # what a run makes has checkpoint.json from the first to the last moment; a folder of that
        # name that lacks it is somebody's
        if os.listdir(stage) and not (stage / "checkpoint.json").exists():
            raise Unreadable(
                f"{stage}, where the run would be made, has files of others in it; choose another --out"
            )
        try:
            yield stage, lock
        finally:
            if _holds(lock, stage) and not checkpoints(
                stage
            ):  # once in its place, that name may already be another run's
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
        return (stage / "checkpoint.json").exists() and "code" in read_summary(stage).get(
            "provenance", {}
        )  # the last that _finish writes
    except Unreadable:
        return False


def _lock(stage: Path, folder: Path) -> int:
    """The open folder `stage`, made if need be and locked; Busy where another run holds it."""
    while True:
        try:
            stage.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Unreadable(
                f"{stage} cannot be made: {error.strerror}; choose another --out"
            ) from None
        try:
            lock = lock_folder(stage, folder)
        except FileNotFoundError:  # its run has just put it in its place
            continue
        if _holds(lock, stage):  # not likewise, while we locked it
            return lock
        os.close(lock)


def _holds(lock: int, path: Path) -> bool:
    """Whether `path` is the folder that was opened as `lock`."""
    try:
        return os.path.samestat(os.fstat(lock), os.stat(path))
    except FileNotFoundError:
        return False


def lock_folder(path: Path, folder: Path) -> int:
    """The folder `path` opened and locked; Busy where a run in `folder` holds it.

    The lock is flock() on the folder itself. FreeFem++ shares the open folder and so the lock,
    and no lock file is left.
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
    for checkpoint in checkpoints(stage):  # first: without the rest they are of no use
        checkpoint.unlink()
    for left_over in sorted(
        stage.iterdir(), key=lambda path: path.name == "checkpoint.json"
    ):  # last: what makes the folder ours
        shutil.rmtree(left_over) if left_over.is_dir() else left_over.unlink()


def checkpoints(stage: Path) -> list[Path]:
    """Those of the run in `stage`, and of the runs that estimate its error."""
    return [path for path in (stage / "checkpoint", *stage.glob("*/checkpoint")) if path.exists()]


def unfinished(stage: Path) -> dict | None:
    """What the run was asked for whose checkpoint is in `stage`, None if there is none;
    Unreadable if it does not say.
    """
    if not checkpoints(stage):
        return None
    try:
        return json.loads((stage / "checkpoint.json").read_text())
    except (OSError, ValueError) as error:
        raise Unreadable(
            f"{stage / 'checkpoint.json'} cannot be read: {why(error)}; delete {shown(stage)} to start from the "
            "beginning, or run with --force"
        ) from None


# ---- put in its place


def replace(stage: Path, folder: Path, same: bool) -> None:
    """Puts `stage` in the place of `folder`, complete or not at all.

    What was there stays as DIR.1 (.2 ...); where it is of the `same` scene, what the program
    wrote there goes, and what else is there moves over.
    """
    earlier = None
    if folder.exists() and any(folder.iterdir()):
        earlier = next(
            place
            for n in itertools.count(1)
            if not os.path.lexists(place := folder.with_name(f"{folder.name}.{n}"))
        )
        os.rename(folder, earlier)
    os.rename(stage, folder)
    (folder / "checkpoint.json").unlink(missing_ok=True)
    if earlier and not (same and _merge(earlier, folder)):
        print(f"what was in {shown(folder)} before is now in {shown(earlier)}")


def _merge(earlier: Path, folder: Path) -> bool:
    """Takes away what the program wrote in `earlier`, moves the rest to `folder`; False where
    something is in the way there.
    """
    (earlier / "summary.json").unlink(missing_ok=True)  # first: no longer a finished run
    for path in sorted(earlier.rglob("*"), reverse=True):  # what is in a folder, then the folder
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
