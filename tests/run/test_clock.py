"""The preloaded clock(): equal output in half the time. Without it nothing changes."""

import json
import os
from dataclasses import replace

import pytest

from ffimpact.freefem import freefem
from tests.support.direct import case


def test_histories_are_equal_to_the_byte_with_and_without_it(tmp_path):
    """The clock does not affect results. The summary reports its use, and its processor time is
    that of the process."""
    variables, histories = freefem.find().environment, []
    if "libclock.so" not in variables.get("LD_PRELOAD", ""):
        pytest.skip("no compiler here")
    for name, environment in (("quick", variables), ("plain", {key: value for key, value in variables.items() if key != "LD_PRELOAD"})):
        flags = case({"accuracy": 0.05, "out": tmp_path / name})
        before = os.times()
        freefem.find().call(*flags, env=environment, check=True)
        after = os.times()
        summary = json.loads((tmp_path / name / "record.json").read_text())["diagnostics"]
        used = after.children_user + after.children_system - before.children_user - before.children_system
        assert summary["quick_clock"] == (name == "quick") and summary["cpu_seconds"] == pytest.approx(used, abs=0.1)
        histories.append((tmp_path / name / "history.csv").read_bytes())
    assert histories[0] == histories[1]


def test_it_serves_on_a_path_that_cannot_be_preloaded_by_its_name(monkeypatch, tmp_path):
    """LD_PRELOAD separates names at blanks and colons. For such paths the library is an open file
    that all processes of the program inherit."""
    program = freefem.find()
    if "LD_PRELOAD" not in program.environment:
        pytest.skip("no compiler here")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "a b:c"))
    environment = {key: value for key, value in program.environment.items() if key != "LD_PRELOAD"}
    program = replace(program, environment=environment | freefem.quick_clock(environment))
    assert len(program.preloaded) == 1
    program.call(*case({"accuracy": 0.2, "out": tmp_path / "out"}), check=True)
    assert json.loads((tmp_path / "out/record.json").read_text())["diagnostics"]["quick_clock"] == 1
