"""A scene: bodies and obstacles in the tables of one TOML file (docs: scenes says which), read,
checked, and its entries set by dotted names; or one of the paper's, whose script makes the bodies
of its parameters, all at the top of the file.
"""

import hashlib
import itertools
import os
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from ..failure import BadInput, brief, gathered, unknown
from ..freefem.describe import describe, describe_results
from ..geometry.outlines import Shape, normal_of
from ..input import dimension, models, parameters
from ..input.dimension import AXISYMMETRIC, SOLID, Dimension
from ..input.models import CONTACT, MATERIAL, OWN, listed
from ..input.parameters import Value
from ..input.table import MESHED, SCRIPTS
from ..mesh.solid_file import takes_in_others
from . import bodies, conditions, mirror, obstacles
from .bodies import SIZES, Body
from .entries import release, set_entry, toml_value
from .obstacles import Obstacle

__all__ = ["Pair", "RUN", "Scene", "gap_between", "gap_to_obstacle", "read"]

RUN = (
    "gravity",
    "body_force_x",
    "body_force_y",
    "degree",
    "integrator",
    "dt",
    "accuracy",
    "accuracy_of",
    "tolerance",
    "breakdown",
    "chatter",
    "end_time",
    "until",
    "fields",
    "modes",
    "checkpoint_every",
    "without",
)
# of Outline.folding: that of a ring as thick as its inner radius; what closes only at more does not
# touch itself
FOLDING = 0.2
WIDE = 100.0  # m: a body of a file that is wider may be in other units
TOUCHING = 1e-9  # of a body's thickness: an overlap up to it is round-off


@dataclass(frozen=True)
class Pair:
    """What differs between two partners: a body is its index from 0, obstacle k is -1 - k.
    `path` is the table that says so.
    """

    first: int
    second: int
    values: dict[str, Value]
    path: str


