"""What is shown while the program works: one line, nested parts in it, a sentence about a run that will take long."""

import re
import subprocess
import sys
import types

import numpy as np
import pytest

from examples.paper import paper as paper_making
from ffimpact import progress, scene
from ffimpact.failure import BadInput
from ffimpact.freefem import freefem
from ffimpact.input.parameters import ROOT
from ffimpact.running import solver as told
from ffimpact.sweeps import study


class Bar:
    """Stands in for tqdm's: keeps what it was told."""

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
    """The bars that a notebook shows, one an output of a cell."""
    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=Bar))
    bars.clear()
    return bars


def test_parts_in_parts_have_one_line(shown):
    """Work in parts has one line: which of how many, what the part says of itself, and shares by what the parts cost."""
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
    """Where it is asked not to, nothing is shown or said; elsewhere than on a terminal or in a notebook there is no line."""
    with progress.Line("run", {1: 1.0}, watched=False) as line:
        line.at(1, 0.5)
        line.say("long")
    del sys.modules["ipykernel"]
    with progress.Line("run", {1: 1.0}) as line:
        line.at(1, float("nan"))
    assert not shown and capsys.readouterr() == ("", "")


@pytest.mark.robustness
def test_a_study_says_which_of_how_many(fake, shown, tmp_path):
    """Runs beside each other tell how far they are before the first of them is done; what was there already counts, but takes no time."""
    fake("brief")
    study.study([{"speed": 4.0}], tmp_path / "sweeps/mine", {"fields": 0}, 60.0)
    study.study([{"speed": 4.0}, {"speed": 5.0}, {"speed": 6.0}], tmp_path / "sweeps/mine", {"fields": 0}, 60.0)
    one, bar = shown
    assert bar.seen[0] == (0.0, "sweeps/mine: 1 of 3 done") and bar.seen[-2:] == [(1.0, "sweeps/mine: 3 of 3 done"), (1.0, "closed")]
    assert any(0 < share < 0.5 and words.endswith("1 of 3 done") for share, words in bar.seen)


def told_of(name: str, monkeypatch, seen: list[tuple[float, freefem.At]], given: dict | None = None, mesh_file=None) -> list[str]:
    """What is said of a run that reports these, each so many seconds after it began."""
    said, clock = [], iter(seconds for seconds, _ in seen)
    monkeypatch.setattr(told.time, "monotonic", lambda: next(clock))
    line = progress.Line(name, {"main run": 1.0})
    line.say = said.append
    run = told.Told(line, scene.load(name).override(given or {}), mesh_file, "main run", 1)
    for _, at in seen:
        run.show(at)
    return said


def steadily(seconds: float, at: freefem.At) -> list[tuple[float, freefem.At]]:
    """Reports of a run that has come `at` there in so many seconds, one step before them, and goes on at that pace."""
    return [(0.0, at._replace(share=at.share / at.steps, steps=1)), (seconds, at), (2 * seconds, at._replace(share=2 * at.share, steps=2 * at.steps))]


@pytest.mark.parametrize("name, given, at, words", [
    ("disc-normal", {"accuracy": 1e-4}, freefem.At(0.05, 1e-4, 50, 90_000), "accuracy = 0.0001"),
    ("disc-normal", {"mesh_size": 1e-3, "contact_mesh_size": 5e-4}, freefem.At(0.05, 1e-4, 50, 90_000), "contact_mesh_size = 0.0005"),
    ("disc-normal", {"dt": 1e-8}, freefem.At(0.05, 1e-4, 5000, 260), "dt = 1e-08"),
    ("disc-oblique", {"end_time": 1.0}, freefem.At(0.05, 1e-4, 5000, 260), "end_time = 1"),
    ("disc-normal", {"integrator": "central-difference"}, freefem.At(0.05, 1e-4, 5000, 260), "integrator = central-difference"),
    ("two-discs", {"body.2.young": 1e12}, freefem.At(0.05, 1e-4, 500, 900, 300.0), "a stiff body beside a soft one, whose waves take 300 times as long"),
])
def test_a_long_run_says_so_and_why(monkeypatch, name, given, at, words):
    """A run that will take longer than a minute says so once, after its first seconds, with the entry that makes it long."""
    sentence, = told_of(name, monkeypatch, steadily(6.0, at), given)
    assert sentence.startswith(f"{name}: about 2 min, for about {at.steps / at.share:.0f} steps of {at.unknowns} unknowns: {words}")
    assert not told_of(name, monkeypatch, steadily(2.5, at), given)


