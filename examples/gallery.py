"""Runs the pages examples/NN_name.py and writes docs/gallery-numbers.csv: `python -m
examples.gallery`.

The runs go to results/gallery, and a second call reuses them.
"""

import argparse
import os
import re
import runpy
import sys
import time
import warnings
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import pandas as pd

from ffimpact.__main__ import start
from ffimpact.failure import Failure

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "docs/gallery-numbers.csv"
COLUMNS = "quantity unit computed error reference uncertainty source note".split()


def pages() -> list[Path]:
    """The files of the gallery, in order."""
    return sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


def numbers(page: Path) -> pd.DataFrame:
    """Runs a page in the working folder without a window and returns its table."""
    matplotlib.use("Agg")
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=".*cannot be shown")
            return runpy.run_path(str(page))["numbers"]
    finally:
        plt.close("all")


def is_consistent(row: pd.Series) -> bool:
    """Whether |computed - reference| <= error + uncertainty, or there is no reference."""
    if pd.isna(row.reference):
        return True
    return bool(abs(row.computed - row.reference) <= row.error + row.uncertainty)


def largest_miss(row: pd.Series) -> float:
    """The largest |computed - reference| that the note of a row admits, 0 if it admits none."""
    stated = re.fullmatch("misses by ([0-9.]+)( %)?: .+", row.note)
    if not stated:
        return 0.0
    return float(stated[1]) * (abs(row.reference) / 100 if stated[2] else 1)


def complaints(table: pd.DataFrame) -> list[str]:
    """The defects of the table of a page, a line for each.

    The note of a row that is not consistent has to begin with its largest size and give the reason:
    "misses by 4 %: ...", of the reference, or "misses by 0.02: ...", in the unit of the row.
    """
    if list(table.columns) != COLUMNS:
        return [f"columns {', '.join(table.columns)} (accepted: {', '.join(COLUMNS)})"]
    messages = [] if len(table) else ["no rows"]
    for _, row in table.iterrows():
        if not pd.notna(row.computed) or abs(row.computed) == float("inf"):
            messages.append(f"{row.quantity}: computed is {row.computed}")
        elif not row.quantity or not row.unit:
            messages.append(f"'{row.quantity}': no name or no unit")
        elif not is_consistent(row) and abs(row.computed - row.reference) > largest_miss(row):
            messages.append(
                f"{row.quantity}: {row.computed:g} +- {row.error:g} against {row.reference:g} "
                f"+- {row.uncertainty:g} ({row.source}), more than the note says: '{row.note}'"
            )
    return messages


def main(argv: list[str]) -> int:
    """Runs every page. Raises Failure if a table is not consistent."""
    parser = argparse.ArgumentParser(prog="python -m examples.gallery", description=__doc__)
    parser.parse_args(argv)
    place = ROOT / "results/gallery"
    place.mkdir(parents=True, exist_ok=True)
    os.chdir(place)
    tables, wrong, began = [], [], time.monotonic()
    for page in pages():
        since = time.monotonic()
        table = numbers(page)
        tables.append(table.assign(page=page.stem)[["page", *COLUMNS]])
        wrong += [f"{page.stem}: {line}" for line in complaints(table)]
        missed = sum(not is_consistent(row) for _, row in table.iterrows())
        took = f"{time.monotonic() - since:6.1f} s"
        print(f"{page.stem:<24}{took}{len(table):5d} numbers, {missed} miss", flush=True)
    pd.concat(tables).to_csv(TABLE, index=False, float_format="%.6g")
    print(f"{'all pages':<24}{time.monotonic() - began:6.1f} s  {TABLE.relative_to(ROOT)}")
    if wrong:
        raise Failure("gallery: " + "; ".join(wrong))
    return 0


if __name__ == "__main__":
    sys.exit(start(main))
