"""The scene disc-normal with NGSolve; see ngsolve_body.py.

Half of the disc in plane strain, with curved P2 triangles of netgen with our sizes.
"""

import ngsolve as ng
import ngsolve_body
from netgen.occ import OCCGeometry
from ngsolve_body import Shape, half_disc


def disc(options) -> Shape:
    geometry = OCCGeometry(half_disc(options.radius, options.contact_mesh_size), dim=2)
    return Shape(ng.Mesh(geometry.GenerateMesh(maxh=options.mesh_size, grading=0.3)).Curve(2), {"dirichletx": "axis"})


if __name__ == "__main__":
    ngsolve_body.main("disc-normal", disc)
