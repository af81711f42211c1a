"""Helpers that the modules test_tubes.py share."""

import json

from ffimpact.__main__ import main

HEAD = """
dimension = "axisymmetric"
law = "svk"
young = 1e6
nu = {nu}
density = 1000
accuracy = {accuracy}
[[obstacle]]
kind = "plane"
point = [0, 0]
normal = [0, 1]
[[body]]
velocity = [0, -0.3]
"""


def run(tmp_path, entries: str, nu=0.0, accuracy=0.05, **more):
    """The summary of a scene on a plane."""
    file, out = tmp_path / "scene.toml", tmp_path / "out"
    file.write_text(HEAD.format(nu=nu, accuracy=accuracy) + entries + "\n" + more.get("beside", ""))
    assert main(["run", str(file), "--out", str(out), "--quiet", "--force", "--no-figures"]) == 0
    return json.loads((out / "summary.json").read_text())
