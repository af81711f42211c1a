"""Run time against error on one core.

Each case runs with many settings. The errors of its results are relative to our two finest runs,
and the report lists the cheapest setting for 5 %, 1 % and 0.1 %. Other programs that are installed
(peers.py) solve the same problems.
"""

import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.ticker import LogLocator, NullFormatter

from ffimpact import scene
from ffimpact.failure import unknown
from ffimpact.mesh import mesh
from ffimpact.output.results import read_history
from ffimpact.places import shown
from ffimpact.progress import in_turn
from ffimpact.report.figures import BLACK, BLUE, GREEN, GREY, LAWS, ORANGE, PURPLE, STYLE, save
from ffimpact.scenes.sizes import made_for
from ffimpact.sweeps import study
from ffimpact.sweeps.sweep_figures import distance, force
from verification import commands

from . import peers

LEVELS = (5.0, 1.0, 0.1)  # error levels of the tables [%]
# Error levels of the headline [%]: of all results but the contact time, and of the contact time. A
# setting must satisfy both.
HEADLINE, HEADLINE_CONTACT = 0.5, 1.0
LIMIT = 600.0  # longest time of a run [s]
# Settings of the other programs by case: program, form, mesh factor and dt [s]. The first setting
# of each program is its cheapest one with an error of at most 0.5 %.
PEERS = {
    "normal-svk": [("ngsolve", "tuned", 2, 1.5e-4), ("ngsolve", "tuned", 2, 1e-4), ("ngsolve", "tuned", 1, 1e-4),
                   ("ngsolve", "tuned", 1, 5e-5), ("ngsolve", "tuned", 1, 2e-5), ("ngsolve", "plain", 2, 1.5e-4),
                   ("ngsolve", "plain", 1, 1e-4), ("ngsolve", "plain", 1, 5e-5), ("getfem", "tuned", 2, 1.5e-4),
                   ("getfem", "tuned", 1, 1e-4), ("getfem", "tuned", 1, 5e-5), ("getfem", "tuned", 1, 2e-5),
                   ("getfem", "plain", 2, 1.5e-4), ("getfem", "plain", 1, 1e-4), ("textbook", "FreeFEM", 2, 1e-4),
                   ("textbook", "FreeFEM", 1, 5e-5)],
    "ball-axisymmetric": [("ngsolve", "tuned", 2, 1.5e-4), ("ngsolve", "tuned", 2, 1e-4), ("ngsolve", "tuned", 1, 1e-4),
                          ("ngsolve", "tuned", 1, 5e-5)],
    "ball": [("ngsolve", "tuned", 4, 1.5e-4), ("ngsolve", "tuned", 3, 1e-4), ("ngsolve", "tuned", 2, 1e-4), ("ngsolve", "tuned", 2, 5e-5)],
}
PEERS_QUICK = {"normal-svk": [("ngsolve", "tuned", 1, 1e-4), ("textbook", "FreeFEM", 2, 1e-4)],
               "ball-axisymmetric": [("ngsolve", "tuned", 1, 1e-4)], "ball": [("ngsolve", "tuned", 4, 1.5e-4)]}
# Disc on block: the refinements of NGSolve's own mesh (peers.two_bodies), and NGSolve's names of
# our results.
REFINEMENTS, REFINEMENTS_QUICK = (0.25, 0.5, 0.75, 1.0), (0.25, 0.5)
NGSOLVE = {"rebound_vy_1": "velocity_upper", "rebound_vy_2": "velocity_lower", "vibration_energy_1": "vibration_upper",
           "vibration_energy_2": "vibration_lower", "thresholded_contact_time": "contact_time_1_percent"}


@dataclass(frozen=True)
class Case:
    """A problem that is solved with many settings.

    scene: name of the built-in scene; base: entries that are set in it
    answers: names of the results whose errors are measured
    finest: smallest accuracy for which meshes and time steps are made
    scale: factor of prescribed sizes and steps, 1 for the disc of radius 0.05 m
    families: names of the families of settings; empty for all of them
    like: the case whose reference is used; empty for the case's own reference
    """

    scene: str
    base: study.Point
    answers: tuple[str, ...]
    finest: float = 0.00125
    scale: float = 1.0
    families: tuple[str, ...] = ()
    like: str = ""

    @property
    def finer(self) -> float:
        """The accuracy of the scene over the accuracy for which its mesh and steps are made."""
        values = scene.load(self.scene).values
        return values["accuracy"] / made_for(values["accuracy"], values["accuracy_of"])

    def sized(self, factor: float, dt: float, **entries) -> study.Point:
        """Sizes `factor` times those of peers.sized() and step dt [s], both multiplied by `scale`.
        """
        return peers.sized(self.scale * factor, dt=float(f"{self.scale * dt:.6g}"), **entries)


