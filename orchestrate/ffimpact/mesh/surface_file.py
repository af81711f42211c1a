"""Reads closed surfaces of triangles for rigid obstacles from files.

The files are STL files, and meshes of surfaces or volumes in gmsh's and Medit's formats.
"""

from pathlib import Path

import numpy as np

from ..failure import BadInput
from . import mesh
from .mesh import boundary, elements_of, in_own_process

__all__ = ["read"]

FILES = (".stl", ".msh", ".mesh")
# Numbers of nodes by gmsh's element types; the first nodes are the corners.
TRIANGLES, TETRAHEDRA = {2: 3, 9: 6}, {4: 4, 11: 10}
SAME = 1e-7  # grid relative to the size of the surface; vertices that round to one point are merged
MOST = 200_000  # largest number of triangles


def read(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices (n, 3), in units of the file, and triangles (t, 3) as numbers of vertices.

    Triangles are counter-clockwise seen from outside. Raises BadInput, with the name of the file,
    if the file cannot be read or the surface is not closed.
    """
    if path.suffix.lower() not in FILES:
        raise BadInput(f"'{path.name}' is no surface (accepted: {', '.join(FILES)})")
    try:
        path.stat()
        if not path.is_file():
            raise BadInput(f"'{path.name}' is no file (accepted: {', '.join(FILES)})")
    except (OSError, ValueError) as error:
        raise BadInput(
            f"'{path.name}' cannot be read: {getattr(error, 'strerror', None) or error}"
        ) from None
    try:
        return in_own_process(_taken, path)
    except BadInput as error:
        raise BadInput(f"'{path.name}': {error}") from None


def _taken(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Reads a surface in the separate process; see `read`."""
    with mesh.gmsh_session() as gmsh:
        try:
            gmsh.open(str(path))
        except Exception as error:  # gmsh raises plain exceptions
            raise BadInput(f"gmsh cannot read it: {ascii(str(error))[1:-1]}") from None
        if gmsh.model.mesh.getElementTypes(3).size:
            points, cells, _ = elements_of(
                gmsh.model, (3,), TETRAHEDRA, "tetrahedron", "tetrahedra"
            )
            triangles = boundary(cells)
        else:
            points, triangles, _ = elements_of(gmsh.model, (2,), TRIANGLES, "triangle", "triangles")
    if len(triangles) > MOST:
        raise BadInput(f"it has {len(triangles)} triangles (accepted: up to {MOST})")
    return _closed(*_merged(points, triangles))


def _merged(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Merges vertices at the same position and removes degenerate triangles and unused vertices."""
    size = np.ptp(points, axis=0).max()
    if not size > 0:
        raise BadInput("all of its vertices are at one place")
    _, first, which = np.unique(
        np.round(points / (SAME * size)), axis=0, return_index=True, return_inverse=True
    )
    triangles = which.ravel()[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    used, triangles = np.unique(triangles, return_inverse=True)
    return points[first[used]], triangles.reshape(-1, 3)


def _closed(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The surface with triangles counter-clockwise seen from outside.

    Raises BadInput if the surface is not closed or its triangles are not oriented consistently.
    """
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, count = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    if (count != 2).any():
        raise BadInput(
            f"it is not closed: {int((count != 2).sum())} edges do not belong to two triangles "
            f"(accepted: the closed surface of a solid)"
        )
    if len(np.unique(sides, axis=0)) < len(sides):
        raise BadInput(
            "its triangles are not all turned alike (accepted: counter-clockwise from outside)"
        )
    a, b, c = points[triangles].transpose(1, 0, 2)
    volume = (a * np.cross(b, c)).sum()
    return points, triangles if volume > 0 else triangles[:, ::-1]
