"""Scenes of bodies of revolution: sections, meshes and positions, and refused input."""

import math

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.mesh.mesh import Sizes, mesh_body
from ffimpact.scenes import assembly
from tests.support.bodies_axisymmetric import BALL, FLOOR, SHAPES, read


def test_a_cone_is_about_its_centre_of_volume():
    """The centre of a cone is a quarter of its height above the base, not a third as the centre of
    its section."""
    cone, = read(SHAPES["cone"][0]).bodies
    assert cone.outline.points[:, 1].max() == pytest.approx(0.25) and cone.outline.points[:, 1].min() == pytest.approx(-0.75)


@pytest.mark.parametrize("accuracy", [0.1, 0.02, 0.005])
def test_the_volume_of_an_ellipsoid_is_exact_within_a_fifth_of_the_accuracy(accuracy):
    """Its edges are straight, also far from the contact where elements of half a semi-axis would
    do."""
    table, volume = SHAPES["ellipsoid"]
    scene = read(table | {"position": 0}, accuracy=accuracy)
    made = mesh_body(assembly.boundary_curves(scene, 0), Sizes(0.05, 0.05, np.empty((0, 2)), 0.0), 0.1)
    corners = made.points[made.triangles]
    sides = corners[:, 1:] - corners[:, :1]
    areas = (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) / 2
    revolved = 2 * math.pi * (areas * corners[..., 0].mean(axis=1)).sum()
    assert volume * (1 - accuracy / 5) < revolved < volume


def test_a_rigid_profile_is_a_surface_of_revolution():
    """A polyline from the axis outwards with its mirror image: distances from the apex and the
    flank of a cone.

    A polyline from axis to axis is closed.
    """
    with pytest.raises(BadInput, match="is no section of a surface of revolution"):
        read(BALL, obstacles=[{"kind": "polyline", "vertices": [[1, -1], [2, 0]]}])
    # In the inward direction everything but the cone is solid.
    with pytest.raises(BadInput, match="overlaps"):
        read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[1, -1], [0, 0]]}])
    cone = read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, -1]]}]).obstacles[0]
    assert cone.gap(np.array([[0, 1.0], [1, 0], [-1, 0], [0, -1]])) == pytest.approx([1, math.sqrt(0.5), math.sqrt(0.5), -math.sqrt(0.5)])
    block = read(BALL | {"position": 5}, obstacles=[{"kind": "polyline", "vertices": [[0, 0], [1, 0], [1, -1], [0, -1]]}]).obstacles[0]
    assert block.numbers[0] == 1 and block.gap(np.array([[0, 1.0], [0, -0.4]])) == pytest.approx([1, -0.4])


# ---- what is refused

BAD = [
    ({"position": [0.1, 2]}, {}, "body.1.position: x is 0.1, off the axis of revolution (accepted: [0, y], or y alone)"),
    ({"velocity": [1, 0]}, {}, "body.1.velocity: x is 1, off the axis"),
    ({"velocity": "fast"}, {}, "body.1.velocity: 'fast' is not a number"),
    ({"spin": 3}, {}, "body.1.spin: no such entry, set to '3'"),
    ({"angle": 30}, {}, "body.1.angle: no such entry, set to '30'"),
    ({"shape": "disc"}, {}, "body.1.shape: 'disc' is not known (accepted: ball|shell|ellipsoid|cylinder|polygon|tube|torus|mesh)"),
    ({"shape": "polygon", "vertices": [[0, 0], [1, 0], [1, 1]]}, {}, "body.1.vertices: do not go from the axis to the axis"),
    ({}, {"body_force_x": 1}, "body_force_x: no such entry, set to '1'"),
    ({}, {"dimension": "2d"}, "dimension: '2d' is not known (accepted: plane-strain|axisymmetric"),
    ({}, {"script": "bodies"}, "script: 'bodies' is not that of [[body]] tables in dimension = 'axisymmetric' (accepted: bodies-axisymmetric)"),
    ({"position": -0.8}, {}, "body.1.position: 'ball' overlaps 'floor'"),
]


@pytest.mark.parametrize("entries, top, words", BAD, ids=[words.split(" (")[0] for *_, words in BAD])
def test_what_is_wrong_is_named(entries, top, words):
    """The message is one line with the entry, the value and what is accepted; exit code 10."""
    table = {key: value for key, value in BALL.items() if key != "radius" or entries.get("shape", "ball") == "ball"}
    with pytest.raises(BadInput) as caught:
        read(table | entries, **top)
    assert words in str(caught.value) and caught.value.code == 10 and "\n" not in str(caught.value)


@pytest.mark.parametrize("obstacle, words", [
    ({"normal": [1, 1]}, "obstacle.1.normal: '[1, 1]' is not along the axis of revolution (accepted: [0, 1] or [0, -1])"),
    ({"velocity": [1, 0]}, "obstacle.1.velocity: x is 1, off the axis"),
    ({"kind": "circle"}, "obstacle.1.kind: 'circle' is not known (accepted: plane|sphere|bowl|polyline|implicit)")])
def test_obstacles_off_the_axis_are_refused(obstacle, words):
    """Planes must be perpendicular to the axis, other obstacles must be on it."""
    with pytest.raises(BadInput) as caught:
        read(BALL, obstacles=[FLOOR | obstacle])
    assert words in str(caught.value)
