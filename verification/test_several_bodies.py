"""Impacts of two and more deformable bodies: conservation in steps and runs, and agreement of
equivalent scenes."""

import math

import numpy as np
import pytest

from .bars import bouncing_bar, relaxing_bar, two_bars
from .blocks import pressed
from .scenes import HITS, disc, plane, scene

# Equal meshes in all contact regions.
UNIFORM = {"mesh_size": 0.02, "contact_mesh_size": 0.02, "penalty": 1e10}


@pytest.mark.few(5)
@pytest.mark.parametrize("degree", [2, 1])
@pytest.mark.parametrize("hit", HITS)
def test_every_step_conserves(steps, hit, degree):
    """For the increment of every step B d = q1 - q0; rows of B and the sum of contact forces have
    no resultant force or moment, to round-off.

    A step begins with the gaps at the end of the last step. Over the impact the energy with
    friction work is constant to 1e-9, momentum to 1e-12, angular momentum to 1e-9.
    """
    numbers = steps({"end_time": 6e-3, "dt": 1e-4, "degree": degree} | HITS[hit])
    assert numbers["state"] == 0 and numbers["rejected"] < 3 and numbers["touching"] > 20 and numbers["depth"] > 1e-5
    assert numbers["exact"] < 1e-12 and numbers["begin"] < 1e-11
    assert max(numbers["rowForce"], numbers["rowMoment"], numbers["force"], numbers["moment"]) < 1e-14
    assert numbers["balance"] < 1e-9 and numbers["momentum"] < 1e-12 and numbers["angular"] < 1e-9
    assert (numbers["friction"] > 1e-4) == (HITS[hit]["contact"]["friction_static"] > 0)


@pytest.mark.few(2)
@pytest.mark.parametrize("hit", HITS)
def test_march_conserves(march, hit):
    """The same for energy and momenta over a whole run with automatic steps, from the flight to the
    last row."""
    run = march(HITS[hit])
    history, bodies = run.history, len(HITS[hit]["body"])
    scale = sum(np.hypot(history[f"momentum_x_{b}"], history[f"momentum_y_{b}"]).max() for b in range(1, bodies + 1))
    assert run.summary["contact_intervals"] >= 1 and run.summary["impulse"] > 0
    assert np.abs(history["balance"]).max() < 1e-9 * run.summary["energy_initial"]
    for axis in "xy":
        assert np.ptp(history[f"momentum_{axis}"]) < 1e-12 * scale
    assert np.ptp(history["angular_momentum"]) < 1e-9 * scale * 0.05


# ---- equivalent scenes

def differ(run, other, *names: str) -> float:
    """The largest relative difference of the entries `names` of two summaries."""
    return max(abs(run.summary[name] / other.summary[name] - 1) for name in names)


MEASURES = ("impulse", "contact_time", "peak_force")


def test_two_equal_discs_are_a_disc_on_a_plane_of_doubled_penalty(march):
    """In a central impact impulse, contact time and rebound agree to 0.5 %. The accuracy is 0.2 %,
    as the end of contact scatters more."""
    pair = march(scene(disc(-0.0501, 0, 4, 0), disc(0.0501, 0, -4, 0), penalty=1e10, accuracy=2e-3))
    single = march(scene(disc(-0.0501, 0, 4, 0), obstacles=(plane(normal=(-1, 0)),), penalty=2e10, accuracy=2e-3))
    assert differ(pair, single, "impulse", "contact_time") < 5e-3
    assert pair.summary["rebound_vx_1"] == pytest.approx(single.summary["rebound_vx"], rel=5e-3)


def test_stiff_heavy_block_is_a_plane(march):
    """A block ten thousand times as stiff and heavy agrees with a plane to 1 %: impulse, contact
    time, rebound."""
    block = {"shape": "rectangle", "width": 0.4, "height": 0.2, "position": [0, -0.1], "young": 7e10, "density": 1.722e7, "nu": 0.3}
    free = march(scene(disc(0, 0.0501, 0, -8), block, penalty=1e10))
    fixed = march(scene(disc(0, 0.0501, 0, -8), obstacles=(plane(),), penalty=1e10))
    assert differ(free, fixed, "impulse", "contact_time") < 0.01
    assert free.summary["rebound_vy_1"] == pytest.approx(fixed.summary["rebound_vy"], rel=0.01)


