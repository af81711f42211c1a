"""Compares the statements of the paper with our numbers: results/paper/report.html, a
self-contained page.

It reads the results of the cases in results/ (`make paper` runs them first) and computes no other
numbers. Every verdict follows from the numbers by the criterion in the docstring of its statement.
A printed number of the paper is known to half a unit of its last digit.
"""

import argparse
import importlib
import os
import re
import shlex
import subprocess
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path

from ffimpact import scene
from ffimpact.__main__ import guarded
from ffimpact.failure import BadInput, Failure, Unreadable
from ffimpact.output.folder import result_folder
from ffimpact.places import RESULTS, ROOT, shown
from ffimpact.progress import Line
from ffimpact.sweeps import study, sweep
from verification import verify

# isort: off
from . import judging, scripts, stick_slip
# These modules register the statements in this order.
from . import limits, friction, impacts, pairs, bodies, times  # noqa: F401
# isort: on
from .page import COLOURS, page, verification

# The runs, and their figures on the page.
RUNS = {"disc-normal": ("force",), "disc-normal-neohookean": (), "disc-normal-incompressible": (),
        "disc-oblique": ("flight", "force", "energies"),
        "disc-oblique-svk": ("flight", "force", "rolling", "energies"), "disc-rolling": ("rolling",),
        "disc-block": ("velocity", "shapes", "energies"), "disc-block-neohookean": ("velocity",),
        "ball": ("shapes", "force"), "ball-axisymmetric": (), "ball-axisymmetric-svk": ("energies", "force")}
# The make target of a case, if it differs from its name.
TARGETS = {"disc-oblique-svk": "disc-oblique", "disc-block-neohookean": "disc-block", "ball-axisymmetric-svk": "ball-axisymmetric",
           "disc-normal-neohookean": "ball-comparison", "disc-normal-incompressible": "ball-comparison"}
# The approximate duration of each target on two cores [s], for the remaining time. Other targets
# take USUAL.
SECONDS = {"disc-normal": 3, "disc-oblique": 40, "disc-rolling": 10, "friction-laws": 3, "oblique": 36, "friction-jump": 6,
           "friction-steps": 11, "slip-limit": 6, "contact-time-svk": 90, "law-comparison": 6, "contact-time-neohookean": 90, "closest-points": 6,
           "calibrate": 115, "calibrate-oblique": 62, "calibrate-ball": 13, "calibrate-ball-3d": 27, "conservation": 8, "stick-slip": 70,
           "verify": 200, "paper-scripts": 600}
USUAL = 20


def main(argv: list[str]) -> int:
    """Writes the page. Raises Failure with a list of all cases that are missing or were made with
    other code."""
    parser = argparse.ArgumentParser(prog="python -m examples.paper", description=__doc__)
    parser.add_argument("--results", metavar="DIR", type=Path, default=RESULTS, help="where the cases are (default: results)")
    parser.add_argument("--make", metavar="TARGET", nargs="+", default=[], help="run these targets of make first")
    options = parser.parse_args(argv)
    if code := make(options.make):
        return code
    results = judging.Results(result_folder(options.results))
    require(results)
    findings = [(item, text, find(results)) for item, text, find in judging.STATEMENTS]
    target = results.folder / "paper/report.html"
    with study.complete(target) as part:
        part.write_text(page(findings, verification(results.folder / "verify")))
    for item, text, finding in findings:
        print(f"{item}: {text}\n    {finding.verdict.upper()}: {finding.ours}\n")
    print(", ".join(f"{sum(finding.verdict == verdict for *_, finding in findings)} {verdict}" for verdict in COLOURS))
    print(shown(target))
    return 0


def require(results: judging.Results) -> None:
    """Raises Failure with all make targets whose result is missing or comes from another scene or
    other code."""
    missing = dict.fromkeys(target for target, files, there in _needed(results) if not (all(file.exists() for file in files) and there()))
    if missing:
        raise Failure(f"paper: no results of the present scenes and code for {', '.join(missing)}; run: make {' '.join(missing)}   "
                      "(or: make paper)", code=Unreadable.code)


