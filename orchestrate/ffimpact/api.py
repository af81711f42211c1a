"""The functions run(), sweep() and plan(), which run scenes from a Python script or a notebook, or
foretell what a run will take.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from .failure import BadInput, brief, suggestion, unknown
from .freefem import freefem
from .input.parameter import plain
from .input.parameters import PARAMETERS
from .places import RESULTS
from .progress import muted
from .result import Progress, Result, of_run
from .running import run as running
from .running.plan import Plan
from .scene import Scene
from .sweeps.study import place, study

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Plan", "Progress", "Study", "plan", "run", "sweep"]

ARGUMENTS = ("out", "force", "estimate", "figures", "progress", "watch")  # of run()


def run(
    scene: Scene | str | Path,
    entries: Mapping[str, Any] | None = None,
    *,
    out: str | Path | None = None,
    force: bool = False,
    estimate: bool = True,
    figures: bool = True,
    progress: bool | None = None,
    watch: Callable[[Progress], object] | None = None,
    **more: Any,
) -> Result:
    """Runs a scene and returns its result. `scene` is a Scene, the name of a built-in scene or the
    path of a TOML file.

    Entries of the scene are set by keywords (accuracy=0.005) or by dotted names
    (entries={"body.1.young": 2e6}). `out` is the result folder. Its default is results/NAME for a
    file or a built-in scene; a Scene object gets a folder of its own. A finished run in the folder
    is reused unless `force` is set. With `estimate` coarser runs estimate the errors, and with
    `figures` the figures are drawn. Progress is shown unless `progress` is False: as a line that
    changes, in a pipe or a file as a line every 20 s or more. `watch` is called with the Progress of
    the first run, not of coarser and finer ones, about every 10 ms, after a step; if it returns True
    the run ends within some steps, without an error estimate, and is never reused. A reused run calls
    nothing. If the scene does not set `fields`, the run keeps 60 states. The folder has
    the files that the command `ffimpact run` leaves. Raises the exceptions of ffimpact: BadInput,
    StepFailed and so on.
    """
    if not isinstance(out or "", str | Path):
        raise BadInput(f"out: '{out}' is no path (accepted: that of a folder)")
    overrides = _overrides(entries, more)
    with muted(progress is False):
        loaded, default_folder = _loaded(scene, overrides)
        return of_run(
            loaded,
            overrides,
            out or default_folder,
            force=force,
            estimate=estimate,
            figures=figures,
            progress=progress,
            watch=watch,
        )


def plan(
    scene: Scene | str | Path,
    entries: Mapping[str, Any] | None = None,
    *,
    estimate: bool = True,
    **more: Any,
) -> Plan:
    """Foretells what run() with the same arguments will take: mesh, steps, processor time and memory.

    The mesh is made and the solver started. It takes steps for a second, whose time is extrapolated.
    Nothing is written. Printing the Plan shows it as a table. Raises the exceptions of run().
    """
    overrides = _overrides(entries, more)
    loaded, _ = _loaded(scene, overrides)
    return running.plan(loaded, overrides, estimate=estimate)


def _overrides(entries: Mapping[str, Any] | None, more: dict[str, Any]) -> dict[str, Any]:
    """Returns the entries that are set, by dotted names, without the keywords that are None. Raises
    BadInput if `entries` is not a mapping from names.
    """
    if not isinstance(entries or {}, Mapping) or not all(isinstance(k, str) for k in entries or {}):
        raise BadInput(f"entries: '{entries}' is no table (accepted: {{\"body.1.young\": 2e6}})")
    for name in more:
        if name not in PARAMETERS and (hint := suggestion(name, ARGUMENTS)):
            raise BadInput(
                f"{name}: no such argument{hint} (accepted: {', '.join(ARGUMENTS)}, and entries of the scene)"
            )
    return dict(entries or {}) | {name: value for name, value in more.items() if value is not None}


def _loaded(scene: Scene | str | Path, overrides: dict[str, Any]) -> tuple[Any, Path]:
    """Returns the scene as the program reads it and its default result folder. Adds the number of
    states to keep to `overrides`. Raises BadInput if `scene` is not a scene.
    """
    if isinstance(scene, Scene):
        loaded = scene.ready(_word(scene.title or "scene"))
    elif isinstance(scene, str | Path):
        loaded = Scene.load(scene)
    else:
        raise BadInput(
            f"scene: '{scene}' is none (accepted: a Scene, the name of a built-in one, the path of a TOML file)"
        )
    overrides.update(running.states(loaded) | overrides)
    choices = [scene.table() if isinstance(scene, Scene) else "", overrides]
    own = f"-{_digits(choices)}" if isinstance(scene, Scene) else ""
    return loaded, RESULTS / f"{loaded.name}{own}"


def _word(title: str) -> str:
    """Converts a title to a name of a folder."""
    return re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-")[:40] or "scene"


class Study:
    """The outcome of a sweep. `table` has one row for each point: the entries that vary, the exit
    code, its message and the numbers of the run. `results` has the Result of each point, or None
    where the run failed.
    """

    def __init__(self, axes: list[str], table: pd.DataFrame, results: list[Result | None]):
        self.axes, self.table, self.results = axes, table, results

    def __repr__(self) -> str:
        return repr(self.table)

    def _repr_html_(self) -> str:
        return str(self.table.to_html(max_cols=12))

    def plot(self, x: str, y: str, by: str | None = None, ax: Axes | None = None) -> Axes:
        """Plots a number `y` with error bars over an entry `x`, one line for each value of the
        entry `by`. Returns the axes. Raises BadInput if a name is unknown or its values are not
        numbers.
        """
        import matplotlib.pyplot as plt

        for name, accepted in (
            (x, self.axes),
            (y, list(self.table)),
            *(((by, self.axes),) if by else ()),
        ):
            if name not in accepted:
                raise BadInput(f"plot: {unknown(name, accepted, ', ')}")
        for name in (x, y):
            if not pd.api.types.is_numeric_dtype(self.table[name]):
                raise BadInput(
                    f"plot: '{name}' has values that are no numbers: '{brief(self.table[name].iloc[0])}' "
                    "(accepted: a number; of a vector sweep a component, body.1.velocity.2)"
                )
        ax = ax if ax is not None else plt.subplots(layout="constrained")[1]
        bars = pd.Series(
            [result.errors.get(y, np.nan) if result else np.nan for result in self.results]
        )
        unit = next((result.units.get(y, "") for result in self.results if result), "")
        for value, rows in (
            self.table.assign(bars=bars).groupby(by)
            if by
            else [(None, self.table.assign(bars=bars))]
        ):
            rows = rows.sort_values(x)
            ax.errorbar(
                rows[x],
                rows[y],
                rows.bars.fillna(0),
                marker="o",
                capsize=3,
                label=None if by is None else f"{by} = {value}",
            )
        ax.set(xlabel=x, ylabel=f"{y} [{unit}]" if unit not in ("", "-", "1") else y)
        if by:
            ax.legend()
        return ax


def sweep(
    scene: Scene | str | Path,
    values: Mapping[str, Sequence[Any]],
    entries: Mapping[str, Any] | None = None,
    *,
    workers: int | None = None,
    out: str | Path | None = None,
    force: bool = False,
    estimate: bool = True,
    **more: Any,
) -> Study:
    """Runs every combination of the `values` of some entries, `workers` runs at a time (default:
    one per core).

    `entries` and keywords are set in all runs; `force` and `estimate` have the meaning they have in
    run(). Each run has a folder below `out` that is named by its values, as those of a sweep file.
    A finished run is not run again: a sweep that was interrupted or has more values goes on. A run
    that fails, or that is not accepted, is a row with its exit code and message. Raises BadInput if
    no combination is accepted.
    """
    _check(values, workers)
    overrides = _overrides(entries, more)
    loaded, default_folder = _loaded(scene, overrides)
    points = [
        dict(zip(values, map(plain, combination)))
        for combination in itertools.product(*values.values())
    ]
    own = f"{default_folder.name}-sweep-{_digits([sorted(values), overrides])}"
    folder = Path(out) if out else default_folder.with_name(own)
    _refuse_all(loaded, [overrides | point for point in points])
    places = [place(folder, point) for point in points]
    cores = workers or freefem.CORES
    table = study(points, folder, overrides, math.inf, loaded, cores, estimate, force)
    results = [Result(where) if code == 0 else None for where, code in zip(places, table.exit)]
    return Study(list(values), table, results)


def _refuse_all(loaded: Any, points: list[dict[str, Any]]) -> None:
    """Raises the BadInput of the first point if the scene accepts none of them."""
    refusals = []
    for point in points:
        try:
            loaded.override(point)
            return
        except BadInput as error:
            refusals.append(error)
    raise refusals[0]


def _check(values: Any, workers: Any) -> None:
    """Raises BadInput if no sweep can be made of these values and workers."""
    if not isinstance(values, Mapping):
        raise BadInput(
            f"sweep: '{values}' is no table (accepted: {{\"body.1.young\": [1e6, 2e6]}})"
        )
    if not values or not all(len(_listed(name, choices)) for name, choices in values.items()):
        raise BadInput("sweep: nothing varies (accepted: one value or more of each entry)")
    if workers is not None and not (isinstance(workers, int) and workers >= 1):
        raise BadInput(f"workers: '{workers}' (accepted: a whole number from 1 on)")


def _digits(choices: Any) -> str:
    """Returns eight hexadecimal digits of a hash that identify `choices`."""
    text = json.dumps(choices, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:8]


def _listed(name: str, value: Any) -> list[Any]:
    if isinstance(value, str) or not hasattr(value, "__len__"):
        raise BadInput(f"sweep: {name}: '{value}' is no list of values (accepted: [1, 2, 3])")
    return list(value)
