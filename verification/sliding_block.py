"""V9: a stiff block on the plane (sliding-block.edp) slides to a stop, starts to slide on an
incline, and creeps below that angle."""

import math
from collections.abc import Iterator
from pathlib import Path

from .case import Row
from .measure import measure

GRAVITY = 10
BLOCK = dict(young=1e9, nu=0.3, penalty=1e9, gravity=GRAVITY, radius=0.005)
MASS = 1722 * 0.1 * 0.01  # kg/m
# Speed over the slip velocity at which phi of the regularisation equals `share`.
CREEP = {"linear": lambda share: share, "sqrt": lambda share: share / math.sqrt(1 - share**2), "tanh": math.atanh, "linear-printed": lambda share: 2 * share}


def stop_time(speed: float, dynamic: float) -> float:
    """The time [s] until a block with the initial speed `speed` stops."""
    return speed / (dynamic * GRAVITY)


def stop_way(speed: float, dynamic: float) -> float:
    """The distance [m] that it slides."""
    return speed**2 / (2 * dynamic * GRAVITY)


def block(folder: Path) -> Iterator[Row]:
    """A block with 1 m/s stops. On an incline it starts to slide at tan alpha = mu_e and creeps
    below.

    The slip velocity is proportional to the step.
    """
    top = math.atan(1.05 * 0.7)
    for dt in (8e-3, 4e-3, 2e-3, 1e-3):
        numbers = measure("sliding-block", speed=1, angle=0, end_time=0.24, friction_static=0.7, friction_dynamic=0.5,
                          slip_velocity=dt, dt=dt, **BLOCK)
        yield Row("stop: time", dt, numbers["stop"], stop_time(1, 0.5), 1)
        yield Row("stop: way", dt, numbers["distance"], stop_way(1, 0.5))
        yield Row("stop: friction work", dt, numbers["work"], MASS / 2)
        numbers = measure("sliding-block", speed=0, angle=math.degrees(top), end_time=0.6, friction_static=0.7,
                          friction_dynamic=0.4, slip_velocity=0.02 * dt, dt=dt, **BLOCK)
        yield Row("starts to slide: tan α", dt, numbers["breakaway"], 0.7)
        for law in ("linear", "sqrt", "tanh"):
            numbers = measure("sliding-block", speed=0, angle=math.degrees(math.atan(0.6 * 0.9)), end_time=0.2, friction_static=0.6,
                              friction_dynamic=0.6, regularization=law, slip_velocity=dt, dt=dt, **BLOCK)
            yield Row(f"creep: {law}", dt, numbers["creep"], CREEP[law](0.9))
