"""The disc on the free block (paper, section 3.2) with error bars: velocities, energies, contact times over law, nu, stiffness, mesh."""

import itertools
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from ffimpact.input.parameters import Value, whole
from ffimpact.output import estimate
from ffimpact.output.results import read_scene
from ffimpact.progress import in_turn
from ffimpact.sweeps import study
from verification import commands

from . import page, peers

CASES = [{"law": law, "nu": nu, "penalty": k} for law, nu, k in itertools.product(("svk", "neohookean"), (0.3, 0.45), (1e9, 1e10))]
ACCURACIES = (0.02, 0.005)
FINER = 1.5               # elements and steps of the reference are so many times smaller than those of the most accurate run
REFERENCE = "reference"     # in the place of an accuracy
SPEED = 10.0                # m/s of the disc
LIMIT = 1800.0              # seconds a run may take
OPEN = {"fields": 0}
# The answers: velocities upwards; energies of the motion of the centres and of the vibration about it, in % of the energy at the start
VELOCITIES = ("v disc m/s", "v block m/s")
SHARES = ("disc moves %", "block moves %", "disc vibrates %", "block vibrates %")
TIMES = ("contact >1% ms", "contact ms")    # above 1 % of the peak force; from the first touch to the last
ANSWERS = VELOCITIES + SHARES + TIMES
# What every run must fulfil. The block's velocity lies between that of bodies that stay together (restitution 0) and of an elastic impact
# (1).
BLOCK = (-0.76, -0.38)      # m/s
MOMENTUM = 1e-8             # of the disc's momentum
ENERGY = 1e-9               # of the energy at the start
# NGSolve: two of the cases at two refinements of its mesh, seconds each; what its answers differ by is the finer's error bar
PEER_CASES = [{"law": law, "nu": 0.45, "penalty": 1e9} for law in ("svk", "neohookean")]
REFINEMENTS = (0.35, 0.7)


def main(argv: list[str]) -> int:
    """Prints answers, errors and checks, writes disc-block-errors.csv and disc-block-peers.csv; 0 if every run fulfils every check."""
    parser = commands.command("disc-block-errors", __doc__, page=True)
    parser.add_argument("--cases", metavar="N", type=whole, default=len(CASES), help="the first N of them")
    parser.add_argument("--accuracy", metavar="A", type=float, nargs="+", default=ACCURACIES,
                        help="of the runs, the most accurate last (default: 0.02 0.005)")
    options = parser.parse_args(argv)
    cases, out = CASES[:max(1, options.cases)], options.out
    table = compare(cases, tuple(options.accuracy), out)
    others, reason = ask_peer([case for case in PEER_CASES if case in cases])
    study.save(others, out / "disc-block-peers.csv")
    bars = [name for answer in ANSWERS for name in (answer, f"{answer} bar")]
    size = ["dofs", "steps", "seconds"]
    tables = {"": with_bars(table)[[*CASES[0], *bars]],
              "errors": differences(table)[[*CASES[0], "accuracy", *size, *ANSWERS]],
              "ngsolve": peer_with_bars(others).reindex(columns=[*CASES[0], "refine", *size, *bars])}
    return page.finish(options, table, report(table, others, reason), not violations(table), argv,
                       "A disc on a free block, with error bars", tables)


def compare(cases: list[study.Point], accuracies: tuple[float, ...], out: Path) -> pd.DataFrame:
    """A row a case and accuracy, and one of its reference: size, processor seconds, ANSWERS, what the checks look at, the message."""
    points = [case | {"accuracy": accuracy} for case in cases for accuracy in accuracies]
    runs = study.study(points, out, OPEN, LIMIT, "disc-block")
    last = range(len(accuracies) - 1, len(points), len(accuracies))
    finer = [estimate.other(points[k], read_scene(study.place(out, points[k])), 1 / FINER) if runs.exit[k] == 0 else points[k]
             for k in last]
    references = study.study(finer, out / "finer", OPEN, LIMIT, "disc-block")
    rows = []
    for k, case in enumerate(cases):
        found = [*runs.iloc[k * len(accuracies):(k + 1) * len(accuracies)].iterrows(), (None, references.iloc[k])]
        rows += [case | row(run, accuracy) for (_, run), accuracy in zip(found, (*accuracies, REFERENCE))]
    return pd.DataFrame(rows).reindex(columns=[*CASES[0], "accuracy", "dofs", "steps", "seconds", *ANSWERS, "momentum",
                                               "energy drift", "message"])


def row(run: Mapping[str, Value], accuracy: float | str) -> dict:
    """Of a run: its answers, and the momentum that is missing after the impact over that of the disc before."""
    if run["exit"] != 0:
        return {"accuracy": accuracy, "message": run["message"]}
    disc, block = (run["mass_1"], run["rebound_vy_1"]), (run["mass_2"], run["rebound_vy_2"])
    found = answers(disc, block, (run["vibration_energy_1"], run["vibration_energy_2"]), run["energy_initial"],
                    (run["thresholded_contact_time"], run["contact_time"]))
    missing = sum(mass * v for mass, v in (disc, block)) / (disc[0] * SPEED) + 1
    return {"accuracy": accuracy, "dofs": run["dofs"], "steps": run["steps"], "seconds": run["cpu_seconds"]} | found | {
        "momentum": abs(missing), "energy drift": run["energy_drift"], "message": ""}


