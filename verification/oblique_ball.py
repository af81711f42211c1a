"""V17: oblique impact of a ball on the plane in three dimensions.

The limits are a rigid ball, and the elastic ball of Maw, Barber and Fawcett (1976). Agreement
within 5 % does not prove an error of 5 % where the elastic ball mostly sticks. At psi_1 = 0.6 the
lost slip 1 + beta is 1.4 % above theory for elements of half the contact radius, as here, but 6.9 %
for elements of a third of it: two errors partly cancel. In both cases the deviation falls with the
contact radius, as a power of it above 0.6, since a ball is not a half-space: 20.4, 6.9 and 1.4 %
at 0.2, 0.02 and 0.002 m/s, and 22, 12.2 and 6.9 % on the finer elements. At psi_1 = 1.2 it is 10.2,
5.1, 5.1 and 2.0 % at 0.2, 0.02, 0.01 and 0.002 m/s; the position of the elements on so small a
contact changes it by some per cent.
"""

import math
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import ArrayLike

from ffimpact.report.figures import BLACK, BLUE, GREY, ORANGE

from . import hertz
from .case import Row
from .measure import disc
from .rigid_disc import STIFF, leaves

# R^2/k^2 of a ball with the radius of gyration k.
INERTIA = 2.5
RADIUS = STIFF["radius"]
# A nearly rigid ball on the penalty. Its penetration is 1.3 % of the radius, about forty times the
# indentation by the pressure.
RIGID = STIFF | dict(penalty=3e10, law="neohookean", fields=0)
# Elastic ball. For nu near 1/2 a rigid plane acts as a plane of the same material.
NU, FRICTION, YOUNG, DENSITY = 0.45, 0.1, 7e6, 1722
MASS = 4 / 3 * math.pi * RADIUS**3 * DENSITY
ELASTIC = dict(kind="ball", law="neohookean", nu=NU, young=YOUNG, density=DENSITY, radius=RADIUS, accuracy=0.1, fields=0)
# v_n [m/s] for each psi, as small (and expensive) as the tolerance requires. Where the error is
# largest, two speeds test that it falls with the contact radius.
SPEEDS = {0.6: (0.2, 0.002), 1.2: (0.002,), 2.0: (0.02,), 3.0: (0.2,), 5.0: (0.2,)}


def rigid(folder: Path, angle: float, friction: float, **more) -> tuple[dict, float, float, float]:
    """The summary of an impact at 1 m/s at this angle [degrees] to the plane.

    Also returns the initial speeds along and across the plane, and mu (1 + e) v_n/v_t.
    """
    summary = disc(folder, "ball", **RIGID | dict(angle=angle, friction_static=friction) | more).summary
    along, across = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    return summary, along, across, friction * (across + summary["rebound_vy"]) / along


def springs(psi: ArrayLike, nu: float) -> np.ndarray:
    """The share 1 + beta of the slip v_s that an elastic ball loses and regains in the other
    direction, beta = -v_s'/v_s.

    The argument is psi = 2 (1 - nu) v_s/(mu (2 - nu) v_n) > 0, a number or an array of any shape.

    Theory of Maw, Barber and Fawcett: Hertz in the normal direction, partial slip of Cattaneo and
    Mindlin along the plane. Both follow from a row of independent springs under a parabola x^2/R
    (Popov, Hess 2015), with the stiffness E* dx along the normal and G* dx along the plane, G*/E* =
    2 (1 - nu)/(2 - nu), each with Coulomb's law. The springs carry the ball. In units in which R,
    E* and the mass are 1, v_n is small: 10^-3.
    """
    normal, friction, count, steps = 1e-3, 0.1, 400, 6000
    ratio = 2 * (1 - nu) / (2 - nu)
    start = np.asarray(psi, dtype=float) * friction * normal / ratio
    slip, speed, depth = start, normal, 0.0
    deepest = (15 / 16 * normal**2) ** 0.4
    dt = 1.2 * 2.87 * normal**-0.2 / steps
    x = 1.05 * math.sqrt(deepest) * (np.arange(count) + 0.5) / count
    width, stretched = 2 * (x[1] - x[0]), np.zeros((*start.shape, count))  # both halves of the row
    while depth >= 0:
        depth += dt * speed
        pressed = np.maximum(depth - x**2, 0)
        limit = friction * pressed / ratio
        stretched = np.clip(stretched + dt * slip[..., None], -limit, limit)
        speed -= dt * width * pressed.sum()
        slip = slip - dt * width * ratio * stretched.sum(axis=-1) * (1 + INERTIA)
    return 1 - slip / start