@dataclass(frozen=True)
class Scene:
    """`given` are the tables of the file, `values` every parameter of a run, `contact` those of
    [contact], both with what is left open (auto, 0) as it is. Without `bodies` it is one of the
    paper's: `values`, and `given` with them, hold EVERY parameter that edp/<script>.edp takes,
    in SI units.
    """

    name: str
    title: str
    script: str
    given: dict
    folder: Path
    values: dict[str, Value]
    dimension: Dimension | None = None
    bodies: list[Body] = field(default_factory=list)
    obstacles: list[Obstacle] = field(default_factory=list)
    contact: dict[str, Value] = field(default_factory=dict)
    pairs: list[Pair] = field(default_factory=list)
    released: tuple[str, ...] = ()  # sentences: what was fixed for others that are set now

    def override(self, given: dict[str, Value]) -> "Scene":
        """The same scene with some entries set by their dotted names (text or values), open
        again what it had fixed for them (release), and read again.
        """
        if not given:
            return self
        changed = self.given
        for name, value in self.check(given).items():
            changed = set_entry(changed, name, value)
        said = release(changed, list(given))
        return replace(read(changed, self.folder, self.name), released=self.released + said)

    def check(self, given: dict[str, Value]) -> dict[str, Value]:
        """The given entries of such a scene, by dotted names, converted; BadInput where
        there is no such place.
        """
        if not self.bodies:
            return parameters.check(given, self.script)
        found, changed = {name: toml_value(value) for name, value in given.items()}, self.given
        for name, value in found.items():
            changed = set_entry(changed, name, value)
        for name in found:  # at the top it is for bodies without their own
            if name in (*MATERIAL, *SIZES) and all(
                name in body for body in listed(changed, "body")
            ):
                raise BadInput(
                    f"{name}: changes nothing, as every body has its own (accepted: body.1.{name} and so on)"
                )
        return found

    @property
    def asked(self) -> dict:
        """What decides the answer beside the script: two scenes that agree in it are one run."""
        files = [
            str(given["file"])
            for key in ("body", "obstacle")
            for given in self.given.get(key, [])
            if "file" in given
        ]
        meshes = {
            name: hashlib.sha256((self.folder / name).read_bytes()).hexdigest() for name in files
        }
        harmless = ("title", "script", *parameters.NOT_DECISIVE)
        return {name: value for name, value in self.given.items() if name not in harmless} | {
            "files": meshes
        }

    def with_files_in(self, where: Path, tables: dict) -> dict:
        """The tables of the scene with copies of the files of bodies and obstacles, made in
        `where`/body-files: a scene.toml there finds them wherever the folder is moved. A
        .geo that takes in other files stays beside them: its path is relative to
        `where`.
        """
        changed = dict(tables)
        for key, named in (("body", self.bodies), ("obstacle", self.obstacles)):
            if tables.get(key):
                changed[key] = [
                    self._with_copy(where, one.name, table) if "file" in table else table
                    for one, table in zip(named, tables[key])
                ]
        return changed

    def _with_copy(self, where: Path, name: str, table: dict) -> dict:
        """A table with the copy of its file."""
        path = self.folder / table["file"]
        copy = Path("body-files", f"{name}{path.suffix}")
        if takes_in_others(path):
            copy = Path(os.path.relpath(path, where))
        else:
            (where / copy).parent.mkdir(exist_ok=True)
            shutil.copyfile(path, where / copy)
        return table | {"file": copy.as_posix()}

    @property
    def numbers(self) -> list[str]:
        """The numbers of summary.json."""
        return self._named("summary")

    @property
    def columns(self) -> list[str]:
        """The columns of history.csv."""
        return self._named("columns")

    def _named(self, what: str) -> list[str]:
        """Columns or numbers; those of each of several bodies have the suffixes _1, _2 ..."""
        said = describe_results(script=self.script)
        bodies = len(self.bodies) or said["bodies"]
        more = said["damped"] * self.damped + said["projected"] * (
            what == "columns" and self._projected(said["plain_nu"])
        )
        return (
            said[what]
            + more
            + [
                f"{name}_{b}"
                for b in range(1, bodies + 1)
                for name in said[f"body_{what}"] + more
                if bodies > 1
            ]
        )

    @property
    def damped(self) -> bool:
        """Whether a body is."""
        return any(body.damped for body in self.bodies) or any(
            self.values.get(name) for name in bodies.DAMPED
        )

    def _projected(self, plain_nu: float) -> bool:
        """Whether nu of a body is above what is as stiff at points: the volume of its
        elements is projected then.
        """
        stiffest = max([body.nu for body in self.bodies] or [self.values["nu"]])
        return (
            self.values.get("volume") != "plain"
            and self.values["degree"] == 2
            and stiffest > plain_nu
        )

    @property
    def of_files(self) -> bool:
        """Whether a body has the mesh of a file, which no other run refines."""
        return any(bool(body.mesh) for body in self.bodies)

    @property
    def meshed(self) -> bool:
        """Whether Python makes the mesh, with gmsh; else the script does."""
        return self.script in MESHED

    @property
    def mesh_name(self) -> str:
        """The file of the mesh in a run's folder."""
        return "mesh.mesh" if self.dimension is SOLID else "mesh.msh"

    @property
    def sizes(self) -> dict[str, float]:
        """The largest mesh sizes that bodies give, 0 where none does, beside `values`."""
        return (
            {name: max(getattr(body, name) for body in self.bodies) for name in SIZES}
            if self.bodies
            else {}
        )

    def description(self, foreign: bytes | None = None, path: Path | None = None) -> dict:
        """What the script says of one of the paper's scenes, on the mesh `foreign`
        (FreeFEM's .msh, of the file `path`) where there is one; BadInput where it refuses
        it. Of others nothing more than was read.
        """
        if self.bodies:
            if foreign is not None:
                raise BadInput(
                    'mesh: is of one body (accepted: in a table [[body]], shape = "mesh" with file)'
                )
            return {}
        if foreign is None:
            return describe(self.values, self.script)
        if not self.meshed:
            raise BadInput(
                f"mesh: {self.script} takes no such parameter (accepted: in {'|'.join(MESHED)})"
            )
        with tempfile.NamedTemporaryFile(suffix=".msh") as file:
            file.write(foreign)
            file.flush()
            try:
                return describe(self.values | {"mesh": file.name}, self.script)
            except BadInput as error:
                raise BadInput(str(error).replace(file.name, str(path))) from None


