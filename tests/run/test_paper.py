"""The report of the paper: verdicts change with their numbers, the page is self-contained, a
missing case stops it."""

import json
import re

import pandas as pd
import pytest

from examples.paper import (
    bodies as paper_bodies,
    judging as paper_judging,
    page as paper_page,
    paper,
    stick_slip,
)
from examples.paper.judging import AGREES, DIFFERS, OPEN, STATEMENTS, Finding
from ffimpact import __version__, scene
from ffimpact.__main__ import guarded
from ffimpact.failure import Failure
from ffimpact.input.parameters import ROOT
from ffimpact.report import figures, report
from ffimpact.running import run
from ffimpact.sweeps import sweep, sweep_figures
from tests.support import fake_freefem
from tests.support.paper import (
    CASES,
    FIND,
    LOST,
    NEO,
    OBLIQUE,
    SVK,
)
from tests.support.paper_results import (
    Memory,
    base,
)


@pytest.mark.parametrize("name, change, verdict, words", [(name, *case) for name, cases in CASES.items() for case in cases])
def test_verdicts_follow_from_the_numbers(tmp_path, name, change, verdict, words):
    """Each statement is judged by its criterion, whatever the numbers are."""
    data = base()
    change(data)
    finding = FIND[name](Memory(tmp_path, data))
    assert finding.verdict == verdict and words in finding.ours, finding.ours


# No SVK run, or only runs that keep ellipticity.
OTHERS = {"friction_laws", "adopted", "monotone", "disc_time", "stepped", "reflections", "incompressible", "slip_limit", "in_space"}
# Conserved by every step on any mesh.
EXACT = {"energy", "total_energy", "conserves", "accelerations"}


@pytest.mark.few(8)
@pytest.mark.parametrize("name", sorted(set(FIND) - OTHERS))
def test_lost_ellipticity_is_judged_by_one_rule(tmp_path, name):
    """If every SVK run has lost ellipticity, no change of the results makes a statement about it
    agree, unless it is about exact conservation."""
    for change, _, _ in CASES[name]:
        data = base()
        change(data)
        for runs in (data["summary"], data["stick-slip"]):
            if isinstance(runs, dict):
                runs.update({key: end | {"ellipticity_lost_time": LOST} for key, end in runs.items()})
            else:
                runs["ellipticity_lost_time"] = LOST
        data["summaries"] = {key: [end | {"ellipticity_lost_time": LOST} for end in ends] for key, ends in data["summaries"].items()}
        data["table"] = {key: table.assign(ellipticity_lost_time=LOST) for key, table in data["table"].items()}
        finding = FIND[name](Memory(tmp_path, data))
        assert finding.verdict != AGREES or name in EXACT and "on any mesh" in finding.ours, finding.ours


@pytest.mark.parametrize("name", FIND)
def test_a_verdict_names_its_data(tmp_path, name):
    """The page has parameters and provenance of every run that a statement reads. Every statement
    reads runs or refers to them."""
    results = Memory(tmp_path, base())
    finding = FIND[name](results)
    assert results.read <= set(finding.runs) and (finding.runs or "laws.csv" in finding.ours) and (
        finding.figures or name == "incompressible")


def test_figures_6b_and_8_are_over_the_same_speeds():
    """Both have one grid with error bars, the time above 1 % of the peak force and the loss of
    ellipticity.

    It has at least 40 speeds from 0.5 to 11 m/s and beyond, for ν = 0.3 and 0.45.
    """
    svk, neo = (sweep.load(name) for name in (SVK, NEO))
    assert svk.points == neo.points and svk.refine == neo.refine != {} and {point["nu"] for point in svk.points} == {0.3, 0.45}
    speeds = {point["speed"] for point in svk.points if point["speed"] <= 11}
    assert len(speeds) >= 40 and min(speeds) == 0.5 and max(speeds) > 10.75
    for plan in (svk, neo, sweep.load("calibrate")):
        assert {"thresholded_contact_time", "ellipticity_lost_time"} <= set(plan.collect)


def test_the_control_differs_in_the_jump_alone():
    """friction-jump has the same runs with equal coefficients, for both laws, on two meshes."""
    plan = sweep.load("friction-jump")
    used = [scene.load(plan.scene).override(plan.base | point) for point in plan.points]
    assert {(run.bodies[0].made_of.law, run.contact_values["friction_static"], run.contact_values["friction_dynamic"]) for run in used} == {(law, static, 0.5) for law in ("svk", "neohookean") for static in (0.7, 0.5)}
    assert plan.refine.keys() == {"mesh_size", "contact_mesh_size"} and {run.contact_values["regularization"] for run in used} == {"linear"}


