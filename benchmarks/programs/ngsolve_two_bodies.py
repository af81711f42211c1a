"""A disc on a free block with NGSolve: an independent solution for two bodies.

Install NGSolve with `pip install ngsolve==6.2.2608`. Half of both bodies (u_x = 0 on the axis x =
0), plane strain, curved P2 triangles of netgen, no friction, no gravity. With --clamped 1 the block
is a beam with clamped ends. The method has nothing in common with our step: central differences
with the consistent mass. The contact potential is k p^2 / 2 per unit reference length:

two-sided: closest-point projection of each Gauss point of either outline onto the other deformed
    outline (P2 edges, so parabolas), with half of the weight in each role. The forces are the exact
    gradient of the potential except where the closest point jumps over a corner between two edges.
    Hence momentum is exact and energy is conserved nearly (1e-5 at k = 1e9 Pa/m, 1e-4 at 1e10).
ngsolve: as users of NGSolve would write it: ContactBoundary with the points of the upper outline
    only and p along their normal. The forces are not quite a gradient. The energy does not contain
    the potential and is therefore to be compared after the contact.

Prints a line of JSON about the whole bodies in SI units per metre of thickness; y is upwards. The
energy of vibration is the elastic energy and the kinetic energy about the mean velocity of the
body, after the contact.
"""

import argparse
import json
import math
import time
from importlib import metadata
from pathlib import Path

import netgen.occ as occ
import ngsolve as ng
import numpy as np
from ngsolve import BND, Grad, Id, IfPos, InnerProduct, Trace, ds, dx, x, y
from ngsolve_body import strain_energy, stress
from peer import with_numbers

# Angle from the axis up to which the outline of the disc is fine and may be in contact [degrees].
FINE_ANGLE = 60
ORDER = 4  # order of the quadrature of the stress and its energy
SAMPLE = 20  # number of steps between two rows of the history
BODIES = ("upper", "lower")
OUTLINES = ("upper outline", "lower outline")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    numbers = {"radius": (0.5, "m"), "width": (10.0, "m, of the block"), "height": (2.0, "m, of the block"), "young": (7e6, "Pa"),
               "density": (1722.0, "kg/m3"), "nu": (0.45, "-"), "penalty": (1e9, "Pa/m"), "speed": (10.0, "m/s, downwards, of the disc"),
               "refine": (1.0, "divides all mesh sizes"),
               "courant": (0.4, "step over the linear limit of stability"), "after": (0.3, "flight after the contact, in contact times")}
    parser.add_argument("--law", choices=("svk", "neohookean"), default="neohookean")
    parser.add_argument("--contact", choices=("two-sided", "ngsolve"), default="two-sided")
    parser.add_argument("--clamped", type=int, default=0, help="1: the block is a beam, held at its ends")
    parser.add_argument("--history", type=Path, help="writes force, energies and velocities over time there (CSV)")
    return with_numbers(parser, numbers)


def bodies_mesh(o: argparse.Namespace) -> ng.Mesh:
    """The half bodies, drawn 4 radii apart.

    The materials are upper and lower; the boundaries are axis, OUTLINES (the fine ones), clamp and
    free.
    """
    half, fine = o.width / 2, 1.6 * o.radius
    upper = occ.WorkPlane().MoveTo(0, 4 * o.radius).Arc(o.radius, FINE_ANGLE).Arc(o.radius, 180 - FINE_ANGLE).Close().Face()
    lower = occ.WorkPlane().MoveTo(0, -o.height).LineTo(half, -o.height).LineTo(half, 0).LineTo(fine, 0).LineTo(0, 0).LineTo(0, -o.height).Face()
    depth = o.radius * (1 - math.cos(math.radians(FINE_ANGLE)))
    block = 0.16 if o.clamped else 0.6
    for face, name, size, is_fine in ((upper, BODIES[0], 0.16, lambda c: c.y < 4 * o.radius + depth),
                                      (lower, BODIES[1], block, lambda c: c.y > -1e-9 and c.x < fine)):
        face.name, face.maxh = name, size * o.radius / o.refine
        for edge in face.edges:
            edge.name = "axis" if edge.center.x < 1e-9 else f"{name} outline" if is_fine(edge.center) else "free"
            if edge.name == f"{name} outline":
                edge.maxh = 0.05 * o.radius / o.refine
            if o.clamped and edge.center.x > half - 1e-9:
                edge.name = "clamp"
    return ng.Mesh(occ.OCCGeometry(occ.Compound([upper, lower]), dim=2).GenerateMesh(maxh=o.radius, grading=0.3)).Curve(2)


