"""Reads the field snapshots of a run: ASCII .vtu files of triangles, and the .pvd list of their times."""

import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .failure import Unreadable

TRIANGLE, QUADRATIC_TRIANGLE = 5, 22   # VTK's cell types
SPLIT = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]   # a quadratic triangle (corners 0-2, middles 3-5) as four


@dataclass(frozen=True)
class Snapshot:
    """points (n, 2) reference coordinates in m; triangles (t, 3) straight; fields by name, SI units: (n,), (n, 3) for vectors,
    (n, 6) for the Cauchy stress (xx yy zz xy yz xz)."""

    points: np.ndarray
    triangles: np.ndarray
    fields: dict[str, np.ndarray]


def read(path: Path) -> Snapshot:
    """One snapshot; quadratic triangles are split into four straight ones. Unreadable where it is not such a file."""
    try:
        piece = xml.parse(path).getroot().find("UnstructuredGrid/Piece")
        points = _array(piece.find("Points/DataArray"))
        cells = {array.get("Name"): _array(array).astype(int) for array in piece.iterfind("Cells/DataArray")}
        kinds = set(cells["types"])
        if kinds == {QUADRATIC_TRIANGLE}:
            triangles = cells["connectivity"].reshape(-1, 6)[:, SPLIT].reshape(-1, 3)
        elif kinds == {TRIANGLE}:
            triangles = cells["connectivity"].reshape(-1, 3)
        else:
            raise ValueError(f"cell types {sorted(kinds)} are not supported")
        fields = {array.get("Name"): _array(array) for array in piece.iterfind("PointData/DataArray")}
        return Snapshot(points[:, :2], triangles, fields)
    except (OSError, xml.ParseError, AttributeError, KeyError, ValueError, IndexError) as error:
        raise Unreadable(f"{path} cannot be read: {error}") from None


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
