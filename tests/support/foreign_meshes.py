"""Helpers that the modules test_foreign_meshes.py share."""

from dataclasses import replace
from pathlib import Path

from ffimpact import scene
from ffimpact.mesh import gmsh_file, mesh
from ffimpact.output import results
from ffimpact.running import run

RADIUS, DENSITY = 0.05, 1722.0
# ---- bodies

# Element size of other shapes [m].
SIZE = 0.008
SETTINGS = {"law": "neohookean", "penalty": 1e9, "speed": 4, "fields": 0, "dt": 4e-5}


def go(out: Path, m: mesh.Mesh, **values) -> results.Record:
    """A run of disc-normal with these values on this mesh. The mesh file is beside the result
    folder."""
    mesh.write(m, out.with_suffix(".msh"))
    return run.run(scene.load("disc-normal"), SETTINGS | values, out, mesh_file=out.with_suffix(".msh"), estimate=False)


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
    for name in names:
        assert abs(a.history[name] - b.history[name]).max() < band * abs(a.history[name]).max(), name
