"""Error estimates and cost (unknowns times steps) over the requested accuracy for `disc-normal`."""

from style import BLUE, FOLDER, GREEN, GREY, ORANGE, RED, graph, save

import ffimpact as ff

ACCURACIES = (0.05, 0.02, 0.01, 0.005, 0.0025)
results = [ff.run("disc-normal", accuracy=one, law="neohookean", out=FOLDER / f".runs/cost-{one:g}", progress=False) for one in ACCURACIES]
percent = [100 * one for one in ACCURACIES]
figure, (left, right) = graph(3.0, 2)
for name, color, marker in (("impulse", BLUE, "o"), ("rebound_vy", GREEN, "s"), ("thresholded_contact_time", ORANGE, "^"), ("peak_force", RED, "v")):
    size = 8 if name == "rebound_vy" else None
    left.plot(percent, [100 * one.errors[name] / (size or one[name]) for one in results], marker + "-", color=color, label=name, ms=4.5)
left.plot(percent, percent, color=GREY, ls="--", lw=1, label="requested")
left.set(xscale="log", yscale="log", xlabel="accuracy [%]", ylabel="error estimate [%]", ylim=(0.01, 60))
left.legend(fontsize=7.5, loc="upper left")
right.plot(percent, [one["dofs"] for one in results], "o-", color=BLUE, label="degrees of freedom")
right.plot(percent, [one["steps"] for one in results], "s-", color=ORANGE, label="time steps")
right.set(xscale="log", yscale="log", xlabel="accuracy [%]", ylim=(30, 4000))
right.legend(fontsize=8.5)
for ax in (left, right):
    ax.set(xticks=(0.25, 0.5, 1, 2, 5), xticklabels=("0.25", "0.5", "1", "2", "5"))
    ax.minorticks_off()
save(figure, "cost")
print([(one["dofs"], one["steps"], one["cpu_seconds"], one["refinements"]) for one in results])
