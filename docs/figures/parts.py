"""The installed parts: Python package, FreeFEM scripts, compiled kernels, gmsh."""

from style import BODY, GREY, INK, LIGHT, OTHER, arrow, box, diagram, save

figure, ax = diagram(2.2)
box(ax, 1.35, 2.6, 2.3, 0.95, "you: terminal,\nscript, notebook", "white")
box(ax, 4.9, 2.6, 2.9, 0.95, "Python package ffimpact\nscenes, sweeps, results", BODY)
box(ax, 8.55, 2.6, 2.5, 0.95, "gmsh, numpy,\npandas, matplotlib", LIGHT)
box(ax, 4.9, 0.75, 2.9, 0.95, "FreeFem++, edp/program:\ntime, record", OTHER)
box(ax, 8.55, 0.75, 2.5, 0.95, "kernels in C++:\nequations, steps", LIGHT)
box(ax, 1.35, 0.75, 2.3, 0.95, "result folder", "white")
arrow(ax, (2.55, 2.6), (3.4, 2.6), INK, width=1.2)
arrow(ax, (6.4, 2.6), (7.25, 2.6), INK, width=1.2)
arrow(ax, (4.9, 2.1), (4.9, 1.27), INK, width=1.2)
arrow(ax, (6.4, 0.75), (7.25, 0.75), INK, width=1.2)
arrow(ax, (3.4, 0.75), (2.55, 0.75), INK, width=1.2)
arrow(ax, (1.35, 1.27), (1.35, 2.1), GREY, width=1.2)
save(figure, "parts")
