"""Angles and signs of an oblique impact: velocities before and after, spin, normal force and
friction."""

import numpy as np
from style import BLUE, GREEN, INK, RED, WIDTH, angle, arrow, circle, ground, plt, save, shape, spin

figure, ax = plt.subplots(figsize=(WIDTH, 3.35), layout="constrained")
ax.set_aspect("equal")
ax.axis("off")
ground(ax, -2.6, 4.75, depth=0.18)
for x, title in ((-1.3, "before"), (1.15, "contact"), (3.6, "after")):
    ax.text(x, 2.72, title, ha="center", fontsize=11, weight="bold")

# Before contact.
shape(ax, circle((-1.3, 1.5), 0.5))
a = np.radians(60)
arrow(ax, (-1.3, 1.5), (-1.3 + 1.45 * np.cos(a), 1.5 - 1.45 * np.sin(a)), BLUE)
ax.text(-1.36, 0.72, r"$v$", color=BLUE, ha="center", fontsize=12)
foot = (-1.3 + 1.5 / np.tan(a), 0)
ax.plot([-1.3, foot[0]], [1.5, 0], color=BLUE, lw=0.8, ls=":")
ax.plot([foot[0] - 1.1, foot[0]], [0, 0], color=INK, lw=1)
angle(ax, foot, 0.55, 120, 180, r"$\theta$", offset=1.3)
ax.text(-2.55, 2.25, "angle = 60\nspeed = 12", family="monospace", fontsize=8.5, va="center")

# In contact.
shape(ax, [(x, max(y, 0)) for x, y in circle((1.15, 0.46), 0.5)])
arrow(ax, (1.15, 0), (1.15, 1.35), GREEN, r"$F_N>0$", at=1.0, offset=(0, 0.16))
arrow(ax, (1.15, 0.03), (0.3, 0.03), RED, r"$F_T<0$", at=0.75, offset=(-0.12, 0.24), width=2)
arrow(ax, (1.25, -0.42), (2.0, -0.42), INK, "slip", at=1.0, offset=(0.28, 0))
spin(ax, (1.15, 0.46), 0.3, 70, -150)

# After contact.
shape(ax, circle((3.3, 1.2), 0.5))
b = np.radians(72)
arrow(ax, (3.3, 1.2), (3.3 + 1.35 * np.cos(b), 1.2 + 1.35 * np.sin(b)), BLUE, r"$v'$", at=0.95, offset=(0.2, -0.05), fontsize=12)
spin(ax, (3.3, 1.2), 0.3, 60, -200, RED)
ax.text(3.95, 0.82, r"spin $\omega<0$", color=RED, ha="left")
ax.plot([3.3 - 1.2 / np.tan(b), 3.3], [0, 1.2], color=BLUE, lw=0.8, ls=":")
angle(ax, (3.3 - 1.2 / np.tan(b), 0), 0.55, 0, 72, r"$\theta'$", offset=1.35)

# Axes.
arrow(ax, (-2.5, 0.25), (-1.95, 0.25), INK, "x", at=1.15)
arrow(ax, (-2.5, 0.25), (-2.5, 0.8), INK, "y", at=1.2)
spin(ax, (-2.5, 1.35), 0.17, -60, 200, INK)
ax.text(-2.22, 1.35, "> 0", va="center", fontsize=9)
ax.set(xlim=(-2.75, 4.95), ylim=(-0.6, 2.95))
save(figure, "angles")
