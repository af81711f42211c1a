"""
The yield stress of aluminium from a bounce
===========================================

A steel ball bounces on a block of aluminium: the dent and the restitution determine the yield stress.
Both were made by a finer run of a known block, with errors, so that the interval can be checked.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# A rigid ball in place of the steel one: its modulus adds to the compliance, but hardly to the dent.
radius, depth = 5e-3, 6e-3


def scene(yield_stress):
    alloy = ff.Metal(young=70e9, nu=0.33, density=2700, yield_stress=yield_stress, hardening=5e8)
    block = ff.Cylinder(name="block", radius=8e-3, height=depth, position=-depth / 2, material=alloy,
                        support=[ff.Support(where="bottom")])  # fmt: skip
    steel = ff.Ball(name="ball", radius=radius, rigid=True, density=7850, velocity=-2.0,
                    position=1.0002 * radius)  # fmt: skip
    return ff.Scene(title="steel on aluminium", dimension="axisymmetric", bodies=[steel, block],
                    accuracy=0.1)  # fmt: skip


# %%
# The measurement
# ---------------
# 300 MPa; the restitution is measured to 0.01, the depth of the dent to 3 %.
truth = 3e8
made = ff.run(scene(truth), accuracy=0.03, estimate=False, figures=False)
dent, chance = made.fields.dent(2), np.random.default_rng(43)
restitution = made["restitution"] + 0.01 * chance.standard_normal()
depth_error = 0.03 * dent.depth
depth_measured = dent.depth + depth_error * chance.standard_normal()

# %%
# The fit
# -------
bounce = ff.Experiment(
    restitution=(restitution, 0.01), dent_depth_2=(depth_measured, depth_error)
)
free = {"body.2.yield_stress": (1e8, 1e9), "body.2.hardening": (5e7, 5e9)}
fit = ff.fit(scene(2e8), free, bounce)
fit

# %%
# Two values determine the yield stress if the hardening is known, as here, and hardly both.
known = ff.fit(scene(2e8), {"body.2.yield_stress": (1e8, 1e9)}, bounce)
known

# %%
fig = known.plot()
plt.show()

# %%
# Comparison
# ----------
own = known.table.iloc[0]
rows = [
    ("yield stress", "Pa", own.value, (own.high - own.low) / 2, truth, 0, "the known block", ""),
    ("entries of two that have a value, both free", "1", float((fit.table.known == "yes").sum()),
     np.nan, np.nan, np.nan, "", ""),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * A second speed: does ``fit.next`` say that it determines the hardening?
# * An elastic steel ball: ``ff.Ball(material=ff.NeoHookean(young=210e9, ...))``.
