"""Runs a scene with ffimpact as a user's Python script does, without an error estimate.

Prints a line of JSON as the other programs do. `cpu_seconds` is the time of FreeFem++ from the
first step on. `setup_seconds` contains the start of FreeFem++, its operators and the work of Python
for scene, mesh and result. `imports_seconds` is the time of Python's imports.
"""

import argparse
import json
import sys
import time
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from ffimpact import scene  # noqa: E402
from ffimpact.output.results import read_history  # noqa: E402
from ffimpact.running import run  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--scene", required=True)
parser.add_argument("--given", type=json.loads, required=True, help="parameters, as JSON")
options = parser.parse_args()
imports = time.process_time()
summary = run.run(scene.load(options.scene), options.given, Path("out").resolve(), estimate=False).summary
marching = summary["cpu_seconds"] - summary["start_seconds"]
children = getrusage(RUSAGE_CHILDREN)
print(json.dumps({name: value for name, value in summary.items() if isinstance(value, (int, float))} | {
    "angular_momentum": read_history(Path("out"))["angular_momentum"][-1], "imports_seconds": imports, "cpu_seconds": marching,
    "setup_seconds": time.process_time() - imports + children.ru_utime + children.ru_stime - marching}))
