"""Results of a sweep: thresholded contact time over speed for two Poisson's ratios, with error
bars."""

from style import BLUE, FOLDER, ORANGE, graph, save

import ffimpact as ff

study = ff.sweep("disc-normal", {"speed": [2, 4, 6, 8], "nu": [0.3, 0.45]}, law="neohookean", accuracy=0.01, out=FOLDER / ".runs/sweep")
figure, ax = graph(2.9)
ax.set_prop_cycle(color=[BLUE, ORANGE])
study.plot("speed", "thresholded_contact_time", by="nu", ax=ax)
ax.set(xlabel="speed [m/s]", ylabel="thresholded_contact_time\n[s]")
save(figure, "sweep")
print(study.table[["speed", "nu", "thresholded_contact_time", "rebound_vy"]])
