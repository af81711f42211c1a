"""The paper's statements beside this program's numbers: results/paper/report.html, one self-contained page.

Reads what the cases left in results/ (`make paper` makes them first) and computes no number that is not in them. Every verdict
follows from the numbers by the rule written at its statement; a printed number of the paper counts as known to half a unit of
its last digit.
"""

import argparse
import base64
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from html import escape
from pathlib import Path

import numpy as np
import pandas as pd

from .. import parameters, scene, verify
from ..failure import Failure, Unreadable
from ..folder import result_folder
from ..parameters import ROOT, Value
from ..places import shown
from ..results import read_history, read_scene, read_summary
from ..studies import stick_slip, study
from ..sweeps import sweep, sweep_figures

AGREES, DIFFERS, PARTLY, OPEN = "agrees", "does not agree", "partly", "not yet in this program"
COLOURS = {AGREES: "#009e73", DIFFERS: "#d55e00", PARTLY: "#b8860b", OPEN: "#777777"}
RUNS = {"disc-normal": ("energies",), "disc-oblique": ("flight", "force", "rolling", "energies"), "disc-oblique-svk": ("force",),
        "disc-rolling": ("rolling",), "disc-block": ("velocity", "shapes", "energies"),
        "disc-block-neohookean": ("velocity", "energies"), "ball-axisymmetric": ("energies", "force", "shapes"), "ball-axisymmetric-svk": ("force",)}   # and the pictures of them on the page
TARGETS = {"disc-oblique-svk": "disc-oblique", "disc-block-neohookean": "disc-block", "ball-axisymmetric-svk": "ball-axisymmetric"}   # the make target of a case, where it is not its own name
BLOCK = {"disc-block": "SVK", "disc-block-neohookean": "neo-Hookean"}   # section 3.2: the paper's law, and the other beside it
OUTSIDE = 1e-9              # of the energy at the start: below, an energy is constant
MOMENTUM = 1e-8             # of the disc's momentum: below, that of both bodies is kept


@dataclass(frozen=True)
class Finding:
    """What we found: the verdict, our number in words, the pictures, and the folders of the runs it rests on."""

    verdict: str
    ours: str
    figures: list[Path] = field(default_factory=list)
    runs: list[Path] = field(default_factory=list)


def main(argv: list[str]) -> int:
    """Writes the page; Failure that lists every case that is missing or was made with other code."""
    parser = argparse.ArgumentParser(prog="python -m orchestrate paper", description=__doc__)
    parser.add_argument("--results", metavar="DIR", type=Path, default=ROOT / "results", help="where the cases are (default: results)")
    options = parser.parse_args(argv)
    results = Results(result_folder(options.results))
    results.require()
    findings = [(item, text, find(results)) for item, text, find in STATEMENTS]
    target = results.folder / "paper/report.html"
    with study.complete(target) as part:
        part.write_text(page(findings, verification(results.folder / "verify")))
    for item, text, found in findings:
        print(f"{item}: {text}\n    {found.verdict.upper()}: {found.ours}\n")
    print(", ".join(f"{sum(found.verdict == verdict for *_, found in findings)} {verdict}" for verdict in COLOURS))
    print(shown(target))
    return 0


