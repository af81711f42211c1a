"""Writes the fields of a finished run from the states that FreeFEM has recorded in states.bin.

fields/*.vtu and fields.pvd are for ParaView and the figures. fields/contact-*.vtu and
fields/contact.pvd hold the contact points under load at the same instants, fields/contact.csv at
more instants.
"""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .results import reading

if TYPE_CHECKING:
    import meshio  # slow to load, so it is imported only where it is needed

__all__ = ["RECORDED", "read_arrays", "write_fields"]

RECORDED = "states.bin"  # written by edp/program/run/record.idp
# Columns that the files of points for ParaView do not repeat.
PLACES = ("t", "s", "X", "Y", "Z", "x", "y", "z")
Arrays = dict[str, np.ndarray]


def write_fields(folder: Path) -> None:
    """Writes the files of the recorded states of the run in `folder` and removes the record. Does
    nothing if there is no record. Raises Unreadable if the record is damaged.
    """
    path = folder / RECORDED
    if not path.exists():
        return
    surface, states = read_arrays(path)
    (folder / "fields").mkdir(exist_ok=True)
    along = _Along(surface)
    rows: list[np.ndarray] = []
    times: list[float] = []
    for state in states:
        points = _points_under_load(surface, state, along)
        rows.append(np.stack(list(points.values()), axis=1))
        if "fields" in state:
            _write_body(folder / f"fields/{len(times):04d}.vtu", surface, state)
            _write_points(folder / f"fields/contact-{len(times):04d}.vtu", points)
            times.append(float(state["time"][0]))
    with open(folder / "fields/contact.csv", "w") as table:
        table.write(",".join(points) + "\n")
        np.savetxt(table, np.concatenate(rows), fmt="%.9g", delimiter=",")
    _write_series(folder / "fields.pvd", "fields/", times)
    _write_series(folder / "fields/contact.pvd", "contact-", times)
    path.unlink()


def read_arrays(path: Path) -> tuple[Arrays, list[Arrays]]:
    """Returns the arrays of states.bin by name: those recorded once, and those of every state.
    Raises Unreadable if the file is not complete.
    """
    once: Arrays = {}
    states: list[Arrays] = []
    with reading(path), open(path, "rb") as file:
        while line := file.readline().strip() or file.readline().strip():
            if (name := line.decode()) == "end":
                return once, states
            if name == "time":
                states.append({})
            count = int(np.fromfile(file, np.int64, 1)[0])
            values = np.fromfile(file, float, count)
            if len(values) < count:
                break
            (states[-1] if states else once)[name] = values
        raise ValueError("it is cut off")
    raise AssertionError


def _columns(values: np.ndarray, rows: int) -> np.ndarray:
    """Returns a matrix (rows, columns) that FreeFEM has stacked by columns."""
    return values.reshape(-1, rows).T


