"""The scene ball with NGSolve; see ngsolve_body.py.

A quarter of the ball, x >= 0 and z >= 0, with curved P2 tetrahedra of netgen with our sizes.
"""

import ngsolve as ng
import ngsolve_body
from netgen.occ import Axis, OCCGeometry, gp_Dir, gp_Pnt
from ngsolve_body import Shape, half_disc


def ball(options) -> Shape:
    """The half disc, revolved by 90 degrees about its axis from the plane z = 0 to the plane x = 0.
    """
    solid = half_disc(options.radius, options.contact_mesh_size).Revolve(Axis(gp_Pnt(0, 0, 0), gp_Dir(0, -1, 0)), 90)
    small = 1e-6 * options.radius
    for face in solid.faces:
        middle = face.center
        face.name = "plane x" if middle.x < small else "plane z" if middle.z < small else "arc" if middle.y < options.radius / 2 else "circle"
        if face.name == "arc":
            face.maxh = options.contact_mesh_size
    mesh = ng.Mesh(OCCGeometry(solid).GenerateMesh(maxh=options.mesh_size, grading=0.3)).Curve(2)
    return Shape(mesh, {"dirichletx": "plane x", "dirichletz": "plane z"}, share=2.0)


if __name__ == "__main__":
    ngsolve_body.main("ball", ball)
