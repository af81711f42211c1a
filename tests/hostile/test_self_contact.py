"""Bodies that may come into contact with themselves: when they do, and conservation during this
contact."""

import numpy as np
import pytest

from ffimpact.failure import BadInput, Failure
from ffimpact.mesh import mesh
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly
from tests.support.self_contact import (
    BOX,
    DISC,
    FLOOR,
    HIGH,
    PINCHED,
    RING,
    SCENE,
    SLOT_HIGH,
    SLOT_WIDE,
    WIDE,
    balanced,
    box_file,
    distances,
    overlaps,
    ran,
    read,
    slot_of,
)


@pytest.mark.robustness
def test_a_ring_is_squeezed_flat(tmp_path):
    """A plane compresses a thin ring until less than a sixth of the hole is left.

    Its inner sides are in contact, with folds, and momentum and energy are conserved.
    """
    press = {"name": "press", "kind": "plane", "point": [0, 0.1002], "normal": [0, -1], "velocity": [0, -8]}
    result = ran(tmp_path, SCENE | {"body": [RING | {"velocity": [0, 0]}], "obstacle": [FLOOR, press], "end_time": 10.5e-3, "fields": 12})
    balanced(result)
    hole = distances(result, lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y > 0.02), lambda x, y: (abs(np.hypot(x, y) - 0.044) < 1e-9) & (y < -0.02))
    assert hole[0] > 0.04 and -1e-3 < hole.min() < 1e-3 and result.summary["max_penetration"] < 5e-4


@pytest.mark.robustness
def test_a_hairpin_in_three_dimensions(tmp_path):
    """With linear elements the sides stay apart. Without self_contact = "on" they pass through each
    other."""
    corners = [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]]
    points = "".join(f"Point({k}) = {{{x}, {y}, 0, 0.01}};\n" for k, (x, y) in enumerate(corners, 1)) + "".join(f"Line({k}) = {{{k}, {k % 8 + 1}}};\n" for k in range(1, 9))
    (tmp_path / "pin.geo").write_text(points + "Curve Loop(1) = {1:8}; Plane Surface(1) = {1}; Extrude {0, 0, 0.02} { Surface{1}; }\n")
    body = {"shape": "mesh", "file": "pin.geo", "position": [0, 0.0151, 0], "velocity": [0, -6, 0], "mesh_size": 0.0095, "contact_mesh_size": 0.0095}
    tables = SCENE | {"dimension": "3d", "degree": 1, "accuracy": 0.3, "body": [body], "obstacle": [FLOOR | {"point": [0, 0, 0], "normal": [0, 1, 0]}], "end_time": 1.8e-3, "fields": 20}
    on, off = (run.run(read_scene(tables | {"contact": {"self_contact": word}}, tmp_path, "pin"), {}, tmp_path / word, estimate=False) for word in ("on", "auto"))
    balanced(on)
    slot = distances(on, lambda x, y: (abs(y - 0.005) < 1e-9) & (x > -0.03), lambda x, y: (abs(y + 0.005) < 1e-9) & (x > -0.03))
    assert abs(slot.min()) < 5e-4 and on.summary["max_penetration"] < 2e-4
    assert any(warning.startswith("overlap") and "self_contact" in warning for warning in off.summary["warnings"])


@pytest.mark.robustness
def test_what_a_file_excludes_is_watched(tmp_path):
    """The curve `contact` of a file has the outer outline only: the walls of the slot pass through
    each other for any `self_contact`.

    A warning reports it. If the run fails afterwards, its message contains the warning.
    """
    tables = PINCHED | {"body": [box_file(tmp_path, "outer")], "contact": {"self_contact": "on"}}
    def pinched(end: float):
        tables["end_time"] = end
        return run.run(read(tables, tmp_path), {}, tmp_path / f"{end}", estimate=False)
    sentence, = overlaps(pinched(1e-3))
    assert "passes through itself" in sentence
    assert "take a file" in sentence and "self_contact" not in sentence
    with pytest.raises(Failure, match="passes through itself .* from t = ") as failed:
        pinched(4e-3)
    assert failed.value.code == 11


