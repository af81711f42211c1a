"""Bodies that touch themselves: what makes them, and that nothing is lost when they do."""

from pathlib import Path

import numpy as np
import pytest

from orchestrate import run
from orchestrate.output import vtu
from orchestrate.failure import BadInput
from orchestrate.scene import read as read_scene
from orchestrate.scenes import assembly

FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}
SCENE = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1722, "accuracy": 0.1, "obstacle": [FLOOR]}
PIN = {"name": "pin", "shape": "polygon", "vertices": [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]],
       "position": [0, 0.0151], "velocity": [0, -6], "mesh_size": 0.009, "contact_mesh_size": 0.009}
RING = {"name": "ring", "shape": "ring", "radius": 0.05, "inner_radius": 0.044, "position": [0, 0.0501], "velocity": [0, -8], "mesh_size": 0.006, "contact_mesh_size": 0.006}
DISC = {"name": "disc", "shape": "disc", "radius": 0.01, "mesh_size": 0.005, "contact_mesh_size": 0.005}


def read(given: dict):
    return read_scene(given, Path(), "self")


def partners(given: dict) -> list[tuple[int, int]]:
    """The pairs of a scene of bodies with themselves."""
    return [(pair.first, pair.second) for pair in read(given).pairs if pair.first == pair.second]


def ran(tmp_path, given: dict, name: str = "run"):
    return run.run(read(given), {}, tmp_path / name, estimate=False)


def distances(found, of, to) -> np.ndarray:
    """Of every snapshot, the least height of nodes of the reference set `of` above the polygon through those of `to`, which is over every x once."""
    least = []
    for _, path in vtu.series(found.folder / "fields.pvd"):
        seen = vtu.read(path)
        X, x = seen.points, seen.points + seen.fields["displacement"][:, :2]
        above, below = x[of(*X.T)], x[to(*X.T)]
        below = below[np.argsort(below[:, 0])]
        least.append((above[:, 1] - np.interp(above[:, 0], *below.T))[(above[:, 0] > below[0, 0]) & (above[:, 0] < below[-1, 0])].min())
    return np.array(least)


def balanced(found, energy: float = 1e-9) -> None:
    s = found.summary
    assert s["status"] == "ok" and s["energy_drift"] < energy and s["momentum_drift"] < 1e-9 and (s.get("angular_momentum_drift") or 0) < 1e-9
    assert not any(one.startswith(("overlap", "energy", "momentum", "angular")) for one in s["warnings"])


@pytest.mark.parametrize("friction", [0, 0.4])
def test_a_hairpin_closes_and_opens_again(tmp_path, friction):
    """Its free arm closes the slot of 10 mm at 6 m/s, no further than a hundredth of it, and comes back; energy with the work of friction is kept."""
    found = ran(tmp_path, SCENE | {"body": [PIN], "end_time": 12e-3, "fields": 40, "contact": {"friction_static": friction}})
    balanced(found)
    assert "self-contact" not in found.summary["skipped"] and (found.summary["friction_work"] > 0.1) == (friction > 0)
    # without the tips' corners, which lie beyond the last contact points
    slot = distances(found, lambda x, y: (abs(y - 0.005) < 1e-9) & (abs(x - 0.01) < 0.035), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03))
    closed = slot.argmin()
    assert abs(slot[closed]) < 2e-4 and slot[0] > 0.0099 and slot[closed:].max() > 0.003 and found.summary["max_penetration"] < 2e-4


def test_with_and_without_kernels_it_is_the_same(tmp_path):
    """The scripts find what the compiled kernel does, until round-off grows."""
    one, other = (ran(tmp_path, SCENE | {"body": [PIN], "end_time": 1.5e-3, "without": without}, without).history for without in ("none", "kernels"))
    assert len(one["t"]) == len(other["t"]) and one["contact"].max() > 0
    for column in ("momentum_y", "elastic", "contact"):
        assert one[column] == pytest.approx(other[column], rel=1e-6, abs=1e-6 * abs(one[column]).max())


def test_a_ring_is_squeezed_flat(tmp_path):
    """A plane comes down on a thin ring until less than a sixth of the hole is left: its inner sides lie on each other, folds and all, and nothing is lost."""
    press = {"name": "press", "kind": "plane", "point": [0, 0.1002], "normal": [0, -1], "velocity": [0, -8]}
    found = ran(tmp_path, SCENE | {"body": [RING | {"velocity": [0, 0]}], "obstacle": [FLOOR, press], "end_time": 10.5e-3, "fields": 12})
    balanced(found)
    hole = distances(found, lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y > 0.02), lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y < -0.02))
    assert hole[0] > 0.04 and -1e-3 < hole.min() < 1e-3 and found.summary["max_penetration"] < 5e-4


def test_a_ring_hits_a_plane_so_hard_that_it_closes(tmp_path):
    """Its inner sides meet, and part again before it leaves the plane."""
    found = ran(tmp_path, SCENE | {"body": [RING], "end_time": 14e-3, "fields": 30})
    balanced(found)
    hole = distances(found, lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y > 0.02), lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y < -0.02))
    assert abs(hole.min()) < 1e-3 and hole[hole.argmin():].max() > 0.003


