"""Helpers that the modules test_onsets.py share."""

from pathlib import Path

from ffimpact.running import run
from ffimpact.scene import Scene, read as read_scene

DISC = {"name": "disc", "shape": "disc", "radius": 0.05, "position": [0, 0.0651], "velocity": [0, -3]}
RUBBER = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1722, "accuracy": 0.1}


def scene(body, obstacle, **more) -> Scene:
    tables = RUBBER | more | {"body": body if isinstance(body, list) else [body], "obstacle": obstacle if isinstance(obstacle, list) else [obstacle]}
    return read_scene(tables, Path(), "onset")


def go(tmp_path, *tables, **more) -> run.Record:
    return run.run(scene(*tables, **more), {}, tmp_path / "out", estimate=False)
