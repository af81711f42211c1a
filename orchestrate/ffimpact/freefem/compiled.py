"""Compiled files in the cache folder of the user. Files of other versions and other sources are
kept beside them.
"""

import hashlib
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from platformdirs import user_cache_path

from .. import __version__, progress

__all__ = ["QUIET", "compiled"]

UNFINISHED = "unfinished-"  # prefix of the temporary folders
LONG = 3600.0  # age [s] of a temporary folder that no process uses any more
QUIET: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)


def compiled(name: str, made_of: Iterable[str], make: Callable[[Path], None]) -> Path | None:
    """Returns the path of the file `name`, which is identified by the texts `made_of`: its sources
    and all else that it depends on.

    If the file is missing, make(folder) makes it in a temporary folder, from which it is moved to
    its place in one step, so that several processes can do this at a time. Returns None if the file
    cannot be made because a compiler, headers or a writable folder are missing.
    """
    key = hashlib.sha256("\0".join(made_of).encode()).hexdigest()[:12]
    path = user_cache_path("ffimpact") / __version__ / key / name
    if path.exists():
        return path
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_remains(path.parents[1])
        with (
            tempfile.TemporaryDirectory(dir=path.parent, prefix=UNFINISHED) as folder,
            progress.work(f"compiling {name}, once for this version"),
        ):
            make(Path(folder))
            os.replace(Path(folder) / name, path)
        return path
    except (OSError, subprocess.SubprocessError):
        return None


def _remove_remains(cache: Path) -> None:
    """Removes the temporary folders of processes that were killed long ago."""
    for folder in cache.glob(f"*/{UNFINISHED}*"):
        if time.time() - folder.stat().st_mtime > LONG:
            shutil.rmtree(folder, ignore_errors=True)
