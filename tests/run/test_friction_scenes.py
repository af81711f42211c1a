"""Scenes with friction: loading, runs, reports and the figures 4 to 6 of the paper."""

import json
import re

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.output import results, vtu
from ffimpact.report import compare, drawing, figures, report
from ffimpact.running import run
from ffimpact.sweeps import study

COARSE = {"degree": 1, "mesh_size": 0.0125, "contact_mesh_size": 0.0125, "fields": 3}
FRICTIONLESS = {"contact", "energies", "force", "shapes", "velocity"}


@pytest.fixture(scope="module")
def oblique(tmp_path_factory):
    """The oblique impact as the paper may have run it, with the real FreeFem++."""
    result = run.run(scene.load("disc-oblique-svk"), {"fields": 5}, tmp_path_factory.mktemp("friction") / "oblique", estimate=False)
    report.draw(result)
    return result


def test_oblique_impact_closes_its_balance(oblique):
    """Friction takes energy and never returns any. The balance closes with it. The body leaves with
    forward rotation."""
    summary, work = oblique.summary, oblique.history["friction_work"]
    assert summary["energy_drift"] < 1e-9 and (np.diff(work) >= -1e-9 * summary["energy_initial"]).all()
    assert 0 < summary["friction_work"] == pytest.approx(work[-1]) and summary["rebound_spin"] < 0
    assert summary["sliding_time"] + summary["sticking_time"] == pytest.approx(summary["contact_time"], rel=1e-9)


def test_friction_is_drawn(oblique):
    """A run with friction also has the figures flight and rolling. None is empty."""
    drawn = {path.stem: path.stat().st_size for path in (oblique.folder / "figures").iterdir()}
    assert set(drawn) == FRICTIONLESS | {"flight", "rolling"} and min(drawn.values()) > 10_000


def test_a_missing_picture_of_the_contact_is_named(oblique):
    """If no stored state is in the contact, there is no figure of it, and the report has advice."""
    picture = oblique.folder / "figures/contact.png"
    assert "no contact.png" not in report.report(oblique, verbose=True)
    kept = picture.rename(oblique.folder / "kept.png")
    assert "no contact.png" in (text := report.report(oblique, verbose=True)) and "keeps more" in text
    kept.rename(picture)


def test_whole_body_without_friction(tmp_path):
    """Without friction there is no figure of friction or rolling. A whole body has its flight."""
    values = COARSE | {"direction": -60, "speed": 4}
    result = run.run(scene.load("disc-normal"), values, tmp_path / "slide", estimate=False)
    report.draw(result)
    assert {path.stem for path in (result.folder / "figures").iterdir()} == FRICTIONLESS | {"flight"}
    assert "slide" not in report.report(result, verbose=True).replace(str(result.folder), "") and "lost to friction" not in report.report(result)


@pytest.mark.few(2)
@pytest.mark.parametrize("values", [{"body.1.position.2": 0.06, "speed": 0, "direction": -90, "gravity": 9.81, "symmetry": "full"},
                                    {"body.1.position.2": 0.06, "spin": 50, "gravity": 9.81}, {"end_time": 1e-3},
                                    {"regularization": "tanh", "friction_transition": "smooth"}, {"fields": 1}, {"fields": 0}])
def test_figures_of_unusual_runs(tmp_path, values):
    """Falls from rest, spins, runs that end during contact or keep at most one snapshot are drawn
    without errors."""
    result = run.run(scene.load("disc-oblique"), COARSE | values, tmp_path / "run", estimate=False)
    names = {path.stem for path in drawing.draw(result.folder)}
    assert FRICTIONLESS - {"shapes", "contact"} <= names and ("flight" in names) == (result.scene["fields"] > 2)


def test_report_tells_sliding_from_sticking(oblique):
    """The report has the times of sliding and sticking, and the spin, with the
    paper's number beside ours."""
    text = report.report(oblique, verbose=True)
    for label in ("load slides for", "load sticks for", "spin", "lost to friction"):
        assert label in text
    assert "4.5 (paper, section 3.1" in text and "unsolved" not in text


