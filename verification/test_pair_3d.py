"""Bodies in three dimensions: gap between bodies (edp/program/contact/pair.idp, paper (9)), rigid
obstacles, and runs of edp/program/bodies-3d.edp."""

import math
from pathlib import Path

import numpy as np
import pytest

from . import measure as runs
from .solids import Scene, ball, brick, write

ROUND_OFF = 1e-13
CASES = [{}, {"degree": 1, "tilt": 0.7}, {"tilt": 2.5, "depth": 0.1}, {"corner": 1, "depth": 0.1}, {"corner": 2, "depth": 0.1, "degree": 1}, {"noise": 0, "depth": 0}]


@pytest.fixture
def march(tmp_path):
    """march(scene, name=value, ...): a run of edp/program/bodies-3d.edp for the scene."""
    return lambda scene, name="run", **flags: runs.solid_bodies(tmp_path / name, scene, **{"accuracy": 0.1} | flags)


# ---- gap Jacobians

@pytest.mark.few(2)
@pytest.mark.parametrize("case", CASES)
def test_rows_conserve(measure, case):
    """The rows satisfy B d = q1 - q0, also if the step rotates the pair by a radian or
    moves it along the block.

    No row of B, S_1, S_2 has a resultant force or moment about the middle configuration, inside
    faces and on edges and vertices. A rotation of the pair changes no gap. A step begins with the
    penetrations at the end of the last step. Which faces share a closest point, and that they share
    it, does not depend on where Newton's method stops on each of them (tilt 2.5).
    """
    numbers = measure("pair-3d", **case)
    assert numbers["randomInside"] > 10
    for name in ("random", "turn"):
        assert max(numbers[name + "Exact"], numbers[name + "Force"], numbers[name + "Moment"]) < ROUND_OFF
        assert 0.1 < numbers[name + "Largest"] < 3
    assert max(numbers["turnChange"], numbers["slideExact"], numbers["slideJump"]) < ROUND_OFF


