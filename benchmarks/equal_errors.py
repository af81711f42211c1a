"""Run times of several programs at equal errors.

This program and, where they are installed (peers.py), NGSolve and GetFEM solve five impacts with
coarse to fine settings. The tables hold the processor seconds of the time integration and of the
whole process for errors of 1, 0.5 and 0.1 %.
"""

import itertools
import math
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from ffimpact.failure import unknown
from ffimpact.freefem import freefem
from ffimpact.input.parameters import Value
from ffimpact.places import shown
from ffimpact.progress import in_turn
from ffimpact.sweeps import study
from verification import commands

from . import page, peers

LEVELS = (1.0, 0.5, 0.1)  # error levels of the tables [%]
LIMIT = 1200.0  # longest time of a run [s]
# A setting runs REPEATS times and the least times count. It runs once if it takes longer than
# LONG [s].
REPEATS, LONG = 3, 2.0
# Tolerance of Newton's method of the other programs: work of the residual over the energy. With
# 5e-12 the results change by 1e-5 and the run time grows by a quarter.
TOLERANCE = 1e-8
SECONDS = {"imports_seconds": "imports", "setup_seconds": "set-up", "cpu_seconds": "march", "process_seconds": "process"}
OURS, EXPLICIT, TUNED, USUAL = "ffimpact", "ffimpact, explicit", "ngsolve, tuned", "ngsolve, as written by users"
OWN = (OURS, EXPLICIT)
GETFEM, GETFEM_USUAL = "getfem, tuned", "getfem, as written by users"
Found = dict[str, Any]
Measured = dict[str, float]  # results of a run by name


@dataclass(frozen=True)
class Case:
    """An impact that all programs solve.

    title: heading; scene: built-in scene; entries: entries set in it; speed: impact speed [m/s]
    answers: for each result, its name in our output, its name in theirs, and the value to which its
        error is relative (None: the result itself)
    settings: settings by program, from coarse to fine
    finest: by program, two finer settings. With the last entry of `settings` they give the
        reference and its error bar. Mesh and steps of the finest differ from both others, so that
        the error bar contains both errors.
    theirs: further flags of the other programs
    """

    title: str
    scene: str
    entries: study.Point
    speed: float
    answers: dict[str, tuple[str, str, float | None]]
    settings: dict[str, list]
    finest: dict[str, list]
    theirs: study.Point = field(default_factory=dict)


def accuracies(*values: float, **entries: Value) -> list[study.Point]:
    return [{"accuracy": value} | entries for value in values]


def sizes(*pairs: tuple[float, float]) -> list[study.Point]:
    """Settings from pairs of a factor of the sizes in peers.sized() and a step [s]."""
    return [peers.sized(factor, dt=dt) for factor, dt in pairs]


def body(speed: float) -> dict[str, tuple[str, str, float | None]]:
    return {"impulse": ("impulse", "impulse", None), "vy": ("rebound_vy", "rebound_vy", speed)}


