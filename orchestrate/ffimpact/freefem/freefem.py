"""FreeFem++: finds and checks the program, starts its processes, waits for them, and ends them
whatever happens.
"""

import ctypes
import json
import math
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import NamedTuple, TextIO

from ..failure import BadInput, NotInstalled, TooLong
from ..places import INSTALLED, ROOT
from . import kernels
from .compiled import QUIET, compiled

__all__ = [
    "At",
    "CORES",
    "DESCRIBE",
    "FreeFem",
    "HOW",
    "LAUNCHER",
    "Process",
    "find",
    "limited",
    "quick_clock",
    "run",
    "said_in",
    "start",
    "words_of",
]

CORES = len(os.sched_getaffinity(0))
OLDEST = (4, 9)  # the version in the banner; Debian's 4.11 calls itself 4.9
DEBIAN_PLUGINS = (
    "/usr/lib/freefem++"  # where Debian puts the plugins, and its FreeFem++ does not look
)
DESCRIBE = "edp/describe.edp"
CLOCK = ROOT / "edp/clock.c"
OPEN_FILES = "/proc/self/fd/"
BANNER = re.compile(r"FreeFem\+\+ v(\d+\.\d\d?)\b")
SAYS = re.compile(r"progress (\S+) t=(\S+) steps=(\S+)(?: unknowns=(\S+) apart=(\S+))?$")
POLL = 0.1  # s between two looks at a process, its log and its limits
# setpriv (util-linux) asks the kernel to kill what it starts as soon as the thread that started it
# ends, even by SIGKILL. Where setpriv is missing FreeFem++ goes on to its end, and its folder stays
# locked until then: start() hands it the lock.
SETPRIV = shutil.which("setpriv")
LAUNCHER = (SETPRIV, "--pdeathsig", "KILL") if SETPRIV else ()
WAYS = (
    "apt-get install freefem++ libfreefem++; conda install -c conda-forge freefem; a package of "
    "https://github.com/FreeFem/FreeFem-sources/releases; or set FREEFEM to where it is"
)
HOW = f"install it: {WAYS}" if INSTALLED else f"run: make setup   (or: {WAYS})"


class At(NamedTuple):
    """How far a run is."""

    share: float  # of its steps, in [0, 1], as far as one can see
    t: float  # s
    steps: int
    unknowns: int = 0
    apart: float = (
        1.0  # the times that a wave takes across the slowest body, over those of the quickest
    )


Progress = Callable[[At], None]


@dataclass(frozen=True)
class FreeFem:
    """A FreeFem++ that runs our scripts: its path, its version, the environment it needs, and
    what the scripts say of themselves.
    """

    command: str
    version: str
    environment: dict[str, str]
    description: dict
    plugin: str = ""  # the word that loads the compiled kernels

    def words(self, script: str | Path, *flags: str) -> list[str]:
        """The command that runs a script."""
        return [
            *LAUNCHER,
            self.command,
            "-nw",
            "-ne",
            "-v",
            "0",
            str(script),
            *filter(None, [self.plugin]),
            *flags,
        ]

    @property
    def preloaded(self) -> list[int]:
        """Open files that its environment names."""
        return [
            int(number)
            for number in re.findall(rf"{OPEN_FILES}(\d+)", self.environment.get("LD_PRELOAD", ""))
        ]

    def call(self, script: str | Path, *flags: str, **options) -> subprocess.CompletedProcess:
        """A script run to its end; `options` are of subprocess.run."""
        usual = {
            "cwd": ROOT,
            "env": self.environment,
            "stdin": subprocess.DEVNULL,
            "capture_output": True,
            "pass_fds": self.preloaded,
        }
        return subprocess.run(
            self.words(script, *flags), **usual | {"text": True, "errors": "replace"} | options
        )


def words_of(flags: Mapping[str, object]) -> list[str]:
    """Flags of a script as words of its command."""
    return [word for name, value in flags.items() for word in (f"-{name}", str(value))]


def said_in(errors: str) -> str:
    """The last line that a script says to the user on its stderr, "" where it says nothing."""
    return next(
        (
            line.removeprefix("ffimpact: ")
            for line in reversed(errors.splitlines())
            if line.startswith("ffimpact: ")
        ),
        "",
    )


def find() -> FreeFem:
    """$FREEFEM or FreeFem++ on the PATH, probed once; NotInstalled when missing, too old or
    without its plugins.
    """
    return _find(tuple(sorted(os.environ.items())))