class Results:
    """The finished cases in a folder of results."""

    def __init__(self, folder: Path):
        self.folder = folder

    def run(self, name: str) -> Path:
        """The folder of a run."""
        return self.folder / name

    def summary(self, name: str) -> dict:
        """The summary of a run."""
        return read_summary(self.run(name))

    def history(self, name: str) -> dict[str, np.ndarray]:
        """The history of a run."""
        return read_history(self.run(name))

    def sweep(self, name: str) -> Path:
        """The folder of a sweep."""
        return self.folder / "sweeps" / name

    def table(self, name: str) -> pd.DataFrame:
        """The points of a sweep, from its runs."""
        return sweep.table(sweep.load(name), self.sweep(name))

    def sweep_runs(self, name: str) -> list[Path]:
        """The folders of the runs of a sweep."""
        return [study.place(self.sweep(name), point) for point in sweep.load(name).runs]

    def require(self) -> None:
        """Failure with one line that names every make target whose result is missing, or of another scene or other code."""
        missing: dict[str, None] = {}
        for name, pictures in RUNS.items():
            there = self._holds([(self.run(name), scene.load(name))])
            if not there or not all((self.run(name) / f"figures/{picture}.png").exists() for picture in pictures):
                missing[TARGETS.get(name, name)] = None
        for name in sweep.built_in():
            wanted, place = sweep.load(name), self.sweep(name)
            base = scene.load(wanted.scene).override(wanted.base)
            runs = [(study.place(place, point), base.override(point)) for point in wanted.runs]
            if not (place / "sweep.png").exists() or not self._holds(runs):
                missing[name] = None
        place, base = self.folder / "stick-slip", scene.load(stick_slip.SCENE).override(stick_slip.BASE)
        runs = [(study.place(place, point), base.override(point)) for point in stick_slip.grid(stick_slip.AXES)]
        if not all((place / f"stick-slip.{kind}").exists() for kind in ("csv", "png")) or not self._holds(runs):
            missing["stick-slip"] = None
        picture, laws = self.folder / "friction-laws/friction-laws.png", (ROOT / "edp/core/contact/friction.idp", ROOT / "edp/friction-laws.edp")
        if not picture.exists() or any(picture.stat().st_mtime < law.stat().st_mtime for law in laws):
            missing["friction-laws"] = None
        if not verify.there(self.folder / "verify"):
            missing["verify"] = None
        if missing:
            raise Failure(f"paper: no results of the present scenes and code for {', '.join(missing)}; run: make {' '.join(missing)}   "
                          "(or: make paper)", Unreadable("").code)

    @staticmethod
    def _holds(runs: list[tuple[Path, scene.Scene]]) -> bool:
        """Whether every folder holds the outcome of its scene, by the present code."""
        return all(study.there(folder, wanted) for folder, wanted in runs)


# ---- the statements, in the order of the paper

STATEMENTS: list[tuple[str, str, Callable[[Results], Finding]]] = []


def states(item: str, text: str) -> Callable:
    """Registers how a statement of the paper is judged."""
    def register(find: Callable[[Results], Finding]) -> Callable[[Results], Finding]:
        STATEMENTS.append((item, text, find))
        return find
    return register


def within(value: float, paper: float, half_digit: float, error: float = 0.0) -> bool:
    """Whether the paper's number is met: to half a unit of its last digit, and our error bar."""
    return abs(value - paper) <= half_digit + error


@states("Figure 3", "Coulomb's law, its three regularisations, and the law with a static and a dynamic coefficient")
def friction_laws(results: Results) -> Finding:
    return Finding(AGREES, "Drawn from the functions that the solver runs. The paper prints v/(2ε) in the middle branch of φ³ (13), which would jump "
                   "from ½ to 1 at |v| = ε; v/ε is used, the printed form is linear-printed.", [results.folder / "friction-laws/friction-laws.png"])


@states("Section 3.1, figure 4b", "the angles of incidence and reflection are different")
def angles(results: Results) -> Finding:
    """Agrees where for every ν they differ by more than a degree and the error bar."""
    parts, apart = [], []
    for row in _finished(results, "oblique").itertuples():
        out = float(np.degrees(np.arctan2(row.rebound_vy, row.rebound_vx)))
        bar = float(np.degrees(np.hypot(row.rebound_vx * row.rebound_vy_error, row.rebound_vy * row.rebound_vx_error)
                               / np.hypot(row.rebound_vx, row.rebound_vy) ** 2))
        parts.append(f"{out:.1f} ± {bar:.1g}° (ν = {row.nu:g})")
        apart.append(abs(out - 60) > 1 + bar)
    return Finding(AGREES if apart and all(apart) else DIFFERS, f"60° in, {', '.join(parts)} out, from the plane; neo-Hookean.",
                   [results.run("disc-oblique") / "figures/flight.png"], results.sweep_runs("oblique") + [results.run("disc-oblique")])


@states("Section 3.1", "oblique disc, SVK, 12 m/s at π/3, μ_d = 0.5, μ_e = 0.7: contact time 0.0045 s, as the paper may have run it")
def oblique_coarse(results: Results) -> Finding:
    """Half a unit of the last digit; the law loses ellipticity here, so that a coarse mesh decides."""
    end = results.summary("disc-oblique-svk")
    met = within(end["contact_time"], 4.5e-3, 0.5e-4)
    lost, broken = (f"{words} from {1e3 * end[key]:.2f} ms on" if end[key] is not None else f"{words} not there yet" for key, words in (
        ("ellipticity_lost_time", "ellipticity lost"), ("breakdown_time", "det F ≤ 0")))
    return Finding(PARTLY if met else DIFFERS, f"{1e3 * end['contact_time']:.3f} ms on one coarse mesh of linear triangles ({end['dofs']} dofs). The number "
                   f"has no error bar: {lost}, {broken}; finer meshes give other times.", [results.run("disc-oblique-svk") / "figures/force.png"], [results.run("disc-oblique-svk")])


