"""Rigid obstacles: [[obstacle]] tables as the numbers that the scripts read
(edp/program/contact/shapes.idp), and signed distances, SI units.

Obstacles of a scene of revolution lie across the axis x = 0 or on it, or begin or end there.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import Polynomial

from ..failure import BadInput, gathered
from ..geometry import implicit, polyline, time_functions, tumbling
from ..geometry.outlines import Shape
from ..geometry.time_functions import TimeFunction, displacements, farthest
from ..input import obstacles as models
from ..input.dimension import AXISYMMETRIC, SOLID, Dimension
from ..input.rules import placeholder
from ..mesh import solids, surface_file
from ..mesh.revolution import mirrored

__all__ = [
    "Bowl",
    "Circle",
    "Drive",
    "Implicit",
    "KINDS",
    "Obstacle",
    "Plane",
    "Polyline",
    "Surface",
    "read",
    "settled",
]

# Returns the position (axes,) of the centre of a sphere relative to a point, polynomials of time.
SeenFrom = Callable[[np.ndarray], np.ndarray]
DRIVE = ("motion", "rotation", "pivot", "axis")  # entries of an obstacle with a prescribed motion


@dataclass(frozen=True)
class Obstacle:
    """One obstacle; the kinds are the classes below. `numbers` are those that the scripts read
    (edp/program/contact/shapes.idp).
    """

    name: str
    numbers: tuple[float, ...]
    velocity: np.ndarray
    drive: "Drive | None" = None

    kind: ClassVar[str]  # in the scripts
    is_exact: ClassVar[bool] = True  # whether gap() is the distance at any distance

    @classmethod
    def numbers_of(cls, table: Any, dimension: Dimension, folder: Path) -> tuple[float, ...]:
        """Returns the numbers of a table [[obstacle]]; files are relative to `folder`."""
        raise NotImplementedError

    @classmethod
    def defaults(cls, dimension: Dimension) -> dict[str, list[float]]:
        """Returns the entries that a table of this kind may leave out, with their defaults."""
        return {}

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Returns the signed distances (n,) [m] of points (n, axes) from the obstacle at the start,
        negative inside.
        """
        raise NotImplementedError

    def radius_at(self, point: np.ndarray, within: float) -> float:
        """Returns the radius of curvature [m] of the surface where it is nearest to a point (axes,): 0
        if a sharp corner is within `within` [m], infinity if the surface is flat or concave.
        """
        return np.inf

    def is_mirrored(self, axis: int) -> bool:
        """Whether the obstacle in space is its own mirror image at the plane of the origin normal to an
        axis.
        """
        return self.numbers[axis] == 0

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        """Yields for each part of the surface a list of polynomials of time. All of a list are <= 0 while
        a moving sphere of this radius [m] is near that part. seen_from(point): the position
        (axes,) of its centre relative to a point, of polynomials.
        """
        yield []

    @property
    def driven(self) -> bool:
        """Whether functions of time move the obstacle."""
        return self.drive is not None and self.drive.moves

    @property
    def moves(self) -> bool:
        """Whether the obstacle has a velocity or is driven."""
        return self.driven or bool(self.velocity.any())

    def matrix(self, t: float) -> np.ndarray:
        """Returns the homogeneous matrix (4, 4) that takes points of the obstacle at the start to
        their positions at the time t [s].
        """
        axes = len(self.velocity)
        matrix = np.eye(4)
        if self.drive:
            matrix[:3, :3] = self.drive.rotation(t)
            pivot = self.drive.pivot
            matrix[:axes, 3] = pivot + self.drive.shift(t) - matrix[:axes, :axes] @ pivot
        else:
            matrix[:axes, 3] = self.velocity * t
        return matrix

    @property
    def carried_along(self) -> "Obstacle":
        """The obstacle as if its motion took it to its farthest position at constant velocity."""
        if not self.drive:
            return self
        translation, when = farthest(self.drive.translation)
        return replace(self, velocity=translation / when if when > 0 else 0 * self.velocity)

    def gap_for_sizes(self, points: np.ndarray) -> np.ndarray:
        """Returns gaps for element sizes: like gap(), but to first order far from an implicit obstacle."""
        return self.gap(points)

    def gap_from(self, shape: Shape) -> float:
        """Returns the smallest gap [m] of the outline or surface of a body."""
        return shape.least(self.gap)

    def gap_in_plane(self, points: np.ndarray, t: float) -> np.ndarray:
        """Returns the gaps (n,) [m] of points (n, 2) of the plane z = 0 at the time t [s]."""
        whole = np.pad(points, [(0, 0), (0, len(self.velocity) - 2)])
        return self.gap(self.drive.at_start(whole, t) if self.drive else whole - self.velocity * t)


