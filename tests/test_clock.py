"""The preloaded clock(): the same bytes, half the time; without it nothing changes."""

import json
import os

import pytest

from orchestrate.freefem import freefem


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """The library's source alone in a folder of its own."""
    source = tmp_path / "clock.c"
    source.write_text(freefem.CLOCK.read_text())
    monkeypatch.setattr(freefem, "CLOCK", source)
    return source


def quick(environment: dict) -> bool:
    return "libclock.so" in freefem._quick_clock(environment).get("LD_PRELOAD", "")


def test_histories_are_equal_to_the_byte_with_and_without_it(tmp_path):
    """The clock decides nothing; the summary says whether it served; the processor time it counts is that of the process."""
    given, histories = freefem.find().environment, []
    if "libclock.so" not in given.get("LD_PRELOAD", ""):
        pytest.skip("no compiler here")
    for name, environment in (("quick", given), ("plain", {key: value for key, value in given.items() if key != "LD_PRELOAD"})):
        before = os.times()
        freefem.find().call("edp/disc-plane.edp", "-accuracy", "0.05", "-out", str(tmp_path / name), env=environment, check=True)
        after = os.times()
        summary = json.loads((tmp_path / name / "summary.json").read_text())
        used = after.children_user + after.children_system - before.children_user - before.children_system
        assert summary["quick_clock"] == (name == "quick") and summary["cpu_seconds"] == pytest.approx(used, abs=0.1)
        histories.append((tmp_path / name / "history.csv").read_bytes())
    assert histories[0] == histories[1]


def test_it_is_built_where_it_is_missing_or_old_and_joins_other_libraries(copy):
    library = copy.with_name("libclock.so")
    environment = {"PATH": os.environ["PATH"], "LD_PRELOAD": "one.so two.so"}
    if not quick(environment):
        pytest.skip("no compiler here")
    os.utime(library, (0, 0))
    assert freefem._quick_clock(environment) == {"LD_PRELOAD": f"{library}:one.so:two.so"} and library.stat().st_mtime > 0
    assert {path.name for path in copy.parent.iterdir()} == {"clock.c", "libclock.so"}


def test_without_a_compiler_or_on_a_path_that_cannot_be_preloaded_nothing_changes(copy, monkeypatch, tmp_path):
    assert not quick({"PATH": "/no/such/folder"}) and {path.name for path in copy.parent.iterdir()} == {"clock.c"}
    odd = tmp_path / "a b"
    odd.mkdir()
    monkeypatch.setattr(freefem, "CLOCK", odd / "clock.c")
    assert not quick({"PATH": os.environ["PATH"]})
