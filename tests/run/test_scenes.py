"""Scenes of several bodies by every interface: disc-block, a TOML file, direct runs, sweeps,
figures."""

import hashlib
import json
import math
import subprocess

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.failure import BadInput, Failure
from ffimpact.freefem import arrays, freefem
from ffimpact.input import parameters
from ffimpact.input.toml_text import to_toml
from ffimpact.mesh import mesh
from ffimpact.output import estimate, vtu
from ffimpact.output.evaluate import evaluate
from ffimpact.report import bodies, drawing, figures, impacts, report
from ffimpact.running import run
from ffimpact.scene import read as read_scene
from ffimpact.scenes import assembly, finer
from ffimpact.sweeps import sweep

MINE = {"title": "A disc meets a soft one and a moving post", "law": "neohookean", "young": 7e6, "nu": 0.4, "density": 1722, "accuracy": 0.4, "fields": 3,
        "body": [{"name": "striker", "shape": "disc", "radius": 0.05, "position": [-0.052, 0], "velocity": [4, 0]},
                 {"name": "target", "shape": "disc", "radius": 0.04, "position": [0.04, 0], "young": 4e6}],
        "obstacle": [{"name": "post", "kind": "circle", "centre": [0.11, 0], "radius": 0.02, "velocity": [-1, 0]}],
        "contact": {"friction_static": 0.2, "pair": [{"bodies": ["target", "post"], "friction_static": 0}]}}


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    """Half of disc-block, coarse."""
    result = run.run(scene.load("disc-block"), {"accuracy": 0.4, "fields": 3}, tmp_path_factory.mktemp("block") / "run")
    report.draw(result)
    return result


@pytest.fixture(scope="module")
def mine(tmp_path_factory):
    """A run of the file above, and the path of the file."""
    folder = tmp_path_factory.mktemp("mine")
    (folder / "mine.toml").write_text(to_toml(MINE))
    result = run.run(scene.load(str(folder / "mine.toml")), {}, folder / "run")
    report.draw(result)
    return result, folder / "mine.toml"


# ---- disc-block

def test_each_body_has_its_columns_and_numbers(block):
    """history.csv and summary.json have the described columns and numbers of two bodies. The totals
    are sums over the bodies."""
    problem, h, s = scene.load("disc-block"), block.history, block.summary
    assert list(h) == problem.columns and {"vy_1", "vy_2", "kinetic_1"} <= set(h) and block.scene["body"][1]["width"] == 10
    assert set(problem.numbers) <= set(s) and s["provenance"]["script"] == "bodies" and s["estimated_error"] is not None
    for name in ("kinetic", "elastic", "momentum_y"):
        assert h[name] == pytest.approx(h[f"{name}_1"] + h[f"{name}_2"], rel=1e-9, abs=1e-9 * abs(h[name]).max())
    assert s["mass_1"] == pytest.approx(1722 * np.pi * 0.25, rel=1e-2) and s["mass_2"] == pytest.approx(1722 * 20, rel=1e-9)


def test_what_one_body_loses_the_other_gains(block):
    """Without external forces the total momentum is constant, each body's changes by its impulse,
    and energy is conserved."""
    h, s = block.history, block.summary
    assert np.ptp(h["momentum_y"]) < 1e-9 * abs(h["momentum_y"]).max()
    # The resultant.
    assert s["impulse_y_1"] == pytest.approx(-s["impulse_y_2"], rel=1e-9) and s["impulse_y_1"] == pytest.approx(s["impulse"], rel=1e-6)
    assert s["mass_1"] * (s["rebound_vy_1"] + 10) == pytest.approx(s["impulse_y_1"], rel=1e-6)
    assert s["rebound_vy_1"] > 0 > s["rebound_vy_2"] and s["energy_drift"] < 1e-8
    assert h["force_y_1"] == pytest.approx(-h["force_y_2"], abs=1e-6 * h["normal_force"].max())


def test_lost_ellipticity_is_a_warning(block):
    """St. Venant-Kirchhoff beyond its range gives a warning for two bodies as for one. A law that
    keeps ellipticity does not."""
    hard = run.run(scene.load("disc-block"), {"accuracy": 0.2, "body.1.speed": 18, "fields": 0, "breakdown": "continue"}, block.folder.parent / "hard", estimate=False)
    assert hard.summary["ellipticity_lost_time"] > 0 and any(
        warning.startswith("ellipticity: lost from") for warning in hard.summary["warnings"])
    assert block.summary["ellipticity_lost_time"] is None and not any(
        warning.startswith("ellipticity") for warning in block.summary["warnings"])