class Plane(Obstacle):
    """The half-space below a plane. `numbers`: a point and the unit outward normal."""

    kind = "plane"

    @classmethod
    def defaults(cls, dimension: Dimension) -> dict[str, list[float]]:
        return {"point": [0.0] * dimension.axes, "normal": [0.0, 1.0, 0.0][: dimension.axes]}

    @classmethod
    def numbers_of(
        cls, table: models.Plane, dimension: Dimension, folder: Path
    ) -> tuple[float, ...]:
        used = cls.defaults(dimension) | table.table()
        point, normal = np.array(used["point"]), np.array(used["normal"])
        if not normal.any():
            raise BadInput(
                f"{table.at('normal')}: '{table.value_text('normal')}' has no direction "
                f"(accepted: {placeholder(dimension.axes)} other than 0)"
            )
        if dimension is AXISYMMETRIC and normal[0] != 0:
            raise BadInput(
                f"{table.at('normal')}: '{table.value_text('normal')}' is not along the axis of revolution "
                f"(accepted: [0, 1] or [0, -1])"
            )
        normal = normal / abs(normal).max()  # its squares do not underflow
        return *map(float, point), *map(float, normal / np.linalg.norm(normal))

    def gap(self, points: np.ndarray) -> np.ndarray:
        axes = points.shape[1]
        return (points - self.numbers[:axes]) @ self.numbers[axes:]

    def is_mirrored(self, axis: int) -> bool:
        return self.numbers[3 + axis] == 0

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        axes = len(self.velocity)
        point, normal = np.array(self.numbers[:axes]), np.array(self.numbers[axes:])
        yield [seen_from(point) @ normal - bounding_radius]


class Circle(Obstacle):
    """A solid circle or sphere. `numbers`: centre and radius."""

    kind = "circle"

    @classmethod
    def numbers_of(cls, table: Any, dimension: Dimension, folder: Path) -> tuple[float, ...]:
        return *table.centre, table.radius

    def gap(self, points: np.ndarray) -> np.ndarray:
        axes = points.shape[1]
        distance: np.ndarray = np.linalg.norm(points - self.numbers[:axes], axis=1) - self.numbers[axes]
        return distance

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return self.numbers[-1]

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        centre, radius = np.array(self.numbers[:-1]), self.numbers[-1]
        yield [(seen_from(centre) ** 2).sum() - (radius + bounding_radius) ** 2]


class Bowl(Circle):
    """The solid outside a circle or sphere."""

    kind = "bowl"

    def gap(self, points: np.ndarray) -> np.ndarray:
        return -super().gap(points)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return np.inf

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        centre, radius = np.array(self.numbers[:-1]), self.numbers[-1]
        yield [max(0.0, radius - bounding_radius) ** 2 - (seen_from(centre) ** 2).sum()]


class Polyline(Obstacle):
    """A chain of straight sides. `numbers`: closed (1 or 0), rounding, x y of each vertex; of a surface
    of revolution with its mirror image.
    """

    kind = "polyline"

    @classmethod
    def numbers_of(
        cls, table: models.Polyline, dimension: Dimension, folder: Path
    ) -> tuple[float, ...]:
        closed, vertices = bool(table.closed), np.array(table.vertices)
        if dimension is AXISYMMETRIC:
            vertices, closed = mirrored(table.at("vertices"), vertices)
        polyline.check(table.entry, vertices, closed)
        if table.fillet:
            vertices = polyline.inset(table.at("fillet"), vertices, closed, table.fillet)
        return polyline.numbers(vertices, closed, table.rounding or table.fillet or 0.0)

    def gap(self, points: np.ndarray) -> np.ndarray:
        return polyline.gap(points, self.numbers)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return polyline.radius_at(point, within, self.numbers)

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        sides, near = polyline.sides_of(self.numbers), bounding_radius + self.numbers[1]
        for point, along, low, high in zip(sides.start, sides.along, sides.low, sides.high):
            r = seen_from(point)
            above, at = r @ np.array([-along[1], along[0]]), r @ along
            yield [
                above - near,
                -above - near,
                *([low - near - at] if np.isfinite(low) else []),
                *([at - high - near] if np.isfinite(high) else []),
            ]