def test_page_holds_everything_itself(tmp_path):
    """The figures are inside, there are no external links, and every statement has its verdict,
    parameters and provenance of its runs."""
    (tmp_path / "scene.toml").write_text(fake_freefem.SCENE.replace("speed = 8", "speed = 7"))
    (tmp_path / "summary.json").write_text(json.dumps({"provenance": dict(git="abc", code="def", freefem="4.9", gmsh="4", mesh="0123")}))
    (tmp_path / "a.png").write_bytes(b"\x89PNG picture")
    text = paper_page.page([("Figure 1", "a < b", Finding(AGREES, "2 & 3", [tmp_path / "a.png"], [tmp_path])),
                       ("Figure 2", "later", Finding(OPEN, "to come"))])
    assert "a &lt; b" in text and "2 &amp; 3" in text and text.count("data:image/png;base64,") == 1
    assert not re.search(r'(src|href)="(?!data:|#)', text) and "1 agrees, 0 does not agree" in text
    assert all(word in text for word in ("speed = 7", "code sha256   def", "mesh sha256   0123", "to come"))
    assert "nu = 0.45" in text and "density" not in text, "nu, which the paper does not state, always; else no parameter at its default"


def test_page_leads_to_every_statement_and_back(tmp_path):
    """There are contents with a link to each statement, links back, captions, every figure once,
    and the version of the program."""
    picture = tmp_path / "sweeps/oblique/sweep.png"
    picture.parent.mkdir(parents=True)
    picture.write_bytes(b"picture")
    text = paper_page.page([("Figure 1", "first", Finding(AGREES, "1", [picture])), ("Figure 2", "second", Finding(DIFFERS, "2", [picture]))])
    for k in (0, 1):
        assert text.count(f'id="s{k}"') == text.count(f'id="row{k}"') == text.count(f'href="#row{k}"') == 1
        assert f'<li><a href="#s{k}">Figure {k + 1}</a>: {("first", "second")[k]}</li>' in text
    assert text.count('href="#top"') == 3 and text.count('id="top"') == 1 and text.count("data:image/png") == 1
    assert f'<figcaption><b>Figure 1.</b> {sweep.load("oblique").title} (make oblique) (<a href="#s0">Figure 1</a>)</figcaption>' in text
    assert text.count('id="figure1"') == 1 and text.count('<a href="#figure1">Figure 1</a> above') == 1
    anchors, links = re.findall(' id="([^"]+)"', text), re.findall(' href="#([^"]+)"', text)
    assert set(links) <= set(anchors) and len(anchors) == len(set(anchors))
    assert f"by ffimpact {__version__}" in text and run.code_hash() in text


def test_pictures_say_what_they_show():
    """A run has the title of its scene, a sweep its title. No figure of the page has its file name
    as caption."""
    results = paper_judging.Results(ROOT / "results")
    pictures = [*(results.drawn(f"{name}/{kind}")[0] for name, kinds in paper.RUNS.items() for kind in kinds), *(results.drawn(name)[0] for name in sweep.built_in()),
                results.folder / "stick-slip/stick-slip.png", results.folder / "friction-laws/friction-laws.png", results.folder / paper_bodies.ACCELERATIONS]
    assert not [path for path in pictures if len(paper_page.caption(path)) < 30]


def test_the_page_of_all_statements(tmp_path, monkeypatch, capsys):
    """The command writes the page with every statement, verdict and figure, and prints the same.
    The counts add up."""
    memory = Memory(tmp_path, base())
    for *_, find in STATEMENTS:
        for path in find(memory).figures:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(b"picture")
    monkeypatch.setattr(paper.judging, "Results", lambda folder: memory)
    monkeypatch.setattr(paper, "require", lambda results: None)
    monkeypatch.setattr(paper, "verification", lambda folder: '<h2 id="verification">Verification</h2>')
    assert guarded(paper.main, ["--results", str(tmp_path)]) == 0
    text, output = (tmp_path / "paper/report.html").read_text(), capsys.readouterr().out
    assert all(f'id="s{k}"' in text for k in range(len(STATEMENTS))) and 'href="#verification"' in text
    assert sum(int(number) for number, _ in re.findall(f"([0-9]+) ({'|'.join(paper.COLOURS)})", output.splitlines()[-2])) == len(STATEMENTS)


