"""A verification case and its numbers. `make verify` runs cases on fine meshes, the tests on coarse
ones."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt

# Order of a second-order scheme at a wave front, which it smears over h^(2/3).
FRONT = 2 / 3
LAWS = {"svk": "SVK", "neohookean": "neo-Hookean"}


@dataclass(frozen=True)
class Row:
    """A number of a case at one size. Its error is relative, or absolute if 0 is expected."""

    # "group: name". A group is drawn in one colour.
    what: str
    size: float
    value: float
    expected: float
    # Theoretical order of the error, if there is one. It is drawn, and required of cases that are
    # judged by order.
    order: float | None = None

    @property
    def error(self) -> float:
        return abs(self.value / self.expected - 1) if self.expected else abs(self.value)


@dataclass(frozen=True)
class Case:
    """A case in the table of checks: its numbers, from coarse to fine, and the requirements.

    With `by_order`, the observed order between the two finest sizes must be within `tolerance` of
    the expected order. Otherwise every number must be within the relative `tolerance` at its finest
    size, and the largest error at that size must be smaller than the largest error at the coarsest
    size.
    """

    name: str
    title: str
    axis: str  # label of the size axis
    tolerance: float
    # Functions that run the case or its parts, in a folder for their files. Parts can run at the
    # same time.
    rows: Callable[[Path], Iterator[Row]] | tuple[Callable[[Path], Iterator[Row]], ...]
    by_order: bool = False
    beside: Callable[[plt.Axes, Path], None] | None = None  # draws a second panel from these files
    note: str = ""  # remark for the reader of the figure

    @property
    def parts(self) -> tuple[Callable[[Path], Iterator[Row]], ...]:
        """The functions that can run at the same time. Their rows in sequence are the rows of the
        case."""
        return self.rows if isinstance(self.rows, tuple) else (self.rows,)
