"""Runs the FreeFEM scripts of this folder, which print lines "name value", and the disc scene itself."""

import re
import subprocess
from functools import cache
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from orchestrate import freefem, parameters, run

HERE = Path(__file__).resolve().parent
LINE = re.compile(r"^([a-zA-Z]\w*) (\S+)$", re.MULTILINE)


@cache
def run_script(script: str, flags: tuple[str, ...]) -> dict[str, float]:
    program = freefem.find()
    process = subprocess.run(   # in this folder: that is where the includes of core.idp start from
        [program.command, "-nw", "-ne", "-v", "0", f"{script}.edp", *flags], cwd=HERE, env=program.environment,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
    values = dict(LINE.findall(process.stdout))
    assert process.returncode == 0 and values.pop("done", None) == "1", process.stdout[-2000:]
    return {name: float(value) for name, value in values.items()}


@pytest.fixture(scope="session")
def measure():
    """measure(script, name=value, ...): what tests/verification/<script>.edp prints with these flags."""
    return lambda script, **given: run_script(script, tuple(w for n, v in given.items() for w in (f"-{n}", str(v))))


@dataclass(frozen=True)
class Disc:
    """A finished run of edp/disc-plane.edp: its summary and the columns of its history."""

    summary: dict
    history: dict[str, np.ndarray]


@pytest.fixture(scope="session")
def disc(tmp_path_factory):
    """disc(name=value, ...): edp/disc-plane.edp run without Python with these flags, each set of flags once."""
    @cache
    def go(flags: tuple[str, ...]) -> Disc:
        folder, program = tmp_path_factory.mktemp("disc"), freefem.find()
        process = subprocess.run([program.command, "-nw", "-ne", "-v", "0", "edp/disc-plane.edp", *flags, "-out", str(folder)],
                                 cwd=parameters.ROOT, env=program.environment, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
        assert process.returncode == 0, process.stdout[-2000:]
        return Disc(run.read_summary(folder), run.read_history(folder))
    return lambda **given: go(tuple(w for n, v in given.items() for w in (f"-{n}", str(v))))
