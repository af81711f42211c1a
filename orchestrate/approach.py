"""Where bodies of a scene first touch: they fly as rigid bodies, r = r0 + v t + b t^2 / 2, angle = angle0 + spin t, until the gap closes."""

import math
from dataclasses import dataclass, replace

import numpy as np

from .bodies import Body
from .dimension import PLANE_STRAIN
from .failure import BadInput
from .multibody import Multibody, gap_between
from .obstacles import Obstacle
from .outlines import Outline
from .solids import Solid

Shape = Outline | Solid
STEPS = 200                  # what has not met by then does not
FAR = 1e6                    # of the smaller thickness: a gap that does not close again
MET, CLOSED = 1e-3, 1e-9     # of the smaller thickness: a gap that counts as met, and one that is followed no further


@dataclass(frozen=True)
class Meeting:
    """Body `first` and `second` (body k, or -1 - k for obstacle k) when they first touch, or, where they do not, at the start: both
    as they are then; the parts along and across the normal, positive, of their relative velocity [m/s] and of the constant force
    between them [m/s2]; the radius that stands for the pair [m]; the time [s], infinite where they do not; the normal, outward of the second; whether as
    rigid bodies they never meet."""

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

    def gaps(self, body: int, points: np.ndarray) -> np.ndarray:
        """Gaps (n,) from the other one of the points of `body`, as it is at the meeting."""
        return self.outlines[1 if body == self.first else 0].gap(points)


def meetings(scene: Multibody) -> list[Meeting]:
    """One for each two bodies and each body with each obstacle."""
    bodies = len(scene.bodies)
    return [_meeting(scene, i, j) for i in range(bodies) for j in [*range(i + 1, bodies), *(-1 - k for k in range(len(scene.obstacles)))]]


def _meeting(scene: Multibody, first: int, second: int) -> Meeting:
    """Conservative advancement: in each step no point can come nearer than the gap."""
    body = scene.bodies[first]
    other = scene.bodies[second] if second >= 0 else scene.obstacles[-1 - second]
    pull = np.zeros(scene.dimension.axes)
    if second < 0:                                             # two bodies fall alike
        pull[:2] = scene.values.get("body_force_x", 0.0), scene.values["body_force_y"] - scene.values["gravity"]
    start = body.velocity - other.velocity
    radius = min([body.outline.half_thickness, *([other.outline.half_thickness] if second >= 0 else [])])
    turning = sum(one.outline.fastest(one.angle, one.spin) * one.outline.reach for one in (body, other) if isinstance(one, Body))
    t, met, before = 0.0, False, math.inf
    for _ in range(STEPS):
        gap = _gap(*_at(body, other, t, pull))
        met = met or gap <= MET * radius
        if met and (gap <= CLOSED * radius or gap >= before):    # closed, or passing by
            break
        before = gap
        speed, rate = np.linalg.norm(start + pull * t) + turning, np.linalg.norm(pull)
        never = not met and (speed + rate == 0 or gap > FAR * radius)
        if never:
            break
        t += 2 * gap / (speed + math.sqrt(speed**2 + 2 * rate * gap))       # speed t + rate t^2 / 2 = gap
    t = t if met else 0.0
    outlines, velocity = _at(body, other, t, pull), start + pull * t
    normal = outlines[0].normal_from(outlines[1])
    if not met:                                                # what lets them meet later may turn them in any direction
        return Meeting(first, second, outlines, float(np.linalg.norm(velocity)), 0.0, float(np.linalg.norm(pull)), 0.0, float(radius), math.inf, normal, never)
    return Meeting(first, second, outlines, *_parts(velocity, normal), *_parts(pull, normal), float(radius), t, normal)


def turned(scene: Multibody) -> Multibody:
    """The scene with its discs turned so that what touches first is their lowest point when they are not turned: where a disc is meshed finely
    does not depend on the frame in which the scene is written."""
    if scene.dimension is not PLANE_STRAIN:
        return scene
    met = meetings(scene)
    found = list(scene.bodies)
    for k, body in enumerate(scene.bodies):
        mine = [one for one in met if k in (one.first, one.second)]
        if not body.outline.disc or not mine:
            continue
        soonest = min(one.time for one in mine)
        first = next(one for one in mine if one.time <= soonest * (1 + 1e-9))
        outward = -first.normal if k == first.first else first.normal
        found[k] = replace(body, angle=math.atan2(outward[1], outward[0]) + math.pi / 2 - (body.spin * first.time if math.isfinite(first.time) else 0.0))
    return replace(scene, bodies=found)


def refuse_nothing(scene: Multibody, met: list[Meeting]) -> None:
    """BadInput where nothing can ever move, or nothing touch before an end that is left open."""
    moving = [*(one.velocity for one in [*scene.bodies, *scene.obstacles]), *(np.atleast_1d(body.spin) for body in scene.bodies)]
    forces = [scene.values.get(name, 0.0) for name in ("gravity", "body_force_x", "body_force_y")]
    if not any(np.any(one) for one in moving) and not any(forces):
        raise BadInput("velocity: 0 of every body, without spin, gravity or body force: nothing would ever move (accepted: one of them)")
    if scene.values["end_time"] == 0 and all(one.never for one in met):
        raise BadInput("end_time: 0 is the end of the contact, but nothing ever touches: the bodies miss each other and every obstacle "
                       "(accepted: an end_time > 0, or velocities and positions that lead them together)")


def _parts(vector: np.ndarray, normal: np.ndarray) -> tuple[float, float]:
    """Its parts along and across a unit vector, positive; what is left of the latter by round-off is none."""
    along, across = abs(vector @ normal), np.linalg.norm(vector - (vector @ normal) * normal)
    return float(along), float(across) if across > 1e-6 * along else 0.0


def _at(body: Body, other: Body | Obstacle, t: float, pull: np.ndarray) -> tuple[Shape, Shape | Obstacle]:
    """Both at a time, seen by one who moves with the obstacle, or falls with the bodies."""
    def flown(one: Body, velocity: np.ndarray) -> Shape:
        return one.at(t, one.position + velocity * t + pull * t**2 / 2)
    if isinstance(other, Body):
        return flown(body, body.velocity), flown(other, other.velocity)
    return flown(body, body.velocity - other.velocity), other


def _gap(first: Shape, second: Shape | Obstacle) -> float:
    """The gap; of two bodies far apart that of the circles around them, which is no larger."""
    if isinstance(second, Obstacle):
        return first.least(second.gap)
    away, around = np.linalg.norm(first.area_centre - second.area_centre), first.reach + second.reach
    return float(away - around) if away > 2 * around else gap_between(first, second)
