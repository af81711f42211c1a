"""The files of a fit."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..input.parameters import Table
from ..input.toml_text import to_toml
from ..scene import Scene
from ..sweeps.study import complete, save
from .experiments import Experiment

if TYPE_CHECKING:
    from .fitted import Fit

__all__ = ["write"]


def write(made: Fit, folder: Path) -> None:
    """Writes fit.json, entries.csv, measurements.csv, the fitted scene.toml, and fit.toml with
    start.toml, which make the fit again.
    """
    record = {
        "best": made.best,
        "entries": made.table.reset_index().to_dict("records"),
        "correlation": made.correlation.to_dict(),
        "measurements": made.measurements.to_dict("records"),
        "chi2": made.chi2,
        "freedom": made.freedom,
        "p": made.p,
        "verdict": made.verdict,
        "notes": made.notes,
        "runs": made.runs,
        "seconds": made.seconds,
    }
    with complete(folder / "fit.json") as part:
        part.write_text(json.dumps(_finite(record), indent=1, default=float) + "\n", "utf-8")
    save(made.table.reset_index(), folder / "entries.csv")
    save(made.measurements, folder / "measurements.csv")
    for name, scene in (("scene", made.scene), ("start", made.start)):
        with complete(folder / f"{name}.toml") as part:
            part.write_text(to_toml(_content(scene, folder)), "utf-8")
    again = {
        "scene": "start.toml",
        **made.settings,
        "experiment": [_table(e) for e in made.experiments],
    }
    with complete(folder / "fit.toml") as part:
        part.write_text(to_toml(again), "utf-8")


def _content(scene: Scene, folder: Path) -> Table:
    return scene.with_files_in(folder, scene.content)


def _finite(value: Any) -> Any:
    """A value with null in place of what is not finite."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _table(experiment: Experiment) -> Table:
    """An experiment as a table of a TOML file."""
    table: Table = {"name": experiment.name} if experiment.name else {}
    table |= {"speed": experiment.speed} if experiment.speed else {}
    table |= {"height": experiment.height} if experiment.height else {}
    table |= {"set": experiment.entries} if experiment.entries else {}
    for number in experiment.numbers:
        table[number.name] = {"value": number.value, "error": number.error, "common": number.common}
    return table | experiment.tables
