"""The contract of runs: one scene, one run, one folder; what is kept, reused and refused."""


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


def test_what_decides_a_result_is_derived():
    """A run is reused only by the same code: every module that assembly.py imports, directly or
    not, counts except those in HARMLESS.

    A new module counts, too.
    """
    decisive = run.imported(run.ENTRANCE) - run.HARMLESS
    assert run.HARMLESS < run.imported(run.ENTRANCE) and {"scenes/scene", "scenes/entries", "scenes/assembly", "input/parameters", "mesh/mesh", "mesh/solid_mesh", "geometry/tumbling"} <= decisive
    assert not decisive & {"running/run", "output/folder", "report/report", "sweeps/study", "running/solver"}


def test_an_import_anywhere_is_found(tmp_path):
    """Imports are found at the top, inside functions, of modules or names, and in cycles. Names
    that are not modules are ignored."""
    (tmp_path / "room").mkdir()
    for name, text in {"a": "from . import b, VERSION\nimport os\n", "b": "def f():\n    from .room.c import g\n", "room/c": "from ..a import x\nfrom . import e\n",
                       "d": "", "room/e": "from ..elsewhere import y"}.items():
        (tmp_path / f"{name}.py").write_text(text)
    assert run.imported("a", tmp_path) == {"a", "b", "room/c", "room/e"} and run.imported("d", tmp_path) == {"d"}


def test_a_changed_module_is_other_code(tmp_path, monkeypatch):
    """The module that sets mesh sizes, scene.py, is part of the hash."""
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