def answers(disc: tuple[float, float], block: tuple[float, float], vibration: tuple[float, float], energy: float,
            times: tuple[float, float]) -> dict[str, float]:
    """ANSWERS, from mass [kg/m] and velocity [m/s] of both bodies, their energies of vibration, that at the start [J/m], both times [s]."""
    moves = [mass / 2 * v**2 for mass, v in (disc, block)]
    return dict(zip(ANSWERS, (disc[1], block[1], *(100 * part / energy for part in (*moves, *vibration)), *(1e3 * time for time in times))))


def ask_peer(cases: list[study.Point]) -> tuple[pd.DataFrame, str]:
    """A row a case and refinement of NGSolve's (benchmarks/programs/ngsolve_two_bodies.py), and why it was not run, if so."""
    rows, reason = [], "none of its cases is among these" if not cases else ""
    for case, refine in in_turn("NGSolve", itertools.product(cases, REFINEMENTS)):
        found, reason = peers.two_bodies(LIMIT, refine=refine, speed=SPEED, **case)
        if not found:
            break
        bodies = [(found[f"mass_{body}"], found[f"velocity_{body}"]) for body in ("upper", "lower")]
        rows.append(case | {"refine": refine, "dofs": found["dofs"], "steps": found["steps"], "seconds": found["cpu_seconds"]
                            + found["setup_seconds"]}
                    | answers(*bodies, (found["vibration_upper"], found["vibration_lower"]), found["energy_start"],
                              (found["contact_time_1_percent"], found["contact_time"])))
    return pd.DataFrame(rows, columns=[*CASES[0], "refine", "dofs", "steps", "seconds", *ANSWERS]), reason


def violations(table: pd.DataFrame) -> list[str]:
    """A sentence for each run and check that it does not fulfil; missing numbers fulfil none."""
    found = []
    for _, run in table.iterrows():
        if run.message:
            found.append(f"{words(run)}: no answer: {run.message}")
            continue
        v_disc, v_block = run[list(VELOCITIES)]
        checks = {f"the block's velocity {v_block:.4f} m/s is not between {BLOCK[0]} and {BLOCK[1]}": BLOCK[0] < v_block < BLOCK[1],
                  f"the disc does not rebound: {v_disc:.4f} m/s": v_disc > 0,
                  f"momentum changes by {run.momentum:.1e}, more than {MOMENTUM:g}": run.momentum <= MOMENTUM,
                  f"energy drifts by {run['energy drift']:.1e}, not below {ENERGY:g}": run["energy drift"] < ENERGY}
        found += [f"{words(run)}: {sentence}" for sentence, holds in checks.items() if not holds]
    return found


def words(run: Mapping[str, Value]) -> str:
    """A case, with its accuracy where it has one, in words."""
    which = run.get("accuracy")
    which = "" if which is None else f", {which}" if which == REFERENCE else f", accuracy {which:g}"
    return f"{run['law']}, nu {run['nu']:g}, k {run['penalty']:g} Pa/m{which}"


def differences(table: pd.DataFrame) -> pd.DataFrame:
    """The runs but for the references, each answer replaced by how far it is from its case's reference [units of the answer]."""
    fine = table[table.accuracy == REFERENCE].set_index(list(CASES[0]))[list(ANSWERS)]
    rough = table[table.accuracy != REFERENCE].copy()
    index = pd.MultiIndex.from_frame(rough[list(CASES[0])])
    rough[list(ANSWERS)] = abs(rough[list(ANSWERS)].to_numpy() - fine.reindex(index).to_numpy())
    return rough


def with_bars(table: pd.DataFrame) -> pd.DataFrame:
    """A row a case: the reference's answers and, as <answer> bar, what the most accurate run differs by."""
    fine = table[table.accuracy == REFERENCE].reset_index(drop=True)
    bars = differences(table).groupby(list(CASES[0]), sort=False).tail(1).reset_index(drop=True)
    return fine.assign(**{f"{answer} bar": bars[answer] for answer in ANSWERS})


def peer_with_bars(others: pd.DataFrame) -> pd.DataFrame:
    """A row a case of which both refinements are there: the finer's answers and, as <answer> bar, what the coarser differs by."""
    groups = [rows for _, rows in others.groupby(list(CASES[0]), sort=False) if len(rows) == len(REFINEMENTS)]
    return pd.DataFrame([{**rows.iloc[-1], **{f"{answer} bar": abs(rows[answer].iloc[-1] - rows[answer].iloc[0]) for answer in ANSWERS}}
                         for rows in groups])


def disagreements(ours: pd.DataFrame, theirs: pd.DataFrame) -> list[str]:
    """A sentence for each answer (tables with bars) that the programs give further apart than both error bars together."""
    found = []
    for _, other in theirs.iterrows():
        own = ours[(ours[list(CASES[0])] == other[list(CASES[0])]).all(axis=1)].iloc[0]
        found += [f"{words(other)}: {answer}: ours {bar(own, answer)}, NGSolve {bar(other, answer)}" for answer in ANSWERS
                  if not abs(own[answer] - other[answer]) <= own[f"{answer} bar"] + other[f"{answer} bar"]]
    return found


