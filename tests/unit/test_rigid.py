"""Rigid bodies: exact rigid motions, and the limit of stiff bodies."""

import numpy as np
import pytest

from ffimpact.__main__ import main
from ffimpact.input import dimension, models
from tests.support.rigid import DISC, FLOOR, ROLLER


@pytest.mark.parametrize("entries, named", [
    ("young = 1e6", "body.1.young"), ("[[body.support]]\nwhere = 'all'", "body.1.support"), ("mass = 1\ndensity = 1", "body.1.mass"),
    ("inertia = -1", "body.1.inertia"), ("inertia = [1, 1, 1]", "body.1.inertia"), ("viscosity = 1", "body.1.viscosity")])
def test_wrong_entries(tmp_path, capsys, entries, named):
    """One line with the entry, exit code 10."""
    file = tmp_path / "scene.toml"
    file.write_text(DISC + "position = [0, 0.06]\nvelocity = [0, -1]\n" + entries + "\n" + FLOOR)
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    message = capsys.readouterr().err
    assert named in message and message.count("\n") == 1


def test_all_rigid_needs_a_penalty(tmp_path, capsys):
    """There is no deformable body whose stiffness could determine the penalty."""
    file = tmp_path / "scene.toml"
    file.write_text(DISC + "position = [0, 0.06]\nvelocity = [0, -1]\n" + FLOOR.replace("penalty = 1e7", "friction_static = 0.1"))
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    assert "contact.penalty" in capsys.readouterr().err


@pytest.mark.parametrize("entries, named", [
    ('motion = [0, "1/t"]', "obstacle.1.motion.2"), ("motion = 3", "obstacle.1.motion"), ("pivot = [0, 0]", "obstacle.1.pivot"),
    ('rotation = "10*t"\nvelocity = [0, -1]', "obstacle.1.velocity"), ('rotation = "u"', "obstacle.1.rotation"),
    ('rotation = "10*t"\naxis = [0, 0, 1]', "obstacle.1.axis"), ('rotation = 20', "obstacle.1.rotation: 20 does not change"),
    ('motion = [0, "0.1*2"]', "obstacle.1.motion.2: 0.2 does not change")])
def test_wrong_motions(tmp_path, capsys, entries, named):
    """One line with the entry, exit code 10."""
    file = tmp_path / "scene.toml"
    file.write_text(ROLLER.format(entries))
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 10
    message = capsys.readouterr().err
    assert named in message and message.count("\n") == 1


@pytest.mark.parametrize("motion", [
    {"velocity": [0.3, -0.2]}, {"motion": [0, "-0.04*sin(pi*t/0.03)"], "rotation": "-2000*t", "pivot": [0.1, 0.05]}])
def test_the_matrix_of_an_obstacle_takes_it_along(motion):
    """Points of the surface at the start are on the surface at a later time; at the start nothing
    has moved. Pictures and the player use the matrix."""
    scene = {"dimension": "2d", "obstacle": [{"kind": "polyline", "vertices": [[-0.1, -0.1], [-0.1, 0], [0.2, 0.05], [0.2, -0.1]], "closed": True, **motion}]}
    (obstacle,) = models.obstacles_of(scene | {"end_time": 0.05}, dimension.PLANE_STRAIN, None)
    side = np.linspace([-0.1, 0], [0.2, 0.05], 5)
    assert obstacle.moves and np.array_equal(obstacle.matrix(0.0), np.eye(4))
    moved = np.pad(side, [(0, 0), (0, 1)]) @ obstacle.matrix(0.02)[:3, :3].T + obstacle.matrix(0.02)[:3, 3]
    assert abs(moved[:, :2] - side).max() > 1e-3
    assert obstacle.gap_in_plane(moved[:, :2], 0.02) == pytest.approx(0, abs=1e-12)
