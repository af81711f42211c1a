"""Twelve materials at three speeds, all else left to the program, against a penalty ten times larger and a mesh twice as fine."""

from pathlib import Path

import pandas as pd

from ..output import estimate
from ..places import shown
from ..output.results import read_scene
from . import draws
from ..sweeps import study

SPEEDS = (0.001, 0.01, 0.1)         # over sqrt(E/density)
STIFFER, FINER = 10, 2
LIMIT = 0.01                        # largest difference without a warning
ANSWERS = ("thresholded_contact_time", "restitution", "peak_force")


def main(argv: list[str]) -> int:
    """Prints the differences, writes materials.csv; 0 if each is below LIMIT, or the run has a warning."""
    parser = study.command("materials", __doc__, page=True)
    parser.add_argument("--materials", metavar="N", type=int, default=len(draws.MATERIALS), help="the first N of them")
    options = parser.parse_args(argv)
    table = compare(list(draws.MATERIALS)[:max(1, options.materials)], options.out)
    study.save(table, options.out / "materials.csv")
    text = report(table)
    print(f"{text}\n{shown(options.out)}/materials.csv")
    study.page(options.page, "Twelve materials at three speeds", ["materials", *argv], text)
    return 0 if table.holds.all() else 1


def compare(materials: list[str], out: Path) -> pd.DataFrame:
    """A row a material and speed: relative differences of ANSWERS, warnings, and whether it holds; nan where a run failed."""
    names = [(name, beta) for name in materials for beta in SPEEDS]
    points = [dict(zip(("young", "density", "nu"), draws.MATERIALS[name]), speed=float(f"{beta * draws.bar_speed(*draws.MATERIALS[name][:2]):.4g}"),
                   law="neohookean") for name, beta in names]
    plain = study.study(points, out, {"fields": 0, "penalty": "auto"}, 900.0, estimate=True)
    finer = []
    for point, code in zip(points, plain.exit):
        used = read_scene(study.place(out, point)) if code == 0 else None
        finer.append(estimate.other(point, used, 1 / FINER) | {"penalty": STIFFER * used["penalty"]} if used else point)
    fine = study.study(finer, out / "finer", {"fields": 0}, 900.0)
    rows = []
    for (name, beta), (_, run), (_, reference) in zip(names, plain.iterrows(), fine.iterrows()):
        row = {"material": name, "v/c": beta, "warnings": run.warnings, "message": run.message or reference.message}
        if run.exit == reference.exit == 0:
            row |= {"thresholded_contact_time": abs(run.thresholded_contact_time / reference.thresholded_contact_time - 1),
                    "restitution": abs(run.rebound_vy - reference.rebound_vy) / abs(reference.rebound_vy), "peak_force": abs(run.peak_force / reference.peak_force - 1)}
        below = all(row.get(answer, 1.0) <= LIMIT for answer in ANSWERS)
        rows.append(row | {"holds": below or bool(run.warnings) or bool(run.message)})
    return pd.DataFrame(rows).reindex(columns=["material", "v/c", *ANSWERS, "holds", "warnings", "message"])


def report(table: pd.DataFrame) -> str:
    """The table, differences in %, and the verdict."""
    names = ["; ".join(sentence.partition(":")[0] for sentence in each.split("; ")) for each in table.warnings]
    percent = table.assign(**{answer: 100 * table[answer] for answer in ANSWERS}, warnings=names)
    below = (table[list(ANSWERS)] <= LIMIT).all(axis=1)
    return (f"Differences in % from a penalty {STIFFER} times larger and elements and steps {FINER} times smaller\n\n"
            + study.table(percent, {"material": "", "v/c": "g"} | dict.fromkeys(ANSWERS, ".2f") | {"holds": "", "warnings": "", "message": ""})
            + f"\n\n{below.sum()} of {len(table)} within {100 * LIMIT:g} %, {(table.holds & ~below).sum()} more with a warning that says why not: the requirement "
            + ("holds" if table.holds.all() else "FAILS"))
