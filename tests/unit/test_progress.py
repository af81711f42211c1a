"""The display of progress: one line with nested parts, and a sentence about long runs."""

import re
import types

import numpy as np
import pytest

from ffimpact import progress, scene
from ffimpact.freefem import freefem
from ffimpact.running import forecast


def told_of(name: str, monkeypatch, seen: list[tuple[float, freefem.At]]) -> list[str]:
    """The sentences about a run with these reports (seconds since its start, state)."""
    sentences = []
    monkeypatch.setattr(forecast, "cure", lambda scene, seconds, estimate: f"cure of {seconds:.0f} s")
    line = progress.Line(name, {"main run": 1.0}, watched=False)
    line.quiet, line.say = False, sentences.append
    run = forecast.Display(line, scene.load(name), "main run", 1)
    for seconds, at in seen:
        run.show(at._replace(wall=seconds))
    return sentences


def steadily(seconds: float, at: freefem.At) -> list[tuple[float, freefem.At]]:
    """Reports of a run with the state `at` after `seconds`, one step before it, and the same pace
    afterwards."""
    return [(0.0, at._replace(share=at.share / at.steps, steps=1)), (seconds, at), (2 * seconds, at._replace(share=2 * at.share, steps=2 * at.steps))]


def test_a_long_run_says_so_and_how_it_becomes_short(monkeypatch):
    """If a run will take longer than two minutes, one sentence reports it after the first seconds, with the
    entry that makes it short."""
    at = freefem.At(0.05, 1e-4, 50, 90_000)
    sentence, = told_of("disc-normal", monkeypatch, steadily(10.0, at))
    assert sentence == "disc-normal: about 3 min, for about 1000 steps of 90000 unknowns: cure of 204 s"
    assert not told_of("disc-normal", monkeypatch, steadily(5.5, at))


def planned(seconds: float) -> types.SimpleNamespace:
    """A plan of so much processor time."""
    return types.SimpleNamespace(total_seconds=seconds, finer_seconds=0.0, is_long=seconds > 120)


