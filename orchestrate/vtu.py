"""Reads the field snapshots of a run: ASCII .vtu files of triangles or tetrahedra, and the .pvd list of their times."""

import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .failure import Unreadable

TRIANGLE, QUADRATIC_TRIANGLE, QUADRATIC_TETRAHEDRON = 5, 22, 24   # VTK's cell types
NODES = {TRIANGLE: 3, QUADRATIC_TRIANGLE: 6, QUADRATIC_TETRAHEDRON: 10}
SPLIT = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]   # a quadratic triangle (corners 0-2, middles 3-5) as four
FACES = [[0, 1, 2, 4, 5, 6], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 2, 3, 6, 9, 7]]   # of a quadratic tetrahedron, as quadratic triangles


@dataclass(frozen=True)
class Snapshot:
    """points (n, 2) reference coordinates in m; triangles (t, 3) straight; fields by name, SI units: (n,), (n, 3) for vectors,
    (n, 6) for the Cauchy stress (xx yy zz xy yz xz). Of a body in three dimensions all that lies in its plane of symmetry z = 0."""

    points: np.ndarray
    triangles: np.ndarray
    fields: dict[str, np.ndarray]


@dataclass(frozen=True)
class Solid:
    """A body in three dimensions: points (n, 3) reference coordinates in m; tetrahedra (t, 10) quadratic; fields as of a Snapshot."""

    points: np.ndarray
    tetrahedra: np.ndarray
    fields: dict[str, np.ndarray]


def read(path: Path) -> Snapshot:
    """One snapshot; quadratic triangles, and the faces of quadratic tetrahedra in the plane z = 0, are split into four straight ones.
    Unreadable where it is not such a file."""
    points, kind, cells, fields = _parts(path)
    on_plane = np.ones(len(points), dtype=bool)
    if kind == QUADRATIC_TETRAHEDRON:
        on_plane = np.abs(points[:, 2]) < 1e-9 * np.ptp(points, axis=0).max()
        cells = _in_plane(cells, on_plane, points)
    triangles = cells if kind == TRIANGLE else cells[:, SPLIT].reshape(-1, 3)
    row = np.cumsum(on_plane) - 1
    return Snapshot(points[on_plane, :2], row[triangles], {name: field[on_plane] for name, field in fields.items()})


def read_solid(path: Path) -> Solid | None:
    """The same of all of a body in three dimensions; None of one in the plane."""
    points, kind, cells, fields = _parts(path)
    return Solid(points, cells, fields) if kind == QUADRATIC_TETRAHEDRON else None


def _parts(path: Path) -> tuple[np.ndarray, int, np.ndarray, dict[str, np.ndarray]]:
    """Points, the type of all cells, their nodes (cells, nodes) and the fields. Unreadable where it is not such a file."""
    try:
        piece = xml.parse(path).getroot().find("UnstructuredGrid/Piece")
        points = _array(piece.find("Points/DataArray"))
        cells = {array.get("Name"): _array(array).astype(int) for array in piece.iterfind("Cells/DataArray")}
        kinds = set(cells["types"])
        if len(kinds) != 1 or not kinds <= set(NODES):
            raise ValueError(f"cell types {sorted(kinds)} are not supported")
        kind = int(kinds.pop())
        fields = {array.get("Name"): _array(array) for array in piece.iterfind("PointData/DataArray")}
        nodes = cells["connectivity"].reshape(-1, NODES[kind])
        if nodes.min() < 0 or nodes.max() >= len(points) or any(len(field) != len(points) for field in fields.values()):
            raise ValueError("a node or a value at one is missing")
        return points, kind, nodes, fields
    except (OSError, xml.ParseError, AttributeError, KeyError, ValueError, IndexError) as error:
        raise Unreadable(f"{path} cannot be read: {error}") from None


def _in_plane(tetrahedra: np.ndarray, on_plane: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The faces (f, 6) of quadratic tetrahedra (t, 10) all of whose nodes are marked in `on_plane`, each once, counter-clockwise in x, y."""
    faces = tetrahedra[:, FACES].reshape(-1, 6)
    faces = faces[on_plane[faces].all(axis=1)]
    faces = faces[np.unique(np.sort(faces[:, :3], axis=1), axis=0, return_index=True)[1]]
    (ax, ay), (bx, by), (cx, cy) = (points[faces[:, k], :2].T for k in range(3))
    clockwise = (bx - ax) * (cy - ay) < (by - ay) * (cx - ax)
    return np.where(clockwise[:, None], faces[:, [0, 2, 1, 5, 4, 3]], faces)


def series(pvd: Path) -> list[tuple[float, Path]]:
    """(time in s, file) of every snapshot, in the order of time; empty where there is no such list."""
    if not pvd.exists():
        return []
    try:
        sets = xml.parse(pvd).getroot().iterfind("Collection/DataSet")
        return sorted((float(each.get("timestep")), pvd.parent / each.get("file")) for each in sets)
    except (xml.ParseError, TypeError, ValueError) as error:
        raise Unreadable(f"{pvd} cannot be read: {error}") from None


def _array(element: xml.Element) -> np.ndarray:
    width = int(element.get("NumberOfComponents", 1))
    numbers = np.array((element.text or "").split(), dtype=float)
    return numbers.reshape(-1, width) if width > 1 else numbers
