"""Free flights of rigid bodies of any duration until contact, and the end of a run if no further
contact follows."""

import math
import re

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.scenes import approach
from tests.support.flights import DISC, FLOOR, RUBBER, go, read

STEEL = RUBBER | {"young": 2e11, "density": 7800}
ROOM = {"kind": "polyline", "vertices": [[-1, 0], [3, 0], [3, 1]]}
# ---- onset of contact in closed form

FALL = math.sqrt(2 * (30 - 0.05) / 9.81)
# [rad] until a corner of the square is lowest.
TURNS = 2 * math.pi * 100 + math.pi / 4 - math.radians(10)
TOUCHES = {
    "two discs, 6 m apart": (read(DISC | {"position": [-3, 0], "velocity": [1, 0]}, DISC | {"position": [3, 0]}), 5.9),
    "30 m above the floor": (read(DISC | {"position": [0, 30]}, obstacles=(FLOOR,), gravity=9.81), FALL),
    "thrown up": (read(DISC | {"position": [0, 1], "velocity": [0, 100]}, obstacles=(FLOOR,), gravity=9.81), (100 + math.sqrt(1e4 + 2 * 9.81 * 0.95)) / 9.81),
    "up, away from a post, and back": (read(DISC | {"position": [0, 1], "velocity": [0, 20]}, gravity=10.0,
                                            obstacles=({"kind": "circle", "centre": [0, 0], "radius": 0.1},)), (20 + math.sqrt(400 + 20 * 0.85)) / 10),
    "along the floor to a wall": (read(DISC | {"position": [0, 0.5], "velocity": [1e-3, 0]}, obstacles=(ROOM,)), 2950.0),
    "across a bowl": (read(DISC | {"position": [0, 0], "velocity": [1e-3, 0]}, obstacles=({"kind": "bowl", "centre": [0, 0], "radius": 10},)), 9950.0),
    "a hundred turns": (read({"shape": "rectangle", "width": 0.1, "height": 0.1, "angle": 10, "position": [0, 1 + math.sqrt(0.005)],
                              "velocity": [0, -1], "spin": TURNS}, obstacles=(FLOOR,)), 1.0),
}


@pytest.mark.parametrize("case", TOUCHES)
def test_the_first_touch_is_that_of_the_closed_form(case):
    """The end of a flight of any duration is exact to 1e-9 of it; for corners that pass within
    round-off, to the root of that."""
    problem, expected = TOUCHES[case]
    first = approach.onsets_of(problem)[0]
    assert first.time == pytest.approx(expected, rel=1e-4 if "turns" in case else 1e-9) and not first.never


LONG = {"two discs": (read(DISC | {"position": [-3, 0], "velocity": [1, 0]}, DISC | {"position": [3, 0]}), {}, 5.9),
        "disc, 30 m": (scene.load("disc-normal"), STEEL | {"body.1.position.2": 30.05, "speed": 0, "gravity": 9.81, "penalty": "auto"}, math.sqrt(60 / 9.81))}


@pytest.mark.parametrize("case", LONG)
def test_long_flights_end_at_the_touch(tmp_path, case):
    """After a flight of more than a million transit times, or of sixty diameters, a body bounces.

    The first contact point comes into contact at the time of the closed form (to the curvature
    between points, 1e-6).
    """
    problem, values, expected = LONG[case]
    rows, result = go(tmp_path, problem, values)
    assert rows.start[0] == pytest.approx(expected, rel=2e-6) and result.history["t"][1] <= rows.start[0]
    assert result.summary["contact_time"] < 0.01 * expected and rows.restitution[0] > 0.9


@pytest.mark.few(1)
@pytest.mark.parametrize("distance, notes", [
    ("y + x^2", []), ("exp(y/0.02) - 1", [])])
def test_what_leaves_an_expression_that_is_no_distance(tmp_path, distance, notes):
    """Above a surface that falls away, or one whose expression overflows 14 m away, no contact is
    invented."""
    _, result = go(tmp_path, read(DISC | {"position": [0, 0.0501], "velocity": [0, -5]}, obstacles=({"kind": "implicit", "distance": distance},)))
    assert [note[:len(notes[0]) if notes else 0] for note in result.summary["notes"] if note.startswith("touches again")] == notes


