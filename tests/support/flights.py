"""Helpers that the modules test_flights.py share."""

from pathlib import Path

import pandas as pd

from ffimpact import scene
from ffimpact.running import run
from ffimpact.scene import Scene, read as read_scene

RUBBER = {"young": 7e6, "nu": 0.3, "density": 1722, "law": "neohookean", "accuracy": 0.1}
DISC = {"shape": "disc", "radius": 0.05}
FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}


def read(*bodies: dict, obstacles: tuple = (), **more) -> Scene:
    return read_scene(RUBBER | more | {"body": [*bodies], "obstacle": [*obstacles]}, Path("."), "flights")


def go(tmp_path: Path, problem: scene.Scene, values: dict | None = None) -> tuple[pd.DataFrame, run.Record]:
    result = run.run(problem, values or {}, tmp_path / "out", estimate=False)
    return pd.read_csv(result.folder / "contacts.csv"), result
