"""Normal force over the approach of the centre of mass; the loop encloses the energy that translation
has lost. docs/how-to/extending.md shows this file."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from ffimpact.report.figures import ABOVE, BLUE, per_metre


def lost(history) -> float:
    """The work of the force on the way of the centre [J/m; J of a ball]: a row has the mean force of
    the step that ends there."""
    return -np.sum(history["normal_force"][1:] * np.diff(history["y"]))


def draw(history, scene) -> Figure | None:
    if len(scene["body"]) > 1:
        return None  # no picture
    approach, per = 1e3 * (history["y"][0] - history["y"]), per_metre(scene)
    middle = np.append(0, (approach[1:] + approach[:-1]) / 2)
    force = np.append(0, 1e-3 * history["normal_force"][1:])
    figure, axes = plt.subplots(figsize=(5.6, 3.4))
    label = f"lost from translation: {lost(history):.4g} J{per}"
    axes.fill(middle, force, color=BLUE, alpha=0.15, label=label)
    axes.plot(middle, force, color=BLUE)
    axes.set(xlabel="approach of the centre of mass [mm]", ylabel=f"normal force [kN{per}]")
    axes.legend(**ABOVE)
    return figure
