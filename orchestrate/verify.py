"""Exact solutions: every case over element size, time step or what else its error comes from, judged by tolerances that were
fixed beforehand. results/verify/verify.csv has all numbers, a figure a case beside it. Some two minutes;
what the present code left is taken as it is."""

import argparse
import hashlib
import json
import math
import shutil
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.ticker import NullLocator
from tqdm import tqdm

from . import freefem, results, run
from .failure import Failure
from .folder import result_folder
from .measure import disc, measure
from .parameters import ROOT
from .places import shown
from .report.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, STYLE
from .report.report import REFERENCE
from .studies import study

COLUMNS = ["case", "what", "size", "value", "expected", "error", "tolerance"]   # of verify.csv; a row with a tolerance is judged
CONVERGES = "order of the largest error"   # asked for above 0, between the coarsest and the finest size
SHOWN = 1e-6                # smaller errors are drawn there


@dataclass(frozen=True)
class Row:
    """A number of a case at one size. Its error is relative; where 0 is expected the number itself."""

    what: str                    # "group: which"; a group is drawn in one colour
    size: float
    value: float
    expected: float
    order: float | None = None   # of the error, where theory gives one: drawn, and asked for where the case is judged by it

    @property
    def error(self) -> float:
        return abs(self.value / self.expected - 1) if self.expected else abs(self.value)


@dataclass(frozen=True)
class Case:
    """A case of the table of checks: its numbers, from coarse to fine, and what is asked of them.

    by_order: the observed order between the two finest sizes, within `tolerance` of the expected one. Otherwise: every number
    at its finest size within the relative `tolerance`, and the largest error there below the largest at the coarsest size.
    """

    name: str
    title: str
    axis: str                                    # label of the size
    tolerance: float
    rows: Callable[[Path], Iterator[Row]]        # runs the case; a folder for its files
    by_order: bool = False
    beside: Callable[[plt.Axes, Path], None] | None = None   # draws a second panel from those files
    note: str = ""                               # what the reader of the figure should know


# ---- V1: manufactured motions

SOFT = dict(young=10, density=1, nu=0.3, radius=1)
LAWS = {"svk": "SVK", "neohookean": "neo-Hookean"}


def in_space(folder: Path) -> Iterator[Row]:
    """L2 error of the displacement, relative, on the square (P1, P2) and on the disc with curved elements (P2)."""
    for degree in (1, 2):
        for law, name in LAWS.items():
            for h in (0.25, 0.125, 0.0625):
                found = measure("manufactured", law=law, degree=degree, mesh_size=h, dt=0.0025, end_time=0.025,
                                tolerance=1e-12, **SOFT)
                yield Row(f"P{degree}: {name}", h, found["error"], 0, degree + 1)
    for law, name in LAWS.items():
        for h in (0.5, 0.25, 0.125):
            found = measure("manufactured-disc", law=law, mesh_size=h, dt=0.005, end_time=0.025,
                            tolerance=1e-12, **SOFT)
            yield Row(f"P2, disc: {name}", h, found["error"], 0, 3)


def in_time(folder: Path) -> Iterator[Row]:
    """L2 error of the displacement, relative, for a motion that the elements hold exactly."""
    for integrator, order in {"energy-momentum": 2, "midpoint": 2, "newmark": 2, "bdf2": 2, "backward-euler": 1}.items():
        for law, name in LAWS.items():
            for dt in ((0.02, 0.01, 0.005) if order == 2 else (0.005, 0.0025, 0.00125)):
                found = measure("manufactured", law=law, degree=2, mesh_size=0.5, dt=dt, end_time=0.4, tolerance=1e-13,
                                integrator=integrator, breakdown="continue", **SOFT)
                yield Row(f"{integrator}: {name}", dt, found["error"], 0, order)


# ---- V4, V5, V8: waves in a bar, a rigid body on the penalty

DENSITY, WIDTH, LENGTH = 1722, 2e-3, 0.05          # of the falling block, SI; the width is that of impact.edp
FRONT = 2 / 3               # a second-order scheme smears a front over h^(2/3)


