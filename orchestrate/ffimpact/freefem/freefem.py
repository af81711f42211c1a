"""Finds and checks the program FreeFem++, starts its processes, waits for them and ends them in all
circumstances.
"""

import ctypes
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TextIO

from ..failure import BadInput, NotInstalled, TooLong, signals
from ..places import INSTALLED, ROOT
from . import kernels
from .compiled import QUIET, compiled

__all__ = [
    "At",
    "CORES",
    "FreeFem",
    "HOW",
    "LAUNCHER",
    "Process",
    "VERSION",
    "find",
    "limited",
    "quick_clock",
    "run",
    "said_in",
    "start",
    "words_of",
]

CORES: int = len(os.sched_getaffinity(0))
# The oldest accepted version, as the banner prints it. Debian's 4.11 prints 4.9.
OLDEST = (4, 9)
# Debian installs the plugins in this folder, in which its FreeFem++ does not search for them.
DEBIAN_PLUGINS = "/usr/lib/freefem++"
VERSION = "edp/program/version.edp"
CLOCK = ROOT / "edp/program/clock.c"
OPEN_FILES = "/proc/self/fd/"
BANNER = re.compile(r"FreeFem\+\+ v(\d+\.\d\d?)\b")
SAYS = re.compile(r"progress (\S+) (t=\S+ steps=\S+.*)$")
POLL = 0.1  # time [s] between two checks of a process, its log and its limits
# setpriv (util-linux) asks the kernel to kill the process that it starts as soon as the thread that
# started setpriv ends, even by SIGKILL. Without setpriv FreeFem++ continues to its end. Its folder
# stays locked until then, because start() passes the lock to FreeFem++.
SETPRIV = shutil.which("setpriv")
LAUNCHER = (SETPRIV, "--pdeathsig", "KILL") if SETPRIV else ()
WAYS = (
    "apt-get install freefem++ libfreefem++; conda install -c conda-forge freefem; a package of "
    "https://github.com/FreeFem/FreeFem-sources/releases; or set FREEFEM to where it is"
)
HOW = f"install it: {WAYS}" if INSTALLED else f"run: make setup   (or: {WAYS})"


class At(NamedTuple):
    """The progress of a run, as its solver prints it (edp/program/run/march.idp)."""

    share: float  # estimated fraction of its steps that is completed, in [0, 1]
    t: float  # time in the run [s]
    steps: int
    unknowns: int = 0
    expected: float = 0.0  # estimated number of all steps, 0 if it is not known yet
    longer: float = 1.0  # factor by which later contacts may make an impact longer
    step: float = 0.0  # largest step [s]
    seconds: float = 0.0  # processor time of the process [s]
    wall: float = 0.0  # wall time of the run [s]
    memory: float = 0.0  # largest memory of the process [bytes]

    @classmethod
    def read(cls, share: str, entries: str) -> "At":
        """Returns the progress of a line "progress <share> <name>=<value> ..."."""
        texts = dict(entry.split("=") for entry in entries.split())
        kinds: dict[str, Any] = cls.__annotations__
        return cls(float(share), **{name: kinds[name](text) for name, text in texts.items()})


Progress = Callable[[At], None]


@dataclass(frozen=True)
class FreeFem:
    """A FreeFem++ that can run the scripts of this program: its path, its version and the environment
    that it needs.
    """

    command: str
    version: str
    environment: dict[str, str]
    plugin: str = ""  # the command-line word that loads the compiled kernels

    def words(self, script: str | Path, *flags: str) -> list[str]:
        """Returns the command that runs a script. The paper's scripts (edp/*.edp) have no kernels."""
        plugin = "" if Path(script).parent.name == "edp" else self.plugin
        return [
            *LAUNCHER,
            self.command,
            "-nw",
            "-ne",
            "-v",
            "0",
            str(script),
            *filter(None, [plugin]),
            *flags,
        ]

    @property
    def preloaded(self) -> list[int]:
        """The numbers of the open files to which LD_PRELOAD in the environment refers."""
        return [
            int(number)
            for number in re.findall(rf"{OPEN_FILES}(\d+)", self.environment.get("LD_PRELOAD", ""))
        ]

    def call(
        self, script: str | Path, *flags: str, **options: Any
    ) -> subprocess.CompletedProcess[str]:
        """Runs a script to its end and returns the completed process. `options` are passed to
        subprocess.run.
        """
        return subprocess.run(
            self.words(script, *flags),
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            pass_fds=self.preloaded,
            **{"env": self.environment} | options,
        )


