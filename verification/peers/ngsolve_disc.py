"""disc-normal with NGSolve (`pip install ngsolve==6.2.2608`): curved P2 triangles of netgen with our sizes, one thread.

plain: as its users would write it: one nonlinear form, contact on the whole circle, full Newton with UMFPACK.
tuned: compiled forms, constant mass matrix, contact on the lowest arc alone, a symmetric tangent factorised by sparse
       Cholesky and kept until Newton's method slows down; the exact tangent once a step needs it.
tuned-realcompile: the same with its forms through the C++ compiler, some 10 s of set-up.
"""

import math
import os
import sys
from importlib import metadata

import ngsolve as ng
from netgen.occ import OCCGeometry, WorkPlane
from ngsolve import BND, Grad, Id, IfPos, InnerProduct, Inv, Det, Trace, Variation, ds, dx, log, x, y

import peer

TINY = 1e-30
SLOW = 0.4                  # contraction of the residual's work from which the tuned form makes a new factorisation
PATIENCE = 30               # iterations after which the tuned form starts a step again and stays with the exact tangent


def disc_mesh(radius: float, mesh_size: float, contact_mesh_size: float) -> ng.Mesh:
    """Half disc of netgen, curved to order 2; boundaries arc (the lowest 45 degrees), circle (the rest) and axis."""
    face = WorkPlane().MoveTo(0, 0).Arc(radius, 45).Arc(radius, 135).Close().Face()
    for edge in face.edges:
        middle = edge.center
        edge.name = "axis" if middle.x < 1e-9 * radius else "arc" if middle.y < radius * (1 - math.cos(math.pi / 4)) else "circle"
        if edge.name == "arc":
            edge.maxh = contact_mesh_size
    return ng.Mesh(OCCGeometry(face, dim=2).GenerateMesh(maxh=mesh_size, grading=0.3)).Curve(2)


class Disc:
    """The forms of one step from (u0, v0) to u1 = u, on the half disc."""

    program, version = "ngsolve", metadata.version("ngsolve")
    bulk_order = 4          # of the quadrature of the stress: NGSolve's choice beside the inertia

    def __init__(self, options):
        self.o, self.dt = options, options.dt
        self.mesh = disc_mesh(options.radius, options.mesh_size, options.contact_mesh_size)
        self.space = ng.VectorH1(self.mesh, order=2, dirichletx="axis")
        self.free, self.dofs = self.space.FreeDofs(), self.space.ndof
        self.u, self.u0, self.v0 = (ng.GridFunction(self.space) for _ in range(3))
        self.v0.Set(ng.CF((0, -options.speed)))
        self.residual, self.change = self.u.vec.CreateVector(), self.u.vec.CreateVector()
        self.newton_iterations = self.factorizations = 0
        test = self.space.TestFunction()
        mass = ng.BilinearForm(options.density * InnerProduct(self.space.TrialFunction(), test) * dx, symmetric=True)
        self.mass = mass.Assemble().mat
        self.upwards = ng.LinearForm(options.density * test[1] * dx).Assemble().vec
        self.weight = ng.Integrate(options.density, self.mesh)
        self.points = self.mesh.MapToAllElements(ng.IntegrationRule(ng.SEGM, 4), self.mesh.Boundaries("arc"))
        self.increment = (self.dt * self.v0.vec).Evaluate()
        self.energy0 = self.energy()

    def strain_energy(self, C):
        """W of C = F^T F (2 x 2, plane strain) [J/m3]."""
        lam, mu = self.o.lame_lambda, self.o.lame_mu
        if self.o.law == "svk":
            E = 0.5 * (C - Id(2))
            return lam / 2 * Trace(E) ** 2 + mu * InnerProduct(E, E)
        log_J = 0.5 * log(Det(C))
        return mu / 2 * (Trace(C) - 2) - mu * log_J + lam / 2 * log_J ** 2

    def stress(self, C):
        """S = 2 dW/dC [Pa]."""
        lam, mu = self.o.lame_lambda, self.o.lame_mu
        if self.o.law == "svk":
            E = 0.5 * (C - Id(2))
            return lam * Trace(E) * Id(2) + 2 * mu * E
        return mu * (Id(2) - Inv(C)) + lam * 0.5 * log(Det(C)) * Inv(C)

    def mean_piola(self, gradient):
        """P of the energy-momentum step, from the displacement gradient at its end [Pa]."""
        F0, F1 = Id(2) + Grad(self.u0), Id(2) + gradient
        C0, C1 = F0.trans * F0, F1.trans * F1
        S = self.stress(0.5 * (C0 + C1))
        if self.o.law != "svk":         # linear in C: nothing is missing
            M = C1 - C0
            square = InnerProduct(M, M)
            missing = 2 * (self.strain_energy(C1) - self.strain_energy(C0)) - InnerProduct(S, M)
            S = S + IfPos(square - 1e-12, missing / (square + TINY), 0) * M
        return 0.5 * (F0 + F1) * S

    def mean_traction(self, uy):
        """t_N of the step, from u_y at its end [Pa]: the mean gradient of k p^2 / 2."""
        q0, q1, k = -(y + self.u0[1]), -(y + uy), self.o.penalty
        p0, p1 = IfPos(q0, q0, 0), IfPos(q1, q1, 0)
        return k / 2 * (p0 + p1) * (p1 - p0) / (q1 - q0 + TINY)     # the fraction is 1 where both are closed

    def energy(self) -> float:
        F = Id(2) + Grad(self.u)
        p = IfPos(y + self.u[1], 0, -y - self.u[1])
        self.change.data = self.mass * self.v0.vec
        circle = self.mesh.Boundaries("arc|circle")
        return (0.5 * ng.InnerProduct(self.change, self.v0.vec)
                + ng.Integrate(self.strain_energy(F.trans * F), self.mesh, order=self.bulk_order)
                + ng.Integrate(self.o.penalty / 2 * p * p, self.mesh, BND, definedon=circle, order=4))

    def velocity(self) -> float:
        return ng.InnerProduct(self.upwards, self.v0.vec) / self.weight

    def penetration(self) -> float:
        return (-(y + self.u[1]))(self.points).max()

    def step(self) -> float:
        before = self.velocity()
        self.u0.vec.data = self.u.vec
        self.u.vec.data += self.increment      # the last one: smoother than what the last velocity would say
        self.solve()
        self.increment.data = self.u.vec - self.u0.vec
        self.v0.vec.data *= -1
        self.v0.vec.data += (2 / self.dt) * self.increment
        return (self.velocity() - before) * self.weight / self.dt


