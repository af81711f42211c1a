"""Functions of time that supports, loads and driven obstacles follow: a number, an expression of
t [s] or a table.

Each becomes a piecewise cubic Hermite polynomial, which the scripts evaluate
(edp/program/input/conditions.idp). A table is interpolated monotonically and with a continuous slope
(Fritsch and Carlson 1980). An expression is interpolated with an error of CLOSE times its largest
value so far, which enclosures of its derivatives guarantee (enclosures.py). What a function is up to
a time does not depend on end_time: a table counts as a whole, and the knots of an expression lie on
a grid that is finer at earlier times.
"""

import ast
import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from . import implicit
from .enclosures import crossing, enclosure
from .limits import LONGEST

__all__ = [
    "NOTHING",
    "TimeFunction",
    "constant",
    "displacements",
    "farthest",
    "functions",
    "is_csv",
    "of_csv",
    "of_entry",
    "of_table",
    "tabulated",
]

# Largest error of the interpolation, relative to the largest value of the expression so far; that
# which is accepted if CLOSE takes more than MOST intervals.
CLOSE, ROUGH = 1e-8, 1e-6
# Largest error of the table of a Python function, relative to its largest value; most of its times.
FOLLOWED, LARGEST = 1e-5, 2**15
NOTHING = 1e-20  # value [m, rad, Pa] that is round-off
STEEPEST = 1e30  # largest slope, per second; larger slopes are refused
# Intervals between two powers of two, before they are divided; the exponent of the first one; the
# largest number of intervals.
FEWEST, FIRST, MOST = 4, -40, 2**17
KINK = 2.0**-44  # distance of the two knots of a kink, relative to its time
SHORTEST = 2.0**-44  # shortest interval that is divided, relative to its time
SHARP = 1e-9  # change of the slope, relative to its largest values, that is a kink


