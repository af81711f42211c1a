"""The bodies of a scene: [[body]] tables as outlines (or meshes) with material, place and motion, SI units.

    [[body]]
    name = "disc"                # body1, body2 ... where it is left out
    shape = "disc"               # radius
                                 # ellipse: semi_axes [a, b];  rectangle: width, height;  ring: radius, inner_radius
                                 # polygon: vertices [[x, y], ...], holes [[[x, y], ...], ...], in coordinates of its own
                                 # mesh: file (FreeFEM's or gmsh's .msh), lengths in m; labels 1: may touch, others: never touch
    position = [0, 1.5]          # centre of its area at the start [m]
    angle = 30                   # turned about it, counter-clockwise [deg]
    velocity = [0, -10]          # [m/s], or: speed = 10, direction = -90 [deg], counter-clockwise from x
    spin = 0                     # [rad/s], counter-clockwise
    young = 7e6                  # law, young, nu, density: those at the top of the file where they are left out
    mesh_size = 0.1              # mesh_size, contact_mesh_size [m]: from the accuracy where they are left out
"""

import math
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import gmsh_file, mesh, parameters
from .describe import describe
from .failure import BadInput
from .outlines import Loop, Outline, crossing_sides, ellipse_loop, polygon_loop, self_crossing
from .tables import LONGEST, SHORTEST, Table

SHAPES = {"disc": ("radius",), "ellipse": ("semi_axes",), "rectangle": ("width", "height"), "ring": ("radius", "inner_radius"),
          "polygon": ("vertices", "holes"), "mesh": ("file",)}
MATERIAL = ("law", "young", "nu", "density")
SIZES = ("mesh_size", "contact_mesh_size")
COMMON = ("name", "shape", "position", "angle", "velocity", "speed", "direction", "spin", *MATERIAL, *SIZES)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.-]*")
LEAST_SIDES = 12             # of a circle of a mesh file: with fewer it is meant as a polygon


@dataclass(frozen=True)
class Body:
    """`outline` and `mesh` (of a mesh file, else None) are about the centre of area, not turned; angle [rad]; a mesh size of 0 is
    open."""

    name: str
    outline: Outline
    mesh: mesh.Mesh | None
    position: np.ndarray
    angle: float
    velocity: np.ndarray
    spin: float
    law: str
    young: float
    nu: float
    density: float
    mesh_size: float
    contact_mesh_size: float

    @property
    def placed(self) -> Outline:
        """The outline where it is at the start."""
        return self.outline.placed(self.position, self.angle)


def read(tables: list[dict], top: dict, folder: Path) -> list[Body]:
    """The bodies of the [[body]] tables; `top` holds the entries at the top of the file, mesh files are sought from `folder` on."""
    return [_body(f"body.{k}", given, top, folder) for k, given in enumerate(tables, 1)]


def _body(path: str, given: dict, top: dict, folder: Path) -> Body:
    shapes = "|".join(SHAPES)
    if "shape" not in given:
        raise BadInput(f"{path}.shape: is missing (accepted: {shapes})")
    if not isinstance(given["shape"], str) or given["shape"] not in SHAPES:
        raise BadInput(f"{path}.shape: '{given['shape']}' is not known (accepted: {shapes})")
    table = Table(path, given, (*COMMON, *SHAPES[given["shape"]]))
    body_mesh = _mesh(table, folder) if given["shape"] == "mesh" else None
    outline = _mesh_outline(body_mesh) if body_mesh else _outline(table)
    if outline.half_thickness < SHORTEST:
        raise BadInput(f"{path}: is {2 * outline.half_thickness:.3g} m thick (accepted: from {2 * SHORTEST:g} m)")
    centre = outline.area_centre
    if body_mesh:
        body_mesh = mesh.Mesh(body_mesh.points - centre, body_mesh.triangles, body_mesh.edges, body_mesh.labels)
    return Body(checked_name(path, given.get("name", path.replace(".", ""))), outline.placed(-centre, 0.0), body_mesh,
                table.numbers("position", -LONGEST, LONGEST), math.radians(table.number("angle", -36000, 36000, 0.0)),
                _velocity(table), float(table.parameter("spin", parameters.table()["spin"])),
                *_material(table, top), *_sizes(table, top))


