"""Prepares a scene of bodies for FreeFEM: one mesh of all bodies, apart from each other, and the
file scene.bin of all that FreeFEM takes.

Region k of the mesh is body k, from 0. Its edges have the label 1 where contact may occur, and
another label where the mesh file excludes contact or nothing can reach them. The bodies stand side
by side along x, not turned, each about its own centre of area; scene.bin holds their displacements
to the start. For bodies of revolution the mesh is the half x >= 0 of their sections, one above the
other, with the label 2 on the axis. So it is for bodies in the plane that are reduced by symmetry.
"""

from __future__ import annotations

import hashlib
import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import progress
from ..failure import BadInput
from ..freefem.arrays import Entries, packed
from ..geometry.outlines import Loop, TubeOutline, rotation
from ..input.bodies import Body
from ..input.contact import OWN, Pair
from ..input.damping import flat, refuse_uneven
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID
from ..input.layers import Layer
from ..input.materials import Material
from ..input.parameters import NOT_DECISIVE, Table, Value
from ..input.toml_text import to_toml
from ..mesh import mesh, revolution, solid_mesh, solids
from ..mesh.layers import circles_between, longest, surfaces_between, with_interfaces
from ..mesh.mesh import AXIS, FREE, Curve, Sizes, mesh_body, nearest
from ..mesh.solids import Solid
from .approach import (
    Onset,
    loaded_pull,
    onsets_of,
    refuse_nothing,
    refuse_sinking,
    with_discs_aligned,
)
from .arrays import Arc, mesh_arrays, padded, parameter_arrays, scene_arrays
from .front import Front, fronts, stretch_of
from .mirror import COPIES, copies, mirror_axes
from .needs import IMPLICIT, implicit_for
from .pairs import STIFF
from .parts import conditions
from .sizes import Impact
from .start_fields import start_fields
from .unstressed import find_unstressed

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = [
    "AutomaticValues",
    "Assembly",
    "SCENE_FILE",
    "assemble",
    "boundary_curves",
    "contact_values",
    "element_sizes",
    "pair_values",
    "prepare",
    "place_apart",
    "stack",
    "used_tables",
    "with_open_penalties",
]

SCENE_FILE = "scene.bin"
# First words of the arrays in which a run up to a later end_time differs, and of those that the
# integrator which `auto` has taken makes superfluous. A checkpoint does not depend on them.
OF_END = ("end_time", "functions", "knots", "kinks", "integrator", "implicit_why")
ROUND = 0.5  # largest element size on a circle or ellipse, over its smaller semi-axis
# Width of an outline near contact, over that of a disc on a plane, below which elements are
# smaller. Two equal discs have 0.71.
NARROW = 0.6
# Largest half-width of a contact over the radius of the obstacle; the same as over that of a disc
# on a plane (sizes.py).
POINTED = 0.5
UNLIMITED = 1e-3  # accuracy for which no element of the rule has a limited size
RESOLVED = 0.5  # largest element in a contact over its half-width
ASIDE = 0.02  # distance from a corner of an obstacle that counts as on it, over the pair's radius
SMALLEST = 1e-3  # smallest element in a contact over the pair's radius
# Accuracies for which elements at a layer are as long as it is thick, in space as long as
# solid_mesh.py allows. Errors are quadratic in them.
LAYERED = {PLANE_STRAIN: 0.02, AXISYMMETRIC: 0.02, SOLID: 0.06}
BETWEEN = 0.2  # distance of bodies in the mesh over their largest extent


@dataclass(frozen=True)
class Assembly:
    """A scene as prepared for FreeFEM.

    - `mesh`: of all bodies; `regions` (t,) are the numbers of the bodies in it.
    - `centres`: centres of area of the bodies in the mesh (bodies, axes) [m].
    - `arrays`: what FreeFEM takes, by name (arrays.py).
    - `values`: all parameters of run and contact, none of them automatic.
    - `used`: the tables of the scene with these values. Read again, they give the same assembly.
    """

    mesh: mesh.Mesh | solid_mesh.SolidMesh
    regions: np.ndarray
    centres: np.ndarray
    arrays: Entries
    values: dict[str, Value]
    used: Table

    @property
    def data(self) -> bytes:
        """The bytes of scene.bin."""
        return packed(self.arrays)

    def write(self, folder: Path) -> None:
        """Writes scene.bin, which FreeFEM takes, and for later use mesh.msh, in three dimensions
        mesh.mesh.
        """
        if isinstance(self.mesh, solid_mesh.SolidMesh):
            solid_mesh.write(self.mesh, self.regions, folder / "mesh.mesh")
        else:
            mesh.write(self.mesh, folder / "mesh.msh", self.regions)
        (folder / SCENE_FILE).write_bytes(self.data)


