"""The player of a run, an HTML page that needs no network. It animates the deforming bodies,
coloured by a field, and the obstacles, beside figures of force and energies with a time cursor.

The bodies and obstacles are a k3d plot. The states are compressed: positions as 16-bit fractions of
the box around all states, fields as 8-bit fractions of their range. player.js decompresses and
shows them.
"""

from __future__ import annotations

import base64
import io
import itertools
import json
import zlib
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .failure import BadInput, Unreadable, unknown
from .input import dimension
from .output import vtu
from .places import PACKAGE
from .report.bodies import obstacles_of
from .report.figures import is_half

if TYPE_CHECKING:
    from .input.obstacles import Obstacle
    from .result import Result

__all__ = ["FIELDS", "Player", "Shown", "States", "states_of", "view"]

# For each name: the label, the field of the state that it is computed from, and the possible units.
FIELDS = {
    "von_mises": ("von Mises stress", "von_mises", ("Pa", "kPa", "MPa", "GPa")),
    "pressure": ("pressure", "pressure", ("Pa", "kPa", "MPa", "GPa")),
    "speed": ("speed", "velocity", ("m/s", "km/s")),
    "energy_density": ("energy density", "energy_density", ("J/m³", "kJ/m³", "MJ/m³", "GJ/m³")),
    "plastic_strain": ("plastic strain", "plastic_strain", ("1",)),
}
SECONDS = 6.0  # duration of the animation [s]
# Quantile of a field at the end of the colour scale, so that a single spot does not dominate it.
DARKEST = 0.999
TURN = np.radians(270)  # angle [rad] over which a body of revolution is shown, cut open
SECTIONS = 37  # number of sections within that angle
GRID = 40  # grid points along each side of the box in which the surface of an obstacle is computed
GROUND = 0xB8B8B8
LINE = 0.012  # width of an obstacle's line, relative to the largest side of the box of the states
STYLE = """
<style>
 html, body { background: #fff; font: 14px system-ui, sans-serif; }
 #canvasTarget { width: 62% !important; height: calc(100% - 44px) !important; }
 #figure { position: absolute; right: 0; top: 0; width: 38%; height: calc(100% - 44px);
           display: flex; align-items: center; justify-content: center; }
 #figure > div { position: relative; max-height: 100%; }
 #figure img { max-width: 38vw; max-height: calc(100vh - 50px); display: block; }
 #cursor { position: absolute; top: 2%; bottom: 9%; left: 0; border-left: 2px solid #c00; }
 #controls { position: absolute; bottom: 0; left: 0; right: 0; height: 44px; display: flex;
             align-items: center; gap: 10px; padding: 0 10px; }
 #controls #state { flex: 1; min-width: 60px; }
 #legend i { display: inline-block; width: 70px; height: 10px;
   background: linear-gradient(to right, #440154, #3b528b, #21918c, #5ec962, #fde725); }
 @media (max-width: 760px) {
   #canvasTarget { width: 100% !important; height: calc(60% - 44px) !important; }
   #figure { width: 100%; height: 40%; top: auto; bottom: 76px; }
   #figure img { max-width: 100vw; max-height: 40vh; }
   #controls { height: 76px; flex-wrap: wrap; } #controls #state { min-width: 60%; }
 }
</style>
"""


