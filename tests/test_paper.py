"""The report of the paper: verdicts follow from the numbers, the page is self-contained, a missing case stops it."""

import json
import re

import numpy as np
import pandas as pd
import pytest

import fake_freefem
from orchestrate import run, scene
from orchestrate.__main__ import main
from orchestrate.report import paper, report
from orchestrate.report.paper import AGREES, DIFFERS, OPEN, PARTLY

# A disc of 1000 kg/m on a block of 20000 kg/m: three steps of contact, one of flight
M, BLOCK_M = 1000.0, 20000.0
BLOCK_RUN = {"t": [0, 0.01, 0.02, 0.03, 0.04], "normal_force": [0, 5, 5, 5, 0], "vy_1": [-10, -5, 1, 4, 4], "vy_2": [0, -0.25, -0.55, -0.7, -0.7],
             "kinetic_1": [50e3, 20e3, 5e3, 9e3, 8e3], "elastic_1": [0, 10e3, 5e3, 1e3, 2e3], "kinetic_2": [0, 10e3, 20e3, 25e3, 20e3],
             "elastic_2": [0, 9e3, 19e3, 15e3, 20e3], "kinetic": [50e3, 30e3, 25e3, 34e3, 28e3], "elastic": [0, 19e3, 24e3, 16e3, 22e3], "contact": [0, 1e3, 1e3, 0, 0]}
BLOCK_END = {"mass_1": M, "mass_2": BLOCK_M, "energy_initial": 50e3, "vibration_energy_1": 2e3, "vibration_energy_2": 35.1e3, "estimated_error": {"rebound": 0.002}}


def altered(**changes) -> dict:
    """History and summary of the disc on the block, with some columns or numbers changed."""
    return {"history": BLOCK_RUN | {name: value for name, value in changes.items() if name in BLOCK_RUN},
            "summary": BLOCK_END | {name: value for name, value in changes.items() if name in BLOCK_END}}


FIND = {find.__name__: find for _, _, find in paper.STATEMENTS}


class Stub(paper.Results):
    """Results that are given as they are: summaries and histories by run, tables by sweep."""

    def __init__(self, folder, **given):
        super().__init__(folder)
        self.given = given

    def summary(self, name):
        return self.given["summary"]

    def history(self, name):
        return {column: np.array(values, dtype=float) for column, values in self.given["history"].items()}

    def table(self, name):
        return pd.DataFrame({"exit": 0} | self.given["table"])

    def sweep_runs(self, name):
        return []


def speeds(times, error=1e-5, nu=(0.3, 0.45)) -> dict:
    n = len(times)
    return {"speed": list(np.linspace(1, 11, n)) * len(nu), "nu": np.repeat(nu, n), "contact_time": list(times) * len(nu),
            "contact_time_error": error, "exit": 0}


