"""Outlines in the plane: closed curves, their areas, what is inside, distances to them. Points are
arrays (n, 2) in m.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..input.rules import SHORTEST

__all__ = [
    "Loop",
    "Outline",
    "Shape",
    "TubeOutline",
    "circle_loop",
    "cross",
    "ellipse_loop",
    "folding",
    "normal_of",
    "polygon_centre",
    "polygon_loop",
    "rotation",
    "self_crossing",
    "signed_area",
]

SAMPLES = 400  # points on a loop where its shape is wanted as a polygon
CHUNK = 500  # points at a time, against as many segments as there are
FINEST = 4000  # points on an outline at most where it is asked what touches
COARSEST = 400
FLUSH = 1e-6  # of the bounding radius: gaps that differ by no more are one face on another


@dataclass(frozen=True)
class Loop:
    """A closed curve, counter-clockwise: the polygon through `corners`, or, where `semi_axes`
    are given, the ellipse whose four extreme points (right, top, left, bottom) the corners are.
    Piece k leads from corner k to the next, straight or, where `hubs` (n, 2) has a centre for
    it and not nan, along a circle.
    """

    corners: np.ndarray
    semi_axes: np.ndarray | None = None
    hubs: np.ndarray | None = None

    @property
    def centre(self) -> np.ndarray:
        """Centre of the ellipse."""
        return self.corners.mean(axis=0)

    @property
    def radius(self) -> float | None:
        """That of a circle, None for anything else."""
        is_circle = self.semi_axes is not None and self.semi_axes[0] == self.semi_axes[1]
        return float(self.semi_axes[0]) if is_circle else None

    @property
    def circles(self) -> list[tuple[np.ndarray, float]]:
        """Centres and radii of the circles that it is, or that pieces of it lie on."""
        if self.hubs is None:
            return [(self.centre, self.radius)] if self.radius else []
        which, first, *_ = self._arcs
        radii = np.linalg.norm(first, axis=1)
        _, once = np.unique(
            np.column_stack([self.hubs[which], np.round(radii / radii.max(), 6)]),
            axis=0,
            return_index=True,
        )
        return [(self.hubs[which[k]], float(radii[k])) for k in once]

    @cached_property
    def _arcs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Pieces along circles: which, the radius vectors of their ends, and the angles
        [rad] between these, positive counter-clockwise.
        """
        which = (
            np.flatnonzero(~np.isnan(self.hubs[:, 0]))
            if self.hubs is not None
            else np.array([], dtype=int)
        )
        a, b = (
            ends[which] - self.hubs[which] if len(which) else np.empty((0, 2))
            for ends in (self.corners, np.roll(self.corners, -1, axis=0))
        )
        return which, a, b, np.arctan2(cross(a, b), (a * b).sum(axis=1))

    def at(self, piece: int, s: np.ndarray) -> np.ndarray:
        """Points of a piece at the parameters s in [0, 1]; s = 0 is the corner itself,
        where there are no hubs to the last digit.
        """
        a, b = self.corners[piece], self.corners[(piece + 1) % len(self.corners)]
        which, first, last, angles = self._arcs
        if len(k := np.flatnonzero(which == piece)):
            turn = angles[k[0]]
            along = np.sin(np.outer(1 - s, turn)) * first[k] + np.sin(np.outer(s, turn)) * last[k]
            return self.hubs[piece] + along / np.sin(turn)
        if self.semi_axes is None:
            return a + s[:, None] * (b - a)
        turn = (
            np.pi / 2 * s[:, None]
        )  # the ellipse is an affine circle: conjugate radii a - c and b - c
        return self.centre + np.cos(turn) * (a - self.centre) + np.sin(turn) * (b - self.centre)

    def sampled(self, spacing: float) -> np.ndarray:
        """The loop as a polygon with all its corners and sides up to about `spacing`."""
        counts = [
            max(1, int(np.ceil(length / spacing - 1e-9))) for length in self.lengths
        ]  # not one more by round-off
        return np.vstack([self.at(k, np.arange(n) / n) for k, n in enumerate(counts)])

    @cached_property
    def lengths(self) -> np.ndarray:
        """Lengths of the pieces; of an ellipse to a millionth."""
        s = np.linspace(0, 1, 2 if self.semi_axes is None and self.hubs is None else 1001)
        return np.array(
            [
                np.linalg.norm(np.diff(self.at(k, s), axis=0), axis=1).sum()
                for k in range(len(self.corners))
            ]
        )

    @cached_property
    def polygon(self) -> np.ndarray:
        """The loop as a polygon of some hundreds of sides, all its corners among them."""
        return self.sampled(self.lengths.sum() / SAMPLES)

    @property
    def sides(self) -> np.ndarray:
        """The polygon with as few corners as tell its shape."""
        return self.corners if self.semi_axes is None and self.hubs is None else self.polygon

    @property
    def area(self) -> float:
        """Area inside, positive."""
        if self.semi_axes is not None:
            return float(np.pi * np.prod(self.semi_axes))
        return signed_area(self.corners) + float(self._segments[0].sum())

    @property
    def _segments(self) -> tuple[np.ndarray, np.ndarray]:
        """Areas between arcs and their chords (arcs,), and first moments (arcs, 2) of these
        about the hubs: of a sector a x b (a + b)/(3 (1 + cos)), of its triangle a x b (a +
        b)/6.
        """
        _, a, b, turn = self._arcs
        square = cross(a, b)
        return (turn * (a**2).sum(axis=1) - square) / 2, (
            square * (1 / (3 + 3 * np.cos(turn)) - 1 / 6)
        )[:, None] * (a + b)

    @property
    def area_centre(self) -> np.ndarray:
        """Centre of the area inside."""
        if self.semi_axes is not None:
            return self.centre
        areas, moments = self._segments
        if not len(areas):
            return polygon_centre(self.corners)
        moment = (
            signed_area(self.corners) * polygon_centre(self.corners)
            + moments.sum(axis=0)
            + areas @ self.hubs[self._arcs[0]]
        )
        return moment / self.area

    def placed(self, centre: np.ndarray, angle: float) -> "Loop":
        """The loop turned about the origin by angle [rad], counter-clockwise, and moved by
        `centre`. A turned ellipse stays one.
        """
        turn = rotation(angle).T
        return replace(
            self,
            corners=self.corners @ turn + centre,
            hubs=None if self.hubs is None else self.hubs @ turn + centre,
        )

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points from the loop, negative inside."""
        if self.radius:
            return np.linalg.norm(points - self.centre, axis=1) - self.radius
        import shapely  # here: a disc needs none

        distance = shapely.distance(shapely.LinearRing(self.sides), shapely.points(points))
        return np.where(
            shapely.contains_xy(shapely.Polygon(self.sides), *points.T), -distance, distance
        )


def polygon_loop(corners: np.ndarray, hubs: np.ndarray | None = None) -> Loop:
    """The polygon through the corners, or along the circles about hubs, turned
    counter-clockwise.
    """
    if signed_area(corners) > 0:
        return Loop(corners, hubs=hubs)
    return Loop(corners[::-1], hubs=None if hubs is None else np.roll(hubs[::-1], -1, axis=0))


def ellipse_loop(a: float, b: float) -> Loop:
    """The ellipse about the origin with semi-axes a along x and b along y."""
    return Loop(np.array([[a, 0.0], [0.0, b], [-a, 0.0], [0.0, -b]]), np.array([a, b]))


def circle_loop(radius: float) -> Loop:
    """The circle about the origin."""
    return ellipse_loop(radius, radius)


class Shape:
    """What an outline in the plane and a solid have in common: `points` on them, signed
    distances `gap` from them, and, of a disc or ball, `disc`.
    """

    points: np.ndarray
    reach: float
    disc: tuple[np.ndarray, float] | None
    gap: Callable[[np.ndarray], np.ndarray]

    def least(self, gap: Callable[[np.ndarray], np.ndarray]) -> float:
        """The least value of a distance on it: of a disc or ball exactly, else at its points."""
        return float(
            gap(self.disc[0][None])[0] - self.disc[1] if self.disc else gap(self.points).min()
        )

    def normal_from(self, other) -> np.ndarray:
        """The outward normal of another body or an obstacle where this one is nearest to it."""
        if not getattr(other, "is_exact", True):
            return other.nearest(self)[1]
        if self.disc:
            return normal_of(other, self.disc[0])
        if getattr(other, "disc", None):
            return -normal_of(self, other.disc[0])
        gaps = other.gap(self.points)
        touching = self.points[
            gaps <= gaps.min() + FLUSH * self.reach
        ]  # of a face that lies on another its middle has a normal
        return normal_of(
            other, touching[np.linalg.norm(touching - touching.mean(axis=0), axis=1).argmin()]
        )


@dataclass(frozen=True)
class Outline(Shape):
    """What bounds a body: the loop around it first, then those of its holes."""

    loops: tuple[Loop, ...]

    @property
    def area(self) -> float:
        return self.loops[0].area - sum(hole.area for hole in self.loops[1:])

    @property
    def area_centre(self) -> np.ndarray:
        outer, *holes = self.loops
        return (
            outer.area * outer.area_centre - sum(hole.area * hole.area_centre for hole in holes)
        ) / self.area

    @property
    def length(self) -> float:
        return float(sum(loop.lengths.sum() for loop in self.loops))

    @cached_property
    def points(self) -> np.ndarray:
        """Points on all loops."""
        return np.vstack([loop.polygon for loop in self.loops])

    @property
    def extent(self) -> np.ndarray:
        """Width and height."""
        return np.ptp(self.loops[0].polygon, axis=0)

    @cached_property
    def reach(self) -> float:
        """Distance of its farthest point from the centre of its area."""
        return float(np.linalg.norm(self.loops[0].polygon - self.area_centre, axis=1).max())

    @cached_property
    def gyration(self) -> float:
        """The square [m2] of its radius of gyration about the centre of its area, of
        polygons of some hundreds of sides.
        """
        first, moments, areas = [loop.polygon - self.area_centre for loop in self.loops], [], []
        for a, b in ((one, np.roll(one, -1, axis=0)) for one in first):
            areas.append(cross(a, b).sum() / 2)
            moments.append((cross(a, b) * (a * a + a * b + b * b).sum(axis=1)).sum() / 12)
        return float((moments[0] - sum(moments[1:])) / (areas[0] - sum(areas[1:])))

    @property
    def half_thickness(self) -> float:
        """What stands for the radius of a body that is no disc: half its smaller extent, or
        2 area / length where that is less (the radius of a disc, the wall of a ring).
        """
        return float(min(self.extent.min() / 2, 2 * self.area / self.length))

    def placed(self, centre: np.ndarray, angle: float) -> "Outline":
        found = Outline(tuple(loop.placed(centre, angle) for loop in self.loops))
        found.__dict__["reach"] = self.reach  # of hundreds of sides: not once more for every place
        return found

    def turned(self, angle: float, spin: float, t: float) -> float:
        """The angle [rad] with what a spin [rad/s] adds in the time t."""
        return angle + spin * t

    def fastest(self, angle: float, spin: float) -> float:
        """No spin [rad/s] is larger that it comes to."""
        return abs(spin)

    def carried(self, moved: "Outline", points: np.ndarray) -> np.ndarray:
        """Points of this outline carried along to where it is moved, rigidly."""
        a, b = self.loops[0].corners[:2]
        c, d = moved.loops[0].corners[:2]
        turn = complex(*(d - c)) / complex(*(b - a))
        return c + (points - a) @ np.array([[turn.real, -turn.imag], [turn.imag, turn.real]]).T

    def samples(self, size: float) -> tuple[np.ndarray, float]:
        """Points on it, twice as dense as elements of a size, and their distance [m]."""
        spacing = self.length / np.clip(2 * self.length / size, COARSEST, FINEST)
        return np.vstack([loop.sampled(spacing) for loop in self.loops]), spacing

    def width(self, points: np.ndarray, spacing: float) -> float:
        """Of a stretch with these of the samples."""
        return (max(2, len(points)) - 1) * spacing

    def folding(self, revolved: bool = False) -> float:
        """The strain (or less) of the body bent until its outline, or half a section,
        touches itself; infinite where it never does.
        """
        return min(
            folding(loop.polygon[:: 1 if k == 0 else -1], self.half_thickness, revolved)
            for k, loop in enumerate(self.loops)
        )

    @property
    def disc(self) -> tuple[np.ndarray, float] | None:
        """Centre and radius of a disc, None for anything else."""
        whole = len(self.loops) == 1 and self.loops[0].radius
        return (self.loops[0].centre, whole) if whole else None

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points from the body, negative in its material, positive
        outside and in its holes.
        """
        outer, *holes = self.loops
        return np.max([outer.gap(points), *(-hole.gap(points) for hole in holes)], axis=0)