@pytest.mark.parametrize("friction", [0, 0.4])
def test_a_free_hairpin_keeps_all_momenta(tmp_path, friction):
    """A disc closes the slot of a hairpin in empty space, off its centre: what the hairpin does to itself moves and turns nothing as a whole."""
    disc = DISC | {"position": [0.04, 0.0255], "velocity": [0, -12]}
    found = ran(tmp_path, SCENE | {"obstacle": [], "body": [PIN | {"position": [0, 0], "velocity": [0, 0]}, disc], "end_time": 4e-3, "fields": 20, "contact": {"friction_static": friction}})
    balanced(found)
    slot = distances(found, lambda x, y: (abs(y - 0.005) < 1e-9) & (x > -0.03) & (x < 0.06), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03) & (x < 0.06))
    assert abs(slot.min()) < 5e-4
    h = found.history
    for column, scale in (("momentum_x", h["momentum_y"]), ("momentum_y", h["momentum_y"]), ("angular_momentum", h["angular_momentum"])):
        assert np.ptp(h[column]) < 1e-9 * abs(scale[0])


def test_a_groove_of_revolution_closes(tmp_path):
    """Likewise in a section through the axis, with friction: the flange of a cylinder comes down on its other one."""
    flanges = [[0, 0], [0.05, 0], [0.05, 0.005], [0.012, 0.005], [0.012, 0.009], [0.05, 0.009], [0.05, 0.014], [0, 0.014]]
    body = {"shape": "polygon", "vertices": flanges, "position": 0.00705, "velocity": -12, "mesh_size": 0.005, "contact_mesh_size": 0.005}
    given = SCENE | {"dimension": "axisymmetric", "body": [body], "end_time": 2e-3, "contact": {"friction_static": 0.3}}
    assert partners(given) == [(0, 0)]
    found, free = (ran(tmp_path, given | {"contact": {"friction_static": 0.3, "self_contact": word}}, word) for word in ("auto", "off"))
    balanced(found)
    assert any(one.startswith("overlap") for one in free.summary["warnings"])


def test_a_hairpin_in_three_dimensions(tmp_path):
    """With linear elements it stays apart where without self_contact = "on" it passes through itself."""
    corners = [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]]
    points = "".join(f"Point({k}) = {{{x}, {y}, 0, 0.01}};\n" for k, (x, y) in enumerate(corners, 1)) + "".join(f"Line({k}) = {{{k}, {k % 8 + 1}}};\n" for k in range(1, 9))
    (tmp_path / "pin.geo").write_text(points + "Curve Loop(1) = {1:8}; Plane Surface(1) = {1}; Extrude {0, 0, 0.02} { Surface{1}; }\n")
    body = {"shape": "mesh", "file": "pin.geo", "position": [0, 0.0151, 0], "velocity": [0, -6, 0], "mesh_size": 0.0095, "contact_mesh_size": 0.0095}
    given = SCENE | {"dimension": "3d", "degree": 1, "accuracy": 0.3, "body": [body], "obstacle": [FLOOR | {"point": [0, 0, 0], "normal": [0, 1, 0]}], "end_time": 1.8e-3, "fields": 20}
    on, off = (run.run(read_scene(given | {"contact": {"self_contact": word}}, tmp_path, "pin"), {}, tmp_path / word, estimate=False) for word in ("on", "auto"))
    balanced(on)
    slot = distances(on, lambda x, y: (abs(y - 0.005) < 1e-9) & (x > -0.03), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03))
    assert abs(slot.min()) < 5e-4 and on.summary["max_penetration"] < 2e-4
    assert any(one.startswith("overlap") and "self_contact" in one for one in off.summary["warnings"])


def test_which_bodies_touch_themselves(tmp_path):
    """auto: those that may fold onto themselves; on and off: all and none; a pair of a body with itself is stronger. What is used is the same scene again."""
    thick, block = RING | {"inner_radius": 0.01}, DISC | {"position": [1, 1]}
    bodies = [PIN, RING | {"position": [0.3, 0.1]}, thick | {"name": "thick", "position": [0.6, 0.1]}, block]
    given = SCENE | {"body": bodies}
    assert partners(given) == [(0, 0), (1, 1)] == partners(given | {"contact": {"self_contact": "auto"}})
    assert partners(given | {"contact": {"self_contact": "on"}}) == [(0, 0), (1, 1), (2, 2), (3, 3)]
    own = {"self_contact": "off", "pair": [{"bodies": ["thick", "thick"], "penalty": 1e9}]}
    assert partners(given | {"contact": {"self_contact": "off"}}) == [] and partners(given | {"contact": own}) == [(2, 2)]
    assert partners(given | {"obstacle": [], "contact": {"pairing": "pairwise"}}) == []
    for contact, said in (({"self_contact": "yes"}, "^contact.self_contact: 'yes' is not known .accepted: auto|on|off"), ({"self_contact": "on", "pairing": "pairwise"}, "^contact.self_contact: on, but pairing = 'pairwise'")):
        with pytest.raises(BadInput, match=said):
            read(given | {"contact": contact})
    _, used, _ = assembly.prepare(read(SCENE | {"body": [PIN], "contact": {"penalty": 1e9}}), tmp_path)
    assert used["contact"]["self_contact"] == "auto" and used["contact"]["pair"] == [{"bodies": ["pin", "pin"], "penalty": 1e9, "friction_static": 0, "friction_dynamic": 0}]
    assert partners(used) == [(0, 0)] and assembly.prepare(read(used), tmp_path)[1] == used


def test_where_it_cannot_happen_it_changes_nothing(tmp_path):
    """A thick ring on a plane, with its own outline as a partner and without: the same motion, and one of the two says that self-contact was skipped."""
    ring = RING | {"inner_radius": 0.015, "velocity": [0, -2], "mesh_size": 0.015}
    on, off = (ran(tmp_path, SCENE | {"body": [ring], "end_time": 1e-3, "contact": {"self_contact": word}}, word) for word in ("on", "auto"))
    assert "self-contact" not in on.summary["skipped"] and "self-contact" in off.summary["skipped"]
    assert on.history["momentum_y"] == pytest.approx(off.history["momentum_y"], rel=1e-7)
