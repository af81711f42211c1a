"""The figure of a dynamic mechanical analysis: measured moduli and those of the fitted branches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .figures import BLUE, ORANGE, styled

if TYPE_CHECKING:
    from ..spectrum import Spectrum

__all__ = ["draw"]


def draw(spectrum: Spectrum, ax: Axes | None = None) -> Axes:
    """Draws storage and loss modulus [Pa] over the frequency [Hz] into `ax`, or new axes."""
    with styled():
        ax = ax or plt.subplots()[1]
        fine = np.geomspace(spectrum.frequency.min() / 3, 3 * spectrum.frequency.max(), 300)
        fitted = spectrum.modulus(fine)
        for name, colour, measured, curve in (
            ("storage modulus E'", BLUE, spectrum.storage, fitted.real),
            ("loss modulus E''", ORANGE, spectrum.loss, fitted.imag),
        ):
            ax.loglog(spectrum.frequency, measured, "o", color=colour, label=f"{name}, measured")
            ax.loglog(fine, curve, color=colour, label=f"{name}, {len(spectrum.branches)} branches")
        ax.set(xlabel="frequency in Hz", ylabel="modulus in Pa")
        ax.legend()
    return ax