@dataclass(frozen=True)
class TimeFunction:
    """A piecewise cubic Hermite polynomial; `knots` (n, 3): time [s], value, slope per second.

    Before the first knot and after the last one it is linear. At a kink there are two knots, KINK
    apart, with both slopes.
    """

    knots: np.ndarray

    @property
    def is_constant(self) -> bool:
        """Whether the function has the same value at all times."""
        return not self.knots[:, 2].any() and bool(np.ptp(self.knots[:, 1]) == 0)

    @property
    def is_zero(self) -> bool:
        """Whether the function is 0 at all times."""
        return not self.knots[:, 1:].any()

    def __call__(self, t: np.ndarray | float) -> np.ndarray:
        """The values at times t [s], in the shape of t."""
        times, values, slopes = self.knots.T
        t = np.asarray(t, dtype=float)
        inside = np.clip(t, times[0], times[-1])
        beyond = np.where(t < times[0], slopes[0], slopes[-1]) * (t - inside)
        values_at: np.ndarray = beyond + (values[0] if len(times) == 1 else self._spline(inside))
        return values_at

    def slope(self, t: np.ndarray | float) -> np.ndarray:
        """The slopes per second at times t [s], in the shape of t."""
        times, _, slopes = self.knots.T
        t = np.asarray(t, dtype=float)
        if len(times) == 1:
            return np.full_like(t, slopes[0])
        return np.asarray(self._spline(np.clip(t, times[0], times[-1]), 1))

    @property
    def largest_value(self) -> float:
        """The largest absolute value from the first to the last knot."""
        return float(abs(self(self.extreme_times)).max())

    def largest_until(self, t: float) -> float:
        """The largest absolute value at the knots up to the time t [s]."""
        return float(abs(self.knots[self.knots[:, 0] <= t, 1]).max(initial=0.0))

    @property
    def largest_slope(self) -> float:
        """The largest absolute slope per second from the first to the last knot."""
        # The slope of a cubic is a parabola: its extreme is at its vertex or at a knot.
        _, (_, second, third) = self._coefficients
        with np.errstate(all="ignore"):
            vertex = self.knots[:-1, 0] - second / (3 * third)
        inside = (vertex > self.knots[:-1, 0]) & (vertex < self.knots[1:, 0]) & ~self._at_kink
        return float(abs(np.append(self.knots[:, 2], self.slope(vertex[inside]))).max())

    @cached_property
    def extreme_times(self) -> np.ndarray:
        """The knots and the times [s] between them at which the slope is 0."""
        width, (first, second, third) = self._coefficients
        with np.errstate(all="ignore"):
            # roots of first + 2 second s + 3 third s^2, without cancellation
            half = -(second + np.copysign(np.sqrt(second**2 - 3 * third * first), second))
            roots = np.concatenate([half / (3 * third), first / half])
            inside = (roots > 0) & (roots < np.tile(width, 2)) & ~np.tile(self._at_kink, 2)
        return np.append(self.knots[:, 0], (np.tile(self.knots[:-1, 0], 2) + roots)[inside])

    @property
    def kinks(self) -> np.ndarray:
        """The kinks (n, 2): times [s], changes of the slope per second."""
        times, _, slopes = self.knots.T
        at = self._at_kink
        return np.column_stack([times[:-1][at], abs(np.diff(slopes))[at]])

    def since(self, begin: float) -> "TimeFunction":
        """The function with knots from `begin` [s] on only, where it is the same."""
        first = [begin, float(self(begin)), float(self.slope(begin))]
        return TimeFunction(np.vstack([first, self.knots[self.knots[:, 0] > begin]]))

    def scaled(self, factor: float) -> "TimeFunction":
        """The function times a factor."""
        return TimeFunction(self.knots * [1.0, factor, factor])

    def raised(self, value: float) -> "TimeFunction":
        """The function plus a constant value."""
        return TimeFunction(self.knots + [0.0, value, 0.0])

    @cached_property
    def _at_kink(self) -> np.ndarray:
        """Whether an interval (n - 1,) lies between the two knots of a kink."""
        times = self.knots[:, 0]
        return np.diff(times) <= 2 * KINK * abs(times[1:])

    @cached_property
    def _spline(self) -> Any:
        from scipy.interpolate import CubicHermiteSpline  # imported here: most scenes need none

        return CubicHermiteSpline(*self.knots.T)

    @cached_property
    def _coefficients(self) -> tuple[np.ndarray, np.ndarray]:
        """Widths (n - 1,) [s] of the intervals, and the coefficients (3, n - 1) of s, s^2, s^3, s
        [s] since the knot before.
        """
        times, values, slopes = self.knots.T
        width = np.diff(times)
        secant = np.diff(values) / width
        second = (3 * secant - 2 * slopes[:-1] - slopes[1:]) / width
        third = (slopes[:-1] + slopes[1:] - 2 * secant) / width**2
        return width, np.array([slopes[:-1], second, third])


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
        if not isinstance(column, np.ndarray) and not (
            isinstance(column, list) and all(type(number) in (int, float) for number in column)
        ):
            raise BadInput(
                f"{entry}: '{brief(column)}' of {name} is no list of numbers "
                f"(accepted: as many numbers as times, two or more)"
            )
        numbers = np.array(column, dtype=float)
        for number in numbers[~(abs(numbers) <= LONGEST**2)]:
            _limited(entry, float(number))
        columns.append(numbers)
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

    slope = PchipInterpolator(t, value).derivative()(t)
    # Before the first time and after the last one the function is constant.
    before, after = (
        [[t[k] + side * KINK * abs(t[k]), value[k], 0.0]] if slope[k] and t[k] else []
        for k, side in ((0, -1), (-1, 1))
    )
    return TimeFunction(np.array([*before, *np.column_stack([t, value, slope]), *after]))


