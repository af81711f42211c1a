"""Channel frequency classes: coefficients, attenuation and resampling by SAE J211-1."""

import math

import numpy as np
import pytest
from scipy.signal import butter

from ffimpact.failure import BadInput
from ffimpact.output.filters import CLASSES, DESIGN, channel_class, filtered


def gain(number: int, frequency: float) -> float:
    """The amplitude of a filtered sine, in the middle of a record of 40 periods."""
    ends = np.linspace(0, 40 / frequency, 40 * 400 + 1)
    integral = -np.cos(2 * np.pi * frequency * ends) / (2 * np.pi * frequency)
    means = np.concatenate([[0.0], np.diff(integral) / np.diff(ends)])
    times, values = filtered(ends, {"force": means}, number)
    middle = (times > 10 / frequency) & (times < 30 / frequency)
    return float(np.sqrt(2 * np.mean(values["force"][middle] ** 2)))


@pytest.mark.parametrize("number", CLASSES)
@pytest.mark.parametrize("share, decibel", [(0.1, 0.0), (1.0, -0.4546), (1 / 0.6, -3.0103), (3.3333, -17.65), (6.0, -36.97)])
def test_attenuation(number, share, decibel):
    """-3 dB at CFC/0.6 (100 Hz of CFC 60), at the class itself within the corridor of +0.5 and -1
    dB, and 24 dB an octave above. Values: -20 log10(1 + (f/fd)^4); the interval of the samples and
    the bilinear transform change them slightly."""
    assert decibel == pytest.approx(-20 * math.log10(1 + (share / DESIGN) ** 4), abs=0.06)
    tolerance = 0.03 if share < 2 else 0.8   # tan(pi f T)/(pi f T) is 1.02 at six times the class
    assert 20 * math.log10(gain(number, share * number)) == pytest.approx(decibel, abs=tolerance)


def test_coefficients_are_those_of_the_standard():
    """y_k = a0 x_k + a1 x_(k-1) + a2 x_(k-2) + b1 y_(k-1) + b2 y_(k-2) of SAE J211-1, appendix C."""
    number, interval = 180, 1e-4
    design = 2 * math.pi * number * 2.0775
    wa = math.sin(design * interval / 2) / math.cos(design * interval / 2)
    below = 1 + math.sqrt(2) * wa + wa**2
    a0 = wa**2 / below
    b1, b2 = -2 * (wa**2 - 1) / below, (-1 + math.sqrt(2) * wa - wa**2) / below
    above, under = butter(2, DESIGN * number, fs=1 / interval)
    assert above == pytest.approx([a0, 2 * a0, a0], rel=1e-12)
    assert under == pytest.approx([1, -b1, -b2], rel=1e-12)


def test_steps_of_any_length():
    """The impulse of a pulse in steps that vary by 16 is kept, and its filtered course hardly
    depends on the steps; a constant force stays."""
    ends = np.concatenate([[0.0], np.cumsum(np.tile([1e-5] * 16 + [1.6e-4], 125))])
    even = np.linspace(0, ends[-1], 20001)

    def pulse(t: np.ndarray) -> np.ndarray:
        integral = np.where((t > 0.01) & (t < 0.02), t - 0.01, 0.0) + np.where(t >= 0.02, 0.01, 0.0)
        return np.concatenate([[0.0], np.diff(integral) / np.diff(t)])

    times, values = filtered(ends, {"force": pulse(ends), "held": np.full(len(ends), 7.0)}, 180)
    _, same = filtered(even, {"force": pulse(even)}, 180)
    assert np.ptp(np.diff(times)) < 1e-9
    assert values["force"].sum() * (times[1] - times[0]) == pytest.approx(0.01, rel=1e-3)
    assert values["force"] == pytest.approx(same["force"], abs=0.01)
    assert values["held"] == pytest.approx(7.0)


@pytest.mark.parametrize("name", ["CFC 60", "cfc180", "CFC_600", "CFC 1000"])
def test_names(name):
    assert channel_class(name) in CLASSES


@pytest.mark.parametrize("name", ["CFC 100", "600", 600, "butter", None])
def test_other_names(name):
    with pytest.raises(BadInput, match=r"^filter: '.*' is no channel frequency class \(accepted: CFC 60, CFC 180, CFC 600, CFC 1000\)$"):
        channel_class(name)


def test_too_long_a_record():
    with pytest.raises(BadInput, match="^filter: 'CFC 1000' takes .* samples of 1000 s"):
        filtered(np.array([0.0, 1000.0]), {"force": np.ones(2)}, 1000)
