"""Error from two runs of `disc-normal` at several mesh sizes.

The figure shows the reported run, the coarser run, their difference and the error estimate.
"""

import numpy as np
from style import BLUE, FOLDER, GREEN, GREY, ORANGE, graph, save

import ffimpact as ff

sizes = (0.02, 0.014, 0.01, 0.007, 0.005)
values = []
for accuracy in sizes:
    result = ff.run("disc-normal", accuracy=accuracy, estimate=False, out=FOLDER / f".runs/two-runs-{accuracy:g}", progress=False)
    values.append(result["rebound_vy"])
values = np.array(values)
reported = ff.run("disc-normal", accuracy=0.007, out=FOLDER / ".runs/two-runs-pair", progress=False)
bar = reported.errors["rebound_vy"]

figure, ax = graph(3.0)
x = np.array(sizes)
limit = 7.394
ax.axhspan(limit - 0.002, limit + 0.002, color=GREEN, alpha=0.3, lw=0)
ax.text(0.0004, limit + 0.0032, "reference 7.394 ± 0.002", color=GREEN, fontsize=9, va="bottom", bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})
ax.plot(x, values, "o-", color=GREY, ms=5, lw=0.8)
k, coarse = 3, 2
ax.errorbar([0.007], [reported["rebound_vy"]], [bar], color=BLUE, marker="o", ms=7, capsize=5, lw=1.6)
ax.plot(0.01, values[coarse], "s", color=ORANGE, ms=7)
ax.annotate("reported: the finer run,\nwith its error estimate", (0.007, reported["rebound_vy"] + bar), (0.0145, limit + 0.0145), color=BLUE, fontsize=9,
            va="center", arrowprops={"arrowstyle": "-", "color": BLUE, "lw": 0.8})
ax.annotate("the coarser run:\nelements and steps\n1.4 times larger", (0.01, values[coarse]), (0.0125, values[coarse] + 0.004), color=ORANGE, fontsize=9, va="center",
            arrowprops={"arrowstyle": "-", "color": ORANGE, "lw": 0.8})
ax.set(xlabel="requested accuracy (element size falls to the left)", ylabel="rebound_vy [m/s]", xlim=(0, 0.022), ylim=(7.37, 7.416))
save(figure, "two-runs")
print(values, reported["rebound_vy"], bar)