@pytest.mark.robustness
def test_a_body_in_a_hole_that_may_not_touch(tmp_path):
    """A disc whose first contact would be such a wall is refused.

    If the box was in contact before, the warning has both names when the disc passes through.
    """
    tiny = DISC | {"radius": 5e-4, "mesh_size": 2e-4, "contact_mesh_size": 2e-4}
    inside = tiny | {"position": [0, 0.001], "velocity": [0, -3]}
    tables = PINCHED | {"body": [box_file(tmp_path, "outer"), inside], "obstacle": []}
    tables["end_time"] = 9.5e-4
    message = r"^body\.1\.file: 'box' comes to 'disc' with \(.*\) m, which is no contact boundary"
    with pytest.raises(BadInput, match=message):
        assembly.prepare(read(tables, tmp_path), tmp_path)
    # The run ends before contact.
    assembly.prepare(read(tables | {"end_time": 4e-4}, tmp_path), tmp_path)
    tables["body"] = [box_file(tmp_path, "all"), inside]
    assembly.prepare(read(tables, tmp_path), tmp_path)
    above = tiny | {"name": "above", "position": [0.03, HIGH / 2 + 6e-4], "velocity": [0, -1]}
    tables["body"] = [box_file(tmp_path, "outer"), inside, above]
    sentence, = overlaps(run.run(read(tables, tmp_path), {}, tmp_path / "run", estimate=False))
    assert "box and disc pass through each other" in sentence


@pytest.mark.robustness
def test_which_inner_outlines_may_touch(tmp_path):
    """Inner outlines may be in contact if the body may come into contact with itself or with a body
    or obstacle inside.

    Others have no contact points. Boundaries that a file excludes stay excluded.
    """
    def inner(body: dict, word: str, **more) -> set[int]:
        tables = PINCHED | {"body": [body, *more.get("bodies", [])],
                            "contact": {"self_contact": word},
                            "obstacle": [*PINCHED["obstacle"], *more.get("obstacles", [])]}
        made = assembly.assemble(read(tables, tmp_path)).mesh
        own = made.points[made.edges].mean(axis=1)
        in_slot = (abs(own[:, 0]) < 0.49 * WIDE) & (abs(own[:, 1]) < 0.49 * HIGH) & (made.labels != mesh.AXIS)
        assert (made.labels[~in_slot & (made.labels != mesh.AXIS)] == mesh.FREE).all()
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
    """A disc strikes the wall of the slot from inside and pushes the box. The momentum of the small disc
    is conserved to the tolerance of the steps, for the residual of the large box."""
    fine = {"mesh_size": 5e-4, "contact_mesh_size": 5e-4}
    disc = DISC | fine | {"radius": 0.001, "velocity": [5, 0], "position": [0.027, 0]}
    tables = PINCHED | {"obstacle": [], "body": [box_file(tmp_path), disc], "end_time": 1.5e-3, "tolerance": 1e-12}
    result = run.run(read(tables, tmp_path), {}, tmp_path / "run", estimate=False)
    balanced(result)
    h = result.history
    assert h["x_2"].max() < SLOT_WIDE / 2 < 0.027 + 5 * 1.5e-3 and h["momentum_x_1"][-1] > 0
    assert result.summary["impulse"] > 0 and result.summary["max_penetration"] < 1e-4


@pytest.mark.robustness
def test_walls_of_a_cavity(tmp_path):
    """In three dimensions, with `self_contact` on, the walls of a cavity of a file stop each other.

    By default none is in contact, and a warning reports that they pass through each other.
    """
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
    tables = PINCHED | {"dimension": "3d", "degree": 1, "accuracy": 0.3, "body": [body],
                        "obstacle": obstacles, "end_time": 9e-4, "fields": 10}
    def pinched(word: str):
        scene = read(tables | {"contact": {"self_contact": word}}, tmp_path)
        return run.run(scene, {}, tmp_path / word, estimate=False)
    on, auto = pinched("on"), pinched("auto")
    assert on.summary["energy_drift"] < 1e-9 and not overlaps(on)
    assert abs(slot_of(on).min()) < 5e-4
    sentence, = overlaps(auto)
    assert slot_of(auto).min() < -5e-4 and "self_contact" in sentence
