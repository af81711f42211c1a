"""The vibration that an impact leaves: the energy in each natural mode (modes.csv), beside the spectrum of the force."""

from pathlib import Path

import numpy as np

from ..output.results import read_table
from .figures import BLUE, GREEN, plt


NEEDED = ["mode", "frequency", "energy", "strain_energy", "kinetic_energy"]


def read(folder: Path) -> np.recarray:
    """modes.csv of the run in `folder`: mode (from 1), frequency [Hz], energy of the last state in it and its two parts [J; of a plane
    problem J/m].

    Unreadable where it is not such a table.
    """
    return read_table(folder / "modes.csv", NEEDED)


def spectrum(t: np.ndarray, dt: np.ndarray, force: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """|integral of F exp(-i 2 pi f t) dt| [N s] at `frequencies` [Hz], of a force that is constant in each step (t: its end)."""
    turns = np.exp(-2j * np.pi * np.outer(frequencies, t - dt / 2)) * np.sinc(np.outer(frequencies, dt))
    return np.abs(turns @ (force * dt))


def draw(table: np.recarray, history: dict[str, np.ndarray], per: str) -> plt.Figure | None:
    """Energy by mode over frequency, and above it the force's spectrum up to the last mode; None where there are no modes, or no energies.
    `per`: "/m" in plane strain."""
    if np.isnan(table.energy).all():
        return None
    most = np.nanmax(table.energy)
    figure, (top, below) = plt.subplots(2, 1, figsize=(6.4, 5), sharex=True)
    frequencies = np.linspace(0, 1.05 * table.frequency.max(), 600)
    top.plot(1e-3 * frequencies, spectrum(history["t"], history["dt"], history["normal_force"], frequencies), color=BLUE, linewidth=1)
    top.set(ylabel=f"spectrum of the force [N s{per}]", yscale="log")
    for name, colour, style in (("kinetic_energy", "#e69f00", "s"), ("strain_energy", GREEN, "^"), ("energy", "black", "o")):
        shown = table[table[name] > 1e-6 * most]
        below.plot(1e-3 * shown.frequency, shown[name], style, color=colour, markersize=3.5, label=name.replace("_", " "))
    below.vlines(1e-3 * table.frequency, 1e-6 * most, table.energy, color="#bbbbbb", linewidth=0.6, zorder=0)
    below.set(ylabel=f"energy of a mode [J{per}]", xlabel="frequency [kHz]", yscale="log")
    below.legend()
    return figure