IN_PARTS = accuracies(0.05, 0.01, 0.005, 0.0025, 0.00125, integrator="central-difference")
# Moment of inertia over radius, I/R, of a disc with the density of the scenes, per thickness: the
# angular momentum over the speed of the rim [kg].
RIM = math.pi * peers.RADIUS**3 * 1722 / 2
CASES = {
    "normal": Case(
        "Disc, normal impact, St. Venant-Kirchhoff, 8 m/s", "disc-normal", {"law": "svk"}, 8.0, body(8.0),
        {OURS: accuracies(0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125),
         EXPLICIT: IN_PARTS, TUNED: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (1, 1e-4), (1, 5e-5), (1, 2e-5)),
         USUAL: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (1, 1e-4), (1, 5e-5)),
         GETFEM: sizes((2, 1.5e-4), (1, 1e-4), (1, 5e-5), (1, 2e-5)), GETFEM_USUAL: sizes((2, 1.5e-4), (1, 1e-4))},
        {OURS: accuracies(0.0003, 0.00015), TUNED: sizes((0.7, 1e-5), (0.5, 7e-6))}),
    "oblique": Case(
        "Disc, oblique impact with static and dynamic friction, neo-Hookean, 12 m/s at 60 degrees", "disc-oblique",
        {"law": "neohookean"}, 12.0,
        body(12.0) | {"vx": ("rebound_vx", "rebound_vx", 12.0), "spin": ("angular_momentum", "angular_momentum", 12.0 * RIM)},
        {OURS: accuracies(0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125, 0.0006),
         EXPLICIT: IN_PARTS, TUNED: sizes((3, 1.5e-4), (2, 1e-4), (2, 5e-5), (1, 5e-5), (1, 3e-5), (1, 2e-5)),
         USUAL: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (2, 5e-5))},
        {OURS: accuracies(0.0003, 0.00015), TUNED: sizes((1, 5e-6), (0.6, 3.75e-6))}, {"speed": 12.0}),
    "block": Case(
        "Disc on a free block, St. Venant-Kirchhoff, 10 m/s", "disc-block", {"law": "svk", "penalty": 1e9}, 10.0,
        {"impulse": ("impulse", "impulse", None), "vy disc": ("rebound_vy_1", "velocity_upper", 10.0),
         "vy block": ("rebound_vy_2", "velocity_lower", 10.0)},
        {OURS: accuracies(0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125), EXPLICIT: IN_PARTS,
         TUNED: [{"refine": value} for value in (0.15, 0.25, 0.5, 0.75)],
         USUAL: [{"refine": value, "contact": "ngsolve"} for value in (0.25, 0.5, 0.75)]},
        {OURS: accuracies(0.0006, 0.0004), TUNED: [{"refine": 1.0}, {"refine": 1.25}]}),
    "ball": Case(
        "Ball of revolution, normal impact, neo-Hookean, 8 m/s", "ball-axisymmetric",
        {"law": "neohookean", "nu": 0.45, "speed": 8.0, "penalty": 1.5e10}, 8.0,
        body(8.0),
        {OURS: accuracies(0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125),
         EXPLICIT: IN_PARTS, TUNED: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (1, 1e-4), (1, 5e-5), (1, 2e-5)),
         USUAL: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (1, 1e-4), (1, 5e-5))},
        {OURS: accuracies(0.0006, 0.0003), TUNED: sizes((0.7, 1e-5), (0.5, 7e-6))}),
    "rubber": Case(
        "Disc of rubber, nu = 0.499, normal impact, neo-Hookean, 4 m/s", "disc-normal",
        {"law": "neohookean", "nu": 0.499, "speed": 4.0}, 4.0, body(4.0),
        {OURS: accuracies(0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125),
         TUNED: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4), (1, 1e-4), (1, 5e-5)), USUAL: sizes((3, 1.5e-4), (2, 1.5e-4), (2, 1e-4))},
        {OURS: accuracies(0.0006, 0.0003), TUNED: sizes((0.7, 2e-5), (0.5, 1.4e-5))}),
}

HEAD = """Processor time, user and system, in seconds on one thread: march / whole process. The march is the time steps alone: of
FreeFem++ from its first step on, of the peers their loop. The whole process is all that a script of a user costs: imports,
mesh, set-up, of ours also FreeFem++ that Python starts. Least of {repeats} runs, of one where it takes above {long:g} s; our
runs make no estimate of their error.

A setting has a level where it and all finer ones of its program are below it in all answers: being below it by chance does
not count. Errors are those of the impulse relative to itself, of velocities to that of the impact, of the spin as the speed
of the rim (angular momentum over I/R) to it, and against our finest run. NGSolve's finest has to agree with it within both
error bars: what the finest run of a program differs by from its two next ones, which have other elements and other steps.

NGSolve, tuned: energy-momentum step, sparse Cholesky factorisation kept as long as it serves, contact on the arc alone, with
friction on a dense compliance of the few unknowns that touch; on the block central differences with contact by hand; of rubber
plain elements, where ours project the volume. As written by users: one form, Newton's method with UMFPACK, with friction damped
and mu by the velocity of the step before; on the block NGSolve's own ContactBoundary. Explicit: ours with central differences,
beside our default step, which alone is compared with others."""


def main(argv: list[str]) -> int:
    """Runs all cases and writes equal-errors.csv and the page.

    Returns 0 if all references agree, 1 if they do not or if NGSolve is missing.
    """
    parser = commands.command("equal-errors", __doc__, page=True)
    parser.add_argument("cases", metavar="CASE", nargs="*", default=list(CASES), help=f"(default: {' '.join(CASES)})")
    options = parser.parse_args(argv)
    for name in options.cases:
        if name not in CASES:
            parser.error(unknown(name, CASES, ", "))
    # Builds the kernels if they are missing, so that no measured time includes it.
    freefem.find()
    tables, references, texts, agreed, ratios = [], [], [], {}, {}
    for name in in_turn("equal-errors", options.cases):
        rows, reference = measure(CASES[name])
        tables.append(rows.assign(case=name))
        references.append(reference.assign(case=name))
        texts.append(text(CASES[name], rows, reference))
        agreed[name], ratios[name] = not reference.empty and bool(reference.agree.all()), beside(rows)
    study.save(pd.concat(tables), options.out / "equal-errors.csv")
    report = "\n\n".join([HEAD.format(repeats=REPEATS, long=LONG), *texts, verdict(agreed, ratios)])
    print(report + f"\n\n{shown(options.out)}/equal-errors.csv")
    page.write(options.page, "Run time at equal errors", ["equal-errors", *argv],
               verdict(agreed, ratios).partition(" The quickest other")[0],
               in_files(tables, references, ratios), ["ratios"])
    return 0 if all(agreed.values()) else 1



