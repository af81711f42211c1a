"""V13, V14 and V19: collision of two bars, a bar that bounces under gravity, and a bar with stress
relaxation.

nu = 0, and the strains are so small that the linear theory of the bar holds.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from .case import FRONT, Row
from .measure import bodies

SPEED = 1e-4  # speed over the wave speed


def _bar(height: float, width: float, **more) -> dict:
    size = min(height, width) / 3
    return {"shape": "rectangle", "height": height, "width": width, "mesh_size": size, "contact_mesh_size": size} | more


def _contacts(history: dict[str, np.ndarray]) -> np.ndarray:
    """The times at which the normal force rises above or falls below 1 % of its maximum, in turn.
    """
    touching = history["normal_force"] > 0.01 * history["normal_force"].max()
    return history["t"][np.flatnonzero(np.diff(touching.astype(int)))]


def two_bars(folder: Path, elements: int, law: str = "neohookean") -> Iterator[Row]:
    """V13, L = 10, E = rho = 1: two bars collide with the velocities +v and -v.

    Expected: contact time 2 L/c, stress rho c v (middle 80 % of the contact), exchanged velocities.
    The elements of the second bar are 0.9 times as large as those of the first, so that nodes do
    not coincide.
    """
    size = 10 / elements
    left_bar = _bar(3 * size, 10, position=[-5, 0], velocity=[SPEED, 0])
    right_bar = _bar(3 * size, 10, position=[5, 0], velocity=[-SPEED, 0]) | {"mesh_size": 0.9 * size, "contact_mesh_size": 0.9 * size}
    run = bodies(folder, {"accuracy": 0.05, "law": law, "young": 1, "nu": 0, "density": 1, "dt": size / 2, "chatter": "continue", "body": [left_bar, right_bar],
                          "contact": {"penalty": 1e3}})
    summary, history = run.summary, run.history
    time = summary["contact_time"]
    plateau = (history["t"] > 0.1 * time) & (history["t"] < 0.9 * time)
    stress = -np.average(history["force_x_1"][plateau], weights=history["dt"][plateau]) / (3 * size)
    yield Row("contact time", 1 / elements, time, 20, FRONT)
    yield Row("stress", 1 / elements, stress, SPEED, FRONT)
    yield Row("velocity: left", 1 / elements, summary["rebound_vx_1"], -SPEED, FRONT)
    yield Row("velocity: right", 1 / elements, summary["rebound_vx_2"], SPEED, FRONT)


def bouncing_bar(folder: Path, elements: int) -> Iterator[Row]:
    """V14, L = 10, E = 900, rho = 1, g = 0.01, dropped from a height of 0.005.

    Expected: contact in [1, 5/3] and [11/3, 13/3].
    """
    size = 10 / elements
    run = bodies(folder, {"accuracy": 0.05, "law": "svk", "young": 900, "nu": 0, "density": 1, "gravity": 1e-2, "end_time": 4.6, "dt": size / 60,
                          "chatter": "continue", "body": [_bar(10, 3 * size, position=[0, 5.005])],
                          "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}], "contact": {"penalty": 9e6}})
    times = _contacts(run.history)
    expected = (1, 5 / 3, 11 / 3, 13 / 3)
    for what, k in (("first: begins", 0), ("first: ends", 1), ("second: begins", 2), ("second: ends", 3)):
        yield Row(what, 1 / elements, times[k] if len(times) == 4 else math.nan, expected[k], FRONT)


def _inverted(transform: Callable[[np.ndarray], np.ndarray], t: float, n: int = 24) -> float:
    """The inverse Laplace transform at t, on Talbot's contour (Abate, Valko 2004)."""
    turn = np.arange(1, n) * math.pi / n
    cot, scale = 1 / np.tan(turn), 2 * n / (5 * t)
    s = scale * turn * (cot + 1j)
    ends = 0.5 * math.exp(scale * t) * transform(np.array([scale + 0j]))[0].real
    return scale / n * (ends + np.sum((np.exp(s * t) * transform(s) * (1 + 1j * (turn + (turn * cot - 1) * cot))).real))


def relaxing_bar(folder: Path, elements: int, share: float, tau: float) -> Iterator[Row]:
    """V19, L = 10, E = rho = 1, nu = 0, with a parallel Maxwell branch of modulus share E and
    relaxation time tau: one of shear, share E/2, and one of volume, share E/3.

    On a rigid plane the bar is in contact until the wave front returns, T = 2 L/c with c^2 = 1 +
    share. The stress on the plane is v times the inverse transform of sqrt(E(s))/s with E(s) = 1 +
    share s tau/(1 + s tau). The front decays on its way as the stress on the plane does, and leaves
    the plane with tension. The restitution is the impulse until T over rho L v, minus 1.
    """
    size, contact = 10 / elements, 20 / math.sqrt(1 + share)
    run = bodies(folder, {"accuracy": 0.05, "law": "neohookean", "young": 1, "nu": 0, "density": 1, "dt": size / 4, "chatter": "continue", "end_time": 1.5 * contact,
                          "body": [_bar(10, 3 * size, position=[0, 5], velocity=[0, -SPEED], branches=[[share / 2, tau]], bulk_branches=[[share / 3, tau]])],
                          "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}], "contact": {"penalty": 1e3}})
    impulse = _inverted(lambda s: np.sqrt(1 + share * s * tau / (1 + s * tau)) / s**2, contact)
    group = f"tau = {tau / contact:.2g} T"
    yield Row(f"{group}: restitution", 1 / elements, run.summary["restitution"], impulse / 10 - 1, FRONT)
    yield Row(f"{group}: contact time", 1 / elements, run.summary["contact_time"], contact, FRONT)
    yield Row("1 + balance", 1 / elements, 1 + run.summary["energy_drift"], 1)


def relaxing(folder: Path) -> Iterator[Row]:
    for elements in (25, 50, 100):
        for share, tau in ((0.5, 10), (0.5, 40)):
            yield from relaxing_bar(folder, elements, share, tau)


def two(folder: Path) -> Iterator[Row]:
    for elements in (25, 50, 100):
        yield from two_bars(folder, elements)


def bouncing(folder: Path) -> Iterator[Row]:
    for elements in (12, 25, 50):
        yield from bouncing_bar(folder, elements)
