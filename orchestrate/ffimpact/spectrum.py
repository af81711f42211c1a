"""From a dynamic mechanical analysis to a material: Maxwell branches for measured storage and loss
moduli (docs/how-to/scenes.md). Units are SI.

    rubber = ff.dma("rubber.csv", nu=0.49)
    disc = ff.Disc(radius=0.05, material=ff.NeoHookean(**rubber.entries, density=1100), ...)
"""

from __future__ import annotations

import argparse
import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .failure import BadInput, Unreadable, brief
from .input.damping import Damping, nonnegative, times_between

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Spectrum", "dma", "main"]

COLUMNS = ("frequency", "storage", "loss")  # [Hz], E' and E'' [Pa]
TEMPERATURE = "temperature"  # [degrees C], a fourth column
FEWEST = 3  # rows of a measurement
LARGEST_NU = 0.4999
ROUNDS, SETTLED = 50, 1e-12  # of the relaxed modulus that the conversion to shear needs


@dataclass(frozen=True)
class Spectrum:
    """A material whose branches fit measured moduli.

    `young` [Pa] is the relaxed modulus, `branches` [Pa, s] are those of shear. `frequency` [Hz]
    (n,), `storage` and `loss` [Pa] (n,) are as measured, with the frequencies shifted to the
    reference temperature. `deviation` is the root mean square of the complex modulus of the branches
    less the measured one, over its amount.
    """

    young: float
    nu: float
    branches: list[list[float]]
    frequency: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    deviation: float

    @property
    def entries(self) -> dict[str, Any]:
        """Its entries of a material: young, nu, branches."""
        return {"young": self.young, "nu": self.nu, "branches": self.branches}

    def modulus(self, frequency: np.ndarray) -> np.ndarray:
        """The complex modulus E' + i E'' [Pa] of the branches at frequencies [Hz] (n,)."""
        omega = 2 * np.pi * np.asarray(frequency, dtype=float)
        return _modulus(self.young, self.nu, self.branches, omega)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws measured and fitted moduli and loss factor over the frequency."""
        from .report.spectrum import draw

        return draw(self, ax)


def dma(
    file: str | Path | np.ndarray,
    nu: float,
    *,
    wlf: Sequence[float] | None = None,
) -> Spectrum:
    """Returns the material that fits a dynamic mechanical analysis in tension.

    file: a CSV file with the columns frequency [Hz], storage E' and loss E'' [Pa], and, with wlf,
    temperature [degrees C]; or an array of these columns. nu: Poisson's ratio of slow motions. wlf: C1,
    C2 [K] and the reference temperature [degrees C] of the shift log10(a) = -C1 (T - T0)/(C2 + T -
    T0) of Williams, Landel and Ferry (1955): frequencies become a times as high.

    The moduli of the branches are nonnegative and fit the complex modulus relative to its amount.
    The bulk modulus stays elastic. Raises BadInput if the measurement is not accepted, Unreadable if there is
    no such file.
    """
    if not 0 <= nu <= LARGEST_NU:
        raise BadInput(f"nu: {nu:g} is out of range (accepted: 0 to {LARGEST_NU:g})")
    table = _checked(file, wlf)
    frequency, storage, loss = table[:, :3].T
    if wlf is not None:
        frequency = frequency * _shift(table[:, 3], *_constants(wlf))
    measured, omega = storage + 1j * loss, 2 * np.pi * frequency
    # The shear modulus needs K, which follows from the relaxed modulus, which is fitted.
    young = float(storage.min())
    for _ in range(ROUNDS):
        mu, branches = _fitted(_shear(measured, young, nu), omega)
        if not mu > 0:
            raise BadInput(
                f"{_named(file)}: no relaxed modulus fits, the loss is too large at the lowest "
                f"frequencies (accepted: measured to lower frequencies)"
            )
        before, young = young, 2 * mu * (1 + nu)
        if abs(young - before) < SETTLED * young:
            break
    wrong = _modulus(young, nu, branches, omega) / measured - 1
    deviation = math.sqrt(float(np.mean(abs(wrong) ** 2)))
    return Spectrum(young, nu, branches, frequency, storage, loss, deviation)


def _named(file: str | Path | np.ndarray) -> str:
    return "file" if isinstance(file, np.ndarray) else str(file)


def _constants(wlf: Sequence[float]) -> Sequence[float]:
    if len(wlf) != 3 or not all(math.isfinite(number) for number in wlf) or wlf[1] <= 0:
        raise BadInput(
            f"wlf: '{brief(list(wlf))}' (accepted: C1, C2 > 0 in K, the reference temperature in degrees C)"
        )
    return wlf


def _shift(temperature: np.ndarray, c1: float, c2: float, reference: float) -> np.ndarray:
    above = temperature - reference
    if not (c2 + above > 0).all():
        raise BadInput(
            f"{TEMPERATURE}: {temperature.min():g} is below the range of wlf (accepted: above {reference - c2:g})"
        )
    shift: np.ndarray = 10 ** (-c1 * above / (c2 + above))
    return shift


def _checked(file: str | Path | np.ndarray, wlf: Sequence[float] | None) -> np.ndarray:
    """The columns of a measurement (n, 3 or 4)."""
    columns = COLUMNS if wlf is None else (*COLUMNS, TEMPERATURE)
    table = (
        np.array(file, dtype=float) if isinstance(file, np.ndarray) else _read(Path(file), columns)
    )
    if table.ndim != 2 or table.shape[1] != len(columns) or len(table) < FEWEST:
        raise BadInput(
            f"{_named(file)}: has {' x '.join(map(str, table.shape))} numbers (accepted: {FEWEST} rows or "
            f"more of {', '.join(columns)})"
        )
    wrong = ~(np.isfinite(table).all(axis=1) & (table[:, :3] > 0).all(axis=1))
    if wrong.any():
        row = int(wrong.argmax())
        raise BadInput(
            f"{_named(file)}: row {row + 1} is {brief(table[row].tolist())} (accepted: numbers, frequency, "
            "storage and loss above 0)"
        )
    return table


def _read(path: Path, columns: Sequence[str]) -> np.ndarray:
    try:
        with open(path, newline="", encoding="utf-8-sig") as lines:
            rows = list(csv.reader(lines))
    except (OSError, UnicodeDecodeError) as error:
        raise Unreadable(f"{path} cannot be read: {error} (accepted: a CSV file)") from None
    heads = [head.strip().lower() for head in rows[0]] if rows else []
    if missing := [name for name in columns if name not in heads]:
        raise BadInput(
            f"{path}: has no column {', '.join(missing)} in its first line (accepted: {', '.join(columns)}, in "
            "Hz, Pa and degrees C)"
        )
    places = [heads.index(name) for name in columns]
    numbers = []
    for k, row in enumerate(filter(any, rows[1:]), 1):
        try:
            numbers.append([float(row[place]) for place in places])
        except (ValueError, IndexError):
            raise BadInput(
                f"{path}: row {k} is '{brief(','.join(row))}' (accepted: numbers)"
            ) from None
    return np.array(numbers).reshape(len(numbers), len(columns))


def _bulk(young: float, nu: float) -> float:
    return young / (3 * (1 - 2 * nu))


def _shear(measured: np.ndarray, young: float, nu: float) -> np.ndarray:
    """The complex shear modulus mu [Pa] (n,) for a modulus of tension (n,), E = 9 K mu/(3 K + mu) with
    an elastic K.
    """
    bulk = _bulk(young, nu)
    mu: np.ndarray = 3 * bulk * measured / (9 * bulk - measured)
    return mu


def _modulus(
    young: float, nu: float, branches: Sequence[Sequence[float]], omega: np.ndarray
) -> np.ndarray:
    """The complex modulus of tension [Pa] (n,) at angular frequencies (n,)."""
    bulk, damping = _bulk(young, nu), Damping(branches=branches)
    shear = np.array([damping.shear(young / (2 * (1 + nu)), rate) for rate in omega])
    modulus: np.ndarray = 9 * bulk * shear / (3 * bulk + shear)
    return modulus


def _fitted(shear: np.ndarray, omega: np.ndarray) -> tuple[float, list[list[float]]]:
    """The relaxed modulus [Pa] and the branches that fit a complex shear modulus (n,)."""
    times = times_between(omega.min(), omega.max())
    turn = 1j * omega[:, None] * times
    parts = np.column_stack([np.ones(len(omega)), turn / (1 + turn)]) / abs(shear)[:, None]
    wanted = shear / abs(shear)
    moduli = nonnegative(np.vstack([parts.real, parts.imag]), np.append(wanted.real, wanted.imag))
    pairs = zip(moduli[1:].tolist(), times.tolist())
    return float(moduli[0]), [[modulus, time] for modulus, time in pairs if modulus > 0]


def main(argv: list[str]) -> int:
    """The command `ffimpact dma`: prints the entries of the material and draws the fit."""
    parser = argparse.ArgumentParser(prog="ffimpact dma", description=dma.__doc__.split("\n")[0])  # type: ignore[union-attr]
    parser.add_argument(
        "file", metavar="FILE", help="CSV with the columns frequency [Hz], storage, loss [Pa]"
    )
    parser.add_argument("--nu", type=float, required=True, help="Poisson's ratio of slow motions")
    parser.add_argument(
        "--wlf",
        type=float,
        nargs=3,
        metavar=("C1", "C2", "T0"),
        help="shift by the column temperature [degrees C]; C2 in K, T0 in degrees C",
    )
    parser.add_argument("--figure", metavar="PNG", type=Path, help="draw the fit")
    options = parser.parse_args(argv)
    spectrum = dma(options.file, options.nu, wlf=options.wlf)
    print(
        f"# fitted to {options.file}: root mean square deviation {100 * spectrum.deviation:.2g} %"
    )
    print(f"young = {spectrum.young:.6g}\nnu = {spectrum.nu:g}\nbranches = [")
    for modulus, time in spectrum.branches:
        print(f"    [{modulus:.6g}, {time:.6g}],")
    print("]")
    if options.figure:
        import matplotlib.pyplot as plt

        from .report.figures import save

        figure, ax = plt.subplots()
        spectrum.plot(ax)
        save(figure, options.figure)
    return 0
