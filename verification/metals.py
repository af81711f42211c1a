"""Metals against exact solutions: a pulled bar, a spherical shell under pressure, waves in a plate and
in a slender bar, the first yield of a ball.

Strains are small where the theory is that of small strains. Steel: E = 210 GPa, nu = 0.3.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ffimpact.output.fields import write_fields
from ffimpact.output.states import Fields, State

from .case import FRONT, Row
from .measure import Outcome, bodies

E, NU, DENSITY = 210e9, 0.3, 7800.0
STEEL = {"law": "metal", "young": E, "nu": NU, "density": DENSITY}
K, MU = E / (3 * (1 - 2 * NU)), E / (2 * (1 + NU))


def _sizes(size: float) -> dict:
    return {"mesh_size": size, "contact_mesh_size": size}


def pulled_bar(folder: Path, steps: int, **yields) -> Outcome:
    """A cylinder of revolution, 20 mm long and 10 mm thick, pulled slowly to 1.2 times its length in
    `steps` steps; yields: the entries of the metal. The stretch is 1.1 - 0.1 cos(pi t/T)."""
    T = 0.01
    hold = [{"where": "bottom", "fix": "normal"},
            {"where": "top", "fix": "normal", "motion": [0, f"0.1*0.02*(1-cos(pi*t/{T}))"]}]
    return bodies(folder, STEEL | yields | {"dimension": "axisymmetric", "end_time": T, "dt": T / steps, "body": [
        {"shape": "cylinder", "radius": 0.005, "height": 0.02, "position": [0, 0], "support": hold} | _sizes(0.005)]})


def uniaxial(folder: Path, steps: int) -> Iterator[Row]:
    """The bar with linear hardening H: with the logarithmic strain e the Kirchhoff stress is
    E (e - p), p = (E e - sigma_y)/(E + H). The work is that of the exact force."""
    first, H = 400e6, 2e9
    run = pulled_bar(folder, steps, yield_stress=first, hardening=H)
    stretch = np.linspace(1, 1.2, 200_001)
    strain = np.log(stretch)
    plastic = np.maximum(0, (E * strain - first) / (E + H))
    volume = math.pi * 0.005**2 * 0.02
    work = volume * np.trapezoid(E * (strain - plastic) / stretch, stretch)
    p = plastic[-1]
    yield Row("plastic strain", 1 / steps, run.summary["max_plastic_strain"], p)
    yield Row("plastic work", 1 / steps, run.summary["plastic_work"], volume * (first * p + H * p**2 / 2))
    yield Row("work", 1 / steps, run.summary["external_work"], work)
    yield Row("1 + balance", 1 / steps, 1 + run.summary["energy_drift"], 1)


INNER, OUTER, FRONT_AT = 0.1, 0.2, 0.14    # radii of the shell, and to which it yields [m]


def shell(folder: Path, elements: int) -> Iterator[Row]:
    """A perfectly plastic spherical shell under a pressure that rises slowly to p = 2 sigma_y
    [ln(c/a) + (1 - c^3/b^3)/3] and falls to 0 (Hill 1950): the displacement of both surfaces, and
    of the outer one after it. Viscosity damps the vibration."""
    a, b, c, first = INNER, OUTER, FRONT_AT, 20e6
    p = 2 * first * (math.log(c / a) + (1 - (c / b) ** 3) / 3)
    T, size = 0.005, (b - a) / elements
    run = bodies(folder, STEEL | {
        "yield_stress": first, "dimension": "axisymmetric", "end_time": T, "dt": T / (20 * elements), "fields": 3, "start": "equilibrium", "viscosity": 2e6,
        "body": [{"shape": "shell", "radius": b, "inner_radius": a, "position": [0, 0],
                  "load": [{"where": "inner", "pressure": f"{p}*(1+cos(pi*t/{T}))/2"}]} | _sizes(size)]})
    write_fields(folder / "run")
    states = Fields(folder / "run", True, ())
    elastic = p * a**3 / (E * (b**3 - a**3)) * ((1 - 2 * NU) * b + (1 + NU) * b / 2)
    outer = 2 * first * c**3 / (3 * E * b**3) * ((1 - 2 * NU) * b + (1 + NU) * b / 2)
    inner = first / E * ((1 - NU) * c**3 / a**2 - 2 / 3 * (1 - 2 * NU) * (1 + 3 * math.log(c / a) - (c / b) ** 3) * a)
    yield Row("inner surface", 1 / elements, _radial(states[0], a), inner)
    yield Row("outer surface", 1 / elements, _radial(states[0], b), outer)
    yield Row("outer surface, unloaded", 1 / elements, _radial(states[2], b), outer - elastic)
    yield Row("1 + balance", 1 / elements, 1 + run.summary["energy_drift"], 1)


def _radial(state: State, radius: float) -> float:
    """The mean radial displacement [m] of the nodes at this radius."""
    r = np.linalg.norm(state.points, axis=1)
    at = abs(r - radius) < 1e-4 * radius
    return float(np.mean(np.sum(state.displacement[at] * state.points[at], axis=1) / r[at]))


def _plateau(run: Outcome, start: float, end: float) -> float:
    """The mean normal force [N/m; N] between two times [s]."""
    history = run.history
    middle = history["t"] - history["dt"] / 2
    inside = (middle > start) & (middle < end)
    return float(np.average(history["normal_force"][inside], weights=history["dt"][inside]))


def plate(folder: Path, elements: int) -> Iterator[Row]:
    """A perfectly plastic plate strikes a rigid wall flat: uniaxial strain, held by the sides of a
    strip. The elastic precursor has the stress sigma_y (1 - nu)/(1 - 2 nu); behind it the plastic
    wave runs at sqrt(K/rho), so that the wall feels precursor + rho sqrt(K/rho) (v - v1)."""
    first, speed, length = 100e6, 20.0, 0.1
    size = length / elements
    elastic, plastic = math.sqrt((K + 4 / 3 * MU) / DENSITY), math.sqrt(K / DENSITY)
    precursor = first * (1 - NU) / (1 - 2 * NU)
    wall = precursor + DENSITY * plastic * (speed - precursor / (DENSITY * elastic))
    run = bodies(folder, STEEL | {
        "yield_stress": first, "end_time": 1.2 * length / elastic, "dt": size / elastic / 2, "chatter": "continue",
        "body": [{"shape": "rectangle", "width": 3 * size, "height": length, "position": [0, length / 2 + 1e-6], "velocity": [0, -speed],
                  "support": [{"where": "left", "fix": "normal"}, {"where": "right", "fix": "normal"}]} | _sizes(size)],
        "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}], "contact": {"penalty": 1e16}})
    transit = length / elastic
    stress = _plateau(run, 0.3 * transit, transit) / (3 * size)
    yield Row("stress on the wall", 1 / elements, stress, wall, FRONT)
    yield Row("1 + balance", 1 / elements, 1 + run.summary["energy_drift"], 1)


def slender_bar(folder: Path, elements: int) -> Iterator[Row]:
    """A slender bar of revolution with linear hardening strikes a rigid wall: the stress behind the
    plastic wave is sigma_y + sqrt(E_t rho) (v - v_y), v_y = sigma_y/sqrt(E rho), 1/E_t = 1/E + 1/H
    (von Karman, Taylor)."""
    first, H, length, radius = 100e6, E / 20, 0.2, 0.004
    tangent = E * H / (E + H)
    first_speed = first / math.sqrt(E * DENSITY)
    speed = 3 * first_speed
    size = radius / elements
    run = bodies(folder, STEEL | {
        "dimension": "axisymmetric", "yield_stress": first, "hardening": H, "end_time": 0.8 * length / math.sqrt(E / DENSITY), "chatter": "continue",
        "dt": size / math.sqrt(E / DENSITY),
        "body": [{"shape": "cylinder", "radius": radius, "height": length, "position": [0, length / 2], "velocity": [0, -speed]} | _sizes(size)],
        "obstacle": [{"kind": "plane", "point": [0, 0], "normal": [0, 1]}], "contact": {"penalty": 1e16}})
    transit = length / math.sqrt(E / DENSITY)
    stress = _plateau(run, 0.4 * transit, 0.8 * transit) / (math.pi * radius**2)
    yield Row("stress on the wall", 1 / elements, stress, first + math.sqrt(tangent * DENSITY) * (speed - first_speed))
    yield Row("1 + balance", 1 / elements, 1 + run.summary["energy_drift"], 1)


def yield_speed(first: float, pressure: float) -> float:
    """The speed [m/s] at which a ball on a rigid plane has by Hertz's theory the largest pressure
    `pressure` times the yield stress `first` [Pa]; it does not depend on the radius."""
    contact_modulus = E / (1 - NU**2)
    highest = pressure * first
    # p0 = 3 F/(2 pi a^2) at the largest force, 8/15 E* sqrt(R) depth^(5/2) = m v^2/2, a^2 = R depth
    depth = (math.pi * highest / (2 * contact_modulus)) ** 2   # over R
    return math.sqrt(16 / 15 * contact_modulus * depth**2.5 / (4 / 3 * math.pi * DENSITY))


def ball(folder: Path, speed: float, first: float, **more) -> Outcome:
    """A perfectly plastic ball of revolution, of radius 5 mm, on a rigid plane."""
    return bodies(folder, STEEL | {"yield_stress": first, "dimension": "axisymmetric",
                                   "body": [{"shape": "ball", "radius": 0.005, "position": 0.005, "velocity": -speed}],
                                   "obstacle": [{"kind": "plane"}]} | more)


def sheared_layer(folder: Path, ratio: float) -> float:
    """Shear force over width of a perfectly plastic layer in plane strain, `ratio` times as wide as
    thick, sheared slowly by 0.1, over sigma_y/sqrt(3); the free ends bear less."""
    first, height, T = 400e6, 0.005, 0.01
    along = f"0.1*{height}*(1-cos(pi*t/{T}))/2"
    run = bodies(folder, STEEL | {"yield_stress": first, "end_time": T, "dt": T / 60, "body": [
        {"shape": "rectangle", "width": ratio * height, "height": height, "position": [0, 0],
         "support": [{"where": "bottom", "fix": "all"}, {"where": "top", "fix": "all", "motion": [along, 0]}]} | _sizes(height / 2)]})
    force = run.history["support_force_x_2"][50]
    return float(force / (ratio * height) / (first / math.sqrt(3)))