def test_the_pictures_of_the_page_are_asked_for(tmp_path):
    """The figures of runs on the page are those that the cases must have left."""
    results = Memory(tmp_path, base())
    shown = {(path.parent.parent.name, path.stem) for *_, find in STATEMENTS for path in find(results).figures if path.parent.name == "figures"}
    assert shown == {(name, kind) for name, kinds in paper.RUNS.items() for kind in kinds}


def test_a_missing_case_stops_it(tmp_path, capsys):
    """One line has every missing make target, with exit code 14, and no page is written."""
    assert guarded(paper.main, ["--results", str(tmp_path)]) == 14
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and not (tmp_path / "paper").exists()
    assert "run: make disc-normal ball-comparison disc-oblique disc-rolling disc-block ball ball-axisymmetric calibrate calibrate-ball calibrate-ball-3d calibrate-oblique closest-points conservation" in err and "stick-slip friction-laws" in err


@pytest.mark.few(2)
@pytest.mark.parametrize("change", ["nothing", "code", "scene", "picture", "failed", "broken"])
def test_only_results_of_the_present_scenes_and_code_count(fake, tmp_path, monkeypatch, change):
    """A case of other code or another scene, without its figure, ended by its time limit, or
    unreadable counts as missing."""
    place = tmp_path / "disc-normal"
    report.draw(run.run(scene.load("disc-normal"), {"speed": 4} if change == "scene" else {}, out=place))
    path = place / "summary.json"
    if change == "code":
        path.write_text(path.read_text().replace(run.code_hash(), "other"))
    if change == "picture":
        (place / "figures/force.png").unlink()
    if change == "failed":
        path.unlink()
        (place / "failure.json").write_text(json.dumps({"exit_code": 124, "provenance": {}}))
    if change == "broken":
        path.write_text("{")
    with pytest.raises(Failure) as error:
        paper.require(paper_judging.Results(tmp_path))
    assert ("disc-normal" in str(error.value)) == (change != "nothing") and error.value.code == 14


def test_values_are_listed_as_numbers(tmp_path):
    """The range of a varied parameter goes from its smallest to its largest number."""
    for k, speed in enumerate((0.5, 9.9, 12.1, 1, 2, 3, 4, 5, 6)):
        (tmp_path / str(k)).mkdir()
        (tmp_path / str(k) / "scene.toml").write_text(fake_freefem.SCENE.replace("speed = 8", f"speed = {speed}"))
    assert "speed: 9 values from 0.5 to 12.1" in paper_page.provenance_of(sorted(tmp_path.iterdir()))


def test_the_map_of_the_oblique_disc_has_both_angles(tmp_path):
    """There is a row of maps for each angle to the plane and a column for each mesh. The text about
    the level mentions both."""
    plan = sweep.load(OBLIQUE)
    table = pd.DataFrame(plan.points).assign(exit=0, contact_time=4.4e-3)
    table.loc[table.penalty < 5e8, "contact_time"] = 5e-3
    sweep_figures.draw(plan, table, tmp_path)
    text = "\n".join(sweep_figures.findings(plan, table, tmp_path))
    assert figures.plt.imread(tmp_path / "sweep.png").std() > 0
    assert all(f"direction = -{angle} deg, mesh size = {size} m: contact time = 4.5" in text for angle in (60, 30) for size in (0.01, 0.008))


def test_the_search_is_drawn_for_both_angles(tmp_path):
    """Sliding and sticking at 60 and 30 degrees from the plane, for both laws: a point for each
    run, counted by angle and law."""
    axes = {name: values[-2:] for name, values in stick_slip.AXES.items()}
    table = pd.DataFrame(stick_slip.grid(axes)).assign(exit=0, contact_time=4.5e-3, first=1.0, second=0.9, last=0.3, work_last=0.01, quiet=True, time=True)
    table["angle"] = -table.direction
    table["order"] = stick_slip.as_told(table)
    stick_slip.draw(table, axes, tmp_path / "map.png")
    text = stick_slip.report(table)
    assert (tmp_path / "map.png").stat().st_size > 10_000
    assert all(f"{angle} degrees, {stick_slip.LAWS[law]}: of 8 runs 8 slide first" in text for angle in (60, 30) for law in stick_slip.LAW)
