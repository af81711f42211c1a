"""Outlines of bodies in the plane, and meshes of files, in SI units."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..failure import BadInput, brief
from ..geometry.outlines import (
    Loop,
    Outline,
    circle_loop,
    polygon_loop,
    self_crossing,
)
from . import given, mesh, plane_file

if TYPE_CHECKING:
    from ..input.shapes import Mesh

__all__ = ["check_simple", "mesh_file", "mesh_outline", "polygon_loops"]


def polygon_loops(entries: list[tuple[str, np.ndarray]]) -> tuple[Loop, ...]:
    """The loops of a polygon with holes: the entry and the corners of each, the outer one first.

    Raises BadInput if a polygon crosses itself, or if a hole is not inside the outer polygon and
    apart from the other holes.
    """
    import shapely  # imported here: other bodies do not need it

    for path, corners in entries:
        check_simple(path, corners)
    areas = [shapely.Polygon(corners) for _, corners in entries]
    for k, (path, _) in enumerate(entries[1:], 1):
        if not areas[0].contains_properly(areas[k]):
            raise BadInput(
                f"{path}: is not inside {entries[0][0]} (accepted: holes that neither cross nor touch the outline)"
            )
        for other in range(1, k):
            if areas[k].intersects(areas[other]):
                raise BadInput(
                    f"{path}: overlaps {entries[other][0]} (accepted: holes apart from each other)"
                )
    return tuple(polygon_loop(corners) for _, corners in entries)


def check_simple(path: str, corners: np.ndarray) -> None:
    n, same = (
        len(corners),
        np.argwhere((corners == np.roll(corners, -1, axis=0)).all(axis=1)).ravel(),
    )
    if len(same):
        raise BadInput(
            f"{path}: vertices {same[0] + 1} and {(same[0] + 1) % n + 1} coincide (accepted: each vertex once, the polygon "
            f"closes itself)"
        )
    if sides := self_crossing(corners):
        first, second = (f"from vertex {k + 1} to {(k + 1) % n + 1}" for k in sides)
        raise BadInput(
            f"{path}: the side {first} meets the side {second} (accepted: a polygon that does not cross or touch itself)"
        )


# ---- mesh files


def mesh_file(body: "Mesh", folder: Path, of_revolution: bool = False) -> mesh.Mesh:
    """The mesh of a body's file in m, with the centres of the circles on which its edges lie.

    The mesh is a whole body in the plane, half a meridian section with edges on the axis, or a
    section to the right of an axis that it does not reach. Raises BadInput if the mesh is not
    accepted.
    """
    if given.is_given(body):
        return _of_whole_body(body, given.plane(body), of_revolution)
    name = body.file or ""
    if "\0" in name or not _may_be_read(folder / name):
        raise BadInput(
            f"{body.at('file')}: {brief(repr(name))} is no file (accepted: FreeFEM's or gmsh's .msh)"
        )
    try:
        body_mesh = plane_file.load(folder / name)
    except BadInput as error:
        raise BadInput(f"{body.at('file')}: {brief(name)}: {error}") from None
    return _of_whole_body(body, body_mesh, of_revolution)


def _of_whole_body(body: "Mesh", body_mesh: mesh.Mesh, of_revolution: bool) -> mesh.Mesh:
    """The mesh in m. Raises BadInput if it is half a body and not `of_revolution`."""
    if not of_revolution and (body_mesh.labels == mesh.AXIS).any():
        raise BadInput(
            f"{body.at('file')}: '{brief(body.file)}' has edges with the label {mesh.AXIS} of a symmetry axis (accepted: whole bodies, "
            f"labels {mesh.FREE}: contact boundary, 3 and more: free boundary without contact)"
            if body.file
            else f"{body.at('labels')}.symmetry: of a whole body (accepted: in a scene of revolution)"
        )
    return body_mesh.scaled(body.scale or 1.0)


def _may_be_read(path: Path) -> bool:
    """Whether a path may be opened: it is a file or does not exist.

    Folders are refused, and so are pipes and devices, because reading would wait for them.
    """
    try:
        return path.is_file() or not path.exists()
    except OSError:  # too long a name or a forbidden folder: opening the file reports the error
        return True


def mesh_outline(body_mesh: mesh.Mesh) -> Outline:
    """The boundary of a mesh as loops, the loop with the largest area first.

    Edges on circles become arcs. A loop whose edges all lie on one circle becomes that circle.
    """
    arc_centre = {
        tuple(sorted(edge)): at
        for edge, at in zip(body_mesh.edges.tolist(), body_mesh.circle_centres)
    }
    following = dict(mesh.boundary(body_mesh.triangles).tolist())
    loops = []
    while following:
        first, v = (chain := list(following.popitem()))
        while v != first:
            v = following.pop(v)
            chain.append(v)
        loops.append(
            _loop(
                body_mesh.points[chain[:-1]],
                np.array([arc_centre[tuple(sorted(edge))] for edge in zip(chain, chain[1:])]),
            )
        )
    return Outline(tuple(sorted(loops, key=lambda loop: -loop.area)))


def _loop(corners: np.ndarray, arc_centres: np.ndarray) -> Loop:
    if np.isnan(arc_centres).all():
        return polygon_loop(corners)
    if (arc_centres == arc_centres[0]).all():
        return circle_loop(float(np.linalg.norm(corners[0] - arc_centres[0]))).placed(
            arc_centres[0], 0.0
        )
    return polygon_loop(corners, arc_centres)