# ---- a scene file

def test_the_folder_of_a_scene_of_ones_own(mine, tmp_path):
    """Mesh, data file and scene as used, with the checksum of the mesh, read back as the same
    scene, which is reused.

    FreeFEM recognised each body with its place and material.
    """
    result, path = mine
    s, h = result.summary, result.history
    assert (s["mass_1"], s["mass_2"]) == pytest.approx((1722 * math.pi * 0.05**2, 1722 * math.pi * 0.04**2), rel=1e-4)
    assert (h["x_1"][0], h["y_1"][0], h["x_2"][0], h["y_2"][0], h["vx_1"][0], h["vx_2"][0]) == pytest.approx((-0.052, 0, 0.04, 0, 4, 0), abs=1e-5)
    assert {"mesh.msh", "scene.bin", "scene.toml", "history.csv", "summary.json", "fields.pvd"} <= {file.name for file in result.folder.iterdir()}
    assert s["provenance"]["mesh"] == hashlib.sha256((result.folder / "mesh.msh").read_bytes()).hexdigest() and s["provenance"]["gmsh"]
    assembly.prepare(scene.load(str(result.folder / "scene.toml")), tmp_path)
    assert (tmp_path / "scene.bin").read_bytes() == (result.folder / "scene.bin").read_bytes()
    assert run.run(scene.load(str(path)), {}, result.folder).reused
    assert not run.reusable(scene.load(str(path)).override({"body.2.young": 5e6}), result.folder)
    assert s["rebound_vx_2"] != 0 and s["energy_drift"] < 1e-8 and s["estimated_error"] is not None


@pytest.mark.robustness
def test_entries_are_set_on_the_command_line(mine, capsys):
    """--set body.2.young=... is in the scene as used, and a direct run with the files of the folder
    gives the same results."""
    result, path = mine
    out = path.parent / "set"
    assert main(["run", str(path), "--set", "body.2.young=8e6", "fields=0", "--out", str(out), "--quiet", "--no-figures"]) == 0, capsys.readouterr().err
    other = json.loads((out / "summary.json").read_text())
    assert other["impulse"] > result.summary["impulse"] and run.read_scene(out)["body"][1]["young"] == 8e6
    direct = freefem_run("-scene", str(out / "scene.bin"), "-out", str(path.parent / "direct"))
    assert direct.returncode == 0, direct.stderr
    evaluate(path.parent / "direct")
    assert json.loads((path.parent / "direct/summary.json").read_text())["impulse"] == pytest.approx(other["impulse"], rel=1e-9)


@pytest.mark.robustness
def test_a_killed_run_goes_on(mine, monkeypatch):
    """A run of bodies that ends at a checkpoint continues from it with the same results."""
    original, path = mine
    problem, real = scene.load(str(path)).override({"checkpoint_every": 5}), freefem.Process.end

    def killed(process, progress=None, every=0.0):
        while not (out.with_name("killed.part") / "checkpoint").exists() and process.child.poll() is None:
            pass
        process.child.kill()
        return real(process, progress)
    monkeypatch.setattr(freefem.Process, "end", killed)
    out = path.parent / "killed"
    with pytest.raises(Failure, match="goes on from the last checkpoint"):
        run.run(problem, {}, out, estimate=False)
    monkeypatch.setattr(freefem.Process, "end", real)
    result = run.run(problem, {}, out, estimate=False)
    assert result.summary["resumed_at"] > 0
    assert result.summary["impulse"] == pytest.approx(original.summary["impulse"], rel=1e-9)