def bar(folder: Path, elements: int) -> Iterator[Row]:
    """A bar falls on a stiff plane, v << c: contact 2L/c, stress rho c v (mean of its middle 80 %), restitution 1."""
    speed, young = 0.05, 7e6
    c = math.sqrt(young / DENSITY)
    measure("impact", nu=0, radius=LENGTH, density=DENSITY, speed=speed, young=young, penalty=1e12, mesh_size=LENGTH / elements,
            dt=LENGTH / elements / c / 2, chatter="continue", out=folder)   # its end chatters on a plane that is all but rigid
    summary, history = results.read_summary(folder), results.read_history(folder)
    time = summary["contact_time"]
    plateau = (history["t"] > 0.1 * time) & (history["t"] < 0.9 * time)
    force = np.average(history["normal_force"][plateau], weights=history["dt"][plateau])
    yield Row("contact time", 1 / elements, time, 2 * LENGTH / c, FRONT)
    yield Row("stress", 1 / elements, force / WIDTH, DENSITY * c * speed, FRONT)
    yield Row("restitution", 1 / elements, summary["rebound_vy"] / speed, 1, FRONT)


def rod(elements: int) -> Iterator[Row]:
    """A clamped rod meets the wall, t in units of L/c; strains of 5e-5, and a penalty of 1000 E/L."""
    found = measure("rod", young=1, density=1, nu=0, speed=1e-4, penalty=1e3, mesh_size=1 / elements, dt=0.5 / elements)
    for what, value, expected in (
            ("contact begins", found["start"], 1), ("contact ends", found["leave"], 2),
            ("period", found["again"] - found["start"], 3), ("stress: mean", found["mean"], 1 / 2),
            ("stress: middle", found["stress"], 1 / 2), ("energy", found["energy"], 1 / 8)):
        yield Row(what, 1 / elements, value, expected, FRONT)


def rigid(folder: Path, exponent: float, speed: float, dt: float) -> Iterator[Row]:
    """A nearly rigid body of mass M on F = K d^m: depth [(m+1) M v^2/(2K)]^(1/(m+1)), contact time, restitution 1."""
    measure("impact", nu=0, radius=LENGTH, density=DENSITY, speed=speed, young=1e12, penalty=1e7, exponent=exponent,
            mesh_size=LENGTH / 4, dt=dt, out=folder)
    summary, power = results.read_summary(folder), 1 / (exponent + 1)
    depth = (DENSITY * LENGTH * speed**2 / (2 * power * 1e7)) ** power
    time = 2 * math.sqrt(math.pi) * math.gamma(1 + power) / math.gamma(0.5 + power) * depth / speed
    yield Row(f"m = {exponent:g}: depth", dt, summary["max_penetration"], depth, 2)
    yield Row(f"m = {exponent:g}: contact time", dt, summary["contact_time"], time, 2)


def bars(folder: Path) -> Iterator[Row]:
    for elements in (40, 80, 160, 320):
        yield from bar(folder, elements)


def rods(folder: Path) -> Iterator[Row]:
    for elements in (50, 100, 200, 400):
        yield from rod(elements)


def rigids(folder: Path) -> Iterator[Row]:
    for exponent in (1, 1.5, 2):
        for dt in (1.6e-3, 8e-4, 4e-4, 2e-4):
            yield from rigid(folder, exponent, 1, dt)


# ---- V6: Hertz

NARROW = 0.005              # half-width b over the radius: the small load


def hertz(folder: Path, share: float, law: str = "neohookean", nu: float = 0.3) -> Iterator[Row]:
    """A cylinder of radius 1 and E = 1 on the plane, elements of share * b: half-width and largest pressure of the fitted
    ellipse. The penalty grows as they shrink, k = 10 E*/h: what it gives way is an error of first order like the others."""
    folder.mkdir(parents=True, exist_ok=True)
    stiffness = 1 / (1 - nu**2)
    load = math.pi * stiffness * NARROW**2 / 4
    found = measure("hertz", law=law, young=1, nu=nu, density=1, radius=1, speed=0, gravity=load / math.pi, dt=20,
                    integrator="backward-euler", penalty=10 * stiffness / (share * NARROW), mesh_size=0.2,
                    contact_mesh_size=share * NARROW, out=folder)
    if abs(found["imbalance"]) > 1e-6 or found["kinetic"] > 1e-9:
        raise Failure("hertz: not at rest")
    yield Row("half-width b", share, found["width"], NARROW, 1)
    yield Row("largest pressure p₀", share, found["peak"], math.sqrt(load * stiffness / math.pi), 1)


