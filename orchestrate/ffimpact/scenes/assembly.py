"""What FreeFEM computes a scene of bodies on: one mesh of all of them, apart from each other, and a
data file of words and numbers.

Region k of the mesh is body k, from 0. Its edges have the label 1 where the body may touch, another
one where its file excludes that or nothing reaches them. The bodies stand side by side along x, not
turned, each about its own centre of area; scene.dat says where they are at the start. Of bodies of
revolution it is the half x >= 0 of their sections, the axis with the label 2, one above the other.
"""

import math
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from ..failure import BadInput
from ..freefem.describe import describe
from ..geometry.outlines import Loop, TubeOutline, rotation
from ..input.dimension import AXISYMMETRIC, PLANE_STRAIN, SOLID
from ..input.models import MATERIAL, OWN
from ..input.parameters import Value
from ..input.toml_text import to_toml
from ..mesh import mesh, revolution, solid_mesh, solids
from ..mesh.mesh import AXIS, FREE, Curve, Sizes, mesh_body, nearest
from .approach import Meeting, loaded_pull, meetings, refuse_nothing, refuse_sinking, turned
from .bodies import DAMPING, STIFF, Body
from .front import Front, fronts
from .mirror import COPIES, FOLDED, copies
from .parts import sections
from .scene import Pair, Scene

__all__ = [
    "Asker",
    "Assembly",
    "assemble",
    "contact_values",
    "data_file",
    "element_sizes",
    "pair_values",
    "prepare",
    "side_by_side",
    "stack",
    "used_tables",
    "with_open_penalties",
]

ROUND = 0.5  # largest element size on a circle or ellipse, over its smaller semi-axis
LIKE = ("radius", "young", "nu", "density", "speed", "angle", "spin")
# of the contact of a disc on a plane: where less of an outline is near, elements are smaller; of
# two equal discs it is 0.71
NARROW = 0.6
# largest half-width of a contact over the radius of the obstacle, as over that of a disc on a plane
# (sizes.idp)
POINTED = 0.5
ASIDE = 0.02  # of the pair's radius: as near to a corner of an obstacle is on it
SMALLEST = 1e-3  # element in a contact over the pair's radius, however small the obstacle is
BETWEEN = 0.2  # from body to body in the reference configuration, over the largest extent

Rule = Callable[
    [dict[str, Value]], dict
]  # describe: what the scripts make of a disc or a ball on a plane


@dataclass(frozen=True)
class Assembly:
    """`mesh` holds all bodies, `regions` (t,) their numbers, `centres` (bodies, axes) where
    their centres of area are in it; `data` is the text of scene.dat; `values` are all
    parameters of run and contact, nothing left open, and `used` the tables of the scene with
    them in it: read again, they make this very assembly.
    """

    mesh: mesh.Mesh | solid_mesh.SolidMesh
    regions: np.ndarray
    centres: np.ndarray
    data: str
    values: dict[str, Value]
    used: dict

    def write(self, folder: Path) -> None:
        """mesh.msh (in three dimensions mesh.mesh) and scene.dat, what edp/bodies.edp reads."""
        if isinstance(self.mesh, solid_mesh.SolidMesh):
            solid_mesh.write(self.mesh, self.regions, folder / "mesh.mesh")
        else:
            mesh.write(self.mesh, folder / "mesh.msh", self.regions)
        (folder / "scene.dat").write_text(self.data)


