"""Scenes of bodies in three dimensions: shapes and distances, meshes, files, symmetry, refused
input, and runs."""

import math

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.geometry import tumbling
from ffimpact.mesh import mesh, solid_mesh, solids
from ffimpact.scenes import approach, mirror
from tests.support.bodies_3d import BALL, BLOCK, FLOOR, read

# ---- shapes

# Volume and area of each shape.
SHAPES = {
    "ball": (solids.ball(0.3), 4 / 3 * math.pi * 0.027, 4 * math.pi * 0.09),
    "box": (solids.box(np.array([0.4, 0.1, 0.2])), 0.008, 2 * (0.04 + 0.02 + 0.08)),
    "cylinder": (solids.cylinder(0.2, 0.5), math.pi * 0.02, 2 * math.pi * 0.2 * 0.7),
    "shell": (solids.shell(0.3, 0.2), 4 / 3 * math.pi * 0.019, 4 * math.pi * 0.13),
    "tube": (solids.tube(0.2, 0.1, 0.5), math.pi * 0.015, 2 * math.pi * (0.3 * 0.5 + 0.03)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_know_their_surface(name):
    """Volume and area are exact. Samples lie on the surface at the requested spacing. Distances are
    exact along the normal and negative inside."""
    shape, volume, area = SHAPES[name]
    assert shape.volume == pytest.approx(volume) and shape.area == pytest.approx(area)
    points = shape.sampled(0.02)
    hollow = {"shell": 0.2, "tube": 0.1}.get(name)
    centre = shape.gap(np.zeros((1, 3)))[0]
    assert abs(shape.gap(points)).max() < 1e-12
    assert centre == pytest.approx(hollow) if hollow else centre < 0
    assert 0.3 < len(points) * 0.02**2 / area < 3
    assert shape.gap(np.array([[0.15, 10.0, 0]]))[0] == pytest.approx(
        math.hypot(0.15, 10) - 0.3 if name in ("ball", "shell") else 10 - shape.extent[1] / 2
    )
    assert np.linalg.norm(points, axis=1).max() == pytest.approx(shape.reach, rel=1e-6)


def test_a_surface_of_triangles_has_the_distances_of_its_body():
    """Distances from a meshed box: outside, near edges and corners, and inside."""
    sizes = mesh.Sizes(0.05, 0.05, np.empty((0, 3)), 0.0)
    made = solid_mesh.mesh_shape("box", np.array([0.4, 0.1, 0.2]), np.eye(3), (), sizes, 0.1)
    surface, box = solids.surface(made.points[made.faces]), SHAPES["box"][0]
    points = np.random.default_rng(1).uniform(-0.3, 0.3, (500, 3))
    assert surface.gap(points) == pytest.approx(box.gap(points), abs=1e-12)
    assert surface.volume == pytest.approx(box.volume) and surface.area == pytest.approx(box.area)


def test_distances_from_slender_triangles():
    """Distances from a long prism of 64 faces, whose triangles have centres far from most of their
    points."""
    turn, count = math.tau / 64, 64
    ring = [np.column_stack([np.cos(turn * np.arange(count)), np.sin(turn * np.arange(count)), np.full(count, z)]) for z in (-50, 50)]
    faces = [(low[k], low[k - 1], high[k - 1]) for low, high in (ring, ring[::-1]) for k in range(count)]
    ends = [(polygon[0], polygon[k], polygon[k + 1]) for polygon in ring for k in range(1, count - 1)]
    angle, z = turn * (np.arange(count) + 0.5), np.linspace(-49, 49, count)
    beside = (math.cos(turn / 2) + 0.2) * np.column_stack([np.cos(angle), np.sin(angle), z / (math.cos(turn / 2) + 0.2)])
    assert solids.distances_from(np.array(faces + ends))(beside) == pytest.approx(np.full(count, 0.2))


def test_places_turns_and_motions():
    """`turn` is an axis times an angle in degrees; `angle` and a single `spin` are about z. A box
    rotated by 90 degrees about x stands on its depth."""
    body, = read(BLOCK | {"position": [1, 2, 3], "turn": [90, 0, 0], "spin": 4}).bodies
    assert body.placed.points[:, 1].max() == pytest.approx(2.1) and body.start_spin.tolist() == [0, 0, 4]
    assert np.array_equal(tumbling.rotation(np.radians([0, 0, 90])), [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turned, = read(BLOCK | {"angle": 30, "spin": [1, 2, 3]}).bodies
    assert turned.start_angle == pytest.approx([0, 0, math.pi / 6]) and turned.start_spin.tolist() == [1, 2, 3]


def test_moments_of_inertia():
    """Moments of inertia of a box by the formula and by its triangles; of other shapes by points
    inside."""
    sides = np.array([0.05, 0.1, 0.2])
    made = solid_mesh.mesh_shape("box", sides, np.eye(3), (), mesh.Sizes(0.1, 0.1, np.empty((0, 3)), 0.0), 0.025)
    assert solids.surface(made.points[made.faces]).moments == pytest.approx(solids.box(sides).moments, rel=1e-9, abs=1e-15)
    x = np.random.default_rng(1).uniform(-1, 1, (400000, 3))
    for shape in (solids.ball(1.0), solids.cylinder(0.7, 1.6), solids.shell(0.9, 0.6), solids.tube(0.8, 0.5, 1.2)):
        inside = x[shape.gap(x) < 0]
        square = inside.T @ inside * 8 / len(x)
        assert shape.moments == pytest.approx(np.trace(square) * np.eye(3) - square, abs=0.01 * shape.moments.max())


def test_balls_meet_where_geometry_says():
    """Two balls off centre: closing speed along the line of centres at contact, sliding speed
    across it, and the smaller radius."""
    met, = approach.onsets_of(read(BALL | {"position": [-0.2, 0, 0], "velocity": [3, 0, 0]}, BALL | {"name": "other", "radius": 0.08, "position": [0.2, 0.03, 0.04], "velocity": [-1, 0, 0]},
                                  obstacles=()))
    sine = 0.05 / 0.13
    assert met.closing == pytest.approx(4 * math.sqrt(1 - sine**2), rel=1e-3) and met.sliding == pytest.approx(4 * sine, rel=1e-3) and met.radius == 0.05


# ---- symmetry

@pytest.mark.parametrize("entries, top, copies", [
    ({}, {}, 4), ({"velocity": [1, -8, 0]}, {}, 2), ({"velocity": [0, -8, 1]}, {}, 1), ({"spin": 5}, {}, 2), ({"spin": [0, 5, 0]}, {}, 1),
    ({"position": [0.01, 0.051, 0]}, {}, 2), ({"position": [0, 0.051, 0.01]}, {}, 1), ({}, {"body_force_x": 1}, 2), ({}, {"symmetry": "half"}, 2), ({}, {"symmetry": "full"}, 1)])
def test_as_much_symmetry_as_there_is(entries, top, copies):
    """The symmetry is a quarter if nothing breaks it, half if all moves in the plane z = 0, else
    none; less if less is requested."""
    assert mirror.copies(read(BALL | entries, BLOCK, **top)) == copies


@pytest.mark.parametrize("turn, copies", [([0, 0, 90], 4), ([0, 0, 30], 2), ([0, 30, 0], 1), ([90, 90, 0], 1)])
def test_a_turned_box_keeps_what_symmetry_it_has(turn, copies):
    """A rotated box is symmetric to z = 0 for any angle about z, and to x = 0 for right angles; a
    lying cylinder likewise."""
    assert mirror.copies(read(BALL | {"position": [0, 0.3, 0]}, BLOCK | {"turn": turn})) == copies
    lying = {"shape": "cylinder", "radius": 0.03, "height": 0.1, "position": [0, -0.04, 0], "turn": turn}
    about_itself = turn == [0, 30, 0]
    assert mirror.copies(read(BALL | {"position": [0, 0.3, 0]}, lying)) == (4 if about_itself else copies)


def test_obstacles_break_symmetry():
    """A wall that faces x leaves half, a wall that faces z no symmetry; a sphere off the axis
    leaves half."""
    for obstacle, copies in ((FLOOR | {"normal": [1, 1, 0], "point": [-1, 0, 0]}, 2), (FLOOR | {"normal": [0, 1, 1], "point": [0, -1, -1]}, 1),
                             ({"kind": "sphere", "centre": [0, -1, 0], "radius": 0.5}, 4), ({"kind": "bowl", "centre": [0.1, 0, 0], "radius": 3}, 2),
                             (FLOOR | {"velocity": [0, 0, 1]}, 1)):
        assert mirror.copies(read(BALL, BLOCK, obstacles=[obstacle])) == copies


# ---- what is refused

BAD = [
    ({"shape": "shell", "inner_radius": 0.05}, {}, "body.1.inner_radius: 0.05 is not less than the radius 0.05"),
    ({"position": [0, 1]}, {}, "body.1.position: '[0, 1]' is no [x, y, z] (accepted: three numbers"),
    ({"velocity": [0, 1]}, {}, "body.1.velocity: '[0, 1]' is no [x, y, z]"),
    ({"turn": [0, 0, 1], "angle": 3}, {}, "body.1.angle: '3' stands beside turn"),
    ({"shape": "disc"}, {}, "body.1.shape: 'disc' is not known (accepted: ball|shell|box|cylinder|tube|mesh)"),
    ({"width": 3}, {}, "body.1.width: no such entry, set to '3'"),
    ({"speed": 3}, {}, "body.1.velocity: '[0, -8, 0]' stands beside speed or direction"),
    ({"radius": 0.3}, {}, "body.1.position: 'ball' overlaps 'block' (body.2)"),
    ({}, {"symmetry": "third"}, "symmetry: 'third' is not known (accepted: auto|full|half|quarter)"),
    ({"velocity": [0, -8, 1]}, {"symmetry": "half"}, "symmetry: half, but 'ball' moves along z (accepted: auto|full)"),
    ({"spin": 1}, {"symmetry": "quarter"}, "symmetry: quarter, but 'ball' spins out of the plane x = 0 (accepted: auto|full|half)"),
    ({}, {"script": "bodies"}, "script: 'bodies' is not that of [[body]] tables in dimension = '3d'"),
]


@pytest.mark.parametrize("entries, top, words", BAD, ids=[words.split(" (")[0] for *_, words in BAD])
def test_what_is_wrong_is_named(entries, top, words):
    """The message is one line with the entry, the value and what is accepted; exit code 10."""
    with pytest.raises(BadInput) as caught:
        read(BALL | entries, BLOCK, **top)
    assert words in str(caught.value) and caught.value.code == 10 and "\n" not in str(caught.value)
