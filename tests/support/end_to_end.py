"""Helpers that the modules test_end_to_end.py share."""

import os
import subprocess
import sys
from pathlib import Path

from ffimpact.input import parameters
from ffimpact.output.evaluate import evaluate
from tests.support.direct import start


def direct(*flags: str) -> subprocess.CompletedProcess:
    process = start(*flags, cwd=parameters.ROOT)
    out, error = process.communicate(timeout=120)
    evaluate(Path(flags[flags.index("-out") + 1]))
    return subprocess.CompletedProcess(process.args, process.returncode, out, error)


# ---- failures of real runs, through the command line

def call(*settings: str, out, environment: dict | None = None) -> subprocess.CompletedProcess:
    arguments = [word for setting in settings for word in ("--set", setting)]
    return subprocess.run([sys.executable, "-m", "ffimpact", "run", "disc-normal", "--no-figures", "--out", str(out), "--set", "fields=0", *arguments],
                          cwd=parameters.ROOT, env=os.environ | (environment or {}), capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=120)


# ---- chatter

COARSE = {"speed": "1.84", "accuracy": "0.01", "degree": "1", "mesh_size": "0.025", "contact_mesh_size": "0.0079"}
