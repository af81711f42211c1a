"""Bodies that touch themselves: what makes them, and that nothing is lost when they do."""

from pathlib import Path

import numpy as np
import pytest

from ffimpact.failure import BadInput, Failure
from ffimpact.mesh import mesh
from ffimpact.output import vtu
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly

FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}
SCENE = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1722, "accuracy": 0.1, "obstacle": [FLOOR]}
PIN = {"name": "pin", "shape": "polygon", "vertices": [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]],
       "position": [0, 0.0151], "velocity": [0, -6], "mesh_size": 0.009, "contact_mesh_size": 0.009}
RING = {"name": "ring", "shape": "ring", "radius": 0.05, "inner_radius": 0.044, "position": [0, 0.0501], "velocity": [0, -8], "mesh_size": 0.006, "contact_mesh_size": 0.006}
DISC = {"name": "disc", "shape": "disc", "radius": 0.01, "mesh_size": 0.005, "contact_mesh_size": 0.005}
# a box with a slot in it, which a peg closes
WIDE, HIGH, SLOT_WIDE, SLOT_HIGH = 0.08, 0.02, 0.06, 0.004
CORNERS = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
BOX = {"name": "box", "shape": "polygon", "position": [0, 0],
       "vertices": (np.array([WIDE, HIGH]) * CORNERS).tolist(),
       "holes": [(np.array([SLOT_WIDE, SLOT_HIGH]) * CORNERS).tolist()],
       "mesh_size": 0.005, "contact_mesh_size": 0.005}
PEG = {"name": "peg", "kind": "circle", "centre": [0, HIGH / 2 + 0.0501], "radius": 0.05,
       "velocity": [0, -6]}
PINCHED = SCENE | {"young": 2e6, "density": 1000, "fields": 40,
                   "obstacle": [FLOOR | {"point": [0, -HIGH / 2 - 1e-4]}, PEG]}


def read(given: dict, folder: Path = Path()):
    return read_scene(given, folder, "self")


def box_file(folder: Path, contact: str = "") -> dict:
    """The box as a file of gmsh, with a physical curve `contact` of all curves, of the outer ones,
    or without any."""
    with mesh.gmsh_session() as gmsh:
        occ = gmsh.model.occ
        outer = occ.addRectangle(-WIDE / 2, -HIGH / 2, 0, WIDE, HIGH)
        slot = occ.addRectangle(-SLOT_WIDE / 2, -SLOT_HIGH / 2, 0, SLOT_WIDE, SLOT_HIGH)
        occ.cut([(2, outer)], [(2, slot)])
        occ.synchronize()
        def is_outer(curve: int) -> bool:
            x, y, _ = gmsh.model.occ.getCenterOfMass(1, curve)
            return max(abs(x) / WIDE, abs(y) / HIGH) > 0.49
        curves = [curve for _, curve in gmsh.model.getEntities(1)
                  if contact == "all" or is_outer(curve)]
        if contact:
            gmsh.model.addPhysicalGroup(1, curves, name="contact")
            gmsh.model.addPhysicalGroup(2, [face for _, face in gmsh.model.getEntities(2)])
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.005)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(folder / "box.msh"))
    return {"name": "box", "shape": "mesh", "file": "box.msh", "position": [0, 0]}


def slot_of(found) -> np.ndarray:
    """The least height of the slot in every snapshot, away from its ends."""
    def wall(side: int):
        return lambda x, y: (abs(y - side * SLOT_HIGH / 2) < 1e-9) & (abs(x) < 0.45 * SLOT_WIDE)
    return distances(found, wall(1), wall(-1))


def overlaps(found) -> list[str]:
    return [one for one in found.summary["warnings"] if one.startswith("overlap: ")]


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


@pytest.mark.few(1)
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


@pytest.mark.robustness
def test_with_and_without_kernels_it_is_the_same(tmp_path):
    """The scripts find what the compiled kernel does, until round-off grows."""
    one, other = (ran(tmp_path, SCENE | {"body": [PIN], "end_time": 1.5e-3, "without": without}, without).history for without in ("none", "kernels"))
    assert len(one["t"]) == len(other["t"]) and one["contact"].max() > 0
    for column in ("momentum_y", "elastic", "contact"):
        assert one[column] == pytest.approx(other[column], rel=1e-6, abs=1e-6 * abs(one[column]).max())


