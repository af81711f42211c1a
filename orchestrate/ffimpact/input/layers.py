"""Layers of a body: parts inside it with a material of their own, bonded to the rest
(docs/how-to/scenes.md). Units are SI.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from .conditions import Part
from .materials import MadeOf
from .rules import ALIAS, Name, Region, Text, number

__all__ = ["Layer"]

PLACES = ("radius", "where", "group")  # entries, one of which says where a layer is
THINNEST = 1e-6  # smallest extent of a layer [m]


class Layer(MadeOf):
    """A part of a body with a material of its own: all inside a radius, a region of the body, or a
    group of its file.

    It takes the entries of the material that it does not set from its body.
    """

    name: Annotated[str | None, Name(), "of its own"] = None
    radius: Annotated[
        float | None,
        number(),
        "all inside this radius about the centre of a round body, or about its axis; smaller ones win",
    ] = None
    where: Annotated[
        dict[str, Any] | None,
        Region(),
        "a region along the axes of the body, from its centre; the later one wins",
    ] = None
    group: Annotated[
        str | None,
        Text("a name in quotes"),
        "a physical group of elements of its mesh file, or a solid of its STEP file, by name; before"
        " radius and where",
    ] = None

    def refusals(self) -> Iterator[tuple[str, str]]:
        by = [name for name in PLACES if getattr(self, name) is not None]
        accepted = f"one of {', '.join(PLACES)}"
        if len(by) > 1:
            yield by[1], f": stands beside {by[0]} (accepted: {accepted})"
        elif not by:
            yield PLACES[0], f": is missing (accepted: {accepted})"
        elif self._thinnest < THINNEST:
            name = "radius" if self.where is None else "where"
            yield name, f": is {self._thinnest:.3g} m thin (accepted: from {THINNEST:g} m)"

    @property
    def _thinnest(self) -> float:
        """The smallest extent [m] of its region, the radius of a round one, infinite for a half-space
        and a group.
        """
        if self.group is not None:
            return np.inf
        if self.radius is not None:
            return self.radius
        part = self.part
        if part.kind == "box":
            return float((part.numbers[1] - part.numbers[0]).min())
        return float(part.numbers[1]) if part.kind == "ball" else np.inf

    @cached_property
    def part(self) -> Part:
        """The region `where`, about the centre of the body."""
        kind, *numbers = (self.where or {}).values()
        region = tuple(np.array(vector) for vector in numbers)
        return Part(self.at("where"), "", ALIAS.get(kind, kind), region)
