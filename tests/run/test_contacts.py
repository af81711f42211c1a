"""contacts.csv: the numbers of every contact interval, in scenes with known momenta, energies and
histories."""

import numpy as np
import pandas as pd
import pytest

from ffimpact import scene
from ffimpact.report import compare
from ffimpact.running import run
from verification.measure import bodies

COARSE = {"law": "neohookean", "accuracy": 0.1, "fields": 0}
OBLIQUE = COARSE | {"speed": 12, "direction": -60, "friction_static": 0.7, "friction_dynamic": 0.5, "slip_velocity": 0.1}


def go(tmp_path, name: str, values: dict) -> tuple[pd.DataFrame, run.Record]:
    result = run.run(scene.load(name), values, tmp_path / "out", estimate=False)
    return pd.read_csv(result.folder / "contacts.csv"), result


@pytest.mark.parametrize("values", [{}, {"integrator": "bdf2"}], ids=str)
def test_an_interval_adds_up_to_the_history(tmp_path, values):
    """A single impact is one row with the times, impulses, work and energies of summary and
    history."""
    rows, result = go(tmp_path, "disc-normal", OBLIQUE | values)
    row, s, h = rows.iloc[0], result.summary, result.history
    assert len(rows) == 1 and (row.body, row.partner, row.over) == (1, -1, 1)
    for name, other in {"time": "contact_time", "thresholded_time": "thresholded_contact_time", "start": "contact_start", "impulse": "impulse",
                        "friction_work": "friction_work", "creep_work": "creep_work", "slip_work": "slip_work", "restitution": "restitution"}.items():
        assert row[name] == pytest.approx(s[other], rel=1e-9), name
    # The momentum of bdf2 is not a sum of impulses.
    for along in "xy" if values != {"integrator": "bdf2"} else "":
        assert row[f"impulse_{along}"] == pytest.approx(h[f"momentum_{along}"][-1] - h[f"momentum_{along}"][0], rel=1e-7)
    assert 0 < row.creep_work < row.friction_work and row.creep_work + row.slip_work == pytest.approx(row.friction_work)


def test_restitution_and_angles_of_an_oblique_impact(tmp_path):
    """Newton's restitution follows from the normal velocities of the centre, the tangential one
    from v_x + spin times R.

    Without gravity Poisson's and the energetic restitution equal Newton's. The impulse ratio is the
    tangential over the normal impulse.
    """
    rows, result = go(tmp_path, "disc-normal", OBLIQUE)
    row, s, h = rows.iloc[0], result.summary, result.history
    last = np.flatnonzero(h["normal_force"] > 0)[-1]
    rim = h["vx"][last] + 0.05 * h["spin"][last]
    assert (row.normal_x, row.normal_y) == pytest.approx((0, 1), abs=1e-12)
    assert row.approach == pytest.approx(12 * np.sin(np.pi / 3)) and row.separation == pytest.approx(s["rebound_vy"], rel=1e-3)
    assert row.restitution == pytest.approx(row.restitution_poisson, rel=1e-4) == pytest.approx(row.restitution_energetic, rel=1e-4)
    assert row.slip_before == pytest.approx(6) and row.slip_after == pytest.approx(rim, rel=2e-3)
    assert row.restitution_tangential == pytest.approx(-rim / 6, rel=2e-3)
    assert row.restitution_tangential == pytest.approx(s["restitution_tangential"])
    assert row.impulse_ratio == pytest.approx(-row.impulse_x / row.impulse_y) and row.angle_in == pytest.approx(60)
    assert row.angle_out == pytest.approx(np.degrees(np.arctan2(s["rebound_vy"], s["rebound_vx"])), rel=1e-6) == pytest.approx(s["angle_out"])
    assert row.translation_energy + row.rotation_energy + row.vibration_energy + row.friction_work == pytest.approx(s["energy_initial"])


def test_a_touch_on_the_way_up(tmp_path):
    """A vibrating body comes into contact again while its centre leaves: a row without approach and
    restitution, also without sliding."""
    rows, result = go(tmp_path, "disc-normal", {"fields": 0, "mesh_size": 0.016, "contact_mesh_size": 0.006, "dt": 2e-5})
    assert len(rows) == result.summary["contact_intervals"] == 2 and rows.approach[1] < 0 < rows.separation[1]
    assert rows.restitution.notna().tolist() == [True, False] and rows.restitution_tangential.isna().all()


def test_bounces_are_rows(tmp_path):
    """Several bounces under gravity are consecutive impacts. The energy lost in one is missing in
    the next approach."""
    rows, _ = go(tmp_path, "disc-normal", COARSE | {"speed": 0, "body.1.position.2": 0.07, "gravity": 9.81, "end_time": 0.5, "accuracy": 0.3})
    assert len(rows) >= 3 and (rows.start[1:].to_numpy() > rows.end[:-1].to_numpy()).all()
    first, second = rows.iloc[0], rows.iloc[1]
    assert first.approach == pytest.approx(np.sqrt(2 * 9.81 * 0.02), rel=1e-3) and 0.5 < first.restitution <= 1
    assert second.approach == pytest.approx(first.separation, rel=0.02)
    assert second.start - first.end == pytest.approx(2 * first.separation / 9.81, rel=0.02)


