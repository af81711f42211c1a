"""The run contract: one scene, one run, one folder; what is kept, reused and refused."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import Failure, NotInstalled, Unreadable
from ffimpact.freefem import freefem
from ffimpact.freefem.describe import describe
from ffimpact.mesh import mesh
from ffimpact.output import folder, results
from ffimpact.report import figures
from ffimpact.running import run


def go(out: Path, overrides: dict | None = None, **options) -> results.RunResult:
    return run.run(scene.load("disc-normal"), {"fields": 0} | (overrides or {}), out, **{"estimate": False} | options)


def test_finished_run_is_complete(fake, tmp_path):
    """A finished run has the whole folder, a summary with provenance, and leaves no staging folder."""
    result = go(tmp_path / "out", {"fields": 2})
    assert {"scene.toml", "history.csv", "summary.json", "log.txt", "mesh.msh", "fields.pvd", "fields"} == {
        p.name for p in result.folder.iterdir()}
    assert set(result.summary["provenance"]) == {"script", "version", "asked", "git", "code", "freefem", "gmsh", "mesh", "estimate", "files"}
    assert result.summary["status"] == "ok" and not result.reused
    assert result.history["t"].shape == (200,) and result.scene["speed"] == 8.0
    assert not list(tmp_path.glob("out.*"))


def test_python_takes_numbers_of_numpy_and_paths_as_text(fake, tmp_path):
    """Scripts loop over np.linspace, and name folders and scenes as they like."""
    found = run.run(scene.load(Path("disc-normal")), {"speed": np.linspace(1, 4, 2)[1], "fields": np.int64(2)}, str(tmp_path / "out"), estimate=False)
    assert found.scene["speed"] == 4 and found.scene["fields"] == 2 and found.folder == tmp_path / "out"


def test_mesh_has_the_described_sizes(fake, tmp_path):
    """The mesh that Python makes has the sizes that the scripts describe."""
    used = go(tmp_path / "out").scene
    m = mesh.read(tmp_path / "out/mesh.msh")
    length = np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1)
    wanted = describe({name: value for name, value in used.items() if name != "script"})["used"]
    assert wanted["contact_mesh_size"] == pytest.approx(length.min(), rel=0.2) and wanted["mesh_size"] == pytest.approx(length.max(), rel=0.3)


@pytest.mark.parametrize("given, half", [
    ({}, True), ({"angle": 60}, False), ({"spin": 1}, False), ({"symmetry": "full"}, False), ({"symmetry": "half"}, True)])
def test_half_is_meshed_where_it_is_enough(fake, tmp_path, given, half):
    """Half a disc is meshed unless direction, spin or the user ask for the whole."""
    m = mesh.read(go(tmp_path / "out", given).folder / "mesh.msh")
    assert (m.points[:, 0].min() >= 0) == half


def test_same_scene_and_code_is_reused(fake, tmp_path, monkeypatch):
    """The same run is not run again; another parameter, other code, another mesh or --force run again."""
    out = tmp_path / "out"
    go(out)
    assert go(out).reused and fake.starts() == 1
    assert not go(out, {"speed": 7}).reused
    assert go(out, {"speed": "7.0"}).reused
    assert not go(out, {"speed": 7}, force=True).reused
    own = tmp_path / "own.msh"
    mesh.write(mesh.disc(0.05, 0.02, 0.01, True), own)
    assert not go(out, mesh_file=own).reused
    assert go(out, mesh_file=own).reused
    mesh.write(mesh.disc(0.05, 0.02, 0.005, True), own)
    assert not go(out, mesh_file=own).reused
    assert not go(out).reused
    monkeypatch.setattr(run, "code_hash", lambda: "other")
    assert not go(out).reused
    assert fake.starts() == 7


def test_run_without_python_is_not_reused(fake, tmp_path):
    """A folder that FreeFem++ wrote without us has no provenance: it is run again and replaced."""
    result = go(tmp_path / "out")
    summary = result.summary.copy()
    del summary["provenance"]
    (result.folder / "summary.json").write_text(json.dumps(summary))
    assert not go(tmp_path / "out").reused


@pytest.mark.few(4)
@pytest.mark.parametrize("mode, code, words", [
    ("step", 11, "^step: no convergence at t = 1.2e-3 s"),
    ("material", 12, "^material: det F = -0.1"),
    ("chatter", 11, "^chatter$"),
    ("plugin", 13, "plugin.*Element_QF.*make setup"),
    ("crash", 1, "killed by SIGABRT.*some assertion failed"),
    ("nan", 1, "history.csv: elastic is not finite from row 8"),
    ("silent", 1, "without a result: summary.json cannot be read"),
])
def test_failed_run_keeps_its_files_and_no_summary(fake, tmp_path, mode, code, words):
    """A failed run ends with the script's line and code, keeps log, scene and failure.json, and never looks finished."""
    fake(mode)
    with pytest.raises(Failure, match=words) as error:
        go(tmp_path / "out")
    assert error.value.code == code and error.value.folder == tmp_path / "out"
    kept = {p.name for p in (tmp_path / "out").iterdir()}
    assert {"log.txt", "scene.toml", "failure.json"} <= kept and "summary.json" not in kept
    record = json.loads((tmp_path / "out/failure.json").read_text())
    assert record["status"] != "ok" and record["message"] and record["exit_code"] == code
    assert not list(tmp_path.glob("out.*"))
    fake("ok")
    assert go(tmp_path / "out").summary["status"] == "ok"
    assert not (tmp_path / "out/failure.json").exists()


