"""The common part of the other programs: flags, mesh of the half disc, time loop and line of JSON.

The problem is the scene disc-normal, ball-axisymmetric or ball: half of a body or less, by
symmetry, falls on the rigid plane y = 0. The traction is t_N = k max(0, -gap) per unit reference
area, the step is energy-momentum with constant dt. SI units, for the disc per metre of thickness. A
program provides a Model; `march` runs it until the contact has been over for a tenth of its
duration.
"""

import argparse
import json
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from ffimpact.mesh import mesh  # noqa: E402

LONGEST = 20e-3  # [s]; no contact of these bodies lasts longer


class Model(Protocol):
    """Half of the body in another program. Its state is at the end of the last step."""

    program: str
    version: str
    dofs: int
    newton_iterations: int
    factorizations: int

    def step(self) -> float:
        """Advances by dt. Returns the mean normal force on the HALF body in this step [N/m; N].
        Raises StepFailed."""

    def penetration(self) -> float:
        """The largest -gap of the quadrature points of contact [m]. It is negative in flight."""

    def energy(self) -> float:
        """Kinetic, elastic and contact energy of the HALF body [J/m; J]."""

    def velocity(self) -> float:
        """Mean of v_y over the mass [m/s]."""

    def reported(self) -> dict[str, float]:
        """Further results that are printed."""


class StepFailed(Exception):
    """Newton's method did not converge, or a stress is not a number."""


def small(work: float, accepted: float) -> bool:
    """Whether Newton's method has converged: the work of the residual is at most `accepted` [J/m;
    J].

    Raises StepFailed if the work is not finite.
    """
    if not math.isfinite(work):
        raise StepFailed("a stress is not a number")
    return abs(work) <= accepted


def arguments(program: str, forms: tuple[str, ...], scene: str = "disc-normal",
              more: dict[str, tuple[float, str]] | None = None) -> argparse.Namespace:
    """Parses the flags of all programs and those of `more`. Adds lame_lambda and lame_mu [Pa]."""
    parser = argparse.ArgumentParser(description=f"{scene} with {program}; ends with a line of JSON")
    parser.add_argument("--form", choices=forms, default="tuned", help="how the program is used (default tuned)")
    parser.add_argument("--mesh", type=Path, help="mesh of the half disc (.msh of ffimpact.mesh.mesh) in place of sizes")
    numbers = {"mesh-size": (8e-3, "m"), "contact-mesh-size": (2.5e-3, "m"), "dt": (2e-5, "s"), "nu": (0.45, "-"),
               "speed": (8.0, "m/s"), "penalty": (1e10, "Pa/m"), "young": (7e6, "Pa"), "density": (1722.0, "kg/m3"),
               "radius": (0.05, "m"), "tolerance": (5e-12, "largest work of the residual in a step, over the energy")}
    parser.add_argument("--law", choices=("svk", "neohookean"), default="svk")
    parser.add_argument("--history", type=Path, help="writes t,normal_force there: whole body, mean of the step that ends at t")
    return with_numbers(parser, numbers | (more or {}))


def with_numbers(parser: argparse.ArgumentParser, numbers: dict[str, tuple[float, str]]) -> argparse.Namespace:
    """Parses the flags of `parser` and of `numbers`, name: (default, unit). Adds lame_lambda and
    lame_mu [Pa]."""
    for name, (default, unit) in numbers.items():
        parser.add_argument(f"--{name}", type=float, default=default, help=f"[{unit}] (default {default:g})")
    options = parser.parse_args()
    options.lame_lambda = options.nu * options.young / ((1 + options.nu) * (1 - 2 * options.nu))
    options.lame_mu = options.young / (2 * (1 + options.nu))
    return options


def half_disc(options: argparse.Namespace) -> mesh.Mesh:
    """The mesh of the flag --mesh, or a mesh with the prescribed sizes (needs gmsh)."""
    if options.mesh:
        return mesh.read(options.mesh)
    return mesh.disc(options.radius, options.mesh_size, options.contact_mesh_size, half=True)


def middles(half: mesh.Mesh, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """The middle nodes of curved P2 triangles.

    Returns their points (m, 2), where those of the circle lie on it, and the middle nodes of each
    triangle (t, 3), in the order of its sides 12, 23, 31.
    """
    a, b, c = half.triangles.T
    pairs = np.vstack([np.column_stack(pair) for pair in ((a, b), (b, c), (c, a))] + [half.edges])
    edges, which = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    which = which.reshape(-1)
    points = half.points[edges].mean(axis=1)
    on_circle = np.unique(which[3 * len(half.triangles):][half.labels == mesh.FREE])
    rays = points[on_circle] - (0.0, radius)
    points[on_circle] = (0.0, radius) + radius * rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return points, which[:3 * len(half.triangles)].reshape(3, -1).T


def main(build: Callable[[argparse.Namespace], Model], options: argparse.Namespace) -> None:
    """Builds the model and runs it. If a step fails, prints one line and exits with code 11, as our
    runs do."""
    imports = time.process_time()
    try:
        model = build(options)
        march(model, options, {"imports_seconds": imports, "setup_seconds": time.process_time() - imports})
    except StepFailed as failure:
        print(failure, file=sys.stderr)
        raise SystemExit(11) from None


def march(model: Model, options: argparse.Namespace, before_it: dict[str, float]) -> None:
    """Integrates from the onset of contact (t = 0) until the contact is over; prints the line of
    JSON, writes the history.

    Contact begins and ends where the largest penetration, linear within a step, is zero.
    `wall_seconds` and `cpu_seconds` contain the steps only; `before_it` holds the processor seconds
    of imports and set-up.
    """
    dt, t, first, last = options.dt, 0.0, None, None
    rows, energy0, drift, before = [], model.energy(), 0.0, model.penetration()
    wall = cpu = 0.0
    while (last is None or t < last + 0.1 * (last - first)) and t < LONGEST:
        start = time.perf_counter(), time.process_time()
        force = 2 * model.step()
        after = model.penetration()
        wall, cpu = wall + time.perf_counter() - start[0], cpu + time.process_time() - start[1]
        if first is None and after > 0:
            first = t if before >= 0 else t - dt * before / (after - before)
        if after <= 0 < before:
            last = t + dt * before / (before - after)
        elif after > 0:
            last = None
        t += dt
        before = after
        rows.append((t, force))
        if len(rows) % 10 == 0 or last is not None:
            drift = max(drift, abs(model.energy() / energy0 - 1))
    forces = np.array([force for _, force in rows])
    if options.history:
        np.savetxt(options.history, rows, delimiter=",", header="t,normal_force", comments="", fmt="%.17g")
    print(json.dumps({
        "program": model.program, "version": model.version, "form": options.form, "dofs": model.dofs, "steps": len(rows),
        "contact_time": last - first if last is not None else None, **model.reported(), "impulse": dt * forces.sum(), "rebound_vy": model.velocity(),
        "peak_force": forces.max(), "energy_drift": drift, "wall_seconds": wall, "cpu_seconds": cpu,
        **before_it, "newton_iterations": model.newton_iterations, "factorizations": model.factorizations}))
