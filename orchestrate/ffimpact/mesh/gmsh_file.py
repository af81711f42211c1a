"""Reads plane meshes in gmsh's format: triangles, their boundary, labels from physical curves.

Without physical curves the whole boundary may come into contact, including the outlines of holes.
"""

import shutil
import tempfile
from pathlib import Path

import numpy as np

from ..failure import BadInput
from . import mesh
from .mesh import Gmsh

__all__ = ["load", "read", "taken"]

# Numbers of nodes by gmsh's element types that are read. The first three nodes of a triangle are
# the corners, the first two nodes of a line are the ends.
TRIANGLES = {2: 3, 9: 6}
LINES = {1: 2, 8: 3}
OTHER = mesh.Mesh.NEVER  # label of edges that are neither contact boundary nor axis
LABELS = {"contact": mesh.FREE, "symmetry": mesh.AXIS}


def load(path: Path) -> mesh.Mesh:
    """The mesh of a gmsh file of any name, lengths in m. Raises BadInput if it is not accepted."""
    with tempfile.TemporaryDirectory() as folder:
        # gmsh recognises the format by the ending of the name
        copy = Path(folder) / "mesh.msh"
        shutil.copyfile(path, copy)
        try:
            return mesh.in_own_process(read, copy)
        except BadInput as error:
            raise BadInput(str(error).replace(copy.name, path.name)) from None


def read(path: Path) -> mesh.Mesh:
    """The mesh of a gmsh file, lengths in m. Raises BadInput if gmsh cannot read the file."""
    with mesh.gmsh_session() as gmsh:
        try:
            gmsh.open(str(path))
        except Exception as error:  # gmsh raises plain exceptions
            raise BadInput(f"gmsh cannot read it: {ascii(str(error))[1:-1]}") from None
        return taken(gmsh.model)


def taken(model: Gmsh) -> mesh.Mesh:
    """The mesh of a gmsh model, with counter-clockwise triangles and without unused vertices.

    Raises BadInput if the model is not flat, has other elements than triangles, or has physical
    curves but no contact boundary among them.
    """
    points, triangles, used = mesh.elements_of(model, (2, 3), TRIANGLES, "triangle", "triangles")
    curves = _physical_curves(model)
    if np.ptp(points[:, 2]) > 1e-9 * np.ptp(points[:, :2], axis=0).max():
        raise BadInput(
            f"it is not flat: z from {points[:, 2].min():g} to {points[:, 2].max():g} m (accepted: one z)"
        )
    points, triangles = points[:, :2], mesh.counter_clockwise(points[:, :2], triangles)
    edges = mesh.boundary(triangles)
    if curves is None:
        labels = np.full(len(edges), mesh.FREE)
    else:
        number = {int(tag): k for k, tag in enumerate(used)}
        labelled: dict[frozenset[int], int] = {}
        # A line in several groups gets the label of contact or symmetry if one group defines it.
        for a, b, label in curves:
            if a not in number or b not in number:  # the line belongs to no triangle
                continue
            edge = frozenset((number[a], number[b]))
            if {label, labelled.get(edge)} == set(LABELS.values()):
                raise BadInput(
                    f"its physical curves ({_names(model)}) have the line of nodes {a} and {b} both as contact and as symmetry "
                    f"(accepted: one of them)"
                )
            if labelled.get(edge, OTHER) == OTHER:
                labelled[edge] = label
        labels = np.array(
            [labelled.get(frozenset(edge), OTHER) for edge in edges.tolist()], dtype=int
        )
        if not (labels == mesh.FREE).any():
            raise BadInput(
                f"none of its physical curves ({_names(model)}) has the name 'contact', or without a name the number "
                f"{mesh.FREE}, on its boundary: the body has no contact boundary "
                "(accepted: a curve with this name or number, or no physical curve)"
            )
    return mesh.Mesh(points, triangles, edges, labels)


def _physical_curves(model: Gmsh) -> list[tuple[int, int, int]] | None:
    """Returns (node, node, label) of each line in a physical curve, None without physical curves.

    The name of the curve determines the label; the number of the curve does if it has no name.
    """
    groups = model.getPhysicalGroups(1)
    lines = []
    for _, number in groups:
        name = model.getPhysicalName(1, number).strip().lower()
        label = LABELS.get(name, OTHER) if name else number if number in LABELS.values() else OTHER
        for entity in model.getEntitiesForPhysicalGroup(1, number):
            for kind, _, nodes in zip(*model.mesh.getElements(1, entity)):
                if kind not in LINES:
                    raise BadInput(
                        f"it has elements '{model.mesh.getElementProperties(kind)[0]}' (accepted: lines of 2 or 3 nodes)"
                    )
                lines += [(int(a), int(b), label) for a, b, *_ in nodes.reshape(-1, LINES[kind])]
    return lines if groups else None


def _names(model: Gmsh) -> str:
    return ", ".join(
        model.getPhysicalName(1, number) or str(number) for _, number in model.getPhysicalGroups(1)
    )