def prepare(
    scene: Scene, where: Path, longer: Scene | None = None
) -> tuple[dict[str, Path], Table, str]:
    """Prepares a run in the folder `where`: writes the mesh and the data file of a scene. Returns the
    flags of the run, the scene as used, and the text of its scene.toml. Raises BadInput for a scene
    that cannot be run. `longer` is the scene with a later end_time, for a run that goes on from the
    end of the one of `scene`, on its mesh.
    """
    if (
        len(scene.bodies) == 1
        and not scene.obstacles
        and not (scene.bodies[0].supports or scene.bodies[0].loads)
        and scene.values["end_time"] == 0
    ):
        raise BadInput(
            "obstacle: is missing, and a second body too (accepted: one table [[obstacle]] or more, several "
            "[[body]], or an end_time > 0)"
        )
    scene = with_discs_aligned(scene)
    onsets = onsets_of(scene)
    scene.refuse_rest()
    refuse_nothing(scene, onsets)
    refuse_sinking(scene, onsets)
    built = assemble(scene, onsets=onsets, longer=longer)
    built.write(where)
    text = to_toml(scene.with_files_in(where, built.used))
    flags = {"scene": where / SCENE_FILE}
    if any(body.inflated for body in scene.bodies) and not (where / "checkpoint").exists():
        find_unstressed(scene, flags, where)
    return flags, tomllib.loads(text), text


def assemble(
    scene: Scene, onsets: list[Onset] | None = None, longer: Scene | None = None
) -> Assembly:
    """Meshes the bodies of a scene and collects the data of a run. `onsets` holds the onsets of
    contact if they are known already; `longer`: prepare().
    """
    auto = AutomaticValues(scene, onsets_of(scene) if onsets is None else onsets)
    why = implicit_for(scene) if scene.values["integrator"] == "auto" else ""
    scene = scene.replaced(
        bodies=[_with_loss(k, auto) for k in range(len(scene.bodies))],
        values=scene.values | ({"integrator": IMPLICIT} if why else {}),
    )
    auto = replace(auto, scene=scene)
    values = scene.values | contact_values(scene.bodies, scene.contact_values, auto, "contact")
    moving = longer or scene  # whose functions of time last until end_time
    values["end_time"] = moving.values["end_time"]
    scene = scene.replaced(pairs=with_open_penalties(scene, auto))
    pairs = [pair_values(pair, auto, values) for pair in scene.pairs]
    with progress.work("choosing element sizes"):
        sizes = [
            None if body.file_mesh else element_sizes(k, auto)
            for k, body in enumerate(scene.bodies)
        ]
    with progress.work("meshing the bodies"):
        meshes, centres, arcs = (_solids if scene.kind is SOLID else _sections)(scene, sizes)
    together, regions = stack(meshes, centres)
    files = [k for k, body in enumerate(scene.bodies) if body.file_mesh or "file" in body]
    penalties = {
        (pair.first, pair.second): float(own["penalty"]) for pair, own in zip(scene.pairs, pairs)
    }
    penalty, exponent = float(values["penalty"]), float(values["exponent"])
    rises = [
        strike.rise_on(penalties.get(both, penalty), scene.bodies, exponent)
        for both, strike in auto.fronts.items()
    ]
    deformable = [k for k, body in enumerate(scene.bodies) if not body.rigid]
    first = np.cumsum([0, *(len(body.materials) for body in scene.bodies)])
    on_mesh = mesh_arrays(together, regions, first[regions] + together.layer_of, arcs, files)
    arrays: Entries = (
        {
            "implicit_why": why,
            "relaxed_step": min(
                _disc_of(k, auto, material).relaxed_step
                for k in deformable
                for material in scene.bodies[k].materials
            )
            if deformable
            else 1e300,
            "front_transit": float(min((strike.tau for strike in auto.fronts.values()), default=0)),
            "front_rise": float(max(rises, default=0)),
        }
        | parameter_arrays(values)
        | scene_arrays(scene, centres, pairs)
        | on_mesh
        | start_fields(scene, together, regions, centres, arcs, on_mesh["mesh.arc_of"])
        | conditions(moving.bodies, meshes, moving.obstacles, scene.kind, copies(scene))
    )
    decisive = {
        name: value
        for name, value in arrays.items()
        if name not in NOT_DECISIVE and not name.startswith(OF_END)
    }
    arrays["identity"] = hashlib.sha256(packed(decisive)).hexdigest()
    return Assembly(
        together, regions, centres, arrays, values, used_tables(scene, sizes, values, pairs)
    )


