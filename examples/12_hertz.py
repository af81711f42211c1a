"""
An aluminium sphere hits a rigid plane: Hertz
=============================================

An aluminium sphere of 0.1 m touches a rigid plane at 0.2 m/s, the second test of Chung and Ooi for
codes of discrete elements. Finite elements know nothing of Hertz, and yet give his force, depth
and time of contact.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# The sphere is a body of revolution. Its contact is 4.5 mm wide, 2 % of its diameter, so that
# elements near the contact are much smaller than elsewhere.
radius, speed, young, nu, density = 0.1, 0.2, 70e9, 0.3, 2699.0
aluminium = ff.NeoHookean(young=young, nu=nu, density=density)
sphere = ff.Ball(radius=radius, material=aluminium, position=(0, radius), velocity=(0, -speed))
scene = ff.Scene(bodies=[sphere], obstacles=[ff.Plane()], title="aluminium sphere")
result = ff.run(scene, accuracy=0.005)
result

# %%
# Hertz' theory
# -------------
# The force is F = 4/3 E* √R δ^(3/2), with E* = E/(1 − ν²). The equation of motion is integrated
# once for the largest depth and numerically for the history. Hertz takes the sphere for a
# half-space. For a ball of this program that is off by about a third of a/R, the radius of the
# contact over that of the ball: contacts at a/R = 0.18 are 4.6 to 6 % shorter than his. We take
# this as the uncertainty.
mass, stiff = 4 / 3 * np.pi * radius**3 * density, young / (1 - nu**2)
deepest = (15 * mass * speed**2 / (16 * stiff * np.sqrt(radius))) ** 0.4
peak = 4 / 3 * stiff * np.sqrt(radius) * deepest**1.5
lasts = 2.868 * (mass**2 / (radius * stiff**2 * speed)) ** 0.2
finite = np.sqrt(deepest / radius) / 3

share = np.sin(np.linspace(0, np.pi / 2, 400))  # share of the largest depth, with fine steps near 1
rate = speed * np.sqrt(np.maximum(1 - share**2.5, 0))
half = np.append(0, np.cumsum(np.diff(share) * deepest * 2 / (rate[1:] + rate[:-1])))
time, depth = np.append(half, 2 * half[-1] - half[::-1]), deepest * np.append(share, share[::-1])

# %%
# Force
# -----
history, start = result.history, result["contact_start"]
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(1e6 * (history.t - history.dt / 2 - start), 1e-3 * history.normal_force, label="computed")
ax.plot(1e6 * time, 1e-3 * peak * (depth / deepest) ** 1.5, "k--", label="Hertz")
ax.set(xlabel="time since first contact [µs]", ylabel="force [kN]", xlim=(-20, 800))
ax.legend()
plt.show()

# %%
# Stress
# ------
# The stress is largest below the surface, half a contact radius deep.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
result.plot.shapes(ax=ax)
ax.set(xlim=(-0.006, 0.006), ylim=(-0.001, 0.007))
plt.show()

# %%
# Comparison
# ----------
# The depth is how far the centre of mass comes down; its relative error is taken as that of the
# peak force.
down, errors = history.y[0] - history.y.min(), result.errors
of_depth = down * errors["peak_force"] / result["peak_force"]
test = "Chung and Ooi 2011, test 2 (Hertz)"
rows = [
    ("peak force", "N", result["peak_force"], errors["peak_force"], 11370.0, 5 + finite * peak),
    ("depth", "m", down, of_depth, 49.72e-6, 5e-9 + finite * deepest),
    ("contact time", "s", result["contact_time"], errors["contact_time"], 731.6e-6,
     5e-8 + finite * lasts),
]
numbers = pd.DataFrame([(*row, test, "") for row in rows] + [
    ("restitution", "1", result["restitution"], errors["restitution"], 1.0, 0.0,
     "Hertz: no loss", "")],
    columns="quantity unit computed error reference uncertainty source note".split())
numbers

# %%
# What to try next
# ----------------
# * A slower sphere, ``velocity=(0, -0.002)``: the theory becomes better as the contact shrinks.
# * A sphere of glass, or of rubber at 8 m/s, where Hertz fails.
# * Two spheres: ``ff.run("two-balls")``.
