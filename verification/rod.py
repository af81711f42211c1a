"""V5: the clamped rod against a wall (rod.edp), whose exact solution has a contact in every period.
"""

from collections.abc import Iterator
from pathlib import Path

from .case import FRONT, Row
from .measure import measure


def rod(elements: int) -> Iterator[Row]:
    """A clamped rod comes into contact with the wall; t in units of L/c, strains of 5e-5, penalty
    1000 E/L."""
    numbers = measure("rod", young=1, density=1, nu=0, speed=1e-4, penalty=1e3, mesh_size=1 / elements, dt=0.5 / elements)
    for what, value, expected in (
            ("contact begins", numbers["start"], 1), ("contact ends", numbers["leave"], 2),
            ("period", numbers["again"] - numbers["start"], 3), ("stress: mean", numbers["mean"], 1 / 2),
            ("stress: middle", numbers["stress"], 1 / 2), ("energy", numbers["energy"], 1 / 8)):
        yield Row(what, 1 / elements, value, expected, FRONT)


def rods(folder: Path) -> Iterator[Row]:
    for elements in (50, 100, 200, 400):
        yield from rod(elements)