@cache
def _find(variables: tuple[tuple[str, str], ...]) -> FreeFem:
    """The same in an environment."""
    environment = dict(variables)
    wanted = environment.get("FREEFEM", "FreeFem++")
    command = shutil.which(wanted)
    if not command:
        raise NotInstalled(f"{wanted} not found; {HOW}")
    environment |= _threads(environment.get("FFIMPACT_THREADS", "1"))
    environment = _blas_kernels() | environment | quick_clock(environment)
    description = _probe(command, environment)
    if not description and "FF_LOADPATH" not in environment:
        environment["FF_LOADPATH"] = DEBIAN_PLUGINS
        description = _probe(command, environment)
    if not description:
        raise NotInstalled(
            f"{command} lacks its plugin Element_QF, is older than 4.9 or does not start; {HOW}"
        )
    version = description["version"]
    if tuple(map(int, version.split(".")[:2])) < OLDEST:
        raise NotInstalled(
            f"{command} is version {version}, needed is {OLDEST[0]}.{OLDEST[1]} or newer; {HOW}"
        )
    return FreeFem(
        command, version, environment, description, kernels.build(command, version, environment)
    )


def _threads(wanted: str) -> dict[str, str]:
    """What lets a process have so many threads. One is best where processes fill the cores:
    sweeps, and a run with the one beside it that estimates its error. Answers are the same with
    any number. CHOLMOD takes four (of its own) unless there is a limit; OpenBLAS, whose sums
    depend on it, has one.
    """
    if not (wanted.isdecimal() and 1 <= int(wanted) <= 64):
        raise BadInput(
            f"FFIMPACT_THREADS: '{wanted}' in the environment is no number of threads (accepted: 1 to 64)"
        )
    return {
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": wanted,
        "OMP_THREAD_LIMIT": wanted,
        "OMP_WAIT_POLICY": "passive",
    }


def _blas_kernels() -> dict[str, str]:
    """OpenBLAS takes its oldest kernels (SSE3) for a processor newer than itself: those for
    AVX2 where there is that. They made steps with 14,000 unknowns in three dimensions a sixth
    faster; answers differ by round-off.
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
    """The preloaded clock() of edp/clock.c; nothing where it cannot be compiled. On a path that
    LD_PRELOAD, whose names end at blanks and colons, cannot name, it is an open file that
    processes are handed.
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


def _probe(command: str, environment: dict[str, str]) -> dict | None:
    """What edp/describe.edp says without a scene, if it starts and finds the plugins that the
    scenes load. The version is the banner's: to scripts it is a number, that of 4.10 the same
    as that of 4.1.
    """
    try:
        said = FreeFem(command, "", environment, {}).call(DESCRIBE, "-v", "1", timeout=60).stdout
        banner = BANNER.search(said)
        return json.loads(said[said.index("{") :]) | ({"version": banner[1]} if banner else {})
    except (OSError, subprocess.TimeoutExpired, ValueError):
        return None


# ---- a process at work


class _Limit(threading.local):
    """When the FreeFem++ that a thread waits for has to end: after `seconds`, at the time
    `end`, or once another thread sets `stop`.
    """

    seconds, end, stop = math.inf, math.inf, threading.Event()

    def check(self) -> None:
        """Raises TooLong after the end, and KeyboardInterrupt once `stop` is set."""
        if self.stop.is_set():
            raise KeyboardInterrupt
        if time.monotonic() > self.end:
            raise TooLong(f"no end after {self.seconds:g} s: killed")


_limit = _Limit()


@contextmanager
def limited(seconds: float = math.inf, stop: threading.Event | None = None) -> Iterator[None]:
    """Limits every FreeFem++ that this thread waits for inside the `with`. Without a `stop` the
    thread keeps the one it has.
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
    """A FreeFem++ at work, the file of its stdout, and that of its stderr."""

    child: subprocess.Popen
    log: Path
    errors: TextIO

    def end(self, progress: Progress | None = None) -> tuple[int, str]:
        """Waits for the end, and raises what the limits of this thread raise.

        Returns the exit code, negative for a signal, and the script's line for the user, or
        "". What the lines "progress <share> t=<time> steps=<n> ..." of the log say goes to
        `progress`.
        """
        unread, code = "", None
        with open(self.log, errors="replace") as lines:
            while code is None:
                _limit.check()
                with suppress(subprocess.TimeoutExpired):
                    code = self.child.wait(POLL)
                *whole, unread = (unread + lines.read()).split("\n")
                for match in filter(None, map(SAYS.match, whole if progress else ())):
                    progress(
                        At(
                            *(
                                kind(text)
                                for kind, text in zip(At.__annotations__.values(), match.groups())
                                if text
                            )
                        )
                    )
        self.errors.seek(0)
        said = self.errors.read()
        with open(self.log, "a") as file:
            file.write(said)
        return code, said_in(said)


@contextmanager
def start(
    freefem: FreeFem,
    script: str,
    flags: Mapping[str, object],
    log: Path,
    lock: int | None = None,
    folder: Path = ROOT,
) -> Iterator[Process]:
    """A script at work, started in `folder`, with its output in `log`.

    FreeFem++ and the commands that it starts are a session, and so a process group, of their
    own: Ctrl-C on the terminal reaches Python alone, which ends the group when this `with` is
    left in any way. FreeFem++ shares the open file `lock`: what is locked stays locked until
    FreeFem++ has ended.
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
