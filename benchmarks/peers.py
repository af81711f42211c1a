"""Other programs that solve the same disc, ball or pair of bodies (benchmarks/programs/), and a
textbook FreeFEM script.

Each program runs if it is installed, one process at a time. `ours()` runs this program in the same
way (ffimpact_run.py).

NGSolve is the extra `peers` of pyproject.toml, in this Python or in $NGSOLVE_PYTHON. GetFEM is
Debian's python3-getfem, in /usr/bin/python3 or in $GETFEM_PYTHON. Only the benchmarks need them.
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

from ffimpact.failure import Failure
from ffimpact.freefem import freefem
from ffimpact.input.parameters import Value
from ffimpact.mesh import mesh
from ffimpact.places import INSTALLED, ROOT, shown
from ffimpact.report.impact import impact_of
from ffimpact.scene import Scene
from ffimpact.sweeps.study import Point

PYTHONS = {"ffimpact": ("", sys.executable), "ngsolve": ("NGSOLVE_PYTHON", sys.executable), "getfem": ("GETFEM_PYTHON", "/usr/bin/python3"),
           "calculix": ("", sys.executable)}
INSTALL = {"ngsolve": "pip install ngsolve==6.2.2608", "getfem": "apt-get install python3-getfem", "calculix": "apt-get install calculix-ccx"}
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
# Radius [m] of the scene disc-normal and default of the other programs.
RADIUS = 0.05
# Mesh sizes [m] in the bulk and near contact on a disc of this radius, for factor 1.
BULK, CONTACT = 8e-3, 2.5e-3
TEXTBOOK = "benchmarks/programs/textbook.edp"
# Our scenes and the body in the name of the script, `<program>_<body>.py`.
BODIES = {"disc-normal": "disc", "disc-oblique": "disc_oblique", "ball-axisymmetric": "ball", "ball": "ball_3d"}


def sized(factor: float, **entries: Value) -> Point:
    """Mesh sizes `factor` times BULK and CONTACT, with further `entries`."""
    return {"mesh_size": factor * BULK, "contact_mesh_size": factor * CONTACT} | entries


@cache
def find(program: str) -> str | None:
    """The Python executable that imports `program` (ngsolve or getfem), or that starts it
    (calculix). Returns None if there is none."""
    variable, usual = PYTHONS[program]
    python = os.environ.get(variable, usual)
    if program == "ffimpact":
        return python
    if program == "calculix":
        return python if shutil.which("ccx") else None
    try:
        exists = subprocess.run([python, "-c", f"import {program}"], capture_output=True, timeout=60).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return None
    return python if exists else None


def run(program: str, form: str, mesh_size: float, contact_mesh_size: float, dt: float, limit: float = 600, scene: str = "disc-normal",
        **flags: Value) -> tuple[dict | None, str]:
    """Runs another program. Returns (its output, "") or (None, the reason why there is none).

    program: ngsolve or, for the disc only, getfem; form: plain, tuned or (NGSolve only) newmark
    sizes [m], step dt [s], limit of the run time [s]; scene: a key of BODIES
    flags: further flags of the scripts: law, nu, speed, penalty, young, density, tolerance, history
    """
    flags |= {"form": form, "dt": dt, "mesh_size": mesh_size, "contact_mesh_size": contact_mesh_size}
    with tempfile.TemporaryDirectory() as folder:
        if program == "getfem":
            # GetFEM uses our mesh. netgen makes its own mesh with the same sizes.
            flags["mesh"] = str(Path(folder) / "mesh.msh")
            mesh.write(mesh.disc(RADIUS, mesh_size, contact_mesh_size, half=True), Path(flags["mesh"]))
        return _printed(program, f"{program}_{BODIES[scene]}.py", folder, limit, flags)


def two_bodies(limit: float, **flags: Value) -> tuple[dict | None, str]:
    """As run(), for benchmarks/programs/ngsolve_two_bodies.py in SI units. The flags are law, nu,
    penalty, speed, refine and others."""
    return scripted("ngsolve", "two_bodies", limit, **flags)


def scripted(program: str, body: str, limit: float, **flags: Value) -> tuple[dict | None, str]:
    """As run(), for any script of a program in benchmarks/programs/ with flags in SI units."""
    with tempfile.TemporaryDirectory() as folder:
        return _printed(program, f"{program}_{body}.py", folder, limit, flags)


def ours(limit: float, scene: str, **entries: Value) -> tuple[dict | None, str]:
    """As run(), for a run of this program without an error estimate: its summary and its seconds by
    phase."""
    with tempfile.TemporaryDirectory() as folder:
        return _printed("ffimpact", "ffimpact_run.py", folder, limit, {"scene": scene, "given": json.dumps(entries)})


def _printed(program: str, script: str, folder: str, limit: float, flags: dict[str, Value]) -> tuple[dict | None, str]:
    """Runs a script and returns its output or the reason why there is none.

    The output is its last line, read as JSON, with `process_seconds`: user and system time of the
    script and its children [s].
    """
    if INSTALLED:
        return None, "the scripts of other programs are in the source folder (benchmarks/programs/)"
    python = find(program)
    if not python:
        return None, f"{program} is not installed ({INSTALL[program]})"
    words = [word for name, value in flags.items() for word in (f"--{name.replace('_', '-')}", str(value))]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([*freefem.LAUNCHER, python, ROOT / "benchmarks/programs" / script, *words], env=os.environ | ONE_THREAD, cwd=folder,
                              capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None, f"no end after {limit:g} s: killed"
    lines, complaint = done.stdout.strip().splitlines(), done.stderr.strip().splitlines()
    if done.returncode != 0 or not lines:
        return None, f"exit code {done.returncode}: {complaint[-1] if complaint else 'no output'}"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(lines[-1]) | {"process_seconds": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}, ""


def textbook(scene: Scene, mesh_file: Path) -> dict:
    """The output of the textbook script for a disc on a mesh, with the names of summary.json.

    `cpu_seconds` excludes the set-up. Raises Failure if the script fails.
    """
    log = mesh_file.with_suffix(".log")
    impact, values = impact_of(scene.content), scene.values | {"mesh": mesh_file}
    entries = {name: impact[name] for name in ("radius", "speed", "young", "nu", "density", "penalty")}
    flags = entries | {name: values[name] for name in ("mesh", "dt", "end_time", "tolerance")}
    code, _ = freefem.run(freefem.find(), TEXTBOOK, flags, log)
    lines = log.read_text().strip().splitlines()
    words = lines[-1].split() if lines else []
    if code != 0 or words[:1] != ["textbook"]:
        raise Failure(f"textbook: the textbook script ended with exit code {code}; its output is in {shown(log)}")
    names = ("dofs", "steps", "newton_iterations", "cpu_seconds", "impulse", "rebound_vy", "contact_time", "energy_drift")
    return dict(zip(names, map(float, words[1:])))
