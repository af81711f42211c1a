"""Writes the animation of README.md and docs/index.md from the film of disc-oblique: `make
pictures`."""

import sys
from pathlib import Path

from PIL import Image, ImageSequence

from ffimpact.places import RESULTS, ROOT

FILM = Path("movies/disc-oblique/disc-oblique.gif")
WIDTH = 460  # pixels
DURATION = 90  # duration of a frame [ms]


def main() -> int:
    """Writes docs/_static/impact.webp."""
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