@dataclass(frozen=True)
class TubeOutline(Outline):
    """The section of a body of revolution that does not reach the axis: a loop to the right of
    it, and its mirror image. `loops` are these two.
    """

    @property
    def area(self) -> float:
        """Of both."""
        return sum(loop.area for loop in self.loops)

    @property
    def area_centre(self) -> np.ndarray:
        """On the axis."""
        return sum(loop.area_centre for loop in self.loops) / 2

    @property
    def extent(self) -> np.ndarray:
        """Width and height of the right loop: of the wall."""
        return np.ptp(self.loops[0].polygon, axis=0)

    @property
    def disc(self) -> None:
        """None: it is no ball."""
        return None

    def placed(self, centre: np.ndarray, angle: float) -> "TubeOutline":
        """The same elsewhere."""
        return TubeOutline(tuple(loop.placed(centre, angle) for loop in self.loops))

    def folding(self, revolved: bool = False) -> float:
        """As of an outline: of the right loop."""
        return folding(self.loops[0].polygon, self.half_thickness, revolved)

    def gap(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) of points from the nearer of both."""
        return np.min([loop.gap(points) for loop in self.loops], axis=0)


def normal_of(other, point: np.ndarray) -> np.ndarray:
    """The gradient (axes,) of the distance from a body or an obstacle, the outward normal, to
    eight digits; 0 where there is none.
    """
    h = max(1e-7 * np.abs(point).max(), 1e-3 * abs(other.gap(point[None])[0]), SHORTEST)
    slope = [
        (
            other.gap(point + k * h * np.eye(len(point)))
            - other.gap(point - k * h * np.eye(len(point)))
        )
        / (2 * k * h)
        for k in (1, 2)
    ]
    normal = np.round((4 * slope[0] - slope[1]) / 3, 8)  # of fourth order
    return normal / max(np.linalg.norm(normal), 0.5)


# ---- polygons, (n, 2), closed from the last to the first


def rotation(angle: float) -> np.ndarray:
    """The matrix (2, 2) that turns by angle [rad], counter-clockwise."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a_x b_y - a_y b_x of vectors (..., 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def signed_area(corners: np.ndarray) -> float:
    """Positive counter-clockwise."""
    local = corners - corners[0]  # far from the origin the products would lose digits
    return float(cross(local, np.roll(local, -1, axis=0)).sum() / 2)


