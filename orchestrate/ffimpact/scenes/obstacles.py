"""Rigid obstacles: [[obstacle]] tables as the numbers that the scripts read
(edp/core/contact/shapes.idp), and signed distances, SI units.

Obstacles of a scene of revolution lie across the axis x = 0 or on it, or begin or end there.
"""

from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from ..failure import BadInput, gathered
from ..geometry import implicit, polyline, time_functions, tumbling
from ..geometry.time_functions import TimeFunction, displacements, farthest
from ..input import models
from ..input.dimension import AXISYMMETRIC, SOLID, Dimension
from ..input.rules import Vector, placeholder
from ..mesh import solids, surface_file
from ..mesh.revolution import mirrored

__all__ = ["Drive", "Obstacle", "read", "settled"]

DRIVE = ("motion", "rotation", "pivot", "axis")      # entries of an obstacle with a prescribed motion


@dataclass(frozen=True)
class Obstacle:
    """One obstacle. `numbers` are those of the scripts: for a plane x y nx ny with a unit normal; for a
    circle, sphere and concave sphere x y radius; for a polyline closed (1 or 0) rounding x1 y1 x2 y2
    ..., for a surface of revolution with its mirror image; for an implicit obstacle the largest
    gradient, the validity limit and the program (implicit.py), 1 and 1 before settled().
    """

    name: str
    kind: str
    numbers: tuple[float, ...]
    velocity: np.ndarray
    drive: "Drive | None" = None

    @property
    def driven(self) -> bool:
        """Whether the obstacle follows functions of time."""
        return self.drive is not None

    @property
    def carried_along(self) -> "Obstacle":
        """The obstacle as if its motion took it to its farthest position at constant velocity."""
        if not self.drive:
            return self
        translation, when = farthest(self.drive.translation)
        return replace(self, velocity=translation / when if when > 0 else 0 * self.velocity)

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Returns the signed distances (n,) [m] of points (n, axes) from the obstacle at the start,
        negative inside.
        """
        if self.kind == "polyline":
            return polyline.gap(points, self.numbers)
        if self.kind == "implicit":
            return implicit.gap(points, self.numbers)
        if self.kind == "surface":
            return self._surface.gap(points) - self.numbers[0]
        axes = points.shape[1]
        from_point = points - self.numbers[:axes]
        if self.kind == "plane":
            return from_point @ self.numbers[axes:]
        outside = np.linalg.norm(from_point, axis=1) - self.numbers[axes]
        return -outside if self.kind == "bowl" else outside

    @cached_property
    def _surface(self) -> solids.Shape:
        """The surface of an obstacle from a file."""
        points, triangles = _triangles(self.numbers)
        return solids.surface(points[triangles])

    def gap_for_sizes(self, points: np.ndarray) -> np.ndarray:
        """Returns gaps for element sizes: like gap(), but to first order far from an implicit obstacle.
        """
        return implicit.gap(points, self.numbers, bounds=False) if self.kind == "implicit" else self.gap(points)

    @property
    def is_exact(self) -> bool:
        """Whether gap() is the distance at any distance."""
        return self.kind != "implicit"

    def gap_from(self, shape) -> float:
        """Returns the smallest gap [m] of the outline or surface of a body."""
        return shape.least(self.gap) if self.is_exact else self.nearest(shape)[0]

    def nearest(self, shape) -> tuple[float, np.ndarray]:
        """Returns the smallest gap [m] of a body from an implicit obstacle and the outward normal there.
        The gap is that of the points of the body, or of its whole circle or sphere.
        """
        gaps, (_, limit, *code) = self.gap(shape.points), self.numbers
        with np.errstate(all="ignore"):
            return implicit.nearest(shape.points[gaps.argmin()], gaps.min(), code, limit, shape.disc)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        """Returns the radius of curvature [m] of the surface where it is nearest to a point (axes,): 0
        if a sharp corner is within `within` [m], infinity if the surface is flat or concave.
        """
        if self.kind == "polyline":
            return polyline.radius_at(point, within, self.numbers)
        if self.kind == "implicit":
            return implicit.radius_at(point, self.numbers)
        return self.numbers[len(point)] if self.kind in ("circle", "sphere") else np.inf

    def gap_in_plane(self, points: np.ndarray, t: float) -> np.ndarray:
        """Returns the gaps (n,) [m] of points (n, 2) of the plane z = 0 at the time t [s]."""
        whole = np.pad(points, [(0, 0), (0, len(self.velocity) - 2)])
        return self.gap(self.drive.at_start(whole, t) if self.drive else whole - self.velocity * t)


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
    def fastest_turn(self) -> float:
        """The largest angular velocity [rad/s]."""
        return float(abs(self.turn.knots[:, 2]).max())

    def at_start(self, points: np.ndarray, t: float) -> np.ndarray:
        """Returns where points (n, axes) that are on the moved obstacle at the time t [s] were on it
        at the start.
        """
        axes = points.shape[1]
        translation = np.array([function(t) - function(0.0) for function in self.translation])
        back = tumbling.rotation(-self.axis * float(self.turn(t) - self.turn(0.0)))[:axes, :axes]
        return self.pivot + (points - self.pivot - translation) @ back.T


def read(tables: list[models.Obstacle], dimension: Dimension, end_time: float, folder: Path) -> list[Obstacle]:
    """Returns the obstacles of [[obstacle]] tables. Functions of time are used up to `end_time` [s];
    files are relative to `folder`.
    """
    return gathered([partial(_obstacle, table, dimension, end_time, folder) for table in tables])


def settled(obstacles: list[Obstacle], centre: np.ndarray, half: float) -> list[Obstacle]:
    """Returns the obstacles with the largest gradient and curvature of implicit ones in a box about
    `centre` of half size `half` [m], in which the bodies lie.
    """
    return [replace(obstacle, numbers=implicit.settled(f"obstacle.{k}", obstacle.numbers[2:], centre, half))
            if obstacle.kind == "implicit" else obstacle for k, obstacle in enumerate(obstacles, 1)]


def _obstacle(table: models.Obstacle, dimension: Dimension, end_time: float, folder: Path) -> Obstacle:
    shape = {"plane": _plane, "polyline": _polyline, "implicit": _implicit,
             "surface": partial(_surface, folder=folder)}.get(table.kind, _circle)
    return Obstacle(table.name or table.entry.replace(".", ""), table.kind, shape(table, dimension),
                    np.array(table.velocity or [0.0] * dimension.axes), _drive(table, dimension, end_time))


def _drive(table: models.Obstacle, dimension: Dimension, end_time: float) -> Drive | None:
    """Returns the motion of the entries motion, rotation, pivot and axis, or None without them."""
    if not any(key in table for key in DRIVE):
        return None
    for key, needs in (("pivot", "rotation"), ("axis", "rotation")):
        if key in table and needs not in table:
            raise BadInput(f"{table.at(key)}: stands without {needs} (accepted: with it)")
    if "velocity" in table:
        raise BadInput(f"{table.at('velocity')}: stands beside motion or rotation (accepted: one of them)")
    if dimension is AXISYMMETRIC and "rotation" in table:
        raise BadInput(f"{table.at('rotation')}: nothing turns in a scene of revolution (accepted: motion)")
    if "axis" in table and dimension is not SOLID:
        raise BadInput(f"{table.at('axis')}: is of three dimensions (accepted: without it, about z)")
    none = time_functions.constant(0.0)
    translation = ((none,) * dimension.axes if table.motion is None
                   else displacements(table.at("motion"), table.motion, "xyz"[:dimension.axes], end_time))
    if dimension is AXISYMMETRIC and not translation[0].is_zero:
        raise BadInput(f"{table.at('motion')}.1: leaves the axis of revolution (accepted: 0)")
    degrees = none if table.rotation is None else displacements(table.at("rotation"), table.rotation, "r", end_time)[0]
    turn = replace(degrees, knots=degrees.knots * [1.0, np.pi / 180, np.pi / 180])
    axis = np.array(table.axis or [0.0, 0.0, 1.0])
    if not axis.any():
        raise BadInput(f"{table.at('axis')}: '{table.value_text('axis')}' has no direction (accepted: other than 0)")
    centre = (getattr(table, "centre", None) or getattr(table, "point", None)
              or [0.0] * dimension.axes)
    return Drive(translation, turn, np.array(table.pivot or centre), axis / np.linalg.norm(axis))


def _plane(table: models.Plane, dimension: Dimension) -> tuple[float, ...]:
    for key in ("point", "normal"):
        if key not in table:
            raise BadInput(f"{table.at(key)}: is missing (accepted: {Vector().accepted_in(dimension)})")
    point, normal = np.array(table.point), np.array(table.normal)
    if not normal.any():
        raise BadInput(f"{table.at('normal')}: '{table.value_text('normal')}' has no direction (accepted: {placeholder(dimension.axes)} "
                       f"other than 0)")
    if dimension is AXISYMMETRIC and normal[0] != 0:
        raise BadInput(f"{table.at('normal')}: '{table.value_text('normal')}' is not along the axis of revolution (accepted: [0, 1] or "
                       f"[0, -1])")
    normal = normal / abs(normal).max()                    # its squares do not underflow
    return *map(float, point), *map(float, normal / np.linalg.norm(normal))


def _surface(table: models.Surface, dimension: Dimension, folder: Path) -> tuple[float, ...]:
    """Returns the numbers of the surface of a file, rotated about the origin of the file and then
    moved.
    """
    try:
        points, triangles = surface_file.read(folder / table.file)
    except BadInput as error:
        raise BadInput(f"{table.at('file')}: {error}") from None
    turn = np.radians(table.turn or [0.0, 0.0, 0.0])
    points = (table.scale or 1.0) * points @ tumbling.rotation(turn).T + np.array(table.position or [0.0, 0.0, 0.0])
    return table.rounding or 0.0, float(len(points)), float(len(triangles)), *points.ravel().tolist(), *map(float, triangles.ravel())


def _triangles(numbers: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Returns the vertices (n, 3) and triangles (t, 3) of the numbers of a surface."""
    points, faces = int(numbers[1]), int(numbers[2])
    data = np.array(numbers[3:])
    return data[:3 * points].reshape(-1, 3), data[3 * points:3 * (points + faces)].astype(int).reshape(-1, 3)


def _circle(table: models.Circle | models.Sphere | models.Bowl, dimension: Dimension) -> tuple[float, ...]:
    return *table.centre, table.radius


def _implicit(table: models.Implicit, dimension: Dimension) -> tuple[float, ...]:
    code = implicit.program(table.at("distance"), table.distance, "xyz"[:dimension.axes])
    if dimension is AXISYMMETRIC and not implicit.is_mirrored(code, 0, 2):
        raise BadInput(f"{table.at('distance')}: '{table.value_text('distance')}' is not the same for x and -x, as of revolution "
                       f"(accepted: with x^2 or abs(x))")
    return 1.0, 1.0, *code


def _polyline(table: models.Polyline, dimension: Dimension) -> tuple[float, ...]:
    closed, vertices = bool(table.closed), np.array(table.vertices)
    if dimension is AXISYMMETRIC:
        vertices, closed = mirrored(table.at("vertices"), vertices)
    polyline.check(table.entry, vertices, closed)
    return polyline.numbers(vertices, closed, table.rounding or 0.0)
