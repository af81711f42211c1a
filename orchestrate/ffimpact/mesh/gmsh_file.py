"""Reads plane meshes in gmsh's format: triangles, their boundary, labels from physical curves.

Without physical curves the whole boundary may come into contact, including the outlines of holes.
"""

import shutil
import tempfile
from pathlib import Path

import numpy as np

from ..failure import BadInput
from . import groups, mesh
from .mesh import Gmsh

__all__ = ["load", "read", "taken"]

TRIANGLES = {
    2: 3,
    9: 6,
}  # numbers of nodes by gmsh's element types; the first three are the corners
OTHER = mesh.Mesh.NEVER  # label of edges that are neither contact boundary nor axis
LABELS = {
    "contact": mesh.FREE,
    "symmetry": mesh.AXIS,
    str(mesh.FREE): mesh.FREE,
    str(mesh.AXIS): mesh.AXIS,
}


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
    if np.ptp(points[:, 2]) > 1e-9 * np.ptp(points[:, :2], axis=0).max():
        raise BadInput(
            f"it is not flat: z from {points[:, 2].min():g} to {points[:, 2].max():g} m (accepted: one z)"
        )
    points, triangles = points[:, :2], mesh.counter_clockwise(points[:, :2], triangles)
    edges = mesh.boundary(triangles)
    curves = groups.of_model(model, 1, used[edges])
    parts = groups.of_cells(model, 2, used[triangles])
    labels = _labels(curves, used[edges])
    return mesh.Mesh(points, triangles, edges, labels, groups=curves, cell_groups=parts)


def _labels(curves: dict[str, np.ndarray], nodes: np.ndarray) -> np.ndarray:
    """The label (e,) of each boundary edge from the edges of each physical curve by name: FREE for
    all without curves. `nodes` (e, 2) are gmsh's numbers of their ends.
    """
    if not curves:
        return np.full(len(nodes), mesh.FREE)
    labels, named = np.full(len(nodes), OTHER), ", ".join(curves)
    for name, own in curves.items():
        label = LABELS.get(name.lower(), OTHER)
        others = np.isin(labels[own], list(LABELS.values())) & (labels[own] != label)
        if label != OTHER and others.any():
            first, second = nodes[own[others.argmax()]]
            raise BadInput(
                f"its physical curves ({named}) have the line of nodes {first} and {second} both as contact and as symmetry "
                f"(accepted: one of them)"
            )
        if label != OTHER:
            labels[own] = label
    if not (labels == mesh.FREE).any():
        raise BadInput(
            f"none of its physical curves ({named}) has the name 'contact', or without a name the number "
            f"{mesh.FREE}, on its boundary: the body has no contact boundary "
            "(accepted: a curve with this name or number, or no physical curve)"
        )
    return labels
