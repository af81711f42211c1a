"""Compares the program with exact solutions (verification/).

Each case runs over element size, time step or the other source of its error. The tolerances were
fixed beforehand. results/verify has verify.csv with all numbers and a figure for each case. One
case runs on each core (the three-dimensional case V17 takes longest, and runs in parts). Results of
the present code are reused.
"""

import hashlib
import json
import math
import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.ticker import NullLocator

from ffimpact.failure import BadInput, Failure
from ffimpact.freefem import freefem
from ffimpact.output.results import read_frame
from ffimpact.places import ROOT, shown
from ffimpact.report.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, STYLE, save
from ffimpact.report.literature import REFERENCE
from ffimpact.running import run
from ffimpact.sweeps import study

from . import commands
from .case import Case, Row
from .cases import CASES

# Columns of verify.csv. A row with a tolerance is judged.
COLUMNS = ["case", "what", "size", "value", "expected", "error", "tolerance"]
# Must be positive between the coarsest and the finest size.
CONVERGES = "order of the largest error"
SHOWN = 1e-6  # smaller errors are drawn at this value


def main(argv: list[str]) -> int:
    """Runs the cases, prints the table, writes verify.csv and the figures. Returns 0 if all cases
    pass. Raises BadInput for wrong options."""
    parser = commands.command("verify", __doc__)
    parser.add_argument("--cores", metavar="N", type=int, default=study.CORES, help="this many cases at a time (default: %(default)s)")
    parser.add_argument("--force", action="store_true", help="run again what the same code has left")
    options = parser.parse_args(argv)
    if options.cores < 1:
        raise BadInput(f"--cores: {options.cores} (accepted: from 1)")
    out = options.out
    reused = is_finished(out) and not options.force
    frame = read_frame(out / "verify.csv", COLUMNS, keep_default_na=False, na_values=[""]) if reused else run_all(out, options.cores)
    passed = bool(judged(frame)["pass"].all())
    print(study.table(overview(frame), FORMATS))
    for failed in judged(frame).query("not `pass`").itertuples():
        print(f"FAILED  {failed.case}, {failed.what}: {failed.value:.6g}, expected {failed.expected:.6g}, "
              f"error {failed.error:.2g} > {failed.tolerance:g}")
    print(f"\n{'all pass' if passed else 'NOT all pass'}: {shown(out)}/verify.csv and *.png")
    return 0 if passed else 1


def is_finished(out: Path) -> bool:
    """Whether `out` holds a finished verification of the present code."""
    try:
        made = json.loads((out / "summary.json").read_text())["provenance"]["code"]
        return made == code_hash() and (out / "verify.csv").exists()
    except (OSError, ValueError, KeyError, TypeError):
        return False


def code_hash() -> str:
    """The sha256 of the core, the verification scripts and the code that runs and judges them."""
    digest = hashlib.sha256(run.code_hash().encode())
    cases = [path for path in (ROOT / "verification").iterdir() if path.suffix in (".edp", ".idp", ".py")
             and not path.name.startswith("test_")]
    for path in [*sorted(cases), REFERENCE / "converged.toml"]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def run_all(out: Path, cores: int = study.CORES) -> pd.DataFrame:
    """Runs every case, `cores` cases or parts at a time. Returns all numbers in the order of CASES.

    Writes verify.csv, the figures and, last, summary.json.
    """
    program, frames, results = freefem.find(), [], {}
    for old in (out / "summary.json", *out.glob("*.png")):
        old.unlink(missing_ok=True)
    shutil.rmtree(out / "runs", ignore_errors=True)
    for case in CASES:
        (out / "runs" / slug(case)).mkdir(parents=True)
    acts = {(c, p): partial(perform, part, out / "runs" / slug(case)) for c, case in enumerate(CASES) for p, part in enumerate(case.parts)}
    for key, outcome in study.run_parallel(acts, cores, "verify"):
        results[key] = ([], str(outcome)) if isinstance(outcome, Failure) else outcome
    for c, case in enumerate(CASES):
        outcomes = [results[c, p] for p in range(len(case.parts))]
        rows, message = [row for some, _ in outcomes for row in some], next((text for _, text in outcomes if text), "")
        frames.append(judge(case, rows, message))
        if not message:
            draw(case, rows, out)
    frame = pd.concat(frames, ignore_index=True)
    study.save(frame, out / "verify.csv")
    with study.complete(out / "summary.json") as part:
        passed, provenance = bool(judged(frame)["pass"].all()), {"code": code_hash(), "freefem": program.version}
        part.write_text(json.dumps({"passed": passed, "provenance": provenance}, indent=1))
    return frame


def perform(part: Callable[[Path], Iterator[Row]], folder: Path) -> tuple[list[Row], str]:
    """The numbers of a part of a case, and the message of the failure that ended it, or ""."""
    rows = []
    try:
        for row in part(folder):
            rows.append(row)
    except Failure as failure:
        return rows, f"{failure}"
    return rows, ""


def slug(case: Case) -> str:
    """The name of the case as a file name."""
    return case.name.lower().replace(" ", "-")


# ---- verdicts

