"""
Three laws for Treloar's rubber
===============================

The tension of natural rubber that Treloar (1944) measured, up to eight times its length, fitted by
three laws through runs of a pulled cylinder. The data refuse the neo-Hookean law.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The measurement
# ---------------
# Stretch and force per undeformed area in kg/cm2 (Treloar 1944, Trans. Faraday Soc. 40, 59; the
# numbers as the documentation of FElupe lists them). No errors are published: 0.05 MPa is assumed.
stretch = np.array([1.02, 1.125, 1.24, 1.39, 1.585, 1.9, 2.18, 2.42, 3.02, 3.57, 4.03, 4.76,
                    5.36, 5.75, 6.15, 6.4, 6.6, 6.85, 7.05, 7.15, 7.25, 7.4, 7.5, 7.6])  # fmt: skip
stress = 98066.5 * np.array([0.26, 1.37, 2.3, 3.23, 4.16, 5.1, 6, 6.9, 8.8, 10.7, 12.5, 16.2,
                             19.9, 23.6, 27.4, 31, 34.8, 38.5, 42.1, 45.8, 49.6, 53.3, 57,
                             64.4])  # fmt: skip

# %%
# The runs
# --------
# A light cylinder is pulled from rest in 0.1 s, many times longer than a wave needs along it. A
# measured stretch is a time of the run.
length, radius, duration, farthest = 0.02, 0.01, 0.1, 6.65
area = np.pi * radius**2
times = duration * np.sqrt((stretch - 1) / farthest)
pull = ff.Experiment(
    support_force_y_2={
        "table": {"t": times, "support_force_y_2": area * stress},
        "error": 0.05e6 * area,
    }
)


def pulled(material):
    motion = [0, f"{farthest * length}*(t/{duration})^2"]
    supports = [
        ff.Support(where="bottom", fix="y"),
        ff.Support(where="top", fix="y", motion=motion),
    ]
    rod = ff.Cylinder(radius=radius, height=length, position=0, material=material,
                      support=supports, mesh_size=radius)  # fmt: skip
    return ff.Scene(title=f"pulled {material.law}", dimension="axisymmetric", bodies=[rod],
                    end_time=duration, dt=duration / 200)  # fmt: skip


light = 10
laws = {
    "neo-Hookean": (ff.Incompressible(young=1e6, density=light), {"body.1.young": (3e5, 3e6)}),
    "Gent": (ff.Gent(mu=3e5, jm=90, density=light),
             {"body.1.parameters.mu": (1e5, 1e6), "body.1.parameters.jm": (65, 200)}),
    "Yeoh": (ff.Yeoh(c10=1.7e5, c20=-1e3, c30=40, density=light),
             {"body.1.parameters.c10": (1e5, 3e5), "body.1.parameters.c20": (-3e3, 0),
              "body.1.parameters.c30": (10, 100)}),
}  # fmt: skip
fits = {name: ff.fit(pulled(law), free, pull) for name, (law, free) in laws.items()}
neo, gent, yeoh = fits.values()
for name, fit in fits.items():
    print(name, fit, sep="\n")

# %%
# Which law?
# ----------
# Akaike's and Schwarz's criteria, less the smaller of each.
neo.compare(gent, yeoh)

# %%
fig, ax = plt.subplots(layout="constrained")
ax.plot(stretch, 1e-6 * stress, "ko", label="Treloar 1944")
for name, fit in fits.items():
    (curve,) = fit.curves.values()
    ax.plot(stretch, 1e-6 * curve.predicted / area, label=name)
ax.set(xlabel="stretch", ylabel="force per undeformed area in MPa")
ax.legend()
plt.show()

# %%
fig = yeoh.plot()
plt.show()

# %%
# Comparison
# ----------
# The runs against the formula of a bar without change of volume, force per area 2 (dW/dI1)
# (stretch - 1/stretch^2).
c10, c20, c30 = (yeoh.best[f"body.1.parameters.{name}"] for name in ("c10", "c20", "c30"))
excess = stretch**2 + 2 / stretch - 3
exact = 2 * (c10 + 2 * c20 * excess + 3 * c30 * excess**2) * (stretch - stretch**-2)
(curve,) = yeoh.curves.values()
off = np.abs(curve.predicted / area / exact - 1)[8:].max()
slope = 2 * (stretch - stretch**-2)
parts = np.column_stack([slope, 2 * excess * slope, 3 * excess**2 * slope])
linear = np.linalg.lstsq(parts, stress, rcond=None)[0]
table = yeoh.table
rows = [
    ("runs less the formula of a bar, Yeoh, largest share", "1", off, 0.005, 0, 0.005, "exact", ""),
    *((f"{name} of Yeoh's law", "Pa", yeoh.best[f"body.1.parameters.{name}"],
       (table.high - table.low).iloc[k] / 2, linear[k], 0.005 * abs(linear[k]), "linear least squares", "")
      for k, name in enumerate(("c10", "c20", "c30"))),
    *((f"chi2 of {name}", "1", fit.chi2, np.nan, np.nan, np.nan, "", "") for name, fit in fits.items()),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * ``ff.ArrudaBoyce``, ``ff.Ogden``, or an energy of your own: its parameters are free entries.
# * Tension alone does not tell a law: fit to shear or two tensions at once with a second experiment.
