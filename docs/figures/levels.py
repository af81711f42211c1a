"""Error estimate of `disc-normal` from three runs.

The figure shows the reported run with its error estimate, the two coarser runs of the estimate, other
runs, and the reference value.
"""

from style import BLUE, FOLDER, GREEN, GREY, ORANGE, graph, save

import ffimpact as ff

result = ff.run("disc-normal", out=FOLDER / ".runs/levels-reported", progress=False)
value, bar = result["rebound_vy"], result.errors["rebound_vy"]
# Elements and steps follow the root of the accuracy: 1.4 times smaller ones are those of half of it.
reported = 0.005 / 2 ** result["refinements"]
levels = (2 * reported, 4 * reported)
values = {}
for accuracy in sorted({0.005, 0.007, 0.01, 0.014, 0.02, *levels}):
    run = ff.run("disc-normal", accuracy=accuracy, estimate=False, out=FOLDER / f".runs/levels-{accuracy:g}", progress=False)
    values[accuracy] = run["rebound_vy"]

figure, ax = graph(3.0)
limit = 7.394
ax.axhspan(limit - 0.002, limit + 0.002, color=GREEN, alpha=0.3, lw=0)
ax.text(0.0152, limit - 0.0075, "reference 7.394 ± 0.002", color=GREEN, fontsize=9, va="top")
ax.plot(list(values), list(values.values()), "o-", color=GREY, ms=5, lw=0.8)
ax.errorbar([reported], [value], [bar], color=BLUE, marker="o", ms=7, capsize=5, lw=1.6)
ax.plot(levels, [values[level] for level in levels], "s", color=ORANGE, ms=7)
ax.annotate("reported: the finest run,\nwith its error estimate", (reported, value + 0.9 * bar), (0.0055, limit + 0.027), color=BLUE, fontsize=9, va="center",
            arrowprops={"arrowstyle": "-", "color": BLUE, "lw": 0.8})
for level, words, place in zip(levels, ("elements and steps\n1.4 times larger", "2 times larger"), ((0.0066, 7.405), (0.0115, 7.367))):
    ax.annotate(words, (level, values[level]), place, color=ORANGE, fontsize=9, va="center", arrowprops={"arrowstyle": "-", "color": ORANGE, "lw": 0.8})
ax.set(xlabel="accuracy for which elements and steps are chosen (finer to the left)", ylabel="rebound_vy [m/s]", xlim=(0, 0.0215), ylim=(7.355, 7.43))
save(figure, "levels")
print(values, value, bar, result["refinements"])
