"""Sweeps: a TOML file names a scene, the values of its parameters, the numbers to collect and the
figure to draw.

    scene = "disc-normal"                       # a built-in scene, or a scene file beside this one
    collect = ["contact_time", "rebound_vy"]    # numbers of summary.json; default: all of them
    limit = 600                                 # largest run time of each run [s]
    estimate = true                             # error bars by error estimates; default: none
    [set]                                       # for every run; in a scene of bodies any entry:
    law = "svk"                                 # body.2.young, contact.penalty ...
    [product]                                   # all combinations of lists or ranges
    nu = [0.30, 0.45]
    speed = { from = 0.5, to = 11, points = 43 }             # or with spacing = "log"
    [[zip]]                                     # one more axis of the product: these entries
    mesh_size = [0.01, 0.005]                   # vary together; there may be several [[zip]]
    dt = [4e-5, 2e-5]
    [refine]                                    # repeats every run with these entries. The refined
    accuracy = 2.5e-3                           # run is the result, the difference its error bar
    [figure]                                    # see sweep_figures.py
    x = "speed"
    y = "contact_time"
    by = "nu"
"""

import argparse
import fcntl
import itertools
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd

from .. import scene
from ..failure import BadInput, Busy, Failure, Unreadable, brief, suggestion, unknown
from ..input import dimension, parameters
from ..input.parameters import Table, Value
from ..output import columns
from ..output.folder import result_folder
from ..places import RESULTS, shown
from ..scene import Scene
from . import study

__all__ = ["Sweep", "built_in", "collect", "load", "main", "report", "table"]

T = TypeVar("T")

SWEEPS = Path(__file__).resolve().parent  # the folder of the built-in sweeps
LIMIT = 600.0  # default of the largest run time of a run [s]
MOST_RUNS = 20_000  # runs of a sweep; more are taken for a mistake in the file
RANGE = ("from", "to", "points", "spacing")
KEYS = (
    "title",
    "scene",
    "collect",
    "limit",
    "estimate",
    "set",
    "product",
    "zip",
    "refine",
    "figure",
)
SHOWN = 8  # number of collected columns in the printed table; sweep.csv has all
# Exit codes that are results: finished, no further step, breakdown of the material.
RECORDED = (0, 11, 12)
LASTING = (*RECORDED, 10)  # exit codes (10: bad input) with which the same run would end again
FINER = ("accuracy", "mesh_size", "contact_mesh_size", "dt")  # entries that [refine] decreases


@dataclass(frozen=True)
class Sweep:
    """A sweep as read from its file.

    `points` are the parameters in which the rows differ, `base` those of every run. `refine` holds
    the entries of the refined runs. With `estimate` each run estimates its errors. `limit` is the
    largest run time of a run [s]. `sample` is the scene of one point, `text` the text of the file.
    """

    name: str
    title: str
    scene: str
    base: study.Point
    points: list[study.Point]
    refine: study.Point
    collect: list[str]
    limit: float
    estimate: bool
    figure: Table
    sample: Scene
    text: str

    @property
    def axes(self) -> list[str]:
        """The names of the parameters that vary."""
        return list(self.points[0])

    @property
    def runs(self) -> list[study.Point]:
        """Every run of the sweep: the points, then the refined points."""
        return self.points + [point | self.refine for point in self.points if self.refine]


