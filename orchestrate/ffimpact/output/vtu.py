"""Reads the field snapshots of a run: .vtu files of triangles or tetrahedra, and the .pvd list of
their times.
"""

import xml.etree.ElementTree as xml
from collections.abc import Sequence
from contextlib import redirect_stderr
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..mesh.mesh import interfaces
from .results import Contents, content, reading

__all__ = [
    "FACES",
    "Skin",
    "Snapshot",
    "Solid",
    "between",
    "cut_in_plane",
    "lattice",
    "read",
    "read_parts",
    "read_solid",
    "series",
    "sides_between",
    "split",
]

KINDS = TRIANGLE, QUADRATIC_TRIANGLE, QUADRATIC_TETRAHEDRON = "triangle", "triangle6", "tetra10"
# Largest number of straight triangles along a side of a quadratic one, and of all. There are always
# at least two along a side.
FINEST, MOST = 6, 2_000
# Straight tetrahedra of a quadratic one: those at its corners and four about the diagonal 4-9.
EIGHT = [
    [0, 4, 6, 7],
    [4, 1, 5, 8],
    [6, 5, 2, 9],
    [7, 8, 9, 3],
    [4, 9, 5, 6],
    [4, 9, 6, 7],
    [4, 9, 7, 8],
    [4, 9, 8, 5],
]

# By the number of corners above the plane, which come first: the triangles of the cut, each as the
# three edges of the tetrahedron that cross the plane.
CUTS = {
    1: [[[0, 1], [0, 2], [0, 3]]],
    2: [[[0, 2], [0, 3], [1, 3]], [[0, 2], [1, 3], [1, 2]]],
    3: [[[0, 3], [1, 3], [2, 3]]],
}
# Faces of a quadratic tetrahedron, as quadratic triangles.
FACES = [[0, 1, 2, 4, 5, 6], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 2, 3, 6, 9, 7]]


NO_SIDES = np.empty((0, 2), dtype=int)


@dataclass(frozen=True)
class Snapshot:
    """Fields on straight triangles.

    `points` (n, 2) are reference coordinates [m], `triangles` (t, 3) their corners. `fields` holds
    the fields by name in SI units: scalars (n,), vectors (n, 3), the Cauchy stress (n, 6) (xx yy zz
    xy yz xz). `interfaces` (e, 2) are sides between layers. For a body in
    three dimensions these are those of its cut with the plane z = 0 of the
    reference configuration.
    """

    points: np.ndarray
    triangles: np.ndarray
    fields: Contents[np.ndarray]
    interfaces: np.ndarray = field(default_factory=lambda: NO_SIDES)


@dataclass(frozen=True)
class Solid:
    """A body in three dimensions: `points` (n, 3) are reference coordinates [m], `tetrahedra` (t,
    10) quadratic, `fields` as in a Snapshot, `layers` (t,) the numbers of their layers, 0 for none.
    """

    points: np.ndarray
    tetrahedra: np.ndarray
    fields: Contents[np.ndarray]
    layers: np.ndarray


@dataclass(frozen=True)
class Skin:
    """Quadratic triangles split into straight ones, `triangles` (t, 3) between vertices.

    Each vertex is the combination `shape` (m, 6) of the `nodes` (m, 6) of a quadratic triangle: its
    corners, then the middles of the sides 01, 12, 20.
    """

    nodes: np.ndarray
    shape: np.ndarray
    triangles: np.ndarray

    def at(self, field: np.ndarray) -> np.ndarray:
        """Returns the field (nodes, ...) at the vertices (m, ...)."""
        values: np.ndarray = np.einsum("ma,ma...->m...", self.shape, field[self.nodes])
        return values