@pytest.mark.robustness
def test_a_sweep_reaches_every_entry(mine):
    """Axes have dotted names, in quotes or not. The table has the numbers of each body."""
    path = mine[1].with_name("sweep.toml")
    path.write_text('scene = "mine.toml"\ncollect = ["rebound_vx_1", "rebound_vx_2"]\n[set]\nfields = 0\n[product]\nbody.2.young = [2e6, 8e6]\n'
                    '"contact.penalty" = [5e9]\n[figure]\nx = "body.2.young"\ny = "rebound_vx_2"\n')
    plan = sweep.load(str(path))
    assert plan.points == [{"body.2.young": 2e6, "contact.penalty": 5e9}, {"body.2.young": 8e6, "contact.penalty": 5e9}]
    rows = sweep.collect(plan, path.parent / "sweep")
    assert (rows.exit == 0).all() and rows.rebound_vx_2.nunique() == 2 and (path.parent / "sweep/sweep.png").exists()
    for text, words in (("body.3.young = [1e6]", "body.3.young: there is no body.3 in the scene"), ("body.2.yung = [1e6]", "body.2.yung: no such entry, set to "),
                        ("body.1.velocity = [[1, 0], [2, 0]]", "single numbers and words"), ("radius = [1]", "radius: no such entry, set to ")):
        path.write_text(f'scene = "mine.toml"\n[product]\n{text}\n')
        with pytest.raises(BadInput, match=words):
            sweep.load(str(path))


def test_coarser_and_finer_elements(mine):
    """The scene for another mesh has larger elements on every meshed body by this factor, and the
    same contact."""
    problem = scene.load(str(mine[1]))
    used = run.read_scene(mine[0].folder)
    built = assembly.assemble(problem.override(finer.scaled(problem, used, 0.5)))
    assert [body["mesh_size"] for body in built.used["body"]] == [0.5 * body["mesh_size"] for body in used["body"]]
    assert built.used["contact"] == used["contact"] and built.values["accuracy"] == 0.25 * used["accuracy"]
    assert len(built.mesh.triangles) > 2 * len(assembly.assemble(problem).mesh.triangles)


@pytest.mark.parametrize("factor, kept", [(estimate.COARSER, False), (1 / estimate.COARSER, True)])
def test_a_finer_run_keeps_what_a_scene_asks_for(mine, factor, kept):
    """Only the coarser run writes no output, as it
    is only compared."""
    requests = {"fields": 5, "modes": 4, "checkpoint_every": 7}
    problem = scene.load(str(mine[1])).override(requests)
    other = problem.override(finer.scaled(problem, run.read_scene(mine[0].folder), factor))
    assert {name: other.values[name] for name in requests} == requests | ({} if kept else parameters.OUTPUT)


# ---- figures

@pytest.mark.parametrize("which", ["block", "mine"])
def test_figures_of_several_bodies(which, request):
    """Energies, velocities, forces, shapes and pressure are drawn, and restitution if there are
    several impacts. The title has the materials."""
    result = request.getfixturevalue(which)
    result = result[0] if which == "mine" else result
    drawn = {path.name for path in (result.folder / "figures").iterdir()}
    assert drawn - {"bounces.png"} == {"contact.png", "energies.png", "force.png", "shapes.png", "velocity.png"}
    assert ("bounces.png" in drawn) == (len(impacts.several(impacts.read(result.folder))) > 0)
    assert all(path.stat().st_size > 5000 for path in (result.folder / "figures").iterdir())
    assert ("target: neo-Hookean, E = 4 MPa" if which == "mine" else "disc, block: St. Venant") in drawing.title(result.scene)
    assert "rebound velocity, " + ("x, target" if which == "mine" else "y, block") in report.report(result, verbose=True)


def test_bodies_are_drawn_where_they_are(mine):
    """The displacement moves the bodies from their reference places, side by side, to those of the
    scene. The post moves, too."""
    result = mine[0]
    t, path = vtu.series(result.folder / "fields.pvd")[-1]
    points = figures.deformed(vtu.read(path), False).points
    x_min, x_max, *_ = bodies.limits([figures.deformed(vtu.read(path), False)])
    xs = [np.interp(t, result.history["t"], result.history[f"x_{b}"]) for b in (1, 2)]
    assert points[:, 0].min() == pytest.approx(xs[0] - 0.05, abs=0.004) and x_min < points[:, 0].min() < points[:, 0].max() < x_max
    assert bodies.obstacles_of(result.scene)[0].start_velocity.tolist() == [-1, 0]


# ---- what is refused

def freefem_run(*flags: str, script: str = "bodies") -> subprocess.CompletedProcess:
    return freefem.find().call(f"edp/program/{script}.edp", *flags)


