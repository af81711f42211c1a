"""The disc on the free block (paper, section 3.2) with error bars.

Computes velocities, energies and contact times for several laws, values of nu, penalties and
meshes.
"""

import itertools
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from ffimpact.input.parameters import Value, whole
from ffimpact.output.results import read_scene
from ffimpact.progress import in_turn
from ffimpact.scene import load
from ffimpact.scenes.finer import scaled
from ffimpact.sweeps import study
from verification import commands

from . import page, peers

CASES = [{"law": law, "nu": nu, "penalty": k} for law, nu, k in itertools.product(("svk", "neohookean"), (0.3, 0.45), (1e9, 1e10))]
ACCURACIES = (0.02, 0.005)
# Mesh sizes and steps of the reference are smaller by this factor than those of the most accurate
# run.
FINER = 1.5
REFERENCE = "reference"  # marks the reference in the column accuracy
SPEED = 10.0  # speed of the disc [m/s]
LIMIT = 1800.0  # longest time of a run [s]
OPEN = {"fields": 0}
# The results. Velocities are positive upwards. The energies of the motion of the centres and of the
# vibration about them are in % of the initial energy.
VELOCITIES = ("v disc m/s", "v block m/s")
SHARES = ("disc moves %", "block moves %", "disc vibrates %", "block vibrates %")
# Contact times: while the force exceeds 1 % of its peak, and from the first to the last contact.
TIMES = ("contact >1% ms", "contact ms")
ANSWERS = VELOCITIES + SHARES + TIMES
# Bounds that every run must satisfy. The velocity of the block lies between the values for
# restitution 0 (the bodies stay together) and restitution 1 (elastic impact).
BLOCK = (-0.76, -0.38)  # velocity of the block [m/s]
MOMENTUM = 1e-8  # change of the total momentum over the momentum of the disc
ENERGY = 1e-9  # error of the energy balance over the initial energy
# NGSolve solves two of the cases at two refinements of its mesh, in seconds each. The difference
# between the two is the error bar of the finer one.
PEER_CASES = [{"law": law, "nu": 0.45, "penalty": 1e9} for law in ("svk", "neohookean")]
REFINEMENTS = (0.35, 0.7)


def main(argv: list[str]) -> int:
    """Prints results, errors and checks; writes disc-block-errors.csv and disc-block-peers.csv.

    Returns 0 if every run passes every check.
    """
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
    """Runs all cases. Each row is a case with one accuracy or with its reference.

    The columns are size, processor seconds, ANSWERS, the quantities of the checks and the message.
    """
    points = [case | {"accuracy": accuracy} for case in cases for accuracy in accuracies]
    runs = study.study(points, out, OPEN, LIMIT, "disc-block")
    last = range(len(accuracies) - 1, len(points), len(accuracies))
    block = load("disc-block")
    finer = [points[k] | scaled(block.override(OPEN | points[k]), read_scene(study.place(out, points[k])), 1 / FINER) if runs.exit[k] == 0
             else points[k] for k in last]
    references = study.study(finer, out / "finer", OPEN, LIMIT, "disc-block")
    rows = []
    for k, case in enumerate(cases):
        entries = [*runs.iloc[k * len(accuracies):(k + 1) * len(accuracies)].iterrows(), (None, references.iloc[k])]
        rows += [case | row(run, accuracy) for (_, run), accuracy in zip(entries, (*accuracies, REFERENCE))]
    return pd.DataFrame(rows).reindex(columns=[*CASES[0], "accuracy", "dofs", "steps", "seconds", *ANSWERS, "momentum",
                                               "energy drift", "message"])


def row(run: Mapping[str, Value], accuracy: float | str) -> dict:
    """The results of a run, and its change of momentum over the momentum of the disc before the
    impact."""
    if run["exit"] != 0:
        return {"accuracy": accuracy, "message": run["message"]}
    disc, block = (run["mass_1"], run["rebound_vy_1"]), (run["mass_2"], run["rebound_vy_2"])
    results = answers(disc, block, (run["vibration_energy_1"], run["vibration_energy_2"]), run["energy_initial"],
                      (run["thresholded_contact_time"], run["contact_time"]))
    missing = sum(mass * v for mass, v in (disc, block)) / (disc[0] * SPEED) + 1
    return {"accuracy": accuracy, "dofs": run["dofs"], "steps": run["steps"], "seconds": run["cpu_seconds"]} | results | {
        "momentum": abs(missing), "energy drift": run["energy_drift"], "message": ""}


def answers(disc: tuple[float, float], block: tuple[float, float], vibration: tuple[float, float], energy: float,
            times: tuple[float, float]) -> dict[str, float]:
    """Returns ANSWERS.

    `disc` and `block` are mass [kg/m] and velocity [m/s]; `vibration` holds their vibration
    energies and `energy` is the initial energy [J/m]; `times` are both contact times [s].
    """
    moves = [mass / 2 * v**2 for mass, v in (disc, block)]
    return dict(zip(ANSWERS, (disc[1], block[1], *(100 * part / energy for part in (*moves, *vibration)), *(1e3 * time for time in times))))


