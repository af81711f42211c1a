"""
A ball falls into a bowl
========================

A ball hits the bottom of bowls that fit it more and more closely. A close fit makes the contact
stiffer and shorter, as Hertz' theory says with the difference of the curvatures.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# The ball has a radius of 10 mm, E = 100 MPa, ν = 0.3 and 2500 kg/m³, and comes down at 50 mm/s.
# The bowls are rigid, with radii of 1.2 to 4 times that of the ball. The last obstacle is a plane.
radius, young, nu, density, speed = 0.01, 1e8, 0.3, 2500.0, 0.05
material = ff.NeoHookean(young=young, nu=nu, density=density)
ball = ff.Ball(radius=radius, material=material, position=(0, radius), velocity=(0, -speed))


def fall(fit):
    """A run with a bowl of `fit` times the radius of the ball."""
    obstacle = ff.Plane()
    if np.isfinite(fit):
        obstacle = ff.Bowl(centre=(0, fit * radius), radius=fit * radius)
    scene = ff.Scene(bodies=[ball], obstacles=[obstacle], title="ball in bowl")
    return ff.run(scene, accuracy=0.01)


runs = {fit: fall(fit) for fit in (1.2, 1.5, 2.0, 4.0, np.inf)}
runs[1.2]

# %%
# Shape
# -----
# The ball in the closest bowl at the largest force.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
runs[1.2].plot.shapes(ax=ax)
plt.show()

# %%
# Theory
# ------
# Hertz' formulas hold with 1/R = 1/R₁ − 1/R₂, R₁ the radius of the ball and R₂ that of the bowl.
# They take both for parabolas and the ball for a half-space. A ball on a plane differs from that
# by about a third of a/R₁, a the radius of the contact, and we take this share as the uncertainty.
mass, stiff = 4 / 3 * np.pi * radius**3 * density, young / (1 - nu**2)


def hertz(fit):
    """Contact time, peak force, and contact radius over ball radius."""
    relative = radius / (1 - 1 / fit)
    depth = (15 * mass * speed**2 / (16 * stiff * np.sqrt(relative))) ** 0.4
    time = 2.868 * (mass**2 / (relative * stiff**2 * speed)) ** 0.2
    return time, 4 / 3 * stiff * np.sqrt(relative) * depth**1.5, np.sqrt(relative * depth) / radius


# %%
# Contact time over the fit
# -------------------------
fits = np.linspace(1.1, 5, 100)
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(fits, [1e3 * hertz(fit)[0] for fit in fits], "k", label="Hertz, bowl")
ax.axhline(1e3 * hertz(np.inf)[0], color="black", linestyle="--", label="Hertz, plane")
times = [1e3 * run["contact_time"] for run in runs.values()]
bars = [1e3 * run.errors["contact_time"] for run in runs.values()]
ax.errorbar(list(runs)[:-1], times[:-1], bars[:-1], fmt="o", capsize=3, label="computed, bowl")
ax.errorbar([5], times[-1:], bars[-1:], fmt="s", capsize=3, label="computed, plane")
ax.set(xlabel="radius of the bowl over that of the ball", ylabel="contact time [ms]")
ax.legend()
plt.show()

# %%
# Comparison
# ----------
rows = []
for fit, run in runs.items():
    where, (time, force, width) = f"R₂ = {fit:g} R₁" if np.isfinite(fit) else "plane", hertz(fit)
    for name, unit, key, exact in (("contact time", "s", "contact_time", time),
                                   ("peak force", "N", "peak_force", force)):
        rows.append((f"{name}, {where}", unit, run[key], run.errors[key], exact, width / 3 * exact,
                     "Hertz, difference of curvatures", ""))
numbers = pd.DataFrame(
    rows, columns="quantity unit computed error reference uncertainty source note".split()
)
numbers

# %%
# What to try next
# ----------------
# * A fit of 1.05: contact over a wide area, where the parabolas of Hertz end.
# * A faster ball, 5 m/s.
# * ``ff.run("disc-bowl")``: a disc rolls down the wall of a bowl.