@pytest.mark.robustness
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


@pytest.mark.few(1)
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


@pytest.mark.robustness
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


# ---- inner outlines

SHAPES = {"polygon": lambda folder: BOX, "file": box_file,
          "file with a group": lambda folder: box_file(folder, "all")}


@pytest.mark.few(1)
@pytest.mark.parametrize("shape", SHAPES)
def test_walls_of_a_hole_stop_each_other(tmp_path, shape):
    """A peg closes the slot of 4 mm in a box. With self_contact = "auto" its walls stop each other
    and keep energy. With "off" they pass through each other, and the warning says so before they
    are a millimetre in, and not while they are apart."""
    body = SHAPES[shape](tmp_path)
    def pinched(word: str, end: float):
        given = PINCHED | {"body": [body], "end_time": end, "contact": {"self_contact": word}}
        return run.run(read(given, tmp_path), {}, tmp_path / f"{word}-{end}", estimate=False)
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
    """Two pegs pinch a ring. Without self-contact its walls pass through each other in the end, and
    the warning says so; as long as they are apart there is none."""
    ring = {"shape": "ring", "radius": 0.05, "inner_radius": 0.045, "position": [0, 0],
            "mesh_size": 0.0025, "contact_mesh_size": 0.0025}
    below = {"kind": "circle", "centre": [0, -0.0651], "radius": 0.015}
    above = below | {"centre": [0, 0.0651], "velocity": [0, -2]}
    given = {"law": "neohookean", "young": 2e6, "nu": 0.3, "density": 1000, "accuracy": 0.2,
             "body": [ring], "obstacle": [below, above], "contact": {"self_contact": "off"}}
    apart, crossed = (ran(tmp_path, given | {"end_time": end}, f"{end}") for end in (0.044, 0.0465))
    assert not overlaps(apart)
    sentence, = overlaps(crossed)
    assert 0.044 < float(sentence.split("t = ")[1].split()[0]) <= 0.0465


@pytest.mark.robustness
def test_what_a_file_excludes_is_watched(tmp_path):
    """The curve `contact` of a file has the outer outline alone: the walls of its slot pass through
    each other whatever self_contact says, and the warning says so; a run that fails after that says
    it in its message."""
    given = PINCHED | {"body": [box_file(tmp_path, "outer")], "contact": {"self_contact": "on"}}
    def pinched(end: float):
        given["end_time"] = end
        return run.run(read(given, tmp_path), {}, tmp_path / f"{end}", estimate=False)
    sentence, = overlaps(pinched(1e-3))
    assert "passes through itself" in sentence
    assert "take a file" in sentence and "self_contact" not in sentence
    with pytest.raises(Failure, match="passes through itself .* from t = ") as failed:
        pinched(4e-3)
    assert failed.value.code == 11


@pytest.mark.robustness
def test_a_body_in_a_hole_that_may_not_touch(tmp_path):
    """A disc that first comes to such a wall is refused. Where the box has touched something
    before, the warning names both as the disc goes through."""
    tiny = DISC | {"radius": 5e-4, "mesh_size": 2e-4, "contact_mesh_size": 2e-4}
    inside = tiny | {"position": [0, 0.001], "velocity": [0, -3]}
    given = PINCHED | {"body": [box_file(tmp_path, "outer"), inside], "obstacle": []}
    given["end_time"] = 9.5e-4
    said = r"^body\.1\.file: 'box' comes to 'disc' with \(.*\) m, which may not touch"
    with pytest.raises(BadInput, match=said):
        assembly.prepare(read(given, tmp_path), tmp_path)
    assembly.prepare(read(given | {"end_time": 4e-4}, tmp_path), tmp_path)       # it ends before
    given["body"] = [box_file(tmp_path, "all"), inside]
    assembly.prepare(read(given, tmp_path), tmp_path)
    above = tiny | {"name": "above", "position": [0.03, HIGH / 2 + 6e-4], "velocity": [0, -1]}
    given["body"] = [box_file(tmp_path, "outer"), inside, above]
    sentence, = overlaps(run.run(read(given, tmp_path), {}, tmp_path / "run", estimate=False))
    assert "box and disc pass through each other" in sentence


