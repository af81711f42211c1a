"""Fields at the start of a run, functions of place: a number or an expression of x, y (, z) [m] for
each component, or a table on a grid, which a Python function becomes.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..failure import BadInput, brief
from . import implicit
from .limits import LONGEST

__all__ = ["Field", "of_entry", "tabulated"]

# Largest error of the table of a Python function, relative to its largest value; its first number of
# points along an axis, and the largest number of its points.
FOLLOWED, FIRST, LARGEST = 1e-5, 9, 2**16
CHECKED = 500  # places besides the middles of cells at which a table is compared with its function
FEWEST = 4  # smallest number of points of a table along an axis


@dataclass(frozen=True)
class Field:
    """A vector at each place: `at` takes points (n, axes) [m] and returns vectors (n, axes)."""

    entry: str
    at: Callable[[np.ndarray], np.ndarray]

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """The vectors (n, axes) at points (n, axes). Raises BadInput if one is not finite."""
        with np.errstate(all="ignore"):
            vectors = self.at(points)
        wrong = ~(abs(vectors) <= LONGEST).all(axis=1)
        if wrong.any():
            place = ", ".join(f"{x:.6g}" for x in points[wrong][0])
            raise BadInput(
                f"{self.entry}: is {brief(vectors[wrong][0])} at ({place}) (accepted: numbers up to "
                f"{LONGEST:g} in all of the body)"
            )
        return vectors


def of_entry(entry: str, definition: Any, axes: int) -> Field:
    """The field of an entry: a list with a number or an expression for each axis, or a table. Raises
    BadInput otherwise.
    """
    names = "xyz"[:axes]
    if isinstance(definition, dict):
        return Field(entry, _of_table(entry, definition, names))
    if not isinstance(definition, list) or len(definition) != axes:
        raise BadInput(
            f"{entry}: '{brief(definition)}' is no field (accepted: [{', '.join(f'v{name}' for name in names)}], each a "
            f"number or an expression of {', '.join(names)} in quotes, or a Python function)"
        )
    programs = [
        implicit.program(f"{entry}.{k}", repr(part) if type(part) in (int, float) else part, names)
        for k, part in enumerate(definition, 1)
    ]
    return Field(entry, partial(_expressions, programs))


def _expressions(programs: list[tuple[float, ...]], points: np.ndarray) -> np.ndarray:
    columns = [np.broadcast_to(implicit.run(code, points)[0], len(points)) for code in programs]
    return np.stack(columns, axis=1)


def _of_table(entry: str, table: dict[str, Any], names: str) -> Callable[[np.ndarray], np.ndarray]:
    """The cubic spline through a table: `x`, `y` (, `z`) are the places of its points along the axes,
    `values` the vectors, those along the last axis behind each other.
    """
    from scipy.interpolate import NdBSpline, make_interp_spline

    accepted = (
        f"a table of {', '.join(names)}, each {FEWEST} or more numbers that grow, and values, a row of {len(names)} "
        "numbers for each point"
    )
    try:
        grid = [np.array(table[name], dtype=float) for name in names]
        values = np.array(table["values"], dtype=float)
        fits = set(table) == {*names, "values"} and values.shape == (
            int(np.prod([len(places) for places in grid])),
            len(names),
        )
        grows = all(len(places) >= FEWEST and (np.diff(places) > 0).all() for places in grid)
        if not (fits and grows and np.isfinite(values).all()):
            raise ValueError
    except (KeyError, TypeError, ValueError):
        raise BadInput(f"{entry}: '{brief(table)}' is no field (accepted: {accepted})") from None
    weights, knots = values.reshape([*map(len, grid), len(names)]), []
    for axis, places in enumerate(grid):
        spline = make_interp_spline(places, np.moveaxis(weights, axis, 0))
        weights = np.moveaxis(spline.c, 0, axis)
        knots.append(spline.t)
    return partial(NdBSpline(tuple(knots), weights, 3), extrapolate=False)


def tabulated(
    entry: str, function: Callable[[np.ndarray], Any], low: np.ndarray, high: np.ndarray
) -> dict[str, Any]:
    """The table of a Python function of place in a box between two points (axes,) [m].

    The function takes a point (axes,) and returns a vector. The table has so many points that its
    error is at most FOLLOWED times the largest value, at the middles of its cells and at CHECKED
    other places. Raises BadInput if the function returns something else, or changes too fast.
    """
    axes = len(low)
    names = "xyz"[:axes]

    def at(points: np.ndarray) -> np.ndarray:
        try:
            rows = [np.asarray(function(point), dtype=float) for point in points]
            values = np.array(rows).reshape(len(points), axes)
        except (TypeError, ValueError) as error:
            raise BadInput(
                f"{entry}: {error} (accepted: a function of a point that returns {axes} numbers)"
            ) from None
        if not np.isfinite(values).all():
            place = points[~np.isfinite(values).all(axis=1)][0]
            raise BadInput(
                f"{entry}: is not finite at ({', '.join(f'{x:.6g}' for x in place)}) (accepted: finite numbers)"
            )
        return values

    other = low + (high - low) * np.random.default_rng(1).uniform(size=(CHECKED, axes))
    for count in itertools.count(1):
        points = (FIRST - 1) * 2 ** (count - 1) + 1
        if points**axes > LARGEST:
            raise BadInput(
                f"{entry}: changes too fast for a table of {LARGEST} points (accepted: a smoother function, or an "
                "expression for each axis in quotes)"
            )
        grid = np.linspace(low, high, points).T
        values = at(_product(grid))
        tested = np.vstack([_product((grid[:, 1:] + grid[:, :-1]) / 2), other])
        table = dict(zip(names, grid.tolist())) | {"values": values.tolist()}
        exact = at(tested)
        off = abs(_of_table(entry, table, names)(tested) - exact).max()
        if off <= FOLLOWED * max(abs(values).max(), abs(exact).max()):
            return table
    raise AssertionError


def _product(grid: np.ndarray) -> np.ndarray:
    """The points (n, axes) of a grid with these places (axes, points) along the axes."""
    return np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, len(grid))
