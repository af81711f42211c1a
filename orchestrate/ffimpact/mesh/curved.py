"""Finds the faces of a mesh of tetrahedra that lie on spheres and cylinders, for meshes of files.

The rule is that of plane_file.py in the plane. Adjacent faces at an angle of 30 degrees or less form
one surface. The surface is a sphere or cylinder if all its corners lie on it to 1e-9 of the radius,
each edge spans at most 30 degrees, and each normal is within 30 degrees of the exact normal at the
middle of the face. All other faces are flat, as are surfaces that bend by less than 30 degrees in
total.
"""

import math

import numpy as np

from .mesh import WIDEST, pieces
from .solid_mesh import Curved

__all__ = ["surfaces"]

# WIDEST is also the largest angle [rad] between adjacent faces and between a face's normal and the
# exact one, and the smallest angle by which a curved surface bends in total.
ON = 1e-9  # tolerance of distances relative to the radius, and of angles
PLACES = 5  # smallest number of different angles of corners around the axis of a cylinder
CORRECTIONS = 20  # number of Gauss-Newton iterations for the axis of a cylinder


def surfaces(points: np.ndarray, faces: np.ndarray) -> list[tuple[Curved, np.ndarray]]:
    """The spheres and cylinders of a mesh, each with the numbers of its faces.

    `faces` (f, 3) are counter-clockwise seen from outside.
    """
    a, b, c = points[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    patch = _patches(faces, normals)
    result = []
    for k in np.unique(patch):
        own = np.flatnonzero(patch == k)
        if not _bends(normals[own]):
            continue
        # The corners of a strip along a rim, which has no inner vertices, can lie on a sphere and
        # on a cylinder: only a cylinder is tried for it.
        inner = np.setdiff1d(faces[own], faces[patch != k])
        corners = points[np.unique(faces[own])]
        fit = _sphere(corners) if len(inner) else None
        fit = fit or _cylinder(corners, normals[own])
        if fit and _agrees(fit, points[faces[own]], normals[own]):
            result.append((fit, own))
    return result


def _patches(faces: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The number (f,) of the surface to which each face belongs."""
    sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(sides.T)
    same = (sides[order[1:]] == sides[order[:-1]]).all(axis=1)
    first, second = order[:-1][same] // 3, order[1:][same] // 3
    smooth = (normals[first] * normals[second]).sum(axis=1) >= math.cos(WIDEST * (1 + ON))
    return pieces(len(faces), np.column_stack([first, second])[smooth])


def _bends(normals: np.ndarray) -> bool:
    """Whether the normals (f, 3) of a surface span an angle of 30 degrees or more."""
    far = normals[(normals @ normals[0]).argmin()]
    return bool((normals @ far).min() <= math.cos(WIDEST * (1 - ON)))


def _agrees(fit: Curved, corners: np.ndarray, normals: np.ndarray) -> bool:
    """Whether faces with corners (f, 3, 3) and unit normals (f, 3) lie on a sphere or cylinder."""
    arms = fit.arms(corners)
    if abs(np.linalg.norm(arms, axis=2) - fit.radius).max() > ON * fit.radius:
        return False
    chords = np.linalg.norm(arms - np.roll(arms, 1, axis=1), axis=2).max()
    middle = arms.sum(axis=1)
    turned = (middle * normals).sum(axis=1) / np.linalg.norm(middle, axis=1)
    return bool(
        chords <= 2 * fit.radius * math.sin(WIDEST / 2) * (1 + ON)
        and min(abs(turned.sum()) / len(turned), abs(turned).min()) >= math.cos(WIDEST)
    )


def _sphere(points: np.ndarray) -> Curved | None:
    """The sphere through points (n, 3), by least squares; None if the points do not lie on it."""
    middle, scale = points.mean(axis=0), np.ptp(points, axis=0).max()
    local = (points - middle) / scale
    solution, *_ = np.linalg.lstsq(
        np.column_stack([2 * local, np.ones(len(local))]), (local**2).sum(axis=1), rcond=None
    )
    # The linear equations are 2 x.c + (R^2 - c^2) = x^2, with the centre c and the radius R.
    radius = math.sqrt(max(solution[3] + (solution[:3] ** 2).sum(), 0.0))
    on = abs(np.linalg.norm(local - solution[:3], axis=1) - radius).max() <= ON * radius
    return Curved(middle + scale * solution[:3], np.array([]), scale * radius) if on else None


def _cylinder(points: np.ndarray, normals: np.ndarray) -> Curved | None:
    """The cylinder through points (n, 3), by Gauss-Newton least squares; None if there is none.

    The iteration starts with the axis that is most nearly orthogonal to all normals (f, 3).
    """
    middle, scale = points.mean(axis=0), np.ptp(points, axis=0).max()
    local, centre, axis = (
        (points - middle) / scale,
        np.zeros(3),
        np.linalg.svd(normals, full_matrices=False)[2][2],
    )
    for _ in range(CORRECTIONS):
        away = local - centre
        along = away @ axis
        arms = away - np.outer(along, axis)
        size = np.linalg.norm(arms, axis=1)
        if not size.min() > 0:
            return None
        first, second = np.linalg.svd(axis[None])[2][1:]
        a, b = arms @ first / size, arms @ second / size
        x, *_ = np.linalg.lstsq(
            np.column_stack([along * a, along * b, a, b, np.ones(len(a))]), size, rcond=None
        )
        axis = axis + x[0] * first + x[1] * second
        axis /= np.linalg.norm(axis)
        centre = centre + x[2] * first + x[3] * second
    cylinder = Curved(centre, axis, float(x[4]))
    arms = cylinder.arms(local)
    if abs(np.linalg.norm(arms, axis=1) - cylinder.radius).max() > ON * abs(cylinder.radius):
        return None
    turn = np.arctan2(arms @ np.cross(axis, arms[0]), arms @ arms[0])
    return (
        Curved(middle + scale * centre, axis, scale * cylinder.radius)
        if len(np.unique(np.round(turn, 6))) >= PLACES
        else None
    )
