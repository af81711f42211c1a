"""Contact with small obstacles, corners and edges.

Tested are the elements that resolve them, the onset of contact, the largest penetration, and
messages about them.
"""

import tomllib
from pathlib import Path

import pytest

from ffimpact.input.toml_text import to_toml
from ffimpact.scene import read as read_scene
from ffimpact.scenes import approach, assembly
from tests.support.onsets import DISC, go, scene


@pytest.mark.robustness
def test_two_discs_that_meet_head_on_part_so(tmp_path):
    """Soft rubber on steel: the last contact at single points does not change the angle of
    reflection."""
    rubber = {"name": "rubber", "shape": "disc", "radius": 0.05, "young": 1e6, "nu": 0.49, "position": [0, 0.101], "velocity": [0, -3]}
    steel = {"name": "steel", "shape": "disc", "radius": 0.05, "young": 2.1e11, "density": 7850, "position": [0, 0]}
    assert go(tmp_path, [rubber, steel], [], accuracy=0.02, density=1000).summary["angle_out"] == pytest.approx(90, abs=0.2)


@pytest.mark.robustness
def test_an_obstacle_that_is_met_twice_has_one_table():
    """An ellipse that lands on two crests of a wave has one table of contact in the scene as used, which
    reads back as written."""
    ellipse = {key: value for key, value in DISC.items() if key != "radius"} | {"shape": "ellipse", "semi_axes": [0.05, 0.03], "angle": 30.0}
    tables = scene(ellipse | {"position": [0, 0.0551]}, {"name": "waves", "kind": "implicit", "distance": "y - 0.002*sin(200*x)"})
    assert [(pair.first, pair.second) for pair in approach.onsets_of(tables)] == [(0, -1), (0, -1)]
    built = assembly.assemble(tables)
    assert [pair["bodies"] for pair in built.used["contact"]["pair"]] == [["disc", "waves"]]
    again = read_scene(tomllib.loads(to_toml(built.used)), Path(), "again")
    assert [(pair.first, pair.second) for pair in again.pairs] == [(0, -1)] and assembly.assemble(again).data == built.data


@pytest.mark.robustness
def test_points_at_a_vertex_know_both_its_edges(tmp_path):
    """A point beyond the end of an edge, near the limit of the search distance, is outside of the
    body.

    No force appears between two steps, and energy is conserved (40 m/s on a plate that is 100 times
    as stiff).
    """
    disc = {"name": "disc", "shape": "disc", "radius": 0.05, "young": 1e6, "nu": 0.45, "position": [0, 0.0501], "velocity": [0, -40]}
    plate = {"name": "plate", "shape": "rectangle", "width": 0.15, "height": 0.02, "young": 1e8, "nu": 0.45, "position": [0.0355, -0.01]}
    result = go(tmp_path, [disc, plate], [], accuracy=0.2, end_time=8e-4, contact={"friction_static": 0.3})
    assert result.summary["energy_drift"] < 1e-9


@pytest.mark.robustness
def test_the_bottom_of_a_bowl_may_lie_where_its_expression_has_no_slope(tmp_path):
    """A square root has no slope at 0, where the top of the disc passes. The onset of contact
    agrees with the `bowl` of the same shape."""
    disc = {"name": "disc", "shape": "disc", "radius": 0.05, "position": [0, 0.051], "velocity": [0, -4]}
    runs = [go(tmp_path / kind["kind"], disc, kind) for kind in ({"kind": "implicit", "distance": "0.1-sqrt(x^2+(y-0.1)^2)"}, {"kind": "bowl", "centre": [0, 0.1], "radius": 0.1})]
    assert runs[0].summary["impulse"] == pytest.approx(runs[1].summary["impulse"], rel=2e-3)
