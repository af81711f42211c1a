"""A bar that strikes flat: the exact force on a penalty, with the wave front that returns from the
free end."""

import numpy as np
from style import BLUE, BODY, GREEN, GREY, INK, RED, WIDTH, arrow, ground, plt, save, shape

figure, (ax, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.6), layout="constrained", gridspec_kw={"width_ratios": (1, 2)})
ax.set_aspect("equal")
ax.axis("off")
ground(ax, -0.3, 1.5, 0, 0.14)
shape(ax, [(0.2, 0), (1.0, 0), (1.0, 2.2), (0.2, 2.2)], "white")
shape(ax, [(0.2, 0), (1.0, 0), (1.0, 0.9), (0.2, 0.9)], BODY, lw=0)
ax.plot([0.2, 1.0], [0.9, 0.9], color=RED, lw=2)
arrow(ax, (1.2, 0.9), (1.2, 1.4), RED, "c", at=1.0, offset=(0.17, 0))
arrow(ax, (0.6, 1.9), (0.6, 1.45), INK, "v", at=1.0, offset=(0.15, 0.05))
ax.text(0.6, 0.45, "at rest,\nρcv", ha="center", va="center", fontsize=9)
ax.text(-0.2, 1.1, "L", va="center")
arrow(ax, (-0.02, 0), (-0.02, 2.2), GREY, style="<|-|>", width=1)
ax.set(xlim=(-0.45, 1.6), ylim=(-0.25, 2.4))
t = np.linspace(0, 2.6, 1200)
for kappa, color in ((10, GREY), (40, BLUE), (400, GREEN)):
    s = np.maximum(t - 2, 0)
    f = np.where(t < 2, 1 - np.exp(-kappa * t), -1 + 2 * (1 + kappa * s) * np.exp(-kappa * s))
    end = 2 + 1.678 / kappa
    right.plot(t[t <= end], f[t <= end], color=color, label=f"kL/M = {kappa}")
right.axvline(2, color=RED, lw=0.9, ls=":")
right.text(2.03, 1.12, "2L/c", color=RED, va="center", fontsize=9)
right.set(xlabel="ct/L", ylabel="force / (ρcv)", ylim=(0, 1.25), xlim=(0, 2.6))
right.legend(loc="center", fontsize=8.5)
save(figure, "front")
