"""Meshes and scene files of bodies in three dimensions for the cases, as edp/bodies-3d.edp reads them: bricks and balls of tetrahedra, one region a body."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

CORNERS = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))    # a cell as six tetrahedra around its diagonal
MATERIAL = ("neohookean", 7e6, 0.3, 1722.0)                                                       # law, young [Pa], nu, density [kg/m3]


@dataclass
class Body:
    """points (n, 3) [m], cells (m, 4) of positive volume, centre in the mesh; its start: shift [m], velocity [m/s], spin [rad/s]; spheres of its surface."""

    points: np.ndarray
    cells: np.ndarray
    centre: np.ndarray
    spheres: tuple[tuple, ...] = ()                # centre and radius
    material: tuple = MATERIAL
    shift: tuple = (0, 0, 0)
    velocity: tuple = (0, 0, 0)
    spin: tuple = (0, 0, 0)


@dataclass
class Scene:
    """bodies; obstacles (kind, numbers, velocity); pairs (a, b, penalty, friction_static, friction_dynamic); the ball that stands for the bodies."""

    bodies: list[Body]
    obstacles: list[tuple] = field(default_factory=list)
    pairs: list[tuple] = field(default_factory=list)
    ball: tuple = (0.05, 7e6, 0.3, 1722.0, 2.0, 90.0, 0.0)       # radius, young, nu, density, speed, angle, spin
    copies: int = 1                                # 2: the half z >= 0 of every body, 4: of that the half x >= 0


def grid(low, high, counts) -> tuple[np.ndarray, np.ndarray]:
    """Points and tetrahedra of a brick from corner to corner, counts cells along x, y, z."""
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(low, high, counts)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), -1)
    number = np.arange(points[..., 0].size).reshape(points.shape[:3])
    corner = [number[a:a + counts[0], b:b + counts[1], c:c + counts[2]].ravel() for c in (0, 1) for b in (0, 1) for a in (0, 1)]
    return points.reshape(-1, 3), np.concatenate([np.stack([corner[k] for k in cell], 1) for cell in CORNERS])


def positive(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """The cells, turned where their volume is negative."""
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)
    return np.where((volume < 0)[:, None], cells[:, [1, 0, 2, 3]], cells)


def brick(low, high, counts, **start) -> Body:
    points, cells = grid(low, high, counts)
    return Body(points, positive(points, cells), (np.array(low, float) + high) / 2, **start)


def ball(centre, radius: float, count, copies: int = 1, turn: float = 0.0, focus: int = 0, **start) -> Body:
    """A quarter of a ball (copies = 4) of cubes pushed out radially, `count` along a radius (x, y, z: three numbers); the half and the whole ball are that
    with its mirror images, turned about y by an angle. focus -1 or 1: cubes get smaller, quadratically, towards the lower or upper end of the y axis."""
    points, cells = grid((0, -1, 0), (1, 1, 1), np.broadcast_to(count, 3) * (1, 2, 1))
    if focus:
        points[:, ::2] *= points[:, ::2]
        points[:, 1] = focus * (1 - (1 - focus * points[:, 1]) ** 2 / 2)
    points = points * (np.abs(points).max(1) / np.maximum(1e-12, np.linalg.norm(points, axis=1)))[:, None]
    for axis in {4: (), 2: (0,), 1: (0, 2)}[copies]:
        points, cells = mirrored(points, cells, axis)
    c, s = np.cos(turn), np.sin(turn)
    points = np.array(centre) + radius * points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    return Body(points, positive(points, cells), np.array(centre, float), ((*centre, radius),), **start)


def mirrored(points: np.ndarray, cells: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """A mesh on one side of a plane through 0 with its mirror image, which shares the points on the plane."""
    off = np.flatnonzero(points[:, axis] > 1e-12)
    image = np.arange(len(points))
    image[off] = len(points) + np.arange(len(off))
    sign = np.where(np.arange(3) == axis, -1, 1)
    return np.concatenate([points, points[off] * sign]), np.concatenate([cells, image[cells]])


def surface(cells: np.ndarray) -> np.ndarray:
    """The faces (n, 3) that belong to one cell."""
    faces = np.concatenate([cells[:, k] for k in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, at, count = np.unique(np.sort(faces, 1), axis=0, return_index=True, return_counts=True)
    return faces[at[count == 1]]


def write(scene: Scene, folder: Path) -> dict[str, Path]:
    """mesh.mesh and scene.dat in `folder`: the flags -mesh and -bodies. Label 1 may touch, 2 and 3 are the planes x = 0 and z = 0 of part of a body."""
    folder.mkdir(parents=True, exist_ok=True)
    points = np.concatenate([body.points for body in scene.bodies])
    first = np.cumsum([0, *(len(body.points) for body in scene.bodies)])
    lines = ["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(points)}", *(" ".join(map(repr, map(float, x))) + " 0" for x in points)]
    faces = np.concatenate([surface(body.cells) + n for body, n in zip(scene.bodies, first)])
    lies = [scene.copies > (1 if axis == 2 else 2) and np.abs(points[faces][..., axis]).max(1) < 1e-12 for axis in (0, 2)]
    label = np.where(lies[1], 3, np.where(lies[0], 2, 1))
    lines += [f"Triangles {len(faces)}", *(f"{a + 1} {b + 1} {c + 1} {k}" for (a, b, c), k in zip(faces, np.broadcast_to(label, len(faces))))]
    cells = [(*(cell + n + 1), b) for b, (body, n) in enumerate(zip(scene.bodies, first)) for cell in body.cells]
    lines += [f"Tetrahedra {len(cells)}", *(" ".join(map(str, cell)) for cell in cells), "End", ""]
    (folder / "mesh.mesh").write_text("\n".join(lines))
    (folder / "scene.dat").write_text(data(scene))
    return {"mesh": folder / "mesh.mesh", "bodies": folder / "scene.dat"}


def data(scene: Scene) -> str:
    """The text of scene.dat (edp/core/input/scene-file.idp)."""
    def numbers(*groups) -> str:
        return " ".join(repr(float(x)) for group in groups for x in group)
    lines = ["ffimpact-bodies-3d 1", f"copies {scene.copies}", "disc " + numbers(scene.ball), f"bodies {len(scene.bodies)}"]
    lines += [f"body{b} {body.material[0]} " + numbers(body.material[1:], body.centre, body.shift, body.velocity, body.spin) for b, body in enumerate(scene.bodies)]
    spheres = [f"{b} " + numbers(sphere) for b, body in enumerate(scene.bodies) for sphere in body.spheres]
    lines += [f"spheres {len(spheres)}", *spheres, "cylinders 0", "files 0", f"obstacles {len(scene.obstacles)}"]
    lines += [f"obstacle{k} {kind} {len(given)} " + numbers(given, velocity) for k, (kind, given, velocity) in enumerate(scene.obstacles, 1)]
    lines += [f"pairs {len(scene.pairs)}", *(f"{a} {b} " + numbers(values) for a, b, *values in scene.pairs), ""]
    return "\n".join(lines)