@pytest.mark.parametrize("words, message", [
    (("disc-normal", "--set", "block_width=3"), "block_width: is no entry any more (accepted: body.2.width)"),
    (("disc-normal", "--set", "angle=60"), "angle: is no entry any more (accepted: body.1.direction, the angle from the x axis: -60 for an impact at 60 degrees)"),
    (("disc-normal", "--set", "height=1"), "height: is no entry any more (accepted: body.1.position"),
    (("disc-block", "--set", "speed=4"), "speed: no such entry, set to '4'; did you mean body.1.speed?"),
    (("two-discs", "--mesh", "MESH"), "--mesh: is no option any more (accepted: in a table [[body]], shape = 'mesh' with file)"),
    (("two-discs", "--set", "body.3.young=1e6"), "body.3.young: there is no body.3 in the scene (accepted: body.1 to body.2)"),
    (("two-discs", "--set", "radius=1"), "radius: no such entry, set to '1'"),
    (("two-discs", "--set", "body.1.position=[0,0]"), "body.1.position: 'left' overlaps 'right' (body.2)"),
    (("two-discs", "--set", "contact.friction_dynamic=0.5"), "contact.friction_dynamic: 0.5 is larger than friction_static 0.3"),
])
def test_what_python_refuses(words, message, tmp_path, capsys):
    """Exit code 10, one line, no files left."""
    (tmp_path / "m.msh").write_text("4 2 4\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n1 2 3 0\n1 3 4 0\n1 2 1\n2 3 1\n3 4 1\n4 1 1\n")
    code = main(["run", *(str(tmp_path / "m.msh") if word == "MESH" else word for word in words), "--out", str(tmp_path / "out"), "--quiet"])
    error = capsys.readouterr().err
    assert code == 10 and error.count("\n") == 1 and message in error, error
    assert [path.name for path in tmp_path.iterdir()] == ["m.msh"]


def test_one_body_and_nothing_else(tmp_path):
    """A body without anything to come into contact with, and without an end_time, is refused."""
    alone = dict(law="svk", young=7e6, nu=0.4, density=1000, body=[dict(shape="disc", radius=0.1, position=[0, 0], velocity=[0, -1])])
    with pytest.raises(BadInput, match="^obstacle: is missing, and a second body too"):
        assembly.prepare(read_scene(alone, tmp_path, "alone"), tmp_path)


FALLING = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1722, "accuracy": 0.1, "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}]}


def test_a_shaft_of_a_file_has_its_flats(tmp_path):
    """A coarse mesh of a shaft with two flats, with all corners on one circle, has the mass of arcs
    and flats, which the log counts.

    When it falls on an end of a flat it rotates as it rebounds, unlike a disc. No estimate contains
    what the mesh leaves out.
    """
    radius, flat = 0.01, math.acos(0.6)
    angles = np.concatenate([np.linspace(side + flat, side + math.pi - flat, 8) for side in (0, math.pi)])
    spokes = np.column_stack([np.full(16, 16), np.arange(16), np.roll(np.arange(16), -1)])
    points = np.vstack([radius * np.column_stack([np.cos(angles), np.sin(angles)]), [0, 0]])
    mesh.write(mesh.Mesh(points, spokes, spokes[:, 1:], np.ones(16, dtype=int)), tmp_path / "shaft.msh")
    body = {"name": "shaft", "shape": "mesh", "file": "shaft.msh", "position": [0, 0.0101], "velocity": [0, -2], "angle": 60}
    result = run.run(read_scene(FALLING | {"body": [body], "end_time": 3e-3}, tmp_path, "shaft"), {}, tmp_path / "run")
    assert result.summary["estimated_error_excludes"][-1] == "mesh" and any("those of the time step" in sentence or "not estimated" in sentence for sentence in result.summary["warnings"] + result.summary["notes"])
    area = radius**2 * (math.pi - 2 * flat + math.sin(2 * flat))
    assert result.summary["energy_initial"] == pytest.approx(area * 1722 * 2, rel=1e-4) and abs(result.summary["rebound_spin"]) > 50
    made = arrays.unpacked((result.folder / "scene.bin").read_bytes())
    assert np.bincount(made["mesh.arc_of"].ravel() + 1).tolist() == [2, 14] and (made["mesh.labels"] == 1).all()
    # 0.3 % more than the file.
    assert not any(warning.startswith("mass") for warning in result.summary["warnings"])