def test_a_steel_bead_bounces(tmp_path):
    """A bead of 1 mm dropped from 1 m is in contact for Hertz' time, with and without end_time."""
    bead = STEEL | {"radius": 5e-4, "body.1.position": 1.0005, "speed": 0, "gravity": 9.81, "penalty": "auto", "accuracy": 0.02}
    stiff, speed, mass = 2e11 / (1 - 0.3**2), math.sqrt(2 * 9.81), 7800 * 4 / 3 * math.pi * 5e-4**3
    for more in ({"end_time": 0.45153}, {}):
        _, result = go(tmp_path / str(len(more)), scene.load("ball-axisymmetric"), bead | more)
        # That of a finite ball is 2 % less.
        assert result.summary["contact_time"] == pytest.approx(2.868 * (mass**2 / (5e-4 * stiff**2 * speed))**0.2, rel=0.025)
        assert result.summary["rebound_vy"] == pytest.approx(speed, rel=0.01)
    assert any(note.startswith("touches again") and "t = 1.35" in note for note in result.summary["notes"])


# ---- the end

def test_a_run_ends_when_all_that_follows_is_over(tmp_path):
    """A disc that moves from the floor to a wall of the same obstacle leaves after both. If nothing
    follows, the run ends at once."""
    rows, result = go(tmp_path, read(DISC | {"position": [2.92, 0.06], "velocity": [2, -2]}, obstacles=(ROOM,)))
    assert rows.normal_y[0] == pytest.approx(1) and rows.normal_x.iloc[-1] == pytest.approx(-1)
    s = result.summary
    assert s["rebound_vx"] < -1.8 and s["rebound_vy"] > 1.8 and s["energy_drift"] < 1e-9
    assert result.history["t"][-1] - s["contact_start"] - s["contact_time"] < 0.15 * s["contact_time"]


def test_what_falls_back_is_told(tmp_path):
    """Under gravity a run without end_time ends after the first impact and reports when the body
    returns, by the parabola."""
    _, result = go(tmp_path, scene.load("disc-normal"), {"law": "neohookean", "accuracy": 0.1, "speed": 2, "gravity": 9.81})
    s = result.summary
    sentence, = [note for note in s["notes"] if note.startswith("touches again")]
    assert float(sentence.split("t = ")[1].split(" s")[0]) == pytest.approx(s["contact_start"] + s["contact_time"] + 2 * s["rebound_vy"] / 9.81, rel=0.03)


def test_what_would_touch_for_ever_is_told(tmp_path):
    """Between two walls without friction, a run without end_time contains exactly the first impact
    and reports when the body reaches the other wall."""
    walls = (FLOOR | {"name": "floor"}, {"name": "ceiling", "kind": "plane", "point": [0, 0.14], "normal": [0, -1]})
    body = DISC | {"position": [0, 0.06], "velocity": [0, -2]}
    rows, result = go(tmp_path / "open", read(body, obstacles=walls, accuracy=0.2))
    _, alone = go(tmp_path / "alone", read(body, obstacles=walls, accuracy=0.2, end_time=float(result.history["t"][-1])))
    s = result.summary
    sentence, = [note for note in s["notes"] if note.startswith("touches again")]
    arrives = s["contact_start"] + s["contact_time"] + 0.04 / s["rebound_vy"]
    assert float(sentence.split("t = ")[1].split(" s")[0]) == pytest.approx(arrives, rel=0.1) and "end_time > 0" in sentence
    assert len(rows) == s["contact_intervals"] == 1 and len(result.history["t"]) == s["steps"] + 1
    for name in ("impulse", "contact_time", "rebound_vy", "vibration_energy", "steps", "max_pressure", "energy_final"):
        assert s[name] == pytest.approx(alone.summary[name], rel=1e-9), name


def test_under_gravity_an_impact_ends_with_the_first_flight_that_gravity_bends(tmp_path):
    """In a hollow circle a disc would reach the wall again also without gravity.

    No flight is integrated and discarded, and the run reports when the disc returns.
    """
    bowl = {"kind": "bowl", "centre": [0, 0.3], "radius": 0.3}
    contacts, result = go(tmp_path, read(DISC | {"position": [0, 0.06], "velocity": [0.5, -4]}, obstacles=(bowl,), gravity=9.81))
    log = (result.folder / "log.txt").read_text()
    assert len(contacts) == 1 and max(map(float, re.findall(r"progress \S+ t=(\S+)", log)), default=0) < 0.05
    assert any(words.startswith("touches again: ") for words in result.summary["notes"]) and result.summary["cpu_seconds"] < 2


