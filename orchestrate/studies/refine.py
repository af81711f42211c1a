"""How far mesh, step and accuracy decide the answers of a scene, the converged answers, and what a parameter of its
contact law does: the penalty for disc-normal, the slip velocity for disc-oblique."""

import argparse
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.ticker import NullLocator

from .. import scene as scenes
from ..freefem.describe import describe
from ..failure import Failure
from ..output.folder import result_folder
from ..input.parameters import defaults
from ..places import COMMAND, RESULTS, shown
from ..report.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, STYLE, save
from ..sweeps import study

ANSWERS = {                 # by scene; all but the last are promised to ASKED
    "disc-normal": ("contact_time", "impulse", "rebound_vy", "peak_force"),
    "disc-oblique": ("rebound_vx", "rebound_vy", "rebound_spin", "friction_work", "contact_time")}
SHOWN = 1e-4                # %; differences below are drawn there
ASKED = 0.5                 # % of the converged values, for the run with default parameters
LABELS = {"mesh": ("mesh factor", "off the finest mesh [%]"), "step": ("time step [s]", "off the smallest step [%]"),
          "accuracy": ("accuracy", "off the converged values [%]"), "penalty": ("penalty [Pa/m]", "off the stiffest [%]"),
          "slip": ("slip velocity [m/s]", "off the smallest [%]")}
SCATTER = {"disc-normal": 16, "disc-oblique": 4}   # meshes
LIMIT = 600.0               # seconds a run may take


@dataclass(frozen=True)
class Series:
    """Runs that differ in one thing, from coarse to fine: `axis` is its value for the figure and the table."""

    title: str
    axis: str
    points: dict[float, study.Point]


def series(scene: str, quick: bool) -> dict[str, Series]:
    """The series of a scene by name; quick: coarser, a few seconds."""
    sized = {factor: {"mesh_size": factor * study.BULK, "contact_mesh_size": factor * study.CONTACT} for factor in (2, 1, 0.5, 0.35, 0.25)}
    normal = scene == "disc-normal"
    small, fine = (4e-5, 1.0) if quick else (5e-6, 0.5)
    finest = 1.0 if quick else (0.25 if normal else 0.35)
    steps = (1e-4, 4e-5, 2e-5) if quick else (1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2.5e-6)[slice(None if normal else 5)]
    found = {
        "mesh": Series(f"both mesh sizes times a factor, dt = {small:g} s", "mesh factor",
                       {f: sized[f] | {"dt": small} for f in sized if f >= finest and (f != 0.35 or not normal)}),
        "step": Series(f"fixed dt [s], mesh factor {fine:g}", "dt", {dt: sized[fine] | {"dt": dt} for dt in steps}),
        "accuracy": Series("accuracy, which sets mesh and adaptive step", "accuracy",
                           {a: {"accuracy": a} for a in ((2e-2, 5e-3) if quick else (2e-2, 5e-3, 1.25e-3, 6e-4, 3e-4)[slice(None if normal else 4)])}),
    }
    if not quick:
        used = describe(scenes.load(scene).values)["used"]
        around = {f: {name: f * used[name] for name in ("mesh_size", "contact_mesh_size")} for f in np.linspace(0.85, 1.15, SCATTER[scene]).round(3).tolist()}
        found["scatter"] = Series("the default run on meshes about as fine, their sizes times a factor: how far answers scatter by chance",
                                  "factor", around)
        if normal:
            found["scatter-neohookean"] = Series("the same with the neo-Hookean law", "factor",
                                                 {f: sizes | {"law": "neohookean"} for f, sizes in around.items()})
    coarse = {"accuracy": 1.25e-3}                      # of the series that show what a parameter does
    if normal:
        found["penalty"] = Series("penalty k [Pa/m]: a parameter of the model, its influence is no error", "penalty",
                                  {k: {"penalty": k} for k in ((1e9, 1e10) if quick else (1e9, 1e10, 1e11, 1e12))})
    else:
        found["slip"] = Series("slip velocity [m/s]: a parameter of the model", "slip_velocity",
                               {e: coarse | {"slip_velocity": e} for e in ((1.0, 0.1) if quick else (1.0, 0.3, 0.1, 0.03, 0.01))})
        found["slip-strong"] = Series("slip velocity [m/s] with both coefficients 1", "slip_velocity", {
            e: coarse | {"slip_velocity": e, "friction_static": 1.0, "friction_dynamic": 1.0} for e in found["slip"].points})
        found["slip-smooth"] = Series("slip velocity [m/s] with the smooth transition", "slip_velocity", {
            e: coarse | {"slip_velocity": e, "friction_transition": "smooth"} for e in found["slip"].points})
        found["frictionless"] = Series("without friction on the mesh and with the steps of the series before, for the iterations", "friction_static", {
            0.0: sized[1] | coarse | {"friction_static": 0.0, "friction_dynamic": 0.0}})
    return found


