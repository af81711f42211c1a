"""Uniaxial strain of a strip: J, and stress over stretch for St. Venant-Kirchhoff and neo-Hookean.

The limits of St. Venant-Kirchhoff are marked.
"""

import numpy as np
from style import BLUE, BODY, GREY, INK, RED, WIDTH, arrow, plt, save, shape

nu = 0.45
young = 1.0
lam, mu = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
figure, (ax, right) = plt.subplots(1, 2, figsize=(WIDTH, 2.9), layout="constrained", gridspec_kw={"width_ratios": (1, 1.7)})
ax.set_aspect("equal")
ax.axis("off")
for y, length, text in ((1.35, 1.0, "reference: length L, J = 1"), (0.0, 0.62, "pressed between smooth walls:\nlength ΛL, J = det F = Λ")):
    shape(ax, [(0, y), (2 * length, y), (2 * length, y + 0.62), (0, y + 0.62)], BODY)
    for k in range(1, 8):
        ax.plot([2 * length * k / 8] * 2, [y, y + 0.62], color=GREY, lw=0.6)
    ax.plot([0, 2.1], [y - 0.05] * 2, color=INK, lw=1.2)
    ax.plot([0, 2.1], [y + 0.67] * 2, color=INK, lw=1.2)
    ax.text(0, y - 0.12, text, va="top", fontsize=8.5)
arrow(ax, (2.0, 0.31), (1.27, 0.31), RED, "P", at=0.0, offset=(0.15, 0))
ax.set(xlim=(-0.1, 2.4), ylim=(-0.65, 2.2))

stretch = np.linspace(0.3, 1.15, 300)
svk = (lam + 2 * mu) * (stretch**3 - stretch) / 2
neo = mu * (stretch - 1 / stretch) + lam * np.log(stretch) / stretch
right.plot(stretch, svk / mu, color=RED, label="St. Venant–Kirchhoff (5)")
right.plot(stretch, neo / mu, color=BLUE, label="neo-Hookean (6)")
# Stretches of the limit point and of the loss of ellipticity; ellipticity.py computes the latter.
limit, lost = 1 / np.sqrt(3), 0.9055
right.plot(limit, np.interp(limit, stretch, svk) / mu, "o", color=RED, ms=5)
right.annotate("limit point Λ = 0.577:\nsoftens below", (limit, np.interp(limit, stretch, svk) / mu), (0.32, -6.5), fontsize=8.5, color=RED,
               arrowprops={"arrowstyle": "-", "color": RED, "lw": 0.8})
right.plot(lost, np.interp(lost, stretch, svk) / mu, "s", color=RED, ms=5)
right.annotate("ellipticity lost\nΛ = 0.906 (ν = 0.45)", (lost, np.interp(lost, stretch, svk) / mu), (0.42, 1.3), fontsize=8.5, color=RED, va="center",
               arrowprops={"arrowstyle": "-", "color": RED, "lw": 0.8})
right.axhline(0, color=GREY, lw=0.7)
right.set(xlabel="stretch Λ = J", ylabel="stress P / μ", ylim=(-14, 3.5), xlim=(0.3, 1.15))
right.legend(loc="lower right", fontsize=8.5)
save(figure, "strip")