class Implicit(Obstacle):
    """The surface D(x) = 0. `numbers`: the validity limit and the program of D (implicit.py); the
    limit is 1 before settled().
    """

    kind = "implicit"
    is_exact = False

    @classmethod
    def numbers_of(
        cls, table: models.Implicit, dimension: Dimension, folder: Path
    ) -> tuple[float, ...]:
        code = implicit.program(table.at("distance"), table.distance, "xyz"[: dimension.axes])
        if dimension is AXISYMMETRIC and not implicit.is_mirrored(code, 0, 2):
            raise BadInput(
                f"{table.at('distance')}: '{table.value_text('distance')}' is not the same for x and -x, "
                f"as of revolution (accepted: with x^2 or abs(x))"
            )
        return 1.0, *code

    def gap(self, points: np.ndarray) -> np.ndarray:
        return implicit.gap(points, self.numbers)

    def gap_for_sizes(self, points: np.ndarray) -> np.ndarray:
        return implicit.gap(points, self.numbers, bounds=False)

    def gap_from(self, shape: Shape) -> float:
        return self.nearest(shape)[0]

    def nearest(self, shape: Shape) -> tuple[float, np.ndarray]:
        """Returns the smallest gap [m] of a body and the outward normal there. The gap is that of the
        points of the body, or of its whole circle or sphere.
        """
        gap, at = implicit.least(shape.points, self.numbers)
        limit, *code = self.numbers
        with np.errstate(all="ignore"):
            return implicit.nearest(shape.points[at], gap, code, limit, shape.disc)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return implicit.radius_at(point, self.numbers)

    def is_mirrored(self, axis: int) -> bool:
        return implicit.is_mirrored(self.numbers[1:], axis, 3)


class Surface(Obstacle):
    """A closed triangle mesh in space. `numbers`: rounding, numbers of vertices and triangles, x y z of
    each vertex, the vertices of each triangle.
    """

    kind = "surface"

    @classmethod
    def numbers_of(
        cls, table: models.Surface, dimension: Dimension, folder: Path
    ) -> tuple[float, ...]:
        """The surface of a file, rotated about the origin of the file and then moved."""
        try:
            points, triangles = surface_file.read(folder / table.file)
        except BadInput as error:
            raise BadInput(f"{table.at('file')}: {error}") from None
        turn = np.radians(table.turn or [0.0, 0.0, 0.0])
        points = (table.scale or 1.0) * points @ tumbling.rotation(turn).T + np.array(
            table.position or [0.0, 0.0, 0.0]
        )
        return (
            table.rounding or 0.0,
            float(len(points)),
            float(len(triangles)),
            *points.ravel().tolist(),
            *map(float, triangles.ravel()),
        )

    @cached_property
    def _surface(self) -> solids.Shape:
        count, faces = int(self.numbers[1]), int(self.numbers[2])
        data = np.array(self.numbers[3:])
        points, triangles = (
            data[: 3 * count].reshape(-1, 3),
            data[3 * count :].astype(int).reshape(faces, 3),
        )
        return solids.surface(points[triangles])

    def gap(self, points: np.ndarray) -> np.ndarray:
        return self._surface.gap(points) - self.numbers[0]

    def is_mirrored(self, axis: int) -> bool:
        return False


KINDS: dict[str, type[Obstacle]] = {
    "sphere": Circle,
    **{kind.kind: kind for kind in (Plane, Circle, Bowl, Polyline, Implicit, Surface)},
}


