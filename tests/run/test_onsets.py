"""Contact with small obstacles, corners and edges.

Tested are the elements that resolve them, the onset of contact, the largest penetration, and
messages about them.
"""

import math
import re

import pytest

from ffimpact.running import run
from ffimpact.scene import Scene
from ffimpact.scenes import approach, assembly
from tests.support.onsets import DISC, go, scene

MASS = 1722 * math.pi * 0.05**2  # kg/m
FLAT = {"mesh_size": 0.0125, "contact_mesh_size": 0.0125}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}


def peg(radius: float, kind: str = "circle", axes: int = 2) -> dict:
    """A peg with its top at y = 0.015."""
    return {"name": "peg", "kind": kind, "centre": [0, 0.015 - radius, 0][:axes], "radius": radius}


def warnings_of(result: run.Record, name: str) -> list[str]:
    return [warning for warning in result.summary["warnings"] if warning.startswith(name + ": ")]


@pytest.mark.few(1)
@pytest.mark.parametrize("change", [{}, {"velocity": [0, -0.08]}, {"shape": "disc", "radius": 0.05, "position": [0, 0.0501]}], ids=str)
def test_the_peak_of_a_face_that_strikes_flat_is_named(tmp_path, change):
    """With a stiff penalty all points of a flat face strike at once: the first steps have a force
    that depends on the penalty.

    The warning gives rho c v on the face, the force of plane waves, to a fifth. With the automatic
    penalty the peak is rho c v to a fifth. For a disc, whose contact grows, there is no such
    warning.
    """
    block = {"name": "block", "shape": "rectangle", "width": 0.2, "height": 0.1, "position": [0, 0.05], "velocity": [0, -0.8]}
    if "radius" in change:
        block = {"velocity": block["velocity"]}
    stiff = {} if "radius" in change else {"contact": {"penalty": 1e13}}
    result = go(tmp_path, block | change, FLOOR, accuracy=0.02, density=1000, **stiff)
    warned, (flat, *_) = warnings_of(result, "peak force"), [*warnings_of(result, "peak force"), ""]
    assert not warnings_of(result, "corner") and bool(warned) == ("radius" not in change)
    if warned:
        speed = -(block | change)["velocity"][1]
        exact = 0.2 * speed * math.sqrt(1000 * 7e6 * 0.7 / (1.3 * 0.4))
        assert float(re.search(r"is at most (\S+) N/m", flat)[1]) == pytest.approx(exact, rel=0.2) and result.summary["peak_force"] > 1.8 * exact
        (tmp_path / "open").mkdir()
        open_one = go(tmp_path / "open", block | change, FLOOR, accuracy=0.02, density=1000)
        assert open_one.summary["peak_force"] == pytest.approx(exact, rel=0.2) and not warnings_of(open_one, "peak force")


def test_a_normal_impact_does_not_creep(tmp_path):
    """Round-off moves a body along the plane, and its points less: there is no creep."""
    assert not warnings_of(go(tmp_path, DISC | {"position": [0, 0.0501]}, FLOOR, accuracy=0.02, contact={"friction_static": 0.3}), "creep")


def test_what_turns_strikes_by_its_spin(tmp_path):
    """A rod that spins towards a peg strikes it with the velocity of its contact point."""
    rod = {"name": "rod", "shape": "rectangle", "width": 0.4, "height": 0.02, "position": [0, 0], "spin": 50}
    first, = [pair for pair in approach.onsets_of(scene(rod, {"name": "peg", "kind": "circle", "centre": [0.15, 0.06], "radius": 0.01})) if pair.time < 0.01][:1]
    assert 0.15 * 50 < first.closing < 0.17 * 50 and first.time == pytest.approx(0.0051, abs=3e-4)


@pytest.mark.parametrize("radius", [0.01, 0.0025, *(pytest.param(radius, marks=pytest.mark.robustness) for radius in (0.005, 0.001))])
def test_a_disc_rebounds_from_a_peg(tmp_path, radius):
    """A disc of 50 mm at 3 m/s gets 80 N s/m from a peg of any radius: elements and automatic
    penalty follow the smaller radius."""
    result = go(tmp_path, DISC, peg(radius))
    assert MASS * (result.summary["rebound_vy"] + 3) == pytest.approx(80.3, abs=0.8)
    assert not warnings_of(result, "small obstacle") and not warnings_of(result, "penetration")
    assert result.summary["max_penetration"] < 0.05 * radius


