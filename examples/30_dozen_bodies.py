"""
A dozen bodies thrown into a box
================================

Discs, rings, squares and pentagons of soft rubber fall into a box, hit its walls and each other,
fold and fly apart. Some fifty contacts come and go, and energy and momentum stay exact.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The bodies
# ----------
# Three rows of four bodies with random velocities. Elements are coarse and the contact is soft:
# warnings say so. This page is for the eye, and its balances hold on any mesh.
rubber = ff.NeoHookean(young=3e5, nu=0.3, density=1100)
random = np.random.default_rng(3)
corners = np.arange(5) * 2 * np.pi / 5 + 0.3
pentagon = [(0.023 * float(np.cos(angle)), 0.023 * float(np.sin(angle))) for angle in corners]
shapes = [
    lambda **more: ff.Disc(radius=0.022, **more),
    lambda **more: ff.Ring(radius=0.024, inner_radius=0.014, **more),
    lambda **more: ff.Rectangle(width=0.036, height=0.036, angle=20, **more),
    lambda **more: ff.Polygon(vertices=pentagon, **more),
]
bodies = []
for k in range(12):
    column, row = k % 4, k // 4
    velocity = (round(float(random.uniform(-2, 2)), 2), round(float(random.uniform(-3, -1)), 2))
    body = shapes[(column + row) % 4](
        name=f"body{k + 1}",
        material=rubber,
        position=(0.08 * (column - 1.5), 0.04 + 0.07 * row),
        velocity=velocity,
        mesh_size=0.0099,
        contact_mesh_size=0.0099,
    )
    bodies.append(body)
walls = [(-0.17, 0.6), (-0.17, 0.0), (0.17, 0.0), (0.17, 0.6)]
scene = ff.Scene(
    title="a dozen bodies",
    bodies=bodies,
    obstacles=[ff.Polyline(vertices=walls, name="box")],
    contact=ff.Contact(friction_static=0.3, penalty=3e8),
    gravity=9.81,
    dt=2.5e-4,
    end_time=0.06,
    accuracy=0.1,
)
result = ff.run(scene, estimate=False)
print(f"{len(result.contacts)} intervals of contact, {result['dofs']} unknowns")

# %%
# Four instants
# -------------
# The colour is the von Mises stress.
fig, axes = plt.subplots(2, 2, figsize=(9, 6), layout="constrained")
for ax, time in zip(axes.flat, (0.011, 0.020, 0.040, 0.060)):
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
# Energies of all bodies together:
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.energies(ax=ax)
plt.show()

# %%
# Comparison
# ----------
# Contacts between bodies have no resultant: the total momentum changes by the forces of the box
# and by weight alone.
history, everyone = result.history, range(1, 13)
first, last = history.iloc[0], history.iloc[-1]
weight = 9.81 * result["mass"]
heights = sum(result[f"mass_{k}"] * 9.81 * (first[f"y_{k}"] - last[f"y_{k}"]) for k in everyone)
kept = last.kinetic + last.elastic + last.contact + last.friction_work
momentum = np.sqrt(2 * first.kinetic * result["mass"])
by_box_x = sum(result[f"impulse_x_{k}"] for k in everyone)
by_box_y = sum(result[f"impulse_y_{k}"] for k in everyone)
rows = [
    ("energy kept and taken by friction", "J/m", kept, 1e-8 * kept, first.kinetic + heights, 0,
     "exact: fall of the weights", ""),
    ("change of momentum along x", "N s/m", last.momentum_x - first.momentum_x, 1e-8 * momentum,
     by_box_x, 0, "exact: impulse of the box", ""),
    ("change of momentum along y", "N s/m", last.momentum_y - first.momentum_y, 1e-8 * momentum,
     by_box_y - weight * last.t, 0, "exact: impulse of box and weight", ""),
    ("share of energy taken by friction", "1", last.friction_work / kept, np.nan, np.nan, np.nan,
     "", "no reference: a new scene"),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * Another seed of the random numbers.
# * No friction, ``friction_static=0``: which bodies still turn?
