"""Bodies that may come into contact with themselves: when they do, and conservation during this
contact."""

import numpy as np
import pytest

from ffimpact.failure import BadInput
from ffimpact.output import vtu
from ffimpact.running import run
from ffimpact.scenes import assembly
from tests.support.self_contact import (
    BOX,
    DISC,
    PIN,
    PINCHED,
    RING,
    SCENE,
    SLOT_HIGH,
    SLOT_WIDE,
    balanced,
    box_file,
    distances,
    overlaps,
    ran,
    read,
    slot_of,
)


def partners(tables: dict) -> list[tuple[int, int]]:
    """The contact pairs of bodies with themselves in a scene."""
    return [(pair.first, pair.second) for pair in read(tables).pairs if pair.first == pair.second]


@pytest.mark.few(1)
@pytest.mark.parametrize("friction", [0, 0.4])
def test_a_hairpin_closes_and_opens_again(tmp_path, friction):
    """Its free arm closes the slot of 10 mm at 6 m/s, to a hundredth of it, and returns. Energy
    with friction work is conserved."""
    result = ran(tmp_path, SCENE | {"body": [PIN], "end_time": 12e-3, "fields": 40, "contact": {"friction_static": friction}})
    balanced(result)
    assert "self-contact" not in result.summary["skipped"] and (result.summary["friction_work"] > 0.1) == (friction > 0)
    # Without the corners of the ends, which lie beyond the last contact points.
    slot = distances(result, lambda x, y: (abs(y - 0.005) < 1e-9) & (abs(x - 0.01) < 0.035), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03))
    closed = slot.argmin()
    assert abs(slot[closed]) < 2e-4 and slot[0] > 0.0099 and slot[closed:].max() > 0.003 and result.summary["max_penetration"] < 2e-4


def test_a_ring_hits_a_plane_so_hard_that_it_closes(tmp_path):
    """Its inner sides come into contact and separate before it leaves the plane."""
    result = ran(tmp_path, SCENE | {"body": [RING], "end_time": 16e-3, "fields": 30})
    balanced(result)
    hole = distances(result, lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y > 0.02), lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y < -0.02))
    assert abs(hole.min()) < 1e-3 and hole[hole.argmin():].max() > 0.003


@pytest.mark.few(1)
@pytest.mark.parametrize("friction", [0, 0.4])
def test_a_free_hairpin_keeps_all_momenta(tmp_path, friction):
    """A disc closes the slot of a free hairpin off its centre: self-contact neither moves nor
    rotates the hairpin as a whole."""
    disc = DISC | {"position": [0.04, 0.0255], "velocity": [0, -12]}
    result = ran(tmp_path, SCENE | {"obstacle": [], "body": [PIN | {"position": [0, 0], "velocity": [0, 0]}, disc], "end_time": 4e-3, "fields": 20, "contact": {"friction_static": friction}})
    balanced(result)
    slot = distances(result, lambda x, y: (abs(y - 0.005) < 1e-9) & (x > -0.03) & (x < 0.06), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03) & (x < 0.06))
    assert abs(slot.min()) < 5e-4
    h = result.history
    for column, scale in (("momentum_x", h["momentum_y"]), ("momentum_y", h["momentum_y"]), ("angular_momentum", h["angular_momentum"])):
        assert np.ptp(h[column]) < 1e-9 * abs(scale[0])


def test_a_groove_of_revolution_closes(tmp_path):
    """The same in a section through the axis, with friction: a flange of a cylinder comes into
    contact with its other flange."""
    flanges = [[0, 0], [0.05, 0], [0.05, 0.005], [0.012, 0.005], [0.012, 0.009], [0.05, 0.009], [0.05, 0.014], [0, 0.014]]
    body = {"shape": "polygon", "vertices": flanges, "position": 0.00705, "velocity": -12, "mesh_size": 0.005, "contact_mesh_size": 0.005}
    tables = SCENE | {"dimension": "axisymmetric", "body": [body], "end_time": 2e-3, "contact": {"friction_static": 0.3}}
    assert partners(tables) == [(0, 0)]
    result, free = (ran(tmp_path, tables | {"contact": {"friction_static": 0.3, "self_contact": word}}, word) for word in ("auto", "off"))
    balanced(result)
    assert any(warning.startswith("overlap") for warning in free.summary["warnings"])