def test_bodies_turn_about_their_stated_centre(tmp_path):
    """A coarse ellipse rotated by 90 degrees and one with exchanged semi-axes are the same body,
    although the centre of mass of the mesh is 0.06 mm off.

    They come into contact at the same time, and their positions agree to round-off.
    """
    results = []
    for axes, angle in (([0.06, 0.03], 0), ([0.03, 0.06], 90)):
        body = {"shape": "ellipse", "semi_axes": axes, "angle": angle, "position": [0, 0.031], "velocity": [0, -1], "mesh_size": 0.015}
        results.append(run.run(read_scene(FALLING | {"symmetry": "full", "body": [body], "end_time": 1.1e-3}, tmp_path, "ellipse"), {}, tmp_path / str(angle), estimate=False))
    first, second = results
    assert first.summary["contact_start"] == pytest.approx(second.summary["contact_start"], rel=1e-9)
    assert second.history["y"] == pytest.approx(first.history["y"], abs=1e-12) and abs(second.history["x"]).max() < 1e-12


def test_a_body_that_passes_through_itself_is_warned_about(tmp_path):
    """Without self-contact the free arm of a hairpin closes its slot of 10 mm at 6 m/s and passes
    into the other arm.

    A warning has the time, not before 10 mm / 12 m/s, and the place on a wall of the slot. While
    the slot is open, there is none.
    """
    pin = {"shape": "polygon", "vertices": [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]],
           "position": [0, 0.0151], "velocity": [0, -6], "mesh_size": 0.009, "contact_mesh_size": 0.009}
    for end, words in ((4e-3, "overlap: the body passes through itself from t = "), (8e-4, "")):
        result = run.run(read_scene(FALLING | {"body": [pin], "end_time": end, "contact": {"self_contact": "off"}}, tmp_path, "pin"), {}, tmp_path / "pin", estimate=False)
        warned = [warning for warning in result.summary["warnings"] if "overlap" in warning]
        assert len(warned) == (words != "")
        for sentence in warned:
            assert sentence.startswith(words) and 8e-4 < float(sentence.split("t = ")[1].split()[0]) < 4e-3
            x, y = map(float, sentence.split("X = (")[1].split(")")[0].split(", "))
            assert abs(y) == pytest.approx(0.005, abs=1e-3)


@pytest.mark.parametrize("dimension, shape, zeros", [("plane-strain", "disc", 0), ("axisymmetric", "ball", 0), ("3d", "ball", 1)])
def test_bodies_that_never_meet(tmp_path, dimension, shape, zeros):
    """Refused before meshing: bodies at rest, and bodies that fly apart if end_time is automatic,
    only then."""
    def prepare(up: float, **more) -> None:
        def body(name: str, y: float, v: float) -> dict:
            return dict(name=name, shape=shape, radius=0.02, position=[0, y] + zeros * [0], velocity=[0, v] + zeros * [0])
        tables = dict(dimension=dimension, law="neohookean", young=1e6, nu=0.3, density=1000, accuracy=0.4, body=[body("above", 0.05, up), body("below", 0, 0)])
        assembly.prepare(read_scene(tables | more, tmp_path, "two"), tmp_path)

    with pytest.raises(BadInput, match="^velocity: 0 of every body"):
        prepare(0)
    for more in ({}, {"gravity": 9.81}):  # both fall equally
        with pytest.raises(BadInput, match="^end_time: 0 is the end of the contact, but no bodies ever come into contact"):
            prepare(1, **more)
    assert not list(tmp_path.iterdir())
    prepare(1, end_time=0.01)
    prepare(-1)


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """scene.bin of two discs in contact."""
    folder = tmp_path_factory.mktemp("it's a tést")
    assembly.assemble(scene.load("two-discs").override({"accuracy": 0.4, "end_time": 1e-5})).write(folder)
    return folder / "scene.bin"


def other_byte(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1:]