BALL = {"law": "neohookean", "nu": 0.45, "speed": 8.0, "penalty": 1.5e10}
CASES = {
    "normal-svk": Case("disc-normal", {"law": "svk"}, ("impulse", "rebound_vy", "contact_time")),
    "normal-neohookean": Case("disc-normal", {"law": "neohookean"}, ("impulse", "rebound_vy", "contact_time")),
    "normal-incompressible": Case("disc-normal-incompressible", {"law": "incompressible"}, ("impulse", "rebound_vy", "contact_time"),
                                  families=("adaptive, P2", "fixed step, P2")),
    "oblique-neohookean": Case("disc-oblique", {"law": "neohookean"},
                               ("impulse", "rebound_vx", "rebound_vy", "rebound_spin", "friction_work", "contact_time"), 0.000625),
    "disc-block-svk": Case("disc-block", {"law": "svk", "penalty": 1e9}, tuple(NGSOLVE), 0.005, 20),
    "ball-axisymmetric": Case("ball-axisymmetric", BALL, ("impulse", "rebound_vy", "contact_time")),
    "ball": Case("ball", BALL, ("impulse", "rebound_vy", "contact_time"), 0.005,
                 families=("adaptive, P2", "midpoint", "central-difference"), like="ball-axisymmetric"),
}


def main(argv: list[str]) -> int:
    """Runs all settings in sequence and writes bench.csv, bench.md and one figure for each case.

    Returns 0. Raises study.Failure if a reference run fails.
    """
    parser = commands.command("bench", __doc__)
    parser.add_argument("cases", metavar="CASE", nargs="*", default=list(CASES), help=f"(default: {' '.join(CASES)})")
    parser.add_argument("--quick", action="store_true",
                        help="the first case, coarse settings only, a coarser reference; under three minutes")
    options = parser.parse_args(argv)
    for name in options.cases:
        if name not in CASES:
            parser.error(unknown(name, CASES, ", "))
    out, tables, pages = options.out, [], []
    cases = options.cases[:1] if options.quick else options.cases
    for name in in_turn("bench", cases):
        rows, bars = measure(name, out, options.quick)
        draw(name, rows, bars, out / f"{name}.png")
        tables.append(rows)
        pages.append(page(name, rows, bars))
    study.save(pd.concat(tables), out / "bench.csv")
    text = f"# Run time against error\n{commands.measured(['bench', *argv])}\n\n{HEAD}" + "\n\n".join(pages) + "\n"
    with study.complete(out / "bench.md") as part:
        part.write_text(text)
    print(text + f"\n{shown(out)}/bench.csv, bench.md, " + ", ".join(f"{name}.png" for name in cases))
    return 0


HEAD = """One process, one thread; seconds are processor time: of ours the whole process, start-up and set-up included; of the other \
programs the
march alone, without imports and set-up (up to 0.4 s). Errors are
relative to the mean of our two finest runs; ± is half their difference, and no error below it is known. The force error is the L2
norm over time of the difference of the force histories over that of the reference.

"""


# ---- the settings

def settings(case: Case, quick: bool) -> dict[str, list[study.Point]]:
    """The settings of each family, from coarse to fine."""
    return {family: points for family, points in (coarse(case) if quick else grid(case)).items() if family in case.families
            or not case.families}


def adaptive(case: Case, accuracies: Iterable[float], **entries) -> list[study.Point]:
    """One setting for each of the `accuracies` for which meshes and steps are made."""
    return [{"accuracy": min(0.4, case.finer * accuracy)} | entries for accuracy in accuracies]


def coarse(case: Case) -> dict[str, list[study.Point]]:
    """The settings of the option --quick, by family."""
    return {"adaptive, P2": adaptive(case, (0.1, 0.05, 0.02, 0.01, 0.005)), "adaptive, P1": adaptive(case, (0.02, 0.005), degree=1),
            "fixed step, P2": [case.sized(1, 1e-4), case.sized(1, 4e-5)],
            "midpoint": adaptive(case, (0.02, 0.005), integrator="midpoint"), "bdf2": adaptive(case, (0.02, 0.005), integrator="bdf2")}


