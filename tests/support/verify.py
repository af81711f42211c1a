"""Helpers that the modules test_verify.py share."""

from verification.case import Case, Row


def case(numbers, **entries) -> Case:
    """A case with these numbers: (what, size, value, expected[, order])."""
    def measured(folder):
        yield from (Row(*row) for row in numbers)
    return Case(**dict(name="V0", title="nothing", axis="size", tolerance=0.01, rows=measured) | entries)
