"""A scene as Python objects, SI units: what a TOML file of a scene holds, entry by entry under the same names.

    rubber = NeoHookean(young=7e6, nu=0.45, density=1722)
    Scene(bodies=[Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))], obstacles=[Plane()])

A Scene is checked as a whole when it is made and when an entry of it is set. Whatever is wrong is a BadInput with
the dotted name of the entry (body.1.young, counted from 1), its value and what is accepted. An entry that is None is
left open: the program chooses it.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from . import scene as files
from .failure import BadInput, brief, suggestion
from .input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .input.parameters import with_unit
from .input.toml_text import to_toml
from .scenes import scene as reading
from .scenes.bodies import MATERIAL, SIZES

__all__ = [
    "Ball",
    "Body",
    "Bowl",
    "Box",
    "Circle",
    "Contact",
    "Cylinder",
    "Disc",
    "Ellipse",
    "Ellipsoid",
    "Gas",
    "Implicit",
    "Incompressible",
    "Load",
    "Material",
    "Mesh",
    "MooneyRivlin",
    "NeoHookean",
    "Obstacle",
    "Ogden",
    "Pair",
    "Plane",
    "Polygon",
    "Polyline",
    "Rectangle",
    "Ring",
    "SaintVenantKirchhoff",
    "Scene",
    "Shell",
    "Sphere",
    "Support",
    "Surface",
    "Torus",
    "Tube",
]


def _plain(value: Any) -> Any:
    """Arrays and numbers of numpy as lists and numbers, tuples as lists: what TOML has."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return {key: _plain(one) for key, one in value.items()} if isinstance(value, dict) else value


def _number(value: Any) -> Any:
    if isinstance(value, bool | np.bool_):
        raise ValueError("true and false are no numbers")
    return _plain(value)


def _several(value: Any) -> Any:
    """One table as a list of one."""
    return [value] if isinstance(value, Entries) else value


def _text(value: Any) -> Any:
    """Numbers as a text with commas between them."""
    if isinstance(value, int | float):
        return f"{value}"
    return (
        ", ".join(map(str, _plain(value)))
        if isinstance(value, list | tuple | np.ndarray)
        else value
    )


Number = Annotated[float, BeforeValidator(_number)]
Vector = Annotated[
    list[float], BeforeValidator(_plain)
]  # a component for each axis: 2 in the plane, 3 in space
Point = Annotated[float | list[float], BeforeValidator(_plain)]  # of revolution also y alone
Points = Annotated[list[list[float]], BeforeValidator(_plain)]
Function = float | str | dict[str, Any]  # of t [s]: a number, an expression, a CSV file, a table
Functions = Annotated[Any, BeforeValidator(_plain)]  # of each axis


class Entries(BaseModel):
    """What all tables of a scene have in common."""

    model_config = ConfigDict(extra="forbid", validate_assignment=False)

    def __init__(self, **entries: Any):
        try:
            super().__init__(**entries)
        except ValidationError as error:
            raise _bad(type(self), error) from None

    def __repr_args__(self) -> list[tuple[str | None, Any]]:
        return [(name, value) for name, value in self if value is not None]

    def table(self) -> dict[str, Any]:
        """The table of a TOML file: without what is left open."""
        return {name: _table(value) for name, value in self if value is not None}


def _table(value: Any) -> Any:
    if isinstance(value, Entries):
        return value.table()
    return [_table(one) for one in value] if isinstance(value, list | tuple) else _plain(value)


TYPES = (
    "float",
    "int",
    "str",
    "list[float]",
    "dict[str,any]",
    "dict[str,str]",
)  # in pydantic's places


def _bad(model: type[BaseModel], error: ValidationError) -> BadInput:
    """The first thing that pydantic refuses, in the words of this program: entry, value, what is accepted."""
    every = error.errors()
    first = next((one for one in every if one["type"] == "extra_forbidden"), every[0])
    parts = [
        part + 1 if isinstance(part, int) else part for part in first["loc"] if part not in TYPES
    ]
    name, entry = ".".join(map(str, parts)) or model.__name__, model.__name__
    given, field = first["input"], model.model_fields.get(str(parts[0])) if parts else None
    if first["type"] == "extra_forbidden":
        near = suggestion(name, model.model_fields)
        accepted = ", ".join(model.model_fields)
        return BadInput(
            f"{entry}: {name}: no such entry, set to '{brief(given)}'{near} (accepted: {accepted})"
        )
    meaning = f" (accepted: {field.description})" if field and field.description else ""
    if first["type"] == "missing":
        return BadInput(f"{entry}: {name}: is missing{meaning}")
    unit = (isinstance(given, str) and with_unit(given, "")) or f"is not accepted: {first['msg']}"
    return BadInput(f"{entry}: {name}: '{brief(given)}' {unit}{meaning}")


