"""Pictures of a body in three dimensions: cut open, with the von Mises stress, and from below, with
the contact pressure. PyVista renders them if it is installed (INSTALL). The arrays in the pictures
are computed without PyVista.
"""

import os
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ..input.parameters import Table
from ..output import vtu
from ..output.results import Contents
from ..places import shown
from .bodies import obstacles_of
from .contact import PRESSURE
from .figures import STRESS, evenly

__all__ = [
    "AXES",
    "INSTALL",
    "PIXELS",
    "Pressure",
    "Sight",
    "Views",
    "bars",
    "draw",
    "in_front",
    "missing",
    "skin",
    "whole",
]

INSTALL = f"{shown(Path(sys.executable))} -m pip install pyvista vtk"
PROBE = (
    "import pyvista; p = pyvista.Plotter(off_screen=True, window_size=(8, 8)); p.add_mesh(pyvista.Sphere()); "
    "p.screenshot(None, return_img=True)"
)
INSTANTS = 4  # largest number of instants in the picture
FINE = 4  # number of segments into which an edge of a face is split
PIXELS = (700, 620)  # width and height of a view
COLOURS = {"stress": "viridis", "pressure": "YlOrRd"}
GROUND = "#d0d0d0"
GRID = 60  # grid points along each side of the box in which an obstacle's surface is computed
# Axes along which the computed part of a symmetric body has a mirror image.
AXES = {"quarter": (0, 2), "half": (2,)}


