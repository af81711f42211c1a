"""Smallest eigenvalue of the acoustic tensor over mu in uniaxial strain, over the stretch and nu.

The law is St. Venant-Kirchhoff.
"""

import numpy as np
from style import BLUE, GREEN, GREY, RED, graph, save

figure, ax = graph(2.7)
turn = np.radians(np.linspace(0, 90, 181))
N = np.column_stack([np.cos(turn), np.sin(turn)])
stretch = np.linspace(0.5, 1.05, 300)
for nu, color in ((0.0, GREEN), (0.3, BLUE), (0.45, RED)):
    lam, smallest = 2 * nu / (1 - 2 * nu), []  # relative to mu = 1
    for value in stretch:
        F = np.diag([value, 1.0])
        E = (F.T @ F - np.eye(2)) / 2
        S = lam * np.trace(E) * np.eye(2) + 2 * E
        n = N @ F.T
        Q = np.einsum("ni,ij,nj->n", N, S, N)[:, None, None] * np.eye(2) + (lam + 1) * n[:, :, None] * n[:, None, :] + F @ F.T
        smallest.append(np.linalg.eigvalsh(Q)[:, 0].min())
    smallest = np.array(smallest)
    ax.plot(stretch, smallest, color=color, label=f"ν = {nu:g}")
    k = np.flatnonzero(smallest > 0)[0]
    lost = np.interp(0, smallest[k - 1:k + 1], stretch[k - 1:k + 1])
    ax.plot(lost, 0, "o", color=color)
    ax.annotate(f"{lost:.3f}", (lost, 0), (lost - 0.012, 0.1), color=color, ha="right", fontsize=9)
ax.axhspan(-1.2, 0, color=RED, alpha=0.07, lw=0)
ax.axhline(0, color=GREY, lw=0.8)
ax.text(0.6, -0.75, "not elliptic: the solution\ndepends on the mesh", color=RED, fontsize=9, va="center")
ax.set(xlabel="stretch in uniaxial strain", ylabel="min_ellipticity (over μ)", ylim=(-1, 1.3), xlim=(0.5, 1.05))
ax.legend(loc="upper left", ncol=3, fontsize=9)
save(figure, "ellipticity")
