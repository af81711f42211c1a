"""Rigid obstacles: [[obstacle]] tables (docs/bodies.md says what they hold) as numbers that the scripts read (edp/core/contact/shapes.idp),
and signed distances, SI units. Of revolution about x = 0 they lie across the axis or on it, or begin or end there."""

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import implicit, polyline
from .bodies import checked_name
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from ..failure import BadInput, brief, unknown
from ..mesh.revolution import mirrored, on_axis
from ..input.tables import Table, placeholder

KINDS = {
    PLANE_STRAIN: {"plane": ("point", "normal"), "circle": ("centre", "radius"), "bowl": ("centre", "radius"),
                   "polyline": ("vertices", "closed", "rounding")},
    AXISYMMETRIC: {"plane": ("point", "normal"), "sphere": ("centre", "radius"), "bowl": ("centre", "radius"),
                   "polyline": ("vertices", "rounding")},
    SOLID: {"plane": ("point", "normal"), "sphere": ("centre", "radius"), "bowl": ("centre", "radius")},
}
for kinds in KINDS.values():
    kinds["implicit"] = ("distance",)


@dataclass(frozen=True)
class Obstacle:
    """`numbers` as the scripts read them: plane x y nx ny, the normal of length 1; circle, sphere and bowl x y radius; polyline closed (1
    or 0) rounding x1 y1 x2 y2 ..., of a surface of revolution with its mirror image; implicit steepest limit program (implicit.py), 1 and 1
    before it is settled()."""

    name: str
    kind: str
    numbers: tuple[float, ...]
    velocity: np.ndarray

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points (n, axes) from the obstacle, negative inside, where it is at the start."""
        if self.kind == "polyline":
            return polyline.gap(points, self.numbers)
        if self.kind == "implicit":
            return implicit.gap(points, self.numbers)
        axes = points.shape[1]
        from_point = points - self.numbers[:axes]
        if self.kind == "plane":
            return from_point @ self.numbers[axes:]
        outside = np.linalg.norm(from_point, axis=1) - self.numbers[axes]
        return -outside if self.kind == "bowl" else outside

    def gap_for_sizes(self, points: np.ndarray) -> np.ndarray:
        """The same, of an implicit one far away to first order: where elements are to be small."""
        return implicit.gap(points, self.numbers, bounds=False) if self.kind == "implicit" else self.gap(points)

    @property
    def is_exact(self) -> bool:
        """Whether `gap` is the distance however far a point is."""
        return self.kind != "implicit"

    def gap_from(self, shape) -> float:
        """The least gap of a body's outline or surface."""
        return shape.least(self.gap) if self.is_exact else self.nearest(shape)[0]

    def nearest(self, shape) -> tuple[float, np.ndarray]:
        """Of an implicit one: the least gap of a body, and the outward normal there; of its points, or of a disc or ball all around."""
        gaps, (_, limit, *code) = self.gap(shape.points), self.numbers
        with np.errstate(all="ignore"):
            return implicit.nearest(shape.points[gaps.argmin()], gaps.min(), code, limit, shape.disc)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        """The radius [m] of its surface where that is nearest to a point (axes,), 0 if a sharp corner is `within` [m] as near, infinite
        where it is flat or hollow."""
        if self.kind == "polyline":
            return polyline.radius_at(point, within, self.numbers)
        if self.kind == "implicit":
            return implicit.radius_at(point, self.numbers)
        return self.numbers[len(point)] if self.kind in ("circle", "sphere") else np.inf

    def gap_in_plane(self, points: np.ndarray, t: float) -> np.ndarray:
        """The same of points (n, 2) of the plane z = 0 at the time t [s]."""
        whole = np.pad(points, [(0, 0), (0, len(self.velocity) - 2)])
        return self.gap(whole - self.velocity * t)


def read(tables: list[dict], dimension: Dimension = PLANE_STRAIN) -> list[Obstacle]:
    """The obstacles of the [[obstacle]] tables."""
    return [_obstacle(f"obstacle.{k}", given, dimension) for k, given in enumerate(tables, 1)]


def settled(found: list[Obstacle], centre: np.ndarray, half: float) -> list[Obstacle]:
    """The same, where bodies lie in a box of this half size [m]: how steep and curved an implicit one is there."""
    return [replace(one, numbers=implicit.settled(f"obstacle.{k}", one.numbers[2:], centre, half)) if one.kind == "implicit" else one
            for k, one in enumerate(found, 1)]


def _obstacle(path: str, given: dict, dimension: Dimension) -> Obstacle:
    kind, kinds = given.get("kind"), KINDS[dimension]
    if kind not in tuple(kinds):
        raise BadInput(f"{path}.kind: " + (f"is missing (accepted: {'|'.join(kinds)})" if kind is None else unknown(kind, kinds)))
    table = Table(path, given, ("name", "kind", "velocity", *kinds[kind]))
    shape = {"plane": _plane, "polyline": _polyline, "implicit": _implicit}.get(kind, _circle)
    return Obstacle(checked_name(path, given.get("name", path.replace(".", ""))), kind, shape(table, dimension),
                    _vector(table, "velocity", dimension, (0.0,) * dimension.axes))


def _vector(table: Table, key: str, dimension: Dimension, default: tuple[float, ...] | None = None) -> np.ndarray:
    return on_axis(table, key, default) if dimension is AXISYMMETRIC else table.numbers(key, default, dimension.axes)


def _plane(table: Table, dimension: Dimension) -> tuple[float, ...]:
    point, normal = (table.numbers(key, count=dimension.axes) for key in ("point", "normal"))
    if not normal.any():
        raise BadInput(f"{table.path}.normal: '{brief(table.given['normal'])}' has no direction (accepted: {placeholder(dimension.axes)} "
                       f"other than 0)")
    if dimension is AXISYMMETRIC and normal[0] != 0:
        raise BadInput(f"{table.path}.normal: '{brief(table.given['normal'])}' is not along the axis of revolution (accepted: [0, 1] or "
                       f"[0, -1])")
    normal = normal / abs(normal).max()                    # so that no square of it underflows
    return *map(float, point), *map(float, normal / np.linalg.norm(normal))


def _circle(table: Table, dimension: Dimension) -> tuple[float, ...]:
    return *map(float, _vector(table, "centre", dimension)), table.number("radius")


def _implicit(table: Table, dimension: Dimension) -> tuple[float, ...]:
    code = implicit.program(table.at("distance"), table.given.get("distance"), "xyz"[:dimension.axes])
    if dimension is AXISYMMETRIC and not implicit.is_mirrored(code, 0, 2):
        raise BadInput(f"{table.path}.distance: '{brief(table.given['distance'])}' is not the same for x and -x, as of revolution "
                       f"(accepted: with x^2 or abs(x))")
    return 1.0, 1.0, *code


def _polyline(table: Table, dimension: Dimension) -> tuple[float, ...]:
    closed, vertices = table.flag("closed", False), table.points("vertices", least=2)
    if dimension is AXISYMMETRIC:
        vertices, closed = mirrored(f"{table.path}.vertices", vertices)
    polyline.check(table.path, vertices, closed)
    return polyline.numbers(vertices, closed, table.number("rounding", 0, default=0.0))
