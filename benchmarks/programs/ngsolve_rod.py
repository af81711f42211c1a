"""The scene rod-flat (benchmarks/scenes/) with NGSolve; see ngsolve_body.py.

Half of the rod in plane strain, on a grid of quadrilaterals of order 2.
"""

import ngsolve_body
from ngsolve.meshes import MakeStructured2DMesh
from ngsolve_body import Shape


def rod(options) -> Shape:
    columns, rows = max(1, round(options.width / 2 / options.across)), round(options.height / options.mesh_size)
    mesh = MakeStructured2DMesh(True, columns, rows, mapping=lambda x, y: (options.width / 2 * x, options.height * y))
    for side, name in enumerate(("arc", "circle", "circle", "axis")):  # bottom, right, top, left
        mesh.ngmesh.SetBCName(side, name)
    return Shape(mesh, {"dirichletx": "axis"})


if __name__ == "__main__":
    ngsolve_body.main("rod-flat", rod, more={"width": (0.02, "m"), "height": (0.25, "m"), "across": (0.01, "m, across the rod")})
