"""V1: manufactured motions at large strain, whose loads are worked out from the motion (manufactured.edp, manufactured-disc.edp, manufactured-axisymmetric.edp)."""

from collections.abc import Iterator
from pathlib import Path

from .case import LAWS, Row
from .measure import measure

SOFT = dict(young=10, density=1, nu=0.3, radius=1)
ORDERS = {"energy-momentum": 2, "midpoint": 2, "newmark": 2, "bdf2": 2, "backward-euler": 1}   # of the integrators


def square(law: str, degree: int, h: float) -> Row:
    """L2 error of the displacement, relative, on the square with elements of size h and a step whose error is far smaller: order degree + 1."""
    found = measure("manufactured", law=law, degree=degree, mesh_size=h, dt=0.0025, end_time=0.025, tolerance=1e-12, **SOFT)
    return Row(f"P{degree}: {LAWS[law]}", h, found["error"], 0, degree + 1)


def disc(law: str, h: float, body: str = "disc") -> dict[str, float]:
    """What manufactured-disc.edp prints, or with body = "axisymmetric" of a ball, P2 on curved elements: its error falls with h^3."""
    return measure(f"manufactured-{body}", law=law, mesh_size=h, dt=0.005, end_time=0.025, tolerance=1e-12, **SOFT)


def step(integrator: str, law: str, dt: float) -> Row:
    """L2 error of the displacement, relative, for a motion that the elements hold exactly."""
    found = measure("manufactured", law=law, degree=2, mesh_size=0.5, dt=dt, end_time=0.4, tolerance=1e-13, integrator=integrator,
                    breakdown="continue", **SOFT)
    return Row(f"{integrator}: {LAWS[law]}", dt, found["error"], 0, ORDERS[integrator])


def in_space(folder: Path) -> Iterator[Row]:
    """On the square (P1, P2), and on disc and ball with curved elements (P2)."""
    for degree in (1, 2):
        for law in LAWS:
            for h in (0.25, 0.125, 0.0625):
                yield square(law, degree, h)
    for law, name in LAWS.items():
        for h in (0.5, 0.25, 0.125):
            yield Row(f"P2, disc: {name}", h, disc(law, h)["error"], 0, 3)
            yield Row(f"P2, ball: {name}", h, disc(law, h, "axisymmetric")["error"], 0, 3)


def in_time(folder: Path) -> Iterator[Row]:
    """With every implicit integrator."""
    for integrator, order in ORDERS.items():
        for law in LAWS:
            for dt in ((0.02, 0.01, 0.005) if order == 2 else (0.005, 0.0025, 0.00125)):
                yield step(integrator, law, dt)
