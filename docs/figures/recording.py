"""The recording of the tutorial: a ball of known material that falls from 80 cm, its bounces by runs,
as a telephone might hear it; and the fit to it.
"""

import math

import matplotlib.pyplot as plt
import numpy as np
from scipy.io import wavfile
from style import FOLDER, save

import ffimpact as ff
from ffimpact import flight

MASS, RADIUS = 0.046, 0.0215
density = MASS / (4 / 3 * math.pi * RADIUS**3)
rubber = ff.NeoHookean(young=2e7, nu=0.48, density=density, loss=0.13, loss_model="flat")
ball = ff.Ball(radius=RADIUS, material=rubber, position=1.005 * RADIUS, velocity=-3)
scene = ff.Scene(title="dropped ball", dimension="axisymmetric", bodies=[ball], obstacles=[ff.Plane()], accuracy=0.02)
speeds = np.array([0.8, 1.5, 2.5, 4.0])
strikes = [ff.run(scene, {"body.1.velocity": -v}, accuracy=0.005, estimate=False, figures=False, out=FOLDER / f".runs/tutorial-{v}") for v in speeds]
drag, chance = flight.drag_of(MASS, RADIUS), np.random.default_rng(8)
time, speed, onsets = 0.6, flight.speed_of_fall(0.8, flight.GRAVITY, drag), []
for _ in range(10):
    onsets.append(time)
    ratio, contact = (np.interp(speed, speeds, [run[name] for run in strikes]) for name in ("restitution", "contact_time"))
    leaves = speed * ratio * (1 + 0.002 * chance.standard_normal())
    time += contact + flight.duration(leaves, flight.GRAVITY, drag)
    speed = flight.landing(leaves, flight.GRAVITY, drag)
rate = 16000
t = np.arange(0, onsets[-1] + 0.3, 1 / rate)
samples = 0.008 * chance.standard_normal(len(t))
for k, onset in enumerate(onsets):
    behind = np.maximum(t - onset, 0)
    samples += (t >= onset) * 0.8 * 0.85**k * np.exp(-behind / 0.004) * np.sin(12000 * behind)
sound = FOLDER.parent / "tutorial/drop.wav"
wavfile.write(sound, rate, np.round(127 * np.clip(samples, -1, 1) + 128).astype(np.uint8))

drop = ff.bounces(sound, mass=MASS, radius=RADIUS)
print(drop.table, drop.restitution)
drops = ff.Experiment.of_bounces(drop)
free = {"body.1.young": (5e6, 1e8), "body.1.loss": (0.02, 0.5)}
fit = ff.fit(scene, free, drops, priors={"body.1.young": ff.shore(85)}, out=FOLDER / ".runs/tutorial-fit")
print(fit, fit.predict(height=1.5, names=["rebound_height", "contact_time", "peak_force"]), sep="\n")
figure, axes = plt.subplots(2, figsize=(6.25, 4.6), layout="constrained")
drop.plot(axes[0])
axes[0].set(xlim=(0, onsets[-1] + 0.3))
own = fit.measurements
axes[1].errorbar([e.speed for e in drops], own.measured, own.error, fmt="o", label="heard")
axes[1].plot([e.speed for e in drops], own.predicted, label="fitted ball")
axes[1].set(xlabel="speed before the bounce in m/s", ylabel="restitution")
axes[1].legend()
save(figure, "recording")