def prepare(
    scene: Scene, where: Path, foreign: bytes | None = None, like: Scene | None = None
) -> tuple[dict[str, Value | Path], dict, str]:
    """The flags of a run in the folder `where`, the scene as it will be used, and the text of
    its scene.toml, "" where the script writes it. Puts into the folder what the flags name: the
    mesh of all bodies and what the script reads of them; of one of the paper's scenes the mesh,
    `foreign` or our own, of the sizes and the part of the body that its description says, or
    that of the scene `like` it, which has other sizes and steps alone.
    """
    file = where / scene.mesh_name
    if scene.bodies:
        if (
            len(scene.bodies) == 1
            and not scene.obstacles
            and not (scene.bodies[0].supports or scene.bodies[0].loads)
        ):
            raise BadInput(
                "obstacle: is missing, and a second body too (accepted: one table [[obstacle]] or more, or several [[body]])"
            )
        scene = turned(scene)
        met = meetings(scene)
        refuse_nothing(scene, met)
        refuse_sinking(scene, met)
        built = assemble(scene, met=met)
        built.write(where)
        text = to_toml(scene.with_files_in(where, built.used))
        return (
            built.values | {"mesh": file, "bodies": where / "scene.dat"},
            tomllib.loads(text),
            text,
        )
    said = (like or scene).description(foreign)
    if not scene.meshed:
        return scene.values, said["used"], ""
    if foreign is not None:
        file.write_bytes(foreign)
    else:
        sizes = (
            scene.values[name] or said["used"][name]
            for name in ("radius", "mesh_size", "contact_mesh_size")
        )
        mesh.write(mesh.disc(*sizes, said["half"], said["touch_arc"]), file)
    return scene.values | {"mesh": file}, said["used"], ""


def assemble(scene: Scene, rule: Rule | None = None, met: list[Meeting] | None = None) -> Assembly:
    """Meshes the bodies of a scene and writes down the rest. What the scene leaves open is
    settled by `rule` (left out: describe), which is asked for a disc, or a ball, of the pair's
    radius that hits a plane. `met`: the scene's meetings, where they are known already.
    """
    ask = Asker(
        scene,
        meetings(scene) if met is None else met,
        rule or partial(describe, script=scene.dimension.like),
    )
    values = scene.values | contact_values(scene.bodies, scene.contact, ask, "contact")
    bodies = [
        replace(
            body,
            viscosity=float(
                _of_body(k, ask, loss=body.loss, viscosity=body.viscosity)["viscosity"]
            ),
        )
        if body.loss
        else body
        for k, body in enumerate(scene.bodies)
    ]
    scene = replace(scene, pairs=with_open_penalties(scene, ask), bodies=bodies)
    pairs = [pair_values(pair, ask, values) for pair in scene.pairs]
    sizes = [None if body.mesh else element_sizes(k, ask) for k, body in enumerate(scene.bodies)]
    meshes, centres, rounds = (_solids if scene.dimension is SOLID else _sections)(scene, sizes)
    together, regions = stack(meshes, centres)
    conditions = sections(scene.bodies, meshes, scene.obstacles, scene.dimension, copies(scene))
    disc = ask.disc(
        scene.bodies, min(body.outline.half_thickness for body in scene.bodies), slides=True
    )
    penalties = {
        (pair.first, pair.second): float(own["penalty"]) for pair, own in zip(scene.pairs, pairs)
    }
    rises = [
        one.rise_on(penalties.get(both, values["penalty"]), scene.bodies, values["exponent"])
        for both, one in ask.fronts.items()
    ]
    front = [(min(one.tau for one in ask.fronts.values()), max(rises))] if rises else []
    return Assembly(
        together,
        regions,
        centres,
        data_file(scene, disc, centres, rounds, pairs, front, conditions),
        values,
        used_tables(scene, sizes, values, pairs),
    )


def _sections(
    scene: Scene, sizes: list[Sizes | None]
) -> tuple[list[mesh.Mesh], np.ndarray, list[tuple]]:
    """The meshes of bodies in the plane, their centres in the mesh of all, the lines of circles
    in scene.dat (of sections those that are not another's mirror image).
    """
    meshes = [
        body.mesh or mesh_body(_boundary(scene, k), sizes[k], body.outline.half_thickness)
        for k, body in enumerate(scene.bodies)
    ]
    meshes = [_reached(scene, k, made) for k, made in enumerate(meshes)]
    centres = side_by_side(meshes, 1 if scene.dimension is AXISYMMETRIC else 0)
    circles = [
        (k, *(centre + at), radius)
        for k, (body, centre) in enumerate(zip(scene.bodies, centres))
        for loop in body.outline.loops
        for at, radius in loop.circles
        if scene.dimension is not AXISYMMETRIC or at[0] >= 0
    ]
    return meshes, centres, [("circles", len(circles)), *circles]


