"""A film of a scene: the deforming body, coloured by its stress, above the contact force over time.
A body in three dimensions is shown cut open and from below if PyVista is installed (solid.py),
otherwise by its cut with the plane z = 0.
"""

import argparse
import logging
import os
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from .. import progress, scene
from ..failure import BadInput, NotInstalled, Unreadable
from ..input.parameters import add_set, overrides, whole
from ..output import vtu
from ..output.results import Record, suffixes
from ..places import RESULTS, shown
from ..running.run import run
from . import bodies, contact, solid
from .drawing import title
from .figures import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    STRESS,
    Body,
    deformed,
    diameter,
    draw_body,
    draw_interfaces,
    is_half,
    legend,
    per_metre,
    styled,
)

__all__ = ["Motion", "PlaneStage", "SolidStage", "Stage", "main", "stage_of", "write"]

SECONDS = 8.0  # duration of the film [s]
# Largest number of frames, 50 per second. Players show a GIF with a higher frame rate more slowly.
MOST_FRAMES = 400
DPI = 110
# A failure of ffmpeg is reported in one line, see write().
logging.getLogger("matplotlib.animation").setLevel(logging.ERROR)


def main(argv: list[str]) -> int:
    """Runs or reuses the scene in DIR, with one snapshot for each frame, and writes DIR/<scene>.mp4
    (or .gif). A finished film is reused, too.
    """
    parser = argparse.ArgumentParser(prog="ffimpact movie", description=__doc__)
    parser.add_argument(
        "scene", metavar="SCENE", help="a built-in scene or the path of a TOML file"
    )
    add_set(parser, "set a parameter")
    parser.add_argument(
        "--frames",
        metavar="N",
        type=whole,
        default=100,
        help="number of frames (default: 100), and of snapshots of the run",
    )
    parser.add_argument(
        "--format", choices=("mp4", "gif"), help="default: mp4 where there is ffmpeg, otherwise gif"
    )
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="the result folder (default: results/movies/SCENE)"
    )
    options = parser.parse_args(argv)
    if not 2 <= options.frames <= MOST_FRAMES:
        raise BadInput(f"--frames: {options.frames} is out of range (accepted: 2 to {MOST_FRAMES})")
    if options.format == "mp4" and not FFMpegWriter.isAvailable():
        raise NotInstalled(
            "ffmpeg not found, which writes mp4; run: sudo apt-get install ffmpeg; or take --format gif"
        )
    form = options.format or ("mp4" if FFMpegWriter.isAvailable() else "gif")
    loaded = scene.load(options.scene)
    result = run(
        loaded,
        overrides(options.set) | {"fields": options.frames},
        options.out or RESULTS / "movies" / loaded.name,
    )
    film = result.folder / f"{loaded.name}.{form}"
    done = (
        result.reused
        and film.exists()
        and film.stat().st_mtime >= (result.folder / "summary.json").stat().st_mtime
    )
    if not done:
        write(film, result, options.frames)
    print(shown(film))
    return 0


def write(film: Path, result: Record, frames: int) -> None:
    """Writes `frames` frames, evenly spaced from the first to the last snapshot, as a film of
    SECONDS seconds. An incomplete film is removed. Raises NotInstalled if ffmpeg fails.
    """
    with styled():
        stage = stage_of(result)
        part = film.with_suffix(f".part{film.suffix}")
        kind = FFMpegWriter if film.suffix == ".mp4" else PillowWriter
        writer = kind(fps=frames / SECONDS)  # type: ignore[arg-type]  # takes fractions, too
        try:
            with writer.saving(stage.figure, part, DPI):
                for t in progress.in_turn(
                    film.name, np.linspace(stage.times[0], stage.times[-1], frames)
                ):
                    stage.show(t)
                    writer.grab_frame()
            os.replace(part, film)
        except (BrokenPipeError, subprocess.CalledProcessError) as error:
            # ffmpeg failed because another exception had stopped this program.
            if error.__context__ and not isinstance(error.__context__, BrokenPipeError):
                raise error.__context__ from None
            raise NotInstalled(
                "ffmpeg could not write the film: it lacks H.264, or the disk is full; take --format gif"
            ) from None
        finally:
            part.unlink(missing_ok=True)
            plt.close(stage.figure)


