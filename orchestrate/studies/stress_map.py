"""A map of what holds and what fails: hundreds of parameter sets drawn at random, with a fixed seed, from all that a scene may be."""

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from ..output.folder import result_folder
from ..input.parameters import whole
from ..places import COMMAND, RESULTS, shown
from ..report.figures import BLUE, ORANGE, PURPLE, STYLE
from . import stress
from ..sweeps import study

SEED, SETS = 2024, 300
LIMIT = 300.0               # seconds a run may take
CHATTER = 20                # separate contacts of the body in one impact: above, the force is noise, and a run must not end well
ALLOWED_11 = 0.02           # share of the sets that may end with exit code 11
AXES = ("law", "nu", "speed", "angle", "penalty", "exponent", "dt", "accuracy", "degree", "friction_static", "friction_dynamic", "slip_velocity",
        "regularization")
COLOURS = {"closed": BLUE, "breakdown": ORANGE, "no step": PURPLE, "open": "red", "chatter": "black", "other": "black"}
SHOWN = {"closed": "finished, balance closed", "breakdown": "material broke down (12)",
         "no step": "no convergence, or chatter (11)", "open": "balance open", "chatter": "chatter, not seen", "other": "anything else"}
WRONG = ("open", "chatter", "other")   # silent wrong answers, crashes, hangs: none is allowed


def main(argv: list[str]) -> int:
    """Runs the sets, prints outcomes and regions, writes stress-map.csv, .png and .md; 0 if the requirement holds."""
    parser = argparse.ArgumentParser(prog=f"{COMMAND} stress-map", description=__doc__)
    parser.add_argument("--sets", metavar="N", type=whole, default=SETS, help=f"the first N of them (default: {SETS})")
    parser.add_argument("--out", metavar="DIR", type=Path, default=RESULTS / "stress-map", help="the result folder")
    options = parser.parse_args(argv)
    out = result_folder(options.out)
    points = sample(max(1, options.sets))
    rows = study.study(points, out, {"fields": 0}, LIMIT)
    rows = rows.reindex(columns=rows.columns.union([*stress.READ, "contact_intervals", "min_jacobian", "ellipticity_lost_time"], sort=False))
    rows["outcome"] = [judge(row) for _, row in rows.iterrows()]
    study.save(rows, out / "stress-map.csv")
    draw(rows, out / "stress-map.png")
    text = "\n".join(report(rows)) + "\n"
    with study.complete(out / "stress-map.md") as part:
        part.write_text(f"# What holds and what fails\n![map](stress-map.png)\n\n{text}")
    print(f"{text}\n{shown(out)}/stress-map.{{csv,png,md}}")
    return 0 if holds(rows) else 1


def sample(sets: int) -> list[study.Point]:
    """The first `sets` parameter sets, always the same: words and exponents evenly, speeds, stiffnesses and epsilon evenly in their
    logarithm, half of them with friction, half of the steps adaptive."""
    random = np.random.default_rng(SEED)
    spread = lambda low, high: float(f"{np.exp(random.uniform(np.log(low), np.log(high))):.3g}")   # noqa: E731
    pick = lambda *values: values[random.integers(len(values))]   # noqa: E731
    points = []
    for _ in range(sets):
        point = {"law": pick("svk", "neohookean"), "nu": pick(0.0, 0.2, 0.3, 0.4, 0.45, 0.48, 0.49, 0.499), "speed": spread(0.5, 20),
                 "penalty": spread(1e8, 1e13), "exponent": pick(1.0, 1.5, 2.0), "accuracy": pick(0.0125, 0.005, 0.0025), "degree": pick(1, 2, 2)}
        adaptive, dt = random.random() < 0.5, spread(5e-6, 1e-4)
        rubs, dynamic, more, epsilon = random.random() < 0.5, round(random.uniform(0.05, 1), 2), round(random.uniform(0, 0.4), 2), spread(1e-2, 1)
        angle, law = pick(90.0, 75.0, 60.0, 45.0, 30.0), pick("linear", "linear", "linear-printed", "sqrt", "tanh")
        point["dt"] = 0.0 if adaptive else dt
        if rubs:
            point |= {"angle": angle, "friction_static": round(dynamic + more, 2), "friction_dynamic": dynamic, "slip_velocity": epsilon,
                      "regularization": law, "accuracy": 0.003}
        points.append(point)
    return points


def judge(row: pd.Series) -> str:
    """The outcome of a set: those of stress.outcome, and chatter reported as success."""
    kind = stress.outcome(row)
    return "chatter" if kind == "closed" and row.contact_intervals > CHATTER else kind


def holds(rows: pd.DataFrame) -> bool:
    """No silent wrong answer, crash or hang; every failure has its message; exit 11 below its share."""
    failed = rows[rows.exit != 0]
    return bool(not rows.outcome.isin(WRONG).any() and (failed.message != "").all() and (rows.outcome == "no step").mean() < ALLOWED_11)