@states("Section 3.1", "the same contact time, 0.0045 s, against the converged neo-Hookean disc")
def oblique_converged(results: Results) -> Finding:
    """Half a unit of the last digit and the error bar, for any of the ν that were run."""
    rows = _finished(results, "oblique")
    found = list(zip(rows.nu, rows.contact_time, sweep_figures.bars(rows, "contact_time")))
    met = [within(time, 4.5e-3, 0.5e-4, bar) for _, time, bar in found]
    text = "; ".join(f"ν = {nu:g}: {1e3 * time:.2f} ± {1e3 * bar:.2f} ms" for nu, time, bar in found)
    return Finding(AGREES if met and all(met) else PARTLY if any(met) else DIFFERS, text + ".", [results.sweep("oblique") / "sweep.png"],
                   results.sweep_runs("oblique"))


@states("Section 3.1, figure 5a", "the normal force oscillates, by reflections of the impact waves")
def oscillates(results: Results) -> Finding:
    """Agrees where the force has several maxima that stand out by more than 5 % of its largest value, on both meshes."""
    count = min(maxima(history["normal_force"], 0.05 * history["normal_force"].max()) for history in _both(results))
    return Finding(AGREES if count > 1 else DIFFERS, f"at least {count} maxima that stand out by more than 5 % of the largest force, on two meshes.",
                   [results.run("disc-oblique") / "figures/force.png"], [results.run("disc-oblique")])


@states("Section 3.1, figure 5b", "static and dynamic friction alternate: stick and slip")
def alternates(results: Results) -> Finding:
    """Agrees where the share of the load that slides rises and falls more than once by over 5 % of the load, on both meshes."""
    count = min(maxima(history["sliding_fraction"][history["normal_force"] > 0], 0.05) for history in _both(results))
    return Finding(AGREES if count > 1 else DIFFERS, f"the share of the load that slides has at least {count} maxima that stand out by over 5 % of the "
                   "load, on two meshes.", [results.run("disc-oblique") / "figures/rolling.png"], [results.run("disc-oblique")])


@states("Section 3.1, figure 6a", "the energy is constant before and after the contact, and falls in it by friction")
def energy(results: Results) -> Finding:
    """Agrees where the total changes by less than 1e-9 of its start after the last touch, and never grows in the contact."""
    history = results.history("disc-oblique")
    total = history["kinetic"] + history["elastic"] + history["contact"]
    touching = np.flatnonzero(history["normal_force"] > 0)
    after = np.ptp(total[touching[-1]:]) / total[0]
    grows = max(0.0, float(np.diff(total).max()) / total[0])
    lost = history["friction_work"][-1] / total[0]
    drift = np.abs(history["balance"]).max() / total[0]
    good = after < OUTSIDE and grows < OUTSIDE and lost > 0
    return Finding(AGREES if good else DIFFERS, f"constant to {after:.0e} after the contact (before it the flight is exact); {100 * lost:.1f} % are lost "
                   f"to friction; with them the balance closes to {drift:.0e}.", [results.run("disc-oblique") / "figures/energies.png"],
                   [results.run("disc-oblique")])


@states("Section 3.1", "the disc slides first and sticks in about the last third of the contact, in which the energy is constant again")
def sliding_first(results: Results) -> Finding:
    """Over the search of ε, k, ν, law and two readings of π/3: agrees where all runs at 60° from the plane do both, partly where some run
    does. Constant energy: at most 5 % of the friction work in the last third."""
    rows = pd.read_csv(results.folder / "stick-slip/stick-slip.csv")
    rows["both"] = rows["order"] & rows["quiet"]
    parts = [f"{int(group['order'].sum())} of {len(group)} runs at {angle:g}° from the plane ({int(group['both'].sum())} of them with at most "
             f"{100 * stick_slip.QUIET:g} % of the friction work in the last third)" for angle, group in rows.groupby("angle", sort=False)]
    verdict = AGREES if rows[rows.angle == 60]["both"].all() else PARTLY if rows["both"].any() else DIFFERS
    return Finding(verdict, "slides first and sticks last in " + ", and ".join(parts) + ". With 60° from the plane most of the load sticks from the start "
                   "and slips back at the end.", [results.folder / "stick-slip/stick-slip.png"],
                   [study.place(results.folder / "stick-slip", point) for point in stick_slip.grid(stick_slip.AXES)])


