"""Functions of time that supports and loads follow: a number, an expression of t [s] or a table.

Each becomes a piecewise cubic Hermite polynomial, which FreeFEM evaluates
(edp/core/input/conditions.idp). A table is interpolated monotonically and with a continuous slope
(Fritsch and Carlson 1980). An expression is interpolated with an error of CLOSE times its largest
value.
"""

import ast
import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..failure import BadInput, brief
from ..input.rules import LONGEST
from . import implicit

__all__ = [
    "TimeFunction",
    "constant",
    "displacements",
    "farthest",
    "functions",
    "of_csv",
    "of_entry",
    "of_table",
]

CLOSE = 1e-8  # largest error of the interpolation, relative to the largest value of the expression
STEEPEST = 1e30  # largest slope, per second; larger slopes are refused
# Relative errors as CLOSE: ROUGH is accepted when the number of knots reaches MOST; an error beyond
# BROKEN means that the expression is not continuous.
ROUGH, BROKEN = 1e-6, 1e-2
FEWEST, MOST = 64, 2**17  # smallest number of intervals, largest number of knots
TESTED = 15  # times between two knots at which an expression and its polynomial are compared
SHORTEST_INTERVAL = 1e-12  # shortest interval between knots, relative to end_time


@dataclass(frozen=True)
class TimeFunction:
    """A piecewise cubic Hermite polynomial; `knots` (n, 3): time [s], value, slope per second.

    Before the first knot and after the last one the function is constant.
    """

    knots: np.ndarray

    @property
    def is_constant(self) -> bool:
        """Whether all knots have the same value."""
        return bool(np.ptp(self.knots[:, 1]) == 0)

    @property
    def is_zero(self) -> bool:
        """Whether the value is 0 at all knots."""
        return not self.knots[:, 1].any()

    def __call__(self, t: np.ndarray | float) -> np.ndarray:
        """The values at times t [s], in the shape of t."""
        times, values, slopes = self.knots.T
        if len(times) == 1:
            return values[0] + 0 * np.asarray(t)
        from scipy.interpolate import CubicHermiteSpline  # imported here: most scenes need none

        return CubicHermiteSpline(times, values, slopes)(np.clip(t, times[0], times[-1]))


def constant(value: float) -> TimeFunction:
    """The function that has the same value at all times."""
    return TimeFunction(np.array([[0.0, value, 0.0]]))


def of_entry(entry: str, definition: object, end_time: float) -> TimeFunction:
    """The function of an entry: a number, or an expression of t, used from 0 to end_time [s].

    Raises BadInput, with the name of the entry, if the entry is neither, or if the expression has
    no finite value or slope at some time.
    """
    if isinstance(definition, bool) or not isinstance(definition, int | float | str):
        raise BadInput(
            f"{entry}: '{brief(definition)}' is no function of time (accepted: a number, or an "
            f"expression of t in quotes)"
        )
    if isinstance(definition, int | float):
        return constant(_limited(entry, float(definition)))
    program = implicit.program(entry, definition, "t")
    value, _ = _evaluated(entry, definition, program, np.zeros(1))
    if not any(
        isinstance(node, ast.Name) and node.id == "t"
        for node in ast.walk(ast.parse(definition.strip().replace("^", "**")))
    ):
        return constant(float(value[0]))
    if end_time <= 0:
        raise BadInput(
            f"{entry}: '{brief(definition)}' is a function of time, and end_time is 0, the end "
            f"of the contact (accepted: a number here, or an end_time > 0)"
        )
    return TimeFunction(_sampled(entry, definition, program, end_time))


def of_table(entry: str, times: object, values: object) -> TimeFunction:
    """The function of a table: values at increasing times [s].

    Raises BadInput, with the name of the entry, if the lists are not of equal length (two or more),
    contain anything but numbers, or if the times do not increase.
    """
    columns = []
    for name, column in (("t", times), ("value", values)):
        if not isinstance(column, list) or not all(
            type(number) in (int, float) for number in column
        ):
            raise BadInput(
                f"{entry}: '{brief(column)}' of {name} is no list of numbers "
                f"(accepted: as many numbers as times, two or more)"
            )
        columns.append(np.array([_limited(entry, float(number)) for number in column]))
    t, value = columns
    if len(t) != len(value) or len(t) < 2:
        raise BadInput(
            f"{entry}: {len(t)} times and {len(value)} values (accepted: as many values as "
            f"times, two or more)"
        )
    if not (np.diff(t) > 0).all():
        where = int(np.argmin(np.diff(t) > 0)) + 1
        raise BadInput(
            f"{entry}: the time {t[where]:g} s follows {t[where - 1]:g} s (accepted: times "
            f"that grow)"
        )
    from scipy.interpolate import PchipInterpolator

    return TimeFunction(np.column_stack([t, value, PchipInterpolator(t, value).derivative()(t)]))


def of_csv(entry: str, path: Path, columns: str) -> dict[str, list[float]]:
    """The table of a CSV file as columns {"t": [...], "x": [...], ...}.

    The first line of the file lists t and the `columns`, one letter each, in any order. Raises
    BadInput, with the name of the entry, if the file cannot be read or is not such a table.
    """
    first = ",".join(["t", *columns])
    accepted = f"(accepted: a CSV file with the first line '{first}' and {len(columns) + 1} columns of numbers)"
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            rows = [[cell.strip() for cell in row] for row in csv.reader(file) if any(row)]
    except (OSError, UnicodeDecodeError, ValueError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(
            f"{entry}: '{brief(path.name)}' cannot be read: {reason} {accepted}"
        ) from None
    if not rows or sorted(rows[0]) != sorted(["t", *columns]):
        begins = ",".join(rows[0]) if rows else ""
        raise BadInput(f"{entry}: '{brief(path.name)}' begins with '{brief(begins)}' {accepted}")
    for number, row in enumerate(rows[1:], 2):
        try:
            if len([float(cell) for cell in row]) != len(rows[0]):
                raise ValueError
        except ValueError:
            raise BadInput(
                f"{entry}: line {number} of '{brief(path.name)}' is '{brief(','.join(row))}' "
                f"{accepted}"
            ) from None
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}


