"""
A hairpin that closes on itself
===============================

A soft strip bent to a U falls flat on the floor. Its upper leg goes on and slams on the lower
one: the outline of the body is its own contact partner.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The strip
# ---------
# The outline is a polygon: two straight legs of 6 mm and an arc between them. The program sees
# that the legs may meet, so that ``contact.self_contact`` can be left open.
thickness, length, gap = 0.006, 0.08, 0.012
arc = np.radians(np.linspace(90, 270, 13))
outer, inner = gap / 2 + thickness, gap / 2
outline = [
    (length, outer),
    *((float(outer * np.cos(angle)), float(outer * np.sin(angle))) for angle in arc),
    (length, -outer),
    (length, -inner),
    *((float(inner * np.cos(angle)), float(inner * np.sin(angle))) for angle in arc[::-1]),
    (length, inner),
]
rubber = ff.NeoHookean(young=1e6, nu=0.4, density=1100, loss=0.05, loss_model="kelvin-voigt")
pin = ff.Polygon(
    name="pin",
    vertices=outline,
    material=rubber,
    position=(0, 0.03),
    velocity=(0, -6),
    mesh_size=0.004,
    contact_mesh_size=0.003,
)
floor, contact = ff.Plane(name="floor"), ff.Contact(friction_static=0.2)
scene = ff.Scene(
    title="hairpin",
    bodies=[pin],
    obstacles=[floor],
    contact=contact,
    end_time=0.03,
    accuracy=0.05,
)
result = ff.run(scene, estimate=False)
result

# %%
# Six instants
# ------------
# It flattens, closes, opens again and flies off with its legs apart.
fig, axes = plt.subplots(3, 2, figsize=(9, 6), layout="constrained")
for ax, time in zip(axes.flat, (0.0037, 0.0043, 0.0058, 0.008, 0.010, 0.030)):
    result.plot.shapes(ax=ax, time=time)
plt.show()

# %%
# The player
# ----------
# The states as an animation.
result.view()

# %%
# Energies
# --------
# Energies: friction between the legs, friction on the floor and the damping of the rubber take
# part of them. The sum of all stays constant.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.energies(ax=ax)
plt.show()

# %%
# Comparison
# ----------
# A contact of the body with itself has no resultant: the floor alone changes the momentum, in the
# time in which the legs hit each other, too.
history, mass = result.history, result["mass"]
start = mass * 6.0**2 / 2
spent = history.friction_work.iloc[-1] + history.viscous_work.iloc[-1]
kept = sum(history[name].iloc[-1] for name in ("kinetic", "elastic", "contact"))
by_floor = result.contacts.impulse_y[result.contacts.partner < 0].sum()
by_friction = np.sum(history.friction_force * history.dt)
rounding = 1e-8 * start
rows = [
    ("energy kept and taken", "J/m", kept + spent, rounding, start, 0, "exact: balance of energy",
     ""),
    ("change of momentum along y", "N s/m", mass * (history.vy.iloc[-1] + 6), 1e-8 * mass * 6,
     by_floor, 0, "exact: impulse of the floor", ""),
    ("change of momentum along x", "N s/m", mass * history.vx.iloc[-1], 1e-8 * mass * 6,
     by_friction, 0, "exact: impulse of the floor", ""),
    ("restitution", "1", history.vy.iloc[-1] / 6, np.nan, np.nan, np.nan, "",
     "no reference: a new scene"),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * ``self_contact="off"`` in ``ff.Contact``, and the warning that the legs overlap.
# * More friction, with which the legs stick to each other.