@states("Section 3.1", "a disc that impacts and rolls")
def rolls(results: Results) -> Finding:
    """Agrees where the disc, set down at v₀, ends rolling at 2/3 v₀ within 1 %, as a rigid one."""
    end, used = results.summary("disc-rolling"), read_scene(results.run("disc-rolling"))
    ratio = end["rebound_vx"] / used["speed"]
    rim = -used["radius"] * end["rebound_spin"] / used["speed"]
    good = abs(ratio / (2 / 3) - 1) < 0.01 and abs(rim / (2 / 3) - 1) < 0.01
    return Finding(AGREES if good else DIFFERS, f"set down on the plane it comes to roll: centre {ratio:.4f} v₀, rim {rim:.4f} v₀ (rigid: 2/3).",
                   [results.run("disc-rolling") / "figures/rolling.png"], [results.run("disc-rolling")])


@states("Figure 6b", "normal impact, SVK: the contact time falls with the speed in steps, with small rises between")
def stepped(results: Results) -> Finding:
    """Agrees where for every ν it falls and at least two rises exceed twice their error bar; partly where it only falls."""
    trends, words, runs = _trends(results, "contact-time-svk")
    falls = all(trend and trend.falls for trend in trends)
    rises = all(trend and trend.established >= 2 for trend in trends)
    told = "" if rises else " The rises are not told from the errors."
    return Finding(AGREES if falls and rises else PARTLY if falls else DIFFERS, words + told, *runs)


@states("Figure 7a", "1 m/s: no noticeable difference between the force histories of SVK and neo-Hookean")
def same_at_low_speed(results: Results) -> Finding:
    """Agrees where they differ by less than 10 % in L2 over time."""
    distance, bar = _distance(results, 1)
    return Finding(AGREES if distance < 0.1 else DIFFERS, f"they differ by {100 * distance:.1f} % in L2 over time (mesh and step change {100 * bar:.1f} %).",
                   [results.sweep("law-comparison") / "sweep.png"], results.sweep_runs("law-comparison"))


@states("Figure 7b", "10 m/s: the contact lasts longer with SVK")
def longer_at_high_speed(results: Results) -> Finding:
    """Agrees where it does by more than both error bars."""
    rows = _finished(results, "law-comparison")
    if len(rows[rows.speed == 10]) < 2:
        return Finding(DIFFERS, "one of the runs at 10 m/s failed.", [results.sweep("law-comparison") / "sweep.png"], results.sweep_runs("law-comparison"))
    svk, neo = (rows[(rows.speed == 10) & (rows.law == law)].iloc[0] for law in ("svk", "neohookean"))
    bar = svk.contact_time_error + neo.contact_time_error
    distance, _ = _distance(results, 10)
    return Finding(AGREES if svk.contact_time - neo.contact_time > bar else DIFFERS,
                   f"SVK {1e3 * svk.contact_time:.3f} ± {1e3 * svk.contact_time_error:.3f} ms, neo-Hookean {1e3 * neo.contact_time:.3f} ± "
                   f"{1e3 * neo.contact_time_error:.3f} ms; the histories differ by {100 * distance:.0f} % in L2.",
                   [results.sweep("law-comparison") / "sweep.png"], results.sweep_runs("law-comparison"))


@states("Figure 8", "normal impact, neo-Hookean: the contact time falls monotonically with the speed")
def monotone(results: Results) -> Finding:
    """Agrees where for every ν it falls and no rise exceeds the error bar of its step; partly where the bars are larger than the
    steps, so that a rise would not show."""
    trends, words, runs = _trends(results, "contact-time-neohookean")
    good = all(trend and trend.falls and trend.beyond == 0 for trend in trends)
    sharp = all(trend and trend.bar < trend.step for trend in trends)
    told = "" if sharp else " Many steps are smaller than their error bar: a small rise would not show."
    return Finding((AGREES if sharp else PARTLY) if good else DIFFERS, words + told, *runs)


@states("Section 3.2", "a disc at 10 m/s on a free block: the disc is reflected")
def rebounds(results: Results) -> Finding:
    """Agrees where its velocity upwards after the contact is more than the estimated error of it."""
    def of(name: str) -> tuple[bool, str]:
        (_, disc), _, bar = _velocities(results, name)
        return disc > bar, f"{disc:.2f} ± {bar:.1g} m/s"
    return _of_both(of, "Upwards after the contact", ".", [results.run(name) / "figures/velocity.png" for name in BLOCK], results)