@pytest.mark.parametrize("name, given, verdict, words", [
    ("angles", {"table": dict(nu=[0.3], rebound_vx=3.0, rebound_vy=8.7, rebound_vx_error=0.01, rebound_vy_error=0)}, AGREES, "60° in, 71.0 ± 0.06°"),
    ("angles", {"table": dict(nu=[0.3], rebound_vx=6.0, rebound_vy=6 * 3**0.5, rebound_vx_error=0, rebound_vy_error=0)}, DIFFERS, "60.0 ± 0°"),
    ("oblique_coarse", {"summary": dict(contact_time=4.5e-3, breakdown_time=None, ellipticity_lost_time=1.1e-4, dofs=300)}, PARTLY, "4.500 ms"),
    ("oblique_coarse", {"summary": dict(contact_time=4.6e-3, breakdown_time=2e-3, ellipticity_lost_time=1e-4, dofs=300)}, DIFFERS, "det F ≤ 0 from 2.00 ms on"),
    ("oblique_converged", {"table": dict(nu=[0.3, 0.45], contact_time=[4.4e-3, 4.1e-3], contact_time_error=[6e-5, 1e-5])}, PARTLY, "ν = 0.3: 4.40 ± 0.06"),
    ("oblique_converged", {"table": dict(nu=[0.3, 0.45], contact_time=[4.5e-3, 4.5e-3], contact_time_error=0, exit=12)}, DIFFERS, ""),
    ("oblique_converged", {"table": dict(nu=[0.3, 0.45], contact_time=[4.2e-3, 4.1e-3], contact_time_error=[1e-5, 1e-5])}, DIFFERS, ""),
    ("oscillates", {"history": dict(normal_force=[0, 5, 3, 6, 0])}, AGREES, "2 maxima"),
    ("oscillates", {"history": dict(normal_force=[0, 5, 6, 0])}, DIFFERS, "1 maxima"),
    ("alternates", {"history": dict(normal_force=[1, 1, 1, 1, 1], sliding_fraction=[0.1, 0.5, 0.1, 0.5, 0])}, AGREES, "2 maxima"),
    ("alternates", {"history": dict(normal_force=[0, 1, 1, 1, 1], sliding_fraction=[0, 0, 0.04, 0, 1])}, DIFFERS, "0 maxima"),
    ("energy", {"history": dict(kinetic=[9, 5, 8, 8], elastic=[0, 2, 0, 0], contact=[0, 1, 0, 0], normal_force=[0, 1, 1, 0],
                                friction_work=[0, 1, 1, 1], balance=[0, 0, 0, 1e-10])}, AGREES, "11.1 % are lost"),
    ("energy", {"history": dict(kinetic=[9, 5, 8, 8.1], elastic=[0, 2, 0, 0], contact=[0, 1, 0, 0], normal_force=[0, 1, 1, 0],
                                friction_work=[0, 1, 1, 1], balance=[0, 0, 0, 0.1])}, DIFFERS, ""),
    ("conserves", {"summary": dict(energy_drift=1e-11)}, AGREES, "1e-11"),
    ("conserves", {"summary": dict(energy_drift=1e-6)}, DIFFERS, ""),
    ("stepped", {"table": speeds([5e-3, 4.8e-3, 4.9e-3, 4.5e-3, 4.6e-3, 4e-3])}, AGREES, "2 of 5 steps rise, 2 of them by more than their error bar, 2 "),
    ("stepped", {"table": speeds([5e-3, 4.8e-3, 4.9e-3, 4.5e-3])}, PARTLY, "not told from the errors"),
    ("stepped", {"table": speeds([5e-3, 4.8e-3, 4.9e-3, 4.5e-3, 4.6e-3, 4e-3], error=6e-5)}, PARTLY, "2 of them by more than their error bar, 0 "),
    ("stepped", {"table": speeds([4.5e-3, 4.9e-3, 4.8e-3, 5e-3])}, DIFFERS, ""),
    ("stepped", {"table": speeds([5e-3, 4.8e-3, 4.7e-3, 4.5e-3]) | {"exit": [0, 0, 0, 0, 12, 12, 0, 0]}}, DIFFERS, "ν = 0.45: too few runs finished"),
    ("monotone", {"table": speeds([5e-3, 4.8e-3, 4.7e-3, 4.5e-3])}, AGREES, "0 of 3 steps rise"),
    ("monotone", {"table": speeds([5e-3, 4.8e-3, 4.9e-3, 4.5e-3])}, DIFFERS, ""),
    ("monotone", {"table": speeds([5e-3, 4.8e-3, 4.7e-3, 4.5e-3], error=1e-3)}, PARTLY, "a small rise would not show"),
    ("monotone", {"table": speeds([5e-3, 4.8e-3, 4.7e-3, 4.5e-3]) | {"exit": 12}}, DIFFERS, "too few runs finished"),
    ("rebounds", altered(), AGREES, "SVK: 4.00 ± 0.02 m/s; neo-Hookean: 4.00"),
    ("rebounds", altered(vy_1=[-10, -5, -1, -0.4, -0.4]), DIFFERS, "-0.40"),
    ("rebounds", altered(vy_1=[-10, -5, -1, 0.01, 0.01]), DIFFERS, "0.01 ± 0.02"),
    ("rebounds", altered(estimated_error=None), DIFFERS, "4.00 ± nan"),
    ("downwards", altered(), AGREES, "-0.7000 ± 0.001 m/s, e = 0.470 (between -0.476 for e = 0 and -0.952 m/s for e = 1"),
    ("downwards", altered(vy_2=[0, 0, 0, 0, -0.70001]), DIFFERS, "momentum kept to 2e-05"),
    ("downwards", altered(vy_1=[-10, 0, 0, 0, -0.6], vy_2=[0, 0, 0, 0, -0.47]), DIFFERS, "momentum kept to"),
    ("downwards", altered(vy_1=[-10, 0, 0, 0, 9.2], vy_2=[0, 0, 0, 0, -0.96]), DIFFERS, "e = 1.016"),
    ("passes", altered(), AGREES, "the disc keeps 20.0 % (4.0 % as vibration), the block has 80.0 % (70.2 %), each constant to 0e+00; in the contact the disc was down to 20.0 %"),
    ("passes", altered(elastic_1=[0, 10e3, 1e3, 1e3, 2e3]), AGREES, "the disc was down to 12.0 %, at 20 ms"),
    ("passes", altered(elastic_1=[0, 10e3, 5e3, 1e3, 2.1e3]), DIFFERS, "each constant to 2e-03"),
    ("passes", altered(elastic_1=[0, 10e3, 5e3, 51e3, 52e3]), DIFFERS, "the disc keeps 120.0 %"),
    ("passes", altered(kinetic_2=[50e3, 10e3, 20e3, 25e3, 20e3]), DIFFERS, "the block has 80.0 %"),
    ("passes", altered(normal_force=[0, 5, 5, 5, 5]), DIFFERS, "each constant to inf"),
    ("total", altered(), AGREES, "SVK: constant to 0e+00, at most 2.0 % of it in the contact"),
    ("total", altered(kinetic=[50e3, 30e3, 25e3, 34e3, 28.001e3]), DIFFERS, "SVK: constant to 2e-05"),
    ("disc_time", {"table": dict(law="svk", nu=0.3, penalty=[1e9, 1e10], contact_time=[4.9e-3, 4.8e-3], exit=0), "summary": dict(contact_time=4.67e-3)},
     AGREES, "met for ν = 0.3: k = 3.2e+09 to 1e+10 [Pa/m]"),
    ("disc_time", {"table": dict(law=["neohookean"], nu=[0.3], penalty=1e9, contact_time=[4.8e-3], exit=0), "summary": dict(contact_time=4.67e-3)},
     DIFFERS, "met for no ν and k"),
    ("conserves", {"summary": dict(energy_drift=2e-11)}, AGREES, "constant to 2e-11"),
    ("conserves", {"summary": dict(energy_drift=2e-6)}, DIFFERS, "constant to 2e-06"),
    ("ball", {"summary": dict(contact_time=6.031e-3, dofs=90, ellipticity_lost_time=1.2e-3)}, PARTLY, "6.03 ms on one coarse mesh of linear triangles (90 dofs)"),
    ("ball", {"summary": dict(contact_time=5.8e-3, dofs=90, ellipticity_lost_time=None)}, DIFFERS, "ellipticity kept"),
    ("longest", {"table": dict(speed=[8.0], nu=0.45, contact_time=4.1e-3), "summary": dict(contact_time=4.7e-3)}, DIFFERS, "disc: SVK 4.70 ms, neo-Hookean 4.10 ms"),
    ("longest", {"table": dict(speed=[7.0], nu=0.45, contact_time=4.1e-3), "summary": dict(contact_time=4.7e-3)}, DIFFERS, "failed"),
])
def test_verdicts_follow_from_the_numbers(tmp_path, monkeypatch, name, given, verdict, words):
    """Each statement is judged by its rule, whatever the numbers are."""
    monkeypatch.setattr(paper, "_both", lambda results: [results.history("")] * 2)
    found = FIND[name](Stub(tmp_path, **given))
    assert found.verdict == verdict and words in found.ours


