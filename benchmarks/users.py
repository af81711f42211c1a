"""Time and error of scenes as users write them, with automatic steps and with steps chosen by hand.

Each scene (benchmarks/scenes/) runs as it is, and again with `dt` and, where the mesh would be far
too fine, sizes given. Errors are relative to references, which --reference computes and stores in
users-references.csv. A second table varies the stiffness of a block under a soft disc.
"""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ffimpact import scene
from ffimpact.failure import Failure, TooLong, unknown
from ffimpact.freefem import freefem
from ffimpact.input.parameters import Value
from ffimpact.output import estimate
from ffimpact.output.results import Record, read_answers
from ffimpact.running import run
from ffimpact.scenes.finer import scaled
from ffimpact.sweeps import study
from verification import commands

from . import draws, page, peers

LIMIT = 300.0  # longest time of a run with those that estimate its error [s]
REFERENCES = Path(__file__).with_name("users-references.csv")
# Elements and steps by hand over those of the two references. With errors of order 2 their
# difference is the error of the finer one.
FINER = (2.0, estimate.COARSER)
AUTOMATIC, BY_HAND = "automatic", "by hand"
RATIO = "stiffness-ratio"  # name of the study of the disc on the block
RIGID = math.inf  # ratio of the disc on a rigid plane
OTHERS = ("ngsolve", "calculix")
Row = dict[str, str | float | None]


# ---- what users want to know

@dataclass(frozen=True)
class Answer:
    """A result of a scene.

    words: what it is, with its unit
    value: name of a number of the summary, or a function of the record
    stated: the entry of `estimated_error` that belongs to it; empty if there is none
    scale: what errors are relative to; None for the value itself
    """

    words: str
    value: str | Callable[[Record], float]
    stated: str = ""
    scale: float | None = None

    def of(self, record: Record) -> float:
        if callable(self.value):
            return self.value(record)
        number = record.summary[self.value]
        return math.nan if number is None else number


def speed(words: str, name: str, at_start: float) -> Answer:
    """A velocity after an impact at the speed `at_start` [m/s]."""
    return Answer(f"{words} [m/s]", name, "rebound", at_start)


def same(words: str, name: str) -> Answer:
    """A number of the summary whose error estimate has the same name."""
    return Answer(words, name, name)


def sag(record: Record) -> float:
    """The largest way of the centre of mass down [mm], by a parabola through the lowest steps."""
    history = record.history
    t, y = np.asarray(history["t"]), np.asarray(history["y"])
    k = int(np.clip(y.argmin(), 1, len(y) - 2))
    a, b, c = np.polyfit(t[k - 1 : k + 2] - t[k], y[k - 1 : k + 2], 2)
    return 1e3 * (y[0] - c + b**2 / (4 * a))


def half_period(record: Record) -> float:
    """The mean time between two passages of the beam through its rest position [ms], once the disc
    has left for good."""
    history = record.history
    t, y = np.asarray(history["t"]), np.asarray(history["y_2"])
    pressed = np.flatnonzero(np.asarray(history["normal_force"]) > 0)
    free = slice(pressed[-1] + 1, None)
    t, y = t[free], y[free]
    k = np.flatnonzero(y[:-1] * y[1:] < 0)
    passages = t[k] - y[k] * (t[k + 1] - t[k]) / (y[k + 1] - y[k])
    return 1e3 * np.diff(passages).mean() if len(passages) > 1 else math.nan


def mean_velocity(record: Record) -> float:
    """The velocity of the first body along x after the impact [m/s], mean until the end of the run,
    so that its vibration does not count."""
    history, end = record.history, record.summary["contact_start"] + record.summary["contact_time"]
    t, x = np.asarray(history["t"]), np.asarray(history["x_1"])
    return float((x[-1] - np.interp(end, t, x)) / (t[-1] - end))


def last_force(record: Record) -> float:
    """The normal force [N/m], mean over the last twentieth of the run."""
    history = record.history
    t, dt = np.asarray(history["t"]), np.asarray(history["dt"])
    late = t > 0.95 * t[-1]
    return float(np.average(np.asarray(history["normal_force"])[late], weights=dt[late]))


def first_peak(record: Record) -> float:
    """The largest force between the first two bodies [N]."""
    contacts = pd.read_csv(record.folder / "contacts.csv")
    first = contacts[(contacts.body == contacts.body.iloc[0]) & (contacts.partner == contacts.partner.iloc[0])]
    return float(first.peak_force.max())


# Flags of the scripts of other programs: entries of the scene and of its body.
ENTRIES, OF_BODY = ("dt", "end_time", "gravity"), ("law", "young", "nu", "density", "width", "height", "mesh_size")


