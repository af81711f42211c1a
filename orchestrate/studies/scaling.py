"""V19: one impact in many units and materials, given by its physical parameters alone, has one dimensionless answer."""

from pathlib import Path

import pandas as pd

from ..output import estimate
from ..input.parameters import defaults
from ..places import shown
from ..progress import in_turn
from ..output.results import read_scene
from . import draws
from ..sweeps import study

CASES = {"normal": {"law": "svk", "nu": 0.45}, "oblique": {"law": "neohookean", "nu": 0.45, "angle": 60.0, "friction_static": 0.7, "friction_dynamic": 0.5}}
SPEED = {"normal": 8.0, "oblique": 12.0}            # m/s of the paper's disc
PAPER = {"young": 7e6, "density": 1722.0, "radius": 0.05}
WORLDS = {"the paper's disc": PAPER,
          "in millimetres, tonnes, MPa": {"young": 7.0, "density": 1.722e-9, "radius": 50.0},
          "steel": {"young": 2.1e11, "density": 7850.0, "radius": 0.05}, "glass": {"young": 7e10, "density": 2500.0, "radius": 0.05},
          "gel": {"young": 3e4, "density": 1050.0, "radius": 0.05}, "a tenth of the density": {"young": 7e6, "density": 172.2, "radius": 0.05}}
EQUAL = 1e-6                                        # largest relative difference of a regular run
NUDGE = 1e-14                                       # of the speed, which shows how far a run amplifies round-off
ANSWERS = ("impulse", "rebound", "rebound_spin", "energy", "friction_work", "thresholded_contact_time", "contact_time", "peak_force")


def main(argv: list[str]) -> int:
    """Prints how far the dimensionless answers of each world are from the paper's disc; 0 if all are equal, or within the scatter."""
    parser = study.command("scaling", __doc__, page=True)
    parser.add_argument("--accuracy", type=float, default=defaults()["accuracy"], help="of the runs (default: %(default)g)")
    options = parser.parse_args(argv)
    table = compare(options.out, options.accuracy)
    study.save(table, options.out / "scaling.csv")
    text = report(table)
    print(f"{text}\n{shown(options.out)}/scaling.csv")
    study.page(options.page, "One impact in many units and materials", ["scaling", *argv], text)
    return 0 if table.holds.all() else 1


def points(case: str, accuracy: float) -> dict[str, study.Point]:
    """The worlds of a case, at the speed over c of the paper's disc, and that disc again with a nudge to its speed either way."""
    beta = SPEED[case] / draws.bar_speed(PAPER["young"], PAPER["density"])
    found = {name: CASES[case] | world | {"speed": beta * draws.bar_speed(world["young"], world["density"]), "accuracy": accuracy}
             for name, world in WORLDS.items()}
    start = found["the paper's disc"]
    return found | {f"speed times 1 {sign} {NUDGE:g}": start | {"speed": start["speed"] * (1 + float(sign + "1") * NUDGE)} for sign in "+-"}


def dimensionless(summary: pd.Series, values: dict) -> dict:
    """The answers of a summary in units of radius, density and c."""
    c, radius, density = draws.bar_speed(values["young"], values["density"]), values["radius"], values["density"]
    mass, time = density * radius**2, radius / c
    units = {"impulse": mass * c, "rebound_vx": c, "rebound_vy": c, "rebound_spin": 1 / time, "energy_initial": mass * c**2, "energy_final": mass * c**2,
             "vibration_energy": mass * c**2, "friction_work": mass * c**2, "thresholded_contact_time": time, "contact_time": time,
             "peak_force": mass * c / time}
    return {name: summary[name] / unit for name, unit in units.items()}


def compare(out: Path, accuracy: float) -> pd.DataFrame:
    """A row a case and world: the largest difference of each answer from the paper's disc; the scatter of the nudged runs and the
    estimated error beside it; holds: equal to EQUAL, or to ten times the scatter where a nudge shows that and the estimate covers it."""
    rows = []
    for case in in_turn("scaling", CASES):
        worlds = points(case, accuracy)
        runs = study.study(list(worlds.values()), out / case, {"fields": 0, "penalty": "auto"}, 900.0, estimate=True)
        if runs.exit.any():
            raise study.Failure(f"scaling: {runs.message[runs.exit != 0].iloc[0]}", int(runs.exit.max()))
        answers = [dimensionless(run, read_scene(study.place(out / case, point))) for (_, run), point in zip(runs.iterrows(), worlds.values())]
        speed = SPEED[case] / draws.bar_speed(PAPER["young"], PAPER["density"])
        apart = [estimate.difference(answers[0], answer, speed, 1.0) for answer in answers]
        scatter = max(apart[-1][name] for name in ANSWERS), max(apart[-2][name] for name in ANSWERS)
        for name, found, (_, run) in zip(worlds, apart, runs.iterrows()):
            worst = max(found[answer] for answer in ANSWERS)
            promised = max(found[answer] for answer in estimate.PROMISED)
            rows.append({"case": case, "world": name} | {answer: found[answer] for answer in ANSWERS}
                        | {"largest": worst, "scatter": max(scatter), "estimated": run.estimated_error,
                           "holds": worst <= EQUAL or (worst <= 10 * max(scatter) and promised <= run.estimated_error)})
    return pd.DataFrame(rows)


def report(table: pd.DataFrame) -> str:
    """The table and the verdict."""
    shown_table = study.table(table, {"case": "", "world": ""} | dict.fromkeys(("largest", "scatter", "estimated"), ".1e") | {"holds": ""})
    return (f"Dimensionless answers against the paper's disc; scatter: of that disc with a nudge of {NUDGE:g} to its speed\n\n{shown_table}\n\n"
            f"{table.holds.sum()} of {len(table)} equal to {EQUAL:g}, or within the scatter: the scaling {'holds' if table.holds.all() else 'FAILS'}")