class Player:
    """The player of a run as an HTML page, `page`. A notebook displays it; `save(path)` writes it
    to a file.
    """

    def __init__(self, page: str):
        self.page = page

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self.page)}" '
            'style="width: 100%; height: 480px; border: 0"></iframe>'
        )

    def save(self, path: str | Path) -> Path:
        """Writes the page to a file and returns its path."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(self.page, "utf-8")
        return path


def view(
    result: Result,
    path: str | Path | None = None,
    field: str = "von_mises",
    revolved: bool = True,
) -> Any:
    """Returns the Player of a run, or writes it to the HTML file `path` and returns the path.

    `field` is the name in FIELDS that is shown first. A body of revolution is shown cut open, or
    with `revolved=False` as its section. A body in space that has a plane of symmetry is shown cut
    along that plane. Raises BadInput for a wrong path or field, and Unreadable
    without states.
    """
    import k3d  # slow to load, so it is imported only here

    if path is not None and Path(path).suffix.lower() not in (".html", ".htm"):
        raise BadInput(f"view: '{path}' is no HTML file (accepted: a name that ends in .html)")
    if field not in FIELDS:
        raise BadInput(f"field: {unknown(field, FIELDS, ', ')}")
    states = states_of(result, revolved)
    points = states.places.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)

    plot = k3d.plot(camera_auto_fit=False, grid_visible=False, menu_visibility=False, axes_helper=0)
    plot.background_color, plot.colorbar_object_id = 0xFFFFFF, 0
    body = k3d.mesh(
        states.places[0].astype(np.float32),
        states.triangles.astype(np.uint32),
        attribute=np.zeros(len(states.places[0]), np.float32),
        color_range=[0, 1],
        color_map=k3d.colormaps.matplotlib_color_maps.Viridis,
        side="double",
        flat_shading=False,
    )
    plot += body
    nodes, sides = np.unique(states.interfaces, return_inverse=True)
    if len(nodes):
        lines = k3d.lines(
            states.places[0][nodes].astype(np.float32),
            sides.reshape(-1, 2).astype(np.uint32),
            indices_type="segment",
            shader="mesh",
            width=0.3 * LINE * (high - low).max(),
            color=0xFFFFFF,
        )
        plot += lines
    obstacles = []
    for obstacle in obstacles_of(result.scene):
        moved = [obstacle.matrix(t) for t in states.times] if obstacle.moves else []
        if drawn := _obstacle(k3d, obstacle, states.kind, *_region(low, high, moved)):
            plot += drawn
            # the matrix of a k3d object takes its own coordinates to the start
            at_start = np.reshape(drawn.model_matrix, (4, 4))
            matrices = [(matrix @ at_start).ravel().tolist() for matrix in moved]
            obstacles.append({"id": drawn.id, "matrices": matrices})
    plot.camera_fov = 20
    plot.camera = _camera(states.kind, low, high)
    picture, cursor = _figure(result)
    run = _packed(states, low, high) | {
        "id": body.id,
        "interfaces": {"id": lines.id, "nodes": nodes.tolist()} if len(nodes) else None,
        "obstacles": obstacles,
        "field": field,
        "seconds": SECONDS,
        "start": int(np.argmin(abs(states.times - _of_largest_force(result)))),
        "cursor": cursor,
    }
    code = f"const RUN = {json.dumps(run)};\n{(PACKAGE / 'player.js').read_text('utf-8')}"
    page = plot.get_snapshot(additional_js_code=code)
    figure = f'<div id="figure"><div><img src="{picture}"><div id="cursor"></div></div></div>'
    page = page.replace("</head>", f"{STYLE}</head>", 1)
    page = page.replace("<body>", f"<body>{figure}", 1)
    player = Player(page)
    return player if path is None else player.save(path)


# ---- the states


@dataclass(frozen=True)
class States:
    """The states that the player shows.

    `places` (states, n, 3): deformed positions [m] at `times` (states,) [s]; `triangles` (t, 3);
    `interfaces` (e, 2): their sides between layers; `fields` by name (states, n) in SI units.
    `kind` is "plane", "revolved" or "space".
    """

    times: np.ndarray
    places: np.ndarray
    triangles: np.ndarray
    interfaces: np.ndarray
    fields: dict[str, np.ndarray]
    kind: str


def states_of(result: Result, revolved: bool) -> States:
    """Reads the kept states of a run in the form that the player shows. Raises Unreadable without
    states.
    """
    series = vtu.series(result.folder / "fields.pvd")
    if not series:
        raise Unreadable(
            f"{result.folder}: has no states (accepted: a run with fields = 60, for example)"
        )
    script = result["provenance"]["script"]
    of_revolution = script == dimension.AXISYMMETRIC.script
    solid = vtu.read_solid(series[0][1])
    if solid:
        kind, shown = "space", _skin(solid, str(result.scene.get("symmetry")))
    elif of_revolution and revolved:
        kind, shown = "revolved", _revolution(vtu.read(series[0][1]))
    else:
        mirrored = is_half(result.scene) or of_revolution
        kind, shown = "plane", _section(vtu.read(series[0][1]), mirrored)
    snapshots: list[Any] = [(vtu.read_solid if solid else vtu.read)(path) for _, path in series]
    places = np.array(
        [
            shown.places(_three(snapshot.points) + _three(snapshot.fields["displacement"]))
            for snapshot in snapshots
        ]
    )
    fields = {
        name: np.array([shown.values(_scalar(snapshot.fields[source])) for snapshot in snapshots])
        for name, (_, source, _) in FIELDS.items()
        if source in snapshots[0].fields
    }
    times = np.array([t for t, _ in series])
    return States(times, places, shown.triangles, shown.interfaces, fields, kind)


@dataclass(frozen=True)
class Shown:
    """Maps the nodes of a state to the vertices that are shown. Vertex i has the field value of
    node `nodes[i]`. Its position is that of the node, rotated about the y-axis by `angle[i]` [rad],
    times the signs `mirror[i]` (3,). `interfaces` (e, 2) are sides between layers.

    If `skin` is set, it first interpolates a field to the vertices of curved faces. The vertices of
    a triangle are in counter-clockwise order as seen from outside.
    """

    triangles: np.ndarray
    nodes: np.ndarray
    angle: np.ndarray
    mirror: np.ndarray
    interfaces: np.ndarray
    skin: vtu.Skin | None = None

    def values(self, field: np.ndarray) -> np.ndarray:
        """Returns a field (nodes, ...) at the vertices."""
        at_vertices: np.ndarray = (self.skin.at(field) if self.skin else field)[self.nodes]
        return at_vertices

    def places(self, places: np.ndarray) -> np.ndarray:
        """Returns the positions (vertices, 3) [m] of the vertices."""
        x, y, z = self.values(places).T
        turned = [np.cos(self.angle) * x, y, np.sin(self.angle) * x + z]
        positions: np.ndarray = np.stack(turned, axis=1) * self.mirror
        return positions


def _section(state: vtu.Snapshot, mirrored: bool) -> Shown:
    """Shows a state in the plane, with its mirror image if `mirrored`."""
    n = len(state.points)
    images = [[1, 1, 1], [-1, 1, 1]] if mirrored else [[1, 1, 1]]
    return _images(state.triangles, state.interfaces, n, images)


def _images(
    triangles: np.ndarray,
    interfaces: np.ndarray,
    n: int,
    images: list[list[int]],
    skin: vtu.Skin | None = None,
) -> Shown:
    """Shows triangles of n vertices and their sides between layers, together with their mirror
    images. Each of `images` is a list of the signs of the three coordinates.
    """
    parts = [
        (triangles if np.prod(signs) > 0 else triangles[:, ::-1]) + k * n
        for k, signs in enumerate(images)
    ]
    nodes = np.tile(np.arange(n), len(images))
    between = np.vstack([interfaces + k * n for k in range(len(images))])
    mirror = np.repeat(images, n, axis=0)
    return Shown(np.vstack(parts), nodes, np.zeros(len(nodes)), mirror, between, skin)


def _revolution(state: vtu.Snapshot) -> Shown:
    """Shows a body of revolution as its two end sections and the surface of revolution between
    them.
    """
    edges = state.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    _, first, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True
    )
    outline, ends = np.unique(edges[first[count == 1]], return_inverse=True)
    ends = ends.reshape(-1, 2)
    n, m = len(state.points), len(outline)
    triangles = [state.triangles[:, ::-1], state.triangles + n]
    for k in range(SECTIONS - 1):
        (a, b), (c, d) = (2 * n + (k + i) * m + ends.T for i in (0, 1))
        triangles += [np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)]
    nodes = np.concatenate([np.arange(n), np.arange(n), np.tile(outline, SECTIONS)])
    angle = np.concatenate(
        [np.zeros(n), np.full(n, TURN), np.repeat(np.linspace(0, TURN, SECTIONS), m)]
    )
    between = np.vstack([state.interfaces, state.interfaces + n])
    return Shown(np.vstack(triangles), nodes, angle, np.ones((len(nodes), 3)), between)


def _skin(solid: vtu.Solid, symmetry: str) -> Shown:
    """Shows the boundary faces of a body in space. A body with a plane of symmetry is shown as its
    half with z < 0, so that its inside is visible. This half consists of mirror images of the half
    or quarter with positive coordinates that was computed.
    """
    faces = solid.tetrahedra[:, vtu.FACES]
    corners = solid.points[faces[..., :3]]
    edges = corners[:, :, 1:] - corners[:, :, :1]
    outward = np.cross(edges[:, :, 0], edges[:, :, 1])
    inner = solid.points[solid.tetrahedra[:, :4]].mean(axis=1)[:, None]
    inward = np.einsum("tfi,tfi->tf", outward, inner - corners.mean(axis=2)) > 0
    faces = np.where(inward[..., None], faces[..., [0, 2, 1, 5, 4, 3]], faces).reshape(-1, 6)
    _, first, count = np.unique(
        np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = first[count == 1]
    skin = vtu.split(faces[outer].tobytes(), 2)
    between = vtu.sides_between(skin.triangles, solid.layers[outer // len(vtu.FACES)])
    images = {"half": [[1, 1, -1]], "quarter": [[1, 1, -1], [-1, 1, -1]]}
    mirrored = images.get(symmetry, [[1, 1, 1]])
    return _images(skin.triangles, between, len(skin.nodes), mirrored, skin)


def _three(vectors: np.ndarray) -> np.ndarray:
    """Pads vectors (n, 2 or 3) with zeros to three components."""
    return np.pad(vectors, [(0, 0), (0, 3 - vectors.shape[1])])


def _scalar(field: np.ndarray) -> np.ndarray:
    return np.linalg.norm(field, axis=1) if field.ndim > 1 else field


def _packed(states: States, low: np.ndarray, high: np.ndarray) -> dict[str, Any]:
    """Returns the states in the form that player.js reads."""
    extent = np.maximum(high - low, 1e-12 * (high - low).max())
    places = np.rint(65535 * (states.places - low) / extent).astype("<u2")
    fields, values = [], {}
    for name, field in states.fields.items():
        label, _, units = FIELDS[name]
        bottom, top = min(0.0, float(np.quantile(field, 1 - DARKEST))), np.quantile(field, DARKEST)
        top = float(top) if top > bottom else bottom + 1.0
        size = max(abs(bottom), abs(top))
        power = int(np.clip(np.log10(size) // 3 if size > 0 else 0, 0, len(units) - 1))
        share = np.clip((field - bottom) / (top - bottom), 0, 1)
        values[name] = _text(np.rint(255 * share).astype(np.uint8))
        fields.append(
            {
                "name": name,
                "label": f"{label} [{units[power]}]",
                "low": bottom / 1000**power,
                "high": top / 1000**power,
            }
        )
    return {
        "times": states.times.tolist(),
        "low": low.tolist(),
        "extent": extent.tolist(),
        "vertices": _text(places),
        "fields": fields,
        "values": values,
    }


def _text(array: np.ndarray) -> str:
    """Returns the differences between successive states, compressed, as text. Successive states are
    similar, so that the differences compress well.
    """
    steps = np.diff(array, axis=0, prepend=np.zeros_like(array[:1]))
    return base64.b64encode(zlib.compress(steps.tobytes(), 9)).decode()


# ---- obstacles, camera and figure


def _region(
    low: np.ndarray, high: np.ndarray, moved: list[np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Returns the corners of the region in which an obstacle is drawn: around the box of the bodies
    and, if it moves by the matrices `moved`, all that comes into it.
    """
    margin = 0.25 * (high - low).max()
    lower, upper = low - margin, high + margin
    corners = np.array([[*corner, 1.0] for corner in itertools.product(*zip(lower, upper))])
    back = [corners @ np.linalg.inv(matrix).T for matrix in moved]
    whole = np.concatenate([corners, *back])[:, :3]
    return whole.min(axis=0), whole.max(axis=0)


