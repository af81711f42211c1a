"""The preloaded clock(): equal output in half the time. Without it nothing changes."""

import os

import pytest

from ffimpact.freefem import freefem


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


def quick(environment: dict) -> bool:
    return "libclock.so" in freefem.quick_clock(environment).get("LD_PRELOAD", "")


def test_it_is_built_once_and_joins_other_libraries(cache):
    environment = {"PATH": os.environ["PATH"], "LD_PRELOAD": "one.so two.so"}
    if not quick(environment):
        pytest.skip("no compiler here")
    library, = (path for path in cache.rglob("*") if path.is_file())
    made = library.stat().st_mtime_ns
    assert freefem.quick_clock(environment) == {"LD_PRELOAD": f"{library}:one.so:two.so"} and library.stat().st_mtime_ns == made


def test_without_a_compiler_nothing_changes(cache):
    assert not quick({"PATH": "/no/such/folder"}) and not [path for path in cache.rglob("*") if path.is_file()]
