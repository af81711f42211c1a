"""Numbers from publications and from computations of others: reference/*.toml."""

import tomllib
from collections.abc import Container
from pathlib import Path

from ..input.parameters import Table
from .impact import impact_of

__all__ = ["REFERENCE", "published", "references"]

REFERENCE = Path(__file__).resolve().parent / "reference"
# No source has damping or layers: an entry of these that `when` does not list is 0 or none.
UNDAMPED = dict.fromkeys(("viscosity", "bulk_viscosity", "loss"), 0)
PLAIN = UNDAMPED | {"branches": None, "layer": None}


def references(scene: Table) -> dict[str, list[Table]]:
    """Returns the published numbers whose conditions this scene fulfils: for each key of
    summary.json a list of {value, [error], source, [note]}.
    """
    numbers: dict[str, list[Table]] = {}
    for run in published(scene):
        for key, number in run["numbers"].items():
            numbers.setdefault(key, []).append(
                number | {k: run[k] for k in ("source", "note") if k in run}
            )
    return numbers


def published(scene: Table, whatever: Container[str] = ()) -> list[Table]:
    """Returns the runs with published numbers whose conditions this scene fulfils as an impact. The
    entries in `whatever` may have any value. Each run has kind (impact.KINDS), when (its entries),
    numbers by key of summary.json, source and [note].
    """
    impact = impact_of(scene)
    if not impact:
        return []
    every = (
        run
        for path in sorted(REFERENCE.glob("*.toml"))
        for run in tomllib.loads(path.read_text()).get("run", [])
    )
    return [
        run
        for run in every
        if run["kind"] == impact["kind"]
        and all(
            (impact.get(name) or 0) == (value or 0)
            for name, value in (PLAIN | run["when"]).items()
            if name not in whatever
        )
    ]