@pytest.mark.parametrize("broken, verdict", [(None, AGREES), ("disc-block-neohookean", PARTLY), ("disc-block", DIFFERS)])
def test_the_papers_law_decides_on_the_block(tmp_path, monkeypatch, broken, verdict):
    """Section 3.2 with both laws: partly where only the paper's holds, no agreement where the paper's does not."""
    sticks = altered(vy_1=[-10, -5, -2, -0.5, -0.5])["history"]
    monkeypatch.setattr(Stub, "history", lambda _, name: {column: np.array(values) for column, values in (sticks if name == broken else BLOCK_RUN).items()})
    assert FIND["rebounds"](Stub(tmp_path, **altered())).verdict == verdict


def test_the_block_is_the_papers_with_either_law():
    """Section 3.2: radius 0.5 m, 10 m x 2 m, 10 m/s straight down, E = 7 MPa, 1722 kg/m3, no friction, no gravity; only the law differs."""
    svk, other = (scene.load(name).values for name in paper.BLOCK)
    assert {name for name in svk if svk[name] != other[name]} == {"law"} and (svk["law"], other["law"]) == ("svk", "neohookean")
    assert [svk[name] for name in ("radius", "block_width", "block_height", "speed", "angle", "young", "density", "friction_static", "gravity")] == [
        0.5, 10, 2, 10, 90, 7e6, 1722, 0, 0]


def test_the_balls_contact_is_the_longest(tmp_path, monkeypatch):
    """Figure 11: the SVK ball beside both discs, the neo-Hookean ball beside the disc of its law."""
    times = {"disc-normal": 4.7e-3, "ball-axisymmetric-svk": 5.8e-3, "ball-axisymmetric": 5e-3}
    monkeypatch.setattr(Stub, "summary", lambda _, name: {"contact_time": times[name]})
    table = {"table": dict(speed=[8.0], nu=0.45, contact_time=4.1e-3)}
    assert FIND["longest"](Stub(tmp_path, **table)).verdict == AGREES
    times["ball-axisymmetric"] = 4e-3
    assert FIND["longest"](Stub(tmp_path, **table)).verdict == DIFFERS