def _sections(
    scene: Scene, sizes: list[Sizes | None]
) -> tuple[list[mesh.Mesh], np.ndarray, list[Arc]]:
    """Returns the meshes of bodies in the plane, their centres in the common mesh (bodies, axes)
    [m], and the circles in it. For bodies of revolution circles that are the mirror image of
    another one are left out.
    """
    meshes = []
    for k, (body, size) in enumerate(zip(scene.bodies, sizes)):
        made = body.file_mesh
        if size:
            made = _meshed(scene, k, size)
        assert isinstance(made, mesh.Mesh)
        meshes.append(_reached(scene, k, _with_layers(body, made, np.eye(2))))
    halved = bool(mirror_axes(scene.kind, copies(scene)))
    centres = place_apart(meshes, 1 if halved else 0)
    circles = [
        Arc(k, padded(centre + at), np.zeros(3), float(radius))
        for k, (body, centre) in enumerate(zip(scene.bodies, centres))
        for loop in body.flat_outline.loops
        for at, radius in loop.circles
        if not halved or at[0] >= 0
    ]
    circles += [
        Arc(k, padded(centre + at), np.zeros(3), radius)
        for k, (body, made, centre) in enumerate(zip(scene.bodies, meshes, centres))
        for at, radius in (circles_between(made) if body.file_mesh else body.regions.circles)
    ]
    return meshes, centres, circles


def _solids(
    scene: Scene, sizes: list[Sizes | None]
) -> tuple[list[solid_mesh.SolidMesh], np.ndarray, list[Arc]]:
    """Returns the same in three dimensions: bodies turned as at the start, one above the other,
    reduced by symmetry; spheres, then cylinders.
    """
    normals = mirror_axes(SOLID, copies(scene))
    accuracy, degree = scene.number("accuracy"), int(scene.number("degree"))
    meshes = []
    for body, size in zip(scene.bodies, sizes):
        solid, made = body.placed_at(0.0, np.zeros(3)), body.file_mesh
        assert isinstance(solid, Solid) and (made is None or isinstance(made, solid_mesh.SolidMesh))
        parts = body.regions.parts if body.layers else ()
        made = solids.mesh_of(body.own_name, solid, made, size, normals, accuracy, parts)
        made = _with_layers(body, made, solid.rotation)
        between = surfaces_between(made) if body.drawn_mesh else ()
        meshes.append(replace(made, curved=(*made.curved, *between)))
    meshes = [_reached(scene, k, made) for k, made in enumerate(meshes)]
    count = sum(
        0 if body.rigid else solid_mesh.unknowns(made.cells, degree)
        for body, made in zip(scene.bodies, meshes)
    )
    largest = solid_mesh.most_unknowns(explicit=scene.values["integrator"] == "central-difference")
    if count > largest:
        raise BadInput(
            f"mesh_size: the bodies have {count} unknowns (accepted: up to {largest}; larger mesh_size, "
            f"contact_mesh_size or accuracy, coarser files, degree = 1)"
        )
    rigid = sum(len(made.cells) for body, made in zip(scene.bodies, meshes) if body.rigid)
    if rigid > solid_mesh.MOST_RIGID_CELLS:
        raise BadInput(
            f"contact_mesh_size: the rigid bodies have {rigid} tetrahedra (accepted: up to "
            f"{solid_mesh.MOST_RIGID_CELLS}; a larger contact_mesh_size or accuracy, or a smaller penalty, whose contacts are wider)"
        )
    centres = place_apart(meshes, 1)
    surfaces = [
        Arc(k, centre + patch.centre, _unit(patch.axis), float(patch.radius))
        for k, (made, centre) in enumerate(zip(meshes, centres))
        for patch in made.curved
    ]
    return meshes, centres, sorted(surfaces, key=lambda arc: arc.axis.any())


def _unit(axis: np.ndarray) -> np.ndarray:
    """The unit vector (3,) of an axis, 0 if there is none."""
    return axis / np.linalg.norm(axis) if len(axis) else np.zeros(3)


# ---- automatic values


