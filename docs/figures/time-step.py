"""One time step: states at its start, middle and end, and the chord of the potential as force
(discrete gradient)."""

import numpy as np
from style import BLUE, GREEN, GREY, INK, RED, arrow, graph, save

figure, (path_axes, force_axes) = graph(2.85, 2)
t = np.linspace(-0.15, 1.15, 50)
path = 0.9 - 1.05 * t + 0.5 * t**2
path_axes.plot(t, path, color=GREY, ls="--", lw=1)
ends = np.array([[0, 0.9], [1, 0.35]])
path_axes.plot(*ends.T, color=BLUE)
for (x, y), name, offset in ((ends[0], r"$u_0,\ v_0$", (0.04, 0.06)), (ends[1], r"$u_1,\ v_1$", (-0.04, -0.08)), (ends.mean(axis=0), r"$u_{1/2}$", (0.03, 0.08))):
    path_axes.plot(x, y, "o", color=INK, ms=6)
    path_axes.text(x + offset[0], y + offset[1], name, ha="left" if x < 1 else "right")
arrow(path_axes, (0, 0.06), (1, 0.06), INK, r"$\Delta t$", offset=(0, 0.06), style="<|-|>", width=1)
path_axes.plot([0, 0], [0, 0.9], color=GREY, lw=0.7, ls=":")
path_axes.plot([1, 1], [0, 0.35], color=GREY, lw=0.7, ls=":")
path_axes.text(0.6, 0.78, "forces act at\nthe mid-point", color=BLUE, fontsize=9, ha="left")
path_axes.set(xlim=(-0.15, 1.2), ylim=(0, 1.15), xticks=(0, 0.5, 1), xticklabels=(r"$t_0$", r"$t_{1/2}$", r"$t_1$"), yticks=(), ylabel="displacement")

p = np.linspace(-0.6, 1.15, 200)
energy = np.where(p > 0, p, 0)**2 / 2
force_axes.plot(p, energy, color=INK)
a, b = -0.25, 0.95
force_axes.plot([a, b], [0, b**2 / 2], color=GREEN)
force_axes.plot([a, b], [0, b**2 / 2], "o", color=INK, ms=6)
middle = (a + b) / 2
tangent = middle * (p - middle) + middle**2 / 2
force_axes.plot(p[(p > -0.15)], tangent[p > -0.15], color=RED, ls="--", lw=1.2)
force_axes.text(0.22, 0.3, r"$t_N=\dfrac{\Phi_1-\Phi_0}{p_1-p_0}$", color=GREEN, ha="right", fontsize=11)
force_axes.text(1.0, 0.2, r"$\Phi'(p_{1/2})$", color=RED, ha="center", fontsize=9)
force_axes.text(a, 0.03, r"$p_0$", ha="center", va="bottom")
force_axes.text(b + 0.03, b**2 / 2 - 0.06, r"$p_1$", ha="left", va="top")
force_axes.axvline(0, color=GREY, lw=0.7, ls=":")
force_axes.text(-0.55, 0.55, "separated", fontsize=8.5, color=GREY, ha="left")
force_axes.text(0.06, 0.55, "penetration", fontsize=8.5, color=GREY, ha="left")
force_axes.set(xlabel=r"$p=-g$", ylabel=r"contact potential $\Phi$", xticks=(0,), yticks=(), ylim=(-0.02, 0.62))
save(figure, "time-step")
