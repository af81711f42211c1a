"""The command line and the report that the commands of verification/ and benchmarks/ have in
common, and the line that names the source of a page's numbers."""

import argparse
import platform
import re
import shlex
from datetime import date
from pathlib import Path

import pandas as pd

from ffimpact.output.folder import result_folder
from ffimpact.places import RESULTS, shown
from ffimpact.running import run
from ffimpact.sweeps import study


def command(name: str, doc: str, page: bool = False, folder: str = "") -> argparse.ArgumentParser:
    """The command line of a study, for finish(): --out for its result folder and, if `page` is set,
    --page."""
    parser = argparse.ArgumentParser(prog=program(name), description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", metavar="DIR", type=lambda text: result_folder(Path(text)), default=str(RESULTS / (folder or name)),
                        help="the result folder")
    if page:
        parser.add_argument("--page", metavar="FILE", type=Path,
                            help="also write its tables, its figure and the block of its page")
    parser.set_defaults(command=name, table=folder or name)
    return parser


def program(name: str) -> str:
    """The command that starts a study."""
    return "python -m verification" if name == "verify" else f"python -m benchmarks {name}"


def finish(options: argparse.Namespace, rows: pd.DataFrame, text: str, good: bool,
           files: str = "csv") -> int:
    """Saves the table of a study, prints its report and the names of its `files`. Returns the exit
    code."""
    study.save(rows, options.out / f"{options.table}.csv")
    print(f"{text}\n{shown(options.out)}/{options.table}.{files}")
    return 0 if good else 1


def measured(command: list[str]) -> str:
    """A line with the command, commit, date and machine of a measurement."""
    model = re.search(r"^model name\s*: (.*)", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    return (f"Measured by `{program(command[0])} {shlex.join(command[1:])}` "
            f"at commit {run.commit(10)}, {date.today()}, on {study.CORES} cores, "
            f"{model[1] if model else platform.machine()}.")
