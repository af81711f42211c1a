"""Element sizes on the curved surfaces of a geometry: its fillets, holes and round ends, as fields
of gmsh.

A surface whose radius r is at least the element size, in the bulk or next to the contact, is
resolved: it gets TURN elements a full turn. A smaller one, such as a fillet away from contact, gets
what its volume asks for: flat elements of the size h lie h^2 / (12 r) off the surface in the mean,
and one across a quarter of a turn (1 - 2 / pi) r / 2.
"""

import math
from dataclasses import dataclass

import numpy as np

from . import mesh
from .mesh import GROWTH, Sizes

__all__ = ["Rounding", "TURN", "fields", "roundings"]

TURN = 20  # elements on a full turn of a curved surface that they resolve
GRID = 7  # points along each parameter at which a surface is evaluated
FINER = 1.1  # ratio of one size that is tried to the next smaller one


@dataclass(frozen=True)
class Rounding:
    """A curved surface in a model of gmsh: its number, the median of its radii [m] and its area
    [m2], untrimmed.
    """

    tag: int
    radius: float
    area: float

    @property
    def fine(self) -> float:
        """The element size [m] of TURN elements a full turn."""
        return 2 * math.pi * self.radius / TURN

    @property
    def across(self) -> float:
        """Its length [m] over a quarter of a turn."""
        return math.pi / 2 * self.radius

    def cut(self, size: float) -> float:
        """The volume [m3] between it and flat elements of a size."""
        depth = max(size, self.fine) ** 2 / (12 * self.radius)
        return self.area * min(depth, (1 - 2 / math.pi) / 2 * self.radius)


def fields(gmsh, sizes: Sizes, sources: list[int], bulk: float, cut: float) -> list[int]:
    """Fields of gmsh with the element sizes on curved surfaces, of a body with elements of the
    size `bulk` that touches next to the points `sources`; flat elements on surfaces that are
    not resolved `cut` no more than this share of the body's box.
    """
    low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    found = roundings(gmsh.model, bulk * TURN / (2 * math.pi))  # on others the bulk's size is finer
    small = [one for one in found if one.radius < bulk]
    size = _size(small, bulk, cut * float(np.prod(high - low)))
    field, made = gmsh.model.mesh.field, []
    for one in found:
        own = one.fine if one.radius >= bulk else max(size, one.fine)
        if one.radius >= bulk or own < one.across:
            made.append(_on_surface(field, one, "Constant", VIn=own))
        if sources and sizes.contact <= one.radius < bulk:
            # as far as elements are no larger than its radius
            reach = sizes.slack + (one.radius - sizes.contact) / GROWTH
            near = mesh.graded(field, "PointsList", sources, (one.fine, bulk), flat=reach)
            made.append(_on_surface(field, one, "Restrict", InField=near))
    return made


def roundings(model, largest: float) -> list[Rounding]:
    """The curved surfaces with a radius below the largest [m]."""
    found = []
    for _, tag in model.getEntities(2):
        low, high = model.getParametrizationBounds(2, tag)
        u, v = (np.linspace(a, b, 2 * GRID + 1)[1::2] for a, b in zip(low, high))
        places = np.stack(np.meshgrid(u, v), axis=-1).ravel()
        bent = float(np.median(model.getCurvature(2, tag, places)))
        if bent * largest > 1:
            tangents = np.reshape(model.getDerivative(2, tag, places), (-1, 2, 3))
            stretch = np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1).mean()
            area = float(stretch * np.prod(np.subtract(high, low)))
            found.append(Rounding(tag, 1 / bent, area))
    return found


def _size(small: list[Rounding], bulk: float, cut: float) -> float:
    """The largest element size [m] with which all of them together cut no more than that, if
    any.
    """
    size = bulk
    while sum(one.cut(size) for one in small) > cut and any(size > one.fine for one in small):
        size /= FINER
    return size


def _on_surface(field, one: Rounding, kind: str, **values: float) -> int:
    """A field of gmsh of a kind with these values, on one surface and its edges."""
    made = field.add(kind)
    field.setNumbers(made, "SurfacesList", [one.tag])
    for name, value in values.items():
        field.setNumber(made, name, value)
    return made
