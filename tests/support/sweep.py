"""Helpers that the modules test_sweep.py share."""

from pathlib import Path

import pandas as pd

COARSE = "[set]\nmesh_size = 0.02\ncontact_mesh_size = 0.01\n"
SIX = COARSE + "[product]\nspeed = { from = 4, to = 8, points = 3 }\nnu = [0.3, 0.4]\n"
DRAWN = SIX + '[figure]\nx = "speed"\ny = "contact_time"\nby = "nu"\n'
TIMINGS = ["seconds"]


def write(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def table(out: Path) -> pd.DataFrame:
    return pd.read_csv(out / "sweep.csv").drop(columns=TIMINGS)


# ---- kills

def orphans(out: Path) -> list[Path]:
    return [path for path in (out / "runs").glob("*.part")] if (out / "runs").exists() else []