def _solids(
    scene: Scene, sizes: list[Sizes | None]
) -> tuple[list[solid_mesh.SolidMesh], np.ndarray, list[tuple]]:
    """The same in three dimensions: bodies turned as they are at the start, one above the
    other; half or a quarter where that is enough.
    """
    folded = FOLDED[copies(scene)]
    accuracy = float(scene.values["accuracy"])
    meshes = [solids.mesh_of(body, one, folded, accuracy) for body, one in zip(scene.bodies, sizes)]
    meshes = [_reached(scene, k, made) for k, made in enumerate(meshes)]
    count = sum(solid_mesh.unknowns(one.cells, scene.values["degree"]) for one in meshes)
    if count > solid_mesh.MOST_UNKNOWNS:
        raise BadInput(
            f"mesh_size: the bodies have {count} unknowns (accepted: up to {solid_mesh.MOST_UNKNOWNS}; larger mesh_size, "
            f"contact_mesh_size or accuracy, coarser files, degree = 1)"
        )
    centres = side_by_side(meshes, 1)
    surfaces = [
        (k, *(centre + one.centre), *one.axis, one.radius)
        for k, (made, centre) in enumerate(zip(meshes, centres))
        for one in made.curved
    ]
    spheres, cylinders = ([one for one in surfaces if len(one) == size] for size in (5, 8))
    return (
        meshes,
        centres,
        [("spheres", len(spheres)), *spheres, ("cylinders", len(cylinders)), *cylinders],
    )


# ---- what the scene leaves open


@dataclass(frozen=True)
class Asker:
    """Asks the rule for discs (balls) that hit a plane as the scene's bodies hit each other:
    with its largest speeds and forces, along and across the normal.
    """

    scene: Scene
    met: list[Meeting]
    rule: Rule

    @cached_property
    def fronts(self) -> dict[tuple[int, int], Front]:
        """The flat strikes, by the pair that meets; of several of a pair the one with the
        smallest elements.
        """
        found = sorted(fronts(self.scene, self.met), key=lambda front: -front.tau)
        return {(front.meeting.first, front.meeting.second): front for front in found}

    def open_front(self, pair: Pair) -> Front | None:
        """The front of a pair that strikes flat and whose penalty is open."""
        is_open = pair.values.get("penalty", self.scene.contact["penalty"]) == "auto"
        return self.fronts.get((pair.first, pair.second)) if is_open else None

    def answer(
        self,
        bodies: list[Body],
        radius: float,
        slides: bool = False,
        presses: bool = True,
        **more: Value,
    ) -> dict:
        """Of the rule, for such a disc."""
        return self.rule(self.disc(bodies, radius, slides, presses) | more)

    def small(self, first: int, second: int) -> float:
        """The radius [m] of an obstacle where a body meets it, if less than half of the
        body's own, 0 at a sharp corner; else infinite.
        """
        one = self.first_met.get((first, second))
        if second >= 0 or one is None:
            return math.inf
        body, obstacle = one.outlines
        radius = obstacle.radius_at(
            body.points[obstacle.gap(body.points).argmin()], ASIDE * one.radius
        )
        return radius if radius < one.radius / 2 else math.inf

    @cached_property
    def first_met(self) -> dict[tuple[int, int], Meeting]:
        """The first meeting of each pair that may meet."""
        return {(one.first, one.second): one for one in reversed(self.met) if not one.never}

    @cached_property
    def largest(self) -> tuple[float, ...]:
        """The largest closing and sliding speed [m/s], and acceleration along and across
        the normal [m/s2]. No round-off: a mesh follows every digit.
        """
        return tuple(
            float(f"{max((getattr(one, name) for one in self.met), default=0.0):.6g}")
            for name in ("closing", "sliding", "pressing", "pulling")
        )

    @cached_property
    def pressed(self) -> float:
        """The closing speed [m/s] of impacts that press as much as moving supports do."""
        return float(f"{max((one.pressed for one in self.met), default=0.0):.6g}")

    def disc(
        self, bodies: list[Body], radius: float, slides: bool, presses: bool = True
    ) -> dict[str, Value]:
        """A disc of this radius [m] and the softer body's material; straight on unless it
        `slides`; where it `presses` as wide a contact as moving supports make.
        """
        along, across, pressing, pulling = self.largest
        along = max(along, self.pressed) if presses else along
        pressing = pressing if self.met else max(loaded_pull(body) for body in self.scene.bodies)
        soft = min(bodies, key=lambda body: body.young)
        asked = {
            name: self.scene.values[name]
            for name in ("accuracy", "accuracy_of", "end_time", "until")
        }
        young = soft.young / (STIFF if soft.rigid else 1)
        asked |= {
            "exponent": self.scene.contact["exponent"],
            "young": young,
            "nu": soft.nu,
            "density": soft.density,
            "radius": radius,
            "symmetry": "full",
            "speed": along,
            "angle": 90.0,
            "spin": 0.0,
            "gravity": pressing,
        }
        if slides:
            asked |= {
                "speed": math.hypot(along, across),
                "angle": math.degrees(math.atan2(along, across)),
                "spin": max(float(np.linalg.norm(body.spin)) for body in bodies),
                "body_force_x": pulling,
            }
        return asked


