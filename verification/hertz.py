"""Hertz: V6, a cylinder pressed on the plane (hertz.edp); V7, the impact of a ball on it; V15, of two balls (two-balls.edp)."""

import math
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from orchestrate.failure import Failure
from orchestrate.report.figures import BLACK, BLUE, ORANGE

from .case import Row
from .measure import Outcome, disc, measure, outcome

BALL = dict(law="neohookean", young=1e8, nu=0.3, density=2500, radius=0.01)
NARROW = 0.005              # half-width b over the radius: the small load


def hertz(folder: Path, share: float, law: str = "neohookean", nu: float = 0.3) -> Iterator[Row]:
    """A cylinder of radius 1 and E = 1 on the plane, elements of share * b: half-width and largest pressure of the fitted
    ellipse. The penalty grows as they shrink, k = 10 E*/h: what it gives way is an error of first order like the others."""
    folder.mkdir(parents=True, exist_ok=True)
    stiffness = 1 / (1 - nu**2)
    load = math.pi * stiffness * NARROW**2 / 4
    found = measure("hertz", law=law, young=1, nu=nu, density=1, radius=1, speed=0, gravity=load / math.pi, dt=20,
                    integrator="backward-euler", penalty=10 * stiffness / (share * NARROW), mesh_size=0.2,
                    contact_mesh_size=share * NARROW, out=folder)
    if abs(found["imbalance"]) > 1e-6 or found["kinetic"] > 1e-9:
        raise Failure("hertz: not at rest")
    yield Row("half-width b", share, found["width"], NARROW, 1)
    yield Row("largest pressure p₀", share, found["peak"], math.sqrt(load * stiffness / math.pi), 1)


def profile(folder: Path, share: float, nu: float = 0.3) -> Iterator[Row]:
    """Of the tractions that hertz() has left in `folder`, against the exact ellipse p = p0 sqrt(1 - (x/b)^2), over p0: root of the mean square
    of the difference over |x| < b, and the largest one at any contact point with |x| < 0.9 b (at its end the exact slope is infinite)."""
    rows, peak = pd.read_csv(folder / "pressure.csv"), NARROW / (2 * (1 - nu**2))
    inside = rows[rows.x < NARROW]
    off = inside.p / peak - np.sqrt(1 - (inside.x / NARROW) ** 2)
    yield Row("profile: mean", share, math.sqrt(np.average(off**2, weights=inside.length)), 0, 1)
    yield Row("profile: largest in 0.9 b", share, abs(off[inside.x < 0.9 * NARROW]).max(), 0, 1)


def cylinder(folder: Path) -> Iterator[Row]:
    for share in (0.3, 0.15, 0.075, 0.0375):
        yield from hertz(folder / f"{share:g}", share)
        yield from profile(folder / f"{share:g}", share)


def ellipse(axes: plt.Axes, folder: Path) -> None:
    """The tractions at the contact points over x, for the coarsest and finest mesh, and the exact ellipse."""
    sizes = sorted((float(path.name) for path in folder.iterdir()), reverse=True)
    peak = NARROW / (2 * (1 - 0.3**2))
    x = np.linspace(0, 1, 400)
    axes.plot(x, np.sqrt(1 - x**2), color=BLACK, linewidth=1, label="exact")
    for size, colour, marker in ((sizes[0], ORANGE, "s"), (sizes[-1], BLUE, ".")):
        rows = pd.read_csv(folder / f"{size:g}/pressure.csv").sort_values("x")
        axes.plot(rows.x / NARROW, rows.p / peak, color=colour, marker=marker, markersize=4, linestyle="none",
                  label=f"elements of {size:g} b")
    axes.set(xlabel="$x/b$", ylabel="$p/p_0$", xlim=(0, 1.4), ylim=(-0.03, 1.15))
    axes.legend(loc="upper right")


def impact(mass: float, radius: float, stiffness: float, speed: float) -> tuple[float, float, float]:
    """Hertz' impact of a mass [kg] on a plane, or of two with their reduced mass, radius and stiffness E* [Pa]: contact time [s], largest
    force [N], radius of the contact [m]."""
    depth = (15 * mass * speed**2 / (16 * stiffness * math.sqrt(radius))) ** 0.4
    return 2.868 * (mass**2 / (radius * stiffness**2 * speed)) ** 0.2, 4 / 3 * stiffness * math.sqrt(radius) * depth**1.5, math.sqrt(radius * depth)


def ball(folder: Path, speed: float, **more) -> Iterator[Row]:
    """A ball on the plane over the contact's radius beside its own: Hertz' half-space is its limit, the difference of first order."""
    return _compare("ball", disc(folder, script="ball-axisymmetric", speed=speed, **(BALL | more)), speed, 1, BALL | more)


def balls(folder: Path, speed: float, **more) -> Iterator[Row]:
    """Two equal balls that approach with this speed, head-on."""
    measure("two-balls", speed=speed, out=folder, **(BALL | more))
    return _compare("two balls", outcome(folder), speed, 0.5, BALL | more)


def _compare(what: str, found: Outcome, speed: float, share: float, of: dict) -> Iterator[Row]:
    """share: 1 of a ball on the plane, 1/2 of two, whose mass, radius and E* are halved."""
    mass = 4 / 3 * math.pi * of["radius"] ** 3 * of["density"]
    time, force, width = impact(share * mass, share * of["radius"], share * of["young"] / (1 - of["nu"] ** 2), speed)
    size = width / of["radius"]
    yield Row(f"{what}: contact time", size, found.summary["contact_time"], time, 1)
    yield Row(f"{what}: largest force", size, found.summary["peak_force"], force, 1)


def impacts(folder: Path) -> Iterator[Row]:
    for speed in (1, 0.1, 0.01, 0.001):
        yield from ball(folder / f"ball-{speed:g}", speed)
        yield from balls(folder / f"balls-{speed:g}", speed)
