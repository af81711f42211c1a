"""Meshes and scene files of bodies in three dimensions for edp/program/bodies-3d.edp.

The bodies are bricks and balls of tetrahedra, with one region for each body.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ffimpact.freefem.arrays import Entries, joined, packed, table
from ffimpact.mesh import solid_mesh
from ffimpact.mesh.mesh import AXIS, FREE, boundary
from ffimpact.mesh.solid_mesh import DEPTH, right_handed
from ffimpact.scenes.arrays import SHAPES, Arc, mesh_arrays, padded, parameter_arrays
from ffimpact.scenes.assembly import stack
from ffimpact.scenes.sizes import Impact

# A cube as six tetrahedra around its diagonal.
CORNERS = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
MATERIAL = ("neohookean", 7e6, 0.3, 1722.0)  # law, young [Pa], nu, density [kg/m3]


@dataclass
class Body:
    """A body: points (n, 3) [m], cells (m, 4) of positive volume and the centre in the mesh.

    Initial state: shift [m], velocity [m/s], spin [rad/s]. `spheres` are the spheres of its
    surface.
    """

    points: np.ndarray
    cells: np.ndarray
    centre: np.ndarray
    spheres: tuple[tuple, ...] = ()  # centre and radius
    material: tuple = MATERIAL
    shift: tuple = (0, 0, 0)
    velocity: tuple = (0, 0, 0)
    spin: tuple = (0, 0, 0)


@dataclass
class Scene:
    """A scene: bodies, obstacles (kind, numbers, velocity) and pairs (a, b, penalty,
    friction_static, friction_dynamic).

    `ball` is the ball that represents the bodies.
    """

    bodies: list[Body]
    obstacles: list[tuple] = field(default_factory=list)
    pairs: list[tuple] = field(default_factory=list)
    # Radius, young, nu, density, speed, angle, spin.
    ball: tuple = (0.05, 7e6, 0.3, 1722.0, 2.0, 90.0, 0.0)
    # Symmetry factor. 2: the half z >= 0 of every body; 4: the half x >= 0 of that.
    copies: int = 1


def grid(low, high, counts) -> tuple[np.ndarray, np.ndarray]:
    """Points and tetrahedra of a brick between two corners, with `counts` cubes along x, y, z."""
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(low, high, counts)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    number = np.arange(points[..., 0].size).reshape(points.shape[:3])
    corner = [number[a:a + counts[0], b:b + counts[1], c:c + counts[2]].ravel() for c in (0, 1) for b in (0, 1) for a in (0, 1)]
    return points.reshape(-1, 3), np.concatenate([np.stack([corner[k] for k in cell], 1) for cell in CORNERS])


def brick(low, high, counts, **start) -> Body:
    points, cells = grid(low, high, counts)
    return Body(points, right_handed(points, cells), (np.array(low, float) + high) / 2, **start)


def ball(centre, radius: float, count, copies: int = 1, turn: float = 0.0, focus: int = 0, **start) -> Body:
    """A ball of tetrahedra, made of cubes that are moved radially, with `count` cubes along a
    radius (one number, or one each for x, y, z).

    copies: 4: a quarter of the ball; 2 and 1: the half and the whole ball by mirror images
    turn: angle of a rotation about y
    focus: -1 or 1: the size of the cubes falls quadratically towards the lower or upper end of the
        y axis
    """
    points, cells = grid((0, -1, 0), (1, 1, 1), np.broadcast_to(count, 3) * (1, 2, 1))
    if focus:
        points[:, ::2] *= points[:, ::2]
        points[:, 1] = focus * (1 - (1 - focus * points[:, 1]) ** 2 / 2)
    points = points * (np.abs(points).max(1) / np.maximum(1e-12, np.linalg.norm(points, axis=1)))[:, None]
    for axis in {4: (), 2: (0,), 1: (0, 2)}[copies]:
        points, cells = mirrored(points, cells, axis)
    c, s = np.cos(turn), np.sin(turn)
    points = np.array(centre) + radius * points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return Body(points, right_handed(points, cells), np.array(centre, float), ((*centre, radius),), **start)


def mirrored(points: np.ndarray, cells: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """A mesh on one side of a plane through 0 together with its mirror image. They share the points
    on the plane."""
    off = np.flatnonzero(points[:, axis] > 1e-12)
    image = np.arange(len(points))
    image[off] = len(points) + np.arange(len(off))
    sign = np.where(np.arange(3) == axis, -1, 1)
    return np.concatenate([points, points[off] * sign]), np.concatenate([cells, image[cells]])


def write(scene: Scene, folder: Path) -> dict[str, Path | float]:
    """Writes scene.bin to `folder`. Returns the flag -scene, and the automatic values of the contact."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.bin").write_bytes(packed(entries(scene)))
    radius, young, nu, density, speed, angle, spin = scene.ball
    turn = math.radians(angle)
    like = Impact(True, radius, young, nu, density, speed * math.sin(turn), 0.005, sliding=speed * math.cos(turn), spin=spin)
    return {"scene": folder / "scene.bin", "penalty": like.penalty, "slip_velocity": like.slip_velocity, "friction_dynamic": 0.0}


