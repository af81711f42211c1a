"""V11: Cook's membrane at nu = 0.4999 (cook.edp). V24: the first mode of a free viscous body
(damped-mode.edp, damped-mode-3d.edp)."""

from collections.abc import Iterator
from pathlib import Path

from .case import Row
from .measure import measure

COOK = {"integrator": "backward-euler", "nu": 0.4999, "young": 240.565, "density": 1e-6, "radius": 1, "law": "neohookean", "without": "frozen-factorisation"}
# Load [N/m] and number of load steps. The published load is 6.25.
LOADS = {"small": (6.25e-4, 1), "large": (6.25, 10)}
# Displacement of the corner under the published load; for the small load, multiplied by 1e4.
# Taylor-Hood elements P5, P6 / P4, P5 graded towards the corners give 8.0677 to 8.0684 and 6.9302
# to 6.9304 for the same equations (NGSolve 6.2.2608).
TIP = {"small": 8.068, "large": 6.930}
VISCOUS = {"nu": 0.3, "viscosity": 100.0, "bulk_viscosity": 150.0}  # zeta/lambda = eta/mu
MODES = {"disc, SVK": ("damped-mode", {}, 0.015), "disc, neo-Hookean": ("damped-mode", {"law": "neohookean"}, 0.015),
         "ball, SVK": ("damped-mode-3d", {"symmetry": "full"}, 0.03)}


def tip(strains: str, elements: int, **flags) -> float:
    """Vertical displacement of the upper right corner, scaled to the published load, with
    `elements` elements on each side."""
    load, parts = LOADS[strains]
    return measure("cook", gravity=load, end_time=parts, mesh_size=1 / elements, contact_mesh_size=1 / elements, **COOK | flags)["tip"] * 6.25 / load


def membranes(folder: Path) -> Iterator[Row]:
    for strains, expected in TIP.items():
        for elements in (8, 16, 32):
            yield Row(f"tip: {strains} strains", 1 / elements, tip(strains, elements), expected)


def decays(folder: Path) -> Iterator[Row]:
    """V24: the decay over three periods, relative to eta omega^2 t/(2 mu)."""
    for name, (script, flags, size) in MODES.items():
        for times in (1, 2):
            numbers = measure(script, tolerance=1e-12, mesh_size=size, contact_mesh_size=size, exponent=times, **flags | VISCOUS)
            yield Row(f"decay: {name}", 1 / (120 * times), numbers["decay"], 1, 2)
