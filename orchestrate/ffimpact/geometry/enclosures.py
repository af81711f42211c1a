"""Enclosures of an expression f(t) and its derivatives in intervals of time.

The program of an expression (implicit.py) is evaluated in interval arithmetic with Taylor
polynomials: for each interval the result contains f^(k)(t)/k! at every t in it, k = 0 to ORDER
(Moore, Kearfott and Cloud 2009, chapters 5 and 9). Where a branch of min, max or abs may change
within an interval, the first derivative is that of either branch and higher ones are not bounded.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from . import implicit
from .implicit import Interval

__all__ = ["ORDER", "Jet", "crossing", "enclosure"]

ORDER = 4  # highest derivative
MIN, SUBTRACT = 9, 5.0  # operations (implicit.py)
Jet = tuple[np.ndarray, np.ndarray]  # lower and upper bounds (ORDER + 1, n)
Program = tuple[float, ...]


def enclosure(
    code: Sequence[float], begin: np.ndarray, end: np.ndarray
) -> tuple[Jet, list[tuple[Program, np.ndarray]]]:
    """The enclosure of a program in the intervals from `begin` (n,) to `end` (n,), and the kinks.

    A kink is a program whose only zero in some of the intervals (n,) is where a branch changes.
    """
    stack: list[tuple[Jet, int]] = []  # enclosures of operands, and where their programs begin
    entries, kinks = enumerate(code), []
    with np.errstate(all="ignore"):
        for e, op in entries:
            if op == 0:
                value = np.full(len(begin), next(entries)[1])
                stack.append((_jet((value, value)), e))
            elif op < 4:
                stack.append((_jet((begin, end), slope=1.0), e))
            else:
                b = stack.pop()[0] if op < 11 else None
                a, first = stack.pop()
                if op in implicit.SIDES:
                    argument = tuple(code[first:e]) + (() if b is None else (SUBTRACT,))
                    result, crossed = _branched(int(op), a, b, argument, begin, end)
                    kinks.append((argument, crossed))
                else:
                    result = _smooth(int(op), a, b)
                stack.append((result, first))
    low, high = stack[0][0]
    return (
        np.nan_to_num(low, nan=-np.inf, posinf=np.inf, neginf=-np.inf),
        np.nan_to_num(high, nan=np.inf, posinf=np.inf, neginf=-np.inf),
    ), [(argument, crossed) for argument, crossed in kinks if crossed.any()]


def crossing(
    argument: Program, begin: np.ndarray, end: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The neighbouring floating-point numbers (n,) between which a program has its only zero in
    the intervals from `begin` (n,) to `end` (n,).
    """
    below, above = begin.copy(), end.copy()
    positive = _values(argument, end) > 0
    while True:
        middle = below + (above - below) / 2
        if not ((middle > below) & (middle < above)).any():
            return below, above
        after = (_values(argument, middle) > 0) == positive
        above, below = np.where(after, middle, above), np.where(after, below, middle)


def _values(code: Program, t: np.ndarray) -> np.ndarray:
    return implicit.run(code, t[:, None])[0]


def _jet(bounds: Interval, slope: float = 0.0) -> Jet:
    """The Taylor coefficients of a number within bounds, or of t with slope 1."""
    low, high = (np.zeros((ORDER + 1, len(bound))) for bound in bounds)
    low[0], high[0] = bounds
    low[1] = high[1] = slope
    return low, high


def _plus(a: Jet, b: Jet) -> Jet:
    return a[0] + b[0], a[1] + b[1]


def _minus(a: Jet) -> Jet:
    return -a[1], -a[0]


def _times(a: Jet, b: Jet) -> Jet:
    """c_k = sum over i of a_i b_(k-i)."""
    low, high = np.zeros_like(a[0]), np.zeros_like(a[0])
    for i in range(ORDER + 1):
        corners = np.array([x[i] * y[: ORDER + 1 - i] for x in a for y in b])
        np.copyto(corners, 0.0, where=np.isnan(corners))  # 0 times infinity
        low[i:] += corners.min(axis=0)
        high[i:] += corners.max(axis=0)
    return low, high