def read(path: Path) -> Snapshot:
    """Returns one snapshot. Raises Unreadable if the file is no snapshot.

    Quadratic triangles, and the faces of quadratic tetrahedra in the plane z = 0, are split into so
    many straight triangles that curved sides look curved. A body in three dimensions without such
    faces is cut in this plane.
    """
    points, kind, cells, fields, _, layers = read_parts(path)
    on_plane = np.ones(len(points), dtype=bool)
    if kind == QUADRATIC_TETRAHEDRON:
        on_plane, solid = np.abs(points[:, 2]) < 1e-9 * np.ptp(points, axis=0).max(), cells
        cells, owners = _in_plane(solid, on_plane, points)
        if not len(cells):
            return cut_in_plane(Solid(points, solid, fields, layers), on_plane)
        layers = layers[owners]
    row = np.cumsum(on_plane) - 1
    points, cells = points[on_plane, :2], row[cells]
    flat = {name: field[on_plane] for name, field in fields.items()}
    if kind != TRIANGLE:
        curved = split(cells.tobytes(), int(np.clip(np.sqrt(MOST / max(1, len(cells))), 2, FINEST)))
        points, cells = curved.at(points), curved.triangles
        flat = {name: curved.at(field) for name, field in flat.items()}
    return Snapshot(points, cells, Contents(flat, path), sides_between(cells, layers))


