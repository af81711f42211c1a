"""
A rubber ball hits a rigid plane
================================

A ball of the same rubber and speed as the disc, computed as a body of revolution in a second. Its
contact lasts longer than that of the disc, as the paper says.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The scene
# ---------
# The paper computes the ball with the law of St. Venant-Kirchhoff. In this impact the law loses
# ellipticity, so that its answer depends on the mesh. The main run here has the neo-Hookean law,
# whose answer converges. Two more runs stand beside it: the ball as the paper may have run it, on
# one coarse mesh, and the neo-Hookean disc.
ball = ff.run("ball-axisymmetric")
coarse = ff.run("ball-axisymmetric-svk")
disc = ff.run("disc-normal-neohookean")
ball

# %%
# What the program says of the run with the other law
# ---------------------------------------------------
coarse.warnings

# %%
# Shape
# -----
# The meridian half of the ball at the largest force. The colour is the von Mises stress.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ball.plot.shapes(ax=ax)
plt.show()

# %%
# Accelerations
# -------------
# The mean acceleration of each body, as in figure 11 of the paper: force over mass.
masses = {"disc": 1722 * np.pi * 0.05**2, "ball": 1722 * 4 / 3 * np.pi * 0.05**3}
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for label, body, result in (("disc, neo-Hookean", "disc", disc),
                            ("ball, neo-Hookean", "ball", ball),
                            ("ball, SVK on a coarse mesh", "ball", coarse)):
    time = 1e3 * (result.history.t - result["contact_start"])
    ax.plot(time, result.history.normal_force / masses[body], label=label)
ax.set(xlabel="time since first contact [ms]", ylabel="acceleration [m/s²]")
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# NGSolve has solved the same equations with meshes of its own. The paper prints a time of contact
# of 0.00603 s, known to half a unit of its last digit.
peer, errors = "NGSolve, converged", ball.errors
numbers = pd.DataFrame(
    [
        ("contact time, neo-Hookean", "s", ball["contact_time"], errors["contact_time"], 5.007e-3,
         1.1e-5, peer, ""),
        ("impulse, neo-Hookean", "N s", ball["impulse"], errors["impulse"], 14.2505, 0.0010, peer,
         ""),
        ("rebound, neo-Hookean", "m/s", ball["rebound_vy"], errors["rebound_vy"], 7.8051, 0.0011,
         peer, ""),
        ("energy after, neo-Hookean", "J", ball["energy_final"], errors["energy_final"],
         masses["ball"] * 8**2 / 2, 0.0, "exact: m v²/2", ""),
        ("contact time, SVK, coarse mesh", "s", coarse["contact_time"],
         coarse.errors["contact_time"], 6.03e-3, 5e-6, "paper, section 3.3",
         "misses by 6.4 %: the law loses ellipticity, so each mesh has its own answer"),
        ("contact time of ball over disc", "1", ball["contact_time"] / disc["contact_time"],
         np.nan, np.nan, np.nan, "paper, figure 11", "the paper says: always larger than 1"),
    ],
    columns="quantity unit computed error reference uncertainty source note".split(),
)
numbers

# %%
# What to try next
# ----------------
# * ``ff.run("ball")``: the same ball in three dimensions.
# * A hollow ball: ``ff.Shell(radius=0.05, inner_radius=0.04, ...)``.
# * A slower ball, ``speed=0.1``, which comes close to the theory of Hertz.
