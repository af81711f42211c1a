"""Helpers that the modules test_run.py share."""

from pathlib import Path

from ffimpact import scene
from ffimpact.output import results
from ffimpact.running import run


def go(out: Path, overrides: dict | None = None, **options) -> results.Record:
    return run.run(scene.load("disc-normal"), {"fields": 0} | (overrides or {}), out, **{"estimate": False} | options)
