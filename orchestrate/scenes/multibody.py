"""A scene of one's own, bodies and obstacles in one TOML file: read, checked, and its entries set by dotted names.

    title = "..."
    dimension = "plane-strain"   # or axisymmetric (dimension.py)
    young = 7e6                  # law, young, nu, density, mesh_size, contact_mesh_size: of the bodies that say nothing else
    gravity = 9.81               # [m/s2], along -y; beside it the parameters of a run: end_time, dt, accuracy, fields ...
    [[body]]                     # see bodies.py
    [[obstacle]]                 # see obstacles.py; with penalty, friction_static, friction_dynamic of its own
    [contact]                    # penalty, exponent, friction_static, friction_dynamic, slip_velocity, regularization, friction_transition,
    pairing = "closest-point"    # pairing_range
    [[contact.pair]]             # what differs between two of them
    bodies = ["disc", "floor"]
    friction_static = 0.3
"""

import copy
import hashlib
import itertools
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .. import scene
from ..input import dimension, parameters
from . import bodies, mirror, obstacles
from .bodies import MATERIAL, SIZES, Body
from ..freefem.describe import describe
from ..input.dimension import SOLID, Dimension
from ..failure import BadInput, brief
from .obstacles import Obstacle
from ..output.estimate import LARGEST
from ..input.parameters import Value
from ..mesh.solids import Solid
from ..geometry.outlines import Outline, normal_of
from ..input.tables import Table, listed, to_toml

SCENES = scene.SCENES
RUN = ("gravity", "body_force_x", "body_force_y", "degree", "integrator", "dt", "accuracy", "accuracy_of", "tolerance", "breakdown",
       "chatter", "end_time", "fields", "modes", "checkpoint_every", "without")
OWN = ("penalty", "friction_static", "friction_dynamic")                                  # a pair may have its own
CONTACT = (*OWN, "exponent", "slip_velocity", "regularization", "friction_transition", "pairing", "pairing_range")
SHAPE = ("shape", "semi_axes", "width", "height", "depth", "inner_radius", "vertices", "file")     # sizes of a body, beside radius
EVERYWHERE = ("penalty", "dt")
TOUCHING = 1e-9              # of a body's thickness: an overlap up to it is round-off


@dataclass(frozen=True)
class Pair:
    """What differs between two partners: a body is its index from 0, obstacle k is -1 - k. `path` is the table that says so."""

    first: int
    second: int
    values: dict[str, Value]
    path: str


