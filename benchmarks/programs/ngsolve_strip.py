"""The scene strip-gravity (benchmarks/scenes/) with NGSolve, one thread: a clamped strip under a step
of gravity, on a grid of quadrilaterals of order 2, with the energy-momentum step."""

import json
import time

import ngsolve as ng
import strip
from ngsolve import Grad, Id, InnerProduct, dx
from ngsolve.meshes import MakeStructured2DMesh
from ngsolve_body import mean_piola


def heights(o) -> list[float]:
    """The height of the centre of mass over that at the start after each step [m]."""
    mesh = MakeStructured2DMesh(True, *strip.grid(o), mapping=lambda x, y: (o.width * x, o.height * y))
    space = ng.VectorH1(mesh, order=2, dirichlet="left")
    u, u0, v0 = (ng.GridFunction(space) for _ in range(3))
    trial, w = space.TnT()
    form = ng.BilinearForm(space)
    inertia = o.density * (2 / o.dt ** 2 * (trial - u0 - o.dt * v0) + ng.CF((0, o.gravity)))
    stress = mean_piola(Id(2) + Grad(u0), Id(2) + Grad(trial), o)
    form += (InnerProduct(inertia, w) + InnerProduct(stress, Grad(w))).Compile() * dx
    upwards = ng.LinearForm(w[1] / (o.width * o.height) * dx).Assemble().vec
    residual, change = u.vec.CreateVector(), u.vec.CreateVector()
    energy, found = o.density * o.gravity ** 2 * o.width * o.height * o.end_time ** 2, []
    o.dofs = space.ndof
    for _ in range(strip.steps(o)):
        u0.vec.data = u.vec
        u.vec.data += o.dt * v0.vec
        for _ in range(20):
            form.Apply(u.vec, residual)
            form.AssembleLinearization(u.vec)
            change.data = form.mat.Inverse(space.FreeDofs(), inverse="umfpack") * residual
            u.vec.data -= change
            if abs(ng.InnerProduct(change, residual)) <= o.tolerance * energy:
                break
        else:
            raise SystemExit("no convergence")
        v0.vec.data *= -1
        v0.vec.data += (2 / o.dt) * (u.vec - u0.vec).Evaluate()
        found.append(ng.InnerProduct(upwards, u.vec))
    return found


if __name__ == "__main__":
    options = strip.arguments("NGSolve")
    ng.SetNumThreads(1)
    began = time.process_time()
    sag = strip.sag(heights(options))
    print(json.dumps({"sag": sag, "dofs": options.dofs, "cpu_seconds": time.process_time() - began}))