# ---- materials


class Material(Entries):
    """What a body is made of. `law` is a constitutive law of edp/core/law; the classes below are those laws.

    Damping beside it: `viscosity` and `bulk_viscosity` [Pa s] of Kelvin and Voigt's kind, or `loss`, the loss factor at the
    first mode; a Maxwell branch of `relaxation_modulus` [Pa] and `relaxation_time` [s].
    """

    law: str = Field(description="constitutive law")
    young: Number = Field(description="Young's modulus [Pa]")
    nu: Number = Field(description="Poisson's ratio; 0.5: J = 1")
    density: Number = Field(description="reference density [kg/m3]")
    law_parameters: Annotated[str | None, BeforeValidator(_text)] = Field(
        None, description="what the law takes beyond young and nu, separated by commas"
    )
    viscosity: Number | None = Field(None, description="viscosity [Pa s]")
    bulk_viscosity: Number | None = Field(None, description="viscosity of volume [Pa s]")
    relaxation_modulus: Number | None = Field(
        None, description="shear modulus of a Maxwell branch [Pa]"
    )
    relaxation_time: Number | None = Field(None, description="its time [s]")
    loss: Number | None = Field(None, description="loss factor of shear at the first mode")


class SaintVenantKirchhoff(Material):
    """S = lambda tr(E) I + 2 mu E, paper (5)."""

    law: str = "svk"


class NeoHookean(Material):
    """Compressible neo-Hookean law, paper (6)."""

    law: str = "neohookean"


class Incompressible(Material):
    """Incompressible neo-Hookean law, J = 1."""

    law: str = "incompressible"
    nu: Number = 0.5


class MooneyRivlin(Material):
    """Mooney and Rivlin's law; law_parameters = "s", the share of the second invariant in the shear modulus."""

    law: str = "mooney-rivlin"


class Ogden(Material):
    """Ogden's law of one to three terms; law_parameters = "alpha_1, s_1, alpha_2, s_2 ...", exponents and shares."""

    law: str = "ogden"


LAWS = {
    one.model_fields["law"].default: one
    for one in (SaintVenantKirchhoff, NeoHookean, Incompressible, MooneyRivlin, Ogden)
}


# ---- conditions at the boundary of a body


class Support(Entries):
    """A part of a body's boundary that is held or moved (docs/supports-and-loads.md)."""

    where: str | dict[str, Any] = Field(
        description="a side, the name of a group of a mesh, or a region"
    )
    fix: str | None = Field(None, description="all, x, y, z or normal")
    motion: Functions | None = Field(
        None, description="displacement [m], a function of t for each axis"
    )
    release: Number | None = Field(None, description="time from which it is free [s]")


class Gas(Entries):
    """p V^n = const in a closed cavity."""

    gauge_pressure: Number = Field(description="over the pressure outside, at the start [Pa]")
    exponent: Number | None = Field(None, description="n; 1: isothermal, 1.4: air")
    ambient_pressure: Number | None = Field(None, description="outside [Pa]")


class Load(Entries):
    """A stress on a part of a body's boundary: one of traction, pressure, gas."""

    where: str | dict[str, Any] = Field(
        description="a side, the name of a group of a mesh, or a region"
    )
    traction: Functions | None = Field(
        None, description="per reference area [Pa], a function of t for each axis"
    )
    pressure: Function | None = Field(None, description="follows the surface [Pa]")
    gas: Gas | None = None


# ---- bodies


