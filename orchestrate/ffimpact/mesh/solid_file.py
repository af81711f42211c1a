"""Reads solids from files: meshes of tetrahedra (gmsh's .msh, Medit's .mesh) or geometries that
gmsh meshes (.geo, .step, .stp), lengths in m: of STEP files converted from the unit that the file
declares.

Faces of a physical surface with the name `contact` may come into contact, other faces never do.
Without named physical surfaces all faces may, including those of cavities.
"""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..failure import BadInput
from . import mesh
from .mesh import FREE, Gmsh, Sizes, boundary, in_own_process, pieces
from .solid_mesh import SolidMesh, cell_volumes, cells_of, generate

__all__ = [
    "GEOMETRIES", "Geometry", "MESHES", "check", "declares_unit", "is_geometry", "meshed", "read",
    "takes_in_others",
]  # fmt: skip

MESHES, GEOMETRIES = (".msh", ".mesh"), (".geo", ".step", ".stp")
OTHERS = re.compile(r"\b(Merge|Include|ShapeFromFile)\b")  # .geo commands that read other files
# Formats that declare their unit of length; gmsh converts their lengths to m.
DECLARED = re.compile(r"\.(step|stp|iges|igs)\b", re.IGNORECASE)
CONTACT = "contact"
HEADER = b"$MeshFormat"
# Numbers of nodes by gmsh's element types; the first three nodes are the corners.
TRIANGLES = {2: 3, 9: 6}
# For a mesh that only represents the shape of a geometry: the number of elements along the largest
# extent, and the largest share of the bounding box that flat elements cut off (rounding.py).
COARSE = 15
SHAPE_CUT = 1e-3


def is_geometry(path: Path) -> bool:
    """Whether the file contains a geometry, which gmsh has to mesh."""
    return path.suffix.lower() in GEOMETRIES


@dataclass(frozen=True)
class Geometry:
    """A geometry in a file.

    `scale` is the length of a unit of the file [m]. `centre` (3,) [m] is the centre of volume in
    the coordinates of the file. `coarse` is a mesh about this centre that represents only the
    shape.
    """

    path: Path
    scale: float
    centre: np.ndarray
    coarse: SolidMesh

    def meshed(self, sizes: Sizes, cut: float) -> SolidMesh:
        """The mesh of the geometry in the coordinates of the file, in m.

        `sizes` are element sizes [m] with points relative to the centre. `cut` is the largest share
        of the bounding box that flat elements cut off at roundings (rounding.py).
        """
        bulk, contact, slack = (
            size / self.scale for size in (sizes.bulk, sizes.contact, sizes.slack)
        )
        inside = Sizes(bulk, contact, (sizes.near + self.centre) / self.scale, slack)
        return meshed(self.path, inside, cut).scaled(self.scale)


def takes_in_others(path: Path) -> bool:
    """Whether the file is a .geo file that reads other files."""
    return path.suffix.lower() == ".geo" and bool(OTHERS.search(path.read_text(errors="replace")))


def declares_unit(path: Path) -> bool:
    """Whether the file, or one that a .geo file reads, declares its unit of length."""
    text = path.read_text(errors="replace") if takes_in_others(path) else path.suffix
    return bool(DECLARED.search(text))


def read(path: Path) -> SolidMesh:
    """The mesh of a file, or a mesh that only represents the shape of a geometry.

    Lengths are those of the coordinates in the file. Raises BadInput, with the name of the file, if
    the file cannot be used.
    """
    if path.suffix.lower() not in MESHES + GEOMETRIES:
        raise BadInput(
            f"{path.name!r} is no mesh or geometry (accepted: {', '.join(MESHES + GEOMETRIES)})"
        )
    try:
        if not path.is_file():
            raise BadInput(f"{path.name!r} is no file (accepted: {', '.join(MESHES + GEOMETRIES)})")
        stamp = path.stat()
    except (OSError, ValueError) as error:
        raise BadInput(
            f"{path.name!r} cannot be read: {getattr(error, 'strerror', None) or error}"
        ) from None
    return _read(path.resolve(), stamp.st_mtime_ns)


def meshed(path: Path, sizes: Sizes | None = None, cut: float = SHAPE_CUT) -> SolidMesh:
    """The mesh of a file, or the mesh that gmsh generates for a geometry.

    `sizes` are element sizes in the coordinates of the file; without them the mesh is coarse. `cut`
    is the largest share of the bounding box that flat elements cut off at roundings (rounding.py).
    Raises BadInput, with the name of the file, if the file cannot be used.
    """
    try:
        return in_own_process(_taken, path, sizes, cut)
    except BadInput as error:
        raise BadInput(f"'{path.name}': {error}") from None


@cache
def _read(path: Path, changed: int) -> SolidMesh:
    return meshed(path)


# ---- functions that run in a separate process


def _taken(path: Path, sizes: Sizes | None, cut: float) -> SolidMesh:
    try:
        if is_geometry(path):
            return _meshed(path, sizes, cut)
        if path.suffix.lower() == ".msh":  # gmsh would run a file of unknown format as a script
            with open(path, "rb") as file:
                if not file.read(len(HEADER)) == HEADER:
                    raise BadInput(
                        f"it does not begin with {HEADER.decode()} (accepted: gmsh's .msh)"
                    )
        with mesh.gmsh_session() as gmsh:
            gmsh.open(str(path))
            return _labelled(gmsh.model)
    except BadInput:
        raise
    except Exception as error:  # gmsh raises plain exceptions
        raise BadInput(f"gmsh cannot read or mesh it: {error}") from None


