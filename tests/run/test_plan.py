"""The plan of a run: mesh, steps, time and memory without the run, and the entry that makes a long run short."""

import re
from pathlib import Path

import pytest

import ffimpact as ff
from ffimpact import scene
from ffimpact.__main__ import main
from ffimpact.running import forecast, plan, run


@pytest.mark.few(2)
@pytest.mark.parametrize("name, values", [
    ("disc-rolling", {"end_time": 0.03}),
    ("block-corner", {}),
    ("disc-beam", {"end_time": 0.004}),
])
def test_a_plan_foretells_the_run(tmp_path, monkeypatch, name, values):
    """Unknowns and the largest step are those of the run. Its steps are within the stated
    bounds, its processor time within twice these, as other processes may slow down one of the two,
    its memory to a quarter. Not all steps are taken for the plan."""
    monkeypatch.setattr(plan, "TIMED", 0.05)
    loaded = scene.load(name)
    foretold = run.plan(loaded, values | {"fields": 0}, estimate=False)
    made = run.run(loaded, values | {"fields": 0}, tmp_path / "out", estimate=False, progress=False).summary
    low, high = foretold.bounds
    assert sum(foretold.unknowns.values()) == made["dofs"] and all(count > 0 for count in foretold.elements.values())
    assert foretold.timed_steps < made["steps"] and low < 1 < high
    assert low * foretold.steps < made["steps"] < high * foretold.steps
    assert low / 2 * foretold.seconds < made["cpu_seconds"] < 2 * high * foretold.seconds
    assert 0.75 * made["peak_memory"] < foretold.memory <= 1.05 * made["peak_memory"]
    assert re.search(rf"of at most {foretold.step:.3g} s", str(foretold))


def test_a_short_run_is_known_exactly(tmp_path):
    """If the timed steps are all of the run, the plan has its steps without bounds. With an estimate the coarser
    runs and the finer ones that may follow are told apart; with a given step no finer ones follow."""
    foretold = ff.plan("disc-normal", accuracy=0.02)
    made = ff.run("disc-normal", accuracy=0.02, out=tmp_path / "out", estimate=False, figures=False)
    assert foretold.steps == made["steps"] and foretold.bounds == (1.0, 1.0) and not foretold.advice
    assert 0.4 * foretold.seconds < foretold.estimate_seconds < 0.6 * foretold.seconds < foretold.finer_seconds
    assert foretold.total_seconds == foretold.seconds + foretold.estimate_seconds
    assert "coarser runs for the error estimate" in str(foretold) and "finer runs at most follow" in str(foretold)
    given = ff.plan("disc-normal", accuracy=0.02, dt=1e-4)
    assert given.finer_seconds == 0 < given.estimate_seconds and ff.plan("disc-normal", dt=1e-4, estimate=False).estimate_seconds == 0


@pytest.mark.parametrize("name, values, entry", [
    ("disc-oblique", {"accuracy": 5e-4}, "accuracy"),
    ("two-discs", {"dt": 1e-6}, "dt"),
])
def test_the_promised_time_is_right(tmp_path, monkeypatch, name, values, entry):
    """A run with the proposed entry takes the promised time, to a factor of two. Scenes of seconds stand for long
    ones."""
    for module in (plan, forecast):
        monkeypatch.setattr(module, "LONG", 1.0)
    monkeypatch.setattr(forecast, "SHORT", 0.7)
    monkeypatch.setattr(plan, "TIMED", 0.1)
    loaded, values = scene.load(name), values | {"fields": 0}
    advice = run.plan(loaded, values, estimate=False).advice
    proposed, value, promised = re.match(r"(\w+) = (\S+) takes about (\S+) s, with ", advice).groups()
    made = run.run(loaded, values | {proposed: float(value)}, tmp_path / "out", estimate=False, progress=False).summary
    assert proposed == entry and made["cpu_seconds"] / 2 < float(promised) < 2 * made["cpu_seconds"], advice


def test_the_command_prints_the_plan_and_writes_nothing(tmp_path, monkeypatch, capsys):
    """`ffimpact run SCENE --plan` prints the table. No folder appears. What has no meaning beside it is refused in
    one line."""
    monkeypatch.chdir(tmp_path)
    assert main(["run", "two-discs", "--plan", "--no-estimate", "--set", "accuracy=0.05"]) == 0
    table = capsys.readouterr().out
    assert [line.split()[0] for line in table.splitlines()[1:]] == ["mesh", "right", "together", "steps", "time", "memory", "basis"]
    assert re.search(r"mesh +left +\d+ elements +\d+ unknowns", table) and "without an estimate of the errors" in table
    for words in (["--out", "x"], ["--force"], ["--quiet"], ["--verbose"], ["--no-figures"], ["--checkpoint-every", "5"]):
        code, error = main(["run", "two-discs", "--plan", *words]), capsys.readouterr().err
        assert code == 10 and error == f"ffimpact: --plan: makes no run, so {words[0]} has no meaning (accepted: --set, --no-estimate)\n"
    assert not list(Path(tmp_path).iterdir())


def test_a_plan_meets_the_failures_of_the_run():
    """A scene that the solver refuses is refused by the plan, with the same line."""
    with pytest.raises(ff.BadInput, match="dt: 1e-12 takes more than 1e.07 steps"):
        ff.plan("disc-normal", dt=1e-12)
