"""The scene disc-normal with GetFEM (Debian: `apt-get install python3-getfem`), one thread.

Curved P2 triangles on our mesh, weak forms. Two forms:

plain: as its users would write it: one model with the energy-momentum step as a nonlinear term,
    full Newton method with MUMPS.
tuned: the same weak form with a constant mass matrix; SuperLU (scipy) factorises the tangent, and
    the factor is kept until Newton's method slows down.

The only law is svk, since the discrete gradient of other laws is not a short weak form.
"""

import math

import getfem
import numpy as np
import peer
import scipy.sparse
import scipy.sparse.linalg

DISC, CIRCLE, SYMMETRY, ARC = -1, 1, 2, 3  # numbers of the regions
# The tuned form factorises again if the work of the residual decreases by a factor above SLOW^2.
SLOW = 0.4

# Weak forms of the step from u0, v0 to u.
F0, F1 = "(Id(2)+Grad_u0)", "(Id(2)+Grad_u)"
E0, E1 = (f"(0.5*({F}'*{F}-Id(2)))" for F in (F0, F1))
E = f"(0.5*({E0}+{E1}))"
STRESS = f"(0.5*({F0}+{F1})*(lambda*Trace({E})*Id(2)+2*mu*{E})):Grad_Test_u"
INERTIA = "(2*rho/(dt*dt))*(u-u0-dt*v0).Test_u"
Q0, Q1 = "(-X(2)-u0(2))", "(-X(2)-u(2))"
P0, P1 = (f"pos_part({Q})" for Q in (Q0, Q1))
# The fraction is 1 if the gap is closed at both ends of the step.
CONTACT = f"-(k/2*({P0}+{P1})*({P1}-{P0})/({Q1}-{Q0}+1e-30))*Test_u(2)"
# Energies of the state u, v0.
ELASTIC = f"lambda/2*sqr(Trace({E1}))+mu*Norm_sqr({E1})"
PENALTY = f"k/2*sqr(pos_part({Q1}))"
# Gauss points on an edge, and the shape functions at these points (3, 3).
LOCAL = 0.5 + math.sqrt(0.15) * np.array([-1, 0, 1])
GAUSS = np.array([(1 - LOCAL) * (1 - 2 * LOCAL), 4 * LOCAL * (1 - LOCAL), LOCAL * (2 * LOCAL - 1)])


def curved_mesh(options) -> getfem.Mesh:
    """A mesh of isoparametric P2 triangles with middle nodes on the circle.

    Its regions are CIRCLE, SYMMETRY and ARC, the lowest 45 degrees.
    """
    half = peer.half_disc(options)
    middle, of_triangle = peer.middles(half, options.radius)
    points = np.vstack([half.points, middle])
    a, b, c = half.triangles.T
    ab, bc, ca = len(half.points) + of_triangle.T
    result = getfem.Mesh("empty", 2)
    # GetFEM's order on the reference triangle.
    nodes = points[np.column_stack([a, ab, b, ca, bc, c])]
    result.add_convex(getfem.GeoTrans("GT_PK(2,2)"), nodes.transpose(2, 1, 0))
    faces = result.outer_faces()
    # (faces, 2, 3).
    nodes = np.array([result.pts(result.pid_in_faces(faces[:, [i]])) for i in range(faces.shape[1])])
    axis = nodes[:, 0].max(axis=1) < 1e-9 * options.radius
    arc = ~axis & (nodes[:, 1].max(axis=1) < options.radius * (1 - math.cos(math.pi / 4)) + 1e-9 * options.radius)
    for region, chosen in ((CIRCLE, ~axis), (SYMMETRY, axis), (ARC, arc)):
        result.set_region(region, faces[:, chosen])
    return result


def csc(matrix: getfem.Spmat) -> scipy.sparse.csc_matrix:
    """A GetFEM matrix as a scipy matrix."""
    starts, rows = matrix.csc_ind()
    return scipy.sparse.csc_matrix((matrix.csc_val(), rows, starts), shape=matrix.size())


