"""Six built-in scenes at the time of their largest force, coloured by the von Mises stress."""

from style import FOLDER, WIDTH, plt, save

import ffimpact as ff

NAMES = ("disc-oblique", "two-discs", "disc-beam", "hollow-ball", "drop-weight", "roller")
figure, axes = plt.subplots(2, 3, figsize=(WIDTH, 3.9), layout="constrained")
for name, ax in zip(NAMES, axes.flat):
    result = ff.run(name, accuracy=0.02, estimate=False, out=FOLDER / f".runs/{name}", progress=False)
    drawn = set(figure.axes)
    result.plot.shapes(ax)
    for bar in set(figure.axes) - drawn:
        bar.remove()  # the colour bar
    ax.set(title=name, xlabel="", ylabel="", xticks=(), yticks=())
    ax.title.set(fontsize=9.5, family="monospace")
    for side in ax.spines.values():
        side.set_visible(False)
save(figure, "gallery", "png")
