"""V1: manufactured motions at large strain. Their loads are computed from the motion.

The scripts are manufactured.edp, manufactured-disc.edp and manufactured-axisymmetric.edp.
"""

from collections.abc import Iterator
from pathlib import Path

from .case import LAWS, Row
from .measure import measure

SOFT = dict(young=10, density=1, nu=0.3, radius=1)
# Orders of the integrators.
ORDERS = {"energy-momentum": 2, "midpoint": 2, "bdf2": 2, "backward-euler": 1}


def square(law: str, degree: int, h: float) -> Row:
    """Relative L2 error of the displacement on the square for elements of size h; expected order
    degree + 1. The error of the step is far smaller."""
    numbers = measure("manufactured", law=law, degree=degree, mesh_size=h, dt=0.0025, end_time=0.025, tolerance=1e-12, **SOFT)
    return Row(f"P{degree}: {LAWS[law]}", h, numbers["error"], 0, degree + 1)


def disc(law: str, h: float, body: str = "disc") -> dict[str, float]:
    """The numbers that manufactured-disc.edp prints; with body = "axisymmetric" those for a ball.

    The elements are curved and of degree 2. The expected error falls with h^3.
    """
    return measure(f"manufactured-{body}", law=law, mesh_size=h, dt=0.005, end_time=0.025, tolerance=1e-12, **SOFT)


def step(integrator: str, law: str, dt: float) -> Row:
    """Relative L2 error of the displacement for a motion that the elements represent exactly."""
    numbers = measure("manufactured", law=law, degree=2, mesh_size=0.5, dt=dt, end_time=0.4, tolerance=1e-13, integrator=integrator,
                      breakdown="continue", **SOFT)
    return Row(f"{integrator}: {LAWS[law]}", dt, numbers["error"], 0, ORDERS[integrator])


def in_space(folder: Path) -> Iterator[Row]:
    """Errors over the element size on the square (P1, P2), and on disc and ball with curved P2
    elements."""
    for degree in (1, 2):
        for law in LAWS:
            for h in (0.25, 0.125, 0.0625):
                yield square(law, degree, h)
    for law, name in LAWS.items():
        for h in (0.5, 0.25, 0.125):
            yield Row(f"P2, disc: {name}", h, disc(law, h)["error"], 0, 3)
            yield Row(f"P2, ball: {name}", h, disc(law, h, "axisymmetric")["error"], 0, 3)


def in_time(folder: Path) -> Iterator[Row]:
    """Errors over the step for all implicit integrators."""
    for integrator, order in ORDERS.items():
        for law in LAWS:
            for dt in ((0.02, 0.01, 0.005) if order == 2 else (0.005, 0.0025, 0.00125)):
                yield step(integrator, law, dt)
