"""The display of progress: one line with nested parts, and a sentence about long runs."""

import re
import subprocess
import sys
import tempfile
import time
import types

import pytest

from examples.paper import paper as paper_making
from ffimpact import progress
from ffimpact.__main__ import main
from ffimpact.failure import BadInput
from ffimpact.input.parameters import ROOT
from ffimpact.sweeps import study


class Bar:
    """A substitute for tqdm's bar that records its calls."""

    def __init__(self, desc: str, **_):
        self.n, self.seen = 0.0, [(0.0, desc)]
        bars.append(self)

    def set_description_str(self, words: str):
        self.seen.append((self.n, words))

    def close(self):
        self.seen.append((self.n, "closed"))


bars: list[Bar] = []


@pytest.fixture
def shown(monkeypatch) -> list[Bar]:
    """The bars that a notebook shows, one for each output of a cell."""
    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=Bar))
    bars.clear()
    return bars


def test_parts_in_parts_have_one_line(shown):
    """Work in parts has one line: number of the part, its own text, and shares by the cost of the
    parts."""
    with progress.Line("paper", {"a": 1.0, "b": 3.0}) as line:
        with line.part("a", "1 of 2"):
            for k in progress.in_turn("compare", ["x", "y"]):
                with progress.Line(k, {"main run": 1.0}) as inner:
                    inner.at("main run", 0.5, "t = 1 ms")
        with line.part("b", "2 of 2"):
            pass
    bar, = shown
    assert (0.0625, "paper: 1 of 2, compare: 1 of 2, x: t = 1 ms") in bar.seen and (0.1875, "paper: 1 of 2, compare: 2 of 2, y: t = 1 ms") in bar.seen
    assert (0.25, "paper: 2 of 2") in bar.seen and bar.seen[-2:] == [(1.0, "paper: 2 of 2"), (1.0, "closed")]


def test_nobody_looks(shown, capsys):
    """If display is switched off, nothing is shown or printed. Short work prints no line in a pipe."""
    with progress.Line("run", {1: 1.0}, watched=False) as line:
        line.at(1, 0.5)
        line.say("long")
    del sys.modules["ipykernel"]
    with progress.Line("run", {1: 1.0}) as line:
        line.at(1, float("nan"))
    assert not shown and capsys.readouterr() == ("", "")


def test_a_pipe_gets_whole_lines(fake):
    """In a pipe progress is whole lines on stderr: share, elapsed and remaining time, work. --quiet prints
    none."""
    program = "from ffimpact import __main__, progress; progress.SELDOM = progress.LATER = 0.0; __main__.start()"
    words = ["run", "disc-normal", "--force", "--no-figures", "--no-estimate", "--set", "fields=0", "--out"]
    for quiet in ([], ["--quiet"]):
        with tempfile.TemporaryDirectory() as folder:
            err = subprocess.run([sys.executable, "-c", program, *words, folder, *quiet], cwd=ROOT, capture_output=True).stderr.decode()
        shares = re.findall(r"(?m)^ffimpact: (\d+) % after 0:\d\d(?:, \d+:\d\d left)?: disc-normal: main run 1 of 1, .*$", err)
        assert "\r" not in err and (not shares if quiet else {"25", "50", "75"} <= set(shares) and sorted(map(int, shares)) == list(map(int, shares)))


class Instant:
    """A timer whose time has come at its start."""

    def __init__(self, seconds: float, call, arguments):
        self.call, self.arguments = call, arguments

    def start(self):
        self.call(*self.arguments)

    def cancel(self):
        pass


def test_long_work_is_announced_in_a_pipe(capsys, monkeypatch):
    """Work that takes longer than SLOW prints one line on stderr while it goes on. Quick work, parts of
    other work and muted work print none."""
    monkeypatch.setattr(progress, "SLOW", 0.05)
    for words, seconds in (("slow", 0.3), ("quick", 0.0)):
        with progress.work(words):
            time.sleep(seconds)
            during = capsys.readouterr().err
        assert during == ("ffimpact: slow ...\n" if words == "slow" else "")
    with progress.muted(), progress.work("muted"):
        time.sleep(0.2)
    with progress.forward(lambda share, words: None), progress.work("a part"):
        time.sleep(0.2)
    assert capsys.readouterr().err == ""


def test_the_set_up_of_a_scene_says_what_it_does(fake, tmp_path, capsys, monkeypatch):
    """Search of the first contact, element sizes, meshes and the set-up of FreeFem++ are announced,
    unless --quiet."""
    monkeypatch.setattr(progress.threading, "Timer", Instant)
    words = ["run", "two-discs", "--no-figures", "--no-estimate", "--set", "fields=0", "--out"]
    for quiet in ([], ["--quiet"]):
        main([*words, str(tmp_path / f"out{len(quiet)}"), *quiet])
        announced = [line for line in capsys.readouterr().err.splitlines() if line.endswith(" ...")]
        steps = ["searching for the first contact", "choosing element sizes", "meshing the bodies", "FreeFem++ sets up the main run"]
        assert all(any(step in line for line in announced) for step in steps) if not quiet else not announced


@pytest.mark.robustness
def test_a_study_says_which_of_how_many(fake, shown, tmp_path):
    """Parallel runs report their progress before the first of them is finished. Existing runs
    count, but take no time."""
    fake("brief")
    study.study([{"speed": 4.0}], tmp_path / "sweeps/mine", {"fields": 0}, 60.0)
    study.study([{"speed": 4.0}, {"speed": 5.0}, {"speed": 6.0}], tmp_path / "sweeps/mine", {"fields": 0}, 60.0)
    first, bar = shown
    assert bar.seen[0] == (0.0, "sweeps/mine: 1 of 3 done") and bar.seen[-2:] == [(1.0, "sweeps/mine: 3 of 3 done"), (1.0, "closed")]
    assert any(0 < share < 0.5 and words.endswith("1 of 3 done") for share, words in bar.seen)


def test_paper_counts_its_parts(shown, monkeypatch, capsys):
    """make paper runs the commands of the targets of make, in their order, in one line with the
    remaining time. The first failure ends it."""
    ran = []
    monkeypatch.setattr(paper_making, "called", lambda module, words: ran.append([module, *words]) or (1 if "oblique" in words else 0))
    # A make within a make adds lines of its own.
    recipe = subprocess.run(["make", "-n", "paper"], cwd=ROOT, capture_output=True, text=True).stdout
    targets = re.search(r"--make (.*)$", recipe, re.MULTILINE)[1].split()
    assert targets[:2] == ["disc-normal", "disc-oblique"] and {"stick-slip", "verify", "contact-time-svk"} < set(targets)
    assert paper_making.make(targets) == 1 and ran[:3] == [
        ["ffimpact", "run", "disc-normal"], ["ffimpact", "compare", "disc-oblique-svk", "disc-oblique"], ["ffimpact", "run", "disc-rolling"]]
    assert ran[-1] == ["ffimpact", "sweep", "oblique"] and any(words == f"paper: 2 of {len(targets)}" for _, words in shown[0].seen)
    # Every line of a recipe.
    assert [words[0] for _, words in paper_making.commands("ball-comparison")] == ["run", "compare", "compare"]
    with pytest.raises(BadInput, match="--make: 'clean' is no target"):
        paper_making.make(["clean"])