def contact_values(
    bodies: list[Body], contact: dict[str, Value], ask: Asker, path: str, least: float = math.inf
) -> dict[str, Value]:
    """`contact` with penalty, friction_dynamic and slip_velocity as numbers: for the softest of
    the bodies and the smallest radius, `least` [m] that of an obstacle.
    """
    radius = min([least, *(body.outline.half_thickness for body in bodies)])
    given = [body.contact_mesh_size for body in bodies]
    more = {"contact_mesh_size": min(*given, radius)} if min(given) > 0 else {}
    found = dict(contact)
    if left := [name for name in ("penalty", "slip_velocity") if contact[name] == "auto"]:
        used = ask.answer(bodies, radius, slides=True, exponent=contact["exponent"], **more)["used"]
        found |= {name: used[name] for name in left}
        if (
            "slip_velocity" in left and ask.pressed > 0
        ):  # a slow motion slips slowly, however far it goes
            used = ask.answer(
                bodies, radius, slides=True, presses=False, exponent=contact["exponent"], **more
            )["used"]
            found["slip_velocity"] = used["slip_velocity"]
    if contact["friction_dynamic"] == "auto":
        found["friction_dynamic"] = contact["friction_static"]
    if found["friction_dynamic"] > found["friction_static"]:
        raise BadInput(
            f"{path}.friction_dynamic: {found['friction_dynamic']:g} is larger than friction_static "
            f"{found['friction_static']:g} (accepted: 0 to friction_static)"
        )
    return found


def pair_values(pair: Pair, ask: Asker, values: dict[str, Value]) -> dict[str, Value]:
    """All that a pair may have of its own: what it does not say is as settled for the scene,
    and open again where it depends on what the pair says.
    """
    bodies = [ask.scene.bodies[k] for k in (pair.first, pair.second) if k >= 0]
    alone = "friction_static" in pair.values  # sets both
    inherited = {name: values[name] for name in ask.scene.contact}
    inherited["friction_dynamic"] = "auto" if alone else ask.scene.contact["friction_dynamic"]
    small = ask.small(pair.first, pair.second)
    if 0 < small < math.inf:
        inherited["penalty"] = ask.scene.contact["penalty"]
    own = inherited | pair.values
    if front := ask.open_front(pair):
        own["penalty"] = front.penalty(ask.scene.bodies, ask.scene.contact["exponent"])
    own = contact_values(bodies, own, ask, pair.path, small or math.inf)
    return {name: own[name] for name in OWN}