@pytest.mark.few(1)
@pytest.mark.parametrize("first, second", [("neohookean", "neohookean"), ("svk", "neohookean")])
@pytest.mark.parametrize("friction", [0, 0.3])
def test_order_of_the_bodies(march, first, second, friction):
    """Bodies of different materials and laws, swapped in the file: nothing changes beyond
    round-off, which friction amplifies."""
    bodies = [disc(-0.055, 0, 4, 1, law=first), disc(0.055, 0.02, -3, 0, law=second, young=2e6, nu=0.3, density=900)]
    there, back = (march(scene(*order, friction=friction, **UNIFORM)) for order in (bodies, bodies[::-1]))
    assert differ(there, back, *MEASURES) < 1e-4
    assert there.summary["rebound_vy_1"] == pytest.approx(back.summary["rebound_vy_2"], rel=1e-4)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind, side", [("bowl", 1), ("circle", -1)])
def test_obstacle_of_great_radius_is_a_plane(march, kind, side):
    """A radius of ten thousand disc radii changes the gaps by 1e-4 of those inside the contact, in
    opposite directions."""
    curved = march(scene(disc(0, 0.0501, 0, -8), obstacles=({"kind": kind, "centre": [0, side * 500], "radius": 500},), **UNIFORM))
    flat = march(scene(disc(0, 0.0501, 0, -8), obstacles=(plane(),), **UNIFORM))
    assert 1e-9 < differ(curved, flat, *MEASURES) < 1e-4


