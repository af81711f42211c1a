"""Polylines with rounded corners as rigid obstacles: checks of the input, and signed distances.

A polyline is an open or closed chain of vertices (n, 2) [m]. The free side is to the LEFT of the
direction of travel and the solid is to the right: a closed clockwise chain is a block, a closed
counter-clockwise chain a container. An open chain continues straight beyond both ends. The surface
lies at the distance `rounding` [m] from the chain on the free side: convex corners become arcs of
this radius, concave corners stay sharp (edp/program/contact/shapes.idp).
"""

import math
from dataclasses import dataclass

import numpy as np

from ..failure import BadInput
from .outlines import cross

__all__ = ["Sides", "check", "gap", "inset", "numbers", "radius_at", "sides_of"]

# A vertex is a corner if the direction turns by more than this angle [rad]
# (edp/program/contact/shapes.idp).
CORNER = math.radians(30)
NEAR = 1e-12  # round-off tolerance of lengths, relative to the size of the chain


@dataclass(frozen=True)
class Sides:
    """The m sides of a chain: first points `start` (m, 2) [m] and unit directions `along` (m, 2).

    A side extends from `low` to `high` (m,) [m] along its direction, infinite beyond an open end.
    """

    start: np.ndarray
    along: np.ndarray
    low: np.ndarray
    high: np.ndarray
    closed: bool


def check(path: str, vertices: np.ndarray, closed: bool) -> None:
    """Raises BadInput, with the name of the entry, if the chain does not have two sides.

    `vertices` (n, 2) [m], n >= 2. A closed chain has three vertices or more. Consecutive vertices
    differ, and the chain neither turns back on itself nor crosses or touches itself.
    """
    if closed and len(vertices) < 3:
        raise BadInput(
            f"{path}.vertices: {len(vertices)} given (accepted: 3 or more points [x, y] of a closed chain)"
        )
    size = np.ptp(vertices, axis=0).max()
    steps = np.linalg.norm(
        np.diff(vertices, axis=0, append=vertices[:1] if closed else np.empty((0, 2))), axis=1
    )
    for k in np.flatnonzero(steps <= NEAR * size):
        if k == len(vertices) - 1:
            raise BadInput(
                f"{path}.vertices.{k + 1}: {_text(vertices[k])} is the first vertex again (accepted: a closed chain without it)"
            )
        raise BadInput(
            f"{path}.vertices.{k + 2}: {_text(vertices[k + 1])} is the vertex before it again (accepted: each vertex once)"
        )
    sides = _sides(vertices, closed)
    after = np.roll(sides.along, -1, axis=0)
    back = (np.sum(sides.along * after, axis=1) < 0) & (abs(cross(sides.along, after)) < 1e-9)
    for k in np.flatnonzero(back if closed else back[:-1]):
        corner = (k + 1) % len(vertices)
        raise BadInput(
            f"{path}.vertices.{corner + 1}: the chain turns back on itself at {_text(vertices[corner])} (accepted: corners of less than "
            f"180 degrees)"
        )
    crossing = _crossing(sides, size)
    if crossing:
        i, j, point = crossing
        raise BadInput(
            f"{path}.vertices: side {i + 1} and side {j + 1} meet at {_text(point)} (accepted: a chain that does not cross or "
            f"touch itself"
            + ("" if closed else "; an open one goes straight on beyond its ends")
            + ")"
        )


def inset(path: str, vertices: np.ndarray, closed: bool, radius: float) -> np.ndarray:
    """The vertices (n, 2) of a chain with all sides moved into the solid by a radius [m].

    With this radius as its rounding, that chain has the sides of the given one, and arcs that
    touch them in place of convex corners. Raises BadInput, with the name of the entry `path`, if an
    arc is larger than a side next to it, or if the solid is too thin for the arcs.
    """
    along = _sides(vertices, closed).along
    before = np.roll(along, 1, axis=0) if closed else np.vstack([along[:1], along])
    after = along if closed else np.vstack([along, along[-1:]])
    # The moved sides at a corner that turns by t meet at -r (n1 + n2)/(1 + cos t), with the normals
    # n1, n2 to the left of the directions.
    normals = (before + after)[:, ::-1] * [-1, 1]
    turns = 1 + np.sum(before * after, axis=1)
    steps = normals / turns[:, None]
    lengths = np.linalg.norm(
        np.diff(vertices, axis=0, append=vertices[:1] if closed else np.empty((0, 2))), axis=1
    )
    arcs = np.maximum(cross(after, before), 0) / turns  # tan(t/2) of convex corners
    shortened = (arcs + np.roll(arcs, -1))[: len(along)]
    finite = slice(None) if closed else slice(1, -1)  # an open chain has no ends
    largest = (lengths / np.maximum(shortened, NEAR))[finite].min(initial=np.inf)
    if radius >= largest:
        raise BadInput(
            f"{path}: {radius:g} m is too large for the sides (accepted: below {largest:.6g} m)"
        )
    moved: np.ndarray = vertices - radius * steps
    if not closed:
        moved[0] = moved[1] - lengths[0] * along[0]
        moved[-1] = moved[-2] + lengths[-1] * along[-1]
    if _crossing(_sides(moved, closed), np.ptp(moved, axis=0).max()):
        raise BadInput(
            f"{path}: {radius:g} m is too large for a solid as thin as this one (accepted: less)"
        )
    return moved


