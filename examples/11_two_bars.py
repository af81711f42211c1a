"""
Two equal bars collide
======================

A moving bar hits an equal one at rest. The first one stops, and all of its energy goes to the
second one.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# It is the benchmark of Runcie, Lee, Haider, Gil and Bonet (IJNME 123, 5700, 2022): E = 100, ρ =
# 0.01 and ν = 0, bars of length 10, a gap of 0.01 and a speed of 0.1. Waves have the speed c =
# 100. The benchmark has no units. The second bar has shorter elements than the first one, so that
# the nodes of the bars do not coincide.
length, young, density, gap, speed = 10.0, 100.0, 0.01, 0.01, 0.1
wave = np.sqrt(young / density)
bar = ff.NeoHookean(young=young, nu=0, density=density)


def collision(elements):
    """Runs the bars with a number of elements along the first one. Returns the run and the pressure
    of each step."""
    size, bodies = length / elements, []
    for name, share, x, v in (("left", 1, -length / 2 - gap, speed), ("right", 0.9, length / 2, 0)):
        bodies.append(ff.Rectangle(name=name, width=length, height=3 * size, material=bar,
                                   mesh_size=share * size, contact_mesh_size=share * size,
                                   position=(x, 0), velocity=(v, 0)))
    scene = ff.Scene(bodies=bodies, contact=ff.Contact(penalty=1000 * young / length), fields=0,
                     chatter="continue", end_time=0.4, dt=size / wave / 2, title="two bars")
    result = ff.run(scene, accuracy=0.05, estimate=False)
    return result, result.history.normal_force / (3 * size)


(coarse, rough), (fine, force) = collision(25), collision(50)

# %%
# Pressure between the bars
# -------------------------
# The bars touch at 0.1. The fronts start at the interface, return from the free ends after 2 L/c,
# and part the bars at 0.3. Between these instants the pressure is ρ c v/2.
begin, end, plateau = gap / speed, gap / speed + 2 * length / wave, density * wave * speed / 2
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(fine.history.t, force, label="50 elements")
ax.plot([0, begin, begin, end, end, 0.4], np.repeat([0, plateau, 0], 2), "k--", label="exact")
ax.set(xlabel="time", ylabel="contact pressure")
ax.legend()
plt.show()

# %%
# Energies
# --------
history = fine.history
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for k, label in ((1, "left bar"), (2, "right bar")):
    ax.plot(history.t, history[f"kinetic_{k}"] + history[f"elastic_{k}"], label=label)
ax.plot(history.t, history.kinetic + history.elastic + history.contact, "k--", label="total")
ax.set(xlabel="time", ylabel="energy per thickness")
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# The bars are in contact while the pressure is above half of ρ c v/2. A scheme of second order
# smears a front over the element size to the power 2/3. The error is therefore the difference of
# the two meshes over 2^(2/3) − 1. It is an estimate from two runs, and can be too small by chance.


def measured(result, p):
    """Instants of contact, mean pressure, final velocities, and the share of the energy in each
    bar."""
    h = result.history
    t, last = h.t - h.dt / 2, h.iloc[-1]
    loaded, middle = t[p > plateau / 2], (t > 0.12) & (t < 0.28)
    energies = [last[f"kinetic_{k}"] + last[f"elastic_{k}"] for k in (1, 2)]
    mean, shares = np.average(p[middle], weights=h.dt[middle]), energies / h.kinetic[0]
    return np.array([loaded.min(), loaded.max(), mean, last.vx_1, last.vx_2, *shares])


names = ["contact begins", "contact ends", "pressure in the middle of the contact",
         "velocity of the left bar after", "velocity of the right bar after",
         "energy in the left bar after", "energy in the right bar after"]
numbers = pd.DataFrame({"quantity": names, "unit": "1", "computed": measured(fine, force)})
numbers["error"] = (numbers.computed - measured(coarse, rough)).abs() / (2 ** (2 / 3) - 1)
numbers["reference"] = [begin, end, plateau, 0, speed, 0, 1]
numbers["uncertainty"], numbers["source"] = 0.0, "exact: Runcie and others 2022"
waves = "short waves behind the fronts stay in the bars; two meshes give a rough error"
sizes = ["0.0008", "0.8 %", "0.0075", "0.8 %"]
numbers["note"] = 3 * [""] + [f"misses by {size}: {waves}" for size in sizes]
numbers

# %%
# What to try next
# ----------------
# * A second bar of twice the length: it takes the momentum, but the bars stay in contact longer.
# * A second bar with another density: part of the wave is reflected at the interface.
# * A faster bar, ``speed = 10``: the strains are no longer small.
