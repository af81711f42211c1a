"""Seconds a step of the program and of the plain textbook script verification/peers/textbook.edp: same mesh, step and answers."""

import statistics
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from .. import run, scene
from ..freefem import freefem
from ..mesh import mesh
from ..failure import Failure
from ..input.parameters import whole
from ..places import shown
from ..progress import in_turn
from ..sweeps import study

DT = 2e-5                   # s
OURS = 3                    # runs of the program at least: they are short, and a busy neighbour shows
ASKED = 40                  # times as fast as the textbook
TEXTBOOK = "../verification/peers/textbook"


@dataclass(frozen=True)
class Case:
    """A mesh of half the disc, and how much of the impact both run on it [s]."""

    mesh_size: float
    end_time: float


CASES = (Case(4.4e-3, 5.2e-3),   # about 2,300 dofs
         Case(2.1e-3, 5.2e-3))   # about 9,000 dofs: the textbook takes some ten minutes
QUICK = (Case(1.25e-2, 2e-4),)


def main(argv: list[str]) -> int:
    """Times both, one process at a time, and prints them side by side; 0 if every ratio is at least ASKED."""
    parser = study.command("textbook", __doc__)
    parser.add_argument("--runs", metavar="N", type=whole, default=1, help="runs of each, of which the median counts")
    parser.add_argument("--small", action="store_true", help="the smaller mesh only: two minutes instead of twelve")
    parser.add_argument("--quick", action="store_true", help="a tiny case: a look at the table, not at the ratio")
    options = parser.parse_args(argv)
    out = options.out
    runs = max(1, options.runs)
    rows = pd.DataFrame([compare(case, out, runs) for case in in_turn("textbook", QUICK if options.quick else CASES[:1] if options.small else CASES)])
    study.save(rows, out / "textbook.csv")
    print(report(rows, runs))
    print(f"\n{shown(out)}/textbook.csv")
    return 0 if (rows.ratio >= ASKED).all() else 1


def compare(case: Case, out: Path, runs: int) -> dict:
    """A row: both programs on one mesh, their seconds a step (medians), answers and energy drifts."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"half-disc-{case.mesh_size:g}.msh"
    wanted = scene.load("disc-normal").override({"dt": DT, "end_time": case.end_time, "fields": 0})
    mesh.write(mesh.disc(wanted.values["radius"], case.mesh_size, case.mesh_size / 2, half=True), path)
    ours = [timed(wanted, out / "runs" / path.stem, path) for _ in range(max(runs, OURS))]
    theirs = [textbook(wanted, path) for _ in range(runs)]
    if theirs[0]["dofs"] != ours[0]["dofs"]:
        raise Failure(f"textbook: not the same problem: {ours[0]['dofs']} and {theirs[0]['dofs']} dofs")
    row = {"mesh_size": case.mesh_size, "end_time": case.end_time, "dofs": ours[0]["dofs"]}
    for name, results in (("ours", ours), ("textbook", theirs)):
        last = results[-1]
        seconds = statistics.median(_marching(result) / result["steps"] for result in results)
        row |= {f"steps_{name}": last["steps"], f"iterations_{name}": last["newton_iterations"],
                f"seconds_a_step_{name}": seconds, f"impulse_{name}": last["impulse"],
                f"rebound_vy_{name}": last["rebound_vy"], f"energy_drift_{name}": last["energy_drift"]}
    return row | {"ratio": row["seconds_a_step_textbook"] / row["seconds_a_step_ours"]}


def timed(wanted: scene.Scene, folder: Path, mesh_file: Path) -> dict:
    """The summary of a run of ours, made now."""
    return run.run(wanted, out=folder, mesh_file=mesh_file, force=True).summary


def _marching(result: dict) -> float:
    """Seconds without the set-up: meshes and operators, once a run."""
    return result["cpu_seconds"] - result.get("phase_seconds", {}).get("setup", 0)


def textbook(wanted: scene.Scene, mesh_file: Path) -> dict:
    """Runs the textbook script; what it prints, under the names of summary.json. Seconds: processor time without set-up."""
    program, log = freefem.find(), mesh_file.with_suffix(".log")
    flags = [text for name, value in wanted.values.items() for text in (f"-{name}", str(value))]
    code, _ = freefem.run(program, TEXTBOOK, [*flags, "-mesh", str(mesh_file)], log)
    said = log.read_text().strip().splitlines()
    words = said[-1].split() if said else []
    if code != 0 or words[:1] != ["textbook"]:
        raise Failure(f"textbook: the textbook script ended with exit code {code}; its output is in {shown(log)}")
    names = ("dofs", "steps", "newton_iterations", "cpu_seconds", "impulse", "rebound_vy", "contact_end", "energy_drift")
    return dict(zip(names, map(float, words[1:])))


def report(rows: pd.DataFrame, runs: int) -> str:
    """Both programs a mesh, the ratio, the difference of the answers, and the verdict."""
    lines = []
    for _, row in rows.iterrows():
        both = pd.DataFrame([{"program": name} | {key: row[f"{key}_{name}"] for key in (
            "steps", "iterations", "seconds_a_step", "impulse", "rebound_vy", "energy_drift")} for name in ("ours", "textbook")])
        lines += [f"{row.dofs:.0f} dofs, dt = {DT:g} s, the first {1e3 * row.end_time:g} ms",
                  study.table(both, {"program": "", "steps": ".0f", "iterations": ".0f", "seconds_a_step": ".5f", "impulse": ".8g",
                                     "rebound_vy": ".8g", "energy_drift": ".1e"}),
                  f"ratio {row.ratio:.1f}; the answers differ by {_off(row, 'impulse'):.1e} (impulse) and "
                  f"{_off(row, 'rebound_vy'):.1e} (velocity)\n"]
    lines.append(f"medians of {max(runs, OURS)} runs (ours) and {runs} (textbook), one process at a time, one thread, without "
                 f"set-up; processor time of FreeFem++\n"
                 f"the ratio is {'' if (rows.ratio >= ASKED).all() else 'NOT '}at least {ASKED} on every mesh")
    return "\n".join(lines)


def _off(row: pd.Series, answer: str) -> float:
    return abs(row[f"{answer}_ours"] / row[f"{answer}_textbook"] - 1)