def test_failure_does_not_cost_an_earlier_result(fake, tmp_path):
    """A failing run in the folder of a finished one leaves that one alone and keeps its own files beside it."""
    go(tmp_path / "out")
    before = (tmp_path / "out/summary.json").read_bytes()
    fake("step")
    with pytest.raises(Failure) as error:
        go(tmp_path / "out", {"speed": 9})
    assert (tmp_path / "out/summary.json").read_bytes() == before
    assert error.value.folder == tmp_path / "out.failed" and (tmp_path / "out.failed/failure.json").exists()
    assert go(tmp_path / "out").reused


def test_left_over_of_a_killed_run_is_replaced(fake, tmp_path):
    """What a killed run left in the staging folder does not get into a result."""
    (tmp_path / "out.part/fields").mkdir(parents=True)
    (tmp_path / "out.part/summary.json").write_text('{"status": "ok"}')
    (tmp_path / "out.part/fields/old.vtu").write_text("")
    (tmp_path / "out.part/checkpoint.json").write_text("{}")
    fake("silent")
    with pytest.raises(Failure, match="without a result"):
        go(tmp_path / "out")
    assert not (tmp_path / "out/summary.json").exists() and not (tmp_path / "out/fields/old.vtu").exists()


def test_a_finished_run_called_like_the_staging_folder_is_left_alone(fake, tmp_path):
    """A finished run of the user's in DIR.part is neither moved nor deleted by a run into DIR: exit code 14."""
    go(tmp_path / "out.part")
    (tmp_path / "out.part/notes.txt").write_text("mine")
    before = {path: path.read_bytes() for path in (tmp_path / "out.part").iterdir() if path.is_file()}
    with pytest.raises(Unreadable, match="files of others"):
        go(tmp_path / "out", {"speed": 7})
    assert {path: path.read_bytes() for path in (tmp_path / "out.part").iterdir() if path.is_file()} == before and not (tmp_path / "out").exists()


def test_foreign_folder_is_refused(fake, tmp_path):
    """A folder with files of others is not touched: exit code 14."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out/thesis.tex").write_text("years of work")
    with pytest.raises(Unreadable, match="no scene.toml") as error:
        go(tmp_path / "out", force=True)
    assert error.value.code == 14 and [p.name for p in (tmp_path / "out").iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("text", ["", "{", "[]", "null", '{"status": "running"}'])
def test_corrupt_summary_is_named(fake, tmp_path, text):
    """A summary that cannot be read is exit code 14 with what to do; --force runs again."""
    go(tmp_path / "out")
    (tmp_path / "out/summary.json").write_text(text)
    with pytest.raises(Unreadable, match="summary.json cannot be read.*--force"):
        go(tmp_path / "out")
    assert not go(tmp_path / "out", force=True).reused


@pytest.mark.parametrize("mode, words", [("noplugin", "lacks its plugin"), ("old", "is version 4.6, needed is 4.9")])
def test_unusable_freefem_says_how_to_install(fake, tmp_path, mode, words):
    """FreeFem++ without plugins or too old is exit code 13 with how to install it."""
    fake(mode)
    with pytest.raises(NotInstalled, match=f"{words}.*make setup") as error:
        go(tmp_path / "out")
    assert error.value.code == 13 and not (tmp_path / "out").exists()


def test_versions_are_numbers_between_points(fake):
    """4.10 is newer than 4.9, though scripts see it as the number 4.1."""
    fake("ten")
    assert freefem.find().version == "4.10"


def test_progress_arrives(fake, tmp_path):
    """The progress lines of the script arrive with their fraction, time and number of steps; the log keeps them too."""
    seen = []
    flags = {"fields": 0, "mesh": __file__, "out": tmp_path}
    assert freefem.run(freefem.find(), "edp/disc-plane.edp", flags, tmp_path / "log.txt", seen.append) == (0, "")
    assert seen[0] == (0.25, 0.001, 50, 0, 1.0) and len(seen) == 3
    assert "progress 0.25" in (tmp_path / "log.txt").read_text()


def test_history_is_read_to_the_last_digit(tmp_path):
    """A table of one row is a table too; a ragged one is named."""
    (tmp_path / "history.csv").write_text("t,vy\n0.10000000000000001,-8\n")
    assert np.array_equal(results.read_history(tmp_path)["t"], [0.1])
    (tmp_path / "history.csv").write_text("t,vy\n0.1,-8\n0.2\n")
    with pytest.raises(Unreadable, match="history.csv cannot be read"):
        results.read_history(tmp_path)


def test_another_scene_puts_the_folder_aside(fake, tmp_path):
    """A run of another scene moves the folder that is there, with all that is in it, to DIR.1, the next one to DIR.2."""
    out = tmp_path / "out"
    for speed in (8, 7, 6):
        go(out, {"speed": speed})
        (out / "notes.txt").write_text(f"of {speed} m/s")
    assert [(tmp_path / name / "notes.txt").read_text() for name in ("out", "out.1", "out.2")] == ["of 6 m/s", "of 8 m/s", "of 7 m/s"]
    assert [results.read_summary(tmp_path / name)["provenance"]["asked"]["speed"] for name in ("out", "out.1", "out.2")] == [6, 8, 7]


def test_the_same_scene_again_keeps_the_files_of_others(fake, tmp_path):
    """--force replaces what the program wrote; what the user put there stays, in subfolders too, and no copy is left."""
    out = tmp_path / "out"
    go(out, {"fields": 4})
    for name in ("notes.txt", "figures/mine.png", "fields/mine.txt", "fields/0-mine.vtu", "fields/2024/mine.vtu", "mine/deep/x"):
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_text("mine")
    (out / "log.txt").write_text("old")
    go(out, {"fields": 4}, force=True)
    assert all((out / name).read_text() == "mine" for name in ("notes.txt", "figures/mine.png", "fields/mine.txt", "mine/deep/x"))
    assert (out / "log.txt").read_text() != "old" and [path.name for path in tmp_path.glob("out*")] == ["out"]


def test_stage_with_files_of_others_is_refused(fake, tmp_path):
    """DIR.part may be a folder of the user's: then it is left alone, exit code 14."""
    (tmp_path / "out.part").mkdir()
    (tmp_path / "out.part/thesis.tex").write_text("years of work")
    with pytest.raises(Unreadable, match="files of others"):
        go(tmp_path / "out", force=True)
    assert (tmp_path / "out.part/thesis.tex").exists()