def test_which_bodies_touch_themselves(tmp_path):
    """auto: bodies that may come into contact with themselves; on and off: all and none. A pair of
    a body with itself has priority.

    The scene as used reads back equal.
    """
    thick, block = RING | {"inner_radius": 0.01}, DISC | {"position": [1, 1]}
    bodies = [PIN, RING | {"position": [0.3, 0.1]}, thick | {"name": "thick", "position": [0.6, 0.1]}, block]
    tables = SCENE | {"body": bodies}
    assert partners(tables) == [(0, 0), (1, 1)] == partners(tables | {"contact": {"self_contact": "auto"}})
    assert partners(tables | {"contact": {"self_contact": "on"}}) == [(0, 0), (1, 1), (2, 2), (3, 3)]
    own = {"self_contact": "off", "pair": [{"bodies": ["thick", "thick"], "penalty": 1e9}]}
    assert partners(tables | {"contact": {"self_contact": "off"}}) == [] and partners(tables | {"contact": own}) == [(2, 2)]
    rigid = {"body": [PIN, RING | {"position": [0.3, 0.1], "rigid": True}]}
    assert partners(SCENE | rigid) == [(0, 0)] == partners(SCENE | rigid | {"contact": {"self_contact": "on"}})
    for contact, message in (({"self_contact": "yes"}, "^contact.self_contact: 'yes' is not known .accepted: auto|on|off"),):
        with pytest.raises(BadInput, match=message):
            read(tables | {"contact": contact})
    _, used, _ = assembly.prepare(read(SCENE | {"body": [PIN], "contact": {"penalty": 1e9}}), tmp_path)
    assert used["contact"]["self_contact"] == "auto" and used["contact"]["pair"] == [{"bodies": ["pin", "pin"], "penalty": 1e9, "friction_static": 0, "friction_dynamic": 0}]
    assert partners(used) == [(0, 0)] and assembly.prepare(read(used), tmp_path)[1] == used


def test_where_it_cannot_happen_it_changes_nothing(tmp_path):
    """A thick ring on a plane has the same motion with and without its own outline as counter-body,
    on one mesh: without it half a ring would do.

    The run without reports that self-contact was skipped.
    """
    ring = RING | {"inner_radius": 0.015, "velocity": [0, -2], "mesh_size": 0.015}
    on, off = (ran(tmp_path, SCENE | {"body": [ring], "symmetry": "full", "end_time": 1e-3, "contact": {"self_contact": word}}, word) for word in ("on", "auto"))
    assert "self-contact" not in on.summary["skipped"] and "self-contact" in off.summary["skipped"]
    assert on.history["momentum_y"] == pytest.approx(off.history["momentum_y"], rel=1e-7)


# ---- inner outlines

SHAPES = {"polygon": lambda folder: BOX, "file": box_file,
          "file with a group": lambda folder: box_file(folder, "all")}


@pytest.mark.few(1)
@pytest.mark.parametrize("shape", SHAPES)
def test_walls_of_a_hole_stop_each_other(tmp_path, shape):
    """A peg closes the slot of 4 mm in a box. With self_contact = "auto" its walls stop each other
    and conserve energy.

    With "off" they pass through each other, and a warning reports it before they overlap by a
    millimetre, and not while they are apart.
    """
    body = SHAPES[shape](tmp_path)
    def pinched(word: str, end: float):
        tables = PINCHED | {"body": [body], "end_time": end, "contact": {"self_contact": word}}
        return run.run(read(tables, tmp_path), {}, tmp_path / f"{word}-{end}", estimate=False)
    stopped, passed, before = pinched("auto", 1.3e-3), pinched("off", 1.3e-3), pinched("off", 5e-4)
    assert stopped.summary["status"] == "ok" and stopped.summary["energy_drift"] < 1e-9
    assert not overlaps(stopped) and stopped.summary["max_penetration"] < 5e-4
    assert slot_of(stopped)[0] == pytest.approx(SLOT_HIGH) and abs(slot_of(stopped).min()) < 2e-4
    assert slot_of(passed).min() < -1e-3 and not overlaps(before) and slot_of(before).min() > 0
    sentence, = overlaps(passed)
    start = float(sentence.split("t = ")[1].split()[0])
    times = [t for t, _ in vtu.series(passed.folder / "fields.pvd")]
    assert -1e-3 < np.interp(start, times, slot_of(passed)) < 0 and "self_contact" in sentence
    x, y = map(float, sentence.split("X = (")[1].split(")")[0].split(", "))
    assert abs(y) == pytest.approx(SLOT_HIGH / 2) and abs(x) < SLOT_WIDE / 2


def test_walls_of_a_ring_are_watched(tmp_path):
    """Two pegs compress a ring. Without self-contact its walls pass through each other at the end,
    with a warning; while they are apart there is none."""
    ring = {"shape": "ring", "radius": 0.05, "inner_radius": 0.045, "position": [0, 0],
            "mesh_size": 0.0025, "contact_mesh_size": 0.0025}
    below = {"kind": "circle", "centre": [0, -0.0651], "radius": 0.015}
    above = below | {"centre": [0, 0.0651], "velocity": [0, -2]}
    tables = {"law": "neohookean", "young": 2e6, "nu": 0.3, "density": 1000, "accuracy": 0.2,
              "body": [ring], "obstacle": [below, above], "contact": {"self_contact": "off"}}
    apart, crossed = (ran(tmp_path, tables | {"end_time": end}, f"{end}") for end in (0.044, 0.0465))
    assert not overlaps(apart)
    sentence, = overlaps(crossed)
    assert 0.044 < float(sentence.split("t = ")[1].split()[0]) <= 0.0465
