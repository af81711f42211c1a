"""Kinds of obstacles in the plane, with the solid region hatched.

These are plane, circle, `bowl`, polyline with its direction, and implicit surface.
"""

import numpy as np
from style import BLUE, GREEN, GREY, INK, RED, SOLID, WIDTH, arrow, circle, plt, save, shape

figure, axes = plt.subplots(1, 5, figsize=(WIDTH, 1.75), layout="constrained")
for ax, name in zip(axes, ("plane", "circle", "bowl", "polyline", "implicit")):
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.15))
    ax.set_title(name, family="monospace", fontsize=9.5)


def solid(ax, points):
    ax.fill(*np.array(points).T, facecolor=SOLID, edgecolor=GREY, hatch="////", lw=0)


ax = axes[0]
solid(ax, [(-1, -0.7), (1, -0.1), (1, -1), (-1, -1)])
ax.plot([-1, 1], [-0.7, -0.1], color=INK)
arrow(ax, (0, -0.4), (-0.17, 0.17), RED, "n", at=1.0, offset=(-0.15, 0.05))
shape(ax, circle((0.25, 0.45), 0.28))
ax = axes[1]
solid(ax, circle((0, -0.5), 0.5))
ax.plot(*circle((0, -0.5), 0.5).T, color=INK)
shape(ax, circle((0.15, 0.45), 0.28))
ax = axes[2]
ring = circle((0, 0.25), 0.9, 200, 340)
solid(ax, [*ring, (0.85, -1), (-0.85, -1)])
ax.plot(*ring.T, color=INK)
shape(ax, circle((-0.3, -0.25), 0.28))
ax = axes[3]
corner = circle((-0.2, -0.3), 0.2, 90, 0, 20)
chain = np.vstack([[(-1, -0.1)], corner, [(0.0, -0.8), (1, -0.8)]])
solid(ax, [*chain, (1, -1), (-1, -1)])
ax.plot(*chain.T, color=INK)
arrow(ax, (-0.95, -0.1), (-0.45, -0.1), GREEN)
arrow(ax, (0.3, -0.8), (0.85, -0.8), GREEN)
ax.text(0.45, -0.55, "order", color=GREEN, fontsize=8.5, ha="center")
ax.text(0.1, -0.12, "rounding", fontsize=8.5, ha="left", va="center")
shape(ax, circle((-0.65, 0.28), 0.28))
ax = axes[4]
x = np.linspace(-1, 1, 100)
y = -0.45 + 0.15 * np.sin(7 * x)
solid(ax, [*np.column_stack([x, y]), (1, -1), (-1, -1)])
ax.plot(x, y, color=INK)
ax.text(0.45, -0.08, "d > 0", color=BLUE, fontsize=8.5, ha="center")
shape(ax, circle((-0.35, 0.35), 0.28))
save(figure, "obstacles")