SOFT = {"young": 5e6, "nu": 0.4, "density": 1200}
FAR_AWAY = {
    "the other end of a rod": (
        ({"name": "ball", "shape": "disc", "radius": 0.03, "position": [0.12, 0.05], "velocity": [0, -3]},
         {"name": "rod", "shape": "rectangle", "width": 0.3, "height": 0.03, "position": [0, 0]}), (),
        "ball and rod", (0.15, 0.25)),
    "across a bowl": (
        ({"name": "disc", "shape": "disc", "radius": 0.04, "position": [0.013, 0.06],
          "velocity": [0.7, -2.0]},),
        ({"name": "bowl", "kind": "bowl", "centre": [0, 0.2], "radius": 0.2},),
        "disc and bowl", (0.15, 0.2)),
}


@pytest.mark.parametrize("case", FAR_AWAY)
def test_a_contact_long_after_the_first_is_named_and_not_computed(tmp_path, case):
    """A contact that begins after many durations of the first one, and many periods of vibration,
    does not belong to the impact.

    The run computes no step beyond the end of the impact and reports which bodies come into contact
    and when.
    """
    bodies, obstacles, who, (earliest, latest) = FAR_AWAY[case]
    rows, result = go(tmp_path, read(*bodies, obstacles=obstacles, **SOFT))
    s, sentences = result.summary, [note for note in result.summary["notes"] if note.startswith("touches again")]
    marched = [float(t) for t in re.findall(r"progress \S+ t=(\S+)", (result.folder / "log.txt").read_text())]
    assert s["ended"] == "impact" and s["contact_time"] < 6e-3 and rows.end.max() < 0.02
    assert max(marched) <= result.history["t"][-1] * (1 + 1e-5) < 0.1  # 6 digits are printed
    assert len(sentences) == 1 and sentences[0].startswith(f"touches again: {who} ") and "end_time > 0" in sentences[0]
    assert earliest < float(sentences[0].split("t = ")[1].split(" s")[0]) < latest
    assert s["phase_seconds"]["flight"] >= 0


def test_a_corner_that_follows_at_once_belongs_to_the_impact(tmp_path):
    """A square at 20 degrees strikes with a second corner within three durations of the first
    contact: the run has both."""
    square = {"shape": "rectangle", "width": 0.1, "height": 0.1, "position": [0, 0.08], "angle": 20}
    rows, result = go(tmp_path, read(square | {"velocity": [0, -2]}, obstacles=(FLOOR,)))
    assert len(rows) == 2 and rows.start[1] - rows.start[0] < 3 * rows.time[0]
    assert not [note for note in result.summary["notes"] if note.startswith("touches again")]


def test_steps_grow_in_a_flight_before_an_end_time(tmp_path):
    """A card that falls flat flies upwards for thousands of transit times across its thickness.

    It takes few steps for this. Energy is conserved, and the centre follows the parabola.
    """
    card = {"shape": "rectangle", "width": 0.06, "height": 0.002, "position": [0, 0.002],
            "mesh_size": 1e-3, "contact_mesh_size": 1e-3}
    problem = read(card, obstacles=(FLOOR,), gravity=9.81, end_time=0.03, young=1e8, density=1000)
    rows, result = go(tmp_path, problem)
    h, s, transit = result.history, result.summary, 0.002 / math.sqrt(1e8 / 1000)
    k = int(np.argmax(h["t"] > rows.end.iloc[-1])) + 1  # in the flight
    rise = h["vy"][k] * (h["t"] - h["t"][k]) - 9.81 * (h["t"] - h["t"][k])**2 / 2
    assert h["t"][-1] - h["t"][k] > 1000 * transit and len(h["t"]) - k < 300
    assert h["y"][k:] - h["y"][k] == pytest.approx(rise[k:], abs=1e-9) and s["energy_drift"] < 1e-8
    log = (result.folder / "log.txt").read_text()  # forecasts include the flight
    forecasts = [int(n) / float(share) for share, n in re.findall(r"progress (\S+) t=\S+ steps=(\d+)", log)]
    steps_of_impact = (h["t"][-1] - h["t"][k]) / np.diff(h["t"][:k]).min()  # that the flight would take
    assert max(forecasts) < 0.1 * steps_of_impact


def test_steps_of_a_compact_body_stay_before_an_end_time(tmp_path):
    """A disc that bounces until an end_time takes the steps of contact in flight, as the next
    contact depends on its vibration."""
    values = {"law": "neohookean", "accuracy": 0.1, "speed": 2, "gravity": 9.81, "end_time": 0.06}
    rows, result = go(tmp_path, scene.load("disc-normal"), values)
    t, dt = result.history["t"], result.history["dt"]
    contact, flight = (t > rows.start[0]) & (t <= rows.end[0]), t > rows.end.iloc[-1]
    assert flight.sum() > 20 and dt[flight].max() == pytest.approx(dt[contact].max(), rel=1e-9)