def _of(derivatives: Iterator[Interval], a: Jet) -> Jet:
    """g(a) by Horner's rule in a - a_0; `derivatives` are bounds of g^(j)(a_0)/j!, j = 0 to ORDER."""
    change = a[0].copy(), a[1].copy()
    change[0][0] = change[1][0] = 0.0
    *lower, result = [_jet(bounds) for bounds in derivatives]
    for bounds in reversed(lower):
        result = _plus(_times(result, change), bounds)
    return result


def _smooth(op: int, a: Jet, b: Jet | None) -> Jet:
    """The result of an operation without branches (implicit.OPERATIONS)."""
    base = a[0][0], a[1][0]
    match op:
        case 4 | 5:
            assert b is not None
            return _plus(a, b if op == 4 else _minus(b))
        case 6 | 7:
            assert b is not None
            return _times(a, b if op == 6 else _of(_powers((b[0][0], b[1][0]), -1.0), b))
        case 8 | 14:
            return _of(_powers(base, 0.5 if b is None else float(b[0][0, 0])), a)
        case 11:
            return _minus(a)
        case 15:
            bounds = [implicit.RANGES[15](base, None)] * (ORDER + 1)
        case _:  # the derivatives of sin(x) and cos(x) are sin(x + j pi/2)
            bounds = [implicit.sines(base, (j + op - 12) * np.pi / 2) for j in range(ORDER + 1)]
    return _of((_scaled(1 / math.factorial(j), bound) for j, bound in enumerate(bounds)), a)


def _powers(base: Interval, exponent: float) -> Iterator[Interval]:
    """Bounds of binomial(exponent, j) x^(exponent - j) for x in `base`, j = 0 to ORDER."""
    factor = 1.0
    for j in range(ORDER + 1):
        yield _scaled(factor, _power(base, exponent - j)) if factor else (0 * base[0],) * 2
        factor *= (exponent - j) / (j + 1)


def _power(base: Interval, exponent: float) -> Interval:
    """Bounds of x^exponent for x in `base`; infinite where it is not defined."""
    low, high = base
    whole = exponent == round(exponent)
    defined = (low > 0) | whole & (high < 0)
    if exponent >= 0:
        defined = (low >= 0) | whole
    bottom, top = implicit.among(
        *(np.where(defined, end, np.nan) ** np.where(defined, exponent, 1.0) for end in base)
    )
    through = (low <= 0) & (high >= 0) & (exponent > 0 and exponent % 2 == 0)
    return np.where(through, 0.0, bottom), top


def _scaled(factor: float, bounds: Interval) -> Interval:
    ends = factor * bounds[0], factor * bounds[1]
    return ends if factor >= 0 else ends[::-1]


def _branched(
    op: int, a: Jet, b: Jet | None, argument: Program, begin: np.ndarray, end: np.ndarray
) -> tuple[Jet, np.ndarray]:
    """The result of min, max or abs, and in which intervals (n,) its argument a - b, or a, has
    exactly one zero.
    """
    low, high = a if b is None else _plus(a, _minus(b))
    negative, positive = high[0] <= 0, low[0] >= 0
    unsure = ~(negative | positive) & ((low[1] > 0) | (high[1] < 0))  # monotone
    crossed = np.zeros(len(begin), dtype=bool)
    if unsure.any():
        before, after = (_values(argument, t[unsure]) for t in (begin, end))
        negative[unsure] = (before <= 0) & (after <= 0)
        positive[unsure] = (before >= 0) & (after >= 0)
        crossed[unsure] = before * after < 0
    # of a and b = -a the larger one is abs(a)
    lower_first = negative if op == MIN else positive
    upper_first = positive if op == MIN else negative
    other = _minus(a) if b is None else b
    hull = np.minimum(a[0], other[0]), np.maximum(a[1], other[1])
    ends = (a[0][0], a[1][0]), (other[0][0], other[1][0])
    hull[0][0], hull[1][0] = implicit.RANGES[op](*ends)
    hull[0][2:], hull[1][2:] = -np.inf, np.inf
    result = [
        np.where(lower_first, x, np.where(upper_first, y, z)) for x, y, z in zip(a, other, hull)
    ]
    return (result[0], result[1]), crossed
