"""Partial slip of Cattaneo and Mindlin: a cylinder is pressed on the plane, then sheared below
gross slip (cattaneo.edp).

It sticks in |x| < c and slips in the strips c < |x| < b: c = b sqrt(1 - Q/(mu P)), q = mu p0
[sqrt(1 - x^2/b^2) - (c/b) sqrt(1 - x^2/c^2)].
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from ffimpact.failure import Failure
from ffimpact.mesh import mesh
from ffimpact.report.figures import BLACK, BLUE, GREY, ORANGE

from .case import Row
from .measure import measure

# WIDTH is the intended half-width b over the radius. R = E = rho = 1.
NU, FRICTION, WIDTH = 0.45, 0.1, 0.02
STIFFNESS = 1 / (1 - NU**2)
# Displacement of the plane for this half-width [m].
DEPTH = WIDTH**2 / 4 * (2 * math.log(4 / WIDTH) - 1)
# Speed of the plane [m/s], number of steps and their length [s].
SPEED, STEPS, STEP = 4e-7, 10, 20.0
CREEP = 3e-3  # slip velocity over the speed of the plane
SHARES = (0.2, 0.1, 0.05)


def held(path: Path, share: float) -> None:
    """Writes a disc of radius 1 with elements of share * b near contact. The upper half of the
    circle is clamped."""
    disc = mesh.disc(1, 0.2, share * WIDTH, half=False, contact_arc=1.5 * WIDTH)
    upper = disc.points[disc.edges].mean(axis=1)[:, 1] > 1
    mesh.write(replace(disc, labels=np.where(upper, 3, 1)), path)


def sheared(folder: Path, share: float) -> tuple[dict[str, float], pd.DataFrame]:
    """The numbers that cattaneo.edp prints, and the tractions.

    The penalty is inversely proportional to the element size, as in V6. Raises Failure if the disc
    is not at rest.
    """
    folder.mkdir(parents=True, exist_ok=True)
    held(folder / "disc.msh", share)
    numbers = measure("cattaneo", mesh=folder / "disc.msh", law="neohookean", young=1, nu=NU, density=1, radius=1, height=DEPTH, speed=SPEED, dt=STEP,
                      end_time=STEPS * STEP, integrator="backward-euler", friction_static=FRICTION, slip_velocity=CREEP * SPEED,
                      penalty=10 * STIFFNESS / (share * WIDTH), out=folder)
    if numbers["state"] or numbers["kinetic"] > 1e-6:
        raise Failure("cattaneo: not at rest")
    return numbers, pd.read_csv(folder / "tractions.csv")


def exact(x: np.ndarray, b: float, c: float) -> np.ndarray:
    """The exact tangential traction q/(mu p0)."""
    return np.sqrt(np.maximum(1 - (x / b) ** 2, 0)) - c / b * np.sqrt(np.maximum(1 - (x / c) ** 2, 0))


def widths(numbers: dict[str, float]) -> tuple[float, float, float]:
    """b and c [m], and p0 [Pa], for the computed forces P and Q."""
    b = 2 * math.sqrt(numbers["normal"] / (math.pi * STIFFNESS))
    return b, b * math.sqrt(1 - numbers["along"] / (FRICTION * numbers["normal"])), 2 * numbers["normal"] / (math.pi * b)


def by_edge(table: pd.DataFrame, b: float, c: float, p0: float) -> pd.DataFrame:
    """Means over each edge of x, q/(mu p0) and its exact value, and the lengths of the edges.

    An edge has three contact points. Its degrees of freedom cannot make all of them stick, so that
    they share the traction at random.
    """
    at = table.assign(q=table.q / (FRICTION * p0), exact=exact(table.x, b, c))
    sums = at[["x", "q", "exact"]].mul(at.length, axis=0).assign(length=at.length).groupby(at.edge).sum()
    return sums[["x", "q", "exact"]].div(sums.length, axis=0).assign(length=sums.length).sort_values("x")


def annulus(folder: Path, share: float) -> Iterator[Row]:
    """Half of the length that sticks, |v_T| < slip_velocity, over c; and the root mean square error
    of q in |x| < b over mu p0."""
    numbers, table = sheared(folder, share)
    b, c, p0 = widths(numbers)
    edges = by_edge(table, b, c, p0)
    yield Row("stick half-width c", share, table.length[table.v.abs() < CREEP * SPEED].sum() / 2, c, 1)
    yield Row("mean error of q", share, math.sqrt(np.average((edges.q - edges.exact) ** 2, weights=edges.length)), 0, 1)


def annuli(folder: Path) -> Iterator[Row]:
    for share in SHARES:
        yield from annulus(folder / f"{share:g}", share)


def shear(axes: plt.Axes, folder: Path) -> None:
    """Draws q and mu p over x on the finest mesh, edge by edge, and the exact curves."""
    table = pd.read_csv(folder / f"{SHARES[-1]:g}/tractions.csv")
    b, c, p0 = widths({"normal": (table.p * table.length).sum(), "along": (table.q * table.length).sum()})
    x, edges = np.linspace(-b, b, 801), by_edge(table, b, c, p0)
    axes.plot(x / b, np.sqrt(1 - (x / b) ** 2), color=GREY, linewidth=1, label="$\\mu p$ of Hertz")
    axes.plot(x / b, exact(x, b, c), color=BLACK, linewidth=1, label="exact")
    axes.plot(edges.x / b, edges.q, ".", color=BLUE, markersize=4, label=f"elements of {SHARES[-1]:g} b")
    for edge in (-c, c):
        axes.axvline(edge / b, color=ORANGE, linewidth=0.8, linestyle="--", label="$c$" if edge > 0 else None)
    axes.set(xlabel="$x/b$", ylabel="$q/(\\mu p_0)$", ylim=(0, 1.1))
    axes.legend(loc="lower center", fontsize=7)
