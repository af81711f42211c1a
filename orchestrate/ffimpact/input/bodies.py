"""Bodies: what all shapes have (docs/how-to/scenes.md). The shapes are in shapes.py. Units are SI.

A body in a scene has an outline or a mesh about its centre, a material, a place and a motion at the
start.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import BeforeValidator

from ..failure import BadInput, brief, gathered, suggestion
from ..geometry import place_functions, tumbling
from ..geometry.limits import LONGEST, SHORTEST
from ..geometry.outlines import Loop, Outline, Shape, Turn
from ..geometry.place_functions import Field
from ..mesh import mesh, revolution, solids
from ..mesh.layers import Layers, contents, layers_of_cells, on_boundary
from ..mesh.solid_file import GEOMETRIES
from ..mesh.solid_mesh import SolidMesh
from ..mesh.solids import Solid
from .conditions import Load, Part, Support, refuse_mixed_gases
from .dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from .entries import several
from .layers import THINNEST, Layer
from .materials import (
    LAWS,
    MADE,
    MATERIAL,
    NOT_RIGID,
    MadeOf,
    Material,
    OfMaterial,
    accepted,
    completed,
    rigid,
)
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

__all__ = ["Body", "Drawn", "FIELDS", "Hollow", "SIZES"]

PLACEMENTS = ("centroid", "as-drawn")
SIZES = ("mesh_size", "contact_mesh_size")
MEAN = 24  # number of points along an axis from which the mean of a field follows
BESIDE = 0.01  # distance of the box of a body from its sampled points, over its extents
FINEST = 1 / 20000  # smallest element size over the half thickness of a body
MOST_LAYERS = 100
# Words for the sides and the cells of meshes, by the corners of a cell.
NAMED = {3: ("lines", "triangles"), 4: ("surfaces", "tetrahedra")}
MOST_STRETCH = 20.0  # largest accepted ratio of the lengths of an element
FIELDS = ("initial_velocity", "initial_displacement")  # entries that are functions of place


class Body(MadeOf):
    """The entries of bodies of all shapes; the shapes are the classes below.

    `material` sets law, young, nu, density and damping together. A rigid body needs only a density
    or a mass.
    """

    shape: ClassVar[str]
    heading = ("shape",)
    dimensions: ClassVar[tuple[Dimension, ...]] = (PLANE_STRAIN,)
    rounds: ClassVar[str] = ""  # what the radius of a layer is measured from: centre, axis
    nested = {"support": Support, "load": Load, "layer": Layer}
    only = {
        "mesh_stretch": (PLANE_STRAIN, AXISYMMETRIC),
        "angle": (PLANE_STRAIN, SOLID), "turn": (SOLID,), "spin": (PLANE_STRAIN, SOLID),
    }  # fmt: skip

    name: Annotated[str | None, Name(), "of its own"] = None
    position: Annotated[Components | None, Place(), "of the centre of mass [m]"]
    velocity: Annotated[Components | None, Place(), "of the centre of mass [m/s]"] = None
    mesh_size: Annotated[
        float | None, real(0, 0, 1e9, "m"), "largest element size; 0 = by accuracy"
    ] = None
    contact_mesh_size: Annotated[
        float | None,
        real(0, 0, 1e9, "m"),
        "element size at the contact boundary; 0 = from accuracy",
    ] = None
    mesh_stretch: Annotated[
        float | None,
        number(0.0, MOST_STRETCH, ""),
        "length of the elements across the normal of the first contact over that along it, from"
        " 1; 0 = by accuracy where a face lands flat, else 1",
    ] = None
    support: Annotated[list[Support] | None, BeforeValidator(several)] = None
    load: Annotated[list[Load] | None, BeforeValidator(several)] = None
    layer: Annotated[list[Layer] | None, BeforeValidator(several)] = None
    rigid: Annotated[bool | None, Flag(), "moves without deforming"] = None
    mass: Annotated[
        float | None, number(1e-12, LONGEST, ""), "of a rigid body [kg, in the plane kg/m]"
    ] = None
    inertia: Annotated[
        Components | None,
        InSpace(number(1e-18, LONGEST, ""), about_z=False),
        "of a rigid body [kg m2]",
    ] = None
    angle: Annotated[float | None, number(-MOST_TURN, MOST_TURN, "deg"), "turned by, about z"] = (
        None
    )
    turn: Annotated[
        list[float] | None,
        Vector(-MOST_TURN, MOST_TURN, 3),
        "turned about a vector of this length [degrees]",
    ] = None
    speed: Annotated[
        float | None, real(0, 0, 1e9, "m/s"), "in place of velocity, with direction"
    ] = None
    direction: Annotated[
        float | None,
        number(-MOST_TURN, MOST_TURN, "deg"),
        "of the speed, in the plane of x and y, from the x axis",
    ] = None
    spin: Annotated[
        Components | None,
        InSpace(real(0, -1e12, 1e12, "rad/s").means("spin at the start, counter-clockwise")),
        "angular velocity [rad/s]; in space a vector",
    ] = None
    initial_velocity: Annotated[
        Placed | None, OfPlace(), "of the points of the body [m/s], on top of velocity and spin"
    ] = None
    initial_displacement: Annotated[
        Placed | None, OfPlace(), "of the points of the body [m], which deforms it"
    ] = None

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
        if len(self.layers) > MOST_LAYERS:
            yield "layer", f": {len(self.layers)} of them (accepted: up to {MOST_LAYERS})"
        if not self.rigid:
            for name in [name for name in ("mass", "inertia") if name in self][:1]:
                yield name, ": is of a rigid body (accepted: with rigid = true, or density)"
            return
        for name in [name for name in (*NOT_RIGID, "support", "layer", *FIELDS) if name in self][
            :1
        ]:
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
        needed |= {"law", "nu"} - set(MADE.get(own.get("law", ""), ()))
        return law(**own) if needed <= set(own) else None

    def table(self) -> dict[str, Any]:
        """The table `[[body]]`."""
        return {"shape": self.shape} | super().table()

    # ---- in a scene

    @property
    def own_name(self) -> str:
        """Its name, body2 without one."""
        return self.name or self.entry.replace(".", "")

    @property
    def dimension(self) -> Dimension:
        """The dimension of its scene."""
        return self.context.dimension

    @property
    def supports(self) -> list[Support]:
        """Its supports."""
        return self.support or []

    @property
    def loads(self) -> list[Load]:
        """Its loads."""
        return self.load or []

    def loops(self) -> tuple[Loop, ...]:
        """The loops of its outline in the plane, or of its section to the right of the axis of
        revolution or over it, in the coordinates of the drawing.
        """
        raise NotImplementedError

    def solid(self) -> solids.Shape:
        """Its shape in space, about its centre of volume."""
        raise NotImplementedError

    @cached_property
    def drawn(self) -> tuple[Shape, mesh.Mesh | SolidMesh | None, np.ndarray]:
        """Its outline, the mesh if a file or arrays contain one, and the centre (axes,) [m] of area or
        volume in the coordinates of the drawing. Outline and mesh are about this centre.
        """
        if self.dimension is SOLID:
            return Solid(self.solid(), np.zeros(3), np.eye(3)), None, np.zeros(3)
        loops = self.loops()
        if self.dimension is AXISYMMETRIC and len(loops) == 1:
            outline, centre = revolution.section(loops[0])
            return outline, None, centre
        centre = np.zeros(2) if self.dimension is AXISYMMETRIC else Outline(loops).area_centre
        return Outline(loops).placed(-centre, 0.0), None, centre

    def take_shape_of(self, other: Body) -> None:
        """Takes over what `other` has drawn, if its shape has the same entries: a file is read once."""
        own = type(self).model_fields.keys() - Body.model_fields.keys()
        same = type(self) is type(other) and self.dimension is other.dimension
        if same and all(getattr(self, name) == getattr(other, name) for name in own):
            vars(self)["drawn"] = other.drawn

    @property
    def outline(self) -> Shape:
        """Its outline, or its surface, about its centre and not turned."""
        return self.drawn[0]

    @property
    def file_mesh(self) -> mesh.Mesh | SolidMesh | None:
        """The mesh that a file or arrays contain, about its centre and not turned."""
        return self.drawn[1]

    @property
    def drawn_mesh(self) -> mesh.Mesh | SolidMesh | None:
        """The file_mesh, or the coarse mesh of a geometry that represents its shape."""
        geometry = isinstance(self.outline, Solid) and self.outline.geometry
        return geometry.coarse if geometry else self.file_mesh

    @cached_property
    def start_position(self) -> np.ndarray:
        """The position (axes,) [m] of its centre at the start."""
        return np.array(self.position or [0.0] * self.dimension.axes)

    @cached_property
    def start_angle(self) -> Turn:
        """The angle [rad] at the start, in space a vector."""
        if self.dimension is SOLID:
            about_z = None if self.angle is None else [0.0, 0.0, self.angle]
            return np.radians(about_z or self.turn or [0.0, 0.0, 0.0])
        return math.radians(self.angle or 0.0)

    @cached_property
    def start_spin(self) -> Turn:
        """The angular velocity [rad/s] at the start, in space a vector."""
        return np.array(self.spin or [0.0] * 3) if self.dimension is SOLID else self.spin or 0.0

    @cached_property
    def start_velocity(self) -> np.ndarray:
        """The velocity (axes,) [m/s] at the start, with the mean of the entry initial_velocity."""
        axes = self.dimension.axes
        velocity = np.array(self.velocity or [0.0] * axes)
        if self.speed is not None and self.direction is not None:
            along = [_sin(self.direction + 90), _sin(self.direction), 0.0]
            velocity = self.speed * np.array(along[:axes])
            if self.dimension is AXISYMMETRIC and velocity[0]:
                raise BadInput(
                    f"{self.at('direction')}: {self.direction:g} leads off the axis of revolution (accepted: 90 or -90)"
                )
        return velocity + self._mean_of_field if self._entered_fields else velocity

    @cached_property
    def _entered_fields(self) -> dict[str, Field]:
        axes = self.dimension.axes
        return {
            name: place_functions.of_entry(self.at(name), getattr(self, name), axes)
            for name in FIELDS
            if name in self
        }

    @cached_property
    def _mean_of_field(self) -> np.ndarray:
        """The mean (axes,) [m/s] of the entry initial_velocity, for the estimate of when and how the
        body comes into contact. Raises BadInput if a field of the body is not finite.
        """
        mean = np.zeros(self.dimension.axes)
        low, high = self.box()
        grid = np.meshgrid(*(np.linspace(*ends, MEAN) for ends in zip(low, high)))
        points = np.stack(grid, axis=-1).reshape(-1, len(low))
        points = points[self.placed.gap(points) < 0]
        values = {name: field(points) for name, field in self._entered_fields.items()}
        if "initial_velocity" in values:
            of_revolution = self.dimension is AXISYMMETRIC
            weight = points[:, 0] if of_revolution else np.ones(len(points))
            mean = np.average(values["initial_velocity"], axis=0, weights=weight)
            if of_revolution:
                mean[0] = 0.0
        return mean

    @cached_property
    def fields(self) -> dict[str, Field]:
        """The velocity [m/s] of its points beside start_velocity, and their displacement [m], at the
        start, by the names of the entries.
        """
        fields = dict(self._entered_fields)
        if entered := fields.get("initial_velocity"):
            mean = self._mean_of_field
            rest = Field(entered.entry, lambda places: entered.at(places) - mean)
            fields["initial_velocity"] = rest
        return fields

    @property
    def layers(self) -> list[Layer]:
        """Its layers."""
        return self.layer or []

    @cached_property
    def regions(self) -> Layers:
        """The regions of its layers about its centre: smaller radii and later regions win. Raises
        BadInput if the radius of a layer is not accepted.
        """
        by_place = [(k, layer) for k, layer in enumerate(self.layers, 1) if layer.group is None]
        numbered = sorted(by_place, key=lambda item: -(item[1].radius or -math.inf))
        parts = [self._region(layer) for _, layer in numbered]
        return Layers(parts, [k for k, _ in numbered], self.outline.reach)

    def layers_on(
        self, made: mesh.Mesh | SolidMesh, rotation: np.ndarray
    ) -> tuple[np.ndarray, bool]:
        """The layer (t,) of each cell of a mesh of the body, turned by `rotation`, 0 for none, and
        whether no region cuts a cell. Groups win over regions.
        """
        layers, follows = layers_of_cells(made.points[made.elements] @ rotation, self.regions)
        for k, layer in enumerate(self.layers, 1):
            if layer.group is not None:
                layers[made.cell_groups[layer.group]] = k
        return layers, follows

    def _check_groups(self) -> None:
        """Raises BadInput for a layer by a group that its file does not have, or that has cells of
        another layer's group.
        """
        taken: dict[str, np.ndarray] = {}
        for layer in (layer for layer in self.layers if layer.group is not None):
            name, at = str(layer.group), layer.at("group")
            own, cells = self._cells_of_group(name, at)
            for other, others in taken.items():
                if count := len(np.intersect1d(own, others)):
                    raise BadInput(
                        f"{at}: '{name}' has {count} {cells} of '{other}', which is another layer's (accepted: groups apart)"
                    )
            taken[name] = own

    def _cells_of_group(self, name: str, at: str) -> tuple[np.ndarray, str]:
        """The numbers of the cells of a group of its file in drawn_mesh, and the word for such cells."""
        made = self.drawn_mesh
        if made is None or getattr(self, "file", None) is None:
            raise BadInput(
                f"{at}: '{brief(name)}', but '{self.own_name}' has no file (accepted: radius or where, or shape = 'mesh' with "
                "a file)"
            )
        sides, cells = NAMED[made.elements.shape[1]]
        if name not in made.cell_groups:
            names = ", ".join(made.cell_groups)
            why = (
                f"is a group of {sides}, not of {cells}" if name in made.groups else "is not known"
            )
            hint = suggestion(name, made.cell_groups)
            raise BadInput(f"{at}: '{brief(name)}' {why}{hint} (accepted: {names})")
        return made.cell_groups[name], cells

    def _region(self, layer: Layer) -> Part:
        """The region of a layer about the centre of the body."""
        if layer.radius is None:
            part = layer.part
            if self.dimension is AXISYMMETRIC and not part.is_mirrored(0, np.eye(2)):
                raise BadInput(
                    f"{layer.at('where')}: '{layer.value_text('where')}' is not of revolution (accepted: its own mirror "
                    "image in the axis x = 0)"
                )
            return part
        if not self.rounds:
            raise BadInput(
                f"{layer.at('radius')}: {layer.radius:g}, but '{self.own_name}' is not round (accepted: where)"
            )
        if self.rounds == "centre":
            centre = np.zeros(self.dimension.axes)
            return Part(layer.at("radius"), "", "ball", (centre, np.array(layer.radius)))
        if self.dimension is SOLID:
            axis = np.array([0.0, 1.0, 0.0])
            return Part(layer.at("radius"), "", "cylinder", (axis, np.array(layer.radius)))
        across = np.array([layer.radius, math.inf])
        return Part(layer.at("radius"), "", "box", (-across, across))

    @property
    def radii(self) -> tuple[float, float]:
        """Its inner and outer radius [m], 0 without them."""
        return getattr(self, "inner_radius", 0.0), getattr(self, "radius", 0.0)

    def _check_layers(self) -> None:
        """Raises BadInput for the radius of a layer that is not apart from those of others and of the
        body.
        """
        own = self.radii
        radii = [layer.radius for layer in self.layers if layer.radius is not None]
        for layer in self.layers:
            if layer.radius is None or not self.rounds:
                continue
            others = [radius for radius in radii if radius is not layer.radius]
            apart = min(abs(layer.radius - radius) for radius in (*own, *others))
            if apart < THINNEST or not own[0] < layer.radius < own[1]:
                raise BadInput(
                    f"{layer.at('radius')}: {layer.radius:g} (accepted: between {own[0]:g} and {own[1]:g}, the radii of "
                    f"'{self.own_name}', and {THINNEST:g} m apart from them and from other layers)"
                )
        _ = self.regions
        self._check_groups()

    @cached_property
    def materials(self) -> list[Material]:
        """Its material outside of its layers, and those of its layers."""
        own = self._own_material()
        return [own, *(completed(layer, own) for layer in self.layers)]

    @property
    def made_of(self) -> Material:
        """Its material outside of its layers."""
        return self.materials[0]

    def _own_material(self) -> Material:
        """Its own entries, else those at the top of the scene, else defaults."""
        top = self.context.top
        assert isinstance(top, OfMaterial)
        if not self.rigid:
            return completed(self, top)
        if not self.mass and "density" not in self and "density" not in top:
            raise BadInput(
                f"{self.at('density')}: is missing, here and at the top of the file (accepted: "
                f"{accepted('density')}, or mass)"
            )
        # For a body of revolution with a mass this density is only a scale.
        by_mass = self.mass / self.outline.content if self.mass else None
        return rigid(float(by_mass or self.density or top.density or 0.0))

    def _size(self, name: str) -> float:
        """An element size [m] of the body, else that at the top of the scene; 0 is automatic."""
        own = getattr(self, name)
        if own is None and not self.file_mesh:
            own = getattr(self.context.top, name)
        return float(own or 0.0)

    @property
    def bulk_size(self) -> float:
        """The element size [m] in the bulk; 0 if it is automatic or that of a file."""
        return self._size("mesh_size")

    @property
    def contact_size(self) -> float:
        """The element size [m] where contact may occur; 0 if it is automatic or that of a file."""
        return self._size("contact_mesh_size")

    @property
    def moments(self) -> tuple[float, ...]:
        """The moments of the entry `inertia` of a rigid body, 0 without one, ordered as in
        edp/program/input/conditions.idp.

        In the plane this is the polar moment of inertia. In space the entry holds moments about the
        body's own axes, and the result holds the integrals of rho X_i X_j about the centre, in the
        scene's axes: 11, 22, 33, 12, 23, 13.
        """
        if "inertia" not in self:
            return (0.0,) * 6
        if self.dimension is AXISYMMETRIC:
            raise BadInput(
                f"{self.at('inertia')}: no body of revolution rotates in its scene (accepted: without inertia)"
            )
        if self.dimension is PLANE_STRAIN:
            return (float(np.array(self.inertia)), *(0.0,) * 5)
        about = np.array(self.inertia)
        own = about.sum() / 2 - about
        if not (own > 0).all():
            raise BadInput(
                f"{self.at('inertia')}: '{self.value_text('inertia')}' has one that is no less than the others together "
                f"(accepted: moments about x, y, z of a body that is nowhere flat)"
            )
        turn = tumbling.rotation(np.asarray(self.start_angle))
        E = turn @ np.diag(own) @ turn.T
        return tuple(float(E[pair]) for pair in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)))

    @property
    def touching(self) -> Material:
        """The softest of the materials on its surface, which decides penalty and sizes in contact."""
        if not self.layers:
            return self.made_of
        made = self.drawn_mesh
        if made:
            numbers = self.layers_on(made, np.eye(self.dimension.axes))[0][on_boundary(made)]
        else:
            numbers = self.regions.at(self.outline.points)
        materials: list[Material] = [self.materials[k] for k in np.unique(numbers)]
        return min(materials, key=lambda material: material.young)

    @cached_property
    def mean_density(self) -> float:
        """Its mass over its area or volume [kg/m3], with layers by its mesh or points on a grid: for
        estimates.
        """
        if not self.layers:
            return self.made_of.density
        densities = np.array([material.density for material in self.materials])
        if made := self.drawn_mesh:
            numbers = self.layers_on(made, np.eye(self.dimension.axes))[0]
            weight = contents(made, self.dimension is AXISYMMETRIC)
            return float(np.average(densities[numbers], weights=weight))
        low, high = self.outline.points.min(axis=0), self.outline.points.max(axis=0)
        grid = np.meshgrid(*(np.linspace(*ends, MEAN) for ends in zip(low, high)))
        points = np.stack(grid, axis=-1).reshape(-1, len(low))
        points = points[self.outline.gap(points) < 0]
        weight = abs(points[:, 0]) if self.dimension is AXISYMMETRIC else np.ones(len(points))
        return float(np.average(densities[self.regions.at(points)], weights=weight))

    @property
    def moduli(self) -> tuple[float, float]:
        """lambda + 2 mu and mu [Pa] in a wave across the body."""
        return self.touching.moduli(2 * self.outline.half_thickness)

    @property
    def stiffness(self) -> float:
        """Young's modulus [Pa] in an impact, over two, with the stiffening by damping; infinite for a
        rigid body.
        """
        return math.inf if self.rigid else self.moduli[1] * (1 + self.touching.nu)

    @property
    def wave_speed(self) -> float:
        """The speed c [m/s] of a plane pressure wave, sqrt((lambda + 2 mu)/rho)."""
        return math.sqrt(self.moduli[0] / self.touching.density)

    @property
    def driven(self) -> bool:
        """Whether a support moves the body, or a prescribed stress loads it (a gas does not
        count).
        """
        return any(support.moves for support in self.supports) or any(
            load.kind != "gas" and load.largest > 0 for load in self.loads
        )

    @property
    def inflated(self) -> bool:
        """Whether the given shape is that under the gases in the body."""
        pressed = not self.rigid and any(load.gas_numbers[0] for load in self.loads)
        return pressed and any(load.inflated for load in self.loads)

    @property
    def has_fields(self) -> bool:
        """Whether its points have velocities or displacements of their own at the start."""
        return bool(self.fields)

    @property
    def at_mean_velocity(self) -> Self:
        """The body with the mean velocity of its support on the way to the displacement farthest
        from the start. A body without supports is unchanged.
        """
        ways = [support.path() for support in self.supports]
        if not ways:
            return self
        displacement, when = max(ways, key=lambda path: float(np.linalg.norm(path[0])))
        velocity = displacement / when if when > 0 else np.zeros_like(self.start_velocity)
        still = {"start_velocity": velocity, "start_spin": 0 * self.start_spin}
        return self.model_copy(update=still)

    @property
    def sides(self) -> tuple[np.ndarray, np.ndarray] | None:
        """The boundary edges or faces of a body from a file, None without a file: corners (f, axes,
        axes), about its centre and not turned, and whether each is contact boundary (f,).
        """
        made = self.drawn_mesh
        if not made:
            return None
        outer = made.labels != mesh.AXIS
        return made.points[made.sides[outer]], made.labels[outer] == mesh.FREE

    @property
    def flat_outline(self) -> Outline:
        """The outline of a body in the plane or of revolution."""
        assert isinstance(self.outline, Outline)
        return self.outline

    @property
    def placed(self) -> Shape:
        """The outline at its position at the start."""
        return self.placed_at(0.0, self.start_position)

    def box(self) -> np.ndarray:
        """Two corners (2, axes) [m] of a box that holds the body at the start, of revolution its half
        x >= 0.
        """
        points = self.placed.points
        corners = np.array([points.min(axis=0), points.max(axis=0)])
        corners += np.outer([-1, 1], BESIDE * np.ptp(points, axis=0))
        if self.dimension is AXISYMMETRIC:
            corners[0, 0] = max(corners[0, 0], 0.0)
        return corners

    def placed_at(self, t: float, centre: np.ndarray) -> Shape:
        """Returns the outline with its centre at `centre`, turned as the body is at time t [s] in
        free motion.
        """
        return self.outline.placed(
            centre, self.outline.turned(self.start_angle, self.start_spin, t)
        )

    def check(self) -> None:
        """Raises BadInput if its entries do not agree with each other in the scene."""
        self._check_sizes()
        _ = self.made_of, self.moments
        self._check_layers()
        _ = self.start_velocity
        gathered([support.check for support in self.supports])
        gathered([load.check for load in self.loads])
        refuse_mixed_gases(self.loads)

    def _check_sizes(self) -> None:
        half = self.outline.half_thickness
        if not half >= SHORTEST:
            raise BadInput(
                f"{self.entry}: is {2 * half:.3g} m thick (accepted: from {2 * SHORTEST:g} m)"
            )
        sizes = (self.bulk_size, self.contact_size)
        if 0 < sizes[0] < sizes[1]:
            raise BadInput(
                f"{self.at('contact_mesh_size')}: {sizes[1]:g} is larger than mesh_size {sizes[0]:g}"
            )
        low, high = half * FINEST, 2 * self.outline.coarsest
        for name, size in zip(SIZES, sizes):
            if size and not low <= size <= high * (1 + 1e-9):
                raise BadInput(
                    f"{self.at(name)}: {size:g} does not fit the thickness of '{self.own_name}' (accepted: 0, or from "
                    f"{low:.3g} to {high:.3g})"
                )
        own = [name for name in (*SIZES, "mesh_stretch") if getattr(self, name)]
        if self.file_mesh and own:
            raise BadInput(
                f"{self.at(own[0])}: '{self.value_text(own[0])}' for a mesh from a file, "
                f"which has its own element sizes (accepted: {', '.join(SIZES)} where gmsh makes "
                f"the mesh: of a shape, or of a geometry, {', '.join(GEOMETRIES)})"
            )


class Drawn(Body):
    """A body whose shape is drawn: by vertices or in a file, with an origin of its own."""

    position: Annotated[
        Components | None,
        Place(),
        "of the centre of mass, or with placement = 'as-drawn' of the origin [m]",
    ] = None
    placement: Annotated[
        str | None, Parameter("", "word", None, "-", words=PLACEMENTS), "what `position` places"
    ] = None

    @property
    def is_placed_as_drawn(self) -> bool:
        """Whether `position` is that of the drawing's origin."""
        return self.placement == "as-drawn"

    @cached_property
    def start_position(self) -> np.ndarray:
        position = np.array(self.position or [0.0] * self.dimension.axes)
        return position + self.drawn[2] if self.is_placed_as_drawn else position

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.position is None and not self.is_placed_as_drawn:
            accepted = "that of the centre of mass, or placement = 'as-drawn'"
            yield "position", f": is missing (accepted: {accepted})"


class Hollow(Body):
    """The entries of a body with a wall."""

    radius: Annotated[float, number(), "outer radius"]
    inner_radius: Annotated[float, number(), "inner radius"]

    def refusals(self) -> Iterator[tuple[str, str]]:
        yield from super().refusals()
        if self.inner_radius >= self.radius:
            inner, outer = self.inner_radius, self.radius
            yield "inner_radius", f": {inner:g} is not less than the radius {outer:g}"


def _sin(degrees: float) -> float:
    """The sine of an angle in degrees, exact at multiples of a right angle."""
    return (
        (0.0, 1.0, 0.0, -1.0)[int(degrees // 90) % 4]
        if degrees % 90 == 0
        else math.sin(math.radians(degrees))
    )