def main(argv: list[str]) -> int:
    """Computes the runs that are missing, and writes DIR/sweep.csv and DIR/sweep.png. Raises
    Failure if a run has no result (10, 14, killed...).
    """
    parser = argparse.ArgumentParser(
        prog="ffimpact sweep",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "sweep",
        metavar="SWEEP",
        help=f"a built-in sweep ({', '.join(built_in())}) or the path of a TOML file",
    )
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="the result folder (default: results/sweeps/NAME)"
    )
    parser.add_argument("--list", action="store_true", help="only list the runs")
    parser.add_argument(
        "--open", action="store_true", help="only list the runs that are not there yet"
    )
    parser.add_argument(
        "--run", metavar="NAME", help="only this run of the list, without table and figure"
    )
    options = parser.parse_args(argv)
    sweep = load(options.sweep)
    out = result_folder(options.out or RESULTS / "sweeps" / sweep.name)
    names = {study.place(out, point).name: point for point in sweep.runs}
    if options.list or options.open:
        there = (
            study.outcomes(
                [*names.values()], out, sweep.base, scene.load(sweep.scene), sweep.estimate
            )
            if options.open
            else {}
        )
        print(
            "\n".join(name for name, point in names.items() if study.place(out, point) not in there)
        )
        return 0
    if options.run is not None and options.run not in names:
        raise BadInput(
            f"--run: '{brief(options.run)}' is no run of {sweep.name} (accepted: see --list)"
        )
    with _ours(sweep, out):
        if options.run is not None:
            row = study.study(
                [names[options.run]],
                out,
                sweep.base,
                sweep.limit,
                sweep.scene,
                estimate=sweep.estimate,
            ).iloc[0]
            print(f"{options.run}: {row.message or 'finished'}")
            return 0 if row.exit in LASTING else int(row.exit)
        rows = collect(sweep, out)
        print(report(sweep, rows, out))
    bad = rows[~rows.exit.isin(RECORDED)]
    if len(bad):
        again = (
            ""
            if bad.exit.isin(LASTING).all()
            else "; the same command runs again what was killed or did not end"
        )
        first = study.place(Path(), bad[sweep.axes].iloc[0].to_dict()).name
        raise Failure(
            f"{sweep.name}: {len(bad)} of {len(rows)} points have no answer, first: {first}: {bad.message.iloc[0]}{again}",
            code=int(bad.exit.iloc[0]) if bad.exit.nunique() == 1 else 1,
        )
    return 0


@contextmanager
def _ours(sweep: Sweep, out: Path) -> Iterator[None]:
    """Locks the folder against processes of other sweeps. Processes of the same sweep share it."""
    try:
        out.mkdir(parents=True, exist_ok=True)
        lock = os.open(out, os.O_RDONLY)
    except OSError as error:
        raise Unreadable(f"{out} cannot be made: {error.strerror}; choose another --out") from None
    try:
        for _ in range(2):  # twice, as another process may have died before it wrote the file
            try:
                # The exclusive lock succeeds if no other process uses the folder.
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                with study.complete(out / "sweep.toml") as part:
                    part.write_text(sweep.text)
            except BlockingIOError:
                pass
            # The shared lock waits for a process that is writing the file. After that nobody
            # changes it.
            fcntl.flock(lock, fcntl.LOCK_SH)
            if (out / "sweep.toml").exists() and (
                out / "sweep.toml"
            ).read_bytes() == sweep.text.encode():
                break
        else:
            raise Busy(f"{out} is being written by another sweep; wait, or choose another --out")
        yield
    finally:
        os.close(lock)


# ---- the file


def built_in() -> list[str]:
    """Returns the names of the built-in sweeps."""
    return sorted(path.stem for path in SWEEPS.glob("*.toml"))


def load(name: str) -> Sweep:
    """Returns a built-in sweep, or that of a TOML file. BadInput names the file, the field, the
    value and what is accepted.
    """
    path = SWEEPS / f"{name}.toml" if name in built_in() else Path(name)
    text, content = scene.read_toml(path, scene.absent(name, "sweep", built_in()))
    try:
        return _sweep(path, content, text)
    except BadInput as error:
        raise error.within(str(path)) from None


def _figure(entries: Table, points: list[Table], collected: list[str], loaded: Scene) -> Table:
    """Returns the [figure] of a sweep with defaults, empty if there is none."""
    if not entries:
        return {}
    from . import sweep_figures  # loads matplotlib, here and below

    figure = sweep_figures.check(entries, points, collected, loaded.columns)
    return figure | {"per": dimension.per_metre(loaded.kind.script)}