def test_report_tells_breakdown_and_unsolved_jumps(oblique):
    """Unsolved jumps are reported in plain words, and place and time of a breakdown in mm and ms.
    """
    summary = oblique.summary | {"unsolved_jumps": 7, "breakdown_time": 1.5e-3, "breakdown_x": 0.01, "breakdown_y": 0.002}
    text = report.report(results.Record(oblique.folder, summary, reused=False), verbose=True)
    assert "7 steps of points in a jump of the friction law" in text
    for line in (r"det F <= 0 from +1\.5 ms", r"there X = +10 mm", r"there Y = +2 mm"):
        assert re.search(line, text)


def test_pose_is_the_whole_outline(oblique):
    """The outline of the first snapshot is the closed circle of the disc; its diameter is vertical
    with the mark on top."""
    pose = figures.pose_at(*vtu.series(oblique.folder / "fields.pvd")[0], oblique.history)
    assert (pose.outline[0] == pose.outline[-1]).all()
    # A polygon with sides of at most 10 mm.
    assert np.hypot(pose.outline[:, 0], pose.outline[:, 1] - 0.05) == pytest.approx(0.05, rel=0.01)
    assert np.ptp(pose.diameter[:, 0]) < 1e-4 and pose.diameter[0, 1] > 0.09 and pose.diameter[-1, 1] < 0.01


def test_flight_is_rigid_motion(oblique):
    """Outside the run the body follows the parabola of its centre, rotates with its spin and keeps
    its shape."""
    h = oblique.history
    pose = figures.pose_at(*vtu.series(oblique.folder / "fields.pvd")[-1], h)
    wait, pull = 0.01, 9.81
    moved = figures.flown(pose, wait, -1, h, {"gravity": pull})
    centre = np.array([h["x"][-1], h["y"][-1]])
    place = centre + wait * np.array([h["vx"][-1], h["vy"][-1]]) - [0, pull * wait**2 / 2]
    before, after = pose.outline - centre, moved.outline - place
    assert np.hypot(*after.T) == pytest.approx(np.hypot(*before.T))
    turned = np.angle((after[:, 0] + 1j * after[:, 1]) / (before[:, 0] + 1j * before[:, 1]))
    assert turned == pytest.approx(h["spin"][-1] * wait) and moved.t == pose.t + wait


def test_compare_goes_on_after_a_failure(fake, tmp_path, capsys):
    """A failed scene is reported, the others run, and the exit code is that of the failure."""
    fake("step")
    assert main(["compare", "disc-oblique-svk", "disc-oblique", "--out", str(tmp_path)]) == 11
    # With two cores, the runs for the error estimate may start beside each.
    assert 2 <= fake.starts() <= 6
    captured = capsys.readouterr()
    assert captured.out.count("failed: step: no convergence") == 2 and captured.err.count("\n") == 1


def test_comparison_of_frictional_runs(oblique, tmp_path):
    """The comparison of runs with friction is drawn."""
    compare.draw({"one": oblique, "two": oblique}, tmp_path / "both.png")
    assert (tmp_path / "both.png").stat().st_size > 20_000


def test_study_of_another_scene(fake, tmp_path):
    """A study runs its scene, by default disc-normal."""
    study.study([{"speed": 4.0}], tmp_path, {"fields": 0}, 30.0, "disc-oblique")
    study.study([{"speed": 5.0}], tmp_path, {"fields": 0}, 30.0)
    made = {folder.name: json.loads((folder / "summary.json").read_text())["provenance"]["asked"] for folder in (tmp_path / "runs").iterdir()}
    for where, name, speed in (("speed=4.0", "disc-oblique", 4.0), ("speed=5.0", "disc-normal", 5.0)):
        assert made[where] == scene.load(name).override({"fields": 0, "speed": speed}).decisive_entries
        assert made[where]["body"][0]["speed"] == speed and ("friction_static" in made[where]["contact"]) == (name == "disc-oblique")
