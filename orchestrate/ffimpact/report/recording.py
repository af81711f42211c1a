"""The figure of a recorded drop: its sound with the onsets of the bounces, and the restitutions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .figures import BLUE, GREY, ORANGE, styled

if TYPE_CHECKING:
    from ..recording import Bounces

__all__ = ["draw"]

POINTS = 4000  # of the drawn loudness


def draw(drop: Bounces, ax: Axes | None = None) -> Axes:
    """Draws the largest amplitudes of the sound over time [s] with the onsets; without a recording
    the restitution of each bounce over the speed before it [m/s].
    """
    with styled():
        ax = ax or plt.subplots()[1]
        if drop.sound is None:
            table = drop.table
            ax.errorbar(table["speed"], table["restitution"], table["error"], fmt="o", color=BLUE)
            ax.set(xlabel="speed before the bounce in m/s", ylabel="restitution")
            return ax
        size = max(1, len(drop.sound.samples) // POINTS)
        count = len(drop.sound.samples) // size
        loudest = np.abs(drop.sound.samples[: count * size]).reshape(count, size).max(axis=1)
        ax.plot(np.arange(count) * size / drop.sound.rate, loudest, color=GREY, linewidth=0.8)
        for k, time in enumerate(drop.times):
            ax.axvline(time, color=ORANGE, linewidth=0.8, label="onset" if k == 0 else None)
        ax.set(xlabel="time in s", ylabel="amplitude, 1: full range")
        ax.legend()
    return ax
