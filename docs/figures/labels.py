"""Numbers of bodies and obstacles of a scene, and labels of the boundary in a mesh file."""

import numpy as np
from style import (
    BLUE,
    BODY,
    GREEN,
    GREY,
    INK,
    ORANGE,
    OTHER,
    RED,
    WIDTH,
    circle,
    ground,
    plt,
    save,
    shape,
)

figure, (ax, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.75), layout="constrained")
for panel in (ax, right):
    panel.set_aspect("equal")
    panel.axis("off")
ground(ax, -1.9, 1.7, 0, 0.14)
shape(ax, [(-1.2, 0), (1.0, 0), (1.0, 0.75), (-1.2, 0.75)], OTHER)
shape(ax, circle((-0.2, 1.4), 0.55))
ax.fill([-2.05, -1.9, -1.9, -2.05], [-0.14, -0.14, 2.1, 2.1], facecolor="#d7d7d7", hatch="////", edgecolor=GREY, lw=0)
ax.plot([-1.9, -1.9], [0, 2.1], color=INK, lw=1.4)
ax.text(-0.2, 1.4, "disc\nbody 1", ha="center", va="center", fontsize=9)
ax.text(-0.1, 0.37, "block, body 2", ha="center", va="center", fontsize=9)
ax.text(0.4, -0.3, "floor, obstacle 1: partner −1", ha="center", fontsize=9)
ax.text(-2.0, 2.25, "wall, obstacle 2: partner −2", ha="left", va="bottom", fontsize=9)
ax.text(0.5, 1.62, "vy_1, elastic_1,\nforce_y_1", color=BLUE, family="monospace", fontsize=8, va="center")
ax.text(1.08, 0.37, "vy_2, elastic_2,\nforce_y_2", color=ORANGE, family="monospace", fontsize=8, va="center")
ax.set(xlim=(-2.1, 2.3), ylim=(-0.5, 2.5))

half = np.vstack([[(0, 1.7), (0.3, 1.7), (0.95, 1.2), (0.95, 0.5), (0.55, 0.0), (0, 0.0)]])
shape(right, half, BODY, lw=0)
right.plot([0, 0], [0, 1.7], color=GREEN, lw=3)
right.plot([0.95, 0.55, 0], [0.5, 0, 0], color=RED, lw=3)
right.plot([0, 0.3, 0.95, 0.95], [1.7, 1.7, 1.2, 0.5], color=GREY, lw=3)
right.text(-0.08, 0.85, "2: symmetry\nu_x = 0", color=GREEN, ha="right", va="center", fontsize=9)
right.text(0.85, 0.12, "1: contact", color=RED, ha="left", va="center", fontsize=9)
right.text(1.05, 1.0, "3 and more:\nfree, never in\ncontact", color=INK, ha="left", va="center", fontsize=9)
right.text(0.42, 0.95, "half of\na body", ha="center", va="center", fontsize=9)
right.set(xlim=(-1.1, 2.0), ylim=(-0.3, 1.95))
save(figure, "labels")
