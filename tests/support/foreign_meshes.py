"""Helpers that the modules test_foreign_meshes.py share."""

from dataclasses import replace
from pathlib import Path

from ffimpact import scene
from ffimpact.mesh import gmsh_file, mesh
from ffimpact.output import results
from ffimpact.running import run
from verification.measure import impact

RADIUS, DENSITY = 0.05, 1722.0
# ---- bodies

# Element size of other shapes [m].
SIZE = 0.008
SETTINGS = {"law": "neohookean", "penalty": 1e9, "fields": 0, "dt": 4e-5}
NEAR = 1e-5  # height of the lowest vertex above the plane at the start [m]


def falling(file: Path, low: float, height: float = 0.0, **values) -> dict:
    """The tables of a body of this mesh file, whose lowest vertex is at y = `low` in the file, above the plane y = 0."""
    spin = {"spin": values.pop("spin")} if "spin" in values else {}
    tables = impact(file=file, speed=4, **SETTINGS | values)
    tables["body"] = [tables["body"][0] | {"placement": "as-drawn", "position": [0.0, height + NEAR - low]} | spin]
    return tables


def go(out: Path, m: mesh.Mesh, **values) -> results.Record:
    """A run of a body of this mesh that falls on the plane. The mesh file is beside the result
    folder."""
    mesh.write(m, out.with_suffix(".msh"))
    low = float(m.points[:, 1].min())
    return run.run(scene.read(falling(out.with_suffix(".msh"), low, **values), out.parent, "mesh"), {}, out, estimate=False)


def shaped(draw, size: float = SIZE) -> mesh.Mesh:
    """The mesh of the shape that draw(gmsh.model.occ) makes. All outlines may come into contact."""
    with mesh.gmsh_session() as gmsh:
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        return gmsh_file.taken(gmsh.model)


def moved(m: mesh.Mesh, x: float, y: float) -> mesh.Mesh:
    return replace(m, points=m.points + (x, y))


def agree(a: results.Record, b: results.Record, band: float,
          names=("normal_force", "kinetic", "elastic", "contact", "y", "vy", "contact_size", "max_penetration")) -> None:
    """Requires the same histories, except the contact size at instants without force: there round-off decides
    whether a point touches."""
    loaded = a.history["normal_force"] > 0
    for name in names:
        if name == "contact_size":
            assert abs(a.history[name] - b.history[name])[loaded].max() < band * a.history[name].max()
            continue
        assert abs(a.history[name] - b.history[name]).max() < band * abs(a.history[name]).max(), name
