"""A body that falls on the rigid plane y = 0 with NGSolve (`pip install ngsolve==6.2.2608`), one thread: what disc and balls share.

A Shape says which body: mesh, symmetry, gradient, weights. Everything else is written once, for any dimension: the laws, the energy-momentum
step from (u0, v0) to u1 = u and v1, contact of potential k p^2 / 2 per unit reference area, and ways to solve it:
plain: as users of NGSolve would write it: one nonlinear form, contact on all of the outline, full Newton with UMFPACK.
newmark: the same with the step that users would take, Newmark's average acceleration, stress and pressure at its end: nothing corrects the energy.
tuned: constant mass, contact on the lowest arc alone, a symmetric tangent factorised by sparse Cholesky and kept until Newton's method
       slows down; the exact tangent once a step needs it.
"""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata

import ngsolve as ng
import peer
from netgen.occ import WorkPlane
from ngsolve import BND, Det, Grad, Id, IfPos, InnerProduct, Inv, Trace, Variation, ds, dx, log, y

TINY = 1e-30
SLOW = 0.4                  # contraction of the residual's work from which the tuned form makes a new factorisation
PATIENCE = 30               # iterations after which the tuned form starts a step again and stays with the exact tangent
ARC = 45                    # degrees from the lowest point: the part of the outline that is meshed for contact


# ---- the laws, of C = F^T F in two or three dimensions; o: lame_lambda, lame_mu [Pa], law

def strain_energy(C, o: argparse.Namespace):
    """W of C [J/m3]; of a C (2 x 2) in plane strain."""
    I = Id(C.dims[0])
    if o.law == "svk":
        E = 0.5 * (C - I)
        return o.lame_lambda / 2 * Trace(E) ** 2 + o.lame_mu * InnerProduct(E, E)
    log_J = 0.5 * log(Det(C))
    return o.lame_mu / 2 * (Trace(C) - C.dims[0]) - o.lame_mu * log_J + o.lame_lambda / 2 * log_J ** 2


def stress(C, o: argparse.Namespace):
    """S = 2 dW/dC [Pa]."""
    I = Id(C.dims[0])
    if o.law == "svk":
        E = 0.5 * (C - I)
        return o.lame_lambda * Trace(E) * I + 2 * o.lame_mu * E
    return o.lame_mu * (I - Inv(C)) + o.lame_lambda * 0.5 * log(Det(C)) * Inv(C)


def mean_piola(F0, F1, o: argparse.Namespace):
    """P of the energy-momentum step from F0 to F1 [Pa]."""
    C0, C1 = F0.trans * F0, F1.trans * F1
    S = stress(0.5 * (C0 + C1), o)
    if o.law != "svk":              # linear in C: nothing is missing
        M = C1 - C0
        square = InnerProduct(M, M)
        missing = 2 * (strain_energy(C1, o) - strain_energy(C0, o)) - InnerProduct(S, M)
        S = S + IfPos(square - 1e-12, missing / (square + TINY), 0) * M
    return 0.5 * (F0 + F1) * S


# ---- the body

@dataclass(frozen=True)
class Shape:
    """mesh: curved to order 2, boundaries arc (the lowest ARC degrees, fine), circle (the rest of the outline) and planes of symmetry;
    held: what VectorH1 holds there; gradient: of a displacement, (n x n); share: the weight with which the computed part stands for
    HALF of the body; bulk_orders: of the quadrature of the energy in the plain and the tuned form, as NGSolve takes them for the stress beside
    the inertia, and alone; more: orders beyond these for share, in the body and on its outline."""

    mesh: ng.Mesh
    held: dict[str, str]
    gradient: Callable = Grad
    share: ng.CoefficientFunction | float = 1.0
    bulk_orders: tuple[int, int] = (4, 2)
    more: tuple[int, int] = (0, 0)


def half_disc(radius: float, contact_mesh_size: float):
    """Half a disc over y = 0 to the right of its axis, a face of OCC; edges arc, circle and axis."""
    face = WorkPlane().MoveTo(0, 0).Arc(radius, ARC).Arc(radius, 180 - ARC).Close().Face()
    for edge in face.edges:
        middle = edge.center
        edge.name = "axis" if middle.x < 1e-9 * radius else "arc" if middle.y < radius * (1 - math.cos(math.radians(ARC))) else "circle"
        if edge.name == "arc":
            edge.maxh = contact_mesh_size
    return face


