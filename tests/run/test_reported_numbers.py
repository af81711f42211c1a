"""Numbers that a run reports beside its history: each is what its meaning says, and an independent
computation gives it again."""

import math

import numpy as np
import pytest

from ffimpact.output import vtu
from ffimpact.output.results import read_table
from verification.measure import bodies

SOFT = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000, "accuracy": 0.1}
FLOOR = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}

# ---- the energy to which the balance is relative

# A rigid cylinder under a shell with a gas, both thrown into a bowl: the gas could bring 30 times
# the energy that the bodies have.
RADIUS, OUTER, INNER, SPEED = 0.068, 0.0405, 0.0324, 1.2366
CYLINDER = {"name": "cylinder", "shape": "cylinder", "radius": RADIUS, "height": RADIUS, "position": [0, 0.0451], "rigid": True, "density": 1722,
            "velocity": [0, -SPEED]}
SHELL = {"name": "shell", "shape": "shell", "radius": OUTER, "inner_radius": INNER, "position": [0, 0.1213], "velocity": [0, -SPEED], "young": 3.1e6,
         "nu": 0, "density": 823.8, "load": [{"where": "inner", "gas": {"gauge_pressure": 7517, "exponent": 0}}]}
THROWN = SOFT | {"dimension": "axisymmetric", "integrator": "midpoint", "end_time": 0.01, "body": [CYLINDER, SHELL],
                 "obstacle": [{"kind": "bowl", "centre": [0, 0.6588], "radius": 0.6588}]}


def test_the_balance_is_relative_to_energy_that_is_there(tmp_path):
    """Beside a load energy_drift is relative to the energy of the bodies, here that of the throw,
    not to what the load might have brought."""
    run = bodies(tmp_path, THROWN | {"dt": 5e-5})
    thrown = (1722 * math.pi * RADIUS**3 + 823.8 * 4 / 3 * math.pi * (OUTER**3 - INNER**3)) * SPEED**2 / 2
    gained = abs(run.history["balance"]).max()
    assert gained > 1e-4 * thrown
    assert run.summary["energy_drift"] == pytest.approx(gained / thrown, rel=0.02)   # the gas has strained the shell


def test_without_energy_at_the_start_the_balance_is_relative_to_that_supplied(tmp_path):
    """A block at rest is pressed by a support: largest sum of energies, which round-off leaves."""
    block = {"shape": "rectangle", "width": 0.04, "height": 0.02, "position": [0, 0.0101],
             "support": [{"where": "top", "motion": [0, "-5e-4*(1-cos(2000*t))"]}]}
    run = bodies(tmp_path, SOFT | {"end_time": 2e-3, "integrator": "midpoint", "dt": 1e-5, "obstacle": [FLOOR], "body": [block]})
    energies = run.history["kinetic"] + run.history["elastic"] + run.history["contact"] - run.history["balance"]
    assert run.summary["energy_drift"] == pytest.approx(abs(run.history["balance"]).max() / energies.max(), rel=1e-6)
    assert run.summary["energy_drift"] > 1e-9


# ---- penetration beside the contact points

FINE = {"mesh_size": 0.004, "contact_mesh_size": 0.004}
SQUARE = {"shape": "rectangle", "width": 0.02, "height": 0.02} | FINE
CENTRE, ROUND, ROUNDING = np.array([0, -0.2]), 0.2, 1e-3
WEDGE = [[-1, -1], [0, 0], [1, -1]]
WITH_NODE = [[-0.01, -0.01], [0, -0.01], [0.01, -0.01], [0.01, 0.01], [-0.01, 0.01]]


def _into_circle(at: np.ndarray) -> float:
    return ROUND - np.linalg.norm(at - CENTRE, axis=1).min()


def _into_bowl(at: np.ndarray) -> float:
    return np.linalg.norm(at + CENTRE, axis=1).max() - ROUND


def _into_groove(at: np.ndarray) -> float:
    """The groove y > |x|/2: the larger gap counts inside it."""
    return -min(np.minimum((at[:, 1] - at[:, 0] / 2), (at[:, 1] + at[:, 0] / 2))) / np.hypot(1, 0.5)


