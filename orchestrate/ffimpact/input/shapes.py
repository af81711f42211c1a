"""The shapes of bodies, one class for each. Units are SI."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Annotated

import numpy as np
from pydantic import Field

from ..geometry.outlines import Loop, Shape, circle_loop, ellipse_loop
from ..mesh import flat, mesh, revolution, solids
from ..mesh.solid_mesh import SolidMesh
from .bodies import Body, Drawn, Hollow
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID
from .rules import Parts, Points, Polygons, Rows, Text, Vector, number

__all__ = [
    "BODIES",
    "Ball",
    "Box",
    "Cylinder",
    "Disc",
    "Ellipse",
    "Ellipsoid",
    "Mesh",
    "Polygon",
    "Rectangle",
    "Ring",
    "Shell",
    "Torus",
    "Tube",
]


class Disc(Body):
    """A disc in plane strain."""

    shape = "disc"
    rounds = "centre"
    radius: Annotated[float, number(), "radius"]

    def loops(self) -> tuple[Loop, ...]:
        return (circle_loop(self.radius),)


class Ellipse(Body):
    """An ellipse in plane strain."""

    shape = "ellipse"
    semi_axes: Annotated[
        list[float], Vector(1e-9, count=2), "half its width and half its height [m]"
    ]

    def loops(self) -> tuple[Loop, ...]:
        return (ellipse_loop(*self.semi_axes),)


class Rectangle(Body):
    """A rectangle in plane strain."""

    shape = "rectangle"
    width: Annotated[float, number(), "width"]
    height: Annotated[float, number(), "height"]

    def loops(self) -> tuple[Loop, ...]:
        half = np.array([self.width, self.height]) / 2
        return (Loop(half * [[-1, -1], [1, -1], [1, 1], [-1, 1]]),)


class Ring(Hollow):
    """A ring in plane strain."""

    shape = "ring"
    rounds = "centre"

    def loops(self) -> tuple[Loop, ...]:
        return circle_loop(self.radius), circle_loop(self.inner_radius)


class Polygon(Drawn):
    """A polygon in plane strain, or the section of a body of revolution.

    The section leads from the axis to the axis, or lies beside the axis.
    """

    shape = "polygon"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC)
    only = Drawn.only | {"holes": (PLANE_STRAIN,)}
    vertices: Annotated[list[list[float]], Points(3), "corners [m], each once, in order"]
    holes: Annotated[list[list[list[float]]] | None, Polygons(), "holes in it"] = None

    def loops(self) -> tuple[Loop, ...]:
        path, outer = self.at("vertices"), np.array(self.vertices)
        if self.dimension is AXISYMMETRIC:
            return (revolution.polygon_section(path, outer),)
        holes = enumerate(self.holes or [], 1)
        named = [(f"{self.at('holes')}.{k}", np.array(hole)) for k, hole in holes]
        return flat.polygon_loops([(path, outer), *named])


class Ball(Body):
    """A ball, as a body of revolution or in space."""

    shape = "ball"
    rounds = "centre"
    dimensions = (AXISYMMETRIC, SOLID)
    radius: Annotated[float, number(), "radius"]

    def loops(self) -> tuple[Loop, ...]:
        return (circle_loop(self.radius),)

    def solid(self) -> solids.Shape:
        return solids.ball(self.radius)


class Shell(Hollow):
    """A hollow ball, of revolution or in space."""

    shape = "shell"
    rounds = "centre"
    dimensions = (AXISYMMETRIC, SOLID)

    def loops(self) -> tuple[Loop, ...]:
        return circle_loop(self.radius), circle_loop(self.inner_radius)

    def solid(self) -> solids.Shape:
        return solids.shell(self.radius, self.inner_radius)


class Ellipsoid(Body):
    """An ellipsoid of revolution, with a radius and half a height."""

    shape = "ellipsoid"
    dimensions = (AXISYMMETRIC,)
    semi_axes: Annotated[list[float], Vector(1e-9, count=2), "radius and half the height [m]"]

    def loops(self) -> tuple[Loop, ...]:
        return (ellipse_loop(*self.semi_axes),)


class Cylinder(Body):
    """A cylinder about the y axis, as a body of revolution or in space."""

    shape = "cylinder"
    rounds = "axis"
    dimensions = (AXISYMMETRIC, SOLID)
    radius: Annotated[float, number(), "radius"]
    height: Annotated[float, number(), "height"]

    def loops(self) -> tuple[Loop, ...]:
        corners = [[0, -1], [1, -1], [1, 1], [0, 1], [-1, 1], [-1, -1]]
        return (Loop(np.array([self.radius, self.height / 2]) * corners),)

    def solid(self) -> solids.Shape:
        return solids.cylinder(self.radius, self.height)


class Tube(Hollow):
    """A tube about the y axis, of revolution or in space."""

    shape = "tube"
    rounds = "axis"
    dimensions = (AXISYMMETRIC, SOLID)
    height: Annotated[float, number(), "height"]

    def loops(self) -> tuple[Loop, ...]:
        inner, outer, half = self.inner_radius, self.radius, self.height / 2
        return (Loop(np.array([[inner, -half], [outer, -half], [outer, half], [inner, half]])),)

    def solid(self) -> solids.Shape:
        return solids.tube(self.radius, self.inner_radius, self.height)


class Torus(Body):
    """A torus (O-ring) of revolution; `section` is the radius of its circular section."""

    shape = "torus"
    dimensions = (AXISYMMETRIC,)
    radius: Annotated[float, number(), "from the axis to the middle of the section"]
    section: Annotated[float, number(), "radius of the section"]

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.section >= self.radius:
            accepted = f"below radius, {self.radius:g} m"
            yield "section", f": {self.section:g} m reaches the axis (accepted: {accepted})"

    def loops(self) -> tuple[Loop, ...]:
        return (circle_loop(self.section).placed(np.array([self.radius, 0.0]), 0.0),)


class Box(Body):
    """A box in space."""

    shape = "box"
    dimensions = (SOLID,)
    width: Annotated[float, number(), "along x"]
    height: Annotated[float, number(), "along y"]
    depth: Annotated[float, number(), "along z"]

    def solid(self) -> solids.Shape:
        return solids.box(np.array([self.width, self.height, self.depth]))


class Mesh(Drawn):
    """A body from a mesh or a CAD file, or from arrays: `points`, `cells` and `labels`.

    The arrays may be those of numpy or meshio. Messages about them count vertices from 1.
    """

    shape = "mesh"
    dimensions = (PLANE_STRAIN, AXISYMMETRIC, SOLID)
    file: Annotated[str | None, Text(), "path, from the folder of the scene on"] = None
    points: Annotated[
        list[list[float]] | None,
        Rows((2, 3)),
        "points of a mesh, in place of a file",
        Field(repr=False),
    ] = None
    cells: Annotated[
        list[list[int]] | None,
        Rows((3, 4), True),
        "corners of its triangles or tetrahedra, as numbers of points",
        Field(repr=False),
    ] = None
    labels: Annotated[
        dict[str, list[list[int]]] | None,
        Parts(Rows((2, 3), whole=True)),
        "parts of its boundary, for `where`; 'contact' may come into contact (without it all), "
        "'symmetry' is on the axis of revolution",
        Field(repr=False),
    ] = None
    scale: Annotated[
        float | None,
        number(1e-9, 1e9, "m"),
        "a unit of length of the file or points; STEP declares its own",
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        arrays = [name for name in ("points", "cells", "labels") if name in self]
        missing = [name for name in ("points", "cells") if arrays and name not in self]
        if arrays and self.file is not None:
            accepted = "a file, or points and cells"
            yield "file", f": stands beside {arrays[0]} (accepted: {accepted})"
        elif missing:
            yield missing[0], ": is missing (accepted: points and cells, or a file)"

    @cached_property
    def drawn(self) -> tuple[Shape, mesh.Mesh | SolidMesh | None, np.ndarray]:
        folder = self.context.folder
        if self.dimension is SOLID:
            return solids.file_solid(self, folder)
        if self.dimension is AXISYMMETRIC:
            return revolution.file_section(self, folder)
        made = flat.mesh_file(self, folder)
        outline = flat.mesh_outline(made)
        centre = outline.area_centre
        return outline.placed(-centre, 0.0), made.moved(-centre), centre


BODIES: dict[str, type[Body]] = {
    model.shape: model
    for model in (
        Disc,
        Ellipse,
        Rectangle,
        Ring,
        Ball,
        Shell,
        Ellipsoid,
        Box,
        Cylinder,
        Polygon,
        Tube,
        Torus,
        Mesh,
    )
}
