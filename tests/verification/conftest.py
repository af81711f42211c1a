"""Runs the FreeFEM scripts of this folder and reads the lines "name value" that they print."""

import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

from orchestrate import freefem

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