@pytest.mark.robustness
def test_which_inner_outlines_may_touch(tmp_path):
    """Those of a body that touches itself, or with a body or an obstacle inside; others need no
    contact points. What a file excludes stays out."""
    def inner(body: dict, word: str, **more) -> set[int]:
        given = PINCHED | {"body": [body, *more.get("bodies", [])],
                           "contact": {"self_contact": word},
                           "obstacle": [*PINCHED["obstacle"], *more.get("obstacles", [])]}
        made = assembly.assemble(read(given, tmp_path)).mesh
        own = made.points[made.edges].mean(axis=1)
        in_slot = (abs(own[:, 0]) < 0.49 * WIDE) & (abs(own[:, 1]) < 0.49 * HIGH)
        assert (made.labels[~in_slot] == mesh.FREE).all()
        return set(made.labels[in_slot].tolist())
    fine = {"mesh_size": 5e-4, "contact_mesh_size": 5e-4}
    inside = DISC | fine | {"radius": 0.001, "position": [0.01, 0]}
    pin = {"name": "pin", "kind": "circle", "centre": [0.01, 0], "radius": 0.001}
    for body in (BOX, box_file(tmp_path)):
        assert inner(body, "off") == {mesh.Mesh.NEVER} and inner(body, "auto") == {mesh.FREE}
        assert inner(body, "off", bodies=[inside]) == {mesh.FREE}
        assert inner(body, "off", obstacles=[pin]) == {mesh.FREE}
        assert inner(body, "off", bodies=[inside | {"position": [0.2, 0]}]) == {mesh.Mesh.NEVER}
    assert inner(box_file(tmp_path, "outer"), "on") == {mesh.Mesh.NEVER}


@pytest.mark.robustness
def test_a_disc_stays_in_the_hole_of_a_file(tmp_path):
    """A disc flies against the wall of the slot from inside and pushes the box along."""
    fine = {"mesh_size": 5e-4, "contact_mesh_size": 5e-4}
    disc = DISC | fine | {"radius": 0.001, "velocity": [5, 0], "position": [0.027, 0]}
    given = PINCHED | {"obstacle": [], "body": [box_file(tmp_path), disc], "end_time": 1.5e-3}
    found = run.run(read(given, tmp_path), {}, tmp_path / "run", estimate=False)
    balanced(found)
    h = found.history
    assert h["x_2"].max() < SLOT_WIDE / 2 < 0.027 + 5 * 1.5e-3 and h["momentum_x_1"][-1] > 0
    assert found.summary["impulse"] > 0 and found.summary["max_penetration"] < 1e-4


@pytest.mark.robustness
def test_walls_of_a_cavity(tmp_path):
    """Likewise in three dimensions: on, the walls of a cavity of a file stop each other; by itself
    none is in contact, and the warning says that they pass through each other."""
    wide, slot = 0.05, 0.036
    def box(tag: int, x: float, y: float) -> str:
        return f"Box({tag}) = {{{-x / 2}, {-y / 2}, {-x / 2}, {x}, {y}, {x}}};\n"
    (tmp_path / "box.geo").write_text(
        'SetFactory("OpenCASCADE");\n' + box(1, wide, HIGH) + box(2, slot, SLOT_HIGH)
        + "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n")
    body = {"shape": "mesh", "file": "box.geo", "position": [0, 0, 0], "mesh_size": 0.008,
            "contact_mesh_size": 0.008}
    obstacles = [FLOOR | {"point": [0, -HIGH / 2 - 1e-4, 0], "normal": [0, 1, 0]},
                 {"kind": "sphere", "centre": [0, HIGH / 2 + 0.0201, 0], "radius": 0.02,
                  "velocity": [0, -8, 0]}]
    given = PINCHED | {"dimension": "3d", "degree": 1, "accuracy": 0.3, "body": [body],
                       "obstacle": obstacles, "end_time": 9e-4, "fields": 10}
    def pinched(word: str):
        scene = read(given | {"contact": {"self_contact": word}}, tmp_path)
        return run.run(scene, {}, tmp_path / word, estimate=False)
    on, auto = pinched("on"), pinched("auto")
    assert on.summary["energy_drift"] < 1e-9 and not overlaps(on)
    assert abs(slot_of(on).min()) < 5e-4
    sentence, = overlaps(auto)
    assert slot_of(auto).min() < -5e-4 and "self_contact" in sentence