def _obstacle(k3d: Any, obstacle: Obstacle, kind: str, lower: np.ndarray, upper: np.ndarray) -> Any:
    """Returns an obstacle at t = 0 as a k3d object: a line in the plane, else a surface. Returns
    None if it is not visible.
    """
    count = 3 if obstacle.kind == "plane" else GRID  # the gap to a plane is linear
    x, y, z = (np.linspace(a, b, count) for a, b in zip(lower, upper))
    if kind == "plane":
        from contourpy import contour_generator

        points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        gap = obstacle.gap_in_plane(points, 0.0).reshape(count, count)
        lines = contour_generator(x, y, gap).lines(0.0)
        if not lines:
            return None
        longest = max((np.asarray(line) for line in lines), key=len)
        return k3d.line(
            _three(longest).astype(np.float32),
            shader="mesh",
            width=LINE * (upper - lower).max(),
            color=0x606060,
        )
    zs, ys, xs = np.meshgrid(z, y, x, indexing="ij")
    points = np.stack([xs, ys, zs], axis=-1).reshape(-1, 3)
    if kind == "revolved":
        points = np.stack([np.hypot(points[:, 0], points[:, 2]), points[:, 1]], axis=-1)
        gap = obstacle.gap_in_plane(points, 0.0)
    else:
        gap = obstacle.gap(points)
    if not gap.min() < 0 < gap.max():
        return None
    return k3d.marching_cubes(
        gap.reshape(count, count, count).astype(np.float32),
        level=0.0,
        color=GROUND,
        opacity=0.6,
        xmin=float(x[0]),
        xmax=float(x[-1]),
        ymin=float(y[0]),
        ymax=float(y[-1]),
        zmin=float(z[0]),
        zmax=float(z[-1]),
        flat_shading=False,
    )