@dataclass(frozen=True)
class AutomaticValues:
    """Makes a disc (ball) that hits a plane as the scene's bodies hit each other, with their largest
    speeds and accelerations along and across the normal. Its automatic values are those of the scene.
    """

    scene: Scene
    onsets: list[Onset]

    @cached_property
    def fronts(self) -> dict[tuple[int, int], Front]:
        """The flat strikes by contact pair. If a pair has several, the one with the smallest
        elements.
        """
        strikes = sorted(fronts(self.scene, self.onsets), key=lambda front: -front.tau)
        return {(front.onset.first, front.onset.second): front for front in strikes}

    def open_front(self, pair: Pair) -> Front | None:
        """Returns the front of a pair that strikes flat and whose penalty is automatic, else
        None.
        """
        is_open = pair.own.get("penalty", self.scene.contact_values["penalty"]) == "auto"
        return self.fronts.get((pair.first, pair.second)) if is_open else None

    def small(self, first: int, second: int) -> float:
        """Returns the radius [m] of an obstacle at the first contact with a body, 0 at a sharp
        corner. It is infinite if the radius is not below half the radius of the pair.
        """
        onset = self.first_onsets.get((first, second))
        if second >= 0 or onset is None:
            return math.inf
        points, obstacle = onset.shape(first).points, self.scene.obstacles[-1 - second]
        radius = obstacle.radius_at(points[obstacle.gap(points).argmin()], ASIDE * onset.radius)
        return radius if radius < onset.radius / 2 else math.inf

    @cached_property
    def first_onsets(self) -> dict[tuple[int, int], Onset]:
        """The first onset of contact of each pair that may come into contact."""
        return {
            (onset.first, onset.second): onset for onset in reversed(self.onsets) if not onset.never
        }

    @cached_property
    def largest(self) -> tuple[float, ...]:
        """The largest closing and sliding speed [m/s], and the largest acceleration along and
        across the normal [m/s2]. Round-off is removed, because a mesh changes with every digit.
        """
        return tuple(
            float(f"{max((getattr(onset, name) for onset in self.onsets), default=0.0):.6g}")
            for name in ("closing", "sliding", "pressing", "pulling")
        )

    @cached_property
    def pressed(self) -> float:
        """The closing speed [m/s] of impacts with as wide a contact as moving supports make."""
        return float(f"{max((onset.pressed for onset in self.onsets), default=0.0):.6g}")

    def of_disc(
        self,
        bodies: list[Body],
        radius: float,
        slides: bool = False,
        presses: bool = True,
        **more: Any,
    ) -> Impact:
        """Returns the impact of a disc, or a ball, of this radius [m] with the material of the softest
        body, and the entries `more`.

        It moves along the normal, or also across it if it `slides`. If it `presses`, it makes as
        wide a contact as moving supports do.
        """
        along, across, pressing, pulling = self.largest
        along = max(along, self.pressed) if presses else along
        pressing = pressing if self.onsets else max(loaded_pull(body) for body in self.scene.bodies)
        soft = min(bodies, key=lambda body: body.stiffness)
        scene = self.scene
        impact = Impact(
            sphere=scene.kind is not PLANE_STRAIN,
            radius=radius,
            young=soft.touching.young / (STIFF if soft.rigid else 1),
            nu=soft.touching.nu,
            density=soft.touching.density,
            damping=soft.touching.damping,
            hardness=min(body.touching.hardness for body in bodies),
            closing=along,
            pressing=pressing,
            exponent=scene.number("exponent"),
            accuracy=scene.number("accuracy"),
            accuracy_of=str(scene.values["accuracy_of"]),
            end_time=scene.number("end_time"),
            endless=scene.values["until"] == "rest",
        )
        if slides:
            spin = max(float(np.linalg.norm(body.start_spin)) for body in bodies)
            impact = replace(impact, sliding=across, spin=spin, pulling=pulling)
        return replace(impact, **more)


def contact_values(
    bodies: list[Body],
    contact: dict[str, Value],
    auto: AutomaticValues,
    path: str,
    least: float = math.inf,
) -> dict[str, Value]:
    """Returns `contact` with numbers for penalty, friction_dynamic and slip_velocity, for the
    softest of the bodies and the smallest radius. `least` [m] is the radius of an obstacle.
    """
    radius = min([least, *(body.outline.half_thickness for body in bodies)])
    sizes = [body.contact_size for body in bodies]
    more: Table = {"given_contact_size": min(*sizes, radius)} if min(sizes) > 0 else {}
    values = dict(contact)
    if automatic := [name for name in ("penalty", "slip_velocity") if contact[name] == "auto"]:
        more |= {"exponent": contact["exponent"]}
        disc = auto.of_disc(bodies, radius, slides=True, **more)
        values |= {name: getattr(disc, name) for name in automatic}
        # The slow motion of a support slips slowly, even if it makes a wide contact.
        if "slip_velocity" in automatic and auto.pressed > 0:
            slow = auto.of_disc(bodies, radius, slides=True, presses=False, **more)
            values["slip_velocity"] = slow.slip_velocity
    if contact["friction_dynamic"] == "auto":
        values["friction_dynamic"] = contact["friction_static"]
    return values


def pair_values(pair: Pair, auto: AutomaticValues, values: dict[str, Value]) -> dict[str, Value]:
    """Returns all contact parameters of a pair. A parameter that the pair does not set has the
    value of the scene; it is automatic again if it depends on one that the pair sets.
    """
    bodies = [auto.scene.bodies[k] for k in (pair.first, pair.second) if k >= 0]
    alone = "friction_static" in pair.own  # then it sets both coefficients
    inherited = {name: values[name] for name in auto.scene.contact_values}
    inherited["friction_dynamic"] = (
        "auto" if alone else auto.scene.contact_values["friction_dynamic"]
    )
    small = auto.small(pair.first, pair.second)
    if 0 < small < math.inf:
        inherited["penalty"] = auto.scene.contact_values["penalty"]
    own = inherited | pair.own
    if front := auto.open_front(pair):
        own["penalty"] = front.penalty(auto.scene.bodies, auto.scene.number("exponent"))
    own = contact_values(bodies, own, auto, pair.entry, small or math.inf)
    return {name: own[name] for name in OWN}


