"""Invalid supports and loads: every wrong entry is reported in one line with what is accepted; exit
code 10."""

import pytest

from ffimpact.__main__ import main
from ffimpact.input.toml_text import to_toml

BASE = {"law": "svk", "young": 1e6, "nu": 0.3, "density": 1e3, "accuracy": 0.2, "end_time": 5e-3}
BAR = {"name": "bar", "shape": "rectangle", "width": 0.2, "height": 0.05, "position": [0, 0.1]}
RING = {"name": "ring", "shape": "ring", "radius": 0.05, "inner_radius": 0.03, "position": [0, 0.2]}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}
DISC, BOX, HALF = {"kind": "disc"}, {"kind": "box"}, {"kind": "half-plane"}
FILES = {"short.csv": "t,x\n0,0\n1,1\n", "bad.csv": "t,x,y\n0,0,0\n1,a,1\n", "back.csv": "t,x,y\n0,0,0\n1,1,1\n0.5,1,1\n"}


def held(body: dict = BAR, top: dict | None = None, **support) -> dict:
    return BASE | (top or {}) | {"body": [body | {"support": [support]}]}


def loaded(body: dict = BAR, top: dict | None = None, **load) -> dict:
    return BASE | (top or {}) | {"body": [body | {"load": [load]}]}


def both(*supports: dict, **more) -> dict:
    return BASE | {"body": [BAR | {"support": list(supports)} | more]}


def moved(*motion) -> dict:
    return held(where="left", motion=list(motion))


