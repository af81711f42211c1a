"""Areas and angles of the triangles of meshes and snapshots, and the mirror image of half a body.
"""

import numpy as np

from ffimpact.mesh import mesh


def areas(m) -> np.ndarray:
    """The areas of the triangles; those of counter-clockwise triangles are positive."""
    (ax, ay), (bx, by), (cx, cy) = (m.points[m.triangles[:, k]].T for k in range(3))
    return ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2


def smallest_angle(m) -> float:
    """The smallest angle of the triangles in degrees."""
    corners, angles = m.points[m.triangles], []
    for k in range(3):
        u, v = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        angles.append(np.degrees(np.arccos((u * v).sum(1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1))).min())
    return min(angles)


def whole_of(half: mesh.Mesh) -> mesh.Mesh:
    """A half body with its mirror image in the line x = 0. No edge is left on the axis."""
    on_axis = abs(half.points[:, 0]) < 1e-12
    number = np.where(on_axis, np.arange(len(half.points)), len(half.points) + np.cumsum(~on_axis) - 1)
    outline = half.edges[half.labels != mesh.AXIS]
    return mesh.Mesh(np.vstack([half.points, half.points[~on_axis] * [-1, 1]]), np.vstack([half.triangles, number[half.triangles][:, ::-1]]),
                     np.vstack([outline, number[outline][:, ::-1]]), np.full(2 * len(outline), mesh.FREE))
