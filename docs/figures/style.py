"""Common style of the documentation figures: colours, arrows, angles, hatched ground, and the
output as SVG.

Every script in this folder writes one or more SVG files to this folder. `python
docs/figures/NAME.py` draws the figures of one script again.
"""

import os
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Arc, Polygon

FOLDER = Path(__file__).parent
INK, GREY, LIGHT = "#222222", "#7a7a7a", "#e4e7eb"
BLUE, RED, GREEN, ORANGE = "#1f5fa8", "#b5372e", "#2f7d4f", "#c47a12"
BODY, OTHER, SOLID = "#cfe0f3", "#f6dcc3", "#d7d7d7"
WIDTH = 6.25  # inches: 600 px at 96 px per inch

plt.rcParams.update({
    "font.size": 10, "font.family": "DejaVu Sans", "axes.edgecolor": GREY, "axes.labelcolor": INK, "axes.spines.top": False,
    "axes.spines.right": False, "xtick.color": INK, "ytick.color": INK, "svg.hashsalt": "ffimpact", "svg.fonttype": "path",
    "lines.linewidth": 1.6, "legend.frameon": False, "figure.facecolor": "white", "axes.titlesize": 10.5, "mathtext.fontset": "dejavusans",
    "path.simplify_threshold": 0.5})


def sketch(height, columns=1, **more):
    """A figure of the full width, with axes of equal scale and without frame."""
    figure, axes = plt.subplots(1, columns, figsize=(WIDTH, height), layout="constrained", **more)
    for ax in np.atleast_1d(axes).flat:
        ax.set_aspect("equal")
        ax.axis("off")
    return figure, axes


def graph(height, columns=1, rows=1, **more):
    """A figure of the full width with ordinary axes."""
    return plt.subplots(rows, columns, figsize=(WIDTH, height), layout="constrained", **more)


def arrow(ax, start, end, color=INK, text="", at=0.5, offset=(0, 0), width=1.6, style="-|>", **words):
    """Draws an arrow with a label at the share `at` of its length."""
    ax.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": style, "color": color, "lw": width, "shrinkA": 0, "shrinkB": 0,
                                                      "mutation_scale": 13})
    if text:
        place = np.array(start) + at * (np.array(end) - np.array(start)) + np.array(offset)
        ax.text(*place, text, color=color, **({"ha": "center", "va": "center"} | words))


def angle(ax, centre, radius, start, end, text="", color=INK, offset=1.25, **words):
    """Draws an arc between two angles in degrees, with its symbol."""
    ax.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=start, theta2=end, color=color, lw=1.2))
    middle = np.radians((start + end) / 2)
    if text:
        ax.text(centre[0] + offset * radius * np.cos(middle), centre[1] + offset * radius * np.sin(middle), text, color=color,
                **({"ha": "center", "va": "center"} | words))


def spin(ax, centre, radius, start, end, color=INK, text="", offset=(0, 0)):
    """Draws a circular arrow between two angles in degrees."""
    turn = np.radians(np.linspace(start, end, 40))
    x, y = centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)
    ax.plot(x[:-1], y[:-1], color=color, lw=1.6)
    arrow(ax, (x[-4], y[-4]), (x[-1], y[-1]), color)
    if text:
        ax.text(centre[0] + offset[0], centre[1] + offset[1], text, color=color, ha="center", va="center")


def ground(ax, start, end, y=0.0, depth=0.12):
    """Draws a rigid plane: a line with a hatched strip below it."""
    ax.fill_between([start, end], y - depth, y, facecolor=SOLID, edgecolor=GREY, hatch="////", lw=0)
    ax.plot([start, end], [y, y], color=INK, lw=1.4)


def shape(ax, points, face=BODY, edge=INK, **more):
    """Draws a filled outline."""
    ax.add_patch(Polygon(points, closed=True, facecolor=face, edgecolor=edge, **({"lw": 1.4} | more)))


def circle(centre, radius, start=0, end=360, number=121):
    """Points of an arc."""
    turn = np.radians(np.linspace(start, end, number))
    return np.column_stack([centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)])


def save(figure, name, kind="svg"):
    """Writes NAME.svg, or NAME.png with 256 colours, to the folder of the scripts.

    With FIGURES_PNG=DIR in the environment it also writes a preview.
    """
    path = FOLDER / f"{name}.{kind}"
    if kind == "svg":
        figure.savefig(path, metadata={"Date": None})
    else:
        from PIL import Image
        figure.savefig(path, dpi=120)
        Image.open(path).convert("RGB").quantize(256).save(path, optimize=True)
    if preview := os.environ.get("FIGURES_PNG"):
        figure.savefig(Path(preview) / f"{name}.png", dpi=96)
    plt.close(figure)
    print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


def box(ax, x, y, width, height, text, face="white", edge=INK, size=9, **more):
    """Draws a box with text, centred at x and y, in a diagram."""
    from matplotlib.patches import FancyBboxPatch
    ax.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height, boxstyle="round,pad=0.02,rounding_size=0.08", facecolor=face,
                                edgecolor=edge, lw=1.2))
    ax.text(x, y, text, ha="center", va="center", fontsize=size, **more)


def diagram(height, width=10.0):
    """Axes of `width` units for boxes. Both directions have the same scale."""
    figure, ax = plt.subplots(figsize=(WIDTH, height), layout="constrained")
    ax.axis("off")
    ax.set(xlim=(0, width), ylim=(0, width * height / WIDTH))
    return figure, ax
