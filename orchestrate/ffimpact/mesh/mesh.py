"""Plane meshes by gmsh: discs or half discs that are graded towards the contact arc, and the inside
of closed curves; written in FreeFEM's .msh format.

Boundary labels: 1 = free outer boundary, which may come into contact, 2 = symmetry axis x = 0. The
triangles are straight; the FreeFEM scripts curve the boundary. The lowest point of a disc lies on
the plane y = 0.
"""

import atexit
import hashlib
import math
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np
import scipy

from .. import progress
from ..failure import BadInput, NotInstalled
from ..places import INSTALLED, PACKAGE

if TYPE_CHECKING:
    from .solid_mesh import SolidMesh

__all__ = [
    "AXIS",
    "Curve",
    "DIGITS",
    "FREE",
    "GROWTH",
    "INTERFACE",
    "Mesh",
    "Piece",
    "Sizes",
    "WIDEST",
    "boundary",
    "counter_clockwise",
    "disc",
    "elements_of",
    "gmsh_session",
    "graded",
    "in_own_process",
    "inner_outlines",
    "interfaces",
    "layers_of",
    "mesh_body",
    "nearest",
    "nodes_on",
    "pieces",
    "read",
    "start_gmsh",
    "without_inner",
    "write",
]

FREE, AXIS = 1, 2  # boundary labels
INTERFACE = -2  # label of sides between layers of a body
# Vertices of the sides of a triangle (counter-clockwise) and of the faces of a tetrahedron
# (counter-clockwise seen from outside).
SIDES = {
    3: np.array([[0, 1], [1, 2], [2, 0]]),
    4: np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]),
}
# Ends and middle node of the sides of triangles of 6 and tetrahedra of 10 nodes, in gmsh's order.
MIDDLE = {
    6: ((0, 1, 3), (1, 2, 4), (2, 0, 5)),
    10: ((0, 1, 4), (1, 2, 5), (2, 0, 6), (3, 0, 7), (2, 3, 8), (1, 3, 9)),
}
WIDEST = math.radians(30)  # largest angle that an edge of a file spans on an arc
# Installs the system libraries that gmsh's wheel needs, with their dependencies.
LIBRARIES = "apt-get install libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"
SAMPLED = 0.25  # largest step between samples of the size field on a curve, over the element size
GROWTH = 0.3  # increase of the element size per length of distance from the contact arc
# Decimals of the coordinates and sizes that gmsh gets, relative to the size of the body. Without
# rounding, round-off would decide ties, and the mesh would depend on the unit of length.
DIGITS = 10
KEPT = 8  # number of results of gmsh's process that are kept
_kept: dict[bytes, Any] = {}  # the results by their contents; see in_own_process
Curve = Callable[[np.ndarray], np.ndarray]  # points (n, 2) [m] at parameters (n,) in [0, 1]
Piece = tuple[Curve, float, int]  # of a boundary: curve, largest element size [m] on it, label
Gmsh = Any  # the module gmsh or a part of it, such as gmsh.model, which have no types
T = TypeVar("T")
Made = TypeVar("Made", "Mesh", "SolidMesh")


