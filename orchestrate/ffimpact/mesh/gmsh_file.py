"""A mesh in gmsh's format as one of ours: its triangles in the plane, its boundary from them,
labels from its physical curves.

Without physical curves all of the boundary may touch, the outlines of holes, too.
"""

import tempfile
from pathlib import Path

import numpy as np

from ..failure import BadInput
from . import mesh

__all__ = ["load", "read", "taken"]

TRIANGLES = {
    2: 3,
    9: 6,
}  # gmsh's types of element that are read: their nodes, of which the first three are the corners
LINES = {1: 2, 8: 3}  # likewise, the first two are the ends
OTHER = mesh.Mesh.NEVER  # the label of what is neither contact nor axis
LABELS = {"contact": mesh.FREE, "symmetry": mesh.AXIS}


def load(path: Path, alone: bool = False) -> bytes:
    """The mesh in a file as FreeFEM's .msh: one of gmsh is converted, one of FreeFEM is taken
    as it is (what is in it is checked by edp/core/input/mesh-file.idp). A body `alone` on a
    plane touches nothing in its holes. BadInput where it cannot be read, or is one of gmsh that
    gmsh or we cannot use.
    """
    try:
        text = path.read_bytes()
    except OSError as error:
        raise BadInput(f"mesh: {path} cannot be read: {error.strerror}") from None
    if not text.startswith(b"$"):
        return text
    with tempfile.TemporaryDirectory() as folder:
        copy, made = (
            Path(folder) / "mesh.msh",
            Path(folder) / "freefem.msh",
        )  # gmsh goes by the ending of the name
        copy.write_bytes(text)
        try:
            found = mesh.in_own_process(read, copy)
            mesh.write(mesh.without_inner(found) if alone else found, made)
        except BadInput as error:
            raise BadInput(f"mesh: {path}: {str(error).replace(copy.name, path.name)}") from None
        return made.read_bytes()


def read(path: Path) -> mesh.Mesh:
    """The mesh in a gmsh file, lengths in m."""
    with mesh.gmsh_session() as gmsh:
        try:
            gmsh.open(str(path))
        except Exception as error:  # gmsh knows no other
            raise BadInput(f"gmsh cannot read it: {error}") from None
        return taken(gmsh.model)


def taken(model) -> mesh.Mesh:
    """The mesh in a model of gmsh: triangles turned counter-clockwise, vertices that no
    triangle uses left out.
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
        labelled = {}
        for a, b, label in curves:  # of a line in several groups the one that says something
            if a not in number or b not in number:  # beside all triangles
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


def _physical_curves(model) -> list[tuple[int, int, int]] | None:
    """(node, node, label) of every line in a physical curve, None where there is no such curve.
    A name decides what the label is, a number where there is no name.
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


def _names(model) -> str:
    return ", ".join(
        model.getPhysicalName(1, number) or str(number) for _, number in model.getPhysicalGroups(1)
    )