class Plain(Disc):
    """One form, full Newton, UMFPACK."""

    def __init__(self, options):
        super().__init__(options)
        u, w = self.space.TnT()
        acceleration = 2 / self.dt ** 2 * (u - self.u0 - self.dt * self.v0)
        self.form = ng.BilinearForm(self.space)
        self.form += (options.density * InnerProduct(acceleration, w) + InnerProduct(self.mean_piola(Grad(u)), Grad(w))) * dx
        self.form += -self.mean_traction(u[1]) * w[1] * ds("arc|circle")

    def solve(self):
        for _ in range(50):
            self.form.Apply(self.u.vec, self.residual)
            self.form.AssembleLinearization(self.u.vec)
            self.change.data = self.form.mat.Inverse(self.free, inverse="umfpack") * self.residual
            self.newton_iterations += 1
            self.factorizations += 1
            self.u.vec.data -= self.change
            if peer.small(ng.InnerProduct(self.change, self.residual), self.o.tolerance * self.energy0):
                return
        raise peer.StepFailed("no convergence")


class Tuned(Disc):
    """Constant mass, compiled residual, frozen Cholesky factor of a symmetric tangent."""

    bulk_order = 2          # three points a triangle, NGSolve's choice for gradients alone

    def __init__(self, options):
        super().__init__(options)
        u, w = self.space.TnT()
        os.environ["PATH"] = f"{sys.prefix}/bin:" + os.environ["PATH"]   # of NGSolve's compiler script
        how = dict(realcompile=True, wait=True) if options.form == "tuned-realcompile" else {}
        stress = InnerProduct(self.mean_piola(Grad(u)), Grad(w)).Compile(**how) * dx
        contact = (-self.mean_traction(u[1]) * w[1]).Compile(**how) * ds("arc")
        # the residual, for the displacement in self.u
        self.force = ng.BilinearForm(self.space, nonassemble=True)
        self.force += stress
        self.force += contact
        # the tangent of the midpoint rule, which is symmetric and differs by the order of dt
        middle = Id(2) + 0.5 * (Grad(u) + Grad(self.u0))
        inertia = (2 * options.density / self.dt ** 2 * InnerProduct(u, w)).Compile() * dx
        self.symmetric = ng.BilinearForm(self.space, symmetric=True)
        self.symmetric += Variation((2 * self.strain_energy(middle.trans * middle)).Compile(**how) * dx)
        self.symmetric += inertia
        self.symmetric += contact
        # the tangent itself, used from the first step on that does not converge with the other
        self.exact = ng.BilinearForm(self.space)
        self.exact += stress
        self.exact += inertia
        self.exact += contact
        self.inertia, self.predicted, self.start = (self.u.vec.CreateVector() for _ in range(3))
        self.tangent, self.inverse = (self.symmetric, "sparsecholesky"), None

    def factorize(self):
        form, solver = self.tangent
        form.AssembleLinearization(self.u.vec)
        self.inverse = form.mat.Inverse(self.free, inverse=solver)
        self.factorizations += 1

    def out_of_balance(self):
        """The residual of the displacement in self.u."""
        self.inertia.data = self.u.vec - self.predicted
        self.force.Apply(self.u.vec, self.residual)
        self.residual.data += (2 / self.dt ** 2) * (self.mass * self.inertia)

    def solve(self):
        self.predicted.data = self.u0.vec + self.dt * self.v0.vec
        self.start.data = self.u.vec
        self.out_of_balance()
        work_before, fresh = math.inf, False
        if self.inverse is None:
            self.factorize()
        for iteration in range(200):
            if iteration == PATIENCE:
                self.tangent, work_before, fresh = (self.exact, "umfpack"), 0.0, False
                self.u.vec.data = self.start
                self.out_of_balance()
            self.change.data = self.inverse * self.residual
            self.newton_iterations += 1
            work = ng.InnerProduct(self.change, self.residual)
            if peer.small(work, self.o.tolerance * self.energy0):
                self.u.vec.data -= self.change
                return
            if not abs(work) < SLOW ** 2 * work_before and not fresh:
                self.factorize()
                fresh = True
                continue
            work_before, fresh = abs(work), False
            length = 1.0
            self.u.vec.data -= self.change
            self.out_of_balance()
            while not abs(ng.InnerProduct(self.change, self.residual)) < abs(work) and length > 1e-2:    # line search
                length /= 2
                self.u.vec.data += length * self.change
                self.out_of_balance()
        raise peer.StepFailed("no convergence")


if __name__ == "__main__":
    options = peer.arguments("NGSolve", ("plain", "tuned", "tuned-realcompile"))
    if options.mesh:
        raise SystemExit("mesh: netgen makes its own, give --mesh-size and --contact-mesh-size")
    ng.SetNumThreads(1)
    peer.main(Plain if options.form == "plain" else Tuned, options)
