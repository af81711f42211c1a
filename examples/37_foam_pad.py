"""
A weight on a pad of two foams
==============================

A flat weight falls on a pad that is glued to the ground: a soft foam on a firm one. Waves run
through both foams and are partly reflected where they meet. As foam does not bulge (:math:`\\nu =
0`), the exact motion is that of plane waves, which a few lines add up.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The pad
# -------
# Foams of 2 cm each. The firm one has four times the modulus of the soft one, and so twice its wave
# speed. The weight has 12 times the mass of the pad and falls slowly, so that strains are small.
width, height = 0.1, 0.02
young, density = {"soft": 1e6, "firm": 4e6}, 100.0
mass, speed = 5.0, 0.04  # [kg/m], [m/s]


def pad(top, bottom, loss=None):
    """The result of the fall on a pad of two foams."""
    body = ff.Rectangle(
        name="pad", width=width, height=2 * height, position=(0, height), law="neohookean",
        young=young[bottom], nu=0.0, density=density, loss=loss,
        layers=[ff.Layer(name="top", young=young[top],
                         where={"kind": "half-plane", "point": (0, 0), "normal": (0, 1)})],
        support=[ff.Support(where="bottom")],
    )  # fmt: skip
    weight = ff.Rectangle(name="weight", width=width, height=0.05, rigid=True, mass=mass,
                          position=(0, 2 * height + 0.025), velocity=(0, -speed))  # fmt: skip
    return ff.run(ff.Scene(title="weight on a pad", bodies=[weight, body], accuracy=0.02))


result = pad("soft", "firm")
result


# %%
# Plane waves
# -----------
# In a foam of impedance :math:`Z = \\sqrt{E \\rho}` the velocity is the sum of a wave downwards and
# one upwards, and the pressure Z times their difference. In a time step both move on by a cell.
def exact(top, bottom, cells=400):
    """Times [s], pressures under the weight [Pa] until it leaves, its velocities [m/s], and the
    elastic energies (n, 2) [J/m] of both foams.
    """
    speeds = [np.sqrt(young[name] / density) for name in (top, bottom)]
    z1, z2 = (density * c for c in speeds)
    dt = height / max(speeds) / cells
    down, up = ([np.zeros(round(height / c / dt)) for c in speeds] for _ in range(2))
    times, pressures, velocities, energies = [0.0], [z1 * speed], [speed], [[0.0, 0.0]]
    while pressures[-1] > 0:
        first, second = down[0][-1], up[1][0]  # they come to the interface
        up1 = ((z1 - z2) * first + 2 * z2 * second) / (z1 + z2)
        down2 = (2 * z1 * first + (z2 - z1) * second) / (z1 + z2)
        arrived = up[0][0]
        fall = velocities[-1] - 2 * arrived  # of the weight: m v' = -w Z1 (v - 2 up)
        velocities.append(2 * arrived + fall * np.exp(-width * z1 * dt / mass))
        down[0] = np.append(velocities[-1] - arrived, down[0][:-1])
        up[0] = np.append(up[0][1:], up1)
        up[1] = np.append(up[1][1:], -down[1][-1])  # from the ground, which holds the pad
        down[1] = np.append(down2, down[1][:-1])
        times.append(times[-1] + dt)
        pressures.append(z1 * (velocities[-1] - 2 * up[0][0]))
        energies.append([width * height * density / 2 * np.mean((d - u) ** 2)
                         for d, u in zip(down, up)])  # fmt: skip
    return np.array(times), np.array(pressures), np.array(velocities), np.array(energies)


t, pressure, velocity, energies = exact("soft", "firm")
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(1e3 * result.history.t, result.history.normal_force, label="computed")
ax.plot(1e3 * t, width * pressure, "--", label="exact")
ax.set(xlabel="time [ms]", ylabel="force [N/m]", xlim=(0, 4.5))
ax.legend()
plt.show()

# %%
# Where the energy is
# -------------------
# A slow load would put four fifths of the energy into the soft foam, the share of its compliance.
# The waves change this share.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.plot(1e3 * result.history.t, result.history.elastic, label="elastic energy")
ax.plot(1e3 * result.history.t, result.history.layer_elastic_1, label="of the soft foam")
ax.plot(1e3 * t, np.cumsum(energies, axis=1), "k--", linewidth=0.8, label=["exact", ""])
ax.set(xlabel="time [ms]", ylabel="energy [J/m]", xlim=(0, 4.5))
ax.legend()
plt.show()

# %%
# The other way round, and a loss
# -------------------------------
# With the firm foam above, the force begins twice as high. With a loss factor of 0.3 the waves die
# out, the weight leaves earlier, and a quarter of its velocity is lost.
turned = pad("firm", "soft")
damped = pad("soft", "firm", loss=0.3)
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for name, run in (("soft on firm", result), ("firm on soft", turned), ("with loss", damped)):
    ax.plot(1e3 * run.history.t, run.history.normal_force, label=name)
ax.set(xlabel="time [ms]", ylabel="force [N/m]", xlim=(0, 4.5))
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# Strains of 0.1 % make the law nonlinear by as much; no other difference is expected. The share of
# the upper foam is that of the mean energy during contact; its error is the accuracy asked for.
strain = 1e-3
rows = []
for name, run in (("soft on firm", result), ("firm on soft", turned)):
    t, pressure, velocity, energies = exact(*name.split(" on "))
    impulse = mass * (speed - velocity[-1])
    for quantity, unit, key, value in (
        ("impulse", "N s/m", "impulse", impulse),
        ("contact time", "s", "contact_time", t[-1]),
        ("velocity of the weight", "m/s", "rebound_vy_1", -velocity[-1]),
    ):
        rows.append((f"{quantity}, {name}", unit, run[key], run.errors[key], value,
                     strain * abs(value), "exact: plane waves", ""))  # fmt: skip
    inside = run.history[run.history.t < t[-1]]
    means = [np.trapezoid(inside[key], inside.t) for key in ("layer_elastic_1", "elastic")]
    share = means[0] / means[1]
    rows.append((f"share of the upper foam in the energy, {name}", "1", share, 0.02 * share,
                 energies[:, 0].mean() / energies.sum(axis=1).mean(), strain,
                 "exact: plane waves", ""))  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A third foam, or a weight that is not heavy: then the waves show in the force.
# * A round weight: ``ff.Disc(radius=0.05, rigid=True, mass=5, ...)``.