class Motion:
    """The snapshots of a run and the body at any time between them. Positions and stresses are
    interpolated linearly in time.

    `times` (s,) in s; `bodies`, one Body for each time, which contains all bodies; `diameters`,
    (m, 2) in m for each time, None if half a body was computed or if there are `several`.
    """

    def __init__(self, pvd: Path, half: bool, several: bool = False):
        series = vtu.series(pvd)
        if not series:
            raise Unreadable(f"{pvd} is missing or empty; delete its folder and run again")
        snapshots = [vtu.read(path) for _, path in series]
        self.times = np.array([t for t, _ in series])
        self.bodies = [deformed(snapshot, half) for snapshot in snapshots]
        self.diameters = None if half or several else [diameter(snapshot) for snapshot in snapshots]

    def at(self, t: float) -> tuple[Body, np.ndarray | None]:
        """Returns the body and its diameter (m, 2) [m] at time t [s]."""
        points, stress = (
            vtu.between(self.times, [getattr(body, name) for body in self.bodies], t)
            for name in ("points", "stress")
        )
        line = None if self.diameters is None else vtu.between(self.times, self.diameters, t)
        first = self.bodies[0]
        return Body(points, first.triangles, stress, first.interfaces), line


class Stage:
    """The figure of all frames. Axes, colours and curves are drawn once; `show` updates the rest to
    a time between `times` [s].

    A subclass draws the body into a panel with a given width and height in inches, and updates it.
    """

    times: np.ndarray
    figure: Figure
    above: Axes

    def move(self, t: float) -> None:
        """Updates the body to time t [s]."""
        raise NotImplementedError

    def _lay_out(self, result: Record, width: float, height: float) -> Axes:
        """Makes the figure with its title and forces, and returns the panel of the body."""
        self.figure, (self.above, below) = plt.subplots(
            2,
            figsize=(width + 2.0, height + 3.2),
            height_ratios=(height, 1.6),
            layout="constrained",
        )
        self.figure.suptitle(title(result.scene))
        self._draw_force(below, result.history, per_metre(result.scene))
        return self.above

    def _draw_force(self, axes: Axes, history: dict[str, np.ndarray], per: str) -> None:
        """Draws the normal force and, if it is not zero, the friction force [kN/m] over the time of
        the film.
        """
        inside = history["t"] >= self.times[0]
        self.t = 1e3 * history["t"][inside]
        forces = (
            {"normal": BLUE, "friction": ORANGE}
            if history["friction_force"].any()
            else {"normal": BLUE}
        )
        self.forces = {name: 1e-3 * history[f"{name}_force"][inside] for name in forces}
        axes.axhline(0, color=GREY, linewidth=0.6)
        for name, colour in forces.items():
            axes.plot(self.t, self.forces[name], color=colour, label=name)
        axes.margins(x=0.005)
        axes.set(xlabel="time [ms]", ylabel=f"contact force [kN{per}]")
        self.now = axes.axvline(self.t[0], color=BLACK, linewidth=0.8)
        self.dots = {
            name: axes.plot([], [], "o", color=colour, markersize=5, clip_on=False)[0]
            for name, colour in forces.items()
        }
        if len(forces) > 1:
            legend(axes, loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)

    def _settle(self) -> None:
        """Fixes the axes at their positions in the first frame."""
        self.show(self.times[0])
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")

    def show(self, t: float) -> None:
        """Updates all moving parts to time t [s]."""
        self.move(t)
        self.above.set_title(f"t = {1e3 * t:.2f} ms")
        self.now.set_xdata([1e3 * t] * 2)
        for name, dot in self.dots.items():
            dot.set_data([1e3 * t], [np.interp(1e3 * t, self.t, self.forces[name])])