@cache
def missing() -> str:
    """Returns the reason why nothing can be rendered on this machine, or an empty text if rendering
    works. Another process tests this, because VTK crashes if there is no OpenGL.
    """
    if not os.environ.get("DISPLAY"):
        # Renders off-screen without searching for a screen.
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    try:
        probe = subprocess.run(
            [sys.executable, "-c", PROBE], capture_output=True, text=True, timeout=120
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"PyVista cannot render here: {type(error).__name__}"
    if "ModuleNotFoundError" in probe.stderr:
        return f"PyVista is not installed ({INSTALL})"
    return (
        ""
        if probe.returncode == 0
        else "PyVista cannot render here: it needs EGL or a screen (apt-get install libegl1)"
    )


# ---- the surface


def skin(tetrahedra: np.ndarray, layers: np.ndarray) -> tuple[vtu.Skin, np.ndarray]:
    """Returns the boundary faces of quadratic tetrahedra, and their sides (e, 2) between layers."""
    faces = tetrahedra[:, vtu.FACES].reshape(-1, 6)
    _, first, count = np.unique(
        np.sort(faces[:, :3], axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = first[count == 1]
    made = vtu.split(faces[outer].tobytes(), FINE)
    return made, vtu.sides_between(made.triangles, layers[outer // len(vtu.FACES)])


def whole(solid: vtu.Solid, axes: tuple[int, ...]) -> vtu.Solid:
    """Returns the whole body as one mesh: the computed part, in which the coordinates `axes` are
    positive, and its mirror images.
    """
    for axis in axes:
        points, n = solid.points, len(solid.points)
        on_plane = np.abs(points[:, axis]) < 1e-9 * np.ptp(points, axis=0).max()
        twin = np.where(on_plane, np.arange(n), n + np.cumsum(~on_plane) - 1)
        flip = np.where(np.arange(3) == axis, -1.0, 1.0)
        image = points[~on_plane] * flip
        moved, stress = solid.fields["displacement"], solid.fields["von_mises"]
        fields = {
            "displacement": np.concatenate([moved, flip * moved[~on_plane]]),
            "von_mises": np.concatenate([stress, stress[~on_plane]]),
        }
        solid = vtu.Solid(
            np.concatenate([points, image]),
            np.vstack([solid.tetrahedra, twin[solid.tetrahedra]]),
            Contents(fields, solid.fields.path),
            np.tile(solid.layers, 2),
        )
    return solid


def in_front(solid: vtu.Solid, axes: tuple[int, ...]) -> np.ndarray:
    """Returns which tetrahedra (t,) are removed to look into the body: those with z > 0. Of a
    quarter with its mirror images, only those with x > 0 and z > 0 are removed.
    """
    middle = solid.points[solid.tetrahedra[:, :4]].mean(axis=1)
    front: np.ndarray = (middle[:, 2] > 0) & ((middle[:, 0] > 0) | (0 not in axes))
    return front


# ---- the pressure on the surface


class Pressure:
    """The pressure (m,) [Pa] at the vertices (m, 3) of a skin in the reference configuration. It is
    the mean over contact points in the neighbourhood, weighted with their area A and
    exp(-(distance/h)^2), where h^2 is the largest A.

    Points that bear no load at the time have zero pressure. If the points that ever bear load cover
    only part of the neighbourhood of radius 2 h, the rest of it has zero pressure. This preserves
    the total force.
    """

    def __init__(self, table: np.recarray, axes: tuple[int, ...], vertices: np.ndarray):
        self.table, self.largest = table, float(table.pressure.max()) if len(table) else 0.0
        rows = np.stack([table[name] for name in ("X", "Y", "Z", "weight")], axis=1)
        self.points = rows[np.unique(rows[:, :3], axis=0, return_index=True)[1]]
        positions, self.source = self.points[:, :3], np.arange(len(self.points))
        for axis in axes:
            positions = np.vstack([positions, positions * np.where(np.arange(3) == axis, -1, 1)])
            self.source = np.concatenate([self.source, self.source])
        self.near, self.share = np.zeros(len(vertices), bool), np.zeros((0, len(positions)))
        if len(positions):
            shares = self.points[self.source, 3] / 2 ** len(axes)
            h = np.sqrt(shares.max())
            low, high = positions.min(axis=0) - 2 * h, positions.max(axis=0) + 2 * h
            self.near = ((vertices > low) & (vertices < high)).all(axis=1)
            square = ((vertices[self.near, None] - positions) ** 2).sum(axis=2) / h**2
            weight = np.where(square < 4, np.exp(-square), 0) * shares
            self.share = weight / np.maximum(
                weight.sum(axis=1, keepdims=True), np.pi * h**2 * (1 - np.exp(-4))
            )

    def at(self, t: float) -> np.ndarray:
        now = self.table[self.table.t == self._instant(t)]
        load = dict(zip(zip(now.X, now.Y, now.Z), now.pressure))
        values = np.array([load.get((x, y, z), 0.0) for x, y, z, _ in self.points])
        pressure = np.zeros(len(self.near))
        pressure[self.near] = self.share @ values[self.source] if len(values) else 0.0
        return pressure

    def _instant(self, t: float) -> float:
        """Returns the time in the table that equals `t` within the digits that are written, or nan
        if no point bears load at that time.
        """
        times = np.unique(self.table.t)
        nearest = times[np.abs(times - t).argmin()] if len(times) else np.nan
        return (
            nearest
            if abs(nearest - t) <= 1e-6 * max(abs(t), np.ptp(times) if len(times) else 0)
            else np.nan
        )


# ---- the views


@dataclass(frozen=True)
class Sight:
    """The data of a view at time t [s]: vertices (m, 3) [m] and von Mises stress [MPa] of the cut
    body, vertices [m] and contact pressure [MPa] of the whole body.
    """

    t: float
    cut: np.ndarray
    stress: np.ndarray
    outside: np.ndarray
    pressure: np.ndarray


class Views:
    """Renders the snapshots `series` of a body in three dimensions. `times` [s]; `stress`,
    `pressure`: upper ends of the colour scales [MPa]; `loaded`: indices of the snapshots with
    contact (more than 5 % of the largest pressure).
    """

    def __init__(self, series: list[tuple[float, Path]], table: np.recarray, scene: Table):
        axes = AXES.get(scene.get("symmetry", "full"), ())
        solids = [whole(solid, axes) for _, path in series if (solid := vtu.read_solid(path))]
        points, tetrahedra = solids[0].points, solids[0].tetrahedra
        behind, layers = ~in_front(solids[0], axes), solids[0].layers
        self.cut, self.lines = skin(tetrahedra[behind], layers[behind])
        self.outside, self.outside_lines = skin(tetrahedra, layers)
        self.times = np.array([t for t, _ in series])
        self.rigid = obstacles_of(scene)
        pressure = Pressure(table, axes, self.outside.at(points))
        self.sights = [
            self._sight(t, solid, pressure.at(t)) for t, solid in zip(self.times, solids)
        ]
        # The end of the colour scale is a quantile, so that a single spot does not dominate it.
        self.stress = float(np.quantile([sight.stress for sight in self.sights], 0.999)) or 1.0
        self.pressure = max(float(sight.pressure.max()) for sight in self.sights) or 1.0
        self.loaded = [
            k for k, sight in enumerate(self.sights) if sight.pressure.max() > 0.05 * self.pressure
        ]
        # The direction from the centre to the eye.
        self.towards = (0.75, 0.42, 1.0) if 0 in axes else (0.3, 0.3, 1.0)
        ends = np.array(
            [[sight.outside.min(axis=0), sight.outside.max(axis=0)] for sight in self.sights]
        )
        self.low, self.high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)

    def _sight(self, t: float, solid: vtu.Solid, pressure: np.ndarray) -> Sight:
        positions = solid.points + solid.fields["displacement"]
        return Sight(
            t,
            self.cut.at(positions),
            1e-6 * self.cut.at(solid.fields["von_mises"]),
            self.outside.at(positions),
            1e-6 * pressure,
        )

    def at(self, t: float) -> Sight:
        """Returns the data of a view at time t [s], linearly interpolated between snapshots."""
        return Sight(
            t,
            *(
                vtu.between(self.times, [getattr(sight, name) for sight in self.sights], t)
                for name in ("cut", "stress", "outside", "pressure")
            ),
        )

    def render(self, sight: Sight) -> tuple[np.ndarray, np.ndarray]:
        """Returns both views as images (height, width, 3): the cut body from the front, and the
        whole body from below, without obstacles.
        """
        return (
            self._image(
                sight.cut,
                self.cut.triangles,
                self.lines,
                sight.stress,
                self.stress,
                COLOURS["stress"],
                self.towards,
                sight.t,
            ),
            self._image(
                sight.outside,
                self.outside.triangles,
                self.outside_lines,
                sight.pressure,
                self.pressure,
                COLOURS["pressure"],
                (0.25, -1.0, 0.55),
                None,
            ),
        )

    def _image(
        self,
        vertices: np.ndarray,
        triangles: np.ndarray,
        lines: np.ndarray,
        values: np.ndarray,
        largest: float,
        colours: str,
        towards: tuple[float, float, float],
        t: float | None,
    ) -> np.ndarray:
        import pyvista

        plotter = pyvista.Plotter(off_screen=True, window_size=PIXELS)
        try:
            surface = pyvista.PolyData(
                vertices, np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
            )
            surface.point_data["value"] = values
            plotter.add_mesh(
                surface,
                scalars="value",
                cmap=colours,
                clim=(0, largest),
                show_scalar_bar=False,
                smooth_shading=True,
                split_sharp_edges=True,
                feature_angle=40,
                ambient=0.45,
                diffuse=0.55,
            )
            if len(lines):
                ends = np.column_stack([np.full(len(lines), 2), lines]).ravel()
                between = pyvista.PolyData(vertices, lines=ends)
                colour = "white" if colours == COLOURS["stress"] else "black"
                plotter.add_mesh(between, color=colour, line_width=2, lighting=False)
            centre, size = (self.low + self.high) / 2, self.high - self.low
            for obstacle in self.rigid if t is not None else []:
                low, span = self.low - 0.08 * size.max(), size + 0.16 * size.max()
                box = pyvista.ImageData(
                    dimensions=(GRID,) * 3, origin=low, spacing=span / (GRID - 1)
                )
                gap = obstacle.gap(box.points - obstacle.start_velocity * t)
                if gap.min() < 0 < gap.max():
                    plotter.add_mesh(
                        box.contour([0.0], scalars=gap),
                        color=GROUND,
                        opacity=0.5,
                        lighting=obstacle.kind != "plane",
                        show_scalar_bar=False,
                    )
            plotter.camera_position = [
                centre + 10 * np.linalg.norm(size) * np.array(towards) / np.linalg.norm(towards),
                centre,
                (0, 1, 0),
            ]
            plotter.enable_parallel_projection()
            plotter.camera.parallel_scale = 0.38 * np.linalg.norm(size)
            plotter.enable_anti_aliasing("ssaa")
            plotter.background_color = "white"
            image: np.ndarray = plotter.screenshot(None, return_img=True)
            return image
        finally:
            plotter.close()


def draw(series: list[tuple[float, Path]], table: np.recarray, scene: Table) -> Figure | None:
    """Draws the body at up to INSTANTS times with contact: in the upper row cut open, with its
    stress; in the lower row from below, with the contact pressure. Returns None for a body in the
    plane, without contact, and if nothing can be rendered.
    """
    if not len(table) or vtu.read_solid(series[0][1]) is None or missing():
        return None
    views = Views(series, table, scene)
    picked = evenly(views.loaded or [0], INSTANTS)
    figure, grid = plt.subplots(
        2, len(picked), figsize=(2.5 * len(picked) + 0.9, 4.6), squeeze=False, layout="constrained"
    )
    for column, k in zip(grid.T, picked):
        for axes, image in zip(column, views.render(views.sights[k])):
            axes.imshow(image)
            axes.set_axis_off()
        column[0].set_title(f"{1e3 * views.times[k]:.2f} ms", pad=2)
    for row, bar in zip(grid, bars(views)):
        figure.colorbar(bar[0], ax=row, label=bar[1], shrink=0.8, aspect=22, extend="max")
    return figure


def bars(views: Views) -> list[tuple[ScalarMappable, str]]:
    """Returns the colour scales and the labels of stress and pressure."""
    return [
        (ScalarMappable(Normalize(0, largest), COLOURS[name]), label)
        for name, largest, label in (
            ("stress", views.stress, STRESS),
            ("pressure", views.pressure, PRESSURE),
        )
    ]
