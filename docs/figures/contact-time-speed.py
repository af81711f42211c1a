"""Contact time over speed for both laws, nu = 0.45 (figures 6b and 8 of the paper). Open marks show
lost ellipticity."""

import numpy as np
from style import BLUE, FOLDER, RED, graph, save

import ffimpact as ff

SPEEDS = [float(speed) for speed in np.arange(1, 12.1, 1)]
figure, ax = graph(2.8)
for law, color, label in (("svk", RED, "St. Venant–Kirchhoff (5)"), ("neohookean", BLUE, "neo-Hookean (6)")):
    study = ff.sweep("disc-normal", {"speed": SPEEDS}, law=law, accuracy=0.005, out=FOLDER / f".runs/speeds-{law}")
    done = [(speed, result) for speed, result in zip(SPEEDS, study.results) if result is not None]
    x = np.array([speed for speed, _ in done])
    y, bar = (1e3 * np.array([get(result) for _, result in done]) for get in (lambda result: result["contact_time"], lambda result: result.errors["contact_time"]))
    kept = np.array([result["ellipticity_lost_time"] is None for _, result in done])
    ax.errorbar(x[kept], y[kept], bar[kept], color=color, marker="o", ms=4.5, capsize=3, label=label)
    if not kept.all():
        ax.plot(x[~kept], y[~kept], "o", color=color, mfc="white", ms=5, label="the same, ellipticity lost")
ax.set(xlabel="speed [m/s]", ylabel="contact_time [ms]", ylim=(3.5, 6))
ax.legend(fontsize=9)
save(figure, "contact-time-speed")