def tabulated(entry: str, definition: Any, names: str, end_time: float) -> Any:
    """The definition of a function of time with tables in place of Python functions of t [s].

    A Python function stands for one component, or for all in `names`. Its table is that of even
    times from 0 to end_time [s], so many that of_table() is within FOLLOWED times its largest value
    in the middle between them. Raises BadInput if the function is not finite there, returns no
    numbers, or changes so fast that more than LARGEST times would be needed.
    """
    if isinstance(definition, list):
        return [
            tabulated(f"{entry}.{k}", component, name, end_time)
            for k, (name, component) in enumerate(zip(names, definition), 1)
        ]
    if not callable(definition):
        return definition
    if end_time <= 0:
        raise BadInput(f"{entry}: a Python function of time needs an end_time (accepted: above 0)")

    def at(times: np.ndarray) -> np.ndarray:
        try:
            rows = [np.atleast_1d(np.asarray(definition(float(t)), float)) for t in times]
            values = np.array(rows).reshape(len(times), len(names))
        except (TypeError, ValueError) as error:
            raise BadInput(
                f"{entry}: {error} (accepted: a function of t that returns {len(names)} numbers)"
            ) from None
        if not np.isfinite(values).all():
            t = times[~np.isfinite(values).all(axis=1)][0]
            raise BadInput(f"{entry}: is not finite at {t:g} s (accepted: finite numbers)")
        return values

    times = np.linspace(0.0, end_time, 65)
    values = at(times)
    while len(times) <= LARGEST:
        middle = (times[1:] + times[:-1]) / 2
        between = at(middle)
        columns = [of_table(entry, times, column)(middle) for column in values.T]
        largest = abs(np.concatenate([values, between])).max(initial=NOTHING)
        if abs(np.transpose(columns) - between).max() <= FOLLOWED * largest:
            return {"t": times.tolist()} | dict(zip(names, values.T.tolist()))
        order = np.argsort(np.concatenate([times, middle]))
        times = np.concatenate([times, middle])[order]
        values = np.concatenate([values, between])[order]
    raise BadInput(
        f"{entry}: changes too fast for a table of {LARGEST} times up to end_time = {end_time:g} s "
        f"(accepted: a smoother function, an expression of t in quotes, or a table of your own)"
    )


def is_csv(definition: object) -> bool:
    """Whether the value of an entry is the name of a CSV file."""
    return isinstance(definition, str) and definition.lower().endswith(".csv")


def of_csv(entry: str, path: Path, columns: str) -> dict[str, np.ndarray]:
    """The table of a CSV file as columns {"t": [...], "x": [...], ...}.

    The first line of the file lists t and the `columns`, one letter each, in any order. Raises
    BadInput, with the name of the entry, if the file cannot be read or is not such a table.
    """
    first = ",".join(["t", *columns])
    accepted = f"(accepted: a CSV file with the first line '{first}' and {len(columns) + 1} columns of numbers)"
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise BadInput(
            f"{entry}: '{brief(path.name)}' cannot be read: {reason} {accepted}"
        ) from None
    begins, _, rows = text.lstrip().partition("\n")
    names = [name.strip() for name in next(csv.reader([begins]), [])]
    if sorted(names) != sorted(["t", *columns]):
        raise BadInput(
            f"{entry}: '{brief(path.name)}' begins with '{brief(begins.strip())}' {accepted}"
        )
    try:
        lines = [line for line in rows.splitlines() if line.strip()]
        table = np.empty((0, len(names)))
        if lines:
            table = np.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
        if table.shape[1] != len(names):
            raise ValueError
    except ValueError:
        table = _rows(entry, path.name, rows, len(names), accepted)
    return dict(zip(names, table.T))


def _rows(entry: str, file: str, rows: str, columns: int, accepted: str) -> np.ndarray:
    """The numbers (n, columns) of the rows of a CSV file, read one by one. Raises BadInput for the
    first row that is no row of numbers.
    """
    table = []
    for number, row in enumerate(csv.reader(rows.splitlines()), 2):
        try:
            table += [[float(cell) for cell in row]] if row else []
            if row and len(row) != columns:
                raise ValueError
        except ValueError:
            raise BadInput(
                f"{entry}: line {number} of '{brief(file)}' is '{brief(','.join(row))}' {accepted}"
            ) from None
    return np.array(table).reshape(-1, columns)


def functions(
    entry: str, definition: object, names: str, end_time: float, folder: Path
) -> tuple[TimeFunction, ...]:
    """The functions of an entry, one for each component in `names`.

    The entry is a list of numbers, expressions and tables {t, x} of single components, a single one
    for a single component, or a table {t, ...} with a column for each component, also as the name
    of a CSV file in `folder`. Their knots begin at 0; expressions are used up to `end_time` [s].
    Raises BadInput, with the name of the entry, for anything else.
    """
    if is_csv(definition):
        definition = of_csv(entry, folder / str(definition), names)
    components = _components(entry, definition, names, end_time)
    return tuple(function.since(0.0) for function in components)


