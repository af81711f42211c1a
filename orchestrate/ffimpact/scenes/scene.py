"""Scenes: reads and checks them, and sets their entries by dotted names.

A scene is a TOML file with tables of bodies and obstacles (docs/how-to/scenes.md), or one of the
paper's cases. The script of such a case makes the bodies from parameters, which are all at the top
of the file.
"""

import hashlib
import itertools
import json
import os
import shutil
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..failure import BadInput, brief, gathered
from ..geometry.outlines import Outline, Shape, normal_of
from ..input import dimension, models, parameters
from ..input.bodies import FIELDS, SIZES, Body
from ..input.contact import CONTACT, Contact, Pair
from ..input.dimension import AXISYMMETRIC, SOLID, Dimension
from ..input.entries import Entries
from ..input.materials import MATERIAL, STIFFEST
from ..input.models import listed
from ..input.obstacles import Obstacle
from ..input.parameters import Table, Value
from ..mesh.solid_file import declares_unit, takes_in_others
from ..output import former
from ..output.columns import Features, recorded
from . import mirror, needs
from .entries import files_renamed, release, set_entry, toml_value

__all__ = ["RUN", "STIFF", "Scene", "gap_between", "gap_to_obstacle", "read", "refuse_rest"]

RUN = (
    "gravity",
    "body_force_x",
    "body_force_y",
    "volume",
    "degree",
    "integrator",
    "dt",
    "accuracy",
    "accuracy_of",
    "tolerance",
    "breakdown",
    "chatter",
    "end_time",
    "start",
    "until",
    "fields",
    "modes",
    "checkpoint_every",
    "without",
)
# `young` of a rigid body over the largest of the others. Its strain is smaller by this factor.
STIFF = 1e5
# Bending strain (Outline.folding) up to which a body may come into contact with itself: that of a
# ring as thick as its inner radius.
FOLDING = 0.2
LONG = 100  # number of items from which on a list is a table
WIDE = 100.0  # width [m] of a body from a file above which its units are doubtful
TOUCHING = 1e-9  # overlap at the start that is round-off, over half the thickness of the body
# Overlap, likewise, that may be the depth at rest under weight or loads. The solver knows the penalty
# and judges it by its force (edp/program/run/start.idp).
SUNK = 0.05


