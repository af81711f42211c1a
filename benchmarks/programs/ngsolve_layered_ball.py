"""A layered ball of revolution with NGSolve, on our mesh; see ngsolve_body.py and benchmarks/layers.py.

--scene is a file with a ball of layers that falls on the plane y = 0. Its triangles and the middles
of its curved sides are those of our run: a quadratic deformation moves the middles of straight sides
onto the circles. Every triangle has the material of its layer.
"""

import argparse
import math
import sys

import ngsolve as ng
import ngsolve_body
import numpy as np
import peer  # noqa: F401  # makes ffimpact importable
from netgen.meshing import Element1D, Element2D, Mesh, MeshPoint, Pnt
from ngsolve_ball import gradient
from ngsolve_body import Shape

from ffimpact import scene as scenes
from ffimpact.mesh.mesh import AXIS, FREE
from ffimpact.scenes import assembly


def straight(built: assembly.Assembly, names: list[str]) -> ng.Mesh:
    """The mesh of straight triangles above y = 0, with the names of its materials."""
    made, shift = built.mesh, -built.mesh.points[:, 1].min()
    plain = Mesh(dim=2)
    points = [plain.Add(MeshPoint(Pnt(x, y + shift, 0))) for x, y in made.points.tolist()]
    regions = [plain.AddRegion(name, dim=2) for name in names]
    sides = {FREE: plain.AddRegion("arc", dim=1), AXIS: plain.AddRegion("axis", dim=1)}
    for corners, material in zip(made.triangles.tolist(), built.arrays["mesh.materials"].tolist()):
        plain.Add(Element2D(regions[material], [points[k] for k in corners]))
    for ends, label in zip(made.edges.tolist(), made.labels.tolist()):
        if label in sides:
            plain.Add(Element1D([points[k] for k in ends], index=sides[label]))
    return ng.Mesh(plain)


def bend(mesh: ng.Mesh, built: assembly.Assembly) -> None:
    """Moves the middles of the sides that lie on circles onto them."""
    made, arcs = built.mesh, built.arrays
    middles = made.points[made.edges].mean(axis=1)
    on = arcs["mesh.arc_of"]
    arms = middles - arcs["arcs.centre"][on, :2]
    moved = arms * (arcs["arcs.radius"][on] / np.linalg.norm(arms, axis=1) - 1)[:, None]
    space = ng.VectorH1(mesh, order=2)
    deformation = ng.GridFunction(space)
    count, bubble = space.components[0].ndof, 1 / height(mesh)
    number = {frozenset(vertex.nr for vertex in edge.vertices): edge for edge in mesh.edges}
    for ends, arc, by in zip(made.edges.tolist(), on.tolist(), moved.tolist()):
        if arc >= 0:
            dof = space.components[0].GetDofNrs(number[frozenset(ends)])[0]
            for axis in range(2):
                deformation.vec[axis * count + dof] = by[axis] * bubble
    mesh.SetDeformation(deformation)
    mesh.kept = deformation  # the mesh refers to it


def height(mesh: ng.Mesh) -> float:
    """The value of the quadratic shape function of a side at its middle."""
    space = ng.H1(mesh, order=2)
    shape, edge = ng.GridFunction(space), next(iter(mesh.edges))
    shape.vec[space.GetDofNrs(edge)[0]] = 1.0
    ends = np.array([mesh[vertex].point for vertex in edge.vertices])
    return float(shape(mesh(*ends.mean(axis=0))))


def ball(options: argparse.Namespace) -> Shape:
    scene = scenes.load(options.scene).ready()
    built, materials = assembly.assemble(scene), scene.bodies[0].materials
    names = [f"material{k}" for k in range(len(materials))]
    mesh = straight(built, names)
    bend(mesh, built)
    moduli = {"density": [m.density for m in materials], "lame_mu": [m.young / (2 * (1 + m.nu)) for m in materials],
              "lame_lambda": [m.young * m.nu / ((1 + m.nu) * (1 - 2 * m.nu)) for m in materials]}
    for name, values in moduli.items():
        setattr(options, name, mesh.MaterialCF(dict(zip(names, values))))
    return Shape(mesh, {"dirichletx": "axis"}, gradient=gradient, share=math.pi * ng.x, more=(2, 1))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--scene", required=True)
    own, sys.argv[1:] = parser.parse_known_args()
    script = ngsolve_body.main

    def with_scene(options: argparse.Namespace) -> Shape:
        options.scene = own.scene
        return ball(options)

    script("a layered ball", with_scene)
