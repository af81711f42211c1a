"""A disc on a beam that is clamped at both ends, with NGSolve: a second opinion on supports, beside the scene disc-beam.

As ngsolve_two_bodies.py, which says what is shared with our own program: nothing but the equations. The lower body is the beam, its end
is held. Example:  ngsolve_disc_beam.py --radius 0.05 --width 0.5 --height 0.04 --speed 4 --penalty 1e9 --refine 2
"""

import ngsolve as ng
import ngsolve_two_bodies as two
from netgen import occ


def mesh_of(o) -> ng.Mesh:
    """Half bodies, drawn 4 radii apart; the end of the beam is named end."""
    half, fine = o.width / 2, 1.2 * o.radius
    upper = occ.WorkPlane().MoveTo(0, 4 * o.radius).Arc(o.radius, two.FINE_ANGLE).Arc(o.radius, 180 - two.FINE_ANGLE).Close().Face()
    lower = occ.WorkPlane().MoveTo(0, -o.height).LineTo(half, -o.height).LineTo(half, 0).LineTo(fine, 0).LineTo(0, 0).LineTo(0, -o.height).Face()
    depth = o.radius * 0.5
    for face, name, size, is_fine in ((upper, two.BODIES[0], 0.16, lambda c: c.y < 4 * o.radius + depth),
                                      (lower, two.BODIES[1], 0.2, lambda c: c.y > -1e-9 and c.x < fine)):
        face.name, face.maxh = name, size * o.radius / o.refine
        for edge in face.edges:
            at_end = name == two.BODIES[1] and edge.center.x > half - 1e-9
            edge.name = "axis" if edge.center.x < 1e-9 else "end" if at_end else f"{name} outline" if is_fine(edge.center) else "free"
            if edge.name == f"{name} outline":
                edge.maxh = 0.05 * o.radius / o.refine
    return ng.Mesh(occ.OCCGeometry(occ.Compound([upper, lower]), dim=2).GenerateMesh(maxh=o.radius, grading=0.3)).Curve(2)


def held(mesh, **more):
    """The space of displacements: u_x = 0 on the axis, u = 0 at the end of the beam."""
    return two.ng_VectorH1(mesh, order=2, dirichletx="axis|end", dirichlety="end")


def main():
    """Runs the two bodies with this mesh and these constraints."""
    two.bodies_mesh, two.ng_VectorH1 = mesh_of, ng.VectorH1
    ng.VectorH1 = held
    two.main()


if __name__ == "__main__":
    main()
