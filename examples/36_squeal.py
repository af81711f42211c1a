"""
Squeal
======

A block of rubber is pressed on a belt. Its friction falls with the slip velocity (Stribeck), so that
friction pushes where the block moves along, and the vibration grows until the lower face sticks at
times: it squeals. With constant friction it does not.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# Two frictions
# -------------
# Both have the same friction at the speed of the belt. The top goes down smoothly in 10 ms.
height, width, belt, pressure = 0.02, 0.2, 0.2, 1e4
young, nu, density, viscosity = 3e6, 0.45, 1100.0, 30.0
press = pressure * height * (1 - 2 * nu) * (1 + nu) / (young * (1 - nu))
falling = "0.2 + 0.4*exp(-v/0.3)"
constant = f"{0.2 + 0.4 * np.exp(-belt / 0.3)}"


def drawn(friction):
    """The run with this friction."""
    rubber = ff.NeoHookean(young=young, nu=nu, density=density, viscosity=viscosity)
    top = ff.Support(where="top", motion=[0, f"-{press}*(1-cos(pi*min(1,t/0.01)))/2"])
    block = ff.Rectangle(name="block", width=width, height=height, position=(0, height / 2),
                         material=rubber, mesh_size=0.004, contact_mesh_size=0.004,
                         support=[top])  # fmt: skip
    scene = ff.Scene(title="squeal", bodies=[block], obstacles=[ff.Plane(velocity=(belt, 0))],
                     contact=ff.Contact(friction=friction), end_time=0.07, accuracy=0.02)  # fmt: skip
    return ff.run(scene, estimate=False)


squeals, silent = drawn(falling), drawn(constant)
squeals

# %%
# The vibration
# -------------
fig, axes = plt.subplots(2, figsize=(6, 4.5), sharex=True, layout="constrained")
for run, label in ((squeals, "falling friction"), (silent, "constant friction")):
    history = run.history
    axes[0].plot(1e3 * history.t, history.vx, label=label)
    axes[1].plot(1e3 * history.t, history.friction_force / history.normal_force.where(history.t > 2e-3))
axes[0].set(ylabel="mean velocity [m/s]")
axes[0].legend()
axes[1].set(xlabel="t [ms]", ylabel="friction over\nnormal force [-]")
plt.show()

# %%
# Its growth
# ----------
# A wide layer that is held at its top has the first shear mode sin(pi y/2h). Friction with the
# slope mu' adds the rate -mu' p/(rho h) to its growth, viscosity takes eta omega^2/(2 mu).
history = squeals.history
shear = young / (2 * (1 + nu))
omega = np.pi / 2 * np.sqrt(shear / density) / height
period = 2 * np.pi / omega
settled = history.t > 0.015
p = history.normal_force[settled].mean() / width
slope = -0.4 / 0.3 * np.exp(-belt / 0.3)
theory = -slope * p / (density * height) - viscosity * omega**2 / (2 * shear)
starts = np.arange(0.018, 0.044 - period, period)
size = [history.vx[(history.t > t) & (history.t < t + period)].abs().max() for t in starts]
(growth, _), spread = np.polyfit(starts, np.log(size), 1, cov=True)
last = silent.history.vx[silent.history.t > 0.06].abs().max()
print(f"growth {growth:.0f} +- {np.sqrt(spread[0, 0]):.0f}, theory {theory:.0f} 1/s")

# %%
# Comparison
# ----------
rows = [
    ("growth of the vibration", "1/s", growth, 2 * np.sqrt(spread[0, 0]), theory, 0.1 * theory,
     "linear theory of a wide layer", ""),
    ("velocity at the end, constant friction", "m/s", last, 0.002, 0, 0.001, "exact: at rest", ""),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A faster belt: at 1 m/s the friction hardly falls, and viscosity keeps the block quiet.
# * Less viscosity: short waves along the lower face grow as well.