def with_open_penalties(scene: Scene, ask: "Asker") -> list[Pair]:
    """The scene's pairs, and those that an open penalty makes differ: flat strikes, and a body
    and an obstacle smaller than its contact on a plane.
    """
    said = {(pair.first, pair.second) for pair in scene.pairs}
    small = [
        (one.first, one.second)
        for one in ask.met
        if 0 < ask.small(one.first, one.second) < math.inf
    ]
    differ = dict.fromkeys([*small, *ask.fronts]) if scene.contact["penalty"] == "auto" else {}
    pairs = scene.pairs + [
        Pair(*both, {}, f"obstacle.{-both[1]}" if both[1] < 0 else "contact")
        for both in differ
        if both not in said
    ]
    return sorted(pairs, key=lambda pair: (pair.first, pair.second))


def used_tables(
    scene: Scene, sizes: list[Sizes | None], values: dict[str, Value], pairs: list[dict[str, Value]]
) -> dict:
    """The tables of a scene with everything as used; what obstacles say of contact stands in
    [[contact.pair]].
    """

    def names(pair: Pair) -> list[str]:
        return [
            (scene.bodies[k] if k >= 0 else scene.obstacles[-1 - k]).name
            for k in (pair.first, pair.second)
        ]

    bodies = []
    for given, body, size in zip(scene.given["body"], scene.bodies, sizes):
        used = (
            {"name": body.name}
            | given
            | ({} if body.rigid else {key: getattr(body, key) for key in MATERIAL})
        )
        used |= {"density": body.density} if body.rigid and not body.mass else {}
        used |= {"mesh_size": size.bulk, "contact_mesh_size": size.contact} if size else {}
        used |= {"file": str((scene.folder / given["file"]).resolve())} if "file" in given else {}
        bodies.append(used)
    obstacles = [
        {"name": one.name} | {key: value for key, value in given.items() if key not in OWN}
        for given, one in zip(scene.given.get("obstacle", []), scene.obstacles)
    ]
    contact = {key: values[key] for key in scene.contact}
    contact |= {"self_contact": scene.given.get("contact", {}).get("self_contact", "auto")}
    contact |= {"pair": [{"bodies": names(pair)} | own for pair, own in zip(scene.pairs, pairs)]}
    top = {"title": scene.title, "script": scene.script, "dimension": scene.dimension.name}
    if scene.dimension is SOLID:
        top["symmetry"] = next(word for word, count in COPIES.items() if count == copies(scene))
    return (
        top
        | {key: values[key] for key in scene.values}
        | {"body": bodies, "obstacle": obstacles, "contact": contact}
    )


def _of_body(k: int, ask: Asker, **given: Value) -> dict:
    """What the rule makes of a disc or ball as thick as body k."""
    body = ask.scene.bodies[k]
    try:
        return ask.answer([body], body.outline.half_thickness, **given)["used"]
    except BadInput as error:
        raise BadInput(
            f"body.{k + 1}.{error} (of a {'disc' if ask.scene.dimension is PLANE_STRAIN else 'ball'} as thick as "
            f"'{body.name}')"
        ) from None


def element_sizes(k: int, ask: Asker) -> Sizes:
    """The element sizes of body k: in the bulk for its own thickness, in the contacts as each
    pair asks for.
    """
    body = ask.scene.bodies[k]
    given = {
        name: value
        for name, value in (
            ("mesh_size", body.mesh_size),
            ("contact_mesh_size", body.contact_mesh_size),
        )
        if value
    }
    bulk = float(_of_body(k, ask, **given)["mesh_size"])
    hits = [_hit(body, k, one, ask) for one in ask.met if k in (one.first, one.second)]
    mine = [front for front in ask.fronts.values() if k in front.sizes]
    if body.rigid and not body.mesh_size:
        bulk = (
            float(body.outline.half_thickness) / 3
        )  # nothing goes on inside; the outline is to look round
    if not body.mesh_size:
        bulk = min((front.sizes[k] for front in mine if k in front.crossed), default=bulk)
    contact = body.contact_mesh_size or min(
        [bulk, *(size for size, *_ in hits), *(front.sizes[k] for front in mine)]
    )
    near = np.vstack([np.empty((0, ask.scene.dimension.axes)), *(points for _, points, _ in hits)])
    return Sizes(bulk, min(bulk, contact), near, max([0.0, *(slack for *_, slack in hits)]))