def grid(case: Case) -> dict[str, list[study.Point]]:
    """All settings, by family."""
    families = {
        "adaptive, P2": adaptive(case, [a for a in (0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125, 0.000625) if a >= case.finest]),
        "adaptive, P1": adaptive(case, (0.02, 0.005, 0.00125, 0.0005), degree=1),
        "fixed step, P2": [case.sized(factor, dt)
                           for factor, dt in ((2, 1.5e-4), (2, 1e-4), (2, 5e-5), (1, 1e-4), (1, 5e-5), (1, 2e-5), (0.5, 2e-5))],
        "fixed step, P1": [case.sized(factor, dt, degree=1) for factor, dt in ((1, 5e-5), (0.5, 5e-5), (0.5, 2e-5))],
    }
    for integrator in ("midpoint", "backward-euler", "bdf2"):
        families[integrator] = adaptive(case, [a for a in (0.02, 0.005, 0.00125) if a >= case.finest], integrator=integrator)
    families["central-difference"] = adaptive(case, (0.02, 0.005), integrator="central-difference")
    return families


def references(case: Case, quick: bool) -> list[study.Point]:
    """The two reference runs: one with a small accuracy, one with a prescribed mesh and step."""
    if quick:
        return [{"accuracy": 0.0006}, case.sized(0.7, 2e-5)]
    return [{"accuracy": 0.12 * case.finest * case.finer}, case.sized(min(0.4, float(f"{0.4 * (case.finest / 0.00125) ** 0.5:.3g}")), 6e-6)]


# ---- the measurement

def measure(name: str, out: Path, quick: bool) -> tuple[pd.DataFrame, dict[str, float]]:
    """Runs a case. Returns a table and the error bars of the reference [%] by result.

    Each row of the table is a setting: case, program, family, parameters, processor seconds, and
    the errors [%] of all results and of the force history. Raises study.Failure if a reference run
    fails.
    """
    case, folder = CASES[name], out / name
    families = settings(case, quick)
    labels = [(family, point) for family, points in families.items() for point in points]
    reference_case = CASES[case.like or name]
    fine_points, best_folder = references(reference_case, quick), out / (case.like or name)
    fine = study.study(fine_points, best_folder, {"fields": 0} | reference_case.base, LIMIT, reference_case.scene, cores=1)
    rows = study.study([point for _, point in labels], folder, {"fields": 0} | case.base, LIMIT, case.scene, cores=1)
    if fine.exit.any():
        raise study.Failure(f"bench: the reference of {name} failed: {fine.message[fine.exit != 0].iloc[0]}", code=int(fine.exit.max()))
    histories = [force_of(study.place(best_folder, point)) for point in fine_points]
    best = fine[list(case.answers)].mean()
    bars = {answer: 50 * abs(fine[answer].iloc[0] - fine[answer].iloc[1]) / abs(best[answer]) for answer in case.answers}
    bars["force"] = 100 * distance(*histories)
    table = pd.DataFrame({"case": name, "program": "ffimpact", "family": [family for family, _ in labels],
                          "setting": [_words(point) for _, point in labels], "dofs": rows.dofs, "steps": rows.steps,
                          "seconds": rows.cpu_seconds, "exit": rows.exit, "message": rows.message})
    for answer in case.answers:
        table[f"{answer}_error"] = 100 * (rows[answer] / best[answer] - 1).abs()
    table["force_error"] = [100 * distance(histories[0], force_of(study.place(folder, point))) if code == 0 else np.nan
                            for (_, point), code in zip(labels, rows.exit)]
    if others := (PEERS_QUICK if quick else PEERS).get(name):
        ours = {study.place(folder, point) for (_, point), code in zip(labels, rows.exit) if code == 0}
        table = pd.concat([table, _peers(case, others, best, histories[0], out / "peers", folder, ours).assign(case=name)],
                          ignore_index=True)
    if case.scene == "disc-block":
        table = pd.concat([table, _two_bodies(case, best, histories[0], out / "peers", quick).assign(case=name)], ignore_index=True)
    return table, bars


