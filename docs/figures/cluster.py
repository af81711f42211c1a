"""A sweep as a graph of jobs: each point is a job, and the table depends on all of them. Finished
folders are kept."""

from style import BODY, GREEN, GREY, OTHER, RED, arrow, box, diagram, save

figure, ax = diagram(2.2)
box(ax, 1.3, 1.75, 2.2, 1.0, "my-sweep.toml\nSnakefile", BODY)
states = (("001", "finished: kept", GREEN), ("002", "finished: kept", GREEN), ("003", "killed: run again", RED), ("004", "not started", GREY))
for k, (name, text, color) in enumerate(states):
    y = 3.05 - 0.87 * k
    box(ax, 5.1, y, 3.2, 0.62, f"job {name}  –  {text}", "white", color, color=color)
    arrow(ax, (2.45, 1.75), (3.45, y), GREY, width=1)
    arrow(ax, (6.75, y), (7.6, 1.75), GREY, width=1)
box(ax, 8.75, 1.75, 2.2, 1.0, "sweep.csv\nsweep.png", OTHER)
save(figure, "cluster")
