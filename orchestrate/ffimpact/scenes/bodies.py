"""Reads the bodies of a scene from [[body]] tables (docs/how-to/scenes.md): outlines or meshes with
material, position and motion, in SI units.

Shapes and motions come from mesh/flat.py in plane strain, mesh/revolution.py for bodies of
revolution and mesh/solids.py in three dimensions.
"""

import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import ModuleType

import numpy as np

from ..failure import BadInput, gathered
from ..geometry import place_functions, tumbling
from ..geometry.limits import SHORTEST
from ..geometry.outlines import Outline, Shape, Turn
from ..geometry.place_functions import Field
from ..input import bodies, models, parameters
from ..input.bodies import FIELDS
from ..input.conditions import Load, Support, refuse_mixed_gases
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID, Dimension
from ..input.materials import Material
from ..input.parameters import Table, Value
from ..mesh import flat, mesh, revolution, solids
from ..mesh.solid_file import GEOMETRIES
from ..mesh.solid_mesh import SolidMesh
from ..mesh.solids import Solid
from . import material

__all__ = ["Body", "SIZES", "STIFF", "read", "stiffened"]

# Modules with the functions shape() and motion().
GEOMETRY = {PLANE_STRAIN: flat, AXISYMMETRIC: revolution, SOLID: solids}
# `young` of a rigid body over the largest of the others. Its strain is smaller by this factor.
STIFF = 1e5
MEAN = 24  # number of points along an axis from which the mean of a field follows
BESIDE = 0.01  # distance of the box of a body from its sampled points, over its extents
FINEST = 1 / 20000  # smallest element size over the half thickness of a body
SIZES = ("mesh_size", "contact_mesh_size")


@dataclass(frozen=True)
class Body:
    """One body of a scene.

    `outline` and `file_mesh` (of a mesh file, else None) are about the centre of area (or volume) and
    not turned. `start_angle` [rad] is a vector in three dimensions, as is `start_spin` [rad/s]. A mesh size or
    stretch of 0 is automatic, or that of the mesh file.
    """

    own_name: str
    outline: Shape
    file_mesh: mesh.Mesh | SolidMesh | None
    start_position: np.ndarray
    start_angle: Turn
    start_velocity: np.ndarray
    start_spin: Turn
    made_of: Material
    bulk_size: float
    contact_size: float
    mesh_stretch: float
    supports: tuple[Support, ...] = ()
    loads: tuple[Load, ...] = ()
    initial_velocity: Field | None = None
    initial_displacement: Field | None = None
    rigid: bool = False
    mass: float = 0.0  # entry of a rigid body [kg/m; kg]; 0: by density
    # Moments of a rigid body's entry `inertia`, ordered as in edp/program/input/conditions.idp; 0: by
    # density.
    moments: tuple[float, ...] = (0.0,) * 6

    @property
    def moduli(self) -> tuple[float, float]:
        """lambda + 2 mu and mu [Pa] in a wave across the body."""
        return self.made_of.moduli(2 * self.outline.half_thickness)

    @property
    def stiffness(self) -> float:
        """Young's modulus [Pa] in an impact, over two, with the stiffening by damping; infinite for a
        rigid body.
        """
        return math.inf if self.rigid else self.moduli[1] * (1 + self.made_of.nu)

    @property
    def wave_speed(self) -> float:
        """The speed c [m/s] of a plane pressure wave, sqrt((lambda + 2 mu)/rho)."""
        return math.sqrt(self.moduli[0] / self.made_of.density)

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
        return any(getattr(self, name) for name in FIELDS)

    @property
    def at_mean_velocity(self) -> "Body":
        """The body with the mean velocity of its support on the way to the displacement farthest
        from the start. A body without supports is unchanged.
        """
        ways = [support.path() for support in self.supports]
        if not ways:
            return self
        displacement, when = max(ways, key=lambda path: float(np.linalg.norm(path[0])))
        velocity = displacement / when if when > 0 else np.zeros_like(self.start_velocity)
        return replace(self, start_velocity=velocity, start_spin=0 * self.start_spin)

    @property
    def sides(self) -> tuple[np.ndarray, np.ndarray] | None:
        """The boundary edges or faces of a body from a file, None without a file: corners (f, axes,
        axes), about its centre and not turned, and whether each is contact boundary (f,).
        """
        geometry = isinstance(self.outline, Solid) and self.outline.geometry
        file_mesh = geometry.coarse if geometry else self.file_mesh
        if not file_mesh:
            return None
        outer = file_mesh.labels != mesh.AXIS
        corners = file_mesh.faces if isinstance(file_mesh, SolidMesh) else file_mesh.edges
        return file_mesh.points[corners[outer]], file_mesh.labels[outer] == mesh.FREE

    @property
    def section(self) -> Outline:
        """The outline of a body in the plane or of revolution."""
        assert isinstance(self.outline, Outline)
        return self.outline

    @property
    def placed(self) -> Shape:
        """The outline at its position at the start."""
        return self.at(0.0, self.start_position)

    def box(self, dimension: Dimension) -> np.ndarray:
        """Two corners (2, axes) [m] of a box that holds the body at the start, of revolution its half
        x >= 0.
        """
        points = self.placed.points
        corners = np.array([points.min(axis=0), points.max(axis=0)])
        corners += np.outer([-1, 1], BESIDE * np.ptp(points, axis=0))
        if dimension is AXISYMMETRIC:
            corners[0, 0] = max(corners[0, 0], 0.0)
        return corners

    def at(self, t: float, centre: np.ndarray) -> Shape:
        """Returns the outline with its centre at `centre`, turned as the body is at time t [s] in
        free motion.
        """
        return self.outline.placed(
            centre, self.outline.turned(self.start_angle, self.start_spin, t)
        )