class Body:
    """A shape in motion; numbers are those of HALF of it, as the march of the peers doubles them."""

    program, version = "ngsolve", metadata.version("ngsolve")
    tuned = False

    def __init__(self, shape: Shape, options: argparse.Namespace):
        self.o, self.dt, self.shape, self.mesh = options, options.dt, shape, shape.mesh
        self.space = ng.VectorH1(self.mesh, order=2, **shape.held)
        self.free, self.dofs = self.space.FreeDofs(), self.space.ndof
        self.u, self.u0, self.v0 = (ng.GridFunction(self.space) for _ in range(3))
        self.v0.Set(ng.CF(self.start()))
        self.residual, self.change = self.u.vec.CreateVector(), self.u.vec.CreateVector()
        self.newton_iterations = self.factorizations = 0
        self.bulk, self.weighted = dx(bonus_intorder=shape.more[0]), options.density * shape.share
        u, w = self.space.TnT()
        self.mass = ng.BilinearForm(self.weighted * InnerProduct(u, w) * self.bulk, symmetric=True).Assemble().mat
        self.upwards = ng.LinearForm(self.weighted * w[1] * self.bulk).Assemble().vec
        self.weight = ng.Integrate(self.weighted, self.mesh, order=5)
        self.points = self.mesh.MapToAllElements(ng.IntegrationRule(ng.SEGM if self.mesh.dim == 2 else ng.TRIG, 4), self.mesh.Boundaries("arc"))
        self.increment = (self.dt * self.v0.vec).Evaluate()
        self.energy0 = self.energy()

    def start(self) -> tuple[float, ...]:
        """The velocity before [m/s]."""
        return tuple(-self.o.speed * (i == 1) for i in range(self.mesh.dim))

    def reported(self) -> dict[str, float]:
        """What is printed beside the march's own numbers."""
        return {}

    def deformation(self, u):
        """F of a displacement."""
        H = self.shape.gradient(u)
        return Id(H.dims[0]) + H

    def stress_form(self, u, w):
        """The work of the stress of the step that ends at u [J]."""
        return self.shape.share * InnerProduct(mean_piola(self.deformation(self.u0), self.deformation(u), self.o), self.shape.gradient(w))

    def contact_form(self, u, w):
        """The work of the pressure, t_N = the mean gradient of k p^2 / 2 in the step [J]."""
        q0, q1, k = -(y + self.u0[1]), -(y + u[1]), self.o.penalty
        p0, p1 = IfPos(q0, q0, 0), IfPos(q1, q1, 0)
        return -self.shape.share * (k / 2 * (p0 + p1) * (p1 - p0) / (q1 - q0 + TINY)) * w[1]     # the fraction is 1 where both are closed

    def outline(self, names: str):
        return ds(names, bonus_intorder=self.shape.more[1])

    def energy(self) -> float:
        F, order = self.deformation(self.u), self.shape.bulk_orders[self.tuned] + self.shape.more[0] // 2
        p = IfPos(y + self.u[1], 0, -y - self.u[1])
        self.change.data = self.mass * self.v0.vec
        return (0.5 * ng.InnerProduct(self.change, self.v0.vec)
                + ng.Integrate(self.shape.share * strain_energy(F.trans * F, self.o), self.mesh, order=order)
                + ng.Integrate(self.shape.share * self.o.penalty / 2 * p * p, self.mesh, BND, definedon=self.mesh.Boundaries("arc|circle"),
                               order=4 + self.shape.more[1]))

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


class Plain(Body):
    """One form, full Newton, UMFPACK."""

    def __init__(self, shape: Shape, options: argparse.Namespace):
        super().__init__(shape, options)
        u, w = self.space.TnT()
        self.form = ng.BilinearForm(self.space)
        self.form += (self.weighted * InnerProduct(self.acceleration(u), w) + self.stress_form(u, w)).Compile() * self.bulk
        self.form += self.contact_form(u, w).Compile() * self.outline("arc|circle")

    def acceleration(self, u):
        """The mean of the step that ends at u [m/s2]."""
        return 2 / self.dt ** 2 * (u - self.u0 - self.dt * self.v0)

    def correct(self):
        """A full step of Newton's method; returns the work of the residual on it [J/m, J]."""
        self.form.Apply(self.u.vec, self.residual)
        self.form.AssembleLinearization(self.u.vec)
        self.change.data = self.form.mat.Inverse(self.free, inverse="umfpack") * self.residual
        self.newton_iterations += 1
        self.factorizations += 1
        self.u.vec.data -= self.change
        return ng.InnerProduct(self.change, self.residual)

    def solve(self):
        for _ in range(50):
            if peer.small(self.correct(), self.o.tolerance * self.energy0):
                return
        raise peer.StepFailed("no convergence")