def with_open_penalties(scene: Scene, auto: AutomaticValues) -> list[Pair]:
    """Returns the pairs of the scene, and those whose automatic penalty differs: flat strikes, and
    a body with an obstacle that is smaller than the contact of the body on a plane.
    """
    listed = {(pair.first, pair.second) for pair in scene.pairs}
    small = [
        (onset.first, onset.second)
        for onset in auto.onsets
        if 0 < auto.small(onset.first, onset.second) < math.inf
    ]
    differ = (
        dict.fromkeys([*small, *auto.fronts]) if scene.contact_values["penalty"] == "auto" else {}
    )
    pairs = scene.pairs + [
        Pair.between(*both, f"obstacle.{-both[1]}" if both[1] < 0 else "contact", {})
        for both in differ
        if both not in listed
    ]
    return sorted(pairs, key=lambda pair: (pair.first, pair.second))


def used_tables(
    scene: Scene, sizes: list[Sizes | None], values: dict[str, Value], pairs: list[dict[str, Value]]
) -> Table:
    """Returns the tables of a scene with all values as used. Contact parameters of obstacles become
    tables [[contact.pair]].
    """

    def names(pair: Pair) -> list[str]:
        return [
            (scene.bodies[k] if k >= 0 else scene.obstacles[-1 - k]).own_name
            for k in (pair.first, pair.second)
        ]

    bodies = []
    for body_table, body, size in zip(scene.content["body"], scene.bodies, sizes):
        used = {"name": body.own_name} | body_table | ({} if body.rigid else body.made_of.table())
        used |= {"density": body.made_of.density} if body.rigid and not body.mass else {}
        if body.layers:
            layers = zip(body.layers, body.materials[1:])
            used["layer"] = [layer.table() | material.table() for layer, material in layers]
        used |= {"mesh_size": size.bulk, "contact_mesh_size": size.contact} if size else {}
        used |= {"mesh_stretch": size.stretch} if size and size.stretch > 1 else {}
        used |= (
            {"file": str((scene.folder / body_table["file"]).resolve())}
            if "file" in body_table
            else {}
        )
        bodies.append(used)
    obstacles = [
        {"name": obstacle.own_name, "kind": obstacle.kind}
        | obstacle.defaults()
        | {key: value for key, value in table.items() if key not in OWN}
        for table, obstacle in zip(scene.content.get("obstacle", []), scene.obstacles)
    ]
    contact: Table = {key: values[key] for key in scene.contact_values}
    if scene.contact.friction:
        kept = {key: contact[key] for key in contact if not key.startswith("friction_")}
        contact = {"friction": scene.contact.friction, **kept}
        contact["friction_transition"] = values["friction_transition"]
    contact |= {"self_contact": scene.contact.self_contact or "auto"}
    of_expression = ("friction_static", "friction_dynamic") if scene.contact.friction else ()
    contact |= {
        "pair": [
            {"bodies": names(pair)}
            | {key: own[key] for key in own if key not in of_expression or key in pair.own}
            for pair, own in zip(scene.pairs, pairs)
        ]
    }
    top = {
        "title": scene.title or scene.name,
        "script": scene.kind.script,
        "dimension": scene.kind.name,
    }
    if scene.kind is not AXISYMMETRIC:
        top["symmetry"] = next(word for word, count in COPIES.items() if count == copies(scene))
    return (
        top
        | {key: values[key] for key in scene.values}
        | {"body": bodies, "obstacle": obstacles, "contact": contact}
    )


def _disc_like(k: int, auto: AutomaticValues, **more: Any) -> Impact:
    """Returns the impact of a disc or ball as thick as body k."""
    body = auto.scene.bodies[k]
    return auto.of_disc([body], body.outline.half_thickness, **more)


def _disc_of(k: int, auto: AutomaticValues, material: Material) -> Impact:
    """Returns the same of a material of body k."""
    return replace(
        _disc_like(k, auto),
        young=material.young,
        nu=material.nu,
        density=material.density,
        damping=material.damping,
    )


def _with_loss(k: int, auto: AutomaticValues) -> Body:
    """Returns body k with the viscosity, or the loss_range, that the loss factor of each of its
    materials sets.
    """
    body = auto.scene.bodies[k]
    if not any(material.loss for material in body.materials):
        return body
    holders: list[Body | Layer] = [body, *body.layers]
    made = [_of_loss(k, auto, *item) for item in zip(holders, body.materials)]
    return body.model_copy(update={"materials": made})


