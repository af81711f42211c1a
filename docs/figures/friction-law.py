"""The regularised friction law (12), (13): three functions phi, and mu phi with a static and a
dynamic coefficient."""

import numpy as np
from style import BLUE, GREEN, GREY, INK, ORANGE, RED, graph, save

figure, (law_axes, coefficient_axes) = graph(2.75, 2)
v = np.linspace(-3, 3, 601)
law_axes.plot(v, np.clip(v, -1, 1), color=BLUE, label="linear φ³ (default)")
law_axes.plot(v, np.tanh(v), color=GREEN, ls="--", label="tanh φ²")
law_axes.plot(v, v / np.hypot(v, 1), color=ORANGE, ls="-.", label="sqrt φ¹")
law_axes.set(xlabel=r"slip velocity $v_T/\varepsilon$", ylabel=r"$\varphi_\varepsilon(v_T)$", xticks=(-2, -1, 0, 1, 2), yticks=(-1, 0, 1), ylim=(-1.15, 1.9))
law_axes.legend(loc="upper left", fontsize=8, ncol=1, borderaxespad=0)

static, dynamic = 0.7, 0.5
coefficient_axes.axvspan(-1, 1, color=BLUE, alpha=0.1, lw=0)
inside = np.linspace(-1, 1, 50)
coefficient_axes.plot(inside, -static * inside, color=INK)
for side in (-1, 1):
    coefficient_axes.plot([side, 3 * side], [-dynamic * side] * 2, color=INK)
    coefficient_axes.plot([side, side], [-static * side, -dynamic * side], color=RED, ls=":")
smooth = np.linspace(1, 2, 50)
coefficient_axes.plot(smooth, -(dynamic + (static - dynamic) * (1 + np.cos(np.pi * (smooth - 1))) / 2), color=GREEN, ls="--", lw=1.2)
coefficient_axes.axhline(0, color=GREY, lw=0.7)
coefficient_axes.axvline(0, color=GREY, lw=0.7)
coefficient_axes.text(0, 0.86, "stick", ha="center", color=BLUE)
coefficient_axes.text(2.1, 0.86, "slip", ha="center")
coefficient_axes.text(-2.1, 0.86, "slip", ha="center")
coefficient_axes.text(1.45, -0.86, "friction_transition\n= \"smooth\"", color=GREEN, fontsize=8, ha="left", va="center")
coefficient_axes.set(xlabel=r"slip velocity $v_T/\varepsilon$", ylabel=r"$t_T/t_N$ on the body", xticks=(-2, -1, 0, 1, 2), ylim=(-1, 1),
                     yticks=(-static, -dynamic, 0, dynamic, static), yticklabels=(r"$-\mu_e$", r"$-\mu_d$", "0", r"$\mu_d$", r"$\mu_e$"))
save(figure, "friction-law")