def read(
    tables: list[bodies.Body], top: models.Top, folder: Path, dimension: Dimension
) -> list[Body]:
    """Returns the bodies of the [[body]] tables. `top` holds the entries at the top of the file;
    paths of mesh files are relative to `folder`.
    """
    return gathered([partial(_body, table, top, folder, dimension) for table in tables])


def _body(table: bodies.Body, top: models.Top, folder: Path, dimension: Dimension) -> Body:
    geometry: ModuleType = GEOMETRY[dimension]
    outline, body_mesh, drawn_centre = geometry.shape(table, folder)
    if not outline.half_thickness >= SHORTEST:
        raise BadInput(
            f"{table.entry}: is {2 * outline.half_thickness:.3g} m thick (accepted: from {2 * SHORTEST:g} m)"
        )
    bulk, contact = _sizes(table, None if body_mesh else top)
    for key, size in zip(SIZES, (bulk, contact)):
        _refuse_size(table.at(key), size, outline, table.name or table.entry)
    if body_mesh and (sizes := [key for key in (*SIZES, "mesh_stretch") if getattr(table, key)]):
        raise BadInput(
            f"{table.at(sizes[0])}: '{table.value_text(sizes[0])}' for a mesh from a file, "
            f"which has its own element sizes (accepted: {', '.join(SIZES)} where gmsh makes "
            f"the mesh: of a shape, or of a geometry, {', '.join(GEOMETRIES)})"
        )
    made_of = (
        _rigid(table, top, dimension, outline)
        if table.rigid
        else {"made_of": material.read(table, top)}
    )
    supports, loads = tuple(table.support or []), tuple(table.load or [])
    gathered([support.check for support in supports])
    gathered([load.check for load in loads])
    refuse_mixed_gases(loads)
    motion = geometry.motion(table)
    if isinstance(table, bodies.Drawn) and table.is_placed_as_drawn:
        motion["start_position"] = motion["start_position"] + drawn_centre
    motion |= {
        name: place_functions.of_entry(table.at(name), getattr(table, name), dimension.axes)
        for name in FIELDS
        if name in table
    }
    body = Body(
        table.name or table.entry.replace(".", ""),
        outline,
        body_mesh,
        **motion,
        **made_of,
        bulk_size=bulk,
        contact_size=contact,
        mesh_stretch=table.mesh_stretch or 0.0,
        supports=supports,
        loads=loads,
    )
    return _with_mean(body, dimension) if body.has_fields else body


def _with_mean(body: Body, dimension: Dimension) -> Body:
    """Returns the body with the mean of its field of velocity in its velocity, for the estimate of
    when and how it comes into contact. Raises BadInput if one of its fields is not finite.
    """
    low, high = body.box(dimension)
    grid = np.meshgrid(*(np.linspace(*ends, MEAN) for ends in zip(low, high)))
    points = np.stack(grid, axis=-1).reshape(-1, len(low))
    points = points[body.placed.gap(points) < 0]
    if body.initial_displacement:
        body.initial_displacement(points)
    if not (field := body.initial_velocity):
        return body
    weight = points[:, 0] if dimension is AXISYMMETRIC else np.ones(len(points))
    mean = np.average(field(points), axis=0, weights=weight)
    if dimension is AXISYMMETRIC:
        mean[0] = 0.0
    rest = Field(field.entry, lambda places: field.at(places) - mean)
    return replace(body, start_velocity=body.start_velocity + mean, initial_velocity=rest)