def read(given: dict, folder: Path, name: str) -> Scene:
    """The scene in a file's tables; mesh files are sought from `folder` on. BadInput for
    whatever is wrong in it.
    """
    folder = folder.absolute()  # so that files are found from any working folder
    if {"body", "obstacle", "contact", "dimension"} & set(given):
        return _of_tables(given, folder, name)
    if not given:
        raise BadInput(
            "says nothing (accepted: a scene, as the built-in ones in orchestrate/ffimpact/scenes)"
        )
    script, title = given.get("script", "disc-plane"), given.get("title", name)
    if not isinstance(title, str):
        raise BadInput(f"title: '{brief(title)}' is no text (accepted: text in quotes)")
    if script in dimension.SCRIPTS:
        raise BadInput(
            f"body: is missing, which script = '{brief(script)}' needs (accepted: one table [[body]] or more)"
        )
    scripts = [word for word in SCRIPTS if word not in dimension.SCRIPTS]
    if script not in scripts:
        raise BadInput(f"script: {unknown(script, scripts)}")
    set_here = {key: value for key, value in given.items() if key not in ("script", "title")}
    values = parameters.defaults(script) | parameters.check(set_here, script)
    _refuse_nu("nu", values["nu"], values["law"], values)
    return Scene(name, title, script, {"title": title, "script": script} | values, folder, values)


def _of_tables(given: dict, folder: Path, name: str) -> Scene:
    """That of bodies in tables."""
    of = dimension.of(given)
    given = conditions.inlined(given, folder, of)
    tables = models.read(given, of)
    if not tables.bodies:
        raise BadInput("body: is missing (accepted: one table [[body]] or more)")
    top = tables.top
    if top.script not in (None, of.script):
        raise BadInput(
            f"script: '{top.given('script')}' is not that of [[body]] tables in dimension = '{of.name}' (accepted: {of.script})"
        )
    all_bodies, all_obstacles, contact, values = gathered(
        [
            lambda: bodies.read(tables.bodies, top, folder, of),
            lambda: obstacles.read(tables.obstacles, of, top.end_time or 0.0, folder),
            lambda: _parameters(tables.contact, CONTACT, of),
            lambda: _parameters(top, RUN, of),
        ]
    )
    for key in SIZES:
        if getattr(top, key) and all(body.mesh for body in all_bodies):
            raise BadInput(
                f"{key}: '{brief(given[key])}' changes nothing, as the mesh of every body is "
                f"that of its file, with its own element sizes (accepted: 0)"
            )
    centres = np.array([body.placed.area_centre for body in all_bodies])
    half = float(
        np.ptp(centres, axis=0).max() / 2 + 2 * max(body.placed.reach for body in all_bodies)
    )
    all_obstacles = obstacles.settled(all_obstacles, centres.mean(axis=0), half)
    index = _names(all_bodies, all_obstacles)
    all_bodies = bodies.stiffened(all_bodies, contact["penalty"], "contact.penalty")
    pairs = _own_of_obstacles(tables.obstacles, len(all_bodies))
    for both, pair in _exceptions(tables.contact.pair or [], index).items():
        pairs[both] = (
            replace(pair, values=pairs[both].values | pair.values) if both in pairs else pair
        )
    for k in _touching_themselves(
        tables.contact,
        contact.get("pairing", "closest-point"),
        all_bodies,
        of,
        len(all_bodies) == 1 and not all_obstacles,
    ):
        pairs.setdefault((k, k), Pair(k, k, {}, "contact"))
    found = Scene(
        name,
        top.title or name,
        of.script,
        given,
        folder,
        values,
        of,
        all_bodies,
        all_obstacles,
        contact,
        [pairs[both] for both in sorted(pairs)],
    )
    _apart(found)
    _refuse_integrator(found)
    for k, body in enumerate(all_bodies, 1):
        _refuse_nu(f"body.{k}.nu" if len(all_bodies) > 1 else "nu", body.nu, body.law, values)
    mirror.copies(found)
    return found


