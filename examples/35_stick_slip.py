"""
Stick and slip of a block of rubber
===================================

A block is pressed on the floor and drawn along at its top. Static friction is larger than dynamic
friction, so the lower face sticks, lets go at once, slides forward and sticks again.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The block
# ---------
# The top goes down by 0.6 mm in 10 ms, and then along at 0.1 m/s. Friction is 0.8 at rest and 0.2
# in motion.
width, height, static, dynamic = 0.03, 0.015, 0.8, 0.2
rubber = ff.NeoHookean(young=1e6, nu=0.45, density=1100, viscosity=3)
drive = ff.Support(where="top", motion=["0.1*max(t - 0.01, 0)", "-0.0006*min(t/0.01, 1)"])
block = ff.Rectangle(
    name="block",
    width=width,
    height=height,
    material=rubber,
    position=(0, height / 2 + 1e-5),
    mesh_size=0.004,
    contact_mesh_size=0.002,
    support=[drive],
)
contact = ff.Contact(friction_static=static, friction_dynamic=dynamic, slip_velocity=0.004)
floor = ff.Plane(name="floor")
scene = ff.Scene(
    title="stick slip",
    bodies=[block],
    obstacles=[floor],
    contact=contact,
    end_time=0.08,
    accuracy=0.005,
)
result = ff.run(scene, estimate=False)
history = result.history

# %%
# Friction
# --------
# Friction over normal force, and the share of the load that slides. The first slip is the largest:
# the block springs forward so far that friction holds it back afterwards.
ratio = -history.friction_force / history.normal_force.where(history.normal_force > 10)
fig, axes = plt.subplots(2, 1, figsize=(6, 4), sharex=True, layout="constrained")
axes[0].plot(1e3 * history.t, ratio)
axes[0].axhline(static, color="grey", linewidth=0.8)
axes[0].axhline(dynamic, color="grey", linewidth=0.8, linestyle="--")
axes[0].set(ylabel="friction over\nnormal force [-]")
axes[1].plot(1e3 * history.t, history.sliding_fraction)
axes[1].set(xlabel="time [ms]", ylabel="share that\nslides [-]")
plt.show()

# %%
# Shapes
# ------
# The block just before its first slip and just after it.
slips = history.index[(history.sliding_fraction > 0.9999) & (history.t > 0.015)]
first = float(history.t[slips[0]])
fig, axes = plt.subplots(1, 2, figsize=(9, 3), layout="constrained")
for ax, time in zip(axes, (first - 0.002, first + 0.004)):
    result.plot.shapes(ax=ax, time=time)
plt.show()

# %%
# Comparison
# ----------
# All of the face never reaches 0.8 at once: one edge of the block has less pressure, lets go first
# and unloads onto the rest. While all of it slides, the ratio is the dynamic coefficient.
run = slips[: np.argmax(np.diff(slips, append=slips[-1] + 2) > 1) + 1]
sliding = ratio[run[1:-1]]
final = history.iloc[-1]
kept = final.kinetic + final.elastic + final.contact + final.friction_work + final.viscous_work
start = history.iloc[0]
kept -= start.kinetic + start.elastic + start.contact
by_floor = np.sum(history.normal_force * history.dt)
by_top = np.sum(history.support_force_y_1 * history.dt)
gained = final.momentum_y - start.momentum_y
rows = [
    ("friction over normal force in the first slip", "1", sliding.mean(), sliding.std() + 1e-6,
     dynamic, 0, "exact: Coulomb", ""),
    ("energy kept and taken", "J/m", kept, 1e-7 * kept, final.external_work, 0,
     "exact: work of the drive", ""),
    ("impulse of the floor", "N s/m", by_floor, 1e-6 * by_floor, gained - by_top, 0,
     "exact: change of momentum", ""),
    ("largest friction over normal force", "1", ratio.max(), np.nan, np.nan, np.nan, "",
     "no reference: below the static coefficient, as one edge slips first"),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A faster drive, 0.5 m/s: does the block still stick?
# * Equal coefficients, ``friction_dynamic=0.8``.
