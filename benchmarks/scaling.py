"""Cost of a step and memory over the number of unknowns n.

Each scene runs on several meshes; the exponents b of c n^b are fitted by phase. The lower bound of
a step is the time that its iterations need at least: forces of the bodies and solutions with the
factors, phases `assembly` and `solve`.
"""

import math
import multiprocessing
from dataclasses import dataclass
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

import pandas as pd

from ffimpact import scene
from ffimpact.freefem import freefem
from ffimpact.output.results import read_json
from ffimpact.running import run
from ffimpact.sweeps import study
from verification import commands

from . import page


@dataclass(frozen=True)
class Case:
    """A scene that is run on several meshes.

    sizes: element sizes in the bulk and near contact [m]; finer: divisors of the sizes
    dt: step [s]; steps: number of steps
    exponent, memory: largest permitted exponents of the time of a step and of the memory
    """

    scene: str
    sizes: tuple[float, float]
    finer: tuple[float, ...]
    dt: float
    steps: int
    exponent: float
    memory: float = 1.1


CASES = {
    # Svk loses ellipticity on fine meshes.
    "disc": Case("disc-normal-neohookean", (5e-3, 1e-3), (1, 2, 4, 9), 2e-5, 30, 1.2),
    "disc, friction": Case("disc-oblique", (5e-3, 1e-3), (1, 2, 4, 8), 2e-5, 30, 1.2),
    "ball": Case("ball", (22e-3, 7.2e-3), (1, 1.6, 2.4, 4), 5e-5, 20, 1.4),
    "ball, friction": Case("ball-oblique", (22e-3, 7.2e-3), (1, 1.6, 2.4, 3.4), 5e-5, 20, 1.4),
}
MOST_OVER_FLOOR = 4  # permitted ratio of a step to its lower bound
# The phases of a step, in `phase_seconds`.
PHASES = ("assembly", "factor", "solve", "contact", "search", "audit", "output")


def main(argv: list[str]) -> int:
    """Prints seconds of a step, memory and their exponents; writes scaling.csv.

    Returns 0 if no exponent exceeds its bound.
    """
    parser = commands.command("scaling", __doc__, page=True)
    parser.add_argument("--meshes", metavar="N", type=int, default=4, help="the coarsest N of each case (default: all four)")
    parser.add_argument("--cases", metavar="CASE", nargs="+", default=list(CASES), choices=CASES, help=", ".join(CASES))
    options = parser.parse_args(argv)
    # Builds the kernels, if they are missing, before the first run.
    freefem.find()
    rows, texts, slopes, phases, good = [], [], [], [], True
    for name in options.cases:
        case = CASES[name]
        # Each run has its own process, so that the memory of its children is measured alone.
        with multiprocessing.get_context("fork").Pool(1, maxtasksperchild=1) as pool:
            arguments = [(case, finer, options.out / name.replace(", ", "-")) for finer in case.finer[:options.meshes]]
            measurements = pd.DataFrame(pool.starmap(_row, arguments, chunksize=1))
        exponents = {column: slope(measurements.unknowns, measurements[column]) for column in (*PHASES, "step", "memory")}
        rows.append(measurements.assign(case=name))
        slopes.append({"case": name, "step": exponents["step"], "step, aim": case.exponent,
                       "memory": exponents["memory"], "memory, aim": case.memory})
        phases.append({"case": name} | {phase: exponents[phase] for phase in PHASES})
        good &= (exponents["step"] <= case.exponent and exponents["memory"] <= case.memory
                 and measurements["over floor"].max() <= MOST_OVER_FLOOR)
        shown = pd.concat([measurements, pd.DataFrame([exponents | {"mesh": f"exponent (asked: {case.exponent}, {case.memory})"}])])
        texts.append(f"## {name}\n\n" + study.table(shown, {"mesh": "", "unknowns": ".0f", "iterations": ".1f", "factorisations": ".0f"}
                                                  | dict.fromkeys((*PHASES, "step"), ".3g") | {"over floor": ".2g", "memory": ".0f"}))
    verdict = (f"Seconds of processor time a step, by phase, from the first touch on; memory in MB. "
               f"{'No' if good else 'An'} exponent is above what is asked, {'and no' if good else 'or a'} step above "
               f"{MOST_OVER_FLOOR} times its floor.")
    table = pd.concat(rows)
    tables = {"": table[["case", *table.columns.drop("case")]], "exponents": pd.DataFrame(slopes),
              "phases": pd.DataFrame(phases)}
    return page.finish(options, table, "\n\n".join([*texts, verdict]), good, argv,
                       "Time and memory over the number of unknowns", tables, ["exponents"])


def _row(case: Case, finer: float, out: Path) -> dict:
    """The row of one run, in its own folder and process."""
    bulk, contact = case.sizes
    values = {"mesh_size": bulk / finer, "contact_mesh_size": contact / finer, "dt": case.dt, "end_time": case.steps * case.dt, "fields": 0}
    folder = out / f"{finer:g}"
    run.run(scene.load(case.scene).override(values), out=folder, force=True, estimate=False)
    summary = read_json(folder / "summary.json")
    spent = {phase: summary["phase_seconds"][phase] / summary["steps"] for phase in PHASES}
    return {"mesh": f"h / {finer:g}", "unknowns": summary["dofs"], "iterations": summary["newton_iterations"] / summary["steps"],
            "factorisations": summary["factorizations"], **spent, "step": sum(spent.values()),
            "over floor": sum(spent.values()) / max(spent["assembly"] + spent["solve"], 1e-9),
            "memory": getrusage(RUSAGE_CHILDREN).ru_maxrss / 1024}


def slope(n: pd.Series, values: pd.Series) -> float:
    """The slope b of the regression line log values = a + b log n. It is nan if a value is too
    small to measure."""
    if len(n) < 2 or (values < 1e-4).any():
        return math.nan
    x, y = n.map(math.log), values.map(math.log)
    return (x - x.mean()).dot(y - y.mean()) / (x - x.mean()).dot(x - x.mean())