@dataclass(frozen=True)
class Multibody:
    """`given` are the tables of the file, `contact` is every parameter of contact, `values` every parameter of a run, both with what is
    left open (auto, 0) as it is."""

    name: str
    title: str
    dimension: Dimension
    given: dict
    folder: Path
    bodies: list[Body]
    obstacles: list[Obstacle]
    contact: dict[str, Value]
    pairs: list[Pair]
    values: dict[str, Value]
    released: tuple[str, ...] = ()      # sentences: what was fixed for others that are set now

    @property
    def script(self) -> str:
        """A file edp/<script>.edp."""
        return self.dimension.script

    def override(self, given: dict[str, Value]) -> "Multibody":
        """The same scene with some entries set by their dotted names, open again what it had fixed for them (release), and read again."""
        if not given:
            return self
        changed = self.given
        for name, value in given.items():
            changed = set_entry(changed, name, value)
        said = release(changed, list(given))
        return replace(read(changed, self.folder, self.name), released=self.released + said)

    def check(self, given: dict[str, Value]) -> dict[str, Value]:
        """The given entries of such a scene, by dotted names, text as TOML reads it; BadInput where there is no such place."""
        for name, value in given.items():
            set_entry(self.given, name, value)
        return {name: toml_value(value) for name, value in given.items()}

    @property
    def asked(self) -> dict:
        """What decides the answer: two scenes that agree in it are one run."""
        files = [str(given["file"]) for given in self.given["body"] if "file" in given]
        meshes = {name: hashlib.sha256((self.folder / name).read_bytes()).hexdigest() for name in files}
        return parameters.decisive({name: value for name, value in self.given.items() if name != "title"}) | {"files": meshes}

    @property
    def numbers(self) -> list[str]:
        """The numbers of summary.json."""
        return scene.of_bodies("summary", describe(script=self.script), len(self.bodies))

    @property
    def columns(self) -> list[str]:
        """The columns of history.csv."""
        return scene.of_bodies("columns", describe(script=self.script), len(self.bodies))

    @property
    def of_files(self) -> bool:
        """Whether a body has the mesh of a file, which no other run refines."""
        return any(bool(body.mesh) for body in self.bodies)

    @property
    def meshed(self) -> bool:
        """Whether Python makes the mesh, with gmsh."""
        return True

    @property
    def mesh_name(self) -> str:
        """The file of the mesh in a run's folder."""
        return "mesh.mesh" if self.dimension is SOLID else "mesh.msh"

    @property
    def sizes(self) -> dict[str, float]:
        """The largest mesh sizes that bodies give, 0 where none does."""
        return {name: max(getattr(body, name) for body in self.bodies) for name in SIZES}

    def description(self, foreign: bytes | None = None) -> dict:
        """Nothing more than was read; BadInput where a mesh file is given beside the scene."""
        if foreign is not None:
            raise BadInput("mesh: is of one body (accepted: in a table [[body]], shape = \"mesh\" with file)")
        return {}

    def prepare(self, where: Path, foreign: bytes | None = None) -> tuple[dict[str, Value | Path], dict, str]:
        """The flags of a run in the folder `where`, the scene as it will be used, and the text of its scene.toml. Puts into the folder what the flags
        name: the mesh of all bodies, and what bodies.edp reads of them."""
        from . import approach, assembly
        if len(self.bodies) == 1 and not self.obstacles:
            raise BadInput("obstacle: is missing, and a second body too (accepted: one table [[obstacle]] or more, or several [[body]])")
        scene = approach.turned(self)
        met = approach.meetings(scene)
        approach.refuse_nothing(scene, met)
        built = assembly.assemble(scene, met=met)
        built.write(where)
        text = to_toml(built.used)
        return built.values | {"mesh": where / self.mesh_name, "bodies": where / "scene.dat"}, tomllib.loads(text), text

    def scaled(self, values: dict, used: dict, factor: float, own_mesh: bool = True) -> dict[str, Value | list]:
        """What the scene, run as the tables `used`, is overridden by for `factor` times the elements and steps; the contact's own
        parameters stay as they were. Meshes of files stay too."""
        found = {f"contact.{name}": used["contact"][name] for name in ("penalty", "slip_velocity", "friction_dynamic")}
        if used["contact"].get("pair"):
            found["contact.pair"] = used["contact"]["pair"]
        for k, (body, given) in enumerate(zip(self.bodies, used["body"]), 1):
            if not body.mesh:
                bulk = min(factor * given["mesh_size"], body.outline.half_thickness)
                found |= {f"body.{k}.mesh_size": bulk, f"body.{k}.contact_mesh_size": min(bulk, factor * given["contact_mesh_size"])}
        if used["dt"] > 0:
            found["dt"] = factor * used["dt"]
        return found | {"accuracy": min(LARGEST, factor**2 * used["accuracy"]), "fields": 0, "modes": 0}


def built_in() -> list[str]:
    """Names of the scenes of bodies that come with the program."""
    return [name for name in scene.built_in() if "body" in scene.read_toml(SCENES / f"{name}.toml", name)[1]]


def read(given: dict, folder: Path, name: str) -> Multibody:
    """The scene in a file's tables; mesh files are sought from `folder` on. BadInput for whatever is wrong in it."""
    of = dimension.of(given)
    own = ("symmetry",) if of is SOLID else ()
    table = Table("", given, ("title", "script", "dimension", *own, "body", "obstacle", "contact", *MATERIAL, *SIZES, *RUN))
    all_bodies = bodies.read(listed(given, "body"), given, folder, of)
    if not all_bodies:
        raise BadInput("body: is missing (accepted: one table [[body]] or more)")
    rigid = listed(given, "obstacle")
    for k, one in enumerate(rigid, 1):
        _of_the_scene(f"obstacle.{k}", one)
    all_obstacles = obstacles.read([{key: value for key, value in one.items() if key not in OWN} for one in rigid], of)
    centres = np.array([body.placed.area_centre for body in all_bodies])
    half = float(np.ptp(centres, axis=0).max() / 2 + 2 * max(body.placed.reach for body in all_bodies))
    all_obstacles = obstacles.settled(all_obstacles, centres.mean(axis=0), half)
    script = table.text("script", of.script)
    if script != of.script:
        raise BadInput(f"script: '{brief(script)}' is not that of [[body]] tables in dimension = '{of.name}' (accepted: {of.script})")
    index = _names(all_bodies, all_obstacles)
    contact_table = Table("contact", given.get("contact", {}), (*CONTACT, "pair"))
    contact = _parameters(contact_table, CONTACT, of)
    pairs = _own_of_obstacles(rigid, len(all_bodies))
    for both, pair in _exceptions(contact_table, index).items():
        pairs[both] = replace(pair, values=pairs[both].values | pair.values) if both in pairs else pair
    values = _parameters(table, RUN, of)
    found = Multibody(name, table.text("title", name), of, given, folder, all_bodies, all_obstacles, contact,
                      [pairs[both] for both in sorted(pairs)], values)
    _apart(found)
    mirror.copies(found)
    return found


