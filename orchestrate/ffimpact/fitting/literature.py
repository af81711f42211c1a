"""Typical ranges of materials, for the bounds and priors of fits. Units are SI.

Sources of materials.csv: Gere, Mechanics of Materials, appendix H; Dowling, Mechanical Behavior of
Materials, table 5.2; Callister, Fundamentals of Materials Science and Engineering, appendix B;
Philpot, Mechanics of Materials, appendix D; Beer and others, Mechanics of Materials, appendix B.
Moduli of rubbers follow from their hardness by `shore`; their loss factors, at 10 to 100 Hz, and
hardnesses are those of a table of rubbers that cites reviews (materialmap.github.io). At the
frequencies of impacts losses are higher.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import pandas as pd

from ..failure import BadInput, unknown

__all__ = ["materials", "shore", "typical"]

FILE = Path(__file__).with_name("materials.csv")
ENTRIES = ("young", "nu", "density", "loss", "yield_stress")
HARDNESS = 3.0  # standard error of a measured hardness
SCALES = {"A": (20.0, 95.0), "D": (30.0, 85.0)}  # in which the relations hold
OF_D = 0.35  # standard error of the logarithm of a modulus by Shore D, taken from Shore A above 60


@cache
def _table() -> pd.DataFrame:
    return pd.read_csv(FILE, index_col="material")


def materials() -> pd.DataFrame:
    """Typical ranges by the name of the material: young_low, young_high [Pa], nu, density [kg/m3],
    loss (tan delta), yield_stress [Pa], and their sources. NaN: none is known here.
    """
    return _table().copy()


def typical(material: str, entry: str) -> tuple[float, float]:
    """A value and its standard error for an entry of a material: middle and half of its range, of a
    modulus, loss or yield stress the geometric middle. As prior of a fit, or to start with.
    """
    if material not in _table().index:
        raise BadInput(f"material: {unknown(material, _table().index, ', ')}")
    if entry not in ENTRIES:
        raise BadInput(f"entry: {unknown(entry, ENTRIES, ', ')}")
    low, high = (float(_table().loc[material, f"{entry}_{end}"]) for end in ("low", "high"))
    if math.isnan(low):
        raise BadInput(f"entry: no {entry} of {material} is known here (accepted: see materials())")
    middle = (low + high) / 2 if entry in ("nu", "density") else math.sqrt(low * high)
    return middle, max((high - low) / 2, 0.01 * middle)


def shore(hardness: float, scale: str = "A") -> tuple[float, float]:
    """Young's modulus [Pa] and its standard error for a Shore hardness.

    A: the geometric mean of the relations of Gent (1958), E = 0.0981 (56 + 7.62336 S)/(0.137505 (254 -
    2.54 S)) MPa, and lg E = 0.0235 S - 0.6403 (Ruess; near the finite elements of Qi, Joyce and Boyce
    2003); half their difference and an error of the hardness of 3 make its error. D: the second
    relation with S + 50.
    """
    if scale not in SCALES:
        raise BadInput(f"scale: {unknown(scale, SCALES, ', ')}")
    low, high = SCALES[scale]
    if isinstance(hardness, bool) or not isinstance(hardness, int | float):
        raise BadInput(f"hardness: '{hardness}' is no number")
    if not low <= hardness <= high:
        raise BadInput(f"hardness: {hardness:g} (accepted: {low:g} to {high:g}, Shore {scale})")
    ruess = 0.0235 * math.log(10)
    if scale == "D":
        modulus = 10 ** (0.0235 * (hardness + 50) - 0.6403)
        return 1e6 * modulus, 1e6 * modulus * math.hypot(OF_D, ruess * HARDNESS)
    relations = (
        0.0981 * (56 + 7.62336 * hardness) / (0.137505 * (254 - 2.54 * hardness)),
        10 ** (0.0235 * hardness - 0.6403),
    )
    modulus = math.sqrt(relations[0] * relations[1])
    apart = abs(math.log(relations[0] / relations[1])) / 2
    slope = 7.62336 / (56 + 7.62336 * hardness) + 2.54 / (254 - 2.54 * hardness)
    return 1e6 * modulus, 1e6 * modulus * math.hypot(apart, (slope + ruess) / 2 * HARDNESS)
