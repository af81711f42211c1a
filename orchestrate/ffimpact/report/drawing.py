"""All figures of a finished run, each with its title."""

import re
from pathlib import Path
from textwrap import wrap

import numpy as np

from ..failure import Unreadable
from ..input.parameters import Table
from ..output import vtu
from ..output.folder import FIGURES
from ..output.results import Contents, body_names, check_files, read_history, read_json, read_scene
from . import bodies, contact as contacts, impacts, solid
from .figures import BODY, as_written, is_half, material, per_metre, save, styled, touched
from .impact import impact_of

__all__ = ["LETTERS", "MOST_LINES", "draw", "title", "wrapped"]

LETTERS, MOST_LINES = 14, 4       # letters per inch of a title; lines of each of its parts


def draw(folder: Path) -> list[Path]:
    """Draws all figures of the run in `folder` into folder/figures and returns their paths. The last
    one is energies.png: if it exists, all do. Raises Unreadable for a damaged folder.
    """
    check_files(folder)
    history, scene = impacts.with_flights(read_history(folder)), read_scene(folder)
    scene["touched"] = touched(read_json(folder / "summary.json"))
    if "body" not in scene:
        raise Unreadable(f"{folder}: of a run without Python, which keeps neither names of bodies nor obstacles (accepted: a folder of "
                         "ffimpact run)")
    snapshots = vtu.series(folder / "fields.pvd")
    target = folder / "figures"
    target.mkdir(exist_ok=True)
    touches, names, impact = history["normal_force"] > 0, body_names(scene), impact_of(scene)
    # without free flight
    contact = Contents[np.ndarray]({name: column[max(0, int(np.argmax(touches)) - 1):] for name, column in history.items()}, history.path)
    with styled():
        drawn = bodies.draw(history, contact, scene, snapshots)
        if (folder / "fields/contact.csv").exists():
            table = contacts.read(folder)
            ball, free = impact if impact and impact["kind"] in BODY and is_half(scene) else None, history["t"][~touches]
            drawn["contact"] = contacts.draw(table, names, is_half(scene), free, ball, scene.get("symmetry", "full"), history)
            if snapshots and hasattr(table, "Z"):
                drawn["solid"] = solid.draw(snapshots, table, scene)
        if (folder / "contacts.csv").exists():
            bounces, rigid = impacts.read(folder), [as_written(obstacle["name"]) for obstacle in scene.get("obstacle", [])] or ["plane"]
            drawn["bounces"] = impacts.draw(bounces, names, rigid)
            drawn["height"] = impacts.heights(history, bounces, names) if scene.get("until") == "rest" else None
        if (folder / "modes.csv").exists():
            drawn["vibration"] = impacts.vibration(impacts.read_modes(folder), history, per_metre(scene))
        figures = {name: figure for name, figure in drawn.items() if figure}
        for name, figure in reversed(figures.items()):
            figure.suptitle(wrapped(title(scene), figure.get_figwidth()))
            save(figure, target / f"{name}.png")
    # Figures that this version does not draw; `solid` stays, for which a library may be missing.
    for name in set(FIGURES) - {*figures, "solid"}:
        (target / f"{name}.png").unlink(missing_ok=True)
    return [target / f"{name}.png" for name in figures]


def title(scene: Table) -> str:
    """Returns the title of a run: that of its scene, and the material of each body; of the impact of
    a disc or ball its speed and angle, linear elements, and the friction law if there is friction.
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
    if impact.get("friction_static", 0) > 0:
        text += (f"\nfriction {impact['friction_static']:g} static, {impact['friction_dynamic']:g} dynamic, "
                 f"{impact['regularization']}, ε = {impact['slip_velocity']:g} m/s")
    return text


def wrapped(text: str, width: float) -> str:
    """Returns the lines of a title, wrapped to the width [inches] of a figure and to at most
    MOST_LINES; a number stays beside its unit.
    """
    text = re.sub(r"(?<=\d) (?=(?:m|MPa|Pa|kg)\b)", "\N{NO-BREAK SPACE}", text)
    return "\n".join("\n".join(wrap(line, int(LETTERS * width))[:MOST_LINES]) for line in text.split("\n"))