def sides_between(triangles: np.ndarray, layers: np.ndarray) -> np.ndarray:
    """Returns the sides (e, 2) between triangles of different layers. Each of `layers` is that of as
    many triangles in a row.
    """
    between: np.ndarray = interfaces(triangles, np.repeat(layers, len(triangles) // len(layers)))
    return between


def read_solid(path: Path) -> Solid | None:
    """Returns a snapshot of a whole body in three dimensions, None for a body in the plane."""
    points, kind, cells, fields, _, layers = read_parts(path)
    return Solid(points, cells, fields, layers) if kind == QUADRATIC_TETRAHEDRON else None


def read_parts(
    path: Path,
) -> tuple[np.ndarray, str, np.ndarray, Contents[np.ndarray], np.ndarray, np.ndarray]:
    """Returns the points, the common type of the cells, their nodes (cells, nodes), the fields, and
    the numbers of the body and of the layer of each cell, 0 outside of layers. Raises Unreadable if the file is no snapshot.
    """
    import meshio  # slow to load, so it is imported only here

    content(path)  # checks that the file is as the run has written it
    with reading(path):
        try:
            # Warnings of meshio are hidden. A missing field is reported where it is needed.
            with redirect_stderr(None):
                mesh = meshio.vtu.read(path)
        except meshio.ReadError as error:
            raise ValueError(str(error) or "it is no VTU file") from None
        kinds = {block.type for block in mesh.cells}
        if len(kinds) != 1 or not kinds <= set(KINDS):
            raise ValueError(f"cell types {', '.join(sorted(kinds))} are not supported")
        nodes = mesh.cells[0].data
        if nodes.min() < 0 or nodes.max() >= len(mesh.points):
            raise ValueError("a node is missing")
        body = mesh.cell_data.get("body", [np.ones(len(nodes), np.int32)])[0]
        layers = mesh.cell_data.get("layer", [np.zeros(len(nodes), np.int32)])[0]
        return mesh.points, kinds.pop(), nodes, Contents(mesh.point_data, path), body, layers


@lru_cache(1)  # all snapshots of a run have the same triangles
def split(cells: bytes, n: int) -> Skin:
    """Returns quadratic triangles (t, 6), as bytes, split into n * n straight ones each.

    Adjacent triangles share vertices: a vertex is identified by the corners and its barycentric
    coordinates.
    """
    nodes = np.frombuffer(cells, dtype=int).reshape(-1, 6)
    places, values, triangles = lattice(n)
    shares = np.rint(n * places).astype(int)[None].repeat(len(nodes), axis=0)  # (cells, points, 3)
    owners = np.where(shares > 0, nodes[:, None, :3], -1)
    order = np.argsort(owners, axis=2)
    keys = np.concatenate(
        [np.take_along_axis(array, order, axis=2) for array in (owners, shares)], axis=2
    ).reshape(-1, 6)
    _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return Skin(
        nodes[first // len(values)],
        values[first % len(values)],
        which.reshape(len(nodes), -1)[:, triangles].reshape(-1, 3),
    )


def lattice(n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns a triangle as n * n straight ones: their corners (points, 3) in barycentric
    coordinates, the values (points, 6) there of the quadratic shape functions of the corners and
    the middles of 01, 12, 20, and the triangles (n * n, 3).
    """
    points = [(i, j) for j in range(n + 1) for i in range(n + 1 - j)]
    number = {point: k for k, point in enumerate(points)}
    b, c = np.array(points).T / n
    a = 1 - b - c
    values = np.stack(
        [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a], axis=1
    )
    up = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in points if i + j < n]
    down = [
        (number[i + 1, j], number[i + 1, j + 1], number[i, j + 1])
        for i, j in points
        if i + j < n - 1
    ]
    return np.stack([a, b, c], axis=1), values, np.array(up + down)


def _in_plane(
    tetrahedra: np.ndarray, on_plane: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the faces (f, 6) of quadratic tetrahedra (t, 10) whose nodes are all marked in
    `on_plane`, each once, counter-clockwise, and the tetrahedron (f,) of each.
    """
    faces = tetrahedra[:, FACES].reshape(-1, 6)
    marked = np.flatnonzero(on_plane[faces].all(axis=1))
    corners = np.sort(faces[marked, :3], axis=1)
    marked = marked[np.unique(corners, axis=0, return_index=True)[1]]
    faces, owners = faces[marked], marked // len(FACES)
    (ax, ay), (bx, by), (cx, cy) = (points[faces[:, k], :2].T for k in range(3))
    clockwise = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax)
    turned: np.ndarray = np.where(clockwise[:, None], faces[:, [0, 2, 1, 5, 4, 3]], faces)
    return turned, owners


def cut_in_plane(solid: Solid, on_plane: np.ndarray) -> Snapshot:
    """Returns the cut of a body with the plane z = 0. Nodes marked in `on_plane` are on it. Every
    edge that crosses the plane gives a point, to which the fields are interpolated linearly.
    """
    z = np.where(on_plane, 0.0, solid.points[:, 2])
    parts = solid.tetrahedra[:, EIGHT].reshape(-1, 4)
    # The corners above the plane come first.
    parts = np.take_along_axis(parts, np.argsort(z[parts] <= 0, axis=1, kind="stable"), axis=1)
    above = (z[parts] > 0).sum(axis=1)
    pieces = [(above == count, three) for count, cuts in CUTS.items() for three in cuts]
    edges = np.concatenate([parts[own][:, three].reshape(-1, 2) for own, three in pieces])
    of_parts = np.repeat(solid.layers, len(parts) // len(solid.layers))
    layers = np.concatenate([of_parts[own] for own, _ in pieces])
    # An edge that ends on the plane is cut at its node.
    edges[on_plane[edges[:, 1]], 0] = edges[on_plane[edges[:, 1]], 1]
    different, which = np.unique(edges, axis=0, return_inverse=True)
    (first, second), triangles = different.T, which.reshape(-1, 3)
    share = np.divide(
        z[first], z[first] - z[second], out=np.zeros(len(first)), where=first != second
    )

    def at(field: np.ndarray) -> np.ndarray:
        values: np.ndarray = (field[first].T * (1 - share) + field[second].T * share).T
        return values

    (ax, ay), (bx, by), (cx, cy) = (at(solid.points)[triangles[:, k], :2].T for k in range(3))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    triangles = np.where((area < 0)[:, None], triangles[:, ::-1], triangles)[area != 0]
    between = interfaces(triangles, layers[area != 0])
    return Snapshot(
        at(solid.points)[:, :2],
        triangles,
        Contents({name: at(field) for name, field in solid.fields.items()}, solid.fields.path),
        between,
    )


def series(pvd: Path) -> list[tuple[float, Path]]:
    """Returns (time [s], file) of every snapshot in the order of time, empty if there is no such
    list.
    """
    if not pvd.exists():
        return []
    text = content(pvd)
    with reading(pvd):
        sets = xml.fromstring(text).iterfind("Collection/DataSet")
        return sorted(
            (float(entry.attrib["timestep"]), pvd.parent / entry.attrib["file"]) for entry in sets
        )


def between(times: np.ndarray, values: Sequence[np.ndarray], t: float) -> np.ndarray:
    """Returns the value at t of `values` at `times`: linear between them, constant beyond the
    ends.
    """
    position = np.interp(t, times, np.arange(len(times)))
    low, share = int(position), position % 1
    return (1 - share) * values[low] + share * values[min(low + 1, len(values) - 1)]
