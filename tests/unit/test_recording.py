"""Restitution from recordings: times, drag, and sounds made for the test."""


import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp
from scipy.io import wavfile

import ffimpact as ff
from ffimpact.failure import BadInput, NotInstalled, Unreadable

RATE = 44100
BALL = {"mass": 0.0415, "radius": 0.021}


def times_of(e: float, first: float = 4.0, count: int = 9, drag: float = 0.0, contact: float = 0.0) -> np.ndarray:
    """Onsets of bounces with the restitution e, the speed `first` behind the first one; the flights
    by integration of their equation."""
    times, speed = [0.3], first
    for _ in range(count - 1):
        if drag == 0:
            flight, lands = 2 * speed / 9.81, speed
        else:
            falls = lambda t, y: y[0] if t > 1e-6 else 1.0
            falls.terminal, falls.direction = True, -1
            done = solve_ivp(lambda t, y: [y[1], -9.81 - drag * y[1] * abs(y[1])], [0, 3], [1e-12, speed], events=falls, rtol=1e-10, atol=1e-12)
            flight, lands = done.t_events[0][0], -done.y_events[0][0][1]
        times.append(times[-1] + contact + flight)
        speed = e * lands
    return np.array(times)


def sound_of(times: np.ndarray, noise: float = 0.002, echo: float = 0.3, seed: int = 1) -> np.ndarray:
    """Bursts of 3 kHz that die away in 4 ms, each with an echo 15 ms later, in noise."""
    chance = np.random.default_rng(seed)
    t = np.arange(0, times[-1] + 0.5, 1 / RATE)
    samples = noise * chance.standard_normal(len(t))
    for k, start in enumerate(times):
        for at, size in ((start, 0.8 * 0.85**k), (start + 0.015, 0.8 * 0.85**k * echo)):
            behind = np.maximum(t - at, 0)
            samples += (t >= at) * size * np.exp(-behind / 0.004) * np.sin(2 * np.pi * 3000 * behind)
    return samples


def saved(path, samples, kind=np.int16):
    full = np.iinfo(kind).max if kind != np.uint8 else 127
    values = np.clip(samples, -1, 1) * full + (128 if kind == np.uint8 else 0)
    wavfile.write(path, RATE, np.round(values).astype(kind))
    return path


def test_times_alone():
    found = ff.bounces(times_of(0.9))
    assert found.table["restitution"].to_numpy() == pytest.approx(0.9, rel=1e-9)
    assert found.table["ratio"].to_numpy() == pytest.approx(0.9, rel=1e-9)
    assert found.table["speed"][0] == pytest.approx(4.0) and not found.notes


def test_drag_and_contact_time_are_in_the_flights():
    """The ratio of intervals alone misses by 0.6 %, that of the speeds is exact."""
    drag = 1.2 * 0.5 * np.pi * BALL["radius"] ** 2 / (2 * BALL["mass"])
    times = times_of(0.9, drag=drag, contact=4e-4)
    found = ff.bounces(times, contact_time=4e-4, **BALL)
    assert found.table["restitution"].to_numpy() == pytest.approx(0.9, rel=1e-7)
    assert abs(found.table["ratio"][0] / 0.9 - 1) > 2e-3
    assert ff.bounces(times).table["restitution"][0] != pytest.approx(0.9, rel=1e-3)


@pytest.mark.parametrize("kind", [np.int16, np.int32, np.uint8])
@pytest.mark.parametrize("noise, echo", [(0.002, 0.3), (0.01, 0.6)])
def test_a_recording_gives_onsets_and_restitution(tmp_path, kind, noise, echo):
    """Echoes are no bounces; onsets within 0.3 ms, the median of the restitution within 0.2 %."""
    times = times_of(0.9)
    found = ff.bounces(saved(tmp_path / "drop.wav", sound_of(times, noise, echo), kind))
    assert len(found.times) == len(times)
    assert np.ptp(found.times - times) < 3e-4
    value, error = found.restitution
    assert value == pytest.approx(0.9, rel=2e-3) and 0 < error < 2e-3


def test_an_unheard_bounce_is_left_out_and_said(tmp_path):
    times = times_of(0.9)
    found = ff.bounces(saved(tmp_path / "drop.wav", sound_of(np.delete(times, 4))))
    assert found.restitution[0] == pytest.approx(0.9, rel=2e-3)
    assert sum("is left out" in note for note in found.notes) == 2
    assert found.table["restitution"].isna().sum() == 2


def test_stereo_and_clipped_are_said(tmp_path):
    samples = sound_of(times_of(0.9))
    both = np.round(32767 * np.clip(np.column_stack([8 * samples, 8 * samples]), -1, 1)).astype(np.int16)
    wavfile.write(tmp_path / "drop.wav", RATE, both)
    found = ff.bounces(tmp_path / "drop.wav")
    assert any("2 channels" in note for note in found.notes) and any("clipped" in note for note in found.notes)
    assert found.restitution[0] == pytest.approx(0.9, rel=5e-3)


def test_times_of_a_table(tmp_path):
    pd.DataFrame({"time": times_of(0.8)}).to_csv(tmp_path / "times.csv", index=False)
    assert ff.bounces(tmp_path / "times.csv").restitution[0] == pytest.approx(0.8)


def test_wrong_recordings_are_named(tmp_path, monkeypatch):
    silent = saved(tmp_path / "silent.wav", np.zeros(RATE))
    noise = saved(tmp_path / "noise.wav", 0.1 * np.random.default_rng(0).standard_normal(RATE))
    (tmp_path / "rubbish.wav").write_bytes(b"no sound at all")
    (tmp_path / "no.csv").write_text("a,b\n1,2\n")
    (tmp_path / "nan.csv").write_text("time\n0\nx\n1\n")
    for file, kind, words in ((silent, BadInput, "no bounce"), (noise, BadInput, "no bounce|bounces"), (tmp_path / "rubbish.wav", Unreadable, "is no WAV"),
                              (tmp_path / "none.wav", Unreadable, "there is no such file"), (tmp_path / "no.csv", BadInput, "has no column time"),
                              (tmp_path / "nan.csv", BadInput, "row 2 of time"), ([0, 1], BadInput, "2 bounces"), ([0, 1, 0.5, 2], BadInput, "each later"),
                              ([0, 1, np.nan], BadInput, "bounces")):  # fmt: skip
        with pytest.raises(kind, match=words):
            ff.bounces(file)
    for wrong, words in (({"mass": 0.04}, "mass"), ({"mass": -1, "radius": 0.02}, "mass"), ({"contact_time": -1}, "contact_time"), ({"contact_time": 5}, "contact_time")):
        with pytest.raises(BadInput, match=words):
            ff.bounces(times_of(0.9), **wrong)
    (tmp_path / "drop.m4a").write_bytes(b"sound")
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(NotInstalled, match="ffmpeg"):
        ff.bounces(tmp_path / "drop.m4a")


def test_the_command_prints_and_draws(tmp_path, capsys):
    from ffimpact.__main__ import main

    file = saved(tmp_path / "it's a drop.wav", sound_of(times_of(0.9)))
    assert main(["bounces", str(file), "--mass", "0.0415", "--radius", "0.021", "--figure", str(tmp_path / "drop.png")]) == 0
    assert "restitution 0.9" in capsys.readouterr().out and (tmp_path / "drop.png").stat().st_size > 10_000
