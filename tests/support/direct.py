"""Helpers that the modules test_direct.py share."""

import subprocess
from pathlib import Path

from ffimpact.freefem import freefem
from ffimpact.input import parameters
from ffimpact.output.evaluate import evaluate

COARSE = ("-law", "neohookean", "-nu", "0.4", "-accuracy", "0.4")


def start(*flags: str, cwd: Path, script: str = "disc-plane", **options) -> subprocess.Popen:
    program = freefem.find()
    return subprocess.Popen(program.words(parameters.ROOT / f"edp/program/{script}.edp", *flags), cwd=cwd, text=True,
                            env=program.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def call(*flags: str, cwd: Path, **options) -> tuple[int, str, str]:
    process = start(*flags, cwd=cwd, **options)
    out, error = process.communicate(timeout=60)
    if "-out" in flags[:-1]:
        evaluate(cwd / flags[flags.index("-out") + 1])
    return process.returncode, out, error
