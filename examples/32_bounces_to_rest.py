"""
A disc bounces until it rests
=============================

A damped disc falls half a metre and bounces sixteen times before it rests. The restitution rises
from bounce to bounce, as slower impacts strain the disc less quickly, and falls again when the
weight keeps the disc on the ground.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# The scene is built in. Its loss factor is 0.5 and its end is open: the run ends when all rests.
# Free flight costs nothing, because the program skips it once the disc has ceased to vibrate.
result = ff.run("disc-rest", estimate=False)
print(f"ended by {result['ended']} after {result['bounces']} bounces, {result['steps']} steps")
result

# %%
# Height
# ------
# Height of the centre over time. A flight is one step of the table, so the parabola is drawn from
# place and velocity at its start.
history = result.history
disc = result.scene["body"][0]
gravity, radius, fall = 9.81, disc["radius"], disc["position"][1] - disc["radius"]
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
times = np.linspace(0, history.t.iloc[-1], 2000)
before = history.iloc[np.searchsorted(history.t, times, side="right") - 1]
since = times - before.t
height = before.y + before.vy * since - gravity * since**2 / 2
ax.plot(times, 1e3 * (height - radius))
ax.set(xlabel="time [s]", ylabel="height above the plane [mm]")
plt.show()

# %%
# Restitution
# -----------
# The restitution over the speed of approach, from the table of contacts.
contacts = result.contacts[result.contacts.restitution.notna()]
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.semilogx(contacts.approach, contacts.restitution, "o-")
ax.set(xlabel="speed of approach [m/s]", ylabel="restitution [-]")
plt.show()

# %%
# At rest
# -------
# The disc as it rests, pressed flat by its own weight.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.shapes(ax=ax, time=float(history.t.iloc[-1]))
plt.show()

# %%
# Comparison
# ----------
# At rest the half-width of the contact is that of Hertz, in plane strain
# :math:`b^2 = 4 W R / (\pi E^*)`. Half an element of the contact is taken as its error. The first
# touch and the balance of energy are exact; their error is the length of a step and round-off.
weight = gravity * result["mass"]
modulus = disc["young"] / (1 - disc["nu"] ** 2)
hertz = np.sqrt(4 * weight * radius / (np.pi * modulus))
first = np.sqrt(2 * fall / gravity)
step = history.dt[history.normal_force > 0].iloc[0]
kept = sum(history[name].iloc[-1] for name in ("kinetic", "elastic", "contact"))
fallen = weight * (radius + fall - history.y.iloc[-1])
rows = [
    ("time of the first touch", "s", result["contact_start"], step, first, 0, "exact: free fall",
     ""),
    ("energy taken and kept", "J/m", history.viscous_work.iloc[-1] + kept, 1e-6 * fallen, fallen,
     0, "exact: weight times way", ""),
    ("half-width of the contact at rest", "m", history.contact_half_width.iloc[-1],
     disc["contact_mesh_size"] / 2, hertz, 0, "Hertz, small strains", ""),
    ("bounces", "1", result["bounces"], np.nan, np.nan, np.nan, "", "no reference: a new scene"),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A smaller loss: ``ff.run("disc-rest", loss=0.3)``. How many bounces are there?
# * Gravity of the moon, ``gravity=1.62``.
