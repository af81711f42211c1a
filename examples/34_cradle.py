"""
Newton's cradle of soft discs
=============================

A disc hits four others in a row, and the last one flies off. It is slower than the first was,
because each impact leaves vibration in the discs; momentum and energy are kept to round-off.
"""

import matplotlib.pyplot as plt
import pandas as pd

import ffimpact as ff

# %%
# The row
# -------
# Five discs with gaps of 2 mm, so that each impact is over before the next one begins.
rubber = ff.NeoHookean(young=5e6, nu=0.3, density=1200)
radius, gap, speed = 0.03, 0.002, 2.0


def cradle(count):
    """A row of discs, the first of which comes from the left."""
    discs = [
        ff.Disc(
            name=f"disc{k + 1}",
            radius=radius,
            material=rubber,
            position=(k * (2 * radius + gap), 0.0),
            velocity=(speed if k == 0 else 0.0, 0.0),
        )
        for k in range(count)
    ]
    time = (count - 1) * (gap / speed + 6e-3)
    return ff.Scene(title=f"{count} discs in a row", bodies=discs, end_time=time, accuracy=0.02)


pair = ff.run(cradle(2))
result = ff.run(cradle(5), estimate=False)
result

# %%
# Velocities
# ----------
# Velocities of the five centres: the momentum is handed on.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
history = result.history
for k in range(1, 6):
    ax.plot(1e3 * history.t, history[f"vx_{k}"], label=f"disc {k}")
ax.set(xlabel="time [ms]", ylabel="velocity [m/s]")
ax.legend()
plt.show()

# %%
# The player
# ----------
# The states as an animation.
result.view()

# %%
# Stress
# ------
# The row at the largest force.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.shapes(ax=ax)
plt.show()

# %%
# Energies
# --------
# Energies: a part of the elastic energy stays in the discs as vibration.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.energies(ax=ax)
plt.show()

# %%
# Comparison
# ----------
# Two discs alone give the restitution e of one impact. If all four impacts had the same, the last
# disc would leave with :math:`v ((1 + e)/2)^4`. The discs of the row vibrate when they hit, so this
# is an estimate. Four times the error of one impact is taken as its error.
mass = result["mass_1"]
momentum = sum(history[f"momentum_x_{k}"].iloc[-1] for k in range(1, 6))
energy = sum(history[name].iloc[-1] for name in ("kinetic", "elastic", "contact"))
start = mass * speed**2 / 2
passed = pair["rebound_vx_2"] / speed
bar = 4 * pair.errors["rebound_vx_2"]
rows = [
    ("momentum of the row", "N s/m", momentum, 1e-9 * mass * speed, mass * speed, 0, "exact", ""),
    ("energy of the row", "J/m", energy, 1e-8 * start, start, 0, "exact", ""),
    ("speed of the second of two", "m/s", pair["rebound_vx_2"], pair.errors["rebound_vx_2"],
     speed - pair["rebound_vx_1"], 0, "exact: momentum", ""),
    ("speed of the last of five", "m/s", result["rebound_vx_5"], bar, speed * passed**4, bar,
     "four equal impacts", ""),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * No gap, so that the impacts overlap.
# * Two discs that come from the left. How many leave on the right?
