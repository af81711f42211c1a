"""
A ball hits the plane obliquely: Maw, Barber and Fawcett
========================================================

A ball of rubber hits a plane with friction at three angles, in three dimensions. If the ball
sticks, the contact springs back and the slip after the impact is opposite to the slip before,
which no law for rigid bodies gives.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# The speed along the normal is 0.2 m/s, the coefficient of friction 0.1. The speed v_s along the
# plane follows from the dimensionless angle ψ = 2 (1 − ν) v_s / (μ (2 − ν) v_n). With ν = 0.45 a
# rigid plane acts nearly as one of the same rubber, for which the theory is made.
nu, friction, young, density, radius, normal = 0.45, 0.1, 7e6, 1722.0, 0.05, 0.2
rubber = ff.NeoHookean(young=young, nu=nu, density=density)
ratio = 2 * (1 - nu) / (2 - nu)


def impact(psi):
    """The initial slip velocity, and the run."""
    slip = psi * friction * normal / ratio
    ball = ff.Ball(radius=radius, material=rubber, position=(0, radius, 0),
                   velocity=(slip, -normal, 0))
    contact = ff.Contact(friction_static=friction, slip_velocity=1e-3 * normal)
    scene = ff.Scene(bodies=[ball], obstacles=[ff.Plane()], contact=contact, fields=0,
                     title="oblique ball")
    return slip, ff.run(scene, accuracy=0.1)


runs = {psi: impact(psi) for psi in (1.2, 2.5, 5.0)}

# %%
# Theory
# ------
# The theory joins Hertz' normal contact with Cattaneo and Mindlin's partial slip. It is the same
# as a row of independent springs under a parabola, each with Coulomb's law (Popov and Hess 2015).
# Lengths and speeds are those of a ball with R = E* = m = 1.


def theory(psi):
    """The slip velocity after over before the impact, with the opposite sign: β."""
    start = psi * friction * 1e-3 / ratio
    slip, speed, depth, deepest = start, 1e-3, 0.0, (15 / 16 * 1e-6) ** 0.4
    x = 1.05 * np.sqrt(deepest) * (np.arange(300) + 0.5) / 300
    width, stretch, dt = 2 * (x[1] - x[0]), np.zeros_like(x), 1.2 * 2.87 * 1e-3**-0.2 / 3000
    while depth >= 0:
        depth += dt * speed
        pressed = np.maximum(depth - x**2, 0)
        limit = friction * pressed / ratio
        stretch = np.clip(stretch + dt * slip, -limit, limit)
        speed -= dt * width * pressed.sum()
        slip -= dt * width * ratio * stretch.sum() * 3.5  # 1 + m R²/I of a ball
    return -slip / start


# %%
# Restitution along the plane
# ---------------------------
# β is 1 if the slip is fully reversed, 0 if the ball rolls after the impact, and −1 without
# friction. A rigid ball has β = 0, or slides throughout. An elastic one slides throughout beyond ψ
# = 14 (1 − ν)/(2 − ν) − 1.
beta = {psi: -(run["rebound_vx"] + radius * run["rebound_spin"]) / slip
        for psi, (slip, run) in runs.items()}
bars = {psi: (run.errors["rebound_vx"] + radius * run.errors["rebound_spin"]) / slip
        for psi, (slip, run) in runs.items()}
angles = np.linspace(0.2, 6, 30)
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(angles, [theory(psi) for psi in angles], "k", label="Maw, Barber and Fawcett")
ax.plot(angles, np.minimum(0, 7 * ratio / angles - 1), "C1--", label="rigid ball")
ax.errorbar(beta.keys(), beta.values(), bars.values(), fmt="o", capsize=3, label="computed")
ax.axhline(0, color="black", linewidth=0.6)
ax.set(xlabel="angle ψ", ylabel="restitution along the plane β")
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# A ball is no half-space. Where it sticks, we take a/R, the radius of the contact over that of the
# ball, of the slip that is lost as the uncertainty of the theory. Where it slides throughout, the
# impulse of friction is μ times the normal one, and the theory is exact but for the restitution.
mass, stiff = 4 / 3 * np.pi * radius**3 * density, young / (1 - nu**2)
finite = np.sqrt((15 * mass * normal**2 / (16 * stiff * np.sqrt(radius))) ** 0.4 / radius)
rows = []
for psi, (_, run) in runs.items():
    slides = psi > 7 * ratio - 1
    exact = (1 + run["restitution"]) * 3.5 * ratio / psi - 1 if slides else theory(psi)
    rows.append((f"restitution along the plane, ψ = {psi:g}", "1", beta[psi], bars[psi], exact,
                 0.0 if slides else finite * (1 + exact),
                 "exact: slides throughout" if slides else "Maw, Barber and Fawcett 1976", ""))
numbers = pd.DataFrame(
    rows, columns="quantity unit computed error reference uncertainty source note".split()
)
numbers

# %%
# What to try next
# ----------------
# * A slower ball, ``normal = 0.02``: the contact is smaller, and the theory better.
# * A spin before the impact, ``spin=(0, 0, 2)``: only the slip of the contact matters.
# * A golf ball on granite: a friction of 0.18, and angles about 40 degrees.