def bar(values: Mapping[str, Value], answer: str) -> str:
    """An answer with its error bar, to two digits of the latter."""
    value, error = values[answer], values[f"{answer} bar"]
    if pd.isna(error):
        return "" if pd.isna(value) else f"{value:.4g}"
    digits = min(8, max(0, 1 - int(f"{error:.1e}".split("e")[1]))) if error > 0 else 8
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def report(table: pd.DataFrame, others: pd.DataFrame, reason: str) -> str:
    """Answers with bars, errors beside processor seconds, NGSolve's answers beside ours, the checks."""
    columns = {"law": "", "nu": "g", "penalty": "g"}
    ours = with_bars(table)
    cells = pd.DataFrame([{name: values[name] for name in columns} | {answer: bar(values, answer) for answer in ANSWERS}
                          for _, values in ours.iterrows()])
    errors = differences(table).assign(accuracy=lambda rows: rows.accuracy.astype(float))
    digits = dict.fromkeys(VELOCITIES, ".5f") | dict.fromkeys(SHARES, ".3f") | dict.fromkeys(TIMES, ".2f")
    size = {"dofs": ".0f", "steps": ".0f", "seconds": ".1f"}
    fine = table[table.accuracy == REFERENCE]
    wrong = violations(table)
    return "\n".join([
        f"The disc of radius 0.5 m comes down at {SPEED:g} m/s on the middle of the free block of 10 m x 2 m. Velocities upwards, after "
        f"the impact; energies of the",
        "motion of the centres of mass and of the vibration about it in % of the energy at the start; contact time above 1 % of the peak "
        "force, and from the first",
        f"touch to the last. k: penalty [Pa/m]. Answers are those of the reference, with {FINER} times smaller elements and steps than the "
        f"most accurate run; ± is what",
        f"that run differs by from it. The reference has an error of its own, at second order {1 / (FINER**2 - 1):.1f} times the bar, and "
        f"two runs can be close by",
        "chance: a bar far below those of its column says little.", "",
        study.table(cells, columns | dict.fromkeys(ANSWERS, "")), "",
        "What the runs differ by from the reference, in the units of the answers, and their processor seconds (beside other work on the "
        "machine up to",
        "several times those of a quiet one):", "",
        study.table(errors, columns | {"accuracy": "g"} | size | digits), "",
        f"The references: {cost(fine)}", "",
        "## NGSolve beside it", *beside(table, others, reason, columns, size | digits, disagreements(ours, peer_with_bars(others))), "",
        "## Checks",
        f"Every run: the block's velocity between {BLOCK[0]} and {BLOCK[1]} m/s (bodies that stay together, an elastic impact), the disc "
        f"rebounds, momentum to {MOMENTUM:g}",
        f"of the disc's, energy drift below {ENERGY:g}. Largest found: momentum {table.momentum.max():.1e}, energy drift "
        f"{table['energy drift'].max():.1e}.", "",
        *[f"- {sentence}" for sentence in wrong], f"{len(table)} runs: the requirement {'FAILS' if wrong else 'holds'}"])


def cost(runs: pd.DataFrame) -> str:
    """From the smallest to the largest of size and processor seconds."""
    return ", ".join(f"{runs[name].min():.0f} to {runs[name].max():.0f} {unit}" for name, unit in
                     (("dofs", "unknowns"), ("steps", "steps"), ("seconds", "processor seconds")))


def beside(table: pd.DataFrame, others: pd.DataFrame, reason: str, columns: dict, formats: dict, apart: list[str]) -> list[str]:
    """The lines on NGSolve: why it was not run, or its answers under ours and where they differ by more than their bars."""
    lines = [f"Not run{' to the end' if len(others) else ''}: {reason}."] if reason else []
    if others.empty:
        return lines
    ours = table.merge(others[list(columns)].drop_duplicates(), on=list(columns)).assign(
        program="ours",
        setting=lambda rows: [REFERENCE if accuracy == REFERENCE else f"accuracy {accuracy:g}" for accuracy in rows.accuracy])
    theirs = others.assign(program="NGSolve", setting=[f"refine {refine:g}" for refine in others.refine])
    both = pd.concat([ours, theirs]).sort_values(list(columns), kind="stable")
    return [*lines, "Central differences on its own mesh, contact from both sides (benchmarks/programs/ngsolve_two_bodies.py); its "
                    "processor seconds with set-up.", "",
            study.table(both, columns | {"program": "", "setting": ""} | formats), "",
            *([f"Its error bar is what refine {REFINEMENTS[0]:g} and {REFINEMENTS[1]:g} differ by. Further apart than both error bars "
               f"together:", "", *[f"- {sentence}" for sentence in apart]]
              if apart else [f"No answer is further apart than both error bars together (its own: what refine {REFINEMENTS[0]:g} and "
                             f"{REFINEMENTS[1]:g} differ by)."])]