def numbers(vertices: np.ndarray, closed: bool, rounding: float) -> tuple[float, ...]:
    """The chain as the scripts read it: closed (1 or 0), rounding [m], x y [m] of each vertex."""
    return float(closed), float(rounding), *map(float, np.ravel(vertices))


def gap(points: np.ndarray, numbers: tuple[float, ...]) -> np.ndarray:
    """Signed distances (n,) [m] of points (n, 2) from the surface, negative inside the solid.

    `numbers` is the chain as the function `numbers` returns it.
    """
    sides = sides_of(numbers)
    nearest = _nearest(sides, points)
    start, along = sides.start[nearest], sides.along[nearest]
    at = np.sum((points - start) * along, axis=1)
    # vectors from the closest points
    away = points - start - np.clip(at, sides.low[nearest], sides.high[nearest])[:, None] * along
    # The sign is that of `away` . normal. At a vertex the normal is the sum of both sides' normals.
    normal = np.column_stack([-sides.along[:, 1], sides.along[:, 0]])
    before, after = normal[nearest - 1], normal[(nearest + 1) % len(normal)]
    beyond = (at > sides.high[nearest])[:, None] * after + (at < sides.low[nearest])[
        :, None
    ] * before
    side = np.sum(away * (normal[nearest] + beyond), axis=1)
    distance: np.ndarray = np.where(side < 0, -1, 1) * np.linalg.norm(away, axis=1) - numbers[1]
    return distance


def _nearest(sides: Sides, points: np.ndarray) -> np.ndarray:
    """The numbers (n,) of the sides nearest to points (n, 2)."""
    if len(sides.start) == 1 or len(points) == 0:
        return np.zeros(len(points), int)
    import shapely  # imported here: other obstacles do not need it

    far = 10 * np.ptp(np.vstack([sides.start, points]), axis=0).max() + 1  # ends of an open chain
    ends = [
        sides.start + np.clip(end, -far, far)[:, None] * sides.along
        for end in (sides.low, sides.high)
    ]
    tree = shapely.STRtree(shapely.linestrings(np.stack(ends, axis=1)))
    nearest: np.ndarray = tree.nearest(shapely.points(points))
    return nearest


def sides_of(numbers: tuple[float, ...]) -> Sides:
    """The sides of the chain `numbers`."""
    return _sides(np.reshape(numbers[2:], (-1, 2)), bool(numbers[0]))


def radius_at(point: np.ndarray, within: float, numbers: tuple[float, ...]) -> float:
    """The radius [m] of the convex corner that is next to a point (2,), infinite if there is none.

    A corner counts if its distance exceeds that of the chain by at most `within` [m].
    """
    sides = sides_of(numbers)
    before, after = (
        (np.roll(sides.along, 1, axis=0), sides.along)
        if sides.closed
        else (sides.along[:-1], sides.along[1:])
    )
    # positive clockwise: there the corner is convex, because the solid is to the right
    turn = np.arctan2(-cross(before, after), np.sum(before * after, axis=1))
    corners = (sides.start if sides.closed else sides.start[1:])[turn > CORNER]
    near = (
        np.linalg.norm(point - corners, axis=1)
        <= abs(gap(point[None], numbers)[0] + numbers[1]) + within
    )
    return numbers[1] if near.any() else np.inf


def _sides(vertices: np.ndarray, closed: bool) -> Sides:
    start, end = (
        (vertices, np.roll(vertices, -1, axis=0)) if closed else (vertices[:-1], vertices[1:])
    )
    length = np.linalg.norm(end - start, axis=1)
    low, high = np.zeros(len(length)), length.copy()
    if not closed:
        low[0], high[-1] = -np.inf, np.inf
    return Sides(start, (end - start) / length[:, None], low, high, closed)


def _crossing(sides: Sides, size: float) -> tuple[int, int, np.ndarray] | None:
    """The first two sides (i, j) that meet and are not neighbours, and their common point (2,)."""
    m, near = len(sides.start), NEAR * size
    i, j = np.triu_indices(m, 2)
    if sides.closed:
        apart = (i > 0) | (j < m - 1)
        i, j = i[apart], j[apart]
    e, f, r = sides.along[i], sides.along[j], sides.start[j] - sides.start[i]
    sine = cross(e, f)
    parallel = abs(sine) < NEAR
    sine = np.where(parallel, 1, sine)
    s, u = cross(r, f) / sine, cross(r, e) / sine
    meet = (
        (s >= sides.low[i] - near)
        & (s <= sides.high[i] + near)
        & (u >= sides.low[j] - near)
        & (u <= sides.high[j] + near)
    )
    # Parallel sides: the interval of side j along side i, for sides on one line.
    turned, offset = np.where(np.sum(e * f, axis=1) < 0, -1, 1), np.sum(r * e, axis=1)
    from_, to = np.sort([offset + turned * sides.low[j], offset + turned * sides.high[j]], axis=0)
    first, last = np.maximum(from_, sides.low[i]), np.minimum(to, sides.high[i])
    meet = np.where(parallel, (abs(cross(r, e)) <= near) & (first <= last + near), meet)
    if not meet.any():
        return None
    k = meet.argmax()
    at = s[k] if not parallel[k] else first[k] if np.isfinite(first[k]) else last[k]
    return int(i[k]), int(j[k]), sides.start[i[k]] + at * e[k]


def _text(point: np.ndarray) -> str:
    return f"[{point[0]:g}, {point[1]:g}]"
