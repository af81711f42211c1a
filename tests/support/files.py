"""Helpers that the modules test_files.py share."""

from ffimpact.mesh import mesh

MATERIAL = {"law": "neohookean", "young": 7e6, "nu": 0.3, "density": 1000, "accuracy": 0.1}
FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}
FLOOR_3D = FLOOR | {"point": [0, 0, 0], "normal": [0, 1, 0]}


def tables(*bodies, obstacles=(), **top) -> dict:
    return MATERIAL | top | {"body": list(bodies), "obstacle": list(obstacles)}


def solid(file: str, **entries) -> dict:
    """The tables of a body from a file above a floor in three dimensions."""
    body = {"name": "part", "shape": "mesh", "file": file, "position": [0, 0.08, 0],
            "velocity": [0, -2, 0]}
    return tables(body | entries, obstacles=[FLOOR_3D], dimension="3d", accuracy=0.3)


def write_mesh(path, draw, size: float = 0.01, version: float = 4.1):
    """Writes a gmsh file with the elements of the shape that draw(gmsh.model) makes. Returns its path."""
    with mesh.gmsh_session() as gmsh:
        draw(gmsh.model)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.model.mesh.generate(gmsh.model.getDimension())
        gmsh.write(str(path))
    return path


def write_step(path, radius: float = 0.0) -> None:
    """Writes a STEP file of a box of 100 x 60 x 40 mm, with edges rounded by fillets of this radius
    [mm]."""
    with mesh.gmsh_session() as gmsh:
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")  # the unit of the file
        occ = gmsh.model.occ
        box = occ.addBox(0, 0, 0, 100, 60, 40)
        occ.synchronize()
        if radius:
            occ.fillet([box], [tag for _, tag in gmsh.model.getEntities(1)], [radius])
            occ.synchronize()
        gmsh.write(str(path))
