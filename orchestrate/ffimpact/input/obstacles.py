"""Rigid obstacles, one class for each kind: their entries, the numbers that the scripts read
(edp/program/contact/shapes.idp) and signed distances. Units are SI.

Obstacles of a scene of revolution lie across the axis x = 0 or on it, or begin or end there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.polynomial import Polynomial

from ..failure import BadInput
from ..geometry import implicit, polyline, time_functions, tumbling
from ..geometry.limits import LONGEST
from ..geometry.outlines import Shape
from ..geometry.time_functions import TimeFunction, displacements, farthest
from ..mesh import solids, surface_file
from ..mesh.revolution import mirrored
from .contact import OfContact
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .rules import (
    MOST_TURN,
    Components,
    Flag,
    Function,
    Name,
    Place,
    Points,
    Text,
    Timed,
    Vector,
    number,
    placeholder,
)

__all__ = [
    "Bowl",
    "Circle",
    "Drive",
    "Implicit",
    "OBSTACLES",
    "Obstacle",
    "Plane",
    "Polyline",
    "Sphere",
    "Surface",
]

# Returns the position (axes,) of the centre of a sphere relative to a point, polynomials of time.
SeenFrom = Callable[[np.ndarray], np.ndarray]


class Obstacle(OfContact):
    """The entries of rigid obstacles of all kinds; the kinds are the classes below."""

    kind: ClassVar[str]
    is_exact: ClassVar[bool] = True  # whether gap() is the distance at any distance
    heading = ("kind",)
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN, AXISYMMETRIC, SOLID)
    name: Annotated[str | None, Name(), "of its own"] = None
    velocity: Annotated[Components | None, Place(), "[m/s]"] = None
    motion: Annotated[
        Timed | None, Function(), "displacement [m], a function of t for each axis"
    ] = None
    rotation: Annotated[
        Timed | None, Function(single=True), "turned by [degrees], a function of t"
    ] = None
    pivot: Annotated[list[float] | None, Vector(), "what it rotates about [m]"] = None
    axis: Annotated[
        list[float] | None, Vector(count=3), "in space, the direction that it rotates about"
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        for name in ("pivot", "axis"):
            if name in self and self.rotation is None:
                yield name, ": stands without rotation (accepted: with it)"
        if self.velocity is not None and any(name in self for name in ("motion", "rotation")):
            yield "velocity", ": stands beside motion or rotation (accepted: one of them)"
        if self.axis is not None and not any(self.axis):
            text = self.value_text("axis")
            yield "axis", f": '{text}' has no direction (accepted: other than 0)"

    def table(self) -> dict[str, Any]:
        """The table `[[obstacle]]`."""
        return {"kind": self.kind} | super().table()

    @property
    def own_name(self) -> str:
        """Its name, obstacle2 without one."""
        return self.name or self.entry.replace(".", "")

    @property
    def kernel(self) -> str:
        """Its kind in the scripts."""
        return self.kind

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """The numbers that the scripts read."""
        raise NotImplementedError

    @cached_property
    def start_velocity(self) -> np.ndarray:
        """Its velocity (axes,) [m/s]; 0 if it is driven."""
        return np.array(self.velocity or [0.0] * self.context.dimension.axes)

    @cached_property
    def drive(self) -> Drive | None:
        """The motion by functions of time, None without one."""
        if self.motion is None and self.rotation is None:
            return None
        dimension = self.context.dimension
        if dimension is AXISYMMETRIC and self.rotation is not None:
            raise BadInput(
                f"{self.at('rotation')}: nothing rotates in a scene of revolution (accepted: motion)"
            )
        if self.axis is not None and dimension is not SOLID:
            raise BadInput(
                f"{self.at('axis')}: is of three dimensions (accepted: without it, about z)"
            )
        translation = self._functions("motion", "xyz"[: dimension.axes])
        if dimension is AXISYMMETRIC and not translation[0].is_zero:
            raise BadInput(f"{self.at('motion')}.1: leaves the axis of revolution (accepted: 0)")
        turn = self._functions("rotation", "r")[0].scaled(np.pi / 180)
        axis = np.array(self.axis or [0.0, 0.0, 1.0])
        place = getattr(self, "centre", None) or getattr(self, "point", None)
        pivot = np.array(self.pivot or place or [0.0] * dimension.axes)
        return Drive(translation, turn, pivot, axis / np.linalg.norm(axis))

    def _functions(self, name: str, axes: str) -> tuple[TimeFunction, ...]:
        """The functions of an entry, which are 0 if it is not set."""
        definition, context = getattr(self, name), self.context
        if definition is None:
            return (time_functions.constant(0.0),) * len(axes)
        return displacements(self.at(name), definition, axes, context.end_time, context.folder)

    def check(self) -> None:
        """Raises BadInput if its entries do not agree with the scene."""
        _ = self.numbers, self.drive

    def within(self, centre: np.ndarray, half: float) -> Self:
        """The obstacle for bodies in a box of half size `half` [m] about `centre`."""
        return self

    def defaults(self) -> dict[str, list[float]]:
        """Returns the entries of this kind that may be left out, with their defaults."""
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
        return self.driven or bool(self.start_velocity.any())

    def matrix(self, t: float) -> np.ndarray:
        """Returns the homogeneous matrix (4, 4) that takes points of the obstacle at the start to
        their positions at the time t [s].
        """
        axes = len(self.start_velocity)
        matrix = np.eye(4)
        if self.drive:
            matrix[:3, :3] = self.drive.rotation(t)
            pivot = self.drive.pivot
            matrix[:axes, 3] = pivot + self.drive.shift(t) - matrix[:axes, :axes] @ pivot
        else:
            matrix[:axes, 3] = self.start_velocity * t
        return matrix

    @property
    def at_mean_velocity(self) -> Self:
        """The obstacle as if its motion took it to its farthest position at constant velocity."""
        if not self.drive:
            return self
        translation, when = farthest(self.drive.translation)
        velocity = translation / when if when > 0 else 0 * self.start_velocity
        return self.model_copy(update={"start_velocity": velocity})

    def gap_for_sizes(self, points: np.ndarray) -> np.ndarray:
        """Returns gaps for element sizes: like gap(), but to first order far from an implicit obstacle."""
        return self.gap(points)

    def gap_from(self, shape: Shape) -> float:
        """Returns the smallest gap [m] of the outline or surface of a body."""
        return shape.least(self.gap)

    def gap_in_plane(self, points: np.ndarray, t: float) -> np.ndarray:
        """Returns the gaps (n,) [m] of points (n, 2) of the plane z = 0 at the time t [s]."""
        whole = np.pad(points, [(0, 0), (0, len(self.start_velocity) - 2)])
        return self.gap(
            self.drive.at_start(whole, t) if self.drive else whole - self.start_velocity * t
        )


class Plane(Obstacle):
    """The half-space below a plane, by default the floor y = 0."""

    kind = "plane"
    point: Annotated[list[float] | None, Vector(), "on it [m]; default 0"] = None
    normal: Annotated[list[float] | None, Vector(), "out of it; default along y"] = None

    def defaults(self) -> dict[str, list[float]]:
        axes = self.context.dimension.axes
        return {"point": [0.0] * axes, "normal": [0.0, 1.0, 0.0][:axes]}

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """A point and the unit outward normal."""
        defaults, dimension = self.defaults(), self.context.dimension
        point = np.array(self.point or defaults["point"])
        normal = np.array(self.normal or defaults["normal"])
        if not normal.any():
            raise BadInput(
                f"{self.at('normal')}: '{self.value_text('normal')}' has no direction "
                f"(accepted: {placeholder(dimension.axes)} other than 0)"
            )
        if dimension is AXISYMMETRIC and normal[0] != 0:
            raise BadInput(
                f"{self.at('normal')}: '{self.value_text('normal')}' is not along the axis of revolution "
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
        axes = len(self.start_velocity)
        point, normal = np.array(self.numbers[:axes]), np.array(self.numbers[axes:])
        yield [seen_from(point) @ normal - bounding_radius]


class Circle(Obstacle):
    """A solid disc in the plane."""

    kind = "circle"
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN,)
    centre: Annotated[Components, Place(), "[m]"]
    radius: Annotated[float, number(), "radius"]

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """Centre and radius."""
        return *np.array(self.centre).tolist(), self.radius

    def gap(self, points: np.ndarray) -> np.ndarray:
        axes = points.shape[1]
        distance: np.ndarray = (
            np.linalg.norm(points - self.numbers[:axes], axis=1) - self.numbers[axes]
        )
        return distance

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return self.numbers[-1]

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        centre, radius = np.array(self.numbers[:-1]), self.numbers[-1]
        yield [(seen_from(centre) ** 2).sum() - (radius + bounding_radius) ** 2]


class Bowl(Circle):
    """A concave obstacle: the solid outside a circle or sphere."""

    kind = "bowl"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC, SOLID)

    def gap(self, points: np.ndarray) -> np.ndarray:
        return -super().gap(points)

    def radius_at(self, point: np.ndarray, within: float) -> float:
        return np.inf

    def regions(self, seen_from: SeenFrom, bounding_radius: float) -> Iterator[list[Polynomial]]:
        centre, radius = np.array(self.numbers[:-1]), self.numbers[-1]
        yield [max(0.0, radius - bounding_radius) ** 2 - (seen_from(centre) ** 2).sum()]


class Sphere(Circle):
    """A solid ball, of revolution or in space."""

    kind = "sphere"
    dimensions = (AXISYMMETRIC, SOLID)

    @property
    def kernel(self) -> str:
        return "circle"


class Polyline(Obstacle):
    """A chain of straight walls, solid to the right of its direction."""

    kind = "polyline"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC)
    only = {"closed": (PLANE_STRAIN,)}
    vertices: Annotated[list[list[float]], Points(2), "corners [m]"]
    closed: Annotated[bool | None, Flag(), "whether the last joins the first"] = None
    rounding: Annotated[
        float | None,
        number(0.0, LONGEST, "m"),
        "of convex corners; sides lie as far outside the vertices",
    ] = None
    fillet: Annotated[
        float | None,
        number(0.0, LONGEST, "m"),
        "radius that cuts convex corners; sides stay on the vertices",
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.rounding and self.fillet:
            yield "rounding", f": {self.rounding:g} m beside fillet (accepted: one of them)"

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """Closed (1 or 0), rounding, x y of each vertex; of revolution with its mirror image."""
        closed, vertices = bool(self.closed), np.array(self.vertices)
        if self.context.dimension is AXISYMMETRIC:
            vertices, closed = mirrored(self.at("vertices"), vertices)
        polyline.check(self.entry, vertices, closed)
        if self.fillet:
            vertices = polyline.inset(self.at("fillet"), vertices, closed, self.fillet)
        return polyline.numbers(vertices, closed, self.rounding or self.fillet or 0.0)

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


class Surface(Obstacle):
    """A closed surface in space from an STL file or a mesh."""

    kind = "surface"
    dimensions = (SOLID,)
    file: Annotated[
        str, Text("the path of an STL file or a mesh"), "path, from the folder of the scene on"
    ]
    scale: Annotated[float | None, number(1e-9, 1e9, "m"), "a unit of length of the file"] = None
    position: Annotated[list[float] | None, Vector(count=3), "of the file's origin [m]"] = None
    turn: Annotated[
        list[float] | None,
        Vector(-MOST_TURN, MOST_TURN, 3),
        "about a vector of this length [degrees]",
    ] = None
    rounding: Annotated[
        float | None, number(0.0, LONGEST, "m"), "how far it reaches out of the file's triangles"
    ] = None

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """Rounding, numbers of vertices and triangles, x y z of each vertex, the vertices of each
        triangle. The surface is rotated about the origin of its file and then moved.
        """
        try:
            points, triangles = surface_file.read(self.context.folder / self.file)
        except BadInput as error:
            raise BadInput(f"{self.at('file')}: {error}") from None
        turn, none = np.radians(self.turn or [0.0, 0.0, 0.0]), [0.0, 0.0, 0.0]
        points = (self.scale or 1.0) * points @ tumbling.rotation(turn).T
        points = points + np.array(self.position or none)
        counts = (float(len(points)), float(len(triangles)))
        corners = map(float, triangles.ravel())
        return self.rounding or 0.0, *counts, *points.ravel().tolist(), *corners

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


class Implicit(Obstacle):
    """A surface given by an expression in x, y (, z) for the signed distance, positive outside."""

    kind = "implicit"
    is_exact = False
    distance: Annotated[
        Timed, Function(single=True), "expression in x, y (, z) of the signed distance [m]"
    ]

    @cached_property
    def numbers(self) -> tuple[float, ...]:
        """The validity limit, 1 before within(), and the program of the expression
        (geometry/implicit.py).
        """
        dimension = self.context.dimension
        code = implicit.program(self.at("distance"), self.distance, "xyz"[: dimension.axes])
        if dimension is AXISYMMETRIC and not implicit.is_mirrored(code, 0, 2):
            raise BadInput(
                f"{self.at('distance')}: '{self.value_text('distance')}' is not the same for x and -x, "
                f"as of revolution (accepted: with x^2 or abs(x))"
            )
        return 1.0, *code

    def within(self, centre: np.ndarray, half: float) -> Self:
        """The obstacle with its largest gradient and curvature in the box."""
        numbers = implicit.settled(self.entry, self.numbers[1:], centre, half)
        return self.model_copy(update={"numbers": numbers})

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


OBSTACLES: dict[str, type[Obstacle]] = {
    model.kind: model for model in (Plane, Circle, Sphere, Bowl, Polyline, Surface, Implicit)
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