@states("Section 3.2", "the block is directed downwards")
def downwards(results: Results) -> Finding:
    """Agrees where momentum is kept and the block's velocity lies between those of bodies that stay together (restitution e = 0) and of an
    elastic impact (e = 1): -m v/(m + M) and twice that."""
    def of(name: str) -> tuple[bool, str]:
        (start, disc), block, bar = _velocities(results, name)
        end = results.summary(name)
        m, M = end["mass_1"], end["mass_2"]
        together = m * start / (m + M)
        missing = abs((m * disc + M * block) / (m * start) - 1)
        return missing < MOMENTUM and 2 * together < block < together, (
            f"{block:.4f} ± {m / M * bar:.1g} m/s, e = {(block - disc) / start:.3f} (between {together:.3f} for e = 0 and {2 * together:.3f} m/s for "
            f"e = 1; momentum kept to {missing:.0e})")
    return _of_both(of, "Upwards after the contact", ".", [results.run("disc-block") / "figures/shapes.png"], results)


@states("Section 3.2, figure 9a", "the variation of the disc's energy, drawn and not described; judged here: in the contact the disc gives energy to the "
        "block, after it each keeps its own")
def passes(results: Results) -> Finding:
    """Agrees where the disc ends with less than at the start and the block with more, and each keeps kinetic and elastic energy together to
    1e-9 of the start's in the flight after the last touch."""
    def of(name: str) -> tuple[bool, str]:
        history, end = results.history(name), results.summary(name)
        disc, block = (100 * (history[f"kinetic_{b}"] + history[f"elastic_{b}"]) / _total(history)[0] for b in (1, 2))
        flight = slice(np.flatnonzero(history["normal_force"] > 0)[-1], None)
        after = max(np.ptp(own[flight]) if len(own[flight]) > 1 else np.inf for own in (disc, block)) / 100
        shares = [100 * end[f"vibration_energy_{b}"] / end["energy_initial"] for b in (1, 2)]
        return disc[-1] < disc[0] and block[-1] > block[0] and after < OUTSIDE, (
            f"the disc keeps {disc[-1]:.1f} % ({shares[0]:.1f} % as vibration), the block has {block[-1]:.1f} % ({shares[1]:.1f} %), each constant to {after:.0e}; "
            f"in the contact the disc was down to {disc.min():.1f} %, at {1e3 * history['t'][disc.argmin()]:.0f} ms")
    return _of_both(of, "After the contact, of the energy at the start", ". After the contact kinetic and elastic energy of each go on to change into each other.",
                    [results.run("disc-block") / "figures/energies.png"], results)


@states("Section 3.2, figure 9b", "the total energy of disc and block is constant")
def total(results: Results) -> Finding:
    """Agrees where kinetic, elastic and contact energy together change by less than 1e-9 of the start's over the whole run."""
    def of(name: str) -> tuple[bool, str]:
        history = results.history(name)
        moved = np.ptp(_total(history)) / _total(history)[0]
        return moved < OUTSIDE, f"constant to {moved:.0e}, at most {100 * (history['contact'] / _total(history)[0]).max():.1f} % of it in the contact"
    return _of_both(of, "Over the whole run", ".", [results.run("disc-block-neohookean") / "figures/energies.png"], results)


def _of_both(of: Callable[[str], tuple[bool, str]], before: str, after: str, figures: list[Path], results: Results) -> Finding:
    """What holds of the disc on the block: agrees with both laws, partly with the paper's alone; `of` gives (holds, words) of a run."""
    found = {law: of(name) for name, law in BLOCK.items()}
    paper, other = (holds for holds, _ in found.values())
    return Finding(AGREES if paper and other else PARTLY if paper else DIFFERS,
                   f"{before}, " + "; ".join(f"{law}: {words}" for law, (_, words) in found.items()) + after, figures, _runs(results))


def _velocities(results: Results, name: str) -> tuple[tuple[float, float], float, float]:
    """Upward velocities [m/s] of the disc before and after, of the block after, and the estimated error of the disc's; nan if it is not known."""
    history, estimated = results.history(name), results.summary(name)["estimated_error"]
    start = history["vy_1"][0]
    return (start, history["vy_1"][-1]), history["vy_2"][-1], abs(start) * (estimated["rebound"] if estimated else np.nan)


