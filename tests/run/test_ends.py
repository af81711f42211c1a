"""The end of an impact: the slowest period of bodies on supports, strikes that belong to the impact,
and what is reported of strikes that were not followed."""

import math
import re

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from ffimpact.running import run
from tests.support.flights import go, read

YOUNG, NU, DENSITY = 7e6, 0.4, 1200.0
RUBBER = {"law": "neohookean", "young": YOUNG, "nu": NU, "density": DENSITY}
LENGTH, THICKNESS = 0.24, 0.012


# ---- the slowest period on supports


def ends_of_a_beam(frequency: float, start: list[int], end: list[int]) -> float:
    """A function that vanishes at the angular frequencies [rad/s] of a beam with shear and rotary
    inertia in plane strain (Timoshenko 1921).

    `start` and `end` name what vanishes at the ends: 0 deflection, 1 rotation, 2 moment, 3 shear
    force.
    """
    inertia, modulus = THICKNESS**3 / 12, YOUNG / (1 - NU**2)
    factor = 5 * (1 + NU / (1 - NU)) / (6 + 5 * NU / (1 - NU))
    shear = factor * YOUNG / (2 * (1 + NU)) * THICKNESS
    system = np.zeros((4, 4))
    system[0, 1], system[0, 3] = 1, 1 / shear
    system[1, 2] = 1 / (modulus * inertia)
    system[2, 1], system[2, 3] = -DENSITY * inertia * frequency**2, -1
    system[3, 0] = -DENSITY * THICKNESS * frequency**2
    others = [k for k in range(4) if k not in start]
    return float(np.linalg.det(expm(system * LENGTH)[np.ix_(end, others)]))


# Conditions at the ends, and the factor b of omega = b^2 sqrt(D/(rho h))/L^2 (Euler, Bernoulli).
BEAMS = {
    "clamped": ([0, 1], [0, 1], 4.730),
    "cantilever": ([0, 1], [2, 3], 1.875),
    "simple": ([0, 2], [0, 2], math.pi),
}


def test_the_slowest_period_is_that_of_the_beam_on_its_supports(tmp_path):
    """Strips that are clamped at both ends, clamped at one, and on rollers have the period of
    Timoshenko's beam, to 1 %: his beam has no clamp that hinders the contraction across, which
    reaches 5 % of the length into each end. Rollers leave a rigid motion, which is no vibration."""
    strip = {
        "shape": "rectangle",
        "width": LENGTH,
        "height": THICKNESS,
        "mesh_size": 0.006,
        "contact_mesh_size": 0.006,
    }
    held = {
        "clamped": [{"where": "left"}, {"where": "right"}],
        "cantilever": [{"where": "left"}],
        "simple": [{"where": "left", "fix": "y"}, {"where": "right", "fix": "y"}],
    }
    bodies = [
        strip | {"name": name, "position": [0, 0.1 * k], "support": supports}
        for k, (name, supports) in enumerate(held.items())
    ]
    ball = {
        "name": "ball",
        "shape": "disc",
        "radius": 0.02,
        "position": [0, 0.35],
        "velocity": [0, -1],
    }
    scene = read(*bodies, ball, **RUBBER, end_time=1e-5)
    _, result = go(tmp_path, scene)
    log = (result.folder / "log.txt").read_text()
    periods = {
        name: float(value) for name, value in re.findall(r"slowest period +(\w+): (\S+) s", log)
    }
    assert set(periods) == set(BEAMS)
    for name, (start, end, factor) in BEAMS.items():
        slender = factor**2 * THICKNESS * math.sqrt(YOUNG / (1 - NU**2) / DENSITY / 12) / LENGTH**2
        omega = brentq(ends_of_a_beam, 0.7 * slender, 1.05 * slender, args=(start, end))
        assert periods[name] == pytest.approx(2 * math.pi / omega, rel=1e-2), name


# ---- strikes that belong to the impact

DISC = {
    "name": "disc",
    "shape": "disc",
    "radius": 0.02,
    "position": [0.04, 0.0305],
    "velocity": [0, -3],
}
STRIP = {
    "name": "strip",
    "shape": "rectangle",
    "width": LENGTH,
    "height": 0.02,
    "position": [0, 0],
    "support": [{"where": "left"}, {"where": "right"}],
}
COARSE = {"mesh_size": 0.01, "contact_mesh_size": 0.004, "accuracy": 0.05}


@pytest.fixture(scope="module")
def strip(tmp_path_factory):
    """A disc on a clamped strip: until the impact is over, until 25.6 ms, and until 20 ms."""
    sizes = [
        body | {name: COARSE[name] for name in ("mesh_size", "contact_mesh_size")}
        for body in (DISC, STRIP)
    ]
    return {
        end: go(
            tmp_path_factory.mktemp("strip"),
            read(*sizes, **RUBBER, accuracy=COARSE["accuracy"], end_time=end),
        )
        for end in (0.0, 0.0256, 0.020)
    }


def test_a_held_body_swings_back_into_the_impact(strip):
    """The fourth strike of a disc and a clamped strip, at 23 ms, belongs to the impact. The impulse
    is that of a run until 25.6 ms."""
    (rows, result), (long_rows, long) = strip[0.0], strip[0.0256]
    assert len(rows) == len(long_rows) >= 4 and 0.020 < rows.start.iloc[-1] < 0.0256
    assert result.summary["impulse"] == pytest.approx(long.summary["impulse"], rel=1e-4)
    assert result.summary["ended"] == "impact" and not result.summary["later_contact_possible"]