def in_files(tables: list[pd.DataFrame], references: list[pd.DataFrame],
             ratios: dict[str, dict[float, tuple[float, float]]]) -> page.Tables:
    """The tables of the page.

    They hold all settings, the cheapest setting of each program for each level, the time of the
    fastest other program over ours, and the references.
    """
    rows = pd.concat(tables).rename(columns=SECONDS)
    first = ["case", "program", "setting", "dofs", "steps", *SECONDS.values()]
    answers = [name for name in rows if name.endswith(" %")]
    best = []
    for table in tables:
        for program, level in itertools.product(table.program.unique(), LEVELS):
            if (row := safe(table, program, level)) is not None:
                best.append({"case": table["case"].iloc[0], "program": program, "level %": level,
                             "march": row.cpu_seconds, "process": row.process_seconds, "setting": row.setting})
    quicker = []
    for name, levels in ratios.items():
        row = {"case": name}
        for level, (march, process) in levels.items():
            row |= {f"{level:g} %, march": march, f"{level:g} %, process": process}
        quicker.append(row)
    files = {"": rows.reindex(columns=[*first, *answers, "error", "message"]),
             "levels": pd.DataFrame(best), "ratios": pd.DataFrame(quicker)}
    agreeing = pd.concat(references)
    if agreeing.empty:
        return files
    return files | {"references": agreeing[["case", *agreeing.columns.drop("case")]]}


# ---- the measurement

