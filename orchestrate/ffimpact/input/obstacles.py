"""Rigid obstacles, one class for each kind. Units are SI."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from ..geometry.limits import LONGEST
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
)

__all__ = [
    "Bowl",
    "Circle",
    "Implicit",
    "OBSTACLES",
    "Obstacle",
    "Plane",
    "Polyline",
    "Sphere",
    "Surface",
]


class Obstacle(OfContact):
    """The entries of rigid obstacles of all kinds; the kinds are the classes below."""

    kind: ClassVar[str]
    heading = ("kind",)
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN, AXISYMMETRIC, SOLID)
    name: Annotated[str | None, Name("of its own")] = None
    velocity: Annotated[Components | None, Place("[m/s]")] = None
    motion: Annotated[Timed | None, Function("displacement [m], a function of t for each axis")] = (
        None
    )
    rotation: Annotated[
        Timed | None, Function("turned by [degrees], a function of t", single=True)
    ] = None
    pivot: Annotated[list[float] | None, Vector("what it turns about [m]")] = None
    axis: Annotated[
        list[float] | None, Vector("in space, the direction that it turns about", count=3)
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


class Plane(Obstacle):
    """The half-space below a plane, by default the floor y = 0."""

    kind = "plane"
    point: Annotated[list[float] | None, Vector("on it [m]; default 0")] = None
    normal: Annotated[list[float] | None, Vector("out of it; default along y")] = None


class Circle(Obstacle):
    """A solid disc in the plane."""

    kind = "circle"
    dimensions = (PLANE_STRAIN,)
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Bowl(Obstacle):
    """A concave obstacle: the solid outside a circle or sphere."""

    kind = "bowl"
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Sphere(Obstacle):
    """A solid ball, of revolution or in space."""

    kind = "sphere"
    dimensions = (AXISYMMETRIC, SOLID)
    centre: Annotated[Components, Place("[m]")]
    radius: Annotated[float, number(meaning="radius")]


class Polyline(Obstacle):
    """A chain of straight walls, solid to the right of its direction."""

    kind = "polyline"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC)
    only = {"closed": (PLANE_STRAIN,)}
    vertices: Annotated[list[list[float]], Points(2, "corners [m]")]
    closed: Annotated[bool | None, Flag("whether the last joins the first")] = None
    rounding: Annotated[
        float | None,
        number(0.0, LONGEST, "m", "of convex corners; sides lie as far outside the vertices"),
    ] = None
    fillet: Annotated[
        float | None,
        number(0.0, LONGEST, "m", "radius that cuts convex corners; sides stay on the vertices"),
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.rounding and self.fillet:
            yield "rounding", f": {self.rounding:g} m beside fillet (accepted: one of them)"


class Surface(Obstacle):
    """A closed surface in space from an STL file or a mesh."""

    kind = "surface"
    dimensions = (SOLID,)
    file: Annotated[
        str, Text("path, from the folder of the scene on", "the path of an STL file or a mesh")
    ]
    scale: Annotated[float | None, number(1e-9, 1e9, "m", "a unit of length of the file")] = None
    position: Annotated[list[float] | None, Vector("of the file's origin [m]", count=3)] = None
    turn: Annotated[
        list[float] | None,
        Vector("about a vector of this length [degrees]", -MOST_TURN, MOST_TURN, 3),
    ] = None
    rounding: Annotated[
        float | None, number(0.0, LONGEST, "m", "how far it reaches out of the file's triangles")
    ] = None


class Implicit(Obstacle):
    """A surface given by an expression in x, y (, z) for the signed distance, positive outside."""

    kind = "implicit"
    distance: Annotated[
        Timed, Function("expression in x, y (, z) of the signed distance [m]", single=True)
    ]


OBSTACLES: dict[str, type[Obstacle]] = {
    model.kind: model for model in (Plane, Circle, Sphere, Bowl, Polyline, Surface, Implicit)
}
