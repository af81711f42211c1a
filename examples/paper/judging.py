"""The basis for judging the statements of the paper: verdicts, results of `make paper`, error bars.

Every verdict follows from numbers by the criterion in the docstring of its statement (limits,
friction, impacts, pairs, bodies, times). Section 3 uses the paper's law, St. Venant-Kirchhoff (5),
except where it refers to (6). The verdict depends on this law; the neo-Hookean result, which
converges, is given beside it.

If this law loses ellipticity in a decisive run, the result depends on the mesh, and "agrees"
becomes "partly" (`_on_any_mesh`) for any statement. The exception is what every step conserves
exactly on any mesh: the discrete energy and momentum.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache, wraps
from pathlib import Path

import numpy as np
import pandas as pd

from ffimpact.output.evaluate import evaluate
from ffimpact.output.results import read_frame, read_history, read_scene, read_summary
from ffimpact.report.impact import impact_of
from ffimpact.report.impacts import read_modes
from ffimpact.sweeps import study, sweep, sweep_figures

from . import scripts

AGREES, DIFFERS, PARTLY, OPEN = "agrees", "does not agree", "partly", "not decided"
# A change of energy below this share of the initial energy counts as constant.
CONSTANT = 1e-9
LAWS = {"svk": "SVK", "neohookean": "neo-Hookean"}  # the paper's law first

History = dict[str, np.ndarray]


@dataclass(frozen=True)
class Finding:
    """The verdict on a statement, our number in words, the figures, and the folders of the runs."""

    verdict: str
    ours: str
    figures: list[Path] = field(default_factory=list)
    runs: list[Path] = field(default_factory=list)


class Results:
    """The finished cases in a folder of results, by the names of runs and sweeps; also histories,
    summaries and modes of the runs of pair()."""

    def __init__(self, folder: Path):
        self.folder = folder

    def run(self, name: str) -> Path:
        return self.folder / name

    def summary(self, name: str) -> dict:
        return read_summary(self.run(name))

    def history(self, name: str) -> History:
        return read_history(self.run(name))

    def scene(self, name: str) -> dict:
        """The scene as used, that of a disc or ball on the plane as an impact (speed, angle)."""
        used = read_scene(self.run(name))
        return impact_of(used) or used

    def sweep(self, name: str) -> Path:
        return self.folder / "sweeps" / name

    def drawn(self, *names: str) -> list[Path]:
        """The figures of sweeps and of runs ("run/kind"). A name with .png is the path of a figure.
        """
        return [self.folder / name if name.endswith(".png") else self.sweep(name) / "sweep.png" if name in sweep.built_in()
                else self.folder / f"{name.replace('/', '/figures/')}.png" for name in names]

    def table(self, name: str) -> pd.DataFrame:
        """The points of a sweep, from its runs, with the angle of a direction to the plane."""
        rows = sweep.table(loaded(name), self.sweep(name))
        return rows.assign(angle=-rows.direction) if "direction" in rows else rows

    def folders(self, *names: str) -> list[Path]:
        """The folders of runs, and of all runs of sweeps."""
        return [folder for name in names for folder in ([study.place(self.sweep(name), point) for point in loaded(name).runs]
                                                        if name in sweep.built_in() else [self.run(name)])]

    def pair(self, name: str, **values) -> list[Path]:
        """The runs of the point of a sweep with these values: plain and, if the sweep has a
        refinement, refined."""
        plan = loaded(name)
        point = next(point for point in plan.points if values.items() <= point.items())
        return [study.place(self.sweep(name), point | more) for more in ([{}, plan.refine] if plan.refine else [{}])]

    def histories(self, name: str, **values) -> list[History]:
        return [read_history(folder) for folder in self.pair(name, **values)]

    def summaries(self, name: str, **values) -> list[dict]:
        return [read_summary(folder) for folder in self.pair(name, **values)]

    def modes(self, name: str, **values) -> list[np.recarray]:
        return [read_modes(folder) for folder in self.pair(name, **values)]

    def by_scripts(self, formulation: str, width: str | float) -> list[dict]:
        """The summaries of the paper's script of the disc on the block on both meshes."""
        folders = [self.folder / scripts.FOLDER / name for name in scripts.pair(formulation, width)]
        for folder in folders:
            evaluate(folder)
        return [read_summary(folder) for folder in folders]

    def friction_laws(self) -> pd.DataFrame:
        """The table of figure 3."""
        return read_frame(self.folder / "friction-laws/laws.csv")

    def stick_slip(self) -> pd.DataFrame:
        """The table of the search for the paper's order of sliding and sticking."""
        return read_frame(self.folder / "stick-slip/stick-slip.csv")


@cache
def loaded(name: str) -> sweep.Sweep:
    return sweep.load(name)


# ---- the statements, in the order of the paper

STATEMENTS: list[tuple[str, str, Callable[[Results], Finding]]] = []
# Times at which runs with St. Venant-Kirchhoff lost ellipticity [s]; None or nan if they kept it.
Lost = list[float | None]


