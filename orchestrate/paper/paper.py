"""The paper's statements beside this program's numbers: results/paper/report.html, one self-contained page.

Reads what the cases left in results/ (`make paper` makes them first) and computes no number that is not in them. Every verdict
follows from the numbers by the rule written at its statement; a printed number of the paper counts as known to half a unit of
its last digit.
"""

import argparse
from collections.abc import Iterable
from pathlib import Path

from verification import verify

from .. import scene
from ..failure import Failure, Unreadable
from ..output.folder import result_folder
from ..places import COMMAND, RESULTS, ROOT, shown
from . import stick_slip
from ..sweeps import study
from ..sweeps import sweep
from . import judging, making
from . import limits, friction, impacts, pairs, bodies, times   # noqa: F401: these register the statements, in this order
from .page import COLOURS, page, verification

# the runs, and the pictures of them on the page
RUNS = {"disc-normal": ("force",), "disc-normal-neohookean": (), "disc-normal-incompressible": (),
        "disc-oblique": ("flight", "force", "energies"),
        "disc-oblique-svk": ("flight", "force", "rolling", "energies"), "disc-rolling": ("rolling",),
        "disc-block": ("velocity", "shapes", "energies"), "disc-block-neohookean": ("velocity",),
        "ball": ("shapes", "force"), "ball-axisymmetric": (), "ball-axisymmetric-svk": ("energies", "force")}
# the make target of a case, where it is not its own name
TARGETS = {"disc-oblique-svk": "disc-oblique", "disc-block-neohookean": "disc-block", "ball-axisymmetric-svk": "ball-axisymmetric",
           "disc-normal-neohookean": "ball-comparison", "disc-normal-incompressible": "ball-comparison"}


def main(argv: list[str]) -> int:
    """Writes the page; Failure that lists every case that is missing or was made with other code."""
    parser = argparse.ArgumentParser(prog=f"{COMMAND} paper", description=__doc__)
    parser.add_argument("--results", metavar="DIR", type=Path, default=RESULTS, help="where the cases are (default: results)")
    parser.add_argument("--make", metavar="TARGET", nargs="+", default=[], help="run these targets of make first")
    options = parser.parse_args(argv)
    if code := making.make(options.make):
        return code
    results = judging.Results(result_folder(options.results))
    require(results)
    findings = [(item, text, find(results)) for item, text, find in judging.STATEMENTS]
    target = results.folder / "paper/report.html"
    with study.complete(target) as part:
        part.write_text(page(findings, verification(results.folder / "verify")))
    for item, text, found in findings:
        print(f"{item}: {text}\n    {found.verdict.upper()}: {found.ours}\n")
    print(", ".join(f"{sum(found.verdict == verdict for *_, found in findings)} {verdict}" for verdict in COLOURS))
    print(shown(target))
    return 0


def require(results: judging.Results) -> None:
    """Failure with one line that names every make target whose result is missing, or of another scene or other code."""
    missing = dict.fromkeys([*_cases(results), *_sweeps(results), *_others(results)])
    if missing:
        raise Failure(f"paper: no results of the present scenes and code for {', '.join(missing)}; run: make {' '.join(missing)}   "
                      "(or: make paper)", Unreadable("").code)


def _cases(results: judging.Results) -> list[str]:
    """The targets of the runs that are not there."""
    missing = [TARGETS.get(name, name) for name, pictures in RUNS.items() if not _holds([(results.run(name), scene.load(name))])
               or not all(results.picture(name, picture).exists() for picture in pictures)]
    return missing + ["ball-comparison"] * (not all((results.folder / drawn).exists()
                                                    for drawn in (bodies.ACCELERATIONS, bodies.LIKE_FOR_LIKE)))


def _sweeps(results: judging.Results) -> list[str]:
    """The sweeps that are not there."""
    missing = []
    for name in sweep.built_in():
        wanted = sweep.load(name)
        given = scene.load(wanted.scene)
        runs = [(study.place(results.sweep(name), point), given.override(wanted.base | point)) for point in wanted.runs]
        if not all(picture.exists() for picture in results.drawn(name)) or not _holds(runs):
            missing.append(name)
    return missing


def _others(results: judging.Results) -> list[str]:
    """Which of the search for sliding and sticking, the friction laws and the verification are not there."""
    place, base = results.folder / "stick-slip", scene.load(stick_slip.SCENE)
    runs = [(study.place(place, point), base.override(stick_slip.BASE | point)) for point in stick_slip.grid(stick_slip.AXES)]
    laws = [ROOT / "edp/core/contact/friction.idp", ROOT / "edp/friction-laws.edp"]
    drawn = [results.folder / f"friction-laws/{name}" for name in ("laws.csv", "friction-laws.png")]
    there = {"stick-slip": all((place / f"stick-slip.{kind}").exists() for kind in ("csv", "png")) and _holds(runs),
             "friction-laws": all(made.exists() and all(made.stat().st_mtime >= law.stat().st_mtime for law in laws) for made in drawn),
             "verify": verify.there(results.folder / "verify")}
    return [name for name, found in there.items() if not found]


def _holds(runs: Iterable[tuple[Path, scene.Scene]]) -> bool:
    """Whether every folder holds the outcome of its scene, by the present code."""
    return all(study.there(folder, wanted) for folder, wanted in runs)
