"""Size fields of gmsh for the curved surfaces of a geometry: fillets, holes and round ends.

A surface is resolved if its radius r is at least the element size, in the bulk or next to the
contact: it gets TURN elements per full turn. The element size of a smaller surface, such as a
fillet away from contact, follows from the volume that flat elements cut off. The mean distance of
flat elements of the size h from the surface is h^2 / (12 r), and that of one element across a
quarter turn is (1 - 2 / pi) r / 2.
"""

import math
from dataclasses import dataclass

import numpy as np

from . import mesh
from .mesh import GROWTH, Gmsh, Sizes

__all__ = ["Rounding", "TURN", "fields", "roundings"]

TURN = 20  # elements per full turn of a resolved surface
GRID = 7  # number of points along each parameter at which a surface is evaluated
FINER = 1.1  # ratio of successive element sizes in the search for the largest admissible size


@dataclass(frozen=True)
class Rounding:
    """A curved surface of a gmsh model.

    `tag` is its number, `radius` [m] the median of its radii of curvature, and `area` [m2] the area
    of the untrimmed surface.
    """

    tag: int
    radius: float
    area: float

    @property
    def fine(self) -> float:
        """The element size [m] for TURN elements per full turn."""
        return 2 * math.pi * self.radius / TURN

    @property
    def across(self) -> float:
        """The arc length [m] of a quarter turn."""
        return math.pi / 2 * self.radius

    def cut(self, size: float) -> float:
        """The volume [m3] between the surface and flat elements of a size [m]."""
        depth = max(size, self.fine) ** 2 / (12 * self.radius)
        return self.area * min(depth, (1 - 2 / math.pi) / 2 * self.radius)


def fields(gmsh: Gmsh, sizes: Sizes, sources: list[int], bulk: float, cut: float) -> list[int]:
    """Adds size fields for the curved surfaces of a body to gmsh and returns their numbers.

    `bulk` is the element size in the bulk, and `sources` are gmsh's points of the expected contact.
    `cut` is the largest share of the body's bounding box that flat elements may cut off at surfaces
    that are not resolved.
    """
    low, high = np.reshape(gmsh.model.getBoundingBox(-1, -1), (2, 3))
    # On surfaces with larger radii the size of the bulk gives more than TURN elements per turn.
    surfaces = roundings(gmsh.model, bulk * TURN / (2 * math.pi))
    small = [rounding for rounding in surfaces if rounding.radius < bulk]
    size = _size(small, bulk, cut * float(np.prod(high - low)))
    field, made = gmsh.model.mesh.field, []
    for surface in surfaces:
        own = surface.fine if surface.radius >= bulk else max(size, surface.fine)
        if surface.radius >= bulk or own < surface.across:
            made.append(_on_surface(field, surface, "Constant", VIn=own))
        if sources and sizes.contact <= surface.radius < bulk:
            # The surface is resolved where the elements around the contact are not larger than r.
            reach = sizes.slack + (surface.radius - sizes.contact) / GROWTH
            near = mesh.graded(field, "PointsList", sources, (surface.fine, bulk), flat=reach)
            made.append(_on_surface(field, surface, "Restrict", InField=near))
    return made


def roundings(model: Gmsh, largest: float) -> list[Rounding]:
    """The curved surfaces of a gmsh model with a radius below `largest` [m]."""
    surfaces = []
    for _, tag in model.getEntities(2):
        low, high = model.getParametrizationBounds(2, tag)
        u, v = (np.linspace(a, b, 2 * GRID + 1)[1::2] for a, b in zip(low, high))
        places = np.stack(np.meshgrid(u, v), axis=-1).ravel()
        bent = float(np.median(model.getCurvature(2, tag, places)))
        if bent * largest > 1:
            tangents = np.reshape(model.getDerivative(2, tag, places), (-1, 2, 3))
            stretch = np.linalg.norm(np.cross(tangents[:, 0], tangents[:, 1]), axis=1).mean()
            area = float(stretch * np.prod(np.subtract(high, low)))
            surfaces.append(Rounding(tag, 1 / bent, area))
    return surfaces


def _size(small: list[Rounding], bulk: float, cut: float) -> float:
    """The largest element size [m] with which all surfaces together cut off at most `cut` [m3].

    The size is divided by FINER until this holds or all surfaces have TURN elements per turn.
    """
    size = bulk
    while sum(surface.cut(size) for surface in small) > cut and any(
        size > surface.fine for surface in small
    ):
        size /= FINER
    return size


def _on_surface(field: Gmsh, surface: Rounding, kind: str, **values: float) -> int:
    """Adds a gmsh field of a kind for one surface and its edges; returns its number."""
    made = int(field.add(kind))
    field.setNumbers(made, "SurfacesList", [surface.tag])
    for name, value in values.items():
        field.setNumber(made, name, value)
    return made