def _of_loss(k: int, auto: AutomaticValues, holder: Body | Layer, material: Material) -> Material:
    """Returns a material of body k with what its loss factor sets. Raises BadInput if it has another
    viscosity, or if no branches have a loss as flat.
    """
    if not material.loss:
        return material
    impact = _disc_of(k, auto, material)
    if material.loss_model == "flat":
        between = material.loss_range or impact.loss_range
        refuse_uneven(holder.at("loss"), flat(material.loss, *between))
        return material.model_copy(update={"loss_range": between})
    viscosity = impact.viscosity(material.loss)
    if material.viscosity and not math.isclose(material.viscosity, viscosity):
        name = auto.scene.bodies[k].own_name
        raise BadInput(
            f"{holder.at('loss')}: {material.loss:g} asks for viscosity {viscosity:g} Pa s of '{name}', which "
            f"is {material.viscosity:g} (accepted: one of the two)"
        )
    return material.model_copy(update={"viscosity": viscosity})


def element_sizes(k: int, auto: AutomaticValues) -> Sizes:
    """Returns the element sizes of body k: in the bulk for its own thickness, near contacts for
    each contact pair.
    """
    body = auto.scene.bodies[k]
    bulk = body.bulk_size or _bulk(k, auto)
    hits = [
        _hit(body, k, onset, auto)
        for onset in auto.onsets
        if k in (onset.first, onset.second) and not onset.shielded
    ]
    mine = [front for front in auto.fronts.values() if k in front.sizes]
    if body.rigid and not body.bulk_size:
        bulk = _bulk_of_rigid(body, min((size for size, *_ in hits), default=math.inf))
    if not body.bulk_size:
        bulk = min((front.sizes[k] for front in mine if k in front.crossed), default=bulk)
    plane = stretch_of(k, mine, bulk)
    if plane > 1:  # a plane front presses evenly: the bulk resolves its pressure
        hits = []
    stretch = body.mesh_stretch or plane
    along = _first_normal(k, auto) if stretch > 1 else None
    contact = body.contact_size or min(
        [bulk, *(size / stretch for size, *_ in hits), *(front.sizes[k] for front in mine)]
    )
    near = np.vstack([np.empty((0, auto.scene.kind.axes)), *(points for _, points, _ in hits)])
    slack = max([0.0, *(slack for *_, slack in hits)])
    thick = math.sqrt(auto.scene.number("accuracy") / LAYERED[auto.scene.kind])
    return Sizes(bulk, min(bulk, contact), near, slack, along, stretch, thick)


def _bulk(k: int, auto: AutomaticValues) -> float:
    """Returns the element size [m] in the bulk of body k that the accuracy requires. Errors are
    quadratic in it. The rule is asked at an accuracy where it does not limit the size.
    """
    body = auto.scene.bodies[k]
    looser = auto.scene.number("accuracy") / UNLIMITED / _share(k, auto)
    required = _disc_like(k, auto, accuracy=UNLIMITED).mesh_size * math.sqrt(looser)
    return max(min(required, body.outline.coarsest), body.contact_size)


def _share(k: int, auto: AutomaticValues) -> float:
    """Returns the error by the elements in the bulk of body k, over that of the softest body it may
    come into contact with, 1 at most.

    A stiffer body deforms less by the ratio of the moduli, but by the cube of its slenderness more
    where it bends. Loads deform a body by themselves.
    """
    body = auto.scene.bodies[k]
    if body.rigid or body.loads:
        return 1.0
    softer = [_softer(k, o, auto) for o in auto.onsets if k in (o.first, o.second) and not o.never]
    slender = float(body.outline.extent.max()) / (2 * body.outline.half_thickness)
    return min(1.0, max(softer, default=1.0) * max(1.0, slender) ** 3)


def _softer(k: int, onset: Onset, auto: AutomaticValues) -> float:
    """Returns the stiffness of the softest body in a contact pair over that of its body k."""
    bodies = [auto.scene.bodies[j] for j in (onset.first, onset.second) if j >= 0]
    return min(body.stiffness for body in bodies) / auto.scene.bodies[k].stiffness


def _first_normal(k: int, auto: AutomaticValues) -> np.ndarray:
    """Returns the normal of the first contact of body k, in its own axes. Raises BadInput if there is
    no contact.
    """
    body = auto.scene.bodies[k]
    onsets = [onset for onset in auto.onsets if k in (onset.first, onset.second)]
    if not onsets:
        raise BadInput(
            f"{body.at('mesh_stretch')}: {body.mesh_stretch or 0.0:g}, but '{body.own_name}' never comes into "
            f"contact (accepted: 0 or 1)"
        )
    return min(onsets, key=lambda onset: onset.time).own_normal(k, body)