@dataclass(frozen=True)
class Peer:
    """A scene in other programs (benchmarks/programs/PROGRAM_BODY.py).

    programs: those that have a script
    body: the second part of the name of the script
    answer: the number that it prints for the first answer of the scene
    more: further flags, from the scene as used by the run by hand
    without: flags that the script does not know
    """

    programs: tuple[str, ...]
    body: str
    answer: str
    more: Callable[[dict], dict] = lambda used: {}
    without: tuple[str, ...] = ()

    def flags(self, used: dict) -> dict:
        """The flags for a scene of one body: its mesh, step and penalty are those of the run."""
        flags = {name: used[name] for name in ENTRIES} | {name: used["body"][0][name] for name in OF_BODY}
        return {name: value for name, value in (flags | self.more(used)).items() if name not in self.without}


def falls(used: dict) -> dict:
    """The flags of a body that falls on a plane."""
    body = used["body"][0]
    return {"speed": -body["velocity"][1], "penalty": used["contact"]["pair"][0]["penalty"], "across": body["mesh_size"] * body["mesh_stretch"]}


@dataclass(frozen=True)
class Case:
    """A scene of benchmarks/scenes/.

    answers: what its user wants, the most important first
    by_hand: step and sizes that a user with experience would give
    entries: entries set in the scene
    peer: the same scene in other programs
    """

    scene: str
    answers: tuple[Answer, ...]
    by_hand: study.Point
    entries: study.Point = field(default_factory=dict)
    peer: Peer = Peer((), "", "")

    def open(self) -> scene.Scene:
        return scene.load(str(draws.OWN / f"{self.scene}.toml")).override(self.entries)


USERS = {case.scene: case for case in (
    Case("beam-rubber-disc", (speed("velocity of the disc", "final_vy_1", 3), Answer("half period of the beam [ms]", half_period)),
         {"dt": 4e-5}),
    Case("strip-gravity", (Answer("sag of the centre [mm]", sag),), {"dt": 4e-3}, peer=Peer(OTHERS, "strip", "sag")),
    Case("rod-flat", (same("impulse [N s/m]", "impulse"), same("contact time above 1 % [s]", "thresholded_contact_time")), {"dt": 2e-5},
         peer=Peer(("ngsolve",), "rod", "impulse", falls, ("end_time", "gravity"))),
    Case("weight-pad-plate", (same("peak force on a clamp [N/m]", "support_peak_1"), speed("velocity of the weight", "final_vy_1", 2)),
         {"dt": 2e-5, "contact.penalty": 5e10, "body.1.contact_mesh_size": 2e-3, "body.2.contact_mesh_size": 4e-3,
          "body.3.contact_mesh_size": 5e-3, "body.3.mesh_size": 5e-3}),
    Case("golf-club", (speed("velocity of the ball", "rebound_vy_1", 40), same("contact time above 1 % [s]", "thresholded_contact_time")),
         {"dt": 1e-5}),
    Case("ball-strings", (speed("velocity of the ball", "final_vy_1", 20),), {"dt": 1e-4}),
    Case("bumper-frame", (same("peak force on a post [N/m]", "support_peak_1"), speed("velocity of the vehicle", "final_vy_1", 0.6)),
         {"dt": 2e-5, "contact.penalty": 1e10, "body.2.contact_mesh_size": 8e-3, "body.2.mesh_size": 0.015,
          "body.3.contact_mesh_size": 0.01, "body.3.mesh_size": 0.01}),
    Case("gripper-finger", (Answer("gripping force [N/m]", last_force), same("peak force on the mount [N/m]", "support_peak_1")),
         {"dt": 1e-3, "contact.penalty": 1e10, "body.1.contact_mesh_size": 1e-3}),
    Case("ring-plates", (same("contact pressure [Pa]", "max_pressure"), same("force on both plates [N/m]", "peak_force")),
         {"dt": 3e-3, "contact.penalty": 1e11, "body.1.contact_mesh_size": 1e-3}),
    Case("tyre-step", (same("peak force [N/m]", "peak_force"),), {"dt": 2e-4}),
    Case("hammer-nail", (Answer("peak force on the nail [N]", first_peak), same("peak force on the support [N]", "support_peak_1")),
         {"dt": 1e-6}),
    Case("pendulum-pad", (Answer("mean velocity afterwards [m/s]", mean_velocity, scale=0.6734),
                          same("contact time above 1 % [s]", "thresholded_contact_time")), {"dt": 1e-4}),
    Case("seal-pressed", (same("contact pressure [Pa]", "max_pressure"), same("force on lid and groove [N]", "peak_force")),
         {"dt": 1e-3, "contact.penalty": 1e12, "body.1.contact_mesh_size": 2e-4}),
)}
ON_BLOCK = (same("impulse [N s/m]", "impulse"),)
# The disc on the block by the ratio of their Young's moduli.
RATIOS = {ratio: Case("disc-on-block", ON_BLOCK, {"dt": 5e-5}, {"body.2.young": ratio * 5e6}) for ratio in (1.0, 10.0, 1e2, 1e3, 1e4, 1e5)}
RATIOS[RIGID] = Case("disc-on-rigid", ON_BLOCK, {"dt": 5e-5})
CASES = USERS | {f"{RATIO}-{ratio:g}": case for ratio, case in RATIOS.items()}