@dataclass(frozen=True)
class Mesh:
    """A mesh of triangles in the plane.

    `points` (n, 2) are in m, `triangles` (t, 3) are counter-clockwise, `edges` (e, 2) of the
    boundary have the `labels` (e,). `arc_centres` (e, 2) [m], of meshes of files, are the centres of the
    circles on which edges lie, nan for straight edges. `groups` are the numbers of the edges of parts
    of the boundary by name, `cell_groups` those of the triangles of named parts. `layers` (t,) are the
    numbers of the layers of triangles, from 1, 0 for those in none.
    """

    points: np.ndarray
    triangles: np.ndarray
    edges: np.ndarray
    labels: np.ndarray
    arc_centres: np.ndarray | None = None
    groups: dict[str, np.ndarray] = field(default_factory=dict)
    cell_groups: dict[str, np.ndarray] = field(default_factory=dict)
    layers: np.ndarray | None = None
    NEVER: ClassVar[int] = 3  # label of edges that never come into contact

    @property
    def elements(self) -> np.ndarray:
        return self.triangles

    @property
    def sides(self) -> np.ndarray:
        return self.edges

    @property
    def layer_of(self) -> np.ndarray:
        """`layers`, 0 for all triangles of a mesh without layers."""
        return layers_of(self)

    @property
    def circle_centres(self) -> np.ndarray:
        """`arc_centres`, nan for all edges of a mesh that has none."""
        if self.arc_centres is None:
            return np.full((len(self.edges), 2), np.nan)
        return self.arc_centres

    def moved(self, by: np.ndarray) -> "Mesh":
        """The mesh, translated by the vector `by` (2,) [m]."""
        return replace(
            self,
            points=self.points + by,
            arc_centres=None if self.arc_centres is None else self.arc_centres + by,
        )

    def scaled(self, factor: float) -> "Mesh":
        """The mesh, scaled by `factor` about the origin."""
        arc_centres = None if self.arc_centres is None else self.arc_centres * factor
        return replace(self, points=self.points * factor, arc_centres=arc_centres)


PAIRS = 1_000_000  # of points, from which on a tree is worth the time in which scipy loads
SAME = 1e-8  # distance of nodes that are the same, over the size of the body
MOST_ON_CURVE = 50_000  # largest number of samples of a curve; no run could use a mesh so fine


@dataclass(frozen=True)
class Sizes:
    """The size field of a body: element sizes [m] in the bulk and at the expected contact.

    `near` (n, axes) [m] are the outline points of the expected contact, in the coordinates of the
    body's mesh. The size `contact` applies up to the distance `slack` from these points. Across
    the unit vector `along` (axes,) elements are `stretch` times as long. Elements at a layer are
    `of_layers` times as long as it is thick, at most.
    """

    bulk: float
    contact: float
    near: np.ndarray
    slack: float  # half the spacing of points on the outline [m]
    along: np.ndarray | None = None
    stretch: float = 1.0
    of_layers: float = 1.0

    def at(self, points: np.ndarray) -> np.ndarray:
        """Element sizes (n,) [m] at points (n, axes), linear in the distance from the contact: both
        in the coordinates of squeezed().
        """
        if not len(self.near):
            return np.full(len(points), self.bulk)
        away = nearest(self.squeezed(points), self.squeezed(self.near))
        return np.minimum(self.bulk, self.contact + GROWTH * np.maximum(away - self.slack, 0.0))

    def squeezed(self, points: np.ndarray) -> np.ndarray:
        """Coordinates (n, axes) [m] in which lengths across `along` are divided by `stretch`. The
        elements have equal sides in them.
        """
        return self._with_across(points, 1 / self.stretch)

    def restored(self, points: np.ndarray) -> np.ndarray:
        """Points (n, axes) [m] with these squeezed() coordinates."""
        return self._with_across(points, self.stretch)

    def _with_across(self, points: np.ndarray, factor: float) -> np.ndarray:
        if self.along is None or factor == 1.0:
            return points
        return factor * points + (1 - factor) * np.outer(points @ self.along, self.along)


