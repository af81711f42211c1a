"""The compiled kernels: the same as the scripts; without them nothing changes."""

import os
import shutil

import pytest

from orchestrate import freefem, kernels


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """A folder of its own for what is built."""
    monkeypatch.setattr(kernels, "BUILT", tmp_path / "dev")
    return tmp_path / "dev"


def test_they_are_built_once_and_again_for_other_sources(copy, monkeypatch):
    """What loads the plugin names one of these very sources; other sources take its place."""
    program = freefem.find()
    if not kernels.build(program.command, program.version, program.environment):
        pytest.skip("no compiler here")
    first, = copy.glob("kernels-*.so")
    made = first.stat().st_mtime_ns
    assert str(first.with_suffix(""))[1:] in (copy / "null").read_text()
    assert kernels.build(program.command, program.version, program.environment) and first.stat().st_mtime_ns == made
    shutil.copytree(kernels.SOURCES, other := copy.parent / "other")
    (other / "kernels.cpp").write_text('#include "ff++.hpp"\nstatic void add() {}\nLOADFUNC(add)\n')
    monkeypatch.setattr(kernels, "SOURCES", other)
    assert kernels.build(program.command, program.version, program.environment)
    second, = copy.glob("kernels-*.so")
    assert second != first and str(second.with_suffix(""))[1:] in (copy / "null").read_text()


def test_where_they_cannot_be_built_nothing_loads_them(copy, monkeypatch):
    """Sources that do not compile leave nothing behind that a script would load; a FreeFem++ without its ff-c++ is no error."""
    program = freefem.find()
    copy.mkdir(exist_ok=True)
    (copy / "null").write_text('load "of-other-sources"\n')
    monkeypatch.setattr(kernels, "SOURCES", copy.parent / "broken")
    kernels.SOURCES.mkdir()
    (kernels.SOURCES / "kernels.cpp").write_text("#include <no-such-header>\n")
    assert not kernels.build(program.command, program.version, {"PATH": os.environ["PATH"]}) and not (copy / "null").exists()
    assert not kernels.build("/no/such/FreeFem++", program.version, {})