@pytest.mark.few(1)
@pytest.mark.parametrize("angle, friction, scatter", [(30, 0, 1e-3), pytest.param(137, 0, 1e-3, marks=pytest.mark.robustness), (137, 0.3, 5e-3)])
def test_inclined_scene_is_the_level_one_turned(march, angle, friction, scatter):
    """Plane, motion, body and load rotate together: results agree to the tolerance of the steps,
    with friction to the scatter that results."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))

    def turned(x: float, y: float) -> tuple[float, float]:
        return c * x - s * y, s * x + c * y
    forces = [dict(zip(("body_force_x", "body_force_y"), force)) for force in ((1.0, -20.0), turned(1.0, -20.0))]
    level = march(scene(disc(0, 0.0501, 4, -7), obstacles=(plane(),), friction=friction, slip_velocity=0.05, **UNIFORM, **forces[0]))
    inclined = march(scene(disc(*turned(0, 0.0501), *turned(4, -7), angle=angle), obstacles=(plane(normal=turned(0, 1)),),
                           friction=friction, slip_velocity=0.05, **UNIFORM, **forces[1]))
    assert differ(inclined, level, *MEASURES, *(["friction_work", "rebound_spin"] if friction else [])) < scatter


def test_moving_plane_on_a_resting_disc(march):
    """Galilean invariance: the results of a disc on a resting plane, to round-off. The work of the
    plane is the final energy of the disc."""
    struck = march(scene(disc(0, 0.0501, 0, 0), obstacles=(plane(velocity=[0, 8]),), **UNIFORM))
    fallen = march(scene(disc(0, 0.0501, 0, -8), obstacles=(plane(),), **UNIFORM))
    assert differ(struck, fallen, *MEASURES) < 1e-9
    assert struck.summary["rebound_vy"] == pytest.approx(fallen.summary["rebound_vy"] + 8, rel=1e-9)
    assert struck.history["external_work"][-1] == pytest.approx(8 * fallen.summary["impulse"], rel=1e-9)
    assert struck.summary["energy_drift"] < 1e-9


def test_moving_plane_on_two_discs(march):
    """The same with a second disc that rests on the first, and friction between all: the energy
    balance includes the work of the plane."""
    struck = march(scene(disc(0, 0.0501, 0, 0), disc(0, 0.1502, 0, 0), obstacles=(plane(velocity=[0, 8]),), friction=0.2, **UNIFORM))
    fallen = march(scene(disc(0, 0.0501, 0, -8), disc(0, 0.1502, 0, -8), obstacles=(plane(),), friction=0.2, **UNIFORM))
    assert differ(struck, fallen, *MEASURES) < 1e-6 and struck.summary["energy_drift"] < 1e-9


def test_disc_falls_from_rest(march):
    """Dropped from 1 m: tolerances are relative to the energy at contact, as the initial energy is
    zero."""
    run = march(scene(disc(0, 1.05, 0, 0), obstacles=(plane(),), gravity=10, **UNIFORM))
    assert run.summary["energy_drift"] < 1e-9 and run.summary["steps"] < 100
    assert run.summary["contact_start"] == pytest.approx(math.sqrt(2 / 10), rel=1e-4)


def test_disc_between_two_others(march):
    """A disc that is hit from both sides at once stays at its place; the others rebound equally, to
    the 1 % by which their meshes differ."""
    run = march(scene(disc(-0.101, 0, 5, 0), disc(0, 0, 0, 0), disc(0.101, 0, -5, 0), friction=0.3))
    assert abs(run.summary["rebound_vx_2"]) < 0.05 and run.summary["energy_drift"] < 1e-9
    assert run.summary["rebound_vx_1"] == pytest.approx(-run.summary["rebound_vx_3"], rel=0.01)


@pytest.mark.few(1)
@pytest.mark.parametrize("friction", [pytest.param(0, marks=pytest.mark.robustness), 0.3])
def test_disc_slides_over_many_elements(march, friction):
    """A small disc in a long contact passes over seven elements of a block: energy is exact, and no
    step changes the force by a tenth of its peak."""
    small = {"shape": "disc", "radius": 0.02, "position": [-0.06, 0.0201], "velocity": [12, -0.3]}
    block = {"shape": "rectangle", "width": 0.16, "height": 0.04, "position": [0, -0.02]}
    history = march(scene(small, block, friction=friction, slip_velocity=0.5, end_time=8e-3, penalty=1e8, mesh_size=0.01,
                          contact_mesh_size=0.01)).history
    force, touching = history["normal_force"], history["normal_force"] > 0
    assert np.ptp(history["x_1"][touching]) > 0.07 and np.ptp(history["momentum_x"]) < 1e-12 * history["momentum_x_1"].max()
    assert np.abs(history["balance"]).max() < 1e-9 * history["kinetic"][0] and (history["friction_work"][-1] > 0) == (friction > 0)
    assert np.abs(np.diff(force)).max() < 0.1 * force.max()


@pytest.mark.few(1)
@pytest.mark.parametrize("integrator, loss, growth", [("midpoint", 0.02, 0.02), ("bdf2", 0.1, 1e-3), ("backward-euler", 0.6, 1e-6)])
def test_other_integrators(march, integrator, loss, growth):
    """Momentum is exact. Energy is conserved approximately, and damping integrators do not gain
    any."""
    run = march(scene(disc(-0.055, 0, 3, 0), disc(0.055, 0.02, -3, 0), friction=0.2, integrator=integrator))
    open_ = run.history["balance"] / run.summary["energy_initial"]
    assert -loss < open_.min() and open_.max() < growth
    assert np.ptp(run.history["momentum_x"]) < 1e-12 * run.history["momentum_x_1"].max()


# ---- exact solutions

@pytest.mark.few(1)
@pytest.mark.parametrize("law", ["svk", "neohookean"])
def test_two_bars_head_on(tmp_path, law):
    """V13 with 25 elements: stress to 1 %; contact time and exchanged velocities, which depend on a
    front of width h^(2/3), to 4 %."""
    rows = {row.what: row.error for row in two_bars(tmp_path, 25, law)}
    assert rows.pop("stress") < 0.01 and max(rows.values()) < 0.04


def test_bouncing_bar(tmp_path):
    """V14 with 12 elements: begin and end of both contacts to 3 %."""
    assert max(row.error for row in bouncing_bar(tmp_path, 12)) < 0.03


@pytest.mark.robustness
def test_relaxing_bar(tmp_path):
    """V19 with 25 and 50 elements: restitution and contact time, which depend on a front of width
    h^(2/3), to 2 and 1.1 %; balance to 1e-9."""
    coarse, fine = ({row.what: row.error for row in relaxing_bar(tmp_path / f"{n}", n, 0.5, 10)} for n in (25, 50))
    assert max(coarse.values()) < 0.02 and max(fine.values()) < 0.011 and fine["1 + balance"] < 1e-9
    assert all(fine[what] < error for what, error in coarse.items() if what != "1 + balance")


def test_blocks_pressed_together(tmp_path):
    """V16 with 4 and 8 elements: the pressure is uniform to 3 and 2 %, better on the finer mesh;
    both faces are entirely in contact, and forces are balanced."""
    coarse, fine = ({row.what: row.error for row in pressed(tmp_path / f"{n}", n)} for n in (4, 8))
    uneven = "pressure: root mean square deviation"
    assert fine[uneven] < 0.02 and fine[uneven] < 0.7 * coarse[uneven] < 0.7 * 0.03
    assert fine["area"] < 1e-9 and fine["force on the planes"] < 1e-6
