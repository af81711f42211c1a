"""V6: a cylinder pressed on the plane (hertz.edp): half-width and largest pressure of Hertz."""

import math
from collections.abc import Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from orchestrate.failure import Failure
from orchestrate.report.figures import BLACK, BLUE, ORANGE

from .case import Row
from .measure import measure

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


def cylinder(folder: Path) -> Iterator[Row]:
    for share in (0.3, 0.15, 0.075, 0.0375):
        yield from hertz(folder / f"{share:g}", share)


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
