"""Closest-point projection: contact point, facets of the counter-body, gap vector, normal, and a
penetration."""

import numpy as np
from style import BLUE, BODY, GREY, INK, OTHER, RED, arrow, save, shape, sketch

figure, axes = sketch(2.75, 2)
s = np.linspace(-1.7, 1.7, 60)
curve = 0.18 - 0.16 * s**2


def nearest(point):
    """The closest point of the curve, and its outward normal."""
    distance = np.hypot(s - point[0], curve - point[1])
    fine = np.linspace(-1.7, 1.7, 4001)
    distance = np.hypot(fine - point[0], 0.18 - 0.16 * fine**2 - point[1])
    k = distance.argmin()
    foot = np.array([fine[k], 0.18 - 0.16 * fine[k]**2])
    normal = np.array([0.32 * fine[k], 1.0])
    return foot, normal / np.linalg.norm(normal)


for ax, lift, title in ((axes[0], 0.75, "separated: g > 0"), (axes[1], -0.38, "penetration: g < 0, p = −g")):
    nodes = np.array([-1.7, -0.6, 0.55, 1.7])
    shape(ax, np.vstack([np.column_stack([s, curve]), [(1.7, -1.1), (-1.7, -1.1)]]), OTHER, lw=0)
    ax.plot(s, curve, color=INK)
    ax.plot(nodes, 0.18 - 0.16 * nodes**2, "o", color=INK, ms=4)
    x = np.array([0.15, lift + 0.2])
    t = np.linspace(-0.95, 1.25, 60)
    lower = x[1] + 0.35 * (t - x[0])**2 - 0.12 * (t - x[0])
    top = 1.9
    shape(ax, np.vstack([np.column_stack([t, lower]), [(1.25, top), (-0.95, top)]]), BODY, lw=0, alpha=0.75)
    ax.plot(t, lower, color=BLUE)
    foot, n = nearest(x)
    ax.plot(*x, "o", color=BLUE, ms=6, zorder=5)
    ax.plot(*foot, "s", color=RED, ms=6, zorder=5)
    arrow(ax, foot, x, RED, width=1.8)
    arrow(ax, foot + [-0.5, 0.0], foot + [-0.5, 0.0] + 0.55 * n, GREY, width=1.1)
    ax.text(foot[0] - 0.62, foot[1] + 0.4, "n", color=GREY, ha="center", va="center")
    if lift > 0:
        ax.text(x[0] - 0.05, x[1] + 0.3, "contact point x", color=BLUE, va="bottom", ha="center", fontsize=9.5)
        ax.text(foot[0] - 0.1, foot[1] - 0.1, "closest point ȳ", color=RED, va="top", ha="center", fontsize=9.5)
        ax.text(foot[0] + 0.1, (x[1] + foot[1]) / 2, "gap vector\nx − ȳ = g n", color=RED, ha="left", va="center", fontsize=9)
        ax.annotate("facet", (-1.15, 0.18 - 0.16 * 1.15**2), (-1.5, 0.55), ha="center", arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.8})
        ax.text(-1.55, -0.85, "counter-body", fontsize=9.5)
        ax.text(-0.85, 1.65, "body", fontsize=9.5)
    else:
        ax.text(foot[0] + 0.12, (x[1] + foot[1]) / 2 - 0.02, "g n", color=RED, ha="left", va="center")
        arrow(ax, x + [0.55, 0], x + [0.55, 0] + 0.95 * n, INK, r"$t_N=k\,p^m$", at=1.0, offset=(0.05, 0.2), width=2)
    ax.set_title(title)
    ax.set(xlim=(-1.75, 1.75), ylim=(-1.12, 1.95))
save(figure, "gap")
