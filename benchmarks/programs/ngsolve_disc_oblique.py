"""The scene disc-oblique with NGSolve: the whole disc in plane strain with friction (11)-(13).

Curved P2 triangles of netgen with our sizes. The friction law has the linear regularisation. In a
step with the mean tangential velocity v_T = (u1_x - u0_x)/dt and the mean pressure t_N,

t_T = -mu phi t_N,  phi = clamp(v_T/eps, -1, 1),  mu = mu_e if |v_T| < eps, else mu_d.

The work of friction, -t_T v_T dt, is counted with the energy. Two forms:

plain: as users would write it: friction is a further term in the form of ngsolve_body.Plain, solved
    by the full Newton method with UMFPACK.
tuned: a sparse Cholesky factor A of the body alone that is kept. Contact is solved on the active
    set, x = x_w + C f(x) with the compliance C = A^-1 restricted to it, by Newton's method with
    dense matrices. A point keeps its stick or slip status until the computed velocity contradicts
    it.
"""

import math

import ngsolve as ng
import numpy as np
import peer
from netgen.occ import OCCGeometry, WorkPlane
from ngsolve import BND, IfPos, x, y
from ngsolve_body import Body, Plain, Shape, Tuned, main
from ngsolve_two_bodies import Outline

# Angles from the lowest point, against and along the motion, that bound the fine part of the
# outline [degrees]. The disc turns by 30 degrees during contact.
BEHIND, AHEAD = 45, 75
# As in ngsolve_body; larger here, as a new factor also costs the columns of the compliance.
SLOW = 0.75
# Largest number of status changes of a point in a step; afterwards the point slips.
TURNS = 4
FRICTION = {"angle": (60.0, "degrees between velocity and plane"), "friction-static": (0.7, "-"), "friction-dynamic": (0.5, "-"),
            "slip-velocity": (0.1, "m/s, eps")}


def disc(options) -> Shape:
    """The whole disc. `share` is 1/2, as all numbers refer to half of the body."""
    r = options.radius
    face = WorkPlane().MoveTo(0, 0).Arc(r, AHEAD).Arc(r, 360 - AHEAD - BEHIND).Arc(r, BEHIND).Close().Face()
    for edge in face.edges:
        edge.name = "arc" if edge.center.y < r else "circle"
        if edge.name == "arc":
            edge.maxh = options.contact_mesh_size
    return Shape(ng.Mesh(OCCGeometry(face, dim=2).GenerateMesh(maxh=options.mesh_size, grading=0.3)).Curve(2), {}, share=0.5)


class Oblique(Body):
    """The common part of both forms: the initial velocity and the results of a disc that slides and
    rotates."""

    rubbed = 0.0  # work of friction on HALF of the disc so far [J/m]

    def start(self) -> tuple[float, ...]:
        angle = math.radians(self.o.angle)
        return self.o.speed * math.cos(angle), -self.o.speed * math.sin(angle)

    def energy(self) -> float:
        return super().energy() + self.rubbed

    def reported(self) -> dict[str, float]:
        """Tangential velocity, angular momentum about the centre and work of friction of the whole
        disc."""
        place, moment = ng.GridFunction(self.space), self.u.vec.CreateVector()
        place.Set(ng.CF((x, y)))
        place.vec.data += self.u.vec
        n = self.dofs // 2
        # The moment of the momentum M v about the origin.
        moment[:n], moment[n:] = -1 * place.vec[n:], place.vec[:n]
        self.change.data = self.mass * self.v0.vec
        sides = self.change.CreateVector()
        _, w = self.space.TnT()
        sides.data = ng.LinearForm(self.weighted * w[0] * self.bulk).Assemble().vec
        centre = [ng.InnerProduct(component, place.vec) / self.weight for component in (sides, self.upwards)]
        vx, vy = ng.InnerProduct(sides, self.v0.vec) / self.weight, self.velocity()
        turning = ng.InnerProduct(moment, self.change) - self.weight * (centre[0] * vy - centre[1] * vx)
        return {"rebound_vx": vx, "angular_momentum": 2 * turning, "friction_work": 2 * self.rubbed}


