"""Onset of contact of the bodies of a scene. They move as rigid bodies, r = r0 + v t + b t^2 / 2,
angle = angle0 + spin t, until the gap closes.

While the bounding spheres are apart no gap is computed: the search goes on from one root of
polynomials of time to the next.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import Polynomial

from .. import progress
from ..failure import BadInput
from ..geometry.outlines import Outline, Shape
from ..geometry.time_functions import farthest
from ..input.bodies import Body
from ..input.conditions import WHOLE
from ..input.dimension import PLANE_STRAIN
from ..input.obstacles import Drive, Obstacle
from ..input.parameters import Value
from ..mesh import mesh
from .overlap import gap_between

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = [
    "Onset",
    "loaded_pull",
    "onsets_of",
    "refuse_nothing",
    "refuse_sinking",
    "with_discs_aligned",
]

STEPS = 2000  # steps of conservative advancement, after which the onset of contact is unknown
# Gap over the smaller half thickness at which the search ends. It matters for implicit obstacles
# and surfaces, which have no parts with a search distance.
FAR = 1e6
# Restitution of an impact that turns bodies. It is low because much energy goes into vibration, and
# because the bodies turn during contact.
RESTITUTION = 0.5
ECCENTRIC = 1e-2  # smallest lever arm of an impact that turns a body, over its bounding radius
MORE = 3  # further onsets of contact of two bodies that are computed after the first one
PARTS = 64  # parts of the way to an onset of contact, for bodies that are in the way
# Gaps over the smaller half thickness: the pair counts as in contact, and the search ends.
MET, CLOSED = 1e-3, 1e-9


@dataclass(frozen=True)
class Onset:
    """The onset of contact of one contact pair: body `first` and the body or obstacle `second`
    (body k, or -1 - k for obstacle k).

    - `outlines`: both shapes at the onset, or at the start if the pair does not come into contact.
    - `closing`, `sliding`: components of the relative velocity along and across the normal,
      positive [m/s].
    - `pressing`, `pulling`: those of the acceleration by constant forces between them [m/s2].
    - `radius`: the radius that represents the pair in the rules of sizes [m].
    - `time`: of the onset [s], infinite without one.
    - `normal`: outward normal of `second`.
    - `never`: whether the pair, as rigid bodies, never comes into contact.
    - `pressed`: closing speed [m/s] of an impact with as wide a contact as the motion of a support
      makes.
    - `shielded`: whether a third body keeps the pair apart (_is_shielded()).
    """

    first: int
    second: int
    outlines: tuple[Shape, Shape | Obstacle]
    closing: float
    sliding: float
    pressing: float
    pulling: float
    radius: float
    time: float
    normal: np.ndarray
    never: bool = False
    pressed: float = 0.0
    shielded: bool = False

    def shape(self, k: int) -> Shape:
        """Returns the shape of body number k at the onset."""
        first, second = self.outlines
        return second if k == self.second and isinstance(second, Shape) else first

    def own_normal(self, k: int, body: Body) -> np.ndarray:
        """Returns the normal in the axes of body number k, not turned, without the round-off of the
        onset, because a mesh changes with every digit.
        """
        axes = np.vstack([np.zeros(len(self.normal)), np.eye(len(self.normal))])
        carried = body.outline.carried(self.shape(k), axes)
        normal = np.round((carried[1:] - carried[0]) @ self.normal, 6)
        unit: np.ndarray = normal / np.linalg.norm(normal)
        return unit

    def gaps(self, body: int, points: np.ndarray) -> np.ndarray:
        """Returns the gaps (n,) [m] between points of `body`, where it is at the onset, and the
        other surface. They serve for element sizes.
        """
        other = self.outlines[1 if body == self.first else 0]
        return other.gap_for_sizes(points) if isinstance(other, Obstacle) else other.gap(points)


def onsets_of(scene: Scene) -> list[Onset]:
    """Returns the onsets of contact of a scene: one for each body with each obstacle and for each
    two bodies that may come near each other, and those that follow because an impact turns the
    bodies. They are searched once for all scenes that move alike.
    """
    if "onsets" not in scene.memory:
        scene.memory["onsets"] = _onsets_of(scene)
    onsets: list[Onset] = scene.memory["onsets"]
    return onsets


@progress.work("searching for the first contact of the bodies")
def _onsets_of(scene: Scene) -> list[Onset]:
    scene = scene.replaced(
        bodies=[body.at_mean_velocity for body in scene.bodies],
        obstacles=[obstacle.at_mean_velocity for obstacle in scene.obstacles],
    )
    obstacles = [-1 - k for k in range(len(scene.obstacles))]
    pairs = [(i, j) for i, others in enumerate(_near(scene)) for j in [*others, *obstacles]]
    onsets = [onset for pair in pairs for onset in _in_turn(scene, _onset(scene, *pair))]
    partners: dict[int, set[int]] = {}
    for onset in onsets:
        partners.setdefault(onset.first, set()).add(onset.second)
        partners.setdefault(onset.second, set()).add(onset.first)
    return [
        replace(
            onset,
            shielded=any(
                _is_shielded(scene, onset, k)
                for k in partners[onset.first] | partners[onset.second]
                if k >= 0 and k not in (onset.first, onset.second)
            ),
        )
        for onset in onsets
    ]


def _near(scene: Scene) -> list[list[int]]:
    """Returns for each body the later bodies that it may come into contact with.

    A pair is left out if its bounding spheres stay apart on straight paths. Bodies that fall freely
    have such relative paths; driven or supported bodies do not.
    """
    places, ways = (
        np.array([getattr(body, name) for body in scene.bodies])
        for name in ("start_position", "start_velocity")
    )
    reaches = np.array([body.outline.reach for body in scene.bodies])
    free = np.array([not body.driven and not body.supports for body in scene.bodies])
    neighbours = []
    for i in range(len(scene.bodies)):
        r, v = places[i + 1 :] - places[i], ways[i + 1 :] - ways[i]
        speed = np.maximum((v * v).sum(axis=1), np.finfo(float).tiny)
        nearest = r + v * np.maximum(0.0, -(r * v).sum(axis=1) / speed)[:, None]
        within = np.linalg.norm(nearest, axis=1) <= 1.01 * (reaches[i] + reaches[i + 1 :])
        neighbours.append((i + 1 + np.flatnonzero(within | ~free[i] | ~free[i + 1 :])).tolist())
    return neighbours


def _fall(scene: Scene) -> np.ndarray:
    """Returns the acceleration of free bodies [m/s2]."""
    fall = np.zeros(scene.kind.axes)
    if "body_force_x" in scene.values:
        fall[0] = scene.number("body_force_x")
    fall[1] = scene.number("body_force_y") - scene.number("gravity")
    return fall


def _is_shielded(scene: Scene, onset: Onset, k: int) -> bool:
    """Whether body k keeps both surfaces of an onset of contact apart: on the straight way to the
    onset, the point of contact of one of them moves through body k for its half thickness or more.
    """
    shield, t = scene.bodies[k], onset.time
    other = scene.bodies[onset.second] if onset.second >= 0 else scene.obstacles[-1 - onset.second]
    if not 0 < t < math.inf:
        return False

    def fall(surface: Body | Obstacle) -> np.ndarray:
        free = isinstance(surface, Body) and not surface.supports
        return _fall(scene) * free

    # The outlines of the onset are in a frame that moves with an obstacle and falls like `other`.
    frame = other.start_velocity if isinstance(other, Obstacle) else np.zeros(len(onset.normal))
    centre = shield.start_position + (shield.start_velocity - frame) * t
    centre = centre + (fall(shield) - fall(other)) * t**2 / 2
    shape = shield.placed_at(0.0, np.zeros(len(centre)))
    before = t * np.linspace(0, 1, PARTS + 1)[:, None]
    for surface in (scene.bodies[onset.first], other):
        velocity = surface.start_velocity - shield.start_velocity
        pull = fall(surface) - fall(shield)
        path = _middle(onset) - centre - velocity * (t - before) - pull * (t**2 - before**2) / 2
        inside = shape.gap((path[:-1] + path[1:]) / 2) < 0
        through = np.linalg.norm(np.diff(path, axis=0), axis=1)[inside].sum()
        if through >= (1 - 1 / PARTS) * shield.outline.half_thickness:
            return True
    return False


def _in_turn(scene: Scene, onset: Onset) -> list[Onset]:
    """Returns an onset of contact and, in the plane, those of the same pair that follow: the impact
    turns the rigid bodies, without friction, and other corners strike.
    """
    onsets = [onset]
    while scene.kind is PLANE_STRAIN and len(onsets) <= MORE and math.isfinite(onset.time):
        rebound = _rebound(scene, onset)
        if rebound is None:
            break
        scene = rebound
        onset = _onset(scene, onset.first, onset.second)
        onsets += [onset] if math.isfinite(onset.time) else []
    return onsets


def _rebound(scene: Scene, onset: Onset) -> Scene | None:
    """Returns the scene a little after an onset of contact, when the bodies have separated, without
    gravity and body forces. None if the impact does not turn the bodies.
    """
    n = onset.normal
    point = _middle(onset)
    fall = _fall(scene) * onset.time
    # Velocity of the obstacle. Its position stays, so the body moves relative to it.
    moves = (
        scene.obstacles[-1 - onset.second].start_velocity if onset.second < 0 else np.zeros(len(n))
    )
    hit, yields, closing = [], 0.0, 0.0
    for sign, k in ((1, onset.first), (-1, onset.second)):
        if k < 0:
            closing += scene.obstacles[-1 - k].start_velocity @ n
            continue
        body, shape = scene.bodies[k], onset.shape(k)
        assert isinstance(shape, Outline)  # in the plane
        held = bool(body.supports)  # neither turns nor falls, as with infinite mass
        lever, mass = (
            _lever(shape, point, n),
            math.inf if held else body.mean_density * shape.area,
        )
        own_fall = np.zeros(len(n)) if held else fall
        yields += (1 + lever**2 / shape.gyration) / mass
        closing -= sign * ((body.start_velocity + own_fall) @ n + body.start_spin * lever)
        hit.append((sign, k, shape, lever, mass, own_fall))
    turns = [abs(lever) / shape.reach for _, _, shape, lever, mass, _ in hit if mass < math.inf]
    turning = max(turns, default=0.0)
    if closing <= 0 or turning < ECCENTRIC:
        return None
    soon, bodies = 4 * MET * onset.radius / (RESTITUTION * closing), list(scene.bodies)
    for sign, k, shape, lever, mass, own_fall in hit:
        body, push = bodies[k], sign * (1 + RESTITUTION) * closing / yields / mass
        velocity, spin = (
            body.start_velocity + own_fall + push * n,
            body.start_spin + push * lever / shape.gyration,
        )
        state = {
            "start_position": shape.area_centre + (velocity - moves) * soon,
            "start_angle": body.start_angle + body.start_spin * onset.time + spin * soon,
            "start_velocity": velocity,
            "start_spin": spin,
        }
        bodies[k] = body.model_copy(update=state)
    still: dict[str, Value] = {
        name: 0.0 for name in ("gravity", "body_force_x", "body_force_y") if name in scene.values
    }
    return scene.replaced(bodies=bodies, values=scene.values | still)


def _middle(onset: Onset) -> np.ndarray:
    """Returns the point of contact at an onset. For a face on another face it is the middle, so
    that a body set down flat does not turn.
    """
    points = np.vstack(
        [shape.points for shape in onset.outlines if not isinstance(shape, Obstacle)]
    )
    off = np.max([abs(shape.gap(points)) for shape in onset.outlines], axis=0)
    along = (points - points[off.argmin()]) @ onset.normal
    on = points[(off <= off.min() + MET * onset.radius) & (abs(along) <= MET * onset.radius)]
    middle: np.ndarray = (on.min(axis=0) + on.max(axis=0)) / 2
    return middle


def _onset(scene: Scene, first: int, second: int) -> Onset:
    body = scene.bodies[first]
    other = scene.bodies[second] if second >= 0 else scene.obstacles[-1 - second]
    # Two bodies without supports fall alike, so that gravity does not change their relative
    # velocity.
    falls = [not scene.bodies[k].supports for k in (first, second) if k >= 0]
    pull = _fall(scene) * (falls[0] - (falls[1] if second >= 0 else 0))
    start = body.start_velocity - other.start_velocity
    bodies = [surface for surface in (body, other) if isinstance(surface, Body)]
    radius = min(surface.outline.half_thickness for surface in bodies)
    loaded = max(loaded_pull(surface) for surface in bodies)
    turning = sum(
        surface.outline.fastest(surface.start_angle, surface.start_spin) * surface.outline.reach
        for surface in bodies
    )
    t, never = _first_touch(body, other, start, pull, turning, radius)
    met = not math.isinf(t)
    t = t if met else 0.0
    outlines, velocity = _at(body, other, t, pull), start + pull * t
    normal = outlines[0].normal_from(outlines[1])
    if not met:  # a later contact may have any normal: all of the velocity counts as closing
        driven = body.driven or other.driven
        never_met = Onset(
            first,
            second,
            outlines,
            float(np.linalg.norm(velocity)) + _turning_speed(other, outlines[0]),
            0.0,
            float(np.linalg.norm(pull)) + loaded,
            0.0,
            float(radius),
            math.inf,
            normal,
            never and not driven,
        )
        return replace(never_met, pressed=_pressed(scene, never_met))
    along, across = _parts(pull, normal)
    onset = Onset(
        first,
        second,
        outlines,
        *_parts(velocity, normal),
        along + loaded,
        across,
        float(radius),
        t,
        normal,
    )
    onset = replace(onset, pressed=_pressed(scene, onset))
    onset = replace(onset, sliding=onset.sliding + _turning_speed(other, outlines[0]))
    if scene.kind is not PLANE_STRAIN:
        return onset
    # `spun` [m/s] is the closing velocity of the points in contact, with that by spin.
    point, spun = _middle(onset), velocity @ normal
    for sign, k, struck in zip((1, -1), (first, second), bodies):
        shape = onset.shape(k)
        if abs(lever := _lever(shape, point, normal)) > ECCENTRIC * shape.reach:
            spun += sign * struck.start_spin * lever
    return replace(onset, closing=float(abs(spun)))


def _turning_speed(other: Body | Obstacle, shape: Shape) -> float:
    """Returns the largest speed [m/s] by rotation of a driven obstacle at the point of a body nearest
    to its pivot; 0 for others.
    """
    if not isinstance(other, Obstacle) or not other.drive:
        return 0.0
    away = np.linalg.norm(shape.points - other.drive.pivot, axis=1).min()
    return other.drive.fastest_turn * float(away)


def loaded_pull(body: Body) -> float:
    """Returns the acceleration [m/s2] of a body by its loads, each on a part as wide as the body is
    thick. A pressure all around the body or a cavity has no resultant.
    """
    stress = [
        load.largest
        for load in body.loads
        if load.kind == "traction" or (load.kind == "pressure" and load.part.name not in WHOLE)
    ]
    half = body.outline.half_thickness
    width = 2 * half if isinstance(body.outline, Outline) else math.pi * half**2
    return sum(stress) * width / (body.mean_density * body.outline.content)


def _pressed(scene: Scene, onset: Onset) -> float:
    """Returns the closing speed [m/s] of an impact with as wide a contact as the motion of a
    support or of an obstacle makes, which moves on by a depth [m] after the onset of contact.

    Half-widths b of discs: b^2 = 0.8 R depth under a support (R/10 deep), b^2 = 2 R^2 v/c in an
    impact (sizes.py). Of balls: b^2 = R depth and b = 1.31 R (v/c)^0.4.
    """
    bodies = [scene.bodies[k] for k in (onset.first, onset.second) if k >= 0]
    met = math.isfinite(onset.time)
    ends = [support.path()[1] for body in bodies for support in body.supports if support.moves]
    depths = [onset.closing * (end - onset.time) for end in ends if met]
    drive = scene.obstacles[-1 - onset.second].drive if onset.second < 0 else None
    if drive and (bodies[0].supports or _between(scene, drive)):
        moved = farthest(drive.translation)[0] - drive.shift(onset.time if met else 0.0)
        depths.append(abs(float(moved @ onset.normal)))
    share = min(0.5, max([0.0, *depths]) / onset.radius)
    bar_speed = min(math.sqrt(body.touching.young / body.touching.density) for body in bodies)
    return bar_speed * (0.4 * share if scene.kind is PLANE_STRAIN else 0.5 * share**1.25)


def _between(scene: Scene, drive: Drive) -> bool:
    """Whether a free body cannot give way to the obstacle with this drive, as there are others."""
    return any(obstacle.drive is not drive for obstacle in scene.obstacles)


def _lever(shape: Shape, point: np.ndarray, n: np.ndarray) -> float:
    """Returns the signed lever arm [m] about the centre of a body of a force along n at a point."""
    arm = point - shape.area_centre
    return float(arm[0] * n[1] - arm[1] * n[0])


def with_discs_aligned(scene: Scene) -> Scene:
    """Returns the scene with its discs turned, except those of mesh files. The point of a disc that
    first comes into contact is then the lowest point of its mesh, which is not turned.

    So the region of small elements does not depend on the frame in which the scene is written.
    """
    if scene.kind is not PLANE_STRAIN:
        return scene
    if "angles" not in scene.memory:
        scene.memory["angles"] = _angles_of_discs(scene), {}
    angles, memory = scene.memory["angles"]
    bodies = list(scene.bodies)
    for k, angle in angles.items():
        bodies[k] = bodies[k].model_copy(update={"start_angle": angle})
    return scene.replaced(memory, bodies=bodies) if angles else scene


def _angles_of_discs(scene: Scene) -> dict[int, float]:
    """Returns the angles [rad] at the start of aligned discs by the numbers of the bodies."""
    angles = {}
    for k, body in enumerate(scene.bodies):
        if body.file_mesh or not body.outline.disc:
            continue
        mine = [onset for onset in onsets_of(scene) if k in (onset.first, onset.second)]
        if not mine:
            continue
        soonest = min(onset.time for onset in mine)
        first = next(onset for onset in mine if onset.time <= soonest * (1 + 1e-9))
        outward = -first.normal if k == first.first else first.normal
        before = body.start_spin * first.time if math.isfinite(first.time) else 0.0
        angles[k] = math.atan2(outward[1], outward[0]) + math.pi / 2 - before
    return angles


def refuse_nothing(scene: Scene, onsets: list[Onset]) -> None:
    """Raises BadInput if a run whose end is automatic would have none: a body is driven, no bodies
    ever come into contact, or a body set down on an obstacle does not leave it.
    """
    driven = [surface.entry for surface in scene.surfaces if surface.driven]
    if driven and (scene.values["end_time"] == 0 or scene.values["until"] == "rest"):
        raise BadInput(
            f"end_time: {scene.values['end_time']:g} with until = '{scene.values['until']}', but "
            f"{driven[0]} is moved or loaded from the start, which has no end of its own "
            f"(accepted: an end_time > 0, until = 'impact')"
        )
    if (
        scene.values["end_time"] == 0
        and all(onset.never for onset in onsets)
        and len(scene.bodies) + len(scene.obstacles) > 1
    ):
        raise BadInput(
            "end_time: 0 is the end of the contact, but no bodies ever come into contact: they miss each other and every obstacle "
            "(accepted: an end_time > 0, or velocities and positions that lead them together)"
        )
    for onset in (
        onsets if scene.values["end_time"] == 0 and scene.values["until"] != "rest" else []
    ):
        body = scene.bodies[onset.first]
        if (
            onset.second < 0
            and onset.time == 0
            and onset.closing == 0
            and not np.any(body.start_spin)
            and _fall(scene) @ onset.normal < 0
        ):
            raise BadInput(
                f"end_time: 0 is the end of the contact, but '{body.own_name}' is set down on "
                f"'{scene.obstacles[-1 - onset.second].own_name}' and does not leave it (accepted: an end_time > 0)"
            )


def refuse_sinking(scene: Scene, onsets: list[Onset]) -> None:
    """Raises BadInput if the first contact of a body with a plane or another body is at a part of
    its boundary that is no contact boundary. It would pass through.
    """
    for k, body in enumerate(scene.bodies):
        mine = [onset for onset in onsets if k in (onset.first, onset.second)]
        first = min(mine, key=lambda onset: onset.time, default=None)
        if not first or not math.isfinite(first.time) or not body.sides:
            continue
        if 0 < scene.number("end_time") < first.time:
            continue
        own, other = first.shape(k), first.outlines[1 if k == first.first else 0]
        corners, may_touch = body.sides
        if isinstance(other, Obstacle) and other.kind != "plane":
            continue
        placed = body.outline.carried(own, corners.reshape(-1, corners.shape[2]))
        gaps = other.gap(placed)
        nearest = gaps.reshape(corners.shape[:2]).min(axis=1)
        # The point nearest to a plane is a vertex. The point nearest to a body may lie within a
        # side.
        near = MET * first.radius if isinstance(other, Obstacle) else np.ptp(corners, axis=1).max()
        if nearest[may_touch].min() > nearest.min() + near:
            partner = first.second if k == first.first else first.first
            name = (
                scene.bodies[partner] if partner >= 0 else scene.obstacles[-1 - partner]
            ).own_name
            position = ", ".join(f"{x:.3g}" for x in placed[gaps.argmin()])
            entry = "labels" if "labels" in body else "file"
            raise BadInput(
                f"body.{k + 1}.{entry}: '{body.own_name}' comes to '{name}' with ({position}) "
                f"m, which is no contact boundary and would pass through the obstacle (accepted: a file whose "
                f"label {mesh.FREE}, or physical group 'contact', is there, too)"
            )


def _parts(vector: np.ndarray, normal: np.ndarray) -> tuple[float, float]:
    """Returns the magnitudes of the components of a vector along and across a unit vector. A
    component across that is round-off becomes 0.
    """
    along, across = abs(vector @ normal), np.linalg.norm(vector - (vector @ normal) * normal)
    return float(along), float(across) if across > 1e-6 * along else 0.0


def _at(
    body: Body, other: Body | Obstacle, t: float, pull: np.ndarray
) -> tuple[Shape, Shape | Obstacle]:
    """Returns both shapes at the time t [s], in a frame that moves with an obstacle and falls like
    another body; `pull` is the acceleration of `body` in that frame.
    """
    if isinstance(other, Body):
        placed = body.placed_at(t, body.start_position + body.start_velocity * t + pull * t**2 / 2)
        return placed, other.placed_at(t, other.start_position + other.start_velocity * t)
    velocity = body.start_velocity - other.start_velocity
    return body.placed_at(t, body.start_position + velocity * t + pull * t**2 / 2), other


def _first_touch(
    body: Body,
    other: Body | Obstacle,
    start: np.ndarray,
    pull: np.ndarray,
    turning: float,
    radius: float,
) -> tuple[float, bool]:
    """Returns the time [s] of the onset of contact, infinite if none is found, and whether there
    never is contact.

    While the pair is within its search distance, conservative advancement is used: each step is so
    short that no point can travel farther than the gap.
    """
    rate, steps, met, before = float(np.linalg.norm(pull)), 0, False, math.inf
    for t, end in _within_reach(body, other, start, pull):
        while t < end:
            gap = _gap(*_at(body, other, t, pull))
            speed = float(np.linalg.norm(start + pull * t)) + turning
            met = met or gap <= MET * radius
            # The search ends when the gap is closed, or grows again as the body passes by.
            if met and (gap <= CLOSED * radius or gap >= before):
                return t, False
            steps, before = steps + 1, gap
            if steps > STEPS or gap > FAR * radius:
                return math.inf, False
            if speed + rate == 0:
                return math.inf, True
            # The step dt solves speed dt + rate dt^2 / 2 = gap.
            t += 2 * gap / (speed + math.sqrt(speed**2 + 2 * rate * gap))
    return math.inf, True


def _within_reach(
    body: Body, other: Body | Obstacle, start: np.ndarray, pull: np.ndarray
) -> Iterator[tuple[float, float]]:
    """Yields the intervals of time [s] in which the bounding sphere of the body overlaps that of
    the other body, or is near a segment of the obstacle.
    """
    if isinstance(other, Body) and not pull.any():
        yield from _passing(
            body.start_position - other.start_position,
            start,
            1.01 * (body.outline.reach + other.outline.reach),
        )
        return
    parts = [[gate.trim() for gate in gates] for gates in _gates(body, other, start, pull)]
    roots = np.concatenate(
        [gate.roots() for gates in parts for gate in gates if gate.degree() > 0] or [np.empty(0)]
    )
    times = [
        0.0,
        *sorted(
            set(roots.real[(abs(roots.imag) <= 1e-6 * abs(roots)) & (roots.real > 0)].tolist())
        ),
        math.inf,
    ]
    for begin, end in itertools.pairwise(times):
        middle = (begin + end) / 2 if end < math.inf else 2 * begin + 1
        if any(all(gate(middle) <= 0 for gate in gates) for gates in parts):
            yield begin, end


def _passing(r: np.ndarray, v: np.ndarray, within: float) -> Iterator[tuple[float, float]]:
    """Yields the interval of times t >= 0 in which |r + v t| <= within, if there is one."""
    square, along, beyond = v @ v, r @ v, r @ r - within**2
    if square == 0:
        yield from [(0.0, math.inf)] if beyond <= 0 else []
    elif (discriminant := along**2 - square * beyond) >= 0:
        first, last = (float((sign * math.sqrt(discriminant) - along) / square) for sign in (-1, 1))
        yield from [(max(0.0, first), last)] if last > 0 else []


def _gates(
    body: Body, other: Body | Obstacle, start: np.ndarray, pull: np.ndarray
) -> Iterator[list[Polynomial]]:
    """Yields a list of polynomials of time for each part of the other surface. All of a list are <=
    0 while the bounding sphere of the body is near that part.
    """
    reach = 1.01 * body.outline.reach

    def seen_from(point: np.ndarray) -> np.ndarray:
        return np.array(
            [Polynomial([x, v, a / 2]) for x, v, a in zip(body.start_position - point, start, pull)]
        )

    if isinstance(other, Body):
        yield [
            (seen_from(other.start_position) ** 2).sum() - (reach + 1.01 * other.outline.reach) ** 2
        ]
    else:
        yield from other.regions(seen_from, reach)


def _gap(first: Shape, second: Shape | Obstacle) -> float:
    """Returns the gap [m]. For two bodies far apart it is that of their bounding circles, a lower
    bound.
    """
    if isinstance(second, Obstacle):
        return second.gap_from(first)
    away, around = (
        np.linalg.norm(first.area_centre - second.area_centre),
        first.reach + second.reach,
    )
    return float(away - around) if away > 2 * around else gap_between(first, second)
