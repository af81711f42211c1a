"""Meshes inside closed curves in the plane, by gmsh: the ends of their pieces are vertices, elements as small as is asked along them."""

from collections.abc import Callable

import numpy as np

from . import mesh
from .mesh import Sizes

Curve = Callable[[np.ndarray], np.ndarray]   # points (n, 2) [m] at parameters (n,) in [0, 1]
SAMPLED = 0.25               # a step between points at which an element size is asked for, over that size


def mesh_body(boundary: list[list[tuple[Curve, float, int]]], sizes: Sizes, scale: float) -> mesh.Mesh:
    """The mesh inside closed curves, of a body about as large as `scale` [m]: the ends of their pieces are vertices, and all vertices of
    the boundary lie on them to rounding; boundary edges have the body to their left, and the label of their piece."""
    pieces = [[nodes_on(curve, largest, sizes) for curve, largest, _ in loop] for loop in boundary]
    labels = [np.repeat([label for *_, label in loop], [len(nodes) for nodes in each]) for loop, each in zip(boundary, pieces)]
    loops = [np.vstack(each) for each in pieces]
    loops = [nodes if k == 0 else nodes[::-1] for k, nodes in enumerate(loops)]     # a hole has one label
    # gmsh's tolerances are absolute
    bulk, inside = round(sizes.bulk / scale, mesh.DIGITS), [np.round(nodes / scale, mesh.DIGITS) for nodes in loops]
    with mesh.gmsh_session() as gmsh:
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        for source in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
            gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
        tags, curves = zip(*(_loop(gmsh.model, nodes) for nodes in inside))
        gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(list(lines)) for lines in curves])
        gmsh.model.geo.synchronize()
        _grade(gmsh.model.mesh.field, inside, curves, bulk)
        gmsh.model.mesh.generate(2)
        points, triangles, used = mesh.elements_of(gmsh.model, (2,), {2: 3}, "triangle", "triangles")
        corners = np.searchsorted(used, [gmsh.model.mesh.getNodes(0, tag)[0][0] for tag in np.concatenate(tags)])
    points = points[:, :2] * scale
    points[corners] = np.vstack(loops)
    triangles = mesh.counter_clockwise(points, triangles)
    ends = np.split(corners, np.cumsum([len(nodes) for nodes in loops])[:-1])
    edges = np.vstack([np.column_stack([each, np.roll(each, -1)]) for each in ends])
    return mesh.Mesh(points, triangles, edges, np.concatenate(labels))


def nodes_on(curve: Curve, largest: float, sizes: Sizes) -> np.ndarray:
    """Vertices (n, 2) on a curve from its first end on, without its last, in steps ds with the integral of ds / size constant."""
    s, size = np.array([0.0, 1.0]), np.array([])
    while len(size) < len(s):                    # halved until the size, which is Lipschitz, is known between points too
        size = np.minimum(sizes.at(curve(s)), largest)
        step = np.linalg.norm(np.diff(curve(s), axis=0), axis=1)
        coarse = step > SAMPLED * np.minimum(size[1:], size[:-1])
        s = np.sort(np.concatenate([s, (s[1:] + s[:-1])[coarse] / 2]))
    passed = np.concatenate([[0.0], np.cumsum(step * (1 / size[1:] + 1 / size[:-1]) / 2)])
    count = max(1, round(passed[-1]))
    return curve(np.interp(passed[-1] * np.arange(count) / count, passed, s))


def _loop(model, nodes: np.ndarray) -> tuple[list[int], list[int]]:
    """Points and lines of gmsh along a loop, one element a line."""
    points = [model.geo.addPoint(x, y, 0) for x, y in nodes]
    lines = [model.geo.addLine(a, b) for a, b in zip(points, [*points[1:], points[0]])]
    for line in lines:
        model.geo.mesh.setTransfiniteCurve(line, 2)
    return points, lines


def _grade(field, loops: list[np.ndarray], curves: tuple[list[int], ...], bulk: float) -> None:
    """Element sizes inside: those of the edges on the outline, growing linearly with the distance from them up to the bulk's. Edges
    of about one length are one source."""
    length = np.concatenate([np.linalg.norm(np.roll(nodes, -1, axis=0) - nodes, axis=1) for nodes in loops])
    fineness = np.ceil(2 * np.log2(np.maximum(bulk / length, 1)) - 1e-9).astype(int)     # from bulk down in steps of sqrt(1/2)
    lines, sources = np.concatenate(curves), []
    for level in np.unique(fineness):
        size = bulk * np.sqrt(0.5)**level
        # points on a line; of 2 gmsh makes none
        sources.append(mesh.graded(field, "CurvesList", lines[fineness == level], (size, bulk), sampling=5))
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", sources)
    field.setAsBackgroundMesh(least)
