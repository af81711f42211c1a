"""A layered ball beside NGSolve on the same mesh.

A ball of revolution of a soft core and a stiffer, lighter cover strikes a plane. NGSolve computes the
same equations on our triangles with our steps (programs/ngsolve_layered_ball.py), with a code of its
own for elements, materials and contact. What differs is the quadrature, above all of the contact
pressure, and so goes to 0 with the elements.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff
from ffimpact.report.figures import BLUE, DASHED, GREY, ORANGE, STYLE, save
from ffimpact.sweeps import study
from verification import commands

from . import page, peers

RADIUS, CORE, SPEED, PENALTY = 0.0214, 0.0195, 30.0, 1e12  # [m], [m/s], [Pa/m]
COVER = {"law": "neohookean", "young": 3e8, "nu": 0.45, "density": 950.0}
LAYERS = {"core": [{"name": "core", "radius": CORE, "young": 5e7, "density": 1150.0}], "none": []}
# Element sizes in the bulk and in contact [m] and steps [s], from coarse to fine.
LEVELS = ((4e-3, 2e-3, 2e-6), (2e-3, 1e-3, 1e-6), (1e-3, 5e-4, 5e-7))
ANSWERS = ("impulse", "rebound_vy", "contact_time", "peak_force")
# Largest differences on the finest level: of the impulse and the rebound, and of all answers.
CLOSE, AGREE = 2e-5, 1e-3
# The differences to NGSolve stay below this share of what the core changes.
SHARE = 0.01
LIMIT = 900.0  # longest time of a run of NGSolve [s]
FORMATS = {"dofs": "g", "answer": "", "ours": ".6g", "NGSolve": ".6g", "differ": ".1e", "without core": ".1e"}


def main(argv: list[str]) -> int:
    """Runs both programs, prints the table and writes layers.csv.

    Returns 0 if the answers agree.
    """
    parser = commands.command("layers", __doc__, page=True)
    parser.add_argument("--levels", metavar="N", type=int, default=len(LEVELS), help="number of levels (default: %(default)s)")
    options = parser.parse_args(argv)
    rows, forces = [], []
    for level in LEVELS[: options.levels]:
        answers, curves = compare(level, options.out)
        rows += answers
        forces = curves
    table = pd.DataFrame(rows, columns=list(FORMATS))
    tables = {"": table, "forces": pd.DataFrame(forces)}
    return page.finish(options, table, report(table), holds(table), argv, "A layered ball beside NGSolve", tables, [""])


def tables_of(level: tuple[float, float, float], layers: str) -> dict:
    """The tables of the scene on a level, with the layers `layers` (of LAYERS)."""
    bulk, near, dt = level
    body = {"shape": "ball", "radius": RADIUS, "position": RADIUS, "velocity": -SPEED, "mesh_size": bulk, "contact_mesh_size": near,
            "layer": LAYERS[layers]} | COVER  # fmt: skip
    return {"dimension": "axisymmetric", "accuracy": 0.02, "dt": dt, "fields": 0, "contact": {"penalty": PENALTY}, "body": [body], "obstacle": [{"kind": "plane"}]}


def compare(level: tuple[float, float, float], out: Path) -> tuple[list[dict], list[dict]]:
    """A row for each answer on a level, and the forces of both programs over time."""
    folder = out / f"{1e3 * level[1]:g}mm"
    path = ff.Scene.read(tables_of(level, "core")).save(folder / "ball.toml")
    ours = ff.run(ff.Scene.load(path), out=folder / "ours", estimate=False, figures=False)
    plain = ff.run(ff.Scene.read(tables_of(level, "none")), out=folder / "none", estimate=False, figures=False)
    history = folder / "ngsolve.csv"
    theirs, why = peers.scripted("ngsolve", "layered_ball", LIMIT, scene=path.resolve(), law="neohookean", penalty=PENALTY, speed=SPEED,
                                 radius=RADIUS, dt=level[2], history=history.resolve())  # fmt: skip
    if not theirs:
        print(f"no NGSolve: {why}")
        return [], []
    rows = [{"dofs": ours["dofs"], "answer": name, "ours": ours[name], "NGSolve": theirs[name], "differ": abs(ours[name] / theirs[name] - 1),
             "without core": abs(plain[name] / theirs[name] - 1)} for name in ANSWERS]
    curve = np.loadtxt(history, delimiter=",", skiprows=1)
    forces = {"ours": (ours.history.t, ours.history.normal_force), "NGSolve": tuple(curve.T), "without core": (plain.history.t, plain.history.normal_force)}
    return rows, [{"program": name, "t [ms]": 1e3 * t, "force [kN]": 1e-3 * f} for name, pair in forces.items() for t, f in zip(*pair)]


def holds(table: pd.DataFrame) -> bool:
    """Whether the answers on the finest level agree, and far better than those of a ball without core."""
    if table.empty:
        return False
    finest = table[table.dofs == table.dofs.max()].set_index("answer")
    close = (finest.differ[["impulse", "rebound_vy"]] <= CLOSE).all() and (finest.differ <= AGREE).all()
    return bool(close and (finest.differ <= SHARE * finest["without core"]).all())


def report(table: pd.DataFrame) -> str:
    """The report: table and verdict."""
    if table.empty:
        return "NGSolve was not there: the requirement FAILS."
    verdict = (f"The requirement (on the finest mesh impulse and rebound agree to {100 * CLOSE:g} %, all answers to {100 * AGREE:g} %, and to "
               f"{100 * SHARE:g} % of what the core changes) {'holds' if holds(table) else 'FAILS'}.")
    return "\n".join([study.table(table, FORMATS), "", verdict])


def draw(forces: pd.DataFrame, path: Path) -> None:
    """Draws the force of both programs over time, and that of the ball without its core."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(5.6, 3.2), layout="constrained")
        for (name, group), (colour, line, wide) in zip(forces.groupby("program", sort=False), ((BLUE, "-", 2.6), (ORANGE, DASHED, 1.3), (GREY, "-", 1))):
            axes.plot(group["t [ms]"], group["force [kN]"], color=colour, linestyle=line, linewidth=wide, label=name)
        axes.set(xlabel="time [ms]", ylabel="normal force [kN]", xlim=(0, None), ylim=(0, None))
        axes.legend()
        save(figure, path)
