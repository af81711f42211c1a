"""The contract of runs: one scene, one run, one folder; what is kept, reused and refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from ffimpact import scene
from ffimpact.failure import Failure, Unreadable
from ffimpact.freefem import freefem
from ffimpact.freefem.arrays import packed
from ffimpact.mesh import mesh
from ffimpact.output import results
from ffimpact.running import run
from tests.support.run import go


def test_finished_run_is_complete(fake, tmp_path):
    """A finished run has the whole folder and a summary with provenance, and leaves no temporary
    folder."""
    result = go(tmp_path / "out", {"fields": 2})
    assert {"scene.toml", "scene.bin", "history.csv", "summary.json", "log.txt", "mesh.msh", "fields.pvd", "fields"} == {
        p.name for p in result.folder.iterdir()}
    assert set(result.summary["provenance"]) == {"script", "version", "asked", "git", "code", "freefem", "gmsh", "mesh", "estimate", "files", "summary"}
    assert result.summary["status"] == "ok" and not result.reused
    assert result.history["t"].shape == (200,) and result.scene["body"][0]["speed"] == 8.0
    assert not list(tmp_path.glob("out.*"))


def test_python_takes_numbers_of_numpy_and_paths_as_text(fake, tmp_path):
    """Scripts use np.linspace in loops, and any form of folder and scene names."""
    result = run.run(scene.load(Path("disc-normal")), {"speed": np.linspace(1, 4, 2)[1], "fields": np.int64(2)}, str(tmp_path / "out"), estimate=False)
    assert result.scene["body"][0]["speed"] == 4 and result.scene["fields"] == 2 and result.folder == tmp_path / "out"


def test_mesh_has_the_described_sizes(fake, tmp_path):
    """The mesh has the sizes of the scene as used."""
    used = go(tmp_path / "out").scene["body"][0]
    m = mesh.read(tmp_path / "out/mesh.msh")
    length = np.linalg.norm(m.points[m.edges[:, 1]] - m.points[m.edges[:, 0]], axis=1)
    assert used["contact_mesh_size"] == pytest.approx(length.min(), rel=0.2) and used["mesh_size"] == pytest.approx(length.max(), rel=0.3)


@pytest.mark.parametrize("values, half", [
    ({}, True), ({"direction": -60}, False), ({"spin": 1}, False), ({"symmetry": "full"}, False), ({"symmetry": "half"}, True)])
def test_half_is_meshed_where_it_is_enough(fake, tmp_path, values, half):
    """Half a disc is meshed unless direction, spin or the user require the whole."""
    m = mesh.read(go(tmp_path / "out", values).folder / "mesh.msh")
    assert (m.points[:, 0].min() >= 0) == half


def test_same_scene_and_code_is_reused(fake, tmp_path, monkeypatch):
    """The same run is reused. Another parameter or code, or --force, runs again."""
    out = tmp_path / "out"
    go(out)
    assert go(out).reused and fake.starts() == 1
    assert not go(out, {"speed": 7}).reused
    assert go(out, {"speed": "7.0"}).reused
    assert not go(out, {"speed": 7}, force=True).reused
    monkeypatch.setattr(run, "code_hash", lambda: "other")
    assert not go(out).reused
    assert fake.starts() == 4


def test_run_without_python_is_not_reused(fake, tmp_path):
    """A folder that FreeFem++ wrote without Python has no provenance: it is run again and replaced.
    """
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
    """A failed run ends with the line and code of the script, keeps log, scene and failure.json,
    and never looks finished."""
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
    """A failed run in the folder of a finished one does not change it and keeps its own files
    beside it."""
    go(tmp_path / "out")
    before = (tmp_path / "out/summary.json").read_bytes()
    fake("step")
    with pytest.raises(Failure) as error:
        go(tmp_path / "out", {"speed": 9})
    assert (tmp_path / "out/summary.json").read_bytes() == before
    assert error.value.folder == tmp_path / "out.failed" and (tmp_path / "out.failed/failure.json").exists()
    assert go(tmp_path / "out").reused


def test_left_over_of_a_killed_run_is_replaced(fake, tmp_path):
    """Files of a killed run in the temporary folder do not get into a result."""
    (tmp_path / "out.part/fields").mkdir(parents=True)
    (tmp_path / "out.part/summary.json").write_text('{"status": "ok"}')
    (tmp_path / "out.part/fields/old.vtu").write_text("")
    (tmp_path / "out.part/checkpoint.json").write_text("{}")
    fake("silent")
    with pytest.raises(Failure, match="without a result"):
        go(tmp_path / "out")
    assert not (tmp_path / "out/summary.json").exists() and not (tmp_path / "out/fields/old.vtu").exists()


def test_a_finished_run_called_like_the_staging_folder_is_left_alone(fake, tmp_path):
    """A run into DIR neither moves nor deletes a finished run of the user in DIR.part: exit code
    14."""
    go(tmp_path / "out.part")
    (tmp_path / "out.part/notes.txt").write_text("mine")
    before = {path: path.read_bytes() for path in (tmp_path / "out.part").iterdir() if path.is_file()}
    with pytest.raises(Unreadable, match="files of others"):
        go(tmp_path / "out", {"speed": 7})
    assert {path: path.read_bytes() for path in (tmp_path / "out.part").iterdir() if path.is_file()} == before and not (tmp_path / "out").exists()


def test_foreign_folder_is_refused(fake, tmp_path):
    """A folder with foreign files is not changed: exit code 14."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out/thesis.tex").write_text("years of work")
    with pytest.raises(Unreadable, match="no scene.toml") as error:
        go(tmp_path / "out", force=True)
    assert error.value.code == 14 and [p.name for p in (tmp_path / "out").iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("text", ["", "{", "[]", "null", '{"status": "running"}'])
def test_corrupt_summary_is_named(fake, tmp_path, text):
    """An unreadable summary gives exit code 14 and advice. --force runs again."""
    go(tmp_path / "out")
    (tmp_path / "out/summary.json").write_text(text)
    with pytest.raises(Unreadable, match="summary.json cannot be read.*--force"):
        go(tmp_path / "out")
    assert not go(tmp_path / "out", force=True).reused


def test_progress_arrives(fake, tmp_path):
    """The progress lines of the script arrive with share, time and number of steps. The log keeps
    them, too."""
    seen = []
    (tmp_path / "scene.bin").write_bytes(packed({"fields": 0}))
    flags = {"scene": tmp_path / "scene.bin", "out": tmp_path}
    assert freefem.run(freefem.find(), "edp/program/bodies.edp", flags, tmp_path / "log.txt", seen.append) == (0, "")
    assert seen[0] == freefem.At(0.25, 0.001, 50) and len(seen) == 3
    assert "progress 0.25" in (tmp_path / "log.txt").read_text()


def test_another_scene_puts_the_folder_aside(fake, tmp_path):
    """A run of another scene moves the existing folder with its content to DIR.1, the next one to
    DIR.2."""
    out = tmp_path / "out"
    for speed in (8, 7, 6):
        go(out, {"speed": speed})
        (out / "notes.txt").write_text(f"of {speed} m/s")
    assert [(tmp_path / name / "notes.txt").read_text() for name in ("out", "out.1", "out.2")] == ["of 6 m/s", "of 8 m/s", "of 7 m/s"]
    assert [results.read_summary(tmp_path / name)["provenance"]["asked"]["body"][0]["speed"] for name in ("out", "out.1", "out.2")] == [6, 8, 7]


def test_the_same_scene_again_keeps_the_files_of_others(fake, tmp_path):
    """--force replaces files of the program and keeps files of the user, also in subfolders. No
    copy is left."""
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
    """DIR.part may be a folder of the user: it is not changed, and the exit code is 14."""
    (tmp_path / "out.part").mkdir()
    (tmp_path / "out.part/thesis.tex").write_text("years of work")
    with pytest.raises(Unreadable, match="files of others"):
        go(tmp_path / "out", force=True)
    assert (tmp_path / "out.part/thesis.tex").exists()