def test_reports_of_the_time_of_the_search_are_out_of_date(monkeypatch):
    """While the entry is sought, for 15 s, reports of the solver wait. They are then left out, so that elapsed and
    remaining time belong to the present state."""
    clock = iter([100.0, 115.0])
    monkeypatch.setattr(forecast.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(forecast, "cure", lambda *_: "cure")
    line, shown = progress.Line("run", {"main run": 1.0}, watched=False), []
    line.quiet, line.say = False, lambda sentence: None
    line.at = lambda part, share, words, cost: shown.append(words)
    run = forecast.Display(line, scene.load("disc-normal"), "main run", 1)
    for wall in (0, 5, 6, 19, 21):
        run.show(freefem.At(0.001 * (wall + 1), 1e-3 * wall, wall, 400, wall=float(wall)))
    assert [int(words.split()[-2]) for words in shown] == [0, 5, 21]


# The time [s] of disc-oblique by its entries: of the sizes, of the accuracy and of the end.
MODEL = {
    "elements": lambda values: (0.02 / values["mesh_size"]) ** 2 if values["mesh_size"] else (0.005 / values["accuracy"]) ** 0.7,
    "steps": lambda values: 1e-5 / values["dt"] if values["dt"] else (0.005 / values["accuracy"]) ** 0.5,
    "explicit": lambda values: 100.0 if values["integrator"] == "central-difference" else 1.0,
    "end": lambda values: max(1.0, values["end_time"] / 0.01),
}


@pytest.mark.parametrize("values, words", [
    ({"accuracy": 2e-4}, r"accuracy = 0.001 takes about 28 s, with errors about 5 times as large \(about 0.1 % instead of 0.02 %\)"),
    ({"dt": 1e-8}, r"dt = 0 takes about 4.0 s, with the error that accuracy = 0.005 asks for"),
    ({"mesh_size": 1e-3, "contact_mesh_size": 5e-4}, r"mesh_size = 0, contact_mesh_size = 0 takes about 4.0 s, with the error"),
    ({"integrator": "central-difference", "dt": 1e-6}, r"integrator = auto takes about 40 s"),
    ({"end_time": 5.0, "accuracy": 0.05}, r"end_time = 2.0 takes about 50 s, without what happens after 2 s"),
    ({"end_time": 1.0}, r"accuracy = 0.05 takes about 25 s, with errors about 10 times as large"),
])
def test_the_entry_that_makes_a_run_short(monkeypatch, values, words):
    """What a scene sets becomes automatic; otherwise a larger accuracy is proposed; otherwise an earlier
    end_time. The time is that of the plan of the changed scene."""
    def measure(changed, estimate):
        return planned(4.0 * float(np.prod([part(changed.values | changed.sizes) for part in MODEL.values()])))

    monkeypatch.setattr(forecast, "measure", measure)
    asked = scene.load("disc-oblique").override(values)
    seconds = measure(asked, True).total_seconds
    assert re.match(words, forecast.cure(asked, seconds, True)), (seconds, forecast.cure(asked, seconds, True))


def test_no_entry_makes_it_short(monkeypatch):
    """If no entry halves the time, the line says so. Without estimates of the errors it takes two thirds."""
    monkeypatch.setattr(forecast, "measure", lambda *_: planned(600.0))
    coarse = scene.load("disc-oblique")
    assert forecast.cure(coarse, 600.0, False) == "no entry makes it short"
    assert forecast.cure(coarse, 600.0, True) == "no entry makes it short: --no-estimate takes about 6.8 min, without error estimates"


def reports(shares: list[float], steps: list[int]) -> list[tuple[float, freefem.At]]:
    """A report every second: the share that seems to be done, and the number of steps."""
    return [(float(k), freefem.At(share, 1e-4, count, 5000)) for k, (share, count) in enumerate(zip(shares, steps))]


def ranges(sentence: str) -> list[tuple[float, float]]:
    """The minutes and the steps of a forecast, as lower and upper bounds."""
    words = re.search(r": (.*) min, for (.*) steps of 5000 unknowns", sentence).groups()
    numbers = [[float(number) for number in re.findall(r"[0-9.]+", part)] for part in words]
    return [(bounds[0], np.inf if "at least" in text else bounds[-1]) for bounds, text in zip(numbers, words)]


@pytest.mark.parametrize("pace", ["steady", "slower", "recedes"])
def test_a_forecast_is_renewed_by_the_pace_of_the_run(monkeypatch, pace):
    """A run of 5 min that seems to take 2 min at first gives few sentences. The last one contains
    the final duration, to a fifth.

    Each range exceeds the former one. A steady run gives one sentence. If the end recedes, there is
    no upper bound.
    """
    seconds = np.arange(300)
    first = 0.4 / 48 * seconds[:48]
    later = {"steady": 0.4 / 48 * seconds[48:120], "slower": 0.4 + 0.6 * (seconds[48:] - 47) / 253, "recedes": np.full(252, 0.4)}[pace]
    shares = np.minimum(0.99, np.concatenate([first, later]))
    sentences = told_of("disc-normal", monkeypatch, reports(shares.tolist(), (10 * seconds[:len(shares)] + 1).tolist()))
    forecasts = [ranges(sentence) for sentence in sentences]
    assert len(sentences) == 1 if pace == "steady" else 2 <= len(sentences) <= 4
    assert all(later[0][0] > 0.9 * before[0][0] for before, later in zip(forecasts, forecasts[1:]))
    # The end only recedes.
    assert not told_of("disc-normal", monkeypatch, reports((1 - shares).tolist(), range(1, len(shares) + 1)))
    minutes, steps = len(shares) / 60, 10 * len(shares)
    if pace == "recedes":
        assert any(high == np.inf for (_, high), _ in forecasts)
    else:
        assert all(0.8 * low <= total <= 1.25 * high for (low, high), total in zip(forecasts[-1], (minutes, steps)))


@pytest.mark.parametrize("minutes, least, most", [(0.3, 0, 0), (2, 5, 6), (60, 30, 45), (600, 55, 85)])
def test_lines_in_a_pipe_become_rare(monkeypatch, minutes, least, most):
    """A short run prints no line in a pipe, a run of ten hours fewer than 85. The first line comes after 20 s,
    and no interval is longer than 20 s and a ninth of the elapsed time."""
    clock, printed = iter(np.arange(0, 60 * minutes, 0.2)), []
    now = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(progress, "_say", lambda sentence: printed.append((now[0], sentence)))
    with progress.Line("run", {1: 1.0}) as line:
        for now[0] in clock:
            line.at(1, now[0] / (60 * minutes), "main run")
    times = [0.0, *(when for when, _ in printed)]
    assert least <= len(printed) <= most
    assert all(later - before < max(20.0, later / 10) + 0.3 for before, later in zip(times, times[1:]))
    if minutes == 600:
        assert printed[-1][1].startswith("ffimpact: 9") and ":" in printed[-1][1].split(" after ")[1]