class PlainOblique(Oblique, Plain):
    """All terms in one form. The mean velocity of the previous step selects mu at a point, since
    Newton's method does not converge across the jump of mu."""

    def __init__(self, shape: Shape, options):
        self.mean = None
        super().__init__(shape, options)

    def traction(self, u):
        """t_N, t_T and v_T of the step that ends at u."""
        self.mean = self.mean or ng.GridFunction(self.space)
        q0, q1, o = -(y + self.u0[1]), -(y + u[1]), self.o
        p0, p1, v = IfPos(q0, q0, 0), IfPos(q1, q1, 0), (u[0] - self.u0[0]) / self.dt
        normal = o.penalty / 2 * (p0 + p1) * (p1 - p0) / (q1 - q0 + 1e-30)
        phi = IfPos(v - o.slip_velocity, 1, IfPos(-v - o.slip_velocity, -1, v / o.slip_velocity))
        mu = IfPos(o.slip_velocity ** 2 - self.mean[0] ** 2, o.friction_static, o.friction_dynamic)
        return normal, -mu * phi * normal, v

    def contact_form(self, u, w):
        normal, along, _ = self.traction(u)
        return -self.shape.share * (along * w[0] + normal * w[1])

    def solve(self):
        """Newton's method with NGSolve's damping: the step is halved while the work of the residual
        grows."""
        for _ in range(50):
            work, length = self.correct(), 1.0
            if peer.small(work, self.o.tolerance * self.energy0):
                return
            while length > 1e-2:
                self.form.Apply(self.u.vec, self.residual)
                if abs(ng.InnerProduct(self.change, self.residual)) < abs(work):
                    break
                length /= 2
                self.u.vec.data += length * self.change
        raise peer.StepFailed("no convergence")

    def step(self) -> float:
        force = super().step()
        _, along, v = self.traction(self.u)
        self.rubbed -= self.dt * ng.Integrate(self.shape.share * along * v, self.mesh, BND, definedon=self.mesh.Boundaries("arc|circle"), order=4)
        self.mean.vec.data = (1 / self.dt) * self.increment
        return force