def _total(history: dict[str, np.ndarray]) -> np.ndarray:
    return history["kinetic"] + history["elastic"] + history["contact"]


def _runs(results: Results) -> list[Path]:
    return [results.run(name) for name in BLOCK]


@states("Section 3.3", "the 2D disc at 8 m/s: contact time 0.0048 s")
def disc_time(results: Results) -> Finding:
    """Agrees where some (ν, k) of the map meet it with SVK: the paper states neither."""
    rows = _finished(results, "calibrate")
    met = sweep_figures.level_set(sweep.load("calibrate").figure, rows[rows.law == "svk"])
    default = results.summary("disc-normal")["contact_time"]
    text = "; ".join(f"ν = {nu:g}: k = {sweep_figures.spans(ranges)}" for nu, ranges in met.items() if ranges)
    return Finding(AGREES if text else DIFFERS, f"with SVK met for {text or 'no ν and k'} [Pa/m]; the default run (ν = 0.45, k = 10¹⁰ Pa/m) gives "
                   f"{1e3 * default:.3f} ms.", [results.sweep("calibrate") / "sweep.png"],
                   results.sweep_runs("calibrate") + [results.run("disc-normal")])


@states("Section 3.3, figure 10", "normal impact of the ball without friction: the energy is constant (here of the disc, too)")
def conserves(results: Results) -> Finding:
    """Agrees below 1e-9 of the energy at the start."""
    runs = ("ball-axisymmetric", "ball-axisymmetric-svk", "disc-normal")
    drift = max(results.summary(name)["energy_drift"] for name in runs)
    return Finding(AGREES if drift < OUTSIDE else DIFFERS, f"constant to {drift:.0e} over the whole run, of the ball (neo-Hookean, SVK) and of the disc.",
                   [results.run("ball-axisymmetric") / "figures/energies.png"], [results.run(name) for name in runs])


@states("Section 3.3", "ball, SVK, 8 m/s: contact time 0.00603 s, as the paper may have run it")
def ball(results: Results) -> Finding:
    """Partly where a coarse mesh meets it to half a unit of its last digit: the law loses ellipticity here, so that a mesh decides."""
    end, converged = results.summary("ball-axisymmetric-svk"), results.summary("ball-axisymmetric")
    met = within(end["contact_time"], 6.03e-3, 0.5e-5)
    lost = f"ellipticity lost from {1e3 * end['ellipticity_lost_time']:.2f} ms on" if end["ellipticity_lost_time"] is not None else "ellipticity kept"
    return Finding(PARTLY if met else DIFFERS, f"{1e3 * end['contact_time']:.2f} ms on one coarse mesh of linear triangles ({end['dofs']} dofs). The number has no "
                   f"error bar: {lost}; finer meshes give other times. Neo-Hookean, converged: {1e3 * converged['contact_time']:.2f} ms.",
                   [results.run("ball-axisymmetric-svk") / "figures/force.png", results.run("ball-axisymmetric") / "figures/force.png"],
                   [results.run("ball-axisymmetric-svk"), results.run("ball-axisymmetric")])


@states("Section 3.3, figure 11", "of disc SVK, disc neo-Hookean and ball SVK at 8 m/s the ball's contact is the longest")
def longest(results: Results) -> Finding:
    """Agrees where the ball's is, with SVK on its coarse mesh and, with the laws alike, neo-Hookean."""
    rows = _finished(results, "contact-time-neohookean")
    discs = rows[(rows.speed == 8) & (rows.nu == 0.45)].contact_time
    if discs.empty:
        return Finding(DIFFERS, "the neo-Hookean disc at 8 m/s failed.", [], results.sweep_runs("contact-time-neohookean"))
    svk, neo = results.summary("disc-normal")["contact_time"], float(discs.iloc[0])
    ball_svk, ball_neo = (results.summary(name)["contact_time"] for name in ("ball-axisymmetric-svk", "ball-axisymmetric"))
    good = ball_svk > max(svk, neo) and ball_neo > neo
    return Finding(AGREES if good else DIFFERS, f"ball: SVK {1e3 * ball_svk:.2f} ms (one coarse mesh), neo-Hookean {1e3 * ball_neo:.2f} ms; disc: SVK {1e3 * svk:.2f} ms, "
                   f"neo-Hookean {1e3 * neo:.2f} ms. The acceleration of the centre of mass is the contact force over the mass.",
                   [results.run("ball-axisymmetric") / "figures/force.png", results.run("disc-normal") / "figures/energies.png"],
                   [results.run(name) for name in ("ball-axisymmetric", "ball-axisymmetric-svk", "disc-normal")])