@dataclass(frozen=True)
class Scene:
    """A scene as it was read.

    `content` holds the tables of the file, `values` every parameter of a run and `contact` those of
    [contact]. Values that are left to the program (auto, 0) stay as they are.
    """

    name: str
    title: str
    script: str
    content: Table
    folder: Path
    values: dict[str, Value]
    dimension: Dimension
    bodies: list[Body]
    obstacles: list[Obstacle]
    contact: dict[str, Value]
    pairs: list[Pair]
    released: tuple[str, ...] = ()  # messages about entries that override() reset to automatic

    def override(self, entries: dict[str, Value]) -> "Scene":
        """Returns the scene with `entries` set by dotted names (text or values). Entries that
        depend on them are reset to automatic (release()). Raises BadInput for whatever is wrong
        then.
        """
        if not entries:
            return self
        named = self._by_full_name(self.check(entries))
        changed = self.content
        for name, value in named.items():
            changed = set_entry(changed, name, value)
        messages = release(changed, list(named))
        return replace(read(changed, self.folder, self.name), released=self.released + messages)

    def check(self, entries: dict[str, Value]) -> dict[str, Value]:
        """Returns `entries`, by dotted names, with converted values. Raises BadInput if the
        scene has no such entry, or if the entry would change nothing.
        """
        converted, changed = (
            {name: toml_value(value) for name, value in entries.items()},
            self.content,
        )
        for name, value in self._by_full_name(converted).items():
            changed = set_entry(changed, name, value)
        # A value at the top of the file applies only to bodies without a value of their own.
        for name in converted:
            if name in (*MATERIAL, *SIZES) and all(
                name in body for body in listed(changed, "body")
            ):
                raise BadInput(
                    f"{name}: changes nothing, as every body has its own (accepted: body.1.{name} and so on)"
                )
        return converted

    def tables(self, entries: dict[str, Value]) -> models.Tables:
        """Returns the tables with `entries` set, and those that depend on them automatic. Raises
        BadInput if the rule of an entry refuses its value, or it does not agree with its table.
        """
        changed, named = self.content, self._by_full_name(entries)
        for name, value in named.items():
            changed = set_entry(changed, name, value)
        release(changed, list(named))
        return models.read(changed, self.dimension)

    def _by_full_name(self, entries: dict[str, Value]) -> dict[str, Value]:
        """Returns `entries` by their dotted names. Of two that are the same entry the later holds."""
        return {
            models.full_name(self.content, name, self.dimension): value
            for name, value in entries.items()
        }

    @property
    def decisive_entries(self) -> Table:
        """The entries that decide the results, apart from the script, and the sha256 of files. Two
        scenes for which they are equal are the same run. Long tables are given by their sha256.
        """
        files: list[str] = []

        def listed_file(label: str, name: str) -> str:
            files.append(name)
            return name

        files_renamed(self.content, listed_file)
        meshes = {
            name: hashlib.sha256((self.folder / name).read_bytes()).hexdigest() for name in files
        }
        harmless = ("title", "script", *parameters.NOT_DECISIVE)
        own = {name: value for name, value in self.content.items() if name not in harmless}
        return {name: _shortened(value) for name, value in own.items()} | {"files": meshes}

    def with_files_in(self, where: Path, tables: Table) -> Table:
        """Copies the files of bodies, obstacles, supports and loads to `where`/body-files and
        returns `tables` with the paths of the copies.

        A scene.toml in `where` then finds the files wherever the folder is moved. A .geo file that
        includes other files is not copied: its path becomes relative to `where`.
        """

        def copied(label: str, name: str) -> str:
            path = self.folder / name
            if takes_in_others(path):
                return Path(os.path.relpath(path, where)).as_posix()
            copy = Path("body-files", f"{label}{path.suffix}")
            (where / copy).parent.mkdir(exist_ok=True)
            shutil.copyfile(path, where / copy)
            return copy.as_posix()

        return files_renamed(tables, copied)

    def number(self, name: str) -> float:
        """The value of a parameter of the run or of [contact] that is a number."""
        return float((self.values | self.contact)[name])

    @property
    def numbers(self) -> list[str]:
        """The names of the numbers of summary.json."""
        return recorded("summary.json", self.features)

    @property
    def columns(self) -> list[str]:
        """The names of the columns of history.csv."""
        return recorded("history.csv", self.features)

    @property
    def features(self) -> Features:
        """What decides the names of numbers and columns."""
        loads = [load for body in self.bodies for load in body.loads]
        words = {
            "penalty_damped": bool(self.contact["penalty_damping"]),
            "damped": self.damped,
            "projected": self._projected,
            "solid": self.script == SOLID.script,
        }
        return Features(
            words=frozenset(word for word, has in words.items() if has),
            bodies=len(self.bodies),
            supports=sum(len(body.supports) for body in self.bodies),
            loads=len(loads),
            gases=tuple(k for k, load in enumerate(loads, 1) if load.kind == "gas"),
        )

    @property
    def damped(self) -> bool:
        """Whether any body is damped."""
        return any(body.made_of.damped for body in self.bodies)

    @property
    def _projected(self) -> bool:
        """Whether the volume of the elements is projected. This needs quadratic elements, a
        `volume` that is not "plain" and a body with nu above STIFFEST.
        """
        stiffest = max(body.made_of.nu for body in self.bodies)
        return (
            self.values["volume"] != "plain" and self.values["degree"] == 2 and stiffest > STIFFEST
        )

    @property
    def of_files(self) -> bool:
        """Whether a body has the mesh of a file. Other runs cannot refine this mesh."""
        return any(bool(body.file_mesh) for body in self.bodies)

    @property
    def mesh_name(self) -> str:
        """The name of the mesh file in the folder of a run."""
        return "mesh.mesh" if self.dimension is SOLID else "mesh.msh"

    @property
    def sizes(self) -> dict[str, float]:
        """The largest element sizes [m] that bodies set, 0 where none does."""
        bulk = max(body.bulk_size for body in self.bodies)
        contact = max(body.contact_size for body in self.bodies)
        return dict(zip(SIZES, (bulk, contact)))


