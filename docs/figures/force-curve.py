"""The force history of `disc-normal` with onset and end of contact, threshold, impulse and the
phases of compression and restitution."""

import numpy as np
from style import BLUE, FOLDER, GREEN, GREY, INK, ORANGE, RED, graph, save

import ffimpact as ff

result = ff.run("disc-normal", out=FOLDER / ".runs/disc-normal", progress=False)
history = result.history
t, force, speed = 1e3 * history.t.to_numpy(), 1e-3 * history.normal_force.to_numpy(), history.vy.to_numpy()
middle = np.append(t[0], (t[1:] + t[:-1]) / 2)
on = 1e3 * result["contact_start"]
off = on + 1e3 * result["contact_time"]
turn = np.interp(0, speed, t)

figure, (ax, low) = graph(3.9, rows=2, sharex=True, gridspec_kw={"height_ratios": (2.2, 1)})
at = np.interp(turn, middle, force)
first, second = middle < turn, middle > turn
ax.fill_between(np.append(middle[first], turn), np.append(force[first], at), color=BLUE, alpha=0.22, lw=0)
ax.fill_between(np.append(turn, middle[second]), np.append(at, force[second]), color=ORANGE, alpha=0.25, lw=0)
ax.plot(middle, force, color=INK)
ax.axhline(0.01 * force.max(), color=GREY, lw=0.8, ls="--")
ax.text(off + 0.3, 0.01 * force.max() + 0.8, "1 % of the peak", fontsize=8.5, color=GREY, va="bottom")
ax.text(turn - 0.95, 22, "impulse of the\ncompression $J_c$", ha="center", color=BLUE, fontsize=9)
ax.text(turn + 0.95, 22, "impulse of the\nrestitution $J_r$", ha="center", color=ORANGE, fontsize=9)
k = force.argmax()
ax.plot(middle[k], force[k], "o", color=RED, ms=5)
ax.annotate("peak_force", (middle[k], force[k]), (middle[k] + 0.75, force[k] + 1), color=RED, family="monospace", fontsize=9, va="center",
            arrowprops={"arrowstyle": "-", "color": RED, "lw": 0.8})
for x, label in ((on, r"$t_{on}$"), (off, r"$t_{off}$")):
    for panel in (ax, low):
        panel.axvline(x, color=GREEN, lw=1, ls=":")
    ax.text(x, 76, label, color=GREEN, ha="center", va="bottom", fontsize=11)
ax.annotate("", (off, 72), (on, 72), arrowprops={"arrowstyle": "<->", "color": GREEN, "lw": 1.2})
ax.text(0.9, 72.8, "contact_time", color=GREEN, ha="center", va="bottom", family="monospace", fontsize=9)
ax.set(ylabel="normal force [kN/m]", ylim=(0, 84))
low.plot(t, speed, color=BLUE)
low.axhline(0, color=GREY, lw=0.8)
low.axvline(turn, color=GREY, lw=0.8, ls=":")
low.text(turn + 0.08, -7.5, "compression ends: $v_y=0$", fontsize=8.5, color=INK, va="bottom")
low.set(xlabel="time [ms]", ylabel="$v_y$ [m/s]", xlim=(-0.35, 6.3), ylim=(-9.5, 9.5), yticks=(-8, 0, 8))
low.text(off + 0.12, speed[-1] - 4.6, f"rebound_vy\n= {result['rebound_vy']:.2f} m/s", family="monospace", fontsize=8, color=BLUE, va="center")
save(figure, "force-curve")
