"""Error estimates and cost (unknowns times steps) over the requested accuracy for `disc-normal`."""

from style import BLUE, FOLDER, GREEN, GREY, ORANGE, RED, graph, save

import ffimpact as ff

ACCURACIES = (0.05, 0.02, 0.01, 0.005, 0.0025)
results = [ff.run("disc-normal", accuracy=accuracy, law="neohookean", out=FOLDER / f".runs/cost-{accuracy:g}", progress=False)
           for accuracy in ACCURACIES]
percent = [100 * accuracy for accuracy in ACCURACIES]
figure, (error_axes, cost_axes) = graph(3.0, 2)
for name, color, marker in (("impulse", BLUE, "o"), ("rebound_vy", GREEN, "s"), ("thresholded_contact_time", ORANGE, "^"), ("peak_force", RED, "v")):
    size = 8 if name == "rebound_vy" else None
    error_axes.plot(percent, [100 * result.errors[name] / (size or result[name]) for result in results],
                    marker + "-", color=color, label=name, ms=4.5)
error_axes.plot(percent, percent, color=GREY, ls="--", lw=1, label="requested")
error_axes.set(xscale="log", yscale="log", xlabel="accuracy [%]", ylabel="error estimate [%]", ylim=(0.01, 60))
error_axes.legend(fontsize=7.5, loc="upper left")
cost_axes.plot(percent, [result["dofs"] for result in results], "o-", color=BLUE, label="degrees of freedom")
cost_axes.plot(percent, [result["steps"] for result in results], "s-", color=ORANGE, label="time steps")
cost_axes.set(xscale="log", yscale="log", xlabel="accuracy [%]", ylim=(30, 4000))
cost_axes.legend(fontsize=8.5)
for ax in (error_axes, cost_axes):
    ax.set(xticks=(0.25, 0.5, 1, 2, 5), xticklabels=("0.25", "0.5", "1", "2", "5"))
    ax.minorticks_off()
save(figure, "cost")
print([(result["dofs"], result["steps"], result["cpu_seconds"], result["refinements"]) for result in results])
