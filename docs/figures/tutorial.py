"""Figures of the tutorial: `disc-normal` at four instants, and its force beside that of a slower
neo-Hookean impact."""

from style import BLUE, FOLDER, ORANGE, WIDTH, graph, plt, save

import ffimpact as ff

result = ff.run("disc-normal", fields=40, out=FOLDER / ".runs/disc-normal-states", progress=False)
figure, axes = plt.subplots(1, 4, figsize=(WIDTH, 1.85), layout="constrained", sharex=True, sharey=True)
for time, ax in zip((0.3e-3, 1e-3, 2.1e-3, 4.6e-3), axes):
    drawn = set(figure.axes)
    result.plot.shapes(ax, time=time)
    for bar in set(figure.axes) - drawn:
        bar.remove()
    ax.set(xlabel="", ylabel="", xticks=(), yticks=(), xlim=(-0.065, 0.065), ylim=(-0.012, 0.125))
    ax.title.set_fontsize(9)
    for side in ax.spines.values():
        side.set_visible(False)
save(figure, "tutorial-shapes", "png")

slow = ff.run("disc-normal", speed=4, law="neohookean", out=FOLDER / ".runs/slow", progress=False)
figure, ax = graph(2.6)
for run, color, label in ((result, BLUE, "8 m/s, St. Venant–Kirchhoff"), (slow, ORANGE, "4 m/s, neo-Hookean")):
    ax.plot(1e3 * run.history.t, 1e-3 * run.history.normal_force, color=color, label=label)
ax.set(xlabel="time [ms]", ylabel="normal force [kN/m]", ylim=(0, None), xlim=(0, 5.2))
ax.legend(fontsize=9)
save(figure, "tutorial-force")