def nearest(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Distances (n,) [m] of points (n, axes) from the nearest of the other points (m, axes)."""
    distances: np.ndarray
    if len(points) * len(others) > PAIRS:
        distances = scipy.spatial.cKDTree(others).query(points)[0]
    else:
        distances = np.sqrt(((points[:, None] - others) ** 2).sum(axis=2).min(axis=1))
    return distances


def disc(
    radius: float,
    mesh_size: float,
    contact_mesh_size: float,
    half: bool,
    contact_arc: float = math.pi / 4,
) -> Mesh:
    """The mesh of a disc with the centre (0, radius), or of its half x >= 0. All lengths are in m.

    The element size is contact_mesh_size along the lowest arc of +-contact_arc radians (seen from
    the centre) and grows linearly to mesh_size with the distance from this arc. Vertices of the
    circle and of the axis lie on them to round-off.
    """
    # The mesh is generated for the radius 1, because gmsh's tolerances are absolute.
    bulk, contact, arc = (
        round(size, DIGITS)
        for size in (mesh_size / radius, contact_mesh_size / radius, contact_arc)
    )
    with gmsh_session() as gmsh:
        arcs, axis = _outline(gmsh.model.geo, half, min(arc, 0.99 * math.pi))
        contact_arcs = arcs[:1] if half else [arcs[0], arcs[-1]]
        points, triangles, used = _filled(
            gmsh,
            [arcs + axis],
            lambda field: graded(
                field, "CurvesList", contact_arcs, (contact, bulk), math.ceil(2 * arc / contact)
            ),
        )
        pieces = [
            (label, gmsh.model.mesh.getElementsByType(1, curve)[1].reshape(-1, 2))
            for label, curves in ((FREE, arcs), (AXIS, axis))
            for curve in curves
        ]

    points = points[:, :2]
    edges = np.searchsorted(used, np.vstack([nodes for _, nodes in pieces]))
    labels = np.concatenate([np.full(len(nodes), label) for label, nodes in pieces])

    circle = np.unique(edges[labels == FREE])
    points[circle] /= np.linalg.norm(points[circle], axis=1, keepdims=True)
    points[np.unique(edges[labels == AXIS]), 0] = 0.0
    points = radius * (points + (0.0, 1.0))
    return Mesh(points, counter_clockwise(points, triangles), edges, labels)


def _outline(geo: Gmsh, half: bool, contact_arc: float) -> tuple[list[int], list[int]]:
    """Adds the unit circle to gmsh; returns its arcs and the axis as numbers of curves.

    The arcs are counter-clockwise from the lowest point. The axis is empty for a whole disc.
    """

    def point(angle: float) -> int:  # angle [rad] from the lowest point
        return int(geo.addPoint(math.sin(angle), -math.cos(angle), 0))

    centre, bottom, top = geo.addPoint(0, 0, 0), point(0.0), point(math.pi)
    corners = [bottom, point(contact_arc), top]
    if not half:
        corners += [point(-contact_arc), bottom]
    arcs = [geo.addCircleArc(a, centre, b) for a, b in zip(corners, corners[1:])]
    return arcs, [geo.addLine(top, bottom)] if half else []


def mesh_body(
    boundary: list[list[Piece]],
    sizes: Sizes,
    scale: float,
    interfaces: Sequence[tuple[Curve, float]] = (),
) -> Mesh:
    """The mesh inside closed curves, the outer curve first, which follows `interfaces` inside it:
    curves with the largest element size [m] on each, which end on the boundary or on each other.

    `boundary` lists the segments of each closed curve: the curve, the largest element size [m] on
    it and its label. The ends of segments become vertices, and all boundary vertices lie on the
    curves to round-off. Boundary edges have the body to the left and the label of their segment.
    `scale` [m] is about the size of the body.
    """
    pieces = [[nodes_on(curve, largest, sizes) for curve, largest, _ in loop] for loop in boundary]
    labels = [
        np.repeat([label for *_, label in loop], [len(nodes) for nodes in piece])
        for loop, piece in zip(boundary, pieces)
    ]
    loops = [np.vstack(piece) for piece in pieces]
    # Holes are reversed; their labels are not, because a hole has a single label.
    loops = [nodes if k == 0 else nodes[::-1] for k, nodes in enumerate(loops)]
    # Lengths are divided by `scale`, because gmsh's tolerances are absolute.
    bulk = round(sizes.bulk / scale, DIGITS)
    nodes, chains = _chains(np.vstack(loops), interfaces, sizes, scale)
    places = np.round(sizes.squeezed(nodes) / scale, DIGITS)
    firsts = np.cumsum([0, *(len(loop) for loop in loops)])
    rings = [np.arange(a, b + 1) for a, b in zip(firsts, firsts[1:])]
    rings = [np.append(ring[:-1], ring[0]) for ring in rings]
    with gmsh_session() as gmsh:
        tags = [gmsh.model.geo.addPoint(x, y, 0) for x, y in places]
        lines = [_lines(gmsh.model, tags, chain) for chain in (*rings, *chains)]
        lengths = [
            np.linalg.norm(np.diff(places[chain], axis=0), axis=1) for chain in (*rings, *chains)
        ]
        points, triangles, used = _filled(
            gmsh,
            lines[: len(rings)],
            lambda field: _grade(field, np.concatenate(lengths), np.concatenate(lines), bulk),
            [line for chain in lines[len(rings) :] for line in chain],
        )
        corners = np.searchsorted(used, [gmsh.model.mesh.getNodes(0, tag)[0][0] for tag in tags])
    points = sizes.restored(points[:, :2] * scale)
    points[corners] = nodes
    triangles = counter_clockwise(points, triangles)
    corners = corners[: firsts[-1]]
    ends = np.split(corners, np.cumsum([len(nodes) for nodes in loops])[:-1])
    edges = np.vstack([np.column_stack([end_nodes, np.roll(end_nodes, -1)]) for end_nodes in ends])
    return Mesh(points, triangles, edges, np.concatenate(labels))


def nodes_on(curve: Curve, largest: float, sizes: Sizes) -> np.ndarray:
    """Vertices (n, 2) on a curve, with its first end and without its last.

    The integral of ds / size is the same between any two successive vertices. `largest` [m] bounds
    the sizes. Raises BadInput if the curve needs more than MOST_ON_CURVE samples.
    """
    s, size = np.array([0.0, 1.0]), np.array([])
    # Intervals are halved until the size field, which is Lipschitz, is resolved between samples.
    while len(size) < len(s):
        size = np.minimum(sizes.at(curve(s)), largest / sizes.stretch)
        step = np.linalg.norm(np.diff(sizes.squeezed(curve(s)), axis=0), axis=1)
        # Round-off, which differs with the unit of length, decides nothing.
        coarse = step > (1 + 1e-9) * SAMPLED * np.minimum(size[1:], size[:-1])
        s = np.sort(np.concatenate([s, (s[1:] + s[:-1])[coarse] / 2]))
        if len(s) > MOST_ON_CURVE:
            raise BadInput(
                f"mesh_size: {min(sizes.contact, sizes.bulk):.3g} m is too small for an outline of "
                f"{step.sum():.3g} m (accepted: larger ones, or a body that is less thin)"
            )
    passed = np.concatenate([[0.0], np.cumsum(step * (1 / size[1:] + 1 / size[:-1]) / 2)])
    count = max(1, round(passed[-1]))
    return curve(np.interp(passed[-1] * np.arange(count) / count, passed, s))


def _chains(
    nodes: np.ndarray, interfaces: Sequence[tuple[Curve, float]], sizes: Sizes, scale: float
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Returns the nodes (n, 2) [m] of the boundary and behind them those of the interfaces, and the
    numbers of the nodes along each interface. Ends on other nodes are these nodes.
    """
    chains = []
    for curve, largest in interfaces:
        along = np.vstack([nodes_on(curve, largest, sizes), curve(np.array([1.0]))])
        numbers = np.full(len(along), -1)
        for end in (0, -1):
            away = np.linalg.norm(nodes - along[end], axis=1)
            if away.min() <= SAME * scale:
                numbers[end] = away.argmin()
            elif end == 0 or np.linalg.norm(along[0] - along[-1]) > SAME * scale:
                numbers[end] = len(nodes)
                nodes = np.vstack([nodes, along[end]])
            else:
                numbers[end] = numbers[0]
        numbers[1:-1] = len(nodes) + np.arange(len(along) - 2)
        nodes = np.vstack([nodes, along[1:-1]])
        chains.append(numbers)
    return nodes, chains


def _lines(model: Gmsh, tags: list[int], chain: np.ndarray) -> list[int]:
    """Adds lines along a chain of points to gmsh, one element per line; returns their numbers."""
    lines = [model.geo.addLine(tags[a], tags[b]) for a, b in zip(chain, chain[1:])]
    for line in lines:
        model.geo.mesh.setTransfiniteCurve(line, 2)
    return lines


def _grade(field: Gmsh, length: np.ndarray, lines: np.ndarray, bulk: float) -> int:
    """Adds the size field between lines of these lengths to gmsh and returns its number.

    On the lines the size is their length. It grows linearly with the distance from them up to the
    size of the bulk. Lines of similar lengths share one gmsh field.
    """
    # levels of the size, from the bulk's down in steps of sqrt(1/2)
    fineness = np.ceil(2 * np.log2(np.maximum(bulk / length, 1)) - 1e-9).astype(int)
    sources = []
    for level in np.unique(fineness):
        size = bulk * np.sqrt(0.5) ** level
        # 5 sampling points on a line: with 2 gmsh would use none
        sources.append(
            graded(field, "CurvesList", lines[fineness == level], (size, bulk), sampling=5)
        )
    least = int(field.add("Min"))
    field.setNumbers(least, "FieldsList", sources)
    return least


def _filled(
    gmsh: Gmsh,
    loops: Sequence[Sequence[int]],
    sizes: Callable[[Gmsh], int],
    embedded: Sequence[int] = (),
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Meshes the inside of loops of gmsh curves and returns its triangles as `elements_of` does.

    The outer loop is the first. The sides of triangles follow `embedded` curves. `sizes` adds the
    size field to gmsh and returns its number.
    """
    gmsh.option.setNumber("Mesh.Algorithm", 6)  # frontal Delaunay: triangles of the best quality
    for source in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
    surface = gmsh.model.geo.addPlaneSurface(
        [gmsh.model.geo.addCurveLoop(list(lines)) for lines in loops]
    )
    gmsh.model.geo.synchronize()
    if embedded:
        gmsh.model.mesh.embed(1, list(embedded), 2, surface)
    field = gmsh.model.mesh.field
    field.setAsBackgroundMesh(sizes(field))
    gmsh.model.mesh.generate(2)
    # elements_of leaves out the centres of arcs, which gmsh keeps as nodes
    return elements_of(gmsh.model, (2,), {2: 3}, "triangle", "triangles")


# ---- gmsh

_alone = threading.RLock()  # gmsh has a single model and serves one thread at a time


def start_gmsh() -> Gmsh:
    """The initialised module gmsh, even if a script that uses gmsh itself has finalised it.

    Raises NotInstalled if a system library is missing.
    """
    with _alone:
        gmsh = _loaded()
        if not gmsh.isInitialized():
            _initialize(gmsh)
        return gmsh


@cache
def _loaded() -> Gmsh:
    """The module gmsh, which is finalised when this program ends."""
    try:
        import gmsh
    except OSError as error:
        raise NotInstalled(
            f"gmsh does not load ({error}); run: {LIBRARIES if INSTALLED else 'make setup'}"
        ) from None
    atexit.register(lambda: gmsh.finalize() if gmsh.isInitialized() else None)
    return gmsh


def _initialize(gmsh: Gmsh) -> None:
    """Initialises gmsh and restores the signal handlers.

    During the initialisation the signal handlers have their defaults. So a run starts gmsh before
    it creates anything that a signal could leave behind.
    """
    handlers = {
        number: signal.getsignal(number)
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE)
    }
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    if threading.current_thread() is threading.main_thread():
        for number, handler in handlers.items():
            signal.signal(number, handler)


def in_own_process(read: Callable[..., T], path: Path, *arguments: object) -> T:
    """Returns read(path, *arguments) from a separate process, because some broken files crash gmsh.
    The last results are kept for files of the same content, except for .geo files, which are
    scripts that may read other files.

    Raises the BadInput of `read`, or BadInput with the signal or exit code of the process.
    """
    try:
        content = path.read_bytes()
    except OSError:
        content = b""
    if not content or path.suffix.lower() == ".geo":
        return _of_process(read, path, *arguments)
    made_of = pickle.dumps((read, path.suffix, content, arguments))
    key = hashlib.sha256(made_of).digest()
    result: T = _kept[key] if key in _kept else _of_process(read, path, *arguments)
    _kept[key] = result
    for old in list(_kept)[:-KEPT]:
        _kept.pop(old, None)
    return result


def _of_process(read: Callable[..., T], path: Path, *arguments: object) -> T:
    """Returns read(path, *arguments) from a separate process; see in_own_process."""
    modules = os.pathsep.join([str(PACKAGE.parent), *filter(None, [os.environ.get("PYTHONPATH")])])
    command = [sys.executable, "-P", "-c", f"from {__name__} import _answer; _answer()"]
    # The process keeps the working folder, so relative paths stay valid.
    with tempfile.NamedTemporaryFile() as answer, progress.work(f"reading {path.name}"):
        child = subprocess.run(
            [*command, answer.name],
            env=os.environ | {"PYTHONPATH": modules},
            input=pickle.dumps((read, path, *arguments)),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        # The file is empty if a script in a geometry has ended the process.
        if child.returncode == 0 and (pickled := answer.read()):
            result: T | BadInput = pickle.loads(pickled)
            if isinstance(result, BadInput):
                raise BadInput(str(result).replace(str(path), path.name))
            return result
    how = (
        signal.Signals(-child.returncode).name
        if child.returncode < 0
        else f"exit code {child.returncode}"
    )
    raise BadInput(f"gmsh broke down over it ({how})")


def _answer() -> None:
    """Runs in the separate process: writes the result, or the BadInput, to the answer file."""
    read, *arguments = pickle.load(sys.stdin.buffer)
    try:
        result = read(*arguments)
    except BadInput as error:
        result = error
    Path(sys.argv[1]).write_bytes(pickle.dumps(result))


@contextmanager
def gmsh_session() -> Iterator[Gmsh]:
    """Provides the module gmsh with default options, without output, to one thread at a time.

    The model is cleared at the end.
    """
    with _alone:
        gmsh = start_gmsh()
        gmsh.option.restoreDefaults()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.AbortOnError", 2)  # errors raise exceptions
        try:
            yield gmsh
        finally:
            gmsh.clear()


def graded(
    field: Gmsh,
    kind: str,
    sources: Sequence[int],
    sizes: tuple[float, float],
    sampling: int = 0,
    flat: float = 0.0,
) -> int:
    """Adds a size field to gmsh that grows with the distance from sources; returns its number.

    The size is the first of `sizes` up to the distance `flat` from the sources and grows linearly
    from there to the second. `kind` is PointsList or CurvesList, `sampling` the number of points on
    a curve.
    """
    distance, size = field.add("Distance"), int(field.add("Threshold"))
    field.setNumbers(distance, kind, sources)
    if sampling:
        field.setNumber(distance, "Sampling", sampling)
    least, largest = sizes
    for name, value in dict(
        InField=distance,
        SizeMin=least,
        SizeMax=largest,
        DistMin=flat,
        DistMax=flat + max(largest - least, 1e-9 * largest) / GROWTH,
    ).items():
        field.setNumber(size, name, value)
    return size


def elements_of(
    model: Gmsh, dimensions: Sequence[int], nodes: dict[int, int], singular: str, plural: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns vertices (n, 3), elements (t, corners) and gmsh's numbers (n,) of the vertices.

    `nodes` maps the accepted gmsh element types to their numbers of nodes, of which the first are
    the corners. Only vertices of elements are returned. Raises BadInput if the model contains no
    elements or other types; `singular` and `plural` are the names of an element and of elements.
    """
    kinds = [kind for dimension in dimensions for kind in model.mesh.getElementTypes(dimension)]
    for kind in kinds:
        if kind not in nodes:
            raise BadInput(
                f"it has elements '{model.mesh.getElementProperties(kind)[0]}' (accepted: {plural} of "
                f"{' or '.join(map(str, nodes.values()))} nodes)"
            )
    if not kinds:
        raise BadInput(f"it has no {plural}")
    by_kind = [model.mesh.getElementsByType(kind)[1].reshape(-1, nodes[kind]) for kind in kinds]
    corners = np.vstack([block[:, : min(nodes.values())] for block in by_kind])
    # The format 2.2 contains an element once for each physical group to which it belongs.
    once = np.unique(np.sort(corners, axis=1), axis=0, return_index=True)[1]
    used, elements = np.unique(corners[np.sort(once)], return_inverse=True)
    tags, coordinates, _ = model.mesh.getNodes()
    points, row = coordinates.reshape(-1, 3), np.full(int(max(tags.max(), corners.max())) + 1, -1)
    row[tags] = np.arange(len(tags))
    if (row[used] < 0).any():
        raise BadInput(f"a {singular} names node {used[row[used] < 0][0]}, which is not there")
    for block in by_kind:
        _refuse_bent(block, points[row[block]])
    return points[row[used]], elements.reshape(-1, min(nodes.values())), used


def _refuse_bent(elements: np.ndarray, points: np.ndarray) -> None:
    """Raises BadInput if a side of second order bends by more than an edge of a file may on an arc.

    `elements` (t, n) are gmsh's numbers of the nodes at `points` (t, n, 3). Of a side only the ends
    are used. The middle of an arc of the angle a is tan(a/4)/2 of its chord away from the chord.
    """
    for first, last, middle in MIDDLE.get(elements.shape[1], ()):
        chord = points[:, last] - points[:, first]
        arm = points[:, middle] - (points[:, first] + points[:, last]) / 2
        length2 = (chord**2).sum(axis=1)
        away = arm - chord * ((chord * arm).sum(axis=1) / length2)[:, None]
        bend = 4 * np.arctan(2 * np.sqrt((away**2).sum(axis=1) / length2))
        worst = bend.argmax()
        if bend[worst] > WIDEST * (1 + 1e-6):
            raise BadInput(
                f"the side from node {elements[worst, first]} to {elements[worst, last]} bends by "
                f"{math.degrees(bend[worst]):.3g} degrees, and only its ends are used (accepted: "
                f"up to {math.degrees(WIDEST):g} degrees, so smaller elements)"
            )


def counter_clockwise(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The triangles (t, 3), with clockwise ones reversed."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    clockwise = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) < (b[:, 1] - a[:, 1]) * (
        c[:, 0] - a[:, 0]
    )
    return np.where(clockwise[:, None], triangles[:, [0, 2, 1]], triangles)


def boundary(cells: np.ndarray) -> np.ndarray:
    """The boundary: sides (e, 2) of triangles, or faces (f, 3) of tetrahedra, of a single cell.

    Sides have the cell to the left; faces are counter-clockwise seen from outside.
    """
    sides = cells[:, SIDES[cells.shape[1]]].reshape(-1, cells.shape[1] - 1)
    _, first, count = np.unique(
        np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer: np.ndarray = sides[np.sort(first[count == 1])]
    return outer


def interfaces(cells: np.ndarray, layers: np.ndarray) -> np.ndarray:
    """The sides (e, corners) between cells (t, corners + 1) of different layers (t,), each as the
    first of its two cells has it.
    """
    corners = SIDES[cells.shape[1]]
    if not layers.any():
        return np.empty((0, corners.shape[1]), dtype=int)
    sides = cells[:, corners].reshape(-1, corners.shape[1])
    order = np.lexsort(np.sort(sides, axis=1).T)
    ordered, layer = np.sort(sides[order], axis=1), np.repeat(layers, len(corners))[order]
    same = (ordered[1:] == ordered[:-1]).all(axis=1)
    between: np.ndarray = sides[order[:-1][same & (layer[1:] != layer[:-1])]]
    return between


def layers_of(made: "Mesh | SolidMesh") -> np.ndarray:
    """The layer (t,) of each cell, 0 for all cells of a mesh without layers."""
    return np.zeros(len(made.elements), dtype=int) if made.layers is None else made.layers


def pieces(points: int, elements: np.ndarray) -> np.ndarray:
    """The number (points,) of the connected component of each point.

    Elements (n, corners) are connected if they have a point in common. `points` is the number of
    points.
    """
    piece, before = np.arange(points), np.full(points, -1)
    while (piece != before).any():
        before = piece.copy()
        # The piece of each point of an element becomes the one with the smallest number among them.
        np.minimum.at(piece, piece[elements], piece[elements].min(axis=1, keepdims=True))
        while (piece != piece[piece]).any():
            piece = piece[piece]
    return np.unique(piece, return_inverse=True)[1]


def inner_outlines(points: np.ndarray, sides: np.ndarray) -> list[np.ndarray]:
    """For each hole of a body, the numbers of its sides among the boundary sides (f, axes).

    The outline with the rightmost point is the outer one. So `sides` may be those of the half at
    x >= 0, but not those on the axis or plane of symmetry, which would join the outlines.
    """
    piece = pieces(len(points), sides)[sides[:, 0]]
    outer = piece[points[sides][:, :, 0].max(axis=1).argmax()]
    return [np.flatnonzero(piece == inner) for inner in np.unique(piece) if inner != outer]


def without_inner(
    made: Made, keeps: Callable[[np.ndarray, np.ndarray], bool] = lambda own, rest: False
) -> Made:
    """The Mesh or SolidMesh with inner outlines that never come into contact.

    An inner outline keeps its labels if `keeps`(own, rest) is true for the vertices (n, axes) on
    the outline and on the rest of the boundary.
    """
    labels = made.labels.copy()
    surface = np.flatnonzero((labels == FREE) | (labels >= made.NEVER))  # not a plane of symmetry
    for own in (surface[hole] for hole in inner_outlines(made.points, made.sides[surface])):
        rest = np.delete(made.sides, own, axis=0)
        if not keeps(*(made.points[np.unique(sides)] for sides in (made.sides[own], rest))):
            labels[own] = made.NEVER
    return replace(made, labels=labels)


def write(mesh: Mesh, path: Path, regions: np.ndarray | None = None) -> None:
    """Writes FreeFEM's 2D .msh format, with vertices counted from 1.

    The lines are: numbers of vertices, triangles and edges; x y label; v1 v2 v3 region; v1 v2
    label. `regions` (t,) are the numbers of the bodies, 0 by default.
    """
    point_labels = np.zeros(len(mesh.points), dtype=int)
    # A vertex of edges with different labels gets the smallest, which is that of the contact.
    for label in np.unique(mesh.labels)[::-1]:
        point_labels[mesh.edges[mesh.labels == label]] = label
    regions = np.zeros(len(mesh.triangles), dtype=int) if regions is None else regions
    with open(path, "w") as file:
        file.write(f"{len(mesh.points)} {len(mesh.triangles)} {len(mesh.edges)}\n")
        file.writelines(
            f"{x:.17g} {y:.17g} {label}\n" for (x, y), label in zip(mesh.points, point_labels)
        )
        file.writelines(
            f"{a} {b} {c} {region}\n" for (a, b, c), region in zip(mesh.triangles + 1, regions)
        )
        file.writelines(f"{a} {b} {label}\n" for (a, b), label in zip(mesh.edges + 1, mesh.labels))


def read(path: Path) -> Mesh:
    """Reads a mesh in the format of `write`; raises BadInput if the file is not such a mesh."""
    try:
        words = path.read_text().split()
        n, t, e = map(int, words[:3])
        points, triangles, edges = np.split(
            np.array(words[3:], dtype=float), [3 * n, 3 * n + 4 * t]
        )
        points, triangles, edges = (
            points.reshape(n, 3),
            triangles.reshape(t, 4),
            edges.reshape(e, 3),
        )
    except OSError as error:
        raise BadInput(f"mesh: {path} cannot be read: {error.strerror}") from None
    except ValueError:
        raise BadInput(
            f"mesh: {path} is no mesh (accepted: a 2D mesh as FreeFEM's savemesh or gmsh writes it, .msh)"
        ) from None
    return Mesh(
        points[:, :2],
        triangles[:, :3].astype(int) - 1,
        edges[:, :2].astype(int) - 1,
        edges[:, 2].astype(int),
    )