def _components(entry: str, definition: object, names: str, end_time: float) -> list[TimeFunction]:
    """The functions of an entry from their first to their last knot."""
    if isinstance(definition, dict):
        if set(definition) != {"t", *names}:
            raise BadInput(
                f"{entry}: '{brief(definition)}' is no table (accepted: t and {', '.join(names)})"
            )
        return [of_table(f"{entry}.{name}", definition["t"], definition[name]) for name in names]
    if len(names) == 1 and not isinstance(definition, list):
        definition = [definition]
    if not isinstance(definition, list) or len(definition) != len(names):
        raise BadInput(
            f"{entry}: '{brief(definition)}' is no [{', '.join(names)}] "
            f"(accepted: {len(names)} numbers, expressions of t or tables, or a CSV file)"
        )
    if len(names) == 1:
        return [of_entry(entry, definition[0], end_time)]
    return [
        _components(f"{entry}.{k}", component, name, end_time)[0]
        if isinstance(component, dict)
        else of_entry(f"{entry}.{k}", component, end_time)
        for k, (name, component) in enumerate(zip(names, definition), 1)
    ]


def displacements(
    entry: str, definition: object, names: str, end_time: float, folder: Path
) -> tuple[TimeFunction, ...]:
    """The functions of a motion, as `functions`, less their values at t = 0.

    Raises BadInput, in addition, if a component is a number other than 0: it would have no effect.
    """
    motion = functions(entry, definition, names, end_time, folder)
    tabulated = isinstance(definition, dict) or is_csv(definition)
    for k, function in enumerate(motion, 1):
        if function.is_constant and not function.is_zero and not tabulated:
            name = f"{entry}.{k}" if len(names) > 1 else entry
            raise BadInput(
                f"{name}: {function.knots[0, 1]:g} does not change in time, and a motion counts "
                f"from its value at t = 0 (accepted: 0, or a function of t, '0.1*t'; place or turn "
                f"the part itself)"
            )
    return tuple(function.raised(-float(function(0.0))) for function in motion)


def farthest(
    translation: Sequence[TimeFunction], until: float = np.inf
) -> tuple[np.ndarray, float]:
    """The largest displacement (axes,) from t = 0 to `until` [s], and the first time [s] of it.

    `translation` contains the functions of the components. Each has its extremes among the times
    that are examined.
    """
    times = np.concatenate([function.extreme_times for function in translation])
    latest = min(until, float(times.max()))
    times = np.unique([0.0, *times[(times > 0) & (times < latest)], max(0.0, latest)])
    moved = np.array([function(times) for function in translation]).T
    ways = np.linalg.norm(moved, axis=1)
    k = int((ways >= (1 - 1e-6) * ways.max()).argmax())  # whatever the round-off of later ones
    return moved[k], float(times[k])


def _sampled(entry: str, expression: str, program: tuple[float, ...], end: float) -> np.ndarray:
    """The knots (n, 3) of an expression from 0 to the end of the grid's interval that contains `end`
    [s], or to `end` if it is not defined everywhere in it.
    """
    grid = _grid(end)
    try:
        return _on_grid(entry, expression, program, grid)
    except BadInput:
        return _on_grid(entry, expression, program, np.append(grid[:-1], end))


def _on_grid(
    entry: str, expression: str, program: tuple[float, ...], grid: np.ndarray
) -> np.ndarray:
    """The knots (n, 3) of an expression: the ends of the intervals of a grid and of their parts.

    Intervals are divided, at kinks or in their middle, until the polynomial in each certainly
    agrees with the expression to CLOSE. Raises BadInput if this takes more than MOST intervals, or
    if the expression has no bound or jumps.
    """
    for close in (CLOSE, ROUGH):
        intervals = _divided(entry, expression, program, grid, close)
        if intervals is not None:
            return _knots(entry, expression, program, *intervals)
    raise BadInput(
        f"{entry}: '{brief(expression)}' changes too often up to end_time = {grid[-1]:g} s "
        f"(accepted: what {MOST} cubic polynomials follow)"
    )


