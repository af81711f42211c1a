"""The ball in three dimensions: input, output and messages of its scenes, with and without Python.
"""

import math
from importlib.util import find_spec

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.output import estimate, vtu
from ffimpact.report import contact, figures, report
from ffimpact.running import run
from tests.support.triangles import areas

MASS = 4 / 3 * math.pi * 0.05**3 * 1722


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    return run.run(scene.load("ball"), {"accuracy": 0.05, "fields": 3}, tmp_path_factory.mktemp("ball") / "ball")


@pytest.fixture(scope="module")
def oblique(tmp_path_factory):
    return run.run(scene.load("ball-oblique"), {"accuracy": 0.1, "fields": 5, "end_time": 2e-3}, tmp_path_factory.mktemp("ball") / "ball", estimate=False)


def test_run_of_a_whole_ball(result):
    """Energy [J] and momentum [N s] are those of the whole ball, to the geometric error of the
    mesh.

    Skipped effects are listed, the error is estimated, and the columns of the third dimension
    exist.
    """
    s, h = result.summary, result.history
    assert s["energy_initial"] == pytest.approx(MASS * 8**2 / 2, rel=2e-3)
    assert s["impulse"] == pytest.approx(MASS * (8 + s["rebound_vy"]), rel=2e-3)
    assert "three quarters of the body (symmetry)" in s["skipped"] and "error estimate" not in s["skipped"]
    assert s["energy_drift"] < 1e-9 and s["momentum_drift"] < 1e-9
    assert 0 < estimate.largest(s["estimated_error"]) < 0.2
    assert list(h) == scene.load("ball").columns and not h["vz"].any()


@pytest.mark.robustness
def test_units_and_pictures_are_those_of_a_ball(result, oblique):
    """No unit is per metre. All figures of a quarter are drawn with its mirror image."""
    for record in (result, oblique):
        report.draw(record)
    text = report.report(result, verbose=True)
    assert "N s" in text and "/m" not in text.replace("m/s", "").replace("Pa/m", "").replace("kg/m3", "")
    pictures = {"energies", "force", "velocity", "shapes", "contact"} | ({"solid"} if find_spec("pyvista") else set())
    assert {path.stem for path in (result.folder / "figures").iterdir()} == pictures
    assert {path.stem for path in (oblique.folder / "figures").iterdir()} == pictures | {"flight", "rolling"}
    assert figures.is_half(result.scene) and not figures.is_half(oblique.scene)


def test_scene_as_used_is_a_scene_again(result):
    """scene.toml has the symmetry that was found, and is the same run again."""
    assert result.scene["symmetry"] == "quarter"
    again = scene.load(str(result.folder / "scene.toml"))
    assert again.contact_values["penalty"] == result.scene["contact"]["penalty"]


def test_snapshots_are_cuts_through_the_middle(result, oblique):
    """Snapshots of a quarter show the half x >= 0 of the disc z = 0, snapshots of a half the whole
    disc.

    Triangles are counter-clockwise and fill it, and the plane stays a plane.
    """
    for record, share in ((result, 0.5), (oblique, 1.0)):
        snapshot = vtu.read(vtu.series(record.folder / "fields.pvd")[-1][1])
        area = areas(snapshot)
        assert (area > 0).all() and area.sum() == pytest.approx(share * math.pi * 0.05**2, rel=0.05)
        assert np.abs(snapshot.fields["displacement"][:, 2]).max() < 1e-15
        assert snapshot.fields["cauchy_stress"].shape[1] == 6 and np.abs(snapshot.fields["cauchy_stress"][:, 2]).max() > 0


def test_contact_points_carry_the_load(oblique):
    """The sums of pressure and shear over the surface are the forces of the history at this
    instant.

    The weights of half a ball contain both sides of z = 0, where the shear along z cancels.
    """
    table, history = contact.read(oblique.folder), oblique.history
    for t in np.unique(table.t):
        rows = table[table.t == t]
        row = np.argmin(np.abs(history["t"] - t))
        assert (rows.pressure * rows.weight).sum() == pytest.approx(history["normal_force"][row], rel=1e-6)
        assert (rows.shear * rows.weight).sum() == pytest.approx(history["friction_force"][row], rel=1e-6)
    assert (table.z > -1e-9).all() and np.abs(table.y).max() < 1e-3 and np.abs(table.shear_z).max() > 0


@pytest.mark.parametrize("values, message", [
    ({"symmetry": "quarter", "direction": -60}, "symmetry: quarter, but 'ball' moves along x .accepted: auto.full.half"),
    ({"mesh_size": 0.06}, "mesh_size: 0.06 does not fit the thickness of 'ball'"),
])
def test_what_is_refused(values, message):
    """Exit code 10 and the name of the entry."""
    with pytest.raises(BadInput, match=message):
        scene.load("ball").override(values)


def test_a_disc_has_no_quarter():
    """symmetry = quarter is possible in three dimensions only."""
    with pytest.raises(BadInput, match="symmetry: quarter, but the scene is in the plane .accepted: auto.full.half"):
        scene.load("disc-normal").override({"symmetry": "quarter"})
