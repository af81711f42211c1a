"""The pictures of README.md and the animation of docs/index.md: `make pictures`."""

import sys
from pathlib import Path

from PIL import Image, ImageSequence

from ffimpact.places import RESULTS, ROOT
from ffimpact.report import drawing

PICTURES = {
    "picture.png": ("disc-normal", "shapes"),
    "picture-oblique.png": ("disc-oblique", "flight"),
}
FILM, WIDTH, DURATION = (
    Path("movies/disc-oblique/disc-oblique.gif"),
    460,
    90,
)  # of a frame: pixels, ms


def main() -> int:
    """Draws all of them."""
    for name, (scene, figure) in PICTURES.items():
        drawing.draw(RESULTS / scene)
        picture = Image.open(RESULTS / scene / f"figures/{figure}.png").convert("RGB")
        picture.quantize(256).save(ROOT / name, optimize=True)
    film = Image.open(RESULTS / FILM)
    size = (WIDTH, round(film.height * WIDTH / film.width))
    first, *others = [
        frame.convert("RGB").resize(size, Image.Resampling.LANCZOS)
        for frame in ImageSequence.Iterator(film)
    ]
    first.save(
        ROOT / "docs/_static/impact.webp",
        save_all=True,
        append_images=others,
        duration=DURATION,
        loop=0,
        quality=50,
        method=6,
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
