"""Penalties that reproduce each contact time printed in the paper, over nu (St. Venant-Kirchhoff).

The data are those of the table in the-paper.md.
"""

from style import BLUE, GREEN, GREY, ORANGE, graph, save

TIMES = (("disc, 4.8 ms at 8 m/s", BLUE, ((0.30, 1.8e9, 1e12), (0.40, 1.0e9, 2.1e11), (0.45, 7.8e8, 2.5e9), (0.49, 6.7e8, 1.7e9))),
         ("oblique disc, 4.5 ms at 12 m/s", ORANGE, ((0.45, 3.8e9, 1e10), (0.49, 7.3e8, 2.8e9))),
         ("ball, 6.03 ms at 8 m/s", GREEN, ((0.30, 3.3e8, 5.2e8), (0.40, 3.1e8, 3.8e8), (0.45, 2.9e8, 3.4e8), (0.49, 2.6e8, 3.0e8))))
figure, ax = graph(2.9)
positions = {0.30: 0, 0.40: 1, 0.45: 2, 0.49: 3}
for k, (label, color, ranges) in enumerate(TIMES):
    for nu, low, high in ranges:
        ax.plot([low, high], [positions[nu] + 0.2 * (1 - k)] * 2, color=color, lw=6, solid_capstyle="butt", label=label if nu == 0.49 else None)
ax.set(xscale="log", yticks=list(positions.values()), yticklabels=[f"ν = {nu:g}" for nu in positions], xlabel="penalty k [Pa/m]", ylim=(-0.5, 4.3),
       xlim=(1.5e8, 2e12))
ax.grid(axis="x", color=GREY, alpha=0.25)
ax.legend(loc="upper right", fontsize=8.5)
save(figure, "contact-times")