def _hit(body: Body, k: int, one: Meeting, ask: Asker) -> tuple[float, np.ndarray, float]:
    """Where body k touches at a meeting: the element size there, points (n, 2) of its outline,
    and half their distance [m].
    """
    bodies = [ask.scene.bodies[j] for j in (one.first, one.second) if j >= 0]
    straight = ask.answer(bodies, one.radius)
    arc, size = straight["touch_arc"], float(straight["used"]["contact_mesh_size"])
    depth, small = (
        one.radius * (1 - math.cos(min(arc, math.pi / 2))),
        ask.small(one.first, one.second),
    )
    points, spacing = body.outline.samples(size)
    near = _near(body, k, one, depth, points)
    # than the contact of a disc: flat faces; or less wide: corners, pegs
    wider = body.outline.width(near, spacing) / (2 * arc * one.radius)
    if small > 0:  # a sharp corner no elements resolve
        wider = min(
            max(1.0, wider), wider / NARROW, POINTED * small / (2 / math.pi * arc * one.radius)
        )
    if small > 0 and wider < 1:
        size = max(SMALLEST * one.radius / wider, size)
        points, spacing = body.outline.samples(size * wider)
        near = _near(body, k, one, min(depth, small), points)
    slide = (ask.answer(bodies, one.radius, slides=True)["touch_arc"] - arc) * one.radius
    if slide > 0:
        near = points[nearest(points, near) <= slide]
    return size * (wider if small > 0 else max(1.0, wider)), near, spacing / 2


def _near(body: Body, k: int, one: Meeting, depth: float, points: np.ndarray) -> np.ndarray:
    """Those of the points of body k where the gap at the meeting is larger than the least by
    `depth` [m] at most, which of a disc on a plane is that at touch_arc from its lowest
    point.
    """
    gaps = one.gaps(k, body.outline.carried(one.outlines[0 if k == one.first else 1], points))
    return points[gaps <= gaps.min() + depth]


def _boundary(scene: Scene, k: int) -> list[list[tuple[Curve, float, int]]]:
    """The closed curves that bound the mesh of body k, the outer first, counter-clockwise: each
    piece with the largest element size on it and its label.
    """
    loops = scene.bodies[k].outline.loops
    if scene.dimension is AXISYMMETRIC:
        if isinstance(scene.bodies[k].outline, TubeOutline):
            return [
                [
                    (partial(loops[0].at, piece), _largest(loops[0]), FREE)
                    for piece in range(len(loops[0].corners))
                ]
            ]
        return [
            [
                (piece, _largest(loop), FREE) if loop else (piece, np.inf, AXIS)
                for piece, loop in revolution.boundary(scene.bodies[k].outline)
            ]
        ]
    return [
        [(partial(loop.at, piece), _largest(loop), FREE) for piece in range(len(loop.corners))]
        for loop in loops
    ]


def _largest(loop: Loop) -> float:
    return np.inf if loop.semi_axes is None else ROUND * loop.semi_axes.min()


def _reached(scene: Scene, k: int, made):
    """The Mesh or SolidMesh of body k. Its inner outlines may touch like the outer one where the
    body touches itself or something is inside. Nothing reaches the others: no contact points."""
    if any(pair.first == pair.second == k for pair in scene.pairs):
        return made
    return mesh.without_inner(made, partial(_holds, scene, k))


def _holds(scene: Scene, k: int, inner: np.ndarray, rest: np.ndarray) -> bool:
    """Whether another body or an obstacle is inside an inner outline of body k, vertices (n, axes)
    of its mesh: it is then nearer to that outline than to the rest of the boundary."""
    body = scene.bodies[k]
    turn = np.eye(3) if scene.dimension is SOLID else rotation(body.angle).T
    own, outer = (points @ turn + body.position for points in (inner, rest))
    others = [*(other.placed for j, other in enumerate(scene.bodies) if j != k), *scene.obstacles]
    return any(other.gap(own).min() < other.gap(outer).min() for other in others)


# ---- meshes