def _sweep(path: Path, content: Table, text: str) -> Sweep:
    for key in content:
        if key not in KEYS:
            raise BadInput(
                f"{brief(key)}: no such entry{suggestion(key, KEYS)} (accepted: {', '.join(KEYS)})"
            )
    tables = {
        key: _is(content.get(key, {}), dict, key, "a table")
        for key in ("set", "product", "refine", "figure")
    }
    groups = _is(content.get("zip", []), list, "zip", "tables [[zip]]")
    name = content.get("scene", "disc-normal")
    if _is(name, str, "scene", "a name") not in scene.built_in():
        name = os.path.join(path.parent.resolve(), name)
    loaded = scene.load(name)
    base, refine = (loaded.check(_flat(tables[key])) for key in ("set", "refine"))
    loaded.tables(refine)
    axes = _crossed(_flat(tables["product"]), base, loaded)
    axes += [
        _together(_flat(_is(group, dict, "zip", "tables [[zip]]")), loaded) for group in groups
    ]
    count = int(np.prod([len(axis) for axis in axes])) * (2 if refine else 1)
    if not axes:
        raise BadInput(
            "product: nothing varies (accepted: at least one parameter in [product] or [[zip]])"
        )
    if count > MOST_RUNS:
        raise BadInput(f"product: {count} runs (accepted: up to {MOST_RUNS})")
    varied = [name for axis in axes for name in axis[0]]
    for where, names in (("set", base), ("product", varied), ("refine", refine)):
        twice = sorted(
            name
            for name in names
            if (varied.count(name) > 1 if where == "product" else name in varied)
        )
        if twice:
            raise BadInput(
                f"{where}: {brief(twice[0])} is given twice (accepted: once, in [set], [product] or [[zip]])"
            )
    points = [
        {name: value for part in parts for name, value in part.items()}
        for parts in itertools.product(*axes)
    ]
    if len({tuple(point.values()) for point in points}) < len(points):
        raise BadInput("zip: two points are the same (accepted: every combination once)")
    sample = _sample(loaded, {"fields": 0} | base, points)
    _finer(refine, loaded.values | loaded.sizes | base, points)
    accepted = [f"{column}_end" if column in varied else column for column in loaded.numbers]
    collected = _is(content.get("collect", accepted), list, "collect", "a list of names")
    for number in collected:
        if number not in accepted:
            raise BadInput(f"collect: {unknown(number, accepted, ', ')}")
        if collected.count(number) > 1:
            raise BadInput(
                f"collect: '{brief(number)}' is given twice (accepted: {', '.join(accepted)})"
            )
    limit = _limit(content)
    estimate = _is(content.get("estimate", False), bool, "estimate", "true, false")
    if estimate and refine:
        raise BadInput("estimate: true beside [refine] (accepted: one of them)")
    figure = _figure(tables["figure"], points, collected, loaded)
    base = {"fields": 0} | base
    return Sweep(
        path.stem,
        str(content.get("title", path.stem)),
        name,
        base,
        points,
        refine,
        collected,
        limit,
        estimate,
        figure,
        sample,
        text,
    )


def _limit(content: Table) -> float:
    limit = content.get("limit", LIMIT)
    if type(limit) not in (int, float) or not 1 <= limit <= 1e6:
        raise BadInput(f"limit: {brief(limit)} (accepted: 1 to 1e6 seconds)")
    return float(limit)


def _sample(loaded: Scene, base: study.Point, points: list[study.Point]) -> Scene:
    """Returns the scene of the first point that is accepted. A point that is refused does not stop
    the runs of others. If all are refused, the BadInput of the first point is raised.
    """
    for point in points:
        with suppress(BadInput):
            return loaded.override(base | point)
    return loaded.override(base | points[0])


def _finer(refine: Table, values: Table, points: list[Table]) -> None:
    """Raises BadInput if `refine` changes nothing, or makes a size larger that it should make
    smaller.
    """
    if refine and all(
        all((values | point).get(name) == value for name, value in refine.items())
        for point in points
    ):
        raise BadInput(
            f"refine: {', '.join(refine)} as in the runs themselves (accepted: other values, or no [refine])"
        )
    for name in set(refine) & set(FINER):
        # In a scene of bodies `values` holds the largest size of its bodies.
        coarse = min((values | point)[name] for point in points)
        if coarse > 0 and not 0 < refine[name] < coarse:
            raise BadInput(
                f"refine: {brief(name)} = {refine[name]:g} is not finer (accepted: above 0, below {coarse:g})"
            )


