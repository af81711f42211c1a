"""A finished run as Python objects: its numbers with units and error estimates, its tables, figures
and states.

    result = ffimpact.run("disc-normal", speed=4)
    result["impulse"], result.errors["impulse"], result.units["impulse"]
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from .failure import BadInput, Unreadable, unknown
from .freefem.freefem import At
from .input.dimension import AXISYMMETRIC, per_metre
from .output.columns import units
from .output.errors import errors
from .output.evaluate import evaluate
from .output.filters import channel_class, filtered
from .output.results import Record, numbers, read_record, read_summary, reading
from .output.states import Fields
from .places import shown
from .progress import muted
from .report import report
from .running import run as running

if TYPE_CHECKING:
    from .plot import Plots

__all__ = ["Progress", "Result", "compare", "load", "of_run"]

# Numbers that `Result.table` lists after those of the report.
ALSO = ("thresholded_contact_time", "energy_initial", "energy_final")


@dataclass(frozen=True)
class Progress:
    """A run that is under way: its time t [s], the number of its steps, the share of its steps that
    is done (estimated, 0 to 1), and the folder of its files.
    """

    t: float
    steps: int
    share: float
    folder: Path

    @property
    def history(self) -> pd.DataFrame:
        """The time history up to now, as Result.history."""
        text = (self.folder / "history.csv").read_text()
        return pd.read_csv(io.StringIO(text[: text.rindex("\n") + 1]))


class Result:
    """A finished run: its numbers with units and error estimates, its tables, figures and states.

    `source` is the folder of the run, or the Record of its files. result["impulse"] is a number of
    summary.json in SI units; `keys()` lists the names of all numbers. `folder` is the result
    folder. `reused` states whether the result was in the folder before the run was requested.
    Raises BadInput if `source` is neither a folder nor a Record, Unreadable if the folder has no
    finished run.
    """

    def __init__(self, source: Record | str | Path):
        if not isinstance(source, Record | str | Path):
            raise BadInput(f"result: '{source}' is no result (accepted: the folder of a run)")
        self.record = source if isinstance(source, Record) else read_record(Path(source))
        self.folder, self.reused = self.record.folder, self.record.reused
        self.summary: dict[str, Any] = self.record.summary

    def __getitem__(self, name: str) -> Any:
        if name not in self.summary:
            raise BadInput(f"result: {unknown(name, self.summary, ', ')}")
        return self.summary[name]

    def keys(self) -> list[str]:
        """Returns the names of all numbers."""
        return numbers(self.summary)

    def _ipython_key_completions_(self) -> list[str]:
        """The names that notebooks complete after result[" ."""
        return self.keys()

    def __contains__(self, name: object) -> bool:
        return self.summary.get(str(name)) is not None

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def _path(self, name: str) -> Path:
        """Returns the path of a file in the folder. Raises Unreadable if the folder holds another
        run by now.
        """
        if read_summary(self.folder) != self.summary:
            raise Unreadable(
                f"{self.folder}: holds another run by now (accepted: load('{self.folder}'))"
            )
        return self.folder / name

    @cached_property
    def scene(self) -> dict[str, Any]:
        """The entries of the scene with the values that the run used:
        result.scene["body"][0]["young"].
        """
        self._path("scene.toml")
        return self.record.scene

    @cached_property
    def history(self) -> pd.DataFrame:
        """The time history in SI units, one row for each step; columns t, normal_force, kinetic
        ...
        """
        self._path("history.csv")
        return pd.DataFrame(dict(self.record.history))

    def force(self, filter: str | None = None) -> pd.DataFrame:
        """The forces over time: t, normal_force, friction_force, and those on bodies and of
        supports where there are any. By default these are the columns of `history`.

        `filter` is a channel frequency class of SAE J211-1 and ISO 6487, "CFC 60", "CFC 180",
        "CFC 600" or "CFC 1000". The forces are then resampled to uniform times and filtered
        forwards and backwards. Raises BadInput for another filter.
        """
        names = [name for name in self.history if "force" in name or name == "normal_load"]
        if filter is None:
            return self.history[["t", *names]].copy()
        columns = {name: self.history[name].to_numpy() for name in names}
        times, values = filtered(self.history.t.to_numpy(), columns, channel_class(filter))
        return pd.DataFrame({"t": times} | values)

    @cached_property
    def contacts(self) -> pd.DataFrame:
        """One row for each interval of contact of a contact pair. The table is empty if there is no
        contacts.csv.
        """
        path = self._path("contacts.csv")
        with reading(path):
            return pd.read_csv(path) if path.exists() else pd.DataFrame()

    @property
    def warnings(self) -> list[str]:
        """The warnings of the run: reasons why a result may be wrong."""
        return list(self.summary["warnings"])

    @cached_property
    def errors(self) -> Mapping[str, float]:
        """The estimated error of each number in the unit of the number: the result is result[name]
        +- result.errors[name].

        Numbers without an estimate are left out. The estimates do not include the errors by the
        penalty and the slip velocity.
        """
        return errors(self.record)

    @cached_property
    def units(self) -> Mapping[str, str]:
        """The unit of each number and column. Only plane strain has units per metre of
        thickness.
        """
        return units(per_metre(self.summary["provenance"]["script"]), self.summary)

    @property
    def table(self) -> pd.DataFrame:
        """The main numbers with value, error and unit, in the order of the report. If the summary has
        a number for each of several bodies, the table lists these.
        """
        rows = [row.key for row in report.rows_of(self.record)]
        names = [name for name in (*rows, *ALSO) if name in self.keys()]
        columns = {
            "value": [self[name] for name in names],
            "error": [self.errors.get(name) for name in names],
            "unit": [self.units.get(name, "") for name in names],
        }
        return pd.DataFrame(columns, index=pd.Index(names, name="number"))

    def __repr__(self) -> str:
        rows = [
            f"  {name:<26}{row['value']:>12.5g}{_bar(row['error'])} {_unit(row['unit'])}".rstrip()
            for name, row in self.table.iterrows()
        ]
        warnings = report.warning_lines(self.summary)
        origin = ", by a script of the paper" if "made_by" in self.summary else ""
        more = (
            [f"  and {len(rows) - report.MAIN_ROWS} more: result.table"]
            if len(rows) > report.MAIN_ROWS
            else []
        )
        return "\n".join(
            [f"Result in {shown(self.folder)}{origin}", *rows[: report.MAIN_ROWS], *more, *warnings]
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(str(name))}</td><td>{row['value']:.5g}{_bar(row['error'])}</td><td>{escape(_unit(row['unit']))}</td></tr>"
            for name, row in self.table.iterrows()
        )
        warnings = "".join(f"<p>{escape(sentence)}</p>" for sentence in self.warnings)
        return (
            f"<table><caption>{escape(str(shown(self.folder)))}</caption>{rows}</table>{warnings}"
        )

    @property
    def plot(self) -> Plots:
        """The pictures: result.plot.force(), .energies(), .velocities() and .shapes() draw into axes
        `ax` and return them; .bodies(), .contact(), .bounces(), .heights() and .modes() are figures.
        """
        from .plot import Plots

        return Plots(self)

    @property
    def fields(self) -> Fields:
        """The states that the run kept (entry `fields`) as numpy arrays: result.fields[-1].von_mises."""
        revolution = self.summary["provenance"]["script"] == AXISYMMETRIC.script
        return Fields(self.folder, revolution, self.summary.get("symmetric_along", ()))

    def extend(
        self,
        end_time: float,
        *,
        out: str | Path | None = None,
        force: bool = False,
        estimate: bool = True,
        figures: bool = True,
        progress: bool | None = None,
        watch: Callable[[Progress], object] | None = None,
    ) -> Result:
        """Goes on from the end of the run to a later `end_time` [s]; returns the result of the whole.

        The mesh stays, the records are those of the whole run, the coarser runs of the estimate begin
        anew. The default of `out` is a folder beside that of the result, which stays as it is. The
        other arguments are those of run(). A Python function of time was tabulated up to the former
        end; after it, it is constant. Raises BadInput if `end_time` is not after the end, Unreadable if
        the run is one of another version.
        """
        if not isinstance(out or "", str | Path):
            raise BadInput(f"out: '{out}' is no path (accepted: that of a folder)")
        with muted(progress is False):
            longer, earlier = running.extended(self.folder, self.summary, end_time)
            beside = f"{self.folder.name}-until-{longer.number('end_time'):g}"
            return of_run(
                longer,
                {},
                out or self.folder.with_name(beside),
                force=force,
                estimate=estimate,
                figures=figures,
                progress=progress,
                watch=watch,
                earlier=earlier,
            )

    def probe(self, *point: float, body: int = 1) -> pd.DataFrame:
        """The motion of a material point of a body, from its centre of mass on [m]: a row for each kept
        state, of which there is at most one at each step, with position, velocity and stresses.
        """
        return self.fields.probe(point, body)

    def view(
        self,
        path: str | Path | None = None,
        field: str = "von_mises",
        revolved: bool = True,
    ) -> Any:
        """Returns an animation of the kept states: a player for a notebook, or the path of the HTML
        file that was written. The file needs no network. See ffimpact.view.view.
        """
        from .view import view

        return view(self, path, field, revolved)


