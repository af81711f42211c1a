"""Numbers that were published, or that others have computed: reference/*.toml."""

import tomllib
from pathlib import Path

from ..input.parameters import Value

REFERENCE = Path(__file__).resolve().parent / "reference"


def references(script: str, scene: dict[str, Value]) -> dict[str, list[dict]]:
    """Published numbers whose conditions this scene meets: by key of summary.json, each {value, [error], source, [note]}."""
    found: dict[str, list[dict]] = {}
    for run in published():
        if run["script"] == script and all(scene.get(name) == value for name, value in run["when"].items()):
            for key, number in run["numbers"].items():
                found.setdefault(key, []).append(number | {k: run[k] for k in ("source", "note") if k in run})
    return found


def published() -> list[dict]:
    """All runs with published numbers: script, when (its parameters), numbers by key of summary.json, source, [note]."""
    return [run for path in sorted(REFERENCE.glob("*.toml")) for run in tomllib.loads(path.read_text()).get("run", [])]