def _is(value: Any, kind: type[T], name: str, words: str) -> T:
    if not isinstance(value, kind):
        raise BadInput(f"{brief(name)}: '{brief(value)}' is not accepted (accepted: {words})")
    return value


def _flat(table: Table, path: str = "") -> Table:
    """Returns the entries of a table by dotted names. TOML reads body.2.young as nested tables
    unless the name is in quotes.
    """
    entries: Table = {}
    for name, value in table.items():
        nested = isinstance(value, dict) and not set(value) & set(RANGE)
        entries |= _flat(value, f"{path}{name}.") if nested else {f"{path}{name}": value}
    return entries


def _crossed(product: Table, base: study.Point, loaded: Scene) -> list[list[study.Point]]:
    """Returns the axes of [product]. Raises BadInput for a value that is refused by its own rule.

    What only a whole scene refuses is left to the runs of the points.
    """
    axes = [
        [{name: value} for value in _values(name, values, loaded)]
        for name, values in product.items()
    ]
    for point in itertools.chain(*axes):
        loaded.tables(base | point)
    return axes


def _values(name: str, axis: Any, loaded: Scene) -> list[Value]:
    """Returns the checked values of an axis of a sweep over the scene `loaded`, from a list or a
    range.
    """
    if isinstance(axis, dict):
        if not set(RANGE[:3]) <= set(axis) <= set(RANGE):
            raise BadInput(
                f"{brief(name)}: {brief(axis)} is no range (accepted: from, to, points and perhaps spacing)"
            )
        low, high, points, spacing = (
            *(axis[key] for key in ("from", "to", "points")),
            axis.get("spacing", "linear"),
        )
        if spacing not in ("linear", "log"):
            raise BadInput(f"{brief(name)}: spacing {unknown(spacing, ('linear', 'log'))}")
        rule = parameters.PARAMETERS.get(name.rpartition(".")[2])
        if rule and rule.kind == "word" or not {type(low), type(high)} <= {int, float}:
            raise BadInput(
                f"{brief(name)}: a range needs a parameter that is a number, from and to numbers"
            )
        low, high = (float(loaded.check({name: number})[name]) for number in (low, high))
        if spacing == "log" and min(low, high) <= 0:
            raise BadInput(f"{brief(name)}: from {low:g} to {high:g} (accepted for log: above 0)")
        if type(points) is not int or not 2 <= points <= MOST_RUNS:
            raise BadInput(f"{brief(name)}: points = {brief(points)} (accepted: 2 to {MOST_RUNS})")
        axis = [
            float(f"{value:.10g}")
            for value in (np.geomspace if spacing == "log" else np.linspace)(low, high, points)
        ]
    values = [
        _single(name, value, loaded)
        for value in _is(axis, list, name, "a list of values, or a range")
    ]
    if not values or len(set(values)) < len(values):
        raise BadInput(f"{brief(name)}: {brief(axis)} (accepted: at least one value, none twice)")
    return values


def _single(name: str, value: Any, loaded: Scene) -> Value:
    """Returns a checked value of an axis: a number or a word."""
    if isinstance(value, list | dict):
        raise BadInput(
            f"{brief(name)}: {brief(value)} (accepted: single numbers and words, as body.1.velocity.2 for one of two)"
        )
    return loaded.check({name: value})[name]


def _together(group: Table, loaded: Scene) -> list[study.Point]:
    """Returns the points of a [[zip]], whose parameters vary together."""
    columns = {
        name: [
            _single(name, value, loaded) for value in _is(values, list, name, "a list of values")
        ]
        for name, values in group.items()
    }
    if (
        not columns
        or len({len(values) for values in columns.values()}) > 1
        or not all(columns.values())
    ):
        raise BadInput(
            f"zip: {', '.join(f'{name} has {len(values)} values' for name, values in columns.items()) or 'nothing in it'} "
            "(accepted: lists of one length)"
        )
    return [dict(zip(columns, values)) for values in zip(*columns.values())]


# ---- the table


def collect(sweep: Sweep, out: Path) -> pd.DataFrame:
    """Computes the runs that are missing. Returns the table and saves it as sweep.csv, with its
    figure.
    """
    rows = table(sweep, out)
    study.save(rows, out / "sweep.csv")
    if sweep.figure:
        from . import sweep_figures

        sweep_figures.draw(sweep, rows, out)
    return rows


