"""Writes the page of a measurement in docs/measurements.

The tables are X.csv and X-NAME.csv, the figure drawn from them is X.svg. A block between two marks
of X.md shows tables and figure with the command that measured them. The text outside of the block
is written by hand.
"""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from ffimpact.failure import BadInput, unknown
from ffimpact.places import ROOT, shown
from ffimpact.sweeps import study
from verification import commands

from . import figures

FOLDER = ROOT / "docs/measurements"
BEGIN, END = "<!-- measured -->", "<!-- end of measured -->"
Tables = dict[str, pd.DataFrame]  # tables by name; "" is the main table


def finish(
    options: argparse.Namespace,
    rows: pd.DataFrame,
    text: str,
    good: bool,
    argv: list[str],
    title: str,
    tables: Tables,
    inline: Sequence[str] = (),
    files: str = "csv",
) -> int:
    """Ends a measurement as commands.finish() does and writes its page if --page is set. Returns
    the exit code."""
    code = commands.finish(options, rows, text, good, files)
    write(options.page, title, [options.command, *argv], text.rpartition("\n\n")[2], tables, inline)
    return code


def write(
    path: Path | None,
    title: str,
    command: list[str],
    verdict: str,
    tables: Tables,
    inline: Sequence[str] = (),
) -> None:
    """Writes tables, figure and block of the page `path`; does nothing if `path` is None.

    The page itself shows the tables named in `inline`.
    """
    if not path:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    source = commands.measured(command)  # before the tables change the source tree
    for name, table in tables.items():
        table.to_csv(place(path, name), index=False, float_format="%.6g")
    draw(path, command[0])
    parts = [source, " ".join(verdict.split()), f"![{title}]({path.stem}.svg)"]
    parts += [markdown(tables[name]) for name in inline if not tables[name].empty]
    links = [f"[{place(path, name).name}]({place(path, name).name})" for name in tables]
    parts.append(f"{'Table' if len(links) == 1 else 'Tables'}: {', '.join(links)}.")
    block = "\n\n".join([BEGIN, *parts, END])
    text = path.read_text() if path.exists() else f"# {title}\n\n{BEGIN}\n{END}\n"
    with study.complete(path) as part:
        part.write_text(
            re.sub(rf"{BEGIN}.*?{END}", lambda _: block, text, count=1, flags=re.DOTALL)
        )


def place(path: Path, name: str) -> Path:
    """The CSV file of the table `name` of the page `path`."""
    return path.with_name(f"{path.stem}-{name}.csv" if name else f"{path.stem}.csv")


def draw(path: Path, command: str) -> None:
    """Draws the figure of a page from its CSV files."""
    tables = {
        file.stem.removeprefix(path.stem).removeprefix("-"): pd.read_csv(file) for file in files(path)
    }
    figures.draw(command, tables, path.with_suffix(".svg"))


def files(path: Path) -> list[Path]:
    """The CSV files of a page, without those of pages whose names begin with the name of this page."""
    pages = sorted(
        {path.stem, *(file.stem for file in path.parent.glob("*.md"))}, key=len, reverse=True
    )
    return [
        file
        for file in sorted(path.parent.glob(f"{path.stem}*.csv"))
        if next((page for page in pages if file.stem == page or file.stem.startswith(f"{page}-")), "")
        == path.stem
    ]


def markdown(table: pd.DataFrame) -> str:
    """A table in Markdown, with numbers to four digits."""
    cells = [[cell(value) for value in row] for row in table.itertuples(index=False)]
    numeric = [
        pd.api.types.is_numeric_dtype(table[name]) and table[name].dtype != bool for name in table
    ]
    lines = [list(table.columns), ["---:" if is_number else "---" for is_number in numeric], *cells]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def cell(value: object) -> str:
    if isinstance(value, float):
        return "" if pd.isna(value) else f"{value:.4g}"
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)


def main(argv: list[str]) -> int:
    """Draws the figures of the pages again from their CSV files."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks page", description=main.__doc__)
    parser.add_argument(
        "pages", metavar="PAGE", nargs="*", help=f"of {shown(FOLDER)} (default: all)"
    )
    names = parser.parse_args(argv).pages
    commands_of = {
        path.stem: match[1]
        for path in sorted(FOLDER.glob("*.md"))
        if (match := re.search(r"`python -m benchmarks ([\w-]+)", path.read_text()))
    }
    for name in names or commands_of:
        if name not in commands_of:
            raise BadInput(f"PAGE: {unknown(name, commands_of, ', ')}")
        draw(FOLDER / f"{name}.md", commands_of[name])
        print(shown(FOLDER / f"{name}.svg"))
    return 0
