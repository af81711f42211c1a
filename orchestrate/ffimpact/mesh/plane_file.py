"""Meshes of files in the plane, FreeFEM's .msh or gmsh's: reads and checks them, and finds the
circles on which their edges lie. Vertices, triangles and edges are counted from 1 in messages.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from ..failure import BadInput
from . import gmsh_file
from .groups import rows_among
from .mesh import AXIS, FREE, SIDES, WIDEST, Mesh, interfaces, pieces

__all__ = ["arc_centres", "checked", "load", "on_circle"]

MOST = 2_000_000  # largest number of vertices, triangles or edges
MOST_LABEL = 2_000_000_000
FARTHEST = 1e9  # largest coordinate [m]
FLAT = 1e-6  # smallest height of a triangle over its longest side
APART = 1e-8  # smallest distance of vertices over the extent of the mesh
ON = 1e-9  # distance from a circle or axis that counts as on it, over its radius or the extent
LEAST_EDGES = 4  # smallest number of edges of a circle
ALIKE = 1e-3  # distance of the centres of neighbouring edges on one circle, over its radius
Local = tuple[np.ndarray, float, bool]  # a circle: centre [m], radius [m], whether it turns left


def load(path: Path) -> Mesh:
    """The mesh of a file, with the centres of the circles on which edges lie. Its triangles are
    counter-clockwise, in one piece, and its boundary edges are all sides of one triangle.

    Raises BadInput, without the name of the file, if it cannot be read or used.
    """
    try:
        with open(path, "rb") as file:
            of_gmsh = file.read(1) == b"$"
        text = "" if of_gmsh else path.read_text("ascii", errors="replace")
    except OSError as error:
        raise BadInput(f"cannot be read: {error.strerror}") from None
    made = gmsh_file.load(path) if of_gmsh else _read(text)
    return checked(made)


def checked(made: Mesh) -> Mesh:
    """The mesh with the centres of the circles on which edges lie; raises BadInput if it cannot be
    used.
    """
    _check(made)
    return replace(made, arc_centres=arc_centres(made))


# ---- FreeFEM's format


def _read(text: str) -> Mesh:
    """Reads numbers of vertices, triangles and edges; then x y label [m] of each vertex, v1 v2 v3
    region of each triangle, v1 v2 label of each boundary edge.
    """
    words = text.split()
    try:
        n, t, e = (int(word) for word in words[:3])
    except ValueError:
        raise BadInput(
            "is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"
        ) from None
    for name, count, least in (("vertices", n, 3), ("triangles", t, 1), ("boundary edges", e, 3)):
        if not least <= count <= MOST:
            raise BadInput(f"{count} {name} (accepted: {least} to {MOST})")
    blocks, at = [], 3
    for name, columns, count in (
        ("vertex", "x y label", n),
        ("triangle", "v1 v2 v3 region", t),
        ("boundary edge", "v1 v2 label", e),
    ):
        width = len(columns.split())
        blocks.append(_block(words[at : at + width * count], name, columns, count))
        at += width * count
    if len(words) > at:
        raise BadInput(f"'{words[at]}' follows behind the last boundary edge (accepted: nothing)")
    if not text[-1].isspace():  # the last number may be cut off
        raise BadInput(f"ends at boundary edge {e} (accepted: a line end behind its label)")
    points, triangles, edges = blocks
    cells, sides = (block.astype(int) for block in (triangles, edges))
    parts = {
        str(region): np.flatnonzero(cells[:, 3] == region) for region in np.unique(cells[:, 3])
    }
    outer = np.ones(len(sides), dtype=bool)  # FreeFEM lists sides between regions, too
    outer[rows_among(interfaces(cells[:, :3], cells[:, 3]), sides[:, :2])] = False
    sides = sides[outer]
    return Mesh(points[:, :2], cells[:, :3] - 1, sides[:, :2] - 1, sides[:, 2], cell_groups=parts)


def _block(words: list[str], name: str, columns: str, count: int) -> np.ndarray:
    """The numbers of `count` vertices, triangles or edges. Raises BadInput for the first that is
    wrong.
    """
    width = len(columns.split())
    try:
        numbers = np.array(words, dtype=float)
        wrong = ~np.isfinite(numbers)
        whole = np.arange(len(numbers)) % width >= (2 if name == "vertex" else 0)
        wrong |= whole & ((np.rint(numbers) != numbers) | (abs(numbers) > MOST_LABEL))
        first = int(wrong.argmax()) if wrong.any() else -1
    except ValueError:
        first = next(k for k, word in enumerate(words) if not _is_number(word))
    if first >= 0:
        raise BadInput(f"{name} {first // width + 1} is not {columns} in numbers")
    if len(words) < width * count:
        raise BadInput(f"ends at {name} {len(words) // width + 1} of {count}")
    return numbers.reshape(count, width)


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


# ---- checks: each reports the first item that fails it


def _check(made: Mesh) -> None:
    _check_numbers(made)
    _check_triangles(made)
    _check_places(made)
    _check_sides(made)
    _check_outline(made)
    _check_axis(made)


def _named(name: str, k: int, corners: np.ndarray) -> str:
    return f"{name} {k + 1} (vertices {', '.join(map(str, corners + 1))})"


def _triangle(made: Mesh, k: int) -> str:
    return _named("triangle", k, made.triangles[k])


def _edge(made: Mesh, k: int) -> str:
    return _named("boundary edge", k, made.edges[k])


def _vertex(made: Mesh, k: int) -> str:
    return "vertex {} at ({:g}, {:g})".format(k + 1, *made.points[k])


def _refuse(wrong: Any, message: Callable[[int], str]) -> None:
    """Raises BadInput with message(k) for the first k whose entry in `wrong` is true."""
    if wrong.any():
        raise BadInput(message(int(wrong.argmax())))


def _check_numbers(made: Mesh) -> None:
    n = len(made.points)
    there = f" names a vertex that is not there (accepted: 1 to {n})"
    _refuse(
        made.labels < 0,
        lambda k: f"boundary edge {k + 1} has the label {made.labels[k]} (accepted: from 0)",
    )
    outside = [((part < 0) | (part >= n)).any(axis=1) for part in (made.triangles, made.edges)]
    _refuse(outside[0], lambda k: _triangle(made, k) + there)
    _refuse(outside[1], lambda k: _edge(made, k) + there)
    _refuse(
        (abs(made.points) > FARTHEST).any(axis=1),
        lambda k: f"{_vertex(made, k)} (accepted: coordinates of at most {FARTHEST:g} m)",
    )


def _check_triangles(made: Mesh) -> None:
    sides = np.roll(made.points[made.triangles], -1, axis=1) - made.points[made.triangles]
    longest2 = (sides**2).sum(axis=2).max(axis=1)
    area2 = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    _refuse(
        area2 <= FLAT * longest2,
        lambda k: (
            _triangle(made, k)
            + (
                " is clockwise (accepted: counter-clockwise)"
                if area2[k] < -FLAT * longest2[k]
                else f" is degenerate: its height is below {FLAT:g} of its longest side"
            )
        ),
    )
    unused = np.ones(len(made.points), dtype=bool)
    unused[made.triangles] = False
    _refuse(unused, lambda k: f"{_vertex(made, k)} belongs to no triangle")


def _check_places(made: Mesh) -> None:
    near = APART * np.ptp(made.points, axis=0).max()
    for first, second in sorted(scipy.spatial.cKDTree(made.points).query_pairs(near)):
        raise BadInput(
            f"vertices {first + 1} and {_vertex(made, second)[7:]} are at the same place"
        )


def _check_sides(made: Mesh) -> None:
    """Checks that a side lies between two triangles, which run along it in opposite directions, and
    is no boundary edge; or it belongs to one triangle and is one boundary edge.
    """
    cell_sides = made.triangles[:, SIDES[3]].reshape(-1, 2)
    both = np.vstack([cell_sides, made.edges])
    _, number = np.unique(np.sort(both, axis=1), axis=0, return_inverse=True)
    of_sides, of_edges = np.split(number.ravel(), [len(cell_sides)])
    count = len(both)
    owners = np.bincount(of_sides, minlength=count)
    forward = np.bincount(of_sides, cell_sides[:, 0] < cell_sides[:, 1], minlength=count)
    listed = np.bincount(of_edges, minlength=count)

    def message(k: int) -> str:
        side, owner = cell_sides[k] + 1, np.flatnonzero(of_sides == of_sides[k]) // 3
        first, last = (_triangle(made, int(t)) for t in (owner[0], owner[-1]))
        if len(owner) > 2:
            return (
                f"the side (vertices {side[0]}, {side[1]}) belongs to {len(owner)} triangles, "
                f"{first} and {last} among them"
            )
        same = set(made.triangles[owner[0]]) == set(made.triangles[owner[-1]])
        return f"{first} and {last} {'are the same' if same else 'overlap'}"

    many = owners > 2
    _refuse((many | ((owners == 2) & (forward != 1)))[of_sides], message)
    _refuse(
        ((owners == 1) & (listed == 0))[of_sides],
        lambda k: (
            f"the side (vertices {', '.join(map(str, cell_sides[k] + 1))}) of "
            f"{_triangle(made, k // 3)} is on the boundary but not among the boundary edges"
        ),
    )
    _refuse(
        ((owners != 1) | (listed != 1))[of_edges],
        lambda k: (
            _edge(made, k)
            + (
                " is no side of a triangle"
                if owners[of_edges[k]] == 0
                else " lies inside the body"
                if owners[of_edges[k]] == 2
                else " is listed twice"
            )
        ),
    )


def _check_outline(made: Mesh) -> None:
    """Checks that the body is one piece, which hangs together by sides, and that an edge may come
    into contact.
    """
    ends = np.bincount(made.edges.ravel(), minlength=len(made.points))
    _refuse(
        ends > 2,
        lambda k: (
            f"{_vertex(made, k)} has {ends[k]} boundary edges: the body hangs together by a "
            "point (accepted: 2)"
        ),
    )
    count = pieces(len(made.points), made.triangles).max() + 1
    if count > 1:
        raise BadInput(f"{count} bodies that are apart (accepted: one piece)")
    if not (made.labels == FREE).any():
        raise BadInput(
            f"no boundary edge has the label {FREE} of the contact boundary, but labels from "
            f"{made.labels.min()} to {made.labels.max()}"
        )


def _check_axis(made: Mesh) -> None:
    """Checks that half a body lies to the right of a vertical axis, and that exactly the edges on
    the axis have its label.
    """
    on = made.labels == AXIS
    if not on.any():
        return
    axis, near = made.points[made.edges[on][0, 0], 0], ON * np.ptp(made.points, axis=0).max()
    line = f" the vertical line x = {axis:g}"
    if abs(axis) > near:
        raise BadInput(
            f"its axis is x = {axis:g} (accepted: half a meridian plane, to the right of its axis "
            "x = 0)"
        )
    lies = (abs(made.points[made.edges, 0] - axis) <= near).all(axis=1)
    _refuse(
        on & ~lies,
        lambda k: (
            f"{_edge(made, k)} has the label {AXIS} of the symmetry axis but does not lie on" + line
        ),
    )
    _refuse(
        lies & ~on,
        lambda k: (
            f"{_edge(made, k)} lies on the symmetry axis,{line}, but has the label "
            f"{made.labels[k]} (accepted: {AXIS})"
        ),
    )
    lowest = int(made.points[:, 0].argmin())
    if made.points[lowest, 0] < axis - near:
        raise BadInput(
            f"{_vertex(made, lowest)} lies to the left of the symmetry axis (the edges with the "
            f"label {AXIS}),{line} (accepted: half a body to the right of its axis)"
        )


# ---- circles: at least LEAST_EDGES neighbouring edges that lie on one and span at least WIDEST
# together. All other edges are straight, also a flat among arcs.


def on_circle(
    ends: np.ndarray, centre: np.ndarray, radius: float, widest: float = WIDEST
) -> np.ndarray:
    """Whether edges with these ends (n, 2, 2) lie on a circle: their ends do, and they span at most
    the angle `widest` [rad].
    """
    off = abs(np.hypot(*(ends - centre).T) - radius).max(axis=0)
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    largest = 2 * radius * math.sin(widest / 2) * (1 + ON)
    on: np.ndarray = (off <= ON * radius) & (length <= largest)
    return on


def arc_centres(made: Mesh) -> np.ndarray:
    """The centre (2,) [m] of the circle of each edge, nan for straight edges."""
    circles: list[tuple[np.ndarray, float]] = []
    for chain in _chains(made):
        circle = _circle_through(made.points[chain])
        if circle and not any(
            max(*abs(circle[0] - centre), abs(circle[1] - radius)) <= ON * circle[1]
            for centre, radius in circles
        ):
            circles.append(circle)
    centres = np.full((len(made.edges), 2), math.nan)
    for centre, radius in circles:
        on = on_circle(made.points[made.edges], centre, radius)
        centres[on & (made.labels != AXIS)] = centre
    return centres


def _chains(made: Mesh) -> list[list[int]]:
    """The vertices of chains of at least LEAST_EDGES edges, whose local circles, through the ends
    of two neighbouring edges, nearly agree. Each edge spans at most WIDEST. Chains with ends come
    first, then closed ones.
    """
    following = dict(_oriented(made).tolist())
    label = {frozenset(edge): own for edge, own in zip(made.edges.tolist(), made.labels.tolist())}
    bends = {}  # by the middle vertex of two edges: its local circle
    for v, w in following.items():
        x = following[w]
        if AXIS not in (label[frozenset((v, w))], label[frozenset((w, x))]):
            if circle := _local_circle(*made.points[[v, w, x]]):
                bends[w] = circle
    goes_on = {w: following[w] for w in bends if _agree(bends[w], bends.get(following[w]))}
    starts = [w for w in bends if w not in set(goes_on.values())]
    chains, seen = [], set()
    before = {w: v for v, w in following.items()}
    for closed, beginnings in ((False, starts), (True, bends)):
        for w in beginnings:
            if w in seen:
                continue
            chain = [before[w], w]
            while w not in seen:
                seen.add(w)
                chain.append(following[w])
                w = goes_on.get(w, w)
            if closed:
                chain.pop()
            if len(chain) > LEAST_EDGES:
                chains.append(chain)
    return chains


def _oriented(made: Mesh) -> np.ndarray:
    """The boundary edges (e, 2) with the body to the left, in the order of the file."""
    sides = {tuple(side) for side in made.triangles[:, SIDES[3]].reshape(-1, 2).tolist()}
    return np.array([edge if tuple(edge) in sides else edge[::-1] for edge in made.edges.tolist()])


def _local_circle(p: np.ndarray, at: np.ndarray, q: np.ndarray) -> Local | None:
    """The circle through three vertices: centre [m], radius [m], and whether it turns left. None if
    they are on a line, or farther apart than edges on an arc.
    """
    (px, py), (qx, qy) = (p - at).tolist(), (q - at).tolist()
    p2, q2, off = px**2 + py**2, qx**2 + qy**2, px * qy - py * qx
    if abs(off) <= 1e-8 * math.sqrt(p2 * q2):
        return None
    centre = np.array([(qy * p2 - py * q2) / (2 * off), (px * q2 - qx * p2) / (2 * off)])
    radius = math.hypot(*centre)
    if math.sqrt(max(p2, q2)) > 2 * radius * math.sin(WIDEST / 2) * (1 + ON):
        return None
    return centre + at, radius, off > 0


def _agree(circle: Local, following: Local | None) -> bool:
    """Whether two local circles turn the same way and have nearly the same centre."""
    if following is None or circle[2] != following[2]:
        return False
    return bool(math.hypot(*(circle[0] - following[0])) < ALIKE * circle[1])


def _circle_through(points: np.ndarray) -> tuple[np.ndarray, float] | None:
    """The circle on which the edges between successive points (n, 2) lie, or None. It goes through
    three distant points: the first, the farthest from it, the farthest from their line.
    """
    x, y = (points - points[0]).T
    far = int(np.hypot(x, y).argmax())
    off = x[far] * y - y[far] * x
    third = int(abs(off).argmax())
    if off[third] == 0:
        return None
    bx, by, cx, cy = x[far], y[far], x[third], y[third]
    b2, c2 = bx**2 + by**2, cx**2 + cy**2
    centre = points[0] + np.array([cy * b2 - by * c2, bx * c2 - cx * b2]) / (2 * off[third])
    radius = math.hypot(*(points[0] - centre))
    centre[abs(centre) < 1e-12 * radius] = 0.0  # round-off
    ends = np.stack([points[:-1], points[1:]], axis=1)
    chords = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    spans = (2 * np.arcsin(np.minimum(1.0, chords / (2 * radius)))).sum()
    if spans < WIDEST * (1 - 1e-9) or not on_circle(ends, centre, radius).all():
        return None
    return centre, radius