def report(rows: pd.DataFrame) -> list[str]:
    """Outcomes, extremes, and each region that fails with its reason."""
    counts = rows.groupby(["law", "outcome"]).size().unstack(fill_value=0).reindex(columns=list(SHOWN), fill_value=0).reset_index()
    lines = [study.table(counts, {"law": ""} | dict.fromkeys(SHOWN, "d")), ""]
    ended = rows[rows.outcome == "closed"]
    if len(ended):
        lines += [f"- {words}: {ended[column].max():.2g} (median {ended[column].median():.2g})" for column, words in (
            ("energy_drift", "largest energy drift"), ("max_penetration", "deepest penetration [m]"), ("wall_seconds", "slowest [s]"))]
        effort = ended.newton_iterations / ended.steps
        lines += [f"- iterations a step: median {effort.median():.1f}, largest {effort.max():.0f}", ""]
    for (law, outcome), group in rows[rows.outcome != "closed"].groupby(["law", "outcome"]):
        lines.append(f"- {law}, {SHOWN[outcome]}: {_region(group, rows[rows.law == law])}. {_reason(group)}")
    lines += [f"- exit {row.exit}: " + ", ".join(f"{name} {row[name]}" for name in AXES if name in row and pd.notna(row[name])) + f": {row.message}"
              for _, row in rows[rows.outcome.isin((*WRONG, "no step"))].iterrows()]
    wrong = rows.outcome.isin(WRONG).sum()
    lines += ["", f"{len(rows)} sets, seed {SEED}: {len(ended)} finished with their balance closed to {stress.CLOSED:g}; {wrong} wrong, crashed or hung; "
              f"{100 * (rows.outcome == 'no step').mean():.1f} % did not converge or chatter (accepted: below {100 * ALLOWED_11:g} %)",
              f"the requirement {'holds' if holds(rows) else 'FAILS'}"]
    return lines


def _region(group: pd.DataFrame, every: pd.DataFrame) -> str:
    """Where the failing sets lie: their number and the ranges of speed and nu, and how many of all sets there fail."""
    low, high = group.speed.min(), group.speed.max()
    inside = every[every.speed.between(low, high)]
    return (f"{len(group)} sets, speeds from {low:g} to {high:g} m/s (median {group.speed.median():.3g}), {100 * len(group) / len(inside):.0f} % of the sets "
            f"at those speeds; nu {group.nu.min():g} to {group.nu.max():g}, penalty {group.penalty.min():.1g} to {group.penalty.max():.1g}")


def _reason(group: pd.DataFrame) -> str:
    if (group.outcome == "breakdown").all() and (group.law == "svk").all():
        lost = group.ellipticity_lost_time.notna().sum()
        return f"Compressed, the law loses ellipticity, and elements invert: {lost} of the {len(group)} had lost it before."
    return "First message: " + str(group.message.iloc[0])


def draw(rows: pd.DataFrame, path: Path) -> None:
    """The sets over speed and nu, penalty and exponent, step and mesh, and epsilon and friction, coloured by outcome."""
    jitter = np.random.default_rng(0).uniform(-0.3, 0.3, len(rows))
    places = {"nu": lambda r: pd.Series(pd.Categorical(r.nu).codes, r.index) + jitter, "exponent": lambda r: r.exponent + jitter / 2}
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(2, 2, figsize=(8.6, 6.6))
        (a, b), (c, d) = grid
        epsilon, coefficient = (rows.get(name, pd.Series(np.nan, rows.index)) for name in ("slip_velocity", "friction_static"))
        panels = ((a, rows.speed, places["nu"](rows), "speed [m/s]", "ν"),
                  (b, rows.penalty, places["exponent"](rows), "penalty k [Pa/m$^m$]", "exponent m"),
                  (c, rows.dt.replace(0.0, 2e-6), rows.dofs, "time step [s]; left: adaptive", "degrees of freedom"),
                  (d, epsilon, coefficient, "ε [m/s]", "static coefficient"))
        for axes, x, y, xlabel, ylabel in panels:
            for outcome, colour in COLOURS.items():
                for law, marker in (("svk", "o"), ("neohookean", "s")):
                    here = (rows.outcome == outcome) & (rows.law == law)
                    if here.any():
                        axes.plot(x[here], y[here], marker=marker, linestyle="", color=colour, markersize=3.5,
                                  alpha=0.5 if outcome == "closed" else 1.0, label=f"{SHOWN[outcome]}, {law}")
            axes.set(xscale="log", xlabel=xlabel, ylabel=ylabel)
        a.set_yticks(range(rows.nu.nunique()), [f"{nu:g}" for nu in sorted(rows.nu.unique())])
        c.set_yscale("log")
        figure.legend(*a.get_legend_handles_labels(), loc="outside upper center", ncols=3)
        with study.complete(path) as part:
            figure.savefig(part)
        plt.close(figure)