class Body(Entries):
    """What bodies of all shapes have; the shapes are the classes below. Rigid ones need no law, young and nu."""

    shape: ClassVar[str]
    material: Material | None = Field(None, description="not needed by a rigid body with a mass")
    position: Point = Field(description="of the centre of mass [m]")
    velocity: Point | None = Field(None, description="of the centre of mass [m/s]")
    speed: Number | None = Field(None, description="in the plane, in place of velocity [m/s]")
    direction: Number | None = Field(None, description="of the speed, from the x axis [degrees]")
    spin: Point | None = Field(None, description="angular velocity [rad/s]; in space a vector")
    angle: Point | None = Field(None, description="turned by [degrees]; in space a vector")
    turn: Point | None = Field(
        None, description="in space: turned about the axes one after the other [degrees]"
    )
    name: str | None = None
    mesh_size: Number | None = Field(
        None, description="largest element size [m]; by accuracy where it is open"
    )
    contact_mesh_size: Number | None = Field(
        None, description="element size where it may touch [m]"
    )
    support: Annotated[list[Support] | None, BeforeValidator(_several)] = None
    load: Annotated[list[Load] | None, BeforeValidator(_several)] = None
    rigid: bool | None = Field(None, description="moves without deforming")
    density: Number | None = Field(None, description="of a rigid body without a material [kg/m3]")
    mass: Number | None = Field(None, description="of a rigid body [kg, in the plane kg/m]")
    inertia: Point | None = Field(None, description="of a rigid body [kg m2]")

    def table(self) -> dict[str, Any]:
        """A table [[body]], its material in it."""
        found = super().table()
        material: dict[str, Any] = found.pop("material", {})
        return {"shape": self.shape} | material | found


class Disc(Body):
    """A disc in plane strain."""

    shape = "disc"
    radius: Number


class Ellipse(Body):
    """An ellipse in plane strain."""

    shape = "ellipse"
    semi_axes: Vector


class Rectangle(Body):
    """A rectangle in plane strain."""

    shape = "rectangle"
    width: Number
    height: Number


class Ring(Body):
    """A ring in plane strain."""

    shape = "ring"
    radius: Number
    inner_radius: Number


class Polygon(Body):
    """A polygon in plane strain; of revolution its section, from the axis to the axis or beside it."""

    shape = "polygon"
    vertices: Points
    holes: Any = None


class Ball(Body):
    """A ball, of revolution or in space."""

    shape = "ball"
    radius: Number


class Shell(Body):
    """A hollow ball of revolution."""

    shape = "shell"
    radius: Number
    inner_radius: Number


class Ellipsoid(Body):
    """An ellipsoid of revolution: radius, half height."""

    shape = "ellipsoid"
    semi_axes: Vector


class Cylinder(Body):
    """A cylinder about the y axis, of revolution or in space."""

    shape = "cylinder"
    radius: Number
    height: Number


class Tube(Body):
    """A tube of revolution."""

    shape = "tube"
    radius: Number
    inner_radius: Number
    height: Number


class Torus(Body):
    """An O-ring of revolution; `section` is the radius of its section."""

    shape = "torus"
    radius: Number
    section: Number


class Box(Body):
    """A box in space."""

    shape = "box"
    width: Number
    height: Number
    depth: Number


class Mesh(Body):
    """A body from a mesh or a CAD file."""

    shape = "mesh"
    file: str
    scale: Number | None = None


BODIES = {
    one.shape: one
    for one in (
        Disc,
        Ellipse,
        Rectangle,
        Ring,
        Polygon,
        Ball,
        Shell,
        Ellipsoid,
        Cylinder,
        Tube,
        Torus,
        Box,
        Mesh,
    )
}


# ---- rigid obstacles


class Obstacle(Entries):
    """What rigid obstacles of all kinds have; the kinds are the classes below."""

    kind: ClassVar[str]
    name: str | None = None
    velocity: Point | None = Field(None, description="[m/s]")
    motion: Functions | None = Field(
        None, description="displacement [m], a function of t for each axis"
    )
    rotation: Function | None = Field(None, description="turned by [degrees], a function of t")
    pivot: Vector | None = Field(None, description="what it turns about [m]")
    axis: Vector | None = Field(None, description="in space, the direction that it turns about")
    penalty: Number | None = Field(None, description="its own contact stiffness [Pa/m^m]")
    friction_static: Number | None = None
    friction_dynamic: Number | None = None

    def table(self) -> dict[str, Any]:
        """A table [[obstacle]]."""
        return {"kind": self.kind} | super().table()


class Plane(Obstacle):
    """A half space below a plane; the floor y = 0 by default."""

    kind = "plane"
    point: Vector | None = Field(None, description="on it [m]; the origin by default")
    normal: Vector | None = Field(None, description="out of it; upwards by default")


class Circle(Obstacle):
    """A disc in the plane."""

    kind = "circle"
    centre: Vector
    radius: Number


