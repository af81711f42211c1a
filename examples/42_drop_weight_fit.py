"""
A rubber pad under a drop weight
================================

The force of one impact over time determines modulus and loss of a pad. The force of this page was
made by a finer run of a known pad, with noise, so that the intervals can be checked.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# A rigid ball of 1 kg falls at 1 m/s on a pad of rubber, 10 mm thick, that is bonded to the floor.
pad_radius, height, weight = 0.03, 0.01, 0.025


def pad(young, loss):
    rubber = ff.NeoHookean(young=young, nu=0.48, density=1100, loss=loss, loss_model="flat")
    below = ff.Cylinder(name="pad", radius=pad_radius, height=height, position=height / 2,
                        material=rubber, support=[ff.Support(where="bottom")])  # fmt: skip
    ball = ff.Ball(name="weight", radius=weight, rigid=True, mass=1.0, velocity=-1.0,
                   position=height + 1.002 * weight)  # fmt: skip
    return ff.Scene(title="drop weight on a pad", dimension="axisymmetric", bodies=[ball, below],
                    accuracy=0.02)  # fmt: skip


# %%
# The measurement
# ---------------
# 3 MPa and a loss factor of 0.2; the force is recorded at 20 kHz with noise of 1 % of its peak.
young, loss = 3e6, 0.2
made = ff.run(pad(young, loss), accuracy=0.005, estimate=False, figures=False)
history = made.history
error, chance = 0.01 * made["peak_force"], np.random.default_rng(42)
times = np.arange(0, history.t.iloc[-1], 5e-5)
force = np.interp(times, history.t - history.dt / 2, history.normal_force)
recorded = pd.DataFrame(
    {"t": times, "normal_force": force + error * chance.standard_normal(len(times))}
)

# %%
# The fit
# -------
# It starts elsewhere, at 10 MPa.
impact = ff.Experiment(normal_force={"table": recorded, "error": error})
free = {"body.2.young": (1e6, 1e8), "body.2.loss": (0.02, 1)}
fit = ff.fit(pad(1e7, 0.1), free, impact)
fit

# %%
fig = fit.plot()
plt.show()

# %%
fig, ax = plt.subplots(layout="constrained")
(own,) = fit.curves.values()
ax.plot(1e3 * own.t, own.measured, "k.", label="measured")
ax.plot(1e3 * own.t, own.predicted, label="fitted pad")
ax.set(xlabel="time from the middle of the impact in ms", ylabel="force in N")
ax.legend()
plt.show()

# %%
# A faster fall
# -------------
# The fitted pad at twice the speed, with an interval, beside the known one.
faster = fit.predict(speed=2, names=["peak_force", "contact_time"])
true = ff.run(pad(young, loss), {"body.1.velocity": -2}, accuracy=0.005, estimate=False,
              figures=False)  # fmt: skip
faster

# %%
# Comparison
# ----------
table = fit.table
rows = [
    *((f"{name.split('.')[-1]} of the pad", unit, row["value"], (row["high"] - row["low"]) / 2, exact, 0,
       "the known pad", "")
      for (name, row), exact, unit in zip(table.iterrows(), (young, loss), ("Pa", "1"))),
    *((f"{name} at 2 m/s", unit, faster.loc[name, "value"], faster.loc[name, "high"] - faster.loc[name, "value"],
       true[name], 0, "the known pad", "")
      for name, unit in (("peak_force", "N"), ("contact_time", "s"))),
]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * ``{"file": "force.csv", "error": 2.0}`` in place of the table: a measurement of your own.
# * A time of sampling ten times as long: the intervals widen.
