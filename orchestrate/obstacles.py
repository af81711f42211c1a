"""Rigid obstacles: [[obstacle]] tables as numbers that the scripts read (edp/core/contact/shapes.idp), and signed distances, SI units.

    [[obstacle]]
    name = "floor"               # obstacle1, obstacle2 ... where it is left out
    kind = "plane"               # point [x, y], normal [x, y] towards the bodies
                                 # circle: centre, radius, solid inside;  bowl: centre, radius, solid outside
                                 # polyline: vertices [[x, y], ...], closed = false, rounding = 0: the bodies to its left (polyline.py)
    velocity = [0, 0]            # it moves on with it, whatever it meets [m/s]
"""

from dataclasses import dataclass

import numpy as np

from . import polyline
from .bodies import checked_name
from .failure import BadInput
from .tables import LONGEST, SHORTEST, Table

KINDS = {"plane": ("point", "normal"), "circle": ("centre", "radius"), "bowl": ("centre", "radius"), "polyline": ("vertices", "closed", "rounding")}


@dataclass(frozen=True)
class Obstacle:
    """`numbers` as the scripts read them: plane x y nx ny, the normal of length 1; circle and bowl x y radius; polyline closed (1 or 0)
    rounding x1 y1 x2 y2 ..."""

    name: str
    kind: str
    numbers: tuple[float, ...]
    velocity: np.ndarray

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points (n, 2) from the obstacle, negative inside, where it is at the start."""
        if self.kind == "polyline":
            return polyline.gap(points, self.numbers)
        from_point = points - self.numbers[:2]
        if self.kind == "plane":
            return from_point @ self.numbers[2:]
        outside = np.linalg.norm(from_point, axis=1) - self.numbers[2]
        return outside if self.kind == "circle" else -outside


def read(tables: list[dict]) -> list[Obstacle]:
    """The obstacles of the [[obstacle]] tables."""
    return [_obstacle(f"obstacle.{k}", given) for k, given in enumerate(tables, 1)]


def _obstacle(path: str, given: dict) -> Obstacle:
    kind = given.get("kind")
    if kind not in tuple(KINDS):
        missing = "is missing" if kind is None else f"'{kind}' is not known"
        raise BadInput(f"{path}.kind: {missing} (accepted: {'|'.join(KINDS)})")
    table = Table(path, given, ("name", "kind", "velocity", *KINDS[kind]))
    shape = {"plane": _plane, "polyline": _polyline}.get(kind, _circle)
    return Obstacle(checked_name(path, given.get("name", path.replace(".", ""))), kind, shape(table),
                    table.numbers("velocity", -LONGEST, LONGEST, (0.0, 0.0)))


def _plane(table: Table) -> tuple[float, ...]:
    point, normal = (table.numbers(key, -LONGEST, LONGEST) for key in KINDS["plane"])
    if not normal.any():
        raise BadInput(f"{table.path}.normal: '{table.given['normal']}' has no direction (accepted: [x, y] other than [0, 0])")
    normal = normal / abs(normal).max()                    # so that no square of it underflows
    return *map(float, point), *map(float, normal / np.linalg.norm(normal))


def _circle(table: Table) -> tuple[float, ...]:
    return *map(float, table.numbers("centre", -LONGEST, LONGEST)), table.number("radius", SHORTEST, LONGEST)


def _polyline(table: Table) -> tuple[float, ...]:
    closed, vertices = table.flag("closed", False), table.points("vertices", least=2)
    rounding = table.number("rounding", 0, LONGEST, 0.0)
    polyline.check(table.path, vertices, closed, rounding)
    return polyline.numbers(vertices, closed, rounding)