def slides_throughout(psi: ArrayLike, nu: float, inertia: ArrayLike = INERTIA) -> ArrayLike:
    """Whether the ball slides throughout by theory: psi_1 > 4 chi - 1, chi = (1 - nu)(1 +
    R^2/k^2)/(2 - nu).

    `inertia` is R^2/k^2.
    """
    return psi > 4 * (1 - nu) * (1 + inertia) / (2 - nu) - 1


def lost_slip(folder: Path, psi: float, normal: float, **more) -> tuple[float, dict]:
    """1 + beta of the elastic ball in three dimensions with v_n = `normal` [m/s], and the summary
    of the run."""
    start = psi * FRICTION * (2 - NU) / (2 * (1 - NU)) * normal
    flags = dict(speed=math.hypot(start, normal), angle=math.degrees(math.atan2(normal, start)), friction_static=FRICTION, slip_velocity=1e-3 * normal)
    summary = disc(folder, **ELASTIC | flags | more).summary
    return 1 - (summary["rebound_vx"] + RADIUS * summary["rebound_spin"]) / start, summary


def elastic(folder: Path, psi: float) -> Iterator[Row]:
    """Lost slip over the largest contact radius over the ball radius."""
    for normal in SPEEDS[psi]:
        *_, radius = hertz.impact(MASS, RADIUS, YOUNG / (1 - NU**2), normal)
        lost = lost_slip(folder / f"{psi:g}", psi, normal)[0]
        with (folder / f"elastic-{psi:g}.csv").open("a") as table:
            table.write(f"{psi},{normal},{lost}\n")
        yield Row(f"ψ₁ = {psi:g}: slip", radius / RADIUS, lost, float(springs(psi, NU)))


def stiff(folder: Path, angle: float) -> Iterator[Row]:
    """Speed and spin over the radius of the intersection of plane and ball at the largest depth,
    over the ball radius."""
    depth = (3 * MASS / (2 * math.pi * RADIUS * RIGID["penalty"])) ** (1 / 3)
    summary, along, _, lost = rigid(folder / f"rigid-{angle:g}", angle, 0.2)
    (centre, rim), words, size = leaves(lost, INERTIA), f"rigid, {angle}°", math.sqrt(2 * depth / RADIUS)
    yield Row(f"{words}: speed", size, summary["rebound_vx"] / along, centre)
    yield Row(f"{words}: spin", size, -summary["rebound_spin"] * RADIUS / along, rim)


# The impacts can run at the same time.
REBOUNDS = (*(partial(elastic, psi=psi) for psi in SPEEDS), *(partial(stiff, angle=angle) for angle in (20, 60)))


def curve(axes: plt.Axes, folder: Path) -> None:
    """Draws beta over psi_1: theory and runs."""
    psi = np.linspace(0.1, 6, 40)
    axes.plot(psi, springs(psi, NU) - 1, color=BLACK, linewidth=1, label="theory")
    runs = np.concatenate([np.loadtxt(path, delimiter=",", ndmin=2) for path in sorted(folder.glob("elastic-*.csv"))])
    for normal, colour in zip(sorted(set(runs[:, 1]), reverse=True), (GREY, ORANGE, BLUE)):
        points = runs[runs[:, 1] == normal]
        axes.plot(points[:, 0], points[:, 2] - 1, "o", color=colour, markersize=4.5, label=f"{normal:g} m/s")
    axes.axhline(0, color=BLACK, linewidth=0.6)
    axes.set(xlabel="$\\psi_1$", ylabel="$\\beta$")
    axes.legend()
