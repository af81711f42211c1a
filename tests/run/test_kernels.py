"""The compiled kernels: they are built once, and required."""

import os
import re
import time
from dataclasses import replace
from pathlib import Path

import pytest

from ffimpact.failure import NotInstalled
from ffimpact.freefem import freefem, kernels


@pytest.fixture
def program():
    """FreeFem++ with the kernels of the user's cache folder."""
    return freefem.find()


@pytest.fixture
def cache(tmp_path, monkeypatch, program):
    """An empty cache folder whose name has special characters of shells."""
    folder = tmp_path / "it's; new"
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    return folder


@pytest.fixture
def sources(tmp_path, monkeypatch):
    """A folder of sources in place of the kernels: two units and a header that both include."""
    folder = tmp_path / "sources"
    folder.mkdir()
    (folder / "part.hpp").write_text("int part();\n")
    (folder / "part.cpp").write_text('#include "part.hpp"\nint part() { return 1; }\n')
    (folder / "kernels.cpp").write_text('#include "ff++.hpp"\n#include "part.hpp"\nstatic void load() { part(); }\nLOADFUNC(load)\n')
    monkeypatch.setattr(kernels, "SOURCES", folder)
    return folder


def build(program, **variables: str) -> str:
    return kernels.build(program.command, program.version, program.environment | variables)


def files(cache) -> dict[str, list[int]]:
    """The times of the files in the cache folder, by their names."""
    times: dict[str, list[int]] = {}
    for path in cache.rglob("*"):
        if path.is_file():
            times.setdefault(path.name, []).append(path.stat().st_mtime_ns)
    return times


def test_they_are_built_once_and_only_changed_units_again(cache, program, sources, tmp_path):
    """They are built in the user's cache folder, which may have any name. A changed unit is compiled
    alone, a changed header with all units that include it. The argument contains the plugin of these
    sources, and FreeFEM loads it."""
    words = [build(program)]
    made = files(cache)
    assert words == [build(program)] and made == files(cache)
    assert {name: len(times) for name, times in made.items()} == {"kernels.so": 1, "unit.o": 2}
    for name, objects in (("part.cpp", 3), ("part.hpp", 5)):
        (sources / name).write_text((sources / name).read_text() + "// changed\n")
        words.append(build(program))
        assert len(files(cache)["unit.o"]) == objects
    assert set(made["unit.o"]) < set(files(cache)["unit.o"])  # the first ones were left as they are
    assert len(set(words)) == 3 and len(files(cache)["kernels.so"]) == 3
    script = tmp_path / "load.edp"
    script.write_text("load " + re.match(r"-D(kernels\d+)=", words[0])[1] + "\n")
    for word in words:
        assert replace(program, plugin=word).call(script).returncode == 0


def test_a_unit_that_fails_leaves_no_plugin(cache, program, sources):
    """Whole objects of the other units stay, and nothing else."""
    (sources / "part.cpp").write_text("int part() { return }\n")
    assert not build(program)
    assert set(files(cache)) <= {"unit.o"} and not list(cache.rglob("unfinished-*"))


def test_a_build_that_takes_too_long_ends_its_compilers(cache, program, sources, monkeypatch, tmp_path):
    """The child processes of the compiler end with it."""
    compiler, children = tmp_path / "slow", tmp_path / "children"
    compiler.write_text(f"#!/bin/sh\nsleep 1000 &\necho $! >> {children}\nwait\n")
    compiler.chmod(0o755)
    monkeypatch.setattr(kernels, "SECONDS", 2.0)
    assert not build(program, CXX=str(compiler))
    assert not files(cache) and not list(cache.rglob("unfinished-*"))
    last = time.monotonic() + 5  # the signal may take a moment to be handled
    while any(map(alive, children.read_text().split())):
        assert time.monotonic() < last
        time.sleep(0.02)


def alive(number: str) -> bool:
    try:
        return Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_where_they_cannot_be_built_nothing_loads_them(cache, program, monkeypatch, tmp_path):
    """Sources that do not compile, a FreeFem++ without ff-c++ and a read-only cache folder are not
    errors."""
    with monkeypatch.context() as empty:
        empty.setenv("PATH", "")
        assert not kernels.build("/no/such/FreeFem++", program.version, {})
    monkeypatch.setattr(kernels, "SOURCES", tmp_path / "broken")
    kernels.SOURCES.mkdir()
    (kernels.SOURCES / "kernels.cpp").write_text("#include <no-such-header>\n")
    assert not kernels.build(program.command, program.version, {"PATH": os.environ["PATH"]})
    assert not [path for path in cache.rglob("*") if path.is_file()]
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert not kernels.build(program.command, program.version, {"PATH": os.environ["PATH"]})


def test_without_them_nothing_starts(monkeypatch):
    """FreeFem++ without kernels is not installed: one line says what is missing."""
    monkeypatch.setattr(kernels, "build", lambda *_: "")
    monkeypatch.setenv("FFIMPACT_THREADS", "3")  # another environment is looked at anew
    with pytest.raises(NotInstalled, match=r"compiled kernels .* g\+\+"):
        freefem.find()
