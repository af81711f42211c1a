"""V4 and V8: a block falls on a plane, through the whole time integration of a scene (impact.edp).

V4 tests waves in a bar, V8 a rigid body on the penalty.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .case import FRONT, Row
from .measure import measure, outcome

# Density [kg/m3], width [m] and length [m] of the falling block. impact.edp has the same width.
DENSITY, WIDTH, LENGTH = 1722, 2e-3, 0.05


def bar(folder: Path, elements: int) -> Iterator[Row]:
    """V4: a bar falls on a stiff plane with v << c. Expected: contact time 2L/c, stress rho c v
    (mean over the middle 80 %), restitution 1."""
    speed, young = 0.05, 7e6
    c = math.sqrt(young / DENSITY)
    # The end of the bar chatters on a nearly rigid plane.
    measure("impact", nu=0, radius=LENGTH, density=DENSITY, speed=speed, young=young, penalty=1e12, mesh_size=LENGTH / elements,
            dt=LENGTH / elements / c / 2, chatter="continue", out=folder / str(elements))
    result = outcome(folder / str(elements))
    summary, history = result.summary, result.history
    time = summary["contact_time"]
    plateau = (history["t"] > 0.1 * time) & (history["t"] < 0.9 * time)
    force = np.average(history["normal_force"][plateau], weights=history["dt"][plateau])
    yield Row("contact time", 1 / elements, time, 2 * LENGTH / c, FRONT)
    yield Row("stress", 1 / elements, force / WIDTH, DENSITY * c * speed, FRONT)
    yield Row("restitution", 1 / elements, summary["rebound_vy"] / speed, 1, FRONT)


def rigid(folder: Path, exponent: float, speed: float, dt: float) -> Iterator[Row]:
    """V8: a nearly rigid body of mass M on F = K d^m.

    Expected: depth [(m+1) M v^2/(2K)]^(1/(m+1)), the contact time of the closed form, restitution
    1.
    """
    measure("impact", nu=0, radius=LENGTH, density=DENSITY, speed=speed, young=1e12, penalty=1e7, exponent=exponent,
            mesh_size=LENGTH / 4, dt=dt, out=folder)
    summary, power = outcome(folder).summary, 1 / (exponent + 1)
    depth = (DENSITY * LENGTH * speed**2 / (2 * power * 1e7)) ** power
    time = 2 * math.sqrt(math.pi) * math.gamma(1 + power) / math.gamma(0.5 + power) * depth / speed
    yield Row(f"m = {exponent:g}: depth", dt, summary["max_penetration"], depth, 2)
    yield Row(f"m = {exponent:g}: contact time", dt, summary["contact_time"], time, 2)


def bars(folder: Path) -> Iterator[Row]:
    for elements in (40, 80, 160, 320):
        yield from bar(folder, elements)


def rigids(folder: Path) -> Iterator[Row]:
    for exponent in (1, 1.5, 2):
        for dt in (1.6e-3, 8e-4, 4e-4, 2e-4):
            yield from rigid(folder / f"{exponent:g}-{dt:g}", exponent, 1, dt)
