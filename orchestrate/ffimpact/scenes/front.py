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

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..geometry.outlines import Outline, TubeOutline
from ..input.bodies import Body
from ..input.dimension import SOLID
from .approach import Onset

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = ["Front", "fronts", "stretch_of"]

FLAT = 0.3  # smallest share of a body's width that lands while the front passes an element
PER_ACCURACY = 5.0  # element size / (length along the normal * accuracy)
# A front stays plane in a body whose whole width lands and whose sides are parallel to the normal:
# the least share of the width, and of the box around the body that the body fills; 1 - |cosine of
# the angle| of two normals that count as one.
WHOLE, FILLED, ALIKE = 0.9, 0.98, 1e-6
# Waves from free sides change a plane front by the square of the ratio s of its stresses across and
# along the normal, s = lambda/(lambda + 2 mu). Elements of the length w across the normal then make
# the error 0.023 s^2 (w/R)^3 of the rebound velocity, R the half thickness (measured). It is a
# quarter of the accuracy for w/R = ACROSS (accuracy/s^2)^(1/3); w is R at most.
ACROSS = 2.2
LONGER = 10.0  # largest ratio of the lengths of an element across and along the normal
STEEPNESS = 1.5  # transit of the front through an element over its rise time
LONGEST = 0.02  # largest rise time of the front over its transit across the body
# By the number of axes: the largest number of unknowns of a body that a front may require; the
# unknowns of a body of area (volume) V with quadratic elements of size h, over V/h^2 (V/h^3); the
# area (volume) of an element over h^2 (h^3).
MOST_UNKNOWNS, UNKNOWNS, ELEMENT = {2: 40000, 3: 60000}, {2: 9.5, 3: 36.0}, {2: 0.43, 3: 0.12}


@dataclass(frozen=True)
class Front:
    """The wave front of one flat strike.

    `onset` is the onset of contact, `tau` [s] the time in which the front passes an element,
    `transit` [s] the shortest time in which it crosses a body. `sizes` are the element sizes [m] by
    the number of the body, `crossed` the numbers of the bodies that a front crosses as a whole.
    Elements of body k may have the length `across[k]` [m] across the normal if they are shorter
    along it; 0 if the front does not stay plane.
    """

    onset: Onset
    tau: float
    transit: float
    sizes: dict[int, float]
    crossed: tuple[int, ...]
    across: dict[int, float]

    @property
    def rise(self) -> float:
        """The required rise time [s] of the front."""
        return min(self.tau / STEEPNESS, LONGEST * self.transit)

    def penalty(self, bodies: list[Body], exponent: float) -> float:
        """Returns the penalty k [Pa/m^m] for which the front has the time `rise`: t_N = k p^m is
        the pressure rho c v at the penetration p = v rise.
        """
        return float(self._pressure(bodies) / (self.onset.closing * self.rise) ** exponent)

    def rise_on(self, penalty: float, bodies: list[Body], exponent: float) -> float:
        """Returns the rise time [s] of the front on a penalty [Pa/m^m]."""
        return float((self._pressure(bodies) / penalty) ** (1 / exponent) / self.onset.closing)

    def _pressure(self, bodies: list[Body]) -> float:
        """Returns rho c v [Pa], with the impedances rho c of two bodies in series."""
        impedances = [bodies[k].touching.density * bodies[k].wave_speed for k in self.sizes]
        return self.onset.closing / sum(1 / impedance for impedance in impedances)


def fronts(scene: Scene, onsets: list[Onset]) -> list[Front]:
    """Returns the flat strikes among the onsets of contact `onsets`. A strike is left out if it is
    the first contact of neither body: the one before changes the later one. A body that is set
    down, slower than constant forces make it in a transit, has no front.
    """
    if scene.values["until"] == "rest":
        return []
    first = [
        min((o.time for o in onsets if k in (o.first, o.second)), default=math.inf)
        for k in range(len(scene.bodies))
    ]
    strikes = [
        onset
        for onset in onsets
        if math.isfinite(onset.time)
        and onset.closing > 0
        and any(onset.time <= first[k] for k in (onset.first, onset.second) if k >= 0)
    ]
    landings = [front for onset in strikes if (front := _front(scene, onset, []))]
    plane = [k for k in range(len(scene.bodies)) if _stays_plane(scene, k, onsets, landings)]
    if plane:
        landings = [front for old in landings if (front := _front(scene, old.onset, plane))]
    return [
        front for front in landings if front.onset.closing > front.onset.pressing * front.transit
    ]


def stretch_of(k: int, strikes: list[Front], size: float) -> float:
    """Returns the length of the elements of body k across the normals of flat strikes over the
    length `size` [m] along them.
    """
    return min(
        (_stretch(size, front.across[k]) for front in strikes if k in front.crossed), default=1.0
    )