def _wedge_into(at: np.ndarray) -> float:
    """The rounded tip, whose centre is at 0, in the node of the side above it."""
    return ROUNDING - at[abs(at[:, 0]) < 1e-4, 1].min()


CASES = {
    # A leaning tip: one of the sides at it faces away from the circle's centre.
    "tip on circle": ({"shape": "polygon", "vertices": [[0.002, 0.0183], [-0.021, -0.0145], [0.019, -0.0038]], "position": [0.021, 0.0146],
                       "young": 7e8} | FINE, {"kind": "circle", "centre": CENTRE.tolist(), "radius": ROUND}, _into_circle),
    "corner on plane": (SQUARE | {"position": [0, 0.0142], "angle": 38}, FLOOR, lambda at: -at[:, 1].min()),
    "corner in bowl": (SQUARE | {"position": [0, 0.0142], "angle": 38}, {"kind": "bowl", "centre": (-CENTRE).tolist(), "radius": ROUND}, _into_bowl),
    "corner in groove": (SQUARE | {"position": [0.003, 0.0166], "angle": 45}, {"kind": "polyline", "vertices": [[-1, 0.5], [0, 0], [1, 0.5]]}, _into_groove),
    "wedge in side": ({"shape": "polygon", "vertices": WITH_NODE, "position": [0, 0.0112]} | FINE, {"kind": "polyline", "vertices": WEDGE, "rounding": ROUNDING}, _wedge_into),
}


@pytest.mark.parametrize("case", CASES)
def test_penetration_is_the_depth_below_the_surface(tmp_path, case):
    """Of every kept state max_penetration is the depth of the deepest corner of the body along the
    normal of the obstacle, or of a convex obstacle in the side of the body, from nodal positions."""
    body, obstacle, depth = CASES[case]
    run = bodies(tmp_path, SOFT | {"end_time": 3e-3, "fields": 40, "contact": {"penalty": 2e10}, "body": [body | {"velocity": [0, -1]}], "obstacle": [obstacle]})
    t, reported, largest, found = run.history["t"], run.history["max_penetration"], 0.0, 0
    for time, path in vtu.series(tmp_path / "run" / "fields.pvd"):
        state = vtu.read(path)
        expected = max(0.0, depth(state.points[:, :2] + state.fields["displacement"][:, :2]))
        largest = max(largest, expected)
        assert reported[np.argmin(abs(t - time))] == pytest.approx(expected, rel=0.03, abs=2e-7)
        found += expected > 2e-6
    assert found > 3 and run.summary["max_penetration"] == pytest.approx(largest, rel=0.1)


# ---- a body in contact with itself

GAP, PUSH = 3e-4, 600.0   # half the width of the slot [m]; pressure that closes it [Pa]
FORK = [[-0.01, -0.0063], [0.06, -0.0063], [0.06, -GAP], [0, -GAP], [0, GAP], [0.06, GAP], [0.06, 0.0063], [-0.01, 0.0063]]
PRONG = [[-0.01, 0], [0, 0], [0, GAP], [0.06, GAP], [0.06, 0.0063], [-0.01, 0.0063]]


def fork(folder, vertices: list, sides: list, extra: dict):
    """A fork clamped at its left end whose prongs are pressed together; of half of it the plane of
    symmetry is a support and an obstacle."""
    x, y = centroid(vertices)
    holds = [{"where": "left"}] + ([{"where": {"kind": "box", "low": [-0.011, -1e-4], "high": [1e-4, 1e-4]}, "fix": "y"}] if len(sides) == 1 else [])
    body = {"shape": "polygon", "vertices": vertices, "position": [x, y], "mesh_size": 0.003, "contact_mesh_size": 0.003, "support": holds,
            "load": [{"where": side, "pressure": PUSH} for side in sides]}
    return bodies(folder, SOFT | {"young": 1e6, "accuracy": 0.05, "dt": 2e-5, "end_time": 5e-3, "body": [body]} | extra)


