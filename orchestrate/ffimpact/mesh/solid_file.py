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

import numpy as np

from ..failure import BadInput
from . import groups, mesh
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
        if path.suffix.lower() != ".geo":
            _bond(gmsh.model)
        if sizes is None:
            low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
            gmsh.option.setNumber("Mesh.MeshSizeMax", float((high - low).max()) / COARSE)

    return generate(build, sizes or Sizes(0.0, 0.0, np.empty((0, 3)), 0.0), 0, _labelled, cut)


def _bond(model: Gmsh) -> None:
    """Makes solids of a STEP file that touch share their faces. Solids with the same name, the last
    part of their name in the file, are a physical group; without a name they have their number.
    """
    solids = model.getEntities(3)
    names = [model.getEntityName(*solid).split("/")[-1].strip() for solid in solids]
    pieces = [[solid] for solid in solids]
    if len(solids) > 1:
        pieces = model.occ.fragment(solids, [])[1]
        model.occ.synchronize()
    of_name: dict[str, list[int]] = {}
    for number, (name, own) in enumerate(zip(names, pieces), 1):
        of_name.setdefault(name or str(number), []).extend(tag for _, tag in own)
    for name, tags in of_name.items():
        model.addPhysicalGroup(3, tags, name=name)


def _labelled(model: Gmsh) -> SolidMesh:
    """The mesh of a gmsh model, with labels of boundary faces from its physical surfaces.

    Raises BadInput if the mesh cannot be used, or if the physical surface `contact` is not on the
    boundary.
    """
    points, cells, used = cells_of(model)
    check(points, cells)
    faces = boundary(cells)
    surfaces = groups.of_model(model, 2, used[faces])
    labels = _labels(surfaces, len(faces))
    parts = groups.of_cells(model, 3, used[cells])
    return SolidMesh(points, cells, faces, labels, groups=surfaces, cell_groups=parts)


def _labels(surfaces: dict[str, np.ndarray], count: int) -> np.ndarray:
    """The label (count,) of each boundary face from the faces of each physical surface by name."""
    named = [name for name in surfaces if not name.isdecimal()]
    contact = [own for name, own in surfaces.items() if name.lower() == CONTACT]
    if not named:
        return np.full(count, FREE)
    if not contact:
        raise BadInput(
            f"none of its physical surfaces ({', '.join(named)}) has the name '{CONTACT}' (accepted: "
            f"such a one, or none with a name)"
        )
    labels = np.full(count, SolidMesh.NEVER)
    labels[np.concatenate(contact)] = FREE
    if not (labels == FREE).any():
        raise BadInput(f"its physical surface '{CONTACT}' is not on its boundary")
    return labels


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
