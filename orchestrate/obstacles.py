"""Rigid obstacles: [[obstacle]] tables as kinds that a FreeFEM script reads and signed distances, SI units.

    [[obstacle]]
    name = "floor"               # obstacle1, obstacle2 ... where it is left out
    kind = "plane"               # point [x, y], normal [x, y] towards the bodies;  circle, bowl: centre, radius (a bowl holds the bodies)
    velocity = [0, 0]
"""

from dataclasses import dataclass

import numpy as np

from .bodies import checked_name
from .failure import BadInput
from .tables import LONGEST, SHORTEST, Table

KINDS = {"plane": ("point", "normal"), "circle": ("centre", "radius"), "bowl": ("centre", "radius")}


@dataclass(frozen=True)
class Obstacle:
    """`numbers` in the order of the data file: plane px py nx ny; circle and bowl cx cy r."""

    name: str
    kind: str
    numbers: tuple[float, ...]
    velocity: np.ndarray

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points (n, 2) from the obstacle, negative inside."""
        centre, rest = np.array(self.numbers[:2]), np.array(self.numbers[2:])
        if self.kind == "plane":
            return (points - centre) @ rest
        off = np.linalg.norm(points - centre, axis=1) - rest[0]
        return off if self.kind == "circle" else -off


def read(tables: list[dict]) -> list[Obstacle]:
    """The obstacles of the [[obstacle]] tables."""
    return [_obstacle(f"obstacle.{k}", given) for k, given in enumerate(tables, 1)]


def _obstacle(path: str, given: dict) -> Obstacle:
    if given.get("kind") not in tuple(KINDS):
        raise BadInput(f"{path}.kind: '{given.get('kind', '')}' is not known (accepted: {'|'.join(KINDS)})")
    kind = given["kind"]
    table = Table(path, given, ("name", "kind", "velocity", *KINDS[kind]))
    place = table.numbers(KINDS[kind][0], -LONGEST, LONGEST)
    if kind == "plane":
        normal = table.numbers("normal", -LONGEST, LONGEST)
        if not normal.any():
            raise BadInput(f"{path}.normal: '{given['normal']}' has no direction (accepted: [x, y] that is not [0, 0])")
        rest = tuple(map(float, normal / np.linalg.norm(normal)))
    else:
        rest = (table.number("radius", SHORTEST, LONGEST),)
    return Obstacle(checked_name(path, given.get("name", path.replace(".", ""))), kind, (*map(float, place), *rest),
                    table.numbers("velocity", -LONGEST, LONGEST, (0.0, 0.0)))