def side_by_side(meshes: list[mesh.Mesh | solid_mesh.SolidMesh], along: int) -> np.ndarray:
    """Centres (bodies, axes) on an axis (0: x, 1: y), from 0 on, that keep meshes about them
    apart by a part of the largest.
    """
    boxes = [np.array([one.points.min(axis=0), one.points.max(axis=0)]) for one in meshes]
    between = BETWEEN * max(np.ptp(box, axis=0).max() for box in boxes)
    centres = np.zeros((len(boxes), boxes[0].shape[1]))
    for k in range(1, len(boxes)):
        centres[k, along] = (
            centres[k - 1, along] + boxes[k - 1][1, along] + between - boxes[k][0, along]
        )
    return centres


def stack(meshes: list[mesh.Mesh] | list[solid_mesh.SolidMesh], centres: np.ndarray) -> tuple:
    """All bodies as one mesh, and the body (t,) of each triangle or tetrahedron."""
    first = np.cumsum([0, *(len(one.points) for one in meshes)])
    points, cells, sides, labels = zip(
        *([getattr(one, part.name) for part in fields(one)[:4]] for one in meshes)
    )
    together = type(meshes[0])(
        np.vstack([own + centre for own, centre in zip(points, centres)]),
        *(np.vstack([own + k for own, k in zip(parts, first)]) for parts in (cells, sides)),
        np.concatenate(labels),
    )
    return together, np.repeat(np.arange(len(meshes)), [len(own) for own in cells])


# ---- scene.dat


def data_file(
    scene: Scene,
    disc: dict[str, Value],
    centres: np.ndarray,
    rounds: list[tuple],
    pairs: list[dict[str, Value]],
    front: Sequence[tuple[float, float]] = (),
    conditions: Sequence[tuple] = (),
) -> str:
    """The text of scene.dat, words and numbers (SI, radians), as edp/core/input/scene-file.idp
    says; the disc, or ball, is what the rules stand for, `rounds` are the lines of circles, or
    of spheres and cylinders, `front` the transit through an element and the rise [s] of the
    front of a flat strike, where there is one, `conditions` the lines of supports and loads.
    """
    if scene.dimension is SOLID:
        head = [("ffimpact-bodies-3d", 1), ("copies", copies(scene))]
        starts = [
            (*(body.position - centre), *body.velocity, *body.spin)
            for body, centre in zip(scene.bodies, centres)
        ]
    else:
        head = [("ffimpact-bodies", 1)]
        starts = [(*body.position, body.angle, *body.velocity, body.spin) for body in scene.bodies]
    lines = [*head, ("disc", *(float(disc[name]) for name in LIKE)), ("bodies", len(scene.bodies))]
    lines += [
        (
            body.name,
            body.law + (f":{body.law_parameters}" if body.law_parameters != "none" else ""),
            body.young,
            body.nu,
            body.density,
            *centre,
            *start,
        )
        for body, centre, start in zip(scene.bodies, centres, starts)
    ]
    lines += rounds
    files = [
        (k, 1 if body.mesh else 2)
        for k, (given, body) in enumerate(zip(scene.given["body"], scene.bodies))
        if "file" in given
    ]
    lines += [("files", len(files)), *files]
    lines += [("obstacles", len(scene.obstacles))]
    lines += [
        (
            one.name,
            "circle" if one.kind == "sphere" and scene.dimension is not SOLID else one.kind,
            len(one.numbers),
            *one.numbers,
            *one.velocity,
        )
        for one in scene.obstacles
    ]
    lines += [
        ("pairs", len(pairs)),
        *((pair.first, pair.second, *own.values()) for pair, own in zip(scene.pairs, pairs)),
    ]
    lines += [("front", *one) for one in front]
    damped = [
        (k, *(getattr(body, name) for name in DAMPING))
        for k, body in enumerate(scene.bodies)
        if body.damped
    ]
    lines += [("damping", len(damped)), *damped] if damped else []
    stiff = [(k, body.mass, *body.moments) for k, body in enumerate(scene.bodies) if body.rigid]
    lines += [("rigid", len(stiff)), *stiff] if stiff else []
    lines += conditions
    return "".join(
        " ".join(repr(float(one)) if isinstance(one, float) else str(one) for one in line) + "\n"
        for line in lines
    )