class Sphere(Obstacle):
    """A ball, of revolution or in space."""

    kind = "sphere"
    centre: Point
    radius: Number


class Bowl(Obstacle):
    """What is outside a circle or sphere."""

    kind = "bowl"
    centre: Point
    radius: Number


class Polyline(Obstacle):
    """A chain of straight walls, solid to its left."""

    kind = "polyline"
    vertices: Points
    closed: bool | None = None
    rounding: Number | None = None


class Implicit(Obstacle):
    """An expression of the signed distance in x, y (, z), positive outside."""

    kind = "implicit"
    distance: str


class Surface(Obstacle):
    """A closed surface in space from an STL file or a mesh."""

    kind = "surface"
    file: str
    scale: Number | None = None
    position: Vector | None = None
    turn: Vector | None = None
    rounding: Number | None = None


OBSTACLES = {one.kind: one for one in (Plane, Circle, Sphere, Bowl, Polyline, Implicit, Surface)}


# ---- contact


class Pair(Entries):
    """What differs between two partners, by their names; between a body and an obstacle, or two bodies."""

    bodies: list[str]
    penalty: Number | None = None
    friction_static: Number | None = None
    friction_dynamic: Number | None = None


class Contact(Entries):
    """Contact and friction of the whole scene, paper (10) to (13)."""

    penalty: Number | None = Field(None, description="contact stiffness k of (10) [Pa/m^m]")
    exponent: Number | None = Field(None, description="m of (10)")
    friction_static: Number | None = Field(None, description="mu_e of (12)")
    friction_dynamic: Number | None = Field(None, description="mu_d of (12)")
    slip_velocity: Number | None = Field(None, description="epsilon of (12) and (13) [m/s]")
    regularization: str | None = Field(
        None, description="phi of (13): linear, linear-printed, sqrt or tanh"
    )
    friction_transition: str | None = Field(
        None, description="from static to dynamic: jump or smooth"
    )
    pairing: str | None = Field(None, description="closest-point (9), or pairwise (14), (15)")
    pairing_range: Number | None = Field(None, description="epsilon of (14) [m]")
    self_contact: str | None = Field(None, description="auto, on or off")
    pair: Annotated[list[Pair] | None, BeforeValidator(_several)] = None


# ---- the scene


