"""A fit of modulus and loss to a force and a restitution that a run has made, with noise."""

import matplotlib.pyplot as plt
import numpy as np
from style import FOLDER, save

import ffimpact as ff

rubber = ff.NeoHookean(young=4.3e7, nu=0.45, density=1070, loss=0.11, loss_model="flat")
ball = ff.Ball(radius=0.021, material=rubber, position=0.0211, velocity=-2.2)
scene = ff.Scene(dimension="axisymmetric", bodies=[ball], obstacles=[ff.Plane()], accuracy=0.01)
made = ff.run(scene, accuracy=0.0025, estimate=False, figures=False, out=FOLDER / ".runs/fit-truth")
error, chance = 0.01 * made["peak_force"], np.random.default_rng(4)
times = np.linspace(0, made.history.t.iloc[-1], 60)
force = np.interp(times, made.history.t - made.history.dt / 2, made.history.normal_force)
table = {"t": times, "normal_force": force + error * chance.standard_normal(60)}
impact = ff.Experiment(restitution=(made["restitution"], 0.003), normal_force={"table": table, "error": error})
fit = ff.fit(scene, {"body.1.young": (1e7, 1e9), "body.1.loss": (0.01, 0.5)}, impact, out=FOLDER / ".runs/fit")
print(fit)
save(fit.plot(), "fit")
plt.close("all")