class Disc:
    """The model of one step on the half disc, with the variable u and the data u0 and v0."""

    program, version = "getfem", getfem.getfem_env("version")
    bulk_order = 4  # order of the quadrature of the stress

    def __init__(self, options):
        self.o, self.dt = options, options.dt
        self.mesh = curved_mesh(options)
        self.fem = getfem.MeshFem(self.mesh, 2)
        self.fem.set_fem(getfem.Fem("FEM_PK(2,2)"))
        self.rule = getfem.MeshIm(self.mesh, getfem.Integ("IM_TRIANGLE(4)"))
        self.bulk_rule = getfem.MeshIm(self.mesh, getfem.Integ(f"IM_TRIANGLE({self.bulk_order})"))
        self.dofs = self.fem.nbdof()
        self.up = np.arange(self.dofs) % 2 == 1  # marks the unknowns along y
        self.model = getfem.Model("real")
        self.model.add_fem_variable("u", self.fem)
        for name in ("u0", "v0"):
            self.model.add_fem_data(name, self.fem)
        for name, value in (("lambda", options.lame_lambda), ("mu", options.lame_mu), ("rho", options.density),
                            ("dt", options.dt), ("k", options.penalty)):
            self.model.add_initialized_data(name, [value])
        self.mass = options.density * csc(getfem.asm_mass_matrix(self.rule, self.fem))
        self.momentum = self.mass @ self.up
        self.weight = self.momentum @ self.up
        self.u, self.v = np.zeros(self.dofs), np.where(self.up, -options.speed, 0.0)
        self.increment = self.dt * self.v
        # u_y and height of the nodes of the arc, from the lowest point on: vertex, middle, vertex,
        # ...
        nodes, heights = self.fem.basic_dof_on_region(ARC), self.fem.basic_dof_nodes()[1]
        nodes = nodes[self.up[nodes]]
        nodes = nodes[np.argsort(heights[nodes])]
        self.edges = np.column_stack([nodes[0:-2:2], nodes[1:-1:2], nodes[2::2]])
        self.heights = heights[self.edges]
        self.newton_iterations = self.factorizations = 0
        self.energy0 = self.energy()

    def energy(self) -> float:
        self.model.set_variable("u", self.u)
        return (0.5 * self.v @ (self.mass @ self.v) + getfem.asm_generic(self.bulk_rule, 0, ELASTIC, DISC, self.model)
                + getfem.asm_generic(self.rule, 0, PENALTY, CIRCLE, self.model))

    def velocity(self) -> float:
        return self.momentum @ self.v / self.weight

    def reported(self) -> dict[str, float]:
        """Further results that are printed."""
        return {}

    def penetration(self) -> float:
        return -((self.heights + self.u[self.edges]) @ GAUSS).min()

    def step(self) -> float:
        before = self.velocity()
        self.model.set_variable("u0", self.u)
        self.model.set_variable("v0", self.v)
        u0 = self.u
        # The last increment is a smoother predictor than the last velocity.
        self.u = self.solve(u0 + self.increment)
        self.increment = self.u - u0
        self.v = (2 / self.dt) * self.increment - self.v
        return (self.velocity() - before) * self.weight / self.dt


class Plain(Disc):
    """The step as one GetFEM model, solved by the full Newton method with MUMPS."""

    def __init__(self, options):
        super().__init__(options)
        self.model.add_nonlinear_term(self.rule, f"{INERTIA}+{STRESS}")
        self.model.add_nonlinear_term(self.rule, CONTACT, CIRCLE)
        self.model.add_normal_Dirichlet_condition_with_multipliers(self.rule, "u", 2, SYMMETRY)

    def solve(self, u):
        first, length = self.model.interval_of_variable("u")
        for _ in range(50):
            self.model.set_variable("u", u)
            self.model.assembly("build_all")
            change = getfem.linsolve_mumps(self.model.tangent_matrix(), self.model.rhs()).flatten()
            self.newton_iterations += 1
            self.factorizations += 1
            work = change @ self.model.rhs()
            self.model.to_variables(self.model.from_variables() + change)
            u = u + change[first:first + length]
            if peer.small(work, self.o.tolerance * self.energy0):
                return u
        raise peer.StepFailed("no convergence")


class Tuned(Disc):
    """The step with a constant mass matrix and a factor that is kept."""

    bulk_order = 2  # three quadrature points in a triangle

    def __init__(self, options):
        super().__init__(options)
        self.model.add_nonlinear_term(self.bulk_rule, STRESS)
        self.model.add_nonlinear_term(self.rule, CONTACT, ARC)
        self.free = np.ones(self.dofs, dtype=bool)
        held = self.fem.basic_dof_on_region(SYMMETRY)
        self.free[held[~self.up[held]]] = False
        self.factor = None

    def residual(self, u):
        self.model.set_variable("u", u)
        self.model.assembly("build_rhs")
        return (self.mass @ (u - self.ballistic) * (2 / self.dt ** 2) - self.model.rhs())[self.free]

    def factorize(self, u):
        self.model.set_variable("u", u)
        self.model.assembly("build_matrix")
        tangent = csc(self.model.tangent_matrix()) + (2 / self.dt ** 2) * self.mass
        self.factor = scipy.sparse.linalg.splu(tangent[self.free][:, self.free], permc_spec="MMD_AT_PLUS_A",
                                               diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        self.factorizations += 1

    def solve(self, u):
        self.ballistic = self.u + self.dt * self.v
        residual, work_before, fresh = self.residual(u), math.inf, False
        if self.factor is None:
            self.factorize(u)
        for _ in range(200):
            change = np.zeros(self.dofs)
            change[self.free] = self.factor.solve(residual)
            self.newton_iterations += 1
            work = change[self.free] @ residual
            if peer.small(work, self.o.tolerance * self.energy0):
                return u - change
            if not abs(work) < SLOW ** 2 * work_before and not fresh:
                self.factorize(u)
                fresh = True
                continue
            work_before, fresh, length = abs(work), False, 1.0
            residual = self.residual(u - change)
            # Line search.
            while not abs(change[self.free] @ residual) < abs(work) and length > 1e-2:
                length /= 2
                residual = self.residual(u - length * change)
            u = u - length * change
        raise peer.StepFailed("no convergence")


if __name__ == "__main__":
    options = peer.arguments("GetFEM", ("plain", "tuned"))
    if options.law != "svk":
        raise SystemExit("law: svk alone")
    getfem.util_trace_level(0)
    peer.main(Plain if options.form == "plain" else Tuned, options)