def functions(
    entry: str, definition: object, names: str, end_time: float
) -> tuple[TimeFunction, ...]:
    """The functions of an entry, one for each component in `names`.

    The entry is a list of numbers and expressions, a single one for a single component, or a table
    {t, ...} with a column for each component. `end_time` is in s. Raises BadInput, with the name of
    the entry, for anything else.
    """
    if isinstance(definition, dict):
        if set(definition) != {"t", *names}:
            raise BadInput(
                f"{entry}: '{brief(definition)}' is no table (accepted: t and {', '.join(names)})"
            )
        return tuple(
            of_table(f"{entry}.{name}", definition["t"], definition[name]) for name in names
        )
    if len(names) == 1 and not isinstance(definition, list):
        definition = [definition]
    if not isinstance(definition, list) or len(definition) != len(names):
        raise BadInput(
            f"{entry}: '{brief(definition)}' is no [{', '.join(names)}] "
            f"(accepted: {len(names)} numbers or expressions of t, or a CSV file)"
        )
    return tuple(
        of_entry(f"{entry}.{k}" if len(names) > 1 else entry, component, end_time)
        for k, component in enumerate(definition, 1)
    )


def displacements(
    entry: str, definition: object, names: str, end_time: float
) -> tuple[TimeFunction, ...]:
    """The functions of a motion, as `functions`. A displacement is the change since t = 0.

    Raises BadInput, in addition, if a component is a number other than 0: it would have no effect.
    """
    motion = functions(entry, definition, names, end_time)
    for k, function in enumerate(motion, 1):
        if len(function.knots) == 1 and not function.is_zero:
            name = f"{entry}.{k}" if len(names) > 1 else entry
            raise BadInput(
                f"{name}: {function.knots[0, 1]:g} does not change in time, and a motion counts "
                f"from its value at t = 0 (accepted: 0, or a function of t, '0.1*t'; place or turn "
                f"the part itself)"
            )
    return motion


def farthest(
    translation: Sequence[TimeFunction], until: float = np.inf
) -> tuple[np.ndarray, float]:
    """The largest displacement (axes,) from the value at t = 0, and the time [s] of it.

    `translation` contains the functions of the components. Only their knots from 0 to `until` [s]
    are examined.
    """
    times = np.unique(np.concatenate([function.knots[:, 0] for function in translation]))
    times = times[(times >= 0) & (times <= until)]
    if not len(times):
        return np.zeros(len(translation)), 0.0
    moved = np.array([function(times) - function(0.0) for function in translation]).T
    k = int(np.linalg.norm(moved, axis=1).argmax())
    return moved[k], float(times[k])


def _sampled(entry: str, expression: str, program: tuple[float, ...], end: float) -> np.ndarray:
    """The knots (n, 3) of an expression from 0 to `end` [s].

    Intervals are halved until the polynomial in each agrees with the expression to CLOSE. At a kink
    they are halved until they are as short as SHORTEST_INTERVAL. Raises BadInput if the expression
    is not continuous or needs more than MOST knots.
    """
    t = np.linspace(0, end, FEWEST + 1)
    while True:
        knots = np.column_stack([t, *_evaluated(entry, expression, program, t)])
        width = np.diff(t)
        between = t[:-1, None] + width[:, None] * np.arange(1, TESTED + 1) / (TESTED + 1)
        value, _ = _evaluated(entry, expression, program, between.ravel())
        off = abs(TimeFunction(knots)(between) - value.reshape(between.shape)).max(axis=1)
        largest = max(abs(knots[:, 1]).max(), abs(value).max())
        open_ones = (off > CLOSE * largest) & (width > SHORTEST_INTERVAL * end)
        too_many = len(t) + open_ones.sum() > MOST
        if off.max() <= (ROUGH * largest if too_many else CLOSE * largest) or not open_ones.any():
            break
        if too_many:
            raise BadInput(
                f"{entry}: '{brief(expression)}' changes too often up to end_time = {end:g} s "
                f"(accepted: what {MOST} cubic polynomials follow)"
            )
        t = np.sort(np.append(t, (t[:-1] + width / 2)[open_ones]))
    if off.max() > BROKEN * largest:
        raise BadInput(
            f"{entry}: '{brief(expression)}' jumps, or has no limit, at "
            f"t = {t[off.argmax()]:.6g} s (accepted: a continuous function)"
        )
    return knots


def _evaluated(
    entry: str, expression: str, program: tuple[float, ...], t: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The values (n,) and slopes (n,) per second of an expression at times (n,) [s].

    Raises BadInput if a value or slope is not finite or too large.
    """
    with np.errstate(all="ignore"):
        value, slope = implicit.run(program, t[:, None])
    value, slope = np.broadcast_to(value, t.shape), np.broadcast_to(slope[:, 0], t.shape)
    bad = ~((abs(value) <= LONGEST**2) & (abs(slope) <= STEEPEST))
    if bad.any():
        raise BadInput(
            f"{entry}: '{brief(expression)}' is {value[bad][0]:g}, its slope {slope[bad][0]:g}, at "
            f"t = {t[bad][0]:g} s (accepted: a number and a finite slope at all times)"
        )
    return value, slope


def _limited(entry: str, value: float) -> float:
    if not abs(value) <= LONGEST**2:
        raise BadInput(f"{entry}: {value:g} is out of range (accepted: up to {LONGEST**2:g})")
    return value
