"""The runs of a scene: the run for the error estimate uses a second core if one is free; results
after the loss of a run."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest

from ffimpact import scene
from ffimpact.failure import Failure
from ffimpact.freefem import freefem
from ffimpact.output import estimate
from ffimpact.running import run, solver
from ffimpact.scenes import finer
from tests.support.checkpoint import EFFORT
from tests.support.kills import at_work
from tests.support.solver import ANSWERS, SCENES, go


@pytest.fixture
def order(monkeypatch):
    """The starts and ends of runs in their order, by the names of the folders. The main run is
    "out.part"."""
    seen, start = [], freefem.start

    @contextmanager
    def recorded(program, script, flags, log, lock=None):
        seen.append(f"{log.parent.name} starts")
        with start(program, script, flags, log, lock) as process:
            yield process
        seen.append(f"{log.parent.name} ends")
    monkeypatch.setattr(freefem, "start", recorded)
    return seen


@pytest.mark.parametrize("name", SCENES)
def test_two_at_a_time_give_the_same_to_the_last_digit(order, monkeypatch, tmp_path, name):
    """With two cores the coarser runs start before the main one has ended and run once. Results,
    estimates and files equal those of sequential runs."""
    runs = {}
    for cores in (2, 1):
        monkeypatch.setattr(freefem, "CORES", cores)
        runs[cores] = go(name, tmp_path / str(cores) / "out")
        both = [event for event in order if "finer" not in event]
        assert sorted(both) == sorted(f"{folder} {event}" for folder in (*estimate.LEVELS, "out.part") for event in ("ends", "starts"))
        for folder in estimate.LEVELS:
            assert (both.index(f"{folder} starts") < both.index("out.part ends")) == (cores == 2)
        order.clear()
    both = [{key: value for key, value in result.summary.items() if key not in EFFORT} for result in runs.values()]
    assert both[0] == both[1] and both[0]["estimated_error"]
    assert all((runs[1].folder / file).read_bytes() == (runs[2].folder / file).read_bytes() for file in ANSWERS)
    assert {path.name for path in runs[1].folder.iterdir()} == {path.name for path in runs[2].folder.iterdir()}


@pytest.mark.parametrize("why", ["a thread of a study", "no estimate", "one core", "auto"])
def test_one_at_a_time(order, monkeypatch, tmp_path, why):
    """A study has a run on every core, so that its runs start no second process; nor do runs
    without an estimate, on one core, or whose integrator is not known yet. None starts twice."""
    monkeypatch.setattr(freefem, "CORES", 1 if why == "one core" else 2)
    with ThreadPoolExecutor(1) as pool:
        call = (lambda act: pool.submit(act).result()) if why == "a thread of a study" else lambda act: act()
        entries = SCENES["disc-normal"] | ({"integrator": "auto"} if why == "auto" else {})
        call(lambda: run.run(scene.load("disc-normal"), entries, tmp_path / "out", progress=False, estimate=why != "no estimate"))
    assert order[:2] == ["out.part starts", "out.part ends"] and len(order) == len(set(order))


def test_sizes_that_are_used_otherwise_are_run_again(order, monkeypatch, tmp_path):
    """If the simultaneous coarser run is not the one that the finished main run requires, it is
    ended and repeated."""
    monkeypatch.setattr(freefem, "CORES", 2)
    problem, guesses = scene.load("disc-normal"), []

    def other(scene, used, factor):
        guesses.append(finer.scaled(scene, used, factor))
        return guesses[-1] | ({"body.1.mesh_size": 0.02} if len(guesses) == 1 else {})
    monkeypatch.setattr(solver, "scaled", other)
    result = run.run(problem, SCENES["disc-normal"], tmp_path / "out", progress=False)
    assert order.count("coarser starts") == 2 and result.summary["estimated_error"] and not list(tmp_path.glob("out.*"))


def test_a_main_run_that_fails_takes_the_other_with_it(order, monkeypatch, tmp_path):
    """The failure is that of the main run. Its files stay; process, folder and checkpoint of the
    simultaneous run are removed."""
    monkeypatch.setattr(freefem, "CORES", 2)
    with pytest.raises(Failure) as error:
        go("disc-normal", tmp_path / "out", law="svk", speed="60", checkpoint_every="1")
    assert error.value.code in (11, 12) and error.value.folder == tmp_path / "out" and "coarser starts" in order
    assert not at_work(tmp_path) and not list(tmp_path.rglob("coarse*")) and not list(tmp_path.rglob("checkpoint*"))


def test_a_run_beside_that_fails_is_said_where_it_was(monkeypatch, tmp_path):
    """A coarser run without a result does not change the main one, and a sentence has the reason
    why the error is unknown."""
    monkeypatch.setattr(freefem, "CORES", 2)
    problem = scene.load("disc-normal")
    monkeypatch.setattr(solver, "scaled", lambda *arguments: finer.scaled(*arguments) | {"body.1.speed": 60, "law": "svk"})
    result = run.run(problem, SCENES["disc-normal"] | {"law": "neohookean"}, tmp_path / "out", progress=False)
    assert result.summary["estimated_error"] is None and "the error is not estimated: the run with 1.4 times larger" in " ".join(result.summary["warnings"])