def checked_name(path: str, name) -> str:
    """A name that is one word in a data file; BadInput where it is none."""
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise BadInput(f"{path}.name: '{name}' is no name (accepted: letters, digits, _ - . without blanks, a letter first)")
    return name


def _velocity(table: Table) -> np.ndarray:
    if "velocity" in table and ("speed" in table or "direction" in table):
        raise BadInput(f"{table.path}.velocity: '{table.given['velocity']}' stands beside speed or direction (accepted: velocity, or speed with direction)")
    if ("speed" in table) != ("direction" in table):
        missing = "direction" if "speed" in table else "speed"
        raise BadInput(f"{table.path}.{missing}: is missing (accepted: speed [m/s] with direction [deg], counter-clockwise from x)")
    if "speed" not in table:
        return table.numbers("velocity", -LONGEST, LONGEST, (0.0, 0.0))
    speed, degrees = table.number("speed", 0, LONGEST), table.number("direction", -36000, 36000)
    return speed * np.array([_sin(degrees + 90), _sin(degrees)])


def _sin(degrees: float) -> float:
    """The sine, exact at multiples of a right angle."""
    return (0.0, 1.0, 0.0, -1.0)[int(degrees // 90) % 4] if degrees % 90 == 0 else math.sin(math.radians(degrees))


def _material(table: Table, top: dict) -> tuple[str, float, float, float]:
    """law, young, nu, density: the body's own, else those at the top of the file; BadInput where one is in neither."""
    found = []
    for key in MATERIAL:
        if key not in table and key not in top:
            raise BadInput(f"{table.path}.{key}: is missing, here and at the top of the file (accepted: {parameters.table()[key].accepted})")
        found.append(table.parameter(key, parameters.table()[key]) if key in table else parameters.table()[key].check(top[key]))
    return tuple(found)


def _sizes(table: Table, top: dict) -> tuple[float, float]:
    rules = [parameters.table()[key] for key in SIZES]
    bulk, contact = (table.parameter(rule.name, rule) if rule.name in table else rule.check(top.get(rule.name, 0.0)) for rule in rules)
    if 0 < bulk < contact:
        raise BadInput(f"{table.path}.contact_mesh_size: {contact:g} is larger than mesh_size {bulk:g}")
    return float(bulk), float(contact)


# ---- shapes

def _outline(table: Table) -> Outline:
    shape = table.given["shape"]
    if shape == "disc":
        radius = table.number("radius", SHORTEST, LONGEST)
        return Outline((ellipse_loop(radius, radius),))
    if shape == "ellipse":
        return Outline((ellipse_loop(*table.numbers("semi_axes", SHORTEST, LONGEST)),))
    if shape == "rectangle":
        half = np.array([table.number("width", SHORTEST, LONGEST), table.number("height", SHORTEST, LONGEST)]) / 2
        return Outline((Loop(half * [[-1, -1], [1, -1], [1, 1], [-1, 1]]),))
    if shape == "ring":
        radius, inner = table.number("radius", SHORTEST, LONGEST), table.number("inner_radius", SHORTEST, LONGEST)
        if inner >= radius:
            raise BadInput(f"{table.path}.inner_radius: {inner:g} is not less than the radius {radius:g}")
        return Outline((ellipse_loop(radius, radius), ellipse_loop(inner, inner)))
    return _polygon(table)


def _polygon(table: Table) -> Outline:
    """The polygon with its holes; BadInput where it crosses itself, or a hole is not inside it and apart from the others."""
    outer, holes = table.points("vertices"), table.polygons("holes")
    named = [(f"{table.path}.vertices", outer), *((f"{table.path}.holes.{k}", hole) for k, hole in enumerate(holes, 1))]
    for path, corners in named:
        _simple(path, corners)
    loops = [polygon_loop(corners) for _, corners in named]
    for k, (path, hole) in enumerate(named[1:], 1):
        for other in range(k):
            crossing = len(crossing_sides(hole, named[other][1])) > 0
            if other == 0 and (crossing or (loops[0].gap(hole) > 0).any()):
                raise BadInput(f"{path}: is not inside {named[0][0]} (accepted: holes that neither cross nor touch the outline)")
            if other > 0 and (crossing or loops[other].gap(hole[:1]) < 0 or loops[k].gap(named[other][1][:1]) < 0):
                raise BadInput(f"{path}: overlaps {named[other][0]} (accepted: holes apart from each other)")
    return Outline(tuple(loops))


def _simple(path: str, corners: np.ndarray) -> None:
    n, same = len(corners), np.argwhere((corners == np.roll(corners, -1, axis=0)).all(axis=1)).ravel()
    if len(same):
        raise BadInput(f"{path}: vertices {same[0] + 1} and {(same[0] + 1) % n + 1} coincide (accepted: each vertex once, the polygon closes itself)")
    if sides := self_crossing(corners):
        first, second = (f"from vertex {k + 1} to {(k + 1) % n + 1}" for k in sides)
        raise BadInput(f"{path}: the side {first} meets the side {second} (accepted: a polygon that does not cross or touch itself)")


# ---- mesh files

def _mesh(table: Table, folder: Path) -> mesh.Mesh:
    """The mesh of a body's file, checked by the scripts as any mesh file is."""
    name, file = table.text("file", ""), None
    if "\0" in name or not _may_be_read(folder / name):
        raise BadInput(f"{table.path}.file: {name!r} is no file (accepted: FreeFEM's or gmsh's .msh)")
    try:
        text = mesh.load(folder / name)
        with tempfile.NamedTemporaryFile(suffix=".msh") as file:
            file.write(text)
            file.flush()
            found = mesh.read(Path(file.name))
            if (found.labels == mesh.AXIS).any():
                raise BadInput(f"mesh: '{name}' has edges with the label {mesh.AXIS} of a symmetry axis (accepted: whole bodies, "
                               f"labels {mesh.FREE}: may touch, 3 and more: never touch)")
            size = float(np.ptp(found.points, axis=0).max()) if len(found.points) else 0.0
            describe({"mesh": file.name, "radius": size / 2 if SHORTEST < size < LONGEST else 1.0})
    except BadInput as error:
        raise BadInput(f"{table.path}.file: {str(error).removeprefix('mesh: ').replace(file.name if file else name, name)}") from None
    return found


def _may_be_read(path: Path) -> bool:
    """Not a folder, and not a pipe or device, which would be waited for."""
    try:
        return path.is_file() or not path.exists()
    except OSError:                 # too long a name, a folder that may not be entered: said where it is opened
        return True


def _mesh_outline(found: mesh.Mesh) -> Outline:
    """The boundary of a mesh as loops, that of the largest area first; where the vertices of one lie on a circle (to 1e-9 of its
    radius) it is that circle."""
    edges = gmsh_file.boundary(found.triangles)
    following = dict(edges.tolist())
    loops = []
    while following:
        first, v = (chain := list(following.popitem()))
        while v != first:
            v = following.pop(v)
            chain.append(v)
        loops.append(_circle_or_polygon(found.points[chain[:-1]]))
    return Outline(tuple(sorted(loops, key=lambda loop: -loop.area)))


def _circle_or_polygon(corners: np.ndarray) -> Loop:
    middle = corners.mean(axis=0)
    scale = np.ptp(corners, axis=0).max()
    local = (corners - middle) / scale
    (x, y, rest), *_ = np.linalg.lstsq(np.column_stack([2 * local, np.ones(len(local))]), (local**2).sum(axis=1), rcond=None)
    radius = math.sqrt(max(rest + x**2 + y**2, 0.0))        # x^2 + y^2 - 2 (x x_c + y y_c) = r^2 - x_c^2 - y_c^2
    off = abs(np.hypot(*(local - [x, y]).T) - radius).max()
    if len(corners) < LEAST_SIDES or off > 1e-9 * radius:
        return polygon_loop(corners)
    return ellipse_loop(scale * radius, scale * radius).placed(middle + scale * np.array([x, y]), 0.0)
