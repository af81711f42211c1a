"""Whether `accuracy` means what it says: scenes drawn at random, runs as they are by default against much finer ones."""

import argparse
from pathlib import Path

import pandas as pd

from .. import estimate
from ..folder import result_folder
from ..parameters import defaults, whole
from ..places import COMMAND, RESULTS, shown
from ..results import read_answers, read_scene
from . import draws, study

SEED, COUNT = 41, 40        # other scenes than those of the calibration (seeds 1, 2, 5 and 40)
FINER = 3                   # elements and steps of the reference are so many times smaller
LIMIT = 900.0               # seconds a run may take
OPEN = {"fields": 0, "penalty": "auto"}   # the scene that runs are made of states its own
KEPT = 0.95                 # share of the scenes in which the promise must be kept
NEAR, FAR = 0.2, 1.0        # between which the median error must lie, over the accuracy asked for: who asks for little shall pay little


def main(argv: list[str]) -> int:
    """Prints the errors, scene by scene, writes promise.csv; 0 if the promise is kept in enough scenes, and not at too high a price."""
    parser = argparse.ArgumentParser(prog=f"{COMMAND} promise", description=__doc__)
    parser.add_argument("--scenes", metavar="N", type=whole, default=COUNT, help=f"how many (default: {COUNT})")
    parser.add_argument("--seed", metavar="N", type=whole, default=SEED, help=f"other scenes (default: {SEED})")
    parser.add_argument("--hard", action="store_true", help="also gravity, other integrators, linear elements ...: nothing above what was asked without a warning")
    parser.add_argument("--of", metavar="SCENE", choices=draws.SCENES, default="disc-normal", help="a disc on the plane, on a free block, or a ball: "
                        f"{', '.join(draws.SCENES)} (default: disc-normal)")
    parser.add_argument("--out", metavar="DIR", type=Path, default=RESULTS / "promise", help="the result folder")
    parser.add_argument("--page", metavar="FILE", type=Path, help="also write what is printed as a page")
    options = parser.parse_args(argv)
    points = draws.draw(options.seed, max(1, options.scenes), options.hard, options.of)
    table = compare(points, result_folder(options.out), options.of)
    study.save(table, options.out / "promise.csv")
    good = silent(table) == 0 if options.hard else kept(table)
    text = report(table) + f"; {'the requirement' if options.hard else 'the promise'} {'is kept' if good else 'IS NOT KEPT'}"
    print(f"{text}\n{shown(result_folder(options.out))}/promise.csv")
    study.page(options.page, "Whether accuracy means what it says", "make robustness" if options.hard else "make promise", text)
    return 0 if good else 1


def compare(points: list[study.Point], out: Path, scene: str = "disc-normal") -> pd.DataFrame:
    """A row a scene: what it is, the error of each promised answer and the largest, over the accuracy asked for; the estimate of the
    largest; warnings; processor seconds of the run with its estimate, and of the reference; nan where one of the two failed."""
    plain = study.study(points, out, OPEN, LIMIT, scene, estimate=True)
    finer = [_finer(study.place(out, point), point) if code == 0 else point for point, code in zip(points, plain.exit)]
    fine = study.study(finer, out / "finer", OPEN, LIMIT, scene)
    rows = []
    for point, beside, (_, run), (_, reference) in zip(points, finer, plain.iterrows(), fine.iterrows()):
        asked = point.get("accuracy", defaults()["accuracy"])
        row = {"scene": draws.words(point), "seconds": run.get("cpu_seconds"), "finer seconds": reference.get("cpu_seconds"),
               "warnings": run.get("warnings", ""), "message": run.message or reference.message}
        if run.exit == reference.exit == 0:
            summary, used, speed = read_answers(study.place(out, point))
            best = read_answers(study.place(out / "finer", beside))[0] | {"largest_energy": summary["largest_energy"]}
            apart = estimate.difference(best, summary, speed, used["radius"])
            row |= {name: apart[name] / asked for name in estimate.PROMISED}
            row["error"] = max(apart[name] for name in estimate.PROMISED) / asked
            row["estimated"] = run.get("estimated_error", float("nan")) / asked
        rows.append(row)
    return pd.DataFrame(rows).reindex(columns=["scene", *estimate.PROMISED, "error", "estimated", "seconds", "finer seconds", "warnings", "message"])


def _finer(folder: Path, point: study.Point) -> study.Point:
    """The same scene with FINER times smaller elements and steps than its run in `folder`."""
    return estimate.other(point, read_scene(folder), 1 / FINER)


def silent(table: pd.DataFrame) -> int:
    """How many scenes are above what was asked without a warning."""
    return int(((table.error > 1) & (table.warnings.fillna("") == "")).sum())


def kept(table: pd.DataFrame) -> bool:
    """Whether enough of the scenes that ended are within what was asked, and their median not far below."""
    ended = table.error.dropna()
    return len(ended) > 0 and (ended <= 1).sum() >= KEPT * len(ended) and NEAR <= ended.median() <= FAR


def report(table: pd.DataFrame) -> str:
    """The table and what it says."""
    ended = table.error.dropna()
    return "\n".join([
        f"Errors over the accuracy asked for, against {FINER} times smaller elements and steps", "",
        study.table(table.assign(warnings=table.warnings.fillna("").str.len() > 0), {"scene": ""} | dict.fromkeys(estimate.PROMISED, ".2f")
                    | {"error": ".2f", "estimated": ".2f", "seconds": ".1f", "finer seconds": ".1f", "warnings": "", "message": ""}), "",
        f"{(ended <= 1).sum()} of {len(ended)} within what was asked (promised: {KEPT:.0%}), {silent(table)} above it without a warning; median {ended.median():.2f} of "
        f"it (promised: {NEAR:g} to {FAR:g})"])