def force_of(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """The times [s] and normal forces of a run."""
    return force(read_history(folder))


def _words(point: study.Point) -> str:
    sizes = f"h = {1e3 * point['mesh_size']:.3g} mm" if "mesh_size" in point else ""
    rest = [f"{key} {value:g}" for key, value in point.items() if key in ("accuracy", "dt")]
    return ", ".join(filter(None, [sizes, *rest]))


def _peers(case: Case, others: list[tuple], best: pd.Series, force: tuple[np.ndarray, np.ndarray], out: Path, folder: Path,
           ours: set[Path]) -> pd.DataFrame:
    """Runs the settings `others` of other programs and returns rows of the same table.

    A program that is not installed or fails gives a row with the reason. `force_from_ours` compares
    the force history with that of our run with the same sizes and step. The column is filled where
    that run, in `folder`, is one of `ours`.
    """
    rows = []
    for program, form, factor, dt in in_turn("others", others):
        sizes = peers.sized(factor)
        history = _history(out, f"{case.scene}-{program}-{form}-{factor:g}-{dt:g}")
        row = {"program": f"{program}, {form}", "family": f"{program}, {form}", "setting": _words(sizes | {"dt": dt})}
        if program == "textbook":
            output, reason = _textbook(sizes, dt, out), ""
        else:
            output, reason = peers.run(program, form, sizes["mesh_size"], sizes["contact_mesh_size"], dt, LIMIT, scene=case.scene,
                                       history=str(history), **case.base)
        row |= _other(output, reason, best, {answer: answer for answer in ("impulse", "rebound_vy", "contact_time")})
        if output and history.exists():
            t, values = np.loadtxt(history, delimiter=",", skiprows=1).T
            row["force_error"] = 100 * distance(force, (t - dt / 2, values))
            if (same := study.place(folder, sizes | {"dt": dt})) in ours:
                row["force_from_ours"] = 100 * distance((t - dt / 2, values), force_of(same))
        rows.append(row)
    return pd.DataFrame(rows)


def _two_bodies(case: Case, best: pd.Series, force: tuple[np.ndarray, np.ndarray], out: Path, quick: bool) -> pd.DataFrame:
    """Rows of the same table for NGSolve's disc on a block, one for each refinement of its mesh.

    A run that fails gives a row with the reason.
    """
    rows = []
    for refine in in_turn("NGSolve", REFINEMENTS_QUICK if quick else REFINEMENTS):
        history = _history(out, f"two-bodies-{refine:g}")
        output, reason = peers.two_bodies(LIMIT, refine=refine, history=str(history), **case.base)
        rows.append({"program": "ngsolve", "family": "ngsolve, central differences", "setting": f"refine {refine:g}"}
                    | _other(output, reason, best, NGSOLVE))
        if output:
            rows[-1]["force_error"] = 100 * distance(force, tuple(np.loadtxt(history, delimiter=",", skiprows=1, usecols=(0, 1)).T))
    return pd.DataFrame(rows)


def _history(out: Path, name: str) -> Path:
    """The file for the force history of another program. Its folder is created."""
    out.mkdir(parents=True, exist_ok=True)
    return out / f"{name}.csv"


def _other(output: dict | None, reason: str, best: pd.Series, answers: dict[str, str]) -> dict:
    """A row from the `output` of another program: unknowns, steps, seconds and errors [%].

    `answers` maps our names of the results to the names in `output`. If `output` is empty, the row
    has the `reason`.
    """
    if not output:
        return {"exit": 1, "message": reason}
    return {"exit": 0, "message": reason, "dofs": output["dofs"], "steps": output["steps"], "seconds": output["cpu_seconds"]} | {
        f"{ours}_error": 100 * abs(output[theirs] / best[ours] - 1) for ours, theirs in answers.items() if theirs in output}


def _textbook(sizes: study.Point, dt: float, out: Path) -> dict:
    """The results of the textbook FreeFEM script on our mesh of these sizes, with step dt [s]."""
    problem = scene.load("disc-normal").override(sizes | {"dt": dt, "end_time": 5.2e-3})
    path = out / f"textbook-{sizes['mesh_size']:g}.msh"
    mesh.write(mesh.disc(peers.RADIUS, sizes["mesh_size"], sizes["contact_mesh_size"], half=True), path)
    return peers.textbook(problem, path)


# ---- the page

def errors(name: str) -> dict[str, str]:
    """The columns of the errors of a case and their headings."""
    return {f"{answer}_error": answer.replace("_", " ") for answer in CASES[name].answers} | {"force_error": "force history (L2)"}


def page(name: str, rows: pd.DataFrame, bars: dict[str, float]) -> str:
    """The case as Markdown: the cheapest setting for each level and result, then all settings."""
    columns = errors(name)
    lines = [f"## {name}", f"![error over time]({name}.png)", "",
             "reference ± [%]: " + ", ".join(f"{words} {bars[column.removesuffix('_error')]:.2g}" for column, words in columns.items()), "",
             "Cheapest setting [s of processor time]:", ""]
    together = [column for column in columns if "impulse" in column or "rebound" in column]
    for words, error_columns in [("impulse and rebound together", together), *((words, [column]) for column, words in columns.items())]:
        entries = [{words: program} | {f"{level:g} %": cheapest(group, error_columns, level) for level in LEVELS}
                   for program, group in rows.groupby("program", sort=False)]
        lines += [study.table(pd.DataFrame(entries), dict.fromkeys(entries[0], "")), ""]
    limits = {answer: HEADLINE_CONTACT if answer.endswith("contact_time") else HEADLINE for answer in CASES[name].answers
              if answer != "friction_work"}
    headline = {f"{answer}_error": level for answer, level in limits.items()}
    entries = [{"program": program, "cheapest": cheapest(group, list(headline), np.array(list(headline.values())))}
               for program, group in rows.groupby("program", sort=False)]
    lines += ["At most " + ", ".join(f"{level:g} % in {answer.replace('_', ' ')}" for answer, level in limits.items()) + ":", "",
              study.table(pd.DataFrame(entries), dict.fromkeys(entries[0], "")), ""]
    if "force_from_ours" in rows and rows.force_from_ours.notna().any():
        lines += ["Force history against that of our run with the same sizes and step, in % (L2; GetFEM takes our mesh, NGSolve makes its "
                  "own):", "",
                  study.table(rows[rows.force_from_ours.notna()], {"program": "", "setting": "", "force_from_ours": ".2f"}), ""]
    lines += ["All settings; errors in %:", ""]
    shown_rows = rows.rename(columns={column: words for column, words in columns.items()})
    lines.append(study.table(shown_rows, {"family": "", "setting": "", "dofs": ".0f", "steps": ".0f", "seconds": ".2f"}
                             | dict.fromkeys(columns.values(), ".3g")))
    failed = rows[rows.exit != 0]
    lines += [f"- {row.family} {row.setting}: {row.message}" for row in failed.itertuples()]
    return "\n".join(lines)


def cheapest(rows: pd.DataFrame, columns: list[str], level: float | np.ndarray) -> str:
    """The cheapest setting whose errors in all `columns` are at most `level`, in words.

    `level` [%] is one number or one number for each column. Returns "none" if there is no such
    setting.
    """
    good = rows[(rows.exit == 0) & (rows[columns] <= level).all(axis=1)].sort_values("seconds")
    return next((f"{row.seconds:.2f} s: {row.family}" + f", {row.setting}" * bool(row.setting) for row in good.itertuples()), "none")


def draw(name: str, rows: pd.DataFrame, bars: dict[str, float], path: Path) -> None:
    """Draws error [%] over processor time [s], one panel for each result and one line for each
    family.

    Errors below the error bar of the reference are grey.
    """
    columns = errors(name)
    styles = itertools.product(("-", "--", ":"), (BLUE, ORANGE, GREEN, PURPLE, BLACK))
    looks = {family: style for family, style in zip(rows.family.unique(), styles)}
    with plt.rc_context(STYLE):
        wide = 2 if len(columns) <= 4 else 3
        figure, grid = plt.subplots(-(-len(columns) // wide), wide, figsize=(4.2 * wide, 3.2 * -(-len(columns) // wide)), squeeze=False,
                                    sharex=True)
        for axes in grid.flat[len(columns):]:
            axes.set_axis_off()
        for axes, (column, words) in zip(grid.flat, columns.items()):
            for family, group in rows[rows.exit == 0].groupby("family", sort=False):
                line, colour = looks[family]
                group = group.sort_values("seconds")
                axes.loglog(group.seconds, group[column].clip(lower=1e-4), color=colour, linestyle=line,
                            marker="os^"[("-", "--", ":").index(line)], markersize=3.5, linewidth=1.1, label=family)
            axes.axhspan(1e-4, max(1e-4, bars[column.removesuffix("_error")]), color=GREY, alpha=0.25, linewidth=0)
            axes.set(title=words, ylabel="error [%]")
            axes.grid(alpha=0.3)
        # The lowest panel of each column.
        for axes in grid.flat[max(0, len(columns) - wide):len(columns)]:
            axes.tick_params(labelbottom=True)
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_xlabel("processor time [s]")
        law = CASES[name].base["law"]
        figure.suptitle(f"{CASES[name].scene}, {LAWS[law]}; grey: below the error bar of the reference", fontsize=9)
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        with study.complete(path) as part:
            save(figure, part)
