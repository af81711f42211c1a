"""
A sticky ball
=============

A soft ball and a plane attract each other over a short range. The faster ball leaves, slower than it
came, as parting leaves vibration behind; the slow one stays.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# Restitution over speed
# ----------------------
# The adhesion of 50 J/m² over 1 mm is that of a tacky gel. There is no gravity and no loss in the
# material.
radius, adhesion, attracted = 0.05, 50.0, 1e-3
gel = ff.NeoHookean(young=1e6, nu=0.3, density=1000)


def strikes(speed, stiff=1.0):
    """The ball three ranges above the plane; stiff: the factor of its modulus."""
    material = ff.NeoHookean(young=stiff * gel.young, nu=gel.nu, density=gel.density)
    ball = ff.Ball(radius=radius, position=radius + 3 * attracted, velocity=-speed, material=material)
    scene = ff.Scene(title="sticky ball", dimension="axisymmetric", bodies=[ball],
                     obstacles=[ff.Plane()],
                     contact=ff.Contact(adhesion=adhesion, adhesion_range=attracted),
                     accuracy=0.05, end_time=0.01 + 0.03 / speed, fields=10)  # fmt: skip
    return ff.run(scene, estimate=False)


speeds = np.array([0.05, 0.1, 0.15, 0.2, 0.4, 0.8])
runs = [strikes(speed) for speed in speeds]
left = np.array([run["later_contact_possible"] is False and run["rebound_vy"] > 0 for run in runs])
restitution = [run["rebound_vy"] / speed if gone else 0 for run, speed, gone in zip(runs, speeds, left)]
runs[-1]

# %%
# The slow and the fast one
# -------------------------
fig, axes = plt.subplots(2, figsize=(6, 5), layout="constrained")
axes[0].plot(speeds, restitution, "o-")
axes[0].set(xlabel="speed [m/s]", ylabel="restitution, 0: it stays [-]")
for run, speed in ((runs[0], speeds[0]), (runs[3], speeds[3])):
    axes[1].plot(1e3 * run.history.t, 1e3 * (run.history.y - radius), label=f"{speed:g} m/s")
axes[1].set(xlabel="t [ms]", ylabel="height of the centre\nover the radius [mm]", ylim=(-5, 10))
axes[1].legend()
plt.show()

# %%
# Parting of a stiff ball
# -----------------------
# A ball that hardly deforms parts at the force 2 pi w R of Bradley (1932). The force is the change
# of momentum in steps.
stiff = strikes(0.4, stiff=300)
momentum, t = stiff.history.momentum_y, stiff.history.t
tension = -(np.diff(momentum) / np.diff(t)).min()
bradley = 2 * np.pi * adhesion * radius

# %%
# Comparison
# ----------
drift = max(run["energy_drift"] for run in runs)
rows = [
    ("tension at which a stiff ball parts", "N", tension, 0.03 * bradley, bradley, 0.02 * bradley,
     "Bradley 1932", ""),
    ("balance of energy", "1", drift, 1e-9, 0, 1e-9, "exact", ""),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A loss in the material: the ball stays at higher speeds.
# * A smaller range needs smaller elements; the warning ``adhesion`` says so.
