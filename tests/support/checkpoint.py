"""Helpers that the modules test_checkpoint.py share."""

import signal
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import meshio
import numpy as np
import pandas as pd
import pytest

from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.output import results
from ffimpact.output.evaluate import evaluate
from tests.support.direct import words as impact_words

EFFORT = ("start_seconds", "wall_seconds", "total_seconds", "cpu_seconds", "estimate_cpu_seconds", "peak_memory", "phase_seconds", "resumed_at", "provenance")


# FreeFEM removes checkpoint.new after each checkpoint. At the N-th one the process gets the signal.
AT_CHECKPOINT = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
int unlink(const char *path)
{
  static int seen;
  const char *name = strrchr(path, '/');
  if (name && !strcmp(name, "/checkpoint.new") && ++seen == atoi(getenv("AT_CHECKPOINT")))
    raise(atoi(getenv("SIGNAL")));
  return ((int (*)(const char *))dlsym(RTLD_NEXT, "unlink"))(path);
}
"""


@cache
def _library() -> Path:
    path = Path(tempfile.mkdtemp()) / "at-checkpoint.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-x", "c", "-o", path, "-", "-ldl"], input=AT_CHECKPOINT, text=True, check=True)
    return path


def at_checkpoint(number: int, what: signal.Signals) -> dict[str, str]:
    """The environment in which FreeFem++ gets a signal after so many checkpoints."""
    before = freefem.find().environment
    names = f"{_library()}:{before.get('LD_PRELOAD', '')}".rstrip(":")
    return before | {"LD_PRELOAD": names, "AT_CHECKPOINT": str(number), "SIGNAL": str(int(what))}


def direct(flags: dict, out: Path, script: str = "disc", environment: dict | None = None) -> subprocess.Popen:
    """Starts FreeFem++ on an impact with these entries, or a script of bodies with these flags."""
    return subprocess.Popen(impact_words(flags | {"out": out}, script), cwd=parameters.ROOT, text=True, env=environment or freefem.find().environment,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def killed_at(number: int, flags: dict, out: Path, script: str = "disc") -> None:
    """Runs it until kill -9 after so many checkpoints."""
    process = direct(flags, out, script, at_checkpoint(number, signal.SIGKILL))
    process.communicate(timeout=120)
    assert process.returncode == -signal.SIGKILL and (out / "checkpoint").exists()


def rows_known(checkpoint: Path) -> int:
    """The number of rows of the history in the checkpoint; 0 if there is none yet."""
    try:
        return int(checkpoint.read_bytes().split(b"\n", 1)[0] or 0)
    except FileNotFoundError:
        return 0


def assert_same(folder: Path, straight: Path) -> None:
    """Asserts that histories and summaries agree to round-off, 1e-12 of the largest value of a
    column.

    For the balance, which is itself round-off, it is 1e-12 of the energy. Snapshots agree to their
    9 digits.
    """
    for place in (folder, straight):
        evaluate(place)
    there, expected = results.read_history(folder), results.read_history(straight)
    assert list(there) == list(expected)
    for name, column in expected.items():
        scale = np.abs(expected["kinetic" if name == "balance" else name]).max()
        np.testing.assert_allclose(there[name], column, rtol=0, atol=1e-12 * scale, err_msg=name)
    there, expected = results.read_summary(folder), results.read_summary(straight)
    assert list(there) == list(expected)
    for name in set(expected) - set(EFFORT):
        exact = not isinstance(expected[name], float)
        assert there[name] == (expected[name] if exact else pytest.approx(expected[name], rel=1e-9, abs=1e-11)), name
    there, expected = (pd.read_csv(run_folder / "contacts.csv") for run_folder in (folder, straight))
    pd.testing.assert_frame_equal(there, expected, rtol=1e-9)
    states, expected = (sorted(place.glob("fields/[0-9]*.vtu")) for place in (folder, straight))
    assert [path.name for path in states] == [path.name for path in expected]
    for path, other in zip(states, expected):
        there, reference = meshio.read(path).point_data, meshio.read(other).point_data
        assert list(there) == list(reference)
        for name, values in reference.items():
            np.testing.assert_allclose(there[name], values, rtol=1e-7, atol=1e-7 * np.abs(values).max(), err_msg=name)