def words_of(flags: Mapping[str, object]) -> list[str]:
    """Converts the flags of a script to words of its command line."""
    return [word for name, value in flags.items() for word in (f"-{name}", str(value))]


def said_in(errors: str) -> str:
    """Returns the last message for the user in a script's stderr, or "" if there is none."""
    return next(
        (
            line.removeprefix("ffimpact: ")
            for line in reversed(errors.splitlines())
            if line.startswith("ffimpact: ")
        ),
        "",
    )


def find() -> FreeFem:
    """Finds $FREEFEM, or FreeFem++ on the PATH, and checks it once per environment. Raises
    NotInstalled if it is missing, too old or without its plugins.
    """
    return _find(tuple(sorted(os.environ.items())))


@cache
def _find(variables: tuple[tuple[str, str], ...]) -> FreeFem:
    """Finds FreeFem++ as find() does, in the environment `variables`."""
    environment = dict(variables)
    executable = environment.get("FREEFEM", "FreeFem++")
    command = shutil.which(executable)
    if not command:
        raise NotInstalled(f"{executable} not found; {HOW}")
    environment |= _threads(environment.get("FFIMPACT_THREADS", "1"))
    # The folder in which includes inside includes are sought, also where its path has a semicolon.
    include_path = environment.get("FF_INCLUDEPATH", "")
    environment["FF_INCLUDEPATH"] = f"{ROOT / 'edp'};./edp" + (
        f";{include_path}" if include_path else ""
    )
    environment = _blas_kernels() | environment | quick_clock(environment)
    version = _version(command, environment)
    if not version and "FF_LOADPATH" not in environment:
        environment["FF_LOADPATH"] = DEBIAN_PLUGINS
        version = _version(command, environment)
    if not version:
        raise NotInstalled(
            f"{command} lacks its plugin Element_QF, is older than 4.9 or does not start; {HOW}"
        )
    if tuple(map(int, version.split(".")[:2])) < OLDEST:
        raise NotInstalled(
            f"{command} is version {version}, needed is {OLDEST[0]}.{OLDEST[1]} or newer; {HOW}"
        )
    plugin = kernels.build(command, version, environment)
    if not plugin:
        raise NotInstalled(f"the compiled kernels cannot be built; {kernels.HOW}")
    return FreeFem(command, version, environment, plugin)


def _threads(threads: str) -> dict[str, str]:
    """Returns the environment variables that give a process this number of `threads`. Raises
    BadInput if `threads` is not a number from 1 to 64.

    One thread is best if processes fill the cores, as in a sweep or in a run beside the one that
    estimates its error. The results do not depend on the number of threads. CHOLMOD starts four
    threads of its own unless OMP_THREAD_LIMIT limits them. OpenBLAS has one thread, because its
    sums depend on the number of threads.
    """
    if not (threads.isdecimal() and 1 <= int(threads) <= 64):
        raise BadInput(
            f"FFIMPACT_THREADS: '{threads}' in the environment is no number of threads "
            f"(accepted: 1 to 64)"
        )
    return {
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": threads,
        "OMP_THREAD_LIMIT": threads,
        "OMP_WAIT_POLICY": "passive",
    }