def test_longer_contact_must_exceed_both_error_bars(tmp_path, monkeypatch):
    """Figure 7b."""
    monkeypatch.setattr(paper, "_distance", lambda *_: (0.3, 0.01))
    rows = lambda longer: {"table": dict(speed=10, law=["svk", "neohookean"], contact_time=[4e-3 + longer, 4e-3], contact_time_error=1e-5)}   # noqa: E731
    assert FIND["longer_at_high_speed"](Stub(tmp_path, **rows(1e-4))).verdict == AGREES
    assert FIND["longer_at_high_speed"](Stub(tmp_path, **rows(1.5e-5))).verdict == DIFFERS


def test_every_statement_of_the_paper_is_there():
    """Every item of the paper that has a number or a claim."""
    items = " ".join(item for item, _, _ in paper.STATEMENTS)
    assert all(word in items for word in ("4b", "5a", "5b", "6a", "6b", "7a", "7b", "Figure 8", "figure 9", "figure 10", "figure 11"))


def test_maxima_must_stand_out():
    """Wiggles below the threshold are none."""
    t = np.linspace(0, 1, 400)
    assert paper.maxima(np.sin(np.pi * t), 0.01) == 1
    assert paper.maxima(np.sin(np.pi * t) + 0.2 * np.sin(20 * np.pi * t), 0.02) > 3
    assert paper.maxima(np.sin(np.pi * t) + 0.001 * np.sin(200 * np.pi * t), 0.02) == 1
    assert paper.maxima(np.zeros(5), 0.01) == 0


def test_page_holds_everything_itself(tmp_path):
    """Pictures inside, no link to other places, every statement with its verdict, parameters and provenance of its runs."""
    fake_freefem.write_scene(tmp_path, dict(law="svk", nu="0.45", speed="7"))
    (tmp_path / "summary.json").write_text(json.dumps({"provenance": dict(git="abc", code="def", freefem="4.9", gmsh="4", mesh="0123")}))
    (tmp_path / "a.png").write_bytes(b"\x89PNG picture")
    text = paper.page([("Figure 1", "a < b", paper.Finding(AGREES, "2 & 3", [tmp_path / "a.png"], [tmp_path])),
                       ("Figure 2", "later", paper.Finding(OPEN, "to come"))])
    assert "a &lt; b" in text and "2 &amp; 3" in text and text.count("data:image/png;base64,") == 1
    assert not re.search(r'(src|href)="(?!data:|#)', text) and "1 agrees, 0 does not agree" in text
    assert all(word in text for word in ("speed = 7", "code sha256   def", "mesh sha256   0123", "to come"))
    assert "nu = 0.45" not in text, "a parameter at its default"


def test_a_missing_case_stops_it(tmp_path, capsys):
    """One line names every make target that is missing, exit code 14, and no page is written."""
    assert main(["paper", "--results", str(tmp_path)]) == 14
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and not (tmp_path / "paper").exists()
    assert "run: make disc-normal disc-oblique disc-rolling disc-block ball-axisymmetric calibrate contact-time-neohookean" in err and "stick-slip friction-laws" in err


@pytest.mark.parametrize("change", ["nothing", "code", "scene", "picture", "failed", "broken"])
def test_only_results_of_the_present_scenes_and_code_count(fake, tmp_path, monkeypatch, change):
    """A case of other code, of another scene, without its picture, that ended by its time limit, or unreadable, is as good as missing."""
    place = tmp_path / "disc-normal"
    report.draw(run.run(scene.load("disc-normal"), {"speed": 4} if change == "scene" else {}, out=place))
    path = place / "summary.json"
    if change == "code":
        path.write_text(path.read_text().replace(run.code_hash(), "other"))
    if change == "picture":
        (place / "figures/energies.png").unlink()
    if change == "failed":
        path.unlink()
        (place / "failure.json").write_text(json.dumps({"exit_code": 124, "provenance": {}}))
    if change == "broken":
        path.write_text("{")
    with pytest.raises(paper.Failure) as error:
        paper.Results(tmp_path).require()
    assert ("disc-normal" in str(error.value)) == (change != "nothing") and error.value.code == 14


def test_values_are_listed_as_numbers(tmp_path):
    """The range of what was varied goes from the smallest to the largest number."""
    for k, speed in enumerate((0.5, 9.9, 12.1, 1, 2, 3, 4, 5, 6)):
        (tmp_path / str(k)).mkdir()
        fake_freefem.write_scene(tmp_path / str(k), dict(speed=str(speed)))
    assert "speed: 9 values from 0.5 to 12.1" in paper._provenance(sorted(tmp_path.iterdir()))
