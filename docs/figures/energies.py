"""The energies of `disc-oblique` over time and the work of friction."""

from style import BLUE, FOLDER, GREEN, INK, ORANGE, RED, graph, save

import ffimpact as ff

history = ff.run("disc-oblique", accuracy=0.02, estimate=False, out=FOLDER / ".runs/disc-oblique", progress=False).history
figure, ax = graph(2.8)
t = 1e3 * history.t
for name, color in (("kinetic", BLUE), ("elastic", ORANGE), ("contact", GREEN), ("friction_work", RED)):
    ax.plot(t, history[name], color=color, label=name)
ax.plot(t, history.kinetic + history.elastic + history.contact + history.friction_work, color=INK, ls="--", label="sum", lw=1.2)
ax.set(xlabel="time [ms]", ylabel="energy [J/m]", ylim=(-20, 1300), xlim=(0, t.max()))
ax.legend(ncol=3, fontsize=8.5, loc="upper center")
save(figure, "energies")