def main(argv: list[str]) -> int:
    """Runs the scenes and writes users.csv and the page, or computes their references.

    Returns 0 if all runs with automatic steps have ended.
    """
    parser = commands.command("users", __doc__, page=True)
    names = [*USERS, RATIO]
    parser.add_argument("scenes", metavar="SCENE", nargs="*", default=names, help=f"(default: {' '.join(names)})")
    parser.add_argument("--limit", metavar="S", type=float, default=LIMIT, help=f"longest time of a run [s] (default: {LIMIT:g})")
    parser.add_argument("--reference", action="store_true", help=f"compute the references of the scenes, in {REFERENCES.name}")
    options = parser.parse_args(argv)
    for name in options.scenes:
        if name not in names:
            parser.error(unknown(name, names, ", "))
    freefem.find()  # builds the kernels if they are missing
    cases = {name: case for name, case in CASES.items()
             if name in options.scenes or RATIO in options.scenes and name.startswith(RATIO)}
    if options.reference:
        return refer(cases, options.out)
    rows = measure(cases, options.out, options.limit)
    shown, ratios = of_users(rows), of_ratios(rows)
    tables = {"": shown, "answers": rows[~rows.scene.str.startswith(RATIO)], "ratio": ratios}
    tables = {name: table for name, table in tables.items() if not table.empty}
    inline = [name for name in ("", "ratio") if name in tables]
    ended = rows[(rows.setting == AUTOMATIC) & (rows.message == "")].scene.nunique()
    text = "\n\n".join([*(page.markdown(tables[name]) for name in inline), verdict(rows, len(cases), ended)])
    return page.finish(options, rows, text, ended == len(cases), argv, "Scenes of users", tables, inline)


# ---- the measurement

def measure(cases: dict[str, Case], out: Path, limit: float) -> pd.DataFrame:
    """A row for each answer of each case with automatic steps and with those by hand."""
    acts = {(name, setting): partial(_rows, name, case, setting, out, limit)
            for name, case in cases.items() for setting in (AUTOMATIC, BY_HAND)}
    # One run at a time, in a thread of its own: those that estimate its error follow it.
    outcomes = dict(study.run_parallel(acts, 1, "users"))
    rows = []
    for (name, setting), outcome in ((key, outcomes[key]) for key in acts):
        rows += [{"scene": name, "setting": setting, "message": str(outcome)}] if isinstance(outcome, Failure) else outcome
    columns = ["scene", "setting", "unknowns", "steps", "seconds", "with estimate", "answer", "value", "stated %", "error %", "reference %",
               "warnings", *OTHERS, "message"]
    return pd.DataFrame(rows).reindex(columns=columns)


def _rows(name: str, case: Case, setting: str, out: Path, limit: float) -> list[Row]:
    """The rows of one run, one for each answer; a failed run has one row."""
    common: Row = {"scene": name, "setting": setting, "message": ""}
    try:
        with freefem.limited(limit):
            record = run.run(case.open(), case.by_hand if setting == BY_HAND else {}, out / f"{name}-{setting.replace(' ', '-')}", progress=False)
    except TooLong:
        return [common | {"message": f"no end after {limit:g} s"}]
    except Failure as failure:
        return [common | {"message": str(failure)}]
    summary, rows = record.summary, []
    common |= {"unknowns": summary["dofs"], "steps": summary["steps"], "seconds": summary["cpu_seconds"],
               "with estimate": summary["cpu_seconds"] + summary["estimate_cpu_seconds"], "warnings": len(summary["warnings"]),
               "message": ""}
    best = references()
    for answer in case.answers:
        value = answer.of(record)
        row = common | {"answer": answer.words, "value": value, "stated %": _percent((summary["estimated_error"] or {}).get(answer.stated))}
        if (name, answer.words) in best.index:
            reference = best.loc[(name, answer.words)]
            row |= {"error %": _error(answer, value, reference.value), "reference %": reference["bar %"]}
            if setting == BY_HAND and not rows:
                row |= {other: _other(other, case, record, reference.value, limit) for other in case.peer.programs}
        rows.append(row)
    return rows


def _percent(share: float | None) -> float | None:
    return None if share is None else 100 * share


def _error(answer: Answer, value: float, reference: float) -> float:
    """The error of an answer [%]."""
    return 100 * abs(value - reference) / (answer.scale or abs(reference))