def judge(case: Case, rows: list[Row], message: str = "") -> pd.DataFrame:
    """The numbers as rows of COLUMNS. Judged numbers have a tolerance; further rows judge the
    convergence over several sizes."""
    tolerance = math.nan if case.by_order else case.tolerance
    names = list(dict.fromkeys(row.what for row in rows))
    finest = {name: series(rows, name)[-1].size for name in names}
    lines = [(row.what, row.size, row.value, row.expected, row.error, tolerance if row.size == finest[row.what] else math.nan)
             for row in rows]
    if message:
        lines.append((message.splitlines()[0][:200], *[math.nan] * 4, case.tolerance))
    elif case.by_order:
        for name in names:
            before, last = series(rows, name)[-2:]
            observed_order = math.log(before.error / last.error) / math.log(before.size / last.size)
            lines.append((f"order of {name}", last.size, observed_order, last.order, abs(observed_order - last.order), case.tolerance))
    else:
        order, size = observed(rows)
        lines.append((CONVERGES, size, order, math.nan, max(-order, 0.0), 0.0))
    return pd.DataFrame([(case.name, *line) for line in lines], columns=COLUMNS)


def series(rows: list[Row], what: str) -> list[Row]:
    """One number at all its sizes, from coarse to fine."""
    return sorted((row for row in rows if row.what == what), key=lambda row: -row.size)


def observed(rows: list[Row]) -> tuple[float, float]:
    """The order of the largest error between the coarsest and the finest size, over the numbers
    with several sizes; and the finest size."""
    several = [refinement for what in dict.fromkeys(row.what for row in rows) if len(refinement := series(rows, what)) > 1]
    first, last = max(group[0].error for group in several), max(group[-1].error for group in several)
    return math.log(first / last) / math.log(several[0][0].size / several[0][-1].size), several[0][-1].size


def judged(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows with a tolerance, with the verdict `pass`. A missing number does not pass."""
    rows = frame[frame.tolerance.notna()]
    return rows.assign(**{"pass": rows.error <= rows.tolerance})


# Formats of the columns: of all numbers, and of the overview.
NUMBERS = {"what": "", "size": "g", "value": ".7g", "expected": ".7g", "error": ".2g", "tolerance": "g"}
FORMATS = {"case": "", "checks": "d", "worst": "", "value": ".6g", "expected": ".6g", "error": ".2g", "tolerance": "g",
           "order": ".2f", "verdict": ""}


def overview(frame: pd.DataFrame) -> pd.DataFrame:
    """A row for each case: number of judged numbers, the one nearest to (or farthest beyond) its
    tolerance, order and verdict."""
    lines = []
    for name, rows in judged(frame).groupby("case", sort=False):
        near = (rows.error / rows.tolerance).where(rows["pass"], math.inf).fillna(0)
        worst, order = rows.loc[near.idxmax()], rows[rows.what == CONVERGES].value
        lines.append({"case": name, "checks": len(rows), "worst": worst.what}
                     | worst[["value", "expected", "error", "tolerance"]].to_dict()
                     | {"order": order.iloc[0] if len(order) else math.nan, "verdict": "pass" if rows["pass"].all() else "FAIL"})
    return pd.DataFrame(lines)


# ---- figures

# Sizes on the axis that differ by more than this factor get a tick label each.
APART = 1.6
# One for each group of numbers.
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK, "#56b4e9", "#e69f00")
# Markers and lines of the numbers within a group.
LOOKS = (dict(marker="o", markersize=4), dict(marker="s", markersize=7, fillstyle="none", linestyle="--"),
         dict(marker="^", markersize=7, fillstyle="none", linestyle=":"))


def draw(case: Case, rows: list[Row], out: Path) -> None:
    """Draws the errors over the size and, if the case has one, its own picture beside them."""
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(1, 2 if case.beside else 1, figsize=(9, 3.6) if case.beside else (6.4, 3.8), squeeze=False)
        draw_errors(grid[0, 0], case, rows)
        if case.beside:
            case.beside(grid[0, 1], out / "runs" / slug(case))
            grid[0, 0].legend(loc="best")
        else:
            figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside right center")
        figure.suptitle(f"{case.name}: {case.title}")
        save(figure, out / f"{slug(case)}.png")


def draw_errors(axes: plt.Axes, case: Case, rows: list[Row]) -> None:
    """Draws errors over sizes with logarithmic axes, expected orders and the tolerance.

    Lines become thinner, so that coinciding lines are visible.
    """
    groups: dict[str, int] = {}
    for k, name in enumerate(dict.fromkeys(row.what for row in rows)):
        group, line = name.partition(":")[0], series(rows, name)
        groups[group] = groups.get(group, -1) + 1
        axes.loglog([row.size for row in line], [max(row.error, SHOWN) for row in line], label=name,
                    color=COLOURS[list(groups).index(group) % len(COLOURS)], linewidth=max(0.8, 2.6 - 0.3 * k),
                    **LOOKS[groups[group] % len(LOOKS)])
    for order in dict.fromkeys(row.order for row in rows if row.order):
        line = max((series(rows, row.what) for row in rows if row.order == order), key=lambda line: line[-1].error)
        sizes = np.array([row.size for row in line])
        errors = 0.6 * min(row.error / row.size**order for row in line) * sizes**order
        axes.loglog(sizes, errors, color=GREY, linewidth=1)
        axes.annotate(f"order {order:.2g}", (sizes[-1], errors[-1]), (4, -2), textcoords="offset points", color="#666666",
                      ha="left", va="top", bbox=dict(facecolor="white", edgecolor="none", alpha=0.8, pad=1))
    if not case.by_order:
        axes.axhline(case.tolerance, color=BLACK, linestyle="--", linewidth=0.8, label="asked of the finest")
    sizes = sorted({row.size for row in rows})
    named = sizes[:1]
    for size in sizes[1:]:
        named += [size] if size > APART * named[-1] else []
    axes.set_xticks(named, [f"{size:.3g}" for size in named])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.margins(y=0.1)
    hidden = any(row.error < SHOWN for row in rows)
    axes.set(xlabel=case.axis, ylabel="relative error" + " (below $10^{-6}$ drawn there)" * hidden)
    axes.grid(alpha=0.3)