def _refuse_nu(entry: str, nu: float, law: str, values: Mapping[str, Value]) -> None:
    """BadInput where a body can be neither compressible nor incompressible, J = 1."""
    if nu == 0.5 or law == "incompressible":
        volume = values.get("volume", "auto")
        keeps_volume = values["degree"] == 2 and volume != "plain"
        conserves = values["integrator"] == "energy-momentum"
        if not (nu == 0.5 and law != "svk" and keeps_volume and conserves):
            raise BadInput(
                f"{entry}: {nu:g} (J = 1) of law = {law}, degree = {values['degree']}, "
                f"volume = {volume}, integrator = {values['integrator']} (accepted: up to 0.4999, or 0.5 "
                "with any law but svk, degree = 2, volume = auto or projected, integrator = energy-momentum)"
            )
    elif nu > 0.4999:
        raise BadInput(f"{entry}: {nu:g} is out of range (accepted: 0 to 0.4999, or 0.5: J = 1)")


def _refuse_integrator(found: Scene) -> None:
    """BadInput where supports and loads would not do exact work."""
    accepted, asked = ("auto", "energy-momentum", "midpoint"), found.values["integrator"]
    if asked not in accepted and any(body.supports or body.loads for body in found.bodies):
        raise BadInput(
            f"integrator: '{asked}' has no supports and loads (accepted with them: {'|'.join(accepted)})"
        )


def _parameters(table: models.Entries, keys: tuple[str, ...], of: Dimension) -> dict[str, Value]:
    """Those of the parameters that the script takes; BadInput for one that it does not."""
    gathered([partial(parameters.taken, key, of.script) for key in keys if key in table])
    rules = {
        key: parameters.PARAMETERS[key]
        for key in keys
        if of.script in parameters.PARAMETERS[key].scripts
    }
    return {
        key: getattr(table, key) if key in table else rule.default for key, rule in rules.items()
    }


def _names(all_bodies: list[Body], all_obstacles: list[Obstacle]) -> dict[str, int]:
    """Names of bodies and obstacles, each once, and what stands for them in a Pair."""
    index, where = {}, {}
    for path, number, one in [
        *((f"body.{k + 1}", k, one) for k, one in enumerate(all_bodies)),
        *((f"obstacle.{k + 1}", -1 - k, one) for k, one in enumerate(all_obstacles)),
    ]:
        if one.name in index:
            raise BadInput(
                f"{path}.name: '{brief(one.name)}' is the name of {where[one.name]} too (accepted: each name once)"
            )
        index[one.name], where[one.name] = number, path
    return index


# ---- contact


def _own_of_obstacles(
    tables: list[models.Obstacle], bodies_count: int
) -> dict[tuple[int, int], Pair]:
    """What [[obstacle]] tables say of contact, as exceptions against every body."""
    pairs = {}
    for k, table in enumerate(tables):
        own = {key: getattr(table, key) for key in OWN if key in table}
        pairs |= {
            (body, -1 - k): Pair(body, -1 - k, own, table.entry)
            for body in range(bodies_count)
            if own
        }
    return pairs


def _exceptions(tables: list[models.Pair], index: dict[str, int]) -> dict[tuple[int, int], Pair]:
    """The tables [[contact.pair]]."""
    pairs = {}
    for table in tables:
        both = _partners(table.entry, table.bodies, index)
        if both in pairs:
            raise BadInput(
                f"{table.at('bodies')}: '{table.given('bodies')}' has a table already (accepted: one a pair)"
            )
        pairs[both] = Pair(
            *both, {key: getattr(table, key) for key in OWN if key in table}, table.entry
        )
    return pairs