def _shortened(value: Any) -> Any:
    """Returns a value with a sha256 in place of each list of more than LONG items."""
    if isinstance(value, dict):
        return {name: _shortened(item) for name, item in value.items()}
    if isinstance(value, list) and len(value) > LONG:
        return (
            f"{len(value)} items, sha256 {hashlib.sha256(json.dumps(value).encode()).hexdigest()}"
        )
    return [_shortened(item) for item in value] if isinstance(value, list) else value


def read(content: Table, folder: Path, name: str) -> Scene:
    """Returns the scene in the tables of a file. Paths of other files are relative to `folder`.
    Raises BadInput for whatever is wrong in the tables.
    """
    folder = folder.absolute()  # finds files from any working folder
    if not content:
        raise BadInput(
            "says nothing (accepted: a scene, as the built-in ones in orchestrate/ffimpact/scenes)"
        )
    if str(content.get("script")) in former.SCRIPTS:
        raise BadInput(
            f"script: '{content['script']}' is no kind of scene any more (accepted: tables [[body]], "
            "[[obstacle]] and [contact], as in the built-in scene of its name)"
        )
    scene_dimension = dimension.of_scene(content)
    tables = models.read(content, scene_dimension, folder)
    if not tables.bodies:
        raise BadInput("body: is missing (accepted: one table [[body]] or more)")
    top = tables.top
    if top.script not in (None, scene_dimension.script):
        raise BadInput(
            f"script: '{top.value_text('script')}' is not that of [[body]] tables in "
            f"dimension = '{scene_dimension.name}' (accepted: {scene_dimension.script})"
        )
    _, _, contact, values = gathered(
        (
            lambda: gathered([body.check for body in tables.bodies]),
            lambda: gathered([obstacle.check for obstacle in tables.obstacles]),
            lambda: _parameters(tables.contact, CONTACT, scene_dimension),
            lambda: _parameters(top, RUN, scene_dimension),
        )
    )
    all_bodies = tables.bodies
    for key in SIZES:
        if getattr(top, key) and all(body.file_mesh for body in all_bodies):
            raise BadInput(
                f"{key}: '{brief(content[key])}' changes nothing, as the mesh of every body is "
                f"that of its file, with its own element sizes (accepted: 0)"
            )
    centres = np.array([body.placed.area_centre for body in all_bodies])
    half = float(
        np.ptp(centres, axis=0).max() / 2 + 2 * max(body.placed.reach for body in all_bodies)
    )
    middle = centres.mean(axis=0)
    all_obstacles = [obstacle.within(middle, half) for obstacle in tables.obstacles]
    index = _names(all_bodies, all_obstacles)
    pairs = _own_of_obstacles(tables.obstacles, len(all_bodies))
    for both, pair in _exceptions(tables.contact.pair or [], index).items():
        own = pairs[both].own if both in pairs else {}
        pairs[both] = Pair.between(*both, pair.entry, own | pair.own)
    penalties = _penalties(contact["penalty"], pairs, list(index.values()))
    all_bodies = _stiffened(all_bodies, penalties, "contact.penalty")
    if all(body.rigid for body in all_bodies) and contact["penalty"] == "auto":
        contact |= {"penalty": max(penalties)}  # no pair uses it, and no body would determine it
    for k in _touching_themselves(
        tables.contact,
        all_bodies,
        scene_dimension,
        len(all_bodies) == 1 and not tables.obstacles,
    ):
        pairs.setdefault((k, k), Pair.between(k, k, "contact", {}))
    scene = Scene(
        name,
        top.title or name,
        scene_dimension.script,
        content,
        folder,
        values,
        scene_dimension,
        all_bodies,
        all_obstacles,
        contact,
        [pairs[both] for both in sorted(pairs)],
    )
    _apart(scene)
    needs.refuse(scene)
    _refuse_friction(scene)
    _refuse_start(scene)
    for k, body in enumerate(all_bodies, 1):
        prefix = f"body.{k}." if len(all_bodies) > 1 else ""
        for entry, text in body.made_of.refusals():
            raise BadInput(f"{prefix}{entry}{text}")
    mirror.copies(scene)
    return scene


