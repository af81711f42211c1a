"""Runs the FreeFEM scripts of this folder, which print lines "name value", and the disc scene
without Python.

The tests and `make verify` use it.
"""

import re
import shutil
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from ffimpact.failure import Failure, TooLong
from ffimpact.freefem import freefem
from ffimpact.input import dimension, parameters
from ffimpact.input.parameters import ROOT, Value
from ffimpact.output import results
from ffimpact.output.evaluate import evaluate
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly

from . import solids

SCRIPTS = Path(__file__).resolve().parent
LINE = re.compile(r"^([a-zA-Z]\w*) (\S+)$", re.MULTILINE)
# Longest time of a run [s]. The longest run, a slow ball of V17, takes 150 s on an idle core.
LIMIT = 600


@dataclass(frozen=True)
class Outcome:
    """A finished run of a scene: its summary and the columns of its history."""

    summary: dict
    history: dict[str, np.ndarray]


@cache
def measure(script: str, **flags: Value | Path) -> dict[str, float]:
    """The numbers that verification/<script>.edp prints with these flags. Each call runs once.

    Raises Failure if the script does not finish.
    """
    # FreeFem++ resolves includes relative to the folder in which it starts.
    output = _start(f"{script}.edp", flags, SCRIPTS)
    values = dict(LINE.findall(output))
    if values.pop("done", None) != "1":
        raise Failure(f"{script}: did not finish: {_end(output)}")
    return {name: float(value) for name, value in values.items()}


def disc(folder: Path, script: str = "disc-plane", **flags: Value | Path) -> Outcome:
    """A run of edp/program/<script>.edp with these flags in `folder`."""
    for name in ("summary.json", "record.json"):  # of an earlier run in the folder
        (folder / name).unlink(missing_ok=True)
    _start(f"edp/program/{script}.edp", flags | {"out": folder})
    return outcome(folder)


def outcome(folder: Path) -> Outcome:
    """The finished run in `folder`."""
    evaluate(folder)
    return Outcome(results.read_summary(folder), results.read_history(folder))


def bodies(folder: Path, tables: dict, **flags: Value | Path) -> Outcome:
    """A run of the script of bodies for the scene in these tables (ffimpact.scene), with further
    flags, in `folder`/run."""
    out = folder / "run"
    shutil.rmtree(out, ignore_errors=True)
    _start(f"edp/program/{dimension.of_scene(tables).script}.edp", prepared(folder, tables) | flags | {"out": out})
    return outcome(out)


def solid_bodies(folder: Path, scene: solids.Scene, **flags: Value | Path) -> Outcome:
    """A run of edp/program/bodies-3d.edp for a scene in three dimensions (solids.py), with further flags,
    in `folder`/run."""
    out = folder / "run"
    shutil.rmtree(out, ignore_errors=True)
    _start("edp/program/bodies-3d.edp", solids.write(scene, folder) | flags | {"out": out})
    return outcome(out)


def prepared(folder: Path, tables: dict) -> dict[str, Value | Path]:
    """The flags of the scene in these tables. Writes its mesh and its bodies to `folder`."""
    scene = read_scene(tables, ROOT, "scene")
    made = assembly.assemble(scene)
    folder.mkdir(parents=True, exist_ok=True)
    made.write(folder)
    flags = {name: value for name, value in made.values.items() if name in parameters.PARAMETERS}
    return flags | {"mesh": folder / scene.mesh_name, "bodies": folder / "scene.dat"}


def _start(script: str, flags: dict[str, Value | Path], folder: Path = ROOT) -> str:
    """The output of FreeFem++. Raises Failure unless it ends with exit code 0 within LIMIT seconds.
    """
    with tempfile.NamedTemporaryFile("r", errors="replace") as log:
        try:
            with freefem.limited(LIMIT):
                code, line = freefem.run(freefem.find(), script, flags, Path(log.name), folder=folder)
        except TooLong as error:
            raise Failure(f"{script}: {error}") from None
        output = log.read()
    if code != 0:
        raise Failure(f"{script}: exit code {code}: {f'ffimpact: {line}' if line else _end(output)}   (flags {' '.join(freefem.words_of(flags))})")
    return output


def _end(output: str) -> str:
    """The end of the output of FreeFem++ on one line."""
    return " ".join(output.split())[-300:]