class PlaneStage(Stage):
    """A body in the plane, or the cut of a body in three dimensions with the plane z = 0, with its
    obstacles.
    """

    def __init__(self, result: Record, motion: Motion):
        self.motion, self.times = motion, motion.times
        view = x_min, x_max, y_min, y_max = bodies.limits(motion.bodies)
        width = min(6.0, 4.8 * (x_max - x_min) / (y_max - y_min))  # [inch]
        self._lay_out(result, width, width * (y_max - y_min) / (x_max - x_min))
        self.view, self.rigid = view, bodies.obstacles_of(result.scene)
        self.drawn = bodies.draw_obstacles(self.above, self.rigid, view, motion.times[0])
        self.above.set(
            xlim=(x_min, x_max), ylim=(y_min, y_max), aspect="equal", xlabel="x [m]", ylabel="y [m]"
        )
        # The end of the colour scale is a quantile, so that a single spot does not dominate it.
        self.largest = np.quantile([body.stress for body in motion.bodies], 0.999) or 1.0
        self.picture = draw_body(self.above, motion.bodies[0], (0, self.largest))
        self.lines = draw_interfaces(self.above, motion.bodies[0])
        self.figure.colorbar(
            self.picture, ax=self.above, label=STRESS, extend="max", aspect=30, pad=0.02
        )
        self.marks = []
        if motion.diameters is not None:  # shows the rotation of the body
            outlined = [withStroke(linewidth=2.5, foreground=BLACK)]
            self.marks = [
                self.above.plot([], [], color="white", linewidth=1.2, path_effects=outlined)[0],
                self.above.plot(
                    [], [], color="white", marker="o", markersize=5, markeredgecolor=BLACK
                )[0],
            ]
        self._settle()

    def move(self, t: float) -> None:
        body, line = self.motion.at(t)
        if any(obstacle.moves for obstacle in self.rigid):
            for artist in self.drawn:
                artist.remove()
            self.drawn = bodies.draw_obstacles(self.above, self.rigid, self.view, t)
        self.picture.remove()
        self.picture = draw_body(self.above, body, (0, self.largest))
        self.lines.set_segments(list(body.points[body.interfaces]))
        if line is not None:
            self.marks[0].set_data(*line.T)
            self.marks[1].set_data(*line[:1].T)


class SolidStage(Stage):
    """A body in three dimensions: cut open, with its stress, and beside it from below, with the
    contact pressure.
    """

    def __init__(self, result: Record, views: solid.Views):
        self.views, self.times = views, views.times
        width, height = 7.2, 7.2 / 2 * solid.PIXELS[1] / solid.PIXELS[0]
        panel = self._lay_out(result, width, height)
        panel.set_axis_off()
        self.pictures = []
        for k, (image, (colours, label)) in enumerate(
            zip(views.render(views.sights[0]), solid.bars(views))
        ):
            axes = panel.inset_axes((0.5 * k, 0, 0.5, 1))
            axes.set_axis_off()
            self.pictures.append(axes.imshow(image, interpolation="antialiased"))
            self.figure.colorbar(
                colours,
                cax=panel.inset_axes((0.5 * k + 0.08, -0.05, 0.34, 0.03)),
                label=label,
                orientation="horizontal",
                extend="max",
            )
        self._settle()

    def move(self, t: float) -> None:
        for picture, image in zip(self.pictures, self.views.render(self.views.at(t))):
            picture.set_data(image)


def stage_of(result: Record) -> Stage:
    series = vtu.series(result.folder / "fields.pvd")
    if (
        series
        and vtu.read_solid(series[0][1])
        and (result.folder / "fields/contact.csv").exists()
        and not solid.missing()
    ):
        return SolidStage(result, solid.Views(series, contact.read(result.folder), result.scene))
    return PlaneStage(
        result,
        Motion(
            result.folder / "fields.pvd", is_half(result.scene), len(suffixes(result.history)) > 1
        ),
    )
