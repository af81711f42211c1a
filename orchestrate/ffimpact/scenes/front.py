"""Flat strikes: a face that lands as a whole on a face or a plane sends a plane wave front through
its body.

The contact patch of a disc shrinks with the speed. A front does not, so elements, steps and penalty
are chosen to resolve the front. A bar of length L (wave speed c, modulus M = rho c^2) on a penalty
k has a front with the rise time M/(k c). The bar loses 0.051 M/(k L) of its rebound velocity and
leaves 1.68 M/(k c) late (exact solution in docs/explanation/method.md). Let tau be the time in
which the front passes one element. The penalty lets the front rise in tau / STEEPNESS, or in
LONGEST of its transit across the body if that is shorter. Then all errors are of first order in the
element size.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..geometry.outlines import Shape, TubeOutline
from ..input.dimension import SOLID
from .approach import Onset
from .bodies import Body
from .scene import Scene

__all__ = ["Front", "fronts"]

FLAT = 0.3  # smallest share of a body's width that lands while the front passes an element
PER_ACCURACY = 5.0  # element size / (length along the normal * accuracy)
STEEPNESS = 1.5  # transit of the front through an element over its rise time
LONGEST = 0.02  # largest rise time of the front over its transit across the body
BRIEF = 30.0  # transits after a strike: in longer runs the front does not matter
# By the number of axes: the largest number of unknowns of a body that a front may require; the
# unknowns of a body of area (volume) V with quadratic elements of size h, over V/h^2 (V/h^3); the
# area (volume) of an element over h^2 (h^3).
MOST_UNKNOWNS, UNKNOWNS, ELEMENT = {2: 40000, 3: 60000}, {2: 9.5, 3: 36.0}, {2: 0.43, 3: 0.12}


@dataclass(frozen=True)
class Front:
    """The wave front of one flat strike.

    `onset` is the onset of contact, `tau` [s] the time in which the front passes an element,
    `transit` [s] the shortest time in which it crosses a body. `sizes` are the element sizes [m] by
    the number of the body, `crossed` the numbers of the bodies that a plane front crosses as a
    whole.
    """

    onset: Onset
    tau: float
    transit: float
    sizes: dict[int, float]
    crossed: tuple[int, ...]

    @property
    def rise(self) -> float:
        """The required rise time [s] of the front."""
        return min(self.tau / STEEPNESS, LONGEST * self.transit)

    def penalty(self, bodies: list[Body], exponent: float) -> float:
        """Returns the penalty k [Pa/m^m] for which the front has the time `rise`: t_N = k p^m is
        the pressure rho c v at the penetration p = v rise.
        """
        return self._pressure(bodies) / (self.onset.closing * self.rise) ** exponent

    def rise_on(self, penalty: float, bodies: list[Body], exponent: float) -> float:
        """Returns the rise time [s] of the front on a penalty [Pa/m^m]."""
        return (self._pressure(bodies) / penalty) ** (1 / exponent) / self.onset.closing

    def _pressure(self, bodies: list[Body]) -> float:
        """Returns rho c v [Pa], with the impedances rho c of two bodies in series."""
        impedances = [bodies[k].density * bodies[k].wave_speed for k in self.sizes]
        return self.onset.closing / sum(1 / impedance for impedance in impedances)


def fronts(scene: Scene, onsets: list[Onset]) -> list[Front]:
    """Returns the flat strikes among the onsets of contact `onsets`. A strike is left out if the run
    continues for more than BRIEF transits after it.
    """
    if scene.values["until"] == "rest":
        return []
    strikes = [onset for onset in onsets if math.isfinite(onset.time) and onset.closing > 0]
    landings = [front for onset in strikes if (front := _front(scene, onset))]
    end = scene.values["end_time"]
    return [front for front in landings if end <= front.onset.time + BRIEF * front.transit]


def _front(scene: Scene, onset: Onset) -> Front | None:
    """Returns the front at an onset of contact, None if no body lands flat."""
    bodies = {k: scene.bodies[k] for k in (onset.first, onset.second) if k >= 0}
    sizes = {k: body.mesh_size or _size(scene, onset, k) for k, body in bodies.items()}  # [m]
    crossed = tuple(
        k for k, body in bodies.items() if not body.rigid and _lands_flat(onset, k, body, sizes[k])
    )
    if not crossed:
        return None
    tau = min(sizes[k] / bodies[k].wave_speed for k in crossed)
    transit = min(_length(onset, k) / bodies[k].wave_speed for k in crossed)
    alike = {k: tau * body.wave_speed for k, body in bodies.items()}
    return Front(onset, tau, transit, alike, crossed)


def _size(scene: Scene, onset: Onset, k: int) -> float:
    """Returns the element size [m] of body k: that of the mesh file, or the size that the accuracy
    requires.

    The latter keeps the body below MOST_UNKNOWNS, and gives at least four elements across the
    thickness.
    """
    body, axes = scene.bodies[k], scene.dimension.axes
    content = body.outline.volume if scene.dimension is SOLID else body.outline.area  # [m3], [m2]
    if body.mesh:
        cells = body.mesh.cells if scene.dimension is SOLID else body.mesh.triangles
        return (content / len(cells) / ELEMENT[axes]) ** (1 / axes)
    accuracy = scene.values["accuracy"] / (1 if scene.values["accuracy_of"] == "promised" else 2)
    least = (UNKNOWNS[axes] * content / MOST_UNKNOWNS[axes]) ** (1 / axes)
    required = max(least, PER_ACCURACY * accuracy * _length(onset, k))
    return min(body.outline.half_thickness / 2, required)


def _shape(onset: Onset, k: int) -> Shape:
    """Returns the shape of body k at the onset of contact."""
    return onset.outlines[0 if k == onset.first else 1]


def _length(onset: Onset, k: int) -> float:
    """Returns the length [m] of body k along the contact normal."""
    return float(np.ptp(_shape(onset, k).points @ onset.normal))


def _lands_flat(onset: Onset, k: int, body: Body, size: float) -> bool:
    """Whether at least the share FLAT of the width of body k lands while the front passes an
    element of the given size [m].
    """
    points, spacing = body.outline.samples(min(size, body.outline.half_thickness / 2))
    moved = body.outline.carried(_shape(onset, k), points)
    gaps = onset.gaps(k, moved)
    landing = moved[gaps <= gaps.min() + onset.closing * size / body.wave_speed]
    walls = moved[moved[:, 0] > 0] if isinstance(body.outline, TubeOutline) else moved
    width = min(np.ptp(walls @ axis) for axis in _tangents(onset.normal))
    return len(landing) > 1 and bool(body.outline.width(landing, spacing) >= FLAT * width)


def _tangents(normal: np.ndarray) -> list[np.ndarray]:
    """Returns unit vectors orthogonal to a normal: one in the plane, two in space."""
    if len(normal) == 2:
        return [np.array([-normal[1], normal[0]])]
    return list(np.linalg.svd(normal[None])[2][1:])
