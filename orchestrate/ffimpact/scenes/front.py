"""Flat strikes: a face that lands as a whole on a face or a plane sends a plane wave front through
its body.

The contact patch of a disc shrinks with the speed. A front does not, so elements, steps and penalty
follow the front. A bar of length L (wave speed c, modulus M = rho c^2) on a penalty k has a front
with the rise time M/(k c). It loses 0.051 M/(k L) of its rebound and leaves 1.68 M/(k c) late
(exact solution: docs: method). Let tau be the time in which the front passes one element. The
penalty lets the front rise in tau / STEEPNESS, and in LONGEST of its transit across the body at
most. Then all errors are of first order in the element size.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..geometry.outlines import Shape, TubeOutline
from ..input.dimension import SOLID
from .approach import Meeting
from .bodies import Body
from .scene import Scene

__all__ = ["Front", "fronts", "wave_speed"]

FLAT = 0.3  # share of a body's width that lands while the front passes an element
PER_ACCURACY = 5.0  # element size over the length along the normal, over the accuracy
STEEPNESS = 1.5  # elements over the rise length of the front
LONGEST = 0.02  # rise of the front over its transit across the body
BRIEF = 30.0  # transits: a run that is asked to go on for longer is not about the front
# By the number of axes: unknowns of a body that no front asks to exceed; unknowns of a body of the
# area (volume) V with quadratic elements of the size h, over V/h^2 (V/h^3); area (volume) of an
# element over h^2 (h^3).
MOST_UNKNOWNS, UNKNOWNS, ELEMENT = {2: 40000, 3: 60000}, {2: 9.5, 3: 36.0}, {2: 0.43, 3: 0.12}
STIFFEST = 0.45  # nu: the rest up to 0.5 acts on the volume of elements (docs: method)


@dataclass(frozen=True)
class Front:
    """The front of one flat strike: the meeting, the time `tau` [s] in which it passes an
    element, the shortest `transit` [s] across a body, the element sizes [m] of the bodies (by
    number), and the bodies that are `crossed` as a whole by a plane front.
    """

    meeting: Meeting
    tau: float
    transit: float
    sizes: dict[int, float]
    crossed: tuple[int, ...]

    @property
    def rise(self) -> float:
        """The time [s] in which the front is to rise."""
        return min(self.tau / STEEPNESS, LONGEST * self.transit)

    def penalty(self, bodies: list[Body], exponent: float) -> float:
        """The penalty k [Pa/m^m] that lets the front rise so: t_N = k p^m is the pressure
        rho c v at the penetration v rise.
        """
        return self._pressure(bodies) / (self.meeting.closing * self.rise) ** exponent

    def rise_on(self, penalty: float, bodies: list[Body], exponent: float) -> float:
        """The time [s] in which the front rises on a penalty [Pa/m^m]."""
        return (self._pressure(bodies) / penalty) ** (1 / exponent) / self.meeting.closing

    def _pressure(self, bodies: list[Body]) -> float:
        """rho c v [Pa], with the impedances rho c of two bodies in series."""
        impedances = [bodies[k].density * wave_speed(bodies[k]) for k in self.sizes]
        return self.meeting.closing / sum(1 / one for one in impedances)


def fronts(scene: Scene, met: list[Meeting]) -> list[Front]:
    """The flat strikes among the meetings of a scene. A run that is asked to go on for long after a
    strike has none."""
    if scene.values["until"] == "rest":
        return []
    strikes = [one for one in met if math.isfinite(one.time) and one.closing > 0]
    found = [front for one in strikes if (front := _front(scene, one))]
    end = scene.values["end_time"]
    return [front for front in found if end <= front.meeting.time + BRIEF * front.transit]


def wave_speed(body: Body) -> float:
    """c [m/s] of a plane pressure wave, sqrt((lambda + 2 mu)/rho)."""
    nu = min(body.nu, STIFFEST)
    return math.sqrt(body.young * (1 - nu) / ((1 + nu) * (1 - 2 * nu) * body.density))


def _front(scene: Scene, one: Meeting) -> Front | None:
    """The front of a meeting, None where no body lands flat."""
    bodies = {k: scene.bodies[k] for k in (one.first, one.second) if k >= 0}
    sizes = {k: body.mesh_size or _size(scene, one, k) for k, body in bodies.items()}  # [m]
    crossed = tuple(
        k for k, body in bodies.items() if not body.rigid and _lands_flat(one, k, body, sizes[k])
    )
    if not crossed:
        return None
    tau = min(sizes[k] / wave_speed(bodies[k]) for k in crossed)
    transit = min(_length(one, k) / wave_speed(bodies[k]) for k in crossed)
    alike = {k: tau * wave_speed(body) for k, body in bodies.items()}
    return Front(one, tau, transit, alike, crossed)


def _size(scene: Scene, one: Meeting, k: int) -> float:
    """The element size [m] of body k: that of its file, or what the accuracy asks for. The
    latter is no smaller than MOST_UNKNOWNS allow, and gives at least four elements across the
    thickness.
    """
    body, axes = scene.bodies[k], scene.dimension.axes
    content = body.outline.volume if scene.dimension is SOLID else body.outline.area  # [m3], [m2]
    if body.mesh:
        cells = body.mesh.cells if scene.dimension is SOLID else body.mesh.triangles
        return (content / len(cells) / ELEMENT[axes]) ** (1 / axes)
    accuracy = scene.values["accuracy"] / (1 if scene.values["accuracy_of"] == "promised" else 2)
    least = (UNKNOWNS[axes] * content / MOST_UNKNOWNS[axes]) ** (1 / axes)
    wanted = max(least, PER_ACCURACY * accuracy * _length(one, k))
    return min(body.outline.half_thickness / 2, wanted)


def _shape(one: Meeting, k: int) -> Shape:
    """Body k as it is at the meeting."""
    return one.outlines[0 if k == one.first else 1]


def _length(one: Meeting, k: int) -> float:
    """The length [m] of body k along the normal."""
    return float(np.ptp(_shape(one, k).points @ one.normal))


def _lands_flat(one: Meeting, k: int, body: Body, size: float) -> bool:
    """Whether a good part of the width of body k lands while the front passes an element [m]."""
    points, spacing = body.outline.samples(min(size, body.outline.half_thickness / 2))
    moved = body.outline.carried(_shape(one, k), points)
    gaps = one.gaps(k, moved)
    landing = moved[gaps <= gaps.min() + one.closing * size / wave_speed(body)]
    walls = moved[moved[:, 0] > 0] if isinstance(body.outline, TubeOutline) else moved
    width = min(np.ptp(walls @ axis) for axis in _tangents(one.normal))
    return len(landing) > 1 and bool(body.outline.width(landing, spacing) >= FLAT * width)


def _tangents(normal: np.ndarray) -> list[np.ndarray]:
    """Unit vectors across a normal: one in the plane, two in space."""
    if len(normal) == 2:
        return [np.array([-normal[1], normal[0]])]
    return list(np.linalg.svd(normal[None])[2][1:])