def _bulk_of_rigid(body: Body, contact: float) -> float:
    """Returns the largest element size [m] of a rigid body, which does not deform. In the plane it
    keeps the outline round. In space solid_mesh.LARGEST does, and all corners, which may strike
    later, have at most twice the size at the first contact as long as the body stays coarse.
    """
    half = float(body.outline.half_thickness)
    return max(half / 3, min(half, 2 * contact)) if isinstance(body.outline, Solid) else half / 3


def _hit(
    body: Body, k: int, onset: Onset, auto: AutomaticValues
) -> tuple[float, np.ndarray, float]:
    """Returns, for an onset of contact of body k, the element size [m] at the contact, points (n,
    axes) of its outline there, and half their distance [m].
    """
    bodies = [auto.scene.bodies[j] for j in (onset.first, onset.second) if j >= 0]
    straight = auto.of_disc(bodies, onset.radius)
    arc, size = straight.touch_arc, straight.contact_mesh_size
    # The indentation of a stiffer body is smaller by the ratio of the moduli, and so is its error,
    # which is quadratic in the size. Its points still resolve the pressure. Rigid bodies have no
    # unknowns to save.
    if not body.rigid:
        resolved = RESOLVED * 2 / math.pi * arc * onset.radius
        size = max(size, min(size / math.sqrt(_softer(k, onset, auto)), resolved))
    depth, small = (
        onset.radius * (1 - math.cos(min(arc, math.pi / 2))),
        auto.small(onset.first, onset.second),
    )
    points, spacing = body.outline.samples(size)
    near = _near(body, k, onset, depth, points)
    # Width near contact over that of a disc: above 1 for flat faces, below 1 for corners and pegs.
    wider = body.outline.width(near, spacing) / (2 * arc * onset.radius)
    if all(hit.rigid for hit in bodies):
        # The penalty alone yields. It spreads the load of a corner as widely as that of a disc.
        wider = max(1.0, wider)
    if small > 0:  # a sharp corner has radius 0, and no element size resolves it
        wider = min(
            max(1.0, wider), wider / NARROW, POINTED * small / (2 / math.pi * arc * onset.radius)
        )
    if small > 0 and wider < 1:
        size = max(SMALLEST * onset.radius / wider, size)
        points, spacing = body.outline.samples(size * wider)
        near = _near(body, k, onset, min(depth, small), points)
    slide = (auto.of_disc(bodies, onset.radius, slides=True).touch_arc - arc) * onset.radius
    if slide > 0:
        near = points[nearest(points, near) <= slide]
    return size * (wider if small > 0 else max(1.0, wider)), near, spacing / 2


def _near(body: Body, k: int, onset: Onset, depth: float, points: np.ndarray) -> np.ndarray:
    """Returns those of the `points` of body k whose gap at the onset of contact exceeds the
    smallest gap by `depth` [m] at most. For a disc on a plane `depth` is the gap at touch_arc from
    its lowest point.
    """
    gaps = onset.gaps(k, body.outline.carried(onset.shape(k), points))
    # A point at the depth itself counts in any unit of length, whatever the round-off.
    nearest: np.ndarray = points[gaps <= gaps.min() + (1 + 1e-9) * depth]
    return nearest


def boundary_curves(scene: Scene, k: int) -> list[list[tuple[Curve, float, int]]]:
    """Returns the closed curves that bound the mesh of body k, the outer one first,
    counter-clockwise. Each is a list of pieces with the largest element size [m] and the label.
    """
    outline, finest = scene.bodies[k].flat_outline, math.sqrt(scene.number("accuracy"))
    loops = outline.loops

    def largest(loop: Loop) -> float:
        # Edges on an ellipse are straight, and an edge of the angle a loses a^2/6 of the area.
        if loop.semi_axes is None:
            return np.inf
        return (ROUND if loop.radius else min(ROUND, finest)) * float(loop.semi_axes.min())

    halved = outline if scene.kind is AXISYMMETRIC else None
    if copies(scene) > 1:
        halved = revolution.crossing_axis(outline)
    if halved:
        if isinstance(outline, TubeOutline):
            return [
                [
                    (partial(loops[0].at, piece), largest(loops[0]), FREE)
                    for piece in range(len(loops[0].corners))
                ]
            ]
        return [
            [
                (piece, largest(loop), FREE) if loop else (piece, np.inf, AXIS)
                for piece, loop in revolution.boundary(halved)
            ]
        ]
    return [
        [(partial(loop.at, piece), largest(loop), FREE) for piece in range(len(loop.corners))]
        for loop in loops
    ]