class Newmark(Plain):
    """Newmark's average acceleration (beta = 1/4, gamma = 1/2)."""

    def __init__(self, shape: Shape, options: argparse.Namespace):
        self.a0 = None
        super().__init__(shape, options)

    def acceleration(self, u):
        """At the end of the step [m/s2]; the flight has none."""
        self.a0 = self.a0 or ng.GridFunction(self.space)
        return 4 / self.dt ** 2 * (u - self.u0 - self.dt * self.v0) - self.a0

    def stress_form(self, u, w):
        F = self.deformation(u)
        return self.shape.share * InnerProduct(F * stress(F.trans * F, self.o), self.shape.gradient(w))

    def contact_form(self, u, w):
        q = -(y + u[1])
        return -self.shape.share * self.o.penalty * IfPos(q, q, 0) * w[1]

    def step(self) -> float:
        before = self.velocity()
        self.u0.vec.data = self.u.vec
        self.u.vec.data += self.increment
        self.solve()
        self.increment.data = self.u.vec - self.u0.vec
        self.change.data = (4 / self.dt ** 2) * self.increment - (4 / self.dt) * self.v0.vec - 2 * self.a0.vec     # a1 - a0
        self.v0.vec.data += self.dt * self.a0.vec + (self.dt / 2) * self.change
        self.a0.vec.data += self.change
        return (self.velocity() - before) * self.weight / self.dt


class Tuned(Body):
    """Constant mass, compiled residual, frozen Cholesky factor of a symmetric tangent."""

    tuned = True

    def __init__(self, shape: Shape, options: argparse.Namespace):
        super().__init__(shape, options)
        u, w = self.space.TnT()
        contact = self.contact_form(u, w).Compile() * self.outline("arc")
        stressed, inertia = self.body_forms()
        self.force += contact
        self.symmetric += contact
        # the tangent itself, used from the first step on that does not converge with the other
        self.exact = ng.BilinearForm(self.space)
        self.exact += stressed
        self.exact += inertia
        self.exact += contact
        self.tried = self.u.vec.CreateVector()
        self.tangent, self.inverse = (self.symmetric, "sparsecholesky"), None

    def body_forms(self):
        """Without contact: force, the residual's stress for the displacement in self.u, and symmetric, the tangent of the midpoint rule, which
        differs by the order of dt from that of its own; gives the forms of stress and inertia."""
        u, w = self.space.TnT()
        stressed = self.stress_form(u, w).Compile() * self.bulk
        self.force = ng.BilinearForm(self.space, nonassemble=True)
        self.force += stressed
        middle = 0.5 * (self.deformation(u) + self.deformation(self.u0))
        inertia = (2 / self.dt ** 2 * self.weighted * InnerProduct(u, w)).Compile() * self.bulk
        self.symmetric = ng.BilinearForm(self.space, symmetric=True)
        self.symmetric += Variation((2 * self.shape.share * strain_energy(middle.trans * middle, self.o)).Compile() * self.bulk)
        self.symmetric += inertia
        self.inertia, self.predicted = (self.u.vec.CreateVector() for _ in range(2))
        return stressed, inertia

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
        self.tried.data = self.u.vec
        self.out_of_balance()
        work_before, fresh = math.inf, False
        if self.inverse is None:
            self.factorize()
        for iteration in range(200):
            if iteration == PATIENCE:
                self.tangent, work_before, fresh = (self.exact, "umfpack"), 0.0, False
                self.u.vec.data = self.tried
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


def main(scene: str, build: Callable[[argparse.Namespace], Shape], forms: dict[str, type[Body]] | None = None,
         more: dict[str, tuple[float, str]] | None = None) -> None:
    """Runs the body that `build` makes of the flags, those of `more` (default, unit) among them, in the form that they ask for; `scene` is the
    one of ours that it stands beside."""
    forms = forms or {"plain": Plain, "newmark": Newmark, "tuned": Tuned}
    options = peer.arguments("NGSolve", tuple(forms), scene, more or {})
    if options.mesh:
        raise SystemExit("mesh: netgen makes its own, give --mesh-size and --contact-mesh-size")
    ng.SetNumThreads(1)
    peer.main(lambda o: forms[o.form](build(o), o), options)
