"""The stages of a run from the scene to the result folder, with the coarser runs that estimate the
error."""

from style import BODY, GREEN, GREY, INK, LIGHT, OTHER, arrow, box, diagram, save

figure, ax = diagram(2.9)
box(ax, 1.1, 3.6, 1.9, 0.85, "scene\nTOML or Python", BODY)
box(ax, 3.7, 3.6, 2.1, 0.85, "check; choose mesh,\nstep, penalty, ε", LIGHT, size=8.3)
box(ax, 6.45, 3.6, 2.1, 0.85, "mesh\n(gmsh)", LIGHT)
box(ax, 8.9, 3.6, 1.7, 0.85, "free flight to\nfirst contact", LIGHT)
box(ax, 8.05, 2.1, 3.5, 0.95, "time step: Newton iterations,\ncontact and friction solved in each", OTHER, size=8.3)
box(ax, 3.3, 2.1, 3.6, 0.95, "the same with elements and steps\n1.4 and 2 times larger", "white", GREY, size=8.3, color=GREY)
box(ax, 8.05, 0.65, 3.5, 0.85, "result folder:\nhistories, states, summary", BODY, size=8.3)
box(ax, 3.3, 0.65, 3.6, 0.85, "differences → error estimate;\nif too large: a finer run", "white", GREEN, size=8.3, color=GREEN)
for a, b in (((2.1, 3.6), (2.6, 3.6)), ((4.8, 3.6), (5.35, 3.6)), ((7.55, 3.6), (8.0, 3.6)), ((8.9, 3.15), (8.9, 2.62)), ((8.05, 1.6), (8.05, 1.12))):
    arrow(ax, a, b, INK, width=1.2)
arrow(ax, (3.7, 3.15), (3.4, 2.62), GREY, width=1.2)
arrow(ax, (3.3, 1.6), (3.3, 1.12), GREY, width=1.2)
arrow(ax, (6.25, 1.85), (5.15, 0.95), GREEN, width=1.2)
arrow(ax, (5.15, 0.55), (6.25, 0.55), GREEN, width=1.2)
save(figure, "overview")