class Outline:
    """A chain of P2 edges from the axis outwards in NGSolve's basis 1 - s, s, bubble s (1 - s);
    dofs of the scalar space."""

    def __init__(self, space, name: str, reference: np.ndarray, side: float):
        edges = np.array([element.dofs for element in space.Elements(BND) if space.mesh.GetBoundaries()[element.index] == name])
        begin, end = reference[edges[:, 0], 0], reference[edges[:, 1], 0]
        edges[begin > end, :2] = edges[begin > end, 1::-1]
        # side: +1 if the body is to the left of the chain.
        self.edges, self.side = edges[np.argsort(np.minimum(begin, end))], side
        bubble = ng.GridFunction(space)
        bubble.vec[int(edges[0, 2])] = 1
        middles = bubble(space.mesh.MapToAllElements(ng.IntegrationRule(points=[(0.5,)], weights=[1.0]), space.mesh.Boundaries(name)))
        self.bubble = 4 * middles.flat[np.argmax(np.abs(middles))]
        nodes, weights = np.polynomial.legendre.leggauss(4)
        # Shape functions at all Gauss points, edge by edge.
        self.N = np.tile(self.shape((nodes + 1) / 2), (len(edges), 1))
        self.dofs = np.repeat(self.edges, 4, axis=0)
        dX = np.einsum("ga,gai->gi", np.tile(self.slope((nodes + 1) / 2), (len(edges), 1)), reference[self.dofs])
        # The quadrature weight in terms of reference length [m].
        self.weight = np.tile(weights / 2, len(edges)) * np.linalg.norm(dX, axis=1)

    def shape(self, s):
        return np.stack([1 - s, s, self.bubble * s * (1 - s)], axis=-1)

    def slope(self, s):
        return np.stack([-np.ones_like(s), np.ones_like(s), self.bubble * (1 - 2 * s)], axis=-1)

    def point(self, s, corners):
        return (self.shape(s)[..., None] * corners).sum(-2)

    def tangent(self, s, corners):
        return (self.slope(s)[..., None] * corners).sum(-2)

    def project(self, points: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Parameters s in [0, 1] of the closest points on the edges, by Newton's method.

        `corners` (points, candidates, 3 dofs, 2) are the coefficients of the candidate edges of
        each point.
        """
        s = np.full(corners.shape[:2], 0.5)
        for _ in range(4):
            r, t = points[:, None] - self.point(s, corners), self.tangent(s, corners)
            square = (t * t).sum(-1)
            hessian = square + 2 * self.bubble * (r * corners[:, :, 2]).sum(-1)
            s = np.clip(s + (r * t).sum(-1) / np.maximum(hessian, 0.1 * square), 0, 1)
        return s

    def outward(self, t: np.ndarray) -> np.ndarray:
        return self.side * np.stack([t[:, 1], -t[:, 0]], axis=1) / np.linalg.norm(t, axis=1)[:, None]

    def closest(self, points: np.ndarray, position: np.ndarray) -> tuple[np.ndarray, ...]:
        """Closest-point projection onto the deformed outline, for points inside the body.

        The edge with the nearest middle and its two neighbours are searched. Returns the indices of
        the points inside, and their edge, s, gap < 0 and outward normal (m, 2).
        """
        corners = position[self.edges]  # (edges, 3 dofs, 2)
        middles, chords = self.point(np.full(len(corners), 0.5), corners), corners[:, 1] - corners[:, 0]
        nearest = np.argmin(((points[:, None] - middles) ** 2).sum(-1), axis=1)
        height = ((points - middles[nearest]) * self.outward(chords)[nearest]).sum(1)
        which = np.flatnonzero(height < 0.25 * np.linalg.norm(chords, axis=1)[nearest])
        # The other points are far outside.
        points = points[which]
        edge = np.clip(nearest[which, None] + np.array([-1, 0, 1]), 0, len(self.edges) - 1)
        s = self.project(points, corners[edge])
        distance = np.linalg.norm(points[:, None] - self.point(s, corners[edge]), axis=-1)
        best = np.arange(len(points)), np.argmin(distance, axis=1)
        edge, s, distance = edge[best], s[best], distance[best]
        r, normal = points - self.point(s, corners[edge]), self.outward(self.tangent(s, corners[edge]))
        gap = np.where((r * normal).sum(1) < 0, -distance, distance)
        # At a vertex the gradient of the gap is along r.
        vertex = ((s == 0) | (s == 1)) & (distance > 0)
        normal[vertex] = r[vertex] / gap[vertex, None]
        # The outline is open beyond the last point of the chain.
        inside = (gap < 0) & ~((edge == len(self.edges) - 1) & (s == 1))
        return which[inside], edge[inside], s[inside], gap[inside], normal[inside]


class Pair:
    """Both half bodies with displacement u and velocity v at the time t. Contact begins at t = 0.
    """

    def __init__(self, o: argparse.Namespace):
        self.o, self.t, self.mesh = o, 0.0, bodies_mesh(o)
        self.space = ng.VectorH1(self.mesh, order=2, dirichletx="axis|clamp", dirichlety="clamp")
        scalar = ng.H1(self.mesh, order=2)
        self.u, self.v, coordinates = (ng.GridFunction(self.space) for _ in range(3))
        # Moves the disc to the first contact.
        self.u.Set(ng.CF((0, -4 * o.radius)), definedon=self.mesh.Materials("upper"))
        self.v.Set(self.mesh.MaterialCF({"upper": ng.CF((0, -o.speed)), "lower": ng.CF((0, 0))}))
        coordinates.Set(ng.CF((x, y)))
        self.reference = self.nodal(coordinates.vec).copy()
        self.outlines = [Outline(scalar, name, self.reference, side) for name, side in zip(OUTLINES, (1.0, -1.0))]
        self.force, self.contact, self.acceleration = (self.u.vec.CreateVector() for _ in range(3))
        self.assemble()
        self.masses = [ng.Integrate(ng.CF(o.density) * dx(body), self.mesh) for body in BODIES]
        self.is_upper = np.zeros(scalar.ndof, bool)
        self.is_upper[[dof for element in scalar.Elements() if element.mat == BODIES[0] for dof in element.dofs]] = True
        # Bubble functions carry no resultant force.
        self.is_upper_vertex = self.is_upper & (np.arange(scalar.ndof) < self.mesh.nv)
        self.dt = o.courant * 2 / self.highest_frequency()

    @staticmethod
    def nodal(vector) -> np.ndarray:
        """Coefficients of a vector (scalar dofs, 2)."""
        return vector.FV().NumPy().reshape(2, -1).T

    def assemble(self):
        o, (trial, test) = self.o, self.space.TnT()
        volume = dx(intrules={ng.TRIG: ng.IntegrationRule(ng.TRIG, ORDER)})
        F, F_now = Id(2) + Grad(trial), Id(2) + Grad(self.u)
        self.stress = ng.BilinearForm(self.space, nonassemble=True)
        self.stress += InnerProduct(F * stress(F.trans * F, o), Grad(test)).Compile() * volume
        self.mass = ng.BilinearForm(o.density * InnerProduct(trial, test) * dx, symmetric=True).Assemble().mat
        self.inverse = self.mass.Inverse(self.space.FreeDofs(), inverse="sparsecholesky")
        self.weights = [ng.LinearForm(o.density * test[1] * dx(body)).Assemble().vec for body in BODIES]
        self.elastic = [strain_energy(F_now.trans * F_now, o) * dx(body, intrules={ng.TRIG: ng.IntegrationRule(ng.TRIG, ORDER)})
                        for body in BODIES]
        strain = 0.5 * (Grad(trial) + Grad(trial).trans)
        linear = ng.BilinearForm(self.space, symmetric=True)
        linear += InnerProduct(o.lame_lambda * Trace(strain) * Id(2) + 2 * o.lame_mu * strain, Grad(test)) * dx
        linear += 2 * o.penalty * InnerProduct(trial, test) * ds("|".join(OUTLINES))
        self.linear = linear.Assemble().mat

    def highest_frequency(self) -> float:
        """An upper bound of the eigenfrequencies of the pair in contact [1/s], by power iteration.

        Motions are small, and either outline is supported by springs of stiffness 2 k.
        """
        mode, image = self.u.vec.CreateVector(), self.u.vec.CreateVector()
        image.SetRandom(1)
        for _ in range(60):
            mode.data = (1 / ng.Norm(image)) * image
            image.data = self.inverse * (self.linear * mode).Evaluate()
        return math.sqrt(ng.Norm(image))

    def contact_forces(self) -> tuple[float, float]:
        """Computes self.contact. Returns the normal force on the upper half body [N/m] and the
        potential [J/m]."""
        position, total, upwards, potential = self.reference + self.nodal(self.u.vec), np.zeros((2, self.space.ndof // 2)), 0.0, 0.0
        points = [np.einsum("ga,gai->gi", outline.N, position[outline.dofs]) for outline in self.outlines]
        near = points[0][:, 1] < points[1][:, 1].max(), points[1][:, 1] > points[0][:, 1].min()
        for role, (own, other) in enumerate((self.outlines, self.outlines[::-1])):
            which = np.flatnonzero(near[role])
            inside, edge, s, gap, normal = other.closest(points[role][which], position)
            which = which[inside]
            if np.any(which >= len(own.weight) - 4) or np.any(edge == len(other.edges) - 1):
                raise SystemExit("contact reaches the end of the fine outline")
            weight = 0.5 * own.weight[which]  # each role has half of the weight
            # The force on the point; its reaction acts on the edge.
            force = -(self.o.penalty * weight * gap)[:, None] * normal
            potential += self.o.penalty / 2 * (weight * gap ** 2).sum()
            upwards += (1 - 2 * role) * force[:, 1].sum()
            for component in range(2):
                np.add.at(total[component], own.dofs[which], own.N[which] * force[:, component, None])
                np.add.at(total[component], other.edges[edge], -other.shape(s) * force[:, component, None])
        self.contact.FV().NumPy()[:] = total.reshape(-1)
        return upwards, potential

    def accelerate(self) -> tuple[float, float]:
        """Computes the acceleration at u and advances the velocity by half a step, to the time of
        u.

        Returns the normal force [N/m] and the potential [J/m].
        """
        self.stress.Apply(self.u.vec, self.force)
        result = self.contact_forces()
        self.contact.data -= self.force
        self.acceleration.data = self.inverse * self.contact
        self.v.vec.data += self.dt / 2 * self.acceleration
        return result

    def advance(self):
        """Advances the velocity by half a step and the displacement by a whole step dt."""
        self.v.vec.data += self.dt / 2 * self.acceleration
        self.u.vec.data += self.dt * self.v.vec
        self.t += self.dt

    def velocities(self) -> list[float]:
        return [ng.InnerProduct(weight, self.v.vec) / mass for weight, mass in zip(self.weights, self.masses)]

    def state(self, force: float, potential: float) -> dict:
        """A row of the history for the whole bodies."""
        self.force.data = self.mass * self.v.vec
        twice = (self.force.FV().NumPy() * self.v.vec.FV().NumPy()).reshape(2, -1).sum(0)
        kinetic = twice[self.is_upper].sum(), twice[~self.is_upper].sum()
        elastic = [2 * ng.Integrate(energy, self.mesh) for energy in self.elastic]
        row = {"t": self.t, "normal_force": 2 * force, "velocity_upper": self.velocities()[0], "velocity_lower": self.velocities()[1],
               "kinetic_upper": kinetic[0], "kinetic_lower": kinetic[1], "elastic_upper": elastic[0], "elastic_lower": elastic[1],
               "contact_potential": 2 * potential}
        return row | {"total_energy": sum(list(row.values())[4:])}


class PairOfNGSolve(Pair):
    """Contact by NGSolve's ContactBoundary."""

    def assemble(self):
        super().assemble()
        trial = self.space.TrialFunction()
        self.pairs = ng.ContactBoundary(*(self.mesh.Boundaries(name) for name in OUTLINES))
        here = ng.CF((x, y)) + trial
        penetration = InnerProduct(here - ng.CF((x, y)).Other() - trial.Other(), self.pairs.normal)
        self.pairs.AddEnergy(IfPos(penetration, self.o.penalty / 2 * penetration ** 2, 0))
        self.springs = ng.BilinearForm(self.space, nonassemble=True)

    def contact_forces(self) -> tuple[float, float]:
        self.pairs.Update(self.u, self.springs, intorder=6, maxdist=0.2 * self.o.radius)
        self.springs.Apply(self.u.vec, self.contact)
        self.contact.data *= -1
        return self.nodal(self.contact)[self.is_upper_vertex, 1].sum(), 0.0


def march(pair: Pair) -> tuple[list[dict], np.ndarray, str]:
    """Integrates until some time after the contact.

    Returns the rows of the history, times and forces of all steps, and the reason of the end:
    "over" if the contact has ended.
    """
    o, rows, forces, last = pair.o, [], [], 0.0
    longest = 60 * o.radius * math.sqrt(o.density / o.young)
    while pair.t < max((1 + o.after) * last, 0.05 * longest) and pair.t < longest:
        force, potential = pair.accelerate()
        if not math.isfinite(force) or not math.isfinite(pair.acceleration[0]):
            return rows, np.array(forces), "not a number"
        last = pair.t if force else last
        forces.append((pair.t, 2 * force))
        if len(forces) % SAMPLE == 1:
            rows.append(pair.state(force, potential))
        pair.advance()
    return rows, np.array(forces), "over" if pair.t < longest else "contact too long"


def summary(pair: Pair, rows: list[dict], forces: np.ndarray, end: str) -> dict:
    """Results of the whole bodies. The energy drift is the largest among the rows."""
    t, force = forces.T
    strong, touching = np.flatnonzero(force > 0.01 * force.max()), np.flatnonzero(force)
    final, masses = rows[-1], [2 * mass for mass in pair.masses]
    vibration = {f"vibration_{body}": final[f"kinetic_{body}"] + final[f"elastic_{body}"] - mass / 2 * final[f"velocity_{body}"] ** 2
                 for body, mass in zip(BODIES, masses)}
    return {"end": end, "mass_upper": masses[0], "mass_lower": masses[1],
            "contact_time": t[touching[-1]] + pair.dt - t[touching[0]], "contact_time_1_percent": t[strong[-1]] - t[strong[0]],
            "impulse": pair.dt * force.sum(), "velocity_upper": final["velocity_upper"], "velocity_lower": final["velocity_lower"], **vibration,
            "energy_start": rows[0]["total_energy"],
            "energy_drift": max(abs(row["total_energy"] / rows[0]["total_energy"] - 1) for row in rows)}


def main():
    options = arguments()
    ng.SetNumThreads(1)
    start = time.process_time()
    pair = (Pair if options.contact == "two-sided" else PairOfNGSolve)(options)
    ready = time.process_time()
    rows, forces, end = march(pair)
    if options.history:
        table = np.array([list(row.values()) for row in rows])
        np.savetxt(options.history, table, delimiter=",", header=",".join(rows[0]), comments="", fmt="%.10g")
    print(json.dumps({"program": "ngsolve", "version": metadata.version("ngsolve"),
                      **{name: getattr(options, name) for name in ("contact", "law", "nu", "penalty", "refine")},
                      "dofs": pair.space.ndof, "dt": pair.dt, "steps": len(forces), **summary(pair, rows, forces, end),
                      "imports_seconds": start, "setup_seconds": ready - start, "cpu_seconds": time.process_time() - ready}))
    if end != "over":
        raise SystemExit(f"no answer: {end} at t = {pair.t:g} s")


if __name__ == "__main__":
    main()
