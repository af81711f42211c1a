"""Closest-point contact (9) with contact points on both bodies, and pairwise contact (14), (15)
with its range."""

import numpy as np
from style import BLUE, BODY, GREY, INK, ORANGE, OTHER, RED, WIDTH, plt, save, shape

figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.0), layout="constrained")
t = np.linspace(-1.6, 1.6, 80)


def lower(x):
    return -0.05 - 0.13 * x**2


def upper(x):
    return 0.42 + 0.22 * (x - 0.1)**2


for ax in axes:
    ax.set_aspect("equal")
    ax.axis("off")
    shape(ax, np.vstack([np.column_stack([t, lower(t)]), [(1.6, -0.95), (-1.6, -0.95)]]), OTHER, lw=0)
    shape(ax, np.vstack([np.column_stack([t, upper(t)]), [(1.6, 1.3), (-1.6, 1.3)]]), BODY, lw=0)
    ax.plot(t, lower(t), color=ORANGE)
    ax.plot(t, upper(t), color=BLUE)
    ax.text(-1.5, 1.22, "body 1", color=BLUE, va="top")
    ax.text(-1.5, -0.9, "body 2", color=ORANGE, va="bottom")
    ax.set(xlim=(-1.65, 1.65), ylim=(-1, 1.35))

first, second = np.arange(-1.3, 1.4, 0.42), np.arange(-1.2, 1.4, 0.36)
fine = np.linspace(-1.9, 1.9, 2001)
ax = axes[0]
for points, own, other, color in ((first, upper, lower, BLUE), (second, lower, upper, ORANGE)):
    for x in points:
        y = own(x)
        k = np.hypot(fine - x, other(fine) - y).argmin()
        ax.plot([x, fine[k]], [y, other(fine[k])], color=color, lw=1)
        ax.plot(x, y, "o", color=color, ms=4.5)
        ax.plot(fine[k], other(fine[k]), "s", color=color, ms=3)
ax.set_title("closest-point (8), (9)\none line for each contact point, weight ½ each", fontsize=9)

ax = axes[1]
epsilon = 0.72
for x in first:
    for z in second:
        d = np.hypot(x - z, upper(x) - lower(z))
        if d < epsilon:
            ax.plot([x, z], [upper(x), lower(z)], color=RED, lw=2.2 * (epsilon - d) / epsilon + 0.5, alpha=0.75)
ax.plot(first, upper(first), "o", color=BLUE, ms=4.5)
ax.plot(second, lower(second), "o", color=ORANGE, ms=4.5)
turn = np.linspace(0, 2 * np.pi, 100)
x = first[3]
ax.plot(x + epsilon * np.cos(turn), upper(x) + epsilon * np.sin(turn), color=GREY, lw=0.9, ls="--")
ax.annotate("", (x + epsilon * np.cos(0.5), upper(x) + epsilon * np.sin(0.5)), (x, upper(x)),
            arrowprops={"arrowstyle": "->", "color": INK, "lw": 1})
ax.text(x + 0.42, upper(x) + 0.08, "ε", color=INK)
ax.set_title("pairwise (14), (15)\nevery pair of points nearer than ε", fontsize=9)
save(figure, "pairings")
