"""Formulas of meshes, motion and sizes against exact answers and scaling laws."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.freefem.freefem import At
from ffimpact.geometry import tumbling
from ffimpact.mesh import curved, mesh
from ffimpact.output.results import Contents
from ffimpact.report import impacts, report
from ffimpact.report.impact import impact_of
from ffimpact.running import forecast
from ffimpact.scenes import front
from ffimpact.scenes.approach import onsets_of
from ffimpact.scenes.sizes import Impact
from tests.support.front import BLOCK, scene_of

BALL = Impact(sphere=True, radius=0.05, young=7e6, nu=0.45, density=1722.0, closing=1.0, accuracy=0.02)


def test_rotation_vector():
    """A vector along an axis turns about it, counter-clockwise, and stays orthogonal; half a turn is
    exact."""
    c, s = math.cos(0.3), math.sin(0.3)
    assert tumbling.rotation(np.array([0, 0, 0.3])) == pytest.approx(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
    assert (tumbling.rotation(np.array([math.pi, 0, 0])) == np.diag([1, -1, -1])).all()
    turn = tumbling.rotation(np.array([0.3, -0.7, 1.1]))
    assert turn @ turn.T == pytest.approx(np.eye(3)) and np.linalg.det(turn) == pytest.approx(1)
    assert turn @ [0.3, -0.7, 1.1] == pytest.approx([0.3, -0.7, 1.1])


def octants(parts: int) -> tuple[np.ndarray, np.ndarray]:
    """The unit sphere as an octahedron whose faces are split into parts * parts triangles."""
    points, faces = [], []
    for x in (1, -1):
        for y in (1, -1):
            for z in (1, -1):
                grid = {(i, j): len(points) + k for k, (i, j) in enumerate((i, j) for i in range(parts + 1) for j in range(parts + 1 - i))}
                points += [np.array([x * (parts - i - j), y * i, z * j]) for i, j in grid]
                own = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in grid if i + j < parts]
                own += [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in grid if i + j < parts - 1]
                faces += [[grid[corner] for corner in triangle[::x * y * z]] for triangle in own]
    unique, number = np.unique(np.array(points), axis=0, return_inverse=True)
    return unique / np.linalg.norm(unique, axis=1, keepdims=True), number.ravel()[np.array(faces)]


@pytest.mark.parametrize("part", [1.0, 0.5])
def test_sphere_through_the_points_of_a_mesh(part):
    """All faces of a sphere, or of half of it, lie on one surface, with its centre and radius."""
    points, faces = octants(8)
    faces = faces[points[faces].mean(axis=1)[:, 0] > (-2 if part == 1 else 0)]
    assert len(faces) == part * 512 and len(np.unique(mesh.pieces(len(points), faces)[faces])) == 1
    centre, radius = np.array([1.0, -2.0, 3.0]), 0.5
    ((sphere, own),) = curved.surfaces(centre + radius * points, faces)
    assert sphere.centre == pytest.approx(centre) and sphere.radius == pytest.approx(radius) and not len(sphere.axis) and len(own) == len(faces)


def test_forecast_of_a_uniform_run():
    """A quarter of a run has taken 10 s since its first report, so it takes 40 s, 400 steps."""
    seen = [At(share=0.025 * k, t=0.0, steps=10 * k, wall=5.0 + k) for k in range(11)]
    assert forecast.forecast(seen) == ((pytest.approx(40), pytest.approx(40)), (pytest.approx(400), pytest.approx(400)))


def test_half_width_of_a_slow_ball():
    """A ball that hits a plane with v makes a contact of 1.31 R (v/c)^0.4: five doublings of v widen it
    by four. The slip velocity is a hundredth of the sliding speed."""
    slow = replace(BALL, closing=BALL.closing / 32)
    speed = math.sqrt(BALL.young / BALL.density)
    assert [BALL.half_width, 4 * slow.half_width] == pytest.approx([1.31 * BALL.radius * (1 / speed) ** 0.4] * 2)
    assert replace(BALL, sliding=300.0).slip_velocity == pytest.approx(3.0)


def test_moduli_of_a_damped_body():
    """A wave crosses a body of the thickness h in h/c: at omega = pi c/h its modulus of shear is
    |mu + i omega eta|."""
    damped = scene.load("disc-normal").bodies[0].made_of.model_copy(update={"nu": 0.0, "viscosity": 50.0})
    mu, omega = damped.young / 2, math.pi * math.sqrt(damped.young / damped.density) / 0.1
    wave, shear = damped.moduli(0.1)
    assert shear == pytest.approx(math.hypot(mu, omega * 50)) and wave == pytest.approx(2 * shear)


@pytest.mark.parametrize("accuracy", [0.002, 0.2])
def test_rise_of_a_front(accuracy, tmp_path):
    """The penalty lets the front of a flat strike rise in 2/3 of its transit of an element, and in a
    fiftieth of its transit of the body where elements are coarse."""
    block = scene_of(BLOCK, tmp_path, accuracy=accuracy)
    strike, = front.fronts(block, onsets_of(block))
    assert strike.rise == pytest.approx(min(strike.tau / 1.5, strike.transit / 50), rel=1e-9)
    assert (strike.rise < 0.99 * strike.transit / 50) == (accuracy < 0.01)


def test_an_impact_to_the_left_is_its_mirror_image():
    """Left and right are alike: an impact moves to the right, and its spin turns with it."""
    tables = scene.load("disc-oblique").content
    body = tables["body"][0] | {"spin": 3.0}
    right = impact_of(tables | {"body": [body]})
    left = impact_of(tables | {"body": [body | {"direction": 180 - body["direction"]}]})
    assert right["spin"] == 3.0 == -left["spin"] and [right["angle"], left["angle"]] == pytest.approx([60, 60])


def test_a_flight_is_a_parabola():
    """A history has two rows of a flight. Rows between them lie on y = h - g t^2 / 2, and the kinetic
    energy is that of their velocities."""
    g, m, h = 10.0, 2.0, 5.0
    t = np.array([0.0, 1.0, 1.1])
    v = -g * np.minimum(t, 1.0)
    rows = {"t": t, "dt": np.diff(t, prepend=0.0), "newton_iterations": [0, 0, 3], "normal_force": [0, 0, 5],
            "y": h - g * np.minimum(t, 1.0)**2 / 2, "vy": v, "momentum_y": m * v, "kinetic": m * v**2 / 2, "external_work": m * v**2 / 2}
    filled = impacts.with_flights(Contents({name: np.array(column, float) for name, column in rows.items()}, Path("history.csv")))
    inside = filled["t"] <= 1
    assert inside.sum() > 10 and filled["y"][inside] == pytest.approx(h - g * filled["t"][inside]**2 / 2)
    assert filled["kinetic"][inside] == pytest.approx(m * filled["vy"][inside]**2 / 2)


def test_units_of_the_report():
    """The rows of the report print times in ms, forces in kN and lengths in mm."""
    texts = {row.key: row.text(0.0123) for row in report.rows("/m")}
    assert texts["contact_time"] == "12.3 ms" and texts["peak_force"] == "1.23e-05 kN/m" and texts["max_penetration"] == "12.3 mm"
    assert texts["impulse"] == "0.0123 N s/m" and texts["rest_time"] == "0.0123 s" and texts["energy_drift"] == "1.2e-02 of the energy supplied"
