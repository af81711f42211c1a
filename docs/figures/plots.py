"""The figures of result.plot for `disc-oblique`: force, energies, velocities and shapes."""

from style import FOLDER, WIDTH, plt, save

import ffimpact as ff

result = ff.run("disc-oblique", accuracy=0.02, estimate=False, out=FOLDER / ".runs/disc-oblique", progress=False)
figure, axes = plt.subplots(2, 2, figsize=(WIDTH, 4.6), layout="constrained")
result.plot.force(axes[0, 0])
result.plot.energies(axes[0, 1])
result.plot.velocities(axes[1, 0])
result.plot.shapes(axes[1, 1])
for ax, name in zip(axes.flat, ("force()", "energies()", "velocities()", "shapes()")):
    ax.set_title(f"result.plot.{name}", family="monospace", fontsize=9)
    if ax.get_legend():
        ax.legend(fontsize=6.5, ncols=2, loc="upper right")
        ax.set_ylim(top=1.45 * ax.get_ylim()[1])
save(figure, "plots", "png")