def _parameters(table: Table, keys: tuple[str, ...], of: Dimension) -> dict[str, Value]:
    """Those of the parameters that the script takes; BadInput for one that it does not."""
    for key in keys:
        if key in table:
            parameters.taken(key, of.script)
    return {key: table.parameter(key, parameters.table()[key]) for key in keys if of.script in parameters.table()[key].scripts}


def _names(all_bodies: list[Body], all_obstacles: list[Obstacle]) -> dict[str, int]:
    """Names of bodies and obstacles, each once, and what stands for them in a Pair."""
    index, where = {}, {}
    for path, number, one in [*((f"body.{k + 1}", k, one) for k, one in enumerate(all_bodies)),
                              *((f"obstacle.{k + 1}", -1 - k, one) for k, one in enumerate(all_obstacles))]:
        if one.name in index:
            raise BadInput(f"{path}.name: '{brief(one.name)}' is the name of {where[one.name]} too (accepted: each name once)")
        index[one.name], where[one.name] = number, path
    return index


# ---- contact

def _own_of_obstacles(rigid: list[dict], bodies_count: int) -> dict[tuple[int, int], Pair]:
    """What [[obstacle]] tables say of contact, as exceptions against every body."""
    pairs = {}
    for k, given in enumerate(rigid):
        mine = Table(f"obstacle.{k + 1}", {key: given[key] for key in OWN if key in given}, OWN)
        own = {key: mine.parameter(key, parameters.table()[key]) for key in mine.given}
        pairs |= {(body, -1 - k): Pair(body, -1 - k, own, mine.path) for body in range(bodies_count) if own}
    return pairs


def _exceptions(contact: Table, index: dict[str, int]) -> dict[tuple[int, int], Pair]:
    """The tables [[contact.pair]]."""
    pairs = {}
    for k, given in enumerate(listed({"contact.pair": contact.given.get("pair", [])}, "contact.pair"), 1):
        path = f"contact.pair.{k}"
        _of_the_scene(path, given)
        table = Table(path, given, ("bodies", *OWN))
        both = _partners(path, table.given.get("bodies"), index)
        if both in pairs:
            raise BadInput(f"{path}.bodies: '{brief(table.given['bodies'])}' has a table already (accepted: one a pair)")
        pairs[both] = Pair(*both, {key: table.parameter(key, parameters.table()[key]) for key in OWN if key in table}, path)
    return pairs


def _of_the_scene(path: str, given: dict) -> None:
    """BadInput where a table has of its own what the contact of a scene has one of."""
    for key in CONTACT:
        if key in given and key not in OWN:
            raise BadInput(f"{path}.{key}: '{brief(given[key])}' holds for the whole scene (accepted: in [contact]; here {', '.join(OWN)})")


def _partners(path: str, given, index: dict[str, int]) -> tuple[int, int]:
    """The two of a pair, the body or the first body first."""
    accepted = f"accepted: two names, one at least of a body, of {', '.join(index)}"
    if not isinstance(given, list) or len(given) != 2 or not all(isinstance(name, str) for name in given):
        raise BadInput(f"{path}.bodies: '{'' if given is None else brief(given)}' is no pair ({accepted})")
    for name in given:
        if name not in index:
            raise BadInput(f"{path}.bodies: '{brief(name)}' is not in the scene ({accepted})")
    first, second = sorted((index[name] for name in given), key=lambda k: (k < 0, abs(k)))
    if first == second or first < 0:
        raise BadInput(f"{path}.bodies: '{brief(given)}' cannot touch each other ({accepted})")
    return first, second


# ---- places

def _apart(found: Multibody) -> None:
    """BadInput where a body overlaps another one or an obstacle at the start."""
    for (i, body), (j, other) in itertools.combinations(enumerate(found.bodies, 1), 2):
        _refuse_overlap(f"body.{i}", body, f"body.{j}", other.name, gap_between(body.placed, other.placed))
    for (i, body), (j, other) in itertools.product(enumerate(found.bodies, 1), enumerate(found.obstacles, 1)):
        _refuse_overlap(f"body.{i}", body, f"obstacle.{j}", other.name, gap_to_obstacle(body.placed, other))


def _refuse_overlap(path: str, body: Body, other_path: str, other: str, gap: float) -> None:
    if gap < -TOUCHING * body.outline.half_thickness:
        raise BadInput(f"{path}.position: '{body.name}' overlaps '{other}' ({other_path}) by {-gap:.3g} m at the start "
                       f"(accepted: apart or touching)")