def main(argv: list[str]) -> int:
    """Runs all series, prints their tables and the converged values; 0 if the default run is as near to them as asked."""
    parser = argparse.ArgumentParser(prog=f"{COMMAND} refine", description=__doc__)
    parser.add_argument("scene", nargs="?", default="disc-normal", choices=list(ANSWERS), help="(default: disc-normal)")
    parser.add_argument("--quick", action="store_true", help="few and coarse runs: a look at the tables, not at convergence")
    parser.add_argument("--out", metavar="DIR", type=Path, help="the result folder (default: results/refine/SCENE)")
    options = parser.parse_args(argv)
    out, wanted = result_folder(options.out or RESULTS / "refine" / options.scene), series(options.scene, options.quick)
    answers = ANSWERS[options.scene]
    tables = run_all(options.scene, wanted, out)
    best, error = converged(tables, answers)
    default = defaults()["accuracy"]
    at_default = tables["accuracy"].set_index("accuracy").loc[default, list(answers)]
    compare(tables, best)
    for name, frame in tables.items():
        study.save(frame, out / f"{name}.csv")
        print(f"{wanted[name].title}\n{as_text(frame, wanted[name].axis, answers)}")
        if name.startswith("scatter"):
            print("mean and rms: " + ", ".join(f"{each} {frame[each].mean():.6g}, {frame[each + ' %'].std():.2g} %" for each in answers))
        print()
    draw({name: frame for name, frame in tables.items() if name in LABELS}, wanted, answers, out / "refine.png")
    result = pd.DataFrame({"answer": answers, "converged": best.values, "+-": error.values, "default": at_default.values,
                           "off %": 100 * (at_default / best - 1).values})
    study.save(result, out / "converged.csv")
    near = (result["off %"].abs() <= ASKED)[:-1].all()
    print(f"converged: the mean of the finest runs of mesh, step and accuracy; error bar: how far the two finest of each are off\n"
          f"{study.table(result, {'answer': '', 'converged': '.7g', '+-': '.1e', 'default': '.6g', 'off %': '+.3f'})}\n\n"
          f"the default run (accuracy {default:g}) is {'' if near else 'NOT '}within {ASKED:g} % of the converged "
          f"{', '.join(answers[:-1])}\n\n{shown(out)}/{{{','.join(tables)},converged}}.csv, refine.png")
    return 0 if near else 1


def run_all(scene: str, wanted: dict[str, Series], out: Path) -> dict[str, pd.DataFrame]:
    """A table for each series, its axis in front; Failure if a run fails."""
    keys = [(name, value) for name, each in wanted.items() for value in each.points]
    rows = study.study([wanted[name].points[value] for name, value in keys], out, {"fields": 0}, LIMIT, scene)
    for (name, value), code, message in zip(keys, rows.exit, rows.message):
        if code:
            raise Failure(f"{name} {value:g}: {message}", code)
    tables = {}
    for name, each in wanted.items():
        here = [key[0] == name for key in keys]
        tables[name] = rows[here].assign(**{each.axis: list(each.points)}).reset_index(drop=True)
    return tables


def converged(tables: dict[str, pd.DataFrame], wanted: tuple[str, ...]) -> tuple[pd.Series, pd.Series]:
    """The mean of the finest runs of the mesh, step and accuracy series, and its error: how far the two finest of each are off.

    Some answers (contact time, friction work) scatter at every resolution: no single run is the converged one.
    """
    last = [tables[name][list(wanted)].iloc[-2:] for name in ("mesh", "step", "accuracy")]
    mean = pd.concat([frame.iloc[-1:] for frame in last]).mean()
    return mean, (pd.concat(last) - mean).abs().max()


def compare(tables: dict[str, pd.DataFrame], best: pd.Series) -> None:
    """Adds the difference in % of each answer: accuracy from the converged values, scatter from its mean, the others from their finest run."""
    for name, frame in tables.items():
        against = best if name == "accuracy" else frame[list(best.index)].mean() if name.startswith("scatter") else frame.iloc[-1]
        for answer in best.index:
            frame[f"{answer} %"] = 100 * (frame[answer] / against[answer] - 1)


def as_text(frame: pd.DataFrame, axis: str, answers: tuple[str, ...]) -> str:
    """The table of a series: each answer with its difference, and what the run cost."""
    text = frame[[axis, *answers]].astype(object)
    for answer in answers:
        text[answer] = [f"{value:.6g} ({percent:+.3f} %)" for value, percent in zip(frame[answer], frame[f"{answer} %"])]
    text[["dofs", "steps", "rejected", "seconds"]] = frame[["dofs", "steps", "rejected_steps", "wall_seconds"]]
    text["iterations a step"] = frame["newton_iterations"] / frame["steps"]
    return study.table(text, {axis: "g"} | dict.fromkeys(answers, "") | {
        "dofs": ".0f", "steps": ".0f", "rejected": ".0f", "iterations a step": ".1f", "seconds": ".1f"})


def draw(tables: dict[str, pd.DataFrame], wanted: dict[str, Series], answers: tuple[str, ...], path: Path) -> None:
    """The differences of the tables over what was refined, log-log; the run that is compared with is left out."""
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(2, 2, figsize=(8, 6.4), sharey=True)
        for axes, (name, frame) in zip(grid.flat, tables.items()):
            rows = frame if name == "accuracy" else frame.iloc[:-1]
            x, differences = rows[wanted[name].axis], rows[[f"{answer} %" for answer in answers]].abs()
            for column, colour, marker in zip(differences, (BLUE, ORANGE, GREEN, PURPLE, GREY), "osd^v"):
                axes.loglog(x, differences[column].clip(lower=SHOWN), color=colour, marker=marker, markersize=4,
                            label=column.rstrip(" %").replace("_", " "))
            if name in ("mesh", "step"):
                axes.loglog(x, 0.1 * (x / x.max()) ** 2, color=GREY, linestyle=":", label="second order")
            if name != "penalty":
                axes.axhline(ASKED, color=BLACK, linestyle="--", linewidth=0.8, label="asked of the default run")
            axes.set_xticks(x, [f"{value:g}" for value in x])
            axes.xaxis.set_minor_locator(NullLocator())
            axes.set(xlabel=LABELS[name][0], ylabel=LABELS[name][1], ylim=(SHOWN / 2, 100))
            axes.yaxis.labelpad = 6
            axes.grid(alpha=0.3)
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, handlelength=1.6,
                      columnspacing=1.4)
        save(figure, path)
