"""Helpers that the modules test_self_contact.py share."""

from pathlib import Path

import numpy as np

from ffimpact.mesh import mesh
from ffimpact.output import vtu
from ffimpact.running import run
from ffimpact.scene import read as read_scene

FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}
SCENE = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1722, "accuracy": 0.1, "obstacle": [FLOOR]}
PIN = {"name": "pin", "shape": "polygon", "vertices": [[0, 0], [0.1, 0], [0.1, 0.01], [0.01, 0.01], [0.01, 0.02], [0.1, 0.02], [0.1, 0.03], [0, 0.03]],
       "position": [0, 0.0151], "velocity": [0, -6], "mesh_size": 0.009, "contact_mesh_size": 0.009}
RING = {"name": "ring", "shape": "ring", "radius": 0.05, "inner_radius": 0.044, "position": [0, 0.0501], "velocity": [0, -8], "mesh_size": 0.006, "contact_mesh_size": 0.006}
DISC = {"name": "disc", "shape": "disc", "radius": 0.01, "mesh_size": 0.005, "contact_mesh_size": 0.005}
# A box with a slot, which a peg closes.
WIDE, HIGH, SLOT_WIDE, SLOT_HIGH = 0.08, 0.02, 0.06, 0.004
CORNERS = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
BOX = {"name": "box", "shape": "polygon", "position": [0, 0],
       "vertices": (np.array([WIDE, HIGH]) * CORNERS).tolist(),
       "holes": [(np.array([SLOT_WIDE, SLOT_HIGH]) * CORNERS).tolist()],
       "mesh_size": 0.005, "contact_mesh_size": 0.005}
PEG = {"name": "peg", "kind": "circle", "centre": [0, HIGH / 2 + 0.0501], "radius": 0.05,
       "velocity": [0, -6]}
PINCHED = SCENE | {"young": 2e6, "density": 1000, "fields": 40,
                   "obstacle": [FLOOR | {"point": [0, -HIGH / 2 - 1e-4]}, PEG]}


def read(tables: dict, folder: Path = Path()):
    return read_scene(tables, folder, "self")


def box_file(folder: Path, contact: str = "") -> dict:
    """Writes the box as a gmsh file. Returns its tables.

    The physical curve `contact` contains all curves, or the outer ones, or does not exist.
    """
    with mesh.gmsh_session() as gmsh:
        occ = gmsh.model.occ
        outer = occ.addRectangle(-WIDE / 2, -HIGH / 2, 0, WIDE, HIGH)
        slot = occ.addRectangle(-SLOT_WIDE / 2, -SLOT_HIGH / 2, 0, SLOT_WIDE, SLOT_HIGH)
        occ.cut([(2, outer)], [(2, slot)])
        occ.synchronize()
        def is_outer(curve: int) -> bool:
            x, y, _ = gmsh.model.occ.getCenterOfMass(1, curve)
            return max(abs(x) / WIDE, abs(y) / HIGH) > 0.49
        curves = [curve for _, curve in gmsh.model.getEntities(1)
                  if contact == "all" or is_outer(curve)]
        if contact:
            gmsh.model.addPhysicalGroup(1, curves, name="contact")
            gmsh.model.addPhysicalGroup(2, [face for _, face in gmsh.model.getEntities(2)])
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.005)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(folder / "box.msh"))
    return {"name": "box", "shape": "mesh", "file": "box.msh", "position": [0, 0]}


def slot_of(result) -> np.ndarray:
    """The smallest height of the slot in every snapshot, away from its ends."""
    def wall(side: int):
        return lambda x, y: (abs(y - side * SLOT_HIGH / 2) < 1e-9) & (abs(x) < 0.45 * SLOT_WIDE)
    return distances(result, wall(1), wall(-1))


def overlaps(result) -> list[str]:
    return [warning for warning in result.summary["warnings"] if warning.startswith("overlap: ")]


def ran(tmp_path, tables: dict, name: str = "run"):
    return run.run(read(tables), {}, tmp_path / name, estimate=False)


def distances(result, upper, lower) -> np.ndarray:
    """The smallest height of the nodes of the reference set `upper` above the polygon through those of
    `lower`, for every snapshot.

    The polygon covers every x once.
    """
    least = []
    for _, path in vtu.series(result.folder / "fields.pvd"):
        seen = vtu.read(path)
        X, x = seen.points, seen.points + seen.fields["displacement"][:, :2]
        above, below = x[upper(*X.T)], x[lower(*X.T)]
        below = below[np.argsort(below[:, 0])]
        least.append((above[:, 1] - np.interp(above[:, 0], *below.T))[(above[:, 0] > below[0, 0]) & (above[:, 0] < below[-1, 0])].min())
    return np.array(least)


def balanced(result, energy: float = 1e-9) -> None:
    s = result.summary
    assert s["status"] == "ok" and s["energy_drift"] < energy and s["momentum_drift"] < 1e-9 and (s.get("angular_momentum_drift") or 0) < 1e-9
    assert not any(warning.startswith(("overlap", "energy", "momentum", "angular")) for warning in s["warnings"])