def _other(program: str, case: Case, record: Record, reference: float, limit: float) -> str:
    """Processor time and error of the first answer in another program, with the step, penalty and
    element sizes of our run."""
    if not peers.find(program):
        return "not installed"
    flags = case.peer.flags(read_answers(record.folder).used)
    output, reason = peers.scripted(program, case.peer.body, limit, **flags)
    if output is None:
        return reason
    return f"{output['cpu_seconds']:.3g} s, {_error(case.answers[0], output[case.peer.answer], reference):.2g} %"


# ---- the references

def references() -> pd.DataFrame:
    """The stored references, by scene and answer; empty if there are none."""
    columns = ["scene", "answer", "value", "bar %", "unknowns", "steps", "seconds", "entries", "commit"]
    table = pd.read_csv(REFERENCES) if REFERENCES.exists() else pd.DataFrame(columns=columns)
    return table.set_index(["scene", "answer"])


def refer(cases: dict[str, Case], out: Path) -> int:
    """Computes the references of the cases and puts them in the place of the stored ones. Returns
    the exit code: 1 if a run failed."""
    acts = {name: partial(_reference, name, case, out / "references") for name, case in cases.items()}
    failed = []
    for name, outcome in study.run_parallel(acts, 1, "users"):
        if isinstance(outcome, Failure):
            failed.append(f"{name}: {outcome}")
            continue
        kept = references().reset_index()
        table = pd.concat([kept[kept.scene != name], pd.DataFrame(outcome)])
        order = {name: k for k, name in enumerate(CASES)}
        study.save(table.sort_values("scene", key=lambda names: names.map(order), kind="stable"), REFERENCES)
    print("\n".join([page.markdown(references().reset_index().drop(columns="entries")), *failed]))
    return 1 if failed else 0


def _reference(name: str, case: Case, out: Path) -> list[Row] | Failure:
    """The reference of each answer: elements and steps are FINER times smaller than those by hand.
    The bar is the difference of both references, which have the penalty of the run by hand."""
    opened = case.open().override(case.by_hand)

    def solve(entries: dict[str, Value], where: str) -> Record:
        return run.run(opened, entries | {"fields": 0}, out / name / where, estimate=False, progress=False)

    try:
        used = read_answers(solve({}, "hand").folder).used
        finer = [scaled(opened, used, 1 / factor) for factor in FINER]
        best, other = (solve(entries, f"finer-{factor:.3g}") for entries, factor in zip(finer, FINER))
    except Failure as failure:
        return failure
    words = json.dumps(case.entries | case.by_hand | _sizes(finer[0]))
    common = {"unknowns": best.summary["dofs"], "steps": best.summary["steps"], "seconds": best.summary["cpu_seconds"], "entries": words,
              "commit": run.commit(10)}
    values = [(answer, answer.of(best), answer.of(other)) for answer in case.answers]
    return [{"scene": name, "answer": answer.words, "value": value, "bar %": 100 * abs(value - beside) / (answer.scale or abs(value))} | common
            for answer, value, beside in values]


def _sizes(entries: dict) -> study.Point:
    """The steps, sizes and penalties among the entries of a scene."""
    return {name: float(f"{value:.6g}") for name, value in entries.items() if name == "dt" or name.endswith(("mesh_size", "contact.penalty"))}


# ---- evaluation of the rows

def of_users(rows: pd.DataFrame) -> pd.DataFrame:
    """The row of the first answer of each run of the users' scenes."""
    own = rows[~rows.scene.str.startswith(RATIO)]
    return own.drop_duplicates(["scene", "setting"])


def of_ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows of the disc on the block, with the ratio of Young's moduli."""
    own = rows[rows.scene.str.startswith(RATIO)]
    ratio = own.scene.str.removeprefix(f"{RATIO}-").astype(float)
    return own.assign(ratio=ratio)[["ratio", "setting", "unknowns", "steps", "seconds", "with estimate", "value", "stated %", "error %",
                                    "message"]]


def verdict(rows: pd.DataFrame, cases: int, ended: int) -> str:
    """The last paragraph: how many runs ended, whose errors are within the stated ones, and the
    time of automatic steps over that of steps by hand."""
    known = rows[["setting", "stated %", "error %", "reference %"]].dropna()
    within = known["error %"] <= known["stated %"] + known["reference %"]
    own = of_users(rows).pivot(index="scene", columns="setting", values="seconds")
    ratios = (own[AUTOMATIC] / own[BY_HAND]).dropna() if len(own) else pd.Series(dtype=float)
    return (f"{ended} of {cases} runs with automatic steps have ended; {within.sum()} of {len(known)} errors are within the stated ones"
            + (f"; automatic steps take {ratios.median():.2g} times as long as those by hand in the median, "
               f"{ratios.min():.2g} to {ratios.max():.2g} times" if len(ratios) else "") + ".")