def _touching_themselves(
    contact: models.Contact, pairing: str, all_bodies: list[Body], of: Dimension, alone: bool
) -> list[int]:
    """The bodies that self_contact makes their own partners."""
    asked = contact.self_contact or "auto"
    if asked == "on" and pairing != "closest-point":
        raise BadInput(
            f"{contact.at('self_contact')}: on, but pairing = '{pairing}' is between bodies "
            f"(accepted: auto|off, or pairing = 'closest-point')"
        )
    if alone:  # what nothing else can touch
        return [0]
    if asked == "off" or pairing != "closest-point":
        return []
    flat = of is not SOLID
    return [
        k
        for k, body in enumerate(all_bodies)
        if asked == "on" or (flat and body.outline.folding(of is AXISYMMETRIC) < FOLDING)
    ]


def _partners(path: str, given, index: dict[str, int]) -> tuple[int, int]:
    """The two of a pair, the body or the first body first."""
    accepted = f"accepted: two names, one at least of a body, of {', '.join(index)}"
    if (
        not isinstance(given, list)
        or len(given) != 2
        or not all(isinstance(name, str) for name in given)
    ):
        raise BadInput(
            f"{path}.bodies: '{'' if given is None else brief(given)}' is no pair ({accepted})"
        )
    for name in given:
        if name not in index:
            raise BadInput(f"{path}.bodies: '{brief(name)}' is not in the scene ({accepted})")
    first, second = sorted((index[name] for name in given), key=lambda k: (k < 0, abs(k)))
    if first < 0:
        raise BadInput(
            f"{path}.bodies: '{brief(given)}' cannot come into contact with each other ({accepted})"
        )
    return first, second


# ---- places


def _apart(found: Scene) -> None:
    """BadInput where a body overlaps another one or an obstacle at the start."""
    placed = [body.placed for body in found.bodies]
    centres, reaches = (
        np.array([one.area_centre for one in placed]),
        np.array([one.reach for one in placed]),
    )
    for i, j in sorted(cKDTree(centres).query_pairs(2 * reaches.max())):
        if np.linalg.norm(centres[i] - centres[j]) <= reaches[i] + reaches[j]:
            body, other = found.bodies[i], found.bodies[j]
            _refuse_overlap(
                f"body.{i + 1}",
                body,
                f"body.{j + 1}",
                other.name,
                gap_between(placed[i], placed[j]),
                _units(found, i + 1, body) or _units(found, j + 1, other),
            )
    for (i, body), (j, other) in itertools.product(
        enumerate(found.bodies, 1), enumerate(found.obstacles, 1)
    ):
        _refuse_overlap(
            f"body.{i}",
            body,
            f"obstacle.{j}",
            other.name,
            gap_to_obstacle(body.placed, other),
            _units(found, i, body),
        )


def _units(found: Scene, i: int, body: Body) -> str:
    """A hint where body i comes from a file and is very large in m."""
    width = 2 * body.outline.reach
    return (
        f"; its file is {width:.3g} m wide: other units? body.{i}.scale = 0.001 takes them as mm"
        if width > WIDE and "file" in found.given["body"][i - 1]
        else ""
    )


def _refuse_overlap(
    path: str, body: Body, other_path: str, other: str, gap: float, hint: str = ""
) -> None:
    if gap < -TOUCHING * body.outline.half_thickness:
        raise BadInput(
            f"{path}.position: '{body.name}' overlaps '{other}' ({other_path}) by {-gap:.3g} m at the start "
            f"(accepted: apart or touching{'' if other_path.startswith('body') else ', on the side that its normal points to'})"
            f"{hint}"
        )


def gap_between(first: Shape, second: Shape) -> float:
    """The distance of two bodies, negative where they overlap: by how far a point of one is
    inside the other.
    """
    return min(second.least(first.gap), first.least(second.gap))


def gap_to_obstacle(outline: Shape, obstacle: Obstacle) -> float:
    """The distance of a body from an obstacle, negative where they overlap."""
    centre, least = outline.area_centre, obstacle.gap_from(outline)
    nearest = centre - obstacle.gap(centre[None]) * normal_of(obstacle, centre)
    is_of_it = (
        obstacle.gap(nearest[None])[0] < 1e-4 * outline.half_thickness
    )  # not where the distance has no gradient
    return float(
        min(least, outline.gap(nearest[None])[0]) if is_of_it else least
    )  # the former: an obstacle inside the body
