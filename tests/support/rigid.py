"""Helpers that the modules test_rigid.py share."""

import json

import pandas as pd

from ffimpact.__main__ import main

DISC = """
density = 1000
accuracy = 0.05
[[body]]
shape = "disc"
radius = 0.05
rigid = true
"""
FLOOR = """
[[obstacle]]
kind = "plane"
point = [0, 0]
normal = [0, 1]
[contact]
penalty = 1e7
"""


def run(tmp_path, text: str, name: str = "scene", estimate: bool = False, **more):
    """Runs a scene, without figures, and returns its summary and history."""
    file = tmp_path / f"{name}.toml"
    file.write_text(text)
    out = tmp_path / name
    flags = [word for key, value in more.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]
    flags += ["--no-figures"] if estimate else ["--no-figures", "--no-estimate"]
    assert main(["run", str(file), "--out", str(out), "--quiet", *flags]) == 0
    return json.loads((out / "summary.json").read_text()), pd.read_csv(out / "history.csv")


ROLLER = """
law = "neohookean"
young = 1e6
nu = 0.3
density = 1000
accuracy = 0.1
mesh_size = 0.0125
contact_mesh_size = 0.006
end_time = 0.01
[[body]]
shape = "rectangle"
width = 0.2
height = 0.05
position = [0, 0.025]
[[obstacle]]
kind = "circle"
centre = [0, 0.0905]
radius = 0.04
{}
[contact]
friction_static = 0.5
"""