def _camera(kind: str, low: np.ndarray, high: np.ndarray) -> list[float]:
    """Returns eye, target and upward direction of the camera. It looks from the front in the plane,
    otherwise from above and aside.
    """
    centre, size = (low + high) / 2, float(np.linalg.norm(high - low))
    towards = {"plane": (0, 0, 1), "revolved": (0.9, 0.45, -1.0), "space": (0.35, 0.3, 1)}[kind]
    eye = centre + 3.2 * size * np.array(towards) / np.linalg.norm(towards)
    return [*eye.tolist(), *centre.tolist(), 0, 1, 0]


def _of_largest_force(result: Result) -> float:
    """Returns the time [s] of the largest normal force. The player shows this time first."""
    return float(result.history.t[result.history.normal_force.idxmax()])


def _figure(result: Result) -> tuple[str, dict[str, float]]:
    """Returns a picture of force and energies over time, and the extent of its time axis: both ends
    as fractions of the picture's width and as times [s].
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.4, 4.8), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    result.plot.force(ax=above)
    result.plot.energies(ax=below)
    above.set_xlabel("")
    picture = io.BytesIO()
    figure.savefig(picture, format="svg")
    box, (start, end) = below.get_position(), below.get_xlim()
    cursor = {"left": box.x0, "right": box.x1, "start": 1e-3 * start, "end": 1e-3 * end}
    return f"data:image/svg+xml;base64,{base64.b64encode(picture.getvalue()).decode()}", cursor
