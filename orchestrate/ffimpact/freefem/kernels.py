"""Builds the compiled kernels of edp/kernels as a plugin for the installed FreeFem++. A word on the
command line of a script loads the plugin.

Each .cpp file is a unit. Its object is kept in the cache folder of the user and is compiled again if
the unit, a header that it includes, or the compiler's command changes.
"""

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from .. import progress
from ..failure import signals
from ..places import ROOT
from .compiled import QUIET, compiled

__all__ = ["HOW", "SOURCES", "build"]

SOURCES = ROOT / "edp/kernels"
LIBRARIES = ("-lcholmod", "-lumfpack")
# Added to the compiler's words of ff-c++. Debug information would double the time.
FLAGS = ("-std=c++17", "-g0")
HOW = (
    "they need g++, ff-c++ and the headers of FreeFem++, SuiteSparse and Eigen, and a cache folder "
    "(XDG_CACHE_HOME) that can be written: apt-get install g++ libfreefem++-dev libsuitesparse-dev "
    "libeigen3-dev"
)
INCLUDE = re.compile(r'(?m)^#include "(.+)"')
SECONDS = 600.0  # longest time [s] for one command
POLL = 0.05  # time [s] between two checks of a command


@dataclass(frozen=True)
class _Compiler:
    """The commands with which ff-c++ compiles unit.cpp to unit.o and links unit.o to unit.so, their
    environment, and the version of FreeFem++ and of ff-c++.
    """

    compile: list[str]
    link: list[str]
    environment: Mapping[str, str]
    version: str

    def object(self, unit: str, sources: Mapping[str, str], stop: threading.Event) -> Path | None:
        """Returns the object of a unit, or None if it cannot be made."""
        texts = _with_headers(unit, sources)

        def make(folder: Path) -> None:
            for name, text in texts.items():
                (folder / name).write_text(text)
            words = [unit if word == "unit.cpp" else word for word in self.compile]
            _run([*words, *FLAGS, "-o", "unit.o"], self.environment, folder, stop)

        # Only the plugin is announced. Another unit has failed if `stop` is set.
        with progress.muted():
            made_of = [self.version, *self.compile, *FLAGS, *texts, *texts.values()]
            return compiled("unit.o", made_of, make)


def build(command: str, version: str, environment: Mapping[str, str]) -> str:
    """Returns the command-line word with which a script loads the plugin of the present sources for
    this FreeFem++. If the plugin is missing, it is built as ff-c++ builds: that in the folder of
    FreeFem++ or, where FreeFem++ is a script elsewhere, that of the search path. The word is empty
    if that fails.
    """
    beside = Path(command).resolve().with_name("ff-c++")
    maker = beside if beside.exists() else Path(shutil.which("ff-c++") or beside)
    try:
        compiler = _compiler(maker, version, environment)
    except (OSError, subprocess.SubprocessError, StopIteration):
        return ""
    sources = {path.name: path.read_text() for path in sorted(SOURCES.iterdir())}
    made_of = [compiler.version, *compiler.compile, *compiler.link, *FLAGS, *sources.values()]
    plugin = compiled("kernels.so", made_of, partial(_make, command, compiler, sources))
    if not plugin or re.search(r'["\\\n]', str(plugin)):
        return ""
    # The version of the interface through which the scripts call the kernels.
    [interface] = re.findall(
        r"(?m)^load (kernels\d+)$", (ROOT / "edp/program/kernels.idp").read_text()
    )
    # FreeFEM puts its own folders before any name, so that the path first leads up to the root.
    return f'-D{interface}="{"../" * 40}{str(plugin.with_suffix("")).lstrip("/")}"'


def _compiler(maker: Path, version: str, environment: Mapping[str, str]) -> _Compiler:
    """Asks ff-c++ for its commands. Raises OSError, subprocess.SubprocessError or StopIteration."""
    said = subprocess.run(
        [maker, "-n", "unit.cpp", *LIBRARIES],
        cwd="/",
        env=environment,
        check=True,
        timeout=60,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    ).stdout
    commands = [shlex.split(line) for line in said.splitlines()]
    return _Compiler(
        next(words for words in commands if "unit.cpp" in words),
        next(words for words in commands if "unit.so" in words),
        environment,
        f"{version} {maker} {maker.stat().st_mtime_ns}",
    )


def _with_headers(unit: str, sources: Mapping[str, str]) -> dict[str, str]:
    """Returns the texts of a unit and of all headers of the kernels that it includes, by name."""
    texts: dict[str, str] = {}
    names = [unit]
    for name in names:
        if name in sources and name not in texts:
            texts[name] = sources[name]
            names += INCLUDE.findall(sources[name])
    return texts


def _make(command: str, compiler: _Compiler, sources: Mapping[str, str], folder: Path) -> None:
    """Builds kernels.so in a folder and checks that FreeFem++ loads it. Raises OSError or
    subprocess.SubprocessError.
    """
    units = [name for name in sources if name.endswith(".cpp")]
    stop = threading.Event()
    free = len(os.sched_getaffinity(0)) - os.getloadavg()[0]
    with ThreadPoolExecutor(2 if free >= 1.5 else 1) as pool:
        try:
            making = [pool.submit(compiler.object, unit, sources, stop) for unit in units]
            objects = [_made(future.result()) for future in making]
        finally:
            stop.set()  # ends the compilers that are still at work
            pool.shutdown(cancel_futures=True)
    words = [
        word
        for place in compiler.link
        for word in (map(str, objects) if place == "unit.o" else [place])
    ]
    stop = threading.Event()
    _run([*words, "-o", "kernels.so"], compiler.environment, folder, stop)
    (folder / "try.edp").write_text('load "./kernels"\n')
    _run([command, "-nw", "-ne", "-v", "0", "try.edp"], compiler.environment, folder, stop)


def _made(path: Path | None) -> Path:
    """Returns the path of an object. Raises subprocess.SubprocessError if there is none."""
    if path is None:
        raise subprocess.SubprocessError
    return path


def _run(
    words: Iterable[str], environment: Mapping[str, str], folder: Path, stop: threading.Event
) -> None:
    """Runs a command to its end. Raises OSError, or subprocess.SubprocessError if it fails, takes
    too long or `stop` is set. The command and its child processes form a process group, which is
    killed when the function is left in any way.
    """
    words, end = list(words), time.monotonic() + SECONDS
    child = subprocess.Popen(words, cwd=folder, env=environment, start_new_session=True, **QUIET)
    try:
        while child.poll() is None:
            if signals:
                sys.exit(128 + signals[0])
            if stop.is_set() or time.monotonic() > end:
                raise subprocess.TimeoutExpired(words, SECONDS)
            with suppress(subprocess.TimeoutExpired):
                child.wait(POLL)
        if child.returncode:
            raise subprocess.CalledProcessError(child.returncode, words)
    finally:
        if child.poll() is None:
            os.killpg(child.pid, signal.SIGKILL)
            child.wait()