def measure(case: Case) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Runs a case. Returns the table of settings and the table of references.

    A setting has program, words, seconds and errors [%]. A reference has its values, error bars [%]
    and whether they agree. Raises study.Failure if our reference run fails.
    """
    outputs, rows = {}, []
    for program, points in case.settings.items():
        for point in points:
            got, reason = least(case, program, point)
            outputs[program, words(point)] = got
            rows.append({"program": program, "setting": words(point), "exit": int(got is None), "message": reason})
            if "not installed" in reason:
                break
    fine = {}
    for program, points in case.finest.items():
        runs = [outputs.get((program, words(case.settings[program][-1])))]
        runs += [runs[0] and once(case, program, point)[0] for point in points]
        fine[program] = [answers(case, program, output) for output in runs]
    if None in fine[OURS]:
        raise study.Failure(f"equal-errors: the reference of {case.title} failed", code=11)
    for row in rows:
        if of_it := outputs[row["program"], row["setting"]]:
            row |= {name: of_it[name] for name in ("dofs", "steps", *SECONDS)}
            row |= errors(case, answers(case, row["program"], of_it), fine[OURS][-1])
    return pd.DataFrame(rows), compare(case, fine)


def once(case: Case, program: str, point: study.Point) -> tuple[Found | None, str]:
    """The output of a program at a setting, and the reason if there is none."""
    if program in OWN:
        return peers.ours(LIMIT, case.scene, fields=0, **case.entries, **point)
    if case.scene == "disc-block":
        return peers.two_bodies(LIMIT, **case.entries, **point)
    form = "plain" if program in (USUAL, GETFEM_USUAL) else "tuned"
    return peers.run(program.split(",")[0], form, limit=LIMIT, scene=case.scene, tolerance=TOLERANCE,
                     **case.entries, **case.theirs, **point)


def least(case: Case, program: str, point: study.Point) -> tuple[Found | None, str]:
    """As once(), with the least times of REPEATS runs, or of one run if it takes longer than LONG.
    """
    output, reason = once(case, program, point)
    for _ in range(REPEATS - 1 if output and output["process_seconds"] <= LONG else 0):
        again, _ = once(case, program, point)
        output |= {name: min(output[name], again[name]) for name in SECONDS}
    return output, reason


def answers(case: Case, program: str, output: Found | None) -> Measured | None:
    """The results by name from the output of a program."""
    return output and {answer: output[ours if program in OWN else theirs] for answer, (ours, theirs, _) in case.answers.items()}


def errors(case: Case, measured: Measured, reference: Measured) -> dict[str, float]:
    """The error [%] of each result, and the largest of them."""
    percentages = {f"{answer} %": 100 * abs(measured[answer] - reference[answer]) / (unit or abs(reference[answer]))
                   for answer, (*_, unit) in case.answers.items()}
    return percentages | {"error": max(percentages.values())}


def compare(case: Case, fine: dict[str, list[Measured | None]]) -> pd.DataFrame:
    """A row for each result: both references, their error bars [%], their difference [%] and
    whether it is within the sum of the error bars.

    An error bar is the largest difference of a program's finest run from its two other fine runs.
    The table is empty if NGSolve has no results.
    """
    if None in fine[TUNED]:
        return pd.DataFrame()
    bars = {program: max(errors(case, run, finest)["error"] for run in runs) for program, (*runs, finest) in fine.items()}
    apart = errors(case, fine[TUNED][-1], fine[OURS][-1])
    return pd.DataFrame([{"answer": answer, OURS: fine[OURS][-1][answer], "its bar %": bars[OURS], "ngsolve": fine[TUNED][-1][answer],
                          "bar %": bars[TUNED], "apart %": apart[f"{answer} %"], "agree": apart[f"{answer} %"] <= bars[OURS] + bars[TUNED]}
                         for answer in case.answers])


def words(point: study.Point) -> str:
    """A setting in words; sizes in mm, steps in microseconds."""
    if "mesh_size" in point:
        return f"h {1e3 * point['mesh_size']:g} mm, dt {1e6 * point['dt']:g} us"
    return ", ".join(f"{name} {value}" for name, value in point.items() if name not in ("contact", "integrator"))


# ---- evaluation of the rows

def safe(rows: pd.DataFrame, program: str, level: float) -> pd.Series | None:
    """The row with the cheapest whole process among the settings of a program that are safe.

    A setting is safe if it and all finer ones satisfy the level. Returns None if there is none.
    """
    own = rows[rows.program == program]
    kept = own[(own.exit == 0) & (own.error <= level)] if "error" in own else own[:0]
    broken = own.index.difference(kept.index)
    kept = kept[kept.index > broken.max()] if len(broken) else kept
    return None if kept.empty else kept.loc[kept.process_seconds.idxmin()]


def beside(rows: pd.DataFrame) -> dict[float, tuple[float, float]]:
    """The least time of all other programs over ours by level: of the time integration and of the
    whole process.

    The ratio is nan if our program or all others do not reach the level.
    """
    ratios = {}
    for level in LEVELS:
        ours = safe(rows, OURS, level)
        theirs = [best for program in rows.program.unique() if program not in OWN and (best := safe(rows, program, level)) is not None]
        ratios[level] = tuple(min((best[name] for best in theirs), default=math.nan) / (math.nan if ours is None else ours[name])
                              for name in ("cpu_seconds", "process_seconds"))
    return ratios


def verdict(agreed: dict[str, bool], ratios: dict[str, dict[float, tuple[float, float]]]) -> str:
    """The last paragraph: agreement of the references and the fastest program."""
    without = [name for name, agrees in agreed.items() if not agrees]
    pairs = [pair for levels in ratios.values() for pair in levels.values() if not math.isnan(pair[0])]
    quicker = [sum(pair[which] > 1 for pair in pairs) for which in (0, 1)]
    details = "; ".join(f"{name} " + ", ".join(f"{level:g} %: " + ("-" if math.isnan(march) else f"{march:.1f} / {process:.1f}")
                                               for level, (march, process) in levels.items()) for name, levels in ratios.items())
    return (f"The references of both programs agree within their bars in {len(agreed) - len(without)} of {len(agreed)} cases"
            + f" (not: {', '.join(without)})" * bool(without)
            + f". Our time integration is the quickest in {quicker[0]} of {len(pairs)} comparisons, our whole process "
            f"in {quicker[1]}. The quickest other over ours, march / process: {details}.")


def text(case: Case, rows: pd.DataFrame, reference: pd.DataFrame) -> str:
    """A case as Markdown: run times, references and all settings."""
    ran = rows[rows.exit == 0]
    levels = pd.DataFrame([{"march / process [s]": program} | {f"{level:g} %": cell(safe(rows, program, level)) for level in LEVELS}
                           for program in ran.program.unique()])
    parts = [f"## {case.title}", study.table(levels, dict.fromkeys(levels, ""))]
    if not reference.empty:
        bar = reference[["its bar %", "bar %"]].max(axis=None)
        parts += ["References:" if bar <= min(LEVELS) else f"References, whose bars say that errors below {bar:.2g} % are not known:",
                  study.table(reference, {"answer": "", OURS: ".6g", "its bar %": ".3f",
                                          "ngsolve": ".6g", "bar %": ".3f", "apart %": ".3f", "agree": ""})]
    formats = {"program": "", "setting": "", "dofs": ".0f", "steps": ".0f"} | dict.fromkeys(SECONDS.values(), ".2f")
    parts += ["All settings, seconds and errors:",
              study.table(ran.rename(columns=SECONDS), formats | {f"{answer} %": ".3f" for answer in case.answers})]
    missing = [f"- {row.program}, {row.setting}: {row.message}" for row in rows[rows.exit != 0].itertuples()]
    return "\n\n".join(parts + ["\n".join(missing)] * bool(missing))


def cell(best: pd.Series | None) -> str:
    return "none" if best is None else f"{best.cpu_seconds:.2f} / {best.process_seconds:.2f} ({best.setting})"
