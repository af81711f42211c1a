"""A scene as named arrays, which FreeFEM takes (edp/program/input/scene.idp). Numbers are in SI units
and radians; vectors have three components.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..freefem.arrays import Entries, joined, table
from ..input.contact import CONTACT
from ..input.dimension import AXISYMMETRIC, SOLID
from ..input.models import RUN
from ..input.parameters import PARAMETERS, Value
from ..mesh.mesh import AXIS, WIDEST, Mesh
from ..mesh.plane_file import on_circle
from ..mesh.solid_mesh import DEPTH, SolidMesh
from .mirror import copies

if TYPE_CHECKING:
    from ..scene import Scene

__all__ = [
    "SHAPES",
    "Arc",
    "mesh_arrays",
    "padded",
    "parameter_arrays",
    "scene_arrays",
]

# The kinds of obstacles, by their numbers in edp/program/contact/kinds.idp.
SHAPES = ("plane", "circle", "bowl", "polyline", "implicit", "surface")
STEEPEST = math.radians(30)  # largest angle between a face and the surface at its middle
ON = 1e-9  # distance from a sphere or cylinder that counts as on it, over its radius


@dataclass(frozen=True)
class Arc:
    """A circle or sphere (axis 0), or a cylinder, on which boundary elements of a body lie: centre
    or point on the axis (3,) [m], unit vector of the axis (3,), radius [m].
    """

    body: int
    centre: np.ndarray
    axis: np.ndarray
    radius: float

    def onto(self, points: np.ndarray) -> np.ndarray:
        """The nearest points of the circle, sphere or cylinder to points (n, axes)."""
        axes = points.shape[1]
        arms = points - self.centre[:axes]
        arms = arms - np.outer(arms @ self.axis[:axes], self.axis[:axes])
        length = np.linalg.norm(arms, axis=1, keepdims=True)
        onto: np.ndarray = points + arms * (self.radius / length - 1)
        return onto

    def has_faces(self, corners: np.ndarray) -> np.ndarray:
        """Whether faces with these corners (n, 3, 3) lie on the sphere or cylinder: their corners
        do, and their normals are within STEEPEST of that of the surface at their middles. A flat
        that is cut into the surface has corners on its rim, too.
        """
        arms = corners - self.centre
        arms = arms - (arms @ self.axis)[..., None] * self.axis
        off = abs(np.linalg.norm(arms, axis=2) - self.radius).max(axis=1)
        middle = arms.sum(axis=1)
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        cosine = abs((normal * middle).sum(axis=1))
        sizes = np.linalg.norm(normal, axis=1) * np.linalg.norm(middle, axis=1)
        on: np.ndarray = (off <= ON * self.radius) & (cosine > math.cos(STEEPEST) * sizes)
        return on


def padded(vector: Sequence[float] | np.ndarray) -> np.ndarray:
    """A vector in the plane or in space, with three components."""
    return np.array([*vector, 0.0, 0.0][:3], dtype=float)


def scene_arrays(scene: Scene, centres: np.ndarray, pairs: list[dict[str, Value]]) -> Entries:
    """Returns bodies, obstacles, pairs and rigid bodies. `centres` (bodies, axes) [m] are those in
    the mesh; `pairs` has the contact parameters of scene.pairs.
    """
    replaces = scene.contact.friction is not None  # pairs with coefficients an expression
    of_pairs = [
        {
            "first": pair.first,
            "second": pair.second,
            "values": [
                *map(float, own.values()),
                float(replaces and "friction_static" in pair.own),
            ],
        }
        for pair, own in zip(scene.pairs, pairs)
    ]
    rigid = [
        {"body": k, "mass": float(body.mass or 0.0), "moments": np.array(body.moments, dtype=float)}
        for k, body in enumerate(scene.bodies)
        if body.rigid
    ]
    return (
        {"script": scene.kind.script, "friction": np.array(scene.contact.friction_code)}
        | {"symmetry_factor": 2 if scene.kind is AXISYMMETRIC else copies(scene)}
        | table("bodies", _bodies(scene, centres))
        | _materials(scene)
        | _obstacles(scene)
        | table("pairs", of_pairs)
        | table("rigid", rigid)
    )


def parameter_arrays(values: Mapping[str, Value]) -> Entries:
    """Returns the parameters of a run: `values`, and the defaults of those that it has not."""
    chosen = {name: values.get(name, PARAMETERS[name].default) for name in (*CONTACT, *RUN)}
    return {
        name: float(value) if PARAMETERS[name].kind == "real" else value
        for name, value in chosen.items()
    }


def _materials(scene: Scene) -> Entries:
    """The materials of all bodies, that of a body outside its layers before those of its layers."""
    bodies = [(k, material) for k, body in enumerate(scene.bodies) for material in body.materials]
    rows = [
        {
            "body": k,
            "law": material.law,
            "young": float(material.young),
            "nu": float(material.nu),
            "density": float(material.density),
            "viscosity": (material.damping.viscosity, material.damping.bulk_viscosity),
        }
        for k, material in bodies
    ]
    # the numbers of each Maxwell branch, [Pa] and [s], behind each other
    lists: dict[str, list[Sequence[Any]]] = {
        "law_numbers": [material.numbers for _, material in bodies],
        "branches": [material.damping.branches for _, material in bodies],
        "bulk_branches": [material.damping.bulk_branches for _, material in bodies],
    }
    entries = table("materials", rows)
    for name, of_materials in lists.items():
        flat = [np.array(numbers, dtype=float).ravel() for numbers in of_materials]
        entries |= joined(f"materials.{name}", flat)
    return entries


def _bodies(scene: Scene, centres: np.ndarray) -> list[Entries]:
    solid = scene.kind is SOLID
    return [
        {
            "name": body.own_name,
            "young": float(min(material.young for material in body.materials)),
            "nu": float(max(material.nu for material in body.materials)),
            "density": float(body.made_of.density),
            "centre": padded(centre),
            "shift": padded(body.start_position - centre),
            "turn": 0.0 if solid else float(body.start_angle),
            "velocity": padded(body.start_velocity),
            "spin": padded(body.start_spin) if solid else np.array([0.0, 0.0, body.start_spin]),
            "thickness": 2 * float(body.outline.half_thickness),
            "of_file": 1 if body.file_mesh else 2 if "file" in body else 0,
        }
        for body, centre in zip(scene.bodies, centres)
    ]


def _obstacles(scene: Scene) -> Entries:
    rows = [
        {
            "name": obstacle.own_name,
            "kind": SHAPES.index(obstacle.kernel),
            "velocity": padded(obstacle.start_velocity),
        }
        for obstacle in scene.obstacles
    ]
    numbers = [np.array(obstacle.numbers, dtype=float) for obstacle in scene.obstacles]
    return table("obstacles", rows) | joined("obstacles.numbers", numbers)


def mesh_arrays(
    together: Mesh | SolidMesh,
    regions: np.ndarray,
    materials: np.ndarray,
    arcs: Sequence[Arc],
    of_files: Sequence[int],
) -> Entries:
    """Returns the mesh of all bodies, the arcs, and the arc of each boundary element, -1 if it has
    none. Region k is body k; `materials` (t,) are the numbers of the materials of cells. `of_files`
    are the numbers of bodies whose mesh is from a file.
    """
    cells = together.cells if isinstance(together, SolidMesh) else together.triangles
    of_point = np.zeros(len(together.points), dtype=int)
    of_point[cells] = regions[:, None]
    body_of = of_point[together.sides[:, 0]]
    arc_of = np.full(len(together.sides), -1)
    for k, arc in enumerate(arcs):
        mine = np.flatnonzero(body_of == arc.body)
        corners = together.points[together.sides[mine]]
        if isinstance(together, SolidMesh):
            on = arc.has_faces(corners) & (together.labels[mine] != DEPTH)
        else:
            on = on_circle(
                corners, arc.centre[:2], arc.radius, WIDEST if arc.body in of_files else math.pi
            )
        # a side across a small circle has its ends on it
        arc_of[mine[on & (together.labels[mine] != AXIS)]] = k
    return {
        "mesh.points": together.points,
        "mesh.cells": cells,
        "mesh.regions": regions,
        "mesh.materials": materials,
        "mesh.sides": together.sides,
        "mesh.labels": together.labels,
        "mesh.arc_of": arc_of,
    } | table(
        "arcs", [{"centre": arc.centre, "axis": arc.axis, "radius": arc.radius} for arc in arcs]
    )