def _meshed(path: Path, sizes: Sizes | None, cut: float) -> SolidMesh:
    def build(gmsh: Gmsh) -> None:
        gmsh.option.setString("Geometry.OCCTargetUnit", "M")
        gmsh.open(str(path))
        if not gmsh.model.getEntities(3):
            raise BadInput("it has no volume")
        if sizes is None:
            low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
            gmsh.option.setNumber("Mesh.MeshSizeMax", float((high - low).max()) / COARSE)

    return generate(build, sizes or Sizes(0.0, 0.0, np.empty((0, 3)), 0.0), 0, _labelled, cut)


def _labelled(model: Gmsh) -> SolidMesh:
    """The mesh of a gmsh model, with labels of boundary faces from its physical surfaces.

    Raises BadInput if the mesh cannot be used, or if the physical surface `contact` is not on the
    boundary.
    """
    points, cells = cells_of(model)
    check(points, cells)
    faces = boundary(cells)
    named = _contact_triangles(model)
    if named is None:
        return SolidMesh(points, cells, faces, np.full(len(faces), FREE))
    scale = np.ptp(points, axis=0).max()

    def keys(corners: np.ndarray) -> list[tuple[Any, ...]]:
        """Keys of triangles: their sorted corners, rounded to 1e-9 of the size of the mesh."""
        return [
            tuple(sorted(map(tuple, triangle)))
            for triangle in np.round(corners / scale, 9).tolist()
        ]

    contact_keys = set(keys(named))
    labels = np.array(
        [FREE if key in contact_keys else SolidMesh.NEVER for key in keys(points[faces])]
    )
    if not (labels == FREE).any():
        raise BadInput(f"its physical surface '{CONTACT}' is not on its boundary")
    return SolidMesh(points, cells, faces, labels)


def check(points: np.ndarray, cells: np.ndarray) -> None:
    """Raises BadInput if a tetrahedron is flat or the mesh is not one piece that hangs together by
    faces.
    """
    volumes = cell_volumes(points, cells)
    if not (volumes > 1e-12 * np.ptp(points, axis=0).max() ** 3 / len(cells)).all():
        raise BadInput(
            f"a tetrahedron is flat: its volume is {np.nanmin(volumes):.3g} m3, or it has a corner that is no number"
        )
    count = len(np.unique(pieces(len(points), cells)[cells[:, 0]]))
    if count > 1:
        raise BadInput(
            f"its tetrahedra are {count} pieces that hang together nowhere (accepted: one, a [[body]] table and a file a piece)"
        )
    _check_surface(points, boundary(cells))


def _check_surface(points: np.ndarray, faces: np.ndarray) -> None:
    """Raises BadInput if two parts of the body are connected by an edge or a point alone.

    In an accepted mesh each edge of the boundary belongs to two faces, and the faces around each
    boundary point form one closed fan.
    """
    corners = np.arange(3 * len(faces)).reshape(-1, 3)
    sides, ends = (
        triples[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2) for triples in (faces, corners)
    )
    ends = np.where((sides[:, 0] > sides[:, 1])[:, None], ends[:, ::-1], ends)
    edges, which, count = np.unique(
        np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True
    )

    def coordinates(point: int) -> str:
        return "({:g}, {:g}, {:g})".format(*points[point])

    if (count != 2).any():
        a, b = edges[np.argmax(count != 2)]
        raise BadInput(
            f"it hangs together by an edge alone, from {coordinates(a)} to {coordinates(b)} "
            f"(accepted: tetrahedra that hang together by faces)"
        )
    first, second = (
        ends[np.argsort(which.ravel(), kind="stable")].reshape(-1, 2, 2).transpose(1, 0, 2)
    )
    turns = np.unique(
        np.column_stack(
            [faces.ravel(), pieces(corners.size, np.column_stack([first.ravel(), second.ravel()]))]
        ),
        axis=0,
    )[:, 0]
    if len(twice := turns[1:][turns[1:] == turns[:-1]]):
        raise BadInput(
            f"it hangs together by a point alone, {coordinates(twice[0])} "
            f"(accepted: tetrahedra that hang together by faces)"
        )


def _contact_triangles(model: Gmsh) -> np.ndarray | None:
    """Corners (t, 3, 3) of the triangles in physical surfaces with the name `contact`.

    Returns None if no physical surface has a name. Raises BadInput if only others have names.
    """
    names = {
        number: model.getPhysicalName(2, number).strip().lower()
        for _, number in model.getPhysicalGroups(2)
    }
    if not any(names.values()):
        return None
    if CONTACT not in names.values():
        raise BadInput(
            f"none of its physical surfaces ({', '.join(filter(None, names.values()))}) has the name '{CONTACT}' (accepted: "
            f"such a one, or none with a name)"
        )
    tags, coordinates, _ = model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=int)
    row[tags] = np.arange(len(tags))
    corners = [
        row[np.reshape(nodes, (-1, TRIANGLES[kind]))[:, :3]]
        for number, name in names.items()
        if name == CONTACT
        for surface in model.getEntitiesForPhysicalGroup(2, number)
        for kind, _, nodes in zip(*model.mesh.getElements(2, surface))
        if kind in TRIANGLES
    ]
    triangles = np.vstack(corners or [np.empty((0, 3), dtype=int)])
    placed: np.ndarray = coordinates.reshape(-1, 3)[triangles]
    return placed
