"""The display of progress: one line with nested parts, and a sentence about long runs."""

import re

import numpy as np
import pytest

from ffimpact import progress, scene
from ffimpact.freefem import freefem
from ffimpact.running import solver


def told_of(name: str, monkeypatch, seen: list[tuple[float, freefem.At]], values: dict | None = None, mesh_file=None) -> list[str]:
    """The sentences about a run with these reports (seconds since its start, state)."""
    sentences, clock = [], iter(seconds for seconds, _ in seen)
    monkeypatch.setattr(solver.time, "monotonic", lambda: next(clock))
    line = progress.Line(name, {"main run": 1.0})
    line.say = sentences.append
    run = solver.Display(line, scene.load(name).override(values or {}), mesh_file, "main run", 1)
    for _, at in seen:
        run.show(at)
    return sentences


def steadily(seconds: float, at: freefem.At) -> list[tuple[float, freefem.At]]:
    """Reports of a run with the state `at` after `seconds`, one step before it, and the same pace
    afterwards."""
    return [(0.0, at._replace(share=at.share / at.steps, steps=1)), (seconds, at), (2 * seconds, at._replace(share=2 * at.share, steps=2 * at.steps))]


@pytest.mark.parametrize("name, values, at, words", [
    ("disc-normal", {"accuracy": 1e-4}, freefem.At(0.05, 1e-4, 50, 90_000), "accuracy = 0.0001"),
    ("disc-normal", {"mesh_size": 1e-3, "contact_mesh_size": 5e-4}, freefem.At(0.05, 1e-4, 50, 90_000), "contact_mesh_size = 0.0005"),
    ("disc-normal", {"dt": 1e-8}, freefem.At(0.05, 1e-4, 5000, 260), "dt = 1e-08"),
    ("disc-oblique", {"end_time": 1.0}, freefem.At(0.05, 1e-4, 5000, 260), "end_time = 1"),
    ("disc-normal", {"integrator": "central-difference"}, freefem.At(0.05, 1e-4, 5000, 260), "integrator = central-difference"),
    ("two-discs", {"body.2.young": 1e12}, freefem.At(0.05, 1e-4, 500, 900, 300.0), "a stiff body beside a soft one, whose waves take 300 times as long"),
])
def test_a_long_run_says_so_and_why(monkeypatch, name, values, at, words):
    """If a run will take longer than a minute, one sentence reports it after the first seconds,
    with the entry that causes it."""
    sentence, = told_of(name, monkeypatch, steadily(6.0, at), values)
    assert sentence.startswith(f"{name}: about 2 min, for about {at.steps / at.share:.0f} steps of {at.unknowns} unknowns: {words}")
    assert not told_of(name, monkeypatch, steadily(2.5, at), values)


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
