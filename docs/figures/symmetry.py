"""Computed parts of a body: plane strain (whole or half), revolution, half and quarter in space,
with axes and symmetry factors."""

import numpy as np
from style import BLUE, BODY, GREEN, GREY, INK, WIDTH, arrow, circle, ground, plt, save, shape

figure, axes = plt.subplots(1, 4, figsize=(WIDTH, 2.25), layout="constrained")
titles = ("plane strain", "revolution", "space, half", "space, quarter")
lines = ('full, or half x ≥ 0\nforces per metre', 'section x ≥ 0\nweight 2πx', 'z ≥ 0, factor 2', 'x, z ≥ 0, factor 4')
for ax, title, line in zip(axes, titles, lines):
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_title(title, fontsize=9.5)
    ax.text(0, -0.5, line, ha="center", va="top", fontsize=8.5)
    ax.set(xlim=(-1.35, 1.35), ylim=(-1.05, 2.35))
ax = axes[0]
ground(ax, -1.3, 1.3, 0, 0.12)
shape(ax, circle((0, 1), 0.95), "white", GREY, ls="--")
shape(ax, np.vstack([circle((0, 1), 0.95, -90, 90)]), BODY)
ax.plot([0, 0], [0.05, 1.95], color=GREEN, lw=2.5)
ax.text(-0.08, 1.0, "u_x = 0", color=GREEN, ha="right", va="center", fontsize=8)
ax = axes[1]
ground(ax, -1.3, 1.3, 0, 0.12)
shape(ax, circle((0, 1), 0.95), "white", GREY, ls="--")
shape(ax, circle((0, 1), 0.95, -90, 90), BODY)
ax.plot([0, 0], [-0.12, 2.3], color=GREEN, lw=1.2, ls="-.")
t = np.linspace(0, 2 * np.pi, 100)
ax.plot(0.7 * np.cos(t), 1.35 + 0.17 * np.sin(t), color=BLUE, lw=1)
ax.plot(0.7, 1.35, "o", color=BLUE, ms=4)
arrow(ax, (0, 1.35), (0.7, 1.35), BLUE, "x", offset=(0, -0.17), width=1, fontsize=9)
for ax, share in ((axes[2], 2), (axes[3], 4)):
    shape(ax, circle((0, 1), 0.95), "white", GREY, ls="--", lw=1)
    if share == 2:
        shape(ax, np.vstack([circle((0, 1), 0.95, 0, 360)]), BODY, lw=0, alpha=0.55)
        ax.fill(0.95 * np.cos(t), 1 + 0.95 * np.sin(t), facecolor=BODY, edgecolor=INK, lw=1.4)
    else:
        shape(ax, np.vstack([circle((0, 1), 0.95, -90, 90)]), BODY)
        ax.plot([0, 0], [0.05, 1.95], color=GREEN, lw=2.5)
    e = np.linspace(0, np.pi, 60) if share == 2 else np.linspace(0, np.pi / 2, 60)
    ax.plot(0.95 * np.cos(e), 1 - 0.22 * np.sin(e), color=INK, lw=1)
    ax.plot(0.95 * np.cos(e), 1 + 0.0 * e, color=GREEN, lw=1, ls="--")
    arrow(ax, (0, 1), (0.62, 1), INK, "x", at=1.2, width=1, fontsize=9)
    arrow(ax, (0, 1), (0, 1.62), INK, "y", at=1.22, width=1, fontsize=9)
    arrow(ax, (0, 1), (-0.34, 0.5), INK, "z", at=1.3, width=1, fontsize=9)
    ground(ax, -1.3, 1.3, 0, 0.12)
save(figure, "symmetry")
