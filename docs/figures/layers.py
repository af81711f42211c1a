"""The files that an extension changes, from an entry of a scene to a line of FreeFEM, and the
output of results."""

from style import BODY, INK, LIGHT, OTHER, arrow, box, diagram, save

figure, ax = diagram(2.6)
rows = (("obstacle", "input/obstacles.py\nentry, numbers, gap", "", "kernels/shapes.cpp\ngap and normal"),
        ("friction law", "input/contact.py\nthe word", "", "kernels/contact-law.cpp\nφ and its derivative"),
        ("law", "input/materials.py\nthe word", "", "kernels/laws.cpp\nS, tangent, energy"),
        ("figure", "", "drawing.MORE\nhistory → figure", ""))
for x, title in ((3.0, "what users write"), (5.75, "Python"), (8.55, "kernels (C++)")):
    ax.text(x, 3.95, title, ha="center", fontsize=9.5, weight="bold")
for k, (name, *cells) in enumerate(rows):
    y = 3.3 - 0.9 * k
    ax.text(0.1, y, name, va="center", fontsize=9.5, weight="bold")
    last = None
    for x, width, text, face in zip((3.0, 5.75, 8.55), (2.1, 2.4, 2.7), cells, (BODY, LIGHT, OTHER)):
        if text:
            box(ax, x, y, width, 0.66, text, face, size=8.3)
            if last:
                arrow(ax, (last, y), (x - width / 2 - 0.03, y), INK, width=1)
            last = x + width / 2 + 0.03
save(figure, "layers")
