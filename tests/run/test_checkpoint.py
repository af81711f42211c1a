"""Checkpoint and restart: a killed run continues from its last checkpoint with unchanged results.
"""

import os
import re
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

from ffimpact import scene
from ffimpact.failure import Failure, Unreadable
from ffimpact.output import results
from ffimpact.running import run
from ffimpact.scenes import assembly
from tests.support.checkpoint import (
    EFFORT,
    assert_same,
    at_checkpoint,
    direct,
    killed_at,
    rows_known,
)
from tests.support.cli import call, is_alive, start, wait_for
from verification.measure import prepared

COARSE = dict(law="neohookean", nu=0.4)
# Entries of the impact of a disc, steps between checkpoints, and rows of the history that the last
# checkpoint must have.
SCENES = {
    "energy-momentum": (COARSE | dict(accuracy=0.1, angle=60, friction_static=0.7, friction_dynamic=0.5, fields=5), 7, 20),
    "relaxing": (COARSE | dict(accuracy=0.05, branches=((2e6, 1e-3),), viscosity=5), 7, 20),
    "metal": (dict(law="metal", nu=0.3, yield_stress=2e5, perzyna=(100, 2), accuracy=0.1, fields=5), 7, 20),
    "until rest": (COARSE | dict(accuracy=0.1, loss=2, loss_model="kelvin-voigt", speed=0, height=0.05, gravity=9.81, until="rest"), 7, 60),
    "svk": (dict(accuracy=0.1, exponent=1.5, penalty=1e11, height=1e-3, gravity=9.81), 7, 20),
    "midpoint": (COARSE | dict(accuracy=0.1, spin=50, friction_static=0.5, friction_dynamic=0.5, degree=1, integrator="midpoint"),
                 7, 20),
    "backward-euler": (COARSE | dict(accuracy=0.1, dt=2e-5, integrator="backward-euler"), 10, 100),
    "bdf2": (COARSE | dict(accuracy=0.1, dt=2e-5, integrator="bdf2"), 10, 100),
    "central-difference": (COARSE | dict(accuracy=0.2, angle=60, friction_static=0.5, friction_dynamic=0.4, slip_velocity=0.1,
                                         dt=3e-5, integrator="central-difference"), 10, 80),
}
# The other scenes, run by `make robustness`, keep no further state between steps.
OFTEN = ("energy-momentum", "relaxing", "metal", "bdf2", "central-difference")


