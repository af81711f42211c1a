"""
A disc falls on a free block
============================

A disc of 0.5 m hits the middle of a free block of the same rubber at 10 m/s. Two thirds of the
energy end up as vibration of the block, although nothing is dissipated.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# It is section 3.2 of the paper: the block is 10 m wide and 2 m high, both bodies have E = 7 MPa
# and a density of 1722 kg/m³, and there is neither friction nor gravity. The program chooses ν =
# 0.45 and a penalty of 10⁹ Pa/m. We run it with both laws of the paper.
runs = {"SVK": ff.run("disc-block"), "neo-Hookean": ff.run("disc-block-neohookean")}
runs["SVK"]

# %%
# Disc and block in motion
# ------------------------
runs["SVK"].view()

# %%
# Exchange of momentum
# --------------------
# The momenta of the disc and of the block change by opposite amounts. The sum is constant.
history = runs["SVK"].history
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for name, label in (("momentum_y_1", "disc"), ("momentum_y_2", "block"), ("momentum_y", "both")):
    ax.plot(1e3 * history.t, 1e-3 * history[name], label=label)
ax.set(xlabel="time [ms]", ylabel="vertical momentum [kN s/m]")
ax.legend()
plt.show()

# %%
# Energies
# --------
# The same as figure 9 of the paper: the energy of the disc falls, the total does not change.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for k, label in ((1, "disc"), (2, "block")):
    energy = history[f"kinetic_{k}"] + history[f"elastic_{k}"]
    ax.plot(1e3 * history.t, 1e-3 * energy, label=label)
total = history.kinetic + history.elastic + history.contact
ax.plot(1e3 * history.t, 1e-3 * total, "k--", label="total")
ax.set(xlabel="time [ms]", ylabel="energy [kJ/m]")
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# Momentum and energy are kept exactly. For the neo-Hookean law there are two runs of NGSolve. We
# take the finer one as known to the difference between them. Figure 9 of the paper prints no
# numbers.
mass, block, speed = 1722 * np.pi * 0.5**2, 1722 * 10 * 2.0, 10.0
peer = "NGSolve, finer of two meshes"
rows = []
for law, result in runs.items():
    disc_v, block_v, errors = result["rebound_vy_1"], result["rebound_vy_2"], result.errors
    of_block = mass / block * errors["rebound_vy_1"]  # equal impulses on both bodies
    theirs, source, note = [(np.nan, np.nan)] * 2, "", "the paper prints no value"
    if law == "neo-Hookean":
        theirs, source, note = [(4.55505, 0.0213), (-0.57157, 0.0008)], peer, ""
    rows += [
        (f"momentum after, {law}", "N s/m", mass * disc_v + block * block_v,
         mass * errors["rebound_vy_1"], -mass * speed, 0.0, "exact: momentum before", ""),
        (f"energy after, {law}", "J/m", result["energy_final"], errors["energy_final"],
         mass * speed**2 / 2, 0.0, "exact: energy before", ""),
        (f"velocity of the disc, {law}", "m/s", disc_v, errors["rebound_vy_1"], *theirs[0],
         source, note),
        (f"velocity of the block, {law}", "m/s", block_v, of_block, *theirs[1], source, note),
        (f"vibration of the block, {law}", "1", result["vibration_energy_2"]
         / result["energy_initial"], errors["energy_final"] / result["energy_initial"], np.nan,
         np.nan, "", "share of the energy; the paper prints no value"),
    ]
numbers = pd.DataFrame(
    rows, columns="quantity unit computed error reference uncertainty source note".split()
)
numbers

# %%
# What to try next
# ----------------
# * A higher block, ``{"body.2.height": 4, "body.2.position": [0, -2]}``: when do the waves come back to the disc?
# * A narrow block, ``{"body.2.width": 2}``, which vibrates less.
# * A slower disc, ``{"body.1.speed": 1}``.