def centroid(vertices: list) -> tuple[float, float]:
    (x, y), (u, v) = np.transpose(vertices), np.roll(vertices, -1, axis=0).T
    cross = x * v - u * y
    return ((x + u) @ cross / cross.sum() / 3).item(), ((y + v) @ cross / cross.sum() / 3).item()


def test_self_contact_is_reported_like_that_with_an_obstacle(tmp_path):
    """A symmetric fork that closes on itself has the forces, impulse, pressure and instants of one
    of its halves on a rigid plane; the penalty is that of two springs in line."""
    half = fork(tmp_path / "half", PRONG, ["top"], {"obstacle": [{"kind": "polyline", "vertices": [[0.005, -1], [0.005, 0], [1, 0]]}], "contact": {"penalty": 2e9}})
    whole = fork(tmp_path / "whole", FORK, ["top", "bottom"], {"contact": {"penalty": 1e9, "self_contact": "on"}})
    first, second = read_table(tmp_path / "half/run/contacts.csv"), read_table(tmp_path / "whole/run/contacts.csv")
    assert set(second.body) == {1} and set(second.partner) == {1} and np.isnan(second.approach).all() and np.isnan(second.restitution).all()
    for name in ("contact_start", "contact_time", "impulse", "peak_force", "thresholded_contact_time"):
        assert whole.summary[name] == pytest.approx(half.summary[name], rel=0.05), name
    assert whole.summary["max_pressure"] == pytest.approx(half.summary["max_pressure"], rel=0.1)
    assert second.impulse.sum() == pytest.approx(whole.summary["impulse"], rel=1e-9)
    assert first.impulse.sum() == pytest.approx(second.impulse.sum(), rel=0.02)
    assert not any(sentence.startswith("no contact") for sentence in whole.summary["warnings"])


# ---- forces of supports

BAR = {"shape": "rectangle", "width": 0.02, "height": 0.1, "position": [0, 0], "mesh_size": 0.01}
HELD = SOFT | {"law": "svk", "nu": 0.0}
PULL, RELEASE = 1e-5, 0.02   # displacement of the end of a bar [m], pulled slowly, and its release [s]


def test_a_shortened_last_step_does_not_change_the_peak_of_a_support(tmp_path):
    """A bar is shaken. The force in a last step of a hundredth of the others is no mean over a
    time that these resolve, and support_peak is the same without it."""
    shaken = BAR | {"support": [{"where": "bottom", "motion": [0, "1e-4*sin(300*t)^2"]}]}
    peaks = [bodies(tmp_path / str(k), HELD | {"dt": 1e-4, "end_time": 0.0185 + k * 1e-6, "body": [shaken]}).summary["support_peak_1"]
             for k in range(2)]
    assert peaks[1] == pytest.approx(peaks[0], rel=1e-3)


def test_ringing_after_a_release_is_a_warning(tmp_path):
    """A bar pulled slowly and released has E A u/L on its other end, whose sign the waves change,
    not its size. Beyond that the peak is said to ring."""
    held = BAR | {"support": [{"where": "bottom"}, {"where": "top", "motion": [0, f"{PULL}*(1-cos(pi*min(t,0.015)/0.015))/2"], "release": RELEASE}]}
    run = bodies(tmp_path, HELD | {"end_time": 0.025, "body": [held]})
    exact = SOFT["young"] * PULL / BAR["height"] * BAR["width"]
    until = run.history["t"] <= RELEASE * (1 + 1e-9)
    assert abs(run.history["support_force_y_1"][until]).max() == pytest.approx(exact, rel=0.02)
    rises = run.summary["support_peak_1"] / exact - 1
    said = [sentence for sentence in run.summary["warnings"] if sentence.startswith("release: support_peak_1")]
    assert rises > 0.2 and len(said) == 1
    assert float(said[0].split(" is ")[1].split(" %")[0]) == pytest.approx(100 * rises, rel=0.1)


