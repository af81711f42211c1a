"""A scene as Python objects, SI units: what a TOML file of a scene holds, entry by entry under the
same names.

    rubber = NeoHookean(young=7e6, nu=0.45, density=1722)
    Scene(bodies=[Disc(radius=0.05, material=rubber, position=(0, 0.051), velocity=(0, -8))], obstacles=[Plane()])

A Scene is checked as a whole when it is made and when an entry of it is set. Whatever is wrong is a
BadInput, a line each, with the dotted name of the entry (body.1.young, counted from 1), its value
and what is accepted. An entry that is None is left open: the program chooses it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, model_validator

from . import scene as files
from .failure import BadInput
from .input import models
from .input.dimension import AXISYMMETRIC, DIMENSIONS, PLANE_STRAIN, SOLID, Dimension
from .input.models import Body, Contact, Obstacle, Plane
from .input.parameter import plain
from .input.toml_text import to_toml
from .scenes import scene as reading

__all__ = ["Scene"]


def _of_tables(key: str) -> BeforeValidator:
    """Bodies or obstacles, each as an object or as the table of a file."""

    def objects(given: Any) -> Any:
        listed = models.several(given)
        if not isinstance(listed, list):
            return given
        made = [
            models.of_table(f"{key}.{k}", one, key) if isinstance(one, dict) else one
            for k, one in enumerate(listed, 1)
        ]
        return made

    return BeforeValidator(objects)


class Scene(models.Top):
    """Bodies, obstacles, contact, and how the run is to be made. Entries are those of a TOML
    file, under the same names.
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
        """Its dimension: as given, or what the bodies' shapes and places say."""
        if self.dimension:
            return DIMENSIONS[self.dimension]
        if any(isinstance(body.position, list) and len(body.position) == 3 for body in self.bodies):
            return SOLID
        plane = all(PLANE_STRAIN in body.dimensions for body in self.bodies)
        return PLANE_STRAIN if plane else AXISYMMETRIC

    def table(self) -> dict[str, Any]:
        """The tables of its TOML file."""
        found = super().table()
        for name in ("bodies", "obstacles", "contact", "folder"):
            found.pop(name, None)
        axes = self.kind.axes
        floor = {"point": [0.0] * axes, "normal": [0.0, 1.0, 0.0][:axes]}
        found["dimension"] = self.kind.name
        found["body"] = [body.table() for body in self.bodies]
        found["obstacle"] = [
            (floor if isinstance(one, Plane) else {}) | one.table() for one in self.obstacles
        ]
        found["contact"] = self.contact.table()
        return {name: value for name, value in found.items() if value not in ({}, [])}

    def checked(self, name: str = "scene") -> reading.Scene:
        """What the program makes of it; BadInput where it does not accept it."""
        return reading.read(self.table(), self.folder, name)

    def save(self, path: str | Path) -> Path:
        """Writes its TOML file."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(to_toml(self.table()), "utf-8")
        return path

    @classmethod
    def load(cls, path: str | Path) -> Scene:
        """The scene of a TOML file, or a built-in one that is made of bodies (disc-beam,
        two-discs ...).
        """
        name = str(path)
        path = files.SCENES / f"{name}.toml" if name in files.built_in() else Path(name)
        _, given = files.read_toml(path, files.absent(name, "scene", files.built_in()))
        if "body" not in given:
            raise BadInput(
                f"{name}: has no [[body]] (accepted: a scene of bodies; run('{name}') runs this one)"
            )
        try:
            return cls.of(given, path.parent)
        except BadInput as error:
            raise error.within(str(path)) from None

    @classmethod
    def of(cls, given: dict[str, Any], folder: Path = Path(".")) -> Scene:
        """The scene of tables as a TOML file has them."""
        reading.read(given, folder, "scene")  # all that is wrong, by the names of the file
        top = {
            name: value
            for name, value in given.items()
            if name not in ("body", "obstacle", "contact")
        }
        tables = {"bodies": given["body"], "obstacles": given.get("obstacle", [])}
        return cls(folder=folder, contact=Contact(**given.get("contact", {})), **tables, **top)

    def set(self, values: Mapping[str, Any] | None = None, /, **entries: Any) -> Scene:
        """The same scene with entries set by their dotted names:
        scene.set({"body.1.velocity.2": -4}), or scene.set(accuracy=0.01).

        An entry that is set to None is removed: the program then chooses its value.
        """
        given = plain(dict(values or {}) | entries)
        return type(self).of(self.checked().override(given).given, self.folder)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self.table() == other.table()
