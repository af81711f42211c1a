"""A case and its numbers: what `make verify` runs on fine meshes and judges, and the tests run coarse."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt

FRONT = 2 / 3               # order of a second-order scheme where a front passes: it smears it over h^(2/3)
LAWS = {"svk": "SVK", "neohookean": "neo-Hookean"}


@dataclass(frozen=True)
class Row:
    """A number of a case at one size. Its error is relative; where 0 is expected the number itself."""

    what: str                    # "group: which"; a group is drawn in one colour
    size: float
    value: float
    expected: float
    order: float | None = None   # of the error, where theory gives one: drawn, and asked for where the case is judged by it

    @property
    def error(self) -> float:
        return abs(self.value / self.expected - 1) if self.expected else abs(self.value)


@dataclass(frozen=True)
class Case:
    """A case of the table of checks: its numbers, from coarse to fine, and what is asked of them.

    by_order: the observed order between the two finest sizes, within `tolerance` of the expected one. Otherwise: every number
    at its finest size within the relative `tolerance`, and the largest error there below the largest at the coarsest size.
    """

    name: str
    title: str
    axis: str                                    # label of the size
    tolerance: float
    rows: Callable[[Path], Iterator[Row]] | tuple[Callable[[Path], Iterator[Row]], ...]   # runs the case, or its parts at the same time; a folder for their files
    by_order: bool = False
    beside: Callable[[plt.Axes, Path], None] | None = None   # draws a second panel from those files
    note: str = ""                               # what the reader of the figure should know

    @property
    def parts(self) -> tuple[Callable[[Path], Iterator[Row]], ...]:
        """What can run at the same time; their rows, one after another, are those of the case."""
        return self.rows if isinstance(self.rows, tuple) else (self.rows,)