def polygon_centre(corners: np.ndarray) -> np.ndarray:
    """Centre of the area inside."""
    a = corners - corners[0]
    b = np.roll(a, -1, axis=0)
    return corners[0] + ((a + b) * cross(a, b)[:, None]).sum(axis=0) / (6 * signed_area(corners))


def folding(corners: np.ndarray, thickness: float, revolved: bool) -> float:
    """Least of thickness s / w^2 over pairs of sides of a polygon, the body to its left, that
    see each other across what is empty (pair.idp): s [m] their distance, w the way along the
    polygon. A wall that closes s bends by some of that; of a ring it is 0.2 thickness / radius.
    `revolved`: sides of a meridian see none beyond the axis.
    """
    along = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(along, axis=1)
    if (cross(along, np.roll(along, -1, axis=0)) >= -1e-9 * length * np.roll(length, -1)).all():
        return math.inf  # convex
    middle, normal, place = (
        corners + along / 2,
        along @ [[0, -1], [1, 0]] / length[:, None],
        np.cumsum(length) - length / 2,
    )
    least = math.inf
    for at in range(0, len(corners), CHUNK):
        some = slice(at, at + CHUNK)
        to = middle - middle[some, None]
        distance, way = np.linalg.norm(to, axis=2), np.abs(place - place[some, None])
        ahead, behind = (to * normal[some, None]).sum(axis=2), (to * normal).sum(axis=2)
        sees = (np.minimum(ahead, -behind) > 1e-9 * distance) & (
            normal[some] @ normal.T < math.cos(math.radians(80))
        )
        if revolved:
            sees &= (middle[some, None, 0] > 0) & (middle[:, 0] > 0)
        least = min(
            least,
            (thickness * distance[sees] / np.minimum(way, length.sum() - way)[sees] ** 2).min(
                initial=math.inf
            ),
        )
    return float(least)


def self_crossing(corners: np.ndarray) -> tuple[int, int] | None:
    """Two sides of a polygon, counted from 0, that cross, touch away from a common corner, or
    fold back on each other.
    """
    import shapely

    n, sides = (
        len(corners),
        shapely.linestrings(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)),
    )
    for i, j in sorted(shapely.STRtree(sides).query(sides, predicate="intersects").T.tolist()):
        if (j - i) % n not in (0, 1, n - 1):
            return int(min(i, j)), int(max(i, j))
    along = np.roll(corners, -1, axis=0) - corners
    ahead = np.roll(along, -1, axis=0)
    folded = (cross(along, ahead) == 0) & ((along * ahead).sum(axis=1) <= 0)
    return (int(np.argmax(folded)), int((np.argmax(folded) + 1) % n)) if folded.any() else None