def test_steps_do_not_pass_a_peg(tmp_path):
    """The flight is integrated in steps of three diameters of the peg. Contact begins when the disc
    reaches it."""
    result = go(tmp_path, DISC | {"position": [0, 0.085]}, peg(0.0002), without="flight", accuracy=0.4, end_time=0.00675)
    assert 3 * result.history["dt"].max() > 0.0012 and result.summary["contact_start"] == pytest.approx(0.02 / 3, rel=5e-3)
    assert result.summary["max_penetration"] < 1e-5


def test_a_peg_between_the_points_is_measured_and_named(tmp_path):
    """With elements far larger than the peg, it penetrates between the contact points.

    max_penetration has the depth, and the warning has peg, radius and elements, not the floor
    beside it.
    """
    coarse = DISC | FLAT | {"position": [0.004, 0.0651]}
    result = go(tmp_path, coarse, [FLOOR | {"point": [0, -1]}, peg(0.001)], end_time=0.01)
    assert result.summary["max_penetration"] == pytest.approx(0.03, abs=0.003)
    (small,), (deep,) = warnings_of(result, "small obstacle"), warnings_of(result, "penetration")
    assert small.startswith("small obstacle: disc and peg ") and "radius is 0.001 m" in small and "disc and peg overlap" in deep


def test_a_spike_is_measured_and_named(tmp_path):
    """A corner without rounding is not resolved by any elements: a warning reports it, and the
    depth is that of the corner, not of the contact points beside it."""
    spike = {"name": "spike", "kind": "polyline", "closed": True, "vertices": [[0, 0.015], [0.01, -0.1], [-0.01, -0.1]]}
    result = go(tmp_path, DISC | {"position": [0.004, 0.0661]}, spike, end_time=0.002)
    (sentence,) = warnings_of(result, "sharp corner")
    assert sentence.startswith("sharp corner: disc and spike ") and result.summary["max_penetration"] > 0.004


def test_a_square_touches_with_its_corner_when_it_does(tmp_path):
    """Contact begins when the corner reaches the floor, not when the first point inside an edge
    does. The penetration is that of the corner."""
    square = {"name": "square", "shape": "rectangle", "width": 0.1, "height": 0.1, "angle": 45, "position": [0, 0.075], "velocity": [0, -2]}
    result = go(tmp_path, square | FLAT, FLOOR, end_time=0.004)
    assert result.summary["contact_start"] == pytest.approx((0.075 - 0.05 * math.sqrt(2)) / 2, rel=1e-9)
    assert result.summary["max_penetration"] > 1e-4


def test_a_cone_touches_with_its_tip_when_it_does(tmp_path):
    """The apex of a body of revolution is on the axis, where no area is, and contact begins with it
    nevertheless."""
    cone = {"name": "cone", "shape": "polygon", "vertices": [[0, 0], [0.04, 0.06], [0, 0.06]], "position": 0.05, "velocity": -2}
    result = go(tmp_path, cone | FLAT, FLOOR, dimension="axisymmetric", end_time=0.004)
    assert result.summary["contact_start"] == pytest.approx((0.05 - 0.75 * 0.06) / 2, rel=1e-9)


def test_a_cube_touches_with_its_corner_when_it_does(tmp_path):
    """The same for a cube on its corner in three dimensions."""
    turn = math.degrees(math.acos(1 / math.sqrt(3))) / math.sqrt(2)
    cube = {"name": "cube", "shape": "box", "width": 0.1, "height": 0.1, "depth": 0.1, "turn": [-turn, 0, turn], "position": [0, 0.09, 0], "velocity": [0, -2, 0]}
    coarse = {"mesh_size": 0.05, "contact_mesh_size": 0.03}
    result = go(tmp_path, cube | coarse, FLOOR | {"point": [0, 0, 0], "normal": [0, 1, 0]}, dimension="3d", symmetry="full", accuracy=0.4, end_time=0.0018)
    assert result.summary["contact_start"] == pytest.approx((0.09 - 0.05 * math.sqrt(3)) / 2, rel=1e-9)


def test_crossed_edges_are_measured_and_named(tmp_path):
    """Two bars collide with crossed edges between their contact points: their overlap is measured
    and reported."""
    bar = {"shape": "box", "height": 0.05} | FLAT
    upper = bar | {"name": "upper", "width": 0.1, "depth": 0.05, "turn": [45, 0, 0], "position": [0, 0.0712, 0], "velocity": [0, -1, 0]}
    lower = bar | {"name": "lower", "width": 0.05, "depth": 0.1, "turn": [0, 0, 45], "position": [0, 0, 0], "velocity": [0, 1, 0]}
    result = go(tmp_path, [upper, lower], [], dimension="3d", symmetry="full", accuracy=0.4, end_time=0.0008)
    overlap = 2 * 0.0008 - (0.0712 - 0.05 * math.sqrt(2))
    assert result.summary["max_penetration"] == pytest.approx(overlap / math.sqrt(2), rel=0.02)
    (sentence,) = warnings_of(result, "unseen contact")
    assert sentence.startswith("unseen contact: upper and lower ") and "contact_mesh_size" in sentence