def cylinder(folder: Path) -> Iterator[Row]:
    for share in (0.3, 0.15, 0.075, 0.0375):
        yield from hertz(folder / f"{share:g}", share)


def ellipse(axes: plt.Axes, folder: Path) -> None:
    """The tractions at the contact points over x, for the coarsest and finest mesh, and the exact ellipse."""
    sizes = sorted((float(path.name) for path in folder.iterdir()), reverse=True)
    peak = NARROW / (2 * (1 - 0.3**2))
    x = np.linspace(0, 1, 400)
    axes.plot(x, np.sqrt(1 - x**2), color=BLACK, linewidth=1, label="exact")
    for size, colour, marker in ((sizes[0], ORANGE, "s"), (sizes[-1], BLUE, ".")):
        rows = pd.read_csv(folder / f"{size:g}/pressure.csv").sort_values("x")
        axes.plot(rows.x / NARROW, rows.p / peak, color=colour, marker=marker, markersize=4, linestyle="none",
                  label=f"elements of {size:g} b")
    axes.set(xlabel="$x/b$", ylabel="$p/p_0$", xlim=(0, 1.4), ylim=(-0.03, 1.15))
    axes.legend(loc="upper right")


# ---- V9: a stiff block slides

GRAVITY = 10
BLOCK = dict(young=1e9, nu=0.3, penalty=1e9, gravity=GRAVITY, radius=0.005)
BLOCK_MASS = DENSITY * 0.1 * 0.01


def block(folder: Path) -> Iterator[Row]:
    """A block at 1 m/s stops; on an incline it starts to slide at tan alpha = mu_e, and below it creeps. The slip velocity goes
    with the step."""
    top = math.atan(1.05 * 0.7)
    for dt in (8e-3, 4e-3, 2e-3, 1e-3):
        found = measure("sliding-block", speed=1, angle=0, end_time=0.24, friction_static=0.7, friction_dynamic=0.5,
                        slip_velocity=dt, dt=dt, **BLOCK)
        yield Row("stop: time", dt, found["stop"], 1 / (0.5 * GRAVITY), 1)
        yield Row("stop: way", dt, found["distance"], 1 / (2 * 0.5 * GRAVITY))
        yield Row("stop: friction work", dt, found["work"], BLOCK_MASS / 2)
        found = measure("sliding-block", speed=0, angle=math.degrees(top), end_time=0.6, friction_static=0.7,
                        friction_dynamic=0.4, slip_velocity=0.02 * dt, dt=dt, **BLOCK)
        yield Row("starts to slide: tan α", dt, found["breakaway"], 0.7)
        for law, creep in {"linear": 0.9, "sqrt": 0.9 / math.sqrt(1 - 0.9**2), "tanh": math.atanh(0.9)}.items():
            found = measure("sliding-block", speed=0, angle=math.degrees(math.atan(0.6 * 0.9)), end_time=0.2, friction_static=0.6,
                            friction_dynamic=0.6, regularization=law, slip_velocity=dt, dt=dt, **BLOCK)
            yield Row(f"creep: {law}", dt, found["creep"], creep)


# ---- V10: a stiff disc hits obliquely

# A pressure wave crosses this disc in 35 us and its contact lasts 1.4 ms at a penalty of 1e10: rigid, on the penalty alone.
# Its stresses are large beside its energy: round-off allows 1e-10 of the energy at the start, not the default 5e-12.
STIFF = dict(radius=0.05, young=1e10, nu=0.3, speed=1, slip_velocity=1e-3, mesh_size=0.025, contact_mesh_size=0.0079, accuracy=0.03, tolerance=1e-10)


def oblique(folder: Path) -> Iterator[Row]:
    """Speed along the plane and of the rim after the impact over the speed along it before, with the measured restitution e:
    v_t - mu (1+e) v_n and 2 mu (1+e) v_n where it slides throughout, else 2/3 v_t."""
    for penalty in (1e11, 3e10, 1e10, 3e9):
        for law, friction, angle in (("neohookean", 0.2, 30), ("svk", 0.3, 20), ("neohookean", 0.2, 60), ("svk", 0.2, 75)):
            found = disc(folder, law=law, angle=angle, friction_static=friction, friction_dynamic=friction, penalty=penalty,
                         **STIFF).summary
            along, across = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            lost = friction * (across + found["rebound_vy"]) / along
            slides, size = 1 > 3 * lost, penalty * STIFF["radius"] / STIFF["young"]
            words = f"{'slides' if slides else 'rolls'}, {angle}°, {LAWS[law]}"
            yield Row(f"{words}: centre", size, found["rebound_vx"] / along, 1 - lost if slides else 2 / 3)
            yield Row(f"{words}: rim", size, -found["spin"] * STIFF["radius"] / along, 2 * lost if slides else 2 / 3)


