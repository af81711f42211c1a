"""Numbers that were published, or that others have computed: reference/*.toml."""

import tomllib
from collections.abc import Container
from pathlib import Path

from ..input.parameters import Value

__all__ = ["REFERENCE", "published", "references"]

REFERENCE = Path(__file__).resolve().parent / "reference"
# No source has damping: what `when` does not name of these is 0 there.
UNDAMPED = dict.fromkeys(("viscosity", "bulk_viscosity", "relaxation_modulus", "loss"), 0)


def references(script: str, scene: dict[str, Value]) -> dict[str, list[dict]]:
    """Published numbers whose conditions this scene meets: by key of summary.json, each {value,
    [error], source, [note]}.
    """
    found: dict[str, list[dict]] = {}
    for run in published(script, scene):
        for key, number in run["numbers"].items():
            found.setdefault(key, []).append(
                number | {k: run[k] for k in ("source", "note") if k in run}
            )
    return found


def published(script: str, scene: dict[str, Value], whatever: Container[str] = ()) -> list[dict]:
    """The runs with published numbers whose conditions this scene meets, `whatever` these
    parameters are: script, when (its parameters), numbers by key of summary.json, source,
    [note].
    """
    every = (
        run
        for path in sorted(REFERENCE.glob("*.toml"))
        for run in tomllib.loads(path.read_text()).get("run", [])
    )
    return [
        run
        for run in every
        if run["script"] == script
        and all(
            scene.get(name, UNDAMPED.get(name)) == value
            for name, value in (UNDAMPED | run["when"]).items()
            if name not in whatever
        )
    ]