def maxima(values: np.ndarray, least: float) -> int:
    """How many maxima stand out: between two of them the values fall and rise again by more than `least`."""
    count, low, high, rising = 0, values[0], values[0], True
    for value in values:
        if rising and value < high - least:
            count, rising, low = count + 1, False, value
        elif not rising and value > low + least:
            rising, high = True, value
        low, high = min(low, value), max(high, value)
    return count


def _finished(results: Results, name: str) -> pd.DataFrame:
    rows = results.table(name)
    return rows[rows.exit == 0]


def _both(results: Results) -> list[dict[str, np.ndarray]]:
    """The histories of the oblique impact for nu = 0.45 with the plain and the refined mesh and step."""
    wanted, out = sweep.load("oblique"), results.sweep("oblique")
    return [read_history(study.place(out, {"nu": 0.45} | more)) for more in ({}, wanted.refine)]


def _trends(results: Results, name: str) -> tuple[list[sweep_figures.Trend | None], str, tuple[list[Path], list[Path]]]:
    """The contact time over the speed: a trend for each ν of the sweep, all in words, and the picture and the runs."""
    every = results.table(name)
    trends, words = [], []
    for nu, group in every.groupby("nu"):
        trend = sweep_figures.steps_against(group, "speed", "contact_time")
        trends.append(trend)
        words.append(f"ν = {nu:g}: {1e3 * trend.first:.3f} to {1e3 * trend.last:.3f} ms (± {1e3 * trend.typical:.3f} ms rms), {trend.against} of "
                     f"{trend.steps} steps rise, {trend.beyond} of them by more than their error bar, {trend.established} by more than twice"
                     if trend else f"ν = {nu:g}: too few runs finished")
    broken = every[every.exit == 12]
    if len(broken):
        words.append("the law breaks down at and above " + ", ".join(f"{group.speed.min():g} m/s (ν = {nu:g})" for nu, group in broken.groupby("nu")))
    return trends, "; ".join(words) + ".", ([results.sweep(name) / "sweep.png"], results.sweep_runs(name))


def _distance(results: Results, speed: float) -> tuple[float, float]:
    """Relative L2 difference of the two laws' force histories at a speed, and the error of it."""
    wanted, out = sweep.load("law-comparison"), results.sweep("law-comparison")
    rows = results.table("law-comparison")
    *_, value, bar = next(iter(sweep_figures.distances(wanted, rows[rows.speed == speed], out)), (np.nan, np.nan))
    return value, bar


# ---- the page

