"""Whether `accuracy` means what it says: over many scenes, the errors of runs with the default accuracy against much finer ones."""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

from . import study
from .parameters import ROOT, defaults
from .run import shown

ASKED = defaults()["accuracy"]
FINE = 0.4                  # of the accuracy: the finer run
LIMIT = 900.0               # seconds a run may take
KEPT = 0.95                 # of the scenes in which the promise must be kept
ANSWERS = ("impulse", "rebound", "contact time", "friction work")


def scenes() -> list[study.Point]:
    """Twenty scenes: both laws, soft and stiff, slow and fast, with and without gravity, friction and spin."""
    points = [{"law": law, "nu": nu, "speed": speed} for law in ("svk", "neohookean") for nu, speed in ((0.0, 2.0), (0.3, 4.0), (0.45, 8.0), (0.49, 6.0))]
    points += [{"law": "neohookean", "nu": 0.3, "speed": speed} for speed in (1.0, 12.0, 18.0)]
    points += [{"law": "neohookean", "nu": 0.4, "speed": 8.0} | more for more in (
        {"penalty": 1e9}, {"exponent": 1.5}, {"gravity": 9.81, "height": 0.2}, {"young": 7e7}, {"radius": 0.5})]
    rubs = {"law": "neohookean", "nu": 0.4, "speed": 8.0, "friction_static": 0.3, "friction_dynamic": 0.3}
    return points + [rubs | more for more in ({"angle": 60.0}, {"angle": 45.0, "friction_static": 0.6}, {"angle": 90.0, "spin": 100.0},
                                              {"angle": 30.0, "regularization": "tanh"})]


def main(argv: list[str]) -> int:
    """Prints the errors, scene by scene, writes promise.csv; 0 if the promise is kept in impulse and rebound in enough scenes."""
    parser = argparse.ArgumentParser(prog="python -m orchestrate promise", description=__doc__)
    parser.add_argument("--scenes", metavar="N", type=int, default=len(scenes()), help="the first N of them")
    parser.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "results/promise", help="the result folder")
    options = parser.parse_args(argv)
    out, points = options.out.resolve(), scenes()[:max(1, options.scenes)]
    rows = study.study(points + [point | {"accuracy": FINE * ASKED} for point in points], out, {"fields": 0}, LIMIT)
    table = errors(points, rows[:len(points)], rows[len(points):].reset_index(drop=True))
    study.save(table, out / "promise.csv")
    print(f"Error in % of runs with accuracy {ASKED:g} (asked: {100 * ASKED:g} %) against accuracy {FINE * ASKED:g}\n")
    print(study.table(table, {"scene": ""} | dict.fromkeys(ANSWERS, ".3f") | {"message": ""}))
    kept = {answer: int((table[answer] <= 100 * ASKED).sum()) for answer in ANSWERS}
    count = {answer: int(table[answer].notna().sum()) for answer in ANSWERS}
    together = int((table[["impulse", "rebound"]] <= 100 * ASKED).all(axis=1).sum())
    print("\nkept in " + ", ".join(f"{kept[answer]} of {count[answer]} ({answer})" for answer in ANSWERS)
          + f"; impulse and rebound together in {together} of {len(table)} (asked: {KEPT:.0%})\n{shown(out)}/promise.csv")
    return 0 if together >= KEPT * len(table) else 1


def errors(points: list[study.Point], plain: pd.DataFrame, fine: pd.DataFrame) -> pd.DataFrame:
    """A row a scene: errors in %: of the impulse and the contact time over themselves, of the rebound velocity over the speed at the
    touch, of the friction work over the energy at the start (of itself it is a small part); nan where a run failed."""
    fall = np.hypot(fine.get("speed", 0), np.sqrt(2 * fine.get("gravity", pd.Series(0.0, fine.index)).fillna(0)
                                                  * fine.get("height", pd.Series(0.0, fine.index)).fillna(0)))
    rebound = np.hypot(plain.rebound_vx - fine.rebound_vx, plain.rebound_vy - fine.rebound_vy) / fall
    work = (plain.friction_work - fine.friction_work).abs() / fine.energy_initial
    table = pd.DataFrame({"scene": [", ".join(map(str, point.values())) for point in points],
                          "impulse": (plain.impulse / fine.impulse - 1).abs(), "rebound": rebound,
                          "contact time": (plain.contact_time / fine.contact_time - 1).abs(), "friction work": work.where(fine.friction_work > 0)})
    table[list(ANSWERS)] *= 100
    return table.assign(message=[a or b for a, b in zip(plain.message, fine.message)])
