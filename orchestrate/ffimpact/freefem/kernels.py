"""The compiled kernels of edp/kernels: built for the FreeFem++ at hand, where it can be, as a plugin that the scripts find."""

import contextlib
import fcntl
import hashlib
import os
import re
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

from ..places import ROOT

SOURCES = ROOT / "edp/kernels"
BUILT = ROOT / "edp/dev"                 # edp/kernels.idp says why it is called so
LIBRARIES = ("-lcholmod", "-lumfpack")
THREADS = ("-fopenmp",), ()              # where the compiler has no OpenMP: one thread
QUIET = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)


def build(command: str, version: str, environment: Mapping[str, str]) -> bool:
    """Whether the scripts find a plugin made of the sources as they stand for this FreeFem++. It is built where there is none, by the
    ff-c++ beside that; where that fails, for want of a compiler, of headers or of a folder to write in, the scripts run without."""
    maker = Path(command).resolve().with_name("ff-c++")
    if not maker.exists() or re.search(r'["\\\n]', str(BUILT)):
        return False
    sources = sorted(SOURCES.iterdir())
    made_of = [version, str(maker), str(maker.stat().st_mtime_ns), *(path.read_text() for path in sources)]
    plugin = BUILT / f"kernels-{hashlib.sha256(chr(0).join(made_of).encode()).hexdigest()[:12]}.so"
    # FreeFEM puts its own folders before any name: from each of them up to the root
    way = "../" * 40 + str(plugin.with_suffix("")).lstrip("/")
    interface = re.search(r"IFMACRO\(kernelsBuilt,(\d+)\)", (ROOT / "edp/kernels.idp").read_text())[1]    # the calls that the scripts know
    loading = f'load "{way}"\nmacro kernelsBuilt(){interface}//\n'
    if _built(plugin, loading):
        return True
    try:
        BUILT.mkdir(exist_ok=True)
        with open(BUILT / "lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)   # processes that start together: one builds, the others wait
            if not _built(plugin, loading):
                _build(command, maker, plugin, loading, environment)
        return True
    except (OSError, subprocess.SubprocessError):
        with contextlib.suppress(OSError):
            (BUILT / "null").unlink()              # it loads what is made of other sources
        return False


def _built(plugin: Path, loading: str) -> bool:
    null = BUILT / "null"
    return plugin.exists() and null.exists() and null.read_text() == loading


def _build(command: str, maker: Path, plugin: Path, loading: str, environment: Mapping[str, str]) -> None:
    """The plugin, then the file that loads it: whoever starts meanwhile finds the old, nothing or the new, and all of it."""
    if not plugin.exists():
        with tempfile.TemporaryDirectory(dir=BUILT) as folder:
            source = os.path.relpath((SOURCES / "kernels.cpp").resolve(), Path(folder).resolve())   # ff-c++ lets no ' pass
            for flags in THREADS:
                made = subprocess.run([maker, *flags, source, *LIBRARIES], cwd=folder, env=environment, check=not flags,
                                      timeout=300, **QUIET)
                if made.returncode == 0:
                    break
            (Path(folder) / "try.edp").write_text('load "./kernels"\n')
            subprocess.run([command, "-nw", "-ne", "-v", "0", "try.edp"], cwd=folder, env=environment, check=True, timeout=60,
                           **QUIET)
            os.replace(Path(folder) / "kernels.so", plugin)
    part = BUILT / f"null.{os.getpid()}"
    part.write_text(loading)
    os.replace(part, BUILT / "null")
    for old in BUILT.glob("kernels-*.so"):
        if old != plugin:
            old.unlink()