def _needed(results: judging.Results) -> Iterator[tuple[str, list[Path], Callable[[], bool]]]:
    """The results that the statements read: (target, files, a function that tests whether its runs
    exist)."""
    for name, pictures in RUNS.items():
        runs = [(results.run(name), scene.load(name))]
        yield TARGETS.get(name, name), results.drawn(*(f"{name}/{picture}" for picture in pictures)), partial(_hold, runs)
    yield "ball-comparison", results.drawn(bodies.ACCELERATIONS, bodies.LIKE_FOR_LIKE), lambda: True
    for name in sweep.built_in():
        plan = judging.loaded(name)
        yield name, results.drawn(name), partial(_hold, _runs(results.sweep(name), scene.load(plan.scene), plan.base, plan.runs))
    place = results.folder / "stick-slip"
    yield ("stick-slip", [place / "stick-slip.csv", place / "stick-slip.png"],
           partial(_hold, _runs(place, scene.load(stick_slip.SCENE), stick_slip.BASE, stick_slip.grid(stick_slip.AXES))))
    laws = [ROOT / "edp/paper/friction.idp", ROOT / "edp/friction-laws.edp"]
    drawn = [results.folder / "friction-laws" / name for name in ("laws.csv", "friction-laws.png")]
    yield "friction-laws", drawn, lambda: all(made.stat().st_mtime >= law.stat().st_mtime for made in drawn for law in laws)
    own = results.folder / scripts.FOLDER
    yield "paper-scripts", [own / scripts.FIGURE], lambda: all(scripts.is_finished(own / name, script) for name, (script, _) in scripts.runs().items())
    yield "verify", [], lambda: verify.is_finished(results.folder / "verify")


def _runs(folder: Path, problem: scene.Scene, base: study.Point, points: list[study.Point]) -> Iterator[tuple[Path, scene.Scene]]:
    """The runs of a study in a folder, each with its scene."""
    return ((study.place(folder, point), problem.override(base | point)) for point in points)


def _hold(runs: Iterable[tuple[Path, scene.Scene]]) -> bool:
    """Whether every folder holds the result of its scene, computed with the present code."""
    return all(study.find_finished(folder, problem) for folder, problem in runs)


# ---- running the cases

def make(targets: list[str]) -> int:
    """Runs the commands that make would run for each target, one at a time in this process, with
    one progress line.

    Returns the exit code of the first that fails, else 0.
    """
    recipes = {target: commands(target) for target in targets}
    with Line("paper", {target: SECONDS.get(target, USUAL) for target in targets}) as line:
        for k, (target, recipe) in enumerate(recipes.items(), 1):
            with line.part(target, f"{k} of {len(recipes)}"):
                for words in recipe:
                    if code := called(*words):
                        return code
    return 0


def commands(target: str) -> list[tuple[str, list[str]]]:
    """The module and the arguments of `python -m MODULE` in each line of the recipe of a target.

    Raises BadInput for a target that does not run the program.
    """
    plain = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    output = subprocess.run(["make", "-n", "-s", target, "ARGS="], cwd=ROOT, env=plain, capture_output=True, text=True).stdout
    recipe = re.findall(r" -m ([\w.]+) ?(.*)$", output, re.MULTILINE)
    if not recipe:
        raise BadInput(f"--make: '{target}' is no target that runs the program (accepted: see make)")
    return [(module, shlex.split(line)) for module, line in recipe]


def called(module: str, words: list[str]) -> int:
    """Runs `python -m MODULE` in this process and returns its exit code."""
    program = importlib.import_module(module)
    if hasattr(program, "__path__"):
        program = importlib.import_module(f"{module}.__main__")
    return guarded(program.execute if module == "ffimpact" else program.main, words)