def _write_body(path: Path, surface: Arrays, state: Arrays) -> None:
    """Writes the fields of a state at the nodes of quadratic triangles or tetrahedra."""
    import meshio  # slow to load, so it is imported only here

    nodes = _columns(surface["nodes"], len(surface["nodes"]) // 3)
    body = surface["cellBody"].astype(np.int32)
    # a record of a former version has no layers
    layer = surface.get("cellLayer", np.zeros(len(body))).astype(np.int32)
    cells = _columns(surface["cells"], len(body)).astype(int)
    at = _columns(state["fields"], len(nodes))
    sigma = at[:, 7:13]
    xx, yy, zz, xy, yz, xz = sigma.T
    mises = np.sqrt(
        ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 2 + 3 * (xy**2 + yz**2 + xz**2)
    )
    fields = {
        "displacement": at[:, :3],
        "velocity": at[:, 3:6],
        "jacobian": at[:, 6],
        "von_mises": mises,
        "pressure": -(xx + yy + zz) / 3,
        "energy_density": at[:, 13],
        "cauchy_stress": sigma,
    }
    if "plasticStrain" in state:
        fields["plastic_strain"] = state["plasticStrain"]
    kind = "triangle6" if cells.shape[1] == 6 else "tetra10"
    _write_mesh(
        path, meshio.Mesh(nodes, [(kind, cells)], fields, {"body": [body], "layer": [layer]})
    )


def _write_points(path: Path, points: Arrays) -> None:
    """Writes the contact points under load as vertices at their reference positions."""
    import meshio

    reference, now = (
        np.stack([points.get(axis, np.zeros(len(points["t"]))) for axis in axes], axis=1)
        for axes in ("XYZ", "xyz")
    )
    loads = {name: values for name, values in points.items() if name not in PLACES}
    for name in ("body", "partner"):
        loads[name] = loads[name].astype(np.int32)
    vertices = np.arange(len(reference))[:, None]
    moved = {"displacement": now - reference}
    _write_mesh(path, meshio.Mesh(reference, [("vertex", vertices)], moved | loads))


def _write_mesh(path: Path, mesh: "meshio.Mesh") -> None:
    import meshio

    arrays = {name: np.ascontiguousarray(values) for name, values in mesh.point_data.items()}
    mesh.point_data = arrays
    meshio.vtu.write(path, mesh, compression=None)


def _write_series(path: Path, prefix: str, times: list[float]) -> None:
    """Writes the .pvd list of the files of all instants [s]."""
    sets = "".join(
        f'<DataSet timestep="{t:.9g}" file="{prefix}{k:04d}.vtu"/>\n' for k, t in enumerate(times)
    )
    path.write_text(
        f'<VTKFile type="Collection" version="0.1">\n<Collection>\n{sets}</Collection>\n</VTKFile>\n'
    )


# ---- contact points


def _points_under_load(surface: Arrays, state: Arrays, along: "_Along") -> Arrays:
    """Returns the columns of fields/contact.csv (POINTS of columns.py) for the points under load in a
    state.
    """
    count = len(surface["pointBody"])
    tangents, _, slip_limit = surface["options"]
    tangents = int(tangents)
    solid = tangents == 2
    empty = np.zeros(count)
    loads = _columns(state.get("loads", np.zeros((2 * tangents + 2) * count)), count)
    under = np.flatnonzero(loads[:, 0] > 0)
    distance = along.distances(loads[:, 0])
    positions = _columns(surface["points"], count)
    now = positions + _columns(state.get("moved", np.zeros(3 * count)), count)
    slip = loads[:, 1 + tangents : 1 + 2 * tangents]
    columns = {
        "t": empty + state["time"][0],
        "body": surface["pointBody"],
        "partner": np.rint(loads[:, -1]),
        "s": distance,
        **dict(zip("XYZ", positions.T)),
        **dict(zip("xyz", now.T)),
        "weight": surface["weight"],
        "pressure": loads[:, 0],
        "shear": loads[:, 1],
        "shear_z": loads[:, tangents],
        "slip_velocity": slip[:, 0],
        "slip_velocity_z": slip[:, -1],
        "slides": (np.linalg.norm(slip, axis=1) >= slip_limit).astype(float),
        "projected_pressure": state.get("projected", empty),
    }
    return {
        name: values[under]
        for name, values in columns.items()
        if solid or name not in ("Z", "z", "shear_z", "slip_velocity_z")
    }


class _Along:
    """The distance of every contact point from the first contact.

    In the plane it is measured along the outline, with the body to the left. In space it is the
    straight distance in the reference configuration.
    """

    def __init__(self, surface: Arrays):
        self.symmetric = surface["options"][1] > 1
        self.positions = _columns(surface["points"], len(surface["pointBody"]))
        self.piece = surface["pointBody"].astype(int)
        self.along: np.ndarray | None = None
        if "along" in surface:
            self.along, self.piece, self.length, self.closed = _chains(surface)
        self.first = np.full(self.piece.max() + 1, -1)

    def distances(self, pressure: np.ndarray) -> np.ndarray:
        """Returns the distances (np,) [m]. A body or chain of edges that comes under load for the
        first time is measured from its most loaded point.
        """
        for piece in np.unique(self.piece[pressure > 0]):
            if self.first[piece] < 0:
                self.first[piece] = np.where(self.piece == piece, pressure, 0.0).argmax()
        origin = np.maximum(self.first[self.piece], 0)
        if self.along is None:
            away: np.ndarray = np.linalg.norm(self.positions - self.positions[origin], axis=1)
            return away
        length, start = self.length[self.piece], self.along[origin]
        if self.symmetric:  # half a body is measured from its axis
            start = np.where(start < length / 2, 0.0, length)
        s: np.ndarray = self.along - start
        around = np.where(s > length / 2, -length, np.where(s <= -length / 2, length, 0.0))
        s += np.where(self.closed[self.piece], around, 0.0)
        return s


def _chains(surface: Arrays) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Returns the outlines as chains of edges that follow each other: the position of every point
    along its chain [m] and the number of the chain; the length [m] of every chain and whether it is
    closed.
    """
    first, last = (surface[name].astype(int) for name in ("edgeFirst", "edgeLast"))
    edge_length, share = surface["edgeLength"], surface["along"].reshape(len(first), -1)
    starting = dict(zip(first, range(len(first))))
    following = np.array([starting.get(node, -1) for node in last])
    begins = np.setdiff1d(np.arange(len(first)), following)
    before, chain = np.full(len(first), -1.0), np.zeros(len(first), int)
    lengths: list[float] = []
    closed: list[bool] = []
    # Open chains start at their first edge. Closed ones, which have none, follow.
    for start in (*begins, *range(len(first))):
        edge, total = start, 0.0
        while edge >= 0 and before[edge] < 0:
            before[edge], chain[edge] = total, len(lengths)
            total += edge_length[edge]
            edge = following[edge]
        if total > 0:
            lengths.append(total)
            closed.append(start not in begins)
    along = (before + (share * edge_length[:, None]).T).T.ravel()
    return along, np.repeat(chain, share.shape[1]), np.array(lengths), np.array(closed)