class Scene(Entries):
    """Bodies, obstacles, contact, and how the run is to be made. Entries are those of a TOML file, under the same names."""

    bodies: Annotated[list[Body], BeforeValidator(_several)]
    obstacles: Annotated[list[Obstacle], BeforeValidator(_several)] = []
    contact: Contact = Contact()
    title: str | None = None
    dimension: str | None = Field(
        None, description="plane-strain, axisymmetric or 3d; by the bodies where it is open"
    )
    symmetry: str | None = Field(None, description="in space: auto, full, half or quarter")
    gravity: Number | None = Field(None, description="along -y [m/s2]")
    body_force_x: Number | None = Field(None, description="[m/s2]")
    body_force_y: Number | None = Field(None, description="[m/s2]")
    accuracy: Number | None = Field(None, description="relative accuracy asked for")
    accuracy_of: str | None = Field(None, description="one answer more that it is asked for")
    end_time: Number | None = Field(None, description="[s]; 0: until the first impact is over")
    until: str | None = Field(None, description="impact or rest")
    dt: Number | None = Field(None, description="time step [s]; 0: adaptive")
    degree: int | None = Field(None, description="polynomial degree of the displacement: 1 or 2")
    integrator: str | None = None
    tolerance: Number | None = None
    breakdown: str | None = None
    chatter: str | None = None
    fields: int | None = Field(None, description="states kept with all fields")
    modes: int | None = Field(None, description="natural modes of free bodies")
    checkpoint_every: int | None = Field(None, description="steps")
    without: str | None = None
    folder: Path = Field(
        Path("."), exclude=True, repr=False, description="from which files of the scene are sought"
    )

    @model_validator(mode="after")
    def _is_accepted(self) -> Self:
        for k, body in enumerate(self.bodies, 1):
            if body.material is None and not body.rigid:
                raise BadInput(
                    f"body.{k}.material: is missing "
                    "(accepted: NeoHookean(young=..., nu=..., density=...), say)"
                )
        try:
            self.read()
        except BadInput as error:
            if self.dimension or ".shape:" not in str(error):
                raise
            raise BadInput(
                f"{error}; dimension = '{self.kind.name}' follows from the shapes, "
                "and from positions with three components"
            ) from None
        return self

    @property
    def kind(self) -> Dimension:
        """Its dimension: as given, or what the bodies' shapes and places say."""
        known = {one.name: one for one in (PLANE_STRAIN, AXISYMMETRIC, SOLID)}
        if self.dimension:
            return known.get(self.dimension, PLANE_STRAIN)
        if any(isinstance(body.position, list) and len(body.position) == 3 for body in self.bodies):
            return SOLID
        round_shapes = (Ball, Shell, Ellipsoid, Cylinder, Tube, Torus)
        return (
            AXISYMMETRIC
            if any(isinstance(body, round_shapes) for body in self.bodies)
            else PLANE_STRAIN
        )

    def table(self) -> dict[str, Any]:
        """The tables of its TOML file."""
        axes = self.kind.axes
        found = {
            name: _table(value)
            for name, value in self
            if value is not None and name not in ("bodies", "obstacles", "contact", "folder")
        }
        floor = {"point": [0.0] * axes, "normal": [0.0, 1.0, 0.0][:axes]}
        found["dimension"] = self.dimension or self.kind.name
        found["body"] = [body.table() for body in self.bodies]
        found["obstacle"] = [
            (floor if isinstance(one, Plane) else {}) | one.table() for one in self.obstacles
        ]
        found["contact"] = self.contact.table()
        return {name: value for name, value in found.items() if value not in ({}, [])}

    def read(self, name: str = "scene") -> reading.Scene:
        """What the program makes of it; BadInput where it does not accept it."""
        return reading.read(self.table(), self.folder, name)

    def save(self, path: str | Path) -> Path:
        """Writes its TOML file."""
        path = Path(path)
        path.write_text(to_toml(self.table()), "utf-8")
        return path

    @classmethod
    def load(cls, path: str | Path) -> Scene:
        """The scene of a TOML file, or a built-in one that is made of bodies (disc-beam, two-discs ...)."""
        name = str(path)
        path = files.SCENES / f"{name}.toml" if name in files.built_in() else Path(name)
        _, given = files.read_toml(path, files.absent(name, "scene", files.built_in()))
        if "body" not in given:
            raise BadInput(
                f"{name}: has no [[body]] (accepted: a scene of bodies; run('{name}') runs this one)"
            )
        try:
            return cls.of(given, path.parent)
        except BadInput as error:
            raise BadInput(f"{path}: {error}") from None

    @classmethod
    def of(cls, given: dict[str, Any], folder: Path = Path(".")) -> Scene:
        """The scene of tables as a TOML file has them: what stands at the top for all bodies is each one's own afterwards."""
        reading.read(given, folder, "scene")  # all that is wrong, by the names of the file
        given = copy.deepcopy(given)
        common = {key: given.pop(key) for key in (*MATERIAL, *SIZES) if key in given}
        bodies = [_body(common | one, one) for one in given.pop("body")]
        obstacles = [OBSTACLES[one.pop("kind")](**one) for one in given.pop("obstacle", [])]
        given.pop("script", None)
        return cls(
            bodies=bodies,
            obstacles=obstacles,
            contact=Contact(**given.pop("contact", {})),
            folder=folder,
            **given,
        )

    def set(self, values: Mapping[str, Any] | None = None, /, **entries: Any) -> Scene:
        """The same scene with entries set by their dotted names: scene.set(**{"body.1.velocity.2": -4, "accuracy": 0.01}),
        or scene.set({...})."""
        return type(self).of(
            self.read().override(_plain(dict(values or {}) | entries)).given, self.folder
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.table() == other.table()


def _body(given: dict[str, Any], own: dict[str, Any]) -> Body:
    """The body of a table [[body]] with what stands at the top of the file in it."""
    rigid = given.get("rigid")
    material = {
        key: given.pop(key) for key in MATERIAL if key in given and not (rigid and key == "density")
    }
    if rigid and "mass" in own:
        given.pop("density", None)
    if "viscosity" in own and "loss" not in own or "loss" in own and "viscosity" not in own:
        material.pop("loss" if "viscosity" in own else "viscosity", None)
    if rigid:
        material = {}
    shape = BODIES[given.pop("shape")]
    return shape(
        material=LAWS.get(material["law"], Material)(**material) if material else None, **given
    )