def _blas_kernels() -> dict[str, str]:
    """Returns the environment variable that makes OpenBLAS use its kernels for AVX2, if the
    processor has AVX2 and FMA. For a processor newer than itself OpenBLAS chooses its oldest and
    slower kernels (SSE3). The results differ by round-off.
    """
    try:
        flags = re.search(r"^flags\s*:(.*)", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
        blas = ctypes.CDLL("libopenblas.so.0")
        blas.openblas_get_corename.restype = ctypes.c_char_p
        unknown = blas.openblas_get_corename() == b"Prescott"
    except (OSError, AttributeError):
        return {}
    return (
        {"OPENBLAS_CORETYPE": "Haswell"}
        if unknown and flags and {"avx2", "fma"} <= set(flags[1].split())
        else {}
    )


def quick_clock(environment: Mapping[str, str]) -> dict[str, str]:
    """Returns the environment variable that preloads the clock() of edp/program/clock.c, or nothing if it
    cannot be compiled. Names in LD_PRELOAD end at blanks and colons. If the path contains one, the
    variable refers to an open file that the processes inherit.
    """

    def make(folder: Path) -> None:
        subprocess.run(
            ["cc", "-O2", "-shared", "-fPIC", "-o", folder / "libclock.so", CLOCK],
            env=environment,
            check=True,
            timeout=60,
            **QUIET,
        )

    library = compiled("libclock.so", [CLOCK.read_text()], make)
    if not library:
        return {}
    name = (
        f"{OPEN_FILES}{os.open(library, os.O_RDONLY)}"
        if re.search(r"[\s:]", str(library))
        else str(library)
    )
    return {"LD_PRELOAD": ":".join([name, *environment.get("LD_PRELOAD", "").split()])}


def _version(command: str, environment: dict[str, str]) -> str:
    """Returns the version by edp/program/version.edp, or "" if FreeFem++ does not start or lacks a
    plugin that the scenes load. It is taken from the banner: scripts see it as a number, in which
    4.10 equals 4.1.
    """
    try:
        output = FreeFem(command, "", environment).call(VERSION, "-v", "1", timeout=60).stdout
        answer = json.loads(output[output.index("{") :])
        banner = BANNER.search(output)
        return banner[1] if banner else str(answer["version"])
    except (OSError, subprocess.TimeoutExpired, ValueError):
        return ""


# ---- running processes


class _Limit(threading.local):
    """The limits of the FreeFem++ that a thread waits for. It has to end after `seconds`, at the
    time `end` [s] of the monotonic clock, or once another thread sets `stop`.
    """

    seconds, end, stop = math.inf, math.inf, threading.Event()

    def check(self) -> None:
        """Raises TooLong after the time `end`, KeyboardInterrupt once `stop` is set, and SystemExit
        after a signal that asks the program to end.
        """
        if signals:
            sys.exit(128 + signals[0])
        if self.stop.is_set():
            raise KeyboardInterrupt
        if time.monotonic() > self.end:
            raise TooLong(f"no end after {self.seconds:g} s: killed")


_limit = _Limit()


@contextmanager
def limited(seconds: float = math.inf, stop: threading.Event | None = None) -> Iterator[None]:
    """Limits every FreeFem++ that this thread waits for inside the `with`. Without `stop` the
    thread keeps its present one.
    """
    before = _limit.seconds, _limit.end, _limit.stop
    _limit.seconds, _limit.end, _limit.stop = (
        seconds,
        time.monotonic() + seconds,
        stop or _limit.stop,
    )
    try:
        yield
    finally:
        _limit.seconds, _limit.end, _limit.stop = before


@dataclass(frozen=True)
class Process:
    """A running FreeFem++, the file of its stdout (`log`) and the file of its stderr (`errors`)."""

    child: subprocess.Popen[bytes]
    log: Path
    errors: TextIO

    def end(self, progress: Progress | None = None, poll: float = POLL) -> tuple[int, str]:
        """Waits for the end of the process, with a look at its log every `poll` [s]. Raises TooLong or KeyboardInterrupt by the limits of
        this thread.

        Returns the exit code, negative for a signal, and the script's message for the user, or "".
        The lines "progress ..." of the log are passed to `progress`.
        """
        unread, code = "", None
        with open(self.log, errors="replace") as lines:
            while code is None:
                _limit.check()
                with suppress(subprocess.TimeoutExpired):
                    code = self.child.wait(poll)
                *whole, unread = (unread + lines.read()).split("\n")
                for match in filter(None, map(SAYS.match, whole)):
                    if progress:
                        progress(At.read(*match.groups()))
        self.errors.seek(0)
        stderr = self.errors.read()
        with open(self.log, "a") as file:
            file.write(stderr)
        return code, said_in(stderr)


@contextmanager
def start(
    freefem: FreeFem,
    script: str,
    flags: Mapping[str, object],
    log: Path,
    lock: int | None = None,
    folder: Path = ROOT,
) -> Iterator[Process]:
    """Starts a script in `folder` with its output in `log`, and ends it when the `with` is left.

    FreeFem++ and its child processes form a session, and thus a process group, of their own. Ctrl-C
    on the terminal therefore reaches Python only. Python kills the group when the `with` is left in
    any way. FreeFem++ inherits the open file `lock`, so that the lock is kept until FreeFem++ has
    ended.
    """
    with open(log, "w") as output, tempfile.TemporaryFile("w+", errors="replace") as errors:
        child = subprocess.Popen(
            freefem.words(script, *words_of(flags)),
            cwd=folder,
            env=freefem.environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            start_new_session=True,
            pass_fds=freefem.preloaded + ([] if lock is None else [lock]),
        )
        try:
            yield Process(child, log, errors)
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()


def run(
    freefem: FreeFem,
    script: str,
    flags: Mapping[str, object],
    log: Path,
    progress: Progress | None = None,
    folder: Path = ROOT,
) -> tuple[int, str]:
    """Runs a script to its end; see start() and Process.end()."""
    with start(freefem, script, flags, log, folder=folder) as process:
        return process.end(progress)