def _refuse_friction(scene: Scene) -> None:
    """Raises BadInput if a dynamic coefficient is larger than the static one, in [contact] or in a
    pair, which inherits what it does not set.
    """
    common = scene.contact
    for path, own in [("contact", common), *((pair.entry, pair.own) for pair in scene.pairs)]:
        static = own.get("friction_static", common["friction_static"])
        inherited = "auto" if "friction_static" in own else common["friction_dynamic"]
        dynamic = own.get("friction_dynamic", inherited)
        if dynamic != "auto" and float(dynamic) > float(static):
            raise BadInput(
                f"{path}.friction_dynamic: {dynamic:g} is larger than friction_static {static:g} "
                "(accepted: 0 to friction_static)"
            )


def refuse_rest(scene: Scene) -> None:
    """Raises BadInput if nothing ever moves."""
    surfaces: list[Body | Obstacle] = [*scene.bodies, *scene.obstacles]
    moving = [
        *(surface.start_velocity for surface in surfaces),
        *(body.start_spin for body in scene.bodies),
        *(scene.values.get(name, 0.0) for name in ("gravity", "body_force_x", "body_force_y")),
    ]
    if (
        not any(np.any(motion) for motion in moving)
        and not any(surface.driven for surface in surfaces)
        and not any(body.supports or body.loads or body.has_fields for body in scene.bodies)
    ):
        raise BadInput(
            "velocity: 0 of every body, without spin, gravity, body force, moved support or "
            "obstacle, or load: nothing would ever move (accepted: one of them)"
        )


def _refuse_start(scene: Scene) -> None:
    """Raises BadInput if the scene starts in equilibrium and something moves at t = 0."""
    if scene.values["start"] != "equilibrium":
        return
    for key, table in [
        *((f"body.{k}", body) for k, body in enumerate(scene.content["body"], 1)),
        *((f"obstacle.{k}", table) for k, table in enumerate(scene.content.get("obstacle", []), 1)),
    ]:
        for name in ("velocity", "spin", *FIELDS):
            if name in FIELDS and name in table or np.any(np.atleast_1d(table.get(name, 0.0))):
                raise BadInput(
                    f"{key}.{name}: '{brief(table[name])}' beside start = 'equilibrium', where all is at "
                    "rest (accepted: 0, or start = 'given')"
                )


def _parameters(
    table: Entries, keys: tuple[str, ...], scene_dimension: Dimension
) -> dict[str, Value]:
    """Returns the values of the parameters `keys` that the script takes; defaults where the table
    has no entry. Raises BadInput for an entry that the script does not take.
    """
    gathered(
        [partial(parameters.taken, key, scene_dimension.script) for key in keys if key in table]
    )
    rules = {
        key: parameters.PARAMETERS[key]
        for key in keys
        if scene_dimension.script in parameters.PARAMETERS[key].scripts
    }
    return {
        key: getattr(table, key) if key in table else rule.default for key, rule in rules.items()
    }


def _names(all_bodies: list[Body], all_obstacles: list[Obstacle]) -> dict[str, int]:
    """Returns the index of each body and obstacle by name, as in a Pair. Raises BadInput if a name
    occurs twice.
    """
    index: dict[str, int] = {}
    where: dict[str, str] = {}
    for path, number, name in [
        *((f"body.{k + 1}", k, body.own_name) for k, body in enumerate(all_bodies)),
        *((f"obstacle.{k + 1}", -1 - k, other.own_name) for k, other in enumerate(all_obstacles)),
    ]:
        if name in index:
            raise BadInput(
                f"{path}.name: '{brief(name)}' is the name of {where[name]} too (accepted: each name once)"
            )
        index[name], where[name] = number, path
    return index