DAMAGED = "is damaged or of another version (accepted: the file that `python -m ffimpact run` prepares)"
WRONG = {
    "empty": (lambda data: b"", DAMAGED), "text": (lambda data: b"ffimpact-bodies 1\ncopies 1\n" * 9, DAMAGED),
    "another version": (lambda data: b"ffinput2" + data[8:], DAMAGED), "cut": (lambda data: data[:-1], DAMAGED), "cut in its head": (lambda data: data[:20], DAMAGED),
    "longer": (lambda data: data + b"\0", DAMAGED), "altered head": (lambda data: other_byte(data, 12), DAMAGED), "altered name": (lambda data: other_byte(data, 30), DAMAGED),
    "altered number": (lambda data: other_byte(data, len(data) // 2), DAMAGED), "altered end": (lambda data: other_byte(data, len(data) - 1), DAMAGED),
    "missing": (None, "' cannot be read (accepted: -scene FILE, which `python -m ffimpact run` prepares)"),
    "of another script": (lambda data: changed_entries(data, script="bodies-3d"), "' is of the script bodies-3d (accepted: of bodies)"),
    "without an entry": (lambda data: changed_entries(data, young=1.0, gravity=None), "its file has no real entry 'gravity' (accepted: the file that"),
    "of another kind": (lambda data: changed_entries(data, gravity="none"), "its file has no real entry 'gravity' (accepted: the file that"),
}


def changed_entries(data: bytes, **changed) -> bytes:
    return arrays.packed({name: value for name, value in (arrays.unpacked(data) | changed).items() if value is not None})


@pytest.mark.few(5)
@pytest.mark.parametrize("case", WRONG)
def test_what_a_direct_run_refuses(case, inputs, tmp_path):
    """bodies.edp with a damaged or foreign scene file: exit code 10, one line, no files left."""
    change, message = WRONG[case]
    if change:
        (tmp_path / "scene.bin").write_bytes(change(inputs.read_bytes()))
    done = freefem_run("-scene", str(tmp_path / "scene.bin"), "-out", str(tmp_path / "out"))
    assert done.returncode == 10 and message in done.stderr and done.stderr.count("\n") == 1 and done.stderr.startswith("ffimpact: scene: "), done.stderr
    assert not (tmp_path / "out").exists()


def test_the_scene_without_a_fault_runs(inputs, tmp_path):
    """The file of the test above, written again from its entries, runs, in a folder with an odd name."""
    copy = inputs.with_name("copy.bin")
    copy.write_bytes(changed_entries(inputs.read_bytes()))
    for path in (inputs, copy):
        done = freefem_run("-scene", str(path), "-out", str(tmp_path / path.name))
        assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "scene.bin/history.csv").read_bytes() == (tmp_path / "copy.bin/history.csv").read_bytes()


@pytest.mark.few(2)
@pytest.mark.parametrize("flags, message", [
    (("-out", "out"), "scene: the file '' cannot be read (accepted: -scene FILE"), (("-radius", "1"), "'-radius': no flag, or without its value (accepted: -scene FILE, -out FOLDER, -restart FILE"),
    (("-scene",), "'-scene': no flag, or without its value"), (("scene.bin",), "'scene.bin': no flag")])
def test_other_flags_are_refused(flags, message):
    """A direct run refuses words that are no flags of it, with exit code 10."""
    done = freefem_run(*flags)
    assert done.returncode == 10 and message in done.stderr and done.stderr.count("\n") == 1


# ---- dependent entries

@pytest.mark.parametrize("name, entries, opened, kept", [
    ("disc-oblique", {"friction_static": "0.3"}, {"friction_dynamic": 0.3}, {"penalty": 1e10, "slip_velocity": 0.1}),
    ("disc-oblique", {"friction_static": 0.8}, {"friction_dynamic": 0.8}, {"penalty": 1e10}),
    ("disc-oblique", {"friction_static": 0.8, "friction_dynamic": 0.6}, {"friction_dynamic": 0.6}, {}),
    ("disc-oblique", {"speed": 4, "nu": 0.3, "law": "svk", "accuracy": 0.1}, {}, {"penalty": 1e10, "friction_dynamic": 0.5, "slip_velocity": 0.1}),
    ("disc-normal", {"young": 5e6, "density": 1100}, {"penalty": "auto"}, {}), ("disc-normal", {"exponent": 1.5}, {"penalty": "auto"}, {}),
    ("disc-normal", {"young": 5e6, "penalty": 3e9}, {"penalty": 3e9}, {}), ("ball", {"young": 5e6}, {"penalty": "auto"}, {}),
    ("disc-rolling", {"radius": 0.5, "position": [0, 0.5]}, {"mesh_size": 0, "contact_mesh_size": 0, "penalty": "auto"}, {"end_time": 0.2}),
    ("disc-normal", {"position": [0, 0.06]}, {}, {"penalty": 1e10})])
def test_what_a_scene_fixed_for_its_own_follows(name, entries, opened, kept):
    """If material, size or static friction of a built-in scene is set alone, its dependent entries
    become automatic, and a sentence reports it.

    All other entries stay.
    """
    before = scene.load(name)
    after = before.override(entries)
    used = assembly.assemble(after).used
    values = used | used["contact"] | after.values | after.sizes | {name: value for name, value in after.contact_values.items() if value == "auto"}
    assert all((after.contact_values[entry] == "auto" if value == "auto" else values[entry] == value) or used["contact"].get(entry) == value for entry, value in opened.items())
    assert all(used["contact"].get(entry, after.values.get(entry)) == value for entry, value in kept.items())
    freed = set(opened) - set(entries)
    assert len(after.released) == len(freed) and all(any(f"{entry} is reset to automatic" in message for message in after.released) for entry in freed)


def test_the_parameters_of_a_law_belong_to_it(tmp_path):
    """Another law does not inherit them; the same law keeps them."""
    file = tmp_path / "scene.toml"
    file.write_text('law = "ogden"\nalpha = [2]\nmu = [2.5e6]\nyoung = 7e6\nnu = 0.4\ndensity = 1722\n[[body]]\nshape = "disc"\nradius = 0.05\n'
                    'position = [0, 0.06]\nvelocity = [0, -2]\n[[obstacle]]\nkind = "plane"\npoint = [0, 0]\nnormal = [0, 1]\n')
    other = scene.load(str(file)).override({"law": "neohookean"})
    assert other.bodies[0].made_of.numbers == [] and [line.partition(" ")[0] for line in other.released] == ["alpha", "mu"]
    assert scene.load(str(file)).override({"density": 900}).bodies[0].made_of.numbers == [2, 1]


def test_what_a_scene_of_bodies_fixed_follows():
    """The same for dotted names: coefficients in their table, sizes in their body, the penalty of
    any material.

    A pair's friction_static alone sets both coefficients, too.
    """
    bowl = scene.load("disc-bowl")
    after = bowl.override({"contact.friction_static": "0.3"})
    assert after.contact_values["friction_dynamic"] == "auto" and after.released == ("contact.friction_dynamic is reset to automatic: the value 0.4 of the scene belonged to its own contact.friction_static",)
    stiff = bowl.override({"contact.penalty": 1e9, "dt": 1e-4})
    assert not stiff.released and stiff.override({"body.1.velocity": [0, -1], "gravity": 1}).contact_values["penalty"] == 1e9
    for name, value in (("body.1.young", 1e6), ("young", 1e6), ("contact.exponent", 1.5)):
        assert stiff.override({name: value}).contact_values["penalty"] == "auto"
    assert (stiff.override({"young": 1e6}).values["dt"], stiff.override({"contact.exponent": 2}).values["dt"]) == (0, 1e-4)
    larger = bowl.override({"body.1.radius": 0.04})
    assert larger.bodies[0].bulk_size == larger.bodies[0].contact_size == 0 and len(larger.released) == 2
    assert bowl.override({"body.1.radius": 0.04, "body.1.mesh_size": 0.01, "body.1.contact_mesh_size": 0.01}).released == ()
    own = read_scene(bowl.content | {"obstacle": [bowl.content["obstacle"][0] | {"friction_static": 0.2}]}, bowl.folder, "bowl")
    assert assembly.assemble(own).used["contact"]["pair"][0]["friction_dynamic"] == 0.2


def test_a_sweep_over_friction_sets_both(tmp_path):
    """Every point of an axis friction_static has one coefficient if the dynamic one is not set;
    else it has two."""
    for more, expected in (("", [0.7, 0.3]), ("[set]\nfriction_dynamic = 0.2\n", [0.2, 0.2])):
        (tmp_path / "friction.toml").write_text(f'scene = "disc-oblique"\n{more}[product]\nfriction_static = [0.7, 0.3]\n')
        plan = sweep.load(str(tmp_path / "friction.toml"))
        assert [assembly.assemble(scene.load(plan.scene).override(plan.base | point)).values["friction_dynamic"] for point in plan.points] == expected
