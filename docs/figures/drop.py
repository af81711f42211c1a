"""A recording of a bouncing ball, synthesised: bursts with echoes in noise, one bounce unheard."""

import numpy as np
from scipy.io import wavfile
from style import FOLDER, graph, save

import ffimpact as ff

rate, times = 44100, 0.3 + np.cumsum([0, *(0.8 * 0.9 ** np.arange(8))])
t = np.arange(0, times[-1] + 0.3, 1 / rate)
samples = 0.002 * np.random.default_rng(1).standard_normal(len(t))
for k, onset in enumerate(times):
    for start, size in ((onset, 0.8), (onset + 0.015, 0.25)):
        behind = np.maximum(t - start, 0)
        samples += (k != 5) * (t >= start) * size * 0.85**k * np.exp(-behind / 0.004) * np.sin(18850 * behind)
(FOLDER / ".runs").mkdir(exist_ok=True)
wavfile.write(FOLDER / ".runs/drop.wav", rate, np.round(32767 * samples).astype(np.int16))
figure, ax = graph(2.6)
drop = ff.bounces(FOLDER / ".runs/drop.wav")
drop.plot(ax)
save(figure, "drop")
print(drop.table, drop.notes)
