"""Flights of a ball in air, up and down: drag proportional to the square of the speed. Units are SI;
`drag` [1/m] is the deceleration over the square of the speed.
"""

import math

__all__ = [
    "AIR",
    "GRAVITY",
    "drag_of",
    "duration",
    "landing",
    "rise",
    "speed_of_fall",
    "speeds",
    "start_of",
]

GRAVITY, AIR = 9.81, 1.2  # [m/s2], density of air [kg/m3]
COEFFICIENT = 0.5  # of drag of a ball at Reynolds numbers between 1e3 and 1e5
SMALL = 1e-12  # drag times height, below which there is none


def drag_of(mass: float, radius: float, air: float = AIR) -> float:
    """The drag [1/m] of a ball of this mass [kg] and radius [m] in air of this density [kg/m3]."""
    return air * COEFFICIENT * math.pi * radius**2 / (2 * mass)


def landing(start: float, gravity: float, drag: float) -> float:
    """The speed [m/s] at the end of a flight up and down that began with the speed `start`."""
    return start / math.sqrt(1 + drag * start**2 / gravity)


def start_of(lands: float, gravity: float, drag: float) -> float:
    """The speed [m/s] at the start of a flight that ends with the speed `lands`."""
    return lands / math.sqrt(1 - drag * lands**2 / gravity)


def duration(start: float, gravity: float, drag: float) -> float:
    """The time [s] of a flight up and down that begins with the speed `start` [m/s]."""
    if drag * start**2 / gravity < SMALL:
        return 2 * start / gravity
    limit = math.sqrt(gravity / drag)  # terminal speed
    lands = landing(start, gravity, drag)
    return limit / gravity * (math.atan(start / limit) + math.atanh(lands / limit))


def speeds(lasts: float, gravity: float, drag: float) -> tuple[float, float]:
    """The speeds [m/s] at the start and at the end of a flight up and down of a duration [s]."""
    if drag * gravity * lasts**2 < SMALL:
        return gravity * lasts / 2, gravity * lasts / 2
    from scipy.optimize import brentq  # takes long to load

    limit = math.sqrt(gravity / drag)
    highest = gravity * lasts * math.cosh(gravity * lasts / limit)
    start = float(brentq(lambda speed: duration(speed, gravity, drag) - lasts, 0.0, highest))
    return start, landing(start, gravity, drag)


def rise(start: float, gravity: float, drag: float) -> float:
    """The height [m] to which a ball rises with the speed `start` [m/s] upwards."""
    if drag * start**2 / gravity < SMALL:
        return start**2 / (2 * gravity)
    return math.log1p(drag * start**2 / gravity) / (2 * drag)


def speed_of_fall(height: float, gravity: float, drag: float) -> float:
    """The speed [m/s] of a ball that fell from rest through a height [m]."""
    if drag * height < SMALL:
        return math.sqrt(2 * gravity * height)
    return math.sqrt(-math.expm1(-2 * drag * height) * gravity / drag)