def table(sweep: Sweep, out: Path) -> pd.DataFrame:
    """Computes the runs that are missing and returns a tidy table with one row per point.

    Columns: the parameters that vary, exit, message, warnings, the collected numbers, and seconds.
    With `refine` the numbers are those of the refined run, and <name>_error [same unit] is |refined
    - plain|; with `estimate` it is the estimated error. If a run of a point failed, the row has the
    exit code and message of that run, and no numbers.
    """
    runs = study.study(
        sweep.runs, out, sweep.base, sweep.limit, sweep.scene, estimate=sweep.estimate
    )
    estimated = [f"{name}_error" for name in sweep.collect if sweep.estimate]
    for name in sweep.collect + estimated:  # what no run has becomes an empty column
        if name not in runs:
            runs[name] = np.nan
    n = len(sweep.points)
    plain, fine = runs[:n], runs[-n:].set_axis(runs.index[:n])
    rows = fine[sweep.axes + ["exit", "message", "warnings"] + sweep.collect + estimated].copy()
    if sweep.refine:
        worse = (plain.exit != 0) & (fine.exit == 0)
        rows.loc[worse, ["exit", "message", "warnings"]] = plain.loc[
            worse, ["exit", "message", "warnings"]
        ]
        errors = {f"{name}_error": (fine[name] - plain[name]).abs() for name in sweep.collect}
        rows = pd.concat([rows, pd.DataFrame(errors)], axis=1)
    rows[sweep.collect] = rows[sweep.collect].where(rows.exit == 0)
    rows["seconds"] = plain.get("wall_seconds", np.nan) + (
        fine.get("wall_seconds", np.nan) if sweep.refine else 0
    )
    return rows


def _units(sweep: Sweep, names: list[str]) -> str:
    """Returns the units of columns of sweep.csv in words, from the parameters and the table of
    what a run records.
    """
    of_table = columns.units(dimension.per_metre(sweep.sample.kind.script), names)
    units = {name: of_table.get(name) or study.unit_of(name) for name in names}
    text = ", ".join(f"{name} {unit}" for name, unit in units.items() if unit not in ("", "-", "1"))
    return f"units: {text}" if text else "units: none"


def report(sweep: Sweep, rows: pd.DataFrame, out: Path) -> str:
    """Returns the results in words: a table of all points if it is short, failures with their
    reasons, the findings of the figure, and where the files are.
    """
    lines = [sweep.title]
    if len(rows) <= 60:
        text = rows[sweep.axes].copy()
        for name in sweep.collect[:SHOWN]:
            text[name] = ["" if np.isnan(value) else f"{value:.5g}" for value in rows[name]]
            if f"{name}_error" in rows:
                from . import sweep_figures

                errors = sweep_figures.bars_of_all(sweep, rows, name)
                text[name] += ["" if np.isnan(error) else f" ± {error:.2g}" for error in errors]
        lines += [
            study.table(
                text,
                {
                    name: "g"
                    if name in sweep.axes and pd.api.types.is_numeric_dtype(rows[name])
                    else ""
                    for name in text
                },
            ),
            _units(sweep, list(text)),
            "",
        ]
    failed = rows[rows.exit != 0]
    for (code, message), group in failed.groupby(["exit", "message"], sort=False):
        where = "; ".join(
            study.place(Path(), point).name for point in group[sweep.axes].to_dict("records")
        )
        lines.append(f"failed, exit {code}: {where}: {message}")
    lines += [f"released: {sentence}" for sentence in sweep.sample.released]
    if warned := study.warned(rows.warnings):
        lines.append(f"warnings: {warned}")
    if sweep.figure:
        from . import sweep_figures

        lines += sweep_figures.findings(sweep, rows, out)
    files = ", ".join(path.name for path in (out / "sweep.csv", out / "sweep.png") if path.exists())
    lines.append(
        f"{len(rows) - len(failed)} of {len(rows)} points finished; {shown(out)}/: {files}"
    )
    return "\n".join(lines)
