"""ball-axisymmetric with NGSolve (`pip install ngsolve==6.2.2608`): curved P2 triangles of netgen with our sizes, one nonlinear form over half a
meridian plane, contact on the whole outline, full Newton with UMFPACK, one thread.

x is the radius, y the axis; F is 3 x 3 with F_33 = 1 + u_x/x. Numbers are those of half the ball inside, weights pi x, as the march of the
peers doubles them: what it prints is of the ball, in N, J and N s.
"""

import math
from importlib import metadata

import ngsolve as ng
from ngsolve import BND, CF, Det, Grad, Id, IfPos, InnerProduct, Inv, Trace, ds, dx, log, x, y

import peer
from ngsolve_disc import TINY, disc_mesh

HOOP = math.pi * x          # half the length of a hoop [m]
ORDER = 5                   # of the quadrature


def gradient(u, grad):
    """(3, 3) of a displacement and its derivatives in the meridian plane."""
    return CF((grad[0, 0], grad[0, 1], 0, grad[1, 0], grad[1, 1], 0, 0, 0, u[0] / x), dims=(3, 3))


class Ball:
    """One step from (u0, v0) to u1 = u, on half a meridian plane."""

    program, version = "ngsolve", metadata.version("ngsolve")

    def __init__(self, options):
        self.o, self.dt = options, options.dt
        self.mesh = disc_mesh(options.radius, options.mesh_size, options.contact_mesh_size)
        self.space = ng.VectorH1(self.mesh, order=2, dirichletx="axis")
        self.free, self.dofs = self.space.FreeDofs(), self.space.ndof
        self.u, self.u0, self.v0 = (ng.GridFunction(self.space) for _ in range(3))
        self.v0.Set(CF((0, -options.speed)))
        self.residual, self.change = self.u.vec.CreateVector(), self.u.vec.CreateVector()
        self.newton_iterations = self.factorizations = 0
        self.bulk, self.outline = dx(bonus_intorder=2), ds("arc|circle", bonus_intorder=1)
        u, w = self.space.TnT()
        self.mass = ng.BilinearForm(options.density * HOOP * InnerProduct(u, w) * self.bulk, symmetric=True).Assemble().mat
        self.upwards = ng.LinearForm(options.density * HOOP * w[1] * self.bulk).Assemble().vec
        self.weight = ng.Integrate(options.density * HOOP, self.mesh, order=ORDER)
        self.points = self.mesh.MapToAllElements(ng.IntegrationRule(ng.SEGM, 4), self.mesh.Boundaries("arc"))
        acceleration = 2 / self.dt**2 * (u - self.u0 - self.dt * self.v0)
        self.form = ng.BilinearForm(self.space)
        self.form += (HOOP * (options.density * InnerProduct(acceleration, w)
                              + InnerProduct(self.mean_piola(gradient(u, Grad(u))), gradient(w, Grad(w))))).Compile() * self.bulk
        self.form += (-HOOP * self.mean_traction(u[1]) * w[1]).Compile() * self.outline
        self.increment = (self.dt * self.v0.vec).Evaluate()
        self.energy0 = self.energy()

    def strain_energy(self, C):
        """W of C [J/m3]."""
        lam, mu = self.o.lame_lambda, self.o.lame_mu
        if self.o.law == "svk":
            E = 0.5 * (C - Id(3))
            return lam / 2 * Trace(E) ** 2 + mu * InnerProduct(E, E)
        log_J = 0.5 * log(Det(C))
        return mu / 2 * (Trace(C) - 3) - mu * log_J + lam / 2 * log_J**2

    def stress(self, C):
        """S = 2 dW/dC [Pa]."""
        lam, mu = self.o.lame_lambda, self.o.lame_mu
        if self.o.law == "svk":
            E = 0.5 * (C - Id(3))
            return lam * Trace(E) * Id(3) + 2 * mu * E
        return mu * (Id(3) - Inv(C)) + lam * 0.5 * log(Det(C)) * Inv(C)

    def mean_piola(self, gradient1):
        """P of the energy-momentum step, from the displacement gradient at its end [Pa]."""
        F0, F1 = Id(3) + gradient(self.u0, Grad(self.u0)), Id(3) + gradient1
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
        F = Id(3) + gradient(self.u, Grad(self.u))
        p = IfPos(y + self.u[1], 0, -y - self.u[1])
        self.change.data = self.mass * self.v0.vec
        return (0.5 * ng.InnerProduct(self.change, self.v0.vec) + ng.Integrate(HOOP * self.strain_energy(F.trans * F), self.mesh, order=ORDER)
                + ng.Integrate(HOOP * self.o.penalty / 2 * p * p, self.mesh, BND, definedon=self.mesh.Boundaries("arc|circle"), order=ORDER))

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


if __name__ == "__main__":
    options = peer.arguments("NGSolve", ("tuned",))
    if options.mesh:
        raise SystemExit("mesh: netgen makes its own, give --mesh-size and --contact-mesh-size")
    ng.SetNumThreads(1)
    peer.main(Ball, options)
