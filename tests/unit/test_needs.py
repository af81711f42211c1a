"""What needs what (scenes/needs.py): refused on all routes, and never chosen by integrator = auto."""

import re
from pathlib import Path

import pytest

from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.input.parameters import PARAMETERS, overrides
from ffimpact.input.toml_text import to_toml
from ffimpact.scene import load, read
from ffimpact.scenes import assembly
from ffimpact.scenes.entries import set_entry
from ffimpact.scenes.needs import NEEDS

DISC = {"shape": "disc", "radius": 0.05, "position": [0, 0.06], "velocity": [0, -1], "law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000}
RIGID = {name: value for name, value in DISC.items() if name not in ("law", "young", "nu")} | {"rigid": True, "position": [0, 0.3]}
RING = {"shape": "ring", "radius": 0.05, "inner_radius": 0.03, "position": [0, 0.2]}
BAR = {"shape": "rectangle", "width": 0.1, "height": 0.02, "position": [0, 0.2]} | {name: DISC[name] for name in ("law", "young", "nu", "density")}
IMPLICIT, MIDDLE = ("energy-momentum", "midpoint", "backward-euler", "bdf2"), ("energy-momentum", "midpoint")
# By the property: changed tables of a scene that has it, and all that the property accepts.
SCENES = {
    "supports and loads need": ({"body": [DISC, BAR | {"support": [{"where": "left"}]}]}, {"integrator": MIDDLE}),
    "rigid bodies need": ({"body": [DISC, RIGID]}, {"integrator": IMPLICIT}),
    "viscosity or relaxation needs": ({"body": [DISC | {"loss": 0.1, "loss_model": "kelvin-voigt"}]}, {"integrator": MIDDLE}),
    "nu = 0.5 (J = 1) needs": ({"body": [DISC | {"nu": 0.5}]}, {"integrator": ("energy-momentum",), "degree": (2,), "volume": ("projected", "auto"),
                                                              "body.1.law": ("neohookean", "mooney-rivlin", "ogden", "energy", "incompressible")}),
    "law = 'metal' needs": ({"body": [DISC | {"law": "metal", "yield_stress": 1e5}]}, {"degree": (2,), "until": ("impact",)}),
    "volume = 'projected' needs": ({"volume": "projected"}, {"degree": (2,)}),
    "start = 'equilibrium' needs": ({"start": "equilibrium", "gravity": 9.81, "body": [DISC | {"velocity": [0, 0], "position": [0, 0.05]}]}, {"integrator": IMPLICIT}),
    "given_shape = 'inflated' needs": ({"body": [DISC, RING | {name: DISC[name] for name in ("law", "young", "nu", "density")}
                                                 | {"load": [{"where": "inner", "gas": {"gauge_pressure": 1e3, "given_shape": "inflated"}}]}]}, {"degree": (2,)}),
    "adhesion needs": ({"contact": {"adhesion": 0.1, "adhesion_range": 1e-4}}, {"integrator": ("energy-momentum", "central-difference")}),
    "penalty_damping needs": ({"contact": {"penalty_damping": 1e-5}}, {"integrator": (*MIDDLE, "central-difference")}),
}
REFUSED = [(what, entry, word) for what, (_, accepted) in SCENES.items() for entry, words in accepted.items()
           for word in (PARAMETERS[entry.split(".")[-1]].words or (1, 2)) if word not in (*words, "auto")]


def tables(what: str) -> dict:
    floor = {"kind": "plane", "point": [0, 0], "normal": [0, 1]}
    return {"end_time": 1e-3, "accuracy": 0.3, "body": [DISC], "obstacle": [floor]} | SCENES[what][0]


def test_every_row_is_tested():
    assert [need.what for need in NEEDS] == list(SCENES)


@pytest.mark.parametrize("what, entry, word", REFUSED, ids=lambda value: str(value))
def test_a_row_refuses_on_all_routes(tmp_path, capsys, what, entry, word):
    """Python API, TOML file, override() and --set: one line with entry, value, property, accepted."""
    line = f"{entry.split('.')[-1]}: '{word}', but {what} another value (accepted: "
    good, bad = tables(what), set_entry(tables(what), entry, word)
    with pytest.raises(BadInput, match=re.escape(line)):
        read(bad, Path("."), "scene")
    file = tmp_path / "scene.toml"
    file.write_text(to_toml(bad))
    with pytest.raises(BadInput, match=re.escape(line)):
        load(str(file))
    file.write_text(to_toml(good))
    with pytest.raises(BadInput, match=re.escape(line)):
        load(str(file)).override(overrides([f"{entry}={word}"]))
    assert main(["run", str(file), "--set", f"{entry}={word}", "--out", str(tmp_path / "out")]) == 10
    error = capsys.readouterr().err
    assert line in error and error.count("\n") == 1


@pytest.mark.parametrize("what", SCENES)
def test_a_row_accepts_the_others(what):
    for entry, words in SCENES[what][1].items():
        for word in words:
            if entry != "body.1.law" or word in ("neohookean", "incompressible"):
                read(set_entry(tables(what), entry, word), Path("."), "scene")


@pytest.mark.parametrize("what", SCENES)
def test_auto_takes_nothing_that_a_row_refuses(what):
    """If a property excludes explicit steps, the solver gets the implicit integrator and the
    property as the reason. Otherwise the solver chooses."""
    built = assembly.assemble(read(tables(what) | {"integrator": "auto"}, Path("."), "scene"))
    accepted = SCENES[what][1].get("integrator", ("energy-momentum", "central-difference"))
    reason = f"{what} implicit steps"
    if "central-difference" in accepted and what != "given_shape = 'inflated' needs":  # a gas is a load
        assert built.values["integrator"] == "auto" and {"energy-momentum", "central-difference"} <= set(accepted) and built.arrays["implicit_why"] == ""
    else:
        assert built.values["integrator"] == "energy-momentum" == built.used["integrator"]
        assert "energy-momentum" in accepted and built.arrays["implicit_why"] in (reason, "supports and loads need implicit steps")


def test_the_accepted_words_are_those_of_all_rows():
    """Supports beside J = 1: midpoint suits the supports alone."""
    both = {"integrator": "bdf2", "end_time": 1e-3, "body": [BAR | {"nu": 0.5, "support": [{"where": "left"}], "velocity": [0, -1]}]}
    with pytest.raises(BadInput, match=re.escape("integrator: 'bdf2', but supports and loads need another value (accepted: auto|energy-momentum)")):
        read(both, Path("."), "scene")


def test_auto_still_chooses_where_obstacles_are_driven():
    """Explicit steps count the work of a driven obstacle (tests/run/test_explicit.py)."""
    driven = {"kind": "plane", "point": [0, 0], "normal": [0, 1], "motion": ["0", "t"]}
    built = assembly.assemble(read(tables("penalty_damping needs") | {"integrator": "auto", "obstacle": [driven]}, Path("."), "scene"))
    assert built.values["integrator"] == "auto" and built.arrays["implicit_why"] == ""