def page(findings: list[tuple[str, str, Finding]], more: str = "") -> str:
    """The page as HTML, pictures and all; `more` comes behind the statements."""
    counts = ", ".join(f"{sum(found.verdict == verdict for *_, found in findings)} {verdict}" for verdict in COLOURS)
    rows = "\n".join(f"<tr><td>{escape(item)}</td><td>{escape(text)}</td><td>{escape(found.ours)}</td>"
                     f'<td style="color:{COLOURS[found.verdict]}"><a href="#s{k}">{found.verdict}</a></td></tr>'
                     for k, (item, text, found) in enumerate(findings))
    sections = "\n".join(_section(k, *each) for k, each in enumerate(findings) if each[2].figures)
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>The paper's statements and our numbers</title>
<style>
body {{ font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 60em; margin: 2em auto; padding: 0 1em }}
table {{ border-collapse: collapse; width: 100% }} td, th {{ border-bottom: 1px solid #ddd; padding: .35em .6em; text-align: left; vertical-align: top }}
td a {{ color: inherit }} img {{ max-width: 100% }} h2 {{ margin-top: 2.2em; font-size: 1.1em }}
h3 {{ margin-top: 1.6em; font-size: 1em }}
details {{ font-size: .85em }} pre {{ white-space: pre-wrap }}
</style></head><body>
<h1>The paper's statements and our numbers</h1>
<p>Buezas, Rosales and Filipich, <i>Nonlinear deformable bodies with unilateral contact including friction</i>. The paper states neither ν (only
“ν → 0.5”) nor the contact stiffness, ε, mesh or step; a number that it prints is taken as known to half a unit of its last digit.
Error bars of ours are what refining mesh and step changes. Verdicts follow from the numbers by fixed rules (orchestrate/report/paper.py).</p>
<p><b>{counts}</b></p>
<table><tr><th>where</th><th>the paper</th><th>here</th><th>verdict</th></tr>
{rows}
</table>
{sections}
{more}
<p>Made {datetime.now():%Y-%m-%d %H:%M} by ffimpact.</p>
</body></html>
"""


def _section(k: int, item: str, text: str, found: Finding) -> str:
    return (f'<h2 id="s{k}">{escape(item)}: {escape(text)}</h2>\n<p><b style="color:{COLOURS[found.verdict]}">{found.verdict}</b>: {escape(found.ours)}</p>\n'
            + "\n".join(map(_picture, found.figures)) + f"\n{_provenance(found.runs)}")


def _picture(path: Path) -> str:
    return f'<img alt="{escape(path.stem)}" src="data:image/png;base64,{base64.b64encode(path.read_bytes()).decode()}">'


def verification(folder: Path) -> str:
    """The section with what `make verify` left in `folder`: a table of the cases, then each with its figure and numbers."""
    frame = pd.read_csv(folder / "verify.csv")
    judged = verify.judged(frame)
    table = _table(verify.overview(frame), verify.FORMATS)
    parts = []
    for case in verify.CASES:
        rows, asked = frame[frame.case == case.name], judged[judged.case == case.name]
        figure = folder / f"{verify.slug(case)}.png"
        parts.append(f"<h3>{escape(case.name)}: {escape(case.title)}</h3>\n<p>{escape(case.note)}</p>\n"
                     f"{_picture(figure) if figure.exists() else ''}\n<details><summary>all numbers ({len(rows)}, of which "
                     f"{len(asked)} are judged)</summary>{_table(rows, verify.NUMBERS)}</details>")
    return ("<h2>Verification</h2>\n<p>Against exact solutions, by tolerances fixed beforehand (make verify): "
            f"<b>{'all pass' if judged['pass'].all() else 'NOT all pass'}</b>. A row a case, with the number that is nearest to "
            f"its tolerance; order: observed, of the largest error between the coarsest and the finest size.</p>\n{table}\n"
            + "\n".join(parts))


def _table(frame: pd.DataFrame, formats: dict[str, str]) -> str:
    """The columns named in `formats` as an HTML table."""
    rows = [[*formats], *zip(*([study.cell(value, form) for value in frame[name]] for name, form in formats.items()))]
    return "<table>" + "\n".join("<tr>" + "".join(f"<{tag}>{escape(text)}</{tag}>" for text in row) + "</tr>"
                                 for tag, row in zip(["th"] + ["td"] * len(frame), rows)) + "</table>"


def _provenance(folders: list[Path]) -> str:
    """Parameters that differ from their defaults, common to all runs and by run, and where the runs come from."""
    scenes = [read_scene(folder) for folder in folders if (folder / "scene.toml").exists()]
    if not scenes:
        return ""
    standard = parameters.defaults()
    common = {name: value for name, value in scenes[0].items()
              if all(used.get(name) == value for used in scenes) and (name == "script" or standard.get(name) != value)}
    varied = {name: sorted({used.get(name) for used in scenes}, key=lambda value: (isinstance(value, str), value)) for name in scenes[0]
              if any(used.get(name) != scenes[0][name] for used in scenes)}
    records = [json.loads(path.read_text()) for folder in folders
               for path in (folder / "summary.json", folder / "failure.json") if path.exists()]
    made = [record.get("provenance", {}) for record in records]
    warned = study.warned("; ".join(each.get("warnings", [])) for each in records)
    lines = [f"runs          {len(scenes)}", f"warnings      {warned or 'none'}",
             "parameters    " + ", ".join(f"{name} = {value}" for name, value in common.items())]
    lines += [f"varied        {name}: {_shown(values)}" for name, values in varied.items()]
    for name, words in (("git", "commit"), ("code", "code sha256"), ("freefem", "FreeFem++"), ("gmsh", "gmsh")):
        lines.append(f"{words:<14}" + ", ".join(sorted({str(each.get(name)) for each in made})))
    meshes = sorted({str(each.get("mesh")) for each in made})
    lines.append("mesh sha256   " + (", ".join(meshes) if len(meshes) <= 4 else f"{len(meshes)} meshes, in each run's summary.json"))
    return f"<details><summary>parameters and provenance</summary><pre>{escape(chr(10).join(lines))}</pre></details>"


def _shown(values: list[Value]) -> str:
    return ", ".join(map(str, values)) if len(values) <= 8 else f"{len(values)} values from {values[0]} to {values[-1]}"