def shapes(r, s):
    """Shape functions (n, 6) of a curved face at r, s, in the order of boundary.idp."""
    q = 1 - r - s
    return np.stack([q * (2 * q - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * r * s, 4 * s * q, 4 * q * r], -1)


def closest(x: np.ndarray, nodes: np.ndarray, grid: int = 24, rounds: int = 12) -> float:
    """Distance of a point to curved faces (n, 6 nodes, 3).

    The best point of a grid on each face is refined on ever finer grids around the best of all.
    """
    a, b = (v.ravel() for v in np.meshgrid(np.linspace(0, 1, grid), np.linspace(0, 1, grid), indexing="ij"))
    keep = a + b <= 1 + 1e-12
    away = np.linalg.norm(np.einsum("ga,fac->fgc", shapes(a[keep], b[keep]), nodes) - x, axis=-1)
    best = math.inf
    for f in np.argsort(away.min(1))[:4]:
        r, s, size = a[keep][away[f].argmin()], b[keep][away[f].argmin()], 1.0 / grid
        for _ in range(rounds):
            p, q = (v.ravel() for v in np.meshgrid(np.linspace(r - size, r + size, 11), np.linspace(s - size, s + size, 11), indexing="ij"))
            p, q = p.clip(0, 1), q.clip(0, 1)
            q = np.minimum(q, 1 - p)
            d = np.linalg.norm(shapes(p, q) @ nodes[f] - x, axis=-1)
            r, s, size = p[d.argmin()], q[d.argmin()], size / 4
        best = min(best, d.min())
    return best


@pytest.mark.robustness
def test_gaps_are_those_of_an_exhaustive_search(measure, tmp_path_factory):
    """Gaps agree with the distances to all curved faces of the other body; points inside have a
    penetration."""
    path = tmp_path_factory.mktemp("pair") / "configuration"
    measure("pair-3d", place=path, noise=0.02)
    lines = path.read_text().splitlines()
    count, points, reach = (float(word) for word in lines[0].split())
    table = np.array([line.split() for line in lines[1:1 + int(count)]], float)
    where = np.array([line.split() for line in lines[1 + int(count):]], float)
    assert len(where) == points
    nodes, near = table[:, 2:].reshape(-1, 3, 6).transpose(0, 2, 1), 0
    for b in (0, 1):
        other = nodes[table[:, 0] != b]
        for row in where[where[:, 0] == b][::4]:
            if -reach / 4 < row[4]:
                near += 1
                assert abs(row[4]) == pytest.approx(closest(row[1:4], other), abs=1e-8)
    assert near > 15


@pytest.mark.parametrize("degree", [2, 1])
def test_rigid_obstacles(measure, degree):
    """Moving planes, spheres and a hollow sphere: gaps agree with closed
    forms.

    B d and S d with the motion of the obstacles are exact, t1, t2, n is a frame, and the force of a
    round obstacle goes through its centre.
    """
    numbers = measure("obstacles-3d", degree=degree)
    assert numbers["near"] > 500
    assert max(numbers[name] for name in ("gap", "exact", "slip", "frame", "moment", "force")) < ROUND_OFF


# ---- runs

def spread(history, *names: str) -> float:
    return max(np.ptp(history[name]) for name in names)


def oblique(friction: float) -> Scene:
    """Two balls of different size, material and mesh that hit each other off centre. Both spin
    about axes of their own."""
    n = np.array([0.3, 1, 0.5]) / math.sqrt(1.34) * (0.045 + 5e-4)
    return Scene([ball((0, 0, 0), 0.05, 1, shift=tuple(n), velocity=(1, -2, -0.5), spin=(10, 20, -15)),
                  ball((0, -0.15, 0), 0.04, 2, turn=0.4, material=("svk", 5e6, 0.3, 1200.0), shift=tuple((0, 0.15, 0) - n), velocity=(-0.2, 2, 0.3), spin=(5, 0, 8))],
                 pairs=[(0, 1, 1e9, friction, 0.7 * friction)])


@pytest.mark.few(1)
@pytest.mark.parametrize("friction", [pytest.param(0.0, marks=pytest.mark.robustness), 0.4])
def test_two_bodies_conserve(march, friction):
    """Momentum is constant to 1e-13, angular momentum about all axes to 1e-9, energy with friction
    work to 1e-9 (1e-8), over all rows."""
    run = march(oblique(friction), friction_static=friction)
    history = run.history
    scale = np.abs(history["momentum_y_1"]).max()
    assert run.summary["contact_intervals"] >= 1 and run.summary["impulse"] > 0.5 * scale
    assert spread(history, "momentum_x", "momentum_y", "momentum_z") < 1e-13 * scale
    assert spread(history, "angular_momentum", "angular_momentum_x", "angular_momentum_y") < 1e-9 * scale * 0.05
    assert np.abs(history["balance"]).max() < (1e-8 if friction else 1e-9) * run.summary["energy_initial"]
    assert (run.summary["friction_work"] > 1e-2) == (friction > 0)
    assert abs(run.summary["rebound_spin_x_2"] - 5) > 1e-3  # the hit changes the axis of its spin


def head_on(count, obstacles=()) -> Scene:
    """V15: R = 10 mm, E = 100 MPa, nu = 0.3, rho = 2500, closing at 1 m/s; a quarter, finer near
    contact.

    With `obstacles`, one of the two balls on a plane.
    """
    material, R = ("neohookean", 1e8, 0.3, 2500.0), 0.01
    upper = ball((0, 0, 0), R, count, 4, focus=-1, material=material, shift=(0, R + 1e-6, 0), velocity=(0, -0.5, 0))
    lower = ball((0, -0.03, 0), R, count, 4, focus=1, material=material, shift=(0, 0.03 - R - 1e-6, 0), velocity=(0, 0.5, 0))
    return Scene([upper] if obstacles else [upper, lower], list(obstacles), [(0, -1, 2e11, 0, 0)] if obstacles else [(0, 1, 1e11, 0, 0)],
                 (R, 1e8, 0.3, 2500.0, 0.5, 90.0, 0.0), 4)


FLOOR = ("plane", (0, 0, 0, 0, 1, 0), (0, 0, 0))


@pytest.mark.robustness
def test_two_equal_balls_are_a_ball_on_a_plane_of_doubled_penalty(march):
    """In a central impact contact time, peak force and rebound agree to 0.5 %.

    They agree with Hertz' T = 2.943 delta / v and F = 4/3 E* R*^1/2 delta^3/2 to 10 % with two
    elements across the contact.
    """
    pair, single = march(head_on((4, 3, 4)), "two").summary, march(head_on((4, 3, 4), (FLOOR,)), "one").summary
    for name in ("contact_time", "peak_force"):
        assert pair[name] == pytest.approx(single[name], rel=5e-3)
    assert pair["rebound_vy_1"] == pytest.approx(single["rebound_vy"], rel=5e-3)
    modulus, mass = 1e8 / 2 / (1 - 0.3**2), 2500 * math.pi * 4e-6 / 3 / 2
    delta = (15 * mass / (16 * modulus * math.sqrt(0.005))) ** 0.4
    assert pair["contact_time"] == pytest.approx(2.943 * delta, rel=0.1)
    assert pair["peak_force"] == pytest.approx(4 / 3 * modulus * math.sqrt(0.005) * delta**1.5, rel=0.1)


def pressed(measure, folder: Path, below: tuple, above: tuple, penalty: float) -> dict:
    material = ("neohookean", 1.0, 0.3, 1.0)
    scene = Scene([brick((-0.5, 0, -0.5), (0.5, 0.5, 0.5), below, material=material), brick((-0.5, 1, -0.5), (0.5, 1.5, 0.5), above, material=material, shift=(0, -0.5, 0))],
                  [FLOOR, ("plane", (0, 1, 0, 0, -1, 0), (0, -1e-4, 0))], ball=(0.5, 1.0, 0.3, 1.0, 0.01, 90.0, 0.0))
    return measure("pressed-3d", **write(scene, folder) | {"penalty": penalty}, integrator="backward-euler", dt=10, end_time=30, tolerance=1e-10, accuracy=0.05, out=folder)


@pytest.mark.robustness
def test_unlike_meshes_carry_a_constant_pressure(measure, tmp_path):
    """V16: two blocks are pressed together. The deviation of the pressure is proportional to
    penalty times element size over E.

    It is 1 % if this ratio is a quarter; with equal meshes it is 1e-6.
    """
    like, unlike = pressed(measure, tmp_path / "like", (3, 2, 3), (3, 2, 3), 10), pressed(measure, tmp_path / "unlike", (4, 2, 4), (3, 2, 3), 1)
    for numbers in (like, unlike):
        assert numbers["area"] == pytest.approx(1, rel=1e-9) and abs(numbers["balance"]) < 1e-3
    assert like["uneven"] < 1e-6
    assert unlike["uneven"] < 1e-2 and unlike["most"] < 1.015 * unlike["mean"] and unlike["least"] > 0.985 * unlike["mean"]


@pytest.mark.robustness
def test_ball_on_a_block(march):
    """A ball falls obliquely on a free block with friction. It rebounds, the block moves away, and
    energy and momenta are conserved."""
    block = brick((-0.1, -0.2, -0.1), (0.1, -0.12, 0.1), (3, 2, 3), shift=(0, 0.12, 0))
    scene = Scene([ball((0, 0.1, 0), 0.05, 2, shift=(0.01, -0.0499, 0.015), velocity=(1, -3, 0.5)), block], pairs=[(0, 1, 1e9, 0.3, 0.3)])
    run = march(scene, friction_static=0.3)
    history = run.history
    scale = np.abs(history["momentum_y_1"]).max()
    assert run.summary["rebound_vy_1"] > 0.5 and run.summary["rebound_vy_2"] < -0.3
    # Dragged along by friction.
    assert run.summary["rebound_vx_2"] > 0.01 and run.summary["rebound_vz_2"] > 0.005
    assert spread(history, "momentum_x", "momentum_y", "momentum_z") < 1e-13 * scale
    assert spread(history, "angular_momentum", "angular_momentum_x", "angular_momentum_y") < 1e-9 * scale * 0.05
    assert np.abs(history["balance"]).max() < 1e-8 * run.summary["energy_initial"]


FAR = ("plane", (0, -10, 0, 0, 1, 0), (0, 0, 0))


@pytest.mark.parametrize("axis", range(3))
def test_spinning_free_body(march, axis):
    """V3: a ball and a brick rotate about x, y or z, integrated in time: energy, momentum and
    angular momentum stay constant.

    No rotation about another axis appears.
    """
    spin = tuple(30.0 if c == axis else 0.0 for c in range(3))
    scene = Scene([ball((0, 0, 0), 0.05, 1, velocity=(0.1, 0, 0.2), spin=spin), brick((0.2, -0.02, -0.03), (0.3, 0.02, 0.03), (2, 1, 1), spin=spin)], [FAR])
    run = march(scene, without="flight", end_time=0.02, dt=4e-4)
    history, scale = run.history, run.history["kinetic"][0] / 30
    names = ["angular_momentum_x", "angular_momentum_y", "angular_momentum"]
    for body in ("_1", "_2"):
        assert spread(history, *(name + body for name in names)) < 1e-9 * scale
        assert history[names[axis] + body][0] > 0.01 * scale
        assert all(np.abs(history[name + body]).max() < 1e-9 * scale for c, name in enumerate(names) if c != axis)
    assert spread(history, "momentum_x", "momentum_y", "momentum_z") < 1e-12
    assert np.abs(history["balance"]).max() < 1e-9 * run.summary["energy_initial"]
    assert run.summary["contact_intervals"] == 0


def test_tumbling_flight(march):
    """A brick whose spin is not about a principal axis flies as a rigid body. At contact it has its
    initial energy and angular momentum."""
    body = brick((-0.05, -0.02, -0.03), (0.05, 0.02, 0.03), (2, 1, 1), shift=(0, 0.3, 0), velocity=(0, -2, 0), spin=(30.0, 5.0, 20.0))
    run = march(Scene([body], [FLOOR]), end_time=0.16, fields=1)
    history, touch = run.history, 1
    scale = history["kinetic"][0]
    assert history["t"][touch] > 0.1 and history["normal_force"][touch] == 0
    assert abs(history["kinetic"][touch] - scale) < 1e-8 * scale and history["elastic"][touch] < 1e-12 * scale
    for name in ("angular_momentum_x", "angular_momentum_y", "angular_momentum"):
        assert abs(history[name][touch] - history[name][0]) < 1e-9 * scale / 30
    assert abs(history["spin_x"][touch] - 30) > 1
    assert run.summary["contact_intervals"] >= 1 and np.abs(history["balance"]).max() < 1e-8 * scale


@pytest.mark.robustness
def test_parts_of_bodies(march):
    """Half and quarter of a ball in a hollow sphere and on a moving sphere agree with the whole
    ball to the tolerance of the step."""
    obstacles = [("sphere", (0, -0.2, 0, 0.2), (0, 0.3, 0)), ("bowl", (0, 0.3, 0, 0.4), (0, 0, 0))]
    whole, half, quarter = (march(Scene([ball((0, 0, 0), 0.05, 2, copies, shift=(0, 0.0501, 0), velocity=(0, -2, 0))], obstacles, copies=copies), f"part{copies}",
                                  friction_static=0.3, end_time=0.004, dt=1e-4).summary for copies in (1, 2, 4))
    for name in ("impulse", "peak_force", "friction_work", "energy_final", "rebound_vy"):
        assert whole[name] == pytest.approx(half[name], rel=1e-7) and half[name] == pytest.approx(quarter[name], rel=1e-7)