def independent(folder: Path) -> Iterator[Row]:
    """disc-normal over `accuracy`, against the converged values of NGSolve and GetFEM (reference/converged.toml)."""
    peers = tomllib.loads((REFERENCE / "converged.toml").read_text())["run"][0]
    for accuracy in (0.02, 0.005, 0.0025, 0.00125, 0.0006):
        found = disc(folder, accuracy=accuracy, **peers["when"]).summary
        for key, words in (("contact_time", "contact time"), ("impulse", "impulse"), ("rebound_vy", "rebound")):
            yield Row(words, accuracy, found[key], peers["numbers"][key]["value"])


CASES = (
    Case("V1 space", "manufactured motions at large strain, L² error of the displacement", "element size", 0.15, in_space,
         by_order=True, note="Both laws on the unit square and on the disc with curved elements, energy-momentum steps so small "
                             "that only the error in space is seen."),
    Case("V1 time", "manufactured motions at large strain, L² error of the displacement", "time step", 0.15, in_time,
         by_order=True, note="A motion that P2 holds exactly, so that only the error in time is seen."),
    Case("V4", "bar on a wall: contact 2L/c, stress ρcv, restitution 1", "element size / length", 0.01, bars,
         note="v/c = 8·10⁻⁴, steps of half an element's transit. A second-order scheme smears the front over h^(2/3): the order "
              "to expect. The stress is the mean of the middle 80 % of the contact."),
    Case("V5", "clamped rod against a wall: contact in [1, 2], stress 1/2, period 3, energy 1/8", "element size / length", 0.01,
         rods, note="Compressed by 5·10⁻⁵, let go, scaled back to the linear rod; the finite strain leaves 5·10⁻⁵ in the energy."
                    " Penalty 1000 E/L. Mean stress: impulse over contact time; middle: t in [1.1, 1.9]."),
    Case("V6", "cylinder pressed on a plane: Hertz", "element size / b", 0.02, cylinder, beside=ellipse,
         note="b/R = 0.005, neo-Hookean, ν = 0.3, penalty 10 E*/h; b and p₀ are those of the ellipse fitted to the tractions at "
              "the contact points."),
    Case("V8", "rigid body on the penalty: depth and contact time", "time step [s]", 0.01, rigids,
         note="E = 10¹² Pa; the depth is the largest at the steps. m = 1.5 and 2 besides m = 1."),
    Case("V9", "stiff block: sliding to a stop, starting to slide, creeping", "time step [s]", 0.01, block,
         note="The slip velocity goes with the step. The block starts in the equilibrium of a rigid one; its weight shortens "
              "it by 0.5 % of the penetration, it vibrates, and its normal load with it: by that the start and the creep are off "
              "once the step resolves it."),
    Case("V10", "stiff oblique disc: sliding throughout, rolling", "penalty × radius / E", 0.03, oblique,
         note="With the measured restitution. A stiff penalty leaves the disc's own compliance, which springs back along the "
              "plane; a soft one lets it sink in (0.8 % of its radius at the softest), which shortens the lever of friction."),
    Case("V12", "normal impact against NGSolve and GetFEM", "accuracy", 0.005, independent,
         note="Their converged values, written independently on the same equations. The contact time scatters with mesh and step, by up "
              "to 1.5 % on the coarser ones."),
)