def test_what_another_run_makes_meanwhile_stays(tmp_path):
    """A run that has put its folder in its place does not take away the next one's, which has the same name by then."""
    with folder.staging(tmp_path / "out") as (stage, _):
        stage.rename(tmp_path / "out")
        stage.mkdir()
        (stage / "checkpoint.json").write_text("{}")
    assert (stage / "checkpoint.json").exists()


def test_killed_between_two_renames(tmp_path):
    """A complete folder that was not yet put in its place is, by the next run, which starts with an empty one."""
    part = tmp_path / "out.part"
    part.mkdir()
    (part / "checkpoint.json").write_text("{}")
    (part / "summary.json").write_text('{"status": "ok", "provenance": {"code": "1"}}')
    with folder.staging(tmp_path / "out") as (stage, _):
        assert not any(stage.iterdir()) and (tmp_path / "out/summary.json").exists()


def test_the_folder_knows_every_figure():
    """What is drawn of a run is the program's, to be drawn anew: no figure's name is missing in the list of what it writes."""
    text = "".join((run.PACKAGE / f"report/{name}.py").read_text() for name in ("drawing", "figures", "bodies"))
    lines = "".join(line for line in text.splitlines() if re.search(r"\bdrawn\b", line))
    assert set(re.findall(r'"([a-z]+)"(?=\]|:)', lines)) | set(figures.COLOURED) == set(folder.FIGURES)


def test_what_decides_a_result_is_derived():
    """A run is reused only by the same code: every module that assembly.py reaches by imports decides, but those that are named as harmless, and so does a new one."""
    decisive = run.imported(run.ENTRANCE) - run.HARMLESS
    assert run.HARMLESS < run.imported(run.ENTRANCE) and {"scenes/scene", "scenes/entries", "scenes/assembly", "input/parameters", "mesh/mesh", "mesh/solid_mesh", "geometry/tumbling"} <= decisive
    assert not decisive & {"running/run", "output/folder", "report/report", "sweeps/study", "running/solver"}


def test_an_import_anywhere_is_found(tmp_path):
    """At the top, inside a function, of a module or of names in it, of modules that import each other; names that are no modules are none."""
    (tmp_path / "room").mkdir()
    for name, text in {"a": "from . import b, VERSION\nimport os\n", "b": "def f():\n    from .room.c import g\n", "room/c": "from ..a import x\nfrom . import e\n",
                       "d": "", "room/e": "from ..elsewhere import y"}.items():
        (tmp_path / f"{name}.py").write_text(text)
    assert run.imported("a", tmp_path) == {"a", "b", "room/c", "room/e"} and run.imported("d", tmp_path) == {"d"}


def test_a_changed_module_is_other_code(tmp_path, monkeypatch):
    """What sets mesh sizes, scene.py, is part of the hash."""
    before = run.code_hash()
    for name in run.imported(run.ENTRANCE):
        (tmp_path / f"{name}.py").parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.py").write_bytes((run.PACKAGE / f"{name}.py").read_bytes())
    monkeypatch.setattr(run, "PACKAGE", tmp_path)
    assert run.code_hash() == before
    (tmp_path / "failure.py").write_text("")
    assert run.code_hash() == before
    (tmp_path / "scenes/scene.py").write_text("")
    assert run.code_hash() != before
