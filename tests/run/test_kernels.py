"""The compiled kernels: they are built once, and required."""

import os
import re
from dataclasses import replace

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


def write(folder, name: str) -> None:
    folder.mkdir(exist_ok=True)
    (folder / "kernels.cpp").write_text(f'#include "ff++.hpp"\nstatic void {name}() {{}}\nLOADFUNC({name})\n')


@pytest.mark.robustness
def test_they_are_built_once_and_again_for_other_sources(cache, program, monkeypatch, tmp_path):
    """They are built in the user's cache folder, which may have any name. The argument contains the
    plugin of these sources, and FreeFEM loads it."""
    monkeypatch.setattr(kernels, "SOURCES", tmp_path / "sources")
    words = []
    for name in ("one", "other"):
        write(kernels.SOURCES, name)
        word = kernels.build(program.command, program.version, program.environment)
        if not word:
            pytest.skip("no compiler here")
        made = {path: path.stat().st_mtime_ns for path in cache.rglob("kernels.so")}
        assert kernels.build(program.command, program.version, program.environment) == word
        assert made == {path: path.stat().st_mtime_ns for path in cache.rglob("kernels.so")}
        words.append(word)
    assert len(set(words)) == len(made) == 2 and all(any(str(path)[1:-3] in word for path in made) for word in words)
    assert {path.name for path in cache.rglob("*") if path.is_file()} == {"kernels.so"}
    script = tmp_path / "load.edp"
    script.write_text("load " + re.match(r"-D(kernels\d+)=", words[0])[1] + "\n")
    assert replace(program, plugin=words[0]).call(script).returncode == 0


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