@pytest.mark.parametrize("motion", ["-0.01*t", "-0.01*max(t-0.001, 0)", "-0.01*t+0.01/1900*sin(1900*t)"], ids=["start", "kink", "smooth"])
def test_a_support_that_starts_suddenly_is_said_to_ring(tmp_path, motion):
    """A bar at rest on its bottom; its top starts to move at V. By characteristics its force is 3
    rho c V A when the front is back. Behind a sharp front it rings by up to a third of the front,
    2 rho c V A there."""
    pressed = BAR | {"support": [{"where": "bottom"}, {"where": "top", "motion": [0, motion]}]}
    transit = BAR["height"] * math.sqrt(1000 / SOFT["young"])
    run = bodies(tmp_path, HELD | {"end_time": 0.001 + 3.5 * transit, "body": [pressed]})
    front = math.sqrt(1000 * SOFT["young"]) * 0.01 * BAR["width"]
    said = [sentence for sentence in run.summary["warnings"] if sentence.startswith("sudden support: ")]
    if "sin" in motion:
        assert said == []
        return
    begins = 0.001 if "max" in motion else 0
    assert [sentence.split(". ")[0] for sentence in said] == [
        f"sudden support: at t = {begins:.3g} s the velocity of support 2 jumps by 0.01 m/s, at the start from that of its body"]
    seen = (run.history["t"] > begins + 2 * transit) & (run.history["t"] < begins + 3.4 * transit)
    rings = abs(run.history["support_force_y_2"][seen]).max() - 3 * front
    assert 0.1 * 2 * front < rings < 2 * front / 3


# ---- nothing to touch, and parts that cannot give way

def test_a_free_body_needs_no_obstacle(tmp_path):
    """A body that nothing touches runs until end_time: it flies and turns as it was thrown, and
    nothing is said about a contact that cannot be."""
    block = {"shape": "rectangle", "width": 0.02, "height": 0.01, "position": [0, 0], "velocity": [3, 1], "spin": 40}
    for alone in (block, block | {"velocity": [0, 0], "spin": 0, "load": [{"where": "left", "traction": [{"t": [0, 1e-3], "x": [0, 2e3]}, 0]}]}):
        run = bodies(tmp_path, SOFT | {"end_time": 2e-3, "body": [alone]})
        summary, mass = run.summary, 1000 * 0.02 * 0.01
        assert summary["ended"] == "end_time" and summary["warnings"] == []
        assert summary["contact_intervals"] == 0 and run.history["t"][-1] == pytest.approx(2e-3)
        thrown = [3, 1, 40] if alone is block else [0.01 * (2e3 / 2 * 1e-3 + 2e3 * 1e-3) / mass, 0, 0]
        assert [run.history[name][-1] for name in ("vx", "vy", "spin")] == pytest.approx(thrown, rel=1e-3, abs=1e-6)


def test_what_ended_a_flight_past_the_end_time(tmp_path):
    """Two bodies that do not meet by the end_time: this ended the run, not an impact."""
    discs = [{"shape": "disc", "radius": 0.01, "position": [x, 0], "velocity": [-x, 0]} for x in (-1, 1)]
    summary = bodies(tmp_path, SOFT | {"end_time": 0.1, "body": discs}).summary
    assert summary["ended"] == "end_time" and [sentence[:11] for sentence in summary["warnings"]] == ["no contact:"]


def test_a_support_that_pushes_its_part_into_an_obstacle_is_named(tmp_path):
    """The bottom of a block is moved 0.5 mm into the plane: no penalty helps, and none is advised."""
    block = {"shape": "rectangle", "width": 0.02, "height": 0.02, "position": [0, 0.0105], "mesh_size": 0.01,
             "support": [{"where": "bottom", "motion": [0, "-0.5*t"]}]}
    summary = bodies(tmp_path, SOFT | {"end_time": 2e-3, "body": [block], "obstacle": [FLOOR]}).summary
    assert [sentence.split(" near ")[0] for sentence in summary["warnings"]] == [
        "held part: support 1 pushes its part up to 0.0005 m into obstacle1"]
