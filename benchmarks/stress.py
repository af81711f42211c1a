"""Difficult parameter sets on a coarse mesh. Each run must close its energy balance or explain its
failure."""

import itertools
import random

import pandas as pd

from ffimpact.input.parameters import whole
from ffimpact.sweeps import study
from verification import commands

AXES = {"law": ("svk", "neohookean"), "nu": (0.0, 0.3, 0.45, 0.49, 0.4999), "speed": (0.5, 4.0, 10.0), "penalty": (1e9, 1e10, 1e12),
        "exponent": (1.0, 1.5, 2.0), "dt": (0.0, 2e-5, 1e-4)}  # dt = 0: adaptive step
# The neo-Hookean law at the largest nu also runs with these values.
HELD = {"law": "incompressible", "nu": 0.5}
# The accuracy controls the adaptive step.
BASE = {"mesh_size": 0.0125, "contact_mesh_size": 0.005, "accuracy": 1.25e-3, "fields": 0}
CLOSED = 1e-8  # largest energy drift of a finished run
LIMIT = 120.0  # longest time of a run [s]
# The columns of the summaries that are evaluated.
READ = ("energy_drift", "max_penetration", "wall_seconds", "newton_iterations", "steps")
KINDS = ("closed", "open", "no step", "breakdown", "other")  # outcomes as the table names them


def main(argv: list[str]) -> int:
    """Runs the sets and prints the outcomes. Returns 0 if every set satisfies the requirements,
    else 1."""
    parser = commands.command("stress", __doc__)
    parser.add_argument("--quick", metavar="N", type=whole, help="N of the sets, always the same ones")
    options = parser.parse_args(argv)
    points = [dict(zip(AXES, values)) for values in itertools.product(*AXES.values())]
    points += [point | HELD for point in points if (point["law"], point["nu"]) == ("neohookean", max(AXES["nu"]))]
    if options.quick is not None:
        points = random.Random(0).sample(points, min(max(options.quick, 1), len(points)))
    rows = study.study(points, options.out, BASE, LIMIT)
    rows = rows.reindex(columns=rows.columns.union(READ, sort=False))   # also where every run crashed
    rows["outcome"] = rows.apply(outcome, axis=1)
    return commands.finish(options, rows, report(rows) + "\n", holds(rows).all())


def outcome(row: pd.Series) -> str:
    """The outcome of a run, one of KINDS."""
    if row.exit == 0:
        return "closed" if row.energy_drift <= CLOSED else "open"
    return {11: "no step", 12: "breakdown"}.get(row.exit, "other")


def holds(rows: pd.DataFrame) -> pd.Series:
    """Whether a run satisfies the requirements: exit 0 with a closed balance, or exit 11 or 12 with
    a message."""
    return (rows.outcome == "closed") | (rows.outcome.isin(("no step", "breakdown")) & (rows.message != ""))


def report(rows: pd.DataFrame) -> str:
    """The report: counts of the outcomes, the extremes, every set that did not finish, and the
    verdict."""
    counts = rows.groupby(["law", "nu", "speed"]).outcome.value_counts().unstack(fill_value=0)
    counts = counts.reindex(columns=KINDS, fill_value=0).reset_index()
    counts["worst drift"] = rows.groupby(["law", "nu", "speed"]).energy_drift.max().values
    lines = [study.table(counts, {"law": "", "nu": "g", "speed": "g"} | dict.fromkeys(KINDS, "d") | {"worst drift": ".1e"}), ""]
    ended = rows[rows.exit == 0]
    if len(ended):
        lines += [_extreme(ended, "energy_drift", "worst energy drift", ".1e"),
                  _extreme(ended, "max_penetration", "deepest penetration [m]", ".2g"),
                  _extreme(rows, "wall_seconds", "slowest [s]", ".1f")]
    lines += [f"exit {row.exit}: {_name(row)}: {row.message}" for _, row in rows[rows.exit != 0].iterrows()]
    lines += [f"balance open, {row.energy_drift:.1e}: {_name(row)}" for _, row in rows[rows.outcome == "open"].iterrows()]
    good, drift = holds(rows), ended.energy_drift
    lines += ["", f"{len(rows)} sets: {len(ended)} finished, {(drift <= CLOSED).sum()} of them with an energy drift of at most "
              f"{CLOSED:g}, {(drift <= CLOSED / 10).sum()} of at most {CLOSED / 10:g}",
              f"requirement {'holds' if good.all() else f'FAILS for {(~good).sum()} sets'}: exit 0 with a drift of at most "
              f"{CLOSED:g}, or exit 11 or 12 with a message"]
    return "\n".join(lines)


def _extreme(rows: pd.DataFrame, column: str, label: str, form: str) -> str:
    row = rows.loc[rows[column].idxmax()]
    return f"{label + ':':<26}{row[column]:{form}} ({_name(row)})"


def _name(row: pd.Series) -> str:
    return ", ".join(f"{name} {_short(name, row[name])}" for name in AXES)


def _short(name: str, value) -> str:
    """A value in words; dt = 0 is adaptive."""
    return "adaptive" if name == "dt" and value == 0 else f"{value:g}" if isinstance(value, float) else value