def _reached(scene: Scene, k: int, made: mesh.Made) -> mesh.Made:
    """Returns the Mesh or SolidMesh of body k. Its inner outlines have contact points only if the
    body may come into contact with itself or something is inside: nothing reaches the others.
    """
    if any(pair.first == pair.second == k for pair in scene.pairs):
        return made
    return mesh.without_inner(made, partial(_holds, scene, k))


def _holds(scene: Scene, k: int, inner: np.ndarray, rest: np.ndarray) -> bool:
    """Whether another body or an obstacle is inside an inner outline of body k. It is then nearer
    to the vertices `inner` (n, axes) of that outline than to those of the `rest` of the boundary.
    """
    body = scene.bodies[k]
    turn = np.eye(3) if scene.kind is SOLID else rotation(body.start_angle).T
    own, outer = (points @ turn + body.start_position for points in (inner, rest))
    gaps = [other.placed.gap for j, other in enumerate(scene.bodies) if j != k]
    gaps += [obstacle.gap for obstacle in scene.obstacles]
    return any(gap(own).min() < gap(outer).min() for gap in gaps)


# ---- meshes


def _meshed(scene: Scene, k: int, size: Sizes) -> mesh.Mesh:
    """Returns the mesh of body k in the plane or of revolution, which follows its layers."""
    body, boundary = scene.bodies[k], boundary_curves(scene, k)
    interfaces: list[tuple[Curve, float]] = []
    if body.layers:
        thin = [  # element sizes on the outline above thin layers
            longest(abs(radius - own), radius, size)
            for own in (layer.radius for layer in body.layers)
            if own is not None
            for radius in body.radii
            if radius > 0
        ]
        halved = bool(mirror_axes(scene.kind, copies(scene)))
        boundary, interfaces = with_interfaces(
            boundary, body.regions, body.outline.gap, halved, size
        )
        boundary = [
            [(curve, min([largest, *thin]), label) for curve, largest, label in loop]
            for loop in boundary
        ]
    return mesh_body(boundary, size, body.outline.half_thickness, interfaces)


def _with_layers(body: Body, made: mesh.Made, rotation: np.ndarray) -> mesh.Made:
    """Returns the mesh of a body, turned by `rotation`, with the layers of its cells. Raises BadInput
    if the mesh does not follow the layers, or if a layer is not in it.
    """
    if not body.layers:
        return made
    layers, follows = body.layers_on(made, rotation)
    if not follows:
        raise BadInput(
            f"{body.at('layer')}: the mesh of '{body.own_name}' does not follow it (accepted: of a shape, or a mesh from a file "
            "or arrays with sides between layers)"
        )
    for number, layer in enumerate(body.layers, 1):
        if not (layers == number).any():
            raise BadInput(
                f"{layer.entry}: has no part of '{body.own_name}' (accepted: inside it, and not covered by another layer)"
            )
    return replace(made, layers=layers)


def place_apart(meshes: Sequence[mesh.Mesh | solid_mesh.SolidMesh], along: int) -> np.ndarray:
    """Returns centres (bodies, axes) [m] on an axis (0: x, 1: y), from 0 on, for meshes about their
    centres. Their distance from each other is BETWEEN times the largest extent.
    """
    boxes = [np.array([made.points.min(axis=0), made.points.max(axis=0)]) for made in meshes]
    between = BETWEEN * max(np.ptp(box, axis=0).max() for box in boxes)
    centres = np.zeros((len(boxes), boxes[0].shape[1]))
    for k in range(1, len(boxes)):
        centres[k, along] = (
            centres[k - 1, along] + boxes[k - 1][1, along] + between - boxes[k][0, along]
        )
    return centres


def stack(
    meshes: Sequence[mesh.Mesh | solid_mesh.SolidMesh], centres: np.ndarray
) -> tuple[mesh.Mesh | solid_mesh.SolidMesh, np.ndarray]:
    """Returns all bodies as one mesh, and the number (t,) of the body of each triangle or
    tetrahedron. Behind the sides on the boundary are those between layers, with the label INTERFACE.
    """
    first = np.cumsum([0, *(len(made.points) for made in meshes)])
    between = [mesh.interfaces(made.elements, made.layer_of) for made in meshes]
    together = type(meshes[0])(
        np.vstack([made.points + centre for made, centre in zip(meshes, centres)]),
        np.vstack([made.elements + k for made, k in zip(meshes, first)]),
        np.vstack(
            [made.sides + k for made, k in zip(meshes, first)]
            + [sides + k for sides, k in zip(between, first)]
        ),
        np.concatenate(
            [made.labels for made in meshes]
            + [np.full(len(sides), mesh.INTERFACE) for sides in between]
        ),
        layers=np.concatenate([made.layer_of for made in meshes]),
    )
    return together, np.repeat(np.arange(len(meshes)), [len(made.elements) for made in meshes])