def _front(scene: Scene, onset: Onset, plane: list[int]) -> Front | None:
    """Returns the front at an onset of contact, None if no body lands flat. The front stays plane
    in the bodies `plane`.
    """
    bodies = {k: scene.bodies[k] for k in (onset.first, onset.second) if k >= 0}
    across = {k: _across(scene, body) if k in plane else 0.0 for k, body in bodies.items()}
    sizes = {k: body.bulk_size or _size(scene, onset, k, across[k]) for k, body in bodies.items()}
    crossed = tuple(
        k
        for k, body in bodies.items()
        if not body.rigid and _landing(onset, k, body, sizes[k]) >= FLAT
    )
    if not crossed:
        return None
    tau = min(sizes[k] / bodies[k].wave_speed for k in crossed)
    transit = min(_length(onset, k) / bodies[k].wave_speed for k in crossed)
    alike = {k: tau * body.wave_speed for k, body in bodies.items()}
    return Front(onset, tau, transit, alike, crossed, across)


def _stretch(size: float, across: float) -> float:
    """Returns the ratio of the lengths of elements across the normal [m] and along it, `size`."""
    return min(LONGER, max(1.0, across / size))


def _across(scene: Scene, body: Body) -> float:
    """Returns the length [m] that elements of a body may have across a plane front."""
    wave, shear = body.moduli
    lateral = max(1 - 2 * shear / wave, 1e-9)
    share = float(ACROSS * (_accuracy(scene) / lateral**2) ** (1 / 3))
    return body.outline.half_thickness * min(1.0, share)


def _stays_plane(scene: Scene, k: int, onsets: list[Onset], landings: list[Front]) -> bool:
    """Whether only plane fronts may cross body k, all along one normal, and the program makes its
    mesh in the plane. The body is a prism that nothing holds or loads, and on each surface that it
    may come into contact with its whole width lands, and that of the other body.
    """
    body = scene.bodies[k]
    is_set = body.file_mesh or body.bulk_size or body.mesh_stretch
    if scene.kind is SOLID or is_set or body.supports or body.loads:
        return False
    possible = [onset for onset in onsets if k in (onset.first, onset.second) and not onset.never]
    mine = [
        front
        for front in landings
        if k in front.crossed
        and all(
            scene.bodies[j].rigid or _landing(front.onset, j, scene.bodies[j], size) >= WHOLE
            for j, size in front.sizes.items()
        )
    ]
    if not mine or len(mine) < len(possible):
        return False
    normals = np.array([front.onset.own_normal(k, body) for front in mine])
    alike = abs(normals @ normals[0]) > 1 - ALIKE
    return bool(alike.all()) and _fills_box(body.flat_outline, normals[0])


def _fills_box(outline: Outline, normal: np.ndarray) -> bool:
    """Whether an outline is a rectangle with sides along the normal."""
    points = outline.loops[0].polygon
    box = np.ptp(points @ normal) * np.ptp(points @ _tangents(normal)[0])
    area = outline.loops[0].area if isinstance(outline, TubeOutline) else outline.area
    return bool(area >= FILLED * box)


def _accuracy(scene: Scene) -> float:
    """Returns the accuracy that the element sizes of a front are chosen for."""
    return scene.number("accuracy") / (1 if scene.values["accuracy_of"] == "promised" else 2)


def _size(scene: Scene, onset: Onset, k: int, across: float = 0.0) -> float:
    """Returns the element size [m] of body k along the normal, and up to `across` [m] across it:
    that of the mesh file, or the size that the accuracy requires.

    The latter keeps the body below MOST_UNKNOWNS, and gives at least four elements across the
    thickness.
    """
    body, axes = scene.bodies[k], scene.kind.axes
    content = body.outline.content
    if body.file_mesh:
        return float((content / len(body.file_mesh.elements) / ELEMENT[axes]) ** (1 / axes))
    required = PER_ACCURACY * _accuracy(scene) * _length(onset, k)
    stretch = _stretch(required, across)
    unknowns = UNKNOWNS[axes] * content / stretch ** (axes - 1)
    least = float((unknowns / MOST_UNKNOWNS[axes]) ** (1 / axes))
    return min(body.outline.half_thickness / 2, max(least, required))


def _length(onset: Onset, k: int) -> float:
    """Returns the length [m] of body k along the contact normal."""
    return float(np.ptp(onset.shape(k).points @ onset.normal))


def _landing(onset: Onset, k: int, body: Body, size: float) -> float:
    """Returns the share of the width of body k that lands while the front passes an element of the
    given size [m].
    """
    points, spacing = body.outline.samples(min(size, body.outline.half_thickness / 2))
    moved = body.outline.carried(onset.shape(k), points)
    gaps = onset.gaps(k, moved)
    landing = moved[gaps <= gaps.min() + onset.closing * size / body.wave_speed]
    walls = moved[moved[:, 0] > 0] if isinstance(body.outline, TubeOutline) else moved
    width = min(np.ptp(walls @ axis) for axis in _tangents(onset.normal))
    return body.outline.width(landing, spacing) / width if len(landing) > 1 else 0.0


def _tangents(normal: np.ndarray) -> list[np.ndarray]:
    """Returns unit vectors orthogonal to a normal: one in the plane, two in space."""
    if len(normal) == 2:
        return [np.array([-normal[1], normal[0]])]
    return list(np.linalg.svd(normal[None])[2][1:])
