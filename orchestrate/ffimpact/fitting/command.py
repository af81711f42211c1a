"""The command `ffimpact fit FIT`: a material from measurements.

The TOML file FIT (docs/how-to/fit.md):

    title = "Golf ball"
    scene = "golf-ball.toml"             # beside this file, or a built-in scene
    robust = false                       # true: large deviations count linearly
    air = 1.2                            # density [kg/m3], for drag
    [set]                                # entries of all runs
    accuracy = 0.02
    [free]                               # what is sought, with bounds
    "body.1.young" = [1e7, 1e9]
    "body.1.loss" = [0.01, 0.5]
    [priors]                             # value and standard error, if known beforehand
    "body.1.young" = [6e7, 1e7]
    [[experiment]]
    speed = 2.2                          # of the first body [m/s], or height = 0.8 [m]
    set = { "body.1.position.2" = 0.022 }
    restitution = [0.895, 0.002]         # value and standard error
    contact_time = { values = [4.1e-4, 4.0e-4, 4.3e-4] }
    normal_force = { file = "force.csv", error = 2.0 }
"""

import argparse
import math
import os
from pathlib import Path
from typing import Any

from ..failure import BadInput, brief, suggestion
from ..input.parameters import Table
from ..output.folder import result_folder
from ..places import RESULTS, shown
from ..scene import Scene, absent, built_in, read_toml
from .experiments import Experiment
from .fit import fit

__all__ = ["main", "read"]

KEYS = ("title", "scene", "robust", "air", "set", "free", "priors", "experiment")


def main(argv: list[str]) -> int:
    """Fits, prints the entries and the measurements, and saves the fit in DIR."""
    parser = argparse.ArgumentParser(
        prog="ffimpact fit",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("fit", metavar="FIT", type=Path, help="the TOML file")
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="the result folder (default: results/NAME)"
    )
    parser.add_argument("--quick", action="store_true", help="without finer runs at the end")
    parser.add_argument("--no-figures", action="store_true", help="draw no figure")
    options = parser.parse_args(argv)
    arguments = read(options.fit)
    out = result_folder(options.out or RESULTS / options.fit.stem)
    made = fit(**arguments, confirm=not options.quick, out=out)
    print(made)
    print(made.listed())
    made.save(out, figure=not options.no_figures)
    print(f"{shown(out)}/: fit.json, entries.csv, measurements.csv, scene.toml, fit.toml")
    return 0


def read(path: Path) -> dict[str, Any]:
    """The arguments of fit() in a TOML file. Raises BadInput or Unreadable."""
    _, content = read_toml(path, absent(str(path), "fit", []))
    try:
        return _arguments(content, path.parent.resolve())
    except BadInput as error:
        raise error.within(str(path)) from None


def _arguments(content: Table, folder: Path) -> dict[str, Any]:
    for key in content:
        if key not in KEYS:
            raise BadInput(
                f"{brief(key)}: no such entry{suggestion(key, KEYS)} (accepted: {', '.join(KEYS)})"
            )
    name = content.get("scene")
    if not isinstance(name, str):
        raise BadInput("scene: is missing (accepted: the path of a scene, or a built-in one)")
    tables = content.get("experiment", [])
    if isinstance(tables, dict):
        raise BadInput("experiment: is one table (accepted: [[experiment]], in double brackets)")
    if not isinstance(tables, list) or not tables:
        raise BadInput("experiment: nothing was measured (accepted: tables [[experiment]])")
    robust, air = content.get("robust", False), content.get("air", 1.2)
    if not isinstance(robust, bool):
        raise BadInput(f"robust: '{brief(robust)}' (accepted: true, false)")
    if isinstance(air, bool) or not isinstance(air, int | float) or not 0 <= air < math.inf:
        raise BadInput(f"air: '{brief(air)}' (accepted: 0 or above, in kg/m3)")
    return {
        "scene": Scene.load(name if name in built_in() else os.path.join(folder, name)),
        "entries": _flat(content.get("set", {}), "set"),
        "free": _flat(content.get("free", {}), "free"),
        "priors": _flat(content.get("priors", {}), "priors"),
        "experiments": [_experiment(k, table, folder) for k, table in enumerate(tables, 1)],
        "robust": robust,
        "air": float(air),
    }


def _flat(table: Any, where: str) -> Table:
    """The entries of a table by dotted names; TOML reads body.1.young as nested tables."""
    if not isinstance(table, dict):
        raise BadInput(f"{where}: '{brief(table)}' is no table")
    entries: Table = {}
    for name, value in table.items():
        if isinstance(value, dict):
            entries |= {f"{name}.{rest}": own for rest, own in _flat(value, where).items()}
        else:
            entries[name] = value
    return entries


def _experiment(k: int, table: Any, folder: Path) -> Experiment:
    try:
        if not isinstance(table, dict):
            raise BadInput(f"'{brief(table)}' is no table")
        measured = {name: _beside(what, folder) for name, what in table.items() if name != "set"}
        if wrong := {"entries", "self"} & set(measured):
            raise BadInput(
                f"{wrong.pop()}: is not measured (accepted: set, speed, height, numbers)"
            )
        return Experiment(_flat(table.get("set", {}), "set"), **measured)
    except BadInput as error:
        raise error.within(f"experiment.{k}") from None


def _beside(what: Any, folder: Path) -> Any:
    """A measurement with the path of its file from the working folder."""
    if isinstance(what, dict) and isinstance(what.get("file"), str):
        return what | {"file": os.path.join(folder, what["file"])}
    return what
