"""What each saving saves: a scene with one saving after the other left out, its time and how far its answers move."""

from pathlib import Path

import pandas as pd

from ..failure import Failure
from ..places import shown
from ..progress import in_turn
from ..output.results import read_history
from ..sweeps import study

BASE = {"height": 0.05, "fields": 0}   # a drop from 5 cm above the plane, so that there is a flight
LIMIT = 600.0                          # seconds a run may take
RUNS = 3                               # of each, of which the fastest counts: neighbours only slow down
ANSWERS = ("impulse", "rebound_vy", "contact_time")
SAVINGS = {                            # what is left out, and what the run does instead
    "symmetry": ("the whole disc", {"symmetry": "full"}),
    "flight": ("steps through the flight", {"without": "flight"}),
    "friction": ("friction terms with both coefficients 0", {"without": "friction"}),
    "body force": ("a dead load of 0", {"without": "body-force"}),
    "frozen factorisation": ("a new one in every iteration", {"without": "frozen-factorisation"}),
    "adaptive step": ("its smallest step throughout", {}),
    "field output": ("50 snapshots", {"fields": 50}),
    "contact culling": ("every point of the outline in the contact problem", {"without": "contact-culling"}),
}


def main(argv: list[str]) -> int:
    """Prints the table and writes skipping.csv; 1 where an answer moves by more than the error of the run itself."""
    parser = study.command("skipping", __doc__)
    parser.add_argument("--accuracy", metavar="A", type=float, default=1e-3, help="of all runs (default: 1e-3)")
    options = parser.parse_args(argv)
    out = options.out
    rows = measure(out, options.accuracy)
    study.save(rows, out / "skipping.csv")
    print(f"disc-normal from {100 * BASE['height']:g} cm above the plane, accuracy {options.accuracy:g}; processor time, the fastest of {RUNS}, "
          "one at a time\n")
    print(study.table(rows, {"left out": "", "instead": "", "seconds": ".2f", "times": ".2f"} | {f"{answer} %": "+.4f" for answer in ANSWERS}))
    allowed = rows["allowed %"].iloc[0]
    same = (rows[[f"{answer} %" for answer in ANSWERS[:2]]].abs() <= allowed).all(axis=None)
    print(f"\nimpulse and rebound move by {'no more' if same else 'MORE'} than {allowed:g} %, the accuracy of the runs"
          f"\n{shown(out)}/skipping.csv")
    return 0 if same else 1


def measure(out: Path, accuracy: float) -> pd.DataFrame:
    """A row a saving: what is left out, seconds, how many times as many as with all savings, difference of each answer in %."""
    base = BASE | {"accuracy": accuracy}
    full = _fastest({"fields": 0}, out, base)
    history = read_history(study.place(out / "0", {"fields": 0}))
    smallest = float(history["dt"][history["normal_force"] > 0].min())
    rows = [{"left out": "nothing", "instead": "", "seconds": full.cpu_seconds, "times": 1.0} | {f"{answer} %": 0.0 for answer in ANSWERS}]
    for name, (instead, point) in in_turn("skipping", SAVINGS.items()):
        run = _fastest(point or {"dt": smallest}, out, base)
        rows.append({"left out": name, "instead": instead, "seconds": run.cpu_seconds, "times": run.cpu_seconds / full.cpu_seconds}
                    | {f"{answer} %": 100 * (run[answer] / full[answer] - 1) for answer in ANSWERS})
    return pd.DataFrame(rows).assign(**{"allowed %": 100 * accuracy})


def _fastest(point: study.Point, out: Path, base: study.Point) -> pd.Series:
    """The row of the fastest of RUNS runs of the same; Failure where one fails."""
    rows = pd.concat([study.study([point], out / str(k), base, LIMIT, cores=1) for k in range(RUNS)])
    if rows.exit.any():
        raise Failure(f"{point}: {rows.message[rows.exit != 0].iloc[0]}", int(rows.exit.max()))
    return rows.iloc[int(rows.cpu_seconds.argmin())]