SIDES = "(accepted: left, right, bottom, top, all, outer, or a region)"
WRONG = {
    "side": (held(where="lefft"), f"body.1.support.1.where: 'bar' has no side or group 'lefft' {SIDES}"),
    "side of space": (held(where="front"), f"body.1.support.1.where: 'bar' has no side or group 'front' {SIDES}"),
    "cavity of a solid body": (loaded(where="inner", pressure=1), f"body.1.load.1.where: 'bar' has no side or group 'inner' {SIDES}"),
    "where is missing": (held(fix="all"), "body.1.support.1.where: is missing (accepted: left,"),
    "where is a number": (held(where=3), "body.1.support.1.where: '3' is no part of a boundary (accepted: left,"),
    "kind of region": (held(where={"kind": "cube"}), "is no part of a boundary (accepted: left,"),
    "empty region": (held(where=DISC | {"centre": [5, 5], "radius": 0.1}), "no boundary element of 'bar' has its middle in the region"),
    "no radius": (held(where=DISC | {"centre": [5, 5]}), "body.1.support.1.where.radius: is missing"),
    "radius 0": (held(where=DISC | {"centre": [5, 5], "radius": 0}), "body.1.support.1.where.radius: 0 is out of range"),
    "radius a list": (held(where=DISC | {"centre": [5, 5], "radius": [1]}), "body.1.support.1.where.radius: '[1]' is not a number"),
    "no centre": (held(where=DISC | {"radius": 1}), "body.1.support.1.where.centre: is missing"),
    "no direction": (held(where=HALF | {"point": [0, 0], "normal": [0, 0]}), "where.normal: '[0, 0]' has no direction"),
    "box upside down": (held(where=BOX | {"low": [1, 1], "high": [0, 0]}), "where.high: '[0, 0]' is below low"),
    "key of a region": (held(where=BOX | {"low": [0, 0], "hihg": [1, 1]}), "where.hihg: no such entry, set to '[1, 1]'; did you mean high?"),
    "touching": (held(BAR | {"position": [0, 0.025]}, {"obstacle": [FLOOR]}, where="bottom"),
                 "body.1.support.1.where: the part is in contact with 'floor' at the start (accepted: a part without contact)"),
    "constant motion": (moved(0, 0.001), "body.1.support.1.motion.2: 0.001 does not change in time"),
    "motion along a part": (held(where="top", fix="normal", motion=["2*t", "-0.1*t"]),
                            "body.1.support.1.motion: moves along x, which fix = 'normal' leaves free on this part"),
    "opposite motions": (both({"where": "top", "motion": [0, "t"]}, {"where": "top", "fix": "y", "motion": [0, "-t"]}),
                         "body.1.support.2.motion: moves 'bar' along y otherwise than body.1.support.1, where both hold it"),
    "load on a held side": (both({"where": "top"}, load=[{"where": "top", "pressure": 1e3}]),
                            "body.1.load.1.where: supports hold this part of 'bar' until the end, so the pressure has no effect"),
    "release after the end": (held(where="top", release=5e-3), "body.1.support.1.release: 0.005 is not before the end_time, 0.005 s"),
    "columns of a component": (loaded(where="top", traction=[{"t": [0, 1], "y": [0, 1]}, 0]), "body.1.load.1.traction.1: '{"),
    "pole": (moved(0, "1/(t-0.0025)"), "at t = 0.0025 s (accepted: a number and a finite slope at all times)"),
    "pole elsewhere": (moved(0, "1/(t-0.0013)"), "at t = 0.0013 s (accepted: a number and a finite slope at all times)"),
    "jump": (moved(0, "abs(t-0.0013)/(t-0.0013)"), "motion.2: 'abs(t-0.0013)/(t-0.0013)' jumps, or has no limit, at t = 0.0013 s"),
    "root of less than 0": (loaded(where="top", pressure="sqrt(0.001-t)"), "body.1.load.1.pressure: 'sqrt(0.001-t)' is nan"),
    "endless slope": (loaded(where="top", pressure="sqrt(t)"), "'sqrt(t)' is 0, its slope 5e+299, at t = 0 s"),
    "too often": (moved("sin(1e12*t)", 0), "motion.1: 'sin(1e12*t)' changes too often up to end_time = 0.005 s"),
    "unknown name": (moved("x", 0), "body.1.support.1.motion.1: 'x' in 'x' is not known (accepted: numbers, pi, t,"),
    "no expression": (moved("sin(t", 0), "motion.1: 'sin(t' is no expression"),
    "true": (loaded(where="top", pressure=True), "pressure: 'true' is no function of time (accepted: a number, or an expression of t in quotes)"),
    "too large": (loaded(where="top", pressure=1e30), "pressure: 1e+30 is out of range"),
    "not a number": (loaded(where="top", pressure=float("nan")), "pressure: nan is out of range"),
    "times": (loaded(where="top", pressure={"t": [0, 1, 1], "p": [0, 1, 2]}), "pressure.p: the time 1 s follows 1 s (accepted: times that grow)"),
    "too few times": (loaded(where="top", pressure={"t": [0, 1], "p": [0, 1, 2]}), "pressure.p: 2 times and 3 values"),
    "words as times": (loaded(where="top", pressure={"t": [0, "a"], "p": [0, 1]}), "pressure.p: '[0, 'a']' of t is no list of numbers"),
    "no times": (loaded(where="top", pressure={"p": [0, 1]}), "pressure: '{'p': [0, 1]}' is no table (accepted: t and p)"),
    "columns": (held(where="left", motion={"t": [0, 1], "x": [0, 1]}), "motion: '{'t': [0, 1], 'x': [0, 1]}' is no table (accepted: t and x, y)"),
    "no file": (held(where="left", motion="none.csv"), "motion: 'none.csv' cannot be read: No such file or directory (accepted: a CSV file"),
    "columns of a file": (held(where="left", motion="short.csv"), "'short.csv' begins with 't,x' (accepted: a CSV file with the first line 't,x,y'"),
    "words in a file": (held(where="left", motion="bad.csv"), "motion: line 3 of 'bad.csv' is '1,a,1'"),
    "times of a file": (held(where="left", motion="back.csv"), "motion.x: the time 0.5 s follows 1 s"),
    "no list": (held(where="left", motion="up"), "motion: 'up' is no [x, y] (accepted: 2 numbers, expressions of t or tables, or a CSV file)"),
    "one component": (moved(0), "motion: '[0]' is no [x, y]"),
    "open cavity": (loaded(where="top", gas={"gauge_pressure": 1e3}), "body.1.load.1.where: is no closed cavity of 'bar', which a gas is in"),
    "two gases": (BASE | {"body": [RING | {"load": [{"where": "inner", "gas": {"gauge_pressure": 1e3}}] * 2}]},
                  "body.1.load.2.where: there is a gas in this cavity of 'ring' already"),
    "gas outside": (loaded(RING, where="outer", gas={"gauge_pressure": 1e3}), "is no closed cavity of 'ring'"),
    "half a cavity": (loaded(RING, where=HALF | {"point": [0, 0.2], "normal": [0, 1]}, gas={"gauge_pressure": 1e3}), "no closed cavity of 'ring'"),
    "less than vacuum": (loaded(RING, where="inner", gas={"gauge_pressure": -2e5}), "gas.gauge_pressure: -200000.0 is out of range (accepted: -101325"),
    "shape": (loaded(RING, where="inner", gas={"gauge_pressure": 1e3, "given_shape": "blown"}), "gas.given_shape: 'blown' is not known (accepted: unstressed|inflated)"),
    "straight elements": (loaded(RING, {"degree": 1}, where="inner", gas={"gauge_pressure": 1e3, "given_shape": "inflated"}),
                          "degree: '1', but given_shape = 'inflated' needs another value (accepted: 2)"),
    "no room to inflate": (loaded(RING | {"position": [0, 0.0502]}, {"obstacle": [FLOOR]}, where="inner", gas={"gauge_pressure": 2e4}),
                           "body.1.load.1.gas: the gas inflates ring, and ring overlaps floor by "),
    "no equilibrium": (loaded(RING, where="inner", gas={"gauge_pressure": 1e7}), "body.1.load.1.gas.gauge_pressure: 'ring' has no equilibrium with 1e+07 Pa; the largest found is "),
    "no equilibrium below": (loaded(RING, where="inner", gas={"gauge_pressure": -101325}), " Pa (accepted: -"),
    "gas a number": (loaded(RING, where="inner", gas=5e3), "gas: '5000.0' is no table (accepted: a table with gauge_pressure,"),
    "empty gas": (loaded(RING, where="inner", gas={}), "gas.gauge_pressure: is missing"),
    "exponent": (loaded(RING, where="inner", gas={"gauge_pressure": 1, "exponent": -1}), "gas.exponent: -1 is out of range (accepted: 0 to 10)"),
    "all is held": (held(where="all"), "body.1.support.1.where: the whole boundary of 'bar' is held (accepted: a part of it)"),
    "two kinds": (loaded(where="top", pressure=1, traction=[0, 1]), "body.1.load.1: has traction and pressure (accepted: one of traction,"),
    "no kind": (loaded(where="top"), "body.1.load.1: has no stress (accepted: one of traction, pressure, gas)"),
    "bdf2": (held(top={"integrator": "bdf2"}, where="left"), "integrator: 'bdf2', but supports and loads need another value (accepted: auto|"),
    "explicit": (held(top={"integrator": "central-difference"}, where="left"), "integrator: 'central-difference', but supports and loads need another value"),
    "moves without end": (held(top={"end_time": 0}, where="left", motion=[0, "t"]), "'t' is a function of time, and end_time is 0"),
    "table without end": (held(top={"end_time": 0}, where="left", motion={"t": [0, 1], "x": [0, 0], "y": [0, 1]}), "end_time: 0 with until = 'impact', but body.1 is moved"),
    "load without end": (loaded(top={"end_time": 0}, where="top", traction=[0, -1]), "end_time: 0 with until = 'impact', but body.1 is moved or loaded"),
    "nothing moves": (held(top={"end_time": 0}, where="left"), "nothing would ever move"),
    "across what is round": (held(RING, where="outer", fix="normal"), "fix: 'normal', but the part is not flat across x, y or z (accepted: all, x, y,"),
    "across what is tilted": (held(BAR | {"angle": 30}, where="left", fix="normal"), "fix: 'normal', but the part is not flat across"),
    "free component": (held(where="left", fix="x", motion=[0, "1e-3*t"]), "motion: moves along y, which fix = 'x' leaves free"),
    "fix": (held(where="left", fix="z"), "body.1.support.1.fix: 'z' is not known (accepted: all|x|y|normal)"),
    "key of a support": (held(where="left", moton=[0, 0]), "body.1.support.1.moton: no such entry, set to '[0, 0]'; did you mean motion?"),
    "key of a load": (loaded(where="left", presure=1), "body.1.load.1.presure: no such entry, set to '1'; did you mean pressure?"),
    "no list of tables": (BASE | {"body": [BAR | {"support": {"where": "left"}}]}, "body.1.support: '{'where': 'left'}' is no list of tables"),
    "release": (held(where="left", release=-1), "body.1.support.1.release: -1 is out of range (accepted: 1e-12 to 1e+09)"),
    "released at once": (held(where="left", release=0), "body.1.support.1.release: 0 is out of range"),
    "at the top": (held(where="left") | {"support": [{"where": "left"}]}, "support: no such entry, set to '[{'where': 'left'}]'; did you mean body.1.support?"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named(tmp_path, capsys, name):
    tables, message = WRONG[name]
    for file, text in FILES.items():
        (tmp_path / file).write_text(text)
    scene = tmp_path / "scene.toml"
    scene.write_text(to_toml(tables))
    assert main(["run", str(scene), "--quiet", "--out", str(tmp_path / "out")]) == 10
    error = capsys.readouterr().err
    assert message in error and len(error.splitlines()) == 1, error
    assert not (tmp_path / "out" / "summary.json").exists()


def test_symmetry_that_a_support_or_load_breaks_is_refused(tmp_path, capsys):
    """Half or a quarter of a body in space is possible only if its supports and loads are
    symmetric."""
    box = {"name": "box", "shape": "box", "width": 0.1, "height": 0.1, "depth": 0.1, "position": [0, 0, 0]}
    for word, more, message in (
            ("quarter", {"support": [{"where": "left"}]}, "'box' has a support that is not its own mirror image in the plane x = 0 (accepted: auto|full|half)"),
            ("half", {"support": [{"where": "top", "motion": [0, 0, "t"]}]}, "'box' has a support that acts along z (accepted: auto|full)"),
            ("quarter", {"load": [{"where": "top", "traction": [1, 0, 0]}]}, "'box' has a load that acts along x (accepted: auto|full|half)"),
            ("half", {"load": [{"where": {"kind": "ball", "centre": [0, 0, 0.05], "radius": 0.02}, "pressure": 1}]}, "'box' has a load that is not its own")):
        scene = tmp_path / "scene.toml"
        scene.write_text(to_toml(BASE | {"dimension": "3d", "symmetry": word, "body": [box | more]}))
        assert main(["run", str(scene), "--quiet", "--out", str(tmp_path / "out")]) == 10
        assert message in capsys.readouterr().err