def _rigid(table: bodies.Body, top: models.Top, dimension: Dimension, outline: Shape) -> Table:
    """Returns the material, mass and moments of a rigid body."""
    mass = table.mass or 0.0
    if not mass and "density" not in table and "density" not in top:
        raise BadInput(
            f"{table.at('density')}: is missing, here and at the top of the file (accepted: "
            f"{parameters.PARAMETERS['density'].accepted}, or mass)"
        )
    # For a body of revolution with a mass this density is only a scale.
    density = mass / outline.content if mass else table.density or top.density or 0.0
    return {
        "made_of": material.rigid(float(density)),
        "rigid": True,
        "mass": mass,
        "moments": _moments(table, dimension),
    }


def _moments(table: bodies.Body, dimension: Dimension) -> tuple[float, ...]:
    """Returns the moments of the entry `inertia`, 0 where there is no such entry.

    In the plane this is the polar moment of inertia. In space the entry holds moments about the
    body's own axes, and the result holds the integrals of rho X_i X_j about the centre, in the
    scene's axes: 11, 22, 33, 12, 23, 13.
    """
    if "inertia" not in table:
        return (0.0,) * 6
    if dimension is AXISYMMETRIC:
        raise BadInput(
            f"{table.at('inertia')}: no body of revolution turns in its scene (accepted: without inertia)"
        )
    if dimension is PLANE_STRAIN:
        return (float(np.array(table.inertia)), *(0.0,) * 5)
    about = np.array(table.inertia)
    own = about.sum() / 2 - about
    if not (own > 0).all():
        raise BadInput(
            f"{table.at('inertia')}: '{table.value_text('inertia')}' has one that is no less than the others together "
            f"(accepted: moments about x, y, z of a body that is nowhere flat)"
        )
    turn = tumbling.rotation(solids.motion(table)["start_angle"])
    E = turn @ np.diag(own) @ turn.T
    return (
        float(E[0, 0]),
        float(E[1, 1]),
        float(E[2, 2]),
        float(E[0, 1]),
        float(E[1, 2]),
        float(E[0, 2]),
    )


def stiffened(bodies: list[Body], penalties: list[Value], path: str) -> list[Body]:
    """Returns the bodies of a scene with `young` of the rigid ones.

    It is STIFF times the largest `young` of the other bodies. If all bodies are rigid it is STIFF
    times the largest of the `penalties` times the largest half thickness. Raises BadInput if one of
    the penalties is automatic then.
    """
    if not any(body.rigid for body in bodies):
        return bodies
    soft = max((body.made_of.young for body in bodies if not body.rigid), default=0.0)
    if not soft and "auto" in penalties:
        raise BadInput(
            f"{path}: 'auto' follows from a body that deforms, and all are rigid (accepted: a number, Pa/m^m)"
        )
    half = max(body.outline.half_thickness for body in bodies)
    young = STIFF * (soft or max(float(penalty) for penalty in penalties) * half)
    return [
        replace(body, made_of=body.made_of.model_copy(update={"young": young}))
        if body.rigid
        else body
        for body in bodies
    ]


def _refuse_size(path: str, size: float, outline: Shape, name: str) -> None:
    """Raises BadInput if an element size [m] does not fit a body; 0 is automatic."""
    low, high = outline.half_thickness * FINEST, 2 * outline.coarsest
    if size and not low <= size <= high * (1 + 1e-9):
        raise BadInput(
            f"{path}: {size:g} does not fit the thickness of '{name}' (accepted: 0, or from "
            f"{low:.3g} to {high:.3g})"
        )


def _sizes(table: bodies.Body, top: models.Top | None) -> tuple[float, float]:
    """Returns the element sizes [m] in the bulk and where contact may occur: those of the body,
    else those at the `top`. 0 is automatic.
    """
    own = [getattr(table, key) for key in SIZES]
    common = [getattr(top, key) if top else None for key in SIZES]
    bulk, contact = (
        float(size if size is not None else other or 0.0) for size, other in zip(own, common)
    )
    if 0 < bulk < contact:
        raise BadInput(
            f"{table.at('contact_mesh_size')}: {contact:g} is larger than mesh_size {bulk:g}"
        )
    return float(bulk), float(contact)
