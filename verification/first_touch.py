"""V18: the first microseconds of the impact of a disc on the plane.

As long as the contact spreads faster than waves, every column above it is a bar of its own on a
wall. The pressure is rho U v over the half-width b = sqrt(2 R v t), hence F = 2 rho U v b, until t
= R v/(2 c_L^2). U is the speed of the plane shock, rho U v = -P(1 - v/U), where P(lambda) is the
nominal stress of a column that is compressed to lambda without lateral strain. For small v, U =
c_L.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ffimpact.mesh import mesh, revolution
from ffimpact.report.figures import BLACK, BLUE, ORANGE

from .case import Row
from .measure import disc, outcome

RADIUS, YOUNG, NU, DENSITY = 0.05, 7e6, 0.45, 1722  # the rubber of the paper
LAME, SHEAR = YOUNG * NU / ((1 + NU) * (1 - 2 * NU)), YOUNG / (2 * (1 + NU))
WAVE = math.sqrt((LAME + 2 * SHEAR) / DENSITY)  # c_L [m/s]
SPEEDS = (8, 0.8)  # [m/s]
SHARES = (0.1, 0.05, 0.025)  # element size over b


def touch(folder: Path, speed: float, share: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times since the onset of contact [s] at the ends of the steps, their lengths [s] and mean
    forces [N/m], up to R v/(2 c_L^2).

    Neo-Hookean law; elements of share * b near contact; steps of a quarter of their transit time;
    penalty 20 rho c_L^2/h, which delays the force by a twentieth of a transit time.
    """
    width = RADIUS * speed / WAVE
    size, until = share * width, width / (2 * WAVE)
    folder.mkdir(parents=True, exist_ok=True)
    half = mesh.disc(RADIUS, RADIUS / 3, size, half=True, contact_arc=1.5 * width / RADIUS)
    half = replace(half, arc_centres=np.full((len(half.edges), 2), math.nan))
    mesh.write(revolution.whole(half), folder / "disc.msh")
    disc(folder, file=folder / "disc.msh", law="neohookean", speed=speed, young=YOUNG, nu=NU, density=DENSITY, radius=RADIUS, fields=0,
         dt=size / WAVE / 4, penalty=20 * DENSITY * WAVE**2 / size, end_time=1.05 * until)
    return since_touch(folder)


def since_touch(folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same for an existing run in `folder`."""
    history = outcome(folder / "run").history
    start = history["t"][np.flatnonzero(history["normal_force"] > 0)[0] - 1]
    return history["t"] - start, history["dt"], history["normal_force"]


def shock(speed: float) -> float:
    """U [m/s] for the velocity jump `speed`, by fixed-point iteration.

    Neo-Hookean: P = mu (l - 1/l) + lambda ln(l)/l with the stretch l = 1 - v/U.
    """
    U = WAVE
    for _ in range(100):
        stretch = 1 - speed / U
        U = math.sqrt(-(SHEAR * (stretch - 1 / stretch) + LAME * math.log(stretch) / stretch) * U / (DENSITY * speed))
    return U


def force(speed: float, t: np.ndarray | float, wave: float) -> np.ndarray | float:
    """F [N/m] at the time t [s] after the onset of contact, for this wave speed [m/s]."""
    return 2 * DENSITY * wave * speed * np.sqrt(2 * RADIUS * speed * t)


def early(folder: Path, speed: float, share: float) -> Iterator[Row]:
    """The force at R v/(2 c_L^2), and the impulse until then.

    The force is a least-squares fit of F ~ sqrt(t) to the second half of the time history, since it
    ripples as single points come into contact.
    """
    ends, steps, forces = touch(folder, speed, share)
    until, middles = RADIUS * speed / (2 * WAVE**2), ends - steps / 2
    late, whole = (middles > until / 2) & (middles < until), (ends > 0) & (ends <= until)
    root = np.sqrt(middles[late])
    fitted_force = (forces[late] * root * steps[late]).sum() / (root**2 * steps[late]).sum() * math.sqrt(until)
    end = ends[whole][-1]
    yield Row(f"{speed:g} m/s: force", share, fitted_force, force(speed, until, shock(speed)))
    yield Row(f"{speed:g} m/s: impulse", share, (forces[whole] * steps[whole]).sum(), 2 / 3 * end * force(speed, end, shock(speed)))
    if share == SHARES[-1]:
        yield Row(f"{speed:g} m/s: with c_L", share, fitted_force, force(speed, until, WAVE))


def touches(folder: Path) -> Iterator[Row]:
    for speed in SPEEDS:
        for share in SHARES:
            yield from early(folder / f"{speed:g}-{share:g}", speed, share)


def forces(axes: plt.Axes, folder: Path) -> None:
    """Draws F on the finest meshes over the time since the onset of contact, relative to 2 rho c_L
    v b at the end."""
    t = np.linspace(0, 1, 200)
    axes.plot(t, np.sqrt(t), color=BLACK, linewidth=1, label="$2\\rho c_L v\\sqrt{2Rvt}$")
    for speed, colour in zip(SPEEDS, (ORANGE, BLUE)):
        until = RADIUS * speed / (2 * WAVE**2)
        ends, steps, contact_forces = since_touch(folder / f"{speed:g}-{SHARES[-1]:g}")
        axes.plot((ends - steps / 2) / until, contact_forces / force(speed, until, WAVE), color=colour, linewidth=0.9,
                  label=f"{speed:g} m/s")
    axes.set(xlabel="time over $Rv/(2c_L^2)$", ylabel="force over that of $c_L$ at the end", xlim=(0, 1.05), ylim=(0, 1.15))
    axes.legend(loc="lower right")