def main(argv: list[str]) -> int:
    """Runs the cases, prints the table, writes verify.csv and the figures; 0 only if all pass."""
    parser = argparse.ArgumentParser(prog="python -m orchestrate verify", description=__doc__)
    parser.add_argument("--out", metavar="DIR", type=Path, default=ROOT / "results/verify", help="the result folder")
    parser.add_argument("--force", action="store_true", help="run again what the same code has left")
    options = parser.parse_args(argv)
    out = result_folder(options.out)
    reused = there(out) and not options.force
    frame = pd.read_csv(out / "verify.csv", keep_default_na=False, na_values=[""]) if reused else run_all(out)
    passed = bool(judged(frame)["pass"].all())
    print(study.table(overview(frame), FORMATS))
    for failed in judged(frame).query("not `pass`").itertuples():
        print(f"FAILED  {failed.case}, {failed.what}: {failed.value:.6g}, expected {failed.expected:.6g}, "
              f"error {failed.error:.2g} > {failed.tolerance:g}")
    print(f"\n{'all pass' if passed else 'NOT all pass'}: {shown(out)}/verify.csv and *.png")
    return 0 if passed else 1


def there(out: Path) -> bool:
    """Whether `out` holds a finished verification of the present code."""
    try:
        made = json.loads((out / "summary.json").read_text())["provenance"]["code"]
        return made == code_hash() and (out / "verify.csv").exists()
    except (OSError, ValueError, KeyError, TypeError):
        return False


def code_hash() -> str:
    """sha256 of the core, the verification scripts and what runs and judges them."""
    digest = hashlib.sha256(run.code_hash().encode())
    for path in [*sorted((ROOT / "tests/verification").glob("*.?dp")), Path(__file__), ROOT / "orchestrate/measure.py", REFERENCE / "converged.toml"]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def run_all(out: Path) -> pd.DataFrame:
    """Runs every case; all numbers, also in verify.csv, with the figures beside it. summary.json last."""
    program, frames = freefem.find(), []
    for old in (out / "summary.json", *out.glob("*.png")):
        old.unlink(missing_ok=True)
    for case in tqdm(CASES, disable=None, leave=False):
        rows, message = perform(case, out)
        frames.append(judge(case, rows, message))
        if not message:
            draw(case, rows, out)
    frame = pd.concat(frames, ignore_index=True)
    study.save(frame, out / "verify.csv")
    with study.complete(out / "summary.json") as part:
        passed, provenance = bool(judged(frame)["pass"].all()), {"code": code_hash(), "freefem": program.version}
        part.write_text(json.dumps({"passed": passed, "provenance": provenance}, indent=1))
    return frame


def perform(case: Case, out: Path) -> tuple[list[Row], str]:
    """The numbers of a case, as far as it came, and why it did not come to its end."""
    folder, rows = out / "runs" / slug(case), []
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    try:
        for row in case.rows(folder):
            rows.append(row)
    except Failure as failure:
        return rows, f"{failure}"
    return rows, ""


def slug(case: Case) -> str:
    """The name of the case as a file name."""
    return case.name.lower().replace(" ", "-")


# ---- verdicts

def judge(case: Case, rows: list[Row], message: str = "") -> pd.DataFrame:
    """The numbers as rows of COLUMNS, those that are judged with their tolerance, and what is judged over several sizes."""
    asked = math.nan if case.by_order else case.tolerance
    names = list(dict.fromkeys(row.what for row in rows))
    finest = {name: series(rows, name)[-1].size for name in names}
    lines = [(row.what, row.size, row.value, row.expected, row.error, asked if row.size == finest[row.what] else math.nan)
             for row in rows]
    if message:
        lines.append((message.splitlines()[0][:200], *[math.nan] * 4, case.tolerance))
    elif case.by_order:
        for name in names:
            before, last = series(rows, name)[-2:]
            found = math.log(before.error / last.error) / math.log(before.size / last.size)
            lines.append((f"order of {name}", last.size, found, last.order, abs(found - last.order), case.tolerance))
    else:
        order, size = observed(rows)
        lines.append((CONVERGES, size, order, math.nan, max(-order, 0.0), 0.0))
    return pd.DataFrame([(case.name, *line) for line in lines], columns=COLUMNS)


def series(rows: list[Row], what: str) -> list[Row]:
    """One number at its sizes, from coarse to fine."""
    return sorted((row for row in rows if row.what == what), key=lambda row: -row.size)


def observed(rows: list[Row]) -> tuple[float, float]:
    """The order of the largest error between the coarsest and the finest size, of the numbers that have several; the finest."""
    several = [each for what in dict.fromkeys(row.what for row in rows) if len(each := series(rows, what)) > 1]
    first, last = max(each[0].error for each in several), max(each[-1].error for each in several)
    return math.log(first / last) / math.log(several[0][0].size / several[0][-1].size), several[0][-1].size