def ask_peer(cases: list[study.Point]) -> tuple[pd.DataFrame, str]:
    """Runs NGSolve (benchmarks/programs/ngsolve_two_bodies.py), one row for each case and
    refinement.

    Also returns the reason why NGSolve was not run, or "".
    """
    rows, reason = [], "none of its cases is among these" if not cases else ""
    for case, refine in in_turn("NGSolve", itertools.product(cases, REFINEMENTS)):
        output, reason = peers.two_bodies(LIMIT, refine=refine, speed=SPEED, **case)
        if not output:
            break
        bodies = [(output[f"mass_{body}"], output[f"velocity_{body}"]) for body in ("upper", "lower")]
        rows.append(case | {"refine": refine, "dofs": output["dofs"], "steps": output["steps"], "seconds": output["cpu_seconds"]
                            + output["setup_seconds"]}
                    | answers(*bodies, (output["vibration_upper"], output["vibration_lower"]), output["energy_start"],
                              (output["contact_time_1_percent"], output["contact_time"])))
    return pd.DataFrame(rows, columns=[*CASES[0], "refine", "dofs", "steps", "seconds", *ANSWERS]), reason


def violations(table: pd.DataFrame) -> list[str]:
    """A sentence for each check that a run fails. A check with a missing number fails."""
    sentences = []
    for _, run in table.iterrows():
        if run.message:
            sentences.append(f"{words(run)}: no answer: {run.message}")
            continue
        v_disc, v_block = run[list(VELOCITIES)]
        checks = {f"the block's velocity {v_block:.4f} m/s is not between {BLOCK[0]} and {BLOCK[1]}": BLOCK[0] < v_block < BLOCK[1],
                  f"the disc does not rebound: {v_disc:.4f} m/s": v_disc > 0,
                  f"momentum changes by {run.momentum:.1e}, more than {MOMENTUM:g}": run.momentum <= MOMENTUM,
                  f"energy drifts by {run['energy drift']:.1e}, not below {ENERGY:g}": run["energy drift"] < ENERGY}
        sentences += [f"{words(run)}: {sentence}" for sentence, holds in checks.items() if not holds]
    return sentences


def words(run: Mapping[str, Value]) -> str:
    """A case in words, with its accuracy if it has one."""
    which = run.get("accuracy")
    which = "" if which is None else f", {which}" if which == REFERENCE else f", accuracy {which:g}"
    return f"{run['law']}, nu {run['nu']:g}, k {run['penalty']:g} Pa/m{which}"


def differences(table: pd.DataFrame) -> pd.DataFrame:
    """The runs without the references.

    Each result is replaced by the distance from the reference of its case, in the unit of the
    result.
    """
    fine = table[table.accuracy == REFERENCE].set_index(list(CASES[0]))[list(ANSWERS)]
    rough = table[table.accuracy != REFERENCE].copy()
    index = pd.MultiIndex.from_frame(rough[list(CASES[0])])
    rough[list(ANSWERS)] = abs(rough[list(ANSWERS)].to_numpy() - fine.reindex(index).to_numpy())
    return rough


def with_bars(table: pd.DataFrame) -> pd.DataFrame:
    """A row for each case: the results of the reference and, as `<answer> bar`, their difference
    from the most accurate run."""
    fine = table[table.accuracy == REFERENCE].reset_index(drop=True)
    bars = differences(table).groupby(list(CASES[0]), sort=False).tail(1).reset_index(drop=True)
    return fine.assign(**{f"{answer} bar": bars[answer] for answer in ANSWERS})


def peer_with_bars(others: pd.DataFrame) -> pd.DataFrame:
    """A row for each case with both refinements: the finer results and, as `<answer> bar`, their
    difference from the coarser ones."""
    groups = [rows for _, rows in others.groupby(list(CASES[0]), sort=False) if len(rows) == len(REFINEMENTS)]
    return pd.DataFrame([{**rows.iloc[-1], **{f"{answer} bar": abs(rows[answer].iloc[-1] - rows[answer].iloc[0]) for answer in ANSWERS}}
                         for rows in groups])


def disagreements(ours: pd.DataFrame, theirs: pd.DataFrame) -> list[str]:
    """A sentence for each result in which the programs differ by more than the sum of both error
    bars.

    Both tables hold error bars, as with_bars() returns them.
    """
    sentences = []
    for _, other in theirs.iterrows():
        own = ours[(ours[list(CASES[0])] == other[list(CASES[0])]).all(axis=1)].iloc[0]
        sentences += [f"{words(other)}: {answer}: ours {bar(own, answer)}, NGSolve {bar(other, answer)}" for answer in ANSWERS
                      if not abs(own[answer] - other[answer]) <= own[f"{answer} bar"] + other[f"{answer} bar"]]
    return sentences


def bar(values: Mapping[str, Value], answer: str) -> str:
    """A result with its error bar, to two digits of the error bar."""
    value, error = values[answer], values[f"{answer} bar"]
    if pd.isna(error):
        return "" if pd.isna(value) else f"{value:.4g}"
    digits = min(8, max(0, 1 - int(f"{error:.1e}".split("e")[1]))) if error > 0 else 8
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def report(table: pd.DataFrame, others: pd.DataFrame, reason: str) -> str:
    """The report: results with error bars, errors beside processor seconds, NGSolve's results and
    the checks."""
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
    """The ranges of unknowns, steps and processor seconds of the runs."""
    return ", ".join(f"{runs[name].min():.0f} to {runs[name].max():.0f} {unit}" for name, unit in
                     (("dofs", "unknowns"), ("steps", "steps"), ("seconds", "processor seconds")))


def beside(table: pd.DataFrame, others: pd.DataFrame, reason: str, columns: dict, formats: dict, apart: list[str]) -> list[str]:
    """The lines about NGSolve: the reason why it was not run, or its results below ours and the
    differences `apart` that exceed the error bars."""
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
