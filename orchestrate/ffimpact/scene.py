"""A scene in SI units. It has the entries of a TOML scene file under the same names.

    rubber = NeoHookean(young=7e6, nu=0.45, density=1722)
    Scene(bodies=[Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))], obstacles=[Plane()])

A Scene is checked as a whole when it is made and when one of its entries is set. Errors are raised
as one BadInput with a line for each error: the dotted name of the entry (body.1.young, counted from
1), its value and the accepted values. The program chooses the value of an entry that is None.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from .failure import BadInput, brief, gathered
from .geometry import place_functions
from .geometry.time_functions import tabulated
from .input import dimension, models, parameters
from .input.bodies import FIELDS, SIZES, Body
from .input.contact import CONTACT, Contact, Pair
from .input.dimension import AXISYMMETRIC, DIMENSIONS, PLANE_STRAIN, SOLID, Dimension
from .input.entries import Entries, several
from .input.materials import MATERIAL
from .input.models import RUN, listed
from .input.obstacles import Obstacle
from .input.parameter import plain
from .input.parameters import PARAMETERS, Table, Value
from .input.toml_text import to_toml
from .mesh.solid_file import takes_in_others
from .output import former
from .output.columns import Features, recorded
from .scenes import mirror, needs, overlap, pairs
from .scenes.entries import files_renamed, reset_dependents, set_entry, toml_value
from .scenes.files import SCENES, absent, built_in, read_toml

__all__ = ["RUN", "SCENES", "Scene", "absent", "built_in", "load", "read", "read_toml"]

# Entries, beside those of contact, on which the motion up to the first contacts does not depend.
UNMOVED = (*SIZES, "mesh_stretch", "accuracy", "dt", "fields", "modes")
# Largest slip velocity [m/s] and coefficient of an expression of friction; the modulus [Pa] that gives
# the pressures of rigid bodies alone.
FASTEST, LARGEST_MU, LIKE_STEEL = 100.0, 1e3, 2e11
LONG = 100  # number of items from which on a list is a table


def _of_tables(key: str) -> BeforeValidator:
    """Returns a validator that accepts bodies or obstacles as objects or as tables of a TOML
    file.
    """

    def objects(value: Any) -> Any:
        listed = several(value)
        if not isinstance(listed, list):
            return value
        made = [
            models.of_table(f"{key}.{k}", item, key) if isinstance(item, dict) else item
            for k, item in enumerate(listed, 1)
        ]
        return made

    return BeforeValidator(objects)


class Scene(models.Top):
    """Bodies, obstacles, contact and the settings of the run. The entries have the names that they
    have in a TOML file.
    """

    nested = {"contact": Contact}
    bodies: Annotated[list[Body], _of_tables("body")]
    obstacles: Annotated[list[Obstacle], _of_tables("obstacle")] = []
    contact: Contact = Contact()
    folder: Path = Field(
        Path("."), exclude=True, repr=False, description="from which files of the scene are sought"
    )
    _name: str = PrivateAttr("scene")
    _content: Table = PrivateAttr(default_factory=dict)
    _released: tuple[str, ...] = PrivateAttr(())
    _ready: Scene | None = PrivateAttr(None)
    _memory: dict[str, Any] = PrivateAttr(default_factory=dict)

    # ---- from files, tables and Python

    @classmethod
    def load(cls, path: str | Path) -> Scene:
        """Reads a built-in scene (disc-beam, two-discs ...) or the scene of a TOML file, such as the
        scene.toml of a result folder. Raises BadInput if it cannot be read.
        """
        name = str(path)
        path = SCENES / f"{name}.toml" if name in built_in() else Path(name)
        _, content = read_toml(path, absent(name, "scene", built_in()))
        try:
            return cls.read(content, path.parent, path.stem)
        except BadInput as error:
            raise error.within(str(path)) if path.parent != SCENES else error from None

    @classmethod
    def read(
        cls,
        content: Table,
        folder: Path = Path(),
        name: str = "scene",
        earlier: Scene | None = None,
    ) -> Scene:
        """Returns the scene of the tables of a file. Paths of other files are relative to `folder`.
        Bodies with the shapes of those of the scene `earlier` take them over. Raises BadInput for
        whatever is wrong in the tables.
        """
        if not content:
            raise BadInput(
                "says nothing (accepted: a scene, as the built-in ones in orchestrate/ffimpact/scenes)"
            )
        if str(content.get("script")) in former.SCRIPTS:
            raise BadInput(
                f"script: '{content['script']}' is no kind of scene any more (accepted: tables [[body]], "
                "[[obstacle]] and [contact], as in the built-in scene of its name)"
            )
        folder = folder.absolute()  # finds files from any working folder
        kind = dimension.of_scene(content)
        tables = models.read(content, kind, folder)
        own: Table = {
            "bodies": tables.bodies,
            "obstacles": tables.obstacles,
            "contact": tables.contact,
        }
        scene = cls.model_construct(**dict(tables.top.entries()), **own, folder=folder)
        vars(scene)["kind"] = kind
        scene._name, scene._content = name, content
        for body, other in zip(scene.bodies, earlier.bodies if earlier else ()):
            body.take_shape_of(other)
        scene._check()
        return scene

    @model_validator(mode="after")
    def _is_accepted(self) -> Self:
        try:
            self.ready()
        except BadInput as error:
            if self.dimension or ".shape:" not in str(error):
                raise
            raise BadInput(
                f"{error}; dimension = '{self.kind.name}' follows from the shapes, "
                "and from positions with three components"
            ) from None
        return self

    def ready(self, name: str = "scene") -> Scene:
        """Returns the scene as the program reads it, after all entries that were set. Raises
        BadInput if the program does not accept it.
        """
        table = self.table()
        if self._ready is None or self._ready._content != table or self._ready.name != name:
            ready = self.read(table, self.folder, name)
            ready.refuse_rest()
            self._ready = ready
        return self._ready

    def set(self, values: Mapping[str, Any] | None = None, /, **entries: Any) -> Scene:
        """Returns a copy of the scene with entries set by their dotted names:
        scene.set({"body.1.velocity.2": -4}), or scene.set(accuracy=0.01).

        An entry that is set to None is removed; the program then chooses its value, as it does for
        entries that belong to those that are set: a penalty to `young` (`released` names them).
        scene.set({"body.1.material": ff.NeoHookean(...)}) changes a material. Raises BadInput.
        """
        changed = self.ready().override(plain(dict(values or {}) | entries))
        changed.refuse_rest()
        return changed

    def override(self, entries: dict[str, Value]) -> Scene:
        """Returns the scene with `entries` set by dotted names (text or values). Entries that
        depend on them are reset to automatic (reset_dependents()). Raises BadInput for whatever is wrong
        then.
        """
        if not entries:
            return self
        named = self._by_full_name(self.check(entries))
        changed = self._with(named)
        messages = reset_dependents(changed, list(named))
        scene = self.read(changed, self.folder, self.name, self)
        scene._released = self.released + messages
        entries_alike = [
            name.startswith("contact.") or name.rpartition(".")[2] in UNMOVED for name in named
        ]
        if all(entries_alike):
            scene._memory = self._memory
        return scene

    def _with(self, named: dict[str, Value]) -> Table:
        """Returns the tables with entries set by their full names."""
        changed = self.content
        for name, value in named.items():
            changed = set_entry(changed, name, value)
        return changed

    def check(self, entries: dict[str, Value]) -> dict[str, Value]:
        """Returns `entries`, by dotted names, with converted values. Raises BadInput if the
        scene has no such entry, or if the entry would change nothing.
        """
        converted = {name: toml_value(value) for name, value in entries.items()}
        changed = self._with(self._by_full_name(converted))
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
        named = self._by_full_name(entries)
        changed = self._with(named)
        reset_dependents(changed, list(named))
        return models.read(changed, self.kind)

    def _by_full_name(self, entries: dict[str, Value]) -> dict[str, Value]:
        """Returns `entries` by their dotted names. Of two that are the same entry the later holds."""
        return {
            models.full_name(self.content, name, self.kind): value
            for name, value in entries.items()
        }

    def __setattr__(self, name: str, value: Any) -> None:
        """Sets an entry if the whole scene is accepted with it. Raises BadInput."""
        if not name.startswith("_"):
            made = type(self)(**(dict(self.entries()) | {name: value}))
            self.forget_derived()
            vars(self)[name] = getattr(made, name)
        else:
            super().__setattr__(name, value)

    # ---- what the program reads

    @property
    def name(self) -> str:
        """The name of its file, or of the folder of its results."""
        return self._name

    @property
    def content(self) -> Table:
        """The tables that it was read from."""
        return self._content

    @property
    def released(self) -> tuple[str, ...]:
        """Messages about entries that override() reset to automatic."""
        return self._released

    @cached_property
    def kind(self) -> Dimension:
        """The dimension of the scene. If the entry `dimension` is not set, it follows from the
        bodies' shapes and the number of components of their positions.
        """
        return self._kind()

    def _kind(self) -> Dimension:
        if self.dimension:
            return DIMENSIONS[self.dimension]
        points = [(getattr(body, "points", None) or [None])[0] for body in self.bodies]
        for place in (*points, *(body.position for body in self.bodies)):
            if isinstance(place, list) and len(place) == 3:
                return SOLID
        plane = all(PLANE_STRAIN in body.dimensions for body in self.bodies)
        return PLANE_STRAIN if plane else AXISYMMETRIC

    @property
    def surfaces(self) -> list[Body | Obstacle]:
        """Bodies and obstacles."""
        return [*self.bodies, *self.obstacles]

    @cached_property
    def values(self) -> dict[str, Value]:
        """All parameters of the run. Those that are left to the program (auto, 0) stay as they are."""
        names = self.names(self.kind)
        return {name: _value(self, name) for name in RUN if name in names}

    @cached_property
    def contact_values(self) -> dict[str, Value]:
        """The parameters of [contact], likewise. With an expression of friction the coefficients are
        its value for slow slip under a hundredth of the softest modulus.
        """
        values = {name: _value(self.contact, name) for name in CONTACT}
        if self.contact.friction:
            mu = float(self.contact.friction_at(np.zeros(1), np.array([self._pressures[1]]))[0])
            values |= {"friction_static": mu, "friction_dynamic": mu}
        return values

    @property
    def _pressures(self) -> tuple[float, float, float]:
        """A small, a usual and the largest pressure [Pa] of contacts of the softest body."""
        young = min(
            (body.made_of.young for body in self.bodies if not body.rigid), default=LIKE_STEEL
        )
        return 1e-8 * young, 1e-2 * young, young

    @cached_property
    def pairs(self) -> list[Pair]:
        """The contact pairs with parameters of their own, by their indices, and those of bodies that
        may come into contact with themselves.
        """
        index = pairs.names(self.bodies, self.obstacles)
        own = pairs.own_of_obstacles(self.obstacles, len(self.bodies))
        for both, pair in pairs.exceptions(self.contact.pair or [], index).items():
            inherited = own[both].own if both in own else {}
            own[both] = Pair.between(*both, pair.entry, inherited | pair.own)
        alone = len(self.bodies) == 1 and not self.obstacles
        for k in pairs.touching_themselves(self.contact, self.bodies, self.kind, alone):
            own.setdefault((k, k), Pair.between(k, k, "contact", {}))
        return [own[both] for both in sorted(own)]

    @property
    def memory(self) -> dict[str, Any]:
        """What is known of the motion up to the first contacts (scenes/approach.py). Scenes that move
        alike, such as the levels of an error estimate, share it.
        """
        return self._memory

    def replaced(self, memory: dict[str, Any] | None = None, **derived: Any) -> Scene:
        """Returns a copy with other bodies, obstacles, values or pairs, for what follows from them."""
        copy = self.model_copy(update=derived)
        copy._memory = {} if memory is None else memory
        return copy

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
        return float((self.values | self.contact_values)[name])

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
            "penalty_damped": bool(self.contact_values["penalty_damping"]),
            "damped": self.damped,
            "metals": any(
                material.law == "metal" for body in self.bodies for material in body.materials
            ),
            "projected": self._projected,
            "solid": self.kind is SOLID,
        }
        return Features(
            words=frozenset(word for word, has in words.items() if has),
            bodies=len(self.bodies),
            supports=sum(len(body.supports) for body in self.bodies),
            loads=len(loads),
            gases=tuple(k for k, load in enumerate(loads, 1) if load.kind == "gas"),
            layers=sum(len(body.layers) for body in self.bodies),
        )

    @property
    def damped(self) -> bool:
        """Whether any body is damped."""
        return any(material.damped for body in self.bodies for material in body.materials)

    @property
    def _projected(self) -> bool:
        """Whether the volume of the elements is projected. This needs quadratic elements, a
        `volume` that is not "plain" and a material that has some to project.
        """
        return (
            self.values["volume"] != "plain"
            and self.values["degree"] == 2
            and any(material.projectable for body in self.bodies for material in body.materials)
        )

    @property
    def of_files(self) -> bool:
        """Whether a body has the mesh of a file. Other runs cannot refine this mesh."""
        return any(bool(body.file_mesh) for body in self.bodies)

    @property
    def mesh_name(self) -> str:
        """The name of the mesh file in the folder of a run."""
        return "mesh.mesh" if self.kind is SOLID else "mesh.msh"

    @property
    def sizes(self) -> dict[str, float]:
        """The largest element sizes [m] that bodies set, 0 where none does."""
        bulk = max(body.bulk_size for body in self.bodies)
        contact = max(body.contact_size for body in self.bodies)
        return dict(zip(SIZES, (bulk, contact)))

    # ---- what is refused

    def _check(self) -> None:
        """Raises BadInput for whatever is wrong in a scene whose tables were read. Resolves what
        depends on several of them.
        """
        if not self.bodies:
            raise BadInput("body: is missing (accepted: one table [[body]] or more)")
        if self.script not in (None, self.kind.script):
            raise BadInput(
                f"script: '{brief(self.script)}' is not that of [[body]] tables in "
                f"dimension = '{self.kind.name}' (accepted: {self.kind.script})"
            )
        gathered([surface.check for surface in self.surfaces])
        for name in SIZES:
            if getattr(self, name) and all(body.file_mesh for body in self.bodies):
                raise BadInput(
                    f"{name}: '{brief(self.content[name])}' changes nothing, as the mesh of every body is "
                    f"that of its file, with its own element sizes (accepted: 0)"
                )
        self._resolve()
        overlap.refuse_overlaps(self)
        needs.refuse(self)
        self._refuse_expression()
        self._refuse_friction()
        self._refuse_start()
        for k, body in enumerate(self.bodies, 1):
            prefix = f"body.{k}." if len(self.bodies) > 1 else ""
            prefixes = [prefix, *(f"{layer.entry}." for layer in body.layers)]
            for own, material in zip(prefixes, body.materials):
                for entry, text in material.refusals():
                    raise BadInput(f"{own}{entry}{text}")
        mirror.copies(self)

    def _resolve(self) -> None:
        """Gives obstacles the region of the bodies, and rigid bodies a stiffness."""
        shapes = [body.placed for body in self.bodies]
        centres = np.array([shape.area_centre for shape in shapes])
        half = np.ptp(centres, axis=0).max() / 2 + 2 * max(shape.reach for shape in shapes)
        middle, derived = centres.mean(axis=0), vars(self)
        derived["obstacles"] = [other.within(middle, float(half)) for other in self.obstacles]
        common = self.contact_values["penalty"]
        penalties = pairs.penalties_of(common, self.pairs, len(self.bodies), len(self.obstacles))
        derived["bodies"] = pairs.with_rigid_modulus(self.bodies, penalties, "contact.penalty")
        if all(body.rigid for body in self.bodies) and common == "auto":
            # no pair uses it, and no body would determine it
            self.contact_values["penalty"] = max(penalties)

    def refuse_rest(self) -> None:
        """Raises BadInput if nothing ever moves."""
        moving = [
            *(surface.start_velocity for surface in self.surfaces),
            *(body.start_spin for body in self.bodies),
            *(self.values.get(name, 0.0) for name in ("gravity", "body_force_x", "body_force_y")),
        ]
        if (
            not any(np.any(motion) for motion in moving)
            and not any(surface.driven for surface in self.surfaces)
            and not any(body.supports or body.loads or body.has_fields for body in self.bodies)
        ):
            raise BadInput(
                "velocity: 0 of every body, without spin, gravity, body force, moved support or "
                "obstacle, or load: nothing would ever move (accepted: one of them)"
            )

    def _refuse_start(self) -> None:
        """Raises BadInput if the scene starts in equilibrium and something moves at t = 0."""
        if self.values["start"] != "equilibrium":
            return
        for table in self.surfaces:
            for name in ("velocity", "spin", *FIELDS):
                value = getattr(table, name, None)
                if value is not None and (name in FIELDS or np.any(np.atleast_1d(value))):
                    raise BadInput(
                        f"{table.at(name)}: '{table.value_text(name)}' beside start = 'equilibrium', where all is at "
                        "rest (accepted: 0, or start = 'given')"
                    )

    def _refuse_expression(self) -> None:
        """Raises BadInput if an expression of friction is negative or not finite, for slip up to
        FASTEST and pressures up to the softest modulus.
        """
        if not self.contact.friction:
            return
        low, _, high = self._pressures
        slips = np.append(0.0, np.geomspace(1e-9, FASTEST, 200))
        v, p = (axis.ravel() for axis in np.meshgrid(slips, np.geomspace(low, high, 60)))
        mu = self.contact.friction_at(v, p)
        if (wrong := ~((mu >= 0) & (mu <= LARGEST_MU))).any():
            k = int(wrong.argmax())
            raise BadInput(
                f"{self.contact.at('friction')}: is {mu[k]:g} at v = {v[k]:.3g} m/s, p = {p[k]:.3g} Pa (accepted: "
                f"0 to {LARGEST_MU:g} everywhere up to {FASTEST:g} m/s and {high:.3g} Pa)"
            )

    def _refuse_friction(self) -> None:
        """Raises BadInput if a dynamic coefficient is larger than the static one, in [contact] or in a
        pair, which inherits what it does not set.
        """
        common = self.contact_values
        for path, own in [("contact", common), *((pair.entry, pair.own) for pair in self.pairs)]:
            static = own.get("friction_static", common["friction_static"])
            if common["adhesion"] and float(static) > 0:
                raise BadInput(
                    f"{path}.friction_static: {static:g} beside adhesion (accepted: 0, or without adhesion)"
                )
            inherited = "auto" if "friction_static" in own else common["friction_dynamic"]
            dynamic = own.get("friction_dynamic", inherited)
            if dynamic != "auto" and float(dynamic) > float(static):
                raise BadInput(
                    f"{path}.friction_dynamic: {dynamic:g} is larger than friction_static {static:g} "
                    "(accepted: 0 to friction_static)"
                )

    # ---- as tables

    def table(self) -> Table:
        """Returns the scene as the tables of its TOML file."""
        tables = super().table()
        for name in ("bodies", "obstacles", "contact", "folder"):
            tables.pop(name, None)
        tables["dimension"] = self._kind().name
        tables["body"] = [body.table() for body in self.bodies]
        tables["obstacle"] = [obstacle.table() for obstacle in self.obstacles]
        tables["contact"] = self.contact.table()
        self._tabulate(tables)
        return {name: value for name, value in tables.items() if value not in ({}, [])}

    def _tabulate(self, tables: dict[str, Any]) -> None:
        """Puts tables in place of Python functions of time."""
        places = [
            (f"{key}.{k}", table)
            for key in ("body", "obstacle")
            for k, table in enumerate(tables[key], 1)
        ]
        places += [
            (f"{entry}.{key}.{k}", table)
            for entry, holder in list(places)
            for key in ("support", "load")
            for k, table in enumerate(holder.get(key, []), 1)
        ]
        self._tabulate_fields(tables)
        letters = dict.fromkeys(("motion", "traction"), "xyz"[: self._kind().axes])
        for entry, table in places:
            for name, own in (letters | {"pressure": "p", "rotation": "r"}).items():
                if name in table:
                    at = f"{entry}.{name}"
                    table[name] = tabulated(at, table[name], own, self.end_time or 0.0)

    def _tabulate_fields(self, tables: dict[str, Any]) -> None:
        """Puts tables in place of Python functions of place at the start."""
        places = [(k, name) for k, body in enumerate(tables["body"]) for name in FIELDS
                  if callable(body.get(name))]  # fmt: skip
        if not places:
            return
        # without the functions, to see where the bodies are
        others = [
            {key: value for key, value in body.items() if key not in FIELDS}
            for body in tables["body"]
        ]
        placed = self.read(tables | {"body": others}, self.folder)
        for k, body in enumerate(placed.bodies):
            for name in [name for other, name in places if other == k]:
                low, high = body.box()
                entry, table = f"body.{k + 1}.{name}", tables["body"][k]
                table[name] = place_functions.tabulated(entry, table[name], low, high)

    def save(self, path: str | Path) -> Path:
        """Writes the scene to a TOML file and returns its path. Its files stay where they are; the
        paths in the scene lead there from the new file.
        """
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)

        def seen_from_there(label: str, name: str) -> str:
            return os.path.relpath(self.folder / name, path.parent)

        path.write_text(to_toml(files_renamed(self.table(), seen_from_there)), "utf-8")
        return path

    def _rows(self) -> list[tuple[str, str]]:
        """The tables of the scene, each with its entries in one line of text."""
        table = self.table()
        parts: dict[str, dict[str, Any]] = {}
        for k, body in enumerate(table.pop("body", []), 1):
            layers = body.pop("layer", [])
            parts[f"body {k}"] = body
            parts |= {f"layer {k}.{j}": layer for j, layer in enumerate(layers, 1)}
        parts |= {
            f"obstacle {k}": entries for k, entries in enumerate(table.pop("obstacle", []), 1)
        }
        parts |= {"contact": table.pop("contact", {}), "run": table}
        return [
            (name, ", ".join(f"{entry} = {brief(value)}" for entry, value in entries.items()))
            for name, entries in parts.items()
            if entries
        ]

    def __repr__(self) -> str:
        return "\n".join(["Scene", *(f"  {name:<11} {text}" for name, text in self._rows())])

    __str__ = __repr__

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{name}</td><td>{escape(text)}</td></tr>" for name, text in self._rows()
        )
        return f"<table>{rows}</table>"


def _value(table: Entries, name: str) -> Any:
    """The value of a parameter, its default if the table does not set it."""
    value = getattr(table, name)
    return PARAMETERS[name].default if value is None else value


def _shortened(value: Any) -> Any:
    """Returns a value with a sha256 in place of each list of more than LONG items."""
    if isinstance(value, dict):
        return {name: _shortened(item) for name, item in value.items()}
    if isinstance(value, list) and len(value) > LONG:
        return (
            f"{len(value)} items, sha256 {hashlib.sha256(json.dumps(value).encode()).hexdigest()}"
        )
    return [_shortened(item) for item in value] if isinstance(value, list) else value


load, read = Scene.load, Scene.read