class TunedOblique(Oblique):
    """The body with a Cholesky factor that is kept; contact and friction on the active set."""

    tuned = True

    def __init__(self, shape: Shape, options):
        super().__init__(shape, options)
        Tuned.body_forms(self)
        scalar, place = ng.H1(self.mesh, order=2), ng.GridFunction(self.space)
        place.Set(ng.CF((x, y)))
        self.half = scalar.ndof
        arc = Outline(scalar, "arc", self.nodal(place.vec).copy(), 1.0)
        self.nodes = np.unique(arc.dofs)  # scalar dofs of the arc
        # Shape functions at the Gauss points of the arc.
        self.N = np.zeros((len(arc.weight), len(self.nodes)))
        for point, (dofs, values) in enumerate(zip(arc.dofs, arc.N)):
            self.N[point, np.searchsorted(self.nodes, dofs)] = values
        self.weights, self.rest = shape.share * arc.weight, self.nodal(place.vec)[self.nodes].T.copy()
        self.sticks, self.inverse = np.ones(len(arc.weight), bool), None

    @staticmethod
    def nodal(vector) -> np.ndarray:
        return vector.FV().NumPy().reshape(2, -1).T

    def places(self, vector) -> np.ndarray:
        """Coefficients (2, nodes) of the positions of the arc for a displacement."""
        return self.rest + self.nodal(vector)[self.nodes].T

    def factorize(self):
        self.symmetric.AssembleLinearization(self.u.vec)
        self.inverse = self.symmetric.mat.Inverse(self.free, inverse="sparsecholesky")
        self.factorizations += 1
        self.columns, self.solved, self.known = np.zeros(2 * [2 * len(self.nodes)]), np.zeros(len(self.nodes), bool), (None, None)

    def compliance(self, window: np.ndarray) -> np.ndarray:
        """The compliance C of the nodes in `window`, x before y. Its columns are kept as long as
        the factor."""
        if self.known[0] == window.tobytes():
            return self.known[1]
        missing = window[~self.solved[window]]
        if len(missing):
            unknowns = np.concatenate([self.nodes[missing], self.half + self.nodes[missing]])
            units = ng.MultiVector(self.u.vec, len(unknowns))
            for unit, unknown in zip(units, unknowns):
                unit[:] = 0
                unit[int(unknown)] = 1
            answers = (self.inverse * units).Evaluate()
            rows = np.concatenate([self.nodes, self.half + self.nodes])
            columns = np.concatenate([missing, len(self.nodes) + missing])
            self.columns[:, columns] = np.stack([answer.FV().NumPy()[rows] for answer in answers], axis=1)
            self.solved[missing] = True
        at = np.concatenate([window, len(self.nodes) + window])
        self.known = window.tobytes(), self.columns[np.ix_(at, at)]
        return self.known[1]

    def tractions(self, before: np.ndarray, after: np.ndarray, sticks: np.ndarray):
        """Tractions at points: t_N, t_T, v_T, dt_N/dp, dt_T/dp and dt_T/ds, with the penetration p
        and the slip increment s."""
        o, q0, q1 = self.o, -before[1], -after[1]
        p0, p1, gone, v = np.maximum(q0, 0), np.maximum(q1, 0), q1 - q0, (after[0] - before[0]) / self.dt
        moves = abs(gone) > 1e-14
        gone = np.where(moves, gone, 1)
        normal = o.penalty / 2 * np.where(moves, (p1 ** 2 - p0 ** 2) / gone, p0 + p1)
        stiff = np.where(moves, (o.penalty * p1 - normal) / gone, o.penalty / 2 * (q1 > 0))
        ratio = np.where(sticks, o.friction_static, o.friction_dynamic) * np.clip(v / o.slip_velocity, -1, 1)
        steep = np.where(abs(v) < o.slip_velocity, np.where(sticks, o.friction_static, o.friction_dynamic) / o.slip_velocity, 0)
        return normal, -ratio * normal, v, stiff, -ratio * stiff, -steep * normal / self.dt

    def touch(self, before: np.ndarray, free: np.ndarray, guess: np.ndarray, window: np.ndarray):
        """Solves x = free + C f(x) for the positions x (2, window) of the active set.

        Returns x and the nodal forces f (2, window) of the points that these nodes move.
        """
        C, points = self.compliance(window), np.flatnonzero((self.N[:, window] != 0).any(axis=1))
        N, w, n = self.N[np.ix_(points, window)], self.weights[points], len(window)
        start, place, turned = before @ self.N[points].T, guess[:, window].reshape(-1), np.zeros(len(points), int)
        rest = free[:, window].reshape(-1)

        def balance(place):
            tractions = self.tractions(start, place.reshape(2, n) @ N.T, self.sticks[points])
            force = np.concatenate([(w * tractions[1]) @ N, (w * tractions[0]) @ N])
            return tractions, force, place - rest - C @ force

        tractions, force, off = balance(place)
        for _ in range(400):
            if np.linalg.norm(off) <= 1e-12 * self.o.radius * math.sqrt(n):
                v, sticks = abs(tractions[2]), self.sticks[points]
                wrong = (tractions[0] > 0) & (turned <= TURNS) & np.where(sticks, v >= self.o.slip_velocity, v < self.o.slip_velocity)
                turned += wrong
                wrong &= sticks | (turned <= TURNS)
                if not wrong.any():
                    return place.reshape(2, n), force.reshape(2, n)
                self.sticks[points[wrong]] ^= True
                tractions, force, off = balance(place)
                continue
            _, _, _, stiff, dragged, steep = tractions
            K = np.block([[N.T @ ((w * steep)[:, None] * N), -N.T @ ((w * dragged)[:, None] * N)],
                          [np.zeros((n, n)), -N.T @ ((w * stiff)[:, None] * N)]])
            move, length, size = np.linalg.solve(np.eye(2 * n) - C @ K, -off), 1.0, np.linalg.norm(off)
            while True:
                tractions, force, off = balance(place + length * move)
                if np.linalg.norm(off) < (1 - 0.1 * length) * size or length < 0.01:
                    break
                length /= 2
            place = place + length * move
        raise peer.StepFailed("contact: no convergence")

    def solve(self):
        self.predicted.data = self.u0.vec + self.dt * self.v0.vec
        before, force, work_before = self.places(self.u0.vec), self.u.vec.CreateVector(), math.inf
        reach = 2 * self.dt * self.o.speed
        if self.inverse is None:
            self.factorize()
        for _ in range(200):
            self.newton_iterations += 1
            self.out_of_balance()
            self.change.data = self.inverse * self.residual
            guess = self.places(self.u.vec)
            free = guess - self.change.FV().NumPy().reshape(2, -1)[:, self.nodes]
            low = (self.N @ np.minimum(np.minimum(before[1], guess[1]), free[1])) < reach
            window = np.flatnonzero((self.N[low] != 0).any(axis=0))
            force[:] = 0
            if len(window):
                _, forces = self.touch(before, free, guess, window)
                array = force.FV().NumPy()
                array[self.nodes[window]], array[self.half + self.nodes[window]] = forces
                self.residual.data -= force
                self.change.data = self.inverse * self.residual
            work = ng.InnerProduct(self.change, self.residual)
            self.u.vec.data -= self.change
            if peer.small(work, self.o.tolerance * self.energy0):
                return self.rub(before)
            if abs(work) > SLOW ** 2 * work_before:
                self.factorize()
            work_before = abs(work)
        raise peer.StepFailed("no convergence")

    def rub(self, before: np.ndarray):
        """Adds the work of friction of the step."""
        _, along, v, *_ = self.tractions(before @ self.N.T, self.places(self.u.vec) @ self.N.T, self.sticks)
        self.rubbed -= self.dt * self.weights @ (along * v)

    out_of_balance = Tuned.out_of_balance


if __name__ == "__main__":
    main("disc-oblique", disc, {"plain": PlainOblique, "tuned": TunedOblique}, FRICTION)