def gap_between(first: Outline | Solid, second: Outline | Solid) -> float:
    """The distance of two bodies, negative where they overlap: by how far a point of one is inside the other."""
    return min(second.least(first.gap), first.least(second.gap))


def gap_to_obstacle(outline: Outline | Solid, obstacle: Obstacle) -> float:
    """The distance of a body from an obstacle, negative where they overlap."""
    centre, least = outline.area_centre, obstacle.gap_from(outline)
    nearest = centre - obstacle.gap(centre[None]) * normal_of(obstacle, centre)
    is_of_it = obstacle.gap(nearest[None])[0] < 1e-4 * outline.half_thickness    # not where the distance has no gradient
    return float(min(least, outline.gap(nearest[None])[0]) if is_of_it else least)    # the former: an obstacle inside the body


# ---- entries by name

def set_entry(given: dict, name: str, value: Value | list) -> dict:
    """The tables of a file with one entry set: "body.2.young", "contact.pair.1.penalty", "body.1.velocity.2"; tables and
    components of a list are counted from 1. `value` may be text as on a command line. BadInput where there is no such place."""
    changed = copy.deepcopy(given)
    place, path = changed, ""
    *way, last = name.split(".")
    for step, following in zip(way, [*way[1:], last]):
        path = f"{path}.{step}" if path else step
        if isinstance(place, dict) and step not in place and path == "contact":
            place[step] = {}
        key = _key(place, step, path, name)
        if key not in place if isinstance(place, dict) else False:
            raise BadInput(f"{brief(name)}: there is no {brief(path)} in the scene (accepted: {', '.join(place)})")
        place = place[key]
        if not isinstance(place, dict | list):
            raise BadInput(f"{brief(name)}: {path} is '{brief(place)}' and has no entry {brief(following)}")
    place[_key(place, last, name, name)] = toml_value(value)
    return changed


def release(given: dict, names: list[str]) -> tuple[str, ...]:
    """Takes out of the tables of a file what FOLLOWS says that the entries `names`, which were set, leave open; the sentences about it. What is of one table
    (coefficients of friction, sizes of a body) follows what is set there, penalty and step whatever body it is of."""
    places = [_table_of(name) for name in names]
    said = []
    for path, table in list(_tables(given)):
        for key in [key for key in parameters.FOLLOWS if key in table and (path, key) not in places]:
            causes = parameters.FOLLOWS[key] + (SHAPE if "radius" in parameters.FOLLOWS[key] else ())
            found = [name for name, (where, entry) in zip(names, places) if entry in causes and (where == path or key in EVERYWHERE)]
            if found and table[key] not in ("auto", 0):
                said.append(parameters.release(f"{path}.{key}".lstrip("."), table.pop(key), found))
    return tuple(said)


def _tables(value, path: str = "") -> Iterator[tuple[str, dict]]:
    """All tables in a table or a list, with their dotted names."""
    if isinstance(value, dict):
        yield path, value
    for key, one in value.items() if isinstance(value, dict) else enumerate(value, 1) if isinstance(value, list) else ():
        yield from _tables(one, f"{path}.{key}".lstrip("."))


def _table_of(name: str) -> tuple[str, str]:
    """Of a dotted name that of its table, and the entry in it."""
    parts = name.split(".")
    depth = 3 if parts[:2] == ["contact", "pair"] else {"body": 2, "obstacle": 2, "contact": 1}.get(parts[0], 0)
    return ".".join(parts[:depth]), ".".join(parts[depth:depth + 1])


def _key(place: dict | list, step: str, path: str, name: str) -> str | int:
    """The key of one step, from 0 in lists."""
    if not step:
        raise BadInput(f"{brief(name)}: has an empty part (accepted: names and numbers with single dots between them)")
    if isinstance(place, dict):
        return step
    if not re.fullmatch("[0-9]{1,6}", step) or not 1 <= int(step) <= len(place):
        before = path.removesuffix(f".{step}")
        numbers = f"{before}.1 to {before}.{len(place)}" if len(place) > 1 else f"{before}.1"
        raise BadInput(f"{brief(name)}: there is no {brief(path)} in the scene (accepted: {numbers})")
    return int(step) - 1


def toml_value(value):
    """Text as TOML reads it, where it does; numbers and arrays of numpy as plain ones."""
    if not isinstance(value, str):
        return value.tolist() if isinstance(value, np.generic | np.ndarray) else value
    try:
        return tomllib.loads(f"value = {value}")["value"] if "\n" not in value else value
    except tomllib.TOMLDecodeError:
        return value