@pytest.mark.parametrize("dimension, kind", [("plane-strain", "circle"), ("axisymmetric", "sphere"), ("3d", "sphere")])
def test_elements_follow_the_radius_of_an_obstacle(dimension, kind):
    """In any dimension a tenth of the radius of the obstacle gives a tenth of the element size in
    contact and ten times the penalty; larger obstacles give neither."""
    axes = 3 if dimension == "3d" else 2
    body = DISC | {"shape": "disc" if kind == "circle" else "ball", "position": [0, 0.0651, 0][:axes], "velocity": [0, -3, 0][:axes]}
    if dimension == "axisymmetric":
        body |= {"position": 0.0651, "velocity": -3}
    sizes, penalties = [], []
    for radius in (0.005, 0.0005, 0.05, 50):
        tables = scene(body, peg(radius, kind, axes), dimension=dimension)
        ask = assembly.AutomaticValues(tables, approach.onsets_of(tables))
        values = assembly.contact_values(tables.bodies, tables.contact_values, ask, "contact")
        sizes.append(assembly.element_sizes(0, ask).contact)
        own = [assembly.pair_values(pair, ask, values) for pair in assembly.with_open_penalties(tables, ask)]
        penalties.append(own[0]["penalty"] if own else values["penalty"])
    assert sizes[1] == pytest.approx(sizes[0] / 10, rel=0.05) and sizes[0] <= 0.005 / 4 * 1.01
    assert penalties[1] == pytest.approx(10 * penalties[0], rel=0.05) and penalties[2] == penalties[3]
    assert sizes[2] == pytest.approx(sizes[3], rel=0.05)


def contact_size(tables: Scene) -> float:
    """The element size of the first body of a scene near contact."""
    return assembly.element_sizes(0, assembly.AutomaticValues(tables, approach.onsets_of(tables))).contact


@pytest.mark.parametrize("distance", ["sqrt(x^2+(y+0.0401)^2)-0.02", "x^2+(y+0.0401)^2-0.0004"])
def test_an_expression_of_a_sphere_gets_the_elements_of_one(distance):
    """Both for a signed distance and for another expression."""
    ball = {"name": "ball", "shape": "ball", "radius": 0.02, "position": [0, 0], "velocity": [0, -5]}
    sphere, expression = (scene(ball, {"name": "sphere"} | kind, dimension="axisymmetric")
                          for kind in ({"kind": "sphere", "centre": [0, -0.0401], "radius": 0.02},
                                       {"kind": "implicit", "distance": distance}))
    assert contact_size(sphere) == pytest.approx(contact_size(expression))


def test_a_face_that_slides_until_it_rests_has_the_elements_of_one_that_hits():
    """For any sliding distance its elements are those of its width and follow the accuracy."""
    box = {"name": "box", "shape": "rectangle", "width": 0.1, "height": 0.1, "position": [0, 0.0501], "velocity": [0.1, -0.1], "mesh_stretch": 1}
    hits, rests = (scene(box | {"loss": 0.5, "loss_model": "kelvin-voigt"}, FLOOR, gravity=9.81, until=until) for until in ("impact", "rest"))
    assert contact_size(rests) == pytest.approx(contact_size(hits)) and contact_size(rests) > 0.005


@pytest.mark.parametrize("gravity", [0, 9.81])
def test_a_body_set_down_flat_is_not_turned(gravity):
    """A square that lands flat, however slowly, comes into contact with its whole face: its
    elements are those of a fast one, to a tenth; set down by its weight, which makes no front, they
    are two thirds as large."""
    sizes = []
    for speed in (1e-13, 0.1):
        square = {"name": "square", "shape": "rectangle", "width": 0.1, "height": 0.1, "position": [0, 0.05], "velocity": [0, -speed]}
        sizes.append(contact_size(scene(square, FLOOR, gravity=gravity)))
    assert sizes[0] == pytest.approx(sizes[1] * (2 / 3 if gravity else 1), rel=0.1) and sizes[0] > 0.005