@dataclass(frozen=True)
class Drive:
    """The prescribed motion of an obstacle: a `translation` [m], and a rotation `turn` [rad] about
    an axis (3,) through `pivot`.
    """

    translation: tuple[TimeFunction, ...]
    turn: TimeFunction
    pivot: np.ndarray
    axis: np.ndarray

    @property
    def moves(self) -> bool:
        """Whether the displacement or the rotation changes in time."""
        return not all(function.is_zero for function in (*self.translation, self.turn))

    @property
    def fastest_turn(self) -> float:
        """The largest angular velocity [rad/s]."""
        return self.turn.largest_slope

    def at_start(self, points: np.ndarray, t: float) -> np.ndarray:
        """Returns where points (n, axes) that are on the moved obstacle at the time t [s] were on it
        at the start.
        """
        axes = points.shape[1]
        turned = self.rotation(t)[:axes, :axes]
        at_start: np.ndarray = self.pivot + (points - self.pivot - self.shift(t)) @ turned
        return at_start

    def shift(self, t: float) -> np.ndarray:
        """The displacement (axes,) [m] at the time t [s] since the start."""
        return np.array([function(t) for function in self.translation])

    def rotation(self, t: float) -> np.ndarray:
        """The rotation matrix (3, 3) at the time t [s] since the start."""
        return tumbling.rotation(self.axis * float(self.turn(t)))


def read(
    tables: list[models.Obstacle], dimension: Dimension, end_time: float, folder: Path
) -> list[Obstacle]:
    """Returns the obstacles of [[obstacle]] tables. Functions of time are used up to `end_time` [s];
    files are relative to `folder`.
    """
    return gathered([partial(_obstacle, table, dimension, end_time, folder) for table in tables])


def settled(obstacles: list[Obstacle], centre: np.ndarray, half: float) -> list[Obstacle]:
    """Returns the obstacles with the largest gradient and curvature of implicit ones in a box about
    `centre` of half size `half` [m], in which the bodies lie.
    """

    def numbers(k: int, code: tuple[float, ...]) -> tuple[float, ...]:
        return implicit.settled(f"obstacle.{k}", code, centre, half)

    return [
        replace(obstacle, numbers=numbers(k, obstacle.numbers[1:]))
        if isinstance(obstacle, Implicit)
        else obstacle
        for k, obstacle in enumerate(obstacles, 1)
    ]


def _obstacle(
    table: models.Obstacle, dimension: Dimension, end_time: float, folder: Path
) -> Obstacle:
    kind = KINDS[table.kind]
    return kind(
        table.name or table.entry.replace(".", ""),
        kind.numbers_of(table, dimension, folder),
        np.array(table.velocity or [0.0] * dimension.axes),
        _drive(table, dimension, end_time, folder),
    )


def _drive(
    table: models.Obstacle, dimension: Dimension, end_time: float, folder: Path
) -> Drive | None:
    """Returns the motion of the entries motion, rotation, pivot and axis, or None without them."""
    if not any(key in table for key in DRIVE):
        return None
    if dimension is AXISYMMETRIC and "rotation" in table:
        raise BadInput(
            f"{table.at('rotation')}: nothing turns in a scene of revolution (accepted: motion)"
        )
    if "axis" in table and dimension is not SOLID:
        raise BadInput(
            f"{table.at('axis')}: is of three dimensions (accepted: without it, about z)"
        )
    none = time_functions.constant(0.0)
    translation = (
        (none,) * dimension.axes
        if table.motion is None
        else displacements(
            table.at("motion"), table.motion, "xyz"[: dimension.axes], end_time, folder
        )
    )
    if dimension is AXISYMMETRIC and not translation[0].is_zero:
        raise BadInput(f"{table.at('motion')}.1: leaves the axis of revolution (accepted: 0)")
    degrees = (
        none
        if table.rotation is None
        else displacements(table.at("rotation"), table.rotation, "r", end_time, folder)[0]
    )
    turn = degrees.scaled(np.pi / 180)
    axis = np.array(table.axis or [0.0, 0.0, 1.0])
    centre = (
        getattr(table, "centre", None) or getattr(table, "point", None) or [0.0] * dimension.axes
    )
    return Drive(translation, turn, np.array(table.pivot or centre), axis / np.linalg.norm(axis))
