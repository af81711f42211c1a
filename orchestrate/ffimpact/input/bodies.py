"""Bodies: the entries that all shapes have. The shapes are in shapes.py. Units are SI."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, model_validator

from ..failure import BadInput, brief
from ..geometry.limits import LONGEST
from .conditions import Load, Support
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .entries import several
from .materials import LAWS, MATERIAL, NOT_RIGID, OF_BODIES, Material, OfMaterial
from .parameter import Parameter, real
from .rules import (
    MOST_TURN,
    Components,
    Flag,
    InSpace,
    Name,
    OfPlace,
    Place,
    Placed,
    Vector,
    number,
)

__all__ = ["Body", "Drawn", "FIELDS", "Hollow"]

PLACEMENTS = ("centroid", "as-drawn")
MOST_STRETCH = 20.0  # largest accepted ratio of the lengths of an element
FIELDS = ("initial_velocity", "initial_displacement")  # entries that are functions of place


class Body(OfMaterial):
    """The entries of bodies of all shapes; the shapes are the classes below.

    `material` sets law, young, nu, density and damping together. A rigid body needs only a density
    or a mass.
    """

    shape: ClassVar[str]
    heading = ("shape",)
    aliases = {"material": "a Material"}
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN,)
    nested = {"support": Support, "load": Load}
    only = {
        "mesh_stretch": (PLANE_STRAIN, AXISYMMETRIC),
        "angle": (PLANE_STRAIN, SOLID), "turn": (SOLID,), "spin": (PLANE_STRAIN, SOLID),
    }  # fmt: skip

    name: Annotated[str | None, Name("of its own")] = None
    position: Annotated[Components | None, Place("of the centre of mass [m]")]
    velocity: Annotated[Components | None, Place("of the centre of mass [m/s]")] = None
    mesh_size: Annotated[
        float | None, real(0, 0, 1e9, "m", "largest element size; 0 = by accuracy", OF_BODIES)
    ] = None
    contact_mesh_size: Annotated[
        float | None,
        real(0, 0, 1e9, "m", "element size at the contact boundary; 0 = from accuracy", OF_BODIES),
    ] = None
    mesh_stretch: Annotated[
        float | None,
        number(
            0.0,
            MOST_STRETCH,
            "",
            "length of the elements across the normal of the first contact over that along it, from"
            " 1; 0 = by accuracy where a face lands flat, else 1",
        ),
    ] = None
    support: Annotated[list[Support] | None, BeforeValidator(several)] = None
    load: Annotated[list[Load] | None, BeforeValidator(several)] = None
    rigid: Annotated[bool | None, Flag("moves without deforming")] = None
    mass: Annotated[
        float | None, number(1e-12, LONGEST, "", "of a rigid body [kg, in the plane kg/m]")
    ] = None
    inertia: Annotated[
        Components | None,
        InSpace(number(1e-18, LONGEST, ""), "of a rigid body [kg m2]", about_z=False),
    ] = None
    angle: Annotated[float | None, number(-MOST_TURN, MOST_TURN, "deg", "turned by, about z")] = (
        None
    )
    turn: Annotated[
        list[float] | None,
        Vector("turned about a vector of this length [degrees]", -MOST_TURN, MOST_TURN, 3),
    ] = None
    speed: Annotated[
        float | None, real(0, 0, 1e9, "m/s", "in place of velocity, with direction", OF_BODIES)
    ] = None
    direction: Annotated[
        float | None,
        number(
            -MOST_TURN, MOST_TURN, "deg", "of the speed, in the plane of x and y, from the x axis"
        ),
    ] = None
    spin: Annotated[
        Components | None,
        InSpace(
            real(0, -1e12, 1e12, "rad/s", "spin at the start, counter-clockwise", OF_BODIES),
            "angular velocity [rad/s]; in space a vector",
        ),
    ] = None
    initial_velocity: Annotated[
        Placed | None, OfPlace("of the points of the body [m/s], on top of velocity and spin")
    ] = None
    initial_displacement: Annotated[
        Placed | None, OfPlace("of the points of the body [m], which deforms it")
    ] = None

    @model_validator(mode="before")
    @classmethod
    def _of_material(cls, entries: Any) -> Any:
        """Replaces the entry `material` by the entries of the material; entries of the body win."""
        if not isinstance(entries, dict):
            return entries
        if not isinstance(entries.get("material"), Material | None):
            text = brief(entries["material"])
            raise BadInput(
                f"material: '{text}' is no material (accepted: NeoHookean(young=..., nu=..., density=...), say)"
            )
        own = {name: value for name, value in entries.items() if name != "material"}
        return (entries["material"].table() if "material" in entries else {}) | own

    def refusals(self) -> Iterator[tuple[str, str]]:
        if self.velocity is not None and (self.speed is not None or self.direction is not None):
            yield (
                "velocity",
                f": '{self.value_text('velocity')}' stands beside speed or direction (accepted: "
                "velocity, or speed with direction)",
            )
        elif (self.speed is None) != (self.direction is None):
            accepted = "speed [m/s] with direction [deg], counter-clockwise from x"
            missing = "direction" if self.direction is None else "speed"
            yield missing, f": is missing (accepted: {accepted})"
        if 0 < (stretch := self.mesh_stretch or 0.0) < 1:
            accepted = f"0, or from 1 to {MOST_STRETCH:g}"
            yield "mesh_stretch", f": {stretch:g} is below 1 (accepted: {accepted})"
        if self.angle is not None and self.turn is not None:
            accepted = "angle about z, or turn = [x, y, z]"
            yield (
                "angle",
                f": '{self.value_text('angle')}' stands beside turn (accepted: {accepted})",
            )
        if not self.rigid:
            for name in [name for name in ("mass", "inertia") if name in self][:1]:
                yield name, ": is of a rigid body (accepted: with rigid = true, or density)"
            return
        for name in [name for name in (*NOT_RIGID, "support", *FIELDS) if name in self][:1]:
            accepted = "density, or mass; without rigid = true"
            yield name, f": a rigid body has none (accepted: {accepted})"
        if "mass" in self and "density" in self:
            yield "mass", ": stands beside density (accepted: one of them)"

    @property
    def material(self) -> Material | None:
        """The body's own material; None unless law, young, nu and density are all set."""
        own = {name: getattr(self, name) for name in MATERIAL if name in self}
        law = LAWS.get(own.get("law", ""), Material)
        needed = {name for name in MATERIAL if law.model_fields[name].is_required()}
        return law(**own) if needed | {"law", "nu"} <= set(own) else None

    @property
    def sizes(self) -> list[Any]:
        """The values of the shape's own entries, in the order of the model."""
        return [
            getattr(self, name) for name in type(self).model_fields if name not in Body.model_fields
        ]

    def table(self) -> dict[str, Any]:
        """The table `[[body]]`."""
        return {"shape": self.shape} | super().table()


class Drawn(Body):
    """A body whose shape is drawn: by vertices or in a file, with an origin of its own."""

    position: Annotated[
        Components | None,
        Place("of the centre of mass, or with placement = 'as-drawn' of the origin [m]"),
    ] = None
    placement: Annotated[
        str | None, Parameter("", "word", None, "-", "what `position` places", words=PLACEMENTS)
    ] = None

    @property
    def is_placed_as_drawn(self) -> bool:
        """Whether `position` is that of the drawing's origin."""
        return self.placement == "as-drawn"

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.position is None and not self.is_placed_as_drawn:
            accepted = "that of the centre of mass, or placement = 'as-drawn'"
            yield "position", f": is missing (accepted: {accepted})"


class Hollow(Body):
    """The entries of a body with a wall."""

    radius: Annotated[float, number(meaning="outer radius")]
    inner_radius: Annotated[float, number(meaning="inner radius")]

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.inner_radius >= self.radius:
            inner, outer = self.inner_radius, self.radius
            yield "inner_radius", f": {inner:g} is not less than the radius {outer:g}"