def _grid(end: float) -> np.ndarray:
    """The times (n,) [s] from 0 to `end` or the first one after it, that are the same for all
    `end`: FEWEST intervals between each two powers of two.
    """
    octaves = 2.0 ** np.arange(FIRST, max(FIRST, math.frexp(end)[1]) + 1)
    grid = np.concatenate([[0.0], *(octaves * (1 + k / FEWEST) for k in range(FEWEST))])
    grid.sort()
    return grid[: np.searchsorted(grid, end) + 1]


def _divided(
    entry: str, expression: str, program: tuple[float, ...], grid: np.ndarray, close: float
) -> tuple[np.ndarray, np.ndarray] | None:
    """The intervals (n,), (n,) of a grid and their parts, in each of which a cubic Hermite polynomial
    has at most the error `close`, relative to the largest value so far; None if they are more than
    MOST. Kinks lie between intervals.
    """
    begin, until, done = grid[:-1], grid[1:], []
    largest = np.full(len(grid) - 1, NOTHING)  # in each interval of the grid
    while len(begin):
        width, middle = until - begin, (begin + until) / 2
        place = np.searchsorted(grid, middle) - 1
        value, _ = _evaluated(entry, expression, program, middle)
        np.maximum.at(largest, place, abs(value))
        (low, high), kinks = enclosure(program, begin, until)
        with np.errstate(all="ignore"):
            # the error is at most h^4/384 times the fourth derivative, and h (max f' - min f')
            off = width**4 / 16 * np.maximum(-low[4], high[4])
            off = np.fmin(off, width * (high[1] - low[1]))
        at_once = (until <= grid[1]) & np.isfinite(off)  # in the first interval
        coarse = ~((off <= close * np.maximum.accumulate(largest)[place]) | at_once)
        done.append((begin[~coarse], until[~coarse]))
        stuck = coarse & (width <= SHORTEST * until)
        if stuck.any():
            raise BadInput(
                f"{entry}: '{brief(expression)}' jumps, or has no limit, at "
                f"t = {begin[stuck][0]:.6g} s, or changes there within {width[stuck][0]:.1g} s "
                f"(accepted: a continuous function)"
            )
        first, last = middle, middle.copy()
        whole = coarse.copy()  # not divided at a kink yet
        for argument, crossed in kinks:
            here = crossed & whole
            first[here], last[here] = crossing(argument, begin[here], until[here])
            whole &= ~here
        begin, until = (
            np.append(begin[coarse], last[coarse]),
            np.append(first[coarse], until[coarse]),
        )
        if len(begin) + sum(len(part[0]) for part in done) > MOST:
            return None
    begin, until = (np.concatenate(ends) for ends in zip(*done))
    order = begin.argsort()
    return begin[order], until[order]


def _knots(
    entry: str,
    expression: str,
    program: tuple[float, ...],
    begin: np.ndarray,
    until: np.ndarray,
) -> np.ndarray:
    """The knots (n, 3) of an expression at the ends of intervals (n,), (n,); two at a kink."""
    branches: dict[int, np.ndarray] = {}  # those in the middle hold in the whole interval
    with np.errstate(all="ignore"):
        implicit.run(program, ((begin + until) / 2)[:, None], branches)
    at_begin, at_end = (
        np.column_stack([t, *_evaluated(entry, expression, program, t, branches)])
        for t in (begin, until)
    )
    change = abs(at_begin[1:, 2] - at_end[:-1, 2])
    kink = change > SHARP * (abs(at_begin[1:, 2]) + abs(at_end[:-1, 2]))
    later = at_begin[1:][kink]
    shift = KINK * later[:, 0]
    later += np.column_stack([shift, shift * later[:, 2], 0 * shift])
    knots = np.vstack([at_begin[:1], at_end, later])
    return knots[knots[:, 0].argsort(kind="stable")]


def _evaluated(
    entry: str,
    expression: str,
    program: tuple[float, ...],
    t: np.ndarray,
    branches: dict[int, np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """The values (n,) and slopes (n,) per second of an expression at times (n,) [s], on its
    `branches` as in implicit.run.

    Raises BadInput if a value or slope is not finite or too large.
    """
    with np.errstate(all="ignore"):
        value, slope = implicit.run(program, t[:, None], branches)
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
