"""What is compiled on a machine lies in the user's cache folder, beside what other versions and
other sources have left there.
"""

import hashlib
import os
import subprocess
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from platformdirs import user_cache_path

from .. import __version__

__all__ = ["QUIET", "compiled"]

QUIET = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)


def compiled(name: str, made_of: Iterable[str], make: Callable[[Path], None]) -> Path | None:
    """The file `name` made of these texts, the sources and whatever else it depends on. Where
    the file is missing, make(folder) makes it in a folder of its own, from where it moves to
    its place at once: several processes may do so at a time. None where it cannot be made, for
    want of a compiler, of headers or of a folder to write in.
    """
    key = hashlib.sha256("\0".join(made_of).encode()).hexdigest()[:12]
    place = user_cache_path("ffimpact") / __version__ / key / name
    if place.exists():
        return place
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=place.parent) as folder:
            make(Path(folder))
            os.replace(Path(folder) / name, place)
        return place
    except (OSError, subprocess.SubprocessError):
        return None
