"""The contract of runs: one scene, one run, one folder; what is kept, reused and refused."""

import shutil

import numpy as np
import pytest

from ffimpact.failure import NotInstalled, Unreadable
from ffimpact.freefem import freefem
from ffimpact.output import folder, results
from ffimpact.running import run
from tests.support.run import go


@pytest.mark.parametrize("mode, words", [("noplugin", "lacks its plugin"), ("old", "is version 4.6, needed is 4.9")])
def test_unusable_freefem_says_how_to_install(fake, tmp_path, mode, words):
    """FreeFem++ without plugins or too old gives exit code 13 with installation instructions."""
    fake(mode)
    with pytest.raises(NotInstalled, match=f"{words}.*make setup") as error:
        go(tmp_path / "out")
    assert error.value.code == 13 and not (tmp_path / "out").exists()


def test_versions_are_numbers_between_points(fake):
    """4.10 is newer than 4.9, although scripts read it as the number 4.1."""
    fake("ten")
    assert freefem.find().version == "4.10"


def test_history_is_read_to_the_last_digit(tmp_path):
    """A table of one row is valid. A ragged table is reported."""
    (tmp_path / "history.csv").write_text("t,vy\n0.10000000000000001,-8\n")
    assert np.array_equal(results.read_history(tmp_path)["t"], [0.1])
    (tmp_path / "history.csv").write_text("t,vy\n0.1,-8\n0.2\n")
    with pytest.raises(Unreadable, match="history.csv cannot be read"):
        results.read_history(tmp_path)


def test_what_another_run_makes_meanwhile_stays(tmp_path):
    """After a run has moved its folder to its final place, it does not delete the folder of the
    next run with the same name."""
    with folder.staging(tmp_path / "out") as (stage, _):
        stage.rename(tmp_path / "out")
        stage.mkdir()
        (stage / "checkpoint.json").write_text("{}")
    assert (stage / "checkpoint.json").exists()


def test_killed_between_two_renames(tmp_path):
    """The next run moves a complete folder of a killed run to its final place and starts with an
    empty one."""
    part = tmp_path / "out.part"
    part.mkdir()
    (part / "checkpoint.json").write_text("{}")
    (part / "summary.json").write_text('{"status": "ok", "provenance": {"code": "1"}}')
    with folder.staging(tmp_path / "out") as (stage, _):
        assert not any(stage.iterdir()) and (tmp_path / "out/summary.json").exists()


def test_a_changed_module_is_other_code(tmp_path, monkeypatch):
    """A run is reused only by the same code: of all modules that make mesh and scene, new ones too; not
    of those that evaluate and draw."""
    before = run.code_hash()
    shutil.copytree(run.PACKAGE, tmp_path / "package")
    monkeypatch.setattr(run, "PACKAGE", tmp_path / "package")
    assert run.code_hash() == before
    (tmp_path / "package/report/report.py").write_text("")
    assert run.code_hash() == before
    for name in ("scenes/scene.py", "mesh/new.py"):
        (tmp_path / "package" / name).write_text("")
        assert run.code_hash() != before
        before = run.code_hash()
