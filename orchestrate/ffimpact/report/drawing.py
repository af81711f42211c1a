"""All figures of a finished run, each with its title."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib.figure import Figure

from ..failure import Unreadable
from ..input.parameters import Table
from ..output import vtu
from ..output.folder import FIGURES
from ..output.materials import layer_name
from ..output.results import Contents, body_names, check_files, read_history, read_json, read_scene
from . import bodies, contact as contacts, impacts, solid
from .figures import BODY, as_written, contact_bounds, is_half, material, per_metre, save, styled
from .impact import impact_of

__all__ = ["LETTERS", "MORE", "MOST_LINES", "draw", "pictures", "title", "wrapped"]

LETTERS, MOST_LINES = 14, 4  # letters per inch of a title; lines of each of its parts
# Pictures of one's own, by name: draw(history from the onset of contact on, scene) -> Figure, or None without one.
MORE: dict[str, Callable[[dict[str, np.ndarray], Table], Figure | None]] = {}


def draw(folder: Path) -> list[Path]:
    """Draws all pictures of the run in `folder` into folder/figures and returns their paths. The last
    one is energies.png: if it exists, all do. Raises Unreadable for a damaged folder.
    """
    target = folder / "figures"
    target.mkdir(exist_ok=True)
    with styled():
        drawn = {name: picture() for name, picture in pictures(folder).items()}
        figures = {name: figure for name, figure in drawn.items() if figure}
        for name, figure in reversed(figures.items()):
            save(figure, target / f"{name}.png")
    # Figures that this version does not draw; `solid` stays, for which a library may be missing.
    for name in set(FIGURES) - {*figures, "solid"}:
        (target / f"{name}.png").unlink(missing_ok=True)
    return [target / f"{name}.png" for name in figures]


def pictures(folder: Path) -> dict[str, Callable[[], Figure | None]]:
    """Returns a function for each picture of the run in `folder`, by the name of its file. It draws
    the picture, with its title, or returns None if there is nothing to show. Raises Unreadable for a
    damaged folder.
    """
    check_files(folder)
    history, scene = impacts.with_flights(read_history(folder)), read_scene(folder)
    scene["touched"] = contact_bounds(read_json(folder / "summary.json"))
    if "body" not in scene:
        raise Unreadable(
            f"{folder}: its scene.toml has no bodies (accepted: a folder of ffimpact run)"
        )
    snapshots, touches, names = (
        vtu.series(folder / "fields.pvd"),
        history["normal_force"] > 0,
        body_names(scene),
    )
    # without free flight
    contact = Contents[np.ndarray](
        {name: column[max(0, int(np.argmax(touches)) - 1) :] for name, column in history.items()},
        history.path,
    )
    made: dict[str, Callable[[], Figure | None]] = {
        **bodies.pictures(history, contact, scene, snapshots)
    }
    if (folder / "fields/contact.csv").exists():
        made |= _of_the_contact(contacts.read(folder), history, scene, snapshots)
    if (folder / "contacts.csv").exists():
        bounces, rigid = (
            impacts.read(folder),
            [as_written(obstacle["name"]) for obstacle in scene.get("obstacle", [])] or ["plane"],
        )
        made["bounces"] = lambda: impacts.draw(bounces, names, rigid)
        if scene.get("until") == "rest":
            made["height"] = lambda: impacts.heights(history, bounces, names)
    if (folder / "modes.csv").exists():
        modes = impacts.read_modes(folder)
        made["vibration"] = lambda: impacts.vibration(modes, history, per_metre(scene))
    made |= {name: partial(own, contact, scene) for name, own in MORE.items()}
    return {name: partial(_titled, picture, scene) for name, picture in made.items()}


def _of_the_contact(
    table: np.recarray,
    history: Contents[np.ndarray],
    scene: Table,
    snapshots: list[tuple[float, Path]],
) -> dict[str, Callable[[], Figure | None]]:
    """Returns the functions that draw the pictures of the contact points in `table`."""
    impact = impact_of(scene)
    ball = impact if impact and impact["kind"] in BODY and is_half(scene) else None
    free, symmetry = history["t"][history["normal_force"] == 0], scene.get("symmetry", "full")
    made: dict[str, Callable[[], Figure | None]] = {
        "contact": lambda: contacts.draw(
            table, body_names(scene), is_half(scene), free, ball, symmetry, history
        )
    }
    if snapshots and hasattr(table, "Z"):
        made["solid"] = lambda: solid.draw(snapshots, table, scene)
    return made


def _titled(picture: Callable[[], Figure | None], scene: Table) -> Figure | None:
    """Draws a picture and gives it the title of its run."""
    if figure := picture():
        figure.suptitle(wrapped(title(scene), figure.get_figwidth()))
    return figure


def title(scene: Table) -> str:
    """Returns the title of a run: that of its scene, and the material of each body; of the impact of
    a disc or ball its layers, speed and angle, linear elements, and the friction law if there is friction.
    """
    impact = impact_of(scene)
    if not impact:
        return bodies.title(scene)
    angle = "" if impact["angle"] == 90 else f" at {impact['angle']:g}°"
    body = BODY.get(impact["kind"], "")
    above = f" from a height of {impact['height']:g} m" if impact["height"] > 0 else ""
    text = f"{body}{material(impact)}, {impact['speed']:g} m/s{angle}{above}"
    if scene.get("degree") == 1:
        text += ", linear elements"
    layers: dict[str, list[str]] = {}
    for number, layer in enumerate(impact["layer"], 1):
        layers.setdefault(material(layer), []).append(layer_name(layer, number))
    text += "".join(f"\n{line}" for line in bodies.made_of(layers))
    if impact.get("friction_static", 0) > 0:
        text += (
            f"\nfriction {impact['friction_static']:g} static, {impact['friction_dynamic']:g} dynamic, "
            f"{impact['regularization']}, ε = {impact['slip_velocity']:g} m/s"
        )
    return text


def wrapped(text: str, width: float) -> str:
    """Returns the lines of a title, wrapped to the width [inches] of a figure and to at most
    MOST_LINES; a number stays beside its unit.
    """
    text = re.sub(r"(?<=\d) (?=(?:m|MPa|Pa|kg)\b)", "\N{NO-BREAK SPACE}", text)
    return "\n".join(
        "\n".join(wrap(line, int(LETTERS * width))[:MOST_LINES]) for line in text.split("\n")
    )
