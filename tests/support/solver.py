"""Helpers that the modules test_solver.py share."""

from ffimpact import scene
from ffimpact.output import results
from ffimpact.running import run

SCENES = {"disc-normal": {"accuracy": "0.1", "fields": "0"}, "two-discs": {"accuracy": "0.2", "fields": "0"}}
ANSWERS = ("history.csv", "contacts.csv", "scene.toml")


def go(name: str, out, **values) -> results.Record:
    return run.run(scene.load(name), SCENES[name] | values, out, progress=False)