def _stiffened(bodies: list[Body], penalties: list[Value], path: str) -> list[Body]:
    """Returns the bodies of a scene with `young` of the rigid ones.

    It is STIFF times the largest `young` of the other bodies. If all bodies are rigid it is STIFF
    times the largest of the `penalties` times the largest half thickness. Raises BadInput if one of
    the penalties is automatic then.
    """
    if not any(body.rigid for body in bodies):
        return bodies
    soft = max((body.made_of.young for body in bodies if not body.rigid), default=0.0)
    if not soft and "auto" in penalties:
        raise BadInput(
            f"{path}: 'auto' follows from a body that deforms, and all are rigid (accepted: a number, Pa/m^m)"
        )
    half = max(body.outline.half_thickness for body in bodies)
    young = STIFF * (soft or max(float(penalty) for penalty in penalties) * half)
    return [
        body.model_copy(update={"made_of": body.made_of.model_copy(update={"young": young})})
        if body.rigid
        else body
        for body in bodies
    ]


# ---- contact


def _own_of_obstacles(tables: list[Obstacle], bodies_count: int) -> dict[tuple[int, int], Pair]:
    """Returns the contact parameters in [[obstacle]] tables, as exceptions for every body."""
    pairs: dict[tuple[int, int], Pair] = {}
    for k, table in enumerate(tables):
        pairs |= {
            (body, -1 - k): Pair.between(body, -1 - k, table.entry, table.own)
            for body in range(bodies_count)
            if table.own
        }
    return pairs


def _penalties(
    common: Value, pairs: dict[tuple[int, int], Pair], surfaces: list[int]
) -> list[Value]:
    """Returns the penalties of all pairs of surfaces, given by their indices; `common` where a pair
    has none of its own, and where there is no pair.
    """
    every = [both for both in itertools.combinations(surfaces, 2) if both[0] >= 0]
    own = {both: pair.own["penalty"] for both, pair in pairs.items() if "penalty" in pair}
    return [own.get(both, common) for both in every] or [common]


def _exceptions(tables: list[Pair], index: dict[str, int]) -> dict[tuple[int, int], Pair]:
    """Returns the exceptions in the tables [[contact.pair]] by the two indices."""
    pairs: dict[tuple[int, int], Pair] = {}
    for table in tables:
        both = _partners(table.entry, table.bodies, index)
        if both in pairs:
            raise BadInput(
                f"{table.at('bodies')}: '{table.value_text('bodies')}' has a table already (accepted: one a pair)"
            )
        pairs[both] = Pair.between(*both, table.entry, table.own)
    return pairs


def _touching_themselves(
    contact: Contact,
    all_bodies: list[Body],
    scene_dimension: Dimension,
    alone: bool,
) -> list[int]:
    """Returns the bodies that may come into contact with themselves, by `self_contact`.

    "auto" takes bodies in the plane or of revolution that close at a bending strain below FOLDING,
    and nothing takes rigid ones.
    A body that is `alone`, without obstacles or other bodies, always may.
    """
    self_contact = contact.self_contact or "auto"
    if alone and self_contact == "off":
        raise BadInput(
            f"{contact.at('self_contact')}: off, but a body without obstacles and other bodies may "
            f"come into contact with itself (accepted: auto|on, or an obstacle)"
        )
    if alone:
        return [0]
    if self_contact == "off":
        return []
    return [
        k
        for k, body in enumerate(all_bodies)
        if not body.rigid
        and (
            self_contact == "on"
            or isinstance(body.outline, Outline)
            and body.outline.folding(scene_dimension is AXISYMMETRIC) < FOLDING
        )
    ]


