"""The report of the paper: verdicts change with their numbers, the page is self-contained, a
missing case stops it."""

import os
import re

import numpy as np
import pytest

from examples.paper import (
    bodies as paper_bodies,
    friction as paper_friction,
    page as paper_page,
    scripts,
)
from examples.paper.judging import DIFFERS, STATEMENTS, maxima
from ffimpact import scene
from ffimpact.input.parameters import ROOT
from ffimpact.report import figures
from tests.support.paper import (
    CASES,
    FIND,
    SAME,
)


@pytest.mark.parametrize("name", FIND)
def test_every_verdict_can_fail(name):
    """For each statement some change of the results changes the verdict, and some change gives
    "does not agree"."""
    verdicts = {verdict for _, verdict, _ in CASES[name]}
    assert DIFFERS in verdicts and len(verdicts) > 1 and CASES[name][0][0] is SAME


def test_only_statements_have_cases():
    """Every case belongs to a statement, and the names of the statements differ."""
    assert set(CASES) == set(FIND) and len(FIND) == len(STATEMENTS)


def test_rigid_disc_stops_to_slide():
    """The share of the impulse from steps of the balance of a rigid disc: friction reduces the slip
    by 3/m per unit of impulse."""
    e, v_n, v_t, mu = 0.8355, 12 * np.sin(np.pi / 3), 6.0, 0.5
    pushes = np.linspace(0, (1 + e) * v_n, 100001)[1:]
    slip = v_t - 3 * mu * pushes
    assert paper_friction.slip_share(e) == pytest.approx(np.argmax(slip <= 0) / len(slip), rel=1e-3) == pytest.approx(0.21, abs=0.001)


def test_load_changes_are_weighted_with_the_load():
    """A change without load does not count. A constant load that changes to sliding and back counts
    two."""
    history = lambda force: {"normal_force": np.array(force), "sliding_fraction": np.array([0, 0, 1, 1, 0, 0.0])}   # noqa: E731
    assert paper_friction.load_changes(history([1, 1, 1, 1, 1, 1.0])) == pytest.approx(2)
    assert paper_friction.load_changes(history([4, 1e-9, 1e-9, 1e-9, 1e-9, 4])) < 1e-6


def test_no_statement_says_how_the_paper_ran_it():
    """The paper gives neither mesh nor step, so texts may only assume how it was run."""
    files = [ROOT / name for name in ("README.md", "Makefile")] + [*(ROOT / "orchestrate/ffimpact").rglob("*.py"), *(ROOT / "orchestrate").rglob("*.toml")]
    assert not [path for path in files if "as the paper ran it" in path.read_text()]


def test_the_block_is_the_papers_with_either_law():
    """Section 3.2: radius 0.5 m, 10 m x 2 m, 10 m/s vertically, E = 7 MPa, 1722 kg/m3, no friction,
    no gravity. Only the law differs."""
    svk, other = (scene.load(name) for name in paper_bodies.BLOCK.values())
    assert {name for name in svk.content if svk.content[name] != other.content[name]} == {"law", "title"}
    assert [body.made_of.law for body in (*svk.bodies, *other.bodies)] == ["svk", "svk", "neohookean", "neohookean"]
    (disc, block), values = svk.content["body"], svk.values
    assert (disc["radius"], disc["speed"], disc["direction"], disc["position"]) == (0.5, 10, -90, [0, 0.5])
    assert (block["width"], block["height"], block["position"]) == (10, 2, [0, -1]) and svk.bodies[0].made_of.young == 7e6 and svk.bodies[1].made_of.density == 1722
    assert svk.contact_values["friction_static"] == 0 and values["gravity"] == 0


def test_every_statement_of_the_paper_is_there():
    """Every item of the paper with a number or a claim has a statement."""
    items = " ".join(item for item, _, _ in STATEMENTS)
    assert all(word in items for word in ("4b", "5a", "5b", "6a", "6b", "7a", "7b", "Figure 8", "figure 9", "figure 10", "figure 11"))


def test_maxima_must_stand_out():
    """Oscillations below the threshold do not count."""
    t = np.linspace(0, 1, 400)
    assert maxima(np.sin(np.pi * t), 0.01) == 1
    assert maxima(np.sin(np.pi * t) + 0.2 * np.sin(20 * np.pi * t), 0.02) > 3
    assert maxima(np.sin(np.pi * t) + 0.001 * np.sin(200 * np.pi * t), 0.02) == 1
    assert maxima(np.zeros(5), 0.01) == 0


def test_text_of_all_pictures_has_one_size(tmp_path):
    """Figures have their drawn width on the page: 5 inches are twice as wide as 2.5."""
    for inches in (2.5, 5.0):
        figure = figures.plt.figure(figsize=(inches, 1), dpi=figures.STYLE["savefig.dpi"])
        figure.savefig(tmp_path / f"{inches}.png")
        figures.plt.close(figure)
    widths = [int(re.search(' width="([0-9]+)"', paper_page.picture_of(tmp_path / f"{inches}.png"))[1]) for inches in (2.5, 5.0)]
    assert widths[1] == pytest.approx(2 * widths[0], abs=1) and widths[1] == pytest.approx(5 * paper_page.PIXELS, abs=2)


def test_runs_of_the_scripts():
    """Each run of the paper's scripts has flags that its script reads, and pairs() names runs."""
    every = scripts.runs()
    for script, flags in every.values():
        text = (ROOT / f"edp/{script}.edp").read_text()
        assert {name for name in flags if not re.search(rf'(?:number|word)\("{name}"', text)} == set()
    assert {name for kind in scripts.FORMULATIONS for width in ("auto", scripts.SEPARATION) for name in scripts.pair(kind, width)} < set(every)


def test_a_run_of_an_older_script_is_not_finished(tmp_path):
    """A run counts if its answers are newer than all files of its script."""
    assert not scripts.is_finished(tmp_path, "disc-plane")
    (tmp_path / scripts.ANSWERS).write_text("{}")
    assert scripts.is_finished(tmp_path, "disc-plane")
    os.utime(tmp_path / scripts.ANSWERS, (0, 0))
    assert not scripts.is_finished(tmp_path, "disc-plane")