def reports(shares: list[float], steps: list[int]) -> list[tuple[float, freefem.At]]:
    """Reports every second: the share that seemed done, and the steps so far."""
    return [(float(k), freefem.At(share, 1e-4, count, 5000)) for k, (share, count) in enumerate(zip(shares, steps))]


def ranges(sentence: str) -> list[tuple[float, float]]:
    """The minutes and the steps of a forecast, at least and at most."""
    words = re.search(r": (.*) min, for (.*) steps of 5000 unknowns", sentence).groups()
    numbers = [[float(number) for number in re.findall(r"[0-9.]+", each)] for each in words]
    return [(each[0], np.inf if "at least" in text else each[-1]) for each, text in zip(numbers, words)]


@pytest.mark.parametrize("pace", ["steady", "slower", "recedes"])
def test_a_forecast_is_renewed_by_the_pace_of_the_run(monkeypatch, pace):
    """A run of 5 min that seems to take 2 at first: the sentences are few, each of a range beyond the one before, and the last contains, to a fifth, what
    it takes in the end; one that goes on as it began has one sentence. Where the end recedes no upper bound is claimed."""
    seconds = np.arange(300)
    first = 0.4 / 48 * seconds[:48]
    later = {"steady": 0.4 / 48 * seconds[48:120], "slower": 0.4 + 0.6 * (seconds[48:] - 47) / 253, "recedes": np.full(252, 0.4)}[pace]
    shares = np.minimum(0.99, np.concatenate([first, later]))
    said = told_of("disc-normal", monkeypatch, reports(shares.tolist(), (10 * seconds[:len(shares)] + 1).tolist()))
    found = [ranges(sentence) for sentence in said]
    assert len(said) == 1 if pace == "steady" else 2 <= len(said) <= 4
    assert all(later[0][0] > 0.9 * before[0][0] for before, later in zip(found, found[1:]))
    assert not told_of("disc-normal", monkeypatch, reports((1 - shares).tolist(), range(1, len(shares) + 1)))    # the end only recedes
    minutes, steps = len(shares) / 60, 10 * len(shares)
    if pace == "recedes":
        assert any(high == np.inf for (_, high), _ in found)
    else:
        assert all(0.8 * low <= total <= 1.25 * high for (low, high), total in zip(found[-1], (minutes, steps)))


@pytest.mark.robustness
@pytest.mark.parametrize("script, flags, apart", [("disc-plane", {"accuracy": 0.003}, 1), ("disc-block", {"accuracy": 0.01, "end_time": 3e-3}, 2)])
def test_scripts_report_the_share_of_their_steps(tmp_path, script, flags, apart):
    """Near half of its steps a script says so, to a fifth; with them it reports unknowns, and how far the waves of its bodies are apart."""
    seen = []
    assert freefem.run(freefem.find(), f"edp/{script}.edp", flags | {"without": "kernels", "out": tmp_path / "out"}, tmp_path / "log.txt", seen.append)[0] == 0
    taken = (tmp_path / "out/history.csv").read_text().count("\n") - 2
    middle = min(seen, key=lambda at: abs(at.steps / taken - 0.5))
    assert middle.share == pytest.approx(middle.steps / taken, abs=0.2) and middle.steps / taken > 0.2
    assert middle.unknowns > 100 and middle.apart == pytest.approx(apart) and 0 < seen[0].share < 0.3 and 0 < seen[0].t < 1e-3


def test_paper_counts_its_parts(shown, monkeypatch, capsys):
    """make paper runs what make's targets run, in their order, in one line with the time left; the first that fails ends it."""
    ran = []
    monkeypatch.setattr(paper_making, "called", lambda module, words: ran.append([module, *words]) or (1 if "oblique" in words else 0))
    recipe = subprocess.run(["make", "-n", "paper"], cwd=ROOT, capture_output=True, text=True).stdout   # a make within a make adds lines of its own
    targets = re.search(r"--make (.*)$", recipe, re.MULTILINE)[1].split()
    assert targets[:2] == ["disc-normal", "disc-oblique"] and {"stick-slip", "verify", "contact-time-svk"} < set(targets)
    assert paper_making.make(targets) == 1 and ran[:3] == [
        ["ffimpact", "run", "disc-normal"], ["ffimpact", "compare", "disc-oblique-svk", "disc-oblique"], ["ffimpact", "run", "disc-rolling"]]
    assert ran[-1] == ["ffimpact", "sweep", "oblique"] and any(words == f"paper: 2 of {len(targets)}" for _, words in shown[0].seen)
    assert [words[0] for _, words in paper_making.commands("ball-comparison")] == ["run", "compare", "compare"]     # every line of a recipe
    with pytest.raises(BadInput, match="--make: 'clean' is no target"):
        paper_making.make(["clean"])
