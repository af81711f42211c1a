"""Channel frequency classes (CFC) of SAE J211-1 and ISO 6487: low-pass filters for measured forces.

A filter is a Butterworth filter of second order, applied forwards and backwards, so that it shifts
no phase. The standard's coefficients follow from w_a = tan(w_d T/2) with the sampling interval T
and w_d = 2 pi 2.0775 CFC; this is the bilinear transform with the frequency w_d kept. Both passes
together have the gain
  1 / (1 + (f / (2.0775 CFC))^4),
which is -3 dB at f = CFC/0.6.
"""

import re
from collections.abc import Mapping

import numpy as np

from ..failure import BadInput, brief

__all__ = ["CLASSES", "channel_class", "filtered"]

CLASSES = (60, 180, 600, 1000)
DESIGN = 2.0775  # design frequency of one pass [Hz] over the class
SAMPLES = 40  # per period of the design frequency
MOST_SAMPLES = 5_000_000
SETTLES = 5  # periods of the design frequency by which a record is continued at its ends


def channel_class(name: object) -> int:
    """The number of a class, as 600 of "CFC 600". Raises BadInput if it is none of CLASSES."""
    match = re.fullmatch(r"cfc[ _-]?(\d+)", name.strip().lower()) if isinstance(name, str) else None
    if not match or int(match[1]) not in CLASSES:
        accepted = ", ".join(f"CFC {number}" for number in CLASSES)
        raise BadInput(
            f"filter: '{brief(name)}' is no channel frequency class (accepted: {accepted})"
        )
    return int(match[1])


def filtered(
    ends: np.ndarray, values: Mapping[str, np.ndarray], number: int
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Returns uniform times [s] and the filtered values at them, for the class `number`.

    `ends` (n,) are the ends of the steps [s], the first is the start; `values` (n,) are means over
    the steps that end there. They are resampled to means over the intervals around the uniform
    times, which keeps their integral. Before and after the record the first and the last value
    hold. Raises BadInput if the record is too long for the class.
    """
    from scipy.signal import butter, sosfiltfilt  # imported here: slow to load

    design = DESIGN * number
    duration = ends[-1] - ends[0]
    count = int(np.ceil(duration * design * SAMPLES))
    if not 2 <= count <= MOST_SAMPLES:
        raise BadInput(
            f"filter: 'CFC {number}' takes {count} samples of {duration:g} s (accepted: 2 to "
            f"{MOST_SAMPLES}, so another class or run)"
        )
    grid = np.linspace(ends[0], ends[-1], count + 1)
    sections = butter(2, design, fs=count / duration, output="sos")
    margin = SETTLES * SAMPLES

    def low_pass(value: np.ndarray) -> np.ndarray:
        integral = np.concatenate([[0.0], np.cumsum(value[1:] * np.diff(ends))])
        means = np.diff(np.interp(grid, ends, integral)) * count / duration
        wide = sosfiltfilt(sections, np.pad(means, margin, mode="edge"), padlen=0)
        return np.asarray(wide[margin:-margin])

    return (grid[1:] + grid[:-1]) / 2, {name: low_pass(value) for name, value in values.items()}
