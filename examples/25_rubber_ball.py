"""
A rubber ball dropped from three heights
========================================

A test case of LS-DYNA: a rubber ball of 60 mm is dropped on a steel plate. The rubber is one of
Mooney and Rivlin with a Maxwell branch that relaxes within the contact, so that the restitution
depends on the ratio of two times.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import ffimpact as ff

# %%
# The ball
# --------
# Sizes, moduli and relaxation are those of the verification manual (VM-LSDYNA-IMPACT-001), and
# the speeds are the measured ones. The plate is rigid here. Shear modulus
# :math:`2(C_{10} + C_{01})`, share of the second invariant 0.2.
shear, nu = 2 * (0.598e6 + 0.1495e6), 0.49
rubber = ff.MooneyRivlin(
    young=2 * shear * (1 + nu),
    nu=nu,
    density=1150,
    share=0.2,
    branches=[[10e6, 1 / 920]],  # modulus and relaxation time
)
heights, speeds = [0.2, 0.4, 0.8], [1.8254, 2.6935, 3.8859]
ball = ff.Ball(radius=0.03, material=rubber, position=(0, 0.0301), velocity=(0, -speeds[0]))
contact = ff.Contact(penalty=2e11)  # stiff relative to the unrelaxed branch
scene = ff.Scene(
    title="rubber ball", bodies=[ball], obstacles=[ff.Plane()], contact=contact, accuracy=0.01
)
study = ff.sweep(scene, {"body.1.velocity.2": [-speed for speed in speeds]})
study

# %%
# Force
# -----
# The force over time: the harder the impact, the shorter the contact.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
for height, run in zip(heights, study.results):
    history = run.history
    ax.plot(1e3 * history.t, history.normal_force, label=f"fall of {height} m")
ax.set(xlabel="time [ms]", ylabel="normal force [N]")
ax.legend()
plt.show()

# %%
# Shape
# -----
# The ball of the middle height at the largest force.
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
study.results[1].plot.shapes(ax=ax)
plt.show()

# %%
# Restitution
# -----------
# The restitution. The same rubber that never relaxes is nearly elastic: the branch takes the rest.
elastic = ff.run(scene, {"body.1.velocity.2": -speeds[1], "body.1.branches": [[10e6, 1.0]]})
restitutions = study.table.restitution
bars = [run.errors["restitution"] for run in study.results]
fig, ax = plt.subplots(figsize=(6, 4), layout="constrained")
ax.errorbar(speeds, restitutions, bars, marker="o", capsize=3, label="relaxes in 1.09 ms")
ax.errorbar(speeds[1], elastic["restitution"], elastic.errors["restitution"], fmt="s",
            label="relaxes in 1 s")  # fmt: skip
ax.set(xlabel="speed [m/s]", ylabel="restitution [-]", ylim=(0, 1.05))
ax.legend()
plt.show()

# %%
# Comparison
# ----------
# The measured restitutions (Wang et al. 2025, AIP Advances 15 025104) are not at hand, so the
# table leaves them open. What is exact: relaxation takes what the ball does not keep, and the
# impulse is the change of momentum.
rows = [
    (f"restitution, fall of {height} m", "1", value, bar, np.nan, np.nan,
     "Wang et al. 2025", "measured value not at hand")
    for height, value, bar in zip(heights, restitutions, bars)
]  # fmt: skip
for height, speed, run in zip(heights, speeds, study.results):
    # 'energy_final' is the energy at the last contact, after the loss by relaxation.
    taken = run["energy_initial"] - run["energy_final"]
    lost = run.history.viscous_work.iloc[-1]
    change, bar = run["mass"] * (speed + run["rebound_vy"]), run["mass"] * run.errors["rebound_vy"]
    rows += [
        (f"energy taken by relaxation, {height} m", "J", lost, 2 * run.errors["energy_final"],
         taken, 0, "exact: balance of energy", ""),
        (f"impulse, {height} m", "N s", run["impulse"], run.errors["impulse"] + bar, change, 0,
         "exact: change of momentum", ""),
    ]  # fmt: skip
columns = "quantity unit computed error reference uncertainty source note".split()
numbers = pd.DataFrame(rows, columns=columns)
numbers

# %%
# What to try next
# ----------------
# * Another relaxation time. Most is lost where it is near the contact time.
# * A harder fall, and the largest stretch, ``min_stretch``.