def _mesh(body: Body, copies: int) -> solid_mesh.SolidMesh:
    """The mesh of a body with its boundary. The faces on x = 0 and z = 0 are planes of symmetry of
    a half or a quarter."""
    faces = boundary(body.cells)
    on_x, _, on_z = (np.abs(body.points[faces]) < 1e-12).all(axis=1).T
    return solid_mesh.SolidMesh(body.points, body.cells, faces, np.select([on_z & (copies > 1), on_x & (copies > 2)], [DEPTH, AXIS], FREE))


def entries(scene: Scene) -> Entries:
    """The entries of the scene file (edp/program/input/scene.idp)."""
    materials = [{"law": body.material[0], **dict(zip(("young", "nu", "density"), map(float, body.material[1:]))), "viscosity": [0.0] * 2, "body": b}
                 for b, body in enumerate(scene.bodies)]
    bodies = [{"name": f"body{b}", **dict(zip(("young", "nu", "density"), map(float, body.material[1:]))), "centre": padded(body.centre), "shift": padded(body.shift), "turn": 0.0, "velocity": padded(body.velocity),
               "spin": padded(body.spin), "thickness": 1e30, "of_file": 0} for b, body in enumerate(scene.bodies)]
    obstacles = [{"name": f"obstacle{k}", "kind": SHAPES.index(kind.replace("sphere", "circle")), "velocity": padded(velocity)}
                 for k, (kind, _, velocity) in enumerate(scene.obstacles, 1)]
    pairs = [{"first": a, "second": b, "values": [*map(float, values), 1.0]} for a, b, *values in scene.pairs]
    spheres = [Arc(b, padded(sphere[:3]), np.zeros(3), float(sphere[3])) for b, body in enumerate(scene.bodies) for sphere in body.spheres]
    meshes = [_mesh(body, scene.copies) for body in scene.bodies]
    return (parameter_arrays({"penalty": 1.0, "slip_velocity": 1.0, "friction_dynamic": 0.0})
            | {"script": "bodies-3d", "symmetry_factor": scene.copies, "implicit_why": "", "relaxed_step": 1e300, "friction": np.zeros(0), "front_transit": 0.0, "front_rise": 0.0}
            | table("bodies", bodies) | table("materials", materials) | joined("materials.law_numbers", [np.zeros(0)] * len(bodies))
            | joined("materials.branches", [np.zeros(0)] * len(bodies)) | joined("materials.bulk_branches", [np.zeros(0)] * len(bodies)) | table("obstacles", obstacles)
            | joined("obstacles.numbers", [np.array(numbers, float) for _, numbers, _ in scene.obstacles]) | table("pairs", pairs)
            | {name: 0 for name in ("rigid", "functions", "kinks", "drives", "supports", "loads", "start_fields")}
            | mesh_arrays(*(stacked := stack(meshes, np.zeros((len(meshes), 3)))), stacked[1], spheres, []))
