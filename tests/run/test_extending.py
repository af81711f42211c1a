"""docs/how-to/extending.md: every block is applied to a copy of the program, runs there, and gives
the results on the page."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ffimpact.output import results, vtu
from ffimpact.output.fields import write_fields
from ffimpact.places import ROOT

PLACE = r"In `([\w./-]+)`, (before|after|instead of) `([^`]+)`:"
ADDED = re.compile(PLACE + r"\n```\w+\n(.*?)```", re.DOTALL)
CHANGED = re.compile(PLACE + r" `([^`]+)`")
NEW = re.compile(r"`([\w./-]+)`, new\b[^`]*?(?:`[^`]+`[^`]*?)?:\n```\w*\n(.*?)```", re.DOTALL)
YOUNG, NU = 7e6, 0.3
F = np.array([[1.2, 0.3, 0], [-0.1, 0.7, 0], [0, 0, 1]])  # as in verification/homogeneous.edp


@pytest.fixture
def extended(tmp_path):
    """extended(heading): a copy of the program with all blocks of the page below this heading."""
    def apply(heading: str) -> Path:
        section = re.search(rf"(?ms)^## {heading}\n(.*?)(?=^## |\Z)", (ROOT / "docs/how-to/extending.md").read_text())[1]
        for name in ("edp", "orchestrate", "verification"):
            shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
        for path, text in NEW.findall(section):
            (tmp_path / path).write_text(text)
        for name, place, line, text in ADDED.findall(section) + CHANGED.findall(section):
            insert(tmp_path / name, place, line, text)
        for command in re.findall(r"```sh\n(.*?)```", section, re.DOTALL):
            go(tmp_path, "sh", "-c", command)
        return tmp_path
    return apply


def insert(file: Path, place: str, line: str, text: str) -> None:
    """Puts text before or after the line that contains `line`, or instead of it. There is one such line."""
    whole = file.read_text()
    (at,) = [found for found in re.finditer(r"[^\n]*\n", whole) if line in found[0]]
    first, last = {"before": (at.start(), at.start()), "after": (at.end(), at.end()), "instead of": at.span()}[place]
    file.write_text(whole[:first] + (at[0].replace(line, text) if place == "instead of" else text) + whole[last:])


def go(folder: Path, *words: str) -> str:
    """The output of a command in the folder. Asserts that it succeeds."""
    ended = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=os.environ | {"GIT_CEILING_DIRECTORIES": str(folder.parent), "PYTHONPATH": str(folder / "orchestrate")})
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


def run(folder: Path, *words: str) -> dict:
    """The summary of a run in the folder, into out/."""
    go(folder, sys.executable, "-m", "ffimpact", "run", *words, "--out", "out", "--force", "--quiet")
    return results.read_summary(folder / "out")


def measured(folder: Path, script: str, **flags) -> dict[str, float]:
    """The numbers that a script of verification/ prints in the folder."""
    call = f"import json; from verification.measure import measure; print(json.dumps(measure({script!r}, **{flags!r})))"
    return json.loads(go(folder, sys.executable, "-c", call))


@pytest.mark.robustness
def test_obstacle_is_its_expression(extended):
    """A torus is the zero of its distance: an eccentric impact of a ball gives equal impulse, velocity
    and vibration on the same mesh."""
    folder = extended("An obstacle")
    torus = run(folder, "tyre.toml")
    text, _ = (folder / "tyre.toml").read_text().split('kind = "torus"')
    (folder / "tyre.toml").write_text(text + 'kind = "implicit"\ndistance = "sqrt((sqrt(x^2 + z^2) - 0.06)^2 + y^2) - 0.03"\n')
    expression = run(folder, "tyre.toml")
    assert abs(torus["rebound_vx"]) > 1 and torus["dofs"] == expression["dofs"]
    for name, size in (("impulse", torus["impulse"]), ("rebound_vx", 4), ("rebound_vy", 4), ("vibration_energy", torus["energy_initial"])):
        assert expression[name] == pytest.approx(torus[name], abs=1e-4 * size), name


@pytest.mark.robustness
def test_friction_law_has_its_closed_form(extended):
    """A block on an incline creeps at the speed at which the law carries it."""
    folder = extended("A friction law")
    creeps = [list(map(float, line.split())) for line in go(folder, sys.executable, "creep.py").splitlines()]
    assert len(creeps) == 3
    for creep, exact in creeps:
        assert creep == pytest.approx(exact, rel=2e-3)


@pytest.mark.robustness
def test_law_has_its_stress_its_tangent_and_its_energy(extended):
    """Homogeneous stress in closed form, tangent by differences, and an energy balance closed to
    round-off, also beside another law."""
    folder = extended("A constitutive law")
    measured(folder, "homogeneous", law="ciarlet", young=YOUNG, nu=NU, accuracy=0.1, out=str(folder / "fields"))
    l, mu, J = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU)), np.linalg.det(F)
    sigma = mu / J * (F @ F.T - np.eye(3)) + l / 2 * (J - 1 / J) * np.eye(3)
    write_fields(folder / "fields")
    stress = vtu.read(folder / "fields/fields/0000.vtu").fields["cauchy_stress"]
    assert stress == pytest.approx(np.tile(sigma[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]], (len(stress), 1)), rel=1e-7)
    tangent = measured(folder, "tangent-disc", law="ciarlet", integrator="bdf2", accuracy=0.1)
    assert tangent["tangent"] < 1e-6 and tangent["smallest"] < 0.6
    summary = run(folder, "disc-normal", "--set", "law=ciarlet", "accuracy=0.05")
    assert summary["energy_drift"] < 1e-9 and summary["vibration_energy"] > 0.1 * summary["energy_initial"]
    mixed = run(folder, "two-discs", "--set", "body.1.law=ciarlet", "accuracy=0.05")
    assert mixed["energy_drift"] < 1e-9 and mixed["vibration_energy_1"] != pytest.approx(mixed["vibration_energy_2"], rel=1e-5)
