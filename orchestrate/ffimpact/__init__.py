"""Python side of ffimpact: scenes as data, meshes, one FreeFem++ process a run, figures, reports.

    import ffimpact
    run = ffimpact.load_run("results/disc-normal")
    run.history.plot("t", "normal_force")
"""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import pandas as pd

__version__ = version("ffimpact")


class Run(NamedTuple):
    """A finished run, SI units. Entries of tables and lists of tables have dotted names: body.2.young, phase_seconds.contact."""

    scene: pd.Series       # every parameter as used
    summary: pd.Series     # the numbers of summary.json, its warnings and its provenance
    history: pd.DataFrame  # a row per accepted step


def load_run(folder: str | Path) -> Run:
    """What is in the folder of a finished run; Unreadable, in one line, where there is none."""
    import pandas as pd

    from .output import results
    folder = Path(folder)
    scene, summary = (pd.Series(dict(_entries(of)), dtype=object, name=folder.name)
                      for of in (results.read_scene(folder), results.read_summary(folder)))
    return Run(scene, summary, pd.DataFrame(results.read_history(folder)))


def _entries(given: dict | list, path: str = "") -> list[tuple[str, object]]:
    """(dotted name, value) of every entry, of the tables in a list by their number from 1."""
    found = []
    for name, value in given.items() if isinstance(given, dict) else enumerate(given, 1):
        nested = isinstance(value, dict) or isinstance(value, list) and value and isinstance(value[0], dict)
        found += _entries(value, f"{path}{name}.") if nested else [(f"{path}{name}", value)]
    return found
