"""The compiled kernels agree with the scripts. Without them nothing changes."""

import json
import os
import re
from dataclasses import replace

import pytest

from ffimpact.failure import Failure
from ffimpact.freefem import freefem, kernels
from verification.measure import disc, measure, prepared
from verification.tangents import COARSE, kernels_are_the_scripts


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
    assert not kernels.build("/no/such/FreeFem++", program.version, {})
    monkeypatch.setattr(kernels, "SOURCES", tmp_path / "broken")
    kernels.SOURCES.mkdir()
    (kernels.SOURCES / "kernels.cpp").write_text("#include <no-such-header>\n")
    assert not kernels.build(program.command, program.version, {"PATH": os.environ["PATH"]})
    assert not [path for path in cache.rglob("*") if path.is_file()]
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert not kernels.build(program.command, program.version, {"PATH": os.environ["PATH"]})


def test_a_plugin_of_another_version_is_left_alone(tmp_path):
    """The argument has the number of the calls that the scripts use."""
    program = replace(freefem.find(), plugin='-Dkernels1="/no/such/plugin"')
    program.call("edp/program/disc-plane.edp", "-accuracy", "0.2", "-end_time", "1e-4", "-out", str(tmp_path / "out"), check=True)
    assert json.loads((tmp_path / "out/record.json").read_text())["kernels"] == 0


FLAGS = [{"law": law} | flags for law in ("svk", "neohookean") for flags in ({}, {"integrator": "midpoint"}, {"integrator": "newmark"}, {"nu": 0.46})]


@pytest.mark.few(10)
@pytest.mark.parametrize("flags", FLAGS, ids=str)
@pytest.mark.parametrize("body", COARSE)
def test_forces_and_tangent_are_those_of_the_scripts(body, flags):
    """In any dimension, for the laws of the scripts, volume as element mean or at points, at any
    position in the step: to round-off.

    verification/test_residual_and_tangent.py has further cases.
    """
    values = {"nu": 0.3, "integrator": "energy-momentum"} | COARSE[body] | flags
    kernels_are_the_scripts(measure(f"tangent-{body}", **values))


@pytest.mark.parametrize("integrator", ["newmark", "energy-momentum"])
def test_two_bodies_of_different_laws(tmp_path, integrator):
    """Every point has the law of its own body."""
    bodies = [{"name": name, "shape": "disc", "radius": 0.05, "position": [0, y], "velocity": [0, 0], "law": law, "young": young, "nu": 0.3, "density": 1722.0}
              for name, y, law, young in (("lower", 0.05, "svk", 7e6), ("upper", 0.151, "neohookean", 2e7))]
    kernels_are_the_scripts(measure("kernels-bodies", **prepared(tmp_path, {"accuracy": 0.1, "body": bodies}) | {"integrator": integrator}))


TIGHT = {"law": "neohookean", "nu": 0.4, "accuracy": 0.3, "tolerance": 1e-14}
RUBBED = {"friction_static": 0.3, "angle": 60}
MARCHES = {"disc": ("disc-plane", {}), "svk": ("disc-plane", {"law": "svk", "integrator": "midpoint", "speed": 2, "end_time": 1e-3}),
           "ball of revolution": ("ball-axisymmetric", {}), "incompressible": ("disc-plane", {"nu": 0.5, "end_time": 1e-3, "dt": 5e-5}),
           "two bodies": ("disc-block", RUBBED | {"end_time": 1e-3})}
WATCHED = ["t", "normal_force", "friction_force", "kinetic", "elastic", "vx", "vy", "min_jacobian", "min_stretch", "min_ellipticity"]


@pytest.mark.few(2)
@pytest.mark.parametrize("name", MARCHES)
def test_marches_are_those_of_the_scripts(tmp_path, name):
    """The histories with and without kernels are equal to round-off. The summary reports which were
    used.

    test_kernels_contact.py has cases with friction.
    """
    script, flags = MARCHES[name]
    runs = {folder: disc(tmp_path / folder, script, **TIGHT | flags, without=without) for folder, without in (("with", "none"), ("without", "kernels"))}
    if not runs["with"].summary["kernels"]:
        pytest.skip("no compiler here")
    assert not runs["without"].summary["kernels"]
    for column in WATCHED:
        ours, theirs = (runs[folder].history[column] for folder in ("with", "without"))
        assert ours == pytest.approx(theirs, rel=0, abs=1e-9 * max(abs(theirs))), column
    for number in ("max_von_mises", "max_tension", "max_shear"):
        assert runs["with"].summary[number] == pytest.approx(runs["without"].summary[number], rel=1e-9)


@pytest.mark.parametrize("flags, entry", [({"law": "ogden", "law_parameters": "2,1"}, "law: ogden"), ({"viscosity": 50}, "viscosity"),
                                          ({"integrator": "central-difference"}, "integrator: central-difference")])
def test_what_the_paper_does_not_have_needs_them(tmp_path, flags, entry):
    """Without kernels such a scene ends with exit code 13 and the entry."""
    with pytest.raises(Failure, match=f"exit code 13: ffimpact: {entry}"):
        disc(tmp_path / "out", "disc-plane", **TIGHT | flags, without="kernels")