def judged(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows that have a tolerance, with their verdict `pass`; no number is no pass."""
    rows = frame[frame.tolerance.notna()]
    return rows.assign(**{"pass": rows.error <= rows.tolerance})


# How columns are shown: of all numbers, and of the overview
NUMBERS = {"what": "", "size": "g", "value": ".7g", "expected": ".7g", "error": ".2g", "tolerance": "g"}
FORMATS = {"case": "", "checks": "d", "worst": "", "value": ".6g", "expected": ".6g", "error": ".2g", "tolerance": "g",
           "order": ".2f", "verdict": ""}


def overview(frame: pd.DataFrame) -> pd.DataFrame:
    """A row a case: how many numbers are judged, the one nearest to (or farthest beyond) its tolerance, order and verdict."""
    lines = []
    for name, rows in judged(frame).groupby("case", sort=False):
        near = (rows.error / rows.tolerance).where(rows["pass"], math.inf).fillna(0)
        worst, order = rows.loc[near.idxmax()], rows[rows.what == CONVERGES].value
        lines.append({"case": name, "checks": len(rows), "worst": worst.what}
                     | worst[["value", "expected", "error", "tolerance"]].to_dict()
                     | {"order": order.iloc[0] if len(order) else math.nan, "verdict": "pass" if rows["pass"].all() else "FAIL"})
    return pd.DataFrame(lines)


# ---- figures

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK, "#56b4e9")                                   # a group of numbers each
LOOKS = (dict(marker="o", markersize=4), dict(marker="s", markersize=7, fillstyle="none", linestyle="--"),
         dict(marker="^", markersize=7, fillstyle="none", linestyle=":"))                    # and in the group


def draw(case: Case, rows: list[Row], out: Path) -> None:
    """The errors over the size, and beside them the case's own picture where it has one."""
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(1, 2 if case.beside else 1, figsize=(9, 3.6) if case.beside else (6.4, 3.8), squeeze=False)
        draw_errors(grid[0, 0], case, rows)
        if case.beside:
            case.beside(grid[0, 1], out / "runs" / slug(case))
            grid[0, 0].legend(loc="lower right")
        else:
            figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside right center")
        figure.suptitle(f"{case.name}: {case.title}", fontsize=9)
        figure.savefig(out / f"{slug(case)}.png")
        plt.close(figure)


def draw_errors(axes: plt.Axes, case: Case, rows: list[Row]) -> None:
    """The errors over the size, log-log, with the expected orders and the tolerance."""
    groups: dict[str, int] = {}
    for name in dict.fromkeys(row.what for row in rows):
        group, line = name.partition(":")[0], series(rows, name)
        groups[group] = groups.get(group, -1) + 1
        axes.loglog([row.size for row in line], [max(row.error, SHOWN) for row in line], label=name,
                    color=COLOURS[list(groups).index(group) % len(COLOURS)], **LOOKS[groups[group] % len(LOOKS)])
    for order in dict.fromkeys(row.order for row in rows if row.order):
        line = max((series(rows, row.what) for row in rows if row.order == order), key=lambda line: line[-1].error)
        sizes = np.array([row.size for row in line])
        errors = 0.6 * min(row.error / row.size**order for row in line) * sizes**order
        axes.loglog(sizes, errors, color=GREY, linewidth=1)
        axes.annotate(f"order {order:.2g}", (sizes[-1], errors[-1]), (4, -2), textcoords="offset points", color="#666666",
                      ha="left", va="top", bbox=dict(facecolor="white", edgecolor="none", alpha=0.8, pad=1))
    if not case.by_order:
        axes.axhline(case.tolerance, color=BLACK, linestyle="--", linewidth=0.8, label="asked of the finest")
    sizes = sorted({row.size for row in rows})
    axes.set_xticks(sizes, [f"{size:.4g}" for size in sizes])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.margins(y=0.1)
    hidden = any(row.error < SHOWN for row in rows)
    axes.set(xlabel=case.axis, ylabel="relative error" + " (below $10^{-6}$ drawn there)" * hidden)
    axes.grid(alpha=0.3)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
