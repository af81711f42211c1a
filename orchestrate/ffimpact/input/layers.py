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
from .rules import ALIAS, Name, Region, number

__all__ = ["Layer"]

THINNEST = 1e-6  # smallest extent of a layer [m]


class Layer(MadeOf):
    """A part of a body with a material of its own: all inside a radius, or a region of the body.

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

    def refusals(self) -> Iterator[tuple[str, str]]:
        if self.radius is not None and self.where is not None:
            yield "where", ": stands beside radius (accepted: one of radius, where)"
        elif self.radius is None and self.where is None:
            yield "radius", ": is missing (accepted: one of radius, where)"
        elif self._thinnest < THINNEST:
            name = "radius" if self.where is None else "where"
            yield name, f": is {self._thinnest:.3g} m thin (accepted: from {THINNEST:g} m)"

    @property
    def _thinnest(self) -> float:
        """The smallest extent [m] of its region, the radius of a round one, infinite for a half-space."""
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