def states(item: str, text: str, runs: str | Callable[[Results], list[Path]] = "", figures: str | None = None,
           lost: Callable[[Results], Lost] = lambda results: [], exact: bool = False, laws: str = "") -> Callable:
    """Registers the criterion for a statement of the paper. The criterion returns the verdict and
    our number in words, and optionally `lost`.

    runs: names of the runs and sweeps that it uses
    figures: names as in Results.drawn(); by default those of its sweeps
    lost: the times of lost ellipticity of the decisive runs
    exact: the statement is about quantities that every step conserves exactly, on any mesh
    laws: if set, the criterion takes one law, and the words for both laws replace {} in this text;
        see of_laws()
    """
    def register(rule: Callable) -> Callable[[Results], Finding]:
        @wraps(rule)
        def judged(results: Results) -> Finding:
            verdict, ours, *more = of_laws(rule, results, laws) if laws else rule(results)
            folders = results.folders(*runs.split()) if isinstance(runs, str) else runs(results)
            shown = [name for name in runs.split() if name in sweep.built_in()] if figures is None else figures.split()
            if verdict == AGREES:
                verdict, ours = _on_any_mesh(ours, more[0] if more else lost(results), exact)
            return Finding(verdict, ours, results.drawn(*shown), folders)
        STATEMENTS.append((item, text, judged))
        return judged
    return register


def lost(*which: str | tuple[str, dict]) -> Callable[[Results], Lost]:
    """The times [s] at which runs, or the runs of points (sweep, values) on both meshes, lose
    ellipticity."""
    def times(results: Results) -> Lost:
        ends = [results.summaries(item[0], **item[1]) if isinstance(item, tuple) else [results.summary(item)] for item in which]
        return [end["ellipticity_lost_time"] for group in ends for end in group]
    return times


def _on_any_mesh(ours: str, lost: Lost, exact: bool) -> tuple[str, str]:
    """The verdict and words of a statement that agrees for St. Venant-Kirchhoff.

    "agrees" becomes "partly" if a decisive run lost ellipticity, as another mesh may give another
    verdict, unless the statement is `exact`.
    """
    if not (times := [time for time in lost if is_known(time)]):
        return AGREES, ours
    since = f"SVK loses ellipticity from {1e3 * min(times):.2f} ms on"
    if exact:
        return AGREES, f"{ours} ({since}; but this is kept exactly by every step, on any mesh.)"
    return PARTLY, f"{ours} Partly: {since}, from where its answer depends on the mesh."


def graded(agrees: bool, partly: bool = False) -> str:
    """The verdict if the statement agrees, or else agrees partly."""
    return AGREES if agrees else PARTLY if partly else DIFFERS


def of_laws(rule: Callable[[Results, str], tuple], results: Results, around: str) -> tuple[str, str]:
    """(verdict, words) for both laws.

    If the criterion returns (agrees, words) for each law, the verdict is "agrees" for both laws,
    "partly" for the paper's law only, and else "does not agree". If it returns (verdict, words,
    text at the end), the paper's law gives the verdict.
    """
    verdicts = {law: rule(results, law) for law in LAWS}
    (paper, _, *remarks), (other, *_) = verdicts.values()
    words = around.format("; ".join(f"{LAWS[law]}: {own}" for law, (_, own, *_) in verdicts.items()))
    return paper if remarks else graded(paper and other, paper), words + "".join(remarks)


def finished(results: Results, name: str) -> pd.DataFrame:
    """The points of a sweep that finished."""
    rows = results.table(name)
    return rows[rows.exit == 0]


def bar(rows: pd.DataFrame, column: str, **values) -> tuple[float, float]:
    """(value, error bar) of the point with these values. The error bar is at least the root mean
    square of those of `rows`."""
    here = np.logical_and.reduce([rows[name] == value for name, value in values.items()])
    return float(rows[column][here].iloc[0]), float(sweep_figures.bars(rows, column)[here][0])


def touching(history: History) -> np.ndarray:
    """The indices of the steps from the first to the last contact."""
    steps = np.flatnonzero(history["normal_force"] > 0)
    return np.arange(steps[0], steps[-1] + 1)


def maxima(values: np.ndarray, least: float) -> int:
    """The number of prominent maxima: between two of them the values fall and rise again by more
    than `least`."""
    count, low, high, rising = 0, values[0], values[0], True
    for value in values:
        if rising and value < high - least:
            count, rising, low = count + 1, False, value
        elif not rising and value > low + least:
            rising, high = True, value
        low, high = min(low, value), max(high, value)
    return count


def both(values: Iterable, form: str = "") -> str:
    """The numbers of both meshes, or steps, in words, with a format such as ".1f"."""
    return " and ".join(format(value, form) for value in values)


def when(time: float | None, words: str) -> str:
    """The time [s] from which a condition holds in a run, in words."""
    return f"{words} from {1e3 * time:.2f} ms on" if is_known(time) else f"{words}: never"


def is_known(time: float | None) -> bool:
    """Whether a time of the summary exists."""
    return time is not None and not np.isnan(time)


def both_times(summary: dict) -> str:
    """The contact time, and the time between the crossings of 1 % of the peak force, in words."""
    return f"{1e3 * summary['contact_time']:.3f} ms (above 1 % of the peak force {1e3 * summary['thresholded_contact_time']:.3f} ms)"
