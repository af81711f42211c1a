"""Runs the FreeFEM scripts of this folder, which print lines "name value", and scenes of bodies
without the runs that estimate errors.

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
from ffimpact.freefem.arrays import Entries, joined, packed, unpacked
from ffimpact.input import dimension, parameters
from ffimpact.input.contact import CONTACT
from ffimpact.input.materials import OWN_ENTRIES, Material
from ffimpact.input.parameters import ROOT, Value
from ffimpact.output import results
from ffimpact.output.evaluate import evaluate
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly
from ffimpact.scenes.arrays import parameter_arrays

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
    output = _start(f"{script}.edp", flags if "scene" in flags else FALLING | flags, SCRIPTS)
    values = dict(LINE.findall(output))
    if values.pop("done", None) != "1":
        raise Failure(f"{script}: did not finish: {_end(output)}")
    return {name: float(value) for name, value in values.items()}


# Entries of the scripts of one falling body (falling-flags.idp), with their defaults.
FALLING = {"law": "svk", "young": 7e6, "nu": 0.45, "density": 1722, "viscosity": 0, "bulk_viscosity": 0,
           "radius": 0.05, "speed": 8, "angle": 90, "spin": 0, "height": 0,
           "symmetry": "auto", "mesh_size": 0, "contact_mesh_size": 0, "penalty": 1e10, "slip_velocity": 0.1}
OF_THE_RUN = ("scene", "out", "restart")  # flags of the scripts; all others are entries of their file
# The paper's bodies by name: dimension, and the shapes with the entries of their own.
IMPACTS = {"disc": ("plane-strain", {"shape": "disc"}), "ball": ("3d", {"shape": "ball"}),
           "ball-axisymmetric": ("axisymmetric", {"shape": "ball"}), "disc-block": ("plane-strain", {"shape": "disc"})}


def impact(kind: str = "disc", *, radius: float = 0.05, speed: float = 8, angle: float = 90, spin: float = 0, height: float = 0,
           file: Path | None = None, **entries: Value) -> dict:
    """The tables of the paper's impact of a disc or a ball on the plane y = 0, or of a disc on a free
    block (IMPACTS).

    angle: between velocity and plane [degrees]; height: of the body above the plane [m]; file: a
    mesh of the body about its centre. Other entries are those of the contact or of the scene.
    """
    word, shape = IMPACTS[kind]
    own = {"shape": "mesh", "file": str(file)} if file else shape | {"radius": radius}
    ball = own | {"name": "ball", "position": [0.0, height + radius, 0.0][:AXES[word]], "speed": speed, "direction": -angle}
    if spin:
        ball["spin"] = spin
    tables = {"dimension": word, "law": "svk", "young": 7e6, "nu": 0.45, "density": 1722, "body": [ball], "contact": {}}
    if kind == "disc-block":
        tables["body"].append({"name": "block", "shape": "rectangle", "width": 20 * radius, "height": 4 * radius, "position": [0, -2 * radius]})
    else:
        tables["obstacle"] = [{"kind": "plane"}]
    for name, value in entries.items():
        (tables["contact"] if name in CONTACT else tables)[name] = value
    return tables


AXES = {"plane-strain": 2, "axisymmetric": 2, "3d": 3}


def disc(folder: Path, kind: str = "disc", **entries: Value | Path) -> Outcome:
    """A run of the impact with these entries (impact()) in `folder`."""
    return bodies(folder, impact(kind, **entries))


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
    one_friction = {"friction_dynamic": flags.get("friction_static", 0.0)}
    _start("edp/program/bodies-3d.edp", solids.write(scene, folder) | one_friction | flags | {"out": out})
    return outcome(out)


def prepared(folder: Path, tables: dict) -> dict[str, Value | Path]:
    """The flag of the file of the scene in these tables, which is written to `folder` with its mesh."""
    made = assembly.assemble(read_scene(tables, ROOT, "scene"))
    folder.mkdir(parents=True, exist_ok=True)
    made.write(folder)
    return {"scene": folder / assembly.SCENE_FILE}


def entries(script: str, flags: dict[str, Value | Path]) -> Entries:
    """The entries of a scene file for a script: those of the file flags["scene"], or the defaults of
    parameters, changed by the other flags."""
    own = {name: value for name, value in flags.items() if name not in OF_THE_RUN}
    if "scene" in flags:
        made = unpacked(Path(flags["scene"]).read_bytes())
    else:
        own = {"friction_dynamic": own.get("friction_static", 0.0)} | own
        made = parameter_arrays({name: own[name] for name in parameters.PARAMETERS if name in own})
        terms = {name: own.pop(name) for name in OWN_ENTRIES if name in own}
        if "parameters" in terms:
            terms["parameters"] = dict(terms["parameters"])
        material = Material.model_construct(law=own["law"], nu=own.get("nu"), **terms)
        if own["law"] == "energy":
            own |= material.made
        numbers = material.numbers
        made |= joined("law_numbers", [np.array(numbers, dtype=float)])
        for name in ("branches", "bulk_branches"):
            made |= joined(name, [np.array(own.pop(name, ()), dtype=float).ravel()])
    whole = [name for name, row in parameters.PARAMETERS.items() if row.kind == "int"]
    made |= {name: value if name in whole else str(value) if isinstance(value, str | Path) else float(value) for name, value in own.items()}
    return made | {"script": Path(script).stem, "identity": str(sorted(own.items()))}


def _start(script: str, flags: dict[str, Value | Path], folder: Path = ROOT) -> str:
    """The output of FreeFem++. Raises Failure unless it ends with exit code 0 within LIMIT seconds.
    """
    with tempfile.NamedTemporaryFile("r", errors="replace") as log, tempfile.NamedTemporaryFile() as file:
        file.write(packed(entries(script, flags)))
        file.flush()
        of_the_run = {name: flags[name] for name in OF_THE_RUN if name in flags} | {"scene": file.name}
        try:
            with freefem.limited(LIMIT):
                code, line = freefem.run(freefem.find(), script, of_the_run, Path(log.name), folder=folder)
        except TooLong as error:
            raise Failure(f"{script}: {error}") from None
        output = log.read()
    if code != 0:
        raise Failure(f"{script}: exit code {code}: {f'ffimpact: {line}' if line else _end(output)}   (flags {' '.join(freefem.words_of(flags))})")
    return output


def _end(output: str) -> str:
    """The end of the output of FreeFem++ on one line."""
    return " ".join(output.split())[-300:]