def test_two_bodies_and_three(tmp_path):
    """The disc on the block is one contact pair of bodies 1 and 2.

    Impulse and normal force are resultants, equal to changes of momentum and less than the sum of
    magnitudes. The acceleration that is compared with other runs is that of the disc.
    """
    rows, result = go(tmp_path, "disc-block", {"law": "neohookean", "accuracy": 0.3, "fields": 0})
    assert (rows.body == 1).all() and (rows.partner == 2).all()
    assert rows.impulse_y.sum() == pytest.approx(result.summary["impulse_y_1"], rel=1e-9)
    s, h = result.summary, result.history
    impulses = [s["mass_1"] * (s["rebound_vy_1"] - h["vy_1"][0]), s["mass_2"] * (h["vy_2"][0] - s["rebound_vy_2"])]
    assert [s["impulse"], rows.impulse.sum(), (h["normal_force"] * h["dt"]).sum()] == pytest.approx([impulses[0]] * 3, rel=1e-6) and impulses[1] == pytest.approx(impulses[0], rel=1e-6)
    assert s["peak_force"] == h["normal_force"].max() and (h["normal_load"] >= h["normal_force"] * (1 - 1e-12)).all()
    assert (h["normal_load"] * h["dt"]).sum() > 1.005 * s["impulse"]
    assert np.diff(h["vy_1"]) / h["dt"][1:] == pytest.approx((compare.contact_force(h) / compare.mass_of(result))[1:], abs=1e-6 * compare.contact_force(h).max() / s["mass_1"])
    closing = result.history["vy_1"][0] - result.history["vy_2"][0]
    after = result.summary["rebound_vy_1"] - result.summary["rebound_vy_2"]
    assert rows.approach.iloc[0] == pytest.approx(-closing) and rows.separation.iloc[-1] == pytest.approx(after, rel=1e-6)
    assert result.summary["restitution"] == pytest.approx(-after / closing, rel=1e-6)


def test_meetings_are_told_apart(tmp_path):
    """Three discs in a row: the first hits the second, the second the third. Each pair has a row,
    and the run has no restitution."""
    rows, result = go(tmp_path, "three-in-a-row", {"accuracy": 0.3, "fields": 0})
    assert set(zip(rows.body, rows.partner)) == {(1, 2), (2, 3)}
    per = rows.groupby(["body", "partner"])[["impulse_x", "impulse_y"]].sum()
    assert result.summary["impulse_x_1"] == pytest.approx(per.loc[(1, 2)].impulse_x, rel=1e-8)
    assert result.summary["impulse_x_3"] == pytest.approx(-per.loc[(2, 3)].impulse_x, rel=1e-8)
    assert result.summary["restitution"] is None


def test_of_a_ball(tmp_path):
    """Bodies of revolution and in three dimensions have the same columns. Bodies of revolution have
    no tangential impulse."""
    rows, result = go(tmp_path, "ball-axisymmetric", COARSE)
    assert rows.iloc[0].impulse_y == pytest.approx(result.summary["impulse"]) and rows.iloc[0].impulse_x == 0
    assert rows.iloc[0].restitution == pytest.approx(result.summary["rebound_vy"] / 8)


def test_in_contact_at_the_end(tmp_path):
    """An interval that is not over is marked and ends with the run."""
    rows, _ = go(tmp_path, "disc-normal", COARSE | {"end_time": 1e-3})
    assert rows.over.tolist() == [0] and rows.end.tolist() == [1e-3]
    rows, result = go(tmp_path, "disc-normal", COARSE | {"end_time": 1e-3, "body.1.position.2": 1.05})
    assert rows.empty and result.summary["restitution"] is None


def test_a_circle_that_turns_about_its_centre(tmp_path):
    """Without friction its rotation changes neither restitution nor slip of the body. The slip is that
    of the surface, angular velocity times radius. The scene at rest is symmetric: both have the whole mesh."""
    rows = {}
    for rate in (0, 1000):  # [rad/s]
        turning = {"rotation": f"{np.degrees(rate)}*t"} if rate else {}
        tables = {"law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "end_time": 0.006, "dt": 1e-4, "accuracy": 0.1, "symmetry": "full",
                  "body": [{"shape": "disc", "radius": 0.05, "position": [0, 0.05001], "velocity": [0, -6], "mesh_size": 0.012, "contact_mesh_size": 0.012}],
                  "obstacle": [{"kind": "circle", "centre": [0, -0.1], "radius": 0.1} | turning]}
        bodies(tmp_path / str(rate), tables)
        rows[rate] = pd.read_csv(tmp_path / str(rate) / "run/contacts.csv").iloc[0]
    still, turns = rows[0], rows[1000]
    assert turns.restitution == pytest.approx(still.restitution, rel=1e-3) and turns.approach == pytest.approx(6, rel=1e-6)
    assert turns.slip_before == pytest.approx(1000 * 0.1, rel=2e-3) and still.slip_before < 1e-3
