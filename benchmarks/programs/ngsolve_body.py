"""A body that falls on the rigid plane y = 0 with NGSolve, one thread; the common part of disc and
balls.

Install NGSolve with `pip install ngsolve==6.2.2608`. A Shape describes the body: mesh, symmetry,
gradient, weights. The rest holds for any dimension: the laws, the energy-momentum step from (u0,
v0) to u1 = u and v1, contact with the potential k p^2 / 2 per unit reference area, and the forms of
the solution:

plain: as users of NGSolve would write it: one nonlinear form, contact on the whole outline, full
    Newton method with UMFPACK.
newmark: as plain, with the usual step: Newmark's average acceleration, stress and pressure at the
    end of the step, no correction of the energy.
tuned: constant mass, contact on the lowest arc only, a symmetric tangent that sparse Cholesky
    factorises and that is kept until Newton's method slows down; the exact tangent once a step
    needs it.
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
# The tuned form factorises again if the work of the residual decreases by a factor above SLOW^2.
SLOW = 0.4
# Iterations after which the tuned form restarts the step and uses the exact tangent from then on.
PATIENCE = 30
# Angle from the lowest point that bounds the finely meshed part of the outline [degrees].
ARC = 45


# ---- the laws as functions of C = F^T F in two or three dimensions; o: lame_lambda, lame_mu [Pa],
# law

def strain_energy(C, o: argparse.Namespace):
    """The strain energy W(C) [J/m3]. A C of shape (2, 2) means plane strain."""
    I = Id(C.dims[0])
    if o.law == "svk":
        E = 0.5 * (C - I)
        return o.lame_lambda / 2 * Trace(E) ** 2 + o.lame_mu * InnerProduct(E, E)
    log_J = 0.5 * log(Det(C))
    return o.lame_mu / 2 * (Trace(C) - C.dims[0]) - o.lame_mu * log_J + o.lame_lambda / 2 * log_J ** 2


def stress(C, o: argparse.Namespace):
    """The stress S = 2 dW/dC [Pa]."""
    I = Id(C.dims[0])
    if o.law == "svk":
        E = 0.5 * (C - I)
        return o.lame_lambda * Trace(E) * I + 2 * o.lame_mu * E
    return o.lame_mu * (I - Inv(C)) + o.lame_lambda * 0.5 * log(Det(C)) * Inv(C)


def mean_piola(F0, F1, o: argparse.Namespace):
    """The stress P of the energy-momentum step from F0 to F1 [Pa]."""
    C0, C1 = F0.trans * F0, F1.trans * F1
    S = stress(0.5 * (C0 + C1), o)
    # For svk, S is linear in C and needs no correction.
    if o.law != "svk":
        M = C1 - C0
        square = InnerProduct(M, M)
        missing = 2 * (strain_energy(C1, o) - strain_energy(C0, o)) - InnerProduct(S, M)
        S = S + IfPos(square - 1e-12, missing / (square + TINY), 0) * M
    return 0.5 * (F0 + F1) * S


# ---- the body

@dataclass(frozen=True)
class Shape:
    """A computed part of a body.

    mesh: curved to order 2; boundaries arc (the lowest ARC degrees, fine), circle (the rest of the
        outline) and planes of symmetry
    held: arguments of VectorH1 for the planes of symmetry
    gradient: displacement gradient (n x n) of a displacement
    share: weight that makes the computed part stand for HALF of the body
    bulk_orders: quadrature orders of the energy in the plain and the tuned form; NGSolve uses them
        for the stress together with the inertia, and alone
    more: further orders for `share`, in the body and on its outline
    """

    mesh: ng.Mesh
    held: dict[str, str]
    gradient: Callable = Grad
    share: ng.CoefficientFunction | float = 1.0
    bulk_orders: tuple[int, int] = (4, 2)
    more: tuple[int, int] = (0, 0)


def half_disc(radius: float, contact_mesh_size: float):
    """Half a disc above y = 0 to the right of its axis, as an OCC face with the edges arc, circle
    and axis."""
    face = WorkPlane().MoveTo(0, 0).Arc(radius, ARC).Arc(radius, 180 - ARC).Close().Face()
    for edge in face.edges:
        middle = edge.center
        edge.name = "axis" if middle.x < 1e-9 * radius else "arc" if middle.y < radius * (1 - math.cos(math.radians(ARC))) else "circle"
        if edge.name == "arc":
            edge.maxh = contact_mesh_size
    return face


class Body:
    """A moving shape. All numbers refer to HALF of the body; the time loop of peer.py doubles them.
    """

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
        """The initial velocity [m/s]."""
        return tuple(-self.o.speed * (i == 1) for i in range(self.mesh.dim))

    def reported(self) -> dict[str, float]:
        """Further results that are printed."""
        return {}

    def deformation(self, u):
        """The deformation gradient F of a displacement."""
        H = self.shape.gradient(u)
        return Id(H.dims[0]) + H

    def stress_form(self, u, w):
        """The virtual work of the stress in the step that ends at u [J]."""
        return self.shape.share * InnerProduct(mean_piola(self.deformation(self.u0), self.deformation(u), self.o), self.shape.gradient(w))

    def contact_form(self, u, w):
        """The virtual work of the pressure [J]. t_N is the mean gradient of k p^2 / 2 over the
        step."""
        q0, q1, k = -(y + self.u0[1]), -(y + u[1]), self.o.penalty
        p0, p1 = IfPos(q0, q0, 0), IfPos(q1, q1, 0)
        # The fraction is 1 if the gap is closed at both ends of the step.
        return -self.shape.share * (k / 2 * (p0 + p1) * (p1 - p0) / (q1 - q0 + TINY)) * w[1]

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
        # The last increment is a smoother predictor than the last velocity.
        self.u.vec.data += self.increment
        self.solve()
        self.increment.data = self.u.vec - self.u0.vec
        self.v0.vec.data *= -1
        self.v0.vec.data += (2 / self.dt) * self.increment
        return (self.velocity() - before) * self.weight / self.dt


class Plain(Body):
    """The step as one form, solved by the full Newton method with UMFPACK."""

    def __init__(self, shape: Shape, options: argparse.Namespace):
        super().__init__(shape, options)
        u, w = self.space.TnT()
        self.form = ng.BilinearForm(self.space)
        self.form += (self.weighted * InnerProduct(self.acceleration(u), w) + self.stress_form(u, w)).Compile() * self.bulk
        self.form += self.contact_form(u, w).Compile() * self.outline("arc|circle")

    def acceleration(self, u):
        """The mean acceleration of the step that ends at u [m/s2]."""
        return 2 / self.dt ** 2 * (u - self.u0 - self.dt * self.v0)

    def correct(self):
        """A full step of Newton's method. Returns the work of the residual on its correction [J/m,
        J]."""
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
        """The acceleration at the end of the step [m/s2]. It is zero in the initial flight."""
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
        # A1 - a0.
        self.change.data = (4 / self.dt ** 2) * self.increment - (4 / self.dt) * self.v0.vec - 2 * self.a0.vec
        self.v0.vec.data += self.dt * self.a0.vec + (self.dt / 2) * self.change
        self.a0.vec.data += self.change
        return (self.velocity() - before) * self.weight / self.dt


class Tuned(Body):
    """The step with a constant mass, a compiled residual and a Cholesky factor of a symmetric
    tangent that is kept."""

    tuned = True

    def __init__(self, shape: Shape, options: argparse.Namespace):
        super().__init__(shape, options)
        u, w = self.space.TnT()
        contact = self.contact_form(u, w).Compile() * self.outline("arc")
        stressed, inertia = self.body_forms()
        self.force += contact
        self.symmetric += contact
        # The exact tangent, used from the first step on that does not converge with the symmetric
        # one.
        self.exact = ng.BilinearForm(self.space)
        self.exact += stressed
        self.exact += inertia
        self.exact += contact
        self.tried = self.u.vec.CreateVector()
        self.tangent, self.inverse = (self.symmetric, "sparsecholesky"), None

    def body_forms(self):
        """Builds the forms of the body without contact.

        `force` is the stress part of the residual for the displacement in self.u. `symmetric` is
        the tangent of the midpoint rule, which differs from the exact tangent by the order of dt.
        Returns the forms of stress and inertia.
        """
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
        """Computes the residual of the displacement in self.u."""
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
            # Line search.
            while not abs(ng.InnerProduct(self.change, self.residual)) < abs(work) and length > 1e-2:
                length /= 2
                self.u.vec.data += length * self.change
                self.out_of_balance()
        raise peer.StepFailed("no convergence")


def main(scene: str, build: Callable[[argparse.Namespace], Shape], forms: dict[str, type[Body]] | None = None,
         more: dict[str, tuple[float, str]] | None = None) -> None:
    """Runs the body that `build` makes from the flags, in the form that the flags select.

    `scene` is our scene of the same problem. `more` holds further numbers as name: (default, unit).
    """
    forms = forms or {"plain": Plain, "newmark": Newmark, "tuned": Tuned}
    options = peer.arguments("NGSolve", tuple(forms), scene, more or {})
    if options.mesh:
        raise SystemExit("mesh: netgen makes its own, give --mesh-size and --contact-mesh-size")
    ng.SetNumThreads(1)
    peer.main(lambda o: forms[o.form](build(o), o), options)
