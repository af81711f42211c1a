"""Helpers that the modules test_cli.py share."""

import signal
import subprocess
import sys
import time
from pathlib import Path

from ffimpact.input import parameters

ROOT = parameters.ROOT


def hear_interrupts() -> None:
    """In a child process: resets SIGINT, which background jobs of a shell ignore and inherit."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(*arguments: str, module: str = "ffimpact", **options) -> subprocess.Popen:
    return subprocess.Popen([sys.executable, "-m", module, *arguments], cwd=ROOT, text=True, preexec_fn=hear_interrupts,
                            **dict(stdout=subprocess.PIPE, stderr=subprocess.PIPE) | options)


def call(*arguments: str) -> tuple[int, str, str]:
    process = start(*arguments)
    out, err = process.communicate(timeout=60)
    return process.returncode, out, err


def wait_for(condition, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.02)


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False