def _partners(path: str, names: Any, index: dict[str, int]) -> tuple[int, int]:
    """Returns the indices of the two surfaces of a contact pair, the body or the first body
    first.
    """
    accepted = f"accepted: two names, one at least of a body, of {', '.join(index)}"
    if (
        not isinstance(names, list)
        or len(names) != 2
        or not all(isinstance(name, str) for name in names)
    ):
        raise BadInput(
            f"{path}.bodies: '{'' if names is None else brief(names)}' is no pair ({accepted})"
        )
    for name in names:
        if name not in index:
            raise BadInput(f"{path}.bodies: '{brief(name)}' is not in the scene ({accepted})")
    first, second = sorted((index[name] for name in names), key=lambda k: (k < 0, abs(k)))
    if first < 0:
        raise BadInput(
            f"{path}.bodies: '{brief(names)}' cannot come into contact with each other ({accepted})"
        )
    return first, second


# ---- positions at the start


def _apart(scene: Scene) -> None:
    """Raises BadInput if a body overlaps another one or an obstacle at the start."""
    placed = [body.placed for body in scene.bodies]
    centres, reaches = (
        np.array([shape.area_centre for shape in placed]),
        np.array([shape.reach for shape in placed]),
    )
    distances = np.linalg.norm(centres[:, None] - centres, axis=2)
    for i, j in np.argwhere(np.triu(distances <= reaches[:, None] + reaches, 1)):
        body, other = scene.bodies[i], scene.bodies[j]
        _refuse_overlap(
            f"body.{i + 1}",
            body,
            f"body.{j + 1}",
            other.own_name,
            gap_between(placed[i], placed[j]),
            _sinks(scene),
            _units(scene, i + 1, body) or _units(scene, j + 1, other),
        )
    for (i, body), (j, other) in itertools.product(
        enumerate(scene.bodies, 1), enumerate(scene.obstacles, 1)
    ):
        _refuse_overlap(
            f"body.{i}",
            body,
            f"obstacle.{j}",
            other.own_name,
            gap_to_obstacle(body.placed, other),
            _sinks(scene),
            _units(scene, i, body),
        )


def _units(scene: Scene, i: int, body: Body) -> str:
    """Returns a hint for a message if body i comes from a file and is wider than WIDE."""
    width, file = 2 * body.outline.reach, scene.content["body"][i - 1].get("file")
    return (
        f"; its file is {width:.3g} m wide: other units? body.{i}.scale = 0.001 takes them as mm"
        if file and width > WIDE and not declares_unit(scene.folder / file)
        else ""
    )


def _sinks(scene: Scene) -> float:
    """Returns the overlap at the start that is not refused, over half the thickness of the body."""
    presses = any(scene.values.get(name) for name in ("gravity", "body_force_x", "body_force_y"))
    return SUNK if presses or any(body.loads for body in scene.bodies) else TOUCHING


def _refuse_overlap(
    path: str, body: Body, other_path: str, other: str, gap: float, sinks: float, hint: str = ""
) -> None:
    if gap < -sinks * body.outline.half_thickness:
        raise BadInput(
            f"{path}.position: '{body.own_name}' overlaps '{other}' ({other_path}) by {-gap:.3g} m at the start "
            f"(accepted: apart or touching{'' if other_path.startswith('body') else ', on the side that its normal points to'})"
            f"{hint}"
        )


def gap_between(first: Shape, second: Shape) -> float:
    """Returns the distance [m] of two bodies. It is negative where they overlap: minus the depth of
    the deepest point of one inside the other.
    """
    return min(second.least(first.gap), first.least(second.gap))


def gap_to_obstacle(outline: Shape, obstacle: Obstacle) -> float:
    """Returns the distance [m] of a body from an obstacle, negative where they overlap."""
    centre, least = outline.area_centre, obstacle.gap_from(outline)
    nearest = centre - obstacle.gap(centre[None]) * normal_of(obstacle.gap, centre)
    # The projection `nearest` is not on the obstacle where its distance has no gradient. The gap of
    # the body at `nearest` finds an obstacle inside the body.
    is_of_it = obstacle.gap(nearest[None])[0] < 1e-4 * outline.half_thickness
    return float(min(least, outline.gap(nearest[None])[0]) if is_of_it else least)