@pytest.mark.parametrize("angle, share", [(35, 1), (0, 0)])
def test_a_contact_that_begins_at_a_corner_is_named(tmp_path, angle, share):
    """A block that falls on its corner gives a warning that error estimates do not cover the effect
    of smaller elements there.

    The warning has the share of this contact in the impulse, which is all of it. A block that falls
    flat gives none.
    """
    block = {"name": "block", "shape": "rectangle", "width": 0.1, "height": 0.05, "angle": angle, "position": [0, 0.075], "velocity": [0, -2]}
    result = go(tmp_path, block, FLOOR, accuracy=0.02)
    assert result.summary["corner_share"] == pytest.approx(share, abs=0.05) and len(warnings_of(result, "corner")) == share


def test_a_flat_end_whose_rim_touches_first_is_no_corner(tmp_path):
    """A plate presses a cylinder on the floor: its end lands as a face, whose rim may come into
    contact first, and its side does not.

    No corner is flattened.
    """
    cylinder = {"name": "cylinder", "shape": "cylinder", "radius": 0.025, "height": 0.05, "position": [0, 0.0251]}
    plate = {"name": "plate", "kind": "plane", "point": [0, 0.0502], "normal": [0, -1], "velocity": [0, -0.3]}
    result = go(tmp_path, cylinder, [FLOOR, plate], young=2e6, nu=0.45, density=1000, dimension="axisymmetric", end_time=0.03)
    assert result.summary["impulse"] > 0 and result.summary["corner_share"] == 0 and not warnings_of(result, "corner")


@pytest.mark.parametrize("thickness, obstacle, through", [
    (1e-3, lambda t: {"kind": "polyline", "vertices": [[-0.3, 0], [0.3, 0], [0.3, -t], [-0.3, -t]], "closed": True}, True),
    (1e-3, lambda t: {"kind": "implicit", "distance": f"abs(y+{t / 2})-{t / 2}"}, True),
    (1e-2, lambda t: {"kind": "polyline", "vertices": [[-0.3, 0], [0.3, 0], [0.3, -t], [-0.3, -t]], "closed": True}, False)], ids=["thin", "implicit", "thick"])
def test_a_body_that_is_pressed_through_a_thin_obstacle_is_named(tmp_path, thickness, obstacle, through):
    """Points deeper than half the thickness are pushed out on the far side: the body passes
    through, which is a warning."""
    result = go(tmp_path, {"name": "disc", "shape": "disc", "radius": 0.05, "position": [0, 0.06], "velocity": [0, -20]}, {"name": "plate"} | obstacle(thickness))
    assert (result.summary["rebound_vy"] < 0) == through == bool(warnings_of(result, "through"))
    if through:
        assert "plate (" in warnings_of(result, "through")[0]


@pytest.mark.parametrize("shape, kind", [({"shape": "rectangle", "width": 0.2, "height": 0.1}, "warnings"), ({"shape": "disc", "radius": 0.05}, "notes")])
def test_a_hard_flat_strike_is_warned_of_and_a_hard_round_one_has_a_note(tmp_path, shape, kind):
    """At a tenth of the wave speed: the peak force of a face that lands as a whole depends on a
    stiff penalty, not on the bodies, at any speed."""
    result = go(tmp_path, shape | {"name": "body", "position": [0, 0.0501], "velocity": [0, -8]}, FLOOR, accuracy=0.02, density=1000, contact={"penalty": 1e13})
    assert {key: any(sentence.startswith("peak force: ") for sentence in result.summary[key]) for key in ("warnings", "notes")} == {"warnings": kind == "warnings", "notes": kind == "notes"}


@pytest.mark.parametrize("tilt, turns", [(0.0, False), (1e-5, False), (0.02, True)])
def test_a_face_that_comes_down_flat_on_a_slope_meets_it_at_its_middle(tilt, turns):
    """A face parallel to the plane to five digits, as normals are written, does not rotate its
    body.

    No corners strike afterwards, and its elements are those of a face. Tilted by a degree, the body
    rotates.
    """
    angle = math.radians(20)
    up = [-math.sin(angle + tilt), math.cos(angle + tilt)]
    block = {"name": "block", "shape": "rectangle", "width": 0.1, "height": 0.05, "angle": 20,
             "position": [-0.0251 * math.sin(angle), 0.0251 * math.cos(angle) + 0.06 * tilt]}
    problem = scene(block, FLOOR | {"normal": up}, accuracy=0.02, gravity=9.81, until="rest", viscosity=500)
    assert (len(approach.onsets_of(problem)) > 1) == turns
    if not turns:
        made = assembly.assemble(problem)
        assert made.used["body"][0]["contact_mesh_size"] > 0.005 and len(made.mesh.triangles) < 500