def test_a_stiff_beam_swings_back_to_a_fast_disc(tmp_path):
    """A disc of aluminium leaves a clamped beam at 6 m/s and is struck again 0.1 ms later. At the
    look after the first contact the gap is larger than what the last step has searched."""
    metal = {"law": "svk", "young": 7e10, "density": 2700, "nu": 0.33}
    disc = DISC | {
        "radius": 0.025, "position": [0, 0.0455], "velocity": [0, -27],
        "mesh_size": 0.0088, "contact_mesh_size": 0.0008,
    }
    beam = STRIP | {
        "width": 0.2, "height": 0.04, "mesh_size": 0.0118, "contact_mesh_size": 0.00076,
    }
    rows, result = go(tmp_path, read(disc, beam, **metal, accuracy=0.05))
    assert rows.start.iloc[-1] > 1.5e-4
    assert result.summary["impulse"] == pytest.approx(225.4, rel=0.01)  # until 0.3 ms


@pytest.mark.robustness
def test_a_slender_free_body_swings_back_into_the_impact(tmp_path):
    """A light disc leaves the middle of a free bar slowly. The bar bends back and strikes it again
    after 38 ms, within its slowest period of 63 ms. The impulse is that of a run until 45 ms, to
    the accuracy, as steps of a flight are longer without an end_time."""
    sizes = {"mesh_size": 0.006, "contact_mesh_size": 0.004}
    disc = DISC | sizes | {"position": [0, 0.0305], "density": 300}
    bar = {"shape": "rectangle", "width": LENGTH, "height": THICKNESS, "position": [0, 0.004]}
    runs = [
        go(tmp_path / f"{end:g}", read(disc, bar | sizes, **RUBBER, accuracy=0.05, end_time=end))
        for end in (0.0, 0.045)
    ]
    (rows, result), (_, long) = runs
    assert rows.start.iloc[-1] > 0.035
    assert result.summary["impulse"] == pytest.approx(long.summary["impulse"], rel=0.05)


def test_a_strike_that_the_end_time_cuts_is_a_warning(strip):
    """A run that ends before the fourth strike says that contacts of the impact may follow."""
    (rows, result), (_, long) = strip[0.020], strip[0.0256]
    assert (
        len(rows) < len(strip[0.0][0]) and result.summary["impulse"] < 0.8 * long.summary["impulse"]
    )
    (sentence,) = [words for words in result.summary["warnings"] if words.startswith("not over")]
    begins = float(re.search(r"t = (\S+) s or later", sentence)[1])
    assert (
        0.020 <= begins <= strip[0.0][0].start.iloc[-1] and result.summary["later_contact_possible"]
    )
    assert "not over" not in " ".join(long.summary["warnings"])


def test_a_return_by_gravity_within_the_impact_has_no_estimate(tmp_path):
    """A disc that falls back within three durations of its contact: gravity ends the run, with a
    warning and without an error estimate. Under a weaker gravity the return is a note."""
    disc = {
        "shape": "disc",
        "radius": 0.05,
        "position": [0, 0.0501],
        "velocity": [0, -2],
        "mesh_size": 0.02,
        "contact_mesh_size": 0.004,
    }
    floor = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}
    for gravity, within in ((400.0, True), (20.0, False)):
        scene = read(disc, obstacles=(floor,), accuracy=0.3, gravity=gravity)
        s = run.run(scene, {}, tmp_path / f"{gravity:g}").summary
        lasts = s["contact_time"]
        assert (2 * s["rebound_vy"] / gravity < 2 * lasts) == within
        assert any(words.startswith("not over") for words in s["warnings"]) == within
        assert any(words.startswith("touches again") for words in s["notes"]) != within
        assert (s["estimated_error"] is None) == within == s["later_contact_possible"]


# ---- steps after and before a strike


def test_prestress_is_no_vibration(tmp_path):
    """Supports pull a strip taut, a ball hits it and leaves at 11 m/s, faster than the strip vibrates
    about its taut shape. The energy of the tension brings no further strike: the steps grow."""
    pull = "0.006*(1-cos(pi*min(t,0.008)/0.008))/2"
    ball = DISC | {"young": 1e6, "position": [0, 0.15], "velocity": [0, -12]}
    strip = {
        "shape": "rectangle", "width": 0.2, "height": 0.005, "position": [0, 0],
        "young": 5e7, "density": 67,
        "support": [
            {"where": "left", "motion": [f"-{pull}", 0]},
            {"where": "right", "motion": [pull, 0]},
        ],
    }
    rows, result = go(tmp_path, read(ball, strip, **RUBBER, accuracy=0.1, end_time=0.024))
    left = rows.start.iloc[-1] + rows.time.iloc[-1]
    assert left < 0.0185 and (result.history["t"] > left).sum() < 50


def test_contact_without_load_sets_no_steps(tmp_path):
    """A weight takes 2 ms to a pad that touches a held plate without load: few steps until then."""
    block = {"shape": "rectangle", "width": 0.05, "height": 0.01}
    plate = block | {"position": [0, 0], "support": [{"where": "bottom"}]}
    pad, weight = (block | {"position": [0, y]} for y in (0.01, 0.022))
    bodies = (plate, pad, weight | {"velocity": [0, -1]})
    rows, result = go(tmp_path, read(*bodies, **RUBBER, accuracy=0.1, end_time=2.2e-3))
    assert (result.history["t"] < 0.0019).sum() < 60 and rows.peak_force.max() > 100