def of_run(
    scene: Any,
    overrides: dict[str, Any],
    out: str | Path,
    *,
    figures: bool,
    watch: Callable[[Progress], object] | None,
    **options: Any,
) -> Result:
    """Runs a scene as it was read and returns its result; `options` are those of running.run.run()."""

    def seen(at: At, where: Path) -> object:
        return watch and watch(Progress(at.t, at.steps, at.share, where))

    record = running.run(scene, overrides, out, watch=seen if watch else None, **options)
    if figures:
        report.draw(record)
    return Result(record)


def _bar(error: float | None) -> str:
    return "" if error is None or pd.isna(error) else f" ± {error:.2g}"


def _unit(unit: str) -> str:
    return "" if unit in ("1", "-") else unit


def load(folder: str | Path) -> Result:
    """Returns the finished run in a folder. The record of a run of an .edp script is evaluated first.
    Raises Unreadable, with a message of one line, if there is no finished run.
    """
    if isinstance(folder, str | Path):
        evaluate(Path(folder))
    return Result(folder)


def compare(*results: Result | str | Path, names: Sequence[str] | str = ()) -> pd.DataFrame:
    """Returns a table of the main numbers of several runs side by side, each with its error
    estimate, in the order of the arguments.

    The column `agree` states whether the error bars of all runs overlap; it is None where a run has
    no estimate. `names` selects the numbers; by default these are the main numbers that all runs
    have. The folders are in `.attrs["folders"]`. Raises BadInput for fewer than two runs.
    """
    if len(results) == 1 and isinstance(results[0], list | tuple):
        results = tuple(results[0])
    runs = [result if isinstance(result, Result) else load(result) for result in results]
    if len(runs) < 2:
        raise BadInput(f"compare: '{len(runs)}' results (accepted: two or more)")
    chosen = [names] if isinstance(names, str) else list(names)
    rows = chosen or [
        name for name in runs[0].table.index if all(name in result.table.index for result in runs)
    ]
    table = pd.DataFrame(index=pd.Index(rows, name="number"))
    for k, run in enumerate(runs, 1):
        table[f"run {k}"] = [run[name] for name in rows]
        table[f"error {k}"] = [run.errors.get(name) for name in rows]
    table["unit"] = [runs[0].units.get(name, "") for name in rows]
    table["agree"] = [_agree(runs, name) for name in rows]
    table.attrs["folders"] = [str(result.folder) for result in runs]
    return table


def _agree(runs: Sequence[Result], name: str) -> bool | None:
    """Returns whether all error bars of a number have a value in common, or None if a run has no
    error estimate.
    """
    if not all(name in run.errors for run in runs):
        return None
    return bool(
        max(run[name] - run.errors[name] for run in runs)
        <= min(run[name] + run.errors[name] for run in runs)
    )
