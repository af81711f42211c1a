"""A scene as a Python object in SI units. It has the entries of a TOML scene file under the same
names.

    rubber = NeoHookean(young=7e6, nu=0.45, density=1722)
    Scene(bodies=[Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))], obstacles=[Plane()])

A Scene is checked as a whole when it is made and when one of its entries is set. Errors are raised
as one BadInput with a line for each error: the dotted name of the entry (body.1.young, counted from
1), its value and the accepted values. The program chooses the value of an entry that is None.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, model_validator

from . import scene as files
from .failure import BadInput, brief
from .geometry import place_functions
from .geometry.time_functions import tabulated
from .input import models
from .input.bodies import FIELDS, Body
from .input.contact import Contact
from .input.dimension import AXISYMMETRIC, DIMENSIONS, PLANE_STRAIN, SOLID, Dimension
from .input.entries import several
from .input.obstacles import Obstacle
from .input.parameter import plain
from .input.toml_text import to_toml
from .scenes import scene as reading
from .scenes.entries import files_renamed

__all__ = ["Scene"]


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

    @model_validator(mode="after")
    def _is_accepted(self) -> Self:
        try:
            self.checked()
        except BadInput as error:
            if self.dimension or ".shape:" not in str(error):
                raise
            raise BadInput(
                f"{error}; dimension = '{self.kind.name}' follows from the shapes, "
                "and from positions with three components"
            ) from None
        return self

    @property
    def kind(self) -> Dimension:
        """The dimension of the scene. If the entry `dimension` is not set, it follows from the
        bodies' shapes and the number of components of their positions.
        """
        if self.dimension:
            return DIMENSIONS[self.dimension]
        points = [(getattr(body, "points", None) or [None])[0] for body in self.bodies]
        for place in (*points, *(body.position for body in self.bodies)):
            if isinstance(place, list) and len(place) == 3:
                return SOLID
        plane = all(PLANE_STRAIN in body.dimensions for body in self.bodies)
        return PLANE_STRAIN if plane else AXISYMMETRIC

    def table(self) -> dict[str, Any]:
        """Returns the scene as the tables of its TOML file."""
        tables = super().table()
        for name in ("bodies", "obstacles", "contact", "folder"):
            tables.pop(name, None)
        tables["dimension"] = self.kind.name
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
        letters = dict.fromkeys(("motion", "traction"), "xyz"[: self.kind.axes])
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
        for k, body in enumerate(
            reading.read(tables | {"body": others}, self.folder, "scene").bodies
        ):
            for name in [name for other, name in places if other == k]:
                low, high = body.box()
                entry, table = f"body.{k + 1}.{name}", tables["body"][k]
                table[name] = place_functions.tabulated(entry, table[name], low, high)

    def checked(self, name: str = "scene") -> reading.Scene:
        """Returns the scene as the program reads it. Raises BadInput if the program does not accept
        it.
        """
        scene = reading.read(self.table(), self.folder, name)
        reading.refuse_rest(scene)
        return scene

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

    @classmethod
    def load(cls, path: str | Path) -> Scene:
        """Reads the scene of a TOML file, or a built-in scene of bodies (disc-beam, two-discs ...).
        Raises BadInput if it cannot be read or has no table [[body]].
        """
        name = str(path)
        path = files.SCENES / f"{name}.toml" if name in files.built_in() else Path(name)
        _, content = files.read_toml(path, files.absent(name, "scene", files.built_in()))
        if "body" not in content:
            raise BadInput(
                f"{name}: has no [[body]] (accepted: a scene of bodies; run('{name}') runs this one)"
            )
        try:
            return cls.from_tables(content, path.parent)
        except BadInput as error:
            raise error.within(str(path)) from None

    @classmethod
    def from_tables(cls, content: dict[str, Any], folder: Path = Path(".")) -> Scene:
        """Makes a scene from the tables of a TOML file. Raises BadInput."""
        reading.read(content, folder, "scene")  # reports all errors by the names of the file
        top = {
            name: value
            for name, value in content.items()
            if name not in ("body", "obstacle", "contact")
        }
        tables = {"bodies": content["body"], "obstacles": content.get("obstacle", [])}
        return cls(folder=folder, contact=Contact(**content.get("contact", {})), **tables, **top)

    def set(self, values: Mapping[str, Any] | None = None, /, **entries: Any) -> Scene:
        """Returns a copy of the scene with entries set by their dotted names:
        scene.set({"body.1.velocity.2": -4}), or scene.set(accuracy=0.01).

        An entry that is set to None is removed; the program then chooses its value. Raises
        BadInput.
        """
        overrides = plain(dict(values or {}) | entries)
        return type(self).from_tables(self.checked().override(overrides).content, self.folder)

    def _rows(self) -> list[tuple[str, str]]:
        """The tables of the scene, each with its entries in one line of text."""
        table = self.table()
        parts: dict[str, dict[str, Any]] = {}
        for key in ("body", "obstacle"):
            parts |= {f"{key} {k}": entries for k, entries in enumerate(table.pop(key, []), 1)}
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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.table() == other.table()
