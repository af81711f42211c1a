"""Contact and impact of Hertz.

V6: a cylinder and a ball are pressed on the plane (hertz.edp); V7: impact of a ball on the plane;
V15: impact of two balls of revolution.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from ffimpact.failure import Failure
from ffimpact.report.figures import BLACK, BLUE, ORANGE

from .case import Row
from .measure import Outcome, bodies, disc, impact as impact_of_ball, measure

BALL = dict(law="neohookean", young=1e8, nu=0.3, density=2500, radius=0.01)
NARROW = 0.005  # half-width b over the radius, for a small load


def hertz(folder: Path, share: float, law: str = "neohookean", nu: float = 0.3, body: str = "cylinder") -> Iterator[Row]:
    """V6: half-width and largest pressure of the fitted ellipse for a cylinder or ball of radius 1
    and E = 1 on the plane.

    Elements have the size share * b = h. The penalty k = 10 E*/h grows with refinement, so that its
    error is of first order as the others. Raises Failure if the body is not at rest.
    """
    folder.mkdir(parents=True, exist_ok=True)
    stiffness, ball = 1 / (1 - nu**2), body == "ball"
    load = 4 / 3 * stiffness * NARROW**3 if ball else math.pi * stiffness * NARROW**2 / 4
    numbers = measure("hertz-ball" if ball else "hertz", law=law, young=1, nu=nu, density=1, radius=1, speed=0,
                      gravity=load / (4 / 3 * math.pi if ball else math.pi), dt=20, integrator="backward-euler",
                      penalty=10 * stiffness / (share * NARROW), end_time=1200, mesh_size=0.2, contact_mesh_size=share * NARROW, out=folder)
    if abs(numbers["imbalance"]) > 1e-6 or numbers["kinetic"] > 1e-9:
        raise Failure("hertz: not at rest")
    yield Row(f"{body}: half-width b", share, numbers["width"], NARROW, 1)
    yield Row(f"{body}: pressure p₀", share, numbers["peak"], peak(nu, body), 1)


def peak(nu: float, body: str = "cylinder") -> float:
    """Hertz' p0 for the half-width b = NARROW: b E*/(2 R) for a cylinder, 2 b E*/(pi R) for a ball.
    """
    return NARROW / (1 - nu**2) * (2 / math.pi if body == "ball" else 0.5)


def profile(folder: Path, share: float, nu: float = 0.3, body: str = "cylinder") -> Iterator[Row]:
    """Errors of the tractions in `folder`, written by hertz(), relative to the exact ellipse p = p0
    sqrt(1 - (x/b)^2), over p0.

    Returns the root mean square of the difference over |x| < b, and its maximum over the contact
    points with |x| < 0.9 b, since the exact slope is infinite at the end.
    """
    rows = pd.read_csv(folder / "pressure.csv")
    inside = rows[rows.x < NARROW]
    off = inside.p / peak(nu, body) - np.sqrt(1 - (inside.x / NARROW) ** 2)
    yield Row(f"{body}: mean error", share, math.sqrt(np.average(off**2, weights=inside.length)), 0, 1)
    yield Row(f"{body}: error in 0.9 b", share, abs(off[inside.x < 0.9 * NARROW]).max(), 0, 1)


def pressed(folder: Path) -> Iterator[Row]:
    for body in ("cylinder", "ball"):
        for share in (0.3, 0.15, 0.075, 0.0375):
            yield from hertz(folder / body / f"{share:g}", share, body=body)
            yield from profile(folder / body / f"{share:g}", share, body=body)


def ellipse(axes: plt.Axes, folder: Path) -> None:
    """Draws the tractions at the contact points of the cylinder on the coarsest and the finest
    mesh, and the exact ellipse."""
    sizes = sorted((float(path.name) for path in (folder / "cylinder").iterdir()), reverse=True)
    x = np.linspace(0, 1, 400)
    axes.plot(x, np.sqrt(1 - x**2), color=BLACK, linewidth=1, label="exact")
    for size, colour, marker in ((sizes[0], ORANGE, "s"), (sizes[-1], BLUE, ".")):
        rows = pd.read_csv(folder / f"cylinder/{size:g}/pressure.csv").sort_values("x")
        axes.plot(rows.x / NARROW, rows.p / peak(0.3), color=colour, marker=marker, markersize=4, linestyle="none",
                  label=f"elements of {size:g} b")
    axes.set(xlabel="$x/b$", ylabel="$p/p_0$", xlim=(0, 1.4), ylim=(-0.03, 1.15))
    axes.legend(loc="upper right")


def impact(mass: float, radius: float, stiffness: float, speed: float) -> tuple[float, float, float]:
    """Hertz' impact of a mass [kg] on a plane: contact time [s], largest force [N], contact radius
    [m].

    For two bodies, the arguments are the reduced mass and radius and the stiffness E* [Pa] of the
    pair.
    """
    depth = (15 * mass * speed**2 / (16 * stiffness * math.sqrt(radius))) ** 0.4
    return 2.868 * (mass**2 / (radius * stiffness**2 * speed)) ** 0.2, 4 / 3 * stiffness * math.sqrt(radius) * depth**1.5, math.sqrt(radius * depth)


def ball(folder: Path, speed: float, **more) -> Iterator[Row]:
    """A ball on the plane, over contact radius / ball radius. Hertz' half-space is the limit; the
    difference is of first order."""
    return _compare("ball", disc(folder, kind="ball-axisymmetric", speed=speed, **(BALL | more)), speed, 1, BALL | more)


def balls(folder: Path, speed: float, **more) -> Iterator[Row]:
    """Central impact of two equal balls that approach each other at this speed."""
    entries = BALL | more
    at = 1.0001 * entries["radius"]
    pair = [{"name": name, "shape": "ball", "radius": entries["radius"], "position": side * at, "velocity": -side * speed / 2}
            for name, side in (("upper", 1), ("lower", -1))]
    tables = impact_of_ball("ball-axisymmetric", **{name: value for name, value in entries.items() if name != "radius"})
    result = bodies(folder, {name: value for name, value in tables.items() if name != "obstacle"} | {"body": pair})
    return _compare("two balls", result, speed, 0.5, entries)


def _compare(what: str, result: Outcome, speed: float, share: float, properties: dict) -> Iterator[Row]:
    """Compares a run with impact(). `share` is 1 for a ball on the plane, and 1/2 for two balls,
    whose mass, radius and E* are halved."""
    mass = 4 / 3 * math.pi * properties["radius"] ** 3 * properties["density"]
    time, force, width = impact(share * mass, share * properties["radius"],
                                share * properties["young"] / (1 - properties["nu"] ** 2), speed)
    size = width / properties["radius"]
    yield Row(f"{what}: contact time", size, result.summary["contact_time"], time, 1)
    yield Row(f"{what}: largest force", size, result.summary["peak_force"], force, 1)


def impacts(folder: Path) -> Iterator[Row]:
    for speed in (1, 0.1, 0.01, 0.001):
        yield from ball(folder / f"ball-{speed:g}", speed)
        yield from balls(folder / f"balls-{speed:g}", speed)