@pytest.mark.parametrize("name", [name if name in OFTEN else pytest.param(name, marks=pytest.mark.robustness) for name in SCENES])
def test_half_a_run_and_the_rest_are_the_whole(tmp_path, name):
    """A run that is killed twice, and continues each time, equals the run without checkpoints in
    every column and number.

    Hence checkpoints do not change the results.
    """
    flags, every, rows = SCENES[name]
    straight = direct(flags, tmp_path / "straight")
    assert straight.communicate(timeout=120) and straight.returncode == 0
    flags, out = flags | {"checkpoint_every": every}, tmp_path / "out"
    for more in ({}, {"restart": out / "checkpoint"}):
        killed_at(rows // every // 2, flags | more, out)
    knows, there = rows_known(out / "checkpoint"), (out / "history.csv").read_text()
    (out / "history.csv").write_text(there + "rows that were written after the checkpoint\n")
    last = direct(flags | {"restart": out / "checkpoint"}, out)
    assert last.communicate(timeout=120) and last.returncode == 0
    assert_same(out, tmp_path / "straight")
    summary = results.read_summary(out)
    assert summary["resumed_at"] == results.read_history(out)["t"][knows - 1]
    assert results.read_summary(tmp_path / "straight")["resumed_at"] is None
    assert not {path.name for path in out.iterdir()} - {"history.csv", "contacts.csv", "summary.json", "last-state", "fields", "fields.pvd"}   # assert_same has evaluated the record


BALL = COARSE | dict(mesh_size=0.03, contact_mesh_size=0.015, accuracy=0.2, fields=2, end_time=1e-3, dt=2e-5, checkpoint_every=7)
SOFT = {"law": "neohookean", "young": 2e6, "nu": 0.4, "density": 1000.0}
# Two balls of revolution on a surface given by an expression.
BALLS = {"dimension": "axisymmetric", "accuracy": 0.2, "end_time": 6e-3, "checkpoint_every": 4, "obstacle": [{"kind": "implicit", "distance": "y + 10*x^2"}],
         "body": [SOFT | {"shape": "ball", "radius": 0.04, "mesh_size": 0.015, "contact_mesh_size": 0.006, "name": name, "position": [0.0, y], "velocity": [0.0, v]}
                  for name, y, v in (("a", 0.0403, -3.0), ("b", 0.1205, -5.0))]}
# A rigid disc on a pad that is moved from below, beside a ring with air inside, and a rotating
# roller.
DRIVEN = SOFT | {"accuracy": 0.2, "end_time": 4e-3, "checkpoint_every": 4, "gravity": 9.81, "contact": {"friction_static": 0.4}, "body": [
    {"shape": "disc", "radius": 0.03, "rigid": True, "position": [0.0, 0.0502], "velocity": [0.5, -1.0], "mesh_size": 0.01, "contact_mesh_size": 0.005},
    {"shape": "rectangle", "width": 0.3, "height": 0.04, "position": [0.0, 0.0], "mesh_size": 0.02, "contact_mesh_size": 0.01,
     "support": [{"where": "bottom", "motion": [0, "0.002*sin(500*t)"]}]},
    {"shape": "ring", "radius": 0.03, "inner_radius": 0.02, "position": [0.09, 0.052], "velocity": [0.0, -1.0], "mesh_size": 0.01, "contact_mesh_size": 0.006,
     "load": [{"where": "inner", "gas": {"gauge_pressure": 2e4, "exponent": 1.4}}]}],
    "obstacle": [{"kind": "circle", "centre": [-0.1, 0.0402], "radius": 0.02, "rotation": "-3000*t", "motion": [0, "-0.1*t"]}]}


@pytest.mark.few(3)
@pytest.mark.parametrize("script, flags", [
    ("bodies", DRIVEN), ("bodies-axisymmetric", BALLS), ("disc-block", COARSE | dict(radius=0.5, speed=10, accuracy=0.02, checkpoint_every=10)),
    ("ball", BALL), ("ball", BALL | dict(angle=60, friction_static=0.5, friction_dynamic=0.4))])
def test_bodies_go_on_to_the_last_bit(tmp_path, script, flags):
    """The state of gaps and of the active set is restored for bodies of revolution, bodies that are
    rigid, held, driven or filled with air, a disc on a block, and balls in space."""
    every, out = flags["checkpoint_every"], tmp_path / "out"
    flags = prepared(tmp_path, flags) if "body" in flags else flags
    assert direct(flags, tmp_path / "straight", script).communicate(timeout=120)
    rows = len(results.read_history(tmp_path / "straight")["t"])
    killed_at(rows // every // 2, flags, out, script)
    assert direct(flags | {"restart": out / "checkpoint"}, out, script).communicate(timeout=120)
    assert_same(out, tmp_path / "straight")
    assert results.read_summary(out)["resumed_at"] > 0 and (out / "history.csv").read_bytes() == (tmp_path / "straight/history.csv").read_bytes()


def test_a_restart_beside_obstacles_that_move(tmp_path):
    """The same bytes from three checkpoints of a disc with friction between a plane that oscillates
    and a circle that rotates."""
    disc = {"shape": "disc", "radius": 0.05, "position": [0, 0.052], "velocity": [3, -3], "mesh_size": 0.01, "contact_mesh_size": 0.006}
    plane = {"kind": "plane", "point": [0, 0], "normal": [0, 1], "motion": [0, "0.001*sin(2000*t)"]}
    circle = {"kind": "circle", "centre": [0.13, 0.06], "radius": 0.05, "rotation": "-100000*t"}
    flags = prepared(tmp_path, COARSE | {"young": 7e6, "density": 1722, "end_time": 0.006, "dt": 4e-5, "body": [disc], "obstacle": [plane, circle],
                                         "contact": {"friction_static": 0.3, "slip_velocity": 0.05}, "checkpoint_every": 5})
    assert direct(flags, tmp_path / "straight", "bodies").communicate(timeout=120)
    straight = (tmp_path / "straight/history.csv").read_bytes()
    for number in (6, 15, 23):
        out = tmp_path / f"out{number}"
        killed_at(number, flags, out, "bodies")
        assert direct(flags | {"restart": out / "checkpoint"}, out, "bodies").communicate(timeout=120)
        assert (out / "history.csv").read_bytes() == straight, number


# ---- repeated command

SET = dict(law="neohookean", nu=0.4, accuracy=0.1, dt=2e-5, fields=2, checkpoint_every=10)
COMMAND = ("run", "disc-normal", "--quiet", "--no-figures", "--checkpoint-every", "10", "--set",
           *(f"{name}={value}" for name, value in SET.items() if name != "checkpoint_every"), "--out")


def go(out: Path, **changed) -> results.Record:
    options = {name: changed.pop(name) for name in ("force",) if name in changed}
    return run.run(scene.load("disc-normal"), SET | changed, out, **options)


def children(process: subprocess.Popen) -> list[int]:
    return [int(pid) for pid in Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]


@pytest.fixture(scope="module")
def straight(tmp_path_factory) -> results.Record:
    """A run that is never killed."""
    return go(tmp_path_factory.mktemp("straight") / "out", checkpoint_every=0)


@pytest.fixture(scope="module")
def killed(tmp_path_factory) -> Path:
    """out.part of a run whose Python process was killed."""
    out = tmp_path_factory.mktemp("killed") / "out"
    process = start(*COMMAND, str(out), env=at_checkpoint(8, signal.SIGSTOP))
    wait_for(lambda: rows_known(out.with_name("out.part") / "checkpoint") > 75)
    freefems = children(process)
    process.kill()
    process.communicate()
    for pid in freefems:
        os.kill(pid, signal.SIGCONT)
    assert freefems
    wait_for(lambda: not any(map(is_alive, freefems)))  # no process is left
    assert not out.exists()
    return out.with_name("out.part")


@pytest.fixture
def out(killed, tmp_path) -> Path:
    """A result folder whose run was killed."""
    shutil.copytree(killed, tmp_path / "out.part")
    return tmp_path / "out"


def test_killed_driver(out, straight):
    """After kill -9 of the Python process the same command continues and leaves the folder of a run
    without interruption."""
    assert call(*COMMAND, str(out))[:2] == (0, "")
    result = results.Record(out, results.read_summary(out), False)
    assert result.summary["resumed_at"] > 1.5e-3
    assert set(result.summary["provenance"]) == set(straight.summary["provenance"])
    assert {path.name for path in out.iterdir()} == {path.name for path in straight.folder.iterdir()}
    assert_same(out, straight.folder)
    assert not list(out.parent.glob("out.*"))


RISING = """accuracy = 0.001
young = 7e6
nu = 0.45
density = 1722
law = "neohookean"
checkpoint_every = 2
[[body]]
shape = "disc"
radius = 0.05
position = [0, 0.051]
velocity = [0, -2]
[[obstacle]]
kind = "plane"
point = [0, 0]
normal = [0, 1]
velocity = [0, 3]
"""


@pytest.mark.robustness
def test_killed_behind_the_run_that_estimates_the_error(tmp_path):
    """The results of the second run are recognised as those of this scene with its moving obstacle:
    equal error estimates, no needless finer run."""
    (tmp_path / "rising.toml").write_text(RISING)
    out, stage, command = tmp_path / "out", tmp_path / "out.part", ["run", str(tmp_path / "rising.toml"), "--quiet", "--out"]
    assert call(*command, str(tmp_path / "straight"))[0] == 0
    process = start(*command, str(out))
    wait_for(lambda: (stage / "coarser/record.json").exists() and (stage / "checkpoint").exists())
    process.kill()
    process.communicate()
    assert not out.exists() and call(*command, str(out))[0] == 0
    uninterrupted, resumed = (results.read_summary(folder) for folder in (tmp_path / "straight", out))
    assert [uninterrupted[name] == resumed[name] for name in uninterrupted if name not in EFFORT] == [True] * (
        len(uninterrupted) - sum(name in uninterrupted for name in EFFORT))
    assert_same(out, tmp_path / "straight")


@pytest.mark.robustness
def test_killed_freefem(tmp_path, straight):
    """After kill -9 of FreeFem++ one line reports that the same command continues, and it does."""
    out, stage = tmp_path / "out", tmp_path / "out.part"
    process = start(*COMMAND, str(out), env=at_checkpoint(6, signal.SIGSTOP))
    wait_for(lambda: rows_known(stage / "checkpoint") > 50)
    subprocess.run(["kill", "-9", *map(str, children(process))], check=True)
    output, err = process.communicate(timeout=10)
    assert process.returncode == 1 and err.count("\n") == 1 and "killed by SIGKILL" in err and "the same command goes on" in err
    assert str(stage) in output and not out.exists()
    assert go(out).summary["resumed_at"] > 0
    assert_same(out, straight.folder)


@pytest.mark.parametrize("changed", [{"speed": 7.5}, {"force": True}, {"mesh_size": 0.021}, {}],
                         ids=["scene", "force", "mesh", "code"])
def test_another_run_starts_anew(out, straight, monkeypatch, changed):
    """Another scene, mesh or code, and --force, delete the checkpoint and start again."""
    if not changed:
        monkeypatch.setattr(run, "code_hash", lambda: "other")
    result = go(out, **changed, end_time=2e-4)
    assert result.summary["resumed_at"] is None and result.history["t"][-1] == pytest.approx(2e-4)
    assert not list(out.parent.glob("out.*"))


def test_checkpoints_are_not_part_of_the_run(out, straight):
    """The frequency of checkpoints affects neither continued nor reused runs."""
    assert go(out, checkpoint_every=0).summary["resumed_at"] > 0
    assert go(out, checkpoint_every=1000).reused


def test_failed_run_leaves_no_checkpoint(tmp_path):
    """A run that fails by itself keeps its files, but no checkpoint, from which it would fail
    again."""
    with pytest.raises(Failure) as error:
        go(tmp_path / "out", law="svk", speed=60, dt=0, checkpoint_every=1)
    assert error.value.code in (11, 12) and error.value.folder == tmp_path / "out"
    assert len(results.read_history(tmp_path / "out")["t"]) > 2
    assert not list(tmp_path.glob("out/checkpoint*")) and not list(tmp_path.glob("out.*"))


@pytest.mark.few(2)
@pytest.mark.parametrize("damage", ["empty", "text", "cut"])
def test_unreadable_checkpoint(out, damage):
    """An unreadable checkpoint gives exit code 14 and one line with its name and advice. The
    checkpoint stays."""
    checkpoint = out.with_name("out.part") / "checkpoint"
    checkpoint.with_name("checkpoint.new").unlink(missing_ok=True)  # left by a kill during the copy
    content = checkpoint.read_bytes()
    middle = len(content) // 2
    checkpoint.write_bytes({"empty": b"", "text": b"not a checkpoint\n", "cut": content[:middle]}[damage])
    code, _, err = call(*COMMAND, str(out))
    assert code == 14 and err.count("\n") == 1 and str(checkpoint) in err and "it is damaged; delete it" in err
    assert checkpoint.exists() and not out.exists()
    checkpoint.unlink()
    assert go(out, end_time=1e-4).summary["resumed_at"] is None


def test_checkpoint_of_nobody_knows_what(out):
    """If the owner of a checkpoint cannot be read, the run ends with exit code 14."""
    (out.with_name("out.part") / "checkpoint.json").write_text("{")
    with pytest.raises(Unreadable, match="checkpoint.json cannot be read.*delete .*out.part"):
        go(out)


@pytest.mark.parametrize("entries, changed, words", [
    ({"gravity": 7}, {}, "it is of another scene, mesh or version;"),
    ({"body.1.position.2": 0.0501}, {}, "it is of another scene, mesh or version;"),
    ({"body.1.mesh_size": 0.02}, {}, "it is of another scene, mesh or version;"),
    ({}, {"restart": "nowhere"}, "there is no such file"),
    ({}, {"out": "elsewhere"}, "does not have the .* rows before it"),
])
def test_restart_without_python(out, tmp_path, entries, changed, words):
    """FreeFem++ itself refuses a checkpoint of another scene or mesh, a missing one, or one without
    its history: exit code 14."""
    (tmp_path / "files").mkdir()
    flags, _, _ = assembly.prepare(scene.load("disc-normal").override(SET | entries), tmp_path / "files")
    flags |= {"restart": out.with_name("out.part") / "checkpoint"} | changed
    process = direct(flags, tmp_path / flags.pop("out", "out.part"), "bodies")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 14 and err.count("\n") == 1
    assert err.startswith("ffimpact: the checkpoint '") and re.search(words, err), err
